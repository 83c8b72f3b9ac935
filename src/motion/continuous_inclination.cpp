#include "plumb/motion/continuous_inclination.hpp"

#include <array>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

/// Of the noise of a gyro, in a mean: beyond it once in 1e11 windows.
constexpr double kNoiseFactor = 7.0;
/// Pairs of blocks in a row have middles one block apart, to this share of it.
constexpr double kOutOfStep = 0.25;
/// A force beyond all accelerometers is none.
constexpr double kMostForce_mps2 = 1e6;

bool usable(const Vec3& rate_radps) noexcept { return norm(rate_radps) <= kMostRate_radps; }  // false for a NaN

Expected<void> within(double value, double least, double most, int index) noexcept {
  if (!std::isfinite(value)) return fail(Errc::not_finite, index, value);
  if (value < least) return fail(Errc::out_of_range, index, value, least);
  if (value > most) return fail(Errc::out_of_range, index, value, most);
  return {};
}

double cosine_within(double x) noexcept { return x < -1.0 ? -1.0 : (x > 1.0 ? 1.0 : x); }

}  // namespace

Expected<void> ContinuousInclination::configure(const SensorArray& array, const MotionSetup& motion,
                                                const InclinationSetup& setup) noexcept {
  configured_ = false;
  if (const Expected<void> sound = check(array, motion); !sound) return sound;
  const double block_s = motion.block_samples[2] * motion.sample_period_s;
  const std::array<Expected<void>, 6> checks = {within(norm(setup.axis), 1.0 - 1e-6, 1.0 + 1e-6, 200),
                                                within(setup.axis_bound_rad, 0.0, kPi, 201),
                                                within(setup.velocity_bound_mps, 0.0, 100.0, 202),
                                                within(setup.window_s, 4.0 * block_s, 600.0, 203),
                                                within(setup.gravity_mps2, 1.0, 30.0, 204),
                                                within(setup.gravity_bound_mps2, 0.0, 0.5, 205)};
  for (const Expected<void>& sound : checks) {
    if (!sound) return sound;
  }
  *this = ContinuousInclination();
  setup_ = setup;
  gyro_ = motion.gyro;
  gyros_ = motion.gyros;
  gyro_corroborated_ = motion.gyro_corroborated;
  block_s_ = block_s;
  block_samples_ = motion.block_samples[2];
  configured_ = true;
  return {};
}

/// The larger of two gyros: one of them may fail. Between two samples a rate is taken to be no larger than at both.
void ContinuousInclination::turn(const MotionSample& sample) noexcept {
  const double relative = relative_error(gyro_);
  double across = 0.0;
  int given = 0;
  for (std::size_t g = 0; g < static_cast<std::size_t>(gyros_); ++g) {
    const Vec3& w = sample.rate_radps[g];
    const double off = sample.interpolation_radps[g];
    if (!sample.rate_given[g] || !usable(w) || !(off >= 0.0 && off <= kMostRate_radps)) continue;
    ++given;
    const double here = norm(cross(w, setup_.axis)) + relative * norm(w) + (1.0 + relative) * off;
    if (here > across) across = here;
  }
  const double larger = across > before_radps_ ? across : before_radps_;
  before_radps_ = across;
  filling_.across_radps += larger;
  filling_.most_radps = larger > filling_.most_radps ? larger : filling_.most_radps;
  filling_.samples += 1.0;
  filling_.known = filling_.known && given > 0;
  filling_.gyro_assumed = filling_.gyro_assumed || (given < 2 && !gyro_corroborated_);
}

bool ContinuousInclination::begin_anew(InclinationStatus why) noexcept {
  const bool new_reason = interval_.status != why;
  window_ = Sums();
  interval_ = InclinationInterval();
  interval_.status = why;
  return new_reason;
}

void ContinuousInclination::add(const SpecificForce& pair) noexcept {
  const auto take = [this](const Turning& block) {
    window_.across_radps += block.across_radps;
    window_.most_radps = block.most_radps > window_.most_radps ? block.most_radps : window_.most_radps;
    window_.samples += block.samples;
    window_.gyro_assumed = window_.gyro_assumed || block.gyro_assumed;
  };
  if (window_.pairs == 0) {
    window_.first_s = pair.time_s;
    take(last_);
  }
  take(filling_);
  ++window_.pairs;
  window_.last_s = pair.time_s;
  window_.force_mps2 += dot(pair.force_mps2, setup_.axis);
  window_.bound_mps2 += pair.bound_mps2;
  window_.gyro_assumed = window_.gyro_assumed || pair.gyro_assumed;
}

