#include "plumb/numeric/cholesky.hpp"

#include <cmath>
#include <cstddef>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

std::size_t entry_at(int i, int j, int stride) noexcept {
  return static_cast<std::size_t>(i) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(j);
}

/// Where entry (i, j), j <= i, stands.
struct Strided {
  int stride;
  std::size_t operator()(int i, int j) const noexcept { return entry_at(i, j, stride); }
};
struct PackedTriangle {
  std::size_t operator()(int i, int j) const noexcept {
    const auto row = static_cast<std::size_t>(i);
    return row * (row + 1) / 2 + static_cast<std::size_t>(j);
  }
};

template <class Place>  // NOLINTNEXTLINE(readability-non-const-parameter): it is written to
bool factorise(double* a, int n, Place place) noexcept {
  for (int j = 0; j < n; ++j) {
    double pivot = a[place(j, j)];
    for (int k = 0; k < j; ++k) pivot -= a[place(j, k)] * a[place(j, k)];
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    const double diagonal = std::sqrt(pivot);
    a[place(j, j)] = diagonal;
    for (int i = j + 1; i < n; ++i) {
      double sum = a[place(i, j)];
      for (int k = 0; k < j; ++k) sum -= a[place(i, k)] * a[place(j, k)];
      a[place(i, j)] = sum / diagonal;
    }
  }
  return true;
}

template <class Place>
void solve_in_place(const double* l, int n, Place place, double* b) noexcept {
  for (int i = 0; i < n; ++i) {
    double sum = b[i];
    for (int k = 0; k < i; ++k) sum -= l[place(i, k)] * b[k];
    b[i] = sum / l[place(i, i)];
  }
  for (int i = n - 1; i >= 0; --i) {
    double sum = b[i];
    for (int k = i + 1; k < n; ++k) sum -= l[place(k, i)] * b[k];
    b[i] = sum / l[place(i, i)];
  }
}

/// L becomes its own inverse, column by column; entries to the right and above are still L when read.
void invert_lower(double* l, int n, int stride) noexcept {
  for (int j = 0; j < n; ++j) {
    l[entry_at(j, j, stride)] = 1.0 / l[entry_at(j, j, stride)];
    for (int i = j + 1; i < n; ++i) {
      double sum = 0.0;
      for (int k = j; k < i; ++k) sum -= l[entry_at(i, k, stride)] * l[entry_at(k, j, stride)];
      l[entry_at(i, j, stride)] = sum / l[entry_at(i, i, stride)];
    }
  }
}

}  // namespace

bool cholesky_factor(double* a, int n, int stride) noexcept {
  return a != nullptr && n >= 1 && stride >= n && factorise(a, n, Strided{stride});
}

bool cholesky_factor_packed(double* a, int n) noexcept {
  return a != nullptr && n >= 1 && factorise(a, n, PackedTriangle{});
}

void cholesky_solve(const double* l, int n, int stride, double* b) noexcept {
  solve_in_place(l, n, Strided{stride}, b);
}

void cholesky_solve_packed(const double* l, int n, double* b) noexcept { solve_in_place(l, n, PackedTriangle{}, b); }

void cholesky_inverse(double* l, int n, int stride) noexcept {
  invert_lower(l, n, stride);
  // M'M with M = L^-1, top row first: entry (i, j), j <= i, needs rows i and below only, still M there.
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = i; k < n; ++k) sum += l[entry_at(k, i, stride)] * l[entry_at(k, j, stride)];
      l[entry_at(i, j, stride)] = sum;
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) l[entry_at(i, j, stride)] = l[entry_at(j, i, stride)];
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
