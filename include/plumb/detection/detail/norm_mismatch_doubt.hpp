/// When may the length of gravity speak against a set of sensors? Not where other sensors, more of them and checked by
/// each other, agree among themselves and disagree with gravity too: then it may be gravity that is off, or the tool
/// moves steadily, and a norm test would reject whichever healthy set measures the length best.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/detection/detail/block_tests.hpp"
#include "plumb/detection/detail/parity_sums.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// The sets that doubt gravity at one block. If such a set is healthy, then gravity is off, and it is no fault of its
/// subsets that they are off too: the norm excuses them. A healthy sensor in a healthy set of four or more is thereby
/// never excluded by a wrong gravity.
class NormMismatchDoubt {
 public:
  static constexpr int kMax = 64;
  void add(SensorSet set) noexcept;
  bool any() const noexcept { return count_ > 0; }
  /// With more sets than fit, everything is excused: nothing is rejected that should not be.
  bool excuses(SensorSet set) const noexcept;

 private:
  std::array<SensorSet, kMax> set_{};
  int count_ = 0;
};

/// What a set of sensors is off gravity by, beside what is the same at every attitude: a wrong gravity and a common
/// scale.
struct LengthError {
  double error_mps2 = 0.0;
  double margin_mps2 = 0.0;  ///< known to so much
};
LengthError length_error(const BlockTests& tests, const SetTest& test) noexcept;
/// What is the same at every attitude: three sigmas of gravity where it is used, and where it calibrated.
double constant_length_error_mps2(const BlockTests& tests) noexcept;

/// What the sets that doubt gravity have claimed during an episode. A wrong gravity and a common scale are the
/// same at every attitude; what a chance set of faulty sensors is off by turns with the tool. A claim that was not the
/// same everywhere is refuted.
class ReferenceClaims {
 public:
  /// Arrays of up to so many units have room for every set; larger ones for their sets of four.
  static constexpr int kAllSets = kStrictCapacity < 8 ? kStrictCapacity : 8;
  static constexpr int kMax = kStrictCapacity <= 8 ? 1 << kAllSets : 1820;
  /// Where a set of units is kept: `rank` is its number among all of its size; -1 where there is no room.
  static constexpr int index_of(SensorSet set, int rank, int universe) noexcept {
    if (universe <= kAllSets) return static_cast<int>(set.bits);
    return set.size() == 4 && rank < kMax ? rank : -1;
  }

  void clear() noexcept { *this = ReferenceClaims{}; }
  void hear(int index, const LengthError& off) noexcept;
  /// No one wrong gravity explains what the set was off by.
  bool refuted(int index) const noexcept { return low_[slot(index)] > high_[slot(index)]; }
  /// Width of the range of gravities, off by `most_mps2` or less, that explain what the set was off by: below zero
  /// where there is none.
  double left_mps2(int index, double most_mps2) const noexcept {
    if (!heard_[slot(index)]) return 2.0 * most_mps2;
    const double low = std::fmax(static_cast<double>(low_[slot(index)]), -most_mps2);
    return std::fmin(static_cast<double>(high_[slot(index)]), most_mps2) - low;
  }

 private:
  static constexpr std::size_t slot(int index) noexcept { return static_cast<std::size_t>(index); }

  /// Between what a wrong gravity would have to lie, over the stations heard.
  std::array<float, static_cast<std::size_t>(kMax)> low_{}, high_{};
  std::array<bool, static_cast<std::size_t>(kMax)> heard_{};

  friend struct FieldsOf;
  static constexpr int slots(int sensors) noexcept { return sensors <= kAllSets ? 1 << sensors : kMax; }
  static constexpr auto fields() noexcept {
    using C = ReferenceClaims;
    return field_list(leading(any(&C::low_), &slots), leading(any(&C::high_), &slots), leading(&C::heard_, &slots));
  }
};

/// What the votes of an episode have put on record.
struct VoteRecord {
  ReferenceClaims claims;
  ParitySums parity;

  void clear() noexcept {
    claims.clear();
    parity.clear();
  }
  static constexpr auto fields() noexcept { return field_list(&VoteRecord::claims, &VoteRecord::parity); }
};

/// Who is asked about gravity at one block.
struct ReferencePanel {
  SensorSet monitored;       ///< the sensors that are not excluded
  SensorSet delivered;       ///< those of them that delivered
  const SensorUnits& units;  ///< configured, over which sets are numbered
  int coplanarity = 0;

  int universe() const noexcept { return units.size(); }
  /// The units that delivered with all of their monitored sensors: who is asked.
  SensorSet asked() const noexcept { return units.units_within(delivered, monitored); }
  /// The monitored sensors of a set of units.
  SensorSet sensors_of(SensorSet set) const noexcept { return units.sensors_of(set) & monitored; }
  /// Units of the smallest sets whose parity checks every member.
  int smallest_checked() const noexcept;
};

/// The sets that doubt gravity at a vote: what they claim goes on record, and each is judged by all of its claims. A
/// set whose parity the record contradicts is not heard.
NormMismatchDoubt hear_doubt(const BlockTests& tests, const ReferencePanel& panel, VoteRecord& record) noexcept;
/// The same at any other question: judged by what is on record, to which nothing is added.
NormMismatchDoubt recall_doubt(const BlockTests& tests, const ReferencePanel& panel, const VoteRecord& record) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
