#include "plausible.hpp"

#include <cmath>

#include "plumb/health/detail/publish.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// A vector computed anew from the same numbers, by whichever compiler.
constexpr double kRounding_mps2 = 1e-9;

bool same_coefficients(const SensorModel& a, const SensorModel& b) noexcept {
  for (size_t i = 0; i < static_cast<size_t>(a.size); ++i) {
    if (a.sensor[i].scale != b.sensor[i].scale || a.sensor[i].bias != b.sensor[i].bias) return false;
  }
  return true;
}

/// What a recalibration leaves alone: it changes scale and bias, and the terms in temperature only along with the
/// scale.
bool same_temperature_terms(const SensorModel& now, const SensorModel& was) noexcept {
  constexpr double kRounding = 1e-9;
  const auto near = [](double a, double b) { return std::fabs(a - b) <= kRounding * std::fabs(b); };
  for (size_t i = 0; i < static_cast<size_t>(now.size); ++i) {
    const double length = now.sensor[i].scale[0] / was.sensor[i].scale[0];
    for (size_t k = 1; k < 4; ++k) {
      if (!near(now.sensor[i].scale[k], length * was.sensor[i].scale[k])) return false;
      if (!near(now.sensor[i].bias[k] * length, was.sensor[i].bias[k])) return false;
    }
  }
  return true;
}

bool same_rows(const SensorArray& a, const SensorArray& b) noexcept {
  for (int i = 0; i < a.size(); ++i) {
    if (a.axis(i) != b.axis(i) || a.sigma_mps2(i) != b.sigma_mps2(i)) return false;
  }
  return true;
}

bool same_uncertainty(const RowUncertainty& a, const RowUncertainty& b, int sensors) noexcept {
  for (int k = 0; k < RowUncertainty::packed_size(sensors); ++k) {
    if (a.covariance[static_cast<size_t>(k)] != b.covariance[static_cast<size_t>(k)]) return false;
  }
  if (a.common_scale != b.common_scale) return false;
  for (int i = 0; i < sensors; ++i) {
    if (a.misfit_mps2[static_cast<size_t>(i)] != b.misfit_mps2[static_cast<size_t>(i)]) return false;
  }
  return true;
}

}  // namespace

bool calibration_is_plausible(const MonitorState& s, const MonitorSetup& setup) noexcept {
  const InForce& now = s.in_force;
  const MonitorConfig& config = s.settings.config;
  const bool changed = s.recalibration.adopted();
  if (changed && !now.array.uncertainty().is_covariance()) return false;
  if (!same_temperature_terms(now.model, setup.model)) return false;
  if (s.recalibration.first() != now.owes_calibration()) return false;
  const bool own = !setup.calibrated && !now.owes_calibration();
  if (own) {
    if (rank_of(now.array, now.calibrated) < 3 || !now.array.uncertainty().is_covariance()) return false;
    const SensorModel commissioned = s.recalibration.bounds().commissioned(now.model);
    const Error off = Recalibration::off_datasheet(setup.model, setup.array, commissioned, now.array, now.array.all());
    return off.code == Errc::ok && (changed || (same_coefficients(now.model, commissioned)));
  }
  if (setup.calibrated != (now.calibrated == now.array.all())) return false;
  if (now.temperature_min_degc != config.temperature_min_degc ||
      now.temperature_max_degc != config.temperature_max_degc)
    return false;
  if (!same_rows(now.array, setup.array) || !s.recalibration.bounds().commissioned_as(setup.model)) return false;
  // Where no calibration was adopted it is not another one.
  return changed || (!now.three_sensor_fit && same_coefficients(now.model, setup.model) &&
                     same_uncertainty(now.array.uncertainty(), setup.array.uncertainty(), now.array.size()));
}

bool sets_are_plausible(const MonitorState& s) noexcept {
  const SensorLedger& l = s.machine.sensors;
  SensorSet seen;
  for (const SensorSet set : {l.in_service, l.provisionally_excluded, l.excluded, l.absent}) {
    if (!(seen & set).empty()) return false;
    seen = seen | set;
  }
  return seen == s.in_force.array.all();
}

bool mode_is_plausible(const MonitorState& s) noexcept {
  const DecisionState& machine = s.machine;
  if ((s.requests.pending & ~kKeptEvents) != 0 || s.window.block.size() >= s.settings.config.window) return false;
  if (s.last.known && !(s.last.evidence.samples > 0.0)) return false;
  const bool rank_lost = s.service.size == SizeClass::rank_lost, owes = s.in_force.owes_calibration();
  if (owes && machine.mode != Mode::initial && machine.mode != Mode::failed) return false;
  // No sensor that the monitor has not calibrated serves.
  if (!owes && !s.in_force.calibrated.contains(s.monitored())) return false;
  switch (machine.mode) {
    case Mode::nominal:
    case Mode::isolated:
    case Mode::degraded: return machine.mode == mode_by_size(s.service.size) && !machine.not_yet_validated;
    case Mode::suspect: return !rank_lost;
    case Mode::recalibrating: return kRecalibrates && !rank_lost && s.recalibration.under_way();
    case Mode::initial:
      return !rank_lost && owes && machine.not_yet_validated && s.recalibration.collects(s.in_service());
    case Mode::failed: return true;
  }
  return false;
}

bool verdict_is_plausible(const MonitorState& s, const Verdict& v) noexcept {
  const SensorLedger& sensors = s.machine.sensors;
  const FaultSetScan& scan = s.diagnosis.scan();
  const bool masks = v.configured == s.in_force.array.all() && v.in_service == sensors.in_service &&
                     v.provisionally_excluded == sensors.provisionally_excluded && v.excluded == sensors.excluded &&
                     v.absent == sensors.absent;
  if (!masks || v.state != state_of(s.machine.mode)) return false;
  if (v.cause != s.last.cause || v.gravity_mps2 != s.last.gravity_mps2 || v.covariance != s.last.covariance)
    return false;
  const Validity now = validity_of(s);
  if (v.validity != now && (v.validity != Validity::held || now == Validity::invalid)) return false;
  if (v.protection_available && !scan.protection_available) return false;
  if (v.protection_level_calibrated_axes_rad != (v.protection_available ? scan.protection_rad : 0.0)) return false;
  if (v.protection_level_housing_rad != (v.protection_available ? housing_level_rad(s) : 0.0)) return false;
  if (v.validity == now && v.usable != usable_bits(s, now)) return false;
  const bool within =
      v.protection_available && v.protection_level_calibrated_axes_rad <= alert_limit_in_axes_rad(s.settings.config);
  if (!v.alert && (!within || v.validity != Validity::valid)) return false;
  if (!s.last.known) return true;
  const SetTest t = test_set(s.in_force.array, s.in_force.gravity, s.settings.limits, s.last.evidence,
                             s.in_service() & s.last.evidence.usable);
  if (!t.tested) return true;
  const Vec3 x_mps2 = times(s.settings.frame, t.x_mps2);
  for (size_t k = 0; k < 3; ++k) {
    if (!(std::fabs(v.gravity_mps2[k] - x_mps2[k]) <= kRounding_mps2 * (1.0 + norm(x_mps2)))) return false;
  }
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
