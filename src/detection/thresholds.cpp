#include "plumb/detection/thresholds.hpp"

#include <cmath>
#include <limits>

#include "largest_eigenvalue.hpp"
#include "plumb/core/detail/numbers.hpp"
#include "plumb/core/units.hpp"
#include "plumb/detection/detail/parity_rows.hpp"
#include "plumb/detection/detectable.hpp"
#include "plumb/detection/estimate_error.hpp"
#include "plumb/detection/isolation.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;
using numbers::kInfinity;

namespace {

using detection_detail::largest_eigenvalue;

/// Bound of sqrt(z' Cov_ii z) over all attitudes, z = (g, 1): the axis part by its largest eigenvalue, the cross term
/// by its length.
double calibration_sigma(const SensorArray& array, int i, double g_mps2) noexcept {
  const RowUncertainty& u = array.uncertainty();
  const auto entry = [&u, i](int p, int q) {
    const int a = 4 * i + (p > q ? p : q);
    const int b = 4 * i + (p > q ? q : p);
    return u.covariance[at(a * (a + 1) / 2 + b)];
  };
  Mat3 axis{};
  for (int p = 0; p < 3; ++p) {
    for (int q = 0; q < 3; ++q) axis[at(3 * p + q)] = entry(p, q);
  }
  const double across = norm({entry(3, 0), entry(3, 1), entry(3, 2)});
  const double misfit = u.misfit_mps2[at(i)];
  const double variance =
      g_mps2 * g_mps2 * largest_eigenvalue(axis) + 2.0 * g_mps2 * across + entry(3, 3) + misfit * misfit;
  return variance > 0.0 ? std::sqrt(variance) : 0.0;
}

/// Variance with which the rest predicts sensor i [(m/s^2)^2 of one sample]; infinite where the rest has no rank.
double predicted_variance(const SensorArray& array, SensorSet rest, int i) noexcept {
  const LeastSquares fit = least_squares(array, rest);
  if (!fit.valid) return kInfinity;
  return dot(array.axis(i), times(fit.covariance, array.axis(i)));
}

/// A bias of sensor i in m/s^2 that shifts the parity of rest + {i} by one standard deviation of a block mean.
double unit_bias(const SensorArray& array, SensorSet rest, int i, double samples) noexcept {
  const double sigma = array.sigma_mps2(i);
  return std::sqrt((sigma * sigma + predicted_variance(array, rest, i)) / samples);
}

double binomial(int n, int k) noexcept {
  double out = 1.0;
  for (int i = 1; i <= k; ++i) out = out * (n - k + i) / i;
  return out;
}

/// What the provisional grade's own vote takes: every set of units with that of sensor i that it hears must be
/// rejected.
class SetAside {
 public:
  SetAside(const SensorArray& array, const TestSettings& settings, const ErrorBudget& budget) noexcept
      : array_(array), settings_(settings), budget_(budget), grade_(provisional_grade(array, array.all())) {
    const int units = array.units().size();
    if (units > kStrictCapacity && grade_ > kScanDepth) grade_ = kScanDepth;
    for (int m = 0; m <= grade_; ++m) sets_ += hears(m) ? binomial(units - 1, m) : 0.0;
  }

  double of(int i) const noexcept {
    if (grade_ < 1) return kInfinity;
    double worst = 0.0;
    for (int m = 0; m <= grade_; ++m) {
      const double bias = hears(m) ? hardest(i, m) : 0.0;
      if (bias > worst) worst = bias;
    }
    return worst;
  }

 private:
  /// Fault sets are heard one by one up to the depth of the scan, and those of the grade's own size.
  bool hears(int m) const noexcept { return m <= kScanDepth || m == grade_; }

  /// Shift of the parity of a set of `sensors`, without m units, that rejects it, the chance of a miss shared among all
  /// sets.
  double shift(int m, int sensors) const noexcept {
    const int dof = sensors - 3;
    const double alarm = m == 0 ? budget_.limits.parity_alarm[at(dof)] : 0.0;
    const double reject = budget_.limits.reject[at(dof)];
    const double limit = (alarm > reject ? alarm : reject) + budget_.parity_systematic;
    return detectable_shift(limit, dof, settings_.missed_detection / sets_) + budget_.parity_systematic;
  }

