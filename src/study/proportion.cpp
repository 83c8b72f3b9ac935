#include "plumb/study/proportion.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

Proportion proportion(std::uint64_t count, std::uint64_t trials, double confidence) {
  Proportion out;
  out.count = std::min(count, trials);
  out.trials = trials;
  if (trials == 0) return out;
  const double inside = confidence > 0.0 && confidence < 1.0 ? confidence : 0.95;
  const double tail = 0.5 * (1.0 - inside);
  const auto n = static_cast<double>(trials);
  const auto k = static_cast<double>(out.count);
  using Binomial = boost::math::binomial_distribution<>;
  if (out.count > 0) out.low = Binomial::find_lower_bound_on_p(n, k, tail);
  if (out.count < trials) out.high = Binomial::find_upper_bound_on_p(n, k, tail);
  return out;
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
