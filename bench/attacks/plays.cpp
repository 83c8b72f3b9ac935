// From a family to what plays it.
#include "plays.hpp"

#include <algorithm>
#include <cmath>

#include "lies.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

Player trusted_at_g0(const Episode& e, const MonitorConfig& config) {
  TrialNoise draws = e.draws();
  Player player = e.player(any_tool(e.n, draws), config);
  player.settle();
  player.attack();
  return player;
}

Player trusted(const Episode& e, const MonitorConfig& config) {
  TrialNoise draws = e.draws();
  Player player = e.player(any_tool(e.n, draws), config);
  player.g_mps2 = gravity_within_bounds(draws);
  player.settle();
  player.attack();
  return player;
}

double gravity_within_bounds(TrialNoise& noise) {
  const double sigmas = noise.below(3) == 0 ? 3.0 * noise.sign() : noise.between(-3.0, 3.0);
  return kG0_mps2 + sigmas * kTrialGravitySigma_mps2;
}

Vec3 turned(const Vec3& direction, double angle_rad, TrialNoise& noise) {
  Vec3 across = cross(direction, noise.direction());
  across = scaled(across, 1.0 / norm(across));
  const Vec3 out = plus(scaled(direction, std::cos(angle_rad)), scaled(across, std::sin(angle_rad)));
  return scaled(out, 1.0 / norm(out));
}

void visit_stations(Player& player, int stations, int most_blocks) {
  for (int station = 0; station < stations; ++station) {
    player.direction = player.noise.direction();
    player.block(1 + player.noise.below(most_blocks));
  }
}

namespace {

Tally of_lies(const LiesCount& c) {
  Tally out;
  out[Count::episodes] = 1;
  out[Count::blocks] = c.blocks;
  out[Count::valid_blocks] = c.valid_blocks;
  out[Count::wrong_exclusion] = c.excluded_healthy;
  out[Count::wrong_aside] = c.set_aside_healthy;
  out[Count::beyond_level] = c.beyond_level;
  out[Count::hazardous] = c.beyond_alert;
  out[Count::broken] = c.broken;
  out[Count::failed_healthy] = c.failed_healthy;
  out[Count::unpromised] = c.crowd_beyond_level + c.crowd_beyond_alert + c.beyond_bounds > 0 ? 1 : 0;
  out[Count::false_doubt] = c.false_doubts;
  out[Count::failed] = c.failed;
  out[Count::faulty] = c.liars;
  out[Count::all_out] = c.all_out;
  ++out.to_nominal[static_cast<std::size_t>(std::min<std::uint64_t>(c.blocks_to_nominal, kNominalBins - 1))];
  return out;
}

Tally play_any_lies(const Episode& e) {
  const auto situation = static_cast<Situation>(static_cast<int>(e.family.number));
  return of_lies(play_lies({situation, e.request.seed, e.request.episode, e.request.tell}, e.findings));
}

Tally play_family(const Episode& e) {
  switch (e.family.play) {
    case Play::lies: return play_any_lies(e);
    case Play::silence: return play_silence(e);
    case Play::gap: return play_gap(e);
    case Play::turn: return play_turn(e);
    case Play::small_turns: return play_small_turns(e);
    case Play::clock: return play_clock(e);
    case Play::steady_push: return play_steady_push(e);
    case Play::truncated_frame: return play_truncated_frame(e);
    case Play::vertical: return play_vertical(e);
    case Play::steps: return play_steps(e);
    case Play::settling: return play_settling(e);
    case Play::mirror:
    case Play::mirrored_still: return play_mirror(e);
    case Play::adaptive: return play_adaptive(e);
    case Play::drift:
    case Play::drift_and_fault: return play_drift(e);
    case Play::thermal: return play_thermal(e);
    case Play::small_sigma:
    case Play::no_covariance: return play_misstated(e);
    case Play::gravity_off:
    case Play::latitude: return play_wrong_gravity(e);
    case Play::roll: return play_roll(e);
    case Play::yaw: return play_yaw(e);
    case Play::tilting_triads: return play_tilt(e);
    case Play::slow_turn: return play_slow_turn(e);
    case Play::wobble: return play_wobble(e);
    case Play::vibration: return play_vibration(e);
    case Play::bias_shift: return play_bias_shift(e);
    case Play::understated_noise:
    case Play::coarse_steps:
    case Play::slow_noise: return play_noise(e);
    case Play::successive: return play_successive(e);
    case Play::after_fault: return play_after_fault(e);
  }
  return {};
}

}  // namespace
}  // namespace PLUMB_ABI

Tally play_episode(const EpisodeRequest& request, std::vector<Finding>& findings) {
  const Family& family = families()[static_cast<std::size_t>(request.family)];
  std::vector<std::string> told;
  const int n = sensors_of(family, request.episode);
  const Tally tally = play_family({family, request, n, variant_of(family, request.episode), told});
  for (std::string& text : told) findings.push_back({request.family, request.episode, std::move(text)});
  return tally;
}

}  // namespace plumb_bench
