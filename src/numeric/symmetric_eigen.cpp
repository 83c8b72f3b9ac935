#include "plumb/numeric/symmetric_eigen.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "plumb/numeric/hypotenuse.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

constexpr int kMaxSweeps = 50;  // quadratic convergence: fewer than ten are seen up to n = 96

/// Square matrix in storage of the caller.
struct View {
  double* data;
  std::size_t stride;
  double& operator()(int i, int j) const noexcept {
    return data[static_cast<std::size_t>(i) * stride + static_cast<std::size_t>(j)];
  }
};

/// Largest magnitude; not finite where an entry is not.
double largest_of(const View& a, int n) noexcept {
  double largest = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (!std::isfinite(a(i, j))) return a(i, j);
      largest = std::fmax(largest, std::fabs(a(i, j)));
    }
  }
  return largest;
}

void scale_by_power(const View& a, int n, int exponent) noexcept {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) a(i, j) = std::ldexp(a(i, j), exponent);
  }
}

void set_identity(const View& v, int n) noexcept {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) v(i, j) = i == j ? 1.0 : 0.0;
  }
}

/// Whether a(p,q) no longer moves either eigenvalue. The geometric mean of the diagonal entries, not
/// the norm of the matrix: it is what keeps small eigenvalues of a positive matrix accurate.
bool negligible(const View& a, int p, int q) noexcept {
  const double off = std::fabs(a(p, q));
  const double scale = std::sqrt(std::fabs(a(p, p))) * std::sqrt(std::fabs(a(q, q)));
  return off <= std::numeric_limits<double>::epsilon() * scale || off < std::numeric_limits<double>::min();
}

/// Rotates in the plane (p, q) so that a(p,q) becomes zero.
void rotate(const View& a, const View& v, int n, int p, int q) noexcept {
  const double apq = a(p, q);
  const double theta = 0.5 * (a(q, q) - a(p, p)) / apq;
  // Not a root of 1 + theta^2: theta is huge for a nearly diagonal pair, and its square overflows.
  const double t = std::copysign(1.0, theta) / (std::fabs(theta) + hypotenuse(1.0, theta));
  const double c = 1.0 / std::sqrt(1.0 + t * t);
  const double s = t * c;
  a(p, p) -= t * apq;
  a(q, q) += t * apq;
  a(p, q) = 0.0;
  a(q, p) = 0.0;
  for (int k = 0; k < n; ++k) {
    if (k != p && k != q) {
      const double akp = a(k, p);
      const double akq = a(k, q);
      a(k, p) = c * akp - s * akq;
      a(p, k) = a(k, p);
      a(k, q) = s * akp + c * akq;
      a(q, k) = a(k, q);
    }
    const double vkp = v(k, p);
    const double vkq = v(k, q);
    v(k, p) = c * vkp - s * vkq;
    v(k, q) = s * vkp + c * vkq;
  }
}

/// Selection sort: n is small, and equal values keep a fixed order.
void sort_ascending(double* values, const View& v, int n) noexcept {
  for (int i = 0; i + 1 < n; ++i) {
    int least = i;
    for (int k = i + 1; k < n; ++k) {
      if (values[k] < values[least]) least = k;
    }
    if (least == i) continue;
    const double value = values[i];
    values[i] = values[least];
    values[least] = value;
    for (int k = 0; k < n; ++k) {
      const double entry = v(k, i);
      v(k, i) = v(k, least);
      v(k, least) = entry;
    }
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-non-const-parameter): both are written, through the views below
bool symmetric_eigen(double* a, int n, int stride, double* values, double* vectors) noexcept {
  if (a == nullptr || values == nullptr || vectors == nullptr) return false;
  if (n < 1 || n > kMaxEigenSize || stride < n) return false;
  const View m = {a, static_cast<std::size_t>(stride)};
  const View v = {vectors, static_cast<std::size_t>(stride)};
  const double largest = largest_of(m, n);
  if (!std::isfinite(largest)) return false;
  // A power of two changes no digit, and keeps every square inside the range of a double.
  const int exponent = largest > 0.0 ? std::ilogb(largest) : 0;
  scale_by_power(m, n, -exponent);
  set_identity(v, n);
  bool turned = true;
  for (int sweep = 0; turned && sweep < kMaxSweeps; ++sweep) {
    turned = false;
    for (int p = 0; p + 1 < n; ++p) {
      for (int q = p + 1; q < n; ++q) {
        if (negligible(m, p, q)) continue;
        rotate(m, v, n, p, q);
        turned = true;
      }
    }
  }
  for (int i = 0; i < n; ++i) values[i] = std::ldexp(m(i, i), exponent);
  sort_ascending(values, v, n);
  return !turned && std::isfinite(values[0]) && std::isfinite(values[n - 1]);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
