// From power-on to nominal, where the tool visits few attitudes.
#include <cmath>

#include "plays.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

namespace {

Vec3 at_inclination(double inclination_rad, double toolface_rad) {
  const double s = std::sin(inclination_rad);
  return {-s * std::sin(toolface_rad), -s * std::cos(toolface_rad), std::cos(inclination_rad)};
}

}  // namespace

Tally play_roll(const Episode& e) {
  constexpr double kInclinations_deg[] = {10.0, 30.0, 45.0, 60.0, 90.0};
  constexpr int kAttitudes = 20, kBlocks = 4;
  Player player = e.player(pool(e.n)[e.variant / 5 % 2]);  // the named geometry, exact or fitted
  player.g_mps2 = gravity_within_bounds(player.noise);
  player.attack();
  const double inclination = rad_from_deg(kInclinations_deg[e.variant % 5]);
  const double start = player.noise.between(0.0, 2.0 * kPi);
  for (int k = 0; k < kAttitudes; ++k) {
    player.direction = at_inclination(inclination, start + 2.0 * kPi * k / kAttitudes);
    player.block(kBlocks);
  }
  return e.done(player);
}

Tally play_yaw(const Episode& e) {
  TrialNoise draws = e.draws();
  Player player = e.player(any_tool(e.n, draws));
  player.g_mps2 = gravity_within_bounds(draws);
  player.attack();
  player.direction = at_inclination(rad_from_deg(draws.between(0.0, 15.0)), draws.between(0.0, 2.0 * kPi));
  player.block(80);
  return e.done(player);
}

Tally play_tilt(const Episode& e) {
  TrialNoise draws = e.draws();
  AttackTool triads;
  const AttackTool* tool = &pool(e.n)[e.variant % 2];
  if (e.n == 6) {
    AxisList axes{};
    for (int i = 0; i < e.n; ++i) axes[slot(i)][slot(i % 3)] = i < 3 ? 1.0 : -1.0;
    triads = tool_with_axes(axes, e.n);
    tool = &triads;
  }
  Player player = e.player(*tool);
  player.g_mps2 = gravity_within_bounds(draws);
  player.attack();
  for (int k = 0; k < 40; ++k) {
    const double tilt = rad_from_deg(player.noise.between(0.0, e.family.number));
    player.direction = at_inclination(tilt, player.noise.between(0.0, 2.0 * kPi));
    player.block(2);
  }
  return e.done(player);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
