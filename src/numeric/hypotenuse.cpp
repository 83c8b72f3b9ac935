#include "plumb/numeric/hypotenuse.hpp"

#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

/// Sides beyond these would leave the range of a double in their squares. A power of two changes no digit.
constexpr double kLongSide = 0x1p500, kShortSide = 0x1p-450, kSideScale = 0x1p600;
/// A side this much shorter than the other one adds less than half a unit in the last place.
constexpr double kShortPart = 0x1p-54;

/// Borges, "Algorithm 1014: An Improved Algorithm for hypot(x,y)", ACM TOMS 47 (2021): what the rounded squares left
/// out of their root is put back, to first order. longer >= shorter > 0.
double corrected_root(double longer, double shorter) noexcept {
  const double root = std::sqrt(longer * longer + shorter * shorter);
  double over = 0.0;  // root^2 - longer^2 - shorter^2
  if (root <= 2.0 * shorter) {
    const double rest = root - shorter;
    over = longer * (2.0 * rest - longer) + (rest - 2.0 * (longer - shorter)) * rest;
  } else {
    const double rest = root - longer;
    over = 2.0 * rest * (longer - 2.0 * shorter) + ((4.0 * rest - shorter) * shorter + rest * rest);
  }
  return root - over / (2.0 * root);
}

}  // namespace

double hypotenuse(double x, double y) noexcept {
  const double a = std::fabs(x), b = std::fabs(y);
  if (std::isinf(a) || std::isinf(b)) return std::numeric_limits<double>::infinity();
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::quiet_NaN();
  const double longer = a < b ? b : a, shorter = a < b ? a : b;
  if (shorter <= longer * kShortPart) return longer;
  if (longer > kLongSide) return corrected_root(longer / kSideScale, shorter / kSideScale) * kSideScale;
  if (shorter < kShortSide) return corrected_root(longer * kSideScale, shorter * kSideScale) / kSideScale;
  return corrected_root(longer, shorter);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
