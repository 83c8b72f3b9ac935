#include "plumb/findings/fit_remarks.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/findings/fit_figures.hpp"
#include "plumb/findings/followed_direction.hpp"
#include "plumb/findings/unit_guess.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// How much of its range a sensor must have seen to tell scale from bias.
constexpr double kEnoughRange = 0.5;
constexpr int kEnoughInclinations = 3;
constexpr int kEnoughAttitudes = 12;
constexpr double kEnoughSpan_deg = 60.0;
/// A sensor that delivered at fewer than this part of the stations is named.
constexpr double kDelivers = 0.5;
/// Over the declared noise; 128 samples tell 1.25 from 1 by 4 sigma.
constexpr double kToldNoise = 1.25;
/// Reported where the condition is above the one and the span of use wider than what was recorded by the other.
constexpr double kExtrapolated = 100.0;
constexpr double kWider = 1.2;

bool extrapolated(const TemperatureReport& t) {
  const double seen = t.levels.highest_degc - t.levels.lowest_degc, spare = (kWider - 1.0) * seen;
  const bool beyond =
      t.use_degc.highest > t.levels.highest_degc + spare || t.use_degc.lowest < t.levels.lowest_degc - spare;
  return t.null_directions == 0 && t.condition > kExtrapolated && beyond;
}

}  // namespace

std::vector<Finding> absent_sensors(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<Finding> out;
  const auto all = static_cast<double>(run.stations.size());
  for (int i = 0; i < array.array.size(); ++i) {
    const auto with = static_cast<double>(
        std::count_if(run.stations.begin(), run.stations.end(), [i](const Station& s) { return s.delivered.has(i); }));
    if (with < kDelivers * all) out.push_back({FindingCode::sensor_absent, i, all - with, all});
  }
  return out;
}

std::vector<Finding> coverage_remarks(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<Finding> out;
  const Coverage& c = run.study.coverage;
  if (c.attitudes < kEnoughAttitudes)
    out.push_back({FindingCode::few_attitudes, -1, static_cast<double>(c.attitudes), kEnoughAttitudes});
  if (c.attitudes == 0) return out;
  const std::vector<Finding> absent = absent_sensors(run, array);
  out.insert(out.end(), absent.begin(), absent.end());
  const double span_deg = deg_from_rad(c.inclination_max_rad) - deg_from_rad(c.inclination_min_rad);
  if (c.inclinations < kEnoughInclinations) {
    out.push_back({FindingCode::few_inclinations, -1, static_cast<double>(c.inclinations), kEnoughInclinations});
  } else if (span_deg < kEnoughSpan_deg) {
    out.push_back({FindingCode::narrow_inclinations, -1, rad_from_deg(span_deg), rad_from_deg(kEnoughSpan_deg)});
  }
  for (int i = 0; i < array.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    if (c.highest[a] < kEnoughRange)
      out.push_back({FindingCode::range_above_not_covered, i, c.highest[a], kEnoughRange});
    if (c.lowest[a] > -kEnoughRange)
      out.push_back({FindingCode::range_below_not_covered, i, c.lowest[a], -kEnoughRange});
  }
  return out;
}

std::vector<Finding> noise_remarks(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<Finding> out;
  if (of_another_unit(array, run.stations)) return out;
  for (int i = 0; i < array.array.size(); ++i) {
    const double factor = noise_factor(run.told(), array, i);
    if (factor > kToldNoise) out.push_back({FindingCode::noise_beyond_declared, i, factor, kToldNoise});
  }
  return out;
}

std::vector<Finding> common_remarks(const FitReport& report) {
  const AcceptanceLimits limits;
  std::vector<Finding> out;
  const double scale = std::fabs(report.common_scale.sigmas()), turn = report.common_turn.sigmas();
  if (scale > limits.told_common_scale_sigmas)
    out.push_back({FindingCode::common_scale_reported, -1, scale, limits.told_common_scale_sigmas});
  if (report.common_turn.sigma_rad > 0.0 && turn > limits.told_common_turn_sigmas)
    out.push_back({FindingCode::roll_axis_reported, -1, turn, limits.told_common_turn_sigmas});
  return out;
}

std::vector<Finding> temperature_remarks(const CalibrationRun& run) {
  const TemperatureReport& t = run.temperature;
  std::vector<Finding> out;
  if (t.levels.count < 2 && t.order == 0) return out;
  if (t.order > 0 && extrapolated(t))
    out.push_back({FindingCode::use_range_not_recorded, -1, t.condition, kExtrapolated});
  if (t.follows_inclination) out.push_back({FindingCode::temperature_follows_inclination});
  const FollowedDirection follows = followed_direction(t.order, run.stations, run.study.attitudes);
  if (follows.axis != 0)
    out.push_back({FindingCode::temperature_follows_direction, -1, follows.correlation, 0.0, follows.axis - 'x'});
  if (t.follows_time && t.order > 0) out.push_back({FindingCode::drift_follows_time});
  if (run.accepted && t.missing > 0)
    out.push_back({FindingCode::higher_order_needs_levels, -1, static_cast<double>(t.missing)});
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
