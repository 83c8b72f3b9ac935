#include "fit_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "finding_words.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/fit_remarks.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/words.hpp"
#include "temperature_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
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
  return fmt::format("({}, {}, {})", fixed_words(turn[0], 1), fixed_words(turn[1], 1), fixed_words(turn[2], 1));
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

constexpr double kAbsurd_mps2 = 1e4;

}  // namespace

std::string id_of(const io::ArrayFile& array, int i) { return array.array.row(i).id.data(); }

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

std::vector<std::string> unobservable(const findings::CalibrationRun& run, const io::ArrayFile& array) {
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
  return out +
         fmt::format(" (down along {}, {}, {})", fixed_words(d[0], 1), fixed_words(d[1], 1), fixed_words(d[2], 1));
}

bool noise_overstated(const FitReport& report) { return report.degrees_of_freedom > 0 && report.p_value > 1.0 - 1e-3; }

std::string p_value_words(const FitReport& report) {
  if (report.degrees_of_freedom < 1) return "no station is left to test the fit";
  const double factor = std::sqrt(report.chi2 / report.degrees_of_freedom);
  if (report.p_value < 1e-3) {
    return fmt::format(
        "the residuals are {:.1f} times what the declared noise alone leaves, so another error affects the readings "
        "(temperature, handling, nonlinearity) or the declared noise is too small; all limits include the excess",
        factor);
  }
  if (noise_overstated(report)) {
    return fmt::format(
        "the residuals are only {:.2g} of what the declared noise leaves: the declared noise is too large, or a row "
        "averages more samples than `count` states; the limits are wider than necessary",
        factor);
  }
  return fmt::format("residuals like these arise by the declared noise alone in {:.0f} of 100 recordings: acceptable",
                     std::fmax(1.0, 100.0 * report.p_value));
}

std::vector<std::string> coverage_words(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  for (const findings::Finding& f : findings::coverage_remarks(run, array)) out.push_back(remark_words(f, run, array));
  return out;
}

std::string common_scale_words(const findings::CalibrationRun& run) {
  if (!run.study.shown) return "";
  const CommonScale& c = run.told().common_scale;
  std::string out = fmt::format(
      "all scale factors changed together by {} % ({:.1f} sigma of what `prior` expects), singly by {:.3f} %",
      unsigned_zero(fmt::format("{:+.3f}", 100.0 * c.mean)), std::fabs(c.sigmas()), 100.0 * c.scatter);
  if (findings::has(findings::common_remarks(run.told()), findings::FindingCode::common_scale_reported))
    out += fmt::format(": gravity reference or common scale off by {:.1f} %, or the `unit` is wrong?",
                       100.0 * std::fabs(c.mean));
  return out;
}

std::vector<std::string> outlier_words(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  const FitReport& r = run.told();
  const int listed = std::min(r.outliers, kMaxOutliers);
  for (int k = 0; k < listed; ++k) {
    const Outlier& o = r.outlier[static_cast<std::size_t>(k)];
    const std::string whose =
        o.sensor >= 0 ? fmt::format(", {:.0f} % of it from {}", 100.0 * o.share, id_of(array, o.sensor)) : "";
    out.push_back(fmt::format("station {} ({:.1f} sigma{})", o.station + 1, o.standardised, whose));
  }
  if (r.outliers > listed) out.push_back(fmt::format("{} more", r.outliers - listed));
  return out;
}

std::string noise_words(const FitReport& report, const io::ArrayFile& array, int sensor) {
  return fmt::format("the samples of {} scatter by {:.3g} mg0, {:.2g} times the {:.3g} mg0 declared",
                     id_of(array, sensor), in_fine(array, report.sample_noise_mps2[static_cast<std::size_t>(sensor)]),
                     findings::noise_factor(report, array, sensor),
                     in_fine(array, array.datasheet.sensor[static_cast<std::size_t>(sensor)].row.sigma_mps2));
}

