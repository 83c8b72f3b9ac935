/// Which faults explain the sets that were rejected in motion: T11, one set of hypotheses for all blocks.
#pragma once

#include <array>

#include "plumb/motion/motion_sets.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// The most units at once (`SensorArray::units`) that parity isolates one of within `sensors`: whatever is taken away
/// beside it leaves a vector (T11, T12; n - 2 - c where every sensor is a unit), at most kMotionDepth. 0 where a fault
/// is detected at best.
int motion_grade(const SensorArray& array, SensorSet sensors) noexcept;

/// What the fault sets that explain all rejected sets have in common.
struct MotionAnswer {
  SensorSet isolated;  ///< in every fault set of at most as many units as are searched for
  SensorSet suspects;  ///< in some of the smallest
  int least = 0;       ///< units of the smallest; one more than are searched for where none explains them
};

/// Sets that were rejected: each holds a faulty sensor.
class RejectedSets {
 public:
  /// False where nothing new is said: by a set that holds another one. There is room for every minimal dependent set;
  /// were there more, they would be dropped, which loses power and adds no error.
  bool add(SensorSet set) noexcept;
  void clear() noexcept { size_ = 0; }
  bool empty() const noexcept { return size_ == 0; }
  /// Every rejected set has a member of `faults`.
  bool explained_by(SensorSet faults) const noexcept;
  /// Forgets those with a member outside `sensors`.
  void keep_within(SensorSet sensors) noexcept;
  /// Over the fault sets of at most `most` units with members in `sensors`.
  MotionAnswer answer(const SensorUnits& units, SensorSet sensors, int most) const noexcept;

 private:
  static constexpr int kMost = kMotionSets;
  std::array<SensorSet, static_cast<std::size_t>(kMost)> sets_{};
  int size_ = 0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
