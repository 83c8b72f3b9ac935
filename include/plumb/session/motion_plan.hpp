/// From an array file and a calibration to the set-up of a monitor of motion, or to the key that is missing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/core/sample.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/motion/continuous_inclination.hpp"
#include "plumb/session/group_rates.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Sigmas of what calibration leaves that count as a bound in motion: the factor of `plumb::commission`.
inline constexpr double kMotionSigmas = 3.0;

/// Chips with clocks of their own: those of [[clock]] in their order, then that of the log where anything is left to
/// it.
struct ClockPlan {
  ClockSetup setup;
  std::vector<std::string> name;  ///< in reports
  std::size_t stated = 0;         ///< in the array file
};

struct MotionPlan {
  SensorArray array;  ///< calibrated; with clocks of chips those of `with_clocks`, as the set-up
  SensorModel model;
  MotionSetup setup;
  std::optional<ClockPlan> clocks;              ///< where the file states one
  std::optional<GroupRates> rates;              ///< where a group of gyros gives the rate (`[gyro] group`)
  std::optional<InclinationSetup> inclination;  ///< where the file bounds the velocity
  std::array<double, kCapacity> clip_raw{};     ///< from here on a reading counts as clipped; infinite: nowhere
};

/// The bounds that an array file leaves to calibration and stability.
struct DerivedBounds {
  double scale = 0.0, axis_rad = 0.0, bias_mps2 = 0.0;
};
/// Of one sensor: three sigma of what calibration leaves of each (docs/array-file.md, *Motion*), and the tolerance of
/// its stability within the temperatures of the calibration, in full in bias and scale.
DerivedBounds derived_bounds(const io::ArrayFile& array, const Calibration& calibration, int sensor, double days);

/// Why motion is not judged is the error: which keys are missing, or what cannot be done. To be asked where
/// `array.motion.mentioned`. Without a calibration (null) the nominal coefficients count, and scale, axis and bias must
/// be bounded by keys. `days` since the calibration. Where a log in motion was fitted (`commissioned`), its lever arms
/// count with their bounds, and its other bounds where the array file states none. The inclination is that in the
/// housing by `alignment_bound_rad` of the monitor, as `findings::with_alignment` sets it. `gyros`: those of the group
/// that `[gyro] group` names, where they are watched over the same rows; null: they are not.
io::FileExpected<MotionPlan> plan_motion(const io::ArrayFile& array, const Calibration* calibration, double days,
                                         const io::MotionCalibration* commissioned = nullptr,
                                         const RateGroup* gyros = nullptr);

/// Rows of a log as samples in motion: calibrated, and clipped where they are at full scale. Rates of rotation are left
/// to the caller.
class MotionSampler {
 public:
  /// `plan` outlives it.
  explicit MotionSampler(const MotionPlan& plan) noexcept
      : plan_(plan), temperature_degc_(plan.model.sensor[0].reference_degc) {}
  /// Where the temperature is not a number, the last one that was counts, as at rest.
  MotionSample sample(const Sample& row) noexcept;

 private:
  const MotionPlan& plan_;
  double temperature_degc_;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
