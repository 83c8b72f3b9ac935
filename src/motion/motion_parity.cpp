#include "plumb/motion/motion_parity.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

Mat3 omega_of(const GyroMeans& gyro) noexcept {
  const Symmetric& p = gyro.rate_product;
  const Vec3& a = gyro.acceleration_radps2;
  return {-p[1] - p[2], p[3] - a[2],  p[4] + a[1],  //
          p[3] + a[2],  -p[0] - p[2], p[5] - a[0],  //
          p[4] - a[1],  p[5] + a[0],  -p[0] - p[1]};
}

/// What x may be off by, relative to the reading y = (1 + s) x, |s| <= `bound`.
double of_reading(double bound) noexcept { return bound / (1.0 - bound); }

/// What the term changes by where the rates are those of another time, by up to the gyro's lag. A mean over two blocks
/// of a derivative is the difference of what stands at their edges (T11): of the rates, for the angular acceleration,
/// and of the means of w w'. Between samples, and within the lag, rates differ from those at the edges by what they do
/// from one sample to the next.
double error_of_lag(const GyroErrors& bounds, const MotionMeans& means, const GyroMeans& gyro) noexcept {
  const double span_s = means.span_s, period_s = span_s / means.samples, lags = bounds.lag_s / period_s;
  const Symmetric& p = gyro.product_change;
  const double trace = p[0] + p[1] + p[2];
  const double change =
      std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + 2.0 * (p[3] * p[3] + p[4] * p[4] + p[5] * p[5])) +
      std::fabs(trace);
  const double moved = lags * gyro.step_radps, open = gyro.begun ? gyro.step_radps : 0.0;
  return bounds.lag_s / (span_s * span_s) *
             (norm(gyro.edge_change_radps) + open + 2.0 * gyro.bend_radps + 4.0 * moved) +
         bounds.lag_s / span_s * change + 2.0 * moved * moved;
}

/// The angular acceleration is summed at the samples in the readings, and between them in the rates: a trapezoidal
/// rule, whose error in a mean over two blocks is period^2 / 12 times the mean second derivative of the acceleration,
/// so what the acceleration does at the edges. Twice that holds for any tone below half the sample rate.
double error_of_sums(const MotionMeans& means, const GyroMeans& gyro) noexcept {
  const double n = means.samples, period_s = means.span_s / n;
  const double open = gyro.begun ? 2.0 * gyro.step_radps : 0.0;
  return (norm(gyro.step_change_radps) + open) / (6.0 * n * n * period_s);
}

/// What interpolation adds to a mean over two blocks, from what it adds to a sample at most (T14). A shock that begins
/// between two samples adds up to eight times that to a pair of single samples, and less to longer blocks.
double in_mean(double interpolation, const MotionMeans& means) noexcept {
  return (1.0 + 3.0 / means.samples) * interpolation;
}

/// What the term of a healthy gyro is off by: scale and axis, bias, noise, and how fast the acceleration changes. A
/// quarter of a sample period covers that readings are compared at instants, rates over the intervals between them.
double mean_error_of(const GyroErrors& bounds, const MotionMeans& means, const GyroMeans& gyro, double k) noexcept {
  const double square = gyro.rate_product[0] + gyro.rate_product[1] + gyro.rate_product[2];
  const double rate = std::sqrt(square > 0.0 ? square : 0.0);
  const double relative = relative_error(bounds), more = (1.0 + relative) * (1.0 + relative);
  const double n = means.samples, period_s = means.span_s / n;
  const double noise = k * bounds.noise_radps, drawn = in_mean(gyro.interpolation_radps, means);
  return (2.0 + relative) * relative * square + relative * norm(gyro.acceleration_radps2) +
         more * (2.0 * rate * (bounds.bias_radps + noise * std::sqrt(means.noise_share())) +
                 bounds.bias_radps * bounds.bias_radps + 3.0 * bounds.noise_radps * bounds.noise_radps +
                 noise * std::sqrt(2.0 / n) / means.span_s +
                 (bounds.lag_s + 0.25 * period_s) / means.span_s * norm(gyro.acceleration_change_radps2) +
                 error_of_lag(bounds, means, gyro) + error_of_sums(means, gyro) +
                 drawn * (2.0 * rate + drawn + 2.0 / means.span_s));
}

