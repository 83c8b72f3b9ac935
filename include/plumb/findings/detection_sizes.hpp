/// The four sizes that plumb states of an array, and the conditions under which each is stated: one definition for
/// every page, command and file. Minimum detectable bias, guaranteed detection threshold, guaranteed isolation
/// threshold, protection level at rest.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "plumb/detection/one_attitude.hpp"
#include "plumb/detection/thresholds.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Of the worst sensor. Infinite, and pi, where the geometry has no such size.
struct DetectionSizes {
  /// Missed by parity in at most `TestSettings::missed_detection` of blocks, at any attitude.
  double minimum_detectable_bias_mps2 = 0.0;
  /// Raises the alarm with every block, the noise in parity below its quantile at the rejection rate: at the attitudes
  /// that calibration visited (not a number where they are not known), and at any attitude.
  double guaranteed_detection_visited_mps2 = 0.0, guaranteed_detection_any_mps2 = 0.0;
  /// Leaves no explanation with one fault but the right one once E attitudes are on record
  /// (`guaranteed_isolation_mps2`).
  double guaranteed_isolation_mps2 = 0.0;
  double protection_level_at_rest_rad = 0.0;
  /// Sizes that are beyond the full scale of a sensor: no fault of it is so large.
  struct Beyond {
    bool minimum_detectable_bias = false, guaranteed_detection_visited = false, guaranteed_detection_any = false,
         guaranteed_isolation = false;
  } beyond_full_scale;
};

/// Attitudes at rest over which the direction was calibrated: unit vectors of down, zero where a station shows none.
using Visited = std::vector<Vec3>;

/// `count` directions spread evenly over the sphere, on a spiral from one pole to the other.
inline Vec3 spread_direction(int k, int count) noexcept {
  const double z = 1.0 - (2.0 * k + 1.0) / count, a = k * kPi * (3.0 - std::sqrt(5.0)), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(a), r * std::sin(a), z};
}

/// Of each sensor, by its index. Five sensors and more: T7 at any attitude. Four, which parity cannot tell apart: T8
/// over `TestSettings::isolation_attitudes` that are spread over the sphere. Never below the guaranteed detection
/// threshold: without an alarm nothing is isolated. `one` may be null where nothing can be isolated.
Readings guaranteed_isolation_mps2(const SensorArray& array, const TestSettings& settings, const Thresholds& thresholds,
                                   const OneAttitude* one) noexcept;

/// An infinite size is none at all, whatever the sensor reads.
inline bool is_beyond_full_scale(double size_mps2, double full_scale_mps2) noexcept {
  return full_scale_mps2 > 0.0 && std::isfinite(size_mps2) && size_mps2 > full_scale_mps2;
}

/// `full_scale_mps2` of each sensor; 0 where none is stated.
DetectionSizes detection_sizes(const SensorArray& array, const GravityReference& gravity, const TestSettings& settings,
                               const Visited& visited = {}, const Readings& full_scale_mps2 = {});

/// The tool of which they are stated, whatever its array file says of drift and acceleration, and as that says.
enum class SizeCondition : std::uint8_t { stability_0, stability_0_2_mg0, as_stated };
inline constexpr int kSizeConditions = 3;
inline constexpr double kDriftingStability_mps2 = 0.2e-3 * kG0_mps2;

/// Why `guaranteed_detection_visited_mps2` has a figure or none.
enum class VisitedKnown : std::uint8_t { yes, no_calibration, not_in_the_file };

struct SizeTable {
  TestSettings settings;  ///< as stated; false alarms, misses, samples and E are the same in every row
  VisitedKnown known = VisitedKnown::no_calibration;
  int visited = 0;  ///< attitudes
  std::array<DetectionSizes, kSizeConditions> at{};

  /// Largest drift of a sensor, and acceleration, that a row allows for.
  double tolerance_mps2(SizeCondition condition, int sensors) const noexcept;
  double acceleration_mps2(SizeCondition condition) const noexcept;
};

/// `calibrated`: the array carries what a calibration left, and `visited` are the attitudes of its stations.
SizeTable size_table(const SensorArray& array, const GravityReference& gravity, const TestSettings& settings,
                     bool calibrated, const Visited& visited, const Readings& full_scale_mps2 = {});

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
