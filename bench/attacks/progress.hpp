// How far a run has come, and its state file: what was played is added up per family and number of sensors, so that
// an interrupted run goes on where it was and ends as if it had never stopped.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "family.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb_bench {

inline constexpr int kLeastSensors = 4, kMostSensors = 8;
inline constexpr int kSensorCounts = kMostSensors - kLeastSensors + 1;

struct Progress {
  explicit Progress(std::uint64_t seed_ = 1, std::uint64_t first = 0);

  std::uint64_t seed;
  std::vector<std::uint64_t> next;  ///< per family: the first episode that has not been played
  std::vector<std::array<Tally, kSensorCounts>> tally;
  std::vector<Finding> findings;  ///< the first few of each family

  Tally total(int family) const;
};

/// How many episodes of each family.
struct RunPlan {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;                ///< number of the first episode in each family
  std::vector<std::uint64_t> episodes{};  ///< per family, 0 = not played
  std::uint64_t chunk = 200;              ///< episodes between two calls of `after_chunk`
};

/// Shares `episodes` out among the chosen families, `adaptive_share` of them to the adaptive ones. Each gets one at
/// least for every number of sensors.
std::vector<std::uint64_t> shared_out(std::uint64_t episodes, double adaptive_share, const std::vector<int>& chosen);

/// Plays what is left of the plan, family by family in turns; stops early where `after_chunk` answers false.
void play(const RunPlan& plan, Progress& progress, const std::function<bool(const Progress&)>& after_chunk);

/// Key of an episode's random numbers: by seed, name of the family and number, whatever was played before.
std::uint64_t stream_of_episode(std::uint64_t seed, int family, std::uint64_t episode);

std::string state_text(const Progress& progress);
/// The last lines of a state, behind what it holds.
std::string with_hash(const std::string& members);
/// What `state_text` wrote. Errors: unreadable; not a state; damaged; of another seed, version of the library or of the
/// harness, list of families, or of a build in which the same few episodes come to something else.
plumb::io::FileExpected<Progress> read_state(const std::string& path, std::uint64_t seed);

}  // namespace plumb_bench
