#include "second_look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "fit_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// Exchanges whose chi^2 is within this factor of the best one's explain the log as well.
constexpr double kAsWell = 2.0;
constexpr std::size_t kNamedMistakes = 3;

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

class Trials {
 public:
  Trials(const io::ArrayFile& array, const std::vector<Station>& stations, const TemperatureOptions& options)
      : array_(array), stations_(stations), trial_(stations), scratch_(stations.size()), options_(options) {}

  /// chi^2 per degree of freedom of an accepted fit to the stations, each put through `change`.
  template <class Change>
  std::optional<double> fits(const TemperatureOptions& options, Change change) {
    trial_ = stations_;
    for (Station& station : trial_) change(station);
    const Expected<Calibration> fit =
        calibrate_over_temperature(array_.datasheet, array_.gravity, trial_.data(), static_cast<int>(trial_.size()),
                                   options, scratch_.data(), *work_);
    if (!fit) return {};
    return fit->report.chi2 / std::max(fit->report.degrees_of_freedom, 1);
  }

  void exchanges(SecondLook& out) {
    struct Pair {
      double chi2;
      int i, j;
    };
    std::vector<Pair> found;
    for (int i = 0; i < array_.array.size(); ++i) {
      for (int j = i; j < array_.array.size(); ++j) {
        const std::optional<double> chi2 =
            fits(options_, [this, i, j](Station& s) { exchange(s, i, j, array_.datasheet); });
        if (chi2) found.push_back({*chi2, i, j});
      }
    }
    std::stable_sort(found.begin(), found.end(), [](const Pair& a, const Pair& b) { return a.chi2 < b.chi2; });
    for (const Pair& pair : found) {
      if (pair.chi2 <= kAsWell * found.front().chi2) out.exchanged.emplace_back(pair.i, pair.j);
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
  const io::ArrayFile& array_;
  const std::vector<Station>& stations_;
  std::vector<Station> trial_, scratch_;
  const TemperatureOptions& options_;
  std::unique_ptr<TemperatureWork> work_ = std::make_unique<TemperatureWork>();
};

std::string axis_words(const Vec3& axis) { return fmt::format("{:g},{:g},{:g}", axis[0], axis[1], axis[2]); }

std::string either(const std::vector<std::string>& names) {
  std::string out = names.front();
  for (std::size_t k = 1; k < names.size(); ++k) out += (k + 1 == names.size() ? " or " : ", ") + names[k];
  return out;
}

std::string group_words(const SecondLook& look) {
  std::vector<std::string> names;
  for (const std::int64_t group : look.groups) names.push_back(std::to_string(group));
  return either(names);
}

}  // namespace

SecondLook second_look(const io::ArrayFile& array, const std::vector<Station>& stations,
                       const TemperatureOptions& options) {
  SecondLook out;
  Trials trials(array, stations, options);
  trials.rolls(out);
  if (!out.found()) trials.exchanges(out);
  return out;
}

std::string second_look_words(const SecondLook& look, const io::ArrayFile& array) {
  if (look.roll_axis) return "; rolled about " + axis_words(*look.roll_axis) + " all would be well";
  if (!look.groups.empty()) return "; without roll group " + group_words(look) + " all would be well";
  if (look.without_groups) return "; without the roll groups all would be well";
  std::vector<std::string> mistakes;
  for (const auto& [i, j] : look.exchanged) {
    if (mistakes.size() == kNamedMistakes) break;
    mistakes.push_back(i == j ? fmt::format("the sign of {} reversed", id_of(array, i))
                              : fmt::format("the columns of {} and {} exchanged", id_of(array, i), id_of(array, j)));
  }
  return mistakes.empty() ? "" : "; with " + either(mistakes) + " all would be well";
}

std::string second_look_remedy(const SecondLook& look, const io::ArrayFile& array) {
  if (look.roll_axis) {
    return "give --roll-axis " + axis_words(*look.roll_axis) +
           ", or correct the third row of [output] frame, from which inclination is counted";
  }
  if (!look.groups.empty()) {
    return "look at the column `" + array.input.roll_group_column + "`: stations numbered " + group_words(look) +
           " do not share an inclination";
  }
  if (look.without_groups) {
    return "check that the stations of a group do share an inclination, and --roll-axis; an axis that is not held "
           "exactly needs --roll-wobble-deg";
  }
  if (look.exchanged.empty()) return "";
  const auto [i, j] = look.exchanged.front();
  const std::string first =
      i == j ? fmt::format("check the sign of {}: its `scale`, its `axis` and its wiring", id_of(array, i))
             : fmt::format("check `column` of {} and {} in the array file, and their wiring", id_of(array, i),
                           id_of(array, j));
  return first + "; two mistakes at once can look like another one";
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
