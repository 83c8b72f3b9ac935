/// Gyro arrays and motions whose truth is known.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "plumb/commission/gyro_common.hpp"
#include "support/noise.hpp"

namespace plumb_test {

struct GyroScene {
  std::vector<plumb::commission::GyroNominal> nominal;
  std::vector<plumb::commission::FittedGyro> truth;
  double period_s = 0.01;
  double noise_radps = 0.002;
};

/// Axes on a cone about z and one along z, off nominal by `off` in every component of a row.
inline GyroScene gyro_scene(int axes, std::uint64_t seed, double off = 0.02, double delay_s = 0.004) {
  Noise noise(seed);
  GyroScene out;
  for (int i = 0; i < axes; ++i) {
    const double turn = 2.0 * plumb::kPi * i / (axes - 1);
    plumb::commission::GyroNominal nominal;
    nominal.axis = i + 1 == axes ? plumb::Vec3{0, 0, 1} : plumb::Vec3{0.8 * std::cos(turn), 0.8 * std::sin(turn), 0.6};
    nominal.noise_radps = out.noise_radps;
    plumb::commission::FittedGyro truth;
    for (std::size_t c = 0; c < 3; ++c) truth.row[c] = nominal.axis[c] + off * noise.normal();
    truth.bias_radps = 0.01 * noise.normal();
    truth.delay_s = delay_s * (2.0 * noise.uniform() - 1.0);
    out.nominal.push_back(nominal);
    out.truth.push_back(truth);
  }
  return out;
}

/// Two seconds at rest, then waves about the axes of which `about` is not zero.
struct GyroWaves {
  plumb::Vec3 about{1.5, 1.2, 1.4};
  std::array<double, 6> hz{};
  explicit GyroWaves(std::uint64_t seed) {
    Noise noise(seed);
    for (double& one : hz) one = 0.3 + 1.2 * noise.uniform();
  }
  plumb::Vec3 at(double t_s) const {
    plumb::Vec3 out{};
    const double begun = t_s <= 2.0 ? 0.0 : 1.0 - std::exp(-(t_s - 2.0) * (t_s - 2.0));
    for (std::size_t c = 0; c < 3; ++c)
      out[c] = begun * about[c] *
               (std::sin(2.0 * plumb::kPi * hz[c] * t_s + 1.0) + std::sin(2.0 * plumb::kPi * hz[c + 3] * t_s));
    return out;
  }
};

inline plumb::Vec3 gyro_force(double t_s) {
  return {5.0 * std::sin(1.7 * t_s), 6.0 * std::cos(2.3 * t_s), 9.8 + 4.0 * std::sin(3.1 * t_s)};
}

template <class Rate>
plumb::commission::GyroLog gyro_log(const GyroScene& scene, const Rate& rate_at, int samples, std::uint64_t seed,
                                    bool rest = true) {
  Noise noise(seed);
  plumb::commission::GyroLog out;
  out.period_s = scene.period_s;
  for (const plumb::commission::FittedGyro& axis : scene.truth) {
    out.rate_radps.emplace_back();
    for (int k = 0; k < samples; ++k) {
      const double t_s = k * scene.period_s;
      out.rate_radps.back().push_back(plumb::dot(axis.row, rate_at(t_s - axis.delay_s)) + axis.bias_radps +
                                      plumb::dot(axis.per_force, gyro_force(t_s)) + scene.noise_radps * noise.normal());
    }
  }
  for (int k = 0; k < samples; ++k) {
    if (rest) out.at_rest.push_back(k < 190);
    out.force_mps2.push_back(gyro_force(k * scene.period_s));
  }
  return out;
}

/// Rows as the fit pins them: least change against the nominal axes.
inline Eigen::MatrixXd pinned_rows(const GyroScene& scene) {
  const auto n = static_cast<Eigen::Index>(scene.truth.size());
  Eigen::MatrixXd rows(n, 3), wanted(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      rows(i, c) = scene.truth[static_cast<std::size_t>(i)].row[static_cast<std::size_t>(c)];
      wanted(i, c) = scene.nominal[static_cast<std::size_t>(i)].axis[static_cast<std::size_t>(c)];
    }
  }
  const Eigen::MatrixXd square = rows.transpose() * rows, product = rows.transpose() * wanted;
  return rows * square.ldlt().solve(product);
}

/// Mean of the delays: what all axes share is not told.
inline double mean_delay_s(const GyroScene& scene) {
  double out = 0.0;
  for (const plumb::commission::FittedGyro& axis : scene.truth)
    out += axis.delay_s / static_cast<double>(scene.truth.size());
  return out;
}

/// Rests of one second and turns of one second between them, each about one body axis.
struct GyroTurns {
  std::vector<plumb::Vec3> angle_rad;
  plumb::Vec3 at(double t_s) const {
    const double in = t_s - 2.0 * std::floor(t_s / 2.0) - 1.0;
    const auto turn = static_cast<std::size_t>(std::fmax(0.0, std::floor(t_s / 2.0)));
    if (t_s < 0.0 || in <= 0.0 || turn >= angle_rad.size()) return {};
    return plumb::scaled(angle_rad[turn], 1.0 - std::cos(2.0 * plumb::kPi * in));
  }
  int samples(double period_s) const {
    return static_cast<int>(std::lround((2.0 * static_cast<double>(angle_rad.size()) + 1.0) / period_s));
  }
};

inline std::vector<plumb::commission::GravityTurn> gravity_turns(const GyroTurns& turns, double period_s,
                                                                 double noise_rad, std::uint64_t seed) {
  Noise noise(seed);
  std::vector<plumb::commission::GravityTurn> out;
  Eigen::Vector3d g(0.0, 0.6, 0.8);
  const auto measured = [&] {
    return plumb::Vec3{g[0] + noise_rad * noise.normal(), g[1] + noise_rad * noise.normal(),
                       g[2] + noise_rad * noise.normal()};
  };
  plumb::Vec3 before = measured();
  for (std::size_t t = 0; t < turns.angle_rad.size(); ++t) {
    const plumb::Vec3& a = turns.angle_rad[t];
    const Eigen::Vector3d angle(a[0], a[1], a[2]);
    g = Eigen::AngleAxisd(-angle.norm(), angle.normalized()) * g;
    const auto at = [&](double t_s) { return static_cast<std::size_t>(std::lround(t_s / period_s)); };
    const double begin_s = 2.0 * static_cast<double>(t) + 0.9;
    const plumb::Vec3 after = measured();
    out.push_back({at(begin_s), at(begin_s + 1.2), before, after, 1e-3});
    before = after;
  }
  return out;
}

inline GyroTurns random_turns(int count, std::uint64_t seed) {
  Noise noise(seed);
  GyroTurns out;
  for (int t = 0; t < count; ++t)
    out.angle_rad.push_back(plumb::scaled(random_direction(noise), 1.0 + noise.uniform()));
  return out;
}

/// Rest is the first 0.8 s of every second second.
inline plumb::commission::GyroLog turning_log(const GyroScene& scene, const GyroTurns& turns, std::uint64_t seed) {
  auto out = gyro_log(
      scene, [&](double t_s) { return turns.at(t_s); }, turns.samples(scene.period_s), seed);
  for (std::size_t k = 0; k < out.samples(); ++k) {
    const double t_s = static_cast<double>(k) * scene.period_s, in = t_s - 2.0 * std::floor(t_s / 2.0);
    out.at_rest[k] = in > 0.1 && in < 0.9;
  }
  return out;
}

}  // namespace plumb_test
