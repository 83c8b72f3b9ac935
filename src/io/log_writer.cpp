#include "plumb/io/log_writer.hpp"

#include <charconv>
#include <cmath>
#include <utility>

#include "plumb/io/log_reader.hpp"

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

}  // namespace

LogWriter::LogWriter(OutputFile file, const InputSpec& input) : file_(std::move(file)), input_(input) {}

FileExpected<LogWriter> LogWriter::create(const std::string& path, const ArrayFile& array) {
  FileExpected<OutputFile> file = OutputFile::create(path, OutputFile::Mode::stream);
  if (!file) return tl::unexpected<FileError>(file.error());
  LogWriter writer(*std::move(file), array.input);
  std::string& header = writer.line_;
  const auto add = [&header](const std::string& name) {
    if (name.empty()) return;
    if (!header.empty()) header += ',';
    header += cell_of(name);
  };
  const InputSpec& input = writer.input_;
  add(input.time_column);
  add(input.station_column);
  add(input.roll_group_column);
  add(input.count_column);
  add(input.temperature_column);
  add(input.depth_column);
  // A filter on a column that has a role already is satisfied, or not, by the samples themselves.
  std::vector<ColumnFilter> constant;
  for (const ColumnFilter& filter : input.where) {
    bool taken = filter.column == input.time_column || filter.column == input.station_column ||
                 filter.column == input.roll_group_column || filter.column == input.count_column ||
                 filter.column == input.temperature_column || filter.column == input.depth_column;
    for (const std::string& column : input.sensor_columns) taken = taken || filter.column == column;
    if (!taken) constant.push_back(filter);
  }
  for (const ColumnFilter& filter : constant) add(filter.column);
  for (const std::string& column : input.sensor_columns) add(column);
  header += '\n';
  writer.input_.where = std::move(constant);
  const FileExpected<void> written = writer.file_.write(header);
  if (!written) return tl::unexpected<FileError>(written.error());
  return writer;
}

FileExpected<void> LogWriter::write(const Sample& sample) {
  line_.clear();
  bool first = true;
  const auto comma = [this, &first] {
    if (!first) line_ += ',';
    first = false;
  };
  const auto whole = [this, &comma](std::int64_t value) {
    char text[24];
    comma();
    line_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  };
  if (!input_.time_column.empty()) {
    comma();
    append_shortest(line_, time_cell(sample.time_s, input_.time_unit_s));
  }
  if (!input_.station_column.empty()) whole(label_of_tag(sample.station));
  if (!input_.roll_group_column.empty()) whole(label_of_tag(sample.roll_group));
  if (!input_.count_column.empty()) whole(static_cast<std::int64_t>(sample.count));
  if (!input_.temperature_column.empty()) {
    comma();
    append_shortest(line_, sample.temperature_degc);
  }
  if (!input_.depth_column.empty()) comma();  // a Sample has none
  for (const ColumnFilter& filter : input_.where) {
    comma();
    line_ += cell_of(filter.text);
  }
  for (std::size_t i = 0; i < input_.sensor_columns.size(); ++i) {
    comma();
    if (sample.delivered.has(static_cast<int>(i))) append_shortest(line_, sample.raw[i]);
  }
  line_ += '\n';
  return file_.write(line_);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
