#include "plumb/findings/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "plumb/findings/best_turn.hpp"
#include "plumb/findings/column_findings.hpp"
#include "plumb/findings/dead_channel.hpp"
#include "plumb/findings/fit_figures.hpp"
#include "plumb/findings/fit_remarks.hpp"
#include "plumb/findings/followed_direction.hpp"
#include "plumb/findings/unit_guess.hpp"
#include "plumb/findings/worst_value.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// The paper writes each misalignment as a mixture of the other readings: axes near one plane make that a quotient of
/// small numbers, and no attitude mends it.
constexpr double kFlat = 0.1;

/// With the code that the figures of a refusal belong to.
Finding as(FindingCode code, const Error& e, int sensor = -1) { return {code, sensor, e.value, e.limit}; }

int worst_sensor(const CalibrationRun& run, const io::ArrayFile& array) {
  const auto begin = run.report.residual_rms_mps2.begin();
  return static_cast<int>(std::max_element(begin, begin + array.array.size()) - begin);
}

std::vector<Finding> dead_columns(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<Finding> out;
  for (const Finding& f : column_findings(run, array)) {
    if (f.sensor >= 0 && dead_channel(run.log, f.sensor)) out.push_back(f);
  }
  return out;
}

std::optional<Finding> of_temperature(const CalibrationRun& run) {
  const TemperatureReport& t = run.temperature;
  const Error& e = run.refusal;
  if (e.code == Errc::too_few_levels)
    return Finding{FindingCode::too_few_levels, -1, static_cast<double>(t.levels.count), t.order + 1.0};
  if (e.code == Errc::out_of_range && e.index == 5 && t.rolls) return as(FindingCode::roll_groups_with_drift, e);
  if (e.code != Errc::unobservable || t.order == 0) return {};
  return as(
      t.follows_inclination ? FindingCode::temperature_follows_inclination : FindingCode::undetermined_over_temperature,
      e);
}

std::optional<Finding> of_worst_value(const CalibrationRun& run, const io::ArrayFile& array) {
  if (!run.study.shown) return {};
  const WorstValue worst = worst_value(array, *run.study.shown, run.options);
  switch (worst.of) {
    case WorstValue::Of::scale: return Finding{FindingCode::scale_implausible, worst.sensor, worst.value, worst.bound};
    case WorstValue::Of::axis: return Finding{FindingCode::axis_implausible, worst.sensor, worst.value, worst.bound};
    case WorstValue::Of::bias: return Finding{FindingCode::bias_implausible, worst.sensor, worst.value, worst.bound};
    case WorstValue::Of::nothing: break;
  }
  return {};
}

Finding implausible(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.refusal;
  switch (run.concern) {
    case Concern::gravity: return as(FindingCode::gravity_out_of_range, e);
    case Concern::common_scale: return as(FindingCode::common_scale_changed, e);
    case Concern::roll_axis: return as(FindingCode::roll_axis_implausible, e);
    default: break;
  }
  if (const int twin = twin_channel(run.stations, array.array.size(), e.index); twin >= 0)
    return {FindingCode::duplicate_channels, std::min(twin, e.index), 0.0, 0.0, std::max(twin, e.index)};
  if (e.index < 0 && run.report.common_turn.sigma_rad > 0.0) return as(FindingCode::roll_axis_implausible, e);
  if (run.report.suspects.size() > 1)
    return {FindingCode::one_of_several_implausible, -1, static_cast<double>(run.report.suspects.size())};
  if (const std::optional<Finding> worst = of_worst_value(run, array)) return *worst;
  return as(FindingCode::value_implausible, e, e.index < array.array.size() ? e.index : -1);
}

/// Of residuals, where the code alone says what is wrong.
std::optional<Finding> by_concern(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.refusal;
  const auto of_station = [&](FindingCode code) {
    return Finding{code, -1, e.value, e.limit, run.study.held_out.worst};
  };
  switch (run.concern) {
    case Concern::inconsistent_sensor: return as(FindingCode::inconsistent_sensor, e, e.index);
    case Concern::level_of_a_sensor: return as(FindingCode::residuals_follow_temperature, e, e.index);
    case Concern::parity: return as(FindingCode::sensors_disagree, e, worst_sensor(run, array));
    case Concern::hold_out: return of_station(FindingCode::held_out_error_too_large);
    case Concern::hold_out_claim: return of_station(FindingCode::held_out_error_above_claim);
    default: return {};
  }
}

Finding poor_fit(const CalibrationRun& run, const io::ArrayFile& array) {
  if (const std::optional<Finding> told = by_concern(run, array)) return *told;
  const Error& e = run.refusal;
  const FitReport& r = run.report;
  if (e.index >= 0 && e.value == noise_factor(r, array, e.index))
    return as(FindingCode::noise_beyond_declared, e, e.index);
  const double most = run.options.max_outlier_share * (r.stations + r.outliers);
  if (static_cast<double>(r.outliers) > most)
    return {FindingCode::too_many_outliers, e.index, static_cast<double>(r.outliers), std::floor(most)};
  const bool of_length = r.norm_rms_mps2 <= residual_bound_mps2(run.options.max_norm_rms_mps2, r);
  // Of three sensors it may have been the outliers, though the length is off too: a bound that holds is no reason.
  if (r.parameters == 12 && r.outliers > 0 && (of_length || !(e.value > e.limit))) {
    return {FindingCode::outliers_of_three, -1, static_cast<double>(r.outliers),
            static_cast<double>(r.stations + r.outliers)};
  }
  if (e.index >= 0 && of_length) return as(FindingCode::residuals_above_others, e, e.index);
  return as(FindingCode::residual_too_large, e, worst_sensor(run, array));
}

