// The report of a fit in motion as JSON for machines.
#include "plumb/render/motion_fit_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using io::finite_or_null;
using io::Json;
using session::MotionCommissioning;

Json estimate(const commission::Estimate& e) {
  return io::object({{"value", finite_or_null(e.value)}, {"sigma", finite_or_null(e.sigma)}, {"open", e.open}});
}

template <class List>
Json estimates(const List& list) {
  Json out = Json::array();
  for (const commission::Estimate& one : list) out.push_back(estimate(one));
  return out;
}

Json three(const Vec3& v) { return Json{v[0], v[1], v[2]}; }

Json sensors_json(const MotionCommissioning& run, const io::ArrayFile& array) {
  Json out = Json::array();
  for (std::size_t k = 0; k < run.found.sensor.size(); ++k) {
    const io::MotionCalibration::Sensor& one = run.found.sensor[k];
    const int i = static_cast<int>(k);
    out.push_back(io::object({{"id", array.array.row(i).id.data()},
                              {"chip", io::package_of(array, i)},
                              {"lever_arm_m", three(one.lever_arm_m)},
                              {"lever_arm_correction_m", estimates(run.fit.arm_m[k])},
                              {"lever_arm_bound_m", one.lever_arm_bound_m},
                              {"lag_s", estimate(run.fit.lag_s[k])},
                              {"lag_bound_s", one.lag_bound_s},
                              {"lag_bound_stated", run.lag_stated[k]},
                              {"vibration_rectification_per_mps2", estimate(run.fit.rectification[k])},
                              {"vibration_rectification_bound_per_mps2", one.rectification_bound_per_mps2},
                              {"vibration_rectification_bound_stated", run.rectification_stated[k]},
                              {"scale", estimate(run.fit.scale[k])},
                              {"axis_rad", estimate(run.fit.axis_rad[k])},
                              {"bias_mps2", estimate(run.fit.bias_mps2[k])}}));
  }
  return out;
}

Json gyro_json(const MotionCommissioning& run) {
  const GyroErrors& g = run.found.gyro;
  return io::object({{"gyros", run.found.gyros},
                     {"scale_and_axes", estimates(run.fit.gyro)},
                     {"bias_radps", estimates(run.fit.gyro_bias_radps)},
                     {"lag_s", estimate(run.fit.gyro_lag_s)},
                     {"scale_bound", g.scale},
                     {"axis_bound_rad", g.axis_rad},
                     {"bias_bound_radps", g.bias_radps},
                     {"noise_radps", g.noise_radps},
                     {"lag_bound_s", g.lag_s}});
}

Json texts_of(const std::vector<std::string>& texts) {
  Json out = Json::array();
  for (const std::string& text : texts) out.push_back(text);
  return out;
}

}  // namespace

io::Json motion_fit_json(const MotionCommissioning& run, const io::ArrayFile& array) {
  const bool accepted = run.refusal == session::MotionRefusal::none;
  const Refusal refusal = accepted ? Refusal{} : refusal_of(run, array);
  Json out = io::object({{"accepted", accepted},
                         {"refusal", accepted ? Json() : Json(word_of(run.refusal))},
                         {"reason", accepted ? Json() : Json(refusal.reason)},
                         {"next", accepted ? Json() : Json(refusal.next)},
                         {"refused_sensors", io::ids_of(run.sensors, array.array)},
                         {"rows", run.rows},
                         {"rows_fitted", run.fitted_rows},
                         {"duration_s", run.duration_s},
                         {"fitted", run.fitted}});
  if (!run.fitted) return out;
  out["block_pairs"] = run.fit.block_pairs;
  out["unknowns"] = run.fit.parameters;
  out["rank"] = run.fit.rank;
  out["gauge"] = run.fit.gauge;
  out["stated_lever_arms_hold"] = run.fit.stated_arms_hold;
  out["open"] = texts_of(left_open(run, array));
  out["residual_mps2"] = run.fit.residual_mps2;
  out["residual_before_mps2"] = run.fit.residual_before_mps2;
  out["lag_needed_s"] = run.lag_needed_s < 0.0 ? Json() : Json(run.lag_needed_s);
  const bool checked = run.held_out_own_mps2 > 0.0;
  out["held_out"] = !checked ? Json()
                             : io::object({{"samples", run.rows - run.fitted_rows},
                                           {"judged", static_cast<std::uint64_t>(run.held_out_judged)},
                                           {"alarm", run.refusal == session::MotionRefusal::held_out_alarm},
                                           {"residual_mps2", run.held_out_mps2},
                                           {"residual_own_fit_mps2", run.held_out_own_mps2}});
  out["sensors"] = sensors_json(run, array);
  out["gyro"] = run.found.sensor.empty() ? Json() : gyro_json(run);
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
