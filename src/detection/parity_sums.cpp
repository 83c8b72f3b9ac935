#include "plumb/detection/detail/parity_sums.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

void ParitySums::add(const BlockTests& tests, SensorSet monitored) noexcept {
  const SetTest& all = tests.of(monitored);
  if (!all.tested || votes_ >= kMostVotes) return;
  const double root_n = std::sqrt(all.samples);
  for (std::size_t i = 0; i < sum_mps2_.size(); ++i) sum_mps2_[i] += root_n * tests.block().mean_mps2[i];
  systematic_ += all.parity_systematic;
  ++votes_;
}

bool ParitySums::agrees(const SensorArray& array, const TestLimits& limits, SensorSet set) const noexcept {
  if (votes_ < 2 || set.size() < 4) return true;  // the block's own test says all
  const double noise = limits.reject[static_cast<std::size_t>(set.size() - 3)] * std::sqrt(static_cast<double>(votes_));
  return !(parity_residual(array, sum_mps2_, set) > noise + systematic_);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
