/// A finding: something that is wrong with an array, a recording or a fit, as a value. What it means to a person, and
/// what to do about it, says `render`.
///
///   for (const findings::Finding& f : findings::refusal_of(run, array))
///     std::cerr << findings::to_string(f.code) << ' ' << f.sensor << ' ' << f.value << " > " << f.limit << '\n';
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// `value` and `limit` of a finding are what was found and what would have been allowed, in the unit stated here.
enum class FindingCode : std::uint8_t {
  // Columns of the log. value = rows without a number, limit = rows.
  column_empty,
  column_not_finite,
  column_empty_or_not_finite,
  column_constant,          ///< the same number in every row that has one
  temperature_column_gaps,  ///< rows that took the temperature before
  roll_group_column_empty,  ///< at every station

  // The temperature column. value, limit = lowest and highest of the stations [degC].
  temperature_in_kelvin,          ///< too high for degC
  claimed_temperature_in_kelvin,  ///< outside what the array file claims, inside once read as kelvin
  claimed_temperature_in_fahrenheit,
  claimed_temperature_in_another_unit,

  // Why no still stretch was found in a log.
  log_too_short,        ///< value = rows, limit = least
  vector_length_wrong,  ///< value = length of the vector over gravity, median; limit = factor
  row_step_beyond_gap,  ///< [s]; every row begins anew
  noise_at_rest,        ///< [m/s^2] in the tenth of least scatter, limit = declared; other = sensors that exceed theirs
  tool_not_at_rest,     ///< nothing stands out: the tool did not rest

  // Too little was recorded.
  no_stretch_at_rest,               ///< value = rows
  too_few_stations,                 ///< value = stations, limit = needed
  undetermined,                     ///< value = rank, limit = needed
  too_few_levels,                   ///< of temperature; value = levels, limit = needed
  roll_groups_with_drift,           ///< value = order
  temperature_follows_inclination,  ///< value = rank, limit = needed, where a fit was refused for it
  undetermined_over_temperature,    ///< value = rank, limit = needed
  too_many_roll_groups,             ///< limit = most

  // Values that cannot be.
  wrong_unit,                  ///< value = length of the vector over gravity
  gravity_out_of_range,        ///< [m/s^2]
  common_scale_changed,        ///< relative change of the mean of all scale factors
  roll_axis_implausible,       ///< [rad] common turn of the axes
  duplicate_channels,          ///< sensor and other hold the same numbers
  one_of_several_implausible,  ///< value = sensors that it may be
  scale_implausible,           ///< value = times that of the datasheet, limit = relative change
  axis_implausible,            ///< [rad] from the nominal one
  bias_implausible,            ///< [m/s^2] from the datasheet
  value_implausible,           ///< of some parameter, in its own unit

  // Residuals that cannot be.
  inconsistent_sensor,           ///< without it the fit would be fine; [m/s^2] misfit with it
  residuals_follow_temperature,  ///< [m/s^2] mean residual at a level
  sensors_disagree,              ///< [m/s^2] rms of parity; sensor = the one with the largest residual
  held_out_error_too_large,      ///< [m/s^2] rms; other = the worst station
  held_out_error_above_claim,    ///< [sigma] rms; other = the worst station
  noise_beyond_declared,         ///< value = times the noise declared
  too_many_outliers,             ///< value = excluded stations, limit = most
  outliers_of_three,       ///< value = excluded stations, limit = stations; three sensors do not check one another
  residuals_above_others,  ///< value = times those of the other sensors
  residual_too_large,      ///< [m/s^2]; sensor = the one with the largest

  // Why a fit did not settle.
  station_temperature_impossible,  ///< [degC]; other = station
  station_reading_impossible,      ///< [log unit] of the sensor; other = station
  temperature_follows_direction,   ///< value = correlation; other = 0, 1, 2: x, y, z
  sensor_absent,                   ///< value = stations without it, limit = stations
  not_converged,
  refused_otherwise,  ///< by the error in `CalibrationRun::refusal`

  // The mistake that would explain a refusal: with it mended the fit settles.
  accepted_if_exchanged,         ///< the columns of sensor and other
  accepted_if_reversed,          ///< the sign of the sensor
  accepted_if_turned,            ///< the triad that begins with the sensor; value = which of SecondLook::turned
  accepted_without_roll_group,   ///< value = its number
  accepted_without_roll_groups,  ///< with none of them
  accepted_about_another_axis,   ///< `SecondLook::roll_axis`

