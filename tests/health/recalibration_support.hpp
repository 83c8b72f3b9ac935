/// For tests of recalibration: one fed by hand, and one inside a monitor.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>

#include "plumb/health/recalibration.hpp"
#include "support/simulated_tool.hpp"

namespace plumb_test {

/// Calibration error of the usual size, uncorrelated: biases `bias_mps2`, axes and scales `axis_rad`.
inline void leave_uncertainty(plumb::SensorArray& array, double bias_mps2 = 1e-4 * plumb::kG0_mps2,
                              double axis_rad = 1e-4) {
  plumb::RowUncertainty u;
  for (int a = 0; a < 4 * array.size(); ++a) {
    const double sigma = a % 4 == 3 ? bias_mps2 : axis_rad;
    u.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = sigma * sigma;
  }
  array.set_uncertainty(u);
}

/// Fed by hand: true axes, biases and scales that differ from what the calibration in force says.
struct Shadow {
  explicit Shadow(int n, std::uint64_t seed)
      : noise(seed),
        array(n == 3   ? triad()
              : n == 4 ? tetrahedron()
                       : cone_array(n)),
        model(identity_model(n)) {
    leave_uncertainty(array);
    for (int i = 0; i < n; ++i) {
      true_axis[static_cast<std::size_t>(i)] = array.axis(i);
      model.sensor[static_cast<std::size_t>(i)].bias[1] = 1e-5;  // a temperature coefficient, to see that it is held
    }
    limits = plumb::TestLimits::from_rates(n, 1e-5, 1e-6);
    used = array.all();
    fit->configure(model, plumb::alike(drift_sigmas), plumb::rad_from_deg(2.0));
  }
  static plumb::SensorArray triad() {
    plumb::AxisList axes{};
    return make_array(axes, plumb::orthogonal_triad(axes), 2e-4 * plumb::kG0_mps2);
  }

