#include "temperature_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr double kMicroG0_mps2 = 1e-6 * kG0_mps2;
constexpr std::size_t kNamedTerms = 4;
constexpr std::size_t kNamedDirections = 6;
constexpr std::size_t kNamedLevels = 5;
/// Told where the condition is above the one and the span of use wider than what was recorded by the other.
constexpr double kExtrapolated = 100.0;
constexpr double kWider = 1.2;
/// Told where the temperature is so nearly a linear function of one component of the direction, over enough stations.
constexpr double kFollows = 0.99;
constexpr double kFollowStations = 6.0;

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

bool number(const std::string& text, std::size_t begin, std::size_t end, double& value) {
  const auto read = std::from_chars(text.data() + begin, text.data() + end, value);
  return read.ec == std::errc{} && read.ptr == text.data() + end && std::isfinite(value);
}

std::string levels_words(const TemperatureLevels& levels) {
  if (static_cast<std::size_t>(levels.count) > kNamedLevels) {
    const auto [least, most] = std::minmax_element(levels.stations.begin(), levels.stations.begin() + levels.count);
    return fmt::format("{}, from {:.3g} to {:.3g} degC, {}{} stations at each", levels.count, levels.lowest_degc,
                       levels.highest_degc, *least, *most > *least ? fmt::format(" to {}", *most) : "");
  }
  std::vector<std::string> each;
  for (int k = 0; k < levels.count; ++k) {
    const auto a = static_cast<std::size_t>(k);
    each.push_back(fmt::format("{:.3g} degC ({} station{})", levels.degc[a], levels.stations[a],
                               levels.stations[a] == 1 ? "" : "s"));
  }
  return listed(each);
}

std::string forecast_words(const TemperatureReport& t, const io::ArrayFile& array) {
  std::string out;
  for (const TemperatureForecast& f : t.forecast) {
    out += fmt::format("{}{:.3g} degC: {:.3g} mg0 ({}), direction {:.2g} deg", out.empty() ? "at " : "; at ", f.degc,
                       1e3 * g0_from_mps2(f.reading_mps2), id_of(array, f.sensor), deg_from_rad(f.tilt_rad));
  }
  return out + "; 1 sigma";
}

}  // namespace

std::string read_temperature_order(const std::string& text, int& order) {
  order = kAutomaticOrder;
  if (text == "auto") return "";
  if (text.size() == 1 && text[0] >= '0' && text[0] <= '0' + kMaxTemperatureOrder) {
    order = text[0] - '0';
    return "";
  }
  return "\"" + text + "\" is neither `auto` nor an order from 0 to 3";
}

std::string read_use_range(const std::string& text, ChebyshevSpan& use_degc) {
  const std::size_t comma = text.find(',');
  ChebyshevSpan read;
  const std::size_t second = comma == std::string::npos ? comma : text.find_first_not_of(' ', comma + 1);
  if (second == std::string::npos || !number(text, 0, comma, read.lowest) ||
      !number(text, second, text.size(), read.highest)) {
    return "\"" + text + "\" is not two temperatures in degC: write for example 20,150";
  }
  if (read.lowest < kPlausibleMin_degc || read.highest > kPlausibleMax_degc) {
    return fmt::format("\"{}\" reaches beyond {:g} to {:g} degC, where no accelerometer is used; is it in degC?", text,
                       kPlausibleMin_degc, kPlausibleMax_degc);
  }
  if (!(read.lowest < read.highest)) return "\"" + text + "\" does not rise: write the lower temperature first";
  if (!(read.highest - read.lowest >= kLevelsApart_degc))
    return fmt::format("\"{}\" must rise by {:g} degC or more", text, kLevelsApart_degc);
  use_degc = read;
  return "";
}

std::string degc_words(const double* degc, int count) {
  std::vector<std::string> each;
  for (int k = 0; k < count; ++k) each.push_back(fmt::format("{:.3g}", degc[k]));
  return listed(each) + " degC";
}

std::vector<std::string> temperature_unobservable(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  const TemperatureReport& t = run.temperature;
  if (t.order == 0 || t.null_directions == 0) return out;
  if (run.refusal.code == Errc::too_few_levels) {
    out.push_back(fmt::format("scale and bias of every sensor of order {}{}: {} values, for {} level{} of temperature",
                              t.levels.count, t.levels.count < t.order ? fmt::format(" to {}", t.order) : "",
                              t.null_directions, t.levels.count, t.levels.count == 1 ? "" : "s"));
    return out;
  }
  const auto kept = static_cast<std::size_t>(std::min(t.null_directions, kMaxNullDirections));
  for (std::size_t k = 0; k < std::min(kept, kNamedDirections); ++k) out.push_back(null_words(t.null[k], array));
  const auto all = static_cast<std::size_t>(t.null_directions);
  if (all > out.size()) out.push_back(fmt::format("{} more", all - out.size()));
  return out;
}

