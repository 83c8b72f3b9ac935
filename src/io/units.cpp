#include "plumb/io/units.hpp"

#include <charconv>
#include <cmath>
#include <vector>

#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

struct Unit {
  const char* name;
  double si;  ///< SI per unit
};

using Units = std::vector<Unit>;

const Units& vector_units(FieldKind field) {
  static const Units acceleration = {{"m/s^2", 1.0},
                                     {"mm/s^2", 1e-3},
                                     {"g0", kG0_mps2},
                                     {"mg0", kG0_mps2 * 1e-3},
                                     {"ug0", kG0_mps2 * 1e-6},
                                     {"mg", kG0_mps2 * 1e-3},
                                     {"ug", kG0_mps2 * 1e-6},
                                     {"g98", 9.8},
                                     {"Gal", 1e-2},
                                     {"mGal", 1e-5},
                                     {"ft/s^2", 0.3048}};
  static const Units magnetic = {{"uT", kInside_per_ut},          {"nT", kInside_per_ut * 1e-3},
                                 {"mT", kInside_per_ut * 1e3},    {"T", kInside_per_ut * 1e6},
                                 {"G", kInside_per_ut * 100},     {"mG", kInside_per_ut * 0.1},
                                 {"gamma", kInside_per_ut * 1e-3}};
  static const Units rate = {
      {"deg/s", kPi / 180.0}, {"dps", kPi / 180.0}, {"rad/s", 1.0}, {"mrad/s", 1e-3}, {"deg/h", kPi / 648000.0}};
  switch (field) {
    case FieldKind::gravity: return acceleration;
    case FieldKind::magnetic: return magnetic;
    case FieldKind::rate: return rate;
  }
  return acceleration;
}

const Units& units_of(Quantity quantity, FieldKind field) {
  static const Units angle = {{"deg", kPi / 180.0}, {"rad", 1.0}, {"mrad", 1e-3}, {"arcmin", kPi / 10800.0}};
  static const Units time = {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"min", 60.0}, {"h", 3600.0}};
  static const Units rate = {{"Hz", 1.0}, {"kHz", 1e3}};
  static const Units temperature = {{"degC", 1.0}};
  static const Units length = {{"m", 1.0}, {"km", 1e3}, {"ft", 0.3048}};
  static const Units density = {{"kg/m^3", 1.0}, {"g/cm^3", 1e3}};
  static const Units ratio = {{"%", 1e-2}, {"ppm", 1e-6}, {"", 1.0}};
  switch (quantity) {
    case Quantity::acceleration: return vector_units(field);
    case Quantity::angle: return angle;
    case Quantity::time: return time;
    case Quantity::rate: return rate;
    case Quantity::temperature: return temperature;
    case Quantity::length: return length;
    case Quantity::density: return density;
    case Quantity::ratio: break;
  }
  return ratio;
}

const Units& raw_units() {
  static const Units units = {{"V", 1.0}, {"mV", 1e-3}, {"uV", 1e-6}, {"count", 1.0}};
  return units;
}

const Unit* find(const Units& units, std::string_view name) {
  for (const Unit& unit : units) {
    if (name == unit.name) return &unit;
  }
  return nullptr;
}

std::vector<std::string> names_of(const Units& units) {
  std::vector<std::string> names;
  for (const Unit& unit : units) {
    if (*unit.name != '\0') names.emplace_back(unit.name);
  }
  return names;
}

tl::unexpected<FileError> refuse(std::string what, std::string remedy) {
  FileError error;
  error.what = std::move(what);
  error.remedy = std::move(remedy);
  return tl::unexpected<FileError>(std::move(error));
}

tl::unexpected<FileError> refuse_bare_g(std::string_view text) {
  return refuse(in_quotes(text) + ": a bare \"g\" is ambiguous", "name g0 (= 9.80665 m/s^2) or g98 (= 9.8 m/s^2)");
}

/// Why `unit` is none of `names`; `text` is the whole value.
tl::unexpected<FileError> refuse_unit(std::string_view text, std::string_view unit,
                                      const std::vector<std::string>& names) {
  if (unit == "g") return refuse_bare_g(text);
  if (unit.empty())
    return refuse(in_quotes(text) + ": the unit is missing",
                  "write the unit after the number, one of: " + joined(names));
  return refuse(in_quotes(text) + ": unit " + in_quotes(unit) + " is not a known unit here",
                did_you_mean(unit, names) + "accepted: " + joined(names));
}

struct Split {
  double number = 0.0;
  std::string_view unit;
};

