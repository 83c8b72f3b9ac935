#include "fit_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures.hpp"
#include "plumb/core/units.hpp"
#include "temperature_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// No more than this many values in one phrase.
constexpr std::size_t kNamed = 6;
/// A rotation vector this near to an axis of the tool (cosine) is named by it.
constexpr double kNearAxis = 0.94;

const char* word_of(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::bias: return "bias";
    case ParameterKind::scale: return "scale";
    case ParameterKind::axis: return "axis";
  }
  return "?";
}

std::string about(const Vec3& turn) {
  const char* const names[] = {"x", "y", "z"};
  for (std::size_t p = 0; p < 3; ++p) {
    if (std::fabs(turn[p]) > kNearAxis) return names[p];
  }
  return fmt::format("({:.1f}, {:.1f}, {:.1f})", turn[0], turn[1], turn[2]);
}

/// About which axis of the tool a sensor turns: any one of which the sensor moves as it does.
std::string about(const Vec3& turn, const Vec3& axis) {
  const char* const names[] = {"x", "y", "z"};
  std::size_t best = 3;
  double largest = 0.0;
  for (std::size_t p = 0; p < 3; ++p) {
    // Only the part of the tool axis across the sensor's axis turns it.
    const double across = std::sqrt(std::fmax(0.0, 1.0 - axis[p] * axis[p]));
    if (std::fabs(turn[p]) > kNearAxis * across && across > largest) {
      best = p;
      largest = across;
    }
  }
  return best < 3 ? names[best] : about(turn);
}

/// One kind of value of the sensors named: "scale of a1 and a2", "scale of all sensors".
struct Group {
  ParameterKind kind;
  std::string about;
  bool negative;
  std::vector<std::string> ids;
};

std::string group_words(const Group& group, int n) {
  std::string who;
  if (static_cast<int>(group.ids.size()) == n && n > 1) {
    who = "all sensors";
  } else if (group.ids.size() > kNamed) {
    who = listed({group.ids.begin(), group.ids.begin() + kNamed}) +
          fmt::format(" and {} more", group.ids.size() - kNamed);
  } else {
    who = listed(group.ids);
  }
  return fmt::format("{} of {}{}", word_of(group.kind), who, group.about.empty() ? "" : " about " + group.about);
}

std::vector<Group> groups_of(const NullCombination& c, const io::ArrayFile& array) {
  std::vector<Group> out;
  std::vector<NullTerm> terms(c.term.begin(), c.term.begin() + c.terms);
  std::stable_sort(terms.begin(), terms.end(),
                   [](const NullTerm& a, const NullTerm& b) { return a.sensor < b.sensor; });
  for (const NullTerm& term : terms) {
    const bool axis = term.kind == ParameterKind::axis;
    if (axis && c.rotates_all) continue;
    Group own{term.kind, axis ? about(term.turn, array.array.axis(term.sensor)) : "", !axis && term.amount < 0.0, {}};
    const auto same = std::find_if(out.begin(), out.end(), [&own](const Group& g) {
      return g.kind == own.kind && g.about == own.about && g.negative == own.negative;
    });
    Group& group = same == out.end() ? out.emplace_back(own) : *same;
    group.ids.push_back(id_of(array, term.sensor));
  }
  // The order in which one reads: bias, scale, axis.
  std::stable_sort(out.begin(), out.end(), [](const Group& a, const Group& b) { return a.kind < b.kind; });
  return out;
}

std::string range_words(double part) { return fmt::format("{:+.1f} g0", part); }

/// How much of its range a sensor must have seen to tell scale from bias.
constexpr double kEnoughRange = 0.5;
constexpr int kEnoughInclinations = 3;
/// A sensor that delivered at fewer than this part of the stations is named.
constexpr double kDelivers = 0.5;
constexpr double kAbsurd_mps2 = 1e4;
constexpr int kEnoughAttitudes = 12;
constexpr double kEnoughSpan_deg = 60.0;

}  // namespace

