/// A tool with four accelerometers and a group of gyros whose truth is known: its array file and its logs.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "plumb/core/vec3.hpp"
#include "support/noise.hpp"

namespace plumb_test {

struct GyroTool {
  static constexpr double kPeriod_s = 0.01, kGravity_mps2 = 9.81, kNoise_degps = 0.05;

  struct Axis {
    std::string id, chip;
    plumb::Vec3 nominal{}, row{};
    double bias_radps = 0.0, delay_s = 0.0;
    plumb::Vec3 per_force{};
  };
  std::vector<Axis> axis;

  /// `chips` of three axes each, every chip turned; off nominal by `off` in each component of a row.
  static GyroTool of_chips(int chips, std::uint64_t seed, double off = 0.006) {
    Noise noise(seed);
    GyroTool out;
    for (int c = 0; c < chips; ++c) {
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.4 * c, Eigen::Vector3d(0.36, 0.48, 0.8)).toRotationMatrix();
      for (int k = 0; k < 3; ++k) {
        Axis one;
        one.chip = "imu" + std::to_string(c + 1);
        one.id = std::string(1, "xyz"[k]) + std::to_string(c + 1);
        for (int j = 0; j < 3; ++j) one.nominal[static_cast<std::size_t>(j)] = turn(k, j);
        for (std::size_t j = 0; j < 3; ++j) {
          one.row[j] = one.nominal[j] + off * noise.normal();
          one.per_force[j] = 3e-5 * noise.normal();
        }
        one.bias_radps = 0.005 * noise.normal();
        one.delay_s = 2e-4 * (2.0 * noise.uniform() - 1.0);
        out.axis.push_back(one);
      }
    }
    return out;
  }

  std::string array_file(const std::string& rate = "") const {
    std::string out =
        "name = \"tool\"\n[gravity]\nmodel = \"value\"\nvalue = \"9.81 m/s^2\"\n[input]\nreads = \"gravity\"\nunit = "
        "\"m/s^2\"\ntime = \"t_s\"\n";
    for (std::size_t i = 0; i < kAccelerometers.size(); ++i)
      out += "[[sensor]]\nid = \"a" + std::to_string(i + 1) + "\"\naxis = " + text_of(kAccelerometers[i]) +
             "\nnoise = \"2 mg\"\n";
    out +=
        "[[group]]\nname = \"gyros\"\nfield = \"rate\"\nunit = \"deg/s\"\n[group.rate]\nsample_period_s = 0.01\n"
        "rate_bound_radps = 8\nforce_bound_mps2 = 15\n" +
        rate;
    for (const Axis& one : axis)
      out += "[[group.sensor]]\nid = \"" + one.id + "\"\naxis = " + text_of(one.nominal) + "\npackage = \"" + one.chip +
             "\"\nnoise = \"0.05 deg/s\"\n";
    return out;
  }
  static std::string usual_bounds() {
    return "scale_bound = 0.03\naxis_bound_rad = 0.03\nbias_bound_radps = 0.03\nlag_bound_s = 0.0005\n"
           "g_sensitivity_bound_s_per_m = 2e-4\n";
  }

  /// What a reading of axis i becomes at a time; the identity where nothing fails.
  using Fault = std::function<double(std::size_t axis, double t_s, double reading_degps)>;

  /// The attitude follows the body's rate from down along z; accelerometers feel gravity alone.
  template <class Rate>
  std::string log(const Rate& rate_at, double seconds, std::uint64_t seed, const Fault& fault = {}) const {
    Noise noise(seed);
    std::string out = "t_s,a1,a2,a3,a4";
    for (const Axis& one : axis) out += "," + one.id;
    out += "\n";
    Eigen::Vector3d down(0.0, 0.6, 0.8);
    constexpr int kFine = 4;
    const double fine_s = kPeriod_s / kFine;
    for (int k = 0; k < static_cast<int>(seconds / kPeriod_s); ++k) {
      const double t_s = k * kPeriod_s;
      const plumb::Vec3 g = {kGravity_mps2 * down[0], kGravity_mps2 * down[1], kGravity_mps2 * down[2]};
      put(out, t_s, true);
      for (const plumb::Vec3& a : kAccelerometers) put(out, plumb::dot(a, g) + 0.01 * noise.normal());
      for (std::size_t i = 0; i < axis.size(); ++i) {
        const Axis& one = axis[i];
        const double radps = plumb::dot(one.row, rate_at(t_s - one.delay_s)) + one.bias_radps -
                             plumb::dot(one.per_force, g);  // specific force is against gravity
        double degps = radps * 180.0 / plumb::kPi + kNoise_degps * noise.normal();
        if (fault) degps = fault(i, t_s, degps);
        put(out, degps);
      }
      out += "\n";
      for (int j = 0; j < kFine; ++j) {
        const plumb::Vec3 w = rate_at(t_s + (j + 0.5) * fine_s);
        const Eigen::Vector3d angle(w[0] * fine_s, w[1] * fine_s, w[2] * fine_s);
        if (angle.norm() > 0.0) down = Eigen::AngleAxisd(-angle.norm(), angle.normalized()) * down;
      }
    }
    return out;
  }

 private:
  static constexpr double kRoot3 = 0.5773502691896258;
  static constexpr std::array<plumb::Vec3, 4> kAccelerometers = {
      {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {kRoot3, kRoot3, kRoot3}}};

  static std::string text_of(const plumb::Vec3& v) {
    std::array<char, 100> text{};
    std::snprintf(text.data(), text.size(), "[%.15f, %.15f, %.15f]", v[0], v[1], v[2]);
    return text.data();
  }
  static void put(std::string& out, double value, bool first = false) {
    if (!first) out += ',';
    if (!std::isfinite(value)) return;
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.9g", value);
    out += text.data();
  }
};

/// Four seconds at rest, then to and fro about the axes of which `about` is not zero.
struct ToolWaves {
  plumb::Vec3 about{2.0, 1.6, 1.8};
  plumb::Vec3 operator()(double t_s) const {
    if (t_s <= 4.0) return {};
    const double begun = 1.0 - std::exp(-(t_s - 4.0) * (t_s - 4.0)), w = 2.0 * plumb::kPi * (t_s - 4.0);
    return {begun * about[0] * (std::sin(0.71 * w) + 0.5 * std::sin(1.9 * w)),
            begun * about[1] * (std::sin(0.53 * w + 1.0) + 0.5 * std::sin(1.3 * w)),
            begun * about[2] * (std::sin(0.37 * w + 2.0) + 0.5 * std::sin(2.3 * w))};
  }
};

/// Three seconds at rest and one in which the tool turns, `count` times.
struct ToolTurns {
  std::vector<plumb::Vec3> angle_rad;
  ToolTurns(int count, std::uint64_t seed) {
    Noise noise(seed);
    for (int k = 0; k < count; ++k) angle_rad.push_back(plumb::scaled(random_direction(noise), 1.0 + noise.uniform()));
  }
  double seconds() const { return 4.0 * static_cast<double>(angle_rad.size()) + 3.0; }
  plumb::Vec3 operator()(double t_s) const {
    const double turn = std::floor(t_s / 4.0), in = t_s - 4.0 * turn - 3.0;
    if (t_s < 0.0 || in <= 0.0 || turn >= static_cast<double>(angle_rad.size())) return {};
    return plumb::scaled(angle_rad[static_cast<std::size_t>(turn)], 1.0 - std::cos(2.0 * plumb::kPi * in));
  }
};

}  // namespace plumb_test
