/// How far errors of single readings move an estimate: what set_test.cpp and estimate_error.cpp have in common.
#pragma once

#include <cmath>

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Adds u v' to a 3x3 matrix.
inline void add_outer(Mat3& m, const Vec3& u, const Vec3& v) noexcept {
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t q = 0; q < 3; ++q) m[3 * r + q] += u[r] * v[q];
  }
}

/// How far errors of single readings can move a vector along itself and across.
struct Reach {
  double along = 0.0, across = 0.0;

  void add(const Vec3& column, const Vec3& u, double tau) noexcept {
    const double projection = dot(u, column);
    along += std::fabs(projection) * tau;
    across += norm(minus(column, scaled(u, projection))) * tau;
  }
  /// What remains of the length at least: the truth is `length` less what lies along it.
  double least_length(double length) const noexcept { return length > along ? length - along : 0.0; }
  /// Of the length: what moves across lengthens it by the square over twice the rest, and never by more than itself.
  double of_length_mps2(double length) const noexcept {
    const double rest = least_length(length);
    return along + (rest > across ? across * across / (2.0 * rest) : across);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