  /// Largest bias of sensor i that is needed over all choices of m other units to omit.
  double hardest(int i, int m) const noexcept {
    const SensorUnits& units = array_.units();
    const SensorSet others = array_.all().without(i);
    if (m == 0) return shift(0, array_.size()) * unit_bias(array_, others, i, settings_.samples);
    double worst = 0.0;
    Readings of_size{};  // the shift is the same for all sets of so many sensors, and dear
    for (SensorSet out = SensorSet::first(m); units.all().contains(out); out = next_of_same_size(out)) {
      if (out.has(units.of(i))) continue;
      const SensorSet rest = others - units.sensors_of(out);
      const int sensors = rest.size() + 1;
      double& needed = of_size[at(sensors - 1)];
      if (!(needed > 0.0)) needed = shift(m, sensors);
      const double bias = needed * unit_bias(array_, rest, i, settings_.samples);
      if (bias > worst) worst = bias;
    }
    return worst;
  }

  const SensorArray& array_;
  const TestSettings& settings_;
  const ErrorBudget& budget_;
  int grade_;
  double sets_ = 0.0;
};

/// Longest parity residual of drift within its tolerance, in standard deviations of a block mean: as `tolerance_bound`
/// of the tests has it for all sensors. The residual of fewer is no longer.
double drift_in_parity(const SensorArray& array, const TestSettings& settings, const Readings& noise_mps2) noexcept {
  const LeastSquares fit = least_squares(array, array.all());
  double columns = 0.0, square = 0.0;
  for (int i = 0; i < array.size() && array.size() > 3; ++i) {
    const double tau = settings.tolerance_mps2[at(i)] / noise_mps2[at(i)];
    const double leverage = 1.0 - dot(array.axis(i), fit.column[at(i)]);
    columns += leverage > 0.0 ? std::sqrt(leverage) * tau : 0.0;
    square += tau * tau;
  }
  return std::fmin(columns, std::sqrt(square));
}

/// What parity finds of single biases: fills `detectable_mps2` and `gain`.
void find_detectable(const SensorArray& array, const TestSettings& settings, const ErrorBudget& budget,
                     std::array<SensorThresholds, kCapacity>& sensor) noexcept {
  const int dof = array.size() - 3;
  const double systematic = budget.parity_systematic;
  const double shift = dof < 1 ? kInfinity
                               : systematic + detectable_shift(budget.limits.parity_alarm[at(dof)] + systematic, dof,
                                                               settings.missed_detection);
  const LeastSquares fit = least_squares(array, array.all());
  for (int i = 0; i < array.size(); ++i) {
    sensor[at(i)].gain = norm(fit.column[at(i)]);
    sensor[at(i)].detectable_mps2 = shift * unit_bias(array, array.all().without(i), i, settings.samples);
  }
}

/// k_v times the root of the largest trace of the covariance that calibration leaves in the vector of all sensors, over
/// all attitudes; k_v holds for its twelve numbers at once.
double calibrated_vector_mps2(const SensorArray& array, double g_mps2) noexcept {
  constexpr int kNumbers = 12;
  return std::sqrt(chi2_tail_quantile(0.005, kNumbers) * worst_vector_variance(array, g_mps2));
}

double protection_level(const SensorArray& array, const GravityReference& gravity, const TestSettings& settings,
                        const std::array<SensorThresholds, kCapacity>& sensor) noexcept {
  double bias = 0.0, left = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    const SensorThresholds& s = sensor[at(i)];
    const double moved = s.gain * s.detectable_mps2;
    if (moved > bias) bias = moved;
    left += s.gain * settings.tolerance_mps2[at(i)];
  }
  left += calibrated_vector_mps2(array, gravity.g_mps2);
  const double largest = largest_eigenvalue(least_squares(array, array.all()).covariance);
  const double noise = normal_tail_quantile(0.5 * settings.integrity_risk) * std::sqrt(largest / settings.samples);
  const double error = (bias + noise + left) / gravity.g_mps2;
  const double level =
      (error < 1.0 ? std::asin(error) : kPi) + acceleration_turn_rad(gravity, settings.acceleration_mps2);
  return level < kPi ? level : kPi;
}

}  // namespace

