// The report of a fit as JSON for machines. A figure that is not known is null, never 0.
#include <algorithm>
#include <cmath>

#include "finding_words.hpp"
#include "fit_words.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/column_findings.hpp"
#include "plumb/findings/dead_channel.hpp"
#include "plumb/findings/geometry_study.hpp"
#include "plumb/io/field_json.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/alignment_words.hpp"
#include "plumb/render/fit_report.hpp"
#include "plumb/render/wiring_words.hpp"
#include "sensor_fields.hpp"
#include "temperature_json.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using io::finite_or_null;
using io::Json;

/// "a3", "temperature", "roll_group"
std::string subject_of(const findings::Finding& f, const io::ArrayFile& array) {
  if (f.sensor >= 0) return id_of(array, f.sensor);
  return f.code == findings::FindingCode::temperature_column_gaps ? "temperature" : "roll_group";
}

Json columns_json(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  Json out = Json::array();
  for (const findings::Finding& f : findings::column_findings(run, array)) {
    out.push_back(io::object({{"column", column_of(f, array)},
                              {"of", subject_of(f, array)},
                              {"rows_without", static_cast<std::uint64_t>(f.value)},
                              {"dead", f.sensor >= 0 && findings::dead_channel(run.log, f.sensor)},
                              {"words", column_words(f, run, array)}}));
  }
  return out;
}

/// What would have made a refused fit settle; null where nothing was found.
Json second_look_json(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  const findings::SecondLook& look = run.second_look;
  if (!look.found()) return {};
  Json exchanged = Json::array();
  Json reversed = Json::array();
  for (const auto& [i, j] : look.exchanged) {
    if (i == j) reversed.push_back(id_of(array, i));
    if (i != j) exchanged.push_back(Json::array({id_of(array, i), id_of(array, j)}));
  }
  Json turned = Json::array();
  for (const findings::TurnedTriad& t : look.turned) {
    Json sensors = Json::array(), axes = Json::array();
    for (int k = 0; k < 3; ++k) {
      sensors.push_back(id_of(array, t.sensor[static_cast<std::size_t>(k)]));
      axes.push_back(findings::mended_axis(array.array, t, k));
    }
    turned.push_back(io::object({{"sensors", std::move(sensors)}, {"axes", std::move(axes)}}));
  }
  return io::object({{"columns_exchanged", std::move(exchanged)},
                     {"sign_reversed", std::move(reversed)},
                     {"triads_turned", std::move(turned)},
                     {"without_roll_group", look.groups},
                     {"roll_axis", look.roll_axis ? Json(*look.roll_axis) : Json()},
                     {"without_roll_groups", look.without_groups}});
}

Json stations_json(const findings::CalibrationRun& run) {
  Json out = Json::array();
  for (std::size_t k = 0; k < run.stations.size(); ++k) {
    const Station& s = run.stations[k];
    Json one = io::object(
        {{"begin_s", s.begin_s}, {"end_s", s.end_s}, {"samples", s.count}, {"temperature_degc", s.temperature_degc}});
    const Vec3& u = run.study.attitudes[k].direction;
    one["down"] = norm(u) > 0.0 ? Json(u) : Json();
    const bool fitted = k < run.study.residuals.size();
    one["norm_error_mps2"] = fitted ? finite_or_null(run.study.residuals[k].norm_error_mps2) : Json();
    one["held_out"] = Json();
    if (k < run.study.predicted.size() && run.study.predicted[k].judged) {
      const StationPrediction& p = run.study.predicted[k];
      one["held_out"] = io::object({{"norm_error_mps2", p.norm_error_mps2},
                                    {"parity_rms_mps2", p.parity_rms_mps2},
                                    {"sigmas", p.sigmas},
                                    {"stands_out", p.sigmas > findings::kOddStation_sigmas}});
    }
    out.push_back(std::move(one));
  }
  return out;
}

