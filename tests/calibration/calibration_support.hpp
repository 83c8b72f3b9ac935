/// Simulated tools for the tests of the calibration room: truth, readings, and how far a fit lies from it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "plumb/array/named.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/core/units.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"

namespace calibration_test {

using plumb::Vec3;

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// splitmix64 and Box-Muller: the same stream everywhere.
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
  Vec3 direction() {
    const double z = within(1.0), a = 2.0 * plumb::kPi * uniform(), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(a), r * std::sin(a), z};
  }

 private:
  std::uint64_t state_;
};

/// Datasheet of n sensors on the given axes: 3 V/g0, prior as wide as the truth below is spread.
inline plumb::Datasheet datasheet_of(const plumb::AxisList& axes, int n, double sigma_mps2,
                                     plumb::Reads reads = plumb::Reads::gravity) {
  plumb::Datasheet d;
  d.size = n;
  d.reads = reads;
  for (int i = 0; i < n; ++i) {
    plumb::DatasheetSensor& s = d.sensor[at(i)];
    s.row.id = plumb::make_id(("A" + std::to_string(i + 1)).c_str());
    s.row.axis = axes[at(i)];
    s.row.sigma_mps2 = sigma_mps2;
    s.coefficients.scale = {3.0 / plumb::kG0_mps2, 1e-5, 0.0, 0.0};
    s.coefficients.bias = {0.02, 1e-3, 0.0, 0.0};
    s.prior = {0.0115 * plumb::kG0_mps2, 0.0115, 0.0202};
  }
  return d;
}

inline plumb::Datasheet paper_tool(double sigma_mps2, plumb::Reads reads = plumb::Reads::gravity) {
  plumb::AxisList axes{};
  const int n = plumb::paper_tetrahedron(axes);
  return datasheet_of(axes, n, sigma_mps2, reads);
}

/// What the sensors really are: r = W g + b after the datasheet's model.
struct Truth {
  std::array<Vec3, plumb::kCapacity> w{};
  std::array<double, plumb::kCapacity> b{};
};

