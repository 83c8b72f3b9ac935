// Counts of isolation trials, run for whichever capacity the sources were compiled with: plain numbers, so that one
// program holds several capacities.
#pragma once

#include <array>
#include <cstdint>

namespace plumb_bench {

struct Count {
  std::uint64_t trials = 0, correct = 0, undecided = 0, wrong = 0;
};

/// Episodes with at most m_strict faults of any kind; per grade how many named a healthy sensor.
struct SoundCount {
  std::uint64_t trials = 0, votes = 0, strict = 0, strict_right = 0;
  std::uint64_t parity = 0, parity_asked = 0, asserted = 0, asserted_asked = 0;
};

struct SoundnessJob {
  int n = 4;
  std::uint64_t trials = 0, seed = 0;
  bool fitted = false;         ///< tools from a pool of fits; else perfectly calibrated ones
  double least_gravity = 0.0;  ///< gravity error in sigmas of the reference: |error| from `least` to `most`
  double most_gravity = 3.0;
  int healthy = 3;   ///< at least so many in every trial
  int stations = 0;  ///< 0: one to four
};

/// How the faulty sensors of a study of rates lie.
enum class Lie : std::uint8_t { bias, stuck, colluding, mirrored };

/// Biases are log-uniform from `least` to `most` sigmas of one sample, constant over the stations.
struct RatesJob {
  int n = 4, faults = 1;
  double least = 10.0, most = 30.0;
  std::uint64_t trials = 0, seed = 0;
  Lie lie = Lie::bias;
  double gravity_error = 0.0;  ///< sigmas of the reference; every rule is told the reference
};

enum class Rule : std::uint8_t { strict, paper, glt, leave_out, best_fit };
inline constexpr int kRules = 5;
using RuleCounts = std::array<Count, kRules>;

/// Trials in which the best test there is, told what the faulty sensors read, rejects every wrong explanation: no rule
/// that blames nobody can name the faulty in more.
struct BoundCount {
  std::uint64_t trials = 0;
  std::uint64_t told = 0;            ///< over eight attitudes, gravity within its bound
  std::uint64_t told_moving = 0;     ///< and not one fault either in a tool that is accelerated anyhow
  std::uint64_t told_by_parity = 0;  ///< at the first attitude, by parity alone, at the provisional grade
};

#define PLUMB_BENCH_ISOLATION_RUNS                  \
  SoundCount soundness(const SoundnessJob& job);    \
  RuleCounts eight_attitudes(const RatesJob& job);  \
  Count parity_at_one_station(const RatesJob& job); \
  Count asserted_at_one_block(const RatesJob& job); \
  BoundCount best_possible(const RatesJob& job, double rate);

namespace cap8 {
PLUMB_BENCH_ISOLATION_RUNS
}
namespace cap16 {
PLUMB_BENCH_ISOLATION_RUNS
}
#undef PLUMB_BENCH_ISOLATION_RUNS

}  // namespace plumb_bench