/// The station by which the fit ran away.
Finding of_station(const Station& station, int k, const io::ArrayFile& array) {
  const double degc = station.temperature_degc;
  if (degc < kPlausibleMin_degc || degc > kPlausibleMax_degc)
    return {FindingCode::station_temperature_impossible, -1, degc, 0.0, k};
  const auto begin = station.mean.begin();
  const auto most = std::max_element(begin, begin + array.array.size(),
                                     [](double a, double b) { return std::fabs(a) < std::fabs(b); });
  return {FindingCode::station_reading_impossible, static_cast<int>(most - begin), *most, 0.0, k};
}

std::vector<Finding> did_not_settle(const CalibrationRun& run, const io::ArrayFile& array) {
  if (const int k = run.refusal.index; k >= 0 && k < static_cast<int>(run.stations.size()))
    return {of_station(run.stations[static_cast<std::size_t>(k)], k, array)};
  const FollowedDirection follows = followed_direction(run.temperature.order, run.stations, run.study.attitudes);
  if (follows.axis != 0)
    return {{FindingCode::temperature_follows_direction, -1, follows.correlation, 0.0, follows.axis - 'x'}};
  std::vector<Finding> absent = absent_sensors(run, array);
  if (!absent.empty()) return absent;
  return {{FindingCode::not_converged}};
}

/// With the one mistake of the array file that would explain values that do not fit together.
std::vector<Finding> explained(std::vector<Finding> out, const SecondLook& look) {
  if (look.roll_axis) {
    out.push_back({FindingCode::accepted_about_another_axis});
  } else if (!look.groups.empty()) {
    for (const std::int64_t group : look.groups)
      out.push_back({FindingCode::accepted_without_roll_group, -1, static_cast<double>(group)});
  } else if (look.without_groups) {
    out.push_back({FindingCode::accepted_without_roll_groups});
  } else {
    for (std::size_t k = 0; k < look.turned.size(); ++k)
      out.push_back({FindingCode::accepted_if_turned, look.turned[k].sensor[0], static_cast<double>(k)});
    for (const auto& [i, j] : look.exchanged) {
      out.push_back(i == j ? Finding{FindingCode::accepted_if_reversed, i}
                           : Finding{FindingCode::accepted_if_exchanged, i, 0.0, 0.0, j});
    }
  }
  return out;
}

/// Of a log that determines too little: the columns that lacked numbers are likely why.
std::vector<Finding> too_little(const Finding& reason, const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<Finding> out = {reason};
  for (const Finding& f : column_findings(run, array)) {
    if (f.code != FindingCode::roll_group_column_empty) out.push_back(f);
  }
  return out;
}

}  // namespace

std::vector<Finding> refusal_of(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.refusal;
  const bool of_values = e.code == Errc::implausible || e.code == Errc::poor_fit || e.code == Errc::diverged;
  const bool of_amount = e.code == Errc::too_few_stations || e.code == Errc::unobservable;
  std::vector<Finding> dead = dead_columns(run, array);
  if (!dead.empty() && (of_values || of_amount) && run.concern != Concern::gravity) return dead;
  if (const std::optional<Finding> temperature = of_temperature(run)) return {*temperature};
  // Triads that are mirrored against each other cancel: the vector is short then too.
  if (of_values && run.concern != Concern::gravity && run.second_look.turned.empty() &&
      of_another_unit(array, run.stations))
    return {{FindingCode::wrong_unit, -1, length_factor(array, run.stations), 1.0}};
  switch (e.code) {
    case Errc::too_few_stations:
      if (!run.log_findings.empty())
        return too_little({FindingCode::no_stretch_at_rest, -1, static_cast<double>(run.log.rows)}, run, array);
      return too_little({FindingCode::too_few_stations, -1, static_cast<double>(run.stations.size()), e.limit}, run,
                        array);
    case Errc::unobservable: return too_little(as(FindingCode::undetermined, e), run, array);
    case Errc::implausible: return explained({implausible(run, array)}, run.second_look);
    case Errc::poor_fit: return explained({poor_fit(run, array)}, run.second_look);
    case Errc::diverged: return explained(did_not_settle(run, array), run.second_look);
    case Errc::out_of_range:  // axis and axis deviation come from the command line, which checks them
      return {{FindingCode::too_many_roll_groups, -1, 0.0, static_cast<double>(kMaxRollGroups)}};
    default: return {as(FindingCode::refused_otherwise, e, e.index < array.array.size() ? e.index : -1)};
  }
}

Finding paper_refusal_of(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.paper_refusal;
  const double least = least_singular_value(array.array);
  if (least < kFlat) return {FindingCode::paper_axes_coplanar, -1, least, kFlat};
  switch (e.code) {
    case Errc::diverged: return as(FindingCode::paper_not_converged, e);
    case Errc::unobservable:
      return as(e.value > e.limit ? FindingCode::paper_rank_too_high : FindingCode::paper_undetermined, e);
    case Errc::too_few_stations: return as(FindingCode::paper_too_few_stations, e);
    default: return as(FindingCode::paper_refused, e);
  }
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
