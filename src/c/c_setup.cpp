// From a configuration in C to a setup, and the defaults.
#include <algorithm>
#include <cmath>

#include "c_api.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace c_api {
namespace {

template <size_t N, class T>
std::array<T, N> array_of(const T (&from)[N]) noexcept {
  std::array<T, N> out{};
  std::copy(from, from + N, out.begin());
  return out;
}

MonitorConfig settings_of(const plumb_config& c) noexcept {
  MonitorConfig out;
  out.window = c.window;
  out.assumed_faults = c.assumed_faults;
  out.isolation_stations = c.isolation_stations;
  out.isolation_timeout = c.isolation_timeout;
  out.passed_blocks = c.passed_blocks;
  out.forget_blocks = c.forget_blocks;
  out.probation_stations = c.probation_stations;
  out.missing_confirm = c.missing_confirm;
  out.isolation_timeout_blocks = c.isolation_timeout_blocks;
  out.recalibrate_after_exclusion = c.recalibrate_after_exclusion != 0;
  out.alarm_form = c.alarm_for_average_tool != 0 ? AlarmForm::average_tool : AlarmForm::every_tool;
  out.reset_key = c.reset_key;
  out.delta_f_mps2 = c.delta_f_mps2;
  out.false_alarm_rate = c.false_alarm_rate;
  out.rejection_rate = c.rejection_rate;
  out.triple_false_alarm_rate = c.triple_false_alarm_rate;
  out.max_gap_s = c.max_gap_s;
  out.max_age_s = c.max_age_s;
  out.max_age_samples = c.max_age_samples;
  out.station_angle_rad = c.station_angle_rad;
  out.distinct_attitude_angle_rad = c.distinct_attitude_angle_rad;
  out.clear_fraction = c.clear_fraction;
  out.alert_limit_rad = c.alert_limit_rad;
  out.alert_frame = c.alert_in_calibrated_axes != 0 ? AlertFrame::calibrated_axes : AlertFrame::housing;
  out.alignment_bound_rad = alignment_bound_of(c.alignment_bound_rad);
  out.integrity_risk = c.integrity_risk;
  out.fault_prior = c.fault_prior;
  out.temperature_min_degc = c.temperature_min_degc;
  out.temperature_max_degc = c.temperature_max_degc;
  out.acceleration_bound_mps2 = c.acceleration_bound_mps2;
  return out;
}

/// The sensors of the configuration; numbers that no calibration can have left are named by sensor.
plumb_error take_sensors(const plumb_config& config, Workspace& work) noexcept {
  const int n = config.sensors;
  MonitorSetup& setup = work.setup;
  setup.model.size = n;
  setup.model.reads = config.reads < 0 ? Reads::specific_force : Reads::gravity;
  setup.lever_arms_known = config.lever_arms_known != 0;
  for (int i = 0; i < n; ++i) {
    const plumb_error sound = check_struct(config.sensor + i, i);
    if (sound.code != PLUMB_OK) return sound;
    const plumb_sensor& given = config.sensor[i];
    const auto a = static_cast<size_t>(i);
    SensorRow& row = work.rows[a];
    std::copy(given.id, given.id + 15, row.id.begin());
    row.axis = array_of(given.axis);
    row.sigma_mps2 = given.sigma_mps2;
    if (given.chip < 0 || given.chip > 255)
      return answer({Errc::out_of_range, i, static_cast<double>(given.chip), 255.0});
    row.chip = static_cast<std::uint8_t>(given.chip);
    SensorCoefficients& c = setup.model.sensor[a];
    c.scale = array_of(given.scale);
    c.bias = array_of(given.bias_mps2);
    c.reference_degc = given.reference_degc;
    work.uncertainty.misfit_mps2[a] = given.misfit_mps2;
    setup.full_scale_raw[a] = given.full_scale_raw;
    setup.resolution_raw[a] = given.resolution_raw;
    setup.lever_arm_m[a] = array_of(given.lever_arm_m);
    setup.stability[a] = {given.stability_mps2, given.stability_per_day_mps2, given.stability_per_degc_mps2,
                          given.stability_per_degc_per_min_mps2};
    double sum = given.reference_degc + given.misfit_mps2 + given.full_scale_raw + given.resolution_raw;
    for (size_t k = 0; k < 4; ++k) sum += c.scale[k] + c.bias[k];
    for (size_t k = 0; k < 3; ++k) sum += given.lever_arm_m[k];
    if (!std::isfinite(sum)) return answer({Errc::not_finite, i});
    if (given.misfit_mps2 < 0.0) return answer({Errc::out_of_range, i, given.misfit_mps2, 0.0});
  }
  return answer(PLUMB_OK);
}

plumb_error take_covariance(const plumb_config& config, Workspace& work) noexcept {
  if (config.covariance == nullptr) return answer(PLUMB_OK);
  const auto size = static_cast<std::uint32_t>(RowUncertainty::packed_size(config.sensors));
  if (config.covariance_size != size)
    return answer({Errc::out_of_range, -1, static_cast<double>(config.covariance_size), static_cast<double>(size)});
  std::copy(config.covariance, config.covariance + size, work.uncertainty.covariance.begin());
  for (std::uint32_t k = 0; k < size; ++k) {
    if (!std::isfinite(config.covariance[k]))
      return answer({Errc::not_finite, static_cast<int>(k), config.covariance[k]});
  }
  work.uncertainty.common_scale = config.common_scale;
  if (!work.uncertainty.is_covariance()) return answer({Errc::implausible});
  return answer(PLUMB_OK);
}

/// No calibration yet: what the sensors were given as is their datasheet.
plumb_error take_datasheet(const plumb_config& config, Workspace& work) noexcept {
  if (config.covariance != nullptr)
    return answer({Errc::out_of_range, -1, static_cast<double>(config.covariance_size), 0.0});
  Datasheet& sheet = work.datasheet;
  sheet.size = config.sensors;
  sheet.reads = work.setup.model.reads;
  for (size_t i = 0; i < static_cast<size_t>(config.sensors); ++i) {
    const plumb_sensor& given = config.sensor[i];
    DatasheetSensor& s = sheet.sensor[i];
    s.row = work.rows[i];
    s.coefficients = work.setup.model.sensor[i];
    s.prior.bias_mps2 = given.prior_bias_mps2;
    s.prior.scale = given.prior_scale;
    s.prior.axis_rad = given.prior_axis_rad;
    s.full_scale_raw = given.full_scale_raw;
    s.resolution_raw = given.resolution_raw;
  }
  return answer(set_datasheet(sheet, work.setup));
}

plumb_error take_calibration(const plumb_config& config, Workspace& work) noexcept {
  const plumb_error e = take_covariance(config, work);
  if (e.code != PLUMB_OK) return e;
  const Expected<SensorArray> array = SensorArray::make(work.rows.data(), config.sensors);
  if (!array) return answer(array.error());
  work.setup.array = *array;
  work.setup.array.set_uncertainty(work.uncertainty);
  return e;
}

}  // namespace

