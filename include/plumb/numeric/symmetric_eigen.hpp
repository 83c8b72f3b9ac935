/// Eigenvalues and eigenvectors of a symmetric matrix in storage that the caller owns.
#pragma once

#include "plumb/numeric/symmetric_eigenvalues.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Cyclic Jacobi: slower than tridiagonal methods, but small eigenvalues of a graded matrix keep their
/// relative accuracy, and the order of operations is fixed. No allocation, bounded sweeps.
///
/// `a` is n x n, row-major with leading dimension `stride`, 1 <= n <= kMaxEigenSize; both triangles must
/// agree; it is destroyed. `values` receives n eigenvalues in ascending order, `vectors` (n x n, same
/// stride) the orthonormal eigenvectors: column k belongs to values[k].
/// False where an argument is out of range, an entry is not finite, or the sweeps did not suffice; the
/// outputs are then not to be used.
bool symmetric_eigen(double* a, int n, int stride, double* values, double* vectors) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
