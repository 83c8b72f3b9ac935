/// Tail probabilities and quantiles that turn false-alarm rates into limits. Pure functions, no
/// allocation, bounded iterations, usable on bare metal.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// P(Z > z), Z standard normal; accurate far into the tail (erfc).
double normal_tail(double z) noexcept;
/// z with P(Z > z) = p, 0 < p < 1; relative error of p below 1e-10 for p in [1e-15, 0.5].
double normal_tail_quantile(double p) noexcept;
/// P(chi^2_dof > x), dof >= 1 (regularised upper incomplete gamma).
double chi2_tail(double x, int dof) noexcept;
/// x with P(chi^2_dof > x) = p. Relative error of p below 1e-9 for dof 1..96, p in [1e-12, 0.999].
double chi2_tail_quantile(double p, int dof) noexcept;
/// The same where the standard deviation is estimated from `freedom` residuals: y with
/// P(chi^2_dof / (chi^2_freedom / freedom) > y) = p, which is dof times the quantile of F. `dof` is even (Abramowitz
/// and Stegun, 26.6.4), 2 to 96; freedom >= 1. Never less than that of chi^2.
double estimated_chi2_tail_quantile(double p, int dof, int freedom) noexcept;
/// How many times wider a bound at tail p on `dof` (even) normal numbers is because their standard deviation is
/// estimated: where residuals with `chi2` of `freedom` contradict the stated one, beyond its 5 % tail. Else 1
/// (docs/theory.md, section 3.3).
double estimated_sigma_widening(double chi2, int freedom, double p, int dof) noexcept;
/// q with P(mean of n half-normals |Z| > q) = alpha, by the Lugannani-Rice saddlepoint
/// (docs/theory.md, section 2.3): within 0.5 % of numerical convolution for n = 1..1024, alpha 1e-2..1e-9.
/// The limit of a triple's MAE is s_T * q(N, alpha). n = 1 is exact.
double half_normal_mean_quantile(int n, double alpha) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
