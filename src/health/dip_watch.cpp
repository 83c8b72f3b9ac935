#include "plumb/health/dip_watch.hpp"

#include <cmath>

#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

constexpr Mat3 transposed(const Mat3& m) noexcept { return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}; }

/// Whether the priors leave two faulty sensors or more to be covered (docs/theory.md, section 7.3): the dip covers one.
bool two_may_be_faulty(const HealthMonitor& monitor) noexcept {
  const double p = monitor.config().fault_prior;
  const int n = monitor.array().size();
  double none = 1.0;
  for (int i = 0; i < n; ++i) none *= 1.0 - p;
  return 1.0 - none * (1.0 + n * p / (1.0 - p)) > monitor.config().integrity_risk;
}

/// What the reading of sensor i may be off by beside its noise, of either sign.
double bound_of(const Verdict& v, const HealthMonitor& monitor, const MonitorSetup& setup, int i) noexcept {
  const std::size_t k = at(i);
  const SensorCoefficients& sensor = monitor.model().sensor[k];
  const double away_degc = v.temperature_degc - sensor.reference_degc;
  const bool known = std::isfinite(away_degc) && std::isfinite(v.temperature_rate_degc_per_min);
  const StabilityNow drift = StabilityNow::of(setup.stability[k], setup.days_since_calibration);
  const float tolerance = drift.tolerance_mps2(known ? away_degc : 0.0, known ? v.temperature_rate_degc_per_min : 0.0);
  return static_cast<double>(tolerance) + v.calibration.tolerance_mps2 +
         0.5 * std::fabs(setup.resolution_raw[k] / sensor.scale[0]);
}

}  // namespace

DipStation dip_station(const HealthMonitor& monitor, const MonitorSetup& setup, const FieldReading& field,
                       const FieldReference& reference) noexcept {
  DipStation out;
  const Verdict& v = monitor.verdict();
  const bool at_rest = v.tick && (v.usable & Usable::stationary) != 0;
  if (!at_rest || v.in_service.size() != 3) return out;
  const SensorArray& array = monitor.array();
  out.used = v.in_service;
  out.field = field;
  out.reference = reference;
  out.gravity = {v.reference_mps2, v.reference_sigma_mps2 + array.uncertainty().common_scale * v.reference_mps2,
                 GravityModel::value};
  out.acceleration_mps2 = monitor.config().acceleration_bound_mps2;
  // Three readings and their vector are the same thing.
  const Vec3 x_mps2 = times(transposed(setup.output_frame), v.gravity_mps2);
  const double independent = monitor.config().window / v.noise_correlation;
  for (int i = 0; i < array.size(); ++i) {
    if (!out.used.has(i)) continue;
    const double noise = array.sigma_mps2(i) * v.noise_factor / std::sqrt(independent);
    out.mean_mps2[at(i)] = dot(array.axis(i), x_mps2);
    out.sigma_mps2[at(i)] = std::sqrt(noise * noise + array.uncertainty().at(i, i, x_mps2));
    out.bound_mps2[at(i)] = bound_of(v, monitor, setup, i);
  }
  return out;
}

DipReport DipWatch::add(const HealthMonitor& monitor, const MonitorSetup& setup, const FieldReading& field,
                        const FieldReference& reference) noexcept {
  const Verdict& v = monitor.verdict();
  const DipStation station = dip_station(monitor, setup, field, reference);
  if (!station.used.empty() && station.used != used_) {
    evidence_.forget();
    used_ = station.used;
  }
  DipReport out;
  out.answer = evidence_.add(judge_dip(monitor.array(), station));
  out.gravity_mps2 = v.gravity_mps2;
  if (v.protection_available) {
    out.protection_level_calibrated_axes_rad = v.protection_level_calibrated_axes_rad;
    out.protection_level_housing_rad = v.protection_level_housing_rad;
  }
  const bool bounded = out.answer.verdict != DipVerdict::not_judged && out.answer.verdict != DipVerdict::unexplained;
  const bool smaller = !v.protection_available || out.answer.bound_rad < v.protection_level_calibrated_axes_rad;
  const bool named = out.answer.named >= 0;
  if (!bounded || v.state == HealthState::failed || two_may_be_faulty(monitor) || !(smaller || named)) return out;
  out.protected_by_dip = true;
  if (named) out.gravity_mps2 = times(setup.output_frame, out.answer.gravity_mps2);
  out.protection_level_calibrated_axes_rad = out.answer.bound_rad;
  out.protection_level_housing_rad =
      std::fmin(out.answer.bound_rad + static_cast<double>(monitor.config().alignment_bound_rad), kPi);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
