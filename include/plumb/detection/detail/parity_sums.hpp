/// Parity added up over the votes of an episode: what is too small to be told from noise at one of them is the same,
/// or nearly, at all, and noise is not.
#pragma once

#include <array>
#include <cmath>

#include "plumb/detection/detail/block_tests.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class ParitySums {
 public:
  void clear() noexcept { *this = ParitySums{}; }
  /// One vote, at which all of `monitored` delivered and none scattered. Beyond `kMostVotes` it is left out.
  void add(const BlockTests& tests, SensorSet monitored) noexcept;
  /// Whether a set of sensors that were monitored at every vote, healthy at all of them, may read their sum: noise
  /// grows with the root of the votes, and what is systematic adds up at most (docs/theory.md, section 5.3).
  bool agrees(const SensorArray& array, const TestLimits& limits, SensorSet set) const noexcept;

  bool plausible() const noexcept {
    for (const double sum : sum_mps2_) {
      if (!std::isfinite(sum)) return false;
    }
    return systematic_ >= 0.0;
  }

  static constexpr int kMostVotes = 10000;

 private:
  Readings sum_mps2_{};      ///< of sqrt(N) times the mean of each block
  double systematic_ = 0.0;  ///< of b_S of all sensors together, a misfit in full: parity of fewer is part of theirs
  int votes_ = 0;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using P = ParitySums;
    return field_list(per_sensor(&P::sum_mps2_), &P::systematic_, within(&P::votes_, 0, kMostVotes));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
