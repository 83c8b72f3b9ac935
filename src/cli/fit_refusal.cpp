// Why a fit was refused, by name and figure, and what to do about it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "best_turn.hpp"
#include "column_facts.hpp"
#include "figures.hpp"
#include "fit_words.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/core/units.hpp"
#include "temperature_words.hpp"
#include "unit_guess.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

std::string joined(const std::vector<std::string>& parts, const char* between) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : between) + part;
  return out;
}

std::string more_attitudes(const CalibrationRun& run) {
  std::vector<std::string> words;
  for (const PlannedAttitude& attitude : run.study.next) {
    if (words.size() < 3) words.push_back(attitude_words(attitude));
  }
  if (words.empty()) return "hold the tool still at attitudes it has not had yet";
  return "hold the tool still at attitudes it has not had yet, for example: " + joined(words, "; ");
}

/// With nothing at rest in the log, other attitudes are no advice.
Refusal no_stations(const CalibrationRun& run) {
  return {fmt::format("no still stretch was found in {} rows", run.log.rows),
          "check the array file against the log: " + joined(run.log_findings, ". Also ")};
}

std::string worst_sensor(const CalibrationRun& run, const io::ArrayFile& array) {
  int worst = 0;
  for (int i = 1; i < array.array.size(); ++i) {
    if (run.report.residual_rms_mps2[static_cast<std::size_t>(i)] >
        run.report.residual_rms_mps2[static_cast<std::size_t>(worst)])
      worst = i;
  }
  return id_of(array, worst);
}

/// Angle of the axis of sensor i from its nominal one once the others lie on theirs as well as one rotation or mirror
/// allows, and the largest angle among those others.
struct AxisShift {
  double own_rad = 0.0;
  double others_rad = 0.0;
};

AxisShift axis_shift(const SensorArray& fitted, const SensorArray& nominal, int i) {
  BestTurn best;
  for (int k = 0; k < nominal.size(); ++k) {
    if (k != i) best.add(nominal.axis(k), fitted.axis(k));
  }
  // Mirrors too: to gravity a tool and its mirror image are the same, and a sensor of the wrong sign may lead to it.
  const Turn turn = best.find(Hand::free);
  AxisShift out;
  for (int k = 0; k < nominal.size(); ++k) {
    const double angle = angle_between_rad(turned(turn, fitted.axis(k)), nominal.axis(k));
    if (k == i) out.own_rad = angle;
    if (k != i) out.others_rad = std::fmax(out.others_rad, angle);
  }
  return out;
}

/// The sensor without which the axes of all others fit theirs best; -1 with three sensors, whose axes always tell only
/// of each other.
int odd_axis(const SensorArray& fitted, const SensorArray& nominal) {
  int best = -1;
  for (int i = 0; i < nominal.size() && nominal.size() > 3; ++i) {
    if (best < 0 || axis_shift(fitted, nominal, i).others_rad < axis_shift(fitted, nominal, best).others_rad) best = i;
  }
  return best;
}