Json fit_object(const findings::CalibrationRun& run) {
  const FitReport& r = run.told();
  const auto known = [&run](Json value) { return run.study.shown ? value : Json(); };
  Json cost = Json::array();
  for (const double c : run.study.cost) cost.push_back(c);
  return io::object({{"start", to_string(run.report.start)},
                     {"stop", to_string(run.report.stop)},
                     {"iterations", run.report.iterations},
                     {"cost", std::move(cost)},
                     {"parameters", r.parameters},
                     {"rank", known(r.rank)},
                     {"gauge", known(r.gauge)},
                     {"roll_groups", r.roll_groups},
                     {"single_station_roll_groups", r.single_station_groups},
                     {"roll_axis", r.roll_axis == Vec3{} ? Json() : Json(r.roll_axis)},
                     {"roll_axis_deviation_rad", r.roll_axis == Vec3{} ? Json() : Json(r.roll_axis_deviation_rad)},
                     {"inclination_sigma_rad", r.null_directions == 0 ? known(r.inclination_sigma_rad) : Json()},
                     {"common_turn_rad", r.common_turn.sigma_rad > 0.0 ? Json(r.common_turn.rad) : Json()},
                     {"common_turn_sigma_rad", r.common_turn.sigma_rad > 0.0 ? Json(r.common_turn.sigma_rad) : Json()},
                     {"norm_rms_mps2", known(r.norm_rms_mps2)},
                     {"parity_rms_mps2", known(r.parity_rms_mps2)},
                     {"misfit_mps2", known(r.misfit_mps2)},
                     {"chi2", known(r.chi2)},
                     {"degrees_of_freedom", known(r.degrees_of_freedom)},
                     {"p_value", known(r.p_value)},
                     {"p_value_means", known(p_value_words(r))},
                     {"condition", known(r.condition)},
                     {"excitation", known(r.excitation)}});
}

Json hold_out_json(const findings::CalibrationRun& run) {
  const HoldOut& h = run.study.held_out;
  if (h.judged == 0) return {};
  return io::object({{"folds", run.study.plan.folds},
                     {"rounds", run.study.plan.rounds},
                     {"judged", h.judged},
                     {"not_judged", h.not_judged},
                     {"norm_rms_mps2", h.norm_rms_mps2},
                     {"norm_max_mps2", h.norm_max_mps2},
                     {"parity_rms_mps2", h.parity_rms_mps2},
                     {"parity_max_mps2", h.parity_max_mps2},
                     {"sigmas", h.sigmas},
                     {"worst_station", h.worst + 1}});
}

/// Stations that the fit rejected, those of an accepted fit all by number; details of the first kMaxOutliers.
Json outliers_json(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  const FitReport& r = run.told();
  Json listed = Json::array();
  for (int k = 0; k < std::min(r.outliers, kMaxOutliers); ++k) {
    const Outlier& o = r.outlier[static_cast<std::size_t>(k)];
    listed.push_back(io::object({{"station", o.station + 1},
                                 {"sigmas", finite_or_null(o.standardised)},
                                 {"sensor", o.sensor >= 0 ? Json(id_of(array, o.sensor)) : Json()},
                                 {"share", o.sensor >= 0 ? finite_or_null(o.share) : Json()}}));
  }
  Json stations = Json::array();
  for (const int k : run.study.set_aside) stations.push_back(k + 1);
  return io::object({{"count", r.outliers}, {"stations", std::move(stations)}, {"listed", std::move(listed)}});
}

Json clipped_json(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  const FitReport& r = run.told();
  return io::object({{"readings", r.clipped}, {"sensors", io::ids_of(r.clipped_sensors, array.array)}});
}

Json sensors_json(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  Json out = Json::array();
  const int highest_variance = run.told().high_variance_sensor;
  const std::string loud = highest_variance >= 0 ? id_of(array, highest_variance) : "";
  for (const findings::SensorFigures& f : findings::sensor_figures(run, array)) {
    Json one = io::object({{"id", f.id}});
    put_fields(one, kSensorFields, f);
    one["sample_noise_mps2"] = f.sample_noise_mg > 0.0 ? Json(f.sample_noise_mg * findings::kMilliG0_mps2) : Json();
    one["high_variance"] = f.known && f.id == loud;
    one["data_share"] = f.known ? finite_or_null(f.data_share) : Json();
    out.push_back(std::move(one));
  }
  return out;
}

Json paper_parameters_json(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  if (!run.study.paper) return io::object({{"why_not", paper_words(run.study.paper.error(), array)}});
  const SensorModel& model = *run.study.paper;
  Json out = Json::array();
  for (int i = 0; i < model.size; ++i) {
    const auto a = static_cast<std::size_t>(i);
    Json row = Json::array();
    for (int k = 0; k < model.size; ++k) row.push_back(model.misalignment[static_cast<std::size_t>(i * kCapacity + k)]);
    out.push_back(io::object({{"id", id_of(array, i)},
                              {"B_mps2", model.sensor[a].bias[0]},
                              {"SF_per_mps2", model.sensor[a].scale[0]},
                              {"m", std::move(row)}}));
  }
  return io::object({{"sensors", std::move(out)}});
}

