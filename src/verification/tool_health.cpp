#include "plumb/verification/tool_health.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/io/records.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

/// A direction further than this from that of the station's first block is another attitude.
const double kSameAttitude_rad = rad_from_deg(1.0);
constexpr double kNever_s = -1.0;

/// Variance of the length of v.
double length_variance(const Vec3& v, const Mat3& covariance) {
  const double length = norm(v);
  return length > 0.0 ? std::fmax(dot(v, times(covariance, v)) / (length * length), 0.0) : 0.0;
}

/// Of the block, or of the event that it raised: a provisional exclusion at once leaves a block without an alarm.
double ratio_of(const Verdict& v) {
  const TransitionRecord& event = v.transition;
  const double raised = event.sequence != 0 && event.limit > 0.0 ? event.statistic / event.limit : 0.0;
  return std::fmax(v.limit > 0.0 ? v.statistic / v.limit : 0.0, raised);
}

void count_sensors(SensorSet which, std::array<std::uint64_t, kCapacity>& counts) {
  for (int i = 0; i < kCapacity; ++i) {
    if (which.has(i)) ++counts[static_cast<std::size_t>(i)];
  }
}

void fill(StationHealth& station, const Verdict& v, const Mat3& frame, double acceleration_mps2) {
  station.end_s = v.time_s;
  station.temperature_degc = v.temperature_degc;
  ++station.blocks;
  station.state = v.state;
  station.validity = v.validity;
  station.cause = v.cause;
  station.decided_by = v.decided_by;
  station.statistic = v.statistic;
  station.limit = v.limit;
  station.gravity_mps2 = v.gravity_mps2;
  station.length_mps2 = norm(v.gravity_mps2);
  station.reference_mps2 = v.reference_mps2;
  station.length_limit_mps2 =
      acceleration_mps2 + kLengthSigmas * std::sqrt(v.reference_sigma_mps2 * v.reference_sigma_mps2 +
                                                    length_variance(v.gravity_mps2, v.covariance));
  station.tilt = tilt_of(io::in_frame(frame, v.gravity_mps2), io::covariance_in_frame(frame, v.covariance));
  station.protected_by_bound = v.protection_available;
  station.alert = v.alert;
  station.protection_calibrated_axes_rad = v.protection_level_calibrated_axes_rad;
  station.protection_housing_rad = v.protection_level_housing_rad;
  station.toolface_protection_housing_rad = v.toolface_protection_housing_rad;
  station.usable = v.usable;
  station.reference = v.norm_mismatch.kind;
  station.used = v.state == HealthState::failed ? SensorSet() : v.in_service;
  station.provisionally_excluded = v.provisionally_excluded;
  station.excluded = v.excluded;
  station.absent = v.absent;
  station.worst_validity = std::min(station.worst_validity, v.validity);
  station.worst_ratio = std::fmax(station.worst_ratio, ratio_of(v));
  station.worst_off_mps2 = std::fmax(station.worst_off_mps2, std::fabs(station.off_mps2()));
}

}  // namespace

NamedEvent named_event(const Verdict& verdict) noexcept {
  NamedEvent out;
  static_cast<TransitionRecord&>(out) = verdict.transition;
  const auto with_cause = [&verdict, &out](Cause cause) {
    SensorSet set;
    for (int i = 0; i < kCapacity; ++i) {
      if (out.sensors.has(i) && verdict.sensor_cause[static_cast<std::size_t>(i)] == cause) set = set.with(i);
    }
    return set;
  };
  out.noisy = verdict.noisy | with_cause(Cause::noisy);
  out.stuck = verdict.stuck | with_cause(Cause::stuck);
  out.clipped = verdict.contradicted_clip | with_cause(Cause::clipped);
  return out;
}

const char* to_string(Colour colour) noexcept {
  switch (colour) {
    case Colour::green: return "green";
    case Colour::orange: return "orange";
    case Colour::red: return "red";
  }
  return "?";
}

std::vector<StationReason> reasons_against(const StationHealth& s) {
  std::vector<StationReason> out;
  const auto when = [&out](bool holds, StationReason reason) {
    if (holds) out.push_back(reason);
  };
  const auto lacks = [&s](std::uint16_t bit) { return (s.usable & bit) == 0; };
  const double off = std::fabs(s.off_mps2());
  const bool published = s.validity == Validity::valid || s.validity == Validity::degraded;
  when(s.state == HealthState::failed, StationReason::failed);
  when(s.validity == Validity::invalid || !s.tilt.inclination_valid, StationReason::no_direction);
  when(!published && s.limit > 0.0 && s.statistic > s.limit, StationReason::alarm);
  when(s.reference == NormMismatchKind::common_bias, StationReason::common_bias);
  // Negated, so that a length that is not a number is far off.
  when(!(off <= 2.0 * s.length_limit_mps2), StationReason::length_far);
  when(off <= 2.0 * s.length_limit_mps2 && off > s.length_limit_mps2, StationReason::length);
  when(lacks(Usable::reference), StationReason::norm_mismatch);
  when(s.validity == Validity::unconfirmed || s.validity == Validity::held, StationReason::unconfirmed);
  when(s.validity == Validity::degraded, StationReason::degraded);
  when(s.validity == Validity::valid && !s.protected_by_bound, StationReason::no_bound);
  when(s.validity == Validity::valid && s.protected_by_bound && s.alert, StationReason::wide_bound);
  when(lacks(Usable::temperature), StationReason::temperature);
  when(lacks(Usable::calibration), StationReason::calibration);
  when(s.worst_validity < s.validity, StationReason::changed);
  return out;
}

