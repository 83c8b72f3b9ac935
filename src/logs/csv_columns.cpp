// Which columns of a table are of which chip, and in which unit.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "csv_layout.hpp"
#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

using Rows = std::vector<std::vector<std::string>>;
using Names = std::vector<ColumnName>;

constexpr double kG0_mps2 = 9.80665;
constexpr std::size_t kMostSources = 64;

tl::unexpected<CsvTrouble> trouble(std::uint64_t line, std::string what, std::string remedy) {
  return tl::unexpected<CsvTrouble>(CsvTrouble{line, std::move(what), std::move(remedy)});
}

std::string lowered(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return out;
}
bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

std::string figure(double value) {
  std::string out = std::to_string(value);
  return out.substr(0, out.find('.') + 4);
}

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of the readings as they stand.
std::optional<double> median_length(const Rows& rows, const CsvColumns& columns, char decimal) {
  std::vector<double> lengths;
  for (const auto& row : rows) {
    double sum = 0.0;
    for (const std::size_t c : columns) {
      double value = 0.0;
      sum += parse_number(row[c], decimal, value) == CellKind::number ? value * value : std::nan("");
    }
    if (std::isfinite(sum)) lengths.push_back(std::sqrt(sum));
  }
  return median(std::move(lengths));
}

/// What writes numbers in units of its own that its names do not say.
enum class Writer { unknown, px4, ardupilot, ros };

Writer writer_of(const CsvLayout& layout, std::string_view stem) {
  for (const std::string_view topic : {"sensor_accel", "sensor_combined", "vehicle_imu", "vehicle_acceleration"}) {
    if (contains(stem, topic)) return Writer::px4;
  }
  bool has_timeus = false;
  for (const std::string& name : layout.header) {
    const std::string plain = lowered(bare(name));
    if (plain == "timestamp_sample") return Writer::px4;
    if (contains(plain, "linear_acceleration.x") || contains(plain, "linear_acceleration_x")) return Writer::ros;
    has_timeus = has_timeus || plain == "timeus";
  }
  return has_timeus ? Writer::ardupilot : Writer::unknown;
}

/// "log_3_sensor_accel_1": topic and instance, as ulog2csv names its files.
bool is_px4_source(std::string_view stem, CsvSource& out) {
  const std::size_t digits = stem.find_last_not_of("0123456789");
  if (digits == std::string_view::npos || stem[digits] != '_') return false;
  const std::string_view number = stem.substr(digits + 1), before = stem.substr(0, digits);
  if (number.empty() || number.size() > 2) return false;
  for (const std::string_view topic :
       {"sensor_accel", "sensor_combined", "vehicle_imu_status", "vehicle_imu", "vehicle_acceleration"}) {
    if (before.size() < topic.size() || before.substr(before.size() - topic.size()) != topic) continue;
    out.instance = std::stoi(std::string(number));
    out.uncalibrated = topic == "sensor_accel";
    out.name = std::string(topic) + "[" + std::to_string(out.instance) + "]";
    return true;
  }
  return false;
}

class Assignment {
 public:
  Assignment(const Rows& rows, const CsvSample& sample, const CsvHints& hints, CsvLayout& out)
      : rows_(rows), hints_(hints), out_(out), stem_(lowered(sample.stem)), writer_(writer_of(out, stem_)) {
    for (const std::string& name : out.header) names_.push_back(column_name(name));
  }

  tl::expected<void, CsvTrouble> run();

 private:
  using Triples = std::map<std::string, CsvColumns>;
  Triples triples_of(ColumnKind kind) const;
  std::size_t first_of(ColumnKind kind) const;
  void find_sources();
  tl::expected<void, CsvTrouble> find_time();
  bool may_be_time(std::size_t column) const;
  void find_nanoseconds();
  std::optional<TimeForm> form_by_name(const ColumnName& name) const;
  TimeForm form_by_size();
  tl::expected<void, CsvTrouble> find_unit(CsvSource& source);
  bool unit_by_size(CsvSource& source);
  void find_rate(CsvSource& source, const Triples& rates);
  void guess(const std::string& text) { out_.guesses.push_back(text); }
  std::string column(std::size_t k) const { return "\"" + io::printable_line(bare(out_.header[k])) + "\""; }

