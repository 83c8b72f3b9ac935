#include <cmath>

#include "plumb/io/json_fields.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/render/survey_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using io::Json;
using io::object;
using survey::Angle;
using survey::OrUndefined;

Json angle_json(const OrUndefined<Angle>& angle, double risk) {
  if (!angle) return object({{"deg", nullptr}, {"why", angle.error().text()}});
  return object({{"deg", deg_from_rad(angle->rad)},
                 {"sigma_deg", deg_from_rad(angle->sigma_rad)},
                 {"protection_level_deg", deg_from_rad(survey::protection_level_rad(*angle, risk))}});
}

Json check_json(const survey::Check& check, double unit) {
  return object({{"measured", check.measured / unit},
                 {"reference", check.reference / unit},
                 {"sigma", check.sigma / unit},
                 {"limit", check.limit / unit},
                 {"passed", check.passed}});
}

Json station_json(const survey::SurveyStation& s, double risk) {
  const OrUndefined<Angle> magnetic = survey::azimuth_from(s, survey::North::magnetic);
  return object({{"md_m", s.measured.md_m},
                 {"status", to_string(s.status)},
                 {"flags", s.flags()},
                 {"inclination", angle_json(s.attitude.inclination, risk)},
                 {"azimuth_magnetic", angle_json(magnetic, risk)},
                 {"azimuth_true", angle_json(survey::azimuth_from(s, survey::North::true_north), risk)},
                 {"azimuth_grid", angle_json(survey::azimuth_from(s, survey::North::grid), risk)},
                 {"gravity_toolface", angle_json(s.attitude.gravity_toolface, risk)},
                 {"magnetic_toolface", angle_json(s.attitude.magnetic_toolface, risk)},
                 {"gravity_mps2", check_json(s.checks.gravity, 1.0)},
                 {"field_nt", check_json(s.checks.field, 1e-9)},
                 {"dip_deg", check_json(s.checks.dip, rad_from_deg(1.0))}});
}

Json test_json(const survey::ErrorTest& test, double unit) {
  return object({{"passed", test.passed()},
                 {"worst_station", test.worst},
                 {"worst_normalised", test.normalised[static_cast<std::size_t>(test.worst)]},
                 {"one_limit", test.one_limit},
                 {"chi_square", test.chi_square},
                 {"chi_square_limit", test.chi_square_limit},
                 {"mean", test.mean / unit},
                 {"mean_limit", test.mean_limit / unit}});
}

Json axial_json(const survey::Survey& s) {
  if (!s.axial) return nullptr;
  if (!*s.axial) return object({{"estimated", false}, {"why", s.axial->error().text()}});
  const survey::Estimate& e = **s.axial;
  const auto z = static_cast<std::size_t>(survey::Term::magnetometer_bias_z);
  return object({{"estimated", true},
                 {"bias_z_nt", e.value[z] * 1e9},
                 {"sigma_nt", e.sigma[z] * 1e9},
                 {"largest_reference_correlation", e.largest_reference_correlation},
                 {"chi_square", e.chi_square},
                 {"freedom", e.freedom}});
}

Json saturated_json(const survey::Survey& s) {
  Json out = Json::array();
  for (const survey::SaturatedChannel& one : s.saturated)
    out.push_back(object({{"component", one.component}, {"stations", one.stations}, {"text", one.text()}}));
  return out;
}

Json axis_json(const survey::AlignmentAxis& axis) {
  return object({{"direction", axis.direction},
                 {"sigma_deg", std::isfinite(axis.sigma_rad) ? Json(deg_from_rad(axis.sigma_rad)) : Json()},
                 {"told", axis.told},
                 {"east_seen", axis.seen},
                 {"with", axis.with},
                 {"correlation", axis.correlation}});
}

