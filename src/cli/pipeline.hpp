/// The two long jobs, as the commands and the demo alike run them: a log to a calibration, and a log
/// through the monitor.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "fit_study.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/health/paper_monitor.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/scenario/host_request.hpp"
#include "second_look.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct LogSpec {
  std::string path;  ///< "-" = standard input
  io::BadRowPolicy on_bad_row = io::BadRowPolicy::stop;
  bool follow = false;  ///< at the end wait for more
};

// ---- from a log to a calibration ---------------------------------------------------------------

struct CalibrationRun {
  std::vector<Station> stations;
  io::LogStatistics log;
  int without_temperature = 0;  ///< stations left out because nothing says how hot they were
  bool interrupted = false;     ///< Ctrl-C: the stations up to then were used
  FitOptions options;
  FitReport report;
  TemperatureReport temperature;  ///< of the fit, whichever order it had
  FitStudy study;
  Error refusal;                          ///< why it was not accepted
  Concern concern = Concern::none;        ///< what exactly, where the code alone does not say
  SecondLook second_look;                 ///< what would have made the fit settle; of values that do not fit only
  std::vector<std::string> log_findings;  ///< why no still stretch was found; empty where there were some
  std::unique_ptr<Calibration> accepted;  ///< null where it was not
  /// The paper's own fits, where they were asked for and plumb's was accepted; null where they could not be made.
  std::unique_ptr<PaperCalibration> paper;
  Error paper_refusal;  ///< why there are none, or why nothing can be monitored with them

  /// Of the fit whose figures are shown: a fit that was refused early has only part of them in `report`.
  const FitReport& told() const { return study.shown ? study.shown->report : report; }
};

/// What a calibration is to be, beyond its log.
struct CalibrationChoice {
  HoldOutChoice hold_out;
  FitOptions fit;
  TemperatureOptions temperature;  ///< its own `fit` is not looked at
  bool paper_fits = false;         ///< the paper's own fits too
  /// Of the roll groups; by default the axis from which the array file has inclinations counted in results.
  std::optional<Vec3> roll_axis;
};

/// Reads the log, finds the stations (or takes the rows as stations), fits, and judges the fit. Refuses to make the
/// paper's fits for more than kPaperCapacity sensors before it reads anything.
io::FileExpected<CalibrationRun> run_calibration(const io::ArrayFile& array, const LogSpec& log,
                                                 const CalibrationChoice& choice = {});

/// Writes the accepted calibration with its provenance.
io::FileExpected<void> save_calibration(const std::string& path, const CalibrationRun& run, const io::ArrayFile& array,
                                        const std::string& log_path);

// ---- from a log through the monitor ------------------------------------------------------------

/// Receives every sample with its verdict, in order.
class VerdictSink {
 public:
  VerdictSink() = default;
  VerdictSink(const VerdictSink&) = delete;
  VerdictSink& operator=(const VerdictSink&) = delete;
  virtual ~VerdictSink() = default;
  virtual io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) = 0;
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

/// A monitor with this calibration, switched on; on the heap, because at capacity 24 it is 2 MB large.
io::FileExpected<std::unique_ptr<HealthMonitor>> make_monitor(const io::ArrayFile& array,
                                                              const Calibration& calibration);

/// The same, gone on from the snapshot that the file holds. Errors: those of `make_monitor`; the file cannot be read;
/// the snapshot is refused, and then the message says why.
io::FileExpected<std::unique_ptr<HealthMonitor>> restore_monitor(const io::ArrayFile& array,
                                                                 const Calibration& calibration,
                                                                 const std::string& snapshot_path);

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
