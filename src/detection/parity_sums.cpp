#include "plumb/detection/detail/parity_sums.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

void ParitySums::add(const BlockTests& tests, SensorSet monitored) noexcept {
  const SetTest& all = tests.of(monitored);
  if (!all.tested || votes_ >= kMostVotes) return;
  const double root_n = std::sqrt(all.samples);
  for (int i = 0; i < tests.array().size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    if (monitored.has(i)) sum_mps2_[a] += root_n * tests.block().mean_mps2[a];
  }
  // A misfit is noise of an attitude, and the same at all of its votes: over these it adds up, and no root is taken.
  const double misfit = largest_misfit(tests.array(), tests.array().uncertainty(), monitored, all.samples);
  const auto rows = static_cast<std::size_t>(all.parity_rows);
  systematic_ += all.parity_systematic + tests.limits().reject[rows] * (misfit - noise_growth(misfit));
  ++votes_;
}

bool ParitySums::agrees(const SensorArray& array, const TestLimits& limits, SensorSet set) const noexcept {
  if (votes_ < 2 || set.size() < 4) return true;  // the block's own test says all
  const double noise = limits.reject[static_cast<std::size_t>(set.size() - 3)] * std::sqrt(static_cast<double>(votes_));
  return !(parity_residual(array, sum_mps2_, set) > noise + systematic_);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
