#include "gyro_series.hpp"

#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Catmull-Rom cubic between y[1] and y[2], 0 <= u < 1.
double between(const std::array<double, 4>& y, double u) {
  return y[1] + 0.5 * u *
                    (y[2] - y[0] +
                     u * (2.0 * y[0] - 5.0 * y[1] + 4.0 * y[2] - y[3] + u * (3.0 * (y[1] - y[2]) + y[3] - y[0])));
}

double shifted(const GyroLog& log, const std::vector<GyroNominal>& nominal, std::size_t axis, std::size_t sample,
               double shift) {
  const std::vector<double>& y = log.rate_radps[axis];
  if (!(shift < 0.0 || shift > 0.0)) return gyro_given(log, nominal, axis, sample) ? y[sample] : kNan;
  const double at = static_cast<double>(sample) + shift, floor = std::floor(at);
  if (floor < 1.0 || floor + 3.0 > static_cast<double>(y.size())) return kNan;
  const std::size_t first = static_cast<std::size_t>(floor) - 1;
  std::array<double, 4> four{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (!gyro_given(log, nominal, axis, first + k)) return kNan;
    four[k] = y[first + k];
  }
  return between(four, at - floor);
}

}  // namespace

std::string gyro_name(const std::vector<GyroNominal>& nominal, std::size_t axis) {
  return nominal[axis].id.empty() ? std::to_string(axis) : nominal[axis].id;
}

Eigen::Vector3d eigen_of_gyro(const Vec3& v) { return {v[0], v[1], v[2]}; }

bool gyro_shape_fits(const GyroLog& log, std::size_t axes) {
  if (log.rate_radps.size() != axes || !(log.period_s > 0.0) || !std::isfinite(log.period_s)) return false;
  for (const std::vector<double>& one : log.rate_radps) {
    if (one.size() != log.samples()) return false;
  }
  return (log.at_rest.empty() || log.at_rest.size() == log.samples()) &&
         (log.force_mps2.empty() || log.force_mps2.size() == log.samples());
}

bool gyro_given(const GyroLog& log, const std::vector<GyroNominal>& nominal, std::size_t axis, std::size_t sample) {
  const double y = log.rate_radps[axis][sample], full = nominal[axis].full_scale_radps;
  return std::isfinite(y) && !(full > 0.0 && std::fabs(y) >= full);
}

GyroRest gyro_rest(const GyroLog& log, const std::vector<GyroNominal>& nominal) {
  GyroRest out;
  out.rate_radps = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(nominal.size()));
  for (std::size_t k = 0; k < log.at_rest.size(); ++k) {
    bool all = log.at_rest[k];
    for (std::size_t i = 0; all && i < nominal.size(); ++i) all = gyro_given(log, nominal, i, k);
    if (!log.force_mps2.empty()) all = all && std::isfinite(norm(log.force_mps2[k]));
    if (!all) continue;
    ++out.samples;
    for (std::size_t i = 0; i < nominal.size(); ++i)
      out.rate_radps[static_cast<Eigen::Index>(i)] += log.rate_radps[i][k];
    if (!log.force_mps2.empty()) out.force_mps2 += eigen_of_gyro(log.force_mps2[k]);
  }
  if (out.samples == 0) return out;
  out.rate_radps /= out.samples;
  out.force_mps2 /= out.samples;
  return out;
}

void take_bias(const GyroRest& rest, std::vector<FittedGyro>* axes) {
  for (std::size_t i = 0; i < axes->size(); ++i) {
    (*axes)[i].bias_radps =
        rest.rate_radps[static_cast<Eigen::Index>(i)] - eigen_of_gyro((*axes)[i].per_force).dot(rest.force_mps2);
  }
}