std::string id_of(const io::ArrayFile& array, int i) { return array.array.row(i).id.data(); }

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) out += k + 1 == names.size() ? " and " : ", ";
    out += names[k];
  }
  return out;
}

std::string null_words(const NullCombination& combination, const io::ArrayFile& array) {
  std::vector<std::string> parts;
  if (combination.rotates_all) parts.push_back("common rotation about " + about(combination.rotation));
  std::size_t left_out = 0;
  for (const Group& group : groups_of(combination, array)) {
    if (parts.size() < kNamed) {
      parts.push_back(group_words(group, array.array.size()));
    } else {
      ++left_out;
    }
  }
  std::string out = parts.front();
  if (parts.size() > 1) out += " against " + listed({parts.begin() + 1, parts.end()});
  return out + (left_out > 0 ? fmt::format(" and {} more", left_out) : "");
}

std::vector<std::string> unobservable(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  for (int k = 0; k < run.study.null_count; ++k)
    out.push_back(null_words((*run.study.nulls)[static_cast<std::size_t>(k)], array));
  if (run.told().null_directions > run.study.null_count)
    out.push_back(fmt::format("and {} more", run.told().null_directions - run.study.null_count));
  const std::vector<std::string> over_temperature = temperature_unobservable(run, array);
  out.insert(out.end(), over_temperature.begin(), over_temperature.end());
  return out;
}

std::string attitude_words(const PlannedAttitude& attitude) {
  const double inclination_deg = deg_from_rad(attitude.inclination_rad);
  std::string out = fmt::format("inclination {:.0f} deg", inclination_deg);
  // Toolface means nothing where the tool hangs or stands upright.
  if (std::fabs(std::sin(attitude.inclination_rad)) > 1e-6)
    out += fmt::format(", toolface {:.0f} deg", deg_from_rad(attitude.toolface_rad));
  const Vec3& d = attitude.direction;
  // + 0.0: no minus sign before a zero.
  const auto rounded = [](double v) { return std::round(10.0 * v) / 10.0 + 0.0; };
  return out + fmt::format(" (down along {:.1f}, {:.1f}, {:.1f})", rounded(d[0]), rounded(d[1]), rounded(d[2]));
}

std::string p_value_words(const FitReport& report) {
  if (report.degrees_of_freedom < 1) return "no station is left over to test the fit with";
  const double factor = std::sqrt(report.chi2 / report.degrees_of_freedom);
  if (report.p_value < 1e-3) {
    return fmt::format(
        "the residuals are {:.1f} times what the declared noise alone leaves, so something else moves the readings "
        "(temperature, hands, nonlinearity) or the noise is declared too small; the excess is carried into all limits",
        factor);
  }
  if (report.p_value > 1.0 - 1e-3) {
    return fmt::format(
        "the residuals are only {:.2g} of what the declared noise leaves: it is declared too large, or more samples "
        "stand "
        "behind a row than `count` says; limits will be wider than they need be",
        factor);
  }
  return fmt::format(
      "residuals like these arise by the declared noise alone in {:.0f} of 100 recordings: nothing to "
      "explain",
      std::fmax(1.0, 100.0 * report.p_value));
}

