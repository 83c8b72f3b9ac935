// Sensors lie: at one attitude, within a block, as mirror images, and by trying beforehand.
#include <cmath>

#include "plays.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

namespace {

double any_step(TrialNoise& noise, double least_g, double most_g) {
  return noise.sign() * noise.log_between(least_g, most_g) * kG0_mps2;
}

/// Two honest blocks at one attitude, before one sensor lies there.
Player at_rest_with_one_faulty(const Episode& e) {
  TrialNoise draws = e.draws();
  Player player = e.player(any_tool(e.n, draws));
  player.g_mps2 = gravity_within_bounds(draws);
  player.settle();
  player.direction = player.noise.direction();
  player.block(2);
  player.attack();
  player.faulty = SensorSet::of(player.noise.below(e.n));
  return player;
}

}  // namespace

Tally play_vertical(const Episode& e) {
  constexpr int kAxial = 3;
  Player player = e.player(exact_named_tool(4));
  player.g_mps2 = gravity_within_bounds(player.noise);
  player.settle();
  player.direction = {0.0, 0.0, player.noise.sign()};
  player.block(1 + player.noise.below(4));
  player.attack();
  player.faulty = SensorSet::of(kAxial);
  const double shown_mps2 = -player.direction[2] * player.g_mps2 / 3.0;
  player.lie = [shown_mps2](int, double) { return shown_mps2; };
  player.block(40);
  return e.done(player);
}

Tally play_steps(const Episode& e) {
  Player player = at_rest_with_one_faulty(e);
  for (int pair = 0; pair < 30; ++pair) {
    player.block();
    player.rest(player.window() / 2);
    const double step_mps2 = any_step(player.noise, 0.3, 3.0);
    player.lie = [step_mps2](int, double y) { return y + step_mps2; };
    player.rest(player.window() - player.window() / 2);
    player.lie = {};
  }
  return e.done(player);
}

Tally play_settling(const Episode& e) {
  Player player = trusted(e);
  player.faulty = SensorSet::of(player.noise.below(e.n));
  for (int station = 0; station < 25; ++station) {
    player.direction = player.noise.direction();
    player.rest(player.window() / 2);
    const double off_mps2 = any_step(player.noise, 0.05, 1.0);
    player.lie = [off_mps2](int, double y) { return y + off_mps2; };
    player.rest(player.window() - player.window() / 2);
    player.lie = {};
    player.block(1 + player.noise.below(3));
  }
  return e.done(player);
}

Tally play_mirror(const Episode& e) {
  TrialNoise draws = e.draws();
  const AttackTool& tool = any_tool(e.n, draws);
  const int given = static_cast<int>(e.family.number);
  const int m = given > 0 ? given : 1 + draws.below(std::max(1, tool.law.strict()));
  Player player = e.player(tool);
  player.g_mps2 = gravity_within_bounds(draws);
  const SensorSet liars = LawCase::some(e.n, m, draws);
  LawCase lies(tool.law.tool, liars, Lie::mirrored, (player.g_mps2 - kG0_mps2) / kTrialGravitySigma_mps2);
  lies.draw(draws);
  player.settle();
  player.attack();
  player.faulty = liars;
  for (int station = 0; station < 25; ++station) {
    player.direction = player.noise.direction();
    const Readings shown = lies.readings(player.direction, draws);
    player.lie = [&shown](int i, double) { return shown[slot(i)]; };
    player.block(1 + player.noise.below(2));
    player.lie = {};
  }
  return e.done(player);
}

Tally play_adaptive(const Episode& e) {
  TrialNoise draws = e.draws();
  const int aim = static_cast<int>(e.family.number);
  const bool many = aim > 2;
  const AttackTool* tool = &any_tool(e.n, draws);
  AttackTool cone;
  if (aim == 4) {
    AxisList axes{};
    cone_with_axis(axes, e.n);
    cone = tool_with_axes(axes, e.n);
    tool = &cone;
  }
  const int m = aim == 4 ? 2 : many ? 1 + draws.below(std::max(1, tool->law.strict())) : 1;
  Player player = e.player(*tool);
  player.g_mps2 = gravity_within_bounds(draws);
  player.settle();
  player.attack();
  player.faulty = LawCase::some(e.n, m, draws);
  const auto goal = static_cast<Aim>(many ? draws.below(3) : aim);
  Adversary adversary(player, goal, e.request.stream + 1);
  const int stations = goal == Aim::fail ? 40 : 24;  // failed is latched: it takes the isolation timeout
  for (int station = 0; station < stations; ++station) {
    player.direction = player.noise.direction();
    const int blocks = 1 + player.noise.below(2);
    for (int k = 0; k < blocks; ++k) adversary.block();
  }
  return e.done(player);
}

Tally play_successive(const Episode& e) {
  TrialNoise draws = e.draws();
  const AttackTool& tool = any_tool(e.n, draws);
  Player player = e.player(tool);
  player.g_mps2 = gravity_within_bounds(draws);
  player.settle();
  player.attack();
  const int gap = static_cast<int>(e.family.number);
  const SensorSet all = LawCase::some(e.n, std::max(1, tool.law.strict()), draws);
  std::array<double, kCapacity> bias_mps2{};
  player.lie = [&bias_mps2](int i, double y) { return y + bias_mps2[slot(i)]; };
  for (SensorSet left = all; !left.empty();) {
    int next = draws.below(e.n);
    while (!left.has(next)) next = (next + 1) % e.n;
    left = left.without(next);
    player.faulty = player.faulty.with(next);
    bias_mps2[slot(next)] = any_step(draws, 0.05, 1.0);
    const int stations = left.empty() ? 24 : 1 + gap;
    for (int station = 0; station < stations; ++station) {
      player.direction = player.noise.direction();
      player.block();
    }
  }
  return e.done(player);
}

Tally play_after_fault(const Episode& e) {
  Player player = at_rest_with_one_faulty(e);
  const bool small = e.family.number > 0.0;  // so small that the vector stays within the alert limit
  const double bias_mps2 = any_step(player.noise, small ? 0.001 : 0.05, small ? e.family.number : 1.0);
  player.lie = [bias_mps2](int, double y) { return y + bias_mps2; };
  player.block(60);
  return e.done(player);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
