// The tool moves: by what the length of gravity hides, between two rows, or all the time.
#include <cmath>

#include "plays.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

namespace {

constexpr int kBlocksInMotion = 60;
constexpr int kBlocksToShow = 2;  ///< one that has begun at rest, and one to learn of it

Vec3 across(const Vec3& direction, TrialNoise& noise) { return turned(direction, 0.5 * kPi, noise); }

}  // namespace

Tally play_steady_push(const Episode& e) {
  constexpr double kThrust_mg = 300.0, kMost_mg = 50.0;
  constexpr double kWithVerticalPart = 1.02;  // at 300 mg across, what keeps the length is 46 mg upwards
  const bool horizontal = e.family.number == 0.0;
  MonitorConfig config;
  config.acceleration_bound_mps2 = (horizontal ? kMost_mg : kThrust_mg * kWithVerticalPart) * kMilligee_mps2;
  Player player = trusted_at_g0(e, config);
  for (int station = 0; station < 12; ++station) {
    player.direction = player.noise.direction();
    const Vec3 side = across(player.direction, player.noise);
    if (horizontal) {
      player.push_mps2 = scaled(side, player.noise.log_between(3.0, kMost_mg) * kMilligee_mps2);
    } else {
      const double a = kThrust_mg * kMilligee_mps2;
      const double along = std::sqrt(player.g_mps2 * player.g_mps2 - a * a) - player.g_mps2;
      player.push_mps2 = plus(scaled(side, a), scaled(player.direction, along));
    }
    player.block(1 + player.noise.below(3));
  }
  return e.done(player);
}

Tally play_truncated_frame(const Episode& e) {
  constexpr double kRate_radps = rad_from_deg(400.0);
  MonitorConfig config;
  if (e.family.number > 0.0) config.assumed_faults = static_cast<int>(e.family.number);
  Player player = trusted(e, config);
  for (int station = 0; station < 12; ++station) {
    player.block(1 + player.noise.below(2));
    player.rest(player.window() - 1);
    const Vec3 to = turned(player.direction, player.noise.between(0.2, 3.0), player.noise);
    const double angle = kRate_radps * player.period_s * player.noise.uniform();
    const double whole = angle_between_rad(player.direction, to);
    const Vec3 begun = plus(scaled(player.direction, 1.0 - angle / whole), scaled(to, angle / whole));
    player.direction = scaled(begun, 1.0 / norm(begun));
    Sample frame = player.next();
    frame.delivered = SensorSet::of(player.noise.below(e.n));
    player.offer(frame);
    player.turn_to(to, kRate_radps);
  }
  return e.done(player);
}

Tally play_slow_turn(const Episode& e) {
  Player player = trusted_at_g0(e);
  const double step_rad = rad_from_deg(e.family.number) * player.period_s;
  const Vec3 axis = across(player.direction, player.noise);
  for (int k = 0; k < kBlocksInMotion * player.window(); ++k) {
    player.steady_motion = k >= kBlocksToShow * player.window();
    const Vec3 moved = plus(player.direction, scaled(cross(axis, player.direction), step_rad));
    player.direction = scaled(moved, 1.0 / norm(moved));
    player.rest(1);
  }
  return e.done(player);
}

Tally play_wobble(const Episode& e) {
  Player player = trusted_at_g0(e);
  const double most_rad = std::sqrt(2.0) * rad_from_deg(e.family.number);
  for (int station = 0; station < 10; ++station) {
    const Vec3 middle = player.noise.direction();
    const Vec3 side = across(middle, player.noise);
    const double phase = player.noise.between(0.0, 2.0 * kPi);
    for (int k = 0; k < 6 * player.window(); ++k) {
      player.steady_motion = k >= kBlocksToShow * player.window();
      const double angle = most_rad * std::sin(2.0 * kPi * player.time_s + phase);
      player.direction = plus(scaled(middle, std::cos(angle)), scaled(side, std::sin(angle)));
      player.rest(1);
    }
  }
  return e.done(player);
}

Tally play_vibration(const Episode& e) {
  Player player = trusted_at_g0(e);
  const double rms_mps2 = e.family.number * kPoolSigma_mps2;
  for (int station = 0; station < 10; ++station) {
    player.direction = player.noise.direction();
    for (int k = 0; k < 6 * player.window(); ++k) {
      for (double& component : player.push_mps2) component = rms_mps2 * player.noise.normal();
      player.rest(1);
    }
  }
  return e.done(player);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