std::vector<std::string> coverage_words(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  const Coverage& c = run.study.coverage;
  if (c.attitudes < kEnoughAttitudes) {
    out.push_back(fmt::format("{} attitude{}; 9 is the least, 12 or more leave something to test the fit with",
                              c.attitudes, c.attitudes == 1 ? "" : "s"));
  }
  if (c.attitudes == 0) return out;
  const std::vector<std::string> absent = absent_words(run, array);
  out.insert(out.end(), absent.begin(), absent.end());
  const double least_deg = deg_from_rad(c.inclination_min_rad), most_deg = deg_from_rad(c.inclination_max_rad);
  if (c.inclinations < kEnoughInclinations) {
    const int missing = kEnoughInclinations - c.inclinations;
    out.push_back(fmt::format("{} inclination{}; at least three are needed: add {} {} {:.0f} deg", c.inclinations,
                              c.inclinations == 1 ? "" : "s", missing == 1 ? "one" : "two",
                              most_deg < 90.0 ? "above" : "below",
                              most_deg < 90.0 ? most_deg + 15.0 : least_deg - 15.0));
  } else if (most_deg - least_deg < kEnoughSpan_deg) {
    out.push_back(fmt::format(
        "inclinations from {:.0f} to {:.0f} deg only; a span of less than 60 deg tells bias from scale poorly",
        least_deg, most_deg));
  }
  for (int i = 0; i < array.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    if (c.highest[a] < kEnoughRange)
      out.push_back(fmt::format("no station with {} above {} (highest {})", id_of(array, i), range_words(kEnoughRange),
                                range_words(c.highest[a])));
    if (c.lowest[a] > -kEnoughRange)
      out.push_back(fmt::format("no station with {} below {} (lowest {})", id_of(array, i), range_words(-kEnoughRange),
                                range_words(c.lowest[a])));
  }
  return out;
}

std::vector<std::string> absent_words(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  const std::size_t all = run.stations.size();
  for (int i = 0; i < array.array.size(); ++i) {
    const auto with = static_cast<std::size_t>(
        std::count_if(run.stations.begin(), run.stations.end(), [i](const Station& s) { return s.delivered.has(i); }));
    if (static_cast<double>(with) < kDelivers * static_cast<double>(all))
      out.push_back(fmt::format("{} was noisy or absent at {} of {} stations", id_of(array, i), all - with, all));
  }
  return out;
}

std::string common_scale_words(const CalibrationRun& run) {
  if (!run.study.shown) return "";
  const CommonScale& c = run.told().common_scale;
  std::string out = fmt::format(
      "all scale factors moved together by {:+.3f} % ({:.1f} sigma of what `prior` expects), singly by {:.3f} %",
      100.0 * c.mean, std::fabs(c.sigmas()), 100.0 * c.scatter);
  if (std::fabs(c.sigmas()) > AcceptanceLimits{}.told_common_scale_sigmas)
    out += fmt::format(": gravity reference or common scale off by {:.1f} %, or the `unit` is wrong?",
                       100.0 * std::fabs(c.mean));
  return out;
}

std::vector<std::string> outlier_words(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  const FitReport& r = run.told();
  const int listed = std::min(r.outliers, kMaxOutliers);
  for (int k = 0; k < listed; ++k) {
    const Outlier& o = r.outlier[static_cast<std::size_t>(k)];
    const std::string whose =
        o.sensor >= 0 ? fmt::format(", {:.0f} % of it by {}", 100.0 * o.share, id_of(array, o.sensor)) : "";
    out.push_back(fmt::format("station {} ({:.1f} sigma{})", o.station + 1, o.standardised, whose));
  }
  if (r.outliers > listed) out.push_back(fmt::format("{} more", r.outliers - listed));
  return out;
}

double noise_factor(const FitReport& report, const io::ArrayFile& array, int sensor) {
  return report.sample_noise_mps2[static_cast<std::size_t>(sensor)] /
         array.datasheet.sensor[static_cast<std::size_t>(sensor)].row.sigma_mps2;
}

std::string noise_words(const FitReport& report, const io::ArrayFile& array, int sensor) {
  return fmt::format("the samples of {} scatter by {:.3g} mg0, {:.2g} times the {:.3g} mg0 declared",
                     id_of(array, sensor),
                     1e3 * g0_from_mps2(report.sample_noise_mps2[static_cast<std::size_t>(sensor)]),
                     noise_factor(report, array, sensor),
                     1e3 * g0_from_mps2(array.datasheet.sensor[static_cast<std::size_t>(sensor)].row.sigma_mps2));
}

std::string loud_words(const FitReport& report, const io::ArrayFile& array) {
  if (report.loud_sensor < 0) return "";
  return fmt::format(
      "{}: its residuals are {:.1f} times those of the other sensors, {:.3g} mg0 at a station beyond its noise; all "
      "sigmas are widened for it. Look at its channel",
      id_of(array, report.loud_sensor), report.loud_excess, 1e3 * g0_from_mps2(report.loud_misfit_mps2));
}