/// Bias within 0.02 g0, scale within 2 %, two tilts within 2 deg each, all times `spread`.
/// `spread` times bias +-0.02 g0 and scale +-2 %; each axis tilted by at most `tilt_rad` about two axes.
inline Truth draw_truth(const plumb::Datasheet& d, Noise& noise, double spread = 1.0, double tilt_rad = 0.0349) {
  Truth t;
  for (int i = 0; i < d.size; ++i) {
    const Vec3 h = d.sensor[at(i)].row.axis;
    const Vec3 helper = std::fabs(h[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    Vec3 p = plumb::cross(h, helper);
    p = plumb::scaled(p, 1.0 / plumb::norm(p));
    const Vec3 q = plumb::cross(h, p);
    // One draw a statement: the order of function arguments is the compiler's choice.
    const double about_q = std::tan(noise.within(tilt_rad));
    const double about_p = std::tan(noise.within(tilt_rad));
    Vec3 axis = plumb::plus(h, plumb::plus(plumb::scaled(p, about_q), plumb::scaled(q, about_p)));
    axis = plumb::scaled(axis, 1.0 / plumb::norm(axis));
    t.w[at(i)] = plumb::scaled(axis, 1.0 + noise.within(spread * 0.02));
    t.b[at(i)] = noise.within(spread * 0.02 * plumb::kG0_mps2);
  }
  return t;
}

inline plumb::Station station_at(const plumb::Datasheet& d, const Truth& truth, const Vec3& gravity, Noise& noise,
                                 double sigma_mps2, double temperature_degc = 25.0) {
  plumb::Readings r{};
  for (int i = 0; i < d.size; ++i) {
    r[at(i)] = plumb::dot(truth.w[at(i)], gravity) + truth.b[at(i)] + sigma_mps2 * noise.normal();
  }
  const auto raw = d.model().raw_from(r, temperature_degc);
  plumb::Station s;
  EXPECT_TRUE(raw.has_value());
  if (raw) s.mean = *raw;
  s.delivered = plumb::SensorSet::first(d.size);
  s.temperature_degc = temperature_degc;
  s.count = 1;
  return s;
}

inline std::vector<plumb::Station> random_stations(const plumb::Datasheet& d, const Truth& truth, int count,
                                                   Noise& noise, double sigma_mps2, double g_mps2 = plumb::kG0_mps2) {
  std::vector<plumb::Station> out;
  for (int k = 0; k < count; ++k) {
    const Vec3 g = plumb::scaled(noise.direction(), g_mps2);
    out.push_back(station_at(d, truth, g, noise, sigma_mps2));
  }
  return out;
}

/// Gravity in the tool at an inclination and a toolface.
inline Vec3 rolled(double inclination_deg, double toolface_deg) {
  const double i = plumb::rad_from_deg(inclination_deg), t = plumb::rad_from_deg(toolface_deg);
  return plumb::scaled({std::sin(i) * std::cos(t), std::sin(i) * std::sin(t), std::cos(i)}, plumb::kG0_mps2);
}

inline plumb::GravityReference standard_gravity() { return {plumb::kG0_mps2, 0.0, plumb::GravityModel::value}; }

/// W and b of the fit in the terms of `Truth`.
inline Truth fitted(const plumb::Datasheet& d, const plumb::Calibration& c) {
  Truth t;
  const double sign = d.reads == plumb::Reads::gravity ? 1.0 : -1.0;
  for (int i = 0; i < d.size; ++i) {
    const auto& now = c.model.sensor[at(i)];
    const auto& then = d.sensor[at(i)].coefficients;
    const double length = now.scale[0] / then.scale[0];
    t.w[at(i)] = plumb::scaled(c.array.axis(i), length);
    t.b[at(i)] = sign * (now.bias[0] * length - then.bias[0]);
  }
  return t;
}

/// v rotated by the vector `turn` (axis times angle).
inline Vec3 turned(const Vec3& v, const Vec3& turn) {
  const double angle = plumb::norm(turn);
  if (angle == 0.0) return v;
  const Vec3 axis = plumb::scaled(turn, 1.0 / angle), across = plumb::cross(axis, v);
  return plumb::plus(plumb::plus(v, plumb::scaled(across, std::sin(angle))),
                     plumb::scaled(plumb::cross(axis, across), 1.0 - std::cos(angle)));
}

/// `from` rotated so that it lies as near to `to` as one rotation allows; the rotation is a few degrees.
inline Vec3 turn_onto(std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  Vec3 total{};
  for (int step = 0; step < 20; ++step) {
    plumb::Mat3 m{};
    Vec3 torque{};
    for (std::size_t k = 0; k < from.size(); ++k) {
      const Vec3& u = from[k];
      for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t q = 0; q < 3; ++q) m[3 * p + q] += (p == q ? plumb::dot(u, u) : 0.0) - u[p] * u[q];
      }
      torque = plumb::plus(torque, plumb::cross(u, to[k]));
    }
    const Vec3 a = {m[0], m[1], m[2]}, b = {m[3], m[4], m[5]}, c = {m[6], m[7], m[8]};
    const double det = plumb::det3(a, b, c);
    const Vec3 turn = {plumb::det3(torque, b, c) / det, plumb::det3(a, torque, c) / det,
                       plumb::det3(a, b, torque) / det};
    for (Vec3& u : from) u = turned(u, turn);
    total = plumb::plus(total, turn);
  }
  return total;
}

/// Error of the parameters (truth - fit), per sensor W and b, with the best common rotation taken out. The
/// truth is turned first: a degree is too much for the linear removal below.
inline std::vector<double> observable_error(int n, Truth truth, const Truth& fit) {
  std::vector<Vec3> from(truth.w.begin(), truth.w.begin() + n), to(fit.w.begin(), fit.w.begin() + n);
  turn_onto(from, to);
  std::copy(from.begin(), from.end(), truth.w.begin());
  std::vector<double> d(at(4 * n));
  std::array<std::vector<double>, 3> r;
  for (int i = 0; i < n; ++i) {
    for (int p = 0; p < 3; ++p) d[at(4 * i + p)] = truth.w[at(i)][at(p)] - fit.w[at(i)][at(p)];
    d[at(4 * i + 3)] = truth.b[at(i)] - fit.b[at(i)];
  }
  for (int q = 0; q < 3; ++q) {
    Vec3 e{};
    e[at(q)] = 1.0;
    r[at(q)].assign(at(4 * n), 0.0);
    for (int i = 0; i < n; ++i) {
      const Vec3 w = plumb::cross(fit.w[at(i)], e);
      for (int p = 0; p < 3; ++p) r[at(q)][at(4 * i + p)] = w[at(p)];
    }
    for (int s = 0; s < q; ++s) {
      double shared = 0.0;
      for (std::size_t k = 0; k < d.size(); ++k) shared += r[at(q)][k] * r[at(s)][k];
      for (std::size_t k = 0; k < d.size(); ++k) r[at(q)][k] -= shared * r[at(s)][k];
    }
    double length = 0.0, shared = 0.0;
    for (const double v : r[at(q)]) length += v * v;
    for (double& v : r[at(q)]) v /= std::sqrt(length);
    for (std::size_t k = 0; k < d.size(); ++k) shared += r[at(q)][k] * d[k];
    for (std::size_t k = 0; k < d.size(); ++k) d[k] -= shared * r[at(q)][k];
  }
  return d;
}