/// At least the operator norm of the difference, and at most sqrt(3) times that.
double frobenius(const Mat3& a, const Mat3& b) noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < 9; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

/// How fast a reading changes at the instants of its samples, on average: the difference of block means says so where
/// the signal is smooth. A shock begins between two samples, and vibration near the sample rate looks slow: what either
/// adds is within the largest second difference, as if it came once in a block, and twice where a block is one sample
/// (docs/motion.md).
double slope_bound(const MotionMeans& means, std::size_t sensor) noexcept {
  return std::fabs(means.slope_mps3[sensor]) + (1.0 + 1.0 / means.samples) * means.bend_mps2[sensor] / means.span_s;
}

/// Of a reading at full scale throughout nothing is known but that the force is bounded: block means differ by up to
/// twice that, and second differences of samples by up to four times.
double clipped_slope_bound(const MotionSetup& setup, const MotionMeans& means) noexcept {
  return (2.0 + 4.0 * (1.0 + 1.0 / means.samples)) * setup.force_bound_mps2 / means.span_s;
}

double clipped_square(const MotionSetup& setup, double y) noexcept {
  const double most = std::fabs(y) > setup.force_bound_mps2 ? std::fabs(y) : setup.force_bound_mps2;
  return most * most;
}

/// Omega' h: what a metre along each axis adds to the reading.
Vec3 per_metre(const Mat3& omega, const Vec3& h) noexcept {
  return {omega[0] * h[0] + omega[3] * h[1] + omega[6] * h[2], omega[1] * h[0] + omega[4] * h[1] + omega[7] * h[2],
          omega[2] * h[0] + omega[5] * h[1] + omega[8] * h[2]};
}

/// How large the force is at most by the readings of a set: |f| <= (|y| + |e|) / s, s the smallest singular value of
/// its axes less what turns of the axes take from it.
double force_bound(const SensorArray& array, const MotionSetup& setup, const MotionSet& set,
                   const MotionReadings& readings) noexcept {
  double square = 0.0, error_square = 0.0, turn_square = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.all.has(i)) continue;
    const auto k = static_cast<std::size_t>(i);
    const double error = readings.error_mps2[k] + readings.noise_factor * array.sigma_mps2(i);
    square += readings.corrected_mps2[k] * readings.corrected_mps2[k];
    error_square += error * error;
    turn_square += setup.errors[k].axis_rad * setup.errors[k].axis_rad;
  }
  const double singular = set.least_singular - std::sqrt(turn_square);
  if (!(singular > 0.0)) return setup.force_bound_mps2;
  const double seen = (std::sqrt(square) + std::sqrt(error_square)) / singular;
  return seen < setup.force_bound_mps2 ? seen : setup.force_bound_mps2;
}

/// The force by least squares of the readings of a set that sees all of it, and what it is off by at most.
struct ForceOfSet {
  Vec3 force_mps2{};
  double error_mps2 = 0.0;
};

ForceOfSet force_of_set(const SensorArray& array, const MotionSetup& setup, const MotionSet& set,
                        const MotionReadings& readings, double force_mps2) noexcept {
  std::array<Vec3, 3> normal{};
  Vec3 right{};
  double square = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.all.has(i)) continue;
    const auto k = static_cast<std::size_t>(i);
    const Vec3& h = array.axis(i);
    for (std::size_t c = 0; c < 3; ++c) normal[c] = plus(normal[c], scaled(h, h[c]));
    right = plus(right, scaled(h, readings.corrected_mps2[k]));
    const double error =
        readings.error_mps2[k] + setup.errors[k].axis_rad * force_mps2 + readings.noise_factor * array.sigma_mps2(i);
    square += error * error;
  }
  const double det = det3(normal[0], normal[1], normal[2]);
  ForceOfSet out;
  out.force_mps2 = {det3(right, normal[1], normal[2]) / det, det3(normal[0], right, normal[2]) / det,
                    det3(normal[0], normal[1], right) / det};
  out.error_mps2 = std::sqrt(square) / set.least_singular;
  return out;
}

