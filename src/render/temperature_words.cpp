#include "temperature_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit_words.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/fit_remarks.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::Finding;
using Code = findings::FindingCode;

constexpr double kMicroG0_mps2 = 1e-6 * kG0_mps2;
constexpr std::size_t kNamedTerms = 4;
constexpr std::size_t kNamedDirections = 6;
constexpr std::size_t kNamedLevels = 5;

std::string term_words(const TemperatureTerm& term, const io::ArrayFile& array) {
  const char* const orders[] = {"constant", "linear", "quadratic", "cubic"};
  const std::string id = id_of(array, term.sensor);
  if (term.kind == ParameterKind::axis) return "axis of " + id;
  return fmt::format("{} {} of {}", orders[term.order], term.kind == ParameterKind::bias ? "bias" : "scale", id);
}

std::string null_words(const TemperatureNull& null, const io::ArrayFile& array) {
  std::vector<std::string> rest;
  for (int k = 1; k < null.terms && rest.size() < kNamedTerms; ++k)
    rest.push_back(term_words(null.term[static_cast<std::size_t>(k)], array));
  const std::string first = term_words(null.term[0], array);
  return rest.empty() ? first : first + " against " + listed(rest);
}

std::string levels_words(const TemperatureLevels& levels) {
  if (static_cast<std::size_t>(levels.count) > kNamedLevels) {
    const auto [least, most] = std::minmax_element(levels.stations.begin(), levels.stations.begin() + levels.count);
    return fmt::format("{}, from {:.3g} to {:.3g} degC, {}{} at each", levels.count, levels.lowest_degc,
                       levels.highest_degc, *most > *least ? fmt::format("{} to ", *least) : "",
                       count_text(*most, "station"));
  }
  std::vector<std::string> each;
  for (int k = 0; k < levels.count; ++k) {
    const auto a = static_cast<std::size_t>(k);
    each.push_back(fmt::format("{:.3g} degC ({})", levels.degc[a], count_text(levels.stations[a], "station")));
  }
  return listed(each);
}

std::string forecast_words(const TemperatureReport& t, const io::ArrayFile& array) {
  std::string out;
  for (const TemperatureForecast& f : t.forecast) {
    out += fmt::format("{}{:.3g} degC: {:.3g} mg0 ({}), direction {:.2g} deg", out.empty() ? "at " : "; at ", f.degc,
                       in_fine(array, f.reading_mps2), id_of(array, f.sensor), deg_from_rad(f.tilt_rad));
  }
  return out + "; 1 sigma";
}

}  // namespace

std::string degc_words(const double* degc, int count) {
  std::vector<std::string> each;
  for (int k = 0; k < count; ++k) each.push_back(fmt::format("{:.3g}", degc[k]));
  return listed(each) + " degC";
}

std::vector<std::string> temperature_unobservable(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  const TemperatureReport& t = run.temperature;
  if (t.order == 0 || t.null_directions == 0) return out;
  if (run.refusal.code == Errc::too_few_levels) {
    out.push_back(fmt::format("scale and bias of every sensor of order {}{}: {} values, for {}", t.levels.count,
                              t.levels.count < t.order ? fmt::format(" to {}", t.order) : "", t.null_directions,
                              count_text(t.levels.count, "level of temperature", "levels of temperature")));
    return out;
  }
  const auto kept = static_cast<std::size_t>(std::min(t.null_directions, kMaxNullDirections));
  for (std::size_t k = 0; k < std::min(kept, kNamedDirections); ++k) out.push_back(null_words(t.null[k], array));
  const auto all = static_cast<std::size_t>(t.null_directions);
  if (all > out.size()) out.push_back(fmt::format("{} more", all - out.size()));
  return out;
}

std::optional<Refusal> temperature_refusal(const Finding& f, const findings::CalibrationRun& run) {
  const TemperatureReport& t = run.temperature;
  switch (f.code) {
    case Code::too_few_levels: {
      const std::string lower =
          t.levels.count > 1 ? fmt::format("--temperature-order {}", t.levels.count - 1) : "--temperature-order 0";
      return Refusal{fmt::format("scale and bias of order {} need {} of {:g} degC; these stations have "
                                 "{} ({})",
                                 t.order, count_text(f.limit, "temperature level"), kLevelsApart_degc, f.value,
                                 degc_words(t.levels.degc.data(), t.levels.count)),
                     "add stations near " + degc_words(t.missing_degc.data(), t.missing) +
                         ", with six attitudes or more at each; or fit what there is with " + lower};
    }
    case Code::roll_groups_with_drift:
      return Refusal{fmt::format("roll groups and a drift of order {:g} are not estimated together", f.value),
                     "give --temperature-order 0, or leave `roll_group` out of the array file"};
    case Code::temperature_follows_inclination:
      return Refusal{
          fmt::format(
              "the temperature of the stations follows their inclination, so that drift and attitude cannot be "
              "told apart: {} of the {} parameters that must be are determined (the report names what is missing)",
              f.value, f.limit),
          "record some of the attitudes again, hotter or colder by 30 degC or more; or give --temperature-order auto"};
    case Code::undetermined_over_temperature:
      return Refusal{
          fmt::format("the stations determine {} of the {} parameters that scales and biases of order {} ask for (the "
                      "report names what is missing)",
                      f.value, f.limit, t.order),
          "record six attitudes or more at every temperature level, nine or more at one; or give --temperature-order "
          "auto"};
    default: return {};
  }
}

