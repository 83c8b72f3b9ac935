// How a monitor begins: what follows from its setup, and what it remembers before the first sample.
#include <cmath>

#include "plumb/detection/mae_test.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

constexpr double kRestlessRate = 1e-6;

/// Least k for which more than k faults among n are rarer than `risk`, each sensor faulty with `prior`.
int faults_to_cover(int n, double prior, double risk) noexcept {
  double term = 1.0;
  for (int i = 0; i < n; ++i) term *= 1.0 - prior;
  double cumulative = term;
  for (int k = 0; k < n; ++k) {
    if (1.0 - cumulative <= risk) return k < 1 ? 1 : k;
    term *= prior / (1.0 - prior) * (n - k) / (k + 1);
    cumulative += term;
  }
  return n;
}

/// A sensor that moved may have changed by its bias alone, or by its scale alone.
std::array<DriftSigmas, kCapacity> drift_sigmas(const MonitorSetup& setup) noexcept {
  std::array<DriftSigmas, kCapacity> out{};
  for (size_t a = 0; a < out.size(); ++a) {
    const Stability& s = setup.stability[a];
    const double sigma_mps2 = s.mps2 + setup.days_since_calibration * s.per_day_mps2;
    if (sigma_mps2 > 0.0) out[a] = {sigma_mps2, sigma_mps2 / setup.gravity.g_mps2};
  }
  return out;
}

}  // namespace

Expected<void> HealthMonitor::configure(const MonitorSetup& setup) noexcept {
  configured_ = false;
  core_sum_ = kNeverConfigured;
  verdict_ = Verdict{};
  const Expected<MonitorConfig> config = checked(setup.config);
  if (!config) return tl::unexpected<Error>(config.error());
  if (setup.config.mode != MonitorMode::plumb) return fail(Errc::wrong_mode, 0);
  const Expected<void> sound = checked(setup);
  if (!sound) return sound;
  set_up(setup);
  power_on(setup);
  configured_ = true;
  publish_now(Sample{}, false);  // a verdict asked for before the first sample already names the sensors
  seal();
  return {};
}

void HealthMonitor::set_up(const MonitorSetup& setup) noexcept {
  InForce& in_force = state_.in_force;
  in_force.model = setup.model;
  in_force.array = setup.array;
  in_force.gravity = setup.gravity;
  const int n = in_force.array.size();
  Settings& s = state_.settings;
  s.config = setup.config;
  s.frame = setup.output_frame;
  s.stability_stated = true;
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<size_t>(i);
    const double scale = in_force.model.scale_at(i, in_force.model.sensor[a].reference_degc);
    s.resolution_mps2[a] = static_cast<float>(std::fabs(setup.resolution_raw[a] / scale));
    s.stability[a] = StabilityNow::of(setup.stability[a], setup.days_since_calibration);
    s.stability_stated = s.stability_stated && setup.stability[a].stated();
  }
  s.lever_arm_m = setup.lever_arm_m;
  s.lever_arms_known = setup.lever_arms_known;
  s.limits =
      TestLimits::from_rates(n, s.config.false_alarm_rate, s.config.rejection_rate, s.config.acceleration_bound_mps2);
  s.scatter_factor = scatter_factor(n, s.config.window, kRestlessRate);
  derive_limits();
  s.k_integrity = normal_tail_quantile(s.config.integrity_risk / 2.0);
  s.protection_faults = faults_to_cover(n, s.config.fault_prior, s.config.integrity_risk);
  s.identity = identity(setup);
}

/// Which triples vote depends on the axes, and so do their shares of the rate; what a calibration leaves in parity
/// depends on its fit.
void HealthMonitor::derive_limits() noexcept {
  Settings& s = state_.settings;
  const SensorArray& array = state_.in_force.array;
  s.limits = s.limits.of(array);
  const double triple_rate = s.config.triple_false_alarm_rate > 0.0 ? s.config.triple_false_alarm_rate
                                                                    : triple_share(array, s.config.false_alarm_rate);
  s.mae_quantile = half_normal_mean_quantile(s.config.window, triple_rate);
}

/// Everything that is remembered, as it stands before the first sample.
void HealthMonitor::power_on(const MonitorSetup& setup) noexcept {
  MonitorState& s = state_;
  const MonitorConfig& config = s.settings.config;
  const SensorArray& array = s.in_force.array;
  s.in_force.calibrated = setup.calibrated ? array.all() : SensorSet{};
  s.in_force.temperature_min_degc = config.temperature_min_degc;
  s.in_force.temperature_max_degc = config.temperature_max_degc;
  s.in_force.three_sensor_fit = false;
  s.in_force.store_g_mps2 = s.in_force.gravity.g_mps2;
  s.machine = DecisionState{};
  s.machine.mode = setup.calibrated ? Mode::suspect : Mode::initial;
  s.machine.sensors.in_service = array.all();
  s.service.map = least_squares(array, array.all());
  s.service.size = s.classify(array.all());
  s.intake.power_on();
  s.intake.gate.configure(array.size(), setup.full_scale_raw, config.missing_confirm);
  s.window.power_on(array.triple_count(), config.window);
  s.facts.clear();
  s.last = LastBlock{};
  s.diagnosis.clear(s.in_force, array.all(), config.assumed_faults);
  s.studies.clear();
  s.requests = Requests{};
  s.freshness = Freshness{};
  s.recalibration.configure(s.in_force.model, drift_sigmas(setup), config.station_angle_rad, !setup.calibrated);
  if (s.machine.mode == Mode::initial) s.recalibration.start(array.all());
  s.counters = MonitorCounters{};
}

}  // namespace PLUMB_ABI
}  // namespace plumb