plumb_error prepare(const plumb_config* given, Workspace& work, int argument) noexcept {
  plumb_error e = check_struct(given, argument);
  if (e.code != PLUMB_OK) return e;
  const plumb_config& config = *given;
  if (config.sensors < 3) return answer({Errc::too_few_sensors, -1, static_cast<double>(config.sensors), 3.0});
  if (config.sensors > kCapacity)
    return answer({Errc::too_many_sensors, -1, static_cast<double>(config.sensors), static_cast<double>(kCapacity)});
  if (config.sensor == nullptr) return missing(argument);
  // Taken for one of the two, a third number could turn every vector round.
  if (config.reads != 1 && config.reads != -1)
    return answer({Errc::out_of_range, -1, static_cast<double>(config.reads), 1.0});
  e = take_sensors(config, work);
  if (e.code == PLUMB_OK) e = config.calibrated != 0 ? take_calibration(config, work) : take_datasheet(config, work);
  if (e.code != PLUMB_OK) return e;
  work.setup.gravity = {config.gravity_mps2, config.gravity_sigma_mps2, GravityModel::value};
  work.setup.output_frame = array_of(config.output_frame);
  work.setup.config = settings_of(config);
  work.setup.days_since_calibration = config.days_since_calibration;
  return answer(PLUMB_OK);
}

}  // namespace c_api
}  // namespace PLUMB_ABI
}  // namespace plumb

