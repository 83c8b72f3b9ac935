/// A log through the monitor of redundant gyros.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "plumb/io/array_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/motion/rate_monitor.hpp"
#include "plumb/session/group_track.hpp"
#include "plumb/session/log_run.hpp"
#include "plumb/session/rate_group.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Something changed at this sample.
struct RateEvent {
  double time_s = 0.0;
  SensorSet suspects, excluded, off_at_rest;  ///< as they are from now on
  bool turned_at_rest = false;
  bool alarm = false;  ///< readings contradict each other, and whoever is out of service does not explain it
  MotionCause cause = MotionCause::none;
};

inline constexpr double kSilent_s = 1.0;

struct RateRun : LogEnd {
  RateVerdict last;
  std::uint64_t samples = 0, samples_at_rest = 0, blocks = 0;
  SensorSet ever_excluded, ever_off_at_rest;
  SensorSet silent;       ///< no number from them for `kSilent_s` at the end
  double silent_s = 0.0;  ///< the shortest of these
  int alarms = 0;         ///< times that readings began to contradict each other
  double first_alarm_s = 0.0;
  int turned_at_rest = 0;          ///< times that this was found anew
  double turned_at_rest_s = 0.0;   ///< when first
  double worst_bound_radps = 0.0;  ///< of the means of two blocks, where they were valid
  double bound_sum_radps = 0.0;
  std::uint64_t bounded_blocks = 0;
  bool calibrated = false;
  double common = 0.0;  ///< `RateGroup::common`: in the bounds
};

/// A row of a log as `RateMonitor` takes it, force and rest not known. `model`: that of the datasheet in `array`, or
/// of its calibration.
RateSample rate_sample(const io::ArrayFile& array, const SensorModel& model, const Sample& sample);

/// Readings, axes and bounds are those of the calibration; without one of the datasheet in the array file.
///
/// Whether the tool stood still at a row is known once the block of the accelerometers ends which that row is in. Rows
/// wait for that where `waits_for_rest`: the rows of one time come before the block that ends there.
class RateWatch final : public RowTaker, public TrackListener {
 public:
  using Sink = std::function<io::FileExpected<void>(const RateEvent&)>;

  /// `array` outlives it. Errors: the monitor refuses the setup.
  static io::FileExpected<std::unique_ptr<RateWatch>> make(const io::ArrayFile& array, bool waits_for_rest,
                                                           const io::GyroCalibration* calibration = nullptr);

  void tell(Sink sink) { sinks_.push_back(std::move(sink)); }
  io::FileExpected<void> take(const stepping::Rows& rows) override;
  io::FileExpected<void> rested(const TrackPoint& block) override;
  io::FileExpected<void> moved(double until_s) override;
  /// The row that came last, whether or not it waits; and the axes that are known to have failed.
  const RateSample& newest() const noexcept { return newest_; }
  SensorSet failed() const noexcept { return run_.last.excluded | run_.last.off_at_rest; }
  const RateGroup& group() const noexcept { return group_; }
  /// Rows that still wait are taken as in motion.
  io::FileExpected<RateRun> end(LogEnd end);

 private:
  RateWatch(const io::ArrayFile& array, RateGroup group, bool waits_for_rest);
  /// Those up to this time that wait, from `rest_from_s` on at rest.
  io::FileExpected<void> step_until(double until_s, double rest_from_s);
  io::FileExpected<void> step(const RateSample& sample);
  void count(const RateVerdict& now);

  const io::ArrayFile& array_;
  RateGroup group_;
  RateMonitor monitor_;
  bool waits_;
  std::deque<RateSample> waiting_;
  RateSample newest_;
  std::vector<Sink> sinks_;
  Readings heard_s_{};
  RateRun run_;
};

/// One line of JSON, without a newline.
std::string rate_event_json(const RateEvent& event, const SensorArray& array);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
