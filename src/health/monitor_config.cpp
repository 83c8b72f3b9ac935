#include "plumb/health/monitor_config.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

struct Range {
  double value, low, high;
};

/// A little more than gravity: beyond that the vector points anywhere, and no larger bound says more.
constexpr double kMostAcceleration_mps2 = 10.0;

}  // namespace

Expected<MonitorConfig> checked(const MonitorConfig& c) noexcept {
  // Order of the fields of MonitorConfig: the index in an error is the position in this list.
  const Range fields[] = {
      {static_cast<double>(c.mode), 0, 1},
      {static_cast<double>(c.window), 1, kWindowCapacity},
      {c.delta_f_mps2, 0, 10},
      {c.false_alarm_rate, 1e-9, 1e-2},
      {c.rejection_rate, 1e-12, 1e-2},
      {static_cast<double>(c.assumed_faults), -1, 3},
      {static_cast<double>(c.isolation_stations), 1, 20},
      {static_cast<double>(c.isolation_timeout), 1, 24},
      {static_cast<double>(c.passed_blocks), 1, kMostPassedBlocks},
      {static_cast<double>(c.forget_blocks), 1, 24},
      {static_cast<double>(c.probation_stations), 1, 24},
      {static_cast<double>(c.missing_confirm), 1, kMostConfirm},
      {static_cast<double>(c.max_age_samples), 0, kMostAgeSamples},
      {c.max_gap_s, 1e-6, 1e9},
      {c.max_age_s, 0, 1e9},
      {c.station_angle_rad, 1e-4, 1.5},
      {c.distinct_attitude_angle_rad, 1e-3, 1.5},
      {c.clear_fraction, 0.1, 1.0},
      {c.alert_limit_rad, 1e-6, kPi},
      {c.integrity_risk, 1e-12, 1e-1},
      {c.fault_prior, 0, 0.1},
      {0, 0, 0},  // reset_key: any
      {c.temperature_min_degc, -1e9, 1e9},
      {c.temperature_max_degc, -1e9, 1e9},
      {static_cast<double>(c.isolation_timeout_blocks), 0, kMostIsolationTimeoutBlocks},
      {static_cast<double>(c.alarm_form), 0, 1},
      {0, 0, 0},  // recalibrate_after_exclusion: either
      {static_cast<double>(c.alert_frame), 0, 1},
      {static_cast<double>(c.alignment_bound_rad), 0, kPi},
      {c.acceleration_bound_mps2, 0, c.recalibrate_after_exclusion ? 0.0 : kMostAcceleration_mps2},
      {c.triple_false_alarm_rate, 0, 1e-2},
  };
  int index = 0;
  for (const Range& f : fields) {
    if (!std::isfinite(f.value)) return fail(Errc::not_finite, index, f.value, f.low);
    if (f.value < f.low) return fail(Errc::out_of_range, index, f.value, f.low);
    if (f.value > f.high) return fail(Errc::out_of_range, index, f.value, f.high);
    ++index;
  }
  if (c.temperature_min_degc > c.temperature_max_degc) {
    return fail(Errc::out_of_range, 22, c.temperature_min_degc, c.temperature_max_degc);
  }
  return c;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
