#include "plumb/calibration/acceptance.hpp"

#include <cmath>

#include "fit_internal.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

constexpr double kTogether = 2.0;

Judgement refuse(Concern concern, Errc code, int index, double value, double limit) noexcept {
  return {Error{code, index, value, limit}, concern};
}

/// Of the misfit that one sensor causes.
double allowed_of(const DatasheetSensor& s, const AcceptanceLimits& limits) noexcept {
  return std::fmin(limits.odd_bias_share * s.prior.bias_mps2, limits.odd_sample_sigmas * s.row.sigma_mps2);
}

Judgement judge_level(const Datasheet& datasheet, const LevelMisfit& level, const AcceptanceLimits& limits) noexcept {
  if (level.sensor < 0 || level.sensor >= datasheet.size) return {};
  const double allowed = allowed_of(datasheet.sensor[at(level.sensor)], limits), mean = std::fabs(level.mean_mps2);
  if (!(mean > allowed)) return {};
  return refuse(Concern::level_of_a_sensor, Errc::poor_fit, level.sensor, mean, allowed);
}

}  // namespace

const char* to_string(Concern concern) noexcept {
  switch (concern) {
    case Concern::none: return "none";
    case Concern::gravity: return "gravity";
    case Concern::common_scale: return "common_scale";
    case Concern::inconsistent_sensor: return "inconsistent_sensor";
    case Concern::parity: return "parity";
    case Concern::hold_out: return "hold_out";
    case Concern::hold_out_claim: return "hold_out_claim";
    case Concern::roll_axis: return "roll_axis";
    case Concern::level_of_a_sensor: return "level_of_a_sensor";
  }
  return "unknown";
}

Judgement judge_gravity(const GravityReference& gravity) noexcept {
  const double g = gravity.g_mps2;
  const bool magnetic = gravity.model == GravityModel::magnetic;
  const double least = magnetic ? kLeastField : kEarthGravityMin_mps2;
  const double most = magnetic ? kMostField : kEarthGravityMax_mps2;
  // Written so that a NaN is refused too.
  if (!(g >= least)) return refuse(Concern::gravity, Errc::implausible, -1, g, least);
  if (!(g <= most)) return refuse(Concern::gravity, Errc::implausible, -1, g, most);
  return {};
}

Judgement judge_odd_sensor(const Datasheet& datasheet, const OddSensor& odd, const AcceptanceLimits& limits) noexcept {
  if (odd.sensor < 0 || odd.sensor >= datasheet.size) return {};
  const double allowed = allowed_of(datasheet.sensor[at(odd.sensor)], limits);
  if (!(odd.with_mps2 > allowed)) return {};
  return refuse(Concern::inconsistent_sensor, Errc::poor_fit, odd.sensor, odd.with_mps2, allowed);
}

Judgement judge(const Datasheet& datasheet, const GravityReference& gravity, const Calibration& calibration,
                const HoldOut& held_out, const OddSensor& odd, const AcceptanceLimits& limits) noexcept {
  const Judgement earth = judge_gravity(gravity);
  if (earth.error.code != Errc::ok) return earth;
  // Before the rest: what one sensor spoils shows everywhere.
  const Judgement alone = judge_odd_sensor(datasheet, odd, limits);
  if (alone.error.code != Errc::ok) return alone;
  const Judgement level = judge_level(datasheet, calibration.report.level_misfit, limits);
  if (level.error.code != Errc::ok) return level;
  const CommonTurn& turn = calibration.report.common_turn;
  if (turn.sigmas() > limits.max_common_turn_sigmas && turn.sensor < 0) {
    return refuse(Concern::roll_axis, Errc::implausible, -1, turn.rad, limits.max_common_turn_sigmas * turn.sigma_rad);
  }
  const CommonScale& common = calibration.report.common_scale;
  if (std::fabs(common.sigmas()) > limits.max_common_scale_sigmas &&
      std::fabs(common.mean) > kTogether * common.scatter) {
    return refuse(Concern::common_scale, Errc::implausible, -1, common.mean,
                  limits.max_common_scale_sigmas * common.sigma);
  }
  const double parity = calibration.report.parity_rms_mps2;
  const double most_parity = residual_bound_mps2(limits.max_parity_rms_mps2, calibration.report);
  if (!(parity <= most_parity)) return refuse(Concern::parity, Errc::poor_fit, -1, parity, most_parity);
  if (held_out.judged == 0) return {};
  const double missed = std::fmax(held_out.norm_rms_mps2, held_out.parity_rms_mps2);
  const double most_missed = residual_bound_mps2(limits.max_hold_out_mps2, calibration.report);
  if (!(missed <= most_missed)) return refuse(Concern::hold_out, Errc::poor_fit, -1, missed, most_missed);
  if (!(held_out.sigmas <= limits.max_hold_out_sigmas)) {
    return refuse(Concern::hold_out_claim, Errc::poor_fit, -1, held_out.sigmas, limits.max_hold_out_sigmas);
  }
  return {};
}

}  // namespace PLUMB_ABI
}  // namespace plumb
