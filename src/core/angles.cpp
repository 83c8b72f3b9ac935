#include "plumb/core/angles.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

constexpr double kTanEighth = 0.41421356237309503;        // tan(pi / 8)
constexpr double kHalfPiLow = 6.1232339957367660e-17;     // pi / 2 beyond its double
constexpr double kQuarterPiLow = 3.0616169978683830e-17;  // pi / 4
constexpr double kPiLow = 1.2246467991473532e-16;         // pi

/// Terms of the series, counted so that what is cut off is below a hundredth of the last digit.
constexpr std::size_t kArcTerms = 21;  // z^2 up to tan(pi/8)^2 = 0.172
constexpr std::size_t kTerms = 10;     // x^2 up to (pi/4)^2 = 0.617

/// -1/3, 1/5, -1/7, ...
constexpr std::array<double, kArcTerms> arc_series() noexcept {
  std::array<double, kArcTerms> out{};
  for (std::size_t k = 0; k < kArcTerms; ++k) {
    const double term = 1.0 / (2.0 * static_cast<double>(k) + 3.0);
    out[k] = k % 2 == 0 ? -term : term;
  }
  return out;
}
/// -1 / ((first + 2k) (first + 2k + 1)): what each term of a sine (first = 2) or cosine (3) is of the one before it.
constexpr std::array<double, kTerms> ratios(double first) noexcept {
  std::array<double, kTerms> out{};
  for (std::size_t k = 0; k < kTerms; ++k) {
    const double n = first + 2.0 * static_cast<double>(k);
    out[k] = -1.0 / (n * (n + 1.0));
  }
  return out;
}
constexpr std::array<double, kArcTerms> kArc = arc_series();
constexpr std::array<double, kTerms> kSine = ratios(2.0), kCosine = ratios(3.0);

/// The angle with tangent z is z and this: z^3 (-1/3 + z^2/5 - ...). |z| <= tan(pi/8).
double arc_rest(double z) noexcept {
  const double square = z * z;
  double sum = 0.0;
  for (std::size_t k = kArcTerms; k-- > 0;) sum = square * (kArc[k] + sum);
  return z * sum;
}

/// x^2 r_0 (1 + x^2 r_1 (1 + ...)).
double series(const std::array<double, kTerms>& ratio, double square) noexcept {
  double sum = 0.0;
  for (std::size_t k = kTerms; k-- > 0;) sum = square * ratio[k] * (1.0 + sum);
  return sum;
}

/// Angle of a quotient of two positive numbers, numerator <= denominator.
double acute(double y, double x) noexcept {
  const double t = y / x;
  if (!(t > kTanEighth)) return t + arc_rest(t);
  const double z = (y - x) / (y + x);
  return 0.25 * kPi + (z + (arc_rest(z) + kQuarterPiLow));
}

/// |x| <= pi/4.
double cosine_near_zero(double x) noexcept {
  const double half = 0.5 * x * x;
  return 1.0 - half * (1.0 + series(kCosine, x * x));
}
double sine_near_zero(double x) noexcept { return x + x * series(kSine, x * x); }

}  // namespace

double angle_of(double y, double x) noexcept {
  const double across = std::fabs(x);
  if (std::isnan(y) || std::isnan(x)) return std::numeric_limits<double>::quiet_NaN();
  if (!(y > 0.0) && !(across > 0.0)) return 0.0;
  const double near = y > across ? 0.5 * kPi - (acute(across, y) - kHalfPiLow) : acute(y, across);
  return x < 0.0 ? kPi - (near - kPiLow) : near;
}

double sine_of(double angle_rad) noexcept {
  const double size = std::fabs(angle_rad);
  const double sine = size > 0.25 * kPi ? cosine_near_zero((0.5 * kPi - size) + kHalfPiLow) : sine_near_zero(size);
  return angle_rad < 0.0 ? -sine : sine;
}

double angle_with_sine(double sine) noexcept {
  if (!(sine >= 0.0 && sine <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
  const double square = sine < 0.5 ? 1.0 - sine * sine : (1.0 - sine) * (1.0 + sine);  // whichever rounds less
  return angle_of(sine, std::sqrt(square));
}

}  // namespace PLUMB_ABI
}  // namespace plumb