/// The value that is farthest beyond its bound. One sensor that is far off turns the axes of all others a little, so
/// the first one beyond its bound need not be the culprit.
std::string worst_value(const CalibrationRun& run, const io::ArrayFile& array) {
  if (!run.study.shown) return "";
  const FitOptions& bound = run.options;
  const int odd = odd_axis(run.study.shown->array, array.array);
  double most = 1.0;
  std::string out;
  const auto take = [&most, &out](double excess, std::string words) {
    if (!(excess > most)) return;
    most = excess;
    out = std::move(words);
  };
  for (int i = 0; i < array.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    const SensorCoefficients& now = run.study.shown->model.sensor[a];
    const SensorCoefficients& then = array.datasheet.sensor[a].coefficients;
    const double ratio = now.scale[0] / then.scale[0];
    const double shift_rad = i == odd  ? axis_shift(run.study.shown->array, array.array, i).own_rad
                             : odd < 0 ? angle_between_rad(run.study.shown->array.axis(i), array.array.axis(i))
                                       : 0.0;
    const double bias_mps2 = now.bias[0] * ratio - then.bias[0];
    const double bias_bound = bound.max_bias_sigmas * array.datasheet.sensor[a].prior.bias_mps2;
    const std::string id = id_of(array, i);
    take((std::fmax(ratio, 1.0 / ratio) - 1.0) / bound.max_scale_change,
         fmt::format("the scale of {} came out as {:.3g} times its datasheet value (within {:.0f} % is allowed)", id,
                     ratio, 100.0 * bound.max_scale_change));
    take(shift_rad / bound.max_axis_change_rad,
         fmt::format("the axis of {} came out {:.0f} deg from its nominal one (at most {:.0f})", id,
                     deg_from_rad(shift_rad), deg_from_rad(bound.max_axis_change_rad)));
    take(std::fabs(bias_mps2) / bias_bound,
         fmt::format("the bias of {} came out {:.4g} mg0 from its datasheet value (at most {:.4g}, 8 times its prior)",
                     id, in_mg0(bias_mps2), in_mg0(bias_bound)));
  }
  return out;
}

/// The sensor whose channel is a copy of this one's; -1 where none is.
int same_as(const CalibrationRun& run, const io::ArrayFile& array, int sensor) {
  for (int i = 0; i < array.array.size() && sensor >= 0 && !run.stations.empty(); ++i) {
    const auto differs = [i, sensor](const Station& s) {
      return s.mean[static_cast<std::size_t>(i)] != s.mean[static_cast<std::size_t>(sensor)];
    };
    if (i != sensor && std::none_of(run.stations.begin(), run.stations.end(), differs)) return i;
  }
  return -1;
}

Refusal wrong_roll_axis(const CalibrationRun& run) {
  const Vec3& axis = run.told().roll_axis;
  return {fmt::format("the roll axis ({:.3g}, {:.3g}, {:.3g}) is likely not the one that the tool was rolled about: to "
                      "agree with the roll groups all axes were turned together by {:.3g} deg (at most {:.3g} allowed)",
                      axis[0], axis[1], axis[2], deg_from_rad(run.refusal.value), deg_from_rad(run.refusal.limit)),
          "check --roll-axis and [output] frame against the drawing, and that nothing but the roll changes within a "
          "group; if all nominal axes are really so far off, widen `prior`"};
}

Refusal implausible(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.refusal;
  switch (run.concern) {
    case Concern::gravity:
      return {fmt::format("gravity {:.5g} m/s^2 is {} than anywhere on Earth ({:.2f} to {:.2f} m/s^2)", e.value,
                          e.value < e.limit ? "less" : "more", kEarthGravityMin_mps2, kEarthGravityMax_mps2),
              "correct [gravity] in the array file (unit, latitude, depth); every scale factor would take the error"};
    case Concern::common_scale:
      return {fmt::format("gravity reference or common scale off by {:.1f} %: all scale factors moved together by "
                          "{:+.2f} %, more than {:.2f} % (4 sigma of what `prior` expects of the mean of {} sensors)",
                          100.0 * std::fabs(e.value), 100.0 * e.value, 100.0 * e.limit, array.array.size()),
              "check [gravity], `unit` and `scale`: a wrong one does just this; if all sensors really are so, state "
              "their `scale` as it is or widen `prior`"};
    case Concern::roll_axis: return wrong_roll_axis(run);
    default: break;
  }
  if (const int twin = same_as(run, array, e.index); twin >= 0) {
    return {fmt::format("{} and {} hold the same numbers at every station, which two sensors never do",
                        id_of(array, std::min(twin, e.index)), id_of(array, std::max(twin, e.index))),
            "look at `column` of both in the array file, and at how the log was written"};
  }
  if (e.index < 0 && run.report.common_turn.sigma_rad > 0.0) return wrong_roll_axis(run);
  if (run.report.suspects.size() > 1) {
    return {fmt::format("{} is physically implausible; which, these stations cannot tell",
                        one_of(run.report.suspects, array)),
            "check channel, sign of the axis and scale of each in the array file; if all is right, record more "
            "attitudes"};
  }
  const std::string sensor = e.index >= 0 && e.index < array.array.size() ? id_of(array, e.index) : "a sensor";
  const std::string worst = worst_value(run, array);
  return {
      worst.empty()
          ? fmt::format("a parameter of {} is physically implausible ({:.4g}, bound {:.4g})", sensor, e.value, e.limit)
          : worst + ", which is physically implausible",
      "check its `column`, the sign of its `axis` and its `scale` in the array file; if all is right, the sensor is "
      "faulty: leave it out"};
}

