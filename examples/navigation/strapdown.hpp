// A strapdown navigator: attitude and velocity from rate and specific force, in the frame of its start. Gravity is left
// out: it adds the same to every velocity that is compared here. And what aligns the rate with the force in time.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "plumb/core/vec3.hpp"

class Strapdown {
 public:
  /// Over one sample period: `rate_radps` and `force_mps2`, tool frame, are means over the same period.
  void step(const plumb::Vec3& rate_radps, const plumb::Vec3& force_mps2, double period_s) {
    const Eigen::Quaterniond half = turned_by(0.5 * period_s * vector(rate_radps));
    velocity_mps_ += period_s * (attitude_ * half * vector(force_mps2));  // the force acts on average half way round
    attitude_ = (attitude_ * half * half).normalized();
  }

  const Eigen::Quaterniond& attitude() const { return attitude_; }
  const Eigen::Vector3d& velocity_mps() const { return velocity_mps_; }

 private:
  static Eigen::Vector3d vector(const plumb::Vec3& v) { return {v[0], v[1], v[2]}; }
  static Eigen::Quaterniond turned_by(const Eigen::Vector3d& turn_rad) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad.norm(), turn_rad.stableNormalized()));
  }

  Eigen::Quaterniond attitude_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_mps_ = Eigen::Vector3d::Zero();
};

/// The last three samples of a vector, and what it was at an instant between them. A motion monitor's force is 1.5
/// samples old: the rate that belongs to it is the mean of the samples 2 and 1 before the newest.
class Recent {
 public:
  void add(double time_s, const plumb::Vec3& value) { samples_ = {samples_[1], samples_[2], {time_s, value}}; }
  plumb::Vec3 at(double time_s) const {
    const std::size_t k = time_s > samples_[1].time_s ? 1 : 0;
    const Sample &a = samples_[k], &b = samples_[k + 1];
    const double part = (time_s - a.time_s) / (b.time_s - a.time_s);
    return plumb::plus(plumb::scaled(a.value, 1.0 - part), plumb::scaled(b.value, part));
  }

 private:
  struct Sample {
    double time_s = 0.0;
    plumb::Vec3 value{};
  };
  std::array<Sample, 3> samples_{};
};
