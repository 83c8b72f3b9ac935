/// Eigenvalues alone of a symmetric matrix in storage that the caller owns: several times faster than
/// `symmetric_eigen`.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Ten parameters a sensor are the most that anything here fits.
inline constexpr int kMaxEigenSize = 10 * kCapacity;

/// Householder tridiagonalisation, then rational QL (Pal, Walker and Kahan). Every value is good to rounding relative
/// to the largest, not to itself: use `symmetric_eigen` where small ones of a graded matrix matter. No allocation,
/// bounded.
///
/// `a` is n x n, row-major with leading dimension `stride`, 1 <= n <= kMaxEigenSize; both triangles must agree; it is
/// destroyed. `values` receives n eigenvalues in ascending order. False where an argument is out of range, an entry is
/// not finite, or the iteration did not suffice; `values` is then not to be used.
bool symmetric_eigenvalues(double* a, int n, int stride, double* values) noexcept;
/// The same of up to two parameters a sensor, n <= 2 kCapacity, on a small stack.
bool symmetric_eigenvalues_of_few(double* a, int n, int stride, double* values) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
