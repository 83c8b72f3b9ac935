// A body that moves by steps, for the examples beside this file: four accelerometers and a gyro, simulated. It turns
// for a second, stands for three, and so on. From `dead_from_s` on the second accelerometer reads zero.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "plumb/array/named.hpp"
#include "plumb/health/health_monitor.hpp"

inline constexpr double kStep_s = 0.01, kSigma_mps2 = 0.002, kGyroSigma_radps = 0.001;
/// A vehicle that stops or holds its place: over a block of 0.32 s its speed changes by less than 16 mm/s. 0.29 deg of
/// every protection level. 0 for what lies on rock.
inline constexpr double kVehicle_mps2 = 5e-3 * plumb::kG0_mps2;

/// Drift of a sensor since its calibration, 1 sigma: servo accelerometers. 0.02 deg of every protection level.
inline constexpr double kStability_mps2 = 3e-5 * plumb::kG0_mps2;

class Body {
 public:
  explicit Body(double dead_from_s, double acceleration_bound_mps2 = kVehicle_mps2) : dead_from_s_(dead_from_s) {
    setup_.config.acceleration_bound_mps2 = acceleration_bound_mps2;
    plumb::AxisList axes{};
    plumb::SensorRow rows[4];
    plumb::paper_tetrahedron(axes);
    const char* const ids[] = {"a1", "a2", "a3", "a4"};
    for (std::size_t i = 0; i < 4; ++i) rows[i] = {plumb::make_id(ids[i]), axes[i], kSigma_mps2};
    const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(rows, 4);
    if (array) setup_.array = *array;  // else empty: the monitor refuses it
    setup_.stability.fill({kStability_mps2, 0.0, 0.0, 0.0});
    setup_.model.size = 4;  // scale 1, bias 0: the raw values are m/s^2 along the axes already
  }

  const plumb::MonitorSetup& setup() const { return setup_; }
  const Eigen::Vector3d& gravity_mps2() const { return gravity_mps2_; }  // the truth, positive down
  const Eigen::Vector3d& gyro_radps() const { return gyro_radps_; }      // of this sample, with noise and bias

  plumb::Sample next() {
    const int stand = count_ / 400;
    Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();
    if (stand > 0 && count_ % 400 < 100) rate_radps << 0.5 * std::cos(2.4 * stand), 0.5 * std::sin(2.4 * stand), 0.15;
    // A vector that stands still turns backwards as seen from a body that turns.
    if (rate_radps.norm() > 0.0)
      gravity_mps2_ = Eigen::AngleAxisd(-rate_radps.norm() * kStep_s, rate_radps.stableNormalized()) * gravity_mps2_;
    for (int c = 0; c < 3; ++c) gyro_radps_[c] = rate_radps[c] + kGyroBias_radps[c] + noise(kGyroSigma_radps);
    plumb::Sample sample;
    sample.time_s = kStep_s * count_++;
    sample.delivered = setup_.array.all();
    for (int i = 0; i < setup_.array.size(); ++i) {
      const plumb::Vec3& axis = setup_.array.axis(i);
      sample.raw[static_cast<std::size_t>(i)] =
          Eigen::Vector3d(axis[0], axis[1], axis[2]).dot(gravity_mps2_) + noise(kSigma_mps2);
    }
    if (sample.time_s >= dead_from_s_) sample.raw[1] = 0.0;
    return sample;
  }

 private:
  double noise(double sigma) {  // uniform, with that standard deviation
    random_ = random_ * 1664525U + 1013904223U;
    return sigma * std::sqrt(12.0) * ((random_ >> 8U) / 16777216.0 - 0.5);
  }

  static constexpr double kGyroBias_radps[3] = {1e-4, -5e-5, 8e-5};  // some 20 deg/h
  plumb::MonitorSetup setup_;
  Eigen::Vector3d gravity_mps2_ = plumb::kG0_mps2 * Eigen::Vector3d(0.3, 0.0, 0.954).normalized();
  Eigen::Vector3d gyro_radps_ = Eigen::Vector3d::Zero();
  double dead_from_s_;
  std::uint32_t random_ = 1;
  int count_ = 0;
};