Json paper_fits_json(const PaperCalibration& paper, const io::ArrayFile& array) {
  Json out = Json::array();
  for (const findings::PaperFigures& f : findings::paper_figures(paper, array)) {
    Json& one = out.emplace_back(io::object({{"sensors", paper_sensors(f, array)},
                                             {"sound", f.sound},
                                             {"stop", paper_outcome(f)},
                                             {"iterations", f.iterations},
                                             {"rank", f.rank}}));
    put_fields(one, kPaperFields, f);
  }
  return out;
}

Json attitudes_json(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  const Coverage& c = run.study.coverage;
  Json ranges = Json::array(), next = Json::array();
  for (int i = 0; i < array.array.size() && c.attitudes > 0; ++i) {
    const auto a = static_cast<std::size_t>(i);
    ranges.push_back(io::object({{"id", id_of(array, i)}, {"lowest_g", c.lowest[a]}, {"highest_g", c.highest[a]}}));
  }
  for (const PlannedAttitude& p : run.study.next) {
    next.push_back(io::object({{"inclination_deg", deg_from_rad(p.inclination_rad)},
                               {"toolface_deg", deg_from_rad(p.toolface_rad)},
                               {"down", p.direction},
                               {"gain", p.gain},
                               {"words", attitude_words(p)}}));
  }
  return io::object({{"recorded", c.attitudes},
                     {"inclinations", c.inclinations},
                     {"inclination_min_deg", deg_from_rad(c.inclination_min_rad)},
                     {"inclination_max_deg", deg_from_rad(c.inclination_max_rad)},
                     {"ranges", std::move(ranges)},
                     {"lacking", coverage_words(run, array)},
                     {"record_next", std::move(next)}});
}

Json fit_of(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  Json out;
  out["array"] = array.name;
  out["gravity_mps2"] = array.gravity.g_mps2;
  out["accepted"] = run.accepted != nullptr;
  if (!run.accepted) {
    const Refusal refusal = refusal_of(run, array);
    out["refusal"] = io::object({{"reason", refusal.reason},
                                 {"concern", to_string(run.concern)},
                                 {"next", refusal.next},
                                 {"would_settle", second_look_json(run, array)}});
  }
  out["interrupted"] = run.interrupted;
  out["rows"] = run.log.rows;
  out["rows_bad"] = run.log.rows_bad;
  out["log_findings"] = Json::array();
  for (const findings::Finding& f : run.log_findings) out["log_findings"].push_back(log_words(f, array));
  out["columns"] = columns_json(run, array);
  out["stations_without_temperature"] = run.without_temperature;
  const std::string unit = temperature_unit_words(run, array);
  out["temperature_unit"] = unit.empty() ? Json() : Json(unit);
  out["unobservable_permutation_count"] = findings::hidden_wiring_count(array);
  out["wiring"] = run.study.shown ? wiring_json(run.wiring, array) : Json();
  out["alignment"] =
      run.study.shown ? alignment_json(array, findings::alignment_of(array, run.study.shown.get(), run.wiring.measured))
                      : Json();
  out["stations"] = stations_json(run);
  out["fit"] = fit_object(run);
  out["outliers"] = outliers_json(run, array);
  out["at_full_scale"] = clipped_json(run, array);
  out["unobservable"] = unobservable(run, array);
  out["temperature"] = temperature_json(run, array);
  out["hold_out"] = hold_out_json(run);
  out["common_scale"] = run.study.shown ? io::object({{"mean", run.told().common_scale.mean},
                                                      {"scatter", run.told().common_scale.scatter},
                                                      {"sigma", run.told().common_scale.sigma},
                                                      {"sigmas", run.told().common_scale.sigmas()}})
                                        : Json();
  out["inconsistent_sensor"] = Json();
  if (run.study.odd_sought) {
    const OddSensor& odd = run.study.odd;
    out["inconsistent_sensor"] = io::object({{"id", odd.sensor >= 0 ? Json(id_of(array, odd.sensor)) : Json()},
                                             {"misfit_with_mps2", odd.with_mps2},
                                             {"misfit_without_mps2", odd.without_mps2},
                                             {"ratio", odd.ratio}});
  }
  out["sensors"] = sensors_json(run, array);
  if (array.field == io::FieldKind::gravity) out["paper_parameters"] = paper_parameters_json(run, array);
  if (run.paper) out["paper"] = paper_fits_json(*run.paper, array);
  out["attitudes"] = attitudes_json(run, array);
  return out;
}

}  // namespace

std::string fit_json(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  return io::in_field_units(fit_of(run, array), array.field).dump(2) + "\n";
}

std::string fit_document(const findings::CalibrationRun& run, const io::ArrayFile& array) {
  return fit_of(run, array).dump();
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
