// What is known of sensors, noise and gravity is not true, or no longer.
#include <cmath>

#include "plays.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

namespace {

constexpr int kStations = 30;

double fault_mps2(TrialNoise& noise) { return noise.sign() * noise.log_between(5.0, 1000.0) * kMilligee_mps2; }

}  // namespace

Tally play_drift(const Episode& e) {
  TrialNoise draws = e.draws();
  Player player = e.player(any_tool(e.n, draws));
  player.g_mps2 = gravity_within_bounds(draws);
  player.state_stability({e.family.number * kMilligee_mps2, 0.0, 0.0, 0.0});
  for (int i = 0; i < e.n; ++i) player.shift_mps2[slot(i)] = e.family.number * kMilligee_mps2 * draws.normal();
  const bool one_lies = e.family.play == Play::drift_and_fault;
  if (!one_lies) player.attack();
  visit_stations(player, one_lies ? 4 : kStations, 2);
  if (!one_lies) return e.done(player);
  player.attack();
  player.faulty = SensorSet::of(draws.below(e.n));
  const double bias_mps2 = fault_mps2(draws);
  player.lie = [bias_mps2](int, double y) { return y + bias_mps2; };
  visit_stations(player, kStations, 2);
  return e.done(player);
}

Tally play_thermal(const Episode& e) {
  constexpr double kWarming_degcps = 5.0 / 60.0, kLag_s = 120.0, kBetween_s = 20.0;
  TrialNoise draws = e.draws();
  Player player = e.player(any_tool(e.n, draws));
  player.g_mps2 = gravity_within_bounds(draws);
  // Slopes of up to the number are 1 sigma of a third of it, for each of the two minutes that the sensors lag behind.
  player.state_stability({0.0, 0.0, 0.0, e.family.number / std::sqrt(3.0) * kMilligee_mps2 * kLag_s / 60.0});
  Readings slope{};
  for (int i = 0; i < e.n; ++i) slope[slot(i)] = e.family.number * kMilligee_mps2 * draws.between(-1.0, 1.0);
  player.settle();
  player.attack();
  const double begin_s = player.time_s;
  for (int station = 0; station < kStations; ++station) {
    player.time_s += kBetween_s;
    player.direction = player.noise.direction();
    const double since_s = player.time_s - begin_s;
    const double behind_degc = kWarming_degcps * kLag_s * (1.0 - std::exp(-since_s / kLag_s));
    player.temperature_degc = 25.0 + kWarming_degcps * since_s;
    for (int i = 0; i < e.n; ++i) player.shift_mps2[slot(i)] = slope[slot(i)] * behind_degc;
    player.block(1 + player.noise.below(2));
  }
  return e.done(player);
}

Tally play_misstated(const Episode& e) {
  constexpr double kStated_mps2 = 0.03 * kMilligee_mps2;
  TrialNoise draws = e.draws();
  const bool none = e.family.play == Play::no_covariance;
  const double actual_mps2 = none ? e.family.number * kMilligee_mps2 : e.family.number * kStated_mps2;
  const AttackTool tool = misstated_tool(e.n, actual_mps2, none ? 0.0 : kStated_mps2, draws);
  Player player = e.player(tool);
  player.attack();
  visit_stations(player, kStations, 2);
  return e.done(player);
}

Tally play_wrong_gravity(const Episode& e) {
  TrialNoise draws = e.draws();
  Player player = e.player(any_tool(e.n, draws));
  const bool latitude = e.family.play == Play::latitude;
  const double off_mg = latitude ? draws.between(0.5, e.family.number) : draws.log_between(0.6, 10.0);
  player.settle();
  player.attack();
  player.g_mps2 = kG0_mps2 + draws.sign() * off_mg * kMilligee_mps2;
  visit_stations(player, 6, 2);
  player.faulty = SensorSet::of(draws.below(e.n));
  const double bias_mps2 = fault_mps2(draws);
  player.lie = [bias_mps2](int, double y) { return y + bias_mps2; };
  visit_stations(player, kStations, 2);
  return e.done(player);
}

Tally play_bias_shift(const Episode& e) {
  TrialNoise draws = e.draws();
  Player player = e.player(any_tool(e.n, draws));
  player.state_stability({e.family.number * kMilligee_mps2, 0.0, 0.0, 0.0});
  player.settle();
  player.attack();
  player.shift_mps2[slot(draws.below(e.n))] = draws.sign() * e.family.number * kMilligee_mps2;
  visit_stations(player, kStations, 2);
  return e.done(player);
}

Tally play_noise(const Episode& e) {
  TrialNoise draws = e.draws();
  const bool coarse = e.family.play == Play::coarse_steps;
  Player player = e.player(any_tool(e.n, draws), {}, coarse ? e.family.number * kPoolSigma_mps2 : 0.0);
  if (e.family.play == Play::understated_noise) player.noise_factor = e.family.number;
  if (e.family.play == Play::slow_noise) player.correlation = e.family.number;
  player.attack();
  visit_stations(player, kStations, 3);
  return e.done(player);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
