#include "plumb/findings/rate_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "plumb/motion/motion_evidence.hpp"
#include "plumb/motion/motion_quantile.hpp"
#include "plumb/motion/motion_sets.hpp"
#include "plumb/motion/motion_window.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kMostError_radps = 1e4;
constexpr int kHalvings = 60;

/// All that one set is judged by while the tool turns at `rate_radps`.
class SetAtRate {
 public:
  SetAtRate(const SensorArray& array, const RateSetup& setup, const MotionSet& set, double noise_factor,
            double rate_radps)
      : array_(array), setup_(setup), set_(set), noise_factor_(noise_factor), rate_(rate_radps) {}

  /// The least error of member `k` that the set is sure to show.
  double shows(std::size_t k) const {
    if (!shown(k, kMostError_radps)) return kNever;
    double low = 0.0, high = kMostError_radps;
    for (int step = 0; step < kHalvings; ++step) {
      const double middle = 0.5 * (low + high);
      (shown(k, middle) ? high : low) = middle;
    }
    return high;
  }

 private:
  /// Bias and g-sensitivity: what a healthy axis reads whatever the rate is, and what the limit allows for them.
  double offset(std::size_t i) const {
    const RateErrors& e = setup_.errors[i];
    return e.bias_radps + (1.0 + 3.0 / setup_.block_samples[2]) * e.g_sensitivity_s_per_m * setup_.force_bound_mps2;
  }

  /// What parity is at least must exceed the limit of the monitor, whose reading of the faulty axis holds the error.
  bool shown(std::size_t member, double error) const {
    double healthy = 0.0, limit = 0.0, axes = 0.0, variance = 0.0;
    for (std::size_t k = 0; k < set_.size; ++k) {
      const std::size_t i = set_.sensor[k];
      const RateErrors& e = setup_.errors[i];
      const double v = std::fabs(set_.null[k]), sigma = array_.sigma_mps2(static_cast<int>(i));
      healthy += v * (offset(i) + (e.scale + e.axis_rad) * rate_);
      limit += v * (offset(i) + e.scale / (1.0 - e.scale) * reading(i, k == member ? error : 0.0));
      axes += v * e.axis_rad;
      variance += v * v * sigma * sigma;
    }
    const double noise = noise_factor_ * std::sqrt(variance);
    return std::fabs(set_.null[member]) * error > healthy + limit + 2.0 * noise +
                                                      (axes + norm(set_.rest)) * seen_rate(member, error) +
                                                      norm(set_.rest) * rate_;
  }

  double reading(std::size_t i, double error) const {
    const RateErrors& e = setup_.errors[i];
    return (1.0 + e.scale + e.axis_rad) * rate_ + offset(i) + error +
           noise_factor_ * array_.sigma_mps2(static_cast<int>(i));
  }

  /// How fast the monitor takes the tool to turn at most, by the readings of the set.
  double seen_rate(std::size_t member, double error) const {
    double square = 0.0, turn = 0.0;
    for (int i = 0; i < array_.size(); ++i) {
      if (!set_.all.has(i)) continue;
      const auto at = static_cast<std::size_t>(i);
      const double most = 2.0 * reading(at, at == set_.sensor[member] ? error : 0.0);
      square += most * most;
      turn += setup_.errors[at].axis_rad * setup_.errors[at].axis_rad;
    }
    const double singular = set_.least_singular - std::sqrt(turn);
    return singular > 0.0 ? std::fmin(std::sqrt(square) / singular, setup_.rate_bound_radps) : setup_.rate_bound_radps;
  }

  const SensorArray& array_;
  const RateSetup& setup_;
  const MotionSet& set_;
  double noise_factor_, rate_;
};

int isolated_units(const SensorArray& array, const RateSetup& setup) {
  return std::min(motion_grade(array, array.all()), setup.max_faults);
}

double noise_factor_of(const RateSetup& setup, int sets) {
  MotionSetup motion;
  motion.sample_period_s = setup.sample_period_s;
  motion.false_alarms_per_hour = setup.false_alarms_per_hour;
  motion.block_samples = setup.block_samples;
  MotionMeans block;
  block.samples = setup.block_samples[2];
  return motion_noise_quantile(motion, sets) * std::sqrt(block.noise_share());
}

/// A set that an error of one axis shows in, and the least such error.
struct Showing {
  double error = kNever;
  SensorSet units;
};

/// The largest of the least errors that show in spite of any `faults` other units being left out.
double isolated_from(std::vector<Showing> sets, const SensorUnits& units, int own, int faults) {
  if (faults < 1) return kNever;
  std::sort(sets.begin(), sets.end(), [](const Showing& a, const Showing& b) { return a.error < b.error; });
  double out = 0.0;
  for (SensorSet left_out = SensorSet::first(faults); units.all().contains(left_out);
       left_out = next_of_same_size(left_out)) {
    if (left_out.has(own)) continue;
    const auto showing = std::find_if(sets.begin(), sets.end(),
                                      [left_out](const Showing& one) { return (one.units & left_out).empty(); });
    out = std::fmax(out, showing == sets.end() ? kNever : showing->error);
  }
  return out;
}

}  // namespace

RateSizes rate_sizes(const SensorArray& array, const RateSetup& setup, double rate_radps) {
  const auto n = static_cast<std::size_t>(array.size());
  const auto sets = std::make_unique<const MotionSets>(array);
  const double noise_factor = noise_factor_of(setup, sets->size());
  std::vector<std::vector<Showing>> showing(n);
  for (int s = 0; s < sets->size(); ++s) {
    const MotionSet& set = (*sets)[s];
    const SetAtRate at_rate(array, setup, set, noise_factor, rate_radps);
    for (std::size_t k = 0; k < set.size; ++k)
      showing[set.sensor[k]].push_back({at_rate.shows(k), array.units().units_of(set.all)});
  }
  RateSizes out{rate_radps, std::vector<RateSize>(n, RateSize{kNever, kNever})};
  const int faults = isolated_units(array, setup);
  for (std::size_t i = 0; i < n; ++i) {
    for (const Showing& one : showing[i]) out.axis[i].detected_radps = std::fmin(out.axis[i].detected_radps, one.error);
    out.axis[i].isolated_radps =
        isolated_from(std::move(showing[i]), array.units(), array.units().of(static_cast<int>(i)), faults);
  }
  return out;
}

RateGeometry study_rates(const SensorArray& array, const RateSetup& setup) {
  RateGeometry out;
  out.merit = figures_of_merit(array);
  out.isolated_units = isolated_units(array, setup);
  out.at_rest = rate_sizes(array, setup, setup.at_rest_radps);
  out.turning = rate_sizes(array, setup, setup.rate_bound_radps);
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