extern "C" {

plumb_error plumb_config_defaults(plumb_config* config) noexcept {
  if (config == nullptr) return plumb::c_api::missing(0);
  const plumb::MonitorConfig d;
  *config = plumb_config{};
  config->struct_size = sizeof(plumb_config);
  config->calibrated = 1;
  config->reads = 1;
  config->gravity_mps2 = plumb::GravityReference{}.g_mps2;
  config->gravity_sigma_mps2 = plumb::GravityReference{}.sigma_mps2;
  for (std::size_t k = 0; k < 9; k += 4) config->output_frame[k] = 1.0;
  config->window = d.window;
  config->assumed_faults = d.assumed_faults;
  config->isolation_stations = d.isolation_stations;
  config->isolation_timeout = d.isolation_timeout;
  config->passed_blocks = d.passed_blocks;
  config->forget_blocks = d.forget_blocks;
  config->probation_stations = d.probation_stations;
  config->missing_confirm = d.missing_confirm;
  config->isolation_timeout_blocks = d.isolation_timeout_blocks;
  config->recalibrate_after_exclusion = d.recalibrate_after_exclusion ? 1 : 0;
  config->alarm_for_average_tool = d.alarm_form == plumb::AlarmForm::average_tool ? 1 : 0;
  config->reset_key = d.reset_key;
  config->delta_f_mps2 = d.delta_f_mps2;
  config->false_alarm_rate = d.false_alarm_rate;
  config->rejection_rate = d.rejection_rate;
  config->triple_false_alarm_rate = d.triple_false_alarm_rate;
  config->max_gap_s = d.max_gap_s;
  config->max_age_s = d.max_age_s;
  config->max_age_samples = d.max_age_samples;
  config->station_angle_rad = d.station_angle_rad;
  config->distinct_attitude_angle_rad = d.distinct_attitude_angle_rad;
  config->clear_fraction = d.clear_fraction;
  config->alert_limit_rad = d.alert_limit_rad;
  config->alert_in_calibrated_axes = d.alert_frame == plumb::AlertFrame::calibrated_axes ? 1 : 0;
  config->alignment_bound_rad = static_cast<double>(d.alignment_bound_rad);
  config->integrity_risk = d.integrity_risk;
  config->fault_prior = d.fault_prior;
  config->temperature_min_degc = d.temperature_min_degc;
  config->temperature_max_degc = d.temperature_max_degc;
  config->acceleration_bound_mps2 = d.acceleration_bound_mps2;
  return plumb::c_api::answer(PLUMB_OK);
}

plumb_error plumb_sensor_defaults(plumb_sensor* sensor) noexcept {
  if (sensor == nullptr) return plumb::c_api::missing(0);
  *sensor = plumb_sensor{};
  sensor->struct_size = sizeof(plumb_sensor);
  sensor->scale[0] = 1.0;
  sensor->reference_degc = 25.0;
  const plumb::Prior prior;
  sensor->prior_bias_mps2 = prior.bias_mps2;
  sensor->prior_scale = prior.scale;
  sensor->prior_axis_rad = prior.axis_rad;
  return plumb::c_api::answer(PLUMB_OK);
}

plumb_error plumb_sample_defaults(plumb_sample* sample) noexcept {
  if (sample == nullptr) return plumb::c_api::missing(0);
  *sample = plumb_sample{};
  sample->struct_size = sizeof(plumb_sample);
  sample->temperature_degc = 25.0;
  sample->count = 1;
  return plumb::c_api::answer(PLUMB_OK);
}

plumb_error plumb_verdict_defaults(plumb_verdict* verdict) noexcept {
  if (verdict == nullptr) return plumb::c_api::missing(0);
  plumb::c_api::no_verdict(*verdict);
  return plumb::c_api::answer(PLUMB_OK);
}

}  // extern "C"
