/// The tests of one block: whichever part of the monitor asks for a set of sensors, it is tested once.
#pragma once

#include <array>
#include <type_traits>

#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Refers to what it is made of: it lives within one step, on the stack, and must not outlive any of the four.
class BlockTests {
 public:
  BlockTests(const SensorArray& array, const GravityReference& gravity, const TestLimits& limits,
             const BlockEvidence& block) noexcept
      : array_(array), gravity_(gravity), limits_(limits), block_(block) {}

  const SensorArray& array() const noexcept { return array_; }
  const GravityReference& gravity() const noexcept { return gravity_; }
  const TestLimits& limits() const noexcept { return limits_; }
  const BlockEvidence& block() const noexcept { return block_; }

  /// Up to four sensors every set has a place of its own, and its result stays: no copy on the stack. Else a
  /// later set may take the place of an earlier one.
  static constexpr bool kOwnPlaces = kCapacity <= 4;
  using Told = std::conditional_t<kOwnPlaces, const SetTest&, SetTest>;
  /// `test_set` of the set at the block.
  Told of(SensorSet set) const noexcept;

  /// True where `set`, which passes parity, may speak about gravity: the parity of the others checks every member
  /// (leverage of at least 0.05), or the others do not deny it: the length is off without that member too, or may be,
  /// both by the rejection limit. Otherwise an unchecked member may be faulty: mikoff5's z axes, four of them
  /// with three coplanar, pass parity whatever the fourth reads. `test` is that of the set.
  bool corroborates_norm(SensorSet set, const SetTest& test) const noexcept;

 private:
  /// Enough for the whole set and every set without one sensor, each mostly in a place of its own; on a host, whose
  /// stack is no matter, for nearly every set of six sensors. Of four sensors the first are all that can be tested; one
  /// place more is for those that cannot.
  static constexpr unsigned kPlacesLog2 = sizeof(void*) >= 8 ? 6 : kCapacity <= 8 ? 4 : 5;
  static constexpr std::size_t kPlaces = kOwnPlaces ? 6 : std::size_t{1} << kPlacesLog2;
  static std::size_t place_of(SensorSet set) noexcept;
  struct Place {
    SensorSet set;
    SetTest test;
  };

  const SensorArray& array_;
  const GravityReference& gravity_;
  const TestLimits& limits_;
  const BlockEvidence& block_;
  mutable std::array<Place, kPlaces> known_{};  ///< what was asked before
};

}  // namespace PLUMB_ABI
}  // namespace plumb
