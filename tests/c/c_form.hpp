/// Setups, samples and verdicts in their C form, and what tells two verdicts apart.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "plumb/c/plumb.h"
#include "plumb/health/health_monitor.hpp"

namespace c_test {

/// A setup in its C form.
struct CForm {
  explicit CForm(const plumb::MonitorSetup& setup) {
    plumb_config_defaults(&config);
    const int n = setup.array.size();
    sensor.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<std::size_t>(i);
      plumb_sensor& s = sensor[a];
      plumb_sensor_defaults(&s);
      std::memcpy(s.id, setup.array.row(i).id.data(), sizeof s.id);
      std::memcpy(s.axis, setup.array.axis(i).data(), sizeof s.axis);
      s.sigma_mps2 = setup.array.sigma_mps2(i);
      std::memcpy(s.scale, setup.model.sensor[a].scale.data(), sizeof s.scale);
      std::memcpy(s.bias_mps2, setup.model.sensor[a].bias.data(), sizeof s.bias_mps2);
      s.reference_degc = setup.model.sensor[a].reference_degc;
      s.misfit_mps2 = setup.array.uncertainty().misfit_mps2[a];
      s.full_scale_raw = setup.full_scale_raw[a];
      s.resolution_raw = setup.resolution_raw[a];
      std::memcpy(s.lever_arm_m, setup.lever_arm_m[a].data(), sizeof s.lever_arm_m);
      s.chip = setup.array.row(i).chip;
    }
    config.sensors = n;
    config.sensor = sensor.data();
    config.covariance = setup.array.uncertainty().covariance.data();
    config.common_scale = setup.array.uncertainty().common_scale;
    config.covariance_size = static_cast<std::uint32_t>(plumb::RowUncertainty::packed_size(n));
    config.gravity_mps2 = setup.gravity.g_mps2;
    config.gravity_sigma_mps2 = setup.gravity.sigma_mps2;
    config.reads = setup.model.reads == plumb::Reads::gravity ? 1 : -1;
    config.lever_arms_known = setup.lever_arms_known ? 1 : 0;
    std::memcpy(config.output_frame, setup.output_frame.data(), sizeof config.output_frame);
    config.recalibrate_after_exclusion = setup.config.recalibrate_after_exclusion ? 1 : 0;
    config.isolation_stations = setup.config.isolation_stations;
    config.acceleration_bound_mps2 = setup.config.acceleration_bound_mps2;
  }
  std::vector<plumb_sensor> sensor;
  plumb_config config{};
};

/// Storage as a caller would have it.
struct Memory {
  std::vector<std::uint64_t> storage = std::vector<std::uint64_t>(plumb_monitor_size() / 8 + 1);
  std::vector<std::uint64_t> workspace = std::vector<std::uint64_t>(plumb_workspace_size() / 8 + 1);
  plumb_monitor* monitor = nullptr;

  plumb_error init(const plumb_config* config) {
    return plumb_monitor_init(storage.data(), 8 * storage.size(), workspace.data(), 8 * workspace.size(), config,
                              &monitor);
  }
};

inline plumb_sample c_form(const plumb::Sample& s) {
  plumb_sample out;
  plumb_sample_defaults(&out);
  out.time_s = s.time_s;
  out.delivered = s.delivered.bits;
  std::memcpy(out.raw, s.raw.data(), sizeof s.raw);
  out.temperature_degc = s.temperature_degc;
  out.station = s.station;
  out.count = s.count;
  return out;
}

template <class T, class U>
bool same(const T& a, const U& b) {
  static_assert(sizeof(T) == sizeof(U), "two forms of one thing");
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// The name of the first field that differs, empty where none does.
inline std::string difference(const plumb_verdict& c, const plumb::Verdict& v) {
#define PLUMB_SAME(field) \
  if (!same(c.field, v.field)) return #field;
  PLUMB_SAME(sample)
  PLUMB_SAME(time_s)
  PLUMB_SAME(state)
  PLUMB_SAME(validity)
  PLUMB_SAME(cause)
  PLUMB_SAME(decided_by)
  PLUMB_SAME(grade)
  PLUMB_SAME(qualifiers)
  PLUMB_SAME(tick)
  PLUMB_SAME(accepted)
  PLUMB_SAME(alert)
  PLUMB_SAME(protection_available)
  PLUMB_SAME(faults_covered)
  PLUMB_SAME(wants_rotation)
  PLUMB_SAME(usable)
  PLUMB_SAME(transition.sequence)
  PLUMB_SAME(transition.from)
  PLUMB_SAME(transition.to)
  PLUMB_SAME(transition.event)
  PLUMB_SAME(transition.cause)
  PLUMB_SAME(transition.grade)
  PLUMB_SAME(transition.sensors)
  PLUMB_SAME(transition.time_s)
  PLUMB_SAME(transition.statistic)
  PLUMB_SAME(transition.limit)
  PLUMB_SAME(configured)
  PLUMB_SAME(in_service)
  PLUMB_SAME(provisionally_excluded)
  PLUMB_SAME(excluded)
  PLUMB_SAME(absent)
  PLUMB_SAME(suspects)
  PLUMB_SAME(clipped)
  PLUMB_SAME(scattering)
  PLUMB_SAME(not_finite)
  PLUMB_SAME(noisy)
  PLUMB_SAME(stuck)
  PLUMB_SAME(contradicted_clip)
  PLUMB_SAME(confirmed_grade)
  PLUMB_SAME(provisional_grade)
  PLUMB_SAME(consistent_hypotheses)
  PLUMB_SAME(stations_on_record)
  PLUMB_SAME(block_fill)
  PLUMB_SAME(statistic)
  PLUMB_SAME(limit)
  PLUMB_SAME(margin)
  PLUMB_SAME(mae_all_mps2)
  PLUMB_SAME(mae_worst_mps2)
  PLUMB_SAME(mae_worst_limit_mps2)
  PLUMB_SAME(parity)
  PLUMB_SAME(parity_limit)
  PLUMB_SAME(norm_error_mps2)
  PLUMB_SAME(reference_mps2)
  PLUMB_SAME(reference_sigma_mps2)
  PLUMB_SAME(temperature_degc)
  PLUMB_SAME(noise_factor)
  PLUMB_SAME(noise_correlation)
  PLUMB_SAME(gravity_mps2)
  PLUMB_SAME(covariance)
  PLUMB_SAME(age_s)
  PLUMB_SAME(latest_mps2)
  PLUMB_SAME(protection_level_calibrated_axes_rad)
  PLUMB_SAME(toolface_protection_housing_rad)
#undef PLUMB_SAME
  if (!same(c.recalibration_phase, v.recalibration.phase)) return "recalibration_phase";
  if (!same(c.stations_wanted, v.recalibration.stations_wanted)) return "stations_wanted";
  if (!same(c.turn_along, v.rotation.along)) return "turn_along";
  if (!same(c.turn_change_mps2, v.rotation.change_mps2)) return "turn_change_mps2";
  if (!same(c.turn_angle_rad, v.rotation.angle_rad)) return "turn_angle_rad";
  for (std::size_t i = 0; i < static_cast<std::size_t>(plumb::kCapacity); ++i) {
    if (!same(c.sensor_cause[i], v.sensor_cause[i])) return "sensor_cause";
    if (c.minimum_faults[i] != v.minimum_faults[i]) return "minimum_faults";
    if (c.drift_mps2_per_h[i] != static_cast<double>(v.drift_mps2_per_h[i])) return "drift_mps2_per_h";
  }
  return {};
}

}  // namespace c_test
