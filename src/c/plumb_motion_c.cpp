// The monitor of motion behind the C header: copies in, one call, copies out. Nothing is decided here.
#include <algorithm>
#include <new>
#include <type_traits>

#include "motion_c.hpp"

namespace {

using namespace plumb;
using namespace plumb::c_api;

static_assert(kMotionCapacity <= PLUMB_C_MOTION_SENSORS && kGyros == PLUMB_C_GYROS, "the header has room for all");
static_assert(std::is_trivially_destructible<plumb_motion>::value, "storage may simply be dropped");

void take_motion_sensors(const plumb_motion_config& config, MotionSetup& setup) noexcept {
  for (size_t k = 0; k < static_cast<size_t>(config.sensors); ++k) {
    const plumb_motion_sensor& from = config.sensor[k];
    std::copy(from.lever_arm_m, from.lever_arm_m + 3, setup.lever_arm_m[k].begin());
    setup.errors[k] = {from.lever_bound_m, from.lag_bound_s,    from.rectification_bound,
                       from.scale_bound,   from.axis_bound_rad, from.bias_bound_mps2};
  }
}

void take_settings(const plumb_motion_config& config, MotionSetup& setup) noexcept {
  setup.sample_period_s = config.sample_period_s;
  setup.gyros = config.gyros;
  setup.gyro_corroborated = config.gyro_corroborated != 0;
  setup.gyro = {config.gyro_scale_bound, config.gyro_axis_bound_rad, config.gyro_bias_bound_radps,
                config.gyro_noise_radps, config.gyro_lag_bound_s};
  setup.rate_bound_radps = config.rate_bound_radps;
  setup.force_bound_mps2 = config.force_bound_mps2;
  setup.false_alarms_per_hour = config.false_alarms_per_hour;
  setup.dwell_s = config.dwell_s;
  setup.quiet_s = config.quiet_s;
  setup.max_faults = config.max_faults;
  setup.shortest_block = config.shortest_block;
  std::copy(config.block_samples, config.block_samples + kMotionScales, setup.block_samples.begin());
}

plumb_specific_force force_for_c(const SpecificForce& from) noexcept {
  plumb_specific_force out{};
  out.validity = static_cast<std::int32_t>(from.validity);
  out.dominant = static_cast<std::int32_t>(from.dominant);
  out.used = from.used.bits;
  out.gyro_assumed = from.gyro_assumed ? 1 : 0;
  out.time_s = from.time_s;
  out.span_s = from.span_s;
  std::copy(from.force_mps2.begin(), from.force_mps2.end(), out.force_mps2);
  std::copy(from.covariance_m2ps4.begin(), from.covariance_m2ps4.end(), out.covariance_m2ps4);
  out.bound_mps2 = from.bound_mps2;
  return out;
}

}  // namespace

namespace plumb {
inline namespace PLUMB_ABI {
namespace c_api {

plumb_error prepare(const plumb_motion_config* config, int argument, MotionProblem& out) noexcept {
  plumb_error e = check_struct(config, argument);
  if (e.code == PLUMB_OK)
    e = read_array(config->sensor, config->sensors, &plumb_motion_sensor::sigma_mps2, argument, out.array);
  if (e.code != PLUMB_OK) return e;
  take_motion_sensors(*config, out.setup);
  take_settings(*config, out.setup);
  return e;
}

plumb_motion_verdict verdict_of(const MotionVerdict& from) noexcept {
  plumb_motion_verdict out{};
  out.struct_size = sizeof out;
  out.rejected = from.rejected.bits;
  out.suspects = from.suspects.bits;
  out.isolated = from.isolated.bits;
  out.excluded = from.excluded.bits;
  out.alarm = from.alarm ? 1 : 0;
  out.block_ended = from.block_ended ? 1 : 0;
  out.least_faults = from.least_faults;
  out.cause = static_cast<std::int32_t>(from.cause);
  out.gyros_disagree = from.gyros_disagree ? 1 : 0;
  out.sample = force_for_c(from.sample);
  out.block = force_for_c(from.block);
  return out;
}

plumb_error without_verdict(const plumb_error& e, plumb_motion_verdict* verdict) noexcept {
  if (verdict != nullptr && check_struct(verdict, 0).code == PLUMB_OK) *verdict = verdict_of(MotionVerdict{});
  return e;
}

MotionSample sample_of(const plumb_motion_sample& from) noexcept {
  MotionSample out;
  out.time_s = from.time_s;
  std::copy(from.reading_mps2, from.reading_mps2 + kMotionCapacity, out.reading_mps2.begin());
  out.delivered = SensorSet(from.delivered);
  out.clipped = SensorSet(from.clipped);
  for (size_t g = 0; g < static_cast<size_t>(kGyros); ++g) {
    std::copy(from.rate_radps[g], from.rate_radps[g] + 3, out.rate_radps[g].begin());
    out.rate_given[g] = (from.rates_given >> g & 1U) != 0;
    out.interpolation_radps[g] = from.rate_error_radps[g];
  }
  return out;
}

}  // namespace c_api
}  // namespace PLUMB_ABI
}  // namespace plumb

