/// What a log of a flight controller says of its accelerometers: a reader hands it on record by record, so that the
/// memory it takes does not grow with the log. One reader per format, one interface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

using Axes = std::array<double, 3>;
constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
constexpr Axes kAbsentAxes = {kAbsent, kAbsent, kAbsent};

/// What a record of a source is.
enum class RecordKind : std::uint8_t {
  sample,  ///< one reading
  mean,    ///< the mean of several: `count` and, where the log has it, `variance`
};

/// One message stream with the readings of one accelerometer chip, in the axes of the log (forward, right, down in PX4
/// and ArduPilot; those of the frame_id in ROS).
struct ImuSource {
  std::string name;             ///< of the message and its instance: "sensor_accel[1]"
  int instance = 0;             ///< counted from 0, as the log counts
  std::uint64_t device_id = 0;  ///< 0 where the log does not say
  RecordKind kind = RecordKind::sample;
  bool uncalibrated = false;  ///< readings before the calibration that is installed in the autopilot
  std::string frame_id;       ///< the axes that the readings are in, by name; empty where the log names none
};

/// What is absent is NaN, or 0 where it counts.
struct ImuRecord {
  double time_s = kAbsent;  ///< since the log's own zero
  Axes specific_force_mps2 = kAbsentAxes;
  Axes rate_radps = kAbsentAxes;  ///< of the same record, where the message has it
  double temperature_degc = kAbsent;
  std::array<std::uint32_t, 3> clipped{};  ///< samples at the end of the range since the last record
  std::uint32_t count = 1;                 ///< readings in a mean
  Axes variance_m2ps4 = kAbsentAxes;       ///< of the readings of a mean; of a sample what its driver declares
};

/// What an autopilot says of one of its accelerometers beside the readings.
struct ChipStatus {
  double time_s = kAbsent;
  std::uint64_t device_id = 0;  ///< 0: `instance` says which one
  int instance = -1;            ///< -1 beside a device_id of 0: the one that it flies by
  enum class Health : std::uint8_t { unknown, sound, failed };
  Health health = Health::unknown;
  double inconsistency_mps2 = kAbsent;  ///< from the mean of all, smoothed (PX4)
  Axes vibration_mps2 = kAbsentAxes;    ///< by its own measure (ArduPilot)
};

/// Who is told what a log holds. `source` comes before the first record of that number; numbers count from 0.
class LogSink {
 public:
  virtual ~LogSink() = default;
  virtual void source(std::size_t number, const ImuSource& source) = 0;
  virtual void record(std::size_t number, const ImuRecord& record) = 0;
  virtual void parameter(const std::string& name, double value) = 0;
  /// What is wrong with the bytes at `offset` and what was left out for it, in a sentence without an end. A reader goes
  /// on behind it where it can.
  virtual void note(std::uint64_t offset, const std::string& what) = 0;
  /// How the log was understood where it does not say so itself: a sentence without an end, before the first source.
  virtual void detected(const std::string& what) { (void)what; }
  /// May come before the source that it speaks of, or of one that the log has no readings of.
  virtual void status(const ChipStatus& status) { (void)status; }
};

/// What a reader has seen. Every count is of what could be read.
struct LogExtent {
  std::uint64_t bytes = 0;       ///< of the file
  std::uint64_t read_bytes = 0;  ///< until where it could be read
  std::uint64_t records = 0;     ///< handed on
  double dropped_s = 0.0;        ///< seconds that the logger says it lost
};

/// PX4's ULog, https://docs.px4.io/main/en/dev_log/ulog_file_format.html. Refused where it is none, or cannot be read
/// at all; what is damaged or cut short is noted, and what could be read is handed on.
io::FileExpected<LogExtent> read_ulog(const std::string& path, LogSink& sink);

/// ArduPilot's DataFlash log (.bin), read as `read_ulog` reads. It counts the clips of a chip, not of an axis: all of
/// them stand in `clipped[0]`. A reading of a unit that is not known here is absent, and that is noted.
io::FileExpected<LogExtent> read_dataflash(const std::string& path, LogSink& sink);

/// MCAP (https://mcap.dev/spec): `sensor_msgs/msg/Imu` in CDR, a source a topic, named like it. It streams forward and
/// needs no summary. Chunks may be packed with zstd or lz4; one whose check sum is wrong, or that unpacks to more than
/// 256 MiB, is left out and noted. Times are the headers'; where one is 0, the time at which the message was recorded.
/// Time 0 is a whole second, which the parameter `log_zero_unix_s` gives in seconds since 1970.
io::FileExpected<LogExtent> read_mcap(const std::string& path, LogSink& sink);

/// One SQLite file (.db3) of a bag of ROS 2, of old and new column sets: the same messages as `read_mcap`, in the order
/// in which they were recorded. Nothing is written, neither to the file nor beside it; what is in a -wal file beside it
/// is not read, and that is noted. The offset of a note is that of the page that SQLite read last.
io::FileExpected<LogExtent> read_rosbag2(const std::string& path, LogSink& sink);

/// A table of text: one row a time with columns of one chip or several, or one line a message as ArduPilot's tools
/// export DataFlash logs. Separators, decimal comma, encoding, units and the column of time are found out and told by
/// `LogSink::detected`; what had to be judged by magnitude is noted. plumb/logs/csv_log.hpp takes hints. Times are as
/// they stand in the file; those since 1970 count from a whole second as in `read_mcap`.
io::FileExpected<LogExtent> read_csv_log(const std::string& path, LogSink& sink);

/// The formats that are read here.
enum class LogFormat : std::uint8_t { ulog, dataflash, mcap, rosbag2, csv };
constexpr std::array<LogFormat, 5> kLogFormats = {LogFormat::ulog, LogFormat::dataflash, LogFormat::mcap,
                                                  LogFormat::rosbag2, LogFormat::csv};
/// "ULog", "DataFlash", "MCAP", "rosbag2", "CSV".
const char* to_string(LogFormat format) noexcept;

/// Which one a file is, by its first bytes; its name counts for nothing. Any text is taken for CSV. The error names
/// what the file is instead, where that is known: packed, a bag of ROS 1, a spreadsheet.
io::FileExpected<LogFormat> log_format(const std::string& path);

/// The one door: reads the log with the reader of its `log_format`.
io::FileExpected<LogExtent> read_log(const std::string& path, LogSink& sink);

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
