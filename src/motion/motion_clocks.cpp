#include "plumb/motion/motion_clocks.hpp"

#include <cmath>
#include <new>

#include "clock_limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

constexpr double kLeastStep = 0.9, kMostStep = 1.1;  // of the sample period of a chip, as T14 takes it
constexpr std::uint64_t kBefore = 2, kAfter = 3;     // samples before the last one and after it that count
constexpr std::uint64_t kRemembered = 16;            // samples whose fourth differences count
/// By which the fourth derivative of vibration below a quarter of the sample rate may pass the largest fourth
/// difference: 1 / (cos(pi/4) sinc(pi/4)^4) (T14).
constexpr double kBetweenSamples = 2.16;

std::size_t slot(std::uint64_t number) noexcept {
  return static_cast<std::size_t>(number % static_cast<std::uint64_t>(kClockSamples));
}

/// The divided difference of values that stand at `time`.
template <std::size_t N>
double divided(const std::array<double, N>& time_s, const std::array<double, N>& value) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < N; ++i) {
    double apart = 1.0;
    for (std::size_t j = 0; j < N; ++j) apart *= i == j ? 1.0 : time_s[i] - time_s[j];
    sum += value[i] / apart;
  }
  return std::fabs(sum);
}

}  // namespace

const char* to_string(ClockPush push) noexcept {
  switch (push) {
    case ClockPush::taken: return "taken";
    case ClockPush::began_anew: return "began_anew";
    case ClockPush::not_configured: return "not_configured";
    case ClockPush::unknown_clock: return "unknown_clock";
    case ClockPush::not_finite: return "not_finite";
    case ClockPush::out_of_order: return "out_of_order";
    case ClockPush::not_valid: return "not_valid";
  }
  return "?";
}

Expected<void> MotionClocks::configure(const SensorArray& array, const MotionSetup& setup,
                                       const ClockSetup& clocks) noexcept {
  if (const Expected<void> sound = check(array, setup); !sound) return sound;
  if (const Expected<void> sound = check(array, setup, clocks); !sound) return sound;
  new (this) MotionClocks();  // in place, as all that is large: not on the stack
  setup_ = clocks;
  period_s_ = setup.sample_period_s;
  for (std::size_t c = 0; c < static_cast<std::size_t>(clocks.clocks); ++c) {
    const MotionClock& clock = clocks.clock[c];
    lag_s_[c] = clock.offset_bound_s + clock.rate_bound * clock.valid_s;
  }
  configured_ = true;
  return {};
}

Expected<void> MotionClocks::set_clock(int clock, double offset_s, double rate, double since_s) noexcept {
  if (!configured_ || clock < 0 || clock >= setup_.clocks) return fail(Errc::out_of_range, clock, clock, setup_.clocks);
  MotionClock& one = setup_.clock[static_cast<std::size_t>(clock)];
  MotionClock changed = one;
  changed.offset_s = offset_s;
  changed.rate = rate;
  changed.since_s = since_s;
  if (const Expected<void> sound = check_clock(changed, clock, period_s_); !sound) return sound;
  one = changed;
  return {};
}

ClockPush MotionClocks::push(int clock, const MotionSample& sample) noexcept {
  if (!configured_) return ClockPush::not_configured;
  if (clock < 0 || clock >= setup_.clocks) return ClockPush::unknown_clock;
  const auto c = static_cast<std::size_t>(clock);
  const MotionClock& one = setup_.clock[c];
  if (!(std::fabs(sample.time_s) <= kMostTime_s)) return ClockPush::not_finite;
  const double since_s = sample.time_s - one.since_s;
  if (!(std::fabs(since_s) <= one.valid_s)) return ClockPush::not_valid;
  const double time_s = sample.time_s - one.offset_s - one.rate * since_s;
  Ring& ring = ring_[c];
  ClockPush out = ClockPush::taken;
  if (ring.end > ring.first) {
    const double step_s = time_s - ring.time_s[slot(ring.end - 1)];
    if (step_s >= 0.0 && step_s < kLeastStep * one.sample_period_s) return ClockPush::out_of_order;
    if (step_s < 0.0 || step_s > kMostStep * one.sample_period_s) {
      ring.first = ring.end;
      out = ClockPush::began_anew;
    }
  }
  keep(c, time_s, sample);
  bend(c);
  return out;
}

