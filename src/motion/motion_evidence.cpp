#include "plumb/motion/motion_evidence.hpp"

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

FaultUnits::FaultUnits(const SensorArray& array, const MotionSetup& setup) noexcept {
  const int n = array.size() < kMotionCapacity ? array.size() : kMotionCapacity;
  SensorSet placed;
  for (int i = 0; i < n; ++i) {
    if (placed.has(i)) continue;
    SensorSet unit = SensorSet::of(i);
    const std::uint8_t chip = setup.chip[static_cast<std::size_t>(i)];
    for (int j = i + 1; j < n && chip != 0; ++j) {
      if (setup.chip[static_cast<std::size_t>(j)] == chip) unit = unit.with(j);
    }
    placed = placed | unit;
    unit_[static_cast<std::size_t>(size_++)] = unit;
  }
}

SensorSet FaultUnits::sensors_of(SensorSet units) const noexcept {
  SensorSet out;
  for (int k = 0; k < size_; ++k) {
    if (units.has(k)) out = out | (*this)[k];
  }
  return out;
}

int FaultUnits::count_in(SensorSet sensors) const noexcept {
  int count = 0;
  for (int k = 0; k < size_; ++k) count += ((*this)[k] & sensors).empty() ? 0 : 1;
  return count;
}

int FaultUnits::grade(const SensorArray& array, SensorSet sensors) const noexcept {
  const SensorSet all = SensorSet::first(size_);
  for (int removed = 1; removed <= size_ && removed <= kMotionDepth + 1; ++removed) {
    for (SensorSet some = SensorSet::first(removed); all.contains(some); some = next_of_same_size(some)) {
      const SensorSet rest = sensors - sensors_of(some);
      if (!spans_space(array, rest)) return removed >= 2 ? removed - 2 : 0;
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

MotionAnswer RejectedSets::answer(const FaultUnits& units, SensorSet sensors, int most) const noexcept {
  MotionAnswer out;
  if (empty()) return out;
  out.least = most + 1;
  SensorSet common = sensors;
  const SensorSet all = SensorSet::first(units.size());
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