Json alignment_json(const survey::Survey& s) {
  if (!s.alignment) return nullptr;
  Json axes = Json::array();
  for (const survey::AlignmentAxis& axis : *s.alignment ? (*s.alignment)->axis : s.alignment->error().axis)
    axes.push_back(axis_json(axis));
  if (!*s.alignment)
    return object({{"estimated", false},
                   {"why", s.alignment->error().text()},
                   {"rank", s.alignment->error().rank},
                   {"axes", axes}});
  const survey::JointAlignment& a = **s.alignment;
  const auto degrees = [](const Vec3& rad) {
    return Json{deg_from_rad(rad[0]), deg_from_rad(rad[1]), deg_from_rad(rad[2])};
  };
  return object({{"estimated", true},
                 {"turn_deg", degrees(a.turn_rad)},
                 {"sigma_deg", degrees(a.sigma_rad)},
                 {"rank", 3},
                 {"axes", axes},
                 {"held_out_dip_deg", deg_from_rad(a.held_out.rms_rad)},
                 {"held_out_normalised", a.held_out.normalised},
                 {"chi_square", a.chi_square},
                 {"freedom", a.freedom}});
}

Json left_out_json(const survey::Survey& s) {
  Json out = Json::array();
  for (const std::size_t k : s.left_out) out.push_back(s.stations[k].measured.md_m);
  return out;
}

Json path_sigmas_json(const survey::PathSigmas& sigmas) {
  const auto stated = [](double sigma) { return sigma > 0.0 ? Json(sigma) : Json(); };
  return object({{"sag_deg", stated(deg_from_rad(sigmas.sag_rad))},
                 {"depth_m", stated(sigmas.depth_m)},
                 {"depth_scale", stated(sigmas.depth_scale)}});
}

Json path_json(const survey::Survey& s) {
  Json out = Json::array();
  if (!s.path) return out;
  for (std::size_t k = 0; k < s.path->size(); ++k) {
    const survey::PathPoint& p = (*s.path)[k];
    const bool known = k < s.position_covariance.size();
    const auto sigma = [&](std::size_t at) { return known ? Json(std::sqrt(s.position_covariance[k][at])) : Json(); };
    out.push_back(object({{"md_m", p.md_m},
                          {"north_m", p.north_m},
                          {"east_m", p.east_m},
                          {"tvd_m", p.tvd_m},
                          {"dogleg_deg_per_30m", p.dogleg_deg_per_30m},
                          {"sigma_north_m", sigma(0)},
                          {"sigma_east_m", sigma(4)},
                          {"sigma_tvd_m", sigma(8)},
                          {"covariance_m2", known ? Json(s.position_covariance[k]) : Json()}}));
  }
  return out;
}

}  // namespace

nlohmann::ordered_json survey_json(const SurveyReport& r) {
  Json stations = Json::array();
  for (const survey::SurveyStation& s : r.survey.stations) stations.push_back(station_json(s, r.survey.integrity_risk));
  Json tests = nullptr;
  if (r.survey.tests)
    tests = object({{"gravity_mps2", test_json(r.survey.tests->gravity, 1.0)},
                    {"field_nt", test_json(r.survey.tests->field, 1e-9)},
                    {"dip_deg", test_json(r.survey.tests->dip, rad_from_deg(1.0))}});
  const geomagnetic::FieldReference& f = r.first.field;
  return object({{"file", io::printable_line(r.file)},
                 {"north", to_string(r.survey.north)},
                 {"integrity_risk", r.survey.integrity_risk},
                 {"limits", to_string(r.settings.station.checks.limits)},
                 {"false_alarm", r.settings.station.checks.false_alarm},
                 {"array", r.array.empty() ? Json() : Json(io::printable_line(r.array))},
                 {"field_source", io::printable_line(f.source)},
                 {"declination_deg", f.declination_known ? Json(deg_from_rad(f.declination_rad)) : Json()},
                 {"declination_note", f.declination_note},
                 {"rows_left_out", r.rows_left_out},
                 {"saturated", saturated_json(r.survey)},
                 {"stations", std::move(stations)},
                 {"error_tests", std::move(tests)},
                 {"axial_interference", axial_json(r.survey)},
                 {"magnetometer_alignment", alignment_json(r.survey)},
                 {"left_out_of_estimate_md_m", left_out_json(r.survey)},
                 {"path_sigmas", path_sigmas_json(r.survey.path_sigmas)},
                 {"path", path_json(r.survey)}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
