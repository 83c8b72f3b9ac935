// What is different where the log is a ULog that plumb wrote.
#include <array>

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

/// By its first bytes. No more is asked for than a text has that begins like one: a live stream is not held back.
LogReader::State::Kind LogReader::State::kind_of_log() {
  const auto begins_with = [this](const unsigned char* bytes, std::size_t length) {
    for (std::size_t k = 1; k <= length; ++k) {
      const unsigned char* const at = source.peek(k);
      if (at == nullptr || at[k - 1] != bytes[k - 1]) return false;
    }
    return true;
  };
  constexpr std::array<unsigned char, 5> kPlogMagic = {0x89, 'P', 'L', 'O', 'G'};
  if (begins_with(kUlogMagic.data(), kUlogMagic.size())) return Kind::ulog;
  return begins_with(kPlogMagic.data(), kPlogMagic.size()) ? Kind::plog : Kind::text;
}

FileExpected<void> LogReader::State::read_binary_header(const std::string& file) {
  FileExpected<UlogRows> rows = UlogRows::open(source, path);
  if (!rows) return tl::unexpected<FileError>(rows.error());
  binary.emplace(*std::move(rows));
  if (file != "-") binary->map(file);
  use_seconds_and_metres();
  std::size_t numbers = 0;
  for (const UlogColumn& column : binary->header().columns) {
    header.push_back(column.name);
    number_place.push_back(column.constant ? kNoColumn : numbers++);
  }
  return {};
}

/// What the array file says in the unit of a CSV, in that of a ULog.
void LogReader::State::use_seconds_and_metres() {
  for (ColumnFilter& filter : input.where) {
    bool timed = filter.column == input.time_column;
    for (const std::string& column : input.clock_columns) timed = timed || filter.column == column;
    if (timed) filter.number *= input.time_unit_s;
    if (filter.column == input.depth_column) filter.number *= input.depth_unit_m;
  }
  input.time_unit_s = 1.0;
  input.depth_unit_m = 1.0;
}

/// That what the log says of its columns is what the array file takes them for. A column without a unit is believed.
FileExpected<void> LogReader::State::check_unit(std::size_t column, const std::string& wanted, const char* key) const {
  if (column == kNoColumn) return {};
  const UlogColumn& found = binary->header().columns[column];
  if (found.constant || found.text.empty() || found.text == wanted) return {};
  return tl::unexpected<FileError>(
      FileError{path, 0, found.name,
                "is in " + in_quotes(found.text) + " according to the log and in " + in_quotes(wanted) +
                    " according to the array file",
                std::string("correct ") + key + " in the array file, or correct the unit in the recorder"});
}

FileExpected<void> LogReader::State::check_binary() const {
  FileExpected<void> done = check_unit(time, "s", "[input] time");
  if (done) done = check_unit(temperature, "degC", "[input] temperature");
  if (done) done = check_unit(depth, "m", "[input] depth");
  for (std::size_t k = 0; k < rates.size() && done; ++k) done = check_unit(rates[k], "rad/s", "[input] rotation_radps");
  for (std::size_t k = 0; k < second_rates.size() && done; ++k)
    done = check_unit(second_rates[k], "rad/s", "[input] second_rotation_radps");
  for (std::size_t k = 0; k < clocks.size() && done; ++k) done = check_unit(clocks[k], "s", "[[clock]] time");
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
  const UlogRows::Status status = binary->next_block();
  statistics.bytes = binary->bytes();
  statistics.hash = binary->hash();
  switch (status) {
    case UlogRows::Status::end: return Got::end;
    case UlogRows::Status::failed: error = io_failure(source.error_number()); return Got::error;
    case UlogRows::Status::damaged:
      index += binary->rows_lost();
      return note_bad(binary->rows_lost(), FileError{path, 0, "", binary->what(), kCopyAgain});
    case UlogRows::Status::lost: return note_bad(1, FileError{path, 0, "", binary->what(), kCopyAgain});
    case UlogRows::Status::row: break;
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
