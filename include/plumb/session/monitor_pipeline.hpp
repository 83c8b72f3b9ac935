/// From a log through the monitor, as the commands and the demo alike do it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plumb/health/health_monitor.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/paper/paper_monitor.hpp"
#include "plumb/scenario/host_request.hpp"
#include "plumb/session/detail/step_rows.hpp"
#include "plumb/session/log_run.hpp"
#include "plumb/session/log_spec.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Receives samples with their verdicts, in order: the first of the run, and at least those that it wants.
class VerdictSink {
 public:
  VerdictSink() = default;
  VerdictSink(const VerdictSink&) = delete;
  VerdictSink& operator=(const VerdictSink&) = delete;
  virtual ~VerdictSink() = default;
  virtual io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) = 0;
  virtual stepping::Wanted wanted() const { return stepping::Wanted::samples; }
  /// Before `take`, where the array file names a depth column; NaN where its cell says nothing.
  virtual void at_depth(double) {}
  /// Likewise, where it names columns with the rate of rotation.
  virtual void at_turn(const stepping::Turn&) {}
  virtual void at_second_turn(const stepping::Turn&) {}
  /// Likewise, where it states clocks of chips: what each says, one a [[clock]]; NaN: the chip has delivered nothing.
  virtual void at_clocks(const std::vector<double>&) {}
  /// What the monitor at rest is to be told before its next sample, by a sink that judges motion; null of the others.
  virtual const stepping::Found* found_in_motion() const { return nullptr; }
};

/// One JSON line per change (--events).
class EventsFile : public VerdictSink {
 public:
  /// `live`: flush each line, someone is reading along. `group`: each line says that it is of this group; empty: none
  /// does.
  EventsFile(io::OutputFile file, const SensorArray& array, bool live, std::string group = "")
      : file_(std::move(file)), array_(array), consistent_(live), group_(std::move(group)) {}
  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  stepping::Wanted wanted() const override { return stepping::Wanted::changes; }
  /// A line of somebody else, its newline to be added, among the others.
  io::FileExpected<void> put(std::string& line);
  io::FileExpected<void> commit() { return file_.commit(); }

 private:
  io::OutputFile file_;
  const SensorArray& array_;
  bool consistent_;
  std::string group_;
  std::string line_;
};

/// What somebody else has to say of a verdict.
class VerdictNote {
 public:
  VerdictNote() = default;
  VerdictNote(const VerdictNote&) = delete;
  VerdictNote& operator=(const VerdictNote&) = delete;
  virtual ~VerdictNote() = default;
  /// To the JSON object of the verdict that is taken just now: a member before its closing brace, or nothing.
  virtual void append(const Verdict& verdict, std::string& object) const = 0;
};

/// One JSON line per block, or per sample (--verdicts, --every-sample).
class VerdictsFile : public VerdictSink {
 public:
  VerdictsFile(io::OutputFile file, const SensorArray& array, const Mat3& frame, bool every_sample, bool live,
               io::FieldKind field = io::FieldKind::gravity)
      : file_(std::move(file)),
        array_(array),
        frame_(frame),
        field_(field),
        every_sample_(every_sample),
        consistent_(live) {}
  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  stepping::Wanted wanted() const override {
    return every_sample_ ? stepping::Wanted::samples : stepping::Wanted::blocks;
  }
  io::FileExpected<void> commit() { return file_.commit(); }
  void add(const VerdictNote& note) { notes_.push_back(&note); }

 private:
  io::OutputFile file_;
  const SensorArray& array_;
  Mat3 frame_;
  io::FieldKind field_;
  std::vector<const VerdictNote*> notes_;
  bool every_sample_;
  bool consistent_;
  std::string line_;
};

struct MonitorRun : LogEnd {
  Verdict last;
  std::uint64_t samples = 0;
  std::uint64_t blocks = 0;  ///< blocks at rest, each judged once
  std::uint64_t transitions = 0;
  stepping::RunCounts counts;
  double last_time_s = 0.0;
};

/// Rows through a monitor and its verdicts to the sinks, which outlive it.
class StepperRun final : public RowTaker {
 public:
  StepperRun(stepping::Stepper& stepper, const std::vector<VerdictSink*>& sinks);
  io::FileExpected<void> take(const stepping::Rows& rows) override;
  MonitorRun end(LogEnd end);

 private:
  io::FileExpected<void> step(const stepping::Rows& rows);

