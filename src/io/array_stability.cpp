// How far a sensor may drift after its calibration: the same keys in [monitor], for all, and in [[sensor]].
#include "array_parts.hpp"
#include "text_tools.hpp"
#include "toml_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

struct StabilityKey {
  const char* key;
  const char* per;  ///< what may stand after the unit, and need not: the key says it too
  double Stability::*figure;
};

constexpr std::array<StabilityKey, 4> kKeys = {
    {{"stability", "", &Stability::mps2},
     {"stability_per_day", "/day", &Stability::per_day_mps2},
     {"stability_per_degc", "/degC", &Stability::per_degc_mps2},
     {"stability_per_degc_per_min", "/degC/min", &Stability::per_degc_per_min_mps2}}};

double read_figure(const TomlTable& table, const StabilityKey& key, double fallback) {
  const TomlNode* value = table.find(key.key);
  if (value == nullptr) return fallback;
  const FieldUnits& units = units_of(table.field_of());
  std::string text = table.text_with_unit(*value, key.key, accepted_units(Quantity::acceleration, table.field_of()));
  const std::string per = key.per;
  if (text.size() > per.size() && text.compare(text.size() - per.size(), per.size(), per) == 0)
    text.resize(text.size() - per.size());
  const double mps2 = table.checked(parse_quantity(Quantity::acceleration, text, table.field_of()), key.key, *value);
  if (mps2 >= 0.0 && mps2 <= kMostStability_mps2) return mps2;
  const bool gravity = table.field_of() == FieldKind::gravity;
  table.fail(value->line, key.key,
             "is " + brief(units.coarse_per_inside * mps2) + " " + units.coarse + per + ", out of range",
             "give the possible error of a reading, 1 sigma, from 0 to " +
                 brief(units.coarse_per_inside * kMostStability_mps2) + " " + units.coarse + ": " + key.key + " = \"" +
                 (gravity ? "0.2 mg" : units.noise_example) + per + "\"");
}

}  // namespace

std::vector<std::string> with_stability_keys(std::vector<std::string> names) {
  for (const StabilityKey& key : kKeys) names.emplace_back(key.key);
  return names;
}

Stability read_stability(const TomlTable& table, const Stability& fallback) {
  Stability out = fallback;
  for (const StabilityKey& key : kKeys) out.*key.figure = read_figure(table, key, fallback.*key.figure);
  return out;
}

std::string stability_toml(const Stability& stability) {
  std::string out;
  for (const StabilityKey& key : kKeys) {
    const double mps2 = stability.*key.figure;
    if (mps2 > 0.0) out += std::string(key.key) + " = \"" + shortest(mps2) + " m/s^2" + key.per + "\"\n";
  }
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
