// Attacks on the whole monitor, counted: plain numbers, so that the program that prints them knows no capacity.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace plumb_bench {

/// What else goes on while sensors lie.
enum class Situation : std::uint8_t {
  plain,        ///< stations, one after the other
  motion,       ///< vibration, sway and turns within blocks, at random
  recalibrate,  ///< the host or the policy asks for a recalibration, lies begin during it
  offer,        ///< calibrations are offered, most of them wrong
  reset,        ///< failed is left by reset, whatever is broken
  reinstate,    ///< lies cease until their sensors are back, and begin anew
  timing,       ///< rows lost, late, repeated, gaps, values that are none
  host,         ///< gravity set anew, inhibit, power cycles with a snapshot
};
inline constexpr int kSituations = 8;
const char* name(Situation situation);

inline constexpr int kAttackLies = 14;  ///< thirteen lies of tests/laws, and nobody lying
const char* name_of_lie(int lie);

struct AttackJob {
  std::uint64_t seed = 1, first = 0, episodes = 0;
  bool tell = false;  ///< every change of state, on standard output
  int only = -1;      ///< play episodes of this situation alone; the others keep their numbers
};

/// Episodes in which it happened.
struct AttackCount {
  std::uint64_t episodes = 0, ticks = 0, usable_ticks = 0;
  // Never, as long as no more sensors lie than the grade bears, and gravity is within three sigmas.
  std::uint64_t excluded_healthy = 0;   ///< latched out
  std::uint64_t set_aside_healthy = 0;  ///< within the parity grade
  std::uint64_t beyond_level = 0;       ///< valid, at most one liar in service, tilt error beyond the protection level
  std::uint64_t beyond_alert = 0;       ///< the same, beyond the alert limit and no alert
  std::uint64_t failed_healthy = 0;     ///< failed though nobody lied
  std::uint64_t broken = 0;             ///< a snapshot refused, sets that are no partition, a figure that is not finite
  // What nothing promises.
  std::uint64_t crowd_beyond_level = 0;  ///< two liars or more in service that no test sees: beyond the level
  std::uint64_t crowd_beyond_alert = 0;  ///< beyond the alert limit and no alert
  std::uint64_t beyond_bounds = 0;       ///< any of the above once motion below the noise made gravity look too far off
  std::uint64_t failed = 0;
  std::uint64_t all_out = 0;  ///< every liar out of service at the end
  std::uint64_t liars = 0;    ///< episodes with one at least

  std::uint64_t unsound() const {
    return excluded_healthy + set_aside_healthy + beyond_level + beyond_alert + failed_healthy + broken;
  }
  void add(const AttackCount& other);
};

struct AttackSum {
  /// [n - 4][situation][lie]
  std::array<std::array<std::array<AttackCount, kAttackLies>, kSituations>, 5> count{};
  std::vector<std::string> finds;  ///< a line each
};

AttackSum attack(const AttackJob& job);

}  // namespace plumb_bench
