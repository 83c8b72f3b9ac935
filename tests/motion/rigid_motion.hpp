/// A rigid body that moves smoothly, written down as sums of sines, and what ideal or nearly ideal sensors on it read.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "plumb/motion/motion_monitor.hpp"
#include "support/simulated_tool.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

/// Three components, each a constant and two sines.
class SmoothVector {
 public:
  SmoothVector(Noise& noise, double constant, double amplitude, double lowest_hz, double highest_hz) {
    for (Component& c : components_) {
      c.constant = constant * (2.0 * noise.uniform() - 1.0);
      for (Sine& s : c.sines) {
        const double hz = lowest_hz * std::pow(highest_hz / lowest_hz, noise.uniform());
        s = {amplitude * noise.uniform(), 2.0 * plumb::kPi * hz, 2.0 * plumb::kPi * noise.uniform()};
      }
    }
  }
  plumb::Vec3 at(double t) const {
    return sum(
        t, [](const Sine& s, double p) { return s.amplitude * std::sin(p); }, 1.0);
  }
  plumb::Vec3 derivative(double t) const {
    return sum(
        t, [](const Sine& s, double p) { return s.amplitude * s.radps * std::cos(p); }, 0.0);
  }

 private:
  struct Sine {
    double amplitude = 0.0, radps = 0.0, phase = 0.0;
  };
  struct Component {
    double constant = 0.0;
    std::array<Sine, 2> sines{};
  };
  template <class F>
  plumb::Vec3 sum(double t, F of, double constants) const {
    plumb::Vec3 out{};
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = constants * components_[k].constant;
      for (const Sine& s : components_[k].sines) out[k] += of(s, s.radps * t + s.phase);
    }
    return out;
  }
  std::array<Component, 3> components_{};
};

/// What the sensors do wrong, within the bounds of a `MotionSetup`.
struct TrueErrors {
  std::array<plumb::MotionErrors, plumb::kCapacity> size{};  ///< signed, `lever_m` along `lever`
  std::array<plumb::Vec3, plumb::kCapacity> lever_m{};
  std::array<plumb::Vec3, plumb::kCapacity> axis{};  ///< added to the axis
  double gyro_scale = 0.0;
};

class RigidMotion {
 public:
  RigidMotion(const plumb::SensorArray& array, const plumb::MotionSetup& setup, std::uint64_t seed,
              double highest_hz = 20.0, double rate_radps = 3.0)
      : array_(&array),
        setup_(&setup),
        noise_(seed),
        force_(noise_, 15.0, 8.0, 0.2, highest_hz),
        rate_(noise_, rate_radps, 0.3 * rate_radps, 0.2, highest_hz) {}

  /// Errors drawn from the bounds: anywhere, or at the vertices.
  void draw_errors(bool vertices) {
    const auto draw = [&](double bound) {
      const double u = 2.0 * noise_.uniform() - 1.0;
      return vertices ? std::copysign(bound, u) : bound * u;
    };
    for (int i = 0; i < array_->size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const plumb::MotionErrors& e = setup_->errors[k];
      errors.size[k] = {0.0, draw(e.lag_s), draw(e.rectification), draw(e.scale), 0.0, draw(e.bias_mps2)};
      errors.lever_m[k] = {draw(e.lever_m), draw(e.lever_m), draw(e.lever_m)};
      const plumb::Vec3 across = plumb::cross(array_->axis(i), random_direction(noise_));
      errors.axis[k] = plumb::scaled(across, draw(e.axis_rad) / plumb::norm(across));
    }
    errors.gyro_scale = draw(setup_->gyro.scale);
  }

  /// From `time_s` on a step of the force, behind a second-order filter of 260 Hz: it begins between two samples.
  void add_shock(double time_s, const plumb::Vec3& step_mps2) {
    shock_s_ = time_s;
    shock_mps2_ = step_mps2;
  }

  plumb::Vec3 force(double t) const {
    return plumb::plus(force_.at(t), plumb::scaled(shock_mps2_, response(t - shock_s_)));
  }
  plumb::Vec3 rate(double t) const { return rate_.at(t); }

