// The report of a fit of gyros as JSON for machines.
#include "plumb/render/gyro_fit_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using io::finite_or_null;
using io::Json;
using session::GyroCheck;

template <class List>
Json gyro_figures(const List& values) {
  Json out = Json::array();
  for (const double one : values) out.push_back(finite_or_null(one));
  return out;
}

Json gyro_check_json(const GyroCheck& check, const io::ArrayFile& group) {
  return io::object({{"log", check.name},
                     {"rows", check.rows},
                     {"residual_radps", check.all.sample_radps},
                     {"residual_32_radps", check.all.block_radps},
                     {"fast_radps", check.fast_radps},
                     {"fast_samples", check.fast.samples},
                     {"fast_residual_radps", check.fast.sample_radps},
                     {"fast_residual_32_radps", check.fast.block_radps},
                     {"alarm", check.alarm},
                     {"alarm_sensors", io::ids_of(check.alarm_axes, group.array)}});
}

Json gyro_axis_json(const io::GyroCalibration::Axis& axis, const char* id) {
  return io::object({{"id", id},
                     {"row", gyro_figures(axis.row)},
                     {"row_covariance", gyro_figures(axis.row_covariance)},
                     {"bias_radps", axis.bias_radps},
                     {"bias_sigma_radps", axis.bias_sigma_radps},
                     {"delay_s", axis.delay_s},
                     {"delay_sigma_s", axis.delay_sigma_s},
                     {"g_sensitivity_s_per_m", gyro_figures(axis.per_force)},
                     {"g_sensitivity_sigma_s_per_m", gyro_figures(axis.per_force_sigma)},
                     {"scale_bound", axis.bound.scale},
                     {"axis_bound_rad", axis.bound.axis_rad},
                     {"bias_bound_radps", axis.bound.bias_radps},
                     {"lag_bound_s", axis.bound.lag_s},
                     {"g_sensitivity_bound_s_per_m", axis.bound.g_sensitivity_s_per_m}});
}

}  // namespace

io::Json gyro_fit_json(const session::GyroCommissioning& run, const io::ArrayFile& group) {
  const bool accepted = run.refusal.empty();
  Json sensors = Json::array(), held_out = Json::array();
  for (std::size_t k = 0; k < run.found.axis.size(); ++k)
    sensors.push_back(gyro_axis_json(run.found.axis[k], group.array.row(static_cast<int>(k)).id.data()));
  for (const GyroCheck& one : run.held_out) held_out.push_back(gyro_check_json(one, group));
  return io::object({{"accepted", accepted},
                     {"reason", accepted ? Json() : Json(run.refusal)},
                     {"next", accepted ? Json() : Json(run.next)},
                     {"group", group.group},
                     {"rows", run.rows},
                     {"rows_fitted", run.fitted_rows},
                     {"rests", run.rests},
                     {"rests_turned", run.rests_turned},
                     {"bias_scatter_radps", run.bias_scatter_radps},
                     {"absolute", run.found.absolute},
                     {"common_part", finite_or_null(run.common_part)},
                     {"turns", run.turns},
                     {"turns_held_out", run.turns_held_out},
                     {"turns_residual_rad", run.found.turns_rad},
                     {"held_out_turns_residual_rad", run.found.held_out_turns_rad},
                     {"lag_factor", run.lag_factor},
                     {"limit", io::object({{"noise_radps", run.limit.noise_radps},
                                           {"timing_s", run.limit.timing_s},
                                           {"timing_share", run.limit.timing_share},
                                           {"relative", run.limit.relative},
                                           {"relative_share", run.limit.relative_share}})},
                     {"fitted", gyro_check_json(run.fitted, group)},
                     {"held_out", std::move(held_out)},
                     {"sensors", std::move(sensors)}});
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