FileExpected<Split> split(std::string_view text) {
  std::string_view rest = trimmed(text);
  if (!rest.empty() && rest.front() == '+') rest.remove_prefix(1);
  Split out;
  const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), out.number);
  if (status == std::errc::result_out_of_range) {
    return refuse(in_quotes(text) + ": the number is too large or too small", "write a number that fits a double");
  }
  if (status != std::errc())
    return refuse(in_quotes(text) + " is not a number with a unit",
                  "write a number, a blank and a unit, as in \"12 mg\"");
  if (!std::isfinite(out.number))
    return refuse(in_quotes(text) + ": the number is not finite", "write a finite number");
  out.unit = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  return out;
}

/// A product of number and unit, which may leave the range of a double.
FileExpected<double> finite(std::string_view text, double value) {
  if (std::isfinite(value)) return value;
  return refuse(in_quotes(text) + ": the number is too large", "write a number that fits a double");
}

std::string_view without_brackets(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '(' && text.back() == ')') return trimmed(text.substr(1, text.size() - 2));
  return text;
}

/// A raw unit by its name, accelerations included.
bool find_raw(std::string_view name, FieldKind field, RawUnit& out) {
  if (const Unit* raw = find(raw_units(), name); raw != nullptr) {
    out = {name == "count" ? RawUnit::Kind::count : RawUnit::Kind::voltage, raw->si, raw->name, field};
    return true;
  }
  if (const Unit* vector = find(vector_units(field), name); vector != nullptr) {
    out = {RawUnit::Kind::acceleration, vector->si, vector->name, field};
    return true;
  }
  return false;
}

std::vector<std::string> raw_names(FieldKind field) {
  std::vector<std::string> names = names_of(raw_units());
  for (const std::string& name : names_of(vector_units(field))) names.push_back(name);
  return names;
}

tl::unexpected<FileError> refuse_kind(std::string_view text, const RawUnit& given, const RawUnit& log_unit) {
  return refuse(in_quotes(text) + " is in " + given.name + ", but the log is in " + log_unit.name,
                "give it in a unit that converts to " + log_unit.name + ", or correct [input] unit");
}

}  // namespace

const char* to_string(Quantity quantity) noexcept {
  switch (quantity) {
    case Quantity::acceleration: return "acceleration";
    case Quantity::angle: return "angle";
    case Quantity::time: return "time";
    case Quantity::rate: return "rate";
    case Quantity::temperature: return "temperature";
    case Quantity::length: return "length";
    case Quantity::density: return "density";
    case Quantity::ratio: return "ratio";
  }
  return "?";
}

std::string accepted_units(Quantity quantity, FieldKind field) {
  return joined(names_of(units_of(quantity, field))) + (quantity == Quantity::ratio ? ", or a plain number" : "");
}

std::string accepted_raw_units(FieldKind field) { return joined(raw_names(field)); }

FileExpected<double> parse_quantity(Quantity quantity, std::string_view text, FieldKind field) {
  const FileExpected<Split> parts = split(text);
  if (!parts) return tl::unexpected<FileError>(parts.error());
  const Unit* unit = find(units_of(quantity, field), parts->unit);
  if (unit == nullptr) return refuse_unit(text, parts->unit, names_of(units_of(quantity, field)));
  return finite(text, parts->number * unit->si);
}

FileExpected<std::string> format_quantity(Quantity quantity, double si, std::string_view unit_name) {
  const Unit* unit = find(units_of(quantity, FieldKind::gravity), unit_name);
  if (unit == nullptr) return refuse_unit(shortest(si), unit_name, names_of(units_of(quantity, FieldKind::gravity)));
  std::string out = shortest(si / unit->si);
  if (!unit_name.empty()) out.append(" ").append(unit_name);
  return out;
}

FileExpected<RawUnit> parse_raw_unit(std::string_view text, FieldKind field) {
  RawUnit unit;
  if (find_raw(without_brackets(text), field, unit)) return unit;
  return refuse_unit(text, trimmed(text), raw_names(field));
}

