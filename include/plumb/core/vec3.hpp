/// Vectors and matrices of three as plain arrays: trivially copyable, so that whole monitors are.
#pragma once

#include <array>
#include <cmath>

#include "plumb/core/angles.hpp"
#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using Vec3 = std::array<double, 3>;
/// Row-major 3x3 matrix.
using Mat3 = std::array<double, 9>;

constexpr double dot(const Vec3& a, const Vec3& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
constexpr Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
constexpr Vec3 scaled(const Vec3& a, double s) noexcept { return {a[0] * s, a[1] * s, a[2] * s}; }
constexpr Vec3 plus(const Vec3& a, const Vec3& b) noexcept { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
constexpr Vec3 minus(const Vec3& a, const Vec3& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
/// Length; of the least-squares vector it is the measured gravity of the paper's eq (6).
inline double norm(const Vec3& a) noexcept { return std::sqrt(dot(a, a)); }
constexpr double det3(const Vec3& a, const Vec3& b, const Vec3& c) noexcept { return dot(a, cross(b, c)); }
constexpr Vec3 times(const Mat3& m, const Vec3& v) noexcept {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}
inline bool finite(const Vec3& a) noexcept { return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]); }
/// F C F': a covariance in another frame.
constexpr Mat3 turned_covariance(const Mat3& f, const Mat3& c) noexcept {
  Mat3 out{};
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3 half{};  // row of F C
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) half[j] += f[3 * i + k] * c[3 * k + j];
    }
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 3; ++k) sum += half[k] * f[3 * j + k];
      out[3 * i + j] = sum;
    }
  }
  return out;
}
/// Angle between two vectors in rad, from sine and cosine: exact near 0 and pi, where acos is not.
inline double angle_between_rad(const Vec3& a, const Vec3& b) noexcept {
  return angle_of(norm(cross(a, b)), dot(a, b));
}

}  // namespace PLUMB_ABI
}  // namespace plumb
