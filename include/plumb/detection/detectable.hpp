/// How large must a shift be to be found.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// P(|z + shift| <= limit) for dof independent standard normal z and a shift of the given length: the chance that a
/// chi-square test misses it. dof >= 1, 0 <= limit, shift <= 35 (beyond: 0 where the shift exceeds the limit by 10 or
/// more, else 1). Absolute error below 1e-12.
double missed_shift_probability(double shift, double limit, int dof) noexcept;

/// The shift that is missed with probability p (1e-9 .. 0.5). Exact for limits up to 25; above, the bound
/// limit + normal quantile, which the exact value stays below by at most (dof - 1) / (2 limit). NaN for dof < 1.
double detectable_shift(double limit, int dof, double p) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