void MotionClocks::keep(std::size_t clock, double time_s, const MotionSample& sample) noexcept {
  Ring& ring = ring_[clock];
  const MotionClock& one = setup_.clock[clock];
  const std::size_t k = slot(ring.end);
  ring.time_s[k] = time_s;
  ring.delivered[k] = SensorSet{};
  ring.clipped[k] = sample.clipped & one.sensors;
  ring.rates[k] = 0;
  for (std::size_t i = 0; i < kSensors; ++i) {
    const int sensor = static_cast<int>(i);
    if (!one.sensors.has(sensor)) continue;
    fourth_mps6_[i][k] = 0.0;
    reading_mps2_[i][k] = sample.reading_mps2[i];
    if (sample.delivered.has(sensor) && std::fabs(sample.reading_mps2[i]) <= kMostReading_mps2)
      ring.delivered[k] = ring.delivered[k].with(sensor);
  }
  for (std::size_t g = 0; g < static_cast<std::size_t>(kGyros); ++g) {
    if (!one.gyro[g]) continue;
    fourth_radps5_[g][k] = 0.0;
    rate_radps_[g][k] = sample.rate_radps[g];
    if (sample.rate_given[g] && norm(sample.rate_radps[g]) <= kMostRate_radps)
      ring.rates[k] = static_cast<std::uint8_t>(ring.rates[k] | (1U << g));
  }
  ++ring.end;
  if (ring.end - ring.first > kSlots) ring.first = ring.end - kSlots;
}

/// The fourth differences about the sample two before the newest.
void MotionClocks::bend(std::size_t clock) noexcept {
  const Ring& ring = ring_[clock];
  if (ring.end - ring.first < 5) return;
  std::array<std::size_t, 5> at{};
  std::array<double, 5> time_s{}, value{};
  SensorSet delivered = setup_.clock[clock].sensors;
  unsigned rates = (1U << kGyros) - 1U;
  for (std::size_t a = 0; a < 5; ++a) {
    at[a] = slot(ring.end - 5 + a);
    time_s[a] = ring.time_s[at[a]] - ring.time_s[at[0]];
    delivered = delivered & ring.delivered[at[a]];
    rates &= ring.rates[at[a]];
  }
  for (std::size_t i = 0; i < kSensors; ++i) {
    if (!delivered.has(static_cast<int>(i))) continue;
    for (std::size_t a = 0; a < 5; ++a) value[a] = reading_mps2_[i][at[a]];
    fourth_mps6_[i][at[2]] = divided(time_s, value);
  }
  for (std::size_t g = 0; g < static_cast<std::size_t>(kGyros); ++g) {
    if ((rates >> g & 1U) == 0) continue;
    Vec3 fourth{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t a = 0; a < 5; ++a) value[a] = rate_radps_[g][at[a]][axis];
      fourth[axis] = divided(time_s, value);
    }
    fourth_radps5_[g][at[2]] = norm(fourth);
  }
}

/// Whether as many samples beyond the instant have come as count for it.
bool MotionClocks::passed(const Ring& ring, double time_s) const noexcept {
  return ring.end - ring.first >= kAfter && ring.time_s[slot(ring.end - kAfter)] > time_s;
}

MotionClocks::Place MotionClocks::place(const Ring& ring, double time_s) const noexcept {
  Place out;
  if (!passed(ring, time_s)) return out;
  std::uint64_t after = ring.end - kAfter;  // a sample beyond the instant
  while (after > ring.first && ring.time_s[slot(after - 1)] > time_s) --after;
  if (after < ring.first + kBefore + 1) return out;
  out.enclosed = true;
  out.number = after - 1;
  out.product_s4 = 1.0;
  for (std::size_t a = 0; a < 4; ++a) {
    const double at_s = ring.time_s[slot(out.number - 1 + a)];
    out.product_s4 *= std::fabs(time_s - at_s);
    out.weight[a] = 1.0;
    for (std::size_t b = 0; b < 4; ++b) {
      const double other_s = ring.time_s[slot(out.number - 1 + b)];
      if (a != b) out.weight[a] *= (time_s - other_s) / (at_s - other_s);
    }
  }
  return out;
}

/// What interpolation adds at most, by the fourth differences (T14), and what a shift of up to `lag_s` adds beyond the
/// first derivative, by the second ones. The limits take second differences of what is interpolated for those of the
/// signal, which costs the share of the lag.
double MotionClocks::more(double fourth, double second, const Place& at, double lag_s) const noexcept {
  return kBetweenSamples * (1.0 + 2.0 * lag_s / period_s_) * at.product_s4 * fourth + lag_s * lag_s * second;
}