Colour colour_of(const StationHealth& station) {
  const std::vector<StationReason> reasons = reasons_against(station);
  if (reasons.empty()) return Colour::green;
  return reasons.front() <= StationReason::last_red ? Colour::red : Colour::orange;
}

void ToolHealth::take(const Sample& sample, const Verdict& verdict, double depth_m) {
  if (extremes_.samples == 0) {
    extremes_.first_s = sample.time_s;
    extremes_.off_at_s = extremes_.ratio_at_s = kNever_s;
  }
  ++extremes_.samples;
  extremes_.last_s = sample.time_s;
  if (!verdict.accepted) ++extremes_.refused;
  if (std::isfinite(depth_m)) depth_m_ = depth_m;
  if ((verdict.qualifiers & Qualifier::moving) != 0) moved_ = true;
  if (verdict.transition.sequence != 0) {
    events_.push_back(named_event(verdict));
    ++changes_;
  }
  take_extremes(sample, verdict);
  if (verdict.tick) take_block(sample, verdict);
  last_ = verdict;
}

bool ToolHealth::begins_station(const Sample& sample, const Vec3& direction) const {
  if (stations_.empty() || each_block_ || sample.station != tag_) return true;
  if (sample.station != 0) return false;  // the log knows
  return moved_ || angle_between_rad(direction, direction_) > kSameAttitude_rad;
}

void ToolHealth::take_block(const Sample& sample, const Verdict& verdict) {
  if ((verdict.usable & Usable::vector) != 0 && (verdict.usable & Usable::stationary) == 0) {
    moved_ = true;  // in slow motion: a direction, and no station
    return;
  }
  if (begins_station(sample, verdict.gravity_mps2)) {
    StationHealth fresh;
    fresh.label = sample.station == 0 ? -1 : static_cast<std::int64_t>(sample.station) - 1;
    fresh.begin_s = verdict.time_s;
    stations_.push_back(fresh);
    direction_ = verdict.gravity_mps2;
    tag_ = sample.station;
  }
  StationHealth& station = stations_.back();
  fill(station, verdict, frame_, acceleration_mps2_);
  station.depth_m = depth_m_;
  station.changes += changes_;
  changes_ = 0;
  moved_ = false;
}

void ToolHealth::take_extremes(const Sample& sample, const Verdict& v) {
  RunExtremes& e = extremes_;
  if (std::isfinite(sample.temperature_degc)) {
    e.temperature_min_degc =
        std::fmin(e.temperature_known ? e.temperature_min_degc : HUGE_VAL, sample.temperature_degc);
    e.temperature_max_degc =
        std::fmax(e.temperature_known ? e.temperature_max_degc : -HUGE_VAL, sample.temperature_degc);
    e.temperature_known = true;
  }
  e.temperature_rate_degc_per_min =
      std::fmax(e.temperature_rate_degc_per_min, std::fabs(v.temperature_rate_degc_per_min));
  if (!v.tick) return;
  ++e.blocks;
  const double off = std::fabs(norm(v.gravity_mps2) - v.reference_mps2);
  if (off > e.off_mps2) {
    e.off_mps2 = off;
    e.off_at_s = v.time_s;
  }
  if (ratio_of(v) > e.ratio) {
    e.ratio = ratio_of(v);
    e.ratio_at_s = v.time_s;
  }
  e.mae_mps2 = std::fmax(e.mae_mps2, v.mae_worst_mps2);
  if (v.protection_available) {
    e.protection_calibrated_axes_rad =
        std::fmax(e.protection_calibrated_axes_rad, v.protection_level_calibrated_axes_rad);
    e.protection_housing_rad = std::fmax(e.protection_housing_rad, v.protection_level_housing_rad);
  }
  count_sensors(v.clipped, e.clipped);
  count_sensors(v.scattering, e.scattering);
  count_sensors(v.not_finite, e.not_finite);
}

int ToolHealth::count(Colour colour) const {
  return static_cast<int>(std::count_if(stations_.begin(), stations_.end(),
                                        [colour](const StationHealth& s) { return colour_of(s) == colour; }));
}

SurveyUse ToolHealth::use() const {
  if (stations_.empty() || last_.state == HealthState::failed || last_.validity == Validity::invalid)
    return SurveyUse::no;
  switch (colour_of(stations_.back())) {
    case Colour::green: break;
    case Colour::orange: return SurveyUse::orientation_only;
    case Colour::red: return SurveyUse::no;
  }
  // The station was good; what came after it may not be.
  const bool trusted = last_.state == HealthState::nominal || last_.state == HealthState::isolated;
  return trusted && doubt_.empty() ? SurveyUse::yes : SurveyUse::orientation_only;
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
