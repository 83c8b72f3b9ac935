// Why a fit was refused, by name and figure, and what to do about it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "finding_words.hpp"
#include "fit_words.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/fit_figures.hpp"
#include "plumb/findings/refusal.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/fit_report.hpp"
#include "plumb/render/wiring_words.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"
#include "second_look_words.hpp"
#include "temperature_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::CalibrationRun;
using findings::Finding;
using Code = findings::FindingCode;

constexpr const char* kRecordAgain = "make sure that the tool was still at every station, then record again";

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
  if (words.empty()) return "hold the tool still at new attitudes";
  return "hold the tool still at new attitudes, for example: " + joined(words, "; ");
}

std::vector<std::string> log_reasons(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  for (const Finding& f : run.log_findings) out.push_back(log_words(f, array));
  return out;
}

/// Of a log that holds too little.
std::optional<Refusal> amount_words(const Finding& f, const CalibrationRun& run, const io::ArrayFile& array) {
  switch (f.code) {
    case Code::no_stretch_at_rest:  // with nothing at rest in the log, other attitudes are no advice
      return Refusal{fmt::format("no stretch at rest was found in {}", count_text(f.value, "row")),
                     "check the array file against the log: " + joined(log_reasons(run, array), ". Also ")};
    case Code::too_few_stations:
      return Refusal{fmt::format("{} {} found, {} are needed", count_text(f.value, "station"),
                                 by_count(f.value, "was", "were"), f.limit),
                     more_attitudes(run)};
    case Code::undetermined:
      return Refusal{
          fmt::format(
              "the stations determine {} of the {} parameters that they must (the report names what is missing)",
              f.value, f.limit),
          more_attitudes(run) + (run.report.roll_axis == Vec3{}
                                     ? ""
                                     : "; with more rolls to a group, or without `roll_group`, where it is "
                                       "the common rotation that is missing")};
    case Code::too_many_roll_groups:
      return Refusal{fmt::format("the log has more than {} roll groups", f.limit),
                     "join groups of like inclination, or leave some stations without"};
    default: return {};
  }
}

Refusal roll_axis_refusal(const Finding& f, const CalibrationRun& run) {
  const Vec3& axis = run.told().roll_axis;
  return {fmt::format("the roll axis ({:.3g}, {:.3g}, {:.3g}) is likely not the one that the tool was rolled about: to "
                      "agree with the roll groups all axes were turned together by {:.3g} deg (at most {:.3g} allowed)",
                      axis[0], axis[1], axis[2], deg_from_rad(f.value), deg_from_rad(f.limit)),
          "check --roll-axis and [output] frame against the drawing, and that nothing but the roll changes within a "
          "group; if all nominal axes are really so far off, widen `prior`"};
}

/// Of what all sensors share: gravity, unit, scale, roll axis.
std::optional<Refusal> common_words(const Finding& f, const CalibrationRun& run, const io::ArrayFile& array) {
  const double coarse = io::units_of(array.field).coarse_per_inside;
  const bool magnetic = array.field == io::FieldKind::magnetic;
  const double least = magnetic ? kLeastField : kEarthGravityMin_mps2;
  const double most = magnetic ? kMostField : kEarthGravityMax_mps2;
  switch (f.code) {
    case Code::wrong_unit:
      return Refusal{
          fmt::format("the vector is {:.3g} times as long as gravity, so the numbers of the log are not in {} or not "
                      "of the `scale` stated{}",
                      f.value, array.input.unit.name, unit_words(array, f.value)),
          "correct `unit` in [input], or `scale` and `bias` of the sensors"};
    case Code::gravity_out_of_range:
      return Refusal{
          fmt::format("gravity {:.5g} m/s^2 is {} than anywhere on Earth ({:.2f} to {:.2f} m/s^2)", coarse * f.value,
                      f.value < f.limit ? "less" : "more", coarse * least, coarse * most),
          "correct [gravity] in the array file (unit, latitude, depth); otherwise every scale factor takes up this "
          "error"};
    case Code::common_scale_changed:
      return Refusal{
          fmt::format("gravity reference or common scale off by {:.1f} %: all scale factors changed together by "
                      "{:+.2f} %, more than {:.2f} % (4 sigma of what `prior` expects of the mean of {} sensors)",
                      100.0 * std::fabs(f.value), 100.0 * f.value, 100.0 * f.limit, array.array.size()),
          "check [gravity], `unit` and `scale`; if all sensors really have this scale, state their `scale` as it is "
          "or widen `prior`"};
    case Code::roll_axis_implausible: return roll_axis_refusal(f, run);
    default: return {};
  }
}

