#include "plumb/io/log_reader.hpp"
#include "plumb/scenario/count_text.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "csv.hpp"
#include "log_state.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

std::string shown_path(const std::string& path) { return path == "-" ? "standard input" : path; }

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 40;
  if (names.size() <= kShown) return joined(names);
  return joined({names.begin(), names.begin() + kShown}) + ", and " + std::to_string(names.size() - kShown) + " more";
}

}  // namespace

bool matches(const ColumnFilter& filter, std::string_view cell) noexcept {
  if (!filter.numeric) return bare_cell(cell) == filter.text;
  double value = 0.0;
  return parse_cell(cell, value) == CellKind::number && value == filter.number;
}

FileError LogReader::State::io_failure(int error_number) const {
  FileError out;
  out.file = path;
  out.line = error_number == EMSGSIZE ? line + 1 : 0;
  out.what = error_number == EMSGSIZE ? "a line is longer than 16 MB"
                                      : std::string("cannot be read: ") + system_message(error_number);
  out.remedy = "check the path and the permissions";
  if (error_number == EISDIR) out.remedy = "name a file, not a directory";
  if (error_number == EMSGSIZE) out.remedy = "give a CSV file: text with one row a line";
  return out;
}

FileExpected<void> LogReader::State::read_header() {
  std::string_view text;
  do {
    const LineSource::Status status = source.next(text);
    if (status == LineSource::Status::failed) return tl::unexpected<FileError>(io_failure(source.error_number()));
    if (status == LineSource::Status::end) {
      return tl::unexpected<FileError>(
          FileError{path, 0, "", "the log is empty", "give a CSV file with a header row that names the columns"});
    }
    ++line;
    if (line == 1 && text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  } while (trimmed(text).empty());
  cells.resize(static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1);
  cells.resize(split_cells(text, cells));
  bool numbers = true;
  for (const std::string_view cell : cells) {
    double value = 0.0;
    numbers = numbers && parse_cell(cell, value) == CellKind::number;
    header.emplace_back(bare_cell(cell));
  }
  if (numbers) {
    return tl::unexpected<FileError>(FileError{path, line, "",
                                               "the first row holds numbers; it must hold the column names",
                                               "add a header row, for example: t_s," + joined(input.sensor_columns)});
  }
  return {};
}

FileExpected<std::size_t> LogReader::State::column_of(const std::string& name, const std::string& role) const {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) {
    std::string remedy = did_you_mean(name, header) + "columns present: " + listed(header);
    if (header.size() == 1 && header[0].find_first_of(";\t") != std::string::npos) {
      remedy = "separate the cells by commas (this file seems to use " +
               std::string(header[0].find(';') != std::string::npos ? "semicolons" : "tabs") + ")";
    }
    return tl::unexpected<FileError>(FileError{
        path, line, name, "the column is missing in the log; " + role + " in the array file names it", remedy});
  }
  if (std::find(found + 1, header.end(), name) != header.end()) {
    return tl::unexpected<FileError>(
        FileError{path, line, name, "two columns have this name", "rename or remove one of them"});
  }
  return static_cast<std::size_t>(found - header.begin());
}

