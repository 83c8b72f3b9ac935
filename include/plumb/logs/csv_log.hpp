/// Readings of accelerometers in tables of text, as people have them.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "plumb/io/file_error.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

/// What is known of a table beforehand, and is then not looked for in it.
struct CsvHints {
  char separator = 0;  ///< ',', ';', '\t', '|', or ' ' for any number of blanks and tabs; 0: it is found out
  char decimal = 0;    ///< '.' or ','; 0: it is found out
  /// Seconds in one count of the column of time: 1, 1e-3, 1e-6 or 1e-9. NaN: it is found out.
  double time_unit_s = std::numeric_limits<double>::quiet_NaN();
  /// m/s^2 in one count of the readings: 9.80665 for g. NaN: it is found out.
  double force_unit_mps2 = std::numeric_limits<double>::quiet_NaN();
  /// Of a table without a column of time. NaN: a table without one is refused.
  double rate_hz = std::numeric_limits<double>::quiet_NaN();
  /// Names in place of the header of the file: "time_s", "ax [m/s^2]", ... Empty: the file has one.
  std::vector<std::string> header;
};

/// As `read_csv_log` of flight_log.hpp. Hints that contradict the file are an error.
io::FileExpected<LogExtent> read_csv_log(const std::string& path, const CsvHints& hints, LogSink& sink);

/// As `read_log` of flight_log.hpp; of a log that is no table the hints are not looked at.
io::FileExpected<LogExtent> read_log(const std::string& path, const CsvHints& table, LogSink& sink);

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
