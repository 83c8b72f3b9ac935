/// Whether the vector of the last block at rest still speaks of the sample at hand: samples keep arriving, every sensor
/// in service delivers, and what they read now is what they read then.
#pragma once

#include <array>

#include "plumb/core/detail/flag.hpp"
#include "plumb/detection/channel_monitor.hpp"
#include "plumb/detection/set_test.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/health/monitor_config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class Freshness {
 public:
  /// So many sigmas from the block a reading of a tool at rest never is: 1e-5 per block at most, at up to 24 sensors
  /// and the longest window.
  static constexpr double kDepartureSigmas = 6.0;
  /// Without an age limit of the host's, the vector may be this old, or two blocks where these take longer [s].
  static constexpr double kLeastAge_s = 1.0;
  /// The same of the vector of one row, in roots of the trace of its covariance: 2e-5 per block at most.
  static constexpr double kVectorSigmas = 5.0;

  /// From here on nothing is known of now, until a block is at rest: at power-on, behind a gap, on a new time base.
  void lapse() noexcept { anchored_ = false; }
  /// The first sample of a block.
  void begin_block(double time_s) noexcept { block_begin_s_ = time_s; }
  /// How far a reading of each sensor may be from the mean of this block by noise: by what is expected, and by one step
  /// of the converter. What a block scatters by beyond that may be a turn that has begun, and is no noise; but of the
  /// sensors of `noisy`, whom the others contradict, it is. The mean is as good as that of `independent` samples.
  void measure(const SensorArray& array, const BlockAccumulator& block, const BlockNoise& expected, double independent,
               const std::array<float, kCapacity>& resolution_mps2, SensorSet noisy) noexcept;
  /// The block that ends at `time_s` was at rest, and its vector is published. The bound holds motion that some sensor
  /// feels by `motion_mps2` at least, whatever its direction: more than that on any one, and it may have been exceeded.
  void anchor(const MonitorConfig& config, double time_s, double motion_mps2) noexcept;
  /// The same of a block in slow motion: the bound holds `motion_mps2` of motion, as the vector of every row is then
  /// held to, with `trace` of the covariance of one row [(m/s^2)^2]; up to the end of the next block and no longer.
  void anchor_moving(const MonitorConfig& config, double time_s, double motion_mps2, double trace) noexcept;
  /// The vector of a complete row beside that of the block in slow motion.
  void compare_vectors(const Vec3& now_mps2, const Vec3& block_mps2) noexcept {
    const Vec3 away = minus(now_mps2, block_mps2);
    // Written so that what is not a number has departed.
    if (!(dot(away, away) <= most_away_mps2_ * most_away_mps2_)) departed_ = true;
  }
  /// What a reading departs by from the one movement of all, in slow motion: noise, or it hides what the others show.
  void compare_residual(int sensor, double residual_mps2) noexcept {
    const auto tolerance_mps2 = static_cast<double>(tolerance_mps2_[static_cast<std::size_t>(sensor)]);
    if (!(residual_mps2 <= tolerance_mps2 && -residual_mps2 <= tolerance_mps2)) departed_ = true;
  }
  /// One sample: the readings of `usable` beside the block's.
  void note(const SensorArray& array, SensorSet in_service, SensorSet usable, const Readings& y_mps2,
            const BlockEvidence& block) noexcept;
  /// The newest readings beside the block's, without another sample having come: of the one that ended the block.
  void compare(const SensorArray& array, SensorSet in_service, SensorSet usable, const Readings& y_mps2,
               const BlockEvidence& block) noexcept;
  /// Other sensors are in service: what each of them may feel of the motion in the bound is not known.
  void allow_no_motion() noexcept { motion_mps2_ = 0.0F; }
  /// One sample that was refused: of its time nothing is known, and of the time before it nothing new.
  void note_nothing() noexcept;
  /// One sample without a reading.
  void note_gap() noexcept;

  /// Whether the vector may be called valid now, `age_s` after its block.
  bool holds(const MonitorConfig& config, double age_s) const noexcept;

 private:
  double block_begin_s_ = 0.0;
  std::array<float, kCapacity> tolerance_mps2_{};
  double most_away_mps2_ = 0.0;  ///< of the vector of a row, in slow motion
  float motion_mps2_ = 0.0F;
  float most_age_s_ = 0.0F;    ///< of the vector
  std::uint32_t samples_ = 0;  ///< offered since that block
  std::uint32_t most_samples_ = 0;
  std::uint16_t missing_run_ = 0;  ///< of these, in a row up to now, without a sensor in service
  bool anchored_ = false;
  Flag departed_;  ///< the last row does not show that the tool is where the block had it

  friend struct FieldsOf;
  /// What a sample alone changes.
  static constexpr auto changing() noexcept {
    using F = Freshness;
    return field_list(&F::block_begin_s_, &F::samples_, &F::missing_run_, &F::departed_);
  }
  static constexpr auto core() noexcept { return field_list(&Freshness::anchored_); }
  static constexpr auto fields() noexcept {
    using F = Freshness;
    return field_list(&F::block_begin_s_, per_sensor(&F::tolerance_mps2_), &F::most_away_mps2_, &F::motion_mps2_,
                      &F::most_age_s_, &F::samples_, &F::most_samples_, &F::missing_run_, &F::anchored_, &F::departed_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