/// The value of one sensor that no sensor has; empty for any other finding.
std::string implausible_words(const Finding& f, const io::ArrayFile& array) {
  const std::string sensor = f.sensor >= 0 ? id_of(array, f.sensor) : "a sensor";
  switch (f.code) {
    case Code::scale_implausible:
      return fmt::format(
          "the scale of {} came out as {:.3g} times its datasheet value (within {:.0f} % is allowed), which is "
          "physically implausible",
          sensor, f.value, 100.0 * f.limit);
    case Code::axis_implausible:
      return fmt::format(
          "the axis of {} came out {:.0f} deg from its nominal one (at most {:.0f}), which is physically implausible",
          sensor, deg_from_rad(f.value), deg_from_rad(f.limit));
    case Code::bias_implausible:
      return fmt::format(
          "the bias of {} came out {:.4g} mg0 from its datasheet value (at most {:.4g}, 8 times its prior), which is "
          "physically implausible",
          sensor, in_fine(array, f.value), in_fine(array, f.limit));
    case Code::value_implausible:
      return fmt::format("a parameter of {} is physically implausible ({:.4g}, bound {:.4g})", sensor, f.value,
                         f.limit);
    default: return "";
  }
}

std::optional<Refusal> value_words(const Finding& f, const CalibrationRun& run, const io::ArrayFile& array) {
  if (f.code == Code::duplicate_channels) {
    return Refusal{fmt::format("{} and {} hold the same numbers at every station, so they read the same channel",
                               id_of(array, f.sensor), id_of(array, f.other)),
                   "look at `column` of both in the array file, and at how the log was written"};
  }
  if (f.code == Code::one_of_several_implausible) {
    return Refusal{fmt::format("{} is physically implausible; these stations do not show which",
                               one_of(run.report.suspects, array)),
                   "check channel, sign of the axis and scale of each in the array file; if all is right, record more "
                   "attitudes"};
  }
  const std::string words = implausible_words(f, array);
  if (words.empty()) return {};
  return Refusal{words,
                 "check its `column`, the sign of its `axis` and its `scale` in the array file; if all is right, the "
                 "sensor is faulty: leave it out"};
}

/// Of a fit that was judged, by the figure that was too large.
std::optional<Refusal> judged_words(const Finding& f, const CalibrationRun& run, const io::ArrayFile& array) {
  const std::string sensor = f.sensor >= 0 ? id_of(array, f.sensor) : "";
  const auto worst_station = [&f] {
    return "look at station " + std::to_string(f.other + 1) + ", the worst one; " + kRecordAgain;
  };
  switch (f.code) {
    case Code::inconsistent_sensor:
      return Refusal{
          fmt::format("{} is faulty or wrongly described: {} (allowed {:.3g} mg0)", sensor,
                      odd_sensor_words(run.study.odd, array), in_fine(array, f.limit)),
          "look at the channel of " + sensor + " in the log; leave the sensor out or replace it, then record again"};
    case Code::residuals_follow_temperature:
      return Refusal{fmt::format("{} (allowed {:.3g} mg0)", level_words(run.told(), array), in_fine(array, f.limit)),
                     run.temperature.order < kMaxTemperatureOrder
                         ? "record at more temperatures, so that a higher order can be fitted; or replace the sensor"
                         : "use the tool where the sensor follows a cubic (--use-range-degc, and stations of that "
                           "range only), or replace the sensor"};
    case Code::sensors_disagree:
      return Refusal{fmt::format("the sensors disagree by {:.3g} mg0 rms (allowed {:.3g})", in_fine(array, f.value),
                                 in_fine(array, f.limit)),
                     "look at " + sensor + ", whose residual is the largest; " + kRecordAgain};
    case Code::held_out_error_too_large:
      return Refusal{fmt::format("the error at stations held out of the fit is {:.3g} mg0 rms (allowed {:.3g})",
                                 in_fine(array, f.value), in_fine(array, f.limit)),
                     worst_station()};
    case Code::held_out_error_above_claim:
      return Refusal{
          fmt::format("stations that were held out are missed by {:.1f} times what the fit claims (allowed {:.1f})",
                      f.value, f.limit),
          worst_station()};
    default: return {};
  }
}

