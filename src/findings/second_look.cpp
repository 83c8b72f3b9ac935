#include "plumb/findings/second_look.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "plumb/calibration/acceptance.hpp"
#include "plumb/io/log_reader.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// Exchanges whose chi^2 is within this factor of the best one's explain the log as well.
constexpr double kAsWell = 2.0;
/// A fit that will settle does so well before.
constexpr int kTrialIterations = 40;
/// Stations times the square of the parameters, over all trials: some ten seconds. Of 24 sensors at 96 stations all are
/// tried at one temperature, and 180 of 300 with cubics.
constexpr double kMostWork = 1e9;

/// Of one trial.
double work_of(const io::ArrayFile& array, const std::vector<Station>& stations, const TemperatureOptions& options) {
  const TemperatureLevels levels = temperature_levels(stations.data(), static_cast<int>(stations.size()));
  const int supported = std::max(std::min(levels.count - 1, options.max_order), 0);
  const int order = options.order == kAutomaticOrder ? supported : options.order;
  const double parameters = (4.0 + 2.0 * order) * array.array.size();
  return static_cast<double>(stations.size()) * parameters * parameters;
}

/// With itself: the sign of what it measures, about its nominal bias.
void exchange(Station& station, int i, int j, const Datasheet& datasheet) {
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
  if (i == j) {
    const SensorCoefficients& c = datasheet.sensor[a].coefficients;
    station.mean[a] = 2.0 * c.scale[0] * c.bias[0] - station.mean[a];
    return;
  }
  std::swap(station.mean[a], station.mean[b]);
  std::swap(station.scatter[a], station.scatter[b]);
  const bool has_i = station.delivered.has(i), has_j = station.delivered.has(j);
  station.delivered = station.delivered.without(i).without(j);
  if (has_j) station.delivered = station.delivered.with(i);
  if (has_i) station.delivered = station.delivered.with(j);
}

struct Pair {
  double rank;  ///< the least first
  int i, j;
};
bool by_rank(const Pair& a, const Pair& b) { return a.rank < b.rank; }

class Trials {
 public:
  Trials(const io::ArrayFile& array, const std::vector<Station>& stations, const TemperatureOptions& options)
      : array_(array),
        stations_(stations),
        trial_(stations),
        scratch_(stations.size()),
        options_(options),
        cost_(work_of(array, stations, options)) {
    options_.fit.max_iterations = std::min(options_.fit.max_iterations, kTrialIterations);
  }

  /// chi^2 per degree of freedom of an accepted fit to the stations, each put through `change`. Nothing once the work
  /// is done that a report may wait for.
  template <class Change>
  std::optional<double> fits(const TemperatureOptions& options, Change change) {
    if (work_left_ < cost_) return {};
    work_left_ -= cost_;
    trial_ = stations_;
    for (Station& station : trial_) change(station);
    const Expected<Calibration> fit =
        calibrate_over_temperature(array_.datasheet, array_.gravity, trial_.data(), static_cast<int>(trial_.size()),
                                   options, scratch_.data(), *work_);
    if (!fit || judge(array_.datasheet, array_.gravity, *fit, {}, {}).error.code != Errc::ok) return {};
    return fit->report.chi2 / std::max(fit->report.degrees_of_freedom, 1);
  }

  /// `refused`: the axes that the fit came to, where there are any.
  void exchanges(const SensorArray* refused, SecondLook& out) {
    std::vector<Pair> tried, found;
    for (int i = 0; i < array_.array.size(); ++i) {
      for (int j = i; j < array_.array.size(); ++j)
        tried.push_back({refused == nullptr ? 0.0 : strangeness(*refused, i, j), i, j});
    }
    // The work may not suffice for all.
    std::stable_sort(tried.begin(), tried.end(), by_rank);
    for (const auto& [ignored, i, j] : tried) {
      const auto put_right = [this, first = i, second = j](Station& s) {
        exchange(s, first, second, array_.datasheet);
      };
      if (const std::optional<double> chi2 = fits(options_, put_right)) found.push_back({*chi2, i, j});
    }
    std::stable_sort(found.begin(), found.end(), by_rank);
    for (const Pair& pair : found) {
      if (pair.rank <= kAsWell * found.front().rank) out.exchanged.emplace_back(pair.i, pair.j);
    }
  }

  /// Turns before mirror images, which no mounting makes.
  void triads(SecondLook& out) {
    const std::vector<std::array<int, 3>> all = triads_of(array_.array, array_.package);
    if (all.size() < 2) return;  // one alone may be turned as it likes
    std::vector<std::pair<double, TurnedTriad>> found;
    for (const bool turns : {true, false}) {
      for (const std::array<int, 3>& triad : all) {
        for (const TurnedTriad& one : turns_of(triad)) {
          if (is_turn(one) != turns) continue;
          const auto mend = [this, &one](Station& s) { put_right(one, array_.datasheet, s); };
          if (const std::optional<double> chi2 = fits(options_, mend)) found.emplace_back(*chi2, one);
        }
      }
      if (!found.empty()) break;
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [chi2, one] : found) {
      if (chi2 <= kAsWell * found.front().first) out.turned.push_back(one);
    }
  }

  void rolls(SecondLook& out) {
    std::vector<std::uint32_t> tags;
    for (const Station& s : stations_) {
      if (s.roll_group != 0 && std::find(tags.begin(), tags.end(), s.roll_group) == tags.end())
        tags.push_back(s.roll_group);
    }
    if (tags.empty() || tags.size() > static_cast<std::size_t>(kMaxRollGroups)) return;
    if (!fits(options_, [](Station& s) { s.roll_group = 0; })) return;  // the groups are not what is wrong
    std::optional<double> best;
    for (const Vec3& axis : {Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 1.0, 0.0}, Vec3{0.0, 0.0, 1.0}}) {
      TemperatureOptions about = options_;
      about.fit.roll_axis = axis;
      const std::optional<double> chi2 = fits(about, [](Station&) {});
      if (!chi2 || (best && *chi2 >= *best)) continue;
      best = chi2;
      out.roll_axis = axis;
    }
    if (out.roll_axis) return;
    for (const std::uint32_t tag : tags) {
      const auto leave_out = [tag](Station& s) { s.roll_group = s.roll_group == tag ? 0 : s.roll_group; };
      if (tags.size() > 1 && fits(options_, leave_out)) out.groups.push_back(io::label_of_tag(tag));
    }
    out.without_groups = out.groups.empty();
  }

 private:
  /// How far the axes of two sensors came out from each other's nominal ones; of one, from its own reversed.
  double strangeness(const SensorArray& refused, int i, int j) const {
    const double sign = i == j ? -1.0 : 1.0;
    return std::fmax(angle_between_rad(refused.axis(i), scaled(array_.array.axis(j), sign)),
                     angle_between_rad(refused.axis(j), scaled(array_.array.axis(i), sign)));
  }

  const io::ArrayFile& array_;
  const std::vector<Station>& stations_;
  std::vector<Station> trial_, scratch_;
  TemperatureOptions options_;
  double cost_, work_left_ = kMostWork;
  std::unique_ptr<TemperatureWork> work_ = std::make_unique<TemperatureWork>();
};

}  // namespace

SecondLook second_look(const io::ArrayFile& array, const std::vector<Station>& stations,
                       const TemperatureOptions& options, const SensorArray* refused) {
  SecondLook out;
  Trials trials(array, stations, options);
  trials.rolls(out);
  if (!out.found()) trials.exchanges(refused, out);
  if (!out.found()) trials.triads(out);
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
