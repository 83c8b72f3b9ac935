/// Cholesky factor, solve and inverse of a symmetric positive definite matrix, in storage that the
/// caller owns: row-major with leading dimension `stride` >= n. No allocation, any n >= 1.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Replaces the lower triangle of `a` by L with L L' = A; reads nothing above the diagonal and leaves it
/// alone. False at the first pivot that is not positive or not finite: A is not positive definite (or
/// holds a NaN), and the lower triangle is then not to be used.
bool cholesky_factor(double* a, int n, int stride) noexcept;

/// The same of a packed lower triangle: entry (i, j), j <= i, at i(i + 1)/2 + j.
bool cholesky_factor_packed(double* a, int n) noexcept;
void cholesky_solve_packed(const double* l, int n, double* b) noexcept;

/// Solves A x = b in place, `l` as left by `cholesky_factor`.
void cholesky_solve(const double* l, int n, int stride, double* b) noexcept;

/// Replaces the factor L in the lower triangle by the inverse of A, both triangles filled and equal.
void cholesky_inverse(double* l, int n, int stride) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
