/// Linear algebra of n x 3 measurement matrices. Private to the array module.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "plumb/core/config.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace array_detail {

/// Singular values below this count as zero (rank, and with it which triples have an inverse).
inline constexpr double kRankTolerance = 1e-6;

/// Rows of a measurement matrix, `count` of them in use.
struct Rows {
  std::array<Vec3, kCapacity> row{};
  int count = 0;

  void add(const Vec3& v) noexcept { row[static_cast<std::size_t>(count++)] = v; }
};

inline double column_dot(const Rows& m, std::size_t p, std::size_t q) noexcept {
  double sum = 0.0;
  for (int i = 0; i < m.count; ++i)
    sum += m.row[static_cast<std::size_t>(i)][p] * m.row[static_cast<std::size_t>(i)][q];
  return sum;
}

/// Turns columns p and q until they are orthogonal; false where they were already.
inline bool orthogonalise(Rows& m, std::size_t p, std::size_t q) noexcept {
  const double alpha = column_dot(m, p, p);
  const double beta = column_dot(m, q, q);
  const double gamma = column_dot(m, p, q);
  const double negligible = std::numeric_limits<double>::epsilon() * std::sqrt(alpha * beta);
  if (!(std::fabs(gamma) > negligible)) return false;
  const double zeta = (beta - alpha) / (2.0 * gamma);
  const double t = std::copysign(1.0, zeta) / (std::fabs(zeta) + std::sqrt(1.0 + zeta * zeta));
  const double c = 1.0 / std::sqrt(1.0 + t * t);
  const double s = c * t;
  for (int i = 0; i < m.count; ++i) {
    Vec3& r = m.row[static_cast<std::size_t>(i)];
    const double a = r[p];
    const double b = r[q];
    r[p] = c * a - s * b;
    r[q] = s * a + c * b;
  }
  return true;
}

/// Singular values in descending order by one-sided Jacobi rotations; those beyond the number of rows
/// are zero. Not by the eigenvalues of H'H: squaring halves the digits exactly where rank is decided.
inline Vec3 singular_values(Rows m) noexcept {
  constexpr int kMaxSweeps = 30;  // three columns settle in four or five
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    bool turned = orthogonalise(m, 0, 1);
    turned = orthogonalise(m, 0, 2) || turned;
    turned = orthogonalise(m, 1, 2) || turned;
    if (!turned) break;
  }
  Vec3 s = {std::sqrt(column_dot(m, 0, 0)), std::sqrt(column_dot(m, 1, 1)), std::sqrt(column_dot(m, 2, 2))};
  if (s[0] < s[1]) s = {s[1], s[0], s[2]};
  if (s[1] < s[2]) s = {s[0], s[2], s[1]};
  if (s[0] < s[1]) s = {s[1], s[0], s[2]};
  return s;
}

/// Inverse of H'H by its adjugate, all zero where it has none. Good to the square of the condition: for figures of
/// merit, not for estimates.
inline Mat3 inverse_normal(const Rows& m) noexcept {
  const double xx = column_dot(m, 0, 0);
  const double xy = column_dot(m, 0, 1);
  const double xz = column_dot(m, 0, 2);
  const double yy = column_dot(m, 1, 1);
  const double yz = column_dot(m, 1, 2);
  const double zz = column_dot(m, 2, 2);
  const double cxx = yy * zz - yz * yz;
  const double cxy = xz * yz - xy * zz;
  const double cxz = xy * yz - xz * yy;
  const double det = xx * cxx + xy * cxy + xz * cxz;
  if (!(det > 0.0)) return Mat3{};
  const double cyz = xy * xz - xx * yz;
  return {cxx / det,
          cxy / det,
          cxz / det,
          cxy / det,
          (xx * zz - xz * xz) / det,
          cyz / det,
          cxz / det,
          cyz / det,
          (xx * yy - xy * xy) / det};
}

/// Columns of the inverse of the matrix with rows a, b, c: x = column[0] ya + column[1] yb + column[2] yc.
inline std::array<Vec3, 3> inverse_columns(const Vec3& a, const Vec3& b, const Vec3& c, double det) noexcept {
  std::array<Vec3, 3> column = {cross(b, c), cross(c, a), cross(a, b)};
  for (Vec3& v : column) {
    for (double& entry : v) entry /= det;  // not times 1/det: one rounding less
  }
  return column;
}

}  // namespace array_detail
}  // namespace PLUMB_ABI
}  // namespace plumb
