// A strapdown attitude filter: a gyro carries the vector of gravity from sample to sample, plumb's vector corrects it.
// It takes a verdict at its word: `valid` with the covariance given, `degraded` (nothing checks the three sensors left)
// with three times the sigma, anything else not at all. Then the gyro alone carries on, and the covariance says so.
#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "plumb/health/verdict.hpp"

class AttitudeFilter {
 public:
  using Vector3 = Eigen::Vector3d;
  using Matrix3 = Eigen::Matrix3d;

  AttitudeFilter(double gyro_sigma_radps, double bias_sigma_radps) : gyro_sigma_radps_(gyro_sigma_radps) {
    covariance_.topLeftCorner<3, 3>() = 1e4 * Matrix3::Identity();  // direction unknown
    covariance_.bottomRightCorner<3, 3>() = bias_sigma_radps * bias_sigma_radps * Matrix3::Identity();
  }

  const Vector3& gravity_mps2() const { return gravity_; }
  double tilt_sigma_rad() const {  // across the vector, both axes together
    const Vector3 down = gravity_.stableNormalized();
    const Matrix3 across = Matrix3::Identity() - down * down.transpose();
    return std::sqrt((across * covariance_.topLeftCorner<3, 3>() * across).trace()) / gravity_.norm();
  }

  /// One gyro sample: what stands still turns backwards as seen from the body.
  void turn(const Vector3& gyro_radps, double dt_s) {
    const Vector3 rate = gyro_radps - bias_;
    const Matrix3 lever = skew(gravity_);
    Matrix3 back = Matrix3::Identity();
    if (rate.norm() > 0.0) back = Eigen::AngleAxisd(-rate.norm() * dt_s, rate.stableNormalized()).toRotationMatrix();
    Eigen::Matrix<double, 6, 6> step = Eigen::Matrix<double, 6, 6>::Identity();
    step.topLeftCorner<3, 3>() = back;
    step.topRightCorner<3, 3>() = -dt_s * lever;  // a bias taken for a rate
    gravity_ = back * gravity_;
    covariance_ = step * covariance_ * step.transpose();
    const double angle_rad = gyro_sigma_radps_ * dt_s;
    covariance_.topLeftCorner<3, 3>() += angle_rad * angle_rad * lever * lever.transpose();
  }

  /// A measured vector with its covariance (Kalman update).
  void correct(const Vector3& measured_mps2, const Matrix3& covariance) {
    const Eigen::Matrix<double, 6, 3> cross = covariance_.leftCols<3>();
    const Matrix3 expected = covariance_.topLeftCorner<3, 3>() + covariance;
    const Eigen::Matrix<double, 6, 3> gain = expected.llt().solve(cross.transpose()).transpose();
    const Eigen::Matrix<double, 6, 1> change = gain * (measured_mps2 - gravity_);
    gravity_ += change.head<3>();
    bias_ += change.tail<3>();
    covariance_ -= gain * expected * gain.transpose();
    covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  }

  /// What plumb says, once per block. Returns whether it was used.
  bool correct(const plumb::Verdict& v) {
    const bool degraded = v.validity == plumb::Validity::degraded;
    if (!v.tick || (v.validity != plumb::Validity::valid && !degraded)) return false;
    const Eigen::Map<const Vector3> measured(v.gravity_mps2.data());
    const Matrix3 stated = Eigen::Map<const Matrix3>(v.covariance.data());  // symmetric: rows are columns
    if (!measured.allFinite() || !stated.allFinite()) return false;
    correct(measured, (degraded ? 9.0 : 1.0) * stated);
    return true;
  }

 private:
  static Matrix3 skew(const Vector3& v) {
    return (Matrix3() << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0).finished();
  }

  Vector3 gravity_ = Vector3::UnitZ(), bias_ = Vector3::Zero();
  Eigen::Matrix<double, 6, 6> covariance_ = Eigen::Matrix<double, 6, 6>::Zero();
  double gyro_sigma_radps_;
};
