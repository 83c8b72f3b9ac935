#include "plumb/session/group_rates.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

using TriadRows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Below this least singular value axes lie nearly in a plane: what they are off by would grow fourfold and more.
constexpr double kSpans = 0.25;

TriadRows rows_of(const SensorArray& array, const std::vector<int>& axes) {
  TriadRows out(static_cast<Eigen::Index>(axes.size()), 3);
  for (std::size_t k = 0; k < axes.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      out(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) = array.axis(axes[k])[c];
  }
  return out;
}

double least_singular(const SensorArray& array, const std::vector<int>& axes) {
  const TriadRows rows = rows_of(array, axes);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(rows.transpose() * rows);
  return std::sqrt(std::max(eigen.eigenvalues()[0], 0.0));
}

}  // namespace

void GroupRates::add(const std::vector<int>& axes) {
  Triad out;
  const TriadRows rows = rows_of(group_.array, axes);
  const Eigen::Matrix<double, 3, Eigen::Dynamic> solve = (rows.transpose() * rows).ldlt().solve(rows.transpose());
  std::array<double, 3> noise{}, relative{}, bias{}, force{}, lag{};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const RateErrors& e = group_.setup.errors[static_cast<std::size_t>(axes[k])];
    out.axes = out.axes.with(axes[k]);
    out.axis.push_back(axes[k]);
    out.solve.push_back({solve(0, column), solve(1, column), solve(2, column)});
    for (std::size_t c = 0; c < 3; ++c) {
      const double part = std::fabs(solve(static_cast<Eigen::Index>(c), column));
      relative[c] += part * (e.scale + (1.0 + e.scale) * e.axis_rad);
      bias[c] += part * e.bias_radps;
      force[c] += part * e.g_sensitivity_s_per_m;
      lag[c] += part * (1.0 + e.scale) * e.lag_s;
      noise[c] = std::hypot(noise[c], part * group_.array.sigma_mps2(axes[k]));
    }
  }
  const auto most = [](const std::array<double, 3>& v) { return std::max({v[0], v[1], v[2]}); };
  out.errors = {most(relative), 0.0, most(bias), most(noise), most(lag)};
  out.per_force = most(force);
  triad_.push_back(std::move(out));
}

/// The best conditioned three first, and so on with the rest: few axes, so every choice is looked at.
void GroupRates::put_together(std::vector<int> loose) {
  while (loose.size() >= 3) {
    std::vector<int> best;
    double least = kSpans;
    for (std::size_t a = 0; a < loose.size(); ++a) {
      for (std::size_t b = a + 1; b < loose.size(); ++b) {
        for (std::size_t c = b + 1; c < loose.size(); ++c) {
          const std::vector<int> one = {loose[a], loose[b], loose[c]};
          const double found = least_singular(group_.array, one);
          if (!(found > least * (1.0 + 1e-9))) continue;
          least = found;
          best = one;
        }
      }
    }
    if (best.empty()) break;
    add(best);
    for (const int axis : best) loose.erase(std::find(loose.begin(), loose.end(), axis));
  }
  for (const int axis : loose) left_out_ = left_out_.with(axis);
}

int GroupRates::spoiled_by_one() const {
  int most = 0;
  const SensorUnits& units = group_.array.units();
  for (int unit = 0; unit < units.size(); ++unit) {
    const SensorSet sensors = units.sensors_of(SensorSet::of(unit));
    int spoiled = 0;
    for (const Triad& one : triad_) spoiled += (one.axes & sensors).empty() ? 0 : 1;
    most = std::max(most, spoiled);
  }
  return most;
}

io::FileExpected<GroupRates> GroupRates::make(const RateGroup& group, int faults) {
  GroupRates out(group);
  const SensorUnits& units = group.array.units();
  std::vector<int> loose;
  for (int unit = 0; unit < units.size(); ++unit) {
    std::vector<int> axes;
    for (int i = 0; i < group.array.size(); ++i) {
      if (units.of(i) == unit) axes.push_back(i);
    }
    const bool whole = axes.size() >= 3 && least_singular(group.array, axes) > kSpans;
    if (whole) out.add(axes);
    if (!whole) loose.insert(loose.end(), axes.begin(), axes.end());
  }
  out.put_together(std::move(loose));
  while (out.triads() > kMostTriads) {
    out.left_out_ = out.left_out_ | out.triad_.back().axes;
    out.triad_.pop_back();
  }
  out.outvoted_ = std::max(faults, 0) * out.spoiled_by_one();
  if (out.triads() < 2 * out.outvoted_ + 1 || out.triad_.empty())
    return tl::unexpected<io::FileError>(
        io::FileError{"", 0, "group.sensor",
                      "has " + std::to_string(out.triads()) + " triads of gyros that share no axis, and " +
                          std::to_string(2 * out.outvoted_ + 1) + " are needed for one that is right whichever fails",
                      "three chips of three axes each (package), or nine axes of which three and three span space"});
  for (const Triad& one : out.triad_) out.lag_s_ = std::max(out.lag_s_, std::sqrt(3.0) * one.errors.lag_s);
  return out;
}

