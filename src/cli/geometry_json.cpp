// What `plumb geometry --json` prints: SI units in the names, null where the geometry has no such figure.
#include <cmath>

#include "figures.hpp"
#include "geometry_study.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

Json ids(SensorSet set, const SensorArray& array) {
  Json list = Json::array();
  for (int i = 0; i < array.size(); ++i) {
    if (set.has(i)) list.push_back(array.row(i).id.data());
  }
  return list;
}

Json sensors_json(const GeometrySubject& subject, const GeometryStudy& study) {
  Json out = Json::array();
  const bool isolable = study.merit.strict_grade > 0;
  for (int i = 0; i < subject.array.size(); ++i) {
    const SensorStudy& s = study.sensors[at(i)];
    const SensorThresholds& t = study.thresholds.sensor[at(i)];
    Json one = io::object({{"id", s.id}, {"axis", subject.array.axis(i)}, {"sigma_mps2", subject.array.sigma_mps2(i)}});
    one["expected_mps2"] = io::object({{"vertical", s.expected.down_mps2[0]},
                                       {"horizontal_toolface_0", s.expected.down_mps2[1]},
                                       {"horizontal_toolface_90", s.expected.down_mps2[2]}});
    if (subject.file) {
      one["expected_raw"] = io::object({{"vertical", s.expected.raw[0]},
                                        {"horizontal_toolface_0", s.expected.raw[1]},
                                        {"horizontal_toolface_90", s.expected.raw[2]}});
    }
    one["thresholds_mps2"] =
        io::object({{"block_noise", study.budget.noise_mps2[at(i)]},
                    {"drift_tolerance", subject.settings.tolerance_mps2[at(i)]},
                    {"detectable", finite_or_null(t.detectable_mps2)},
                    {"sure_detection", finite_or_null(t.sure_detection_mps2)},
                    {"set_aside", finite_or_null(t.set_aside_mps2)},
                    {"sure_isolation", finite_or_null(study.thresholds.sure.fault[2][at(i)])},
                    {"blind_half_width", isolable ? finite_or_null(s.blind_half_width_mps2) : Json(nullptr)},
                    {"any_attitude", isolable ? finite_or_null(s.any_attitude_mps2) : Json(nullptr)}});
    one["nearest_mirror_axis_deg"] = deg_from_rad(s.nearest_remount_rad);
    out.push_back(std::move(one));
  }
  return out;
}

Json constants_json(const GeometrySubject& subject, const GeometryStudy& study) {
  Json out = Json::array();
  const int most = subject.array.size() - 1 - study.merit.coplanarity;
  for (int m = 1; m <= most; ++m) {
    out.push_back(io::object(
        {{"faults", m},
         {"detected_e", finite_or_null(study.constants.worst_fault(m))},
         {"told_apart_e", 2 * m <= most ? finite_or_null(study.constants.worst_fault(2 * m)) : Json(nullptr)},
         {"vector_error_e", finite_or_null(study.constants.vector_error[at(m)])}}));
  }
  return out;
}

Json bias_json(const CommonBias& b) {
  return io::object({{"visibility", b.visibility}, {"vector_error", norm(b.vector_error)}});
}

Json findings_json(const std::vector<Finding>& findings) {
  Json out = Json::array();
  for (const Finding& f : findings) out.push_back(io::object({{"name", f.name}, {"text", f.text}}));
  return out;
}

Json one_attitude_json(const GeometryStudy& study) {
  if (study.map.empty()) return nullptr;
  const MapSummary& s = study.one_attitude;
  return io::object({{"blind_share", s.blind_share},
                     {"clear_from_best_mps2", finite_or_null(s.least_clear_mps2)},
                     {"clear_from_worst_mps2", finite_or_null(s.largest_clear_mps2)},
                     {"best_inclination_deg", s.best_inclination_deg},
                     {"best_toolface_deg", s.best_toolface_deg}});
}

}  // namespace

std::string geometry_json(const GeometrySubject& subject, const GeometryStudy& study) {
  const SensorArray& array = subject.array;
  const FiguresOfMerit& f = study.merit;
  Json out;
  out["name"] = subject.name;
  out["calibrated"] = subject.calibrated;
  if (subject.file) {
    out["reads"] = subject.file->datasheet.reads == Reads::gravity ? "gravity" : "specific-force";
    out["unit"] = subject.file->input.unit.name;
  }
  out["gravity_mps2"] = subject.gravity.g_mps2;
  out["samples"] = subject.settings.samples;
  out["sensors"] = sensors_json(subject, study);
  out["figures_of_merit"] = io::object({{"gdop", f.gdop},
                                        {"condition", f.condition},
                                        {"nearest_angle_deg", deg_from_rad(f.nearest_angle_rad)},
                                        {"min_triple_det", f.min_triple_det},
                                        {"max_triple_condition", finite_or_null(f.max_triple_condition)},
                                        {"common_bias_visibility", f.common_bias_visibility},
                                        {"coplanarity", f.coplanarity},
                                        {"strict_grade", f.strict_grade},
                                        {"parity_grade", f.parity_grade},
                                        {"collusion_grade", study.collusion_grade},
                                        {"near_singular_triples", f.near_singular_triples}});
  out["critical_sensors"] = ids(critical_sensors(array, array.all()), array);
  out["worst_case"] = constants_json(subject, study);
  const double level = study.thresholds.protection_rad;
  out["protection_level_deg"] = level < kPi ? Json(deg_from_rad(level)) : Json(nullptr);
  Json levels = Json::array();
  for (const auto& l : study.levels)
    levels.push_back(
        io::object({{"sigma_mg0", l.sigma_mg0}, {"one_sample_deg", l.one_sample_deg}, {"block_deg", l.block_deg}}));
  out["protection_levels"] = std::move(levels);
  out["one_attitude"] = one_attitude_json(study);
  out["common_bias"] = io::object({{"as_mounted", bias_json(study.common)},
                                   {"reverse", ids(study.polarity.reverse, array)},
                                   {"with_these_reversed", bias_json(study.polarity.effect)}});
  Json hidden = Json::array();
  for (const HiddenWiring& h : study.hidden)
    hidden.push_back(io::object({{"what", h.what},
                                 {"turn_deg", deg_from_rad(h.effect.turn_rad)},
                                 {"inclination_deg", deg_from_rad(h.effect.inclination_rad)}}));
  out["hidden_wiring"] = std::move(hidden);
  out["warnings"] = findings_json(study.warnings);
  out["known_limits"] = findings_json(study.limits);
  Json triples = Json::array();
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    triples.push_back(io::object({{"sensors", ids(t.set(), array)},
                                  {"det", t.det},
                                  {"condition", finite_or_null(t.condition)},
                                  {"near_singular", !t.votes}}));
  }
  out["triples"] = std::move(triples);
  return out.dump(2) + "\n";
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
