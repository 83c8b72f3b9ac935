#include "plumb/health/detail/intake.hpp"

#include <cmath>

#include "plumb/core/detail/archive.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using archive_detail::bits_of;
using std::size_t;

namespace {

/// In place: a call for every reading would be felt in a step.
[[gnu::always_inline]] inline void keep(int i, double v, Readings& y, GateResult& gate) noexcept {
  const auto a = static_cast<size_t>(i);
  const double size = std::fabs(v);
  if (size <= kReadingClamp_mps2) {  // a NaN is not
    y[a] = v;
  } else if (size <= std::numeric_limits<double>::max()) {
    y[a] = std::copysign(kReadingClamp_mps2, v);
  } else {
    y[a] = 0.0;
    gate.usable = gate.usable.without(i);
    gate.not_finite = gate.not_finite.with(i);
  }
}

}  // namespace

Arrival SampleClock::admit(double time_s, double max_gap_s) noexcept {
  if (!std::isfinite(time_s)) return Arrival::refused;
  Arrival arrival = Arrival::in_order;
  if (!started_ && refused_run_ > 0) {
    arrival = Arrival::new_time_base;
  } else if (started_ && !(time_s > last_s_)) {
    const bool goes_on = refused_run_ > 0 && time_s > last_refused_s_;
    refused_run_ = goes_on ? refused_run_ + 1 : 1;
    last_refused_s_ = time_s;
    if (refused_run_ < kNewTimeBase) return Arrival::refused;
    arrival = Arrival::new_time_base;
  } else if (started_ && time_s - last_s_ > max_gap_s) {
    arrival = Arrival::after_gap;
  }
  refused_run_ = 0;
  started_ = true;
  last_s_ = time_s;
  return arrival;
}

void CoefficientsAt::take(const SensorModel& model, double temperature_degc) noexcept {
  // With its sign: 0 and -0 are not the same argument of a cubic.
  if (temperature_degc == temperature_degc_ && std::signbit(temperature_degc) == std::signbit(temperature_degc_))
    return;
  for (int i = 0; i < model.size; ++i) {
    const double scale = model.scale_at(i, temperature_degc);
    // A product costs a sixth of a quotient where both are made in software.
    scale_[static_cast<size_t>(i)] = kSingle && scale != 0.0 ? 1.0 / scale : scale;
    bias_mps2_[static_cast<size_t>(i)] = model.bias_at(i, temperature_degc);
  }
  temperature_degc_ = temperature_degc;
}

bool CoefficientsAt::hold(const SensorModel& model) const noexcept {
  if (std::isnan(temperature_degc_)) return true;  // they will be taken before they are used
  CoefficientsAt fresh;
  fresh.take(model, temperature_degc_);
  for (size_t a = 0; a < static_cast<size_t>(model.size); ++a) {
    const bool same_scale = bits_of(scale_[a]) == bits_of(fresh.scale_[a]);
    if (!same_scale || bits_of(bias_mps2_[a]) != bits_of(fresh.bias_mps2_[a])) return false;
  }
  return true;
}

void keep_reading(int i, double v, Readings& y, GateResult& gate) noexcept { keep(i, v, y, gate); }

Readings readings_of(const SensorModel& model, CoefficientsAt& kept, const Sample& sample, double temperature_degc,
                     GateResult& gate) noexcept {
  kept.take(model, std::isfinite(sample.temperature_degc) ? sample.temperature_degc : temperature_degc);
  const double sign = model.reads == Reads::gravity ? 1.0 : -1.0;
  Readings y{};
  for (int i = 0; i < model.size; ++i) {
    if (!gate.usable.has(i)) continue;
    const auto a = static_cast<size_t>(i);
    // A cubic scale factor may pass through zero far from its calibrated span: what comes of it is not finite.
    const double scale = kept.scale(a);
    double v = std::numeric_limits<double>::quiet_NaN();
    if (scale != 0.0) {
      const double specific_force = kSingle ? sample.raw[a] * scale : sample.raw[a] / scale;
      v = sign * (specific_force - kept.bias_mps2(a));
    }
    keep(i, v, y, gate);
  }
  return y;
}

Readings readings_of(const SensorModel& model, const Sample& sample, double temperature_degc,
                     GateResult& gate) noexcept {
  CoefficientsAt nothing;
  return readings_of(model, nothing, sample, temperature_degc, gate);
}

/// y = h.g is what the sensors feel of gravity; turning adds -h.(w x (w x r)). A rate or an arm that the host got wrong
/// may make of a reading what is no reading.
Readings Intake::read(const InForce& in_force, const Settings& settings, const Sample& sample,
                      GateResult& gate_result) noexcept {
  Readings y = readings_of(in_force.model, coefficients, sample, temperature_degc, gate_result);
  if (!rotation.turning || !models_rotation(settings)) return y;
  const Vec3& w = rotation.rate_radps;
  for (int i = 0; i < in_force.array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    if (!gate_result.usable.has(i)) continue;
    const double turning = dot(in_force.array.axis(i), cross(w, cross(w, settings.lever_arm_m[a])));
    keep_reading(i, y[a] + turning, y, gate_result);
  }
  return y;
}

SensorSet SilenceCounter::note(SensorSet usable, int n, int confirm) noexcept {
  SensorSet silent;
  for (int i = 0; i < n; ++i) {
    std::uint16_t& run = run_[static_cast<size_t>(i)];
    run = static_cast<std::uint16_t>(usable.has(i) ? 0 : run + (run < confirm ? 1 : 0));
    if (run >= confirm) silent = silent.with(i);
  }
  return silent == SensorSet::first(n) ? SensorSet{} : silent;
}

SensorSet SilenceCounter::close(int n, int confirm) noexcept {
  SensorSet usable;
  for (int i = 0; i < n; ++i) {
    if (2 * missed_[static_cast<size_t>(i)] <= rows_) usable = usable.with(i);
  }
  missed_.fill(0);
  rows_ = 0;
  return note(usable, n, confirm);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