/// The numbers of the log cannot be in the unit stated.
Refusal wrong_unit(const CalibrationRun& run, const io::ArrayFile& array) {
  const double factor = length_factor(array, run.stations);
  return {
      fmt::format("the vector is {:.3g} times as long as gravity, so the numbers of the log are not in {} or not of "
                  "the `scale` stated{}",
                  factor, array.input.unit.name, likely_unit(array, factor)),
      "correct `unit` in [input], or `scale` and `bias` of the sensors"};
}

Refusal poor_fit(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.refusal;
  const std::string record = "make sure that the tool was still at every station, then record again";
  switch (run.concern) {
    case Concern::odd_sensor: {
      const std::string sensor = id_of(array, e.index);
      return {
          fmt::format("{} is faulty or wrongly described: {} (allowed {:.3g} mg0)", sensor,
                      odd_sensor_words(run.study.odd), in_mg0(e.limit)),
          "look at the channel of " + sensor + " in the log; leave the sensor out or replace it, then record again"};
    }
    case Concern::level_of_a_sensor:
      return {fmt::format("{} (allowed {:.3g} mg0)", level_words(run.told(), array), in_mg0(e.limit)),
              run.temperature.order < kMaxTemperatureOrder
                  ? "record at more temperatures, so that a higher order can be fitted; or replace the sensor"
                  : "use the tool where the sensor follows a cubic (--use-range-degc, and stations of that range "
                    "only), or replace the sensor"};
    case Concern::parity:
      return {fmt::format("the sensors contradict one another by {:.3g} mg0 rms (allowed {:.3g})", in_mg0(e.value),
                          in_mg0(e.limit)),
              "look at " + worst_sensor(run, array) + ", whose residual is the largest; " + record};
    case Concern::hold_out:
      return {fmt::format("stations that were held out of the fit are missed by {:.3g} mg0 rms (allowed {:.3g})",
                          in_mg0(e.value), in_mg0(e.limit)),
              "look at station " + std::to_string(run.study.held_out.worst + 1) + ", the worst one; " + record};
    case Concern::hold_out_claim:
      return {fmt::format("stations that were held out are missed by {:.1f} times what the fit claims (allowed {:.1f})",
                          e.value, e.limit),
              "look at station " + std::to_string(run.study.held_out.worst + 1) + ", the worst one; " + record};
    default: break;
  }
  const FitReport& r = run.report;
  if (e.index >= 0 && e.value == noise_factor(r, array, e.index)) {
    return {noise_words(r, array, e.index) + ", and the residuals are no noise either",
            "look at the channel of " + id_of(array, e.index) +
                " in the log; if its noise is what it is, declare it in the array file: the limits of the monitor are "
                "made of it"};
  }
  const double most = run.options.max_outlier_share * (r.stations + r.outliers);
  const std::string channel = e.index >= 0 ? "look at the channel of " + id_of(array, e.index) + " in the log; " : "";
  if (static_cast<double>(r.outliers) > most) {
    return {fmt::format("{} of {} stations contradict the others (at most {:.0f} may be set aside){}", r.outliers,
                        r.stations + r.outliers, std::floor(most),
                        e.index >= 0 ? ", most of them by the reading of " + id_of(array, e.index) : ""),
            channel + record};
  }
  if (r.parameters == 12 && r.outliers > 0 && r.norm_rms_mps2 <= run.options.max_norm_rms_mps2) {
    return {fmt::format("three sensors cannot tell which stations err: {} of {} were set aside ({}), and the rest "
                        "{}",
                        r.outliers, r.stations + r.outliers, listed(outlier_words(run, array)),
                        r.p_value < 1e-3 ? "is no noise either" : "is too little to confirm it"),
            record + ", at 36 attitudes or more"};
  }
  if (e.index >= 0 && r.norm_rms_mps2 <= run.options.max_norm_rms_mps2) {
    return {fmt::format("the residuals of {} are {:.1f} times those of the other sensors (allowed {:.1f})",
                        id_of(array, e.index), e.value, e.limit),
            channel + record};
  }
  return {fmt::format("the residual is too large ({:.4g} m/s^2, allowed {:.4g})", e.value, e.limit),
          "look at " + worst_sensor(run, array) + ", whose residual is the largest; check [gravity], and " + record};
}