  const Rows& rows_;
  const CsvHints& hints_;
  CsvLayout& out_;
  std::string stem_;
  Writer writer_;
  Names names_;
};

Assignment::Triples Assignment::triples_of(ColumnKind kind) const {
  Triples out;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const ColumnName& name = names_[k];
    if (name.kind != kind || name.axis < 0) continue;
    auto& columns = out.emplace(name.group, CsvColumns{kNoColumn, kNoColumn, kNoColumn}).first->second;
    auto& place = columns[static_cast<std::size_t>(name.axis)];
    if (place == kNoColumn) place = k;  // the first one of a name
  }
  for (auto at = out.begin(); at != out.end();) {
    const bool is_whole = std::count(at->second.begin(), at->second.end(), kNoColumn) == 0;
    at = is_whole ? std::next(at) : out.erase(at);
  }
  return out;
}

std::size_t Assignment::first_of(ColumnKind kind) const {
  const auto found =
      std::find_if(names_.begin(), names_.end(), [kind](const ColumnName& name) { return name.kind == kind; });
  return found == names_.end() ? kNoColumn : static_cast<std::size_t>(found - names_.begin());
}

void Assignment::find_sources() {
  Triples forces = triples_of(ColumnKind::force);
  Triples rates = triples_of(ColumnKind::rate);
  if (forces.empty() && !contains(stem_, "gyro") && !contains(stem_, "mag")) {
    forces = triples_of(ColumnKind::axis_alone);
    if (!forces.empty() && !contains(stem_, "acc"))
      guess("the columns x, y, z are taken for those of an accelerometer");
  }
  if (forces.empty()) {
    // Who drills calls the components of gravity Gx, Gy, Gz.
    for (const auto& [group, columns] : rates) {
      const auto unit = names_[columns[0]].unit;
      const bool may_be = lowered(bare(out_.header[columns[0]])).find("gx") == 0 && unit != ColumnUnit::radps &&
                          unit != ColumnUnit::degps;
      if (may_be) forces.emplace(group, columns);
    }
    if (!forces.empty()) {
      rates.clear();
      guess("there are no columns of accelerations, " + column(forces.begin()->second[0]) +
            " and the like are taken for components of gravity");
    }
  }
  std::vector<std::pair<std::string, CsvColumns>> in_order(forces.begin(), forces.end());
  std::sort(in_order.begin(), in_order.end(), [](const auto& a, const auto& b) { return a.second[0] < b.second[0]; });
  for (const auto& [group, columns] : in_order) {
    if (out_.sources.size() == kMostSources) break;
    CsvSource source;
    source.force = columns;
    source.name = group.find_first_not_of("0123456789") == std::string::npos && !group.empty() ? "acc" + group : group;
    if (forces.size() == 1) (void)is_px4_source(stem_, source);
    if (source.name.empty()) source.name = writer_ == Writer::ardupilot ? "IMU" : "accelerometer";
    find_rate(source, rates);
    out_.sources.push_back(source);
  }
}

void Assignment::find_rate(CsvSource& source, const Triples& rates) {
  const std::string& group = names_[source.force[0]].group;
  const auto same = rates.find(group);
  const bool is_only = rates.size() == 1 && triples_of(ColumnKind::force).size() == 1;
  if (same != rates.end()) source.rate = same->second;
  if (same == rates.end() && is_only) source.rate = rates.begin()->second;
  std::size_t temperatures = 0, last = kNoColumn;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    if (names_[k].kind != ColumnKind::temperature) continue;
    ++temperatures;
    last = k;
    if (names_[k].group == group) source.temperature = k;
  }
  if (source.temperature == kNoColumn && temperatures == 1) source.temperature = last;
  if (source.rate[0] == kNoColumn) return;
  const double factor = factor_of(names_[source.rate[0]].unit);
  const bool is_rate =
      names_[source.rate[0]].unit == ColumnUnit::radps || names_[source.rate[0]].unit == ColumnUnit::degps;
  source.rate_factor = is_rate ? factor : writer_ == Writer::unknown ? 0.0 : 1.0;
  if (!(source.rate_factor > 0.0))
    guess("the name of " + column(source.rate[0]) + " says no unit of a rate (rad/s, deg/s), the rates are left out");
}

