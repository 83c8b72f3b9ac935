/// Arrays and generators for the tests of the array room.
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "plumb/array/geometry.hpp"
#include "plumb/array/named.hpp"
#include "plumb/array/sensor_array.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
namespace test {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

inline std::vector<SensorRow> rows_of(const Vec3* axes, int n, double sigma_mps2 = 1.0) {
  std::vector<SensorRow> rows;
  for (int i = 0; i < n; ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "a%d", i);
    rows.push_back(SensorRow{make_id(name), axes[i], sigma_mps2});
  }
  return rows;
}

inline Expected<SensorArray> make(const std::vector<SensorRow>& rows) {
  return SensorArray::make(rows.data(), static_cast<int>(rows.size()));
}

/// An array that must be valid: a failure to build it ends the test.
inline SensorArray built(const Vec3* axes, int n, double sigma_mps2 = 1.0) {
  const Expected<SensorArray> array = make(rows_of(axes, n, sigma_mps2));
  if (!array) throw std::runtime_error(describe(array.error().code));
  return *array;
}

inline SensorArray tetrahedron(double sigma_mps2 = 1.0) {
  AxisList axes{};
  const int n = paper_tetrahedron(axes);
  return built(axes.data(), n, sigma_mps2);
}

/// z axes of the five triads of the mikoff5 recording (shared/data/README.md), normalised.
inline std::array<Vec3, 5> mikoff5_axes() {
  std::array<Vec3, 5> axes = {{{0.004, -0.863, 0.506},
                               {-0.860, 0.011, 0.510},
                               {0.013, 0.876, 0.483},
                               {0.876, 0.006, 0.483},
                               {0.002, 0.001, 1.000}}};
  for (Vec3& a : axes) a = scaled(a, 1.0 / norm(a));
  return axes;
}

inline double product(const Mat3& m, int row, const Vec3& v) {
  return m[at(3 * row)] * v[0] + m[at(3 * row + 1)] * v[1] + m[at(3 * row + 2)] * v[2];
}

/// Uniform in [low, high], both ends and the middle met often.
inline double any_in(double low, double high) {
  const int k = *rc::gen::weightedOneOf<int>(
      {{8, rc::gen::inRange(0, 1000001)}, {1, rc::gen::elementOf(std::vector<int>{0, 1, 500000, 999999, 1000000})}});
  return low + (high - low) * (k / 1e6);
}

/// Unit vectors, the coordinate axes among them.
inline Vec3 any_unit() {
  const double z = any_in(-1.0, 1.0);
  const double azimuth = any_in(0.0, 2.0 * kPi);
  const double r = std::sqrt(1.0 - z * z);
  const Vec3 v = {r * std::cos(azimuth), r * std::sin(azimuth), z};
  return scaled(v, 1.0 / norm(v));
}

/// Rotation of v about the unit vector u (Rodrigues).
inline Vec3 rotated(const Vec3& v, const Vec3& u, double angle) {
  const Vec3 along = scaled(u, dot(u, v) * (1.0 - std::cos(angle)));
  return plus(plus(scaled(v, std::cos(angle)), scaled(cross(u, v), std::sin(angle))), along);
}

/// Axes of rank 3 by construction: three on a turned cone (never flatter or sharper than 0.1 rad), the
/// others anywhere, copies and opposites of earlier ones included; sigmas equal or up to 100 apart.
inline std::vector<SensorRow> any_rows(int least = 3) {
  const int n = *rc::gen::inRange(least, kCapacity + 1);
  AxisList axes{};
  cone(axes, 3, any_in(0.1, 1.45));
  const Vec3 about = any_unit();
  const double angle = any_in(0.0, 2.0 * kPi);
  for (int i = 0; i < 3; ++i) {
    axes[at(i)] = rotated(axes[at(i)], about, angle);
    axes[at(i)] = scaled(axes[at(i)], 1.0 / norm(axes[at(i)]));
  }
  for (int i = 3; i < n; ++i) {
    const int kind = *rc::gen::inRange(0, 8);
    const Vec3& earlier = axes[at(*rc::gen::inRange(0, i))];
    axes[at(i)] = kind == 0 ? earlier : kind == 1 ? scaled(earlier, -1.0) : any_unit();
  }
  std::vector<SensorRow> rows = rows_of(axes.data(), n, 0.01);
  if (*rc::gen::arbitrary<bool>()) {
    for (SensorRow& row : rows) row.sigma_mps2 = 0.01 * std::pow(100.0, any_in(0.0, 1.0));
  }
  return rows;
}

inline SensorArray any_array(int least = 3) {
  const Expected<SensorArray> array = make(any_rows(least));
  RC_ASSERT(array.has_value());
  return *array;
}

inline Readings any_readings(double limit) {
  Readings y{};
  for (double& v : y) v = any_in(-limit, limit);
  return y;
}

}  // namespace test
}  // namespace plumb