  stepping::Stepper& stepper_;
  const std::vector<VerdictSink*>& sinks_;
  MonitorRun run_;
  const VerdictSink* in_motion_ = nullptr;
  stepping::Wanted wanted_ = stepping::Wanted::changes;
  stepping::Said said_;
  stepping::Rows one_;
};

/// The sensors of which the array file states another noise than when the calibration was made.
SensorSet noise_changed(const io::ArrayFile& array, const Calibration& calibration);
/// The calibrated array with the noise that the array file states now, by the calibrated scale: what the sensor does
/// today counts, so that `noise` can be corrected without calibrating again. The monitors below have it.
SensorArray calibrated_array(const io::ArrayFile& array, const Calibration& calibration);
/// The same with the larger of the two noises of each sensor: for a claim about the tool, which an understated `noise`
/// must not improve.
SensorArray array_to_certify(const io::ArrayFile& array, const Calibration& calibration);

/// What a monitor with this calibration is configured with. Without one (null) it makes its own, from the datasheet in
/// the array file. `days` since the calibration was made, here and below.
io::FileExpected<std::unique_ptr<MonitorSetup>> monitor_setup(const io::ArrayFile& array,
                                                              const Calibration* calibration, double days = 0.0);

/// A monitor with this calibration, switched on; on the heap, because at capacity 24 it is 2 MB large.
io::FileExpected<std::unique_ptr<HealthMonitor>> make_monitor(const io::ArrayFile& array,
                                                              const Calibration* calibration, double days = 0.0);

/// The same, gone on from the snapshot that the file holds. Errors: those of `make_monitor`; the file cannot be read;
/// the snapshot is refused, and then the message says why.
io::FileExpected<std::unique_ptr<HealthMonitor>> restore_monitor(const io::ArrayFile& array,
                                                                 const Calibration* calibration,
                                                                 const std::string& snapshot_path, double days = 0.0);

/// The same of bytes that are in memory; `name` is used in messages.
io::FileExpected<std::unique_ptr<HealthMonitor>> restore_monitor(const io::ArrayFile& array,
                                                                 const Calibration* calibration,
                                                                 const std::string& bytes, const std::string& name,
                                                                 double days = 0.0);

/// Puts the snapshot in its place as a whole, or not at all.
io::FileExpected<void> save_snapshot(const std::string& path, const HealthMonitor& monitor);

/// The monitor of mode = "paper". Refuses a calibration file without the paper's fits; `path` names it.
io::FileExpected<std::unique_ptr<PaperMonitor>> make_paper_monitor(const io::ArrayFile& array,
                                                                   const io::CalibrationFile& calibration,
                                                                   const std::string& path);

/// The stepper for a log of this array: a monitor of the smallest build that holds it, with the setup of
/// `make_monitor`, whose outcome it shares: to be asked for only where that was made. Null where this program has none
/// of `least_capacity` or more that holds it.
std::unique_ptr<stepping::Stepper> make_stepper(const io::ArrayFile& array, const Calibration* calibration,
                                                int least_capacity = 0, double days = 0.0);

/// Steps all samples of the log. An error of the log is returned in `stop`, an error of a sink (a file that cannot be
/// written) as the error.
io::FileExpected<MonitorRun> run_stepper(stepping::Stepper& stepper, const io::ArrayFile& array, const LogSpec& log,
                                         const std::vector<VerdictSink*>& sinks);

/// Steps a monitor that somebody else keeps, and lets `host` ask of it what it has to ask.
template <class Monitor>
class HostedStepper final : public stepping::Stepper {
 public:
  HostedStepper(Monitor& monitor, scenario::Host& host) : monitor_(monitor), host_(host) {}
  void step(const stepping::Rows& rows, bool first, stepping::Wanted wanted, stepping::Said& said) override {
    stepping_detail::step_rows(monitor_, rows, first, wanted, counter_, said,
                               [this](double time_s) { host_.before(time_s, monitor_); });
  }
  void now(std::vector<std::uint8_t>& bytes) const override { stepping_detail::pack(monitor_.verdict(), bytes); }
  int capacity() const noexcept override { return kCapacity; }

 private:
  Monitor& monitor_;
  scenario::Host& host_;
  stepping_detail::RunCounter counter_;
};

template <class Monitor>
io::FileExpected<MonitorRun> run_monitor(Monitor& monitor, const io::ArrayFile& array, const LogSpec& log,
                                         const std::vector<VerdictSink*>& sinks, scenario::Host& host) {
  HostedStepper<Monitor> stepper(monitor, host);
  return run_stepper(stepper, array, log, sinks);
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
