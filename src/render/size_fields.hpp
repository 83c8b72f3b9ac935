/// The four sizes as they are reported everywhere (private to src/render).
#pragma once

#include <limits>

#include "field_table.hpp"
#include "html_view.hpp"
#include "plumb/findings/detection_sizes.hpp"
#include "plumb/render/figures.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// What the sizes of single sensors are for, where the array has chips (docs/theory.md, section 5.7).
inline constexpr const char* kSizesOfOneAxis =
    "sizes are of one axis at fault; of orthogonal triads of equal noise a whole chip's error of that length is at "
    "least as visible";

inline constexpr double kDegrees = 180.0 / kPi;

/// pi bounds nothing.
inline double bounded_angle(double rad) { return rad < kPi ? rad : std::numeric_limits<double>::infinity(); }

using SizeField = FieldOf<findings::DetectionSizes>;

// clang-format off
inline constexpr SizeField kSizeFields[] = {
    {"minimum_detectable_bias_mps2",      [](const auto& s) { return s.minimum_detectable_bias_mps2; },
     1.0, "minimum detectable", "bias", kMg0, "{:.3f} mg0", 18, "minimum detectable bias, mg0", kMg0},
    {"guaranteed_detection_visited_mps2", [](const auto& s) { return s.guaranteed_detection_visited_mps2; },
     1.0, "guaranteed detection", "visited attitudes", kMg0, "{:.3f} mg0", 20, "guaranteed detection threshold at the attitudes that calibration visited, mg0", kMg0},
    {"guaranteed_detection_any_mps2",     [](const auto& s) { return s.guaranteed_detection_any_mps2; },
     1.0, "guaranteed detection", "any attitude", kMg0, "{:.3f} mg0", 20, "guaranteed detection threshold at any attitude, mg0", kMg0},
    {"guaranteed_isolation_mps2",         [](const auto& s) { return s.guaranteed_isolation_mps2; },
     1.0, "guaranteed isolation", "over E attitudes", kMg0, "{:.3f} mg0", 20, "guaranteed isolation threshold over E attitudes, mg0", kMg0},
    {"protection_level_at_rest_deg",      [](const auto& s) { return bounded_angle(s.protection_level_at_rest_rad); },
     kDegrees, "protection level", "at rest", kDegrees, "{:.4f} deg", 16, "protection level at rest, deg", 1.0},
};
// clang-format on

/// Whether size k of the table is beyond the full scale of a sensor.
inline bool is_beyond(const findings::DetectionSizes& sizes, std::size_t k) {
  const findings::DetectionSizes::Beyond& b = sizes.beyond_full_scale;
  const bool flags[] = {b.minimum_detectable_bias, b.guaranteed_detection_visited, b.guaranteed_detection_any,
                        b.guaranteed_isolation, false};
  static_assert(std::size(flags) == std::size(kSizeFields));
  return flags[k];
}

/// The table on a page; `sizes` null: why there is none stands in its place.
void put_sizes(const Json& sizes, Section& out);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
