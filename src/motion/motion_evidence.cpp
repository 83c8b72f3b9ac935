#include "plumb/motion/motion_evidence.hpp"

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

int motion_grade(const SensorArray& array, SensorSet sensors) noexcept {
  const SensorUnits& units = array.units();
  for (int removed = 1; removed <= units.size() && removed <= kMotionDepth + 1; ++removed) {
    for (SensorSet some = SensorSet::first(removed); units.all().contains(some); some = next_of_same_size(some)) {
      if (!spans_space(array, sensors - units.sensors_of(some))) return removed >= 2 ? removed - 2 : 0;
    }
  }
  return kMotionDepth;
}

bool RejectedSets::add(SensorSet set) noexcept {
  int kept = 0;
  for (int k = 0; k < size_; ++k) {
    const SensorSet other = sets_[static_cast<std::size_t>(k)];
    if (set.contains(other)) return false;
    if (!other.contains(set)) sets_[static_cast<std::size_t>(kept++)] = other;
  }
  size_ = kept;
  if (size_ == kMost) return false;
  sets_[static_cast<std::size_t>(size_++)] = set;
  return true;
}

bool RejectedSets::explained_by(SensorSet faults) const noexcept {
  for (int k = 0; k < size_; ++k) {
    if ((sets_[static_cast<std::size_t>(k)] & faults).empty()) return false;
  }
  return true;
}

void RejectedSets::keep_within(SensorSet sensors) noexcept {
  int kept = 0;
  for (int k = 0; k < size_; ++k) {
    const SensorSet set = sets_[static_cast<std::size_t>(k)];
    if (sensors.contains(set)) sets_[static_cast<std::size_t>(kept++)] = set;
  }
  size_ = kept;
}

MotionAnswer RejectedSets::answer(const SensorUnits& units, SensorSet sensors, int most) const noexcept {
  MotionAnswer out;
  if (empty()) return out;
  out.least = most + 1;
  SensorSet common = sensors;
  const SensorSet all = units.all();
  for (int size = 1; size <= most && size <= kMotionDepth && size <= units.size(); ++size) {
    for (SensorSet some = SensorSet::first(size); all.contains(some); some = next_of_same_size(some)) {
      const SensorSet faults = units.sensors_of(some) & sensors;
      if (!explained_by(faults)) continue;
      if (out.least > most) out.least = size;
      if (size == out.least) out.suspects = out.suspects | faults;
      common = common & faults;
    }
  }
  if (out.least <= most) out.isolated = common;
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
