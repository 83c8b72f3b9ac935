#include "gyro_checks.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

constexpr double kFast = 0.5;

bool finite_rate(const Vec3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

/// The axes [first, first + count) of a group, with their monitor.
struct AxesJudge {
  int first, count;
  std::unique_ptr<RateMonitor> monitor = std::make_unique<RateMonitor>();

  AxesJudge(const RateGroup& group, int from, int axes) : first(from), count(axes) {
    std::array<SensorRow, kCapacity> rows{};
    RateSetup setup = group.setup;
    for (int i = 0; i < count; ++i) {
      rows[static_cast<std::size_t>(i)] = group.array.row(first + i);
      setup.errors[static_cast<std::size_t>(i)] = group.setup.errors[static_cast<std::size_t>(first + i)];
    }
    const auto array = SensorArray::make(rows.data(), count);
    if (!array || !monitor->configure(*array, setup)) monitor.reset();
  }
};

void judge_axes(const io::GyroCalibration& calibration, const commission::GyroLog& log, const AxesJudge& by,
                GyroReplay& out) {
  for (std::size_t k = 0; k < log.samples(); ++k) {
    RateSample sample;
    sample.time_s = static_cast<double>(k) * log.period_s;
    sample.at_rest = log.at_rest[k];
    if (!log.force_mps2.empty() && finite_rate(log.force_mps2[k])) sample.force_mps2 = norm(log.force_mps2[k]);
    for (int i = 0; i < by.count; ++i) {
      const auto a = static_cast<std::size_t>(by.first + i);
      const double reading = log.rate_radps[a][k];
      if (!std::isfinite(reading)) continue;
      sample.delivered = sample.delivered.with(i);
      const io::GyroCalibration::Axis& found = calibration.axis[a];
      sample.rate_radps[static_cast<std::size_t>(i)] = (reading - found.bias_radps) / norm(found.row);
    }
    const RateVerdict& verdict = by.monitor->step(sample);
    const SensorSet now = verdict.suspects | verdict.isolated | verdict.excluded;
    if (!verdict.alarm && now.empty()) continue;
    if (!out.alarm || sample.time_s < out.alarm_s) out.alarm_s = sample.time_s;
    out.alarm = true;
    for (int i = 0; i < by.count; ++i) {
      if (now.has(i)) out.axes = out.axes.with(by.first + i);
    }
  }
}

}  // namespace

commission::GyroLog part_of(const commission::GyroLog& log, std::size_t begin, std::size_t end) {
  const auto cut = [&](const auto& all) {
    using List = std::decay_t<decltype(all)>;
    if (all.empty()) return List{};
    return List(all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end));
  };
  commission::GyroLog out;
  out.period_s = log.period_s;
  for (const std::vector<double>& axis : log.rate_radps) out.rate_radps.push_back(cut(axis));
  out.at_rest = cut(log.at_rest);
  out.force_mps2 = cut(log.force_mps2);
  return out;
}

GyroCheck check_of(const commission::GyroLog& log, const commission::GyroFit& fit, double rate_bound_radps) {
  GyroCheck out;
  out.rows = log.samples();
  double fastest = 0.0;
  for (const Vec3& one : common_rates(log, fit)) {
    if (finite_rate(one)) fastest = std::fmax(fastest, norm(one));
  }
  out.fast_radps = kFast * std::fmin(fastest, rate_bound_radps);
  out.all = commission::gyro_residual(log, fit);
  out.fast = commission::gyro_residual(log, fit, out.fast_radps);
  return out;
}

GyroLimit limit_of(const commission::GyroLog& log, const commission::GyroFit& fit) {
  const std::vector<Vec3> rate = common_rates(log, fit);
  const auto n = static_cast<double>(fit.axis.size());
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
  double square = 0.0, count = 0.0;
  for (std::size_t k = 1; k + 1 < rate.size(); ++k) {
    if (!finite_rate(rate[k - 1]) || !finite_rate(rate[k]) || !finite_rate(rate[k + 1])) continue;
    const Vec3 slope = scaled(minus(rate[k + 1], rate[k - 1]), 0.5 / log.period_s);
    for (std::size_t i = 0; i < fit.axis.size(); ++i) {
      const commission::FittedGyro& axis = fit.axis[i];
      double rest = log.rate_radps[i][k] - axis.bias_radps - dot(axis.row, rate[k]);
      rest += axis.delay_s * dot(axis.row, slope);
      if (!log.force_mps2.empty()) rest -= dot(axis.per_force, log.force_mps2[k]);
      if (!std::isfinite(rest)) continue;
      const double s = dot(axis.row, slope), w = dot(axis.row, rate[k]);
      const Eigen::Vector3d terms(1.0, s * s, w * w);
      normal += terms * terms.transpose();
      right += terms * rest * rest;
      mean += terms;
      square += rest * rest;
      count += 1.0;
    }
  }
  GyroLimit out;
  if (!(count > 0.0) || !(square > 0.0)) return out;
  // A fit leaves n - 3 parts in n of what every axis adds by itself.
  const double spread = n > 3.0 ? n / (n - 3.0) : 1.0;
  const Eigen::Vector3d scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-300);
  const Eigen::Matrix3d scaled_normal = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const Eigen::Vector3d part =
      (scaled_normal.completeOrthogonalDecomposition().solve(Eigen::Vector3d(right.cwiseQuotient(scale))))
          .cwiseQuotient(scale)
          .cwiseMax(0.0);
  out.noise_radps = std::sqrt(spread * part[0]);
  out.timing_s = std::sqrt(spread * part[1]);
  out.relative = std::sqrt(spread * part[2]);
  const double all = part.dot(mean);
  if (!(all > 0.0)) return out;
  out.timing_share = part[1] * mean[1] / all;
  out.relative_share = part[2] * mean[2] / all;
  return out;
}

GyroReplay replayed(const RateGroup& group, const io::GyroCalibration& calibration, const commission::GyroLog& log) {
  GyroReplay out;
  const int n = group.array.size(), most = std::min(n, kMotionCapacity);
  for (const int first : {0, n - most}) {
    const AxesJudge by(group, first, most);
    if (by.monitor) judge_axes(calibration, log, by, out);
    if (first == n - most) break;
  }
  return out;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