  plumb::MotionSample sample(std::uint64_t number) {
    return sample_at(static_cast<double>(number) * setup_->sample_period_s);
  }
  plumb::MotionSample sample_at(double t) {
    plumb::MotionSample out;
    out.time_s = t;
    out.delivered = array_->all();
    for (int i = 0; i < array_->size(); ++i) out.reading_mps2[static_cast<std::size_t>(i)] = reading(i, t);
    for (std::size_t g = 0; g < static_cast<std::size_t>(setup_->gyros); ++g) {
      out.rate_given[g] = true;
      out.rate_radps[g] = plumb::scaled(rate_.at(t), 1.0 + errors.gyro_scale);
      for (double& w : out.rate_radps[g]) w += setup_->gyro.noise_radps * noise_.normal();
    }
    return out;
  }

  TrueErrors errors;

 private:
  static double response(double after_s) {
    const double phase = std::sqrt(2.0) * plumb::kPi * 260.0 * after_s;
    return after_s > 0.0 ? 1.0 - std::exp(-phase) * (std::cos(phase) + std::sin(phase)) : 0.0;
  }
  double reading(int i, double t) {
    const auto k = static_cast<std::size_t>(i);
    const plumb::MotionErrors& e = errors.size[k];
    const double at = t + e.lag_s;
    const plumb::Vec3 arm = plumb::plus(setup_->lever_arm_m[k], errors.lever_m[k]), w = rate_.at(at);
    const plumb::Vec3 felt = plumb::plus(
        force(at), plumb::plus(plumb::cross(rate_.derivative(at), arm), plumb::cross(w, plumb::cross(w, arm))));
    const double y = plumb::dot(plumb::plus(array_->axis(i), errors.axis[k]), felt);
    return (1.0 + e.scale) * y + e.bias_mps2 + e.rectification * y * y + array_->sigma_mps2(i) * noise_.normal();
  }

  const plumb::SensorArray* array_;
  const plumb::MotionSetup* setup_;
  Noise noise_;
  SmoothVector force_, rate_;
  double shock_s_ = 0.0;
  plumb::Vec3 shock_mps2_{};
};

/// Arms of 10 to 30 mm, a gyro, and the errors of good sensors.
inline plumb::MotionSetup motion_setup(int n, std::uint64_t seed = 1) {
  plumb::MotionSetup out;
  Noise noise(seed);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    out.lever_arm_m[i] = plumb::scaled(random_direction(noise), 0.01 + 0.02 * noise.uniform());
    out.errors[i] = {1e-3, 60e-6, 1e-5, 1e-3, 1e-3, 1e-3 * plumb::kG0_mps2};
  }
  out.gyros = 1;
  out.gyro = {0.01, 0.0, 0.0, 1e-3, 0.0};
  out.rate_bound_radps = 10.0;
  return out;
}

/// The same axes: every so many sensors in a row, of the first `sensors`, are on one chip.
inline plumb::SensorArray in_chips(const plumb::SensorArray& array, int axes, int sensors = plumb::kCapacity) {
  std::array<plumb::SensorRow, plumb::kCapacity> rows{};
  for (int i = 0; i < array.size(); ++i) {
    rows[static_cast<std::size_t>(i)] = array.row(i);
    if (i < sensors) rows[static_cast<std::size_t>(i)].chip = static_cast<std::uint8_t>(1 + i / axes);
  }
  return *plumb::SensorArray::make(rows.data(), array.size());
}

/// Chips, each three axes at right angles, in the same position but for their arms.
inline plumb::SensorArray parallel_triads(int chips, double sigma_mps2 = 0.01) {
  plumb::AxisList axes{};
  for (int c = 0; c < chips; ++c) {
    for (int k = 0; k < 3; ++k) axes[static_cast<std::size_t>(3 * c + k)][static_cast<std::size_t>(k)] = 1.0;
  }
  return in_chips(make_array(axes, 3 * chips, sigma_mps2), 3);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_test
