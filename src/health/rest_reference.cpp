#include "plumb/health/detail/rest_reference.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// A reading that differs by less than so many standard deviations from an earlier one is the same: that of a tool at
/// rest always is.
constexpr double kSameSigmas = 5.0;

}  // namespace

SensorSet reads_the_same(const SensorArray& array, const BlockEvidence& block,
                         const std::array<float, kCapacity>& earlier, double samples) noexcept {
  SensorSet same;
  const double scatter = std::sqrt(1.0 / block.samples + 1.0 / samples);
  for (int i = 0; i < array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double change = block.mean_mps2[a] - static_cast<double>(earlier[a]);
    if (std::fabs(change) <= kSameSigmas * array.sigma_mps2(i) * scatter) same = same.with(i);
  }
  return same & block.usable;
}

void RestReference::take(const BlockEvidence& block) noexcept {
  for (size_t a = 0; a < reading_mps2_.size(); ++a) reading_mps2_[a] = static_cast<float>(block.mean_mps2[a]);
  delivered_ = block.usable;
  samples_ = static_cast<float>(block.samples);
  held_ = true;
}

void RestReference::follow(const SensorArray& array, const BlockEvidence& block) noexcept {
  if (!held_) return;
  const SensorSet same = reads_the_same(array, block, reading_mps2_, static_cast<double>(samples_));
  held_ = rank_of(array, same & delivered_) == 3;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
