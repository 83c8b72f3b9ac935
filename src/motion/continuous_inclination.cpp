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
/// A rate beyond all gyros is none.
constexpr double kMostRate_radps = 1e4;
/// So is a force beyond all accelerometers.
constexpr double kMostForce_mps2 = 1e6;

/// What a rate may be off by, relative to the measured one.
double relative_of(const GyroErrors& gyro) noexcept {
  const double relative = gyro.scale + std::sqrt(2.0) * gyro.axis_rad;
  return relative / (1.0 - relative);
}

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
  const double block_s = 32.0 * motion.sample_period_s, length = norm(setup.axis);
  const std::array<Expected<void>, 5> checks = {
      within(length, 1.0 - 1e-6, 1.0 + 1e-6, 0), within(setup.velocity_bound_mps, 0.0, 100.0, 1),
      within(setup.window_s, 4.0 * block_s, 600.0, 2), within(setup.gravity_mps2, 1.0, 30.0, 3),
      within(setup.gravity_bound_mps2, 0.0, 1.0, 4)};
  for (const Expected<void>& sound : checks) {
    if (!sound) return sound;
  }
  *this = ContinuousInclination();
  setup_ = setup;
  gyro_ = motion.gyro;
  gyros_ = motion.gyros;
  gyro_corroborated_ = motion.gyro_corroborated;
  period_s_ = motion.sample_period_s;
  configured_ = true;
  return {};
}

/// The larger of two gyros: one of them may fail. Between two samples a rate is taken to be no larger than at both.
void ContinuousInclination::turn(const MotionSample& sample) noexcept {
  const double relative = relative_of(gyro_);
  double across = 0.0;
  int given = 0;
  for (std::size_t g = 0; g < static_cast<std::size_t>(gyros_); ++g) {
    const Vec3& w = sample.rate_radps[g];
    if (!sample.rate_given[g] || !usable(w)) continue;
    ++given;
    const double here = norm(cross(w, setup_.axis)) + relative * norm(w);
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
  const double away_s = pair.time_s - window_.last_s - pair.span_s;
  const bool in_step = std::fabs(away_s) <= kOutOfStep * pair.span_s;  // false for a NaN
  const bool told = window_.pairs > 0 && !in_step && begin_anew(InclinationStatus::irregular_time);
  add(pair);
  return window_.last_s - window_.first_s >= setup_.window_s - 2.5 * pair.span_s ? publish(pair.span_s) : told;
}

/// Theorem T13. The weights of the pairs add up to a trapezoid of height 1 / (pairs * block_s) that is zero at both
/// ends.
bool ContinuousInclination::publish(double block_s) noexcept {
  const double pairs = window_.pairs, length_s = pairs * block_s;
  const double more = 1.0 + relative_of(gyro_);
  const double across_radps =
      window_.across_radps * period_s_ / length_s + 2.0 * gyro_.lag_s * window_.most_radps / length_s +
      more * (gyro_.bias_radps + kNoiseFactor * gyro_.noise_radps / std::sqrt(window_.samples)) * (pairs + 1.0) / pairs;
  const double force = window_.force_mps2 / pairs;
  // Sums over samples take accelerations near half the sample rate for slower ones: a sixteenth more covers any tone.
  const double velocity = 2.0 * setup_.velocity_bound_mps / length_s * (1.0 + 1.0 / 16.0);
  const double turning = setup_.velocity_bound_mps * across_radps;
  const double error = window_.bound_mps2 / pairs + velocity + turning;
  const double least = setup_.gravity_mps2 - setup_.gravity_bound_mps2;
  const double most = setup_.gravity_mps2 + setup_.gravity_bound_mps2;
  const double down_low = -force - error, down_high = -force + error;  // of gravity along the axis
  const double low = down_low / (down_low > 0.0 ? most : least), high = down_high / (down_high > 0.0 ? least : most);
  interval_ = InclinationInterval();
  interval_.time_s = 0.5 * (window_.first_s + window_.last_s);
  interval_.span_s = window_.last_s - window_.first_s + 2.0 * block_s;
  interval_.gyro_assumed = window_.gyro_assumed;
  const std::array<double, 4> parts{window_.bound_mps2 / pairs, velocity, turning,
                                    setup_.gravity_bound_mps2 * std::fabs(force) / setup_.gravity_mps2};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k] > parts[static_cast<std::size_t>(interval_.widest)])
      interval_.widest = static_cast<InclinationTerm>(k);
  }
  interval_.status = low > 1.0 || high < -1.0 ? InclinationStatus::contradicts_gravity : InclinationStatus::known;
  interval_.inclination_rad = std::acos(cosine_within(-force / setup_.gravity_mps2));
  interval_.low_rad = std::acos(cosine_within(high));
  interval_.high_rad = std::acos(cosine_within(low));
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
  return "unknown";
}

const char* to_string(InclinationTerm term) noexcept {
  switch (term) {
    case InclinationTerm::force: return "force";
    case InclinationTerm::velocity: return "velocity";
    case InclinationTerm::turn: return "turn";
    case InclinationTerm::gravity: return "gravity";
  }
  return "unknown";
}

}  // namespace PLUMB_ABI
}  // namespace plumb
