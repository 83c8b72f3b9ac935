// The stations that an estimate from many of them may use: those that pass their checks once it is taken off.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "plumb/survey/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// `number`: of each of `stations` in the survey.
struct SoundStations {
  std::vector<ReferencedStation> stations;
  std::vector<std::size_t> number, left_out;
};

/// Difference over limit of the worst check; 1 passes. Infinite where it is no number.
inline double worst_check(const StationChecks& checks) noexcept {
  double out = 0.0;
  for (const Check* check : {&checks.gravity, &checks.field, &checks.dip}) {
    const double part = std::fabs(check->difference()) / check->limit;
    out = std::fmax(out, check->passed ? std::fmin(part, 1.0) : std::isfinite(part) ? std::fmax(part, 1.0) : HUGE_VAL);
  }
  return out;
}

/// Those that `fails` says nothing against.
template <class Fails>
SoundStations without_failed(SoundStations from, const Fails& fails) {
  SoundStations out;
  out.left_out = std::move(from.left_out);
  for (std::size_t k = 0; k < from.stations.size(); ++k) {
    if (fails(from.stations[k])) {
      out.left_out.push_back(from.number[k]);
    } else {
      out.stations.push_back(from.stations[k]);
      out.number.push_back(from.number[k]);
    }
  }
  return out;
}

/// What is estimated explains what fails in the readings, so the checks are those of the corrected stations; but of
/// gravity, which no estimate explains, those of the readings. `estimate` of stations may be refused: then those that
/// are left are returned. `judge` of a station and an estimate.
///
/// Where half of the stations pass as they were read, the estimate begins with those, and takes up whatever passes by
/// it. Else it begins with all, and the worst are left out first, as they bend the estimate that judges the others.
/// Where more than half would go, which are the good ones is not known: none goes, and the misfit tells.
template <class Estimate, class Judge>
SoundStations sound_stations(const std::vector<ReferencedStation>& all, const StationSettings& settings,
                             const Estimate& estimate, const Judge& judge) {
  constexpr int kMostRounds = 30;
  SoundStations base;
  base.stations = all;
  for (std::size_t k = 0; k < all.size(); ++k) base.number.push_back(k);
  const auto as_read = [&](const ReferencedStation& s) { return judge_station(s.measured, s.reference, settings); };
  base = without_failed(std::move(base), [&](const ReferencedStation& s) {
    return as_read(s).status == StationStatus::rejected || !std::isfinite(norm(s.measured.field_tesla));
  });
  SoundStations out =
      without_failed(base, [&](const ReferencedStation& s) { return worst_check(as_read(s).checks) > 1.0; });
  const bool from_the_good = 2 * out.stations.size() >= base.stations.size();
  if (!from_the_good) out = base;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto found = estimate(out.stations);
    if (!found) break;
    const auto failure = [&](const ReferencedStation& s) { return worst_check(judge(s, *found).checks); };
    double worst = 0.0;
    if (!from_the_good) {
      for (const ReferencedStation& s : out.stations) worst = std::fmax(worst, failure(s));
    }
    SoundStations next = without_failed(from_the_good ? base : out, [&](const ReferencedStation& s) {
      const double one = failure(s);
      return one > 1.0 && one >= 0.5 * worst;
    });
    if (2 * next.stations.size() < base.stations.size()) return base;
    if (next.number == out.number) break;
    out = std::move(next);
  }
  std::sort(out.left_out.begin(), out.left_out.end());
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
