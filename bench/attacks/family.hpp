// The families of attacks: their names, what each plays, and what plumb promises of it. Plain data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tally.hpp"

namespace plumb_bench {

/// What is held against a family.
enum class Standing : std::uint8_t {
  promised,  ///< 0 in every safety column, or the program fails
  open,      ///< a known defect; becomes promised with its mend
  outside,   ///< beyond the bounds that plumb states: counted, not held
};
const char* to_string(Standing standing);

/// What the player of a family is to do: one per family, or per part of it that differs by numbers alone.
enum class Play : std::uint8_t {
  lies,
  silence,
  gap,
  turn,
  small_turns,
  clock,
  steady_push,
  truncated_frame,
  vertical,
  steps,
  settling,
  mirror,
  adaptive,
  drift,
  thermal,
  small_sigma,
  no_covariance,
  gravity_off,
  roll,
  yaw,
  tilting_triads,
  slow_turn,
  wobble,
  vibration,
  bias_shift,
  understated_noise,
  coarse_steps,
  slow_noise,
  mirrored_still,
  successive,
  after_fault,
  latitude,
  drift_and_fault,
};

struct Family {
  const char* name;
  const char* what;  ///< one line
  Play play;
  Standing safety;
  Standing failing;  ///< promised: never failed, which no family owes but those about failing for no good reason
  int least_n, most_n;
  bool by_n;      ///< a row for each number of sensors
  bool adaptive;  ///< copies the monitor and tries its lies beforehand
  double number;  ///< what the family is about: a rate, a size, a situation
  double weight;  ///< share of the episodes, beside the others
};

const std::vector<Family>& families();
/// -1 where there is none of that name.
int family_named(const std::string& name);
/// Families whose name begins so, ends with a full word: "b3" is b3-bias and b3-noise, "b3-bias" that one.
std::vector<int> families_like(const std::string& name);

/// Part of every state and result: a change of what any episode plays, or of what is counted, raises it.
inline constexpr int kHarnessVersion = 2;

/// One episode that did what it should not.
struct Finding {
  int family = 0;
  std::uint64_t episode = 0;
  std::string text;
};

struct EpisodeRequest {
  int family = 0;
  std::uint64_t seed = 1;     ///< of the run
  std::uint64_t episode = 0;  ///< number within the family
  std::uint64_t stream = 0;   ///< key of the episode's random numbers: see `stream_of`
  bool tell = false;          ///< every change of state, on standard output
};

/// Sensors of that episode: the lowest digit of its number.
int sensors_of(const Family& family, std::uint64_t episode);
/// The number without that digit: a family's own choices.
std::uint64_t variant_of(const Family& family, std::uint64_t episode);

/// Plays one episode. What happens in it depends on the request alone.
Tally play_episode(const EpisodeRequest& request, std::vector<Finding>& findings);

}  // namespace plumb_bench
