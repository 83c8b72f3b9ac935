#include "plumb/noise/allan.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "phase_covariance.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// Tails of a 95 % interval.
constexpr double kTail = 0.025;
/// A mean over more than a third of the log has no neighbour of its own length left beside it.
constexpr std::size_t kLeastMeans = 3;
/// Lags per averaging time at which covariances are summed; beyond kReach averaging times they are forgotten (those of
/// flicker noise fall as lag^-2 there).
constexpr double kLagsPerStep = 64.0, kReach = 8.0;

/// Of flicker and walk the covariance at a long lag is a small difference of large numbers; this much of it is
/// rounding.
constexpr double kNegligible = 1e-9;

}  // namespace

std::vector<double> prefix_sums(const std::vector<double>& readings) {
  // Twice, so that the first mean need not be exact: sums then stay as small as the noise lets them.
  double mean = 0.0, rest = 0.0;
  const double n = static_cast<double>(std::max<std::size_t>(readings.size(), 1));
  for (const double y : readings) mean += y / n;
  for (const double y : readings) rest += (y - mean) / n;
  std::vector<double> sums(readings.size() + 1, 0.0);
  for (std::size_t k = 0; k < readings.size(); ++k) sums[k + 1] = sums[k] + ((readings[k] - mean) - rest);
  return sums;
}

double allan_variance(const std::vector<double>& sums, std::size_t samples) noexcept {
  if (samples == 0 || sums.size() <= 2 * samples) return 0.0;
  const std::size_t count = sums.size() - 2 * samples;
  double total = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double second = sums[k + 2 * samples] - 2.0 * sums[k + samples] + sums[k];
    total += second * second;
  }
  const auto m = static_cast<double>(samples);
  return total / (2.0 * m * m * static_cast<double>(count));
}

std::vector<std::size_t> averaging_lengths(std::size_t readings, int per_octave) {
  std::vector<std::size_t> out;
  const double step = std::exp2(1.0 / std::max(per_octave, 1));
  const std::size_t last = readings / kLeastMeans;
  for (int k = 0;; ++k) {
    const auto length = static_cast<std::size_t>(std::llround(std::pow(step, k)));
    if (length > last) return out;
    if (out.empty() || length > out.back()) out.push_back(length);
  }
}

std::vector<AllanPoint> allan_deviation(const std::vector<double>& sums, double period_s, int per_octave) {
  std::vector<AllanPoint> out;
  for (const std::size_t samples : averaging_lengths(sums.size() - 1, per_octave)) {
    AllanPoint point;
    point.samples = samples;
    point.tau_s = static_cast<double>(samples) * period_s;
    point.deviation = std::sqrt(allan_variance(sums, samples));
    out.push_back(point);
  }
  return out;
}

double equivalent_freedom(const Coefficients& noise, std::size_t readings, std::size_t samples,
                          double period_s) noexcept {
  if (readings < 2 * samples || samples == 0) return 1.0;
  const Variances unit = per_sample(squares(noise), period_s);
  const auto m = static_cast<double>(samples), count = static_cast<double>(readings + 1 - 2 * samples);
  const double variance = second_difference_covariance(unit, m, 0.0);
  if (!(variance > 0.0)) return 1.0;
  // Sum over all lags of (1 - |lag|/count) rho^2, in steps where m is long. Quantisation correlates at the lags 0, m
  // and 2m alone, which steps would pass over or count too often: it is added there.
  Variances smooth = unit;
  smooth[index(Term::quantisation)] = 0.0;
  const auto squared = [m, variance](const Variances& of, double lag) {
    const double rho = second_difference_covariance(of, m, lag) / variance;
    return std::fabs(rho) > kNegligible ? rho * rho : 0.0;
  };
  const double stride = std::max(1.0, std::floor(m / kLagsPerStep));
  const double reach = std::min(count, kReach * m);
  double sum = 0.5 * squared(smooth, 0.0);
  const auto steps = static_cast<int>(std::ceil(reach / stride));
  for (int k = 1; k < steps; ++k) {
    const double lag = k * stride;
    sum += (1.0 - lag / count) * squared(smooth, lag);
  }
  double all = 2.0 * stride * sum + 1.0 - squared(smooth, 0.0);
  for (const double lag : {m, 2.0 * m}) {
    if (lag < count) all += 2.0 * (1.0 - lag / count) * (squared(unit, lag) - squared(smooth, lag));
  }
  return std::max(1.0, count / all);
}

void add_intervals(std::vector<AllanPoint>& points, const Coefficients& noise, std::size_t readings, double period_s) {
  for (AllanPoint& point : points) {
    point.freedom = equivalent_freedom(noise, readings, point.samples, period_s);
    const boost::math::chi_squared law(point.freedom);
    point.low = point.deviation * std::sqrt(point.freedom / boost::math::quantile(law, 1.0 - kTail));
    point.high = point.deviation * std::sqrt(point.freedom / boost::math::quantile(law, kTail));
  }
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