std::optional<Refusal> temperature_refusal(const CalibrationRun& run) {
  const TemperatureReport& t = run.temperature;
  if (run.refusal.code == Errc::too_few_levels) {
    const std::string lower =
        t.levels.count > 1 ? fmt::format("--temperature-order {}", t.levels.count - 1) : "--temperature-order 0";
    return Refusal{
        fmt::format("scale and bias of order {} need {} temperature levels of {:g} degC; these stations have "
                    "{} ({})",
                    t.order, t.order + 1, kLevelsApart_degc, t.levels.count,
                    degc_words(t.levels.degc.data(), t.levels.count)),
        "add stations near " + degc_words(t.missing_degc.data(), t.missing) +
            ", with six attitudes or more at each; or fit what there is with " + lower};
  }
  if (run.refusal.code == Errc::out_of_range && run.refusal.index == 5 && t.rolls) {
    return Refusal{fmt::format("roll groups and a drift of order {:g} are not estimated together", run.refusal.value),
                   "give --temperature-order 0, or leave `roll_group` out of the array file"};
  }
  if (run.refusal.code != Errc::unobservable || t.order == 0) return {};
  if (t.follows_inclination) {
    return Refusal{
        fmt::format(
            "the temperature of the stations follows their inclination, so that drift and attitude cannot be "
            "told apart: {} of the {} parameters that must be are determined (the report names what is missing)",
            run.refusal.value, run.refusal.limit),
        "record some of the attitudes again, hotter or colder by 30 degC or more; or give --temperature-order auto"};
  }
  return Refusal{
      fmt::format("the stations determine {} of the {} parameters that scales and biases of order {} ask for (the "
                  "report names what is missing)",
                  run.refusal.value, run.refusal.limit, t.order),
      "record six attitudes or more at every temperature level, nine or more at one; or give --temperature-order auto"};
}

std::vector<TemperatureFact> temperature_facts(const CalibrationRun& run, const io::ArrayFile& array) {
  const TemperatureReport& t = run.temperature;
  std::vector<TemperatureFact> out;
  if (t.levels.count < 2 && t.order == 0) return out;
  out.push_back({"levels", levels_words(t.levels)});
  if (t.order == 0) {
    out.push_back({"order", t.rolls ? "0: roll groups and drift are not estimated together"
                                    : "0: the coefficients of the array file hold, none was estimated"});
  } else {
    out.push_back({"order", fmt::format("{}, scale and bias of every sensor; {} of {} parameters seen by the data",
                                        t.order, t.rank, t.parameters)});
    out.push_back({"range of use", fmt::format("{:.3g} to {:.3g} degC", t.use_degc.lowest, t.use_degc.highest)});
    const double seen = t.levels.highest_degc - t.levels.lowest_degc, spare = (kWider - 1.0) * seen;
    const bool beyond =
        t.use_degc.highest > t.levels.highest_degc + spare || t.use_degc.lowest < t.levels.lowest_degc - spare;
    if (t.null_directions == 0 && t.condition > kExtrapolated && beyond) {
      out.push_back({"extrapolated",
                     "the range of use reaches far beyond what was recorded: where no station is, the "
                     "`prior` of the array file speaks"});
    }
    if (run.accepted) out.push_back({"expected error", forecast_words(t, array)});
  }
  if (t.follows_inclination)
    out.push_back({"", "the temperature follows the inclination: record some attitudes again at another temperature"});
  if (const FollowedDirection f = followed_direction(run); f.axis != 0) {
    out.push_back({"", fmt::format("the temperature follows the {} direction of gravity (correlation {:.3f}), so that "
                                   "drift and attitude are hardly told apart: record some attitudes again at another "
                                   "temperature",
                                   f.axis, f.correlation)});
  }
  if (t.follows_time && t.order > 0) {
    out.push_back({"drift in time",
                   fmt::format("cannot be told from drift with temperature, which went one way from the first station "
                               "to the last: record some attitudes again near {:.3g} degC, after the others",
                               run.stations.front().temperature_degc)});
  }
  if (run.accepted && t.missing > 0) {
    out.push_back({"a higher order", fmt::format("needs {} more level{}: near {}", t.missing, t.missing == 1 ? "" : "s",
                                                 degc_words(t.missing_degc.data(), t.missing))});
  }
  return out;
}

FollowedDirection followed_direction(const CalibrationRun& run) {
  FollowedDirection out;
  if (run.temperature.order < 1) return out;
  for (std::size_t p = 0; p < 3; ++p) {
    double n = 0.0, x = 0.0, t = 0.0, xx = 0.0, tt = 0.0, xt = 0.0;
    for (std::size_t k = 0; k < run.stations.size(); ++k) {
      const Vec3& u = run.study.attitudes[k].direction;
      if (!(norm(u) > 0.0)) continue;
      const double degc = run.stations[k].temperature_degc - run.stations.front().temperature_degc;
      n += 1.0;
      x += u[p];
      t += degc;
      xx += u[p] * u[p];
      tt += degc * degc;
      xt += u[p] * degc;
    }
    const double spread = std::sqrt((n * xx - x * x) * (n * tt - t * t));
    const double r = n >= kFollowStations && spread > 0.0 ? (n * xt - x * t) / spread : 0.0;
    if (std::fabs(r) > std::fmax(kFollows, std::fabs(out.correlation))) out = {"xyz"[p], r};
  }
  return out;
}

std::string temperature_table(const CalibrationRun& run, const io::ArrayFile& array) {
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

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
