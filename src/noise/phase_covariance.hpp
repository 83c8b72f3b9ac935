/// Covariances of phases, sums of the readings so far (private to src/noise).
///
/// A phase is not stationary; its second differences are, and these generalised covariances give theirs (Greenhall and
/// Riley, 2003).
#pragma once

#include "plumb/noise/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

/// Of noise terms in units of one sample: Q^2/T^2, N^2/T, B^2, K^2 T for a sample period T.
Variances per_sample(const Variances& squares, double period_s) noexcept;

/// Of phases `lag` samples apart, without quantisation, whose covariance is Q^2 at lag 0 and nothing elsewhere.
double smooth_phase_covariance(const Variances& unit, double lag) noexcept;

/// Covariance of second differences x(k + m) - 2 x(k) + x(k - m) whose places are `lag` samples apart, m = `step`;
/// quantisation counts where a lag is a whole multiple of m.
double second_difference_covariance(const Variances& unit, double step, double lag) noexcept;

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