Eigen::MatrixXd corrected_rates(const GyroLog& log, const std::vector<GyroNominal>& nominal,
                                const std::vector<FittedGyro>& axes) {
  const auto n = static_cast<Eigen::Index>(axes.size());
  Eigen::MatrixXd out(n, static_cast<Eigen::Index>(log.samples()));
  for (std::size_t k = 0; k < log.samples(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      double y = shifted(log, nominal, i, k, axes[i].delay_s / log.period_s) - axes[i].bias_radps;
      if (!log.force_mps2.empty()) y -= dot(axes[i].per_force, log.force_mps2[k]);
      out(static_cast<Eigen::Index>(i), column) = y;
    }
    if (!out.col(column).allFinite()) out.col(column).setConstant(kNan);
  }
  return out;
}

Eigen::MatrixXd weighted_rows(const std::vector<GyroNominal>& nominal, const std::vector<FittedGyro>& axes) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(axes.size()), 3);
  for (std::size_t i = 0; i < axes.size(); ++i)
    out.row(static_cast<Eigen::Index>(i)) = eigen_of_gyro(axes[i].row) / nominal[i].noise_radps;
  return out;
}

Eigen::MatrixXd rate_solver(const Eigen::MatrixXd& weighted) {
  return (weighted.transpose() * weighted).ldlt().solve(weighted.transpose());
}

std::vector<Vec3> common_rates(const GyroLog& log, const GyroFit& fit) {
  std::vector<Vec3> out;
  if (!gyro_shape_fits(log, fit.axis.size())) return out;
  std::vector<FittedGyro> axes = fit.axis;
  const GyroRest rest = gyro_rest(log, fit.nominal);
  if (rest.samples >= fit.least_rest) take_bias(rest, &axes);
  Eigen::MatrixXd y = corrected_rates(log, fit.nominal, axes);
  for (std::size_t i = 0; i < fit.nominal.size(); ++i)
    y.row(static_cast<Eigen::Index>(i)) /= fit.nominal[i].noise_radps;
  const Eigen::MatrixXd w = rate_solver(weighted_rows(fit.nominal, axes)) * y;
  for (Eigen::Index k = 0; k < w.cols(); ++k) out.push_back({w(0, k), w(1, k), w(2, k)});
  return out;
}

GyroResidual gyro_residual(const GyroLog& log, const GyroFit& fit, double above_radps) {
  GyroResidual out;
  const std::vector<Vec3> rate = common_rates(log, fit);
  if (rate.empty()) return out;
  std::vector<FittedGyro> axes = fit.axis;
  const GyroRest at_rest = gyro_rest(log, fit.nominal);
  if (at_rest.samples >= fit.least_rest) take_bias(at_rest, &axes);
  const Eigen::MatrixXd y = corrected_rates(log, fit.nominal, axes);
  const double n = static_cast<double>(axes.size());
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(y.rows());
  double mean_rate = 0.0, sample = 0.0, block = 0.0;
  int in_block = 0;
  for (Eigen::Index k = 0; k < y.cols(); ++k) {
    if (k % kGyroBlock == 0) {
      mean.setZero();
      mean_rate = 0.0;
      in_block = 0;
    }
    const Vec3& w = rate[static_cast<std::size_t>(k)];
    if (!std::isfinite(norm(w))) continue;
    Eigen::VectorXd rest = y.col(k);
    for (std::size_t i = 0; i < axes.size(); ++i) rest[static_cast<Eigen::Index>(i)] -= dot(axes[i].row, w);
    mean += rest / kGyroBlock;
    mean_rate += norm(w) / kGyroBlock;
    ++in_block;
    if (norm(w) >= above_radps) {
      sample += rest.squaredNorm() / n;
      ++out.samples;
    }
    if (in_block < kGyroBlock || mean_rate < above_radps) continue;
    block += mean.squaredNorm() / n;
    ++out.blocks;
  }
  if (out.samples > 0) out.sample_radps = std::sqrt(sample / out.samples);
  if (out.blocks > 0) out.block_radps = std::sqrt(block / out.blocks);
  return out;
}

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
