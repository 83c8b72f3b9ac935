#include "plumb/io/log_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "plumb/io/log_reader.hpp"
#include "text_tools.hpp"
#include "ulog_writer.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// A cell that the reader takes back as the same text.
std::string cell_of(const std::string& text) {
  return text.find_first_of(", \t") == std::string::npos ? text : "\"" + text + "\"";
}

/// The cell whose product with its unit is exactly `value`: of the quotient and its neighbours the one with the fewest
/// digits, which is what a log holds that was read.
double cell_in_unit(double value, double unit) {
  const double quotient = value / unit;
  if (unit == 1.0 || !std::isfinite(quotient)) return quotient;
  double out = quotient;
  std::size_t fewest = std::string::npos;
  for (const double candidate : {quotient, std::nextafter(quotient, -HUGE_VAL), std::nextafter(quotient, HUGE_VAL)}) {
    if (candidate * unit != value) continue;
    const std::size_t digits = shortest(candidate).size();
    if (digits < fewest) {
      out = candidate;
      fewest = digits;
    }
  }
  return out;
}

/// Of a clock; empty where the column is another one's already: two clocks may share a column, and it may be the log's.
std::string own_clock_column(const InputSpec& input, std::size_t clock) {
  const std::string& column = input.clock_columns[clock];
  bool taken = column == input.time_column;
  for (std::size_t c = 0; c < clock; ++c) taken = taken || input.clock_columns[c] == column;
  return taken ? std::string() : column;
}

bool ends_in(const std::string& path, std::string_view ending) {
  return path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

/// The numbers of a row as they are put down one after the other, in the order of the columns.
class Cells {
 public:
  Cells(std::string& line, UlogWriter* ulog) : line_(line), ulog_(ulog) { line_.clear(); }

  void number(bool present, double value) {
    if (ulog_ != nullptr) return ulog_->put(present, value);
    comma();
    if (present) append_shortest(line_, value);
  }
  /// A time or a length: a ULog has seconds and metres, a CSV its own unit.
  void in_unit(bool present, double si, double unit) {
    number(present, ulog_ != nullptr || !present ? si : cell_in_unit(si, unit));
  }
  void whole(std::int64_t value) {
    if (ulog_ != nullptr) return ulog_->put(true, static_cast<double>(value));
    char text[24];
    comma();
    line_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  }
  /// The header of a ULog holds what is the same in all rows.
  void constant(const std::string& text) {
    if (ulog_ != nullptr) return;
    comma();
    line_ += cell_of(text);
  }

 private:
  void comma() {
    if (!first_) line_ += ',';
    first_ = false;
  }
  std::string& line_;
  UlogWriter* ulog_;
  bool first_ = true;
};

}  // namespace

ClockTimes clock_times(const std::vector<double>& clock_s) noexcept {
  ClockTimes out = kNoClockTimes;
  std::copy_n(clock_s.begin(), std::min(clock_s.size(), out.size()), out.begin());
  return out;
}

LogWriter::LogWriter(OutputFile file, const ArrayFile& array, Columns columns)
    : file_(std::move(file)), input_(array.input) {
  if (columns == Columns::tool) {
    for (const ArrayFile& group : array.groups) groups_.push_back(group.input);
  }
  if (columns != Columns::samples) return;
  input_.rotation_columns.clear();
  input_.second_rotation_columns.clear();
  input_.clock_columns.clear();
}
LogWriter::LogWriter(LogWriter&& other) noexcept = default;
LogWriter& LogWriter::operator=(LogWriter&& other) noexcept = default;
LogWriter::~LogWriter() = default;

/// A filter on a column that has a role already is satisfied, or not, by the samples themselves.
void LogWriter::choose_constants() {
  std::vector<ColumnFilter> constant;
  for (const ColumnFilter& filter : input_.where) {
    bool taken = filter.column == input_.time_column || filter.column == input_.station_column ||
                 filter.column == input_.roll_group_column || filter.column == input_.count_column ||
                 filter.column == input_.temperature_column || filter.column == input_.depth_column;
    for (const std::string& column : input_.rotation_columns) taken = taken || filter.column == column;
    for (const std::string& column : input_.second_rotation_columns) taken = taken || filter.column == column;
    for (const std::string& column : input_.clock_columns) taken = taken || filter.column == column;
    for (const std::string& column : input_.sensor_columns) taken = taken || filter.column == column;
    if (!taken) constant.push_back(filter);
  }
  input_.where = std::move(constant);
}

FileExpected<void> LogWriter::begin_csv() {
  std::string header;
  const auto add = [&header](const std::string& name) {
    if (name.empty()) return;
    if (!header.empty()) header += ',';
    header += cell_of(name);
  };
  add(input_.time_column);
  add(input_.station_column);
  add(input_.roll_group_column);
  add(input_.count_column);
  add(input_.temperature_column);
  add(input_.depth_column);
  for (const ColumnFilter& filter : input_.where) add(filter.column);
  for (const std::string& column : input_.rotation_columns) add(column);
  for (const std::string& column : input_.second_rotation_columns) add(column);
  for (std::size_t c = 0; c < input_.clock_columns.size(); ++c) add(own_clock_column(input_, c));
  for (const std::string& column : input_.sensor_columns) add(column);
  for (const InputSpec& group : groups_) {
    for (const std::string& column : group.sensor_columns) add(column);
  }
  header += '\n';
  return file_.write(header);
}

