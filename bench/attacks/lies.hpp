// Sensors that lie from station to station while something else goes on: plain numbers of one episode.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "plumb/core/config.hpp"

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

struct LiesRequest {
  Situation situation = Situation::plain;
  std::uint64_t seed = 1, episode = 0;
  bool tell = false;  ///< every change of state, on standard output
};

/// The number of that episode among those of all situations: five sizes, eight situations, fourteen lies. It keys the
/// episode's random numbers, and is the one that docs/isolation.md and the tests name.
std::uint64_t old_number(Situation situation, std::uint64_t episode);

inline constexpr std::uint64_t kNeverNominal = ~std::uint64_t{0};

/// One episode: whether it happened, but for blocks.
struct LiesCount {
  std::uint64_t blocks = 0, valid_blocks = 0;
  // Never, as long as no more sensors lie than the grade bears, and gravity is within three sigmas.
  std::uint64_t excluded_healthy = 0;   ///< excluded
  std::uint64_t set_aside_healthy = 0;  ///< within the provisional grade
  std::uint64_t beyond_level = 0;       ///< valid, at most one liar in service, tilt error beyond the protection level
  std::uint64_t beyond_alert = 0;       ///< the same, beyond the alert limit and no alert
  std::uint64_t failed_healthy = 0;     ///< failed though nobody lied
  std::uint64_t broken = 0;             ///< a snapshot refused, sets that are no partition, a figure that is not finite
  // What nothing promises.
  std::uint64_t crowd_beyond_level = 0;  ///< two liars or more in service that no test sees: beyond the level
  std::uint64_t crowd_beyond_alert = 0;  ///< beyond the alert limit and no alert
  std::uint64_t beyond_bounds = 0;       ///< any of the above once motion below the noise made gravity look too far off
  std::uint64_t false_doubts = 0;        ///< nominal left for suspect though nobody lies
  std::uint64_t failed = 0;
  std::uint64_t all_out = 0;  ///< every liar out of service at the end
  std::uint64_t liars = 0;    ///< whether anybody lies
  std::uint64_t blocks_to_nominal = kNeverNominal;
};

inline namespace PLUMB_ABI {
LiesCount play_lies(const LiesRequest& request, std::vector<std::string>& finds);
}  // namespace PLUMB_ABI

}  // namespace plumb_bench