void MotionClocks::draw_sensor(const Ring& ring, const Place& at, double lag_s, std::size_t sensor,
                               MotionSample& out) const noexcept {
  const int i = static_cast<int>(sensor);
  const auto& y = reading_mps2_[sensor];
  bool clipped = false, at_full_scale = true;
  for (std::uint64_t k = at.number - kBefore; k <= at.number + kAfter; ++k) {
    if (!ring.delivered[slot(k)].has(i)) return;
    const bool here = ring.clipped[slot(k)].has(i);
    clipped = clipped || here;
    at_full_scale = at_full_scale && here && (y[slot(k)] > 0.0) == (y[slot(at.number)] > 0.0);
  }
  if (clipped) out.clipped = out.clipped.with(i);
  if (clipped && !at_full_scale) return;  // between a reading and an inequality nothing can be interpolated
  const auto second_about = [&](std::uint64_t k) {
    const std::array<double, 3> time_s{ring.time_s[slot(k - 1)], ring.time_s[slot(k)], ring.time_s[slot(k + 1)]};
    return divided<3>(time_s, {y[slot(k - 1)], y[slot(k)], y[slot(k + 1)]});
  };
  double reading = 0.0, fourth = 0.0;
  for (std::size_t a = 0; a < 4; ++a) reading += at.weight[a] * y[slot(at.number - 1 + a)];
  const std::uint64_t first = at.number > ring.first + kRemembered ? at.number - kRemembered : ring.first;
  for (std::uint64_t k = first; k <= at.number + 1; ++k) fourth = std::fmax(fourth, fourth_mps6_[sensor][slot(k)]);
  out.reading_mps2[sensor] = reading;
  out.interpolation_mps2[sensor] =
      more(fourth, std::fmax(second_about(at.number), second_about(at.number + 1)), at, lag_s);
  out.delivered = out.delivered.with(i);
}

void MotionClocks::draw_gyro(const Ring& ring, const Place& at, double lag_s, std::size_t gyro,
                             MotionSample& out) const noexcept {
  for (std::uint64_t k = at.number - kBefore; k <= at.number + kAfter; ++k) {
    const unsigned rates = ring.rates[slot(k)];
    if ((rates >> gyro & 1U) == 0) return;
  }
  const auto& w = rate_radps_[gyro];
  const auto second_about = [&](std::uint64_t k) {
    const std::array<double, 3> time_s{ring.time_s[slot(k - 1)], ring.time_s[slot(k)], ring.time_s[slot(k + 1)]};
    Vec3 second{};
    for (std::size_t c = 0; c < 3; ++c)
      second[c] = divided<3>(time_s, {w[slot(k - 1)][c], w[slot(k)][c], w[slot(k + 1)][c]});
    return norm(second);
  };
  Vec3 rate{};
  double fourth = 0.0;
  for (std::size_t a = 0; a < 4; ++a) rate = plus(rate, scaled(w[slot(at.number - 1 + a)], at.weight[a]));
  const std::uint64_t first = at.number > ring.first + kRemembered ? at.number - kRemembered : ring.first;
  for (std::uint64_t k = first; k <= at.number + 1; ++k) fourth = std::fmax(fourth, fourth_radps5_[gyro][slot(k)]);
  out.rate_radps[gyro] = rate;
  out.interpolation_radps[gyro] =
      more(fourth, std::fmax(second_about(at.number), second_about(at.number + 1)), at, lag_s);
  out.rate_given[gyro] = true;
}

void MotionClocks::draw(std::size_t clock, double time_s, MotionSample& out) const noexcept {
  const Ring& ring = ring_[clock];
  const MotionClock& one = setup_.clock[clock];
  const Place at = place(ring, time_s);
  if (!at.enclosed) return;
  for (std::size_t i = 0; i < kSensors; ++i) {
    if (one.sensors.has(static_cast<int>(i))) draw_sensor(ring, at, lag_s_[clock], i, out);
  }
  for (std::size_t g = 0; g < static_cast<std::size_t>(kGyros); ++g) {
    if (one.gyro[g]) draw_gyro(ring, at, lag_s_[clock], g, out);
  }
}

bool MotionClocks::next(double now_s, MotionSample& out) noexcept {
  if (!configured_ || !(std::fabs(now_s) <= kMostTime_s)) return false;
  const double kept_s = kClockSamples * period_s_;
  double due_s = origin_s_ + static_cast<double>(drawn_) * period_s_;
  // The host's time has jumped, or was not told for so long that samples are gone.
  const bool lost = begun_ && (due_s < now_s - setup_.wait_s - kept_s || due_s > now_s + kept_s);
  if (!begun_ || lost) {
    begun_ = true;
    drawn_ = 0;
    origin_s_ = due_s = period_s_ * std::ceil((now_s - (lost ? setup_.wait_s : 0.0)) / period_s_);
  }
  bool all = true;
  const auto clocks = static_cast<std::size_t>(setup_.clocks);
  for (std::size_t c = 0; c < clocks; ++c) all = all && passed(ring_[c], due_s);
  if (!all && now_s < due_s + setup_.wait_s) return false;
  out = MotionSample{};
  out.time_s = due_s;
  for (std::size_t c = 0; c < clocks; ++c) draw(c, due_s, out);
  ++drawn_;
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
