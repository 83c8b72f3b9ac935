// What `plumb geometry --json` prints: SI units in the names, null where the geometry has no such figure.
#include <cmath>

#include "geometry_fields.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/field_json.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/detection_sizes.hpp"
#include "plumb/render/geometry_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using findings::Finding;
using findings::GeometryStudy;
using findings::GeometrySubject;
using findings::HiddenWiring;
using findings::MapSummary;
using findings::SensorStudy;
using io::finite_or_null;
using io::ids_of;
using io::Json;

Json sensors_json(const GeometrySubject& subject, const GeometryStudy& study) {
  Json out = Json::array();
  for (int i = 0; i < subject.array.size(); ++i) {
    const SensorStudy& s = study.sensors[at(i)];
    Json one = io::object({{"id", s.id}, {"axis", subject.array.axis(i)}, {"sigma_mps2", subject.array.sigma_mps2(i)}});
    one["expected_mps2"] = io::object({{"vertical", s.expected.down_mps2[0]},
                                       {"horizontal_toolface_0", s.expected.down_mps2[1]},
                                       {"horizontal_toolface_90", s.expected.down_mps2[2]}});
    if (subject.file) {
      one["expected_raw"] = io::object({{"vertical", s.expected.raw[0]},
                                        {"horizontal_toolface_0", s.expected.raw[1]},
                                        {"horizontal_toolface_90", s.expected.raw[2]}});
    }
    put_fields(one["thresholds_mps2"], kThresholdFields, subject, study, i);
    one[kBeyondKey] = put_beyond(one["thresholds_mps2"], kThresholdFields,
                                 [&subject, &study, i](std::size_t k) { return is_beyond(subject, study, i, k); });
    one["nearest_mirror_axis_deg"] = deg_from_rad(s.nearest_remount_rad);
    out.push_back(std::move(one));
  }
  return out;
}

Json worst_json(const GeometryStudy& study) {
  Json out = Json::array();
  for (const findings::WorstCase& c : study.worst) {
    Json one = io::object({{"faults", c.faults}});
    put_fields(one, kWorstFields, c);
    out.push_back(std::move(one));
  }
  return out;
}

Json bias_json(const CommonBias& b) {
  return io::object({{"visibility", b.visibility}, {"vector_error", norm(b.vector_error)}});
}

Json findings_json(const std::vector<Finding>& list, const GeometrySubject& subject, const GeometryStudy& study) {
  Json out = Json::array();
  for (const Finding& f : list)
    out.push_back(io::object({{"name", to_string(f.code)}, {"text", geometry_words(f, subject, study)}}));
  return out;
}

Json one_attitude_json(const GeometryStudy& study) {
  if (study.map.empty()) return nullptr;
  const MapSummary& s = study.one_attitude;
  return io::object({{"not_guaranteed_share", s.not_guaranteed_share},
                     {"guaranteed_above_best_mps2", finite_or_null(s.least_clear_mps2)},
                     {"guaranteed_above_worst_mps2", finite_or_null(s.largest_clear_mps2)},
                     {"best_inclination_deg", s.best_inclination_deg},
                     {"best_toolface_deg", s.best_toolface_deg}});
}

}  // namespace

std::string geometry_json(const GeometrySubject& subject, const GeometryStudy& study) {
  return io::in_field_units(geometry_document(subject, study), subject.field()).dump(2) + "\n";
}

Json geometry_document(const GeometrySubject& subject, const GeometryStudy& study) {
  const SensorArray& array = subject.array;
  const FiguresOfMerit& f = study.merit;
  Json out;
  out["name"] = subject.name;
  out["calibrated"] = subject.calibrated;
  if (subject.file) {
    if (subject.file->field == io::FieldKind::gravity)
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
                                        {"units", f.units},
                                        {"coplanarity", f.coplanarity},
                                        {"confirmed_grade", f.confirmed_grade},
                                        {"provisional_grade", f.provisional_grade},
                                        {"correlated_grade", study.correlated_grade},
                                        {"near_singular_triples", f.near_singular_triples}});
  out["critical_sensors"] = ids_of(critical_sensors(array, array.all()), array);
  out["worst_case"] = worst_json(study);
  out["detection_sizes"] = sizes_json(study.sizes, array.size());
  const double as_mg0 =
      subject.field() == io::FieldKind::gravity ? 1.0 : in_mg0(1.0 / io::units_of(subject.field()).fine_per_inside);
  Json levels = Json::array();
  for (const auto& l : study.levels)
    levels.push_back(io::object(
        {{"sigma_mg0", as_mg0 * l.sigma_fine}, {"one_sample_deg", l.one_sample_deg}, {"block_deg", l.block_deg}}));
  out["protection_levels"] = std::move(levels);
  out["one_attitude"] = one_attitude_json(study);
  out["common_bias"] = io::object({{"as_mounted", bias_json(study.common)},
                                   {"reverse", ids_of(study.polarity.reverse, array)},
                                   {"with_these_reversed", bias_json(study.polarity.effect)}});
  Json hidden = Json::array();
  for (const HiddenWiring& h : study.hidden)
    hidden.push_back(io::object({{"what", wiring_words(h, array)},
                                 {"turn_deg", deg_from_rad(h.effect.turn_rad)},
                                 {"inclination_deg", deg_from_rad(h.effect.inclination_rad)}}));
  out["unobservable_permutations"] = std::move(hidden);
  out["warnings"] = findings_json(study.warnings, subject, study);
  out["known_limits"] = findings_json(study.limits, subject, study);
  Json triples = Json::array();
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    triples.push_back(io::object({{"sensors", ids_of(t.set(), array)},
                                  {"det", t.det},
                                  {"condition", finite_or_null(t.condition)},
                                  {"near_singular", !t.votes}}));
  }
  out["triples"] = std::move(triples);
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
