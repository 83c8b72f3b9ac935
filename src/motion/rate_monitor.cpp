#include "plumb/motion/rate_monitor.hpp"

#include <cmath>
#include <new>

#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

constexpr double kMostSensitivity_s_per_m = 1.0;
constexpr double kMostSensedForce_mps2 = 1e5;
constexpr double kMostAtRest_radps = 10.0;

bool in_range(double value, double most) noexcept { return value >= 0.0 && value <= most; }

Expected<void> within_or_fail(double value, double most, int index) noexcept {
  if (!std::isfinite(value)) return fail(Errc::not_finite, index, value);
  if (!in_range(value, most)) return fail(Errc::out_of_range, index, value, value < 0.0 ? 0.0 : most);
  return {};
}

/// Rates in the place of forces; the terms that lever arms and vibration add are zero.
MotionSetup parity_setup(const SensorArray& array, const RateSetup& setup) noexcept {
  MotionSetup out;
  out.sample_period_s = setup.sample_period_s;
  for (std::size_t k = 0; k < static_cast<std::size_t>(array.size()); ++k) {
    const RateErrors& e = setup.errors[k];
    MotionErrors& to = out.errors[k];
    to.lag_s = e.lag_s;
    to.scale = e.scale;
    to.axis_rad = e.axis_rad;
    to.bias_mps2 = e.bias_radps;
  }
  out.gyros = 0;
  out.rate_bound_radps = setup.rate_bound_radps;  // of lever arms, which are zero: any bound makes the term known
  out.force_bound_mps2 = setup.rate_bound_radps;
  out.false_alarms_per_hour = setup.false_alarms_per_hour;
  out.dwell_s = setup.dwell_s;
  out.quiet_s = setup.quiet_s;
  out.max_faults = setup.max_faults;
  out.block_samples = setup.block_samples;
  return out;
}

AngularRate rate_of(const SpecificForce& found) noexcept {
  AngularRate out;
  out.validity = found.validity;
  out.time_s = found.time_s;
  out.span_s = found.span_s;
  out.rate_radps = found.force_mps2;
  out.covariance_rad2ps2 = found.covariance_m2ps4;
  out.bound_radps = found.bound_mps2;
  out.used = found.used;
  return out;
}

/// What the sample says counts, beyond the stated bound too: with less a healthy axis would be off.
double most_force_of(const RateSample& sample, const RateSetup& setup) noexcept {
  return in_range(sample.force_mps2, kMostSensedForce_mps2) ? sample.force_mps2 : setup.force_bound_mps2;
}

/// Of tests that each axis takes once a block at rest.
double rest_quantile(const RateSetup& setup, int axes) noexcept {
  const double tests_per_hour = axes * 3600.0 / (setup.block_samples[2] * setup.sample_period_s);
  return normal_tail_quantile(0.5 * setup.false_alarms_per_hour / (tests_per_hour > 1.0 ? tests_per_hour : 1.0));
}

}  // namespace

Expected<void> RateMonitor::configure(const SensorArray& array, const RateSetup& setup) noexcept {
  if (const auto sound = within_or_fail(setup.at_rest_radps, kMostAtRest_radps, 120); !sound) return sound;
  if (const auto sound = within_or_fail(setup.force_bound_mps2, kMostSensedForce_mps2, 121); !sound) return sound;
  for (int i = 0; i < array.size(); ++i) {
    const double g = setup.errors[static_cast<std::size_t>(i)].g_sensitivity_s_per_m;
    if (const auto sound = within_or_fail(g, kMostSensitivity_s_per_m, i); !sound) return sound;
  }
  if (!(setup.rate_bound_radps > 0.0)) return fail(Errc::out_of_range, 107, setup.rate_bound_radps, 0.0);
  new (this) RateMonitor();  // in place, as all that is large: not on the stack
  if (const auto sound = parity_.configure(array, parity_setup(array, setup)); !sound) return sound;
  array_ = array;
  setup_ = setup;
  rest_quantile_ = rest_quantile(setup, array.size());
  configured_ = true;
  return {};
}

void RateMonitor::forget() noexcept {
  parity_.forget();
  rest_ = Rest{};
  verdict_.off_at_rest = SensorSet{};
  verdict_.turned_at_rest = false;
  parity_.set_in_service(array_.all());
}

