// What is different where the log is a binary one.
#include "log_state.hpp"
#include "plumb/io/units.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

const char* const kCopyAgain = "copy or record the log again, or run with --on-bad-row skip to skip these rows";

/// Two names of one unit, such as mg and mg0, are the same.
bool same_raw_unit(const std::string& name, const RawUnit& wanted) {
  const FileExpected<RawUnit> unit = parse_raw_unit(name);
  return unit && unit->kind == wanted.kind && unit->base_per_unit == wanted.base_per_unit;
}

}  // namespace

FileExpected<void> LogReader::State::read_binary_header(const std::string& file) {
  FileExpected<PlogRows> rows = PlogRows::open(source, path);
  if (!rows) return tl::unexpected<FileError>(rows.error());
  binary.emplace(*std::move(rows));
  if (file != "-") binary->map(file);
  std::size_t numbers = 0;
  for (const PlogColumn& column : binary->header().columns) {
    header.push_back(column.name);
    number_place.push_back(column.constant ? kNoColumn : numbers++);
  }
  return {};
}

/// That what the log says of its columns is what the array file takes them for. A column without a unit is believed.
FileExpected<void> LogReader::State::check_unit(std::size_t column, const std::string& wanted, const char* key) const {
  if (column == kNoColumn) return {};
  const PlogColumn& found = binary->header().columns[column];
  if (found.constant || found.text.empty() || found.text == wanted) return {};
  return tl::unexpected<FileError>(
      FileError{path, 0, found.name,
                "is in " + in_quotes(found.text) + " according to the log and in " + in_quotes(wanted) +
                    " according to the array file",
                std::string("correct ") + key + " in the array file, or correct the unit in the recorder"});
}

FileExpected<void> LogReader::State::check_binary() const {
  FileExpected<void> done = check_unit(time, plog_time_unit(input.time_unit_s), "[input] time_unit");
  if (done) done = check_unit(temperature, "degC", "[input] temperature");
  if (done) done = check_unit(depth, plog_depth_unit(input.depth_unit_m), "[input] depth_unit");
  for (std::size_t k = 0; k < rates.size() && done; ++k) done = check_unit(rates[k], "rad/s", "[input] rotation_radps");
  for (std::size_t k = 0; k < second_rates.size() && done; ++k)
    done = check_unit(second_rates[k], "rad/s", "[input] second_rotation_radps");
  for (std::size_t k = 0; k < clocks.size() && done; ++k)
    done = check_unit(clocks[k], plog_time_unit(input.time_unit_s), "[input] time_unit");
  for (std::size_t k = 0; k < sensors.size() && done; ++k) {
    if (!same_raw_unit(binary->header().columns[sensors[k]].text, input.unit))
      done = check_unit(sensors[k], input.unit.name, "[input] unit");
  }
  if (!done) return done;
  const double rate_hz = binary->header().rate_hz;
  if (input.rate_hz > 0.0 && rate_hz > 0.0 && rate_hz != input.rate_hz) {
    return tl::unexpected<FileError>(FileError{path, 0, "rate",
                                               "is " + shortest(rate_hz) + " Hz according to the log and " +
                                                   shortest(input.rate_hz) + " Hz according to the array file",
                                               "correct [input] rate in the array file, or the rate in the recorder"});
  }
  for (std::size_t k = 0; k < filters.size(); ++k) {
    if (input.where[k].numeric || number_place[filters[k]] == kNoColumn) continue;
    return tl::unexpected<FileError>(
        FileError{path, 0, header[filters[k]],
                  "holds numbers, and [input] where compares it with the text " + in_quotes(input.where[k].text),
                  "write the number without quotes in the array file"});
  }
  return {};
}

bool LogReader::State::matches_binary(const ColumnFilter& filter, std::size_t column) const noexcept {
  if (number_place[column] == kNoColumn) return matches(filter, binary->header().columns[column].text);
  return binary->has(number_place[column]) && binary->value(number_place[column]) == filter.number;
}

/// A row that has a number of every sensor, which is the usual one, is not asked for each.
void LogReader::State::plan_sensors() {
  for (const std::size_t column : sensors) {
    const std::size_t place = number_place[column];
    if (place == kNoColumn) return sensor_place.clear();
    sensor_place.push_back(place);
    sensor_marks |= std::uint64_t{1} << place;
  }
}

LogReader::State::Got LogReader::State::next_block() {
  const PlogRows::Status status = binary->next_block();
  statistics.bytes = binary->bytes();
  statistics.hash = binary->hash();
  switch (status) {
    case PlogRows::Status::end: return Got::end;
    case PlogRows::Status::failed: error = io_failure(source.error_number()); return Got::error;
    case PlogRows::Status::damaged:
      index += binary->rows_lost();
      return note_bad(binary->rows_lost(), FileError{path, 0, "", binary->what(), kCopyAgain});
    case PlogRows::Status::lost: return note_bad(1, FileError{path, 0, "", binary->what(), kCopyAgain});
    case PlogRows::Status::row: break;
  }
  return binary->marks_sound() ? Got::row : refuse_marks();
}

LogReader::State::Got LogReader::State::refuse_marks() {
  ++index;
  refuse(kNoColumn, "marks values in more columns than the header has");
  return note_bad(1, bad_row());
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