FileExpected<void> LogReader::State::map_columns() {
  struct Wanted {
    const std::string& name;
    const char* role;
    std::size_t& place;
  };
  const Wanted wanted[] = {{input.time_column, "input.time", time},
                           {input.station_column, "input.station", station},
                           {input.roll_group_column, "input.roll_group", roll_group},
                           {input.count_column, "input.count", count},
                           {input.temperature_column, "input.temperature", temperature},
                           {input.depth_column, "input.depth", depth}};
  for (const Wanted& one : wanted) {
    if (one.name.empty()) continue;
    const FileExpected<std::size_t> column = column_of(one.name, one.role);
    if (!column) return tl::unexpected<FileError>(column.error());
    one.place = *column;
  }
  for (const ColumnFilter& filter : input.where) {
    const FileExpected<std::size_t> column = column_of(filter.column, "input.where");
    if (!column) return tl::unexpected<FileError>(column.error());
    filters.push_back(*column);
  }
  for (const std::string& name : input.rotation_columns) {
    const FileExpected<std::size_t> column = column_of(name, "input.rotation_radps");
    if (!column) return tl::unexpected<FileError>(column.error());
    rates.push_back(*column);
  }
  for (const std::string& name : input.second_rotation_columns) {
    const FileExpected<std::size_t> column = column_of(name, "input.second_rotation_radps");
    if (!column) return tl::unexpected<FileError>(column.error());
    second_rates.push_back(*column);
  }
  for (std::size_t c = 0; c < input.clock_columns.size(); ++c) {
    const FileExpected<std::size_t> column =
        column_of(input.clock_columns[c], "clock[" + std::to_string(c + 1) + "].time");
    if (!column) return tl::unexpected<FileError>(column.error());
    clocks.push_back(*column);
  }
  clock_s.resize(clocks.size());
  for (std::size_t i = 0; i < input.sensor_columns.size(); ++i) {
    const FileExpected<std::size_t> column =
        column_of(input.sensor_columns[i], "sensor[" + std::to_string(i + 1) + "].column");
    if (!column) return tl::unexpected<FileError>(column.error());
    sensors.push_back(*column);
  }
  return {};
}

FileError LogReader::State::bad_row() const {
  FileError out;
  out.file = path;
  out.line = line;
  if (bad_column < header.size()) out.field = header[bad_column] + " (column " + std::to_string(bad_column + 1) + ")";
  out.what = bad_what;
  out.remedy = "correct the row, or run with --on-bad-row skip";
  if (!binary) return out;
  out.line = 0;
  out.field = "row " + std::to_string(binary->row()) + (out.field.empty() ? "" : ", ") + out.field;
  out.remedy = "record or copy the log again, or run with --on-bad-row skip";
  return out;
}

bool LogReader::State::selected() const noexcept {
  for (std::size_t k = 0; k < filters.size(); ++k) {
    if (!(binary ? matches_binary(input.where[k], filters[k]) : matches(input.where[k], cells[filters[k]])))
      return false;
  }
  return true;
}

FileError LogReader::State::nothing_usable() const {
  FileError out;
  out.file = path;
  out.line = line;
  out.what = "the log has a header but no usable row (" + std::to_string(statistics.rows_bad) + " bad, " +
             std::to_string(statistics.rows_filtered) + " not selected by [input] where)";
  out.remedy = statistics.rows_bad > 0 ? "correct the bad rows; the first is " +
                                             (binary ? statistics.bad_rows.front().field
                                                     : "line " + std::to_string(statistics.bad_rows.front().line)) +
                                             ", " + statistics.bad_rows.front().what
               : statistics.rows_filtered > 0 ? "check [input] where in the array file against the log"
                                              : "give a log with data rows";
  return out;
}

