/// Minimal dependent sets of axes: the smallest sets whose members check one another whatever the specific force is.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/motion/motion_setup.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Two parallel axes, three in one plane, or four in general position; `null` has length 1 and
/// sum null_i h_i = `rest`, which is zero but for axes that are parallel or coplanar only nearly.
struct MotionSet {
  std::array<std::uint8_t, 4> sensor{};
  std::uint8_t size = 0;
  std::array<double, 4> null{};
  Vec3 rest{};
  /// The members, and those whose readings say how large the force is: axes that are turned a little mix in a part of
  /// it. Two or three axes do not see all of it; where they belong to chips that do, all axes of these chips count, and
  /// what is rejected is all of them.
  SensorSet all;
  double least_singular = 0.0;  ///< of the axes of `all`; 0 where they do not see all of the force
};

/// Axes count as parallel or coplanar where |sum null_i h_i| is at most this.
inline constexpr double kMotionRest = 0.02;
/// C(n, 4) and C(n, 2) more: sets of two take the place of sets of four.
inline constexpr int kMotionSets =
    kMotionCapacity * (kMotionCapacity - 1) * (kMotionCapacity - 2) * (kMotionCapacity - 3) / 24 +
    kMotionCapacity * (kMotionCapacity - 1) / 2;

class MotionSets {
 public:
  MotionSets() noexcept = default;
  /// At most kMotionCapacity sensors; of more sets than fit the last are left out, which loses power and adds no error.
  explicit MotionSets(const SensorArray& array) noexcept;

  int size() const noexcept { return size_; }
  const MotionSet& operator[](int k) const noexcept { return sets_[static_cast<std::size_t>(k)]; }
  /// Whether some of these sensors check each other: a set lies within them.
  bool any_within(SensorSet sensors) const noexcept;
  /// The largest |rest| of the sets that do not see all of the force.
  double largest_blind_rest() const noexcept { return largest_blind_rest_; }
  /// The largest |rest| / least_singular of the others: what an error of the readings adds by way of their force.
  double largest_gain() const noexcept { return largest_gain_; }

 private:
  void add(const SensorArray& array, SensorSet members) noexcept;
  bool has_subset_of(SensorSet members) const noexcept;

  std::array<MotionSet, static_cast<std::size_t>(kMotionSets)> sets_{};
  int size_ = 0;
  double largest_blind_rest_ = 0.0, largest_gain_ = 0.0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
