/// A log of a tool at rest, read for the study of its noise: as an array file describes it, or any CSV with a time
/// column.
#pragma once

#include <csignal>
#include <cstdint>
#include <string>
#include <vector>

#include "plumb/io/array_file.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/noise/still_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

/// What the readings of a column are in.
struct ColumnUnit {
  std::string name;           ///< "m/s^2" for every unit of acceleration; empty: not known
  bool acceleration = false;  ///< the readings are in m/s^2; of another field in nT or rad/s
  bool sensor = true;         ///< false: the name tells of something else than an accelerometer, a gyro for example
  io::FieldKind field = io::FieldKind::gravity;
};
/// By the end of a column's name: "_mps2", "_cnt", "_V", "_radps".
ColumnUnit unit_of_name(const std::string& name);

/// "t", "time_us", "timestamp [ms]".
bool is_time_name(const std::string& name);
/// Seconds per unit of a time column, by the end of its name; 1 where that tells none.
double time_unit_of_name(const std::string& name);

struct LoadOptions {
  const io::ArrayFile* array = nullptr;  ///< null: any CSV; then the keys below say more
  std::string time_column;               ///< empty: the first whose name is one of a time
  double rate_hz = 0.0;                  ///< 0: by the time column
  std::string unit;                      ///< of all columns; empty: by their names
  std::vector<std::string> columns;      ///< names, or ids of the array file; empty: all but the time
  io::BadRowPolicy on_bad_row = io::BadRowPolicy::stop;
  const volatile std::sig_atomic_t* stop = nullptr;
};

struct LoadedLog {
  StillLog log;                   ///< its columns are named as in the array file where there is one
  std::vector<ColumnUnit> units;  ///< one a column
  std::vector<double> declared;   ///< noise that the array file states, in the unit of its column; empty: no array file
  std::string time_column;        ///< empty: by the rate
  std::vector<std::string> left_out;  ///< columns without numbers
  std::uint64_t rows_bad = 0;
  bool complete = true;  ///< false: the rest of a very long file was not read
};

/// Errors: as LogReader and read_csv_columns; no time and no rate; a column that is not there; time that does not
/// increase; rows that are stations.
io::FileExpected<LoadedLog> load_still_log(const std::string& path, const LoadOptions& options);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
