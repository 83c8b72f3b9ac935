/// exp, log, sine and cosine whose bits do not depend on the C library. They use only +, -, *, / and
/// comparison, which IEEE 754 rounds exactly, so a scenario gives the same log on every machine (built
/// with -ffp-contract=off, as all of plumb is). Within 2 ulp of the true value over the stated ranges.
/// libm is not used because its last bit differs between implementations and versions.
#pragma once

#include <array>

#include "plumb/core/config.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// ln 2 in two pieces, the first with trailing zeros so that k * kLn2High is exact for |k| < 2^20.
inline constexpr double kLn2High = 6.93147180369123816490e-01;
inline constexpr double kLn2Low = 1.90821492927058770002e-10;

/// e^x for -700 <= x <= 700.
constexpr double portable_exp(double x) noexcept {
  const double turns = x / (kLn2High + kLn2Low);
  const int k = static_cast<int>(turns < 0.0 ? turns - 0.5 : turns + 0.5);
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double sum = 1.0;
  for (int n = 14; n >= 1; --n) sum = 1.0 + r * sum / n;  // Taylor: |r| <= 0.35 leaves 2e-19
  for (int i = 0; i < k; ++i) sum *= 2.0;
  for (int i = 0; i > k; --i) sum *= 0.5;
  return sum;
}

/// ln x for normal x > 0.
constexpr double portable_log(double x) noexcept {
  int k = 0;
  while (x > 1.4142135623730951) {
    x *= 0.5;
    ++k;
  }
  while (x < 0.70710678118654757) {
    x *= 2.0;
    --k;
  }
  const double f = (x - 1.0) / (x + 1.0);
  const double f2 = f * f;
  double sum = 0.0;
  for (int n = 25; n >= 3; n -= 2) sum = f2 * (1.0 / n + sum);  // atanh series: f^2 <= 0.0295
  return k * kLn2High + (k * kLn2Low + 2.0 * (f + f * sum));
}

struct SinCos {
  double sin = 0.0;
  double cos = 1.0;
};

/// Sine and cosine of x [rad], |x| <= 1e6.
constexpr SinCos portable_sincos(double x) noexcept {
  // pi/2 in three pieces of 33 bits (fdlibm), so that n * piece is exact for |n| < 2^20.
  constexpr double kPiece1 = 1.57079632673412561417e+00;
  constexpr double kPiece2 = 6.07710050630396597660e-11;
  constexpr double kPiece3 = 2.02226624879595063154e-21;
  const double quarters = x / (0.5 * kPi);
  const auto n = static_cast<long long>(quarters < 0.0 ? quarters - 0.5 : quarters + 0.5);
  const auto turns = static_cast<double>(n);
  const double r = ((x - turns * kPiece1) - turns * kPiece2) - turns * kPiece3;
  const double r2 = r * r;
  double s = 1.0;
  double c = 1.0;
  for (int k = 18; k >= 2; k -= 2) s = 1.0 - s * r2 / (k * (k + 1));  // Taylor: |r| <= 0.79
  for (int k = 19; k >= 1; k -= 2) c = 1.0 - c * r2 / (k * (k + 1));
  s *= r;
  switch (n & 3) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

/// The angle in [0, pi] with the given cosine and sine >= 0 (need not be exactly normalised).
constexpr double portable_angle(double cosine, double sine) noexcept {
  double angle = 0.5 * kPi - cosine;
  if (cosine > 0.7) angle = sine;
  if (cosine < -0.7) angle = kPi - sine;
  for (int i = 0; i < 6; ++i) {  // each step subtracts the sine of the error: cubic convergence
    const SinCos at = portable_sincos(angle);
    angle += sine * at.cos - cosine * at.sin;
  }
  return angle;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
