#include "plumb/noise/load_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "plumb/io/csv_columns.hpp"
#include "plumb/io/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

constexpr double kNoReading = std::numeric_limits<double>::quiet_NaN();

tl::unexpected<io::FileError> refuse(std::string file, std::string field, std::string what, std::string remedy,
                                     io::ExitCode code = io::ExitCode::invalid_input) {
  return tl::unexpected<io::FileError>(
      io::FileError{std::move(file), 0, std::move(field), std::move(what), std::move(remedy), code});
}

const char* unit_of_readings(io::FieldKind field) {
  switch (field) {
    case io::FieldKind::gravity: return "m/s^2";
    case io::FieldKind::magnetic: return "nT";
    case io::FieldKind::rate: return "rad/s";
  }
  return "";
}

std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 40;
  std::string out;
  for (std::size_t k = 0; k < std::min(names.size(), kShown); ++k) out += (k > 0 ? ", " : "") + names[k];
  return names.size() > kShown ? out + ", and " + std::to_string(names.size() - kShown) + " more" : out;
}

bool chosen(const LoadOptions& options, const std::string& name) {
  return options.columns.empty() ||
         std::find(options.columns.begin(), options.columns.end(), name) != options.columns.end();
}

/// Every name of --columns is one of `names`.
io::FileExpected<void> check_columns(const std::string& path, const LoadOptions& options,
                                     const std::vector<std::string>& names) {
  for (const std::string& wanted : options.columns) {
    if (std::find(names.begin(), names.end(), wanted) == names.end())
      return refuse(path, wanted, "there is no such column", "name one of: " + joined(names), io::ExitCode::usage);
  }
  return {};
}

/// The column of the time; csv.names.size() where there is none.
std::size_t time_place(const LoadOptions& options, const io::CsvColumns& csv) {
  for (std::size_t c = 0; c < csv.names.size(); ++c) {
    if (options.time_column.empty() ? is_time_name(csv.names[c]) : csv.names[c] == options.time_column) return c;
  }
  return csv.names.size();
}

/// Times in seconds, which increase: a row whose time does not is bad, and goes with its readings.
io::FileExpected<std::vector<double>> increasing_times(const std::string& path, const LoadOptions& options,
                                                       std::size_t place, io::CsvColumns& csv) {
  const double unit_s = time_unit_of_name(csv.names[place]);
  const std::size_t rows = csv.values[place].size();
  std::size_t kept = 0;
  for (std::size_t k = 0; k < rows; ++k) {
    const double time_s = csv.values[place][k] * unit_s;
    if (std::isfinite(time_s) && (kept == 0 || time_s > csv.values[place][kept - 1])) {
      for (std::size_t c = 0; c < csv.values.size(); ++c) csv.values[c][kept] = csv.values[c][k];
      csv.values[place][kept++] = time_s;
      continue;
    }
    ++csv.rows_bad;
    if (options.on_bad_row == io::BadRowPolicy::stop)
      return refuse(path, csv.names[place],
                    "the time of row " + std::to_string(k + 1) + " below the header is " + io::shortest(time_s) +
                        " s and does not increase",
                    "correct the row, run with --on-bad-row skip, or give the sampling rate: --rate \"100 Hz\"");
  }
  for (std::vector<double>& column : csv.values) column.resize(kept);
  return std::move(csv.values[place]);
}

/// Takes the time out of the columns of a CSV.
io::FileExpected<void> find_time(const std::string& path, const LoadOptions& options, io::CsvColumns& csv,
                                 LoadedLog& out) {
  const std::size_t place = time_place(options, csv);
  out.log.rate_hz = options.rate_hz;
  if (place == csv.names.size()) {
    if (!options.time_column.empty())
      return refuse(path, options.time_column, "there is no such column of numbers",
                    "name one of: " + joined(csv.names), io::ExitCode::usage);
    if (options.rate_hz > 0.0) return {};
    return refuse(path, "", "no column is named like a time (t, time, timestamp, with a unit as in time_us)",
                  "name it with --time, or give the sampling rate: --rate \"100 Hz\"", io::ExitCode::usage);
  }
  if (!(options.rate_hz > 0.0)) {
    io::FileExpected<std::vector<double>> times = increasing_times(path, options, place, csv);
    if (!times) return tl::unexpected<io::FileError>(times.error());
    out.time_column = csv.names[place];
    out.log.time_s = *std::move(times);
  }
  csv.names.erase(csv.names.begin() + static_cast<std::ptrdiff_t>(place));
  csv.values.erase(csv.values.begin() + static_cast<std::ptrdiff_t>(place));
  return {};
}

