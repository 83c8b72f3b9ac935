#include "plumb/numeric/cholesky.hpp"

#include <cmath>
#include <cstddef>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

std::size_t at(int i, int j, int stride) noexcept {
  return static_cast<std::size_t>(i) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(j);
}

/// L becomes its own inverse, column by column; entries to the right and above are still L when read.
void invert_lower(double* l, int n, int stride) noexcept {
  for (int j = 0; j < n; ++j) {
    l[at(j, j, stride)] = 1.0 / l[at(j, j, stride)];
    for (int i = j + 1; i < n; ++i) {
      double sum = 0.0;
      for (int k = j; k < i; ++k) sum -= l[at(i, k, stride)] * l[at(k, j, stride)];
      l[at(i, j, stride)] = sum / l[at(i, i, stride)];
    }
  }
}

}  // namespace

bool cholesky_factor(double* a, int n, int stride) noexcept {
  if (a == nullptr || n < 1 || stride < n) return false;
  for (int j = 0; j < n; ++j) {
    double pivot = a[at(j, j, stride)];
    for (int k = 0; k < j; ++k) pivot -= a[at(j, k, stride)] * a[at(j, k, stride)];
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    const double diagonal = std::sqrt(pivot);
    a[at(j, j, stride)] = diagonal;
    for (int i = j + 1; i < n; ++i) {
      double sum = a[at(i, j, stride)];
      for (int k = 0; k < j; ++k) sum -= a[at(i, k, stride)] * a[at(j, k, stride)];
      a[at(i, j, stride)] = sum / diagonal;
    }
  }
  return true;
}

void cholesky_solve(const double* l, int n, int stride, double* b) noexcept {
  for (int i = 0; i < n; ++i) {
    double sum = b[i];
    for (int k = 0; k < i; ++k) sum -= l[at(i, k, stride)] * b[k];
    b[i] = sum / l[at(i, i, stride)];
  }
  for (int i = n - 1; i >= 0; --i) {
    double sum = b[i];
    for (int k = i + 1; k < n; ++k) sum -= l[at(k, i, stride)] * b[k];
    b[i] = sum / l[at(i, i, stride)];
  }
}

void cholesky_inverse(double* l, int n, int stride) noexcept {
  invert_lower(l, n, stride);
  // M'M with M = L^-1, top row first: entry (i, j), j <= i, needs rows i and below only, still M there.
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = i; k < n; ++k) sum += l[at(k, i, stride)] * l[at(k, j, stride)];
      l[at(i, j, stride)] = sum;
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) l[at(i, j, stride)] = l[at(j, i, stride)];
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
