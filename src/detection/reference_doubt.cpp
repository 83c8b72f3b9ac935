#include "plumb/detection/reference_doubt.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

void ReferenceDoubt::add(SensorSet set) noexcept {
  if (count_ < kMax) set_[static_cast<std::size_t>(count_)] = set;
  if (count_ <= kMax) ++count_;
}

bool ReferenceDoubt::excuses(SensorSet set) const noexcept {
  if (count_ > kMax) return true;
  for (int k = 0; k < count_; ++k) {
    if (set_[static_cast<std::size_t>(k)].contains(set)) return true;
  }
  return false;
}

void ReferenceClaims::hear(int index, double error_mps2, double margin_mps2) noexcept {
  const auto from = static_cast<float>(error_mps2 - margin_mps2), to = static_cast<float>(error_mps2 + margin_mps2);
  const bool first = !heard_[slot(index)];
  if (first || from > low_[slot(index)]) low_[slot(index)] = from;
  if (first || to < high_[slot(index)]) high_[slot(index)] = to;
  heard_[slot(index)] = true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