namespace {

/// A remark in the report; empty where its line is reported elsewhere.
std::optional<TemperatureFact> remark_of(const Finding& f, const findings::CalibrationRun& run) {
  switch (f.code) {
    case Code::temperature_follows_inclination:
      return TemperatureFact{
          "", "the temperature follows the inclination: record some attitudes again at another temperature"};
    case Code::temperature_follows_direction:
      return TemperatureFact{
          "",
          fmt::format(
              "the temperature follows the {} direction of gravity (correlation {:.3f}), so that drift and attitude "
              "are hardly separable: record some attitudes again at another temperature",
              static_cast<char>('x' + f.other), f.value)};
    case Code::drift_follows_time:
      return TemperatureFact{
          "drift in time",
          fmt::format(
              "cannot be separated from drift with temperature, which went one way from the first station to the "
              "last: record some attitudes again near {:.3g} degC, after the others",
              run.stations.front().temperature_degc)};
    case Code::higher_order_needs_levels: {
      const TemperatureReport& t = run.temperature;
      return TemperatureFact{"a higher order",
                             fmt::format("needs {} more level{}: near {}", f.value, t.missing == 1 ? "" : "s",
                                         degc_words(t.missing_degc.data(), t.missing))};
    }
    default: return {};
  }
}

}  // namespace

std::vector<TemperatureFact> temperature_facts(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  const TemperatureReport& t = run.temperature;
  std::vector<TemperatureFact> out;
  if (t.levels.count < 2 && t.order == 0) return out;
  const std::vector<Finding> remarks = findings::temperature_remarks(run);
  out.push_back({"levels", levels_words(t.levels)});
  if (t.order == 0) {
    out.push_back({"order", t.rolls ? "0: roll groups and drift are not estimated together"
                                    : "0: the coefficients of the array file hold, none was estimated"});
  } else {
    out.push_back(
        {"order", fmt::format("{}, scale and bias of every sensor; {} of {} parameters determined by the data", t.order,
                              t.rank, t.parameters)});
    out.push_back({"range of use", fmt::format("{:.3g} to {:.3g} degC", t.use_degc.lowest, t.use_degc.highest)});
    if (findings::has(remarks, Code::use_range_not_recorded)) {
      out.push_back({"extrapolated",
                     "the range of use reaches far beyond what was recorded: where there is no station, the `prior` "
                     "of the array file decides"});
    }
    if (run.accepted) out.push_back({"expected error", forecast_words(t, array)});
  }
  for (const Finding& f : remarks) {
    if (const std::optional<TemperatureFact> told = remark_of(f, run)) out.push_back(*told);
  }
  return out;
}

std::string temperature_table(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  const TemperatureReport& t = run.temperature;
  if (t.order == 0 || !run.accepted) return "";
  std::string out = fmt::format("\n  {:<15} {:>8} {:>14} {:>10} {:>5} {:>14} {:>10} {:>5}\n", "sensor", "per", "scale",
                                "sigma", "data", "bias", "sigma", "data");
  out += fmt::format("  {:<15} {:>8} {:>14} {:>10} {:>5} {:>14} {:>10} {:>5}\n", "", "", "ppm", "ppm", "%", "ug0",
                     "ug0", "%");
  for (int i = 0; i < array.array.size(); ++i) {
    const SensorTemperature& s = t.sensor[static_cast<std::size_t>(i)];
    for (std::size_t k = 1; k <= static_cast<std::size_t>(t.order); ++k) {
      const double ppm = 1e6 / s.scale[0].value;
      out +=
          fmt::format("  {:<15} {:>8} {:>14.4g} {:>10.2g} {:>5.0f} {:>14.4g} {:>10.2g} {:>5.0f}\n",
                      k == 1 ? id_of(array, i) : "", k == 1 ? "degC" : fmt::format("degC^{}", k),
                      s.scale[k].value * ppm, s.scale[k].sigma * std::fabs(ppm), 100.0 * s.scale[k].data_share,
                      s.bias[k].value / kMicroG0_mps2, s.bias[k].sigma / kMicroG0_mps2, 100.0 * s.bias[k].data_share);
    }
  }
  return out + "  coefficients of (T - t_ref), (T - t_ref)^2 ...; those of the scale relative to it\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
