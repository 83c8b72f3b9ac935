#include "plumb/numeric/tails.hpp"

#include <cmath>
#include <limits>

#include "plumb/core/detail/numbers.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::kInfinity;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double normal_density(double z) noexcept { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * kPi); }

// ---- chi-square --------------------------------------------------------------------------------

struct TailAndDensity {
  double tail;
  double density;
};

/// Tail of chi^2 and its density in x, by the finite sums that half-integer gamma functions have:
/// all terms are positive, so nothing cancels, and no log-gamma (not reentrant in C) is needed.
TailAndDensity chi2(double x, int dof) noexcept {
  const double y = 0.5 * x;
  const bool odd = dof % 2 != 0;
  // `pending` is the part of exp(-y) not yet multiplied in: for many degrees of freedom exp(-y)
  // underflows while the sum overflows, although their product is ordinary.
  constexpr double kChunk = 300.0;
  double pending = y;
  double term = odd ? 1.0 / std::sqrt(kPi * y) : 1.0;
  double sum = odd ? 0.0 : 1.0;
  const int last = (dof - 1) / 2;
  for (int k = 1; k <= last; ++k) {
    term *= y / (odd ? k - 0.5 : static_cast<double>(k));
    sum += term;
    if (sum > 1e100 && pending > kChunk) {
      term *= std::exp(-kChunk);
      sum *= std::exp(-kChunk);
      pending -= kChunk;
    }
  }
  const double factor = std::exp(-pending);
  const double tail = (odd ? std::erfc(std::sqrt(y)) : 0.0) + factor * sum;
  return {tail < 1.0 ? tail : 1.0, 0.5 * factor * term};
}

/// Start of the chi-square quantile: Wilson and Hilferty, kept positive.
double wilson_hilferty(double p, int dof) noexcept {
  const double c = 2.0 / (9.0 * dof);
  const double root = 1.0 - c + normal_tail_quantile(p) * std::sqrt(c);
  return root > 0.1 ? dof * root * root * root : 1e-3 * dof;
}

// ---- mean of half-normals ----------------------------------------------------------------------

/// Cumulants at tilt t of |Z|: K(t) = ln 2 + t^2/2 + ln Phi(t) and two derivatives.
struct Cumulants {
  double value;
  double slope;
  double curvature;
};

Cumulants half_normal_cumulants(double t) noexcept {
  constexpr double kAsymptotic = -12.0;
  if (t > kAsymptotic) {
    const double below = normal_tail(-t);
    const double ratio = normal_density(t) / below;
    const double slope = t + ratio;
    return {std::log(2.0) + 0.5 * t * t + std::log(below), slope, 1.0 - ratio * slope};
  }
  // Far below zero t^2/2 and ln Phi(t) cancel: Mills' ratio as a series, s = 1 - defect, t^2 r = t^2 / s.
  const double v = 1.0 / (t * t);
  const double defect = v * (1.0 - v * (3.0 - v * (15.0 - v * (105.0 - v * 945.0))));
  const double s = 1.0 - defect;
  const double slope = -t * defect / s;
  return {std::log(2.0 * s / (-t * std::sqrt(2.0 * kPi))), slope, 1.0 + t * slope / s};
}

/// P(mean of n > K'(t)) by Lugannani and Rice.
double half_normal_mean_tail(int n, double t) noexcept {
  const Cumulants k = half_normal_cumulants(t);
  constexpr double kCentral = 1e-4;
  if (std::fabs(t) < kCentral) {
    // 1/u - 1/w is 0/0 at the mean; its limit is -skewness / (6 sqrt n).
    constexpr double kSkewness = 0.99527174643115610;  // sqrt(2) (4 - pi) / (pi - 2)^1.5
    return normal_tail(t * std::sqrt(n * k.curvature)) - kSkewness / (6.0 * std::sqrt(2.0 * kPi * n));
  }
  const double exponent = t * k.slope - k.value;  // K is convex: above zero off the mean
  const double w = std::copysign(std::sqrt(2.0 * n * exponent), t);
  const double u = t * std::sqrt(n * k.curvature);
  return normal_tail(w) + normal_density(w) * (1.0 / u - 1.0 / w);
}

