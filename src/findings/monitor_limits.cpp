#include "plumb/findings/monitor_limits.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "plumb/detection/estimate_error.hpp"
#include "plumb/detection/mae_test.hpp"
#include "plumb/findings/detection_sizes.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

using std::size_t;

constexpr int kSearched = kSearchedAttitudes;
constexpr double kLargestFault_mps2 = 2.0 * kG0_mps2;
constexpr double kFaultStep = 1.02;  ///< ratio of one fault looked at to the next

Vec3 attitude(int k) { return spread_direction(k, kSearched); }

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + kSearched / 2, values.end());
  return values[kSearched / 2];
}

/// Figures of one test over the attitudes.
struct Collected {
  std::vector<double> noise, systematic, bias;
  void add(double noise_mps2, double limit_mps2, double bias_mps2) {
    noise.push_back(noise_mps2);
    systematic.push_back(limit_mps2 - noise_mps2);
    bias.push_back(bias_mps2);
  }
  TestLimit median_of() const { return {median(noise), median(systematic), median(bias)}; }
};

/// A healthy block without noise, with the drift that its limits allow for.
BlockEvidence block_at(const SensorArray& array, const Vec3& g, int window, const Readings& tolerance_mps2) {
  BlockEvidence block;
  for (size_t i = 0; i < tolerance_mps2.size(); ++i) block.tolerance_mps2[i] = static_cast<float>(tolerance_mps2[i]);
  block.usable = array.all();
  block.samples = window;
  for (int i = 0; i < array.size(); ++i) block.mean_mps2[static_cast<size_t>(i)] = dot(array.axis(i), g);
  return block;
}

/// How a unit bias shows for the sensor where it shows least: in parity (per sigma of one sample), in the length [1].
struct Visibility {
  double parity = 1e300, length = 1e300;
};

Visibility visibility(const SensorArray& array, const LeastSquares& map, const Vec3& u) {
  Visibility out;
  for (int i = 0; i < array.size(); ++i) {
    const Vec3& column = map.column[static_cast<size_t>(i)];
    const double leverage = std::fmax(1.0 - dot(array.axis(i), column), 0.0);  // diagonal of the parity projector
    out.parity = std::fmin(out.parity, std::sqrt(leverage) / array.sigma_mps2(i));
    out.length = std::fmin(out.length, std::fabs(dot(u, column)));
  }
  return out;
}

/// Limits of one attitude for one sample's sigma: parity in sigmas, length in m/s^2.
struct AttitudeLimits {
  double parity_noise = 0.0, parity = 0.0;
  double length_noise_mps2 = 0.0, length_mps2 = 0.0;
  double left = 0.0;  ///< 1 sigma of what calibration leaves, misfit included, in sigmas of one sample
};

/// `t` of a block with its tolerances, `undrifted` without, `drift` what these add; `calibrated_at_mps2`: 1 sigma of
/// the gravity at which the array was calibrated; `misfit`: `largest_misfit` of this
/// block.
AttitudeLimits limits_of(const SetTest& t, const SetTest& undrifted, const ToleranceBound& drift,
                         const TestLimits& limits, const GravityReference& gravity, double calibrated_at_mps2,
                         double misfit, AlarmForm form, int window) {
  AttitudeLimits out;
  const double root_n = std::sqrt(window), s = t.norm_sigma_mps2;
  const double growth = noise_growth(misfit);
  const double parity_grown = limits.reject[static_cast<size_t>(t.parity_rows)] * growth;
  const double parity_left =
      std::hypot((undrifted.parity_systematic - parity_grown) / root_n / limits.parity_calibration, misfit / root_n);
  const double gravity_bound = TestLimits::gravity * (gravity.sigma_mps2 + calibrated_at_mps2) / s;
  const double pushed = limits.acceleration_mps2 / s;
  const double length_bound = (undrifted.norm_systematic - limits.reject[1] * growth) / root_n;
  const double length_left =
      std::hypot(std::fmax(length_bound - gravity_bound - pushed, 0.0) / limits.norm_calibration, misfit / root_n);
  const double alarm = limits.parity_alarm[static_cast<size_t>(t.parity_rows)];
  out.left = t.parity_rows > 0 ? parity_left : length_left;
  out.parity_noise = t.parity_rows > 0 ? alarm / root_n : 0.0;
  out.length_noise_mps2 = limits.norm_alarm * s / root_n;
  if (form == AlarmForm::average_tool) {
    out.parity = out.parity_noise * std::sqrt(1.0 + window * parity_left * parity_left) + drift.parity / root_n;
    const double sigma_g = std::hypot(gravity.sigma_mps2, calibrated_at_mps2) / s;
    out.length_mps2 =
        out.length_noise_mps2 * std::sqrt(1.0 + window * (length_left * length_left + sigma_g * sigma_g)) +
        limits.acceleration_mps2 + drift.norm_mps2;
  } else {
    out.parity = out.parity_noise + t.parity_systematic / root_n;
    out.length_mps2 = out.length_noise_mps2 + t.norm_systematic / root_n * s;
  }
  return out;
}

/// The widest limit of a monitored triple at one attitude.
MaeLimit widest_triple(const SensorArray& array, const GravityReference& gravity, const TestLimits& limits,
                       const BlockEvidence& block, const MonitorConfig& config, double quantile) {
  if (config.delta_f_mps2 > 0.0) return given_mae_limit(config.delta_f_mps2);
  MaeLimit widest;
  for (int k = 0; k < array.triple_count(); ++k) {
    if (!array.triple(k).votes) continue;
    const SetTest three = test_set(array, gravity, limits, block, array.triple(k).set());
    const MaeLimit limit = computed_mae_limit(three, block, config.window, quantile);
    if (limit.limit_mps2() > widest.limit_mps2()) widest = limit;
  }
  return widest;
}

