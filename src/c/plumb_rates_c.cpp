// Redundant gyros behind the C header: copies in, one call, copies out. Nothing is decided here.
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <type_traits>

#include "motion_c.hpp"
#include "plumb/c/plumb_rates.h"
#include "plumb/motion/median_rate.hpp"
#include "plumb/motion/rate_monitor.hpp"

/// What stands in the storage of the caller.
struct plumb_rates {
  std::uint64_t alive = 0;
  plumb::RateMonitor monitor;
};

namespace {

using namespace plumb;
using namespace plumb::c_api;

constexpr std::uint64_t kRatesAlive = 0x706c756d622d7231ULL;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

static_assert(std::is_trivially_destructible<plumb_rates>::value, "storage may simply be dropped");
static_assert(kMotionCapacity <= PLUMB_C_MOTION_SENSORS && kMostTriads == PLUMB_C_TRIADS,
              "the header has room for all");

RateSetup rate_setup_of(const plumb_rates_config& config) noexcept {
  RateSetup out;
  for (size_t k = 0; k < static_cast<size_t>(config.axes); ++k) {
    const plumb_gyro_axis& from = config.axis[k];
    out.errors[k] = {from.scale_bound, from.axis_bound_rad, from.bias_bound_radps, from.lag_bound_s,
                     from.g_sensitivity_bound_s_per_m};
  }
  out.max_faults = config.max_faults;
  std::copy(config.block_samples, config.block_samples + kMotionScales, out.block_samples.begin());
  out.sample_period_s = config.sample_period_s;
  out.rate_bound_radps = config.rate_bound_radps;
  out.force_bound_mps2 = config.force_bound_mps2;
  out.at_rest_radps = config.at_rest_radps;
  out.false_alarms_per_hour = config.false_alarms_per_hour;
  out.dwell_s = config.dwell_s;
  out.quiet_s = config.quiet_s;
  return out;
}

RateSample sample_of(const plumb_rates_sample& from) noexcept {
  RateSample out;
  out.time_s = from.time_s;
  std::copy(from.rate_radps, from.rate_radps + kMotionCapacity, out.rate_radps.begin());
  out.delivered = SensorSet(from.delivered);
  out.clipped = SensorSet(from.clipped);
  out.force_mps2 = from.force_mps2;
  out.at_rest = from.at_rest != 0;
  return out;
}

plumb_angular_rate rate_for_c(const AngularRate& from) noexcept {
  plumb_angular_rate out{};
  out.validity = static_cast<std::int32_t>(from.validity);
  out.used = from.used.bits;
  out.time_s = from.time_s;
  out.span_s = from.span_s;
  std::copy(from.rate_radps.begin(), from.rate_radps.end(), out.rate_radps);
  std::copy(from.covariance_rad2ps2.begin(), from.covariance_rad2ps2.end(), out.covariance_rad2ps2);
  out.bound_radps = from.bound_radps;
  return out;
}

plumb_rates_verdict verdict_of(const RateVerdict& from) noexcept {
  plumb_rates_verdict out{};
  out.struct_size = sizeof out;
  out.suspects = from.suspects.bits;
  out.isolated = from.isolated.bits;
  out.excluded = from.excluded.bits;
  out.off_at_rest = from.off_at_rest.bits;
  out.alarm = from.alarm ? 1 : 0;
  out.turned_at_rest = from.turned_at_rest ? 1 : 0;
  out.block_ended = from.block_ended ? 1 : 0;
  out.cause = static_cast<std::int32_t>(from.cause);
  out.sample = rate_for_c(from.sample);
  out.block = rate_for_c(from.block);
  return out;
}

/// What stood in the verdict before is not the answer to this call, and must not be taken for it.
plumb_error without_rates(const plumb_error& e, plumb_rates_verdict* verdict) noexcept {
  if (verdict != nullptr && check_struct(verdict, 0).code == PLUMB_OK) *verdict = verdict_of(RateVerdict{});
  return e;
}

plumb_error not_below_zero(double value, int index) noexcept {
  if (!std::isfinite(value)) return answer({Errc::not_finite, index, value, 0.0});
  return value < 0.0 ? answer({Errc::out_of_range, index, value, 0.0}) : answer(PLUMB_OK);
}

plumb_error check_bounds(const plumb_triad_bounds* b, double rate_radps) noexcept {
  plumb_error e = check_struct(b, 0);
  if (e.code != PLUMB_OK) return e;
  const double values[] = {b->scale, b->axis_rad, b->bias_radps, b->noise_radps, b->noise_in_sigmas, rate_radps};
  for (int i = 0; i < 6 && e.code == PLUMB_OK; ++i) e = not_below_zero(values[i], i);
  return e;
}

}  // namespace