ErrorBudget error_budget(const SensorArray& array, const GravityReference& gravity,
                         const TestSettings& settings) noexcept {
  ErrorBudget out;
  const int n = array.size();
  if (n < 3) return out;
  out.limits = TestLimits::from_rates(n, settings.false_alarm_rate, settings.rejection_rate, settings.acceleration_mps2)
                   .of(array);
  out.noise_factor = normal_tail_quantile(settings.rejection_rate / (2.0 * n));
  const double calibrated_at = array.uncertainty().common_scale * gravity.g_mps2;
  out.gravity_mps2 = TestLimits::gravity * (gravity.sigma_mps2 + calibrated_at) + settings.acceleration_mps2;
  for (int i = 0; i < n; ++i) {
    const double sigma = array.sigma_mps2(i) / std::sqrt(settings.samples);
    out.calibration_mps2[at(i)] = out.limits.calibration * calibration_sigma(array, i, gravity.g_mps2);
    out.noise_mps2[at(i)] = sigma;
    out.systematic_mps2[at(i)] = out.calibration_mps2[at(i)] + settings.tolerance_mps2[at(i)];
  }
  const double variance = settings.samples * worst_parity_variance(array, gravity.g_mps2);
  const double growth = noise_growth(largest_misfit(array, array.uncertainty(), array.all(), settings.samples));
  out.parity_systematic = out.limits.parity_calibration * std::sqrt(variance) +
                          (n > 3 ? out.limits.reject[at(n - 3)] * growth : 0.0) +
                          drift_in_parity(array, settings, out.noise_mps2);
  return out;
}

/// Shifted by the fault, parity stays above limit + b_S whatever the noise and what is systematic take off it.
double guaranteed_detection_mps2(const SensorArray& array, const TestSettings& settings, const ErrorBudget& budget,
                                 int i) noexcept {
  const int dof = array.size() - 3;
  if (dof < 1) return kInfinity;
  const double limit = budget.limits.parity_alarm[at(dof)] + budget.parity_systematic;
  const double against = budget.limits.reject[at(dof)] + budget.parity_systematic;
  return (limit + against) * unit_bias(array, array.all().without(i), i, settings.samples);
}

double protection_level_rad(const SensorArray& array, const GravityReference& gravity,
                            const TestSettings& settings) noexcept {
  if (array.size() < 3) return kPi;
  std::array<SensorThresholds, kCapacity> sensor{};
  const ErrorBudget budget = error_budget(array, gravity, settings);
  find_detectable(array, settings, budget, sensor);
  return protection_level(array, gravity, settings, sensor);
}

Thresholds thresholds_of(const SensorArray& array, const GravityReference& gravity,
                         const TestSettings& settings) noexcept {
  Thresholds out;
  const int n = array.size();
  out.protection_rad = kPi;
  if (n < 3) return out;
  const ErrorBudget budget = error_budget(array, gravity, settings);
  // A set that passes leaves no residual beyond its limit, and the truth none beyond the budget: together the slack.
  double limit = 0.0;
  for (int nu = 1; nu <= n - 3; ++nu) {
    for (const double one : {budget.limits.reject[at(nu)], budget.limits.parity_alarm[at(nu)]})
      limit = one > limit ? one : limit;
  }
  Readings slack{};
  for (int i = 0; i < n; ++i) {
    slack[at(i)] = budget.noise_mps2[at(i)] * (limit + budget.parity_systematic + budget.noise_factor) +
                   budget.systematic_mps2[at(i)];
  }
  out.sure = fault_bounds(array, slack);
  find_detectable(array, settings, budget, out.sensor);
  const SetAside provisionally_excluded(array, settings, budget);
  for (int i = 0; i < n; ++i) {
    out.sensor[at(i)].provisional_exclusion_mps2 = provisionally_excluded.of(i);
    out.sensor[at(i)].guaranteed_detection_mps2 = plumb::guaranteed_detection_mps2(array, settings, budget, i);
  }
  out.protection_rad = protection_level(array, gravity, settings, out.sensor);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
