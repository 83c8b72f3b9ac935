#include "legendre.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {
namespace {

class Triangle {
 public:
  double& operator()(int n, int m) noexcept { return entries_[place(n, m)]; }
  double operator()(int n, int m) const noexcept { return entries_[place(n, m)]; }

 private:
  static constexpr std::size_t place(int n, int m) noexcept {
    return static_cast<std::size_t>(n * (kMaxDegree + 1) + m);
  }
  std::array<double, static_cast<std::size_t>((kMaxDegree + 1) * (kMaxDegree + 1))> entries_{};
};

double root(int square) noexcept { return std::sqrt(static_cast<double>(square)); }

/// Q(n, m), which is P(n, m) for m = 0 and P(n, m) / sin(theta) for m >= 1.
Triangle regular_functions(double c, double s) noexcept {
  Triangle q;
  q(0, 0) = 1.0;
  q(1, 0) = c;
  q(1, 1) = 1.0;
  for (int m = 2; m <= kMaxDegree; ++m) q(m, m) = s * std::sqrt((2.0 * m - 1.0) / (2.0 * m)) * q(m - 1, m - 1);
  for (int m = 0; m <= kMaxDegree; ++m) {
    for (int n = m + 1; n <= kMaxDegree; ++n) {
      const double before = n - 2 >= m ? root((n - 1) * (n - 1) - m * m) * q(n - 2, m) : 0.0;
      q(n, m) = ((2 * n - 1) * c * q(n - 1, m) - before) / root(n * n - m * m);
    }
  }
  return q;
}

}  // namespace

LegendreTable legendre_table(double cos_theta, double sin_theta) noexcept {
  const Triangle q = regular_functions(cos_theta, sin_theta);
  LegendreTable out;
  for (int n = 1; n <= kMaxDegree; ++n) {
    const std::size_t zonal = coefficient_index(n, 0);
    out.value[zonal] = q(n, 0);
    out.slope[zonal] = -root(n * (n + 1) / 2) * q(n, 1) * sin_theta;
    for (int m = 1; m <= n; ++m) {
      const std::size_t at = coefficient_index(n, m);
      out.over_sine[at] = q(n, m);
      out.value[at] = sin_theta * q(n, m);
      const double before = n - 1 >= m ? root(n * n - m * m) * q(n - 1, m) : 0.0;
      out.slope[at] = n * cos_theta * q(n, m) - before;
    }
  }
  return out;
}

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb
