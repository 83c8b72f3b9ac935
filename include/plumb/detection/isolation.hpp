/// Who is at fault: which sets of sensors can still explain the evidence of an episode.
///
/// What is counted are units: sensors, or chips with all their axes where the array states them (docs/theory.md,
/// section 5.7). A fault set is made of units, and a sensor is never suspected without the others of its chip.
///
/// A sensor is excluded only if every explanation with at most m faults contains it (theorem T5:
/// a sensor healthy throughout the episode is never excluded while the sensors healthy throughout
/// have rank 3, at most m are not, and systematic errors are within their bounds).
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/flag.hpp"
#include "plumb/detection/detail/norm_mismatch_doubt.hpp"
#include "plumb/detection/protection_level.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Largest binomial coefficient over kStrictCapacity: the most sets of units of one size that can vote.
constexpr int max_voting_sets() noexcept {
  long best = 1;
  for (int k = 1; k <= kStrictCapacity; ++k) {
    long value = 1;
    for (int i = 1; i <= k; ++i) value = value * (kStrictCapacity - k + i) / i;
    if (value > best) best = value;
  }
  return static_cast<int>(best);
}
inline constexpr int kVotingCapacity = max_voting_sets();

/// What a vote found.
struct IsolationAnswer {
  SensorSet strict;    ///< found faulty at the confirmed grade; empty where the survivors are not consistent
  SensorSet parity;    ///< found faulty at the provisional grade, by this station alone
  SensorSet asserted;  ///< found faulty under "at most M faults"
  int live = 0;        ///< test subsets still consistent
  int voting = 0;      ///< test subsets in all
  bool no_consistent_hypothesis = false;  ///< some sensor is redundant and no test subset is consistent
  bool norm_void = false;  ///< a well-checked set agrees with itself and not with gravity: the norm excuses it here
  bool full_consistent = false;  ///< the empty fault set still explains everything

  static constexpr auto fields() noexcept {
    using A = IsolationAnswer;
    return field_list(&A::strict, &A::parity, &A::asserted, within(&A::live, 0, kVotingCapacity),
                      within(&A::voting, 0, kVotingCapacity), &A::no_consistent_hypothesis, &A::norm_void,
                      &A::full_consistent);
  }
};

/// Outcome of scanning the fault sets of at most kScanDepth units.
struct FaultSetScan {
  std::array<std::uint8_t, kCapacity> minimum_faults{};  ///< s_i of each sensor, in units; 255 = none found
  SensorSet suspects;                                    ///< union of the consistent fault sets of least size
  SensorSet asserted;  ///< intersection of the consistent fault sets of at most `assumed_faults` units
  int least = 255;     ///< size of the smallest consistent fault set
  Flag protection_available;
  int covered = 0;              ///< K: the protection level is over consistent fault sets of at most so many units
  Flag bears_more = true;       ///< that is the priors' number on top of what an alarm on record takes to explain
  double protection_rad = 0.0;  ///< of what is felt, g + a

  bool plausible() const noexcept { return protection_rad >= 0.0; }
  static constexpr auto fields() noexcept {
    using S = FaultSetScan;
    return field_list(&S::minimum_faults, &S::suspects, &S::asserted, within(&S::least, 0, 255),
                      &S::protection_available, within(&S::covered, 0, kCapacity), &S::bears_more, &S::protection_rad);
  }
};

class Isolation {
 public:
  /// Poses the problem on the sensors `monitored` (those not excluded). Rejected sets stay rejected as long as the size
  /// of the test subsets is unchanged, they consist of monitored units (projection) and no unit has lost a part of its
  /// sensors; otherwise none is rejected.
  void pose(const SensorArray& array, SensorSet monitored) noexcept;
  /// After the rejected sets have been read back: poses the problem to which they belong.
  void resume(const SensorArray& array, SensorSet monitored) noexcept;
  /// Forgets all evidence: a new episode.
  void clear() noexcept;

  SensorSet monitored() const noexcept { return monitored_; }
  int coplanarity() const noexcept { return coplanarity_; }
  int confirmed_grade() const noexcept { return strict_; }
  int provisional_grade() const noexcept { return parity_; }

  /// One station's pooled block: rejects what it contradicts and answers. Sets with a member that is not
  /// usable are not tested and stay consistent, and so do those with a member outside `corroborating`: what a sensor
  /// that scatters beyond its noise reads on average may be noise, or motion that faulty ones hide by hanging.
  IsolationAnswer vote(const BlockTests& tests, SensorSet corroborating = SensorSet::first(kCapacity)) noexcept;

  /// Fault sets of at most kScanDepth units against this block and the episode's rejected sets; the protection level
  /// is the largest separation from the estimate of `in_service` over the consistent fault sets of at most
  /// `faults_covered` units (solution separation; of those in service alone, too, where some are provisionally
  /// excluded). Where two or more sensors of one direction are provisionally excluded, all others of it in service are
  /// one fault more: a common cause. Where the sensors that a fault set leaves measure in one plane only, the mirrored
  /// vector counts. For the assumed answer a fault set that leaves others than `corroborating`, or too few to be
  /// tested, stays consistent.
  FaultSetScan scan(const BlockTests& tests, SensorSet in_service, int depth, int assumed_faults,
                    const ProtectionTerms& protect,
                    SensorSet corroborating = SensorSet::first(kCapacity)) const noexcept;

  /// Whether the unsuspected sensors in service would be right within `limit_rad`, by the terms of `scan`,
  /// over every explanation of up to as many faults as it takes, or as `protect` covers. False where they determine no
  /// vector, where an explanation leaves too few to determine one, and where nothing explains the block.
  bool bounded_without(const BlockTests& tests, SensorSet in_service, const FaultSetScan& scan,
                       const ProtectionTerms& protect, double limit_rad) const noexcept;

  int live() const noexcept;
  int voting() const noexcept { return voting_; }

 private:
  bool is_rejected(int index) const noexcept {
    return ((rejected_[static_cast<std::size_t>(index) / 64U] >> (static_cast<unsigned>(index) % 64U)) & 1U) != 0;
  }
  void reject(int index) noexcept {
    rejected_[static_cast<std::size_t>(index) / 64U] |= std::uint64_t{1} << (static_cast<unsigned>(index) % 64U);
  }
  void resume(const SensorArray& array, SensorSet monitored, int coplanarity) noexcept;
  /// The monitored sensors of a set of units, and the units that have any.
  SensorSet sensors_of(SensorSet units) const noexcept { return units_.sensors_of(units) & monitored_; }
  SensorSet monitored_units() const noexcept { return units_.units_of(monitored_); }
  bool any_rejected() const noexcept;
  bool has_rejected_subset(SensorSet set) const noexcept;
  /// Who is asked about gravity.
  ReferencePanel panel_of(const BlockTests& tests) const noexcept {
    return {monitored_, monitored_ & tests.block().usable, units_, coplanarity_};
  }
  /// What is held against a hypothesis about a block, beside the test of the sensors that it leaves.
  struct Grounds {
    NormMismatchDoubt doubt;
    bool rejections = false;  ///< some set of the episode is rejected
  };
  Grounds grounds(const BlockTests& tests) const noexcept;
  /// Whether the sensors `rest`, with their test, can be the healthy ones.
  bool explains(const TestLimits& limits, const Grounds& grounds, SensorSet rest, const SetTest& test) const noexcept;
  SensorSet exclude_by_parity(const BlockTests& tests, SensorSet corroborating) const noexcept;

  std::array<std::uint64_t, static_cast<std::size_t>(kVotingCapacity + 63) / 64U> rejected_{};
  VoteRecord record_;
  SensorSet monitored_;
  int voting_ = 0;               ///< test subsets within the monitored sensors
  SensorUnits units_;            ///< configured, over which sets are numbered
  std::int8_t voting_size_ = 3;  ///< c + 1
  std::int8_t coplanarity_ = 2;
  std::int8_t strict_ = 0;
  std::int8_t parity_ = 0;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using I = Isolation;
    return field_list(&I::rejected_, &I::record_, not_stored(&I::monitored_), not_stored(&I::voting_),
                      not_stored(&I::units_), not_stored(&I::voting_size_), not_stored(&I::coplanarity_),
                      not_stored(&I::strict_), not_stored(&I::parity_));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
