/// Which sizes of a fault are possible: a few intervals.
#pragma once

#include <array>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Faults from `low` to `high`.
struct FaultRange {
  double low_mps2 = 0.0, high_mps2 = 0.0;

  bool has(double f_mps2) const noexcept { return low_mps2 <= f_mps2 && f_mps2 <= high_mps2; }
  static constexpr auto fields() noexcept { return field_list(&FaultRange::low_mps2, &FaultRange::high_mps2); }
};

/// Up to four, in increasing order, apart from each other. None: there is no such fault.
struct FaultRanges {
  static constexpr int kMost = 4;
  std::array<FaultRange, kMost> range{};
  int count = 0;

  bool empty() const noexcept { return count == 0; }
  bool has(double f_mps2) const noexcept;
  /// `more` lies behind all others. With one too many the two that are nearest to each other become one: what was
  /// possible stays possible.
  void append(const FaultRange& more) noexcept;
  FaultRanges widened(double by_mps2) const noexcept;
  FaultRanges with(const FaultRanges& other) const noexcept;  ///< in both

  bool plausible() const noexcept;
  static constexpr auto fields() noexcept {
    return field_list(&FaultRanges::range, within(&FaultRanges::count, 0, kMost));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
