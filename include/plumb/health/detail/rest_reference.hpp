/// The readings of the last passed block before an alarm, while the tool has not moved since: what an array that can
/// bear no further fault may be held against.
#pragma once

#include <array>

#include "plumb/array/geometry.hpp"
#include "plumb/core/detail/flag.hpp"
#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Sensors that read in this block what they read in an earlier one, of `samples` samples: within five sigmas of the
/// difference of the two means.
SensorSet reads_the_same(const SensorArray& array, const BlockEvidence& block,
                         const std::array<float, kCapacity>& earlier, double samples) noexcept;

class RestReference {
 public:
  void clear() noexcept { *this = RestReference{}; }
  /// A passed block, with no alarm on record.
  void take(const BlockEvidence& block) noexcept;
  /// Another block: enough sensors to determine a vector read the same, or the tool may have turned and it is over.
  void follow(const SensorArray& array, const BlockEvidence& block) noexcept;
  bool holds() const noexcept { return held_; }

 private:
  std::array<float, kCapacity> reading_mps2_{};
  SensorSet delivered_;
  float samples_ = 1.0F;
  Flag held_;

  friend struct FieldsOf;
  bool plausible() const noexcept { return samples_ > 0.0F; }
  static constexpr auto fields() noexcept {
    using R = RestReference;
    return field_list(per_sensor(&R::reading_mps2_), &R::delivered_, &R::samples_, &R::held_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