/// What the parity of the true readings of a set may be against that of the readings, some of which are at full scale.
struct FullScale {
  bool may_be_more = false, may_be_less = false;
};

FullScale beyond_full_scale(const MotionSet& set, const MotionReadings& readings) noexcept {
  FullScale out;
  for (std::size_t k = 0; k < set.size; ++k) {
    const bool upwards = readings.at_least.has(set.sensor[k]), downwards = readings.at_most.has(set.sensor[k]);
    const bool counts_up = set.null[k] > 0.0;
    out.may_be_more = out.may_be_more || (counts_up ? upwards : downwards);
    out.may_be_less = out.may_be_less || (counts_up ? downwards : upwards);
  }
  return out;
}

/// A mean of the angular acceleration over two blocks is the difference of two mean rates over the length of one.
RotationTerm bounded(const MotionSetup& setup, const MotionMeans& means) noexcept {
  RotationTerm out;
  const double rate = setup.rate_bound_radps;
  out.known = rate > 0.0;
  out.error_per_s2 = rate * rate + 2.0 * rate / means.span_s;
  return out;
}

}  // namespace

RotationTerm rotation_term(const MotionSetup& setup, const MotionMeans& means, RotationSource source,
                           double noise_quantile) noexcept {
  const RotationTerm bound = bounded(setup, means);
  if (source == RotationSource::bound || setup.gyros == 0 || !means.gyro[0].given) return bound;
  RotationTerm out;
  out.known = true;
  out.omega_per_s2 = omega_of(means.gyro[0]);
  out.error_per_s2 = mean_error_of(setup.gyro, means, means.gyro[0], noise_quantile);
  if (setup.gyros == 2) {
    if (!means.gyro[1].given) return bound;
    const Mat3 first = out.omega_per_s2, second = omega_of(means.gyro[1]);
    const double error = mean_error_of(setup.gyro, means, means.gyro[1], noise_quantile);
    const double apart = frobenius(first, second);
    out.gyros_disagree = apart > std::sqrt(3.0) * (out.error_per_s2 + error);
    for (std::size_t k = 0; k < 9; ++k) out.omega_per_s2[k] = 0.5 * (first[k] + second[k]);
    // The mean is half their difference away from either, and one of them is right within its bound.
    if (error > out.error_per_s2) out.error_per_s2 = error;
    out.error_per_s2 += 0.5 * apart;
    if (bound.known && bound.error_per_s2 < out.error_per_s2) {
      const bool disagree = out.gyros_disagree;
      out = bound;
      out.gyros_disagree = disagree;
    }
  }
  return out;
}