std::optional<TimeForm> Assignment::form_by_name(const ColumnName& name) const {
  for (const TimeForm form :
       {TimeForm::seconds, TimeForm::milliseconds, TimeForm::microseconds, TimeForm::nanoseconds}) {
    const double unit_s = std::pow(1e-3, static_cast<int>(form));
    if (std::abs(hints_.time_unit_s / unit_s - 1.0) < 1e-6) return form;
  }
  switch (name.unit) {
    case ColumnUnit::s: return TimeForm::seconds;
    case ColumnUnit::ms: return TimeForm::milliseconds;
    case ColumnUnit::us: return TimeForm::microseconds;
    case ColumnUnit::ns: return TimeForm::nanoseconds;
    default: break;
  }
  if (writer_ == Writer::px4) return TimeForm::microseconds;
  return std::nullopt;
}

/// By what it counts from, where that is 1970, else by its steps: logs of IMUs have 1 to 10 000 rows a second.
TimeForm Assignment::form_by_size() {
  std::vector<double> steps, values;
  double before = std::nan("");
  for (const auto& row : rows_) {
    double value = 0.0;
    if (parse_number(row[out_.time], out_.dialect.decimal, value) != CellKind::number) continue;
    values.push_back(value);
    if (value > before) steps.push_back(value - before);
    before = value;
  }
  const double size = median(values).value_or(0.0), step = median(steps).value_or(0.0);
  struct Bound {
    double since_1970, step;
    TimeForm form;
  };
  constexpr std::array<Bound, 3> kBounds = {
      {{1e17, 1e6, TimeForm::nanoseconds}, {1e14, 1e3, TimeForm::microseconds}, {1e11, 1.0, TimeForm::milliseconds}}};
  for (const Bound& bound : kBounds) {
    if (size < bound.since_1970 && !(size < 1e8 * bound.step && step >= bound.step)) continue;
    guess("the name of " + column(out_.time) + " says no unit: steps of " + figure(step) + " are taken for " +
          to_string(bound.form));
    return bound.form;
  }
  return TimeForm::seconds;
}

/// A number, or a date with a time: a date alone says too little.
bool Assignment::may_be_time(std::size_t column) const {
  double value = 0.0;
  std::int64_t time_ns = 0;
  const std::string& cell = rows_.front()[column];
  return parse_number(cell, out_.dialect.decimal, value) == CellKind::number ||
         parse_time(cell, out_.dialect.decimal, TimeForm::date, time_ns);
}

/// "header.stamp.sec" and "header.stamp.nanosec": the time is in two columns.
void Assignment::find_nanoseconds() {
  const auto all_of = [this](std::size_t column, const auto& holds) {
    return std::all_of(rows_.begin(), rows_.end(), [&](const auto& row) { return holds(bare(row[column])); });
  };
  const auto is_whole = [](std::string_view cell) {
    return !cell.empty() && cell.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const auto is_rest = [&is_whole](std::string_view cell) { return is_whole(cell) && cell.size() <= 9; };
  if (names_[out_.time].unit != ColumnUnit::s || !all_of(out_.time, is_whole)) return;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    if (names_[k].kind == ColumnKind::time && names_[k].unit == ColumnUnit::ns && all_of(k, is_rest))
      out_.nanoseconds = k;
  }
}

tl::expected<void, CsvTrouble> Assignment::find_time() {
  int best = 0;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    if (names_[k].kind != ColumnKind::time || !may_be_time(k)) continue;
    const std::string plain = lowered(bare(out_.header[k]));
    const int rank = contains(plain, "sample")            ? 4
                     : contains(plain, "header")          ? 3
                     : names_[k].unit != ColumnUnit::none ? 2
                                                          : 1;
    if (rank <= best) continue;
    best = rank;
    out_.time = k;
  }
  if (out_.time == kNoColumn) {
    if (hints_.rate_hz > 0.0) return {};
    return trouble(out_.header_line, "has no column of time",
                   "name it \"time_s\", or say how many rows come in a second");
  }
  std::int64_t time_ns = 0;
  double value = 0.0;
  const bool is_number = parse_number(rows_.front()[out_.time], out_.dialect.decimal, value) == CellKind::number;
  if (!is_number && parse_time(rows_.front()[out_.time], '.', TimeForm::date, time_ns)) {
    out_.time_form = TimeForm::date;
    return {};
  }
  const auto form = form_by_name(names_[out_.time]);
  out_.time_form = form ? *form : form_by_size();
  find_nanoseconds();
  return {};
}