extern "C" {

plumb_error plumb_motion_config_defaults(plumb_motion_config* config) noexcept {
  if (config == nullptr) return missing(0);
  const MotionSetup d;
  *config = plumb_motion_config{};
  config->struct_size = sizeof(plumb_motion_config);
  config->max_faults = d.max_faults;
  config->shortest_block = d.shortest_block;
  std::copy(d.block_samples.begin(), d.block_samples.end(), config->block_samples);
  config->sample_period_s = d.sample_period_s;
  config->force_bound_mps2 = d.force_bound_mps2;
  config->false_alarms_per_hour = d.false_alarms_per_hour;
  config->dwell_s = d.dwell_s;
  config->quiet_s = d.quiet_s;
  return answer(PLUMB_OK);
}

plumb_error plumb_motion_sensor_defaults(plumb_motion_sensor* sensor) noexcept {
  if (sensor == nullptr) return missing(0);
  *sensor = plumb_motion_sensor{};
  sensor->struct_size = sizeof(plumb_motion_sensor);
  return answer(PLUMB_OK);
}

plumb_error plumb_motion_sample_defaults(plumb_motion_sample* sample) noexcept {
  if (sample == nullptr) return missing(0);
  *sample = plumb_motion_sample{};
  sample->struct_size = sizeof(plumb_motion_sample);
  return answer(PLUMB_OK);
}

plumb_error plumb_motion_verdict_defaults(plumb_motion_verdict* verdict) noexcept {
  if (verdict == nullptr) return missing(0);
  *verdict = verdict_of(MotionVerdict{});
  return answer(PLUMB_OK);
}

const char* plumb_force_validity_text(std::int32_t validity) noexcept {
  return to_string(static_cast<ForceValidity>(number_of(validity)));
}
const char* plumb_force_term_text(std::int32_t term) noexcept {
  return to_string(static_cast<ForceTerm>(number_of(term)));
}
const char* plumb_motion_cause_text(std::int32_t cause) noexcept {
  return to_string(static_cast<MotionCause>(number_of(cause)));
}

std::int32_t plumb_motion_capacity(void) noexcept { return kMotionCapacity; }
size_t plumb_motion_size(void) noexcept { return sizeof(plumb_motion); }
size_t plumb_motion_align(void) noexcept { return alignof(plumb_motion); }

plumb_error plumb_motion_init(void* storage, size_t storage_size, const plumb_motion_config* config,
                              plumb_motion** motion) noexcept {
  if (motion == nullptr) return missing(3);
  *motion = nullptr;
  plumb_error e = room_for<plumb_motion>(storage, storage_size, 0);
  MotionProblem problem;
  if (e.code == PLUMB_OK) e = prepare(config, 2, problem);
  if (e.code != PLUMB_OK) return e;
  auto* made = new (storage) plumb_motion;
  e = answer(made->monitor.configure(problem.array, problem.setup));
  if (e.code != PLUMB_OK) return e;
  made->alive = kMotionAlive;
  *motion = made;
  return e;
}

plumb_error plumb_motion_step(plumb_motion* motion, const plumb_motion_sample* sample,
                              plumb_motion_verdict* verdict) noexcept {
  plumb_error e = check_alive(motion, kMotionAlive, 0);
  if (e.code == PLUMB_OK) e = check_struct(sample, 1);
  if (e.code == PLUMB_OK && verdict != nullptr) e = check_struct(verdict, 2);
  if (e.code != PLUMB_OK) return without_verdict(e, verdict);
  const MotionVerdict& found = motion->monitor.step(sample_of(*sample));
  if (verdict != nullptr) *verdict = verdict_of(found);
  return e;
}

plumb_error plumb_motion_set_in_service(plumb_motion* motion, std::uint32_t sensors) noexcept {
  const plumb_error e = check_alive(motion, kMotionAlive, 0);
  if (e.code == PLUMB_OK) motion->monitor.set_in_service(SensorSet(sensors));
  return e;
}

plumb_error plumb_motion_forget(plumb_motion* motion) noexcept {
  const plumb_error e = check_alive(motion, kMotionAlive, 0);
  if (e.code == PLUMB_OK) motion->monitor.forget();
  return e;
}

}  // extern "C"