/// Of a fit that was refused for its residuals.
std::optional<Refusal> residual_words(const Finding& f, const CalibrationRun& run, const io::ArrayFile& array) {
  const FitReport& r = run.report;
  const double coarse = io::units_of(array.field).coarse_per_inside;
  const std::string sensor = f.sensor >= 0 ? id_of(array, f.sensor) : "";
  const std::string channel = f.sensor >= 0 ? "look at the channel of " + sensor + " in the log; " : "";
  switch (f.code) {
    case Code::noise_beyond_declared:
      return Refusal{noise_words(r, array, f.sensor) + ", and the residuals exceed the noise too",
                     channel +
                         "if this is its true noise, declare it in the array file: the limits of the monitor depend "
                         "on it; " +
                         measure_noise_words(array)};
    case Code::too_many_outliers:
      return Refusal{fmt::format("{} of {} contradict the others (at most {:.0f} may be outliers){}", f.value,
                                 count_text(r.stations + r.outliers, "station"), f.limit,
                                 f.sensor >= 0 ? ", most of them by the reading of " + sensor : ""),
                     channel + kRecordAgain};
    case Code::outliers_of_three:
      return Refusal{
          fmt::format("three sensors do not show which stations are wrong: {} of {} are outliers ({}), and the rest {}",
                      f.value, f.limit, listed(outlier_words(run, array)),
                      r.p_value < 1e-3 ? "exceeds the noise too" : "is too little to confirm it"),
          std::string(kRecordAgain) + ", at 36 attitudes or more"};
    case Code::residuals_above_others:
      return Refusal{fmt::format("the residuals of {} are {:.1f} times those of the other sensors (allowed {:.1f})",
                                 sensor, f.value, f.limit),
                     channel + kRecordAgain};
    case Code::residual_too_large:
      return Refusal{
          fmt::format("the residual is too large ({:.4g} m/s^2, allowed {:.4g})", coarse * f.value, coarse * f.limit),
          "look at " + sensor + ", whose residual is the largest; check [gravity], and " + kRecordAgain};
    default: return {};
  }
}

/// Of a fit that did not settle.
std::optional<Refusal> settling_refusal(const std::vector<Finding>& list, const CalibrationRun& run,
                                        const io::ArrayFile& array) {
  const Finding& f = list.front();
  switch (f.code) {
    case Code::station_temperature_impossible:
      return Refusal{fmt::format("station {} has a temperature of {:.4g} degC, outside {:g} to {:g} degC", f.other + 1,
                                 f.value, kPlausibleMin_degc, kPlausibleMax_degc),
                     "correct the temperature column, or remove the rows"};
    case Code::station_reading_impossible:
      return Refusal{fmt::format("station {} holds a reading that no sensor gives ({} reads {:.4g} {})", f.other + 1,
                                 id_of(array, f.sensor), f.value, array.input.unit.name),
                     "correct or remove the row"};
    case Code::temperature_follows_direction:
      return Refusal{
          fmt::format(
              "the fit did not converge: the temperature of the stations follows the {} direction of gravity, so "
              "drift and attitude cannot be separated",
              static_cast<char>('x' + f.other)),
          "record some of the attitudes again, hotter or colder by 30 degC or more; or give --temperature-order 0"};
    case Code::sensor_absent: {
      std::vector<std::string> absent;
      for (const Finding& one : list) {
        if (one.code == Code::sensor_absent) absent.push_back(remark_words(one, run, array));
      }
      return Refusal{"the fit did not converge: " + joined(absent, "; "), "look at the channel in the log"};
    }
    case Code::not_converged:
      return Refusal{"the fit did not converge",
                     "check `column`, `axis` and `scale` of the sensors in the array file against the log; then " +
                         more_attitudes(run)};
    default: return {};
  }
}

