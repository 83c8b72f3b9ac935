#include "plumb/motion/median_rate.hpp"

#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

using Component = std::array<double, kMostTriads>;

/// Few values: by insertion.
void sort(Component& values, std::size_t count) noexcept {
  for (std::size_t k = 1; k < count; ++k) {
    const double value = values[k];
    std::size_t at = k;
    for (; at > 0 && values[at - 1] > value; --at) values[at] = values[at - 1];
    values[at] = value;
  }
}

}  // namespace

MedianRate median_rate(const TriadRates& rates, int faults) noexcept {
  std::array<Component, 3> by_component{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(kMostTriads); ++k) {
    if (static_cast<int>(k) >= rates.triads || !rates.given[k] || !finite(rates.rate_radps[k])) continue;
    for (std::size_t c = 0; c < 3; ++c) by_component[c][count] = rates.rate_radps[k][c];
    ++count;
  }
  MedianRate out;
  out.given = faults >= 0 && faults<kMostTriads&& static_cast<int>(count)> 2 * faults;
  if (!out.given) return out;
  for (std::size_t c = 0; c < 3; ++c) {
    sort(by_component[c], count);
    // Halves first: the sum of two large ones may leave the range of a double.
    out.rate_radps[c] = 0.5 * by_component[c][(count - 1) / 2] + 0.5 * by_component[c][count / 2];
  }
  return out;
}

// A component of a healthy triad is within c + r |w| of that of the true rate w; of three components the length is
// within sqrt(3) times that, and |w| within it of the length that was read.
double median_error_radps(const GyroErrors& triad, double rate_radps, double noise_sigmas) noexcept {
  const double share = std::sqrt(3.0);
  const double relative = share * (triad.scale + std::sqrt(2.0) * triad.axis_rad);
  const double constant = share * (triad.bias_radps + noise_sigmas * triad.noise_radps);
  if (!(relative < 1.0)) return std::numeric_limits<double>::infinity();
  return constant + relative * (std::fabs(rate_radps) + constant) / (1.0 - relative);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
