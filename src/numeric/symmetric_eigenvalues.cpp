#include "plumb/numeric/symmetric_eigenvalues.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "plumb/core/detail/numbers.hpp"
#include "plumb/numeric/detail/add_scaled.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

constexpr int kMaxSteps = 60;  // for one eigenvalue; fewer than two are usual

/// Four columns of work, each longer by three than the matrix.
struct Columns {
  double *diagonal, *off_diagonal_sq, *u, *p;
};

/// Largest magnitude; not finite where an entry is not.
double largest_entry(const double* a, int n, int stride) noexcept {
  double largest = 0.0, sum = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double entry = std::fabs(a[i * stride + j]);
      largest = entry > largest ? entry : largest;
      sum += entry - entry;  // 0, or NaN for ever
    }
  }
  return largest + sum;
}

/// Columns below `i` in whole fours where the rows are long enough: what lies beyond is not read again.
int padded(int i, int stride) noexcept {
  const int fours = (i + 3) / 4 * 4;
  return fours <= stride ? fours : i / 4 * 4;
}

/// to += factor * from over `i` entries, and up to three more.
void add_row(double* to, const double* from, double factor, int i, int fours) noexcept {
  for (int j = 0; j < fours; j += 4) add_scaled<4>(to + j, from + j, factor);
  for (int j = fours; j < i; ++j) to[j] += factor * from[j];
}

/// Reflects row and column i of the leading block to (0, .., 0, e). Returns e.
double reflect(double* a, int i, int stride, double* u, double* p) noexcept {
  const double* given = a + at(i * stride);
  double square = 0.0;
  for (int k = 0; k + 1 < i; ++k) square += given[k] * given[k];
  const double last = given[i - 1];
  if (square == 0.0) return last;
  const double e = -std::copysign(std::sqrt(square + last * last), last);
  for (int k = 0; k < i + 3; ++k) {
    u[k] = k < i ? given[k] : 0.0;
    p[k] = 0.0;
  }
  u[i - 1] = last - e;
  const double h = 1.0 / (e * (e - last));  // 2 / u'u
  // A - u q' - q u' with p = A u h, q = p - u (u'p h / 2): by rows, so that nothing waits for a sum.
  const int fours = padded(i, stride);
  for (int k = 0; k < i; ++k) add_row(p, a + at(k * stride), u[k] * h, i, fours);
  double along = 0.0;
  for (int j = 0; j < i; ++j) along += u[j] * p[j];
  add_row(p, u, -0.5 * h * along, i, fours);
  for (int k = 0; k < i; ++k) {
    double* row = a + at(k * stride);
    add_row(row, p, -u[k], i, fours);
    add_row(row, u, -p[k], i, fours);
  }
  return e;
}

/// One QL step with shift on d[l..m] and the squared off-diagonals e2[l..m-1]; `shift` collects what was taken from the
/// diagonal. `tiny` replaces a vanishing pivot.
void ql_step(double* d, double* e2, int n, int l, int m, double tiny, double& shift) noexcept {
  const double s0 = std::sqrt(e2[l]);
  const double g0 = d[l];
  const double p0 = (d[l + 1] - g0) / (2.0 * s0);
  d[l] = s0 / (p0 + std::copysign(std::sqrt(p0 * p0 + 1.0), p0));
  const double taken = g0 - d[l];
  for (int i = l + 1; i < n; ++i) d[i] -= taken;
  shift += taken;
  double g = d[m] == 0.0 ? tiny : d[m];
  double h = g, s = 0.0;
  for (int i = m - 1; i >= l; --i) {
    const double p = g * h;
    const double r = p + e2[i];
    const double inverse = 1.0 / r;
    e2[i + 1] = s * r;
    s = e2[i] * inverse;
    d[i + 1] = h + s * (h + d[i]);
    g = d[i] - e2[i] / g;
    if (g == 0.0) g = tiny;
    h = g * (p * inverse);
  }
  e2[l] = s * g * h;
  d[l] = h;
}

/// Eigenvalues of the tridiagonal matrix into `values`, ascending.
bool solve_tridiagonal(double* d, double* e2, int n, double* values) noexcept {
  double shift = 0.0, scale = 0.0;
  e2[n - 1] = 0.0;
  for (int l = 0; l < n; ++l) {
    scale = std::fmax(scale, std::fabs(d[l]) + std::sqrt(e2[l]));
    const double tiny = std::numeric_limits<double>::epsilon() * scale;
    const double negligible = tiny * tiny;
    int step = 0;
    for (; step < kMaxSteps; ++step) {
      int m = l;
      while (e2[m] > negligible) ++m;  // ends at n - 1, where it is zero
      if (m == l) break;
      ql_step(d, e2, n, l, m, tiny, shift);
    }
    const double value = d[l] + shift;
    if (step == kMaxSteps || !std::isfinite(value)) return false;
    int k = l;
    for (; k > 0 && values[k - 1] > value; --k) values[k] = values[k - 1];
    values[k] = value;
  }
  return true;
}

bool eigenvalues(double* a, int n, int stride, double* values, const Columns& work) noexcept {
  const double largest = largest_entry(a, n, stride);
  if (!std::isfinite(largest)) return false;
  // Where squares might leave the range of a double: a power of two changes no digit.
  constexpr int kMild = 400, kExponent = 1000;
  const int exponent = largest > 0.0 ? std::ilogb(largest) : 0;
  double down = 1.0;
  if (exponent > kMild || exponent < -kMild) {
    down = std::ldexp(1.0, exponent > kExponent ? -kExponent : exponent < -kExponent ? kExponent : -exponent);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) a[i * stride + j] *= down;
    }
  }
  double *d = work.diagonal, *e2 = work.off_diagonal_sq;
  for (int i = n - 1; i > 0; --i) {
    const double e = i > 1 ? reflect(a, i, stride, work.u, work.p) : a[stride];
    e2[i - 1] = e * e;
    d[i] = a[i * stride + i];
  }
  d[0] = a[0];
  if (!solve_tridiagonal(d, e2, n, values)) return false;
  for (int i = 0; i < n; ++i) values[i] /= down;
  return std::isfinite(values[0]) && std::isfinite(values[n - 1]);
}

/// So much work lies on the stack as a matrix of that size needs.
template <int kMaxSize>
bool eigenvalues_of(double* a, int n, int stride, double* values) noexcept {
  if (a == nullptr || values == nullptr || n < 1 || n > kMaxSize || stride < n) return false;
  std::array<std::array<double, std::size_t{kMaxSize} + 4>, 4> column{};
  return eigenvalues(a, n, stride, values, {column[0].data(), column[1].data(), column[2].data(), column[3].data()});
}

}  // namespace

bool symmetric_eigenvalues(double* a, int n, int stride, double* values) noexcept {
  return eigenvalues_of<kMaxEigenSize>(a, n, stride, values);
}

bool symmetric_eigenvalues_of_few(double* a, int n, int stride, double* values) noexcept {
  return eigenvalues_of<2 * kCapacity>(a, n, stride, values);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
