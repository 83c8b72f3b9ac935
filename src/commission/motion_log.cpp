#include "plumb/commission/motion_log.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

constexpr int kLeastSamples = 512;

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;
using Signal = std::vector<Vec3>;

Vector3 eigen_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// Between samples: the cubic through the four around. `at` in samples, at least 1 and less than size - 2.
Vec3 between(const Signal& signal, double at) {
  const double floor = std::floor(at), x = at - floor;
  const auto k = static_cast<std::size_t>(floor);
  const std::array<double, 4> weight{-x * (x - 1.0) * (x - 2.0) / 6.0, (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0,
                                     -(x + 1.0) * x * (x - 2.0) / 2.0, (x + 1.0) * x * (x - 1.0) / 6.0};
  Vec3 out{};
  for (std::size_t j = 0; j < 4; ++j) out = plus(out, scaled(signal[k + j - 1], weight[j]));
  return out;
}

Signal smoothed(const Signal& signal, int samples) {
  const auto width = static_cast<std::size_t>(samples);
  Signal out(signal.size() - width + 1);
  for (std::size_t k = 0; k < out.size(); ++k) {
    Vec3 sum{};
    for (std::size_t j = 0; j < width; ++j) sum = plus(sum, signal[k + j]);
    out[k] = scaled(sum, 1.0 / samples);
  }
  return out;
}

/// Samples of the reference that are compared, up to `end`.
struct Range {
  std::size_t begin;
  std::size_t end;
};

/// Of the lengths of two rates, which no mounting changes, at a delay of whole samples.
double correlation(const Signal& a, const Signal& b, int delay, const Range& range) {
  double n = 0.0, sa = 0.0, sb = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t k = range.begin; k < range.end; ++k) {
    const double x = norm(a[k]), y = norm(b[k + static_cast<std::size_t>(delay)]);
    if (!std::isfinite(x + y)) continue;
    n += 1.0, sa += x, sb += y, aa += x * x, bb += y * y, ab += x * y;
  }
  const double variances = (aa - sa * sa / n) * (bb - sb * sb / n);
  return variances > 0.0 ? (ab - sa * sb / n) / std::sqrt(variances) : 0.0;
}

/// The best turn at a delay, and what it leaves.
struct Turn {
  Matrix3 to_frame = Matrix3::Identity();
  Vector3 bias = Vector3::Zero();
  Matrix3 spread = Matrix3::Zero();  // of the reference, about its mean
  double square = 0.0;               // sum of what is left
  double count = 0.0;
};

Turn turn_at(const Signal& reference, const Signal& signal, double delay_samples, const Range& range) {
  Vector3 mean_a = Vector3::Zero(), mean_b = Vector3::Zero();
  Matrix3 product = Matrix3::Zero(), spread_b = Matrix3::Zero();
  Turn out;
  for (std::size_t k = range.begin; k < range.end; ++k) {
    const Vector3 a = eigen_of(reference[k]), b = eigen_of(between(signal, static_cast<double>(k) + delay_samples));
    if (!(a + b).allFinite()) continue;
    mean_a += a, mean_b += b, out.count += 1.0;
    product += a * b.transpose(), out.spread += a * a.transpose(), spread_b += b * b.transpose();
  }
  mean_a /= out.count, mean_b /= out.count;
  product -= out.count * mean_a * mean_b.transpose();
  out.spread -= out.count * mean_a * mean_a.transpose();
  spread_b -= out.count * mean_b * mean_b.transpose();
  const Eigen::JacobiSVD<Matrix3> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3 signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  out.to_frame = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  out.bias = mean_a - out.to_frame * mean_b;
  out.square = out.spread.trace() + spread_b.trace() - 2.0 * (out.to_frame.transpose() * product).trace();
  return out;
}

/// Golden section over two samples about the best delay of whole samples.
double best_delay(const Signal& reference, const Signal& signal, int whole, const Range& range) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = whole - 1.0, high = whole + 1.0;
  while (high - low > 1e-4) {
    const double a = high - ratio * (high - low), b = low + ratio * (high - low);
    const bool left = turn_at(reference, signal, a, range).square < turn_at(reference, signal, b, range).square;
    (left ? high : low) = left ? b : a;
  }
  return 0.5 * (low + high);
}

/// Mean square of the derivative.
double mean_square_rate(const Signal& signal, double period_s) {
  double square = 0.0, count = 0.0;
  for (std::size_t k = 1; k < signal.size(); ++k) {
    const Vec3 step = minus(signal[k], signal[k - 1]);
    if (!std::isfinite(norm(step))) continue;
    square += dot(step, step), count += 1.0;
  }
  return square / (count * period_s * period_s);
}

