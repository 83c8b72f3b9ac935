/// Readings of gyro axes corrected by a fit, shared by the relative fit and that of the common matrix.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdio>
#include <string>

#include "plumb/commission/gyro_fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

inline tl::unexpected<std::string> gyro_refusal(const char* text) { return tl::unexpected<std::string>(text); }
/// The format is that of printf.
template <class... Values>
tl::unexpected<std::string> gyro_refusal(const char* format, Values... values) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return tl::unexpected<std::string>(text.data());
}

/// Means over the samples at rest at which every axis is given.
struct GyroRest {
  int samples = 0;
  Eigen::VectorXd rate_radps;
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();
};

/// As refusals name it.
std::string gyro_name(const std::vector<GyroNominal>& nominal, std::size_t axis);
Eigen::Vector3d eigen_of_gyro(const Vec3& v);
bool gyro_shape_fits(const GyroLog& log, std::size_t axes);
bool gyro_given(const GyroLog& log, const std::vector<GyroNominal>& nominal, std::size_t axis, std::size_t sample);
GyroRest gyro_rest(const GyroLog& log, const std::vector<GyroNominal>& nominal);
/// Bias from rest, less what the force does there.
void take_bias(const GyroRest& rest, std::vector<FittedGyro>* axes);
/// One column a sample: y_i(t + tau_i) - b_i - c_i . f(t) by cubic interpolation; NaN throughout a sample at which any
/// of them is not given.
Eigen::MatrixXd corrected_rates(const GyroLog& log, const std::vector<GyroNominal>& nominal,
                                const std::vector<FittedGyro>& axes);
/// Rows divided by the noise of their axes.
Eigen::MatrixXd weighted_rows(const std::vector<GyroNominal>& nominal, const std::vector<FittedGyro>& axes);
/// From weighted readings to the rate, least squares.
Eigen::MatrixXd rate_solver(const Eigen::MatrixXd& weighted);

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
