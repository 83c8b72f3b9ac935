#include "plumb/render/monitor_limits.hpp"

#include <fmt/format.h>

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/health/stability.hpp"
#include "plumb/io/field_json.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::MonitorLimits;
using findings::TestLimit;

/// In units of the field that the limits are of.
struct Words {
  io::FieldKind field;
  std::string operator()(double inside) const;
};

std::string Words::operator()(double inside) const {
  if (field != io::FieldKind::gravity)
    return fmt::format("{:.3g} {}", io::units_of(field).fine_per_inside * inside, io::units_of(field).fine);
  const double g0 = g0_from_mps2(inside);
  return g0 < 1.0 ? fmt::format("{:.3g} mg", 1e3 * g0) : fmt::format("{:.2f} g0", g0);
}

std::string row(const char* name, const TestLimit& t, bool with_bias, const Words& mg) {
  return fmt::format("{:<28}{:>12}{:>12}{:>12}{:>14}\n", name, mg(t.noise_mps2), mg(t.systematic_mps2),
                     mg(t.noise_mps2 + t.systematic_mps2), with_bias ? mg(t.bias_mps2) : std::string("-"));
}

/// Which stability the limits hold.
std::string drift_line(const MonitorLimits& l, const Words& mg) {
  if (l.untold == l.sensors)
    return "No stability is stated: these limits allow for no drift since the calibration. State it in the array file "
           "(stability).\n";
  return fmt::format(
      "drift since the calibration allowed for: {} in a reading, {:.0f} sigmas of the stability{}\n",
      mg(l.tolerance_mps2), kStabilitySigmas,
      l.untold > 0 ? fmt::format("; none for {} of the sensors, which state none", l.untold) : std::string());
}

nlohmann::ordered_json json_of(const TestLimit& t) {
  return io::object({{"noise_mps2", t.noise_mps2}, {"systematic_mps2", t.systematic_mps2}, {"bias_mps2", t.bias_mps2}});
}

}  // namespace

std::string limits_text(const MonitorLimits& l, io::FieldKind field) {
  const Words mg{field};
  std::string out = fmt::format("{}, blocks of {}; medians over {}\n\n", count_text(l.sensors, "sensor"),
                                count_text(l.window, "sample"), count_text(findings::kSearchedAttitudes, "attitude"));
  out += fmt::format("{:<28}{:>12}{:>12}{:>12}{:>14}\n", "test", "noise", "systematic", "limit", "bias at limit");
  if (l.sensors > 3) out += row("parity", l.parity, true, mg);
  out += row("length of the vector", l.length, true, mg);
  out += row(l.delta_f_mps2 > 0.0 ? "triples (given delta_f)" : "triple, the widest", l.triple, false, mg);
  out +=
      "bias at limit: shows in every second block; what plumb detects and isolates for certain: plumb geometry "
      "--calibration\n";
  out += fmt::format("\nnoise of a sample {}, left by calibration {}\n", mg(l.noise_mps2), mg(l.left_mps2));
  out += drift_line(l, mg);
  if (l.useful_samples > 0.0) {
    const auto enough = static_cast<long>(std::ceil(l.useful_samples * (1.0 - 1e-9)));
    out += fmt::format(
        "What calibration leaves does not average out: blocks beyond {} bring no gain at one attitude{}.\n",
        count_text(enough, "sample"), l.window > enough ? fmt::format(", and these have {}", l.window) : std::string());
  }
  if (l.delta_f_mps2 > 0.0) {
    out += fmt::format(
        "with delta_f = {} the triples miss a bias of {} in some sensor at half of the attitudes, of {} at the worst;\n"
        "such a bias turns the answer by up to {:.2f} deg. {}\n",
        mg(l.delta_f_mps2), mg(l.blind_median_mps2), mg(l.blind_worst_mps2), deg_from_rad(l.blind_tilt_rad),
        l.sensors > 3 ? fmt::format("Parity and length keep their own limits, and parity still detects {}.",
                                    mg(l.parity.bias_mps2))
                      : std::string("With three sensors only the norm test is left, and a mirror fault passes it."));
  }
  return out;
}

std::string limits_json(const MonitorLimits& l, io::FieldKind field) {
  nlohmann::ordered_json out;
  out["sensors"] = l.sensors;
  out["window"] = l.window;
  if (l.sensors > 3) out["parity"] = json_of(l.parity);
  out["length"] = json_of(l.length);
  out["triple"] = io::object({{"noise_mps2", l.triple.noise_mps2}, {"systematic_mps2", l.triple.systematic_mps2}});
  out["noise_mps2"] = l.noise_mps2;
  out["left_by_calibration_mps2"] = l.left_mps2;
  out["drift_tolerance_mps2"] = l.tolerance_mps2;
  out["without_stability"] = l.untold;
  out["useful_samples"] = l.useful_samples > 0.0 ? nlohmann::ordered_json(l.useful_samples) : nullptr;
  if (l.delta_f_mps2 > 0.0) {
    out["delta_f_mps2"] = l.delta_f_mps2;
    out["blind_median_mps2"] = l.blind_median_mps2;
    out["blind_worst_mps2"] = l.blind_worst_mps2;
    out["blind_tilt_deg"] = deg_from_rad(l.blind_tilt_rad);
  }
  return io::in_field_units(io::object({{"limits", std::move(out)}}), field).dump() + "\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