extern "C" {

plumb_error plumb_gyro_axis_defaults(plumb_gyro_axis* axis) noexcept {
  if (axis == nullptr) return missing(0);
  *axis = plumb_gyro_axis{};
  axis->struct_size = sizeof(plumb_gyro_axis);
  return answer(PLUMB_OK);
}

plumb_error plumb_rates_config_defaults(plumb_rates_config* config) noexcept {
  if (config == nullptr) return missing(0);
  const RateSetup d;
  *config = plumb_rates_config{};
  config->struct_size = sizeof(plumb_rates_config);
  config->max_faults = d.max_faults;
  std::copy(d.block_samples.begin(), d.block_samples.end(), config->block_samples);
  config->sample_period_s = d.sample_period_s;
  config->rate_bound_radps = d.rate_bound_radps;
  config->force_bound_mps2 = d.force_bound_mps2;
  config->at_rest_radps = d.at_rest_radps;
  config->false_alarms_per_hour = d.false_alarms_per_hour;
  config->dwell_s = d.dwell_s;
  config->quiet_s = d.quiet_s;
  return answer(PLUMB_OK);
}

plumb_error plumb_rates_sample_defaults(plumb_rates_sample* sample) noexcept {
  if (sample == nullptr) return missing(0);
  *sample = plumb_rates_sample{};
  sample->struct_size = sizeof(plumb_rates_sample);
  sample->force_mps2 = -1.0;
  return answer(PLUMB_OK);
}

plumb_error plumb_rates_verdict_defaults(plumb_rates_verdict* verdict) noexcept {
  if (verdict == nullptr) return missing(0);
  *verdict = verdict_of(RateVerdict{});
  return answer(PLUMB_OK);
}

size_t plumb_rates_size(void) noexcept { return sizeof(plumb_rates); }
size_t plumb_rates_align(void) noexcept { return alignof(plumb_rates); }

plumb_error plumb_rates_init(void* storage, size_t storage_size, const plumb_rates_config* config,
                             plumb_rates** rates) noexcept {
  if (rates == nullptr) return missing(3);
  *rates = nullptr;
  plumb_error e = room_for<plumb_rates>(storage, storage_size, 0);
  if (e.code == PLUMB_OK) e = check_struct(config, 2);
  SensorArray array;
  if (e.code == PLUMB_OK) e = read_array(config->axis, config->axes, &plumb_gyro_axis::sigma_radps, 2, array);
  if (e.code != PLUMB_OK) return e;
  auto* made = new (storage) plumb_rates;
  e = answer(made->monitor.configure(array, rate_setup_of(*config)));
  if (e.code != PLUMB_OK) return e;
  made->alive = kRatesAlive;
  *rates = made;
  return e;
}

plumb_error plumb_rates_step(plumb_rates* rates, const plumb_rates_sample* sample,
                             plumb_rates_verdict* verdict) noexcept {
  plumb_error e = check_alive(rates, kRatesAlive, 0);
  if (e.code == PLUMB_OK) e = check_struct(sample, 1);
  if (e.code == PLUMB_OK && verdict != nullptr) e = check_struct(verdict, 2);
  if (e.code != PLUMB_OK) return without_rates(e, verdict);
  const RateVerdict& found = rates->monitor.step(sample_of(*sample));
  if (verdict != nullptr) *verdict = verdict_of(found);
  return e;
}

plumb_error plumb_rates_forget(plumb_rates* rates) noexcept {
  const plumb_error e = check_alive(rates, kRatesAlive, 0);
  if (e.code == PLUMB_OK) rates->monitor.forget();
  return e;
}

plumb_error plumb_triad_rates_defaults(plumb_triad_rates* rates) noexcept {
  if (rates == nullptr) return missing(0);
  *rates = plumb_triad_rates{};
  rates->struct_size = sizeof(plumb_triad_rates);
  rates->faults = 1;
  return answer(PLUMB_OK);
}

plumb_error plumb_median_rate(const plumb_triad_rates* rates, double rate_radps[3], std::int32_t* given) noexcept {
  if (given != nullptr) *given = 0;
  if (rate_radps != nullptr) std::fill(rate_radps, rate_radps + 3, 0.0);
  const plumb_error e = check_struct(rates, 0);
  if (e.code != PLUMB_OK) return e;
  if (rate_radps == nullptr) return missing(1);
  if (given == nullptr) return missing(2);
  if (rates->triads < 0 || rates->triads > kMostTriads)
    return answer({Errc::out_of_range, 0, static_cast<double>(rates->triads), static_cast<double>(kMostTriads)});
  TriadRates triads;
  triads.triads = rates->triads;
  for (size_t k = 0; k < static_cast<size_t>(kMostTriads); ++k) {
    triads.given[k] = (rates->given >> k & 1U) != 0;
    std::copy(rates->rate_radps[k], rates->rate_radps[k] + 3, triads.rate_radps[k].begin());
  }
  const MedianRate median = median_rate(triads, rates->faults);
  *given = median.given ? 1 : 0;
  std::copy(median.rate_radps.begin(), median.rate_radps.end(), rate_radps);
  return e;
}

plumb_error plumb_triad_bounds_defaults(plumb_triad_bounds* bounds) noexcept {
  if (bounds == nullptr) return missing(0);
  *bounds = plumb_triad_bounds{};
  bounds->struct_size = sizeof(plumb_triad_bounds);
  bounds->noise_in_sigmas = 6.0;
  return answer(PLUMB_OK);
}

plumb_error plumb_median_error(const plumb_triad_bounds* bounds, double rate_radps, double* error_radps) noexcept {
  if (error_radps == nullptr) return missing(2);
  *error_radps = kNoLimit;
  const plumb_error e = check_bounds(bounds, rate_radps);
  if (e.code != PLUMB_OK) return e;
  const GyroErrors triad{bounds->scale, bounds->axis_rad, bounds->bias_radps, bounds->noise_radps, 0.0};
  *error_radps = median_error_radps(triad, rate_radps, bounds->noise_in_sigmas);
  return e;
}

}  // extern "C"
