#include "plumb/commission/array_commission.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

using Samples = std::vector<MotionSample>;

/// Sensors on one clock are not farther apart.
constexpr double kMostLagPeriods = 2.0;
constexpr double kLeastLag_s = 1e-6;

double most(const Estimate& e) { return std::fabs(e.value) + kBoundSigmas * e.sigma; }

/// What is stated holds as well; negative: nothing is.
double least(double stated, double found) { return stated >= 0.0 ? std::min(stated, found) : found; }

/// Nothing is known of any arm along an axis: there the reference point stays where it is stated.
bool open_for_all(const ArrayFit& fit, std::size_t axis) {
  return std::all_of(fit.arm_m.begin(), fit.arm_m.end(), [axis](const auto& arm) { return arm[axis].open; });
}

bool all_given(const MotionSample& sample, int gyros) {
  for (std::size_t g = 0; g < static_cast<std::size_t>(gyros); ++g) {
    if (!sample.rate_given[g]) return false;
  }
  return true;
}

/// How two gyros differ: rate of the second less that of the first = `matrix` rate + `bias`.
struct GyroDifference {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
};

GyroDifference difference_of(const Samples& samples, int gyros) {
  if (gyros < 2) return {};
  Eigen::Matrix4d normal = Eigen::Matrix4d::Identity() * 1e-9;
  Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
  for (const MotionSample& sample : samples) {
    if (!all_given(sample, gyros)) continue;
    const Vec3 mean = scaled(plus(sample.rate_radps[0], sample.rate_radps[1]), 0.5);
    const Vec3 apart = minus(sample.rate_radps[1], sample.rate_radps[0]);
    const Eigen::Vector4d x(mean[0], mean[1], mean[2], 1.0);
    normal += x * x.transpose();
    right += x * Eigen::RowVector3d(apart[0], apart[1], apart[2]);
  }
  const Eigen::Matrix<double, 4, 3> found = normal.ldlt().solve(right);
  return {found.topRows<3>().transpose(), found.row(3).transpose()};
}

/// Of either gyro: what their mean is off by, and half of what they differ by.
GyroErrors gyro_bounds(const ArrayFit& fit, const GyroDifference& apart, const GyroErrors& floor) {
  GyroErrors out = floor;
  double bias_square = 0.0;
  for (std::size_t r = 0; r < 3; ++r) {
    double across_square = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double half = 0.5 * std::fabs(apart.matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)));
      const double entry = most(fit.gyro[3 * r + c]) + half;
      if (r == c) out.scale = std::max(out.scale, floor.scale + entry);
      if (r != c) across_square += entry * entry;
    }
    out.axis_rad = std::max(out.axis_rad, floor.axis_rad + std::sqrt(across_square));
    const double bias = most(fit.gyro_bias_radps[r]) + 0.5 * std::fabs(apart.bias[static_cast<Eigen::Index>(r)]);
    bias_square += bias * bias;
  }
  out.bias_radps = floor.bias_radps + std::sqrt(bias_square);
  out.lag_s = floor.lag_s + most(fit.gyro_lag_s);
  return out;
}

MotionSetup with_lag(MotionSetup setup, double lag_s) {
  for (MotionErrors& e : setup.errors) e.lag_s = std::max(e.lag_s, lag_s);
  return setup;
}

}  // namespace

ArrayBounds bounds_of(const ArrayOnBoard& on_board, const ArrayFit& fit, const Samples& samples,
                      const ArrayBoundRule& rule) {
  ArrayBounds out;
  for (std::size_t i = 0; i < fit.lag_s.size(); ++i) {
    const std::array<Estimate, 3>& arm = fit.arm_m[i];
    out.lever_arm_m[i] = on_board.setup.lever_arm_m[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const bool as_stated = fit.stated_arms_hold && on_board.lever_bound_m[i] >= 0.0 && open_for_all(fit, c);
      if (!as_stated) out.lever_arm_m[i][c] += arm[c].value;
      out.lever_m[i] =
          std::max(out.lever_m[i], as_stated ? on_board.lever_bound_m[i] : rule.lever_m + kBoundSigmas * arm[c].sigma);
    }
    out.lag_s[i] = rule.lag_s + most(fit.lag_s[i]);  // the stated one need not be against the mean of all
    out.rectification[i] = least(on_board.rectification_bound[i], rule.rectification + most(fit.rectification[i]));
  }
  out.gyro = gyro_bounds(fit, difference_of(samples, on_board.setup.gyros), rule.gyro);
  out.gyro.noise_radps = gyro_noise_radps(samples, on_board.setup.gyros);
  return out;
}

