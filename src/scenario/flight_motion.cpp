#include "flight_motion.hpp"

#include <cmath>
#include <utility>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// Instants between two steps of a tone's frequency.
constexpr std::uint64_t kBlock = 64;

Vec3 weighted(const Vec3& a, const Vec3& weight) noexcept {
  return {a[0] * weight[0], a[1] * weight[1], a[2] * weight[2]};
}

double calm_end_s(std::uint64_t seed, double start_s) noexcept {
  return start_s + flight_stream_of(seed, flight_stream::kCourse).uniform(1U << 20U, 1.0, 2.0);
}

void advance(SinCos& now, const SinCos& step) noexcept {
  const double sine = now.sin * step.cos + now.cos * step.sin;
  now.cos = now.cos * step.cos - now.sin * step.sin;
  now.sin = sine;
}

}  // namespace

double Draws::log_uniform(double low, double high) noexcept {
  return portable_exp(uniform(portable_log(low), portable_log(high)));
}

Glide::Glide(const Vec3& start, double start_s, const Stream& stream, Law law)
    : draws_(stream), law_(std::move(law)), from_(start), end_s_(start_s) {}

Glide::Place Glide::at(double time_s) {
  while (time_s >= end_s_) {
    const GlideStep step = law_(number_++, draws_);
    from_ = plus(from_, way_);
    way_ = minus(step.level, from_);
    begin_s_ = end_s_;
    glide_s_ = step.glide_s;
    end_s_ = begin_s_ + step.glide_s + step.hold_s;
  }
  const double s = (time_s - begin_s_) / glide_s_;
  if (s >= 1.0 || number_ == 0) return {plus(from_, way_), {}};
  const double part = s * s * s * (10.0 + s * (6.0 * s - 15.0));
  const double slope = 30.0 * s * s * (1.0 - s) * (1.0 - s) / glide_s_;
  return {plus(from_, scaled(way_, part)), scaled(way_, slope)};
}

Motion::Band::Band(const Stream& stream, double rms, const std::array<double, 2>& band_hz, double step_s)
    : draws_(stream),
      gain_(0.0),
      fast_share_(1.0 - portable_exp(-2.0 * kPi * band_hz[1] * step_s)),
      slow_share_(1.0 - portable_exp(-2.0 * kPi * band_hz[0] * step_s)) {
  double fast = 0.0, slow = 0.0,
         sum = 0.0;  // the answer to one impulse: its square sum is the variance per unit of input
  const int last = static_cast<int>(20.0 / slow_share_);
  for (int k = 0; k < last; ++k) {
    fast += fast_share_ * ((k == 0 ? 1.0 : 0.0) - fast);
    slow += slow_share_ * (fast - slow);
    sum += (fast - slow) * (fast - slow);
  }
  gain_ = rms / std::sqrt(sum);
}

double Motion::Band::next() noexcept {
  fast_ += fast_share_ * (draws_.next() - fast_);
  slow_ += slow_share_ * (fast_ - slow_);
  return gain_ * (fast_ - slow_);
}

Motion::Motion(FlightKind kind, std::uint64_t seed, double step_s, double start_s, double vibration)
    : step_s_(step_s),
      factor_(vibration),
      law_(draw_motion(kind, seed)),
      force_(law_.force_mps2, calm_end_s(seed, start_s), flight_stream_of(seed, flight_stream::kForce), law_.force),
      rate_(law_.rate_radps, calm_end_s(seed, start_s), flight_stream_of(seed, flight_stream::kRate), law_.rate),
      level_({law_.level, 0.0, 0.0}, calm_end_s(seed, start_s), flight_stream_of(seed, flight_stream::kLevel),
             law_.vibration),
      shock_draws_(flight_stream_of(seed, flight_stream::kShock)),
      up_(law_.up),
      last_rate_radps_(law_.rate_radps) {
  std::uint32_t number = flight_stream::kTone;
  for (const auto& [tones, turning] :
       {std::pair(&law_.tones, &tones_), std::pair(&law_.angular_tones, &angular_tones_)}) {
    for (const Tone& tone : *tones) {
      const Stream stream = flight_stream_of(seed, number++);
      Turning one{tone, NormalSource(stream)};
      one.phase_rad = stream.uniform(0, 0.0, 2.0 * kPi);
      turning->push_back(one);
    }
  }
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    bands_.emplace_back(flight_stream_of(seed, flight_stream::kBroadband + axis), law_.broadband_mps2[axis],
                        law_.band_hz, step_s);
  }
  draw_shock(calm_end_s(seed, start_s));
}