  // The fits by the paper's method.
  paper_axes_coplanar,  ///< value = least singular value of the axes
  paper_not_converged,
  paper_rank_too_high,     ///< value = rank, limit = directions that gravity shows
  paper_undetermined,      ///< value = rank, limit = needed
  paper_too_few_stations,  ///< value = stations with all sensors, limit = needed
  paper_refused,           ///< by the error in `CalibrationRun::paper_refusal`

  // What is reported of a fit, accepted or not.
  few_attitudes,              ///< value = attitudes, limit = enough
  few_inclinations,           ///< value = inclinations, limit = enough
  narrow_inclinations,        ///< [rad] span
  range_above_not_covered,    ///< [g0] highest that the sensor has seen
  range_below_not_covered,    ///< [g0] lowest
  common_scale_reported,      ///< value = sigmas of what the priors expect
  roll_axis_reported,         ///< value = sigmas of the common turn
  use_range_not_recorded,     ///< value = condition number; the prior decides where no station is
  drift_follows_time,         ///< the temperature went one way
  higher_order_needs_levels,  ///< value = levels that are missing

  // An array by its geometry: warnings first, then known limits.
  near_singular_triples,  ///< value = how many, limit = |det|
  weak_isolation,         ///< value = errors of a reading in the worst case, limit = most
  no_isolation,
  critical_sensors,  ///< value = how many
  gravity_needed,
  correlated_faults,
  common_bias_unobservable,   ///< value = part of it in the vector
  unobservable_permutations,  ///< value = how many mistakes
  many_sensors,               ///< value = sensors, limit = kStrictCapacity
  common_rotation,
  common_scale,

};
inline constexpr std::size_t kFindingCodes = static_cast<std::size_t>(FindingCode::common_scale) + 1;

struct Finding {
  FindingCode code = FindingCode::not_converged;
  int sensor = -1;     ///< whose it is; -1 where it is of no single sensor
  double value = 0.0;  ///< found
  double limit = 0.0;  ///< allowed
  int other = -1;      ///< the second sensor or the station, from 0, where there is one; else as stated
};

struct FindingId {
  FindingCode code;
  const char* id;  ///< for machines: it stays
};

