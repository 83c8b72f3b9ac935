#include "quantity_text.hpp"

#include <charconv>
#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

tl::unexpected<std::string> refuse(std::string why) { return tl::unexpected<std::string>(std::move(why)); }

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::string names_of(const TextUnits& units) {
  std::string names;
  for (const TextUnit& unit : units) {
    // The first unit may stand in the list a second time (the log's own unit is an ordinary one too).
    if (!names.empty() && unit.name == units.front().name) continue;
    names += (names.empty() ? "" : ", ") + unit.name;
  }
  return names;
}

}  // namespace

const TextUnits& acceleration_units(FaultContext::Vector of) {
  static const TextUnits units = {{"m/s^2", 1.0},
                                  {"mg0", kG0_mps2 * 1e-3},
                                  {"g0", kG0_mps2},
                                  {"ug0", kG0_mps2 * 1e-6},
                                  {"mm/s^2", 1e-3, false},
                                  {"mg", kG0_mps2 * 1e-3, false},
                                  {"ug", kG0_mps2 * 1e-6, false},
                                  {"g98", 9.8, false},
                                  {"Gal", 1e-2, false},
                                  {"mGal", 1e-5, false},
                                  {"ft/s^2", 0.3048, false}};
  constexpr double kUt = 0.25;
  static const TextUnits magnetic = {{"uT", kUt},
                                     {"nT", kUt * 1e-3},
                                     {"mT", kUt * 1e3, false},
                                     {"T", kUt * 1e6, false},
                                     {"G", kUt * 100.0, false},
                                     {"mG", kUt * 0.1, false},
                                     {"gamma", kUt * 1e-3, false}};
  static const TextUnits rate = {{"rad/s", 1.0},
                                 {"deg/s", kPi / 180.0},
                                 {"dps", kPi / 180.0, false},
                                 {"mrad/s", 1e-3, false},
                                 {"deg/h", kPi / 648000.0, false}};
  switch (of) {
    case FaultContext::Vector::gravity: return units;
    case FaultContext::Vector::magnetic: return magnetic;
    case FaultContext::Vector::rate: return rate;
  }
  return units;
}

const TextUnits& time_units() {
  static const TextUnits units = {
      {"s", 1.0}, {"ms", 1e-3, false}, {"us", 1e-6, false}, {"min", 60.0, false}, {"h", 3600.0, false}};
  return units;
}

const TextUnits& angle_units() {
  static const TextUnits units = {{"rad", 1.0}, {"deg", kPi / 180.0}, {"mrad", 1e-3, false}};
  return units;
}

const TextUnits& share_units() {
  static const TextUnits units = {{"", 1.0}, {"%", 0.01}, {"ppm", 1e-6, false}};
  return units;
}

TextUnits drift_units(FaultContext::Vector of) {
  TextUnits units;
  for (const TextUnit& per : time_units()) {
    if (per.factor < 1.0) continue;
    for (const TextUnit& unit : acceleration_units(of)) {
      units.push_back({unit.name + "/" + per.name, unit.factor / per.factor, unit.print});
    }
  }
  return units;
}

tl::expected<NumberText, std::string> read_number(std::string_view text) {
  std::string_view digits = trimmed(text);
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    return refuse(quoted(text) + " is too large or too small for a number. Remedy: use another unit");
  }
  if (error != std::errc() || !std::isfinite(value)) {
    return refuse(quoted(text) + " does not begin with a number. Remedy: write a finite number and its unit");
  }
  digits.remove_prefix(static_cast<std::size_t>(end - digits.data()));
  return NumberText{value, trimmed(digits)};
}

tl::expected<double, std::string> read_quantity(std::string_view text, const TextUnits& units, const char* what) {
  const auto number = read_number(text);
  if (!number) return tl::unexpected<std::string>(number.error());
  for (const TextUnit& unit : units) {
    if (number->rest == unit.name) return number->value * unit.factor;
  }
  const std::string needed = ". Remedy: write the " + std::string(what) + " in one of " + names_of(units);
  if (number->rest.empty()) return refuse(quoted(text) + " has no unit" + needed);
  if (number->rest == "g" || number->rest.substr(0, 2) == "g/") {
    return refuse("'g' is ambiguous in " + quoted(text) + ": g0 is 9.80665 m/s^2, g98 is 9.8 m/s^2" + needed);
  }
  return refuse("unknown unit " + quoted(number->rest) + " in " + quoted(text) + needed);
}

std::string shortest_text(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc() ? std::string(buffer, end) : std::string("nan");
}

std::string quantity_text(double value, const TextUnits& units, const char* gap) {
  std::string best;
  for (const TextUnit& unit : units) {
    if (!unit.print) continue;
    const double number = value / unit.factor;
    if (!std::isfinite(number) || number * unit.factor != value) continue;
    const std::string text = shortest_text(number) + gap + unit.name;
    if (best.empty() || text.size() < best.size()) best = text;
  }
  return best;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
