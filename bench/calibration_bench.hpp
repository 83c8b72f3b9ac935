// Simulated calibrations for the benchmarks, for whatever capacity the including file is compiled with (which is why
// the capacity is in the namespace: the same program holds this file twice).
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "plumb/array/named.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/core/units.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

/// splitmix64 and Box-Muller.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  double uniform() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    z ^= z >> 31U;
    return static_cast<double>(z >> 11U) * 0x1.0p-53;
  }
  double within(double bound) { return bound * (2.0 * uniform() - 1.0); }
  double normal() {
    const double u = 1.0 - uniform();
    const double v = uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * plumb::kPi * v);
  }

 private:
  std::uint64_t state_;
};

inline constexpr double kSigma_mps2 = 2e-4 * plumb::kG0_mps2;

struct Problem {
  plumb::Datasheet sheet;
  std::vector<plumb::Station> stations;
};

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

inline plumb::GravityReference gravity() { return {plumb::kG0_mps2, 0.0, plumb::GravityModel::value}; }

/// n sensors whose bias, scale and axes lie within 0.02 g0, 2 % and 2 deg of the datasheet; attitudes at random.
inline Problem problem_of(int n, int count, std::uint64_t seed) {
  Problem p;
  plumb::AxisList axes{};
  if (n == 3) {
    plumb::orthogonal_triad(axes);
  } else if (n == 4) {
    plumb::paper_tetrahedron(axes);
  } else {
    plumb::cone_with_axis(axes, n);
  }
  Noise noise(seed);
  p.sheet.size = n;
  std::vector<plumb::Vec3> w(at(n));
  std::vector<double> b(at(n));
  for (int i = 0; i < n; ++i) {
    plumb::DatasheetSensor& s = p.sheet.sensor[at(i)];
    s.row.id = plumb::make_id(("a" + std::to_string(i + 1)).c_str());
    s.row.axis = axes[at(i)];
    s.row.sigma_mps2 = kSigma_mps2;
    s.coefficients.scale = {3.0 / plumb::kG0_mps2, 0.0, 0.0, 0.0};
    s.prior = {0.0115 * plumb::kG0_mps2, 0.0115, 0.0202};
    for (double& component : w[at(i)]) component = 0.035 * noise.within(1.0);
    w[at(i)] = plumb::plus(w[at(i)], axes[at(i)]);
    w[at(i)] = plumb::scaled(w[at(i)], (1.0 + noise.within(0.02)) / plumb::norm(w[at(i)]));
    b[at(i)] = noise.within(0.02 * plumb::kG0_mps2);
  }
  for (int k = 0; k < count; ++k) {
    const double z = noise.within(1.0), a = 2.0 * plumb::kPi * noise.uniform(), r = std::sqrt(1.0 - z * z);
    const plumb::Vec3 g = plumb::scaled({r * std::cos(a), r * std::sin(a), z}, plumb::kG0_mps2);
    plumb::Station s;
    s.delivered = plumb::SensorSet::first(n);
    s.temperature_degc = 25.0;
    s.count = 1;
    for (int i = 0; i < n; ++i) {
      const double reading = plumb::dot(w[at(i)], g) + b[at(i)] + kSigma_mps2 * noise.normal();
      s.mean[at(i)] = 3.0 / plumb::kG0_mps2 * reading;
    }
    p.stations.push_back(s);
  }
  return p;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
