#include "plumb/core/circle_point.hpp"

#include <cmath>
#include <limits>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

/// A number as the sum of two doubles, the second below half a unit in the last place of the first: 106 bits.
struct Twin {
  double high = 0.0, low = 0.0;
};

/// a + b without an error, |a| >= |b| or a = 0 (Dekker).
Twin ordered_sum(double a, double b) noexcept {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a b without an error: each as two halves of 26 bits (Veltkamp, Dekker).
Twin exact_product(double a, double b) noexcept {
  constexpr double kSplit = 134217729.0;  // 2^27 + 1
  const double spread_a = kSplit * a, spread_b = kSplit * b;
  const double a1 = spread_a - (spread_a - a), b1 = spread_b - (spread_b - b);
  const double a2 = a - a1, b2 = b - b1;
  const double product = a * b;
  return {product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2};
}

Twin twin_product(const Twin& a, const Twin& b) noexcept {
  const Twin main = exact_product(a.high, b.high);
  return ordered_sum(main.high, main.low + (a.high * b.low + a.low * b.high));
}

/// 1 / m for a whole number m.
Twin twin_inverse(double m) noexcept {
  const double inverse = 1.0 / m;
  const Twin back = exact_product(inverse, m);
  return {inverse, ((1.0 - back.high) - back.low) / m};
}

/// 1 + t, |t| < 1.
Twin one_and_twin(const Twin& t) noexcept {
  const Twin sum = ordered_sum(1.0, t.high);
  return ordered_sum(sum.high, sum.low + t.low);
}

/// 1 - s/(f (f+1)) (1 - s/((f+2) (f+3)) (1 - ...)): the sine over its angle for f = 2, the cosine for f = 1, s the
/// square of the angle. Fourteen terms leave 1e-34 at pi/4.
Twin alternating_series(const Twin& square, double first) noexcept {
  constexpr int kCircleTerms = 14;
  Twin sum = {1.0, 0.0};
  for (int k = kCircleTerms; k-- > 0;) {
    const double n = first + 2.0 * k;
    const Twin part = twin_product(twin_product(square, twin_inverse(n * (n + 1.0))), sum);
    sum = one_and_twin({-part.high, -part.low});
  }
  return sum;
}

/// angle - quarters pi/2, |quarters| <= 6: pi/2 in two pieces of 33 bits, so that a multiple has no error, and a rest.
Twin less_quarters(double angle, double quarters) noexcept {
  constexpr double kPiece1 = 0x1.921fb544p+0, kPiece2 = 0x1.0b4611a6p-34, kPiece3 = 0x1.3198a2e037073p-69;
  const double first = angle - quarters * kPiece1, second = -quarters * kPiece2;
  const Twin sum = std::fabs(first) < std::fabs(second) ? ordered_sum(second, first) : ordered_sum(first, second);
  return ordered_sum(sum.high, sum.low - quarters * kPiece3);
}

}  // namespace

CirclePoint circle_point(double angle_rad) noexcept {
  constexpr double kMostAngle_rad = 8.0;
  if (!(std::fabs(angle_rad) <= kMostAngle_rad)) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none};
  }
  const double turns = angle_rad / (0.5 * kPi);
  const int quarters = static_cast<int>(turns < 0.0 ? turns - 0.5 : turns + 0.5);
  const Twin rest = less_quarters(angle_rad, quarters);
  const Twin square = twin_product(rest, rest);
  const double cosine = alternating_series(square, 1.0).high,
               sine = twin_product(rest, alternating_series(square, 2.0)).high;
  switch (quarters & 3) {
    case 0: return {cosine, sine};
    case 1: return {-sine, cosine};
    case 2: return {-cosine, -sine};
    default: return {sine, -cosine};
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