/// Gravity is what an accelerometer reads most of the time.
bool Assignment::unit_by_size(CsvSource& source) {
  const auto length = median_length(rows_, source.force, out_.dialect.decimal);
  if (!length) return false;
  struct Gravity {
    double length;
    double tolerance;
    ColumnUnit unit;
    const char* name;
  };
  std::vector<Gravity> known = {{kG0_mps2, 0.2, ColumnUnit::mps2, "m/s^2"},
                                {1.0, 0.2, ColumnUnit::g, "g"},
                                {1000.0, 0.012, ColumnUnit::mg, "mg"},
                                {980.665, 0.005, ColumnUnit::gal, "Gal"}};
  for (const Gravity& one : known) {
    if (std::abs(*length / one.length - 1.0) > one.tolerance) continue;
    source.force_unit = one.unit;
    source.force_factor = factor_of(one.unit);
    guess("the name of " + column(source.force[0]) + " says no unit: the length of gravity is " + figure(*length) +
          ", taken for " + one.name);
    return true;
  }
  for (double counts = 256.0; counts <= 32768.0; counts *= 2.0) {
    if (std::abs(*length / counts - 1.0) > 0.06) continue;
    source.force_factor = kG0_mps2 / counts;
    guess("the name of " + column(source.force[0]) + " says no unit: the length of gravity is " + figure(*length) +
          ", taken for counts of 1/" + std::to_string(static_cast<int>(counts)) + " g");
    return true;
  }
  return false;
}

tl::expected<void, CsvTrouble> Assignment::find_unit(CsvSource& source) {
  if (hints_.force_unit_mps2 > 0.0)
    return source.force_factor = hints_.force_unit_mps2, tl::expected<void, CsvTrouble>();
  const ColumnUnit unit = names_[source.force[0]].unit;
  for (const std::size_t c : source.force) {
    if (names_[c].unit != unit)
      return trouble(out_.header_line, column(source.force[0]) + " and " + column(c) + " are in different units",
                     "give the three axes of a chip in one unit");
  }
  const bool is_rate = unit == ColumnUnit::radps || unit == ColumnUnit::degps;
  source.force_factor = is_rate ? 0.0 : factor_of(unit);
  source.force_unit = source.force_factor > 0.0 ? unit : ColumnUnit::none;
  if (source.force_factor > 0.0) return {};
  if (writer_ != Writer::unknown) {
    source.force_unit = ColumnUnit::mps2;
    source.force_factor = 1.0;
    return {};
  }
  if (unit_by_size(source)) return {};
  const auto length = median_length(rows_, source.force, out_.dialect.decimal);
  return trouble(out_.header_line,
                 "says no unit of " + column(source.force[0]) + " that is known, and a length of " +
                     (length ? figure(*length) : std::string("nothing")) + " tells none",
                 "put the unit into the name: \"ax [m/s^2]\", \"ax [g]\"");
}

tl::expected<void, CsvTrouble> Assignment::run() {
  out_.instance = first_of(ColumnKind::instance);
  out_.device = first_of(ColumnKind::device);
  find_sources();
  if (out_.sources.empty())
    return trouble(out_.header_line, "has no three columns that are called like those of an accelerometer",
                   "call them \"ax [m/s^2]\", \"ay [m/s^2]\", \"az [m/s^2]\"");
  for (CsvSource& source : out_.sources) {
    if (auto found = find_unit(source); !found) return found;
  }
  return find_time();
}

}  // namespace

tl::expected<void, CsvTrouble> assign_columns(const Rows& rows, const CsvSample& sample, const CsvHints& hints,
                                              CsvLayout& out) {
  return Assignment(rows, sample, hints, out).run();
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
