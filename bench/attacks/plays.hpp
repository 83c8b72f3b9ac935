// What each family plays: one function per `Play`, that builds a player, attacks, and answers with what it came to.
#pragma once

#include <string>
#include <vector>

#include "adversary.hpp"
#include "family.hpp"
#include "player.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

/// One episode to play, and where its findings go.
struct Episode {
  const Family& family;
  EpisodeRequest request;
  int n;
  std::uint64_t variant;  ///< the family's own choices
  std::vector<std::string>& findings;

  /// A player's own numbers are one stream; what a family draws before it has a player is another.
  plumb_test::TrialNoise draws() const { return plumb_test::TrialNoise(request.stream ^ 0x5bf0'3635'd1f8'2a17U); }
  Player player(const AttackTool& tool, const plumb::MonitorConfig& config = {}, double resolution_mps2 = 0.0) const {
    Player out(tool, config, request.stream, request.tell, resolution_mps2);
    out.count_all = family.safety == Standing::outside;
    return out;
  }
  Tally done(Player& player) const {
    findings.insert(findings.end(), player.findings().begin(), player.findings().end());
    return player.finish();
  }
};

/// Some tool under its reference gravity, nominal by the time that the attack begins.
Player trusted_at_g0(const Episode& e, const plumb::MonitorConfig& config = {});
/// The same under `gravity_within_bounds`.
Player trusted(const Episode& e, const plumb::MonitorConfig& config = {});
/// Gravity within the three sigmas of its reference that plumb bears.
double gravity_within_bounds(plumb_test::TrialNoise& noise);
/// Another direction, so far from this one.
plumb::Vec3 turned(const plumb::Vec3& direction, double angle_rad, plumb_test::TrialNoise& noise);
/// Stations at random attitudes, of one to `most` blocks.
void visit_stations(Player& player, int stations, int most_blocks);

// plays_data.cpp: what arrives, and when
Tally play_silence(const Episode& e);
Tally play_gap(const Episode& e);
Tally play_turn(const Episode& e);
Tally play_small_turns(const Episode& e);
Tally play_clock(const Episode& e);
// plays_motion.cpp: the tool moves
Tally play_steady_push(const Episode& e);
Tally play_truncated_frame(const Episode& e);
Tally play_slow_turn(const Episode& e);
Tally play_wobble(const Episode& e);
Tally play_vibration(const Episode& e);
// plays_fault.cpp: sensors lie
Tally play_vertical(const Episode& e);
Tally play_steps(const Episode& e);
Tally play_settling(const Episode& e);
Tally play_mirror(const Episode& e);
Tally play_adaptive(const Episode& e);
Tally play_successive(const Episode& e);
Tally play_after_fault(const Episode& e);
// plays_calibration.cpp: what is known of sensors and gravity is not true
Tally play_drift(const Episode& e);
Tally play_thermal(const Episode& e);
Tally play_misstated(const Episode& e);
Tally play_wrong_gravity(const Episode& e);
Tally play_bias_shift(const Episode& e);
Tally play_noise(const Episode& e);
// plays_power_on.cpp: how a tool becomes nominal
Tally play_roll(const Episode& e);
Tally play_yaw(const Episode& e);
Tally play_tilt(const Episode& e);

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