TriadRates GroupRates::rates_of(const RateSample& sample, SensorSet without) const noexcept {
  TriadRates out;
  out.triads = triads();
  const SensorSet here = (sample.delivered - sample.clipped) - without;
  for (std::size_t t = 0; t < triad_.size(); ++t) {
    const Triad& one = triad_[t];
    if (!(one.axes - here).empty()) continue;
    Vec3 rate{};
    for (std::size_t k = 0; k < one.axis.size(); ++k) {
      const double y = sample.rate_radps[static_cast<std::size_t>(one.axis[k])];
      for (std::size_t c = 0; c < 3; ++c) rate[c] += one.solve[k][c] * y;
    }
    out.rate_radps[t] = rate;
    out.given[t] = std::isfinite(rate[0]) && std::isfinite(rate[1]) && std::isfinite(rate[2]);
  }
  return out;
}

GroupRates::Together GroupRates::together(const TriadRates& rates) const noexcept {
  if (const MedianRate median = median_rate(rates, outvoted_); median.given) return {true, median.rate_radps, 0.0};
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Vec3 low{kNone, kNone, kNone}, high{-kNone, -kNone, -kNone};
  int count = 0;
  for (std::size_t t = 0; t < static_cast<std::size_t>(rates.triads); ++t) {
    if (!rates.given[t]) continue;
    ++count;
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::fmin(low[c], rates.rate_radps[t][c]);
      high[c] = std::fmax(high[c], rates.rate_radps[t][c]);
    }
  }
  if (count <= outvoted_) return {};  // all of them may be faulty
  const Vec3 middle = scaled(plus(low, high), 0.5);
  const double spread_radps = 0.5 * norm(minus(high, low));
  // Numbers so large that their sum or difference is none say nothing.
  return {std::isfinite(norm(middle)) && std::isfinite(spread_radps), middle, spread_radps};
}

GyroErrors GroupRates::worst_errors(const RateSample& sample) const noexcept {
  const bool told = sample.force_mps2 >= 0.0 && std::isfinite(sample.force_mps2);
  const double force_mps2 = told ? sample.force_mps2 : group_.setup.force_bound_mps2;
  GyroErrors out;
  for (const Triad& one : triad_) {
    out.scale = std::max(out.scale, one.errors.scale);
    out.bias_radps = std::max(out.bias_radps, one.errors.bias_radps + one.per_force * force_mps2);
    out.noise_radps = std::max(out.noise_radps, one.errors.noise_radps);
  }
  return out;
}

double GroupRates::lag_error_radps(const TriadRates& rates, double time_s, const GyroErrors& worst) noexcept {
  const double step_s = time_s - last_s_, period_s = group_.setup.sample_period_s;
  TriadRates change;
  change.triads = rates.triads;
  for (std::size_t t = 0; t < triad_.size(); ++t) {
    change.given[t] = rates.given[t] && last_.given[t];
    change.rate_radps[t] = minus(rates.rate_radps[t], last_.rate_radps[t]);
  }
  last_ = rates;
  last_s_ = time_s;
  if (!(lag_s_ > 0.0)) return 0.0;
  const Together changed = together(change);
  double slope_radps2 = std::numeric_limits<double>::infinity();
  if (changed.given && step_s > 0.5 * period_s && step_s < 1.5 * period_s) {
    const GyroErrors of_two = {worst.scale, 0.0, 0.0, 2.0 * worst.noise_radps, 0.0};
    const double length_radps = norm(changed.rate_radps);
    slope_radps2 =
        (length_radps + changed.spread_radps + median_error_radps(of_two, length_radps, kNoiseSigmas)) / step_s;
  }
  const double before_radps2 = std::exchange(last_slope_radps2_, slope_radps2);
  return lag_s_ * (slope_radps2 > before_radps2 ? 2.0 * slope_radps2 - before_radps2 : before_radps2);
}

ToolRate GroupRates::step(const RateSample& sample, SensorSet excluded) noexcept {
  const TriadRates rates = rates_of(sample, excluded);
  ToolRate out;
  out.triads = static_cast<int>(std::count(rates.given.begin(), rates.given.end(), true));
  const GyroErrors worst = worst_errors(sample);
  const double lag_radps = lag_error_radps(rates, sample.time_s, worst);
  const Together found = together(rates);
  if (!found.given) return out;
  out.rate_radps = found.rate_radps;
  const double length_radps = norm(out.rate_radps);
  out.bound_radps = with_common_part(group_, length_radps,
                                     median_error_radps(worst, length_radps + found.spread_radps, kNoiseSigmas)) +
                    found.spread_radps + lag_radps;
  out.given = std::isfinite(length_radps) && std::isfinite(out.bound_radps);
  out.begins = !std::isfinite(lag_radps);
  return out;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
