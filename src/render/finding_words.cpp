#include "finding_words.hpp"

#include <fmt/format.h>

#include "fit_words.hpp"
#include "plumb/calibration/temperature_fit.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/column_findings.hpp"
#include "plumb/findings/unit_guess.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::CalibrationRun;
using findings::Finding;
using Code = findings::FindingCode;

std::string in_rows(double without, double rows) {
  if (without == rows) return "all " + count_text(rows, "row");
  return fmt::format("{} of {} ({:.3g} %)", without, count_text(rows, "row"), 100.0 * without / rows);
}

std::string gap_words(const Finding& f, const std::string& column, int left_out) {
  std::string out = fmt::format("`{}` (temperature) is empty in {}, which use the value of the row before", column,
                                in_rows(f.value, f.limit));
  if (left_out > 0) {
    out += fmt::format(
        "; {} {} not used: no temperature of {} own, and the stations before and after differ by more than "
        "{:g} degC or none follows",
        count_text(left_out, "station"), by_count(left_out, "is", "are"), by_count(left_out, "its", "their"),
        kLevelMargin_degc);
  }
  return out;
}

std::string range_words(double part) { return unsigned_zero(fmt::format("{:+.1f}", part)) + " g0"; }

std::string inclination_remark(const Finding& f, const Coverage& c) {
  const double least_deg = deg_from_rad(c.inclination_min_rad), most_deg = deg_from_rad(c.inclination_max_rad);
  if (f.code == Code::narrow_inclinations) {
    return fmt::format(
        "inclinations from {:.0f} to {:.0f} deg only; a span of less than 60 deg separates bias and scale poorly",
        least_deg, most_deg);
  }
  return fmt::format("{}; at least three are needed: add {} {} {:.0f} deg", count_text(c.inclinations, "inclination"),
                     f.limit - f.value > 1.0 ? "two" : "one", most_deg < 90.0 ? "above" : "below",
                     most_deg < 90.0 ? most_deg + 15.0 : least_deg - 15.0);
}

}  // namespace

bool is_of_column(Code code) { return code <= Code::roll_group_column_empty; }

std::string column_of(const Finding& f, const io::ArrayFile& array) {
  if (f.code == Code::temperature_column_gaps) return array.input.temperature_column;
  if (f.code == Code::roll_group_column_empty) return array.input.roll_group_column;
  return array.input.sensor_columns[static_cast<std::size_t>(f.sensor)];
}

std::string column_words(const Finding& f, const CalibrationRun& run, const io::ArrayFile& array) {
  const std::string column = column_of(f, array);
  const std::string name = f.sensor >= 0 ? fmt::format("`{}` ({})", column, id_of(array, f.sensor)) : "";
  switch (f.code) {
    case Code::column_empty: return fmt::format("{} is empty in {}", name, in_rows(f.value, f.limit));
    case Code::column_not_finite: return fmt::format("{} is nan or inf in {}", name, in_rows(f.value, f.limit));
    case Code::column_empty_or_not_finite:
      return fmt::format("{} is empty, nan or inf in {}", name, in_rows(f.value, f.limit));
    case Code::column_constant:
      return fmt::format("{} reads {:.6g} in every row{}", name,
                         run.log.first_value[static_cast<std::size_t>(f.sensor)],
                         f.value > 0.0 ? " that has a number" : "");
    case Code::temperature_column_gaps: return gap_words(f, column, run.without_temperature);
    default:
      return fmt::format(
          "`{}` (roll_group) is empty or -1 at all {}, so the groups with a common inclination are unknown: "
          "number the groups from 0, or remove `roll_group` from the array file",
          column, count_text(run.stations.size(), "station"));
  }
}

std::string temperature_unit_words(const CalibrationRun& run, const io::ArrayFile& array) {
  const std::optional<Finding> f = findings::temperature_unit(run, array);
  if (!f) return "";
  const std::string name =
      fmt::format("`{}` reads {:.4g} to {:.4g}", array.input.temperature_column, f->value, f->limit);
  const std::string claims = fmt::format("{}, and the array file claims {:.4g} to {:.4g} degC", name,
                                         array.monitor.temperature_min_degc, array.monitor.temperature_max_degc);
  const char* const kelvin = ": is it in kelvin? The column must be in degC, subtract 273.15";
  switch (f->code) {
    case Code::claimed_temperature_in_kelvin: return claims + kelvin;
    case Code::claimed_temperature_in_fahrenheit:
      return claims + ": is it in degF? The column must be in degC, (T - 32) / 1.8";
    case Code::claimed_temperature_in_another_unit: return claims + ": is it in another unit than degC?";
    default: return name + kelvin;
  }
}

std::string unit_words(const io::ArrayFile& array, double factor) {
  const findings::UnitGuess guess = findings::likely_unit(array, factor);
  switch (guess.kind) {
    case findings::UnitGuess::Kind::unit: return std::string(": they look like ") + guess.unit;
    case findings::UnitGuess::Kind::counts: return ": are they counts of a converter?";
    case findings::UnitGuess::Kind::volts: return ": are they volts?";
    case findings::UnitGuess::Kind::none: break;
  }
  return "";
}

std::string log_words(const Finding& f, const io::ArrayFile& array) {
  switch (f.code) {
    case Code::log_too_short:
      return fmt::format(
          "the log has {}; a station needs at least {} at rest. If the rows are means of "
          "attitudes, set rows = \"stations\"",
          count_text(f.value, "row"), f.limit);
    case Code::vector_length_wrong:
      return fmt::format(
          "`unit` and `scale`: the vector is {:.3g} times as long as gravity (median), so the numbers "
          "of the log are not in the unit or not of the scale that the array file states{}",
          f.value, unit_words(array, f.value));
    case Code::row_step_beyond_gap:
      return fmt::format(
          "`time`: rows are {:.3g} s apart and `max_gap` is {:.3g} s, so every row starts a new block. Is the time "
          "column in milliseconds or samples? Name its unit, or give `rate`; if the rows are means of attitudes, set "
          "rows = \"stations\"",
          f.value, f.limit);
    case Code::noise_at_rest:
      return fmt::format(
          "`noise`: even in the quietest tenth of the log {} scatters by {:.3g} mg0, {:.3g} times the {:.3g} mg0 "
          "declared{}. If the tool was at rest then, declare the noise as it is; {}",
          id_of(array, f.sensor), in_fine(array, f.value), f.value / f.limit, in_fine(array, f.limit),
          f.other > 1 ? fmt::format(" ({} of {} exceed theirs)", f.other, count_text(array.array.size(), "sensor"))
                      : "",
          measure_noise_words(array));
    default:
      return "noise, unit and time column look as declared, so the tool did not rest: hold it still for 10 s at each "
             "attitude, and check that `station` tags do not change from row to row";
  }
}

std::string remark_words(const Finding& f, const CalibrationRun& run, const io::ArrayFile& array) {
  switch (f.code) {
    case Code::few_attitudes:
      return fmt::format("{}; at least 9 are needed, 12 or more to test the fit", count_text(f.value, "attitude"));
    case Code::sensor_absent:
      return fmt::format("{} was noisy or absent at {} of {}", id_of(array, f.sensor), f.value,
                         count_text(f.limit, "station"));
    case Code::range_above_not_covered:
      return fmt::format("no station with {} above {} (highest {})", id_of(array, f.sensor), range_words(f.limit),
                         range_words(f.value));
    case Code::range_below_not_covered:
      return fmt::format("no station with {} below {} (lowest {})", id_of(array, f.sensor), range_words(f.limit),
                         range_words(f.value));
    default: return inclination_remark(f, run.study.coverage);
  }
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