MotionReadings corrected(const SensorArray& array, const MotionSetup& setup, const MotionMeans& means,
                         const RotationTerm& rotation, double noise_quantile) noexcept {
  MotionReadings out;
  if (!rotation.known || means.samples == 0) return out;
  out.usable = means.usable;
  out.at_least = means.at_least;
  out.at_most = means.at_most;
  out.noise_factor = noise_quantile * std::sqrt(means.noise_share());
  for (int i = 0; i < array.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const MotionErrors& e = setup.errors[k];
    const Vec3& arm = setup.lever_arm_m[k];
    const Vec3 metre = per_metre(rotation.omega_per_s2, array.axis(i));
    const double y = means.reading_mps2[k];
    const bool clipped = (means.at_least | means.at_most).has(i);
    out.corrected_mps2[k] = y - dot(metre, arm);
    out.part_mps2[k] = {e.lever_m * (std::fabs(metre[0]) + std::fabs(metre[1]) + std::fabs(metre[2])),
                        rotation.error_per_s2 * (norm(arm) + std::sqrt(3.0) * e.lever_m),
                        e.lag_s * (clipped ? clipped_slope_bound(setup, means) : slope_bound(means, k)) +
                            in_mean(means.interpolation_mps2[k], means),
                        e.rectification * (clipped ? clipped_square(setup, y) : means.square_m2ps4[k]),
                        of_reading(e.scale) * std::fabs(y),
                        e.axis_rad * norm(times(rotation.omega_per_s2, arm)),
                        e.bias_mps2};
    for (const double part : out.part_mps2[k]) out.error_mps2[k] += part;
  }
  return out;
}

bool rejects(const SensorArray& array, const MotionSetup& setup, const MotionSet& set,
             const MotionReadings& readings) noexcept {
  const bool clipped = !readings.usable.contains(set.all);
  if (clipped && !(readings.usable | readings.at_least | readings.at_most).contains(set.all)) return false;
  double parity = 0.0, variance = 0.0, limit = 0.0, axes = 0.0;
  for (std::size_t k = 0; k < set.size; ++k) {
    const auto i = static_cast<std::size_t>(set.sensor[k]);
    const double v = set.null[k], sigma = array.sigma_mps2(static_cast<int>(i));
    parity += v * readings.corrected_mps2[i];
    variance += v * v * sigma * sigma;
    limit += std::fabs(v) * readings.error_mps2[i];
    axes += std::fabs(v) * setup.errors[i].axis_rad;
  }
  limit += readings.noise_factor * std::sqrt(variance);
  if (clipped) {
    limit += (axes + norm(set.rest)) * setup.force_bound_mps2;
    const FullScale truth = beyond_full_scale(set, readings);
    return (parity > limit && !truth.may_be_less) || (parity < -limit && !truth.may_be_more);
  }
  const double force = force_bound(array, setup, set, readings);
  limit += axes * force;
  if (set.least_singular == 0.0) return std::fabs(parity) > limit + norm(set.rest) * force;
  // What nearly parallel axes add of the force is taken off where the set sees the force: it costs what that force is
  // off by.
  const ForceOfSet seen = force_of_set(array, setup, set, readings, force);
  return std::fabs(parity - dot(set.rest, seen.force_mps2)) > limit + norm(set.rest) * seen.error_mps2;
}

bool may_reject(const SensorArray& array, const MotionSets& sets, const MotionReadings& readings,
                const LeastSquares& fit) noexcept {
  if (!fit.valid || fit.used != readings.usable) return true;
  if (!(readings.at_least | readings.at_most).empty()) return true;
  const Vec3 force = fit.estimate(readings.corrected_mps2);
  double square = 0.0, least_error = 0.0, least_sigma = 0.0;
  bool first = true;
  for (int i = 0; i < array.size(); ++i) {
    if (!readings.usable.has(i)) continue;
    const auto k = static_cast<std::size_t>(i);
    const double rest = readings.corrected_mps2[k] - dot(array.axis(i), force);
    square += rest * rest;
    if (first || readings.error_mps2[k] < least_error) least_error = readings.error_mps2[k];
    if (first || array.sigma_mps2(i) < least_sigma) least_sigma = array.sigma_mps2(i);
    first = false;
  }
  // The product of a unit vector with the readings is at most the length of what is left of them, and what axes that
  // are only nearly dependent add: the force, or by how much the force of a set differs from that of all sensors.
  // Limits are at least this: sum |v_i| >= 1.
  const double parity = std::sqrt(square) * (1.0 + sets.largest_gain()) + sets.largest_blind_rest() * norm(force);
  return parity > least_error + readings.noise_factor * least_sigma;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
