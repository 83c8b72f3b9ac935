#include "csv_long.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "csv_cells.hpp"
#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::size_t kMostColumnsOfOne = 64;
constexpr int kMostInstances = 32;

/// Messages that are read, and the instance that their names say; -1: the column I does.
struct Known {
  std::string_view name;
  std::string_view source;
  int instance;
};
constexpr std::array<Known, 8> kKnown = {{{"IMU", "IMU", -1},
                                          {"IMU2", "IMU", 1},
                                          {"IMU3", "IMU", 2},
                                          {"ACC", "ACC", -1},
                                          {"ACC1", "ACC", 0},
                                          {"ACC2", "ACC", 1},
                                          {"ACC3", "ACC", 2},
                                          {"ACC4", "ACC", 3}}};

const Known* known(std::string_view name) noexcept {
  const auto* const found =
      std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& one) { return one.name == name; });
  return found == kKnown.end() ? nullptr : found;
}

/// Three or four capitals and figures.
bool is_message_name(std::string_view text) noexcept {
  return text.size() >= 2 && text.size() <= 4 && text[0] >= 'A' && text[0] <= 'Z' &&
         std::all_of(text.begin(), text.end(), [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
}

/// "...: IMU {a : 1, b : 2}": the name and what is within; empty where the line is none of these.
std::string_view keyed_name(std::string_view line, std::string_view& content) noexcept {
  const std::size_t open = line.find(" {");
  const std::size_t close = line.rfind('}');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return {};
  const std::size_t before = line.rfind(": ", open);
  const std::string_view name = bare(line.substr(before == std::string_view::npos ? 0 : before + 2,
                                                 open - (before == std::string_view::npos ? 0 : before + 2)));
  if (!is_message_name(name)) return {};
  content = line.substr(open + 2, close - open - 2);
  return name;
}

double number_in(const std::vector<std::string_view>& cells, const std::vector<std::string>& columns,
                 std::string_view name) {
  const auto found = std::find(columns.begin(), columns.end(), name);
  const auto k = static_cast<std::size_t>(found - columns.begin());
  double value = kAbsent;
  if (found == columns.end() || k >= cells.size() || parse_number(cells[k], '.', value) != CellKind::number)
    return kAbsent;
  return value;
}

Axes axes_in(const std::vector<std::string_view>& cells, const std::vector<std::string>& columns, const char* x,
             const char* y, const char* z) {
  return {number_in(cells, columns, x), number_in(cells, columns, y), number_in(cells, columns, z)};
}

std::optional<std::int64_t> time_in(const std::vector<std::string_view>& cells,
                                    const std::vector<std::string>& columns) {
  struct Named {
    const char* name;
    TimeForm form;
  };
  for (const Named& one : {Named{"TimeUS", TimeForm::microseconds}, Named{"TimeMS", TimeForm::milliseconds}}) {
    const auto found = std::find(columns.begin(), columns.end(), one.name);
    const auto k = static_cast<std::size_t>(found - columns.begin());
    std::int64_t out_ns = 0;
    if (found != columns.end() && k < cells.size() && parse_time(cells[k], '.', one.form, out_ns)) return out_ns;
  }
  return std::nullopt;
}

}  // namespace

bool is_long_form(const std::vector<std::string>& lines) {
  std::size_t messages = 0, all = 0, wanted = 0;
  for (const std::string& line : lines) {
    if (bare(line).empty()) continue;
    ++all;
    std::string_view content;
    std::string_view name = keyed_name(line, content);
    if (name.empty()) name = bare(std::string_view(line).substr(0, std::min(line.find(','), line.size())));
    if (!is_message_name(name) || name.size() == line.size()) continue;
    ++messages;
    wanted += name == "FMT" || known(name) != nullptr ? 1U : 0U;
  }
  return wanted > 0 && 2 * messages > all;
}

void CsvLong::define(std::string_view name, const Cells& cells, std::size_t first) {
  if (known(name) == nullptr || cells.size() <= first || cells.size() - first > kMostColumnsOfOne) return;
  Columns& columns = columns_[std::string(name)];
  columns.clear();
  for (std::size_t k = first; k < cells.size(); ++k) columns.emplace_back(bare(cells[k]));
}

/// As the log says them, or as the firmwares had them: with the instance behind the time from 4.1 on.
const CsvLong::Columns* CsvLong::columns_of(std::string_view name, const Cells& cells, std::uint64_t offset) {
  const auto found = columns_.find(name);
  if (found != columns_.end()) return &found->second;
  const bool is_imu = name.substr(0, 3) == "IMU";
  double instance = 0.0;
  const bool has_instance = (name == "IMU" || name == "ACC") && cells.size() > 2 &&
                            parse_number(cells[2], '.', instance) == CellKind::number && instance >= 0.0 &&
                            instance < kMostInstances && cells[2].find('.') == std::string_view::npos;
  Columns columns = {"TimeUS"};
  if (has_instance) columns.emplace_back("I");
  if (!is_imu) columns.emplace_back("SampleUS");
  if (is_imu) columns.insert(columns.end(), {"GyrX", "GyrY", "GyrZ"});
  columns.insert(columns.end(), {"AccX", "AccY", "AccZ"});
  if (notes_.wanted(CsvTroubleKind::guess, offset))
    notes_.say(offset, "nothing before it says the columns of " + std::string(name) + ", they are taken for TimeUS, " +
                           columns[1] + ", " + columns[2] + " and so on");
  return &columns_.emplace(std::string(name), std::move(columns)).first->second;
}

void CsvLong::reading(std::string_view name, const Columns& columns, const Cells& cells, std::uint64_t offset,
                      std::uint64_t number) {
  const Known& message = *known(name);
  const auto time_ns = time_in(cells, columns);
  if (!time_ns) {
    if (notes_.wanted(CsvTroubleKind::time, offset))
      notes_.say(offset,
                 "line " + std::to_string(number) + ": " + std::string(name) + " has no time, the line is left out");
    return;
  }
  const double stated = number_in(cells, columns, "I");
  int instance = message.instance >= 0 ? message.instance : 0;
  if (message.instance < 0 && stated >= 0.0) instance = static_cast<int>(std::min<double>(stated, kMostInstances));
  if (instance >= kMostInstances || stated < 0.0) {
    if (notes_.wanted(CsvTroubleKind::source, offset))
      notes_.say(offset, "line " + std::to_string(number) + ": no chip has this instance, the line is left out");
    return;
  }
  ImuSource source;
  source.name = std::string(message.source) + "[" + std::to_string(instance) + "]";
  source.instance = instance;
  ImuRecord record;
  record.specific_force_mps2 = axes_in(cells, columns, "AccX", "AccY", "AccZ");
  record.rate_radps = axes_in(cells, columns, "GyrX", "GyrY", "GyrZ");
  record.temperature_degc = number_in(cells, columns, "T");
  if (!(record.temperature_degc > -300.0)) record.temperature_degc = number_in(cells, columns, "Temp");
  records_.take(source, *time_ns, record, offset, number);
}

void CsvLong::parameter(const Cells& cells) {
  const auto is_name = [](std::string_view text) {
    return !text.empty() && text.size() <= 16 && std::all_of(text.begin(), text.end(), [](char c) {
      return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
  };
  double value = 0.0, time = 0.0;
  for (std::size_t k = 1; k + 1 < cells.size() && k <= 2; ++k) {  // the first ones had no time
    if (parse_number(cells[k], '.', time) == CellKind::number || !is_name(bare(cells[k]))) continue;
    if (parse_number(cells[k + 1], '.', value) == CellKind::number) sink_.parameter(std::string(bare(cells[k])), value);
    return;
  }
}

void CsvLong::keyed(std::string_view name, std::string_view content, std::uint64_t offset, std::uint64_t number) {
  Cells pairs, values;
  Columns keys;
  split(content, ',', pairs);
  for (const std::string_view pair : pairs) {
    const std::size_t colon = pair.find(':');
    if (colon == std::string_view::npos || keys.size() == kMostColumnsOfOne) continue;
    keys.emplace_back(bare(pair.substr(0, colon)));
    values.push_back(pair.substr(colon + 1));
  }
  if (name == "PARM") {
    const auto at = std::find(keys.begin(), keys.end(), "Name");
    const double value = number_in(values, keys, "Value");
    if (at == keys.end() || !(value - value <= 0.0)) return;
    const std::string figure = std::to_string(value);
    return parameter({name, values[static_cast<std::size_t>(at - keys.begin())], figure});
  }
  if (known(name) != nullptr) reading(name, keys, values, offset, number);
}

void CsvLong::take(std::string_view line, bool is_whole, std::uint64_t offset, std::uint64_t number) {
  std::string_view content;
  const std::string_view key = keyed_name(line, content);
  if (!key.empty()) return keyed(key, content, offset, number);
  const std::string_view name = bare(line.substr(0, std::min(line.find(','), line.size())));
  const bool is_format = name == "FMT";
  if (!is_format && name != "PARM" && known(name) == nullptr) return;
  if (!is_whole) {
    if (notes_.wanted(CsvTroubleKind::line, offset))
      notes_.say(offset,
                 "line " + std::to_string(number) + ": the last line has no end and may be cut, it is left out");
    return;
  }
  split(line, ',', cells_);
  if (is_format) {
    if (cells_.size() > 5) define(bare(cells_[3]), cells_, 5);
    return;
  }
  if (name == "PARM") return parameter(cells_);
  double value = 0.0;
  const bool is_header = cells_.size() > 4 && parse_number(cells_[1], '.', value) == CellKind::text &&
                         parse_number(cells_[4], '.', value) == CellKind::text;
  if (is_header) return define(name, cells_, 1);
  const Columns* columns = columns_of(name, cells_, offset);
  cells_.erase(cells_.begin());
  reading(name, *columns, cells_, offset, number);
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