  void drift(double bias_mps2, double scale) {
    for (int i = 0; i < array.size(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      const double b = noise.normal();
      const double k = noise.normal();
      drifted_bias[a] = bias_mps2 * std::fmax(-2.0, std::fmin(2.0, b));
      drifted_scale[a] = scale * std::fmax(-2.0, std::fmin(2.0, k));
    }
  }
  void shift_mount(int i, double angle_rad) {
    const plumb::Vec3& h = array.axis(i);
    const plumb::Vec3 across = plumb::cross(h, random_direction(noise));
    const plumb::Vec3 moved = plumb::plus(h, plumb::scaled(across, std::tan(angle_rad) / plumb::norm(across)));
    true_axis[static_cast<std::size_t>(i)] = plumb::scaled(moved, 1.0 / plumb::norm(moved));
  }
  /// Axis errors such as the calibration may have left.
  void bend_axes(double sigma_rad) {
    for (int i = 0; i < array.size(); ++i) {
      plumb::Vec3& w = true_axis[static_cast<std::size_t>(i)];
      for (double& component : w) component += sigma_rad * noise.normal();
    }
  }

  void start() { fit->start(used); }
  void offer(const plumb::Vec3& u) {
    plumb::StationMean mean;
    const int entry = offered++;
    mean.direction = u;
    mean.samples = 32.0;
    mean.temperature_degc = 25.0;
    for (int i = 0; i < array.size(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      const double reading =
          plumb::dot(true_axis[a], u) * gravity.g_mps2 + array.sigma_mps2(i) / std::sqrt(mean.samples) * noise.normal();
      mean.raw[a] = bend(entry, i, (1.0 + drifted_scale[a]) * (reading + drifted_bias[a]));
    }
    fit->add_block(mean, true);
  }
  plumb::Recalibration::Outcome step(double time_s) { return fit->step({model, array, gravity, limits}, time_s); }
  /// One attitude and as many steps as a fit may need.
  plumb::Recalibration::Outcome visit(const plumb::Vec3& u, double time_s = 0.0) {
    offer(u);
    plumb::Recalibration::Outcome outcome = plumb::Recalibration::Outcome::none;
    for (int k = 0; k < 60 && outcome == plumb::Recalibration::Outcome::none; ++k) outcome = step(time_s);
    return outcome;
  }
  plumb::Recalibration::Outcome roam(int most, double time_s = 0.0) {
    plumb::Recalibration::Outcome outcome = plumb::Recalibration::Outcome::none;
    offered = 0;
    for (int k = 0; k < most && outcome == plumb::Recalibration::Outcome::none; ++k) {
      outcome = visit(random_direction(noise), time_s);
    }
    return outcome;
  }

  double scale_at(int i) const { return 1.0 + drifted_scale[static_cast<std::size_t>(i)]; }
  double bias_at(int i) const { return drifted_bias[static_cast<std::size_t>(i)]; }
  /// What the sensor shows for g, less what the model in force makes of g along the axis in force.
  double reading_error(int i, const plumb::Vec3& g) const {
    const auto a = static_cast<std::size_t>(i);
    std::array<double, plumb::kCapacity> raw{};
    raw[a] = scale_at(i) * (plumb::dot(true_axis[a], g) + drifted_bias[a]);
    return model.apply(raw, 25.0, plumb::SensorSet::of(i))[a] - plumb::dot(array.axis(i), g);
  }

  Noise noise;
  plumb::SensorArray array;
  plumb::SensorModel model;
  plumb::GravityReference gravity{plumb::kG0_mps2, 1e-4 * plumb::kG0_mps2, plumb::GravityModel::value};
  plumb::TestLimits limits;
  plumb::DriftSigmas drift_sigmas;
  plumb::SensorSet used;
  std::array<plumb::Vec3, plumb::kCapacity> true_axis{};
  std::array<double, plumb::kCapacity> drifted_bias{}, drifted_scale{};
  std::function<double(int entry, int sensor, double raw)> bend = [](int, int, double raw) { return raw; };
  int offered = 0;
  std::unique_ptr<plumb::Recalibration> fit = std::make_unique<plumb::Recalibration>();
};

/// Every figure bit for bit; not by memory, which holds padding too.
inline bool same_model(const plumb::SensorModel& a, const plumb::SensorModel& b) {
  bool same = a.size == b.size && a.reads == b.reads && a.misalignment == b.misalignment;
  for (std::size_t i = 0; i < plumb::kCapacity; ++i) {
    same = same && a.sensor[i].scale == b.sensor[i].scale && a.sensor[i].bias == b.sensor[i].bias &&
           a.sensor[i].reference_degc == b.sensor[i].reference_degc;
  }
  return same;
}

/// A tool whose biases have moved since it was calibrated, by what its calibration leaves room for.
struct Tool {
  explicit Tool(const plumb::SensorArray& array, plumb::MonitorConfig config = {}, std::uint64_t seed = 1)
      : rig(array, config, seed), directions(seed + 100) {
    leave_uncertainty(rig.setup.array);
    rig.restart();
    rig.distort = [this](int i, double r, int k) { return fault(i, r + bias[static_cast<std::size_t>(i)], k); };
  }
  explicit Tool(int n, plumb::MonitorConfig config = {}, std::uint64_t seed = 1)
      : Tool(n == 4 ? tetrahedron() : cone_array(n), config, seed) {}

  void drift(double size_mps2) {
    for (double& b : bias) b = size_mps2 * (2.0 * directions.uniform() - 1.0);
  }
  void visit(int stations, double g_mps2 = plumb::kG0_mps2) {
    for (int k = 0; k < stations; ++k) rig.stay(random_direction(directions), 2, g_mps2);
  }
  /// Proven, asked and taken.
  void begin() {
    rig.prove();
    ASSERT_TRUE(rig.monitor.request_recalibration().has_value());
    rig.stay(direction_at(70, 70));
    ASSERT_EQ(state(), plumb::HealthState::recalibrating);
  }
  plumb::HealthState state() const { return rig.monitor.verdict().state; }
  double bias_error(plumb::SensorSet set) const {
    double sum = 0.0;
    for (int i = 0; i < rig.setup.array.size(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      const double e = rig.monitor.model().sensor[a].bias[0] - bias[a];
      if (set.has(i)) sum += e * e;
    }
    return std::sqrt(sum / set.size());
  }
  int count(plumb::HealthEvent event) const {
    return static_cast<int>(std::count_if(rig.records.begin(), rig.records.end(),
                                          [event](const plumb::TransitionRecord& r) { return r.event == event; }));
  }
  /// Every figure bit for bit.
  bool calibration_untouched() const {
    bool same = same_model(rig.monitor.model(), rig.setup.model);
    const plumb::SensorArray& array = rig.monitor.array();
    same = same && array.size() == rig.setup.array.size();
    for (int i = 0; i < array.size(); ++i) {
      same = same && array.axis(i) == rig.setup.array.axis(i) && array.sigma_mps2(i) == rig.setup.array.sigma_mps2(i);
    }
    return same && array.uncertainty().covariance == rig.setup.array.uncertainty().covariance &&
           array.uncertainty().misfit_mps2 == rig.setup.array.uncertainty().misfit_mps2;
  }

  Rig rig;
  Noise directions;
  std::array<double, plumb::kCapacity> bias{};
  Rig::Distort fault = [](int, double r, int) { return r; };
};

inline plumb::MonitorConfig after_exclusion() {
  plumb::MonitorConfig config;
  config.recalibrate_after_exclusion = true;
  return config;
}

}  // namespace plumb_test