double gyro_noise_radps(const Samples& samples, int gyros) {
  double square = 0.0, count = 0.0;
  const auto signal = [&samples, gyros](std::size_t k) {
    return gyros == 2 ? minus(samples[k].rate_radps[1], samples[k].rate_radps[0]) : samples[k].rate_radps[0];
  };
  for (std::size_t k = 2; k < samples.size(); ++k) {
    if (!all_given(samples[k], gyros) || !all_given(samples[k - 1], gyros) || !all_given(samples[k - 2], gyros))
      continue;
    const Vec3 second = plus(minus(signal(k), scaled(signal(k - 1), 2.0)), signal(k - 2));
    square += dot(second, second);
    count += 3.0 * 6.0 * gyros;  // of white noise: 1 + 4 + 1, for each gyro
  }
  return count > 0.0 ? std::sqrt(square / count) : 0.0;
}

Replay replayed(const SensorArray& array, const MotionSetup& setup, const Samples& samples, std::size_t first,
                std::size_t end) {
  Replay out;
  const auto monitor = std::make_unique<MotionMonitor>();
  if (!monitor->configure(array, setup)) return out;
  for (std::size_t k = first; k < end; ++k) {
    const MotionVerdict& now = monitor->step(samples[k]);
    const bool judged = now.cause != MotionCause::rotation_unknown && now.cause != MotionCause::no_redundancy &&
                        now.cause != MotionCause::irregular_time;
    out.judged += judged ? 1U : 0U;
    if (now.gyros_disagree && !out.gyros_disagree) out.gyros_disagree_s = samples[k].time_s;
    out.gyros_disagree = out.gyros_disagree || now.gyros_disagree;
    if (!now.alarm) continue;
    if (!out.alarm) out.alarm_s = samples[k].time_s;
    out.alarm = true;
    out.suspects = out.suspects | now.suspects;
    out.isolated = out.isolated | now.isolated | now.excluded;
  }
  return out;
}

double lag_needed_s(const SensorArray& array, const MotionSetup& setup, const Samples& samples, std::size_t first,
                    std::size_t end) {
  const auto contradicts = [&](double lag_s) {
    return replayed(array, with_lag(setup, lag_s), samples, first, end).alarm;
  };
  double low = 0.0, high = kMostLagPeriods * setup.sample_period_s;
  if (!contradicts(0.0)) return 0.0;
  if (contradicts(high)) return -1.0;
  while (high - low > 0.01 * high && high > kLeastLag_s) {
    const double middle = 0.5 * (low + high);
    (contradicts(middle) ? low : high) = middle;
  }
  return high;
}

double scatter_in_sigmas(const SensorArray& array, const Samples& samples) {
  const Eigen::Index n = array.size();
  Eigen::MatrixXd axes(n, 3);
  Eigen::VectorXd weight(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3& h = array.axis(static_cast<int>(i));
    weight[i] = 1.0 / array.sigma_mps2(static_cast<int>(i));
    axes.row(i) = weight[i] * Eigen::RowVector3d(h[0], h[1], h[2]);
  }
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(axes).householderQ();
  const Eigen::MatrixXd across = q.rightCols(n - 3).transpose() * weight.asDiagonal();
  double square = 0.0, count = 0.0;
  for (std::size_t k = 2; k < samples.size(); ++k) {
    Eigen::VectorXd second(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto s = static_cast<std::size_t>(i);
      second[i] = samples[k].reading_mps2[s] - 2.0 * samples[k - 1].reading_mps2[s] + samples[k - 2].reading_mps2[s];
    }
    square += (across * second).squaredNorm();
    count += 6.0 * static_cast<double>(n - 3);
  }
  return count > 0.0 ? std::sqrt(square / count) : 0.0;
}

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
