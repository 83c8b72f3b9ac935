/// Writes the log that `LogReader` reads with the same array file, bit for bit: a CSV, or a ULog, the log of PX4, which
/// other tools open as well.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "plumb/core/sample.hpp"
#include "plumb/health/rotation.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/output_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

class UlogWriter;

/// One a [[clock]] of the array file.
using ClockTimes = std::array<double, static_cast<std::size_t>(kMotionClocks)>;
/// No chip with a clock of its own has delivered anything.
inline constexpr ClockTimes kNoClockTimes = [] {
  ClockTimes out{};
  for (double& time_s : out) time_s = std::numeric_limits<double>::quiet_NaN();
  return out;
}();
/// What `LogReader::clock_s` says, for a row that is written.
ClockTimes clock_times(const std::vector<double>& clock_s) noexcept;

class LogWriter {
 public:
  enum class Columns : std::uint8_t {
    samples,  ///< all but the rates of turn and the times of chips
    all,      ///< these too, where the array file names them
    tool,     ///< these, and the sensors of the other groups of the tool
  };
  enum class Form : std::uint8_t {
    by_name,  ///< a path that ends in ".ulg" or ".ulog" becomes a ULog, any other a CSV; ".plog" is refused
    csv,
    ulog,
  };
  /// What a row says beyond its sample.
  struct Notes {
    bool temperature_held = false;                              ///< of the row before: the cell becomes empty
    Rotation rotation;                                          ///< with Columns::all
    double depth_m = std::numeric_limits<double>::quiet_NaN();  ///< not finite: the cell stays empty
    Rotation second_rotation{};                                 ///< by the second gyro
    ClockTimes clock_s = kNoClockTimes;                         ///< NaN: the cell stays empty
    const Sample* groups = nullptr;                             ///< with Columns::tool: one a group of the array file
  };

  /// Columns: time, station, count, temperature, depth (those that [input] names), the columns of `where` with
  /// their values, the rates of turn, the times of chips with clocks of their own, then the sensors. Without a time
  /// column the time is left to the reader.
  static FileExpected<LogWriter> create(const std::string& path, const ArrayFile& array,
                                        Columns columns = Columns::samples, Form form = Form::by_name);

  LogWriter(LogWriter&& other) noexcept;
  LogWriter& operator=(LogWriter&& other) noexcept;
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;
  ~LogWriter();

  /// A channel that is not in `sample.delivered` becomes an empty cell. Values must be in the log's unit.
  FileExpected<void> write(const Sample& sample) { return write(sample, Notes{}); }
  FileExpected<void> write(const Sample& sample, const Notes& notes);
  FileExpected<void> commit();

 private:
  LogWriter(OutputFile file, const ArrayFile& array, Columns columns);
  void choose_constants();
  FileExpected<void> begin_csv();
  FileExpected<void> begin_ulog();

  OutputFile file_;
  InputSpec input_;  ///< `where` without what has a role already, rates of turn only where they are written
  std::vector<InputSpec> groups_;  ///< with Columns::tool
  std::string line_;
  std::unique_ptr<UlogWriter> ulog_;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