/// A healthy axis reads its bias, what the tool turns by, and noise. That one reads more is no fault of it while one
/// rate explains all axes: the host may be wrong about rest, above all where the tool turns about the vertical, which
/// no accelerometer feels. So rest only decides between those whom parity suspects (docs/theory.md, T17).
void RateMonitor::judge_rest() noexcept {
  SensorSet off;
  const double n = rest_.samples;
  for (int i = 0; i < array_.size(); ++i) {
    if (!rest_.delivered.has(i)) continue;
    const auto k = static_cast<std::size_t>(i);
    const RateErrors& e = setup_.errors[k];
    const double limit = e.bias_radps + setup_.at_rest_radps * (1.0 + e.scale + e.axis_rad) +
                         e.g_sensitivity_s_per_m * rest_.largest_force_mps2 +
                         rest_quantile_ * array_.sigma_mps2(i) / std::sqrt(n);
    if (!(std::fabs(rest_.sum_radps[k]) <= limit * n)) off = off.with(i);
  }
  const SensorSet silent = array_.all() - rest_.delivered;
  const MotionVerdict& parity = parity_.verdict();
  // Without a suspect although readings contradict: the axes are too few to name any, and rest decides between all.
  const SensorSet suspected = !parity.alarm ? SensorSet() : parity.suspects.empty() ? array_.all() : parity.suspects;
  verdict_.off_at_rest = (off & suspected) | (verdict_.off_at_rest & (off | silent));
  verdict_.turned_at_rest = !(off - parity.excluded).empty() && verdict_.off_at_rest.empty();
  parity_.set_in_service(array_.all() - verdict_.off_at_rest);
}

void RateMonitor::watch_rest(const RateSample& sample) noexcept {
  const double step_s = sample.time_s - rest_.last_s;
  const bool goes_on =
      rest_.samples > 0 && step_s > 0.5 * setup_.sample_period_s && step_s < 1.5 * setup_.sample_period_s;
  if (!goes_on) rest_ = Rest{};
  if (!sample.at_rest || !std::isfinite(sample.time_s)) {
    rest_ = Rest{};
    return;
  }
  const SensorSet here = sample.delivered & array_.all();
  rest_.delivered = rest_.samples == 0 ? here : rest_.delivered & here;
  for (int i = 0; i < array_.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double y = sample.rate_radps[k];
    if (here.has(i) && std::fabs(y) <= kMostRate_radps) {
      rest_.sum_radps[k] += y;
    } else {
      rest_.delivered = rest_.delivered.without(i);
    }
  }
  const double force_mps2 = most_force_of(sample, setup_);
  if (force_mps2 > rest_.largest_force_mps2) rest_.largest_force_mps2 = force_mps2;
  rest_.last_s = sample.time_s;
  if (++rest_.samples < setup_.block_samples[2]) return;
  judge_rest();
  rest_ = Rest{};
}

const RateVerdict& RateMonitor::step(const RateSample& sample) noexcept {
  if (!configured_) return verdict_;
  watch_rest(sample);
  MotionSample as_force;
  as_force.time_s = sample.time_s;
  as_force.reading_mps2 = sample.rate_radps;
  as_force.delivered = sample.delivered;
  as_force.clipped = sample.clipped;
  const double force_mps2 = most_force_of(sample, setup_);
  for (std::size_t k = 0; k < static_cast<std::size_t>(array_.size()); ++k)
    as_force.interpolation_mps2[k] = setup_.errors[k].g_sensitivity_s_per_m * force_mps2;
  const MotionVerdict& found = parity_.step(as_force);
  verdict_.sample = rate_of(found.sample);
  if (found.block_ended || found.block.validity == ForceValidity::none) verdict_.block = rate_of(found.block);
  verdict_.block_ended = found.block_ended;
  verdict_.alarm = found.alarm || !verdict_.off_at_rest.empty();
  verdict_.suspects = found.suspects;
  verdict_.isolated = found.isolated | verdict_.off_at_rest;
  verdict_.excluded = found.excluded;
  verdict_.cause = found.cause;
  return verdict_;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