/// What is left after smoothing over some samples is one independent value in so many.
void state_uncertainty(const Signal& reference, const Turn& turn, double period_s, int smoothed_samples,
                       UnitAlignment* out) {
  const double independent = turn.count / smoothed_samples;
  const double variance = turn.square / (3.0 * turn.count);
  out->residual_radps = std::sqrt(variance);
  out->delay_sigma_s = std::sqrt(variance / (independent * mean_square_rate(reference, period_s)));
  // A turn about an axis moves what stands across it.
  const Matrix3 spread = turn.spread * (independent / turn.count);
  const Eigen::SelfAdjointEigenSolver<Matrix3> seen(spread.trace() * Matrix3::Identity() - spread);
  for (Eigen::Index c = 0; c < 3; ++c) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      sum += seen.eigenvectors()(c, k) * seen.eigenvectors()(c, k) / std::max(seen.eigenvalues()[k], 1e-300);
    }
    out->turn_sigma_rad[static_cast<std::size_t>(c)] = std::sqrt(variance * sum);
  }
}

int best_whole_delay(const Signal& reference, const Signal& signal, int most, const Range& range) {
  int whole = 0;
  double best = -2.0;
  for (int delay = -most; delay <= most; ++delay) {
    const double found = correlation(reference, signal, delay, range);
    if (found > best) best = found, whole = delay;
  }
  return whole;
}

/// Empty where the alignment may be used.
std::string doubt_about(const UnitAlignment& unit, const AlignmentLimits& limits) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (unit.turn_sigma_rad[c] < limits.turn_sigma_rad) continue;
    return std::string("the gyros leave open how it is turned about the first unit's ") + "xyz"[c] +
           " axis. Remedy: turn the body about at least two axes, by some ten degrees";
  }
  if (std::fabs(unit.slip_s) <= limits.slip_s) return "";
  return "its clock moves by " + std::to_string(std::lround(1e6 * unit.slip_s)) +
         " us against the first unit's within the log. Remedy: cut the log where a row was lost";
}

CommissionExpected<UnitAlignment> align(const Signal& reference, const Signal& signal, double period_s,
                                        const std::string& name, const AlignmentLimits& limits) {
  const int most = static_cast<int>(std::ceil(limits.delay_s / period_s));
  const auto margin = static_cast<std::size_t>(most + 3);
  const Range all{margin, reference.size() - margin};
  const Range first{margin, reference.size() / 2}, second{reference.size() / 2, reference.size() - margin};
  const int whole = best_whole_delay(reference, signal, most, all);
  if (turn_at(reference, signal, whole, all).count < kLeastSamples) {
    return tl::unexpected<std::string>(name + ": the gyros give too few samples. Remedy: turn more slowly, or longer");
  }
  if (std::abs(whole) == most) {
    return tl::unexpected<std::string>(name +
                                       ": the gyros agree best at the largest delay searched for. Remedy: search "
                                       "farther, or check that the rows belong together");
  }
  UnitAlignment out;
  const double delay = best_delay(reference, signal, whole, all);
  const Turn turn = turn_at(reference, signal, delay, all);
  out.delay_s = delay * period_s;
  out.slip_s = period_s * (best_delay(reference, signal, whole, second) - best_delay(reference, signal, whole, first));
  for (std::size_t k = 0; k < 9; ++k) {
    out.to_frame[k] = turn.to_frame(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3));
  }
  out.bias_radps = {turn.bias[0], turn.bias[1], turn.bias[2]};
  state_uncertainty(reference, turn, period_s, limits.smoothed_samples, &out);
  const std::string doubt = doubt_about(out, limits);
  if (!doubt.empty()) return tl::unexpected<std::string>(name + ": " + doubt);
  return out;
}

std::string flaw_of(const MotionLog& log) {
  if (log.unit.size() < 2 || 3 * log.unit.size() > static_cast<std::size_t>(kMotionCapacity)) {
    return "the log has " + std::to_string(log.unit.size()) + " units. Remedy: give 2 to " +
           std::to_string(kMotionCapacity / 3);
  }
  if (!(log.period_s > 0.0)) return "the sample period is not positive. Remedy: state it";
  for (const UnitLog& unit : log.unit) {
    if (unit.force_mps2.size() != log.samples() || unit.rate_radps.size() != log.samples()) {
      return "the units have different numbers of samples. Remedy: cut them to the shortest";
    }
    for (std::size_t k = 0; k < log.samples(); ++k) {
      if (std::isfinite(norm(unit.force_mps2[k]))) continue;
      return "a force of sample " + std::to_string(k) + " is not finite. Remedy: cut the log at gaps";
    }
  }
  return "";
}

}  // namespace