/// Error of what the calibrated tool says over the sphere, in the absence of noise.
struct SphereError {
  double tilt_rad = 0.0;    ///< rms angle, best common rotation removed
  double turned_rad = 0.0;  ///< that rotation
  double parity_g0 = 0.0;   ///< rms of the parity residual
};

inline SphereError sphere_error(const plumb::Datasheet& d, const Truth& truth, const plumb::Calibration& c) {
  constexpr int kPoints = 200;
  const plumb::LeastSquares ls = plumb::least_squares(c.array, c.array.all());
  EXPECT_TRUE(ls.valid);
  std::vector<Vec3> asked, said;
  double parity = 0.0;
  Noise none(0);
  for (int k = 0; k < kPoints; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / kPoints, a = k * plumb::kPi * (3.0 - std::sqrt(5.0)),
                 r = std::sqrt(1.0 - z * z);
    const Vec3 u = {r * std::cos(a), r * std::sin(a), z};
    const plumb::Station s = station_at(d, truth, plumb::scaled(u, plumb::kG0_mps2), none, 0.0);
    const plumb::Readings y = c.model.apply(s.mean, s.temperature_degc, s.delivered);
    const Vec3 x = ls.estimate(y);
    for (int i = 0; i < d.size; ++i) {
      const double e = y[at(i)] - plumb::dot(c.array.axis(i), x);
      parity += e * e / kPoints / std::fmax(1.0, d.size - 3);
    }
    asked.push_back(u);
    said.push_back(plumb::scaled(x, 1.0 / plumb::norm(x)));
  }
  const Vec3 total = turn_onto(said, asked);
  double square = 0.0;
  for (int k = 0; k < kPoints; ++k) {
    const double angle = plumb::angle_between_rad(said[at(k)], asked[at(k)]);
    square += angle * angle / kPoints;
  }
  return {std::sqrt(square), plumb::norm(total), std::sqrt(parity) / plumb::kG0_mps2};
}

/// d' Cov^+ d over the `rank` largest eigenvalues of the covariance that the calibrated array carries.
inline double observable_chi2(const plumb::Datasheet& d, const Truth& truth, const plumb::Calibration& c, int rank) {
  const int n4 = 4 * d.size;
  const Truth fit = fitted(d, c);
  std::vector<double> error = observable_error(d.size, truth, fit);
  std::vector<double> a(at(n4 * n4)), v(at(n4 * n4)), values(at(n4));
  const auto unit = [](int k) { return k % 4 == 3 ? 1.0 / plumb::kG0_mps2 : 1.0; };
  for (int i = 0; i < n4; ++i) {
    for (int j = 0; j < n4; ++j) {
      const int hi = i > j ? i : j, lo = i > j ? j : i;
      const double lengths = plumb::norm(fit.w[at(i / 4)]) * plumb::norm(fit.w[at(j / 4)]);
      a[at(i * n4 + j)] = c.array.uncertainty().covariance[at(hi * (hi + 1) / 2 + lo)] * lengths * unit(i) * unit(j);
    }
  }
  EXPECT_TRUE(plumb::symmetric_eigen(a.data(), n4, n4, values.data(), v.data()));
  double chi2 = 0.0;
  for (int k = n4 - rank; k < n4; ++k) {
    double along = 0.0;
    for (int i = 0; i < n4; ++i) along += v[at(i * n4 + k)] * error[at(i)] * unit(i);
    chi2 += along * along / values[at(k)];
  }
  return chi2;
}

}  // namespace calibration_test
