#include "plumb/detection/one_attitude.hpp"

#include <cmath>
#include <limits>

#include "largest_eigenvalue.hpp"
#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

using detection_detail::largest_eigenvalue;

/// c(T) e: how far errors of its readings can move a triple's vector.
double moved_by(const Mat3& map, const Vec3& errors) noexcept {
  double worst = 0.0;
  for (const double b : {errors[1], -errors[1]}) {
    for (const double c : {errors[2], -errors[2]}) worst = std::fmax(worst, norm(times(map, {errors[0], b, c})));
  }
  return worst;
}

/// d: what the length of a triple's vector may be off by where no sensor is faulty, plus what it is allowed to be.
double allowance(const SensorArray& array, const ErrorBudget& budget, int triple) noexcept {
  const Triple& t = array.triple(triple);
  Vec3 errors{};
  double systematic = 0.0;
  for (std::size_t m = 0; m < 3; ++m) {
    const std::size_t i = t.sensors[m];
    errors[m] = budget.noise_factor * budget.noise_mps2[i] + budget.systematic_mps2[i];
    systematic += norm(triple_weight(array, triple, static_cast<int>(m))) * budget.systematic_mps2[i];
  }
  const double root_n = array.sigma_mps2(t.sensors[0]) / budget.noise_mps2[t.sensors[0]];
  const double noise = std::sqrt(largest_eigenvalue(least_squares(array, t.set()).covariance)) / root_n;
  const double limit = budget.limits.reject[1] * noise + systematic + budget.gravity_mps2;
  return limit + budget.gravity_mps2 + moved_by(triple_map(array, triple), errors);
}

}  // namespace

OneAttitude::OneAttitude(const SensorArray& array, const GravityReference& gravity, const ErrorBudget& budget) noexcept
    : g_mps2_(gravity.g_mps2) {
  for (int k = 0; k < array.triple_count(); ++k) {
    if (!array.triple(k).votes) continue;
    const double d = allowance(array, budget, k);
    for (int m = 0; m < 3; ++m) {
      Entry& entry = entries_[numbers::at(triples_)][numbers::at(m)];
      entry.weight = triple_weight(array, k, m);
      entry.reach = (2.0 * g_mps2_ * d + d * d) / dot(entry.weight, entry.weight);
    }
    sensors_[numbers::at(triples_)] = array.triple(k).sensors;
    ++triples_;
  }
}

template <class F>
void OneAttitude::for_each(F&& f) const noexcept {
  for (int t = 0; t < triples_; ++t) {
    for (std::size_t m = 0; m < 3; ++m) f(int{sensors_[numbers::at(t)][m]}, entries_[numbers::at(t)][m]);
  }
}

double OneAttitude::blind_half_width_mps2(int i) const noexcept {
  double worst = 0.0;
  for_each([&](int sensor, const Entry& e) {
    if (sensor == i) worst = std::fmax(worst, std::sqrt(e.reach));
  });
  return worst > 0.0 ? worst : std::numeric_limits<double>::infinity();
}

double OneAttitude::any_attitude_mps2(int i) const noexcept {
  double worst = 0.0;
  for_each([&](int sensor, const Entry& e) {
    // The larger root of f (f - 2 G / |w|) = reach.
    const double half = g_mps2_ / norm(e.weight);
    if (sensor == i) worst = std::fmax(worst, half + std::sqrt(half * half + e.reach));
  });
  return worst > 0.0 ? worst : std::numeric_limits<double>::infinity();
}

double OneAttitude::mirror_of(const Entry& entry, const Vec3& down) const noexcept {
  return -2.0 * g_mps2_ * dot(down, entry.weight) / dot(entry.weight, entry.weight);
}

/// The errors that pass at one attitude are one or two closed intervals, so that those that pass at all of them end at
/// an end of one of these.
double OneAttitude::passes_all(const Entry& entry, const Vec3* down, int count) const noexcept {
  constexpr double kRounding = 1e-9;
  const auto passes = [&](double f) {
    for (int k = 0; k < count; ++k) {
      if (std::fabs(f) * std::fabs(f - mirror_of(entry, down[k])) > entry.reach * (1.0 + kRounding)) return false;
    }
    return true;
  };
  double largest = 0.0;
  for (int k = 0; k < count; ++k) {
    const double half = 0.5 * mirror_of(entry, down[k]);
    for (const double square : {half * half + entry.reach, half * half - entry.reach}) {
      if (square < 0.0) continue;
      for (const double end : {half - std::sqrt(square), half + std::sqrt(square)})
        if (std::fabs(end) > largest && passes(end)) largest = std::fabs(end);
    }
  }
  return largest;
}

double OneAttitude::clear_over_mps2(const Vec3* down, int count, int i) const noexcept {
  double worst = 0.0;
  bool any = false;
  for_each([&](int sensor, const Entry& e) {
    if (sensor != i) return;
    any = true;
    worst = std::fmax(worst, passes_all(e, down, count));
  });
  return any && count > 0 ? worst : std::numeric_limits<double>::infinity();
}

bool OneAttitude::isolates(const Vec3& down, int i, double f_mps2) const noexcept {
  bool all_fail = true, any = false;
  for_each([&](int sensor, const Entry& e) {
    if (sensor != i) return;
    any = true;
    if (!(std::fabs(f_mps2) * std::fabs(f_mps2 - mirror_of(e, down)) > e.reach)) all_fail = false;
  });
  return any && all_fail;
}

AttitudeFigures OneAttitude::at(const Vec3& down) const noexcept {
  AttitudeFigures out;
  out.nearest_mirror_mps2 = std::numeric_limits<double>::infinity();
  for_each([&](int sensor, const Entry& e) {
    const double mirror = std::fabs(mirror_of(e, down));
    const double square = mirror * mirror;
    out.clear_from_mps2 = std::fmax(out.clear_from_mps2, 0.5 * (mirror + std::sqrt(square + 4.0 * e.reach)));
    out.nearest_mirror_mps2 = std::fmin(out.nearest_mirror_mps2, mirror);
    if (square <= 4.0 * e.reach) out.blind = out.blind.with(sensor);
  });
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
