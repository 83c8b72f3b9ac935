#include "tally.hpp"

namespace plumb_bench {

const char* to_string(Count count) {
  switch (count) {
    case Count::episodes: return "episodes";
    case Count::blocks: return "blocks";
    case Count::valid_blocks: return "valid_blocks";
    case Count::wrong_exclusion: return "wrong_exclusion";
    case Count::wrong_aside: return "wrong_provisional_exclusion";
    case Count::beyond_level: return "beyond_protection_level";
    case Count::hazardous: return "hazardous";
    case Count::stale: return "stale";
    case Count::broken: return "broken";
    case Count::failed_healthy: return "failed_healthy";
    case Count::unpromised: return "unpromised";
    case Count::false_doubt: return "false_doubt";
    case Count::failed: return "failed";
    case Count::faulty: return "faulty";
    case Count::all_out: return "all_out";
  }
  return "?";
}

void Tally::add(const Tally& other) {
  for (std::size_t k = 0; k < count.size(); ++k) count[k] += other.count[k];
  for (std::size_t k = 0; k < to_nominal.size(); ++k) to_nominal[k] += other.to_nominal[k];
}

std::uint64_t Tally::unsafe() const {
  std::uint64_t sum = 0;
  for (const Count c : kSafety) sum += (*this)[c];
  return sum;
}

std::size_t Tally::median_to_nominal() const {
  std::uint64_t all = 0, below = 0;
  for (const std::uint64_t k : to_nominal) all += k;
  for (std::size_t k = 0; k < to_nominal.size(); ++k) {
    below += to_nominal[k];
    if (2 * below >= all) return k;
  }
  return kNominalBins - 1;
}

}  // namespace plumb_bench
