// What arrives, and when: silence, gaps, turns between samples, clocks that stand still.
#include <limits>

#include "plays.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

namespace {

constexpr double kNone[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity()};

}  // namespace

Tally play_silence(const Episode& e) {
  constexpr int kSilentSamples = 2000;
  Player player = trusted(e);
  player.block(1 + player.noise.below(24));
  const Vec3 to = turned(player.direction, rad_from_deg(player.noise.between(5.0, 175.0)), player.noise);
  const Vec3 from = player.direction;
  for (int k = 0; k < kSilentSamples; ++k) {
    const double share = static_cast<double>(k) / kSilentSamples;
    const Vec3 between = plus(scaled(from, 1.0 - share), scaled(to, share));
    player.direction = scaled(between, 1.0 / norm(between));
    Sample sample = player.next();
    if (e.variant % 4 == 0) {
      sample.delivered = SensorSet{};
    } else {
      for (int i = 0; i < e.n; ++i) sample.raw[slot(i)] = kNone[e.variant % 4 - 1];
    }
    player.offer(sample);
  }
  player.block(3);
  return e.done(player);
}

Tally play_gap(const Episode& e) {
  Player player = trusted(e);
  for (int round = 0; round < 3; ++round) {
    player.block(1 + player.noise.below(4));
    if (e.variant % 2 == 0) {
      player.time_s += player.noise.between(5.1, 59.0);
      player.direction = turned(player.direction, player.noise.between(0.02, 3.0), player.noise);
      player.block(2);
      continue;
    }
    player.period_s = 5.1;
    for (int k = 0; k < 40; ++k) {
      player.direction = turned(player.direction, player.noise.between(0.02, 0.3), player.noise);
      player.rest(1);
    }
    player.period_s = 0.01;
    player.block(2);
  }
  return e.done(player);
}

Tally play_turn(const Episode& e) {
  Player player = trusted(e);
  player.period_s = 1.0 / e.family.number;
  for (int round = 0; round < 8; ++round) {
    player.block(1 + player.noise.below(2));
    player.rest(player.noise.below(4));
    const double angle = rad_from_deg(player.noise.log_between(0.5, 170.0));
    const Vec3 to = turned(player.direction, angle, player.noise);
    if (player.noise.below(2) == 0) {
      player.direction = to;
    } else {
      player.turn_to(to, rad_from_deg(player.noise.log_between(1.0, 400.0)));
    }
    player.rest(player.noise.below(player.window()));
  }
  return e.done(player);
}

/// What the tool turned between two blocks is in the bound of the second; a turn after that must not hide in it.
Tally play_small_turns(const Episode& e) {
  Player player = trusted(e);
  for (int round = 0; round < 12; ++round) {
    player.direction = player.noise.direction();
    player.block(2);
    const double angle = rad_from_deg(player.noise.log_between(0.05, 2.0));
    player.direction = turned(player.direction, angle, player.noise);
    player.block();
    player.direction = turned(player.direction, angle * player.noise.between(0.8, 1.8), player.noise);
    player.rest(1 + player.noise.below(player.window()));
    while (player.offered() % static_cast<std::uint64_t>(player.window()) != 0) player.rest(1);
  }
  return e.done(player);
}

namespace {

/// A sample, and then samples of other attitudes with its time stamp or an older one.
void repeat_a_time_stamp(Player& player, bool backwards) {
  const Sample last = player.next();
  player.offer(last);
  const int repeats = 1 + player.noise.below(40);
  for (int k = 0; k < repeats; ++k) {
    player.direction = turned(player.direction, 0.05, player.noise);
    Sample again = player.next();
    player.time_s -= player.period_s;
    again.time_s = last.time_s - (backwards ? 0.003 * k : 0.0);
    player.offer(again);
  }
}

}  // namespace

Tally play_clock(const Episode& e) {
  constexpr double kSlow_s = 4.1;  // below the longest gap; 15 of these are more than a minute
  Player player = trusted(e);
  for (int round = 0; round < 3; ++round) {
    player.block(1 + player.noise.below(3));
    player.rest(player.noise.below(8));
    const bool slow = e.variant % 3 == 2;
    if (slow) player.period_s = kSlow_s;
    if (slow) player.rest(13);
    repeat_a_time_stamp(player, e.variant % 2 != 0);
    if (slow) {
      player.rest(1);
    } else {
      player.time_s += player.noise.between(1.0, 70.0);
      Sample silent = player.next();
      silent.delivered = SensorSet{};
      player.offer(silent);
    }
    player.power_cycle();
    player.period_s = 0.01;
    player.block(2);
  }
  return e.done(player);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
