/// At which temperatures the stations are, and at which they are not.
#include <cmath>

#include "plumb/calibration/temperature_fit.hpp"
#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

constexpr double kStep_degc = 5.0;
constexpr int kMostSteps = 400;

/// The lowest temperature at or above `from`; false where there is none.
bool next_above(const Station* stations, int count, double from, double& found) noexcept {
  bool any = false;
  for (int k = 0; k < count; ++k) {
    const double t = stations[k].temperature_degc;
    if (stations[k].count == 0 || !std::isfinite(t) || !(t >= from)) continue;
    if (!any || t < found) found = t;
    any = true;
  }
  return any;
}

}  // namespace

TemperatureLevels temperature_levels(const Station* stations, int count) noexcept {
  TemperatureLevels out;
  if (stations == nullptr) return out;
  double begin = 0.0;
  bool more = next_above(stations, count, -HUGE_VAL, begin);
  out.lowest_degc = begin;
  while (more && out.count < kMaxTemperatureLevels) {
    double sum = 0.0;
    int members = 0;
    for (int k = 0; k < count; ++k) {
      const double t = stations[k].temperature_degc;
      if (stations[k].count == 0 || !(t >= begin) || !(t < begin + kLevelsApart_degc)) continue;
      sum += t;
      ++members;
    }
    if (members == 0) break;  // so large that a level has no width: no temperature of a sensor, and refused as such
    out.degc[static_cast<std::size_t>(out.count)] = sum / members;
    out.begin_degc[static_cast<std::size_t>(out.count)] = begin;
    out.stations[static_cast<std::size_t>(out.count)] = members;
    ++out.count;
    more = next_above(stations, count, begin + kLevelsApart_degc, begin);
  }
  out.highest_degc = out.lowest_degc;
  for (int k = 0; k < count; ++k) {
    const double t = stations[k].temperature_degc;
    if (stations[k].count > 0 && std::isfinite(t)) out.highest_degc = std::fmax(out.highest_degc, t);
  }
  return out;
}

namespace {

/// Temperatures of the stations of those levels that `counts(level)`.
template <class Counts>
ChebyshevSpan span_of_levels(const Station* stations, int count, const TemperatureLevels& levels,
                             Counts&& counts) noexcept {
  ChebyshevSpan out = {levels.highest_degc, levels.lowest_degc};
  for (int k = 0; k < count; ++k) {
    const double t = stations[k].temperature_degc;
    if (stations[k].count == 0 || !std::isfinite(t)) continue;
    int nearest = 0;
    for (int level = 1; level < levels.count; ++level) {
      if (std::fabs(t - levels.degc[static_cast<std::size_t>(level)]) <
          std::fabs(t - levels.degc[static_cast<std::size_t>(nearest)])) {
        nearest = level;
      }
    }
    if (!counts(nearest)) continue;
    out.lowest = std::fmin(out.lowest, t);
    out.highest = std::fmax(out.highest, t);
  }
  return out.lowest <= out.highest ? out : ChebyshevSpan{levels.lowest_degc, levels.highest_degc};
}

}  // namespace

ChebyshevSpan confirmed_span(const Station* stations, int count, const TemperatureLevels& levels) noexcept {
  constexpr int kNotAlone = 2;  // one station, or one slip of the thermometer, is no level
  return span_of_levels(stations, count, levels,
                        [&levels](int level) { return levels.stations[static_cast<std::size_t>(level)] >= kNotAlone; });
}

ChebyshevSpan fullest_level(const Station* stations, int count, const TemperatureLevels& levels) noexcept {
  int fullest = 0;
  for (int level = 1; level < levels.count; ++level) {
    if (levels.stations[static_cast<std::size_t>(level)] > levels.stations[static_cast<std::size_t>(fullest)])
      fullest = level;
  }
  return span_of_levels(stations, count, levels, [fullest](int level) { return level == fullest; });
}

bool one_way(const Station* stations, int count) noexcept {
  double lowest = 0.0, highest = 0.0, fell = 0.0, rose = 0.0;
  bool any = false;
  for (int k = 0; k < count && stations != nullptr; ++k) {
    const double t = stations[k].temperature_degc;
    if (stations[k].count == 0 || !std::isfinite(t)) continue;
    if (!any) lowest = highest = t;
    any = true;
    lowest = std::fmin(lowest, t);
    highest = std::fmax(highest, t);
    fell = std::fmax(fell, highest - t);
    rose = std::fmax(rose, t - lowest);
  }
  return highest - lowest >= kLevelsApart_degc && (fell < kLevelsApart_degc || rose < kLevelsApart_degc);
}

int missing_levels(const TemperatureLevels& levels, const ChebyshevSpan& use_degc, int wanted,
                   std::array<double, kMaxTemperatureOrder + 1>& degc) noexcept {
  int found = 0;
  while (levels.count + found < wanted && found < static_cast<int>(degc.size())) {
    double best = use_degc.highest, farthest = -1.0;
    for (int step = 0; step <= kMostSteps; ++step) {
      // The ends of the span first, then the multiples between.
      double t = step == 0 ? use_degc.highest : use_degc.lowest;
      if (step > 1) t = kStep_degc * (std::ceil(use_degc.lowest / kStep_degc) + step - 2);
      if (t > use_degc.highest) break;
      double nearest = HUGE_VAL;
      for (int k = 0; k < levels.count; ++k) nearest = std::fmin(nearest, std::fabs(t - levels.degc[at(k)]));
      for (int k = 0; k < found; ++k) nearest = std::fmin(nearest, std::fabs(t - degc[at(k)]));
      if (nearest > farthest) {
        farthest = nearest;
        best = t;
      }
    }
    degc[static_cast<std::size_t>(found++)] = best;
  }
  for (int k = 1; k < found; ++k) {
    for (int l = k; l > 0 && degc[at(l)] < degc[at(l - 1)]; --l) {
      const double kept = degc[at(l)];
      degc[at(l)] = degc[at(l - 1)];
      degc[at(l - 1)] = kept;
    }
  }
  return found;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
