/// From a log through the monitor, as the commands and the demo alike do it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pipeline.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/health/paper_monitor.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/scenario/host_request.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Receives every sample with its verdict, in order.
class VerdictSink {
 public:
  VerdictSink() = default;
  VerdictSink(const VerdictSink&) = delete;
  VerdictSink& operator=(const VerdictSink&) = delete;
  virtual ~VerdictSink() = default;
  virtual io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) = 0;
  /// Before `take`, where the array file names a depth column; NaN where its cell says nothing.
  virtual void at_depth(double) {}
};

/// One JSON line per change (--events).
class EventsFile : public VerdictSink {
 public:
  /// `live`: flush each line, someone is reading along.
  EventsFile(io::OutputFile file, const SensorArray& array, bool live)
      : file_(std::move(file)), array_(array), live_(live) {}
  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  io::FileExpected<void> commit() { return file_.commit(); }

 private:
  io::OutputFile file_;
  const SensorArray& array_;
  bool live_;
  std::string line_;
};

/// One JSON line per block, or per sample (--verdicts, --every-sample).
class VerdictsFile : public VerdictSink {
 public:
  VerdictsFile(io::OutputFile file, const SensorArray& array, const Mat3& frame, bool every_sample, bool live)
      : file_(std::move(file)), array_(array), frame_(frame), every_sample_(every_sample), live_(live) {}
  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  io::FileExpected<void> commit() { return file_.commit(); }

 private:
  io::OutputFile file_;
  const SensorArray& array_;
  Mat3 frame_;
  bool every_sample_;
  bool live_;
  std::string line_;
};

struct MonitorRun {
  Verdict last;
  std::uint64_t samples = 0;
  std::uint64_t blocks = 0;  ///< quiet blocks, each judged once
  std::uint64_t transitions = 0;
  double last_time_s = 0.0;
  io::LogStatistics log;
  bool interrupted = false;
  bool stopped = false;  ///< the log ended in an error; what came before counts
  io::FileError stop;
};

/// A monitor with this calibration, switched on; on the heap, because at capacity 24 it is 2 MB large. Without one
/// (null) it makes its own, from the datasheet in the array file.
io::FileExpected<std::unique_ptr<HealthMonitor>> make_monitor(const io::ArrayFile& array,
                                                              const Calibration* calibration);

/// The same, gone on from the snapshot that the file holds. Errors: those of `make_monitor`; the file cannot be read;
/// the snapshot is refused, and then the message says why.
io::FileExpected<std::unique_ptr<HealthMonitor>> restore_monitor(const io::ArrayFile& array,
                                                                 const Calibration* calibration,
                                                                 const std::string& snapshot_path);

/// The same of bytes that are in memory; `name` is used in messages.
io::FileExpected<std::unique_ptr<HealthMonitor>> restore_monitor(const io::ArrayFile& array,
                                                                 const Calibration* calibration,
                                                                 const std::string& bytes, const std::string& name);

/// Puts the snapshot in its place as a whole, or not at all.
io::FileExpected<void> save_snapshot(const std::string& path, const HealthMonitor& monitor);

/// The monitor of mode = "paper". Refuses a calibration file without the paper's fits; `path` names it.
io::FileExpected<std::unique_ptr<PaperMonitor>> make_paper_monitor(const io::ArrayFile& array,
                                                                   const io::CalibrationFile& calibration,
                                                                   const std::string& path);

/// What a run needs of a monitor, whichever it is.
struct Watch {
  std::function<const Verdict&(const Sample&)> step;
  const Verdict& now;                         ///< the monitor's verdict
  std::function<void(const Rotation&)> turn;  ///< where the monitor makes use of it
};

/// Steps all samples of the log through the monitor; `run_monitor` lets `host` ask of it what it has to ask. An error
/// of the log is returned in `stop`, an error of a sink (a file that cannot be written) as the error.
io::FileExpected<MonitorRun> run_watch(const Watch& watch, const io::ArrayFile& array, const LogSpec& log,
                                       const std::vector<VerdictSink*>& sinks);

template <class Monitor>
io::FileExpected<MonitorRun> run_monitor(Monitor& monitor, const io::ArrayFile& array, const LogSpec& log,
                                         const std::vector<VerdictSink*>& sinks, scenario::Host& host) {
  const auto step = [&monitor, &host](const Sample& sample) -> const Verdict& {
    host.before(sample.time_s, monitor);
    return monitor.step(sample);
  };
  std::function<void(const Rotation&)> turn;
  if constexpr (std::is_same_v<Monitor, HealthMonitor>) {
    turn = [&monitor](const Rotation& rotation) { (void)monitor.set_rotation(rotation); };  // the reader's are finite
  }
  return run_watch({step, monitor.verdict(), turn}, array, log, sinks);
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
