/// Arrays and blocks for the tests of thresholds.
#pragma once

#include <rapidcheck.h>

#include <cmath>
#include <vector>

#include "plumb/detection/set_test.hpp"
#include "support/simulated_tool.hpp"

namespace plumb_test {

using plumb::dot;
using plumb::norm;
using plumb::plus;
using plumb::scaled;

inline const plumb::GravityReference kGravity{plumb::kG0_mps2, plumb::kDefaultGravitySigma_mps2,
                                              plumb::GravityModel::value};
/// A reference without uncertainty.
inline const plumb::GravityReference kExact{plumb::kG0_mps2, 0.0, plumb::GravityModel::value};

inline plumb::BlockEvidence exact_block(const plumb::SensorArray& array, const plumb::Vec3& down, double samples) {
  plumb::BlockEvidence block;
  block.usable = array.all();
  block.samples = samples;
  for (int i = 0; i < array.size(); ++i)
    block.mean_mps2[static_cast<std::size_t>(i)] = plumb::kG0_mps2 * dot(array.axis(i), down);
  return block;
}

inline plumb::BlockEvidence noisy_block(const plumb::SensorArray& array, const plumb::Vec3& down, Noise& noise,
                                        double samples) {
  plumb::BlockEvidence block = exact_block(array, down, samples);
  for (int i = 0; i < array.size(); ++i)
    block.mean_mps2[static_cast<std::size_t>(i)] += array.sigma_mps2(i) / std::sqrt(samples) * noise.normal();
  return block;
}

/// Tetrahedron, cones of 5 to 8, two triads, five axes of which three lie nearly in one plane, five z axes of mikoff5.
inline std::vector<plumb::SensorArray> sample_arrays(double sigma_mps2) {
  using plumb::AxisList;
  using plumb::Vec3;
  std::vector<plumb::SensorArray> out = {tetrahedron(sigma_mps2)};
  for (int n = 5; n <= 8; ++n) out.push_back(cone_array(n, sigma_mps2));
  AxisList triads{};
  plumb::orthogonal_triad(triads);
  for (std::size_t i = 0; i < 3; ++i) triads[i + 3] = triads[i];
  out.push_back(make_array(triads, 6, sigma_mps2));
  AxisList flat{};
  plumb::paper_tetrahedron(flat);
  const Vec3 between = plus(plus(scaled(flat[0], 0.6), scaled(flat[1], 0.5)), scaled(flat[3], 0.06));
  flat[4] = scaled(between, 1.0 / norm(between));
  out.push_back(make_array(flat, 5, sigma_mps2));
  AxisList z{};
  const Vec3 mikoff5[5] = {{0.004, -0.863, 0.506},
                           {-0.860, 0.011, 0.510},
                           {0.013, 0.876, 0.483},
                           {0.876, 0.006, 0.483},
                           {0.002, 0.001, 1.0}};
  for (std::size_t i = 0; i < 5; ++i) z[i] = scaled(mikoff5[i], 1.0 / norm(mikoff5[i]));
  out.push_back(make_array(z, 5, sigma_mps2));
  return out;
}

inline double drawn(double low, double high) {
  const int k = *rc::gen::inRange(0, 1000001);
  return low + (high - low) * (k / 1e6);
}

inline plumb::Vec3 drawn_direction() {
  const double z = drawn(-1.0, 1.0);
  const double a = drawn(0.0, 2.0 * plumb::kPi);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(a), r * std::sin(a), z};
}

/// Four to capacity axes, the first three on a cone, the others anywhere; noises up to four times apart.
inline plumb::SensorArray drawn_array() {
  const int n = *rc::gen::inRange(4, plumb::kCapacity + 1);
  plumb::AxisList axes{};
  plumb::cone(axes, 3, drawn(0.3, 1.3));
  for (int i = 3; i < n; ++i) {
    const plumb::Vec3 v = drawn_direction();
    axes[static_cast<std::size_t>(i)] = scaled(v, 1.0 / norm(v));
  }
  std::array<plumb::SensorRow, plumb::kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    plumb::SensorRow& row = rows[static_cast<std::size_t>(i)];
    row.id = plumb::make_id(("a" + std::to_string(i + 1)).c_str());
    row.axis = axes[static_cast<std::size_t>(i)];
    row.sigma_mps2 = 1e-3 * drawn(0.5, 2.0);
  }
  const auto made = plumb::SensorArray::make(rows.data(), n);
  RC_ASSERT(made.has_value());
  return *made;
}

}  // namespace plumb_test
