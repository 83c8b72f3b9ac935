#include "plumb/health/intake.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

Arrival SampleClock::admit(double time_s, double max_gap_s) noexcept {
  if (!std::isfinite(time_s)) return Arrival::refused;
  Arrival arrival = Arrival::in_order;
  if (started_ && !(time_s > last_s_)) {
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

Readings readings_of(const SensorModel& model, const Sample& sample, double temperature_degc,
                     GateResult& gate) noexcept {
  const bool known = std::isfinite(sample.temperature_degc);
  Readings y = model.without_misalignment(sample.raw, known ? sample.temperature_degc : temperature_degc, gate.usable);
  for (int i = 0; i < model.size; ++i) {
    double& v = y[static_cast<size_t>(i)];
    if (!std::isfinite(v)) {
      gate.usable = gate.usable.without(i);
      gate.not_finite = gate.not_finite.with(i);
      v = 0.0;
    } else {
      v = std::fmin(std::fmax(v, -kReadingClamp_mps2), kReadingClamp_mps2);
    }
  }
  return y;
}

SensorSet SilenceCounter::note(SensorSet usable, int n, int confirm) noexcept {
  SensorSet silent;
  for (int i = 0; i < n; ++i) {
    int& run = run_[static_cast<size_t>(i)];
    run = usable.has(i) ? 0 : run + (run < confirm ? 1 : 0);
    if (run >= confirm) silent = silent.with(i);
  }
  return silent == SensorSet::first(n) ? SensorSet{} : silent;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