/// Largest bias of sensor i that every monitored triple passes at delta_F, without noise.
double hidden_bias(const SensorArray& array, const std::vector<Mat3>& maps, int i, const Vec3& g, double g_mps2,
                   double delta_f_mps2) {
  const auto passes = [&](double fault) {
    for (int k = 0; k < array.triple_count(); ++k) {
      const Triple& triple = array.triple(k);
      if (!triple.votes || !triple.set().has(i)) continue;
      const size_t column = triple.sensors[0] == i ? 0U : triple.sensors[1] == i ? 1U : 2U;
      const Mat3& m = maps[static_cast<size_t>(k)];
      const Vec3 x = plus(g, scaled({m[column], m[3 + column], m[6 + column]}, fault));
      if (!(std::fabs(norm(x) - g_mps2) < delta_f_mps2)) return false;
    }
    return true;
  };
  for (double fault = kLargestFault_mps2; fault > 1e-6 * kG0_mps2; fault /= kFaultStep) {
    if (passes(fault)) return fault;
    if (passes(-fault)) return -fault;
  }
  return 0.0;
}

void look_for_hidden(const SensorArray& array, const GravityReference& gravity, MonitorLimits& out) {
  const LeastSquares map = least_squares(array, array.all());
  std::vector<Mat3> maps;
  for (int k = 0; k < array.triple_count(); ++k) maps.push_back(array.triple(k).votes ? triple_map(array, k) : Mat3{});
  std::vector<double> hidden;
  for (int k = 0; k < kSearched; ++k) {
    const Vec3 g = scaled(attitude(k), gravity.g_mps2);
    double most = 0.0;
    for (int i = 0; i < array.size(); ++i) {
      const double fault = hidden_bias(array, maps, i, g, gravity.g_mps2, out.delta_f_mps2);
      most = std::fmax(most, std::fabs(fault));
      const Vec3 x = plus(g, scaled(map.column[static_cast<size_t>(i)], fault));
      out.blind_tilt_rad = std::fmax(out.blind_tilt_rad, angle_between_rad(x, g));
    }
    hidden.push_back(most);
  }
  out.blind_median_mps2 = median(hidden);
  out.blind_worst_mps2 = *std::max_element(hidden.begin(), hidden.end());
}

}  // namespace

MonitorLimits monitor_limits(const SensorArray& array, const GravityReference& gravity, const MonitorConfig& config,
                             const Readings& tolerance_mps2) {
  MonitorLimits out;
  const int n = array.size();
  out.sensors = n;
  out.window = config.window;
  out.delta_f_mps2 = config.delta_f_mps2;
  const TestLimits limits =
      TestLimits::from_rates(n, config.false_alarm_rate, config.rejection_rate, config.acceleration_bound_mps2)
          .of(array);
  const double rate = config.triple_false_alarm_rate > 0.0 ? config.triple_false_alarm_rate
                                                           : triple_share(array, config.false_alarm_rate);
  const double quantile = half_normal_mean_quantile(config.window, rate);
  const LeastSquares map = least_squares(array, array.all());
  double noise = 0.0, left = 0.0;
  for (int i = 0; i < n; ++i) noise += array.sigma_mps2(i) * array.sigma_mps2(i) / n;
  out.noise_mps2 = std::sqrt(noise);
  out.tolerance_mps2 = *std::max_element(tolerance_mps2.begin(), tolerance_mps2.end());
  for (int i = 0; i < n; ++i) out.untold += tolerance_mps2[static_cast<size_t>(i)] > 0.0 ? 0 : 1;
  Collected parity, length, triple;
  const double misfit = largest_misfit(array, array.uncertainty(), array.all(), config.window);
  for (int k = 0; k < kSearched; ++k) {
    const Vec3 u = attitude(k);
    const Vec3 g = scaled(u, gravity.g_mps2);
    const BlockEvidence block = block_at(array, g, config.window, tolerance_mps2);
    const SetTest t = test_set(array, gravity, limits, block, array.all());
    const SetTest undrifted = test_set(array, gravity, limits, block_at(array, g, config.window, {}), array.all());
    const AttitudeLimits at =
        limits_of(t, undrifted, tolerance_bound(array, block, array.all(), t), limits, gravity,
                  array.uncertainty().common_scale * gravity.g_mps2, misfit, config.alarm_form, config.window);
    const Visibility seen = visibility(array, map, u);
    if (n > 3) parity.add(at.parity_noise * out.noise_mps2, at.parity * out.noise_mps2, at.parity / seen.parity);
    length.add(at.length_noise_mps2, at.length_mps2, at.length_mps2 / std::fmax(seen.length, 1e-9));
    const MaeLimit widest = widest_triple(array, gravity, limits, block, config, quantile);
    triple.add(widest.noise_mps2, widest.limit_mps2(), 0.0);
    left += at.left * at.left / kSearched;
  }
  if (n > 3) out.parity = parity.median_of();
  out.length = length.median_of();
  out.triple = triple.median_of();
  out.left_mps2 = std::sqrt(left) * out.noise_mps2;
  out.useful_samples = left > 0.0 ? 1.0 / left : 0.0;
  if (config.delta_f_mps2 > 0.0) look_for_hidden(array, gravity, out);
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