// clang-format off
inline constexpr std::array<FindingId, kFindingCodes> kFindingIds{{
    {FindingCode::column_empty, "column_empty"},
    {FindingCode::column_not_finite, "column_not_finite"},
    {FindingCode::column_empty_or_not_finite, "column_empty_or_not_finite"},
    {FindingCode::column_constant, "column_constant"},
    {FindingCode::temperature_column_gaps, "temperature_column_gaps"},
    {FindingCode::roll_group_column_empty, "roll_group_column_empty"},
    {FindingCode::temperature_in_kelvin, "temperature_in_kelvin"},
    {FindingCode::claimed_temperature_in_kelvin, "claimed_temperature_in_kelvin"},
    {FindingCode::claimed_temperature_in_fahrenheit, "claimed_temperature_in_fahrenheit"},
    {FindingCode::claimed_temperature_in_another_unit, "claimed_temperature_in_another_unit"},
    {FindingCode::log_too_short, "log_too_short"},
    {FindingCode::vector_length_wrong, "vector_length_wrong"},
    {FindingCode::row_step_beyond_gap, "row_step_beyond_gap"},
    {FindingCode::noise_at_rest, "noise_at_rest"},
    {FindingCode::tool_not_at_rest, "tool_not_at_rest"},
    {FindingCode::no_stretch_at_rest, "no_stretch_at_rest"},
    {FindingCode::too_few_stations, "too_few_stations"},
    {FindingCode::undetermined, "undetermined"},
    {FindingCode::too_few_levels, "too_few_levels"},
    {FindingCode::roll_groups_with_drift, "roll_groups_with_drift"},
    {FindingCode::temperature_follows_inclination, "temperature_follows_inclination"},
    {FindingCode::undetermined_over_temperature, "undetermined_over_temperature"},
    {FindingCode::too_many_roll_groups, "too_many_roll_groups"},
    {FindingCode::wrong_unit, "wrong_unit"},
    {FindingCode::gravity_out_of_range, "gravity_out_of_range"},
    {FindingCode::common_scale_changed, "common_scale_changed"},
    {FindingCode::roll_axis_implausible, "roll_axis_implausible"},
    {FindingCode::duplicate_channels, "duplicate_channels"},
    {FindingCode::one_of_several_implausible, "one_of_several_implausible"},
    {FindingCode::scale_implausible, "scale_implausible"},
    {FindingCode::axis_implausible, "axis_implausible"},
    {FindingCode::bias_implausible, "bias_implausible"},
    {FindingCode::value_implausible, "value_implausible"},
    {FindingCode::inconsistent_sensor, "inconsistent_sensor"},
    {FindingCode::residuals_follow_temperature, "residuals_follow_temperature"},
    {FindingCode::sensors_disagree, "sensors_disagree"},
    {FindingCode::held_out_error_too_large, "held_out_error_too_large"},
    {FindingCode::held_out_error_above_claim, "held_out_error_above_claim"},
    {FindingCode::noise_beyond_declared, "noise_beyond_declared"},
    {FindingCode::too_many_outliers, "too_many_outliers"},
    {FindingCode::outliers_of_three, "outliers_of_three"},
    {FindingCode::residuals_above_others, "residuals_above_others"},
    {FindingCode::residual_too_large, "residual_too_large"},
    {FindingCode::station_temperature_impossible, "station_temperature_impossible"},
    {FindingCode::station_reading_impossible, "station_reading_impossible"},
    {FindingCode::temperature_follows_direction, "temperature_follows_direction"},
    {FindingCode::sensor_absent, "sensor_absent"},
    {FindingCode::not_converged, "not_converged"},
    {FindingCode::refused_otherwise, "refused_otherwise"},
    {FindingCode::accepted_if_exchanged, "accepted_if_exchanged"},
    {FindingCode::accepted_if_reversed, "accepted_if_reversed"},
    {FindingCode::accepted_if_turned, "accepted_if_turned"},
    {FindingCode::accepted_without_roll_group, "accepted_without_roll_group"},
    {FindingCode::accepted_without_roll_groups, "accepted_without_roll_groups"},
    {FindingCode::accepted_about_another_axis, "accepted_about_another_axis"},
    {FindingCode::paper_axes_coplanar, "paper_axes_coplanar"},
    {FindingCode::paper_not_converged, "paper_not_converged"},
    {FindingCode::paper_rank_too_high, "paper_rank_too_high"},
    {FindingCode::paper_undetermined, "paper_undetermined"},
    {FindingCode::paper_too_few_stations, "paper_too_few_stations"},
    {FindingCode::paper_refused, "paper_refused"},
    {FindingCode::few_attitudes, "few_attitudes"},
    {FindingCode::few_inclinations, "few_inclinations"},
    {FindingCode::narrow_inclinations, "narrow_inclinations"},
    {FindingCode::range_above_not_covered, "range_above_not_covered"},
    {FindingCode::range_below_not_covered, "range_below_not_covered"},
    {FindingCode::common_scale_reported, "common_scale_reported"},
    {FindingCode::roll_axis_reported, "roll_axis_reported"},
    {FindingCode::use_range_not_recorded, "use_range_not_recorded"},
    {FindingCode::drift_follows_time, "drift_follows_time"},
    {FindingCode::higher_order_needs_levels, "higher_order_needs_levels"},
    {FindingCode::near_singular_triples, "near_singular_triples"},
    {FindingCode::weak_isolation, "weak_isolation"},
    {FindingCode::no_isolation, "no_isolation"},
    {FindingCode::critical_sensors, "critical_sensors"},
    {FindingCode::gravity_needed, "gravity_needed"},
    {FindingCode::correlated_faults, "correlated_faults"},
    {FindingCode::common_bias_unobservable, "common_bias_unobservable"},
    {FindingCode::unobservable_permutations, "unobservable_permutations"},
    {FindingCode::many_sensors, "many_sensors"},
    {FindingCode::common_rotation, "common_rotation"},
    {FindingCode::common_scale, "common_scale"},
}};
// clang-format on

namespace detail {
constexpr bool in_order() noexcept {
  for (std::size_t k = 0; k < kFindingCodes; ++k) {
    if (static_cast<std::size_t>(kFindingIds[k].code) != k) return false;
  }
  return true;
}
}  // namespace detail
static_assert(detail::in_order(), "every finding has its row in kFindingIds, in the order of the enumeration");

constexpr const char* to_string(FindingCode code) noexcept { return kFindingIds[static_cast<std::size_t>(code)].id; }

inline bool has(const std::vector<Finding>& list, FindingCode code) {
  return std::any_of(list.begin(), list.end(), [code](const Finding& f) { return f.code == code; });
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