LogReader::LogReader(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
LogReader::LogReader(LogReader&& other) noexcept = default;
LogReader& LogReader::operator=(LogReader&& other) noexcept = default;
LogReader::~LogReader() = default;

const Rotation& LogReader::rotation() const noexcept { return state_->rotation; }
const std::vector<double>& LogReader::clock_s() const noexcept { return state_->clock_s; }
const Rotation& LogReader::second_rotation() const noexcept { return state_->second_rotation; }

/// Up to the first row.
FileExpected<void> LogReader::State::begin(const std::string& file) {
  const Kind kind = kind_of_log();
  if (kind == Kind::plog) {
    return tl::unexpected<FileError>(FileError{
        path, 0, "", "is a .plog, the binary log of plumb before it wrote ULog, which is read no longer",
        "write it as CSV with the plumb that wrote it: plumb convert --array ARRAY.toml --log LOG.plog --out LOG.csv"});
  }
  FileExpected<void> done = kind == Kind::ulog ? read_binary_header(file) : read_header();
  if (done) done = map_columns();
  if (!done || kind != Kind::ulog) return done;
  plan_sensors();
  return check_binary();
}

FileExpected<LogReader> LogReader::open(const std::string& path, const ArrayFile& array, BadRowPolicy policy) {
  FileExpected<std::vector<LogReader>> one = open(path, {&array}, policy);
  if (!one) return tl::unexpected<FileError>(one.error());
  return std::move(one->front());
}

FileExpected<std::vector<LogReader>> LogReader::open(const std::string& path,
                                                     const std::vector<const ArrayFile*>& arrays, BadRowPolicy policy) {
  std::vector<LogReader> out;
  for (const ArrayFile* array : arrays) {
    auto state = std::make_unique<State>();
    state->path = shown_path(path);
    state->input = array->input;
    state->policy = policy;
    const int error_number = out.empty() ? state->source.open(path) : 0;
    if (error_number != 0) return tl::unexpected<FileError>(state->io_failure(error_number));
    if (!out.empty()) state->source.open_beside(out.front().state_->source);
    out.push_back(LogReader(std::move(state)));
  }
  for (LogReader& reader : out) {
    const FileExpected<void> begun = reader.state_->begin(path);
    if (!begun) return tl::unexpected<FileError>(begun.error());
  }
  return out;
}

/// The next row of a CSV, cut into cells.
LogReader::State::Got LogReader::State::next_cells() {
  std::string_view text;
  const LineSource::Status status = source.next(text);
  statistics.bytes = source.bytes();
  statistics.hash = source.hash();
  if (status == LineSource::Status::end) return Got::end;
  if (status == LineSource::Status::failed) {
    error = io_failure(source.error_number());
    return Got::error;
  }
  ++line;
  if (trimmed(text).empty()) return Got::skipped;
  const std::size_t found = split_cells(text, cells);
  if (found == cells.size()) return Got::row;
  ++index;
  refuse(kNoColumn,
         "the row has " + count_text(found, "cell") + ", but the header has " + std::to_string(cells.size()));
  return note_bad(1, bad_row());
}

/// Counts rows that cannot be used; what follows from it.
LogReader::State::Got LogReader::State::note_bad(std::uint64_t rows, FileError why) {
  statistics.rows_bad += rows;
  error = std::move(why);
  if (statistics.bad_rows.size() < LogStatistics::kBadRowsKept) statistics.bad_rows.push_back(error);
  return policy == BadRowPolicy::stop ? Got::error : Got::skipped;
}

LogReader::Next LogReader::next(Sample& sample) {
  State& s = *state_;
  for (;;) {
    State::Got got = s.binary ? s.next_binary() : s.next_cells();
    if (got == State::Got::end) {
      if (s.statistics.rows > 0 || s.source.stopped()) return Next::end;
      s.error = s.nothing_usable();
      return Next::error;
    }
    if (got == State::Got::row && !s.filters.empty() && !s.selected()) {
      ++s.statistics.rows_filtered;
      continue;
    }
    if (got == State::Got::row) {
      ++s.index;
      if (s.fill(sample)) {
        if (s.statistics.rows++ == 0) s.statistics.first_time_s = sample.time_s;
        s.statistics.last_time_s = sample.time_s;
        return Next::row;
      }
      got = s.note_bad(1, s.bad_row());
    }
    if (got == State::Got::error) return Next::error;
  }
}

double LogReader::depth_m() const noexcept { return state_->depth_m; }
const FileError& LogReader::error() const noexcept { return state_->error; }
const LogStatistics& LogReader::statistics() const noexcept { return state_->statistics; }
int LogReader::line() const noexcept { return state_->line; }
void LogReader::hash_bytes() {
  if (state_->binary) return state_->binary->hash_bytes();
  state_->source.hash_bytes();
  state_->statistics.hash = state_->source.hash();
}
void LogReader::follow() {
  state_->source.follow();
  if (state_->binary) state_->binary->unmap();
}
void LogReader::stop_when(const volatile std::sig_atomic_t* flag) { state_->source.stop_when(flag); }

FileExpected<LogContent> read_log(const std::string& path, const ArrayFile& array, BadRowPolicy policy) {
  FileExpected<LogReader> reader = LogReader::open(path, array, policy);
  if (!reader) return tl::unexpected<FileError>(reader.error());
  reader->hash_bytes();
  LogContent out;
  Sample sample;
  LogReader::Next status = reader->next(sample);
  for (; status == LogReader::Next::row; status = reader->next(sample)) out.samples.push_back(sample);
  if (status == LogReader::Next::error) return tl::unexpected<FileError>(reader->error());
  out.statistics = reader->statistics();
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
