#include "plumb/detection/detectable.hpp"

#include <cmath>
#include <limits>

#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

constexpr double kLargestShift = 35.0;  // exp(-35^2/2) is still a number
constexpr double kExactLimit = 25.0;

}  // namespace

double missed_shift_probability(double shift, double limit, int dof) noexcept {
  if (!(limit > 0.0)) return 0.0;
  if (!(shift <= kLargestShift)) return shift - limit >= 10.0 ? 0.0 : 1.0;
  // Poisson mixture of central chi-squares: sum_j e^(-a) a^j / j! P(chi^2_(dof+2j) <= limit^2), a = shift^2 / 2. From
  // one term to the next the distribution loses x^(dof/2+j) e^(-x) / Gamma(dof/2+j+1), x = limit^2 / 2.
  const double a = 0.5 * shift * shift;
  const double x = 0.5 * limit * limit;
  const double tail = chi2_tail(limit * limit, dof);
  double below = 1.0 - tail;
  double step = chi2_tail(limit * limit, dof + 2) - tail;
  double weight = std::exp(-a);
  double sum = 0.0;
  constexpr int kTerms = 1200;  // a <= 613: beyond the mean by more than 23 standard deviations
  for (int j = 0; j < kTerms; ++j) {
    sum += weight * (below > 0.0 ? below : 0.0);
    below -= step;
    step *= x / (0.5 * dof + 1.0 + j);
    weight *= a / (j + 1.0);
  }
  return sum;
}

double detectable_shift(double limit, int dof, double p) noexcept {
  if (dof < 1) return std::numeric_limits<double>::quiet_NaN();
  // The component along the shift alone has to stay below the limit.
  double high = limit + normal_tail_quantile(p);
  if (!(limit <= kExactLimit) || !(high <= kLargestShift)) return high;
  double low = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (missed_shift_probability(middle, limit, dof) > p ? low : high) = middle;
  }
  return high;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