std::string high_variance_words(const FitReport& report, const io::ArrayFile& array) {
  if (report.high_variance_sensor < 0) return "";
  return fmt::format(
      "{}: its residuals are {:.1f} times those of the other sensors, {:.3g} mg0 at a station beyond its noise; all "
      "sigmas are widened for it. Look at its channel",
      id_of(array, report.high_variance_sensor), report.loud_excess, in_fine(array, report.loud_misfit_mps2));
}

std::string inclination_words(const FitReport& report) {
  return fmt::format("known to {:.3g} deg (1 sigma), {}", deg_from_rad(report.inclination_sigma_rad),
                     report.roll_axis == Vec3{}
                         ? "from the nominal axes only: gravity shows only changes of inclination unless `roll_group` "
                           "groups the stations with a common one"
                         : "by the stations that share one, about the roll axis as stated");
}

std::string roll_axis_words(const FitReport& report) {
  const CommonTurn& turn = report.common_turn;
  if (!(turn.sigma_rad > 0.0)) return "";
  std::string out = fmt::format(
      "by it all axes are turned together by {:.3g} deg from the nominal ones, which know it to {:.3g} deg: {:.1f} "
      "sigma",
      deg_from_rad(turn.rad), deg_from_rad(turn.sigma_rad), turn.sigmas());
  if (findings::has(findings::common_remarks(report), findings::FindingCode::roll_axis_reported)) {
    out += ". Check the roll axis (--roll-axis, [output] frame): its error is an error of every inclination";
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
      "the residuals of {} depend on temperature beyond the fit: near {:.0f} degC its residuals have a mean of "
      "{:+.3g} mg0, {:.1f} sigma from none",
      one_of(level.suspects, array), level.degc, in_fine(array, level.mean_mps2), level.sigmas());
}

std::string roll_words(const FitReport& report) {
  if (report.roll_groups == 0) return "";
  std::string out = fmt::format("{} in the log", report.roll_groups);
  if (report.roll_axis != Vec3{}) {
    out += fmt::format(", rolled about ({:.3g}, {:.3g}, {:.3g}) within {:.3g} deg", report.roll_axis[0],
                       report.roll_axis[1], report.roll_axis[2], deg_from_rad(report.roll_axis_deviation_rad));
  }
  if (report.single_station_groups == 1) out += "; one has a single station, which carries no information";
  if (report.single_station_groups > 1)
    out += fmt::format("; {} have a single station, which carries no information", report.single_station_groups);
  return out;
}

std::string odd_sensor_words(const OddSensor& odd, const io::ArrayFile& array) {
  // A fit that runs away may end with any number.
  const std::string with = odd.with_mps2 < kAbsurd_mps2 ? fmt::format("with it {:.3g} mg0 remain beyond the noise",
                                                                      in_fine(array, odd.with_mps2))
                                                        : "with it the fit does not converge";
  return with + fmt::format(", without it {:.3g} mg0", in_fine(array, odd.without_mps2));
}

std::string paper_sensors(const findings::PaperFigures& figures, const io::ArrayFile& array) {
  return figures.used == array.array.all() ? "all" : sensor_names(figures.used, array.array);
}

std::string paper_outcome(const findings::PaperFigures& figures) {
  return figures.stop == StopReason::none ? "not possible" : to_string(figures.stop);
}

std::string paper_words(const Error& error, const io::ArrayFile& array) {
  const std::string sensor = error.index >= 0 && error.index < array.array.size() ? id_of(array, error.index) : "";
  switch (error.code) {
    case Errc::not_unique:
      return fmt::format("none: with {:.0f} sensors the m_ij are not unique; use axis, scale and bias", error.value);
    case Errc::axes_rank_deficient:
      return "none: " + (sensor.empty() ? "the axes lie" : "without " + sensor + " the axes lie") +
             " in one plane, so the misalignments of eq (3) are undefined";
    case Errc::not_invertible: return "none: " + sensor + " lies across its nominal direction";
    default: return "none: there is no fit to show";
  }
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