bool ContinuousInclination::step(const MotionSample& sample, const MotionVerdict& verdict) noexcept {
  if (!configured_) return false;
  turn(sample);  // follows the block that ends with it, and counts in both: for what happens between the two
  if (!verdict.block_ended) return false;
  const bool told = take(verdict.block);
  last_ = filling_;
  filling_ = Turning();
  before_radps_ = 0.0;
  turn(sample);
  return told;
}

bool ContinuousInclination::take(const SpecificForce& pair) noexcept {
  const bool bounded = pair.validity == ForceValidity::bounded && pair.bound_mps2 < kMostForce_mps2;
  if (!bounded || !(norm(pair.force_mps2) < kMostForce_mps2))  // a NaN is none either
    return begin_anew(InclinationStatus::no_force);
  if (!last_.known || !filling_.known) return begin_anew(InclinationStatus::rate_unknown);
  const double away_s = pair.time_s - window_.last_s - block_s_;
  const bool in_step = std::fabs(away_s) <= kOutOfStep * block_s_;  // false for a NaN
  const bool told = window_.pairs > 0 && !in_step && begin_anew(InclinationStatus::irregular_time);
  add(pair);
  return window_.last_s - window_.first_s >= setup_.window_s - 2.5 * block_s_ ? publish() : told;
}

/// Theorem T13. The weights of the pairs add up to a trapezoid that is zero at both ends, of height 1 / length_s.
bool ContinuousInclination::publish() noexcept {
  const double pairs = window_.pairs, step_s = (window_.last_s - window_.first_s) / (pairs - 1.0);
  const double length_s = pairs * step_s;
  const double own = (1.0 + relative_error(gyro_)) *
                     (gyro_.bias_radps + kNoiseFactor * gyro_.noise_radps / std::sqrt(window_.samples));
  const double across_radps = window_.across_radps / (pairs * block_samples_) +
                              2.0 * gyro_.lag_s * window_.most_radps / length_s + own * (pairs + 1.0) / pairs;
  const double force = window_.force_mps2 / pairs;
  // Sums over samples take accelerations near half the sample rate for slower ones: 2 / n more, with blocks
  // of n samples, covers any tone.
  const double velocity = 2.0 * setup_.velocity_bound_mps / length_s * (1.0 + 2.0 / block_samples_);
  const double turning = setup_.velocity_bound_mps * across_radps;
  const double error = window_.bound_mps2 / pairs + velocity + turning;
  const double least = setup_.gravity_mps2 - setup_.gravity_bound_mps2;
  const double most = setup_.gravity_mps2 + setup_.gravity_bound_mps2;
  const double down_low = -force - error, down_high = -force + error;  // of gravity along the axis
  const double low = down_low / (down_low > 0.0 ? most : least), high = down_high / (down_high > 0.0 ? least : most);
  interval_ = InclinationInterval();
  interval_.time_s = 0.5 * (window_.first_s + window_.last_s);
  interval_.span_s = length_s + step_s;
  interval_.gyro_assumed = window_.gyro_assumed;
  const std::array<double, 5> parts{window_.bound_mps2 / pairs, velocity, turning,
                                    setup_.gravity_bound_mps2 * std::fabs(force) / setup_.gravity_mps2,
                                    setup_.gravity_mps2 * setup_.axis_bound_rad};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k] > parts[static_cast<std::size_t>(interval_.widest)])
      interval_.widest = static_cast<InclinationTerm>(k);
  }
  interval_.status = low > 1.0 || high < -1.0 ? InclinationStatus::contradicts_gravity : InclinationStatus::known;
  interval_.inclination_rad = std::acos(cosine_within(-force / setup_.gravity_mps2));
  interval_.low_rad = std::fmax(std::acos(cosine_within(high)) - setup_.axis_bound_rad, 0.0);
  interval_.high_rad = std::fmin(std::acos(cosine_within(low)) + setup_.axis_bound_rad, kPi);
  window_ = Sums();
  return true;
}

const char* to_string(InclinationStatus status) noexcept {
  switch (status) {
    case InclinationStatus::filling: return "filling";
    case InclinationStatus::known: return "known";
    case InclinationStatus::no_force: return "no_force";
    case InclinationStatus::rate_unknown: return "rate_unknown";
    case InclinationStatus::irregular_time: return "irregular_time";
    case InclinationStatus::contradicts_gravity: return "contradicts_gravity";
  }
  return "?";
}

const char* to_string(InclinationTerm term) noexcept {
  switch (term) {
    case InclinationTerm::force: return "force";
    case InclinationTerm::velocity: return "velocity";
    case InclinationTerm::turn: return "turn";
    case InclinationTerm::gravity: return "gravity";
    case InclinationTerm::alignment: return "alignment";
  }
  return "?";
}

}  // namespace PLUMB_ABI
}  // namespace plumb