Refusal other_words(const Finding& f, const Error& error, const io::ArrayFile& array) {
  const io::FileError words = io::from_error(error);
  return {words.what + (f.sensor >= 0 ? " (sensor " + id_of(array, f.sensor) + ")" : ""), words.remedy};
}

Refusal reason_of(const std::vector<Finding>& list, const CalibrationRun& run, const io::ArrayFile& array) {
  const Finding& f = list.front();
  std::optional<Refusal> out = amount_words(f, run, array);
  if (!out) out = temperature_refusal(f, run);
  if (!out) out = common_words(f, run, array);
  if (!out) out = value_words(f, run, array);
  if (!out) out = judged_words(f, run, array);
  if (!out) out = residual_words(f, run, array);
  if (!out) out = settling_refusal(list, run, array);
  return out ? *out : other_words(f, run.refusal, array);
}

/// Columns that are stuck: no attitude mends that.
Refusal dead_columns_words(const std::vector<Finding>& dead, const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> words, ids;
  for (const Finding& f : dead) {
    words.push_back(column_words(f, run, array));
    ids.push_back(id_of(array, f.sensor));
  }
  return {"the column " + listed(words),
          fmt::format(
              "look at `column` of {} in the array file and at how the log was written; remove an absent sensor from "
              "the array file",
              listed(ids))};
}

Refusal of_run(const CalibrationRun& run, const io::ArrayFile& array) {
  if (run.wiring.status == findings::WiringStatus::contradicted && run.refusal.code == Errc::ok)
    return {wiring_reason(run.wiring, array), wiring_remedy(run.wiring, array)};
  const std::vector<Finding> list = findings::refusal_of(run, array);
  if (is_of_column(list.front().code)) return dead_columns_words(list, run, array);
  Refusal out = reason_of(list, run, array);
  std::vector<std::string> columns;
  std::vector<Finding> settling;
  for (const Finding& f : list) {
    if (is_of_column(f.code)) {
      out.reason += "; the column " + column_words(f, run, array);
      columns.push_back("`" + column_of(f, array) + "`");
    } else if (f.code >= Code::accepted_if_exchanged && f.code <= Code::accepted_about_another_axis) {
      settling.push_back(f);
    }
  }
  if (!columns.empty()) out.next = "fill in " + joined(columns, ", ") + " where it is empty; or " + out.next;
  if (settling.empty()) return out;
  return {out.reason + settling_words(settling, run, array), settling_remedy(settling, run, array)};
}

}  // namespace

Refusal refusal_of(const CalibrationRun& run, const io::ArrayFile& array) {
  const Refusal out = of_run(run, array);
  return {in_field_words(out.reason, array.field), in_field_words(out.next, array.field)};
}

Refusal paper_refusal_of(const CalibrationRun& run, const io::ArrayFile& array) {
  const Finding f = findings::paper_refusal_of(run, array);
  const std::string without = "calibrate without --paper and mode = \"paper\"";
  switch (f.code) {
    case Code::paper_axes_coplanar:
      return {fmt::format("the nominal axes lie near one plane (least singular value {:.3g}, below {} the "
                          "misalignments of eq (3) are quotients of small numbers)",
                          f.value, f.limit),
              without + "; plumb's own fit does not need them"};
    case Code::paper_not_converged:
      return {"it did not converge", "check axes and scales in the array file, or " + without};
    case Code::paper_rank_too_high:
      return {fmt::format("its equations have rank {} where the length of gravity shows {} directions: the "
                          "disagreement of the sensors ({:.3g} mg0 rms) adds the others",
                          f.value, f.limit, in_fine(array, run.told().parity_rms_mps2)),
              "look for an error beyond the noise (see `chi^2` in the report), or " + without};
    case Code::paper_undetermined:
      return {fmt::format("the stations show {} of the {} directions that the length of gravity can show", f.value,
                          f.limit),
              more_attitudes(run) + ", or " + without};
    case Code::paper_too_few_stations:
      return {fmt::format("{} {} all sensors, {} are needed", count_text(f.value, "station"),
                          by_count(f.value, "has", "have"), f.limit),
              more_attitudes(run) + ", or " + without};
    default: {
      const Refusal words = other_words({}, run.paper_refusal, array);
      return {words.reason, words.next + ", or " + without};
    }
  }
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
