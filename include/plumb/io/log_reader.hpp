/// Streaming reader of CSV logs, from a file or from standard input ("-").
///
/// First row: column names. Cells of a sensor: empty = the channel did not deliver; nan or inf = it
/// delivered a value that is not finite; both are counted and are not bad rows. A bad row (text in a
/// number, too few or too many cells, time that does not increase) is named by line and column and
/// skipped or ends the run. Values stay in the unit of the log (InputSpec::unit), correctly rounded.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plumb/core/sample.hpp"
#include "plumb/health/rotation.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// --on-bad-row
enum class BadRowPolicy : std::uint8_t { stop, skip };

/// Station and roll group columns <-> Sample::station and roll_group. 0 means "none" in a Sample but is a common first
/// label in logs, so every label v >= 0 becomes the tag v + 1; an empty cell or -1 means none.
constexpr std::uint32_t tag_of_label(std::int64_t label) noexcept {
  return label < 0 || label >= 0xFFFFFFFFLL ? 0U : static_cast<std::uint32_t>(label + 1);
}
constexpr std::int64_t label_of_tag(std::uint32_t tag) noexcept { return static_cast<std::int64_t>(tag) - 1; }

struct LogStatistics {
  static constexpr std::size_t kBadRowsKept = 20;

  std::uint64_t rows = 0;                             ///< delivered as samples
  std::uint64_t rows_bad = 0;                         ///< skipped as bad (with BadRowPolicy::stop: 0 or 1)
  std::uint64_t rows_filtered = 0;                    ///< not selected by [input] where
  std::uint64_t temperature_held = 0;                 ///< rows without a temperature, which got the one before
  std::array<std::uint64_t, kCapacity> missing{};     ///< empty cells per sensor
  std::array<std::uint64_t, kCapacity> not_finite{};  ///< nan or inf per sensor
  /// First number of each sensor's column, and which sensors have had another one since.
  std::array<double, kCapacity> first_value{};
  SensorSet varied;
  std::vector<FileError> bad_rows;  ///< the first kBadRowsKept of them
  double first_time_s = 0.0;
  double last_time_s = 0.0;
  std::uint64_t bytes = 0;  ///< read so far
  std::uint64_t hash = 0;   ///< FNV-1a of these bytes where `LogReader::hash_bytes` was asked for
};

class LogReader {
 public:
  enum class Next : std::uint8_t { row, end, error };

  /// Opens the file and reads the header row. Errors: unreadable, empty, a column missing or named twice.
  static FileExpected<LogReader> open(const std::string& path, const ArrayFile& array, BadRowPolicy policy);

  /// One reader an array, over one pass of the bytes: each stands where it has read to, and standard input serves them
  /// all. They are read by one thread, and a reader that is no longer read is destroyed: the others keep for it what
  /// they read.
  static FileExpected<std::vector<LogReader>> open(const std::string& path, const std::vector<const ArrayFile*>& arrays,
                                                   BadRowPolicy policy);

  LogReader(LogReader&& other) noexcept;
  LogReader& operator=(LogReader&& other) noexcept;
  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;
  ~LogReader();

  /// The next sample; `end` at the end of the input, `error` at a bad row under BadRowPolicy::stop, when
  /// reading fails, or at the end of a log without a single usable row.
  Next next(Sample& sample);
  /// How the tool turned at the sample delivered last, where the log says so (InputSpec::rotation_columns): an empty
  /// cell, nan or inf means that it turns at a rate that is not known.
  const Rotation& rotation() const noexcept;
  /// The same by the second gyro.
  const Rotation& second_rotation() const noexcept;
  /// What the clocks of the chips say there, one a [[clock]] of the array file; NaN: its chip has delivered nothing.
  const std::vector<double>& clock_s() const noexcept;
  /// Measured depth at the sample delivered last [m]; NaN where the log does not say.
  double depth_m() const noexcept;
  const FileError& error() const noexcept;
  const LogStatistics& statistics() const noexcept;
  /// Line of the sample delivered last.
  int line() const noexcept;

  /// Hash the bytes as they pass (for the provenance of a calibration). Call before the first `next`.
  void hash_bytes();
  /// At the end of the file wait for the rows that are appended to it, until `stop_when`. A row is taken once its line
  /// has ended.
  void follow();
  /// Treat the input as ended once *flag != 0, also while waiting on a pipe, provided the handler that
  /// sets it was installed by sigaction without SA_RESTART.
  void stop_when(const volatile std::sig_atomic_t* flag);

 private:
  struct State;
  explicit LogReader(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

/// All rows of a log at once.
struct LogContent {
  std::vector<Sample> samples;
  LogStatistics statistics;
};
FileExpected<LogContent> read_log(const std::string& path, const ArrayFile& array, BadRowPolicy policy);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