std::string largest_reading(const Station& station, const io::ArrayFile& array) {
  int most = 0;
  for (int i = 1; i < array.array.size(); ++i) {
    if (std::fabs(station.mean[static_cast<std::size_t>(i)]) > std::fabs(station.mean[static_cast<std::size_t>(most)]))
      most = i;
  }
  return fmt::format("{} reads {:.4g} {}", id_of(array, most), station.mean[static_cast<std::size_t>(most)],
                     array.input.unit.name);
}

Refusal did_not_settle(const CalibrationRun& run, const io::ArrayFile& array) {
  if (const int k = run.refusal.index; k >= 0 && k < static_cast<int>(run.stations.size())) {
    const double degc = run.stations[static_cast<std::size_t>(k)].temperature_degc;
    if (degc < kPlausibleMin_degc || degc > kPlausibleMax_degc) {
      return {fmt::format("station {} has a temperature of {:.4g} degC, which no tool has (from {:g} to {:g})", k + 1,
                          degc, kPlausibleMin_degc, kPlausibleMax_degc),
              "mend the temperature column, or leave the rows out"};
    }
    return {fmt::format("station {} holds a reading that no sensor gives ({})", k + 1,
                        largest_reading(run.stations[static_cast<std::size_t>(k)], array)),
            "mend the row or leave it out"};
  }
  if (const FollowedDirection follows = followed_direction(run); follows.axis != 0) {
    return {
        fmt::format("the fit did not settle: the temperature of the stations follows the {} direction of gravity, so "
                    "that drift and attitude cannot be told apart",
                    follows.axis),
        "record some of the attitudes again, hotter or colder by 30 degC or more; or give --temperature-order 0"};
  }
  const std::vector<std::string> absent = absent_words(run, array);
  if (!absent.empty()) return {"the fit did not settle: " + joined(absent, "; "), "look at the channel in the log"};
  return {"the fit did not settle",
          "check `column`, `axis` and `scale` of the sensors in the array file against the log; then " +
              more_attitudes(run)};
}

/// Of a log that determines too little: the columns that lacked numbers are likely why.
Refusal too_little(Refusal refusal, const CalibrationRun& run, const io::ArrayFile& array) {
  std::string columns;
  for (const ColumnFact& fact : column_facts(run, array)) {
    if (fact.of != "roll_group") refusal.reason += "; the column " + fact.words;
    if (fact.of != "roll_group") columns += (columns.empty() ? "" : ", ") + ("`" + fact.column + "`");
  }
  if (!columns.empty()) refusal.next = "fill in " + columns + " where it is empty; or " + refusal.next;
  return refusal;
}

/// The refusal of values that do not fit together, with the one mistake of the array file that would explain them.
Refusal explained(Refusal refusal, const CalibrationRun& run, const io::ArrayFile& array) {
  if (!run.second_look.found()) return refusal;
  return {refusal.reason + second_look_words(run.second_look, array), second_look_remedy(run.second_look, array)};
}

}  // namespace

