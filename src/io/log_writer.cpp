#include "plumb/io/log_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "plog_writer.hpp"
#include "plumb/io/log_reader.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// A cell that the reader takes back as the same text.
std::string cell_of(const std::string& text) {
  return text.find_first_of(", \t") == std::string::npos ? text : "\"" + text + "\"";
}

/// The cell whose product with the unit of time is exactly `time_s`: the quotient, or a neighbour.
double time_cell(double time_s, double unit_s) {
  const double quotient = time_s / unit_s;
  if (quotient * unit_s == time_s || !std::isfinite(quotient)) return quotient;
  for (const double towards : {-HUGE_VAL, HUGE_VAL}) {
    const double neighbour = std::nextafter(quotient, towards);
    if (neighbour * unit_s == time_s) return neighbour;
  }
  return quotient;
}

/// Of a clock; empty where the column is another one's already: two clocks may share a column, and it may be the log's.
std::string own_clock_column(const InputSpec& input, std::size_t clock) {
  const std::string& column = input.clock_columns[clock];
  bool taken = column == input.time_column;
  for (std::size_t c = 0; c < clock; ++c) taken = taken || input.clock_columns[c] == column;
  return taken ? std::string() : column;
}

bool is_binary(const std::string& path) {
  constexpr std::string_view kEnding = ".plog";
  return path.size() > kEnding.size() && path.compare(path.size() - kEnding.size(), kEnding.size(), kEnding) == 0;
}

/// The numbers of a row as they are put down one after the other, in the order of the columns.
class Cells {
 public:
  Cells(std::string& line, PlogWriter* binary) : line_(line), binary_(binary) { line_.clear(); }

  void number(bool present, double value) {
    if (binary_ != nullptr) return binary_->put(present, value);
    comma();
    if (present) append_shortest(line_, value);
  }
  void whole(std::int64_t value) {
    if (binary_ != nullptr) return binary_->put(true, static_cast<double>(value));
    char text[24];
    comma();
    line_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  }
  /// The header of a binary log holds what is the same in all rows.
  void constant(const std::string& text) {
    if (binary_ != nullptr) return;
    comma();
    line_ += cell_of(text);
  }

 private:
  void comma() {
    if (!first_) line_ += ',';
    first_ = false;
  }
  std::string& line_;
  PlogWriter* binary_;
  bool first_ = true;
};

}  // namespace

ClockTimes clock_times(const std::vector<double>& clock_s) noexcept {
  ClockTimes out = kNoClockTimes;
  std::copy_n(clock_s.begin(), std::min(clock_s.size(), out.size()), out.begin());
  return out;
}

LogWriter::LogWriter(OutputFile file, const InputSpec& input, Columns columns) : file_(std::move(file)), input_(input) {
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
  header += '\n';
  return file_.write(header);
}

FileExpected<void> LogWriter::begin_binary() {
  PlogHeader header;
  const auto add = [&header](const std::string& name, const std::string& unit) {
    if (!name.empty()) header.columns.push_back(PlogColumn{name, false, unit});
  };
  add(input_.time_column, plog_time_unit(input_.time_unit_s));
  add(input_.station_column, "");
  add(input_.roll_group_column, "");
  add(input_.count_column, "");
  add(input_.temperature_column, "degC");
  add(input_.depth_column, plog_depth_unit(input_.depth_unit_m));
  for (const ColumnFilter& filter : input_.where)
    header.columns.push_back(PlogColumn{filter.column, true, filter.text});
  for (const std::string& column : input_.rotation_columns) add(column, "rad/s");
  for (const std::string& column : input_.second_rotation_columns) add(column, "rad/s");
  for (std::size_t c = 0; c < input_.clock_columns.size(); ++c)
    add(own_clock_column(input_, c), plog_time_unit(input_.time_unit_s));
  for (const std::string& column : input_.sensor_columns) add(column, input_.unit.name);
  if (input_.time_column.empty()) header.rate_hz = input_.rate_hz;
  if (const std::string misfit = plog_misfit(header); !misfit.empty()) {
    return tl::unexpected<FileError>(FileError{file_.path(), 0, "", misfit, "write a CSV (a name that ends in .csv)"});
  }
  binary_ = std::make_unique<PlogWriter>(header);
  return binary_->begin(file_);
}

FileExpected<LogWriter> LogWriter::create(const std::string& path, const ArrayFile& array, Columns columns) {
  FileExpected<OutputFile> file = OutputFile::create(path, OutputFile::Mode::stream);
  if (!file) return tl::unexpected<FileError>(file.error());
  LogWriter writer(*std::move(file), array.input, columns);
  writer.choose_constants();
  const FileExpected<void> begun = is_binary(path) ? writer.begin_binary() : writer.begin_csv();
  if (!begun) return tl::unexpected<FileError>(begun.error());
  return writer;
}

FileExpected<void> LogWriter::write(const Sample& sample, const Notes& notes) {
  Cells cells(line_, binary_.get());
  if (!input_.time_column.empty()) cells.number(true, time_cell(sample.time_s, input_.time_unit_s));
  if (!input_.station_column.empty()) cells.whole(label_of_tag(sample.station));
  if (!input_.roll_group_column.empty()) cells.whole(label_of_tag(sample.roll_group));
  if (!input_.count_column.empty()) cells.whole(static_cast<std::int64_t>(sample.count));
  if (!input_.temperature_column.empty()) cells.number(!notes.temperature_held, sample.temperature_degc);
  if (!input_.depth_column.empty()) cells.number(std::isfinite(notes.depth_m), notes.depth_m / input_.depth_unit_m);
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
    cells.number(std::isfinite(time_s), time_cell(time_s, input_.time_unit_s));
  }
  for (std::size_t i = 0; i < input_.sensor_columns.size(); ++i) {
    cells.number(sample.delivered.has(static_cast<int>(i)), sample.raw[i]);
  }
  if (binary_ != nullptr) return binary_->end_row(file_);
  line_ += '\n';
  return file_.write(line_);
}

FileExpected<void> LogWriter::commit() {
  const FileExpected<void> done = binary_ ? binary_->finish(file_) : FileExpected<void>();
  return done ? file_.commit() : done;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
