/// Convergence is not acceptance: whether a fit may be adopted, judged on rank and residual (the fit itself), held-out
/// stations, physical bounds, and on what a wrong gravity or a faulty sensor in the set would look like. The bounds
/// leave room for real tools, whose residuals exceed pure noise: that excess is estimated and carried (misfit).
#pragma once

#include <cstdint>

#include "plumb/calibration/cross_check.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Where the length of gravity lies on Earth, from mountain tops to ten kilometres of borehole, with margin.
inline constexpr double kEarthGravityMin_mps2 = 9.74;
inline constexpr double kEarthGravityMax_mps2 = 9.87;

struct AcceptanceLimits {
  double max_common_scale_sigmas = 4.0;   ///< `CommonScale::sigmas`: implausible beyond; 4 % for four sensors of 2 %
  double told_common_scale_sigmas = 1.0;  ///< reported beyond it
  /// `CommonTurn::sigmas`, of a turn that no single axis explains better: implausible beyond it. By chance the nominal
  /// axes of a right roll axis lie so far off in exp(-8), 3 of 10 000 tools.
  double max_common_turn_sigmas = 4.0;
  double told_common_turn_sigmas = 2.0;  ///< reported beyond it: so do 14 of 100 tools with a right roll axis
  double max_parity_rms_mps2 =
      0.05;  ///< this and the next: or `kResidualNoiseSigmas` sigmas of the means of the stations
  double max_hold_out_mps2 = 0.05;   ///< norm or parity rms of stations not used
  double max_hold_out_sigmas = 3.0;  ///< rms of what was predicted, in sigmas that the fit claims
  /// A sensor that stands out is refused where the misfit that it causes, or its mean residual at a temperature level,
  /// exceeds this part of its bias prior, or this many sigmas of a sample, whichever is less.
  double odd_bias_share = 0.05;
  double odd_sample_sigmas = 3.0;
};

/// What exactly was refused, beside the code.
enum class Concern : std::uint8_t {
  none,
  gravity,
  common_scale,
  inconsistent_sensor,
  parity,
  hold_out,
  hold_out_claim,
  roll_axis,         ///< or the frame in which it was stated
  level_of_a_sensor  ///< `LevelMisfit`
};
const char* to_string(Concern concern) noexcept;

struct Judgement {
  Error error;  ///< ok: accepted
  Concern concern = Concern::none;
};

/// Judges what `calibrate` let pass. `held_out.judged` = 0 means that no station was held out: not judged by it.
/// Errors: implausible (gravity: value = g; common scale: value = mean change, limit = the bound on it; roll axis:
/// value = common turn, limit = the bound on it; index -1) and poor_fit (odd sensor: index = sensor, value = misfit
/// with it, limit = what is allowed; level of a sensor: index = sensor, value = mean residual, limit = what is allowed;
/// parity, hold-out: index -1).
Judgement judge(const Datasheet& datasheet, const GravityReference& gravity, const Calibration& calibration,
                const HoldOut& held_out, const OddSensor& odd, const AcceptanceLimits& limits = {}) noexcept;

/// The sensor that stands out, on its own: for a fit that did not settle.
Judgement judge_odd_sensor(const Datasheet& datasheet, const OddSensor& odd,
                           const AcceptanceLimits& limits = {}) noexcept;

/// Before any fit: a length of gravity that is not the Earth's. Calibrating against it would put the error into every
/// scale factor.
Judgement judge_gravity(const GravityReference& gravity) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
