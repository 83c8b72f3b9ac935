#include "plumb/scenario/instability.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/scenario/portable_math.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// Correlation of a Gauss-Markov process over a time.
double correlation(double time_s, double constant_s) noexcept {
  return portable_exp(-std::min(time_s / constant_s, 700.0));
}

int levels_for(std::uint64_t ticks) noexcept {
  int levels = 0;
  while (levels < 62 && (std::uint64_t{1} << static_cast<unsigned>(levels)) < ticks) ++levels;
  return levels;
}

}  // namespace

Instability::Instability(const InstabilityLaw& law, std::uint64_t ticks, double period_s, std::uint64_t seed,
                         int sensor)
    : wander_{Stream(seed, Purpose::instability, static_cast<std::uint32_t>(sensor)), 0.0, 0.0, {}},
      walk_{Stream(seed, Purpose::walk, static_cast<std::uint32_t>(sensor)), 0.0, 0.0, {}} {
  const int levels = levels_for(ticks);
  const std::uint64_t end = std::uint64_t{1} << static_cast<unsigned>(levels);
  const double whole_s = static_cast<double>(end) * period_s;
  if (law.sigma_mps2 > 0.0) {
    const double far = correlation(whole_s, law.correlation_s);
    wander_.first = law.sigma_mps2 * wander_.stream.normal(0);
    wander_.last =
        far * wander_.first + std::sqrt(std::max(0.0, 1.0 - far * far)) * law.sigma_mps2 * wander_.stream.normal(end);
  }
  if (law.walk_mps2 > 0.0) walk_.last = law.walk_mps2 * std::sqrt(whole_s) * walk_.stream.normal(end);
  double half_s = whole_s;
  for (int k = 0; k < levels; ++k) {
    half_s *= 0.5;
    if (law.sigma_mps2 > 0.0) {
      const double near = correlation(half_s, law.correlation_s);
      const double square = near * near;
      wander_.halvings.push_back(
          {near / (1.0 + square), law.sigma_mps2 * std::sqrt(std::max(0.0, (1.0 - square) / (1.0 + square)))});
    }
    if (law.walk_mps2 > 0.0) walk_.halvings.push_back({0.5, law.walk_mps2 * std::sqrt(0.5 * half_s)});
  }
}

double Instability::value(const Process& process, std::uint64_t tick) noexcept {
  std::uint64_t left = 0;
  std::uint64_t right = std::uint64_t{1} << static_cast<unsigned>(process.halvings.size());
  double left_value = process.first;
  double right_value = process.last;
  if (tick == 0) return left_value;
  if (tick >= right) return right_value;
  for (const Halving& halving : process.halvings) {
    const std::uint64_t middle = left + (right - left) / 2;
    const double value = halving.weight * (left_value + right_value) + halving.sigma * process.stream.normal(middle);
    if (tick == middle) return value;
    if (tick < middle) {
      right = middle;
      right_value = value;
    } else {
      left = middle;
      left_value = value;
    }
  }
  return left_value;
}

double Instability::at(std::uint64_t tick) const noexcept { return value(wander_, tick) + value(walk_, tick); }

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
