#include "plumb/findings/detection_sizes.hpp"

#include <algorithm>
#include <limits>

#include "plumb/array/geometry.hpp"
#include "plumb/core/units.hpp"
#include "plumb/health/stability.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr std::size_t index(int i) noexcept { return static_cast<std::size_t>(i); }

double largest(const Readings& values, int n) noexcept {
  double out = 0.0;
  for (int i = 0; i < n; ++i) out = std::fmax(out, values[index(i)]);
  return out;
}

/// A healthy block without noise, with the drift that its limits allow for.
BlockEvidence healthy_block(const SensorArray& array, const Vec3& g, const TestSettings& settings) noexcept {
  BlockEvidence block;
  block.usable = array.all();
  block.samples = settings.samples;
  for (int i = 0; i < array.size(); ++i) {
    block.mean_mps2[index(i)] = dot(array.axis(i), g);
    block.tolerance_mps2[index(i)] = static_cast<float>(settings.tolerance_mps2[index(i)]);
  }
  return block;
}

/// Largest b_S of parity, as the test of all sensors has it at these attitudes; not a number where there are none.
double systematic_at(const SensorArray& array, const GravityReference& gravity, const TestSettings& settings,
                     const TestLimits& limits, const Visited& visited) noexcept {
  double out = std::nan("");
  for (const Vec3& down : visited) {
    if (!(norm(down) > 0.0)) continue;
    const Vec3 g = scaled(down, gravity.g_mps2 / norm(down));
    out = std::fmax(out,
                    test_set(array, gravity, limits, healthy_block(array, g, settings), array.all()).parity_systematic);
  }
  return out;
}

TestSettings settings_at(SizeCondition condition, TestSettings stated, int sensors) noexcept {
  if (condition == SizeCondition::as_stated) return stated;
  const double stability_mps2 = condition == SizeCondition::stability_0_2_mg0 ? kDriftingStability_mps2 : 0.0;
  stated.acceleration_mps2 = 0.0;
  for (int i = 0; i < sensors; ++i) stated.tolerance_mps2[index(i)] = kStabilitySigmas * stability_mps2;
  return stated;
}

}  // namespace

Readings guaranteed_isolation_mps2(const SensorArray& array, const TestSettings& settings, const Thresholds& thresholds,
                                   const OneAttitude* one) noexcept {
  constexpr int kFour = 4;
  Readings out{};
  std::array<Vec3, 32> down{};
  const int attitudes = std::min(settings.isolation_attitudes, static_cast<int>(down.size()));
  for (int k = 0; k < attitudes; ++k) down[index(k)] = spread_direction(k, attitudes);
  for (int i = 0; i < array.size(); ++i) {
    const double by_parity = thresholds.sure.fault[2][index(i)];
    const bool by_length = array.size() == kFour && one != nullptr && !std::isfinite(by_parity);
    const double isolated = by_length ? one->clear_over_mps2(down.data(), attitudes, i) : by_parity;
    out[index(i)] = std::fmax(isolated, thresholds.sensor[index(i)].guaranteed_detection_mps2);
  }
  return out;
}

DetectionSizes detection_sizes(const SensorArray& array, const GravityReference& gravity, const TestSettings& settings,
                               const Visited& visited, const Readings& full_scale_mps2) {
  const int n = array.size();
  DetectionSizes out;
  const auto add = [&full_scale_mps2](double size_mps2, int i, double& worst, bool& beyond) {
    worst = std::fmax(worst, size_mps2);
    beyond = beyond || is_beyond_full_scale(size_mps2, full_scale_mps2[index(i)]);
  };
  ErrorBudget budget = error_budget(array, gravity, settings);
  const Thresholds thresholds = thresholds_of(array, gravity, settings);
  const bool isolable = figures_of_merit(array).confirmed_grade > 0;
  const auto one = isolable ? std::make_unique<OneAttitude>(array, gravity, budget) : nullptr;
  for (int i = 0; i < n; ++i) {
    const SensorThresholds& sensor = thresholds.sensor[index(i)];
    add(sensor.detectable_mps2, i, out.minimum_detectable_bias_mps2, out.beyond_full_scale.minimum_detectable_bias);
    add(sensor.guaranteed_detection_mps2, i, out.guaranteed_detection_any_mps2,
        out.beyond_full_scale.guaranteed_detection_any);
  }
  budget.parity_systematic = systematic_at(array, gravity, settings, budget.limits, visited);
  const bool known = std::isfinite(budget.parity_systematic);
  out.guaranteed_detection_visited_mps2 = known ? 0.0 : std::nan("");
  for (int i = 0; known && i < n; ++i) {
    add(guaranteed_detection_mps2(array, settings, budget, i), i, out.guaranteed_detection_visited_mps2,
        out.beyond_full_scale.guaranteed_detection_visited);
  }
  out.guaranteed_isolation_mps2 = isolable ? 0.0 : kInfinity;
  const Readings isolated = isolable ? guaranteed_isolation_mps2(array, settings, thresholds, one.get()) : Readings{};
  for (int i = 0; i < n; ++i)
    add(isolated[index(i)], i, out.guaranteed_isolation_mps2, out.beyond_full_scale.guaranteed_isolation);
  out.protection_level_at_rest_rad = thresholds.protection_rad;
  return out;
}

double SizeTable::tolerance_mps2(SizeCondition condition, int sensors) const noexcept {
  return largest(settings_at(condition, settings, sensors).tolerance_mps2, sensors);
}

double SizeTable::acceleration_mps2(SizeCondition condition) const noexcept {
  return settings_at(condition, settings, 0).acceleration_mps2;
}

SizeTable size_table(const SensorArray& array, const GravityReference& gravity, const TestSettings& settings,
                     bool calibrated, const Visited& visited, const Readings& full_scale_mps2) {
  SizeTable out;
  out.settings = settings;
  for (const Vec3& down : visited) out.visited += norm(down) > 0.0 ? 1 : 0;
  out.known = !calibrated        ? VisitedKnown::no_calibration
              : out.visited == 0 ? VisitedKnown::not_in_the_file
                                 : VisitedKnown::yes;
  for (int c = 0; c < kSizeConditions; ++c) {
    const TestSettings at = settings_at(static_cast<SizeCondition>(c), settings, array.size());
    out.at[index(c)] = detection_sizes(array, gravity, at, calibrated ? visited : Visited(), full_scale_mps2);
  }
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
