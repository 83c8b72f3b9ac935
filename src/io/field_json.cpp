#include "plumb/io/field_json.hpp"

#include <array>
#include <string_view>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

struct Suffix {
  std::string_view of_gravity, of_field;
  double factor;
};

/// A name that holds a figure: 0.2 mg0 inside are 7.85 nT.
constexpr std::string_view kUsualStability = "stability_0_2_mg0";

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

Json scaled_by(const Json& value, double factor) {  // NOLINT(misc-no-recursion) as deep as its lists
  if (value.is_number()) return factor * value.get<double>();
  Json out = value;
  if (value.is_structured()) {
    for (Json& one : out) one = scaled_by(one, factor);
  }
  return out;
}

constexpr double kNt = 1e3 / kInside_per_ut;
/// The longer ones first.
constexpr std::array<Suffix, 6> kMagnetic = {{{"_per_mps2", "_per_nt", 1.0 / kNt},
                                              {"_mps2_per_h", "_nt_per_h", kNt},
                                              {"_mps2_2", "_nt_2", kNt* kNt},
                                              {"_mps2", "_nt", kNt},
                                              {"_mg0", "_nt", 1e-3 * kG0_mps2* kNt},
                                              {"_per_g0", "_per_ut", kInside_per_ut / kG0_mps2}}};

Json of_magnetic(const Json& value) {  // NOLINT(misc-no-recursion) as deep as the result
  if (value.is_array()) {
    Json out = Json::array();
    for (const Json& one : value) out.push_back(of_magnetic(one));
    return out;
  }
  if (!value.is_object()) return value;
  Json out = Json::object();
  for (const auto& [old, one] : value.items()) {
    std::string key = old;
    if (const std::size_t at = key.find("gravity"); at != std::string::npos) key.replace(at, 7, "field");
    if (const std::size_t at = key.find("acceleration"); at != std::string::npos) key.replace(at, 12, "disturbance");
    double factor = 0.0;
    if (key == kUsualStability) key = "stability_7_85_nt";
    for (const Suffix& suffix : kMagnetic) {
      if (!ends_with(key, suffix.of_gravity)) continue;
      key.replace(key.size() - suffix.of_gravity.size(), std::string::npos, suffix.of_field);
      factor = suffix.factor;
      break;
    }
    out[key] = factor > 0.0 ? scaled_by(one, factor) : of_magnetic(one);
  }
  return out;
}

/// The same keys. What a page shows in m/s^2, lengths of the vector and scales, is multiplied by `coarse`; what it
/// shows in mg0 by `fine`.
Json stretched(const Json& value, double fine, double coarse) {  // NOLINT(misc-no-recursion) as deep as the result
  if (!value.is_structured()) return value;
  Json out = value;
  for (auto item = out.begin(); item != out.end(); ++item) {
    double by = 0.0;
    if (value.is_object()) {
      const std::string& key = item.key();
      by = key == "g_mps2"                                                                      ? coarse
           : ends_with(key, "_per_mps2")                                                        ? 1.0 / coarse
           : ends_with(key, "_mps2_2")                                                          ? fine * fine
           : ends_with(key, "_mps2") || ends_with(key, "_mps2_per_h") || ends_with(key, "_mg0") ? fine
                                                                                                : 0.0;
    }
    *item = by > 0.0 ? scaled_by(*item, by) : stretched(*item, fine, coarse);
  }
  return out;
}

}  // namespace

Json in_field_units(const Json& value, FieldKind field) {
  return field == FieldKind::magnetic ? of_magnetic(value) : value;
}

std::string in_field_units(const std::string& line, FieldKind field) {
  if (field != FieldKind::magnetic) return line;
  const bool newline = !line.empty() && line.back() == '\n';
  return of_magnetic(parsed(line)).dump() + (newline ? "\n" : "");
}

Json with_fine_as_mg0(const Json& value, FieldKind field) {
  if (field == FieldKind::gravity) return value;
  const FieldUnits &of = units_of(field), &gravity = units_of(FieldKind::gravity);
  return stretched(value, of.fine_per_inside / gravity.fine_per_inside, of.coarse_per_inside);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