void Motion::draw_shock(double after_s) noexcept {
  const ShockLaw& law = law_.shocks;
  shock_.begin_s = after_s + shock_draws_.uniform(law.gap_s[0], law.gap_s[1]);
  shock_.end_s = shock_.begin_s + shock_draws_.uniform(law.duration_s[0], law.duration_s[1]);
  const Vec3 way = weighted(shock_draws_.direction(), law.shape);
  const double length = norm(way);
  const double peak = shock_draws_.uniform(law.peak_mps2[0], law.peak_mps2[1]);
  shock_.peak_mps2 = length > 0.0 ? scaled(way, peak / length) : Vec3{0.0, 0.0, peak};
}

/// Phases are kept from block to block, so that rounding does not add up and the angular acceleration stays the
/// derivative.
void Motion::start_block() noexcept {
  for (std::vector<Turning>* all : {&tones_, &angular_tones_}) {
    for (Turning& one : *all) {
      one.phase_rad += one.step_rad * static_cast<double>(kBlock);
      while (one.phase_rad > 2.0 * kPi) one.phase_rad -= 2.0 * kPi;
      if (one.tone.wanders) one.wander = 0.95 * one.wander + 0.31 * one.wander_draws.next();
      const double limited = one.wander > 3.0 ? 3.0 : one.wander < -3.0 ? -3.0 : one.wander;
      one.step_rad = 2.0 * kPi * one.tone.frequency_hz * (1.0 + 0.02 * limited) * step_s_;
      one.now = portable_sincos(one.phase_rad);
      one.step = portable_sincos(one.step_rad);
    }
  }
}

Vec3 Motion::vibration_force(double time_s, double level) {
  Vec3 sum{};
  for (Turning& one : tones_) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += one.now.sin * one.tone.amplitude[k];
    advance(one.now, one.step);
  }
  for (std::size_t k = 0; k < 3; ++k) sum[k] = level * (sum[k] + bands_[k].next());
  if (!law_.shocks.any || time_s < shock_.begin_s) return sum;
  const double part = (time_s - shock_.begin_s) / (shock_.end_s - shock_.begin_s);
  if (part < 1.0) return plus(sum, scaled(shock_.peak_mps2, portable_sincos(kPi * part).sin));
  draw_shock(shock_.end_s);
  return sum;
}

/// Up in the tool frame one step later: du/dt = -w x u.
void Motion::turn_gravity(const Vec3& rate_radps) noexcept {
  const Vec3 turn = scaled(plus(rate_radps, last_rate_radps_), 0.5 * step_s_);
  const Vec3 way = cross(turn, up_);
  up_ = plus(minus(up_, way), scaled(cross(turn, way), 0.5));
  up_ = scaled(up_, 1.5 - 0.5 * dot(up_, up_));  // one step of Newton's towards length 1
}

MotionInstant Motion::next() {
  const double time_s = static_cast<double>(instant_) * step_s_;
  if (instant_ % kBlock == 0) start_block();
  const Glide::Place level = level_.at(time_s);
  const Glide::Place rate = rate_.at(time_s);
  MotionInstant out;
  out.rate_radps = rate.value;
  out.angular_acceleration_radps2 = rate.slope;
  for (Turning& one : angular_tones_) {
    const double turns = one.step_rad / step_s_;
    const double value = factor_ * level.value[0] * one.now.sin;
    const double slope = factor_ * (level.value[0] * turns * one.now.cos + level.slope[0] * one.now.sin);
    for (std::size_t k = 0; k < 3; ++k) {
      out.rate_radps[k] += value * one.tone.amplitude[k];
      out.angular_acceleration_radps2[k] += slope * one.tone.amplitude[k];
    }
    advance(one.now, one.step);
  }
  out.specific_force_mps2 = plus(force_.at(time_s).value, scaled(vibration_force(time_s, level.value[0]), factor_));
  if (law_.gravity) {
    if (instant_ > 0) turn_gravity(out.rate_radps);
    out.specific_force_mps2 = plus(out.specific_force_mps2, scaled(up_, kG0_mps2));
  }
  last_rate_radps_ = out.rate_radps;
  ++instant_;
  return out;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