CommissionExpected<std::vector<UnitAlignment>> align_by_gyros(const MotionLog& log, const AlignmentLimits& limits) {
  const std::string flaw = flaw_of(log);
  if (!flaw.empty()) return tl::unexpected<std::string>(flaw);
  const std::size_t least = static_cast<std::size_t>(kLeastSamples + limits.smoothed_samples) +
                            2 * static_cast<std::size_t>(std::ceil(limits.delay_s / log.period_s));
  if (log.samples() < least) {
    return tl::unexpected<std::string>("the log has " + std::to_string(log.samples()) + " samples. Remedy: record " +
                                       std::to_string(least) + " at least");
  }
  const Signal reference = smoothed(log.unit.front().rate_radps, limits.smoothed_samples);
  std::vector<UnitAlignment> out(1);
  for (std::size_t u = 1; u < log.unit.size(); ++u) {
    const CommissionExpected<UnitAlignment> found =
        align(reference, smoothed(log.unit[u].rate_radps, limits.smoothed_samples), log.period_s,
              "unit " + std::to_string(u + 1), limits);
    if (!found) return tl::unexpected<std::string>(found.error());
    out.push_back(*found);
  }
  return out;
}

namespace {

/// Between samples; at full scale where one of the samples around is.
Vec3 force_between(const Signal& signal, double at, double full_scale_mps2) {
  Vec3 out = between(signal, at);
  const auto k = static_cast<std::size_t>(std::floor(at));
  for (std::size_t c = 0; c < 3 && full_scale_mps2 > 0.0; ++c) {
    for (std::size_t j = k - 1; j <= k + 2; ++j) {
      if (std::fabs(signal[j][c]) >= full_scale_mps2) out[c] = std::copysign(full_scale_mps2, signal[j][c]);
    }
  }
  return out;
}

}  // namespace

MotionLog aligned(const MotionLog& log, const std::vector<UnitAlignment>& alignment) {
  double least = 0.0, most = 0.0;
  for (const UnitAlignment& unit : alignment) {
    least = std::min(least, unit.delay_s / log.period_s);
    most = std::max(most, unit.delay_s / log.period_s);
  }
  const auto first = static_cast<std::size_t>(std::ceil(1.0 - least));
  const std::size_t end = log.samples() - 2 - static_cast<std::size_t>(std::ceil(most));
  MotionLog out;
  out.period_s = log.period_s;
  out.full_scale_mps2 = log.full_scale_mps2;
  out.unit.resize(log.unit.size());
  for (std::size_t u = 0; u < log.unit.size(); ++u) {
    const double delay = alignment[u].delay_s / log.period_s;
    for (std::size_t k = first; k < end; ++k) {
      const double at = static_cast<double>(k) + delay;
      out.unit[u].force_mps2.push_back(force_between(log.unit[u].force_mps2, at, log.full_scale_mps2));
      const Vec3 rate = times(alignment[u].to_frame, between(log.unit[u].rate_radps, at));
      out.unit[u].rate_radps.push_back(plus(rate, alignment[u].bias_radps));
    }
  }
  return out;
}

MotionSample sample_of(const MotionLog& aligned_log, std::size_t k) {
  MotionSample out;
  const std::size_t units = aligned_log.unit.size(), half = (units + 1) / 2;
  out.time_s = static_cast<double>(k) * aligned_log.period_s;
  out.delivered = SensorSet::first(static_cast<int>(3 * units));
  for (std::size_t u = 0; u < units; ++u) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double y = aligned_log.unit[u].force_mps2[k][c], full = aligned_log.full_scale_mps2;
      out.reading_mps2[3 * u + c] = y;
      if (full > 0.0 && std::fabs(y) >= full) out.clipped = out.clipped.with(static_cast<int>(3 * u + c));
    }
    const std::size_t gyro = u < half ? 0 : 1;
    const double share = 1.0 / static_cast<double>(gyro == 0 ? half : units - half);
    out.rate_radps[gyro] = plus(out.rate_radps[gyro], scaled(aligned_log.unit[u].rate_radps[k], share));
  }
  for (std::size_t g = 0; g < 2; ++g) out.rate_given[g] = std::isfinite(norm(out.rate_radps[g]));
  return out;
}

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