/// normal_tail_quantile for 0 < p <= 0.5: Abramowitz and Stegun 26.2.23 (4.5e-4), then Newton on
/// ln(tail), which is nearly a parabola.
double upper_quantile(double p) noexcept {
  const double t = std::sqrt(-2.0 * std::log(p));
  double z = t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  for (int i = 0; i < 4; ++i) {
    const double tail = normal_tail(z);
    z += std::log(tail / p) * tail / normal_density(z);
  }
  return z;
}

}  // namespace

double normal_tail(double z) noexcept { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

double normal_tail_quantile(double p) noexcept {
  if (std::isnan(p)) return kNan;
  if (p <= 0.0) return kInfinity;
  if (p >= 1.0) return -kInfinity;
  if (p > 0.5) return -upper_quantile(1.0 - p);  // 1 - p is exact here
  return upper_quantile(p);
}

double chi2_tail(double x, int dof) noexcept {
  if (dof < 1 || std::isnan(x)) return kNan;
  if (x <= 0.0) return 1.0;
  if (std::isinf(x)) return 0.0;
  return chi2(x, dof).tail;
}

double chi2_tail_quantile(double p, int dof) noexcept {
  if (dof < 1 || std::isnan(p)) return kNan;
  if (p <= 0.0) return kInfinity;
  if (p >= 1.0) return 0.0;
  double low = 0.0;
  double high = wilson_hilferty(p, dof);
  for (int i = 0; i < 60 && chi2_tail(high, dof) > p; ++i) {
    low = high;
    high *= 2.0;
  }
  double x = high;
  for (int i = 0; i < 100; ++i) {
    const TailAndDensity at = chi2(x, dof);
    (at.tail > p ? low : high) = x;
    const double step = std::log(at.tail / p) * at.tail / at.density;
    const double newton = x + step;
    // Newton on ln(tail) where it stays inside the bracket; NaN and overshoot fall back to bisection.
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::fabs(next - x) <= 1e-15 * x) return next;
    x = next;
  }
  return x;
}

namespace {

/// P(chi^2_dof / (chi^2_freedom / freedom) > y): with x = 1 / (1 + y / freedom) and h = freedom / 2, x^h times the sum
/// of h (h + 1) ... (h + j - 1) (1 - x)^j / j! over j below dof / 2.
double estimated_chi2_tail(double y, int dof, int freedom) noexcept {
  const double half = 0.5 * freedom, x = 1.0 / (1.0 + y / freedom);
  double term = std::exp(half * std::log(x)), sum = 0.0;
  for (int j = 0; j < dof / 2; ++j) {
    sum += term;
    term *= (half + j) / (j + 1.0) * (1.0 - x);
  }
  return sum;
}

}  // namespace

double estimated_chi2_tail_quantile(double p, int dof, int freedom) noexcept {
  if (dof < 2 || dof % 2 != 0 || freedom < 1 || std::isnan(p)) return kNan;
  if (p <= 0.0) return kInfinity;
  if (p >= 1.0) return 0.0;
  double low = chi2_tail_quantile(p, dof), high = low;
  for (int i = 0; i < 200 && estimated_chi2_tail(high, dof, freedom) > p; ++i) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (estimated_chi2_tail(middle, dof, freedom) > p ? low : high) = middle;
  }
  return high;
}

double estimated_sigma_widening(double chi2, int freedom, double p, int dof) noexcept {
  constexpr double kContradicted = 0.05;
  if (freedom < 1 || !(chi2_tail(chi2, freedom) < kContradicted)) return 1.0;
  return std::sqrt(estimated_chi2_tail_quantile(p, dof, freedom) / chi2_tail_quantile(p, dof));
}

double half_normal_mean_quantile(int n, double alpha) noexcept {
  if (n < 1 || std::isnan(alpha)) return kNan;
  if (alpha <= 0.0) return kInfinity;
  if (alpha >= 1.0) return 0.0;
  if (n == 1) return normal_tail_quantile(0.5 * alpha);
  // Chernoff: n (t^2/2 - ln 2) <= -ln alpha holds at the root for t > 0, so this bracket contains it.
  double low = -1e4;
  double high = 3.0 + std::sqrt(2.0 * (std::log(2.0) - std::log(alpha) / n));
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (half_normal_mean_tail(n, middle) > alpha ? low : high) = middle;
  }
  return half_normal_cumulants(0.5 * (low + high)).slope;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