io::FileExpected<LoadedLog> load_any_csv(const std::string& path, const LoadOptions& options) {
  std::optional<io::RawUnit> unit;
  if (!options.unit.empty()) {
    const io::FileExpected<io::RawUnit> parsed = io::parse_raw_unit(options.unit);
    if (!parsed) return refuse("--unit", "", parsed.error().what, parsed.error().remedy, io::ExitCode::usage);
    unit = *parsed;
  }
  io::FileExpected<io::CsvColumns> csv = io::read_csv_columns(path, options.on_bad_row, options.stop);
  if (!csv) return tl::unexpected<io::FileError>(csv.error());
  LoadedLog out;
  if (const io::FileExpected<void> time = find_time(path, options, *csv, out); !time)
    return tl::unexpected<io::FileError>(time.error());
  out.left_out = csv->left_out;
  out.rows_bad = csv->rows_bad;
  out.complete = csv->complete;
  if (const io::FileExpected<void> known = check_columns(path, options, csv->names); !known)
    return tl::unexpected<io::FileError>(known.error());
  for (std::size_t c = 0; c < csv->names.size(); ++c) {
    if (!chosen(options, csv->names[c])) continue;
    ColumnUnit one = unit_of_name(csv->names[c]);
    if (unit) one = {unit->name, unit->kind == io::RawUnit::Kind::acceleration, true, io::FieldKind::gravity};
    if (unit && one.acceleration) {
      one.name = "m/s^2";
      for (double& y : csv->values[c]) y *= unit->base_per_unit;
    }
    out.units.push_back(one);
    out.log.columns.push_back({csv->names[c], std::move(csv->values[c])});
  }
  if (out.log.columns.empty())
    return refuse(path, "", "there is no column of numbers but the time", "give a log with the readings of a sensor");
  return out;
}

io::FileExpected<LoadedLog> load_described_log(const std::string& path, const LoadOptions& options) {
  const io::ArrayFile& array = *options.array;
  if (array.input.rows == io::RowKind::stations)
    return refuse(array.path, "input.rows", "the rows of this log are stations, means over many samples",
                  "measure the noise on a log of single samples");
  std::vector<std::string> ids;
  ids.reserve(static_cast<std::size_t>(array.array.size()));
  for (int i = 0; i < array.array.size(); ++i) ids.emplace_back(array.array.row(i).id.data());
  if (const io::FileExpected<void> known = check_columns(path, options, ids); !known)
    return tl::unexpected<io::FileError>(known.error());
  io::FileExpected<io::LogReader> reader = io::LogReader::open(path, array, options.on_bad_row);
  if (!reader) return tl::unexpected<io::FileError>(reader.error());
  reader->stop_when(options.stop);
  LoadedLog out;
  out.time_column = array.input.time_column;
  out.log.rate_hz = array.input.rate_hz;
  std::vector<int> sensors;
  std::vector<double> raw_per_unit;
  const double unit_per_inside = io::units_of(array.field).json_per_inside;
  for (int i = 0; i < array.array.size(); ++i) {
    if (!chosen(options, ids[static_cast<std::size_t>(i)])) continue;
    sensors.push_back(i);
    raw_per_unit.push_back(array.datasheet.sensor[static_cast<std::size_t>(i)].coefficients.scale[0] / unit_per_inside);
    out.units.push_back({unit_of_readings(array.field), true, true, array.field});
    out.declared.push_back(array.array.sigma_mps2(i) * unit_per_inside);
    out.log.columns.push_back({ids[static_cast<std::size_t>(i)], {}});
  }
  Sample sample;
  io::LogReader::Next status = reader->next(sample);
  for (std::size_t rows = 0; status == io::LogReader::Next::row; status = reader->next(sample)) {
    if (++rows * sensors.size() > io::kMostCsvValues) {
      out.complete = false;
      break;
    }
    if (!out.time_column.empty()) out.log.time_s.push_back(sample.time_s);
    for (std::size_t c = 0; c < sensors.size(); ++c) {
      const bool delivered = sample.delivered.has(sensors[c]);
      out.log.columns[c].readings.push_back(
          delivered ? sample.raw[static_cast<std::size_t>(sensors[c])] / raw_per_unit[c] : kNoReading);
    }
  }
  if (status == io::LogReader::Next::error) return tl::unexpected<io::FileError>(reader->error());
  out.rows_bad = reader->statistics().rows_bad;
  return out;
}

}  // namespace

io::FileExpected<LoadedLog> load_still_log(const std::string& path, const LoadOptions& options) {
  return options.array != nullptr ? load_described_log(path, options) : load_any_csv(path, options);
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