std::string inclination_words(const FitReport& report) {
  return fmt::format("known to {:.3g} deg (1 sigma) in itself, {}", deg_from_rad(report.inclination_sigma_rad),
                     report.roll_axis == Vec3{} ? "by the nominal axes alone: gravity shows its changes only, unless "
                                                  "`roll_group` says which stations share one"
                                                : "by the stations that share one, about the roll axis as stated");
}

std::string roll_axis_words(const FitReport& report) {
  const CommonTurn& turn = report.common_turn;
  if (!(turn.sigma_rad > 0.0)) return "";
  std::string out = fmt::format(
      "by it all axes are turned together by {:.3g} deg from the nominal ones, which know it to {:.3g} deg: {:.1f} "
      "sigma",
      deg_from_rad(turn.rad), deg_from_rad(turn.sigma_rad), turn.sigmas());
  if (turn.sigmas() > AcceptanceLimits{}.told_common_turn_sigmas) {
    out +=
        ". Is the roll axis the one stated (--roll-axis, [output] frame)? Every inclination is off by as much as it "
        "is not";
  }
  return out;
}

std::string one_of(const SensorSet& suspects, const io::ArrayFile& array) {
  std::vector<std::string> ids;
  for (int i = 0; i < array.array.size(); ++i) {
    if (suspects.has(i)) ids.push_back(id_of(array, i));
  }
  return ids.size() > 1 ? "one of " + listed(ids) : listed(ids);
}

std::string level_words(const FitReport& report, const io::ArrayFile& array) {
  const LevelMisfit& level = report.level_misfit;
  if (level.sensor < 0) return "";
  return fmt::format(
      "{} bends over temperature as the fit does not: near {:.0f} degC its residuals have a mean of {:+.3g} mg0, "
      "{:.1f} "
      "sigma from none",
      one_of(level.suspects, array), level.degc, 1e3 * g0_from_mps2(level.mean_mps2), level.sigmas());
}

std::string roll_words(const FitReport& report) {
  if (report.roll_groups == 0) return "";
  std::string out = fmt::format("{} in the log", report.roll_groups);
  if (report.roll_axis != Vec3{}) {
    out += fmt::format(", rolled about ({:.3g}, {:.3g}, {:.3g}) within {:.3g} deg", report.roll_axis[0],
                       report.roll_axis[1], report.roll_axis[2], deg_from_rad(report.roll_wobble_rad));
  }
  if (report.lone_rolls == 1) out += "; one has a single station, which says nothing";
  if (report.lone_rolls > 1) out += fmt::format("; {} have a single station, which says nothing", report.lone_rolls);
  return out;
}

std::string odd_sensor_words(const OddSensor& odd) {
  const auto in_mg0 = [](double mps2) { return 1e3 * g0_from_mps2(mps2); };
  // A fit that runs away may end with any number.
  const std::string with = odd.with_mps2 < kAbsurd_mps2
                               ? fmt::format("with it {:.3g} mg0 remain beyond the noise", in_mg0(odd.with_mps2))
                               : "with it the fit does not settle";
  return with + fmt::format(", without it {:.3g} mg0", in_mg0(odd.without_mps2));
}

std::string paper_words(const Error& error, const io::ArrayFile& array) {
  const std::string sensor = error.index >= 0 && error.index < array.array.size() ? id_of(array, error.index) : "";
  switch (error.code) {
    case Errc::not_unique:
      return fmt::format("none: with {:.0f} sensors infinitely many m_ij say the same; use axis, scale and bias",
                         error.value);
    case Errc::axes_rank_deficient:
      return "none: " + (sensor.empty() ? "the axes lie" : "without " + sensor + " the axes lie") +
             " in one plane, and the misalignments of eq (3) have nothing to be expressed in";
    case Errc::not_invertible: return "none: " + sensor + " lies across its nominal direction";
    default: return "none: there is no fit to show";
  }
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
