#include "plumb/detection/detail/block_tests.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

/// A member whose fault shows in parity with less than the root of this is one that no other sensor checks.
constexpr double kMinLeverage = 0.05;

}  // namespace

std::size_t BlockTests::place_of(SensorSet set) noexcept {
  if constexpr (kOwnPlaces) {
    if (set.size() < 3 || !SensorSet::first(kCapacity).contains(set)) return kPlaces - 1;  // of these none is tested
    const SensorSet missing = SensorSet::first(kCapacity) - set;
    return missing.empty() ? kPlaces - 2 : static_cast<std::size_t>(missing.lowest());
  }
  // Fibonacci hashing: the high bits of the product depend on all bits of the set.
  return (set.bits * 0x9E3779B1U) >> (32U - kPlacesLog2);
}

BlockTests::Told BlockTests::of(SensorSet set) const noexcept {
  Place& p = known_[place_of(set)];
  if (p.set != set) {
    p.set = set;
    if constexpr (!kOwnPlaces) p.test = SetTest{};  // a place of its own is as it was made
    const RowUncertainty* uncertainty = array_.perfectly_known() ? nullptr : &array_.uncertainty();
    test_set(array_, uncertainty, gravity_, limits_, block_, set, p.test);
  }
  return p.test;
}

bool BlockTests::corroborates_norm(SensorSet set, const SetTest& test) const noexcept {
  if (!test.tested || test.parity_rows < 1) return false;
  if (test.least_leverage >= kMinLeverage) return true;
  for (int i = 0; i < array_.size(); ++i) {
    if (!set.has(i)) continue;
    const double whitened = dot(array_.axis(i), times(test.covariance, array_.axis(i))) * block_.samples /
                            (array_.sigma_mps2(i) * array_.sigma_mps2(i));
    if (1.0 - whitened >= kMinLeverage) continue;
    const SetTest& others = of(set.without(i));
    if (!others.tested) return false;
    const double limit = others.norm_reject_limit(limits_);
    const bool off_too = std::fabs(others.norm) > limit;
    // Where the others know the length so badly that it may be what the set says, a steady acceleration explains all.
    const double apart_mps2 = std::fabs(others.norm_error_mps2 - test.norm_error_mps2);
    const bool deny = apart_mps2 * std::sqrt(block_.samples) > limit * others.norm_sigma_mps2;
    if (!off_too && deny) return false;
  }
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