Refusal refusal_of(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.refusal;
  const bool of_values = e.code == Errc::implausible || e.code == Errc::poor_fit || e.code == Errc::diverged;
  const bool of_amount = e.code == Errc::too_few_stations || e.code == Errc::unobservable;
  const std::optional<Refusal> columns = column_refusal(run, array);
  if (columns && (of_values || of_amount) && run.concern != Concern::gravity) return *columns;
  if (const std::optional<Refusal> temperature = temperature_refusal(run)) return *temperature;
  if (of_values && run.concern != Concern::gravity && of_another_unit(array, run.stations))
    return wrong_unit(run, array);
  switch (e.code) {
    case Errc::too_few_stations:
      if (!run.log_findings.empty()) return too_little(no_stations(run), run, array);
      return too_little({fmt::format("{} station{} found, {} are needed", run.stations.size(),
                                     run.stations.size() == 1 ? " was" : "s were", e.limit),
                         more_attitudes(run)},
                        run, array);
    case Errc::unobservable:
      return too_little(
          {fmt::format(
               "the stations determine {} of the {} parameters that they must (the report names what is missing)",
               e.value, e.limit),
           more_attitudes(run) + (run.report.roll_axis == Vec3{}
                                      ? ""
                                      : "; with more rolls to a group, or without `roll_group`, where it is "
                                        "the common rotation that is missing")},
          run, array);
    case Errc::implausible: return explained(implausible(run, array), run, array);
    case Errc::poor_fit: return explained(poor_fit(run, array), run, array);
    case Errc::diverged: return explained(did_not_settle(run, array), run, array);
    case Errc::out_of_range:  // axis and wobble come from the command line, which checks them
      return {fmt::format("the log has more than {} roll groups", kMaxRollGroups),
              "join groups of like inclination, or leave some stations without"};
    default: {
      const std::string sensor = e.index >= 0 && e.index < array.array.size() ? id_of(array, e.index) : "";
      const io::FileError words = io::from_error(e);
      return {words.what + (sensor.empty() ? "" : " (sensor " + sensor + ")"), words.remedy};
    }
  }
}

namespace {

/// The paper writes each misalignment as a mixture of the other readings: axes near one plane make that a quotient of
/// small numbers, and no attitude mends it.
constexpr double kFlat = 0.1;

}  // namespace

Refusal paper_refusal_of(const CalibrationRun& run, const io::ArrayFile& array) {
  const Error& e = run.paper_refusal;
  const std::string without = "calibrate without --paper and mode = \"paper\"";
  const double least = least_singular_value(array.array);
  if (least < kFlat) {
    return {fmt::format("the nominal axes lie near one plane (least singular value {:.3g}, below {} the misalignments "
                        "of eq (3) are quotients of small numbers)",
                        least, kFlat),
            without + "; plumb's own fit does not need them"};
  }
  switch (e.code) {
    case Errc::diverged: return {"it did not converge", "check axes and scales in the array file, or " + without};
    case Errc::unobservable:
      if (e.value > e.limit) {
        return {fmt::format("its equations have rank {} where the length of gravity shows {} directions: what the "
                            "sensors contradict one another by ({:.3g} mg0 rms) feigns the others",
                            e.value, e.limit, in_mg0(run.told().parity_rms_mps2)),
                "look for what moves the readings beyond their noise (see `chi^2` in the report), or " + without};
      }
      return {fmt::format("the stations show {} of the {} directions that the length of gravity can show", e.value,
                          e.limit),
              more_attitudes(run) + ", or " + without};
    case Errc::too_few_stations:
      return {fmt::format("{} stations have all sensors, {} are needed", e.value, e.limit),
              more_attitudes(run) + ", or " + without};
    default: {
      const io::FileError words = io::from_error(e);
      return {words.what, words.remedy + ", or " + without};
    }
  }
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
