/// A monitor of motion beside the monitor at rest, over the same rows: the sensors that rest left in service go to it
/// before every sample, what it found goes to rest before the next one, and is forgotten where rest has judged.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "plumb/io/motion_records.hpp"
#include "plumb/motion/motion_monitor.hpp"
#include "plumb/session/monitor_pipeline.hpp"
#include "plumb/session/motion_feed.hpp"
#include "plumb/session/motion_inputs.hpp"
#include "plumb/session/motion_plan.hpp"
#include "plumb/session/rate_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

inline constexpr std::size_t kMotionCauses = 7;

/// What a run showed in motion.
struct MotionRun {
  std::uint64_t samples = 0;  ///< rows, or common instants where chips have clocks of their own
  std::uint64_t judged = 0;   ///< of them those with enough redundancy, a known rotation and a regular clock
  std::uint64_t alarms = 0;   ///< how often one began
  std::uint64_t in_alarm = 0;
  double first_alarm_s = 0.0;
  std::uint64_t gyro_disagreements = 0;            ///< how often the two gyros began to disagree
  double gyros_disagree_s = 0.0;                   ///< the first time
  SensorSet suspects, isolated, excluded;          ///< at any time
  std::array<double, kCapacity> isolated_at_s{};   ///< the first time
  std::array<double, kCapacity> excluded_at_s{};   ///< the first time
  std::array<std::uint64_t, kMotionCauses> why{};  ///< samples by cause
  /// Blocks of 32 samples with a bound of their force; of them those whose bound holds while no further unit fails,
  /// and while the only gyro is healthy.
  std::uint64_t blocks = 0, blocks_unchecked = 0, blocks_by_one_gyro = 0;
  double bound_sum_mps2 = 0.0, worst_bound_mps2 = 0.0, worst_bound_at_s = 0.0;
  std::array<std::uint64_t, kForceTerms> dominant{};  ///< those blocks, by the largest part of their bound
  /// Windows with an inclination, and how often there was none for another reason than before; the last of each.
  std::uint64_t inclinations = 0, inclination_breaks = 0;
  InclinationInterval inclination, no_inclination;
  bool rates_of_group = false;  ///< the rate is that of a group of gyros, one for all of them
  MotionInputs inputs;          ///< its steps are those of what was judged, its rates as they were delivered
  std::vector<ClockRun> clocks;
  MotionVerdict last;

  std::uint64_t samples_with(MotionCause cause) const noexcept { return why[static_cast<std::size_t>(cause)]; }
};

/// Receives every sample's verdict with what changed.
class MotionSink {
 public:
  MotionSink() = default;
  MotionSink(const MotionSink&) = delete;
  MotionSink& operator=(const MotionSink&) = delete;
  virtual ~MotionSink() = default;
  virtual io::FileExpected<void> take(double time_s, const MotionVerdict& verdict,
                                      const std::vector<io::MotionEvent>& events) = 0;
  /// Where a window of the inclination has ended, or why there is none has changed.
  virtual io::FileExpected<void> take_inclination(const InclinationInterval&) { return {}; }
};

class MotionWatch final : public VerdictSink {
 public:
  /// `plan` is one of `plan_motion`, which the monitor takes.
  explicit MotionWatch(const MotionPlan& plan);

  void tell(MotionSink& sink) { sinks_.push_back(&sink); }
  /// Of a plan with `rates`: each row of `gyros` comes before the row of the same time here. It outlives the watch.
  void take_rates_of(const RateWatch& gyros) { gyros_ = &gyros; }
  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  void at_turn(const stepping::Turn& turn) override;
  void at_second_turn(const stepping::Turn& turn) override;
  void at_clocks(const std::vector<double>& clock_s) override { clock_s_ = clock_s; }
  const stepping::Found* found_in_motion() const override { return &found_; }
  const MotionRun& run() const noexcept { return run_; }

 private:
  MotionSample row_of(const Sample& sample);
  void add_group_rate(MotionSample& row);
  io::FileExpected<void> judge(const MotionSample& sample);
  void note_events(const MotionVerdict& before, const MotionVerdict& now, double time_s);
  void count(const MotionVerdict& verdict, double time_s);
  io::FileExpected<void> follow_inclination(const MotionSample& sample, const MotionVerdict& verdict);

  MotionPlan plan_;
  std::unique_ptr<MotionMonitor> monitor_;
  std::optional<ContinuousInclination> inclination_;
  MotionSampler sampler_;
  MotionFeed feed_;
  const RateWatch* gyros_ = nullptr;
  MotionInputsWatch inputs_;
  std::array<std::optional<stepping::Turn>, kGyros> turn_{};  ///< of the sample to come, by gyro
  std::vector<double> clock_s_;                               ///< likewise, one a [[clock]]
  std::vector<io::MotionEvent> events_;                       ///< of the sample at hand
  std::vector<MotionSink*> sinks_;
  stepping::Found found_;
  MotionRun run_;
};

/// One CSV row per sample (--motion).
class MotionFile final : public MotionSink {
 public:
  static io::FileExpected<std::unique_ptr<MotionFile>> create(const std::string& path, const SensorArray& array,
                                                              const Mat3& frame, bool live);
  io::FileExpected<void> take(double time_s, const MotionVerdict& verdict,
                              const std::vector<io::MotionEvent>& events) override;
  io::FileExpected<void> commit() { return file_.commit(); }

 private:
  MotionFile(io::OutputFile file, const SensorArray& array, const Mat3& frame, bool live)
      : file_(std::move(file)), array_(array), frame_(frame), live_(live) {}

  io::OutputFile file_;
  const SensorArray& array_;
  Mat3 frame_;
  bool live_;
  std::string line_;
};

/// One CSV row per window of the inclination (--inclination).
class InclinationFile final : public MotionSink {
 public:
  static io::FileExpected<std::unique_ptr<InclinationFile>> create(const std::string& path, bool live);
  io::FileExpected<void> take(double, const MotionVerdict&, const std::vector<io::MotionEvent>&) override { return {}; }
  io::FileExpected<void> take_inclination(const InclinationInterval& interval) override;
  io::FileExpected<void> commit() { return file_.commit(); }

 private:
  InclinationFile(io::OutputFile file, bool live) : file_(std::move(file)), live_(live) {}

  io::OutputFile file_;
  bool live_;
  std::string line_;
};

/// The events among the lines of another file (--events, --json).
class MotionEvents final : public MotionSink {
 public:
  MotionEvents(EventsFile& file, const SensorArray& array) : file_(file), array_(array) {}
  io::FileExpected<void> take(double time_s, const MotionVerdict& verdict,
                              const std::vector<io::MotionEvent>& events) override;

 private:
  EventsFile& file_;
  const SensorArray& array_;
  std::string line_;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