FileExpected<double> parse_scale(std::string_view text, const RawUnit& log_unit) {
  const FileExpected<Split> parts = split(text);
  if (!parts) return tl::unexpected<FileError>(parts.error());
  if (parts->number == 0.0)
    return refuse(in_quotes(text) + ": the scale must not be zero", "give the scale of the datasheet");
  const std::string_view unit = parts->unit;
  if (unit.empty()) {
    if (log_unit.kind == RawUnit::Kind::acceleration) return parts->number / log_unit.base_per_unit;
    return refuse(in_quotes(text) + ": the unit is missing",
                  log_unit.field == FieldKind::gravity
                      ? "give the output per g0 or per m/s^2, for example \"3 V/g0\" or \"415 count/(m/s^2)\""
                      : std::string("give the output per ") + units_of(log_unit.field).coarse + ", for example " +
                            units_of(log_unit.field).scale_examples);
  }
  // Brackets may be omitted ("415 count/m/s^2"): the slash that has a known unit on both sides divides.
  for (std::size_t at = unit.find('/'); at != std::string_view::npos; at = unit.find('/', at + 1)) {
    RawUnit raw;
    const Unit* per = find(vector_units(log_unit.field), without_brackets(unit.substr(at + 1)));
    if (per == nullptr || !find_raw(without_brackets(unit.substr(0, at)), log_unit.field, raw)) continue;
    if (raw.kind != log_unit.kind) return refuse_kind(text, raw, log_unit);
    return finite(text, parts->number * (raw.base_per_unit / log_unit.base_per_unit) / per->si);
  }
  const std::size_t last = unit.rfind('/');
  if (last != std::string_view::npos && without_brackets(unit.substr(last + 1)) == "g") return refuse_bare_g(text);
  const bool gravity = log_unit.field == FieldKind::gravity;
  return refuse(in_quotes(text) + ": unit " + in_quotes(unit) + " is not \"<raw unit>/<" +
                    (gravity ? "acceleration" : to_string(log_unit.field)) + ">\"",
                std::string("write for example ") +
                    (gravity ? "\"3 V/g0\", \"2048 count/g0\" or \"415 count/(m/s^2)\""
                             : units_of(log_unit.field).scale_examples) +
                    "; raw units: " + joined(names_of(raw_units())) + (gravity ? "; accelerations: " : "; others: ") +
                    accepted_units(Quantity::acceleration, log_unit.field));
}

FileExpected<double> parse_as_acceleration(std::string_view text, const RawUnit& log_unit, double scale) {
  const FileExpected<Split> parts = split(text);
  if (!parts) return tl::unexpected<FileError>(parts.error());
  RawUnit given;
  if (!find_raw(parts->unit, log_unit.field, given)) return refuse_unit(text, parts->unit, raw_names(log_unit.field));
  if (given.kind == RawUnit::Kind::acceleration) return finite(text, parts->number * given.base_per_unit);
  if (given.kind != log_unit.kind) return refuse_kind(text, given, log_unit);
  return finite(text, parts->number * (given.base_per_unit / log_unit.base_per_unit) / scale);
}

FileExpected<double> parse_as_raw(std::string_view text, const RawUnit& log_unit, double scale) {
  const FileExpected<Split> parts = split(text);
  if (!parts) return tl::unexpected<FileError>(parts.error());
  RawUnit given;
  if (!find_raw(parts->unit, log_unit.field, given)) return refuse_unit(text, parts->unit, raw_names(log_unit.field));
  if (given.kind == RawUnit::Kind::acceleration) return finite(text, parts->number * given.base_per_unit * scale);
  if (given.kind != log_unit.kind) return refuse_kind(text, given, log_unit);
  return finite(text, parts->number * (given.base_per_unit / log_unit.base_per_unit));
}

FileExpected<double> parse_temperature_slope(Quantity quantity, std::string_view text, int order, FieldKind field) {
  const std::string per = order == 1 ? "/degC" : "/degC^" + std::to_string(order);
  const std::string example = (quantity == Quantity::ratio   ? "ppm"
                               : field == FieldKind::gravity ? "mg"
                                                             : units_of(field).fine) +
                              per;
  std::string_view whole = trimmed(text);
  const std::size_t slash = whole.rfind('/');
  const bool fits = slash != std::string_view::npos && trimmed(whole.substr(slash)) == per;
  if (!fits) {
    return refuse(in_quotes(text) + ": coefficient number " + std::to_string(order) + " must be per " + per.substr(1),
                  "write for example \"0.1 " + example + "\"; the list runs from /degC to /degC^3");
  }
  return parse_quantity(quantity, whole.substr(0, slash), field);
}

void append_shortest(std::string& out, double value) {
  if (!std::isfinite(value)) {
    out += std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
    return;
  }
  char text[32];
  const auto result = std::to_chars(text, text + sizeof text, value);
  out.append(text, result.ptr);
}

std::string shortest(double value) {
  std::string out;
  append_shortest(out, value);
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