/// In the order of the cells of `write`.
FileExpected<void> LogWriter::begin_ulog() {
  UlogHeader header;
  const auto add = [&header](const std::string& field, const std::string& name, const std::string& unit) {
    if (!name.empty()) header.add_numbers(field, name, unit);
  };
  constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};
  const auto add_rates = [&add, &kAxisNames](const std::string& rotation, const std::vector<std::string>& columns) {
    for (std::size_t k = 0; k < columns.size(); ++k)
      add(rotation + "_" + kAxisNames[k % kAxisNames.size()] + "_radps", columns[k], "rad/s");
  };
  add("time_s", input_.time_column, "s");
  add("station", input_.station_column, "");
  add("roll_group", input_.roll_group_column, "");
  add("count", input_.count_column, "");
  add("temperature_degc", input_.temperature_column, "degC");
  add("depth_m", input_.depth_column, "m");
  for (const ColumnFilter& filter : input_.where)
    header.columns.push_back(UlogColumn{"", filter.column, true, filter.text});
  add_rates("rotation", input_.rotation_columns);
  add_rates("second_rotation", input_.second_rotation_columns);
  for (std::size_t c = 0; c < input_.clock_columns.size(); ++c)
    add("clock_" + std::to_string(c + 1) + "_s", own_clock_column(input_, c), "s");
  for (const std::string& column : input_.sensor_columns) add(column, column, input_.unit.name);
  for (const InputSpec& group : groups_) {
    for (const std::string& column : group.sensor_columns) add(column, column, group.unit.name);
  }
  if (input_.time_column.empty()) header.rate_hz = input_.rate_hz;
  if (const std::string misfit = ulog_misfit(header); !misfit.empty()) {
    return tl::unexpected<FileError>(FileError{file_.path(), 0, "", misfit, "write a CSV (a name that ends in .csv)"});
  }
  ulog_ = std::make_unique<UlogWriter>(header);
  return ulog_->begin(file_);
}

FileExpected<LogWriter> LogWriter::create(const std::string& path, const ArrayFile& array, Columns columns, Form form) {
  if (form == Form::by_name && ends_in(path, ".plog")) {
    return tl::unexpected<FileError>(
        FileError{path, 0, "", "ends in .plog, the binary log that ULog has taken the place of", "name it .ulg"});
  }
  const bool ulog = form == Form::ulog || (form == Form::by_name && (ends_in(path, ".ulg") || ends_in(path, ".ulog")));
  FileExpected<OutputFile> file = OutputFile::create(path, OutputFile::Mode::stream);
  if (!file) return tl::unexpected<FileError>(file.error());
  LogWriter writer(*std::move(file), array, columns);
  writer.choose_constants();
  const FileExpected<void> begun = ulog ? writer.begin_ulog() : writer.begin_csv();
  if (!begun) return tl::unexpected<FileError>(begun.error());
  return writer;
}

FileExpected<void> LogWriter::write(const Sample& sample, const Notes& notes) {
  Cells cells(line_, ulog_.get());
  if (ulog_ != nullptr) ulog_->begin_row(sample.time_s);
  if (!input_.time_column.empty()) cells.in_unit(true, sample.time_s, input_.time_unit_s);
  if (!input_.station_column.empty()) cells.whole(label_of_tag(sample.station));
  if (!input_.roll_group_column.empty()) cells.whole(label_of_tag(sample.roll_group));
  if (!input_.count_column.empty()) cells.whole(static_cast<std::int64_t>(sample.count));
  if (!input_.temperature_column.empty()) cells.number(!notes.temperature_held, sample.temperature_degc);
  if (!input_.depth_column.empty()) cells.in_unit(std::isfinite(notes.depth_m), notes.depth_m, input_.depth_unit_m);
  for (const ColumnFilter& filter : input_.where) cells.constant(filter.text);
  const auto rates = [&cells](const std::vector<std::string>& columns, const Rotation& rotation) {
    for (std::size_t k = 0; k < columns.size(); ++k)
      cells.number(rotation.rate_known || !rotation.turning, rotation.rate_radps[k]);
  };
  rates(input_.rotation_columns, notes.rotation);
  rates(input_.second_rotation_columns, notes.second_rotation);
  for (std::size_t c = 0; c < input_.clock_columns.size(); ++c) {
    if (own_clock_column(input_, c).empty()) continue;
    const double time_s = notes.clock_s[c];
    cells.in_unit(std::isfinite(time_s), time_s, input_.time_unit_s);
  }
  const auto readings = [&cells](const InputSpec& input, const Sample& of) {
    for (std::size_t i = 0; i < input.sensor_columns.size(); ++i)
      cells.number(of.delivered.has(static_cast<int>(i)), of.raw[i]);
  };
  readings(input_, sample);
  for (std::size_t k = 0; k < groups_.size() && notes.groups != nullptr; ++k) readings(groups_[k], notes.groups[k]);
  if (ulog_ != nullptr) return ulog_->end_row(file_);
  line_ += '\n';
  return file_.write(line_);
}

FileExpected<void> LogWriter::commit() {
  const FileExpected<void> done = ulog_ ? ulog_->finish(file_) : FileExpected<void>();
  return done ? file_.commit() : done;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
