#include "plumb/detection/isolation.hpp"

#include "plumb/detection/detail/one_gravity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

using std::size_t;

/// Calls f(set, index) for all subsets of {0..universe-1} of the given size, in a fixed order.
template <class F>
void for_each_subset(int universe, int size, F&& f) noexcept {
  if (size < 1 || size > universe) return;
  const SensorSet all = SensorSet::first(universe);
  int index = 0;
  for (SensorSet s = SensorSet::first(size); all.contains(s); s = next_of_same_size(s)) {
    f(s, index);
    ++index;
  }
}

/// Calls f(F) for every set of units of `monitored` with at most `depth` members, and none of more than three, smallest
/// first.
template <class F>
void for_each_fault_set(SensorSet monitored, int n, int depth, F&& f) noexcept {
  f(SensorSet{});
  if (depth < 1) return;
  for (int i = 0; i < n; ++i) {
    if (monitored.has(i)) f(SensorSet::of(i));
  }
  if (depth < 2) return;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (monitored.has(i) && monitored.has(j)) f(SensorSet::of(i).with(j));
    }
  }
  if (depth < 3) return;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        if (monitored.has(i) && monitored.has(j) && monitored.has(k)) f(SensorSet::of(i).with(j).with(k));
      }
    }
  }
}

/// Whether `f(F)` holds for every one of them; none is asked after one for which it does not.
template <class F>
bool all_fault_sets(SensorSet monitored, int n, int depth, F&& f) noexcept {
  bool all = true;
  for_each_fault_set(monitored, n, depth, [&](SensorSet set) { all = all && f(set); });
  return all;
}

/// Calls f(S) for all sensors S of one direction that are `left` where two or more of that direction are out: what
/// moved those may have moved these.
template <class F>
void for_each_common_cause(const SensorArray& array, SensorSet left, SensorSet out, F&& f) noexcept {
  if constexpr (kCapacity < 5) return;  // of four sensors no two can be out and two left
  for (int i = 0; i < array.size(); ++i) {
    if (!left.has(i)) continue;
    const SensorSet alike = of_direction(array, left, array.axis(i));
    if (alike.lowest() == i && of_direction(array, out, array.axis(i)).size() >= 2) f(alike);
  }
}

/// Whether nothing in the block speaks against the set: it agrees with itself and with gravity, or is excused from
/// that.
bool may_be_healthy(SensorSet set, const SetTest& t, const TestLimits& limits,
                    const NormMismatchDoubt& doubt) noexcept {
  return t.parity_consistent(limits) && (t.consistent(limits) || doubt.excuses(set));
}

}  // namespace

void Isolation::clear() noexcept {
  rejected_.fill(0);
  record_.clear();
}

void Isolation::pose(const SensorArray& array, SensorSet monitored) noexcept {
  const int c = plumb::coplanarity(array, monitored);
  const SensorUnits& units = array.units();
  // What a chip without an axis reads was never tested.
  const bool whole = (units.whole(monitored) & monitored_) == monitored;
  if (c + 1 != voting_size_ || !monitored_.contains(monitored) || units_.size() != units.size() || !whole) clear();
  resume(array, monitored, c);
}

void Isolation::resume(const SensorArray& array, SensorSet monitored) noexcept {
  resume(array, monitored, plumb::coplanarity(array, monitored));
}

void Isolation::resume(const SensorArray& array, SensorSet monitored, int c) noexcept {
  monitored_ = monitored;
  units_ = array.units();
  coplanarity_ = static_cast<std::int8_t>(c);
  voting_size_ = static_cast<std::int8_t>(c + 1);
  const int units = units_.count(monitored & array.all());
  const bool strict_possible = units_.size() <= kStrictCapacity;
  strict_ = static_cast<std::int8_t>(strict_possible ? plumb::confirmed_grade(units, c) : 0);
  parity_ = static_cast<std::int8_t>(plumb::provisional_grade(units, c));
  if (!strict_possible && parity_ > kScanDepth) parity_ = kScanDepth;
  voting_ = 0;
  if (strict_ < 1) return;
  const SensorSet asked = monitored_units();
  for_each_subset(units_.size(), voting_size_, [&](SensorSet u, int) {
    if (asked.contains(u)) ++voting_;
  });
}

int Isolation::live() const noexcept {
  int count = 0;
  if (strict_ < 1) return count;
  const SensorSet asked = monitored_units();
  for_each_subset(units_.size(), voting_size_, [&](SensorSet u, int index) {
    if (asked.contains(u) && !is_rejected(index)) ++count;
  });
  return count;
}

bool Isolation::any_rejected() const noexcept {
  std::uint64_t any = 0;
  for (const std::uint64_t word : rejected_) any |= word;
  return any != 0;
}

bool Isolation::has_rejected_subset(SensorSet set) const noexcept {
  if (strict_ < 1) return false;
  const SensorSet all = units_.all(), whole = units_.units_within(set, units_.grouped() ? monitored_ : set);
  int index = 0;
  for (SensorSet u = SensorSet::first(voting_size_); all.contains(u); u = next_of_same_size(u), ++index) {
    if (is_rejected(index) && whole.contains(u)) return true;
  }
  return false;
}

SensorSet Isolation::exclude_by_parity(const BlockTests& tests, SensorSet corroborating) const noexcept {
  const TestLimits& limits = tests.limits();
  // Where a monitored sensor did not deliver, the published grade does not hold for the rest: no sensor is excluded.
  const SensorSet asked = monitored_, units = monitored_units();
  const int grade = provisional_grade();
  if (grade < 1 || !tests.block().usable.contains(asked)) return {};
  SensorSet cleared;
  const auto hear = [&](SensorSet s) {
    if (cleared.contains(s)) return;
    if (!corroborating.contains(s) || tests.of(s).parity_consistent(limits)) cleared = cleared | s;
  };
  if (units_.size() <= kStrictCapacity) {
    const int size = units.size() - grade;
    for_each_subset(units_.size(), size, [&](SensorSet u, int) {
      if (units.contains(u)) hear(sensors_of(u));
    });
  }
  for_each_fault_set(units, units_.size(), grade < kScanDepth ? grade : kScanDepth,
                     [&](SensorSet f) { hear(asked - sensors_of(f)); });
  const SensorSet excluded = asked - cleared;
  if (excluded.empty() || units_.count(excluded) > grade) return {};
  const SetTest& rest = tests.of(asked - excluded);
  const bool agree = rest.tested && rest.parity_consistent(limits);
  return agree ? excluded : SensorSet{};
}

IsolationAnswer Isolation::vote(const BlockTests& tests, SensorSet corroborating) noexcept {
  const TestLimits& limits = tests.limits();
  IsolationAnswer out;
  out.voting = voting_;
  const ReferencePanel panel = panel_of(tests);
  const bool hears = corroborating.contains(monitored_);
  const NormMismatchDoubt doubt = hears ? hear_doubt(tests, panel, record_) : recall_doubt(tests, panel, record_);
  out.norm_void = doubt.any();
  out.parity = exclude_by_parity(tests, corroborating);
  const auto consistent_here = [&](SensorSet s) { return may_be_healthy(s, tests.of(s), limits, doubt); };
  out.full_consistent = (!any_rejected() || !has_rejected_subset(monitored_)) && consistent_here(monitored_);
  if (strict_ < 1) return out;

  const bool delivered = panel.delivered == monitored_;
  const bool one_gravity = delivered && holds_one_gravity(tests, panel, hears, record_);
  const SensorSet asked = monitored_units();
  SensorSet innocent;
  for_each_subset(units_.size(), voting_size_, [&](SensorSet u, int index) {
    if (!asked.contains(u) || is_rejected(index)) return;
    const SensorSet s = sensors_of(u);
    if (!corroborating.contains(s) || consistent_here(s)) {
      if (one_gravity && contradicts_one_gravity(tests, panel, u, hears, record_)) return;
      innocent = innocent | s;
      ++out.live;
    } else {
      reject(index);
    }
  });
  out.no_consistent_hypothesis = out.live == 0;
  const SensorSet suspected = monitored_ - innocent;
  if (!out.no_consistent_hypothesis && !suspected.empty() && units_.count(suspected) <= strict_) {
    const SensorSet survivors = monitored_ - suspected;
    const bool tested = tests.of(survivors).tested;
    if (tested && consistent_here(survivors)) out.strict = suspected;
  }
  return out;
}

namespace {

/// One explanation of a block: `faults` are faulty, and `rest` healthy.
struct Hypothesis {
  SensorSet faults, rest;
  int size = 0;           ///< so many units are faulty
  const SetTest& test;    ///< of the rest
  bool explains = false;  ///< the rest is tested, and nothing speaks against it
};

/// The faults that every explanation of at most `most` of them has. One that leaves others than `corroborating`, or too
/// few to be tested, stays.
class CommonFaults {
 public:
  CommonFaults(SensorSet monitored, int most, SensorSet corroborating) noexcept
      : common_(monitored), corroborating_(corroborating), most_(most) {}
  void note(const Hypothesis& h) noexcept {
    if (h.size <= most_ && (h.explains || !h.test.tested || !corroborating_.contains(h.rest))) {
      common_ = common_ & h.faults;
      any_ = true;
    }
  }
  SensorSet found() const noexcept { return any_ ? common_ : SensorSet{}; }

 private:
  SensorSet common_, corroborating_;
  int most_;
  bool any_ = false;
};

/// How far off the estimate `used` may be: the worst of the explanations by the size of their fault sets. Without a
/// test of what a fault set leaves it is one of two vectors. Nothing is said of an estimate that is none.
class Levels {
 public:
  Levels(const BlockTests& tests, const SetTest& used, const ProtectionTerms& protect) noexcept
      : tests_(tests), used_(used), protect_(protect) {}
  void note(const Hypothesis& h) noexcept {
    if (!used_.tested) return;
    const auto size = static_cast<size_t>(h.size);
    if (!h.test.tested) raise(size, mirror_separation_rad(tests_, used_.x_mps2, h.rest, protect_));
    if (!h.explains) return;
    raise(size, separation_rad(tests_, used_.x_mps2, h.rest, h.test, protect_));
    explained_[size] = true;
  }
  /// Over all fault sets of at most `covered` members.
  double worst_rad(int covered) const noexcept {
    double worst = 0.0;
    for (int size = 0; size <= covered && size <= kScanDepth; ++size) {
      if (rad_[static_cast<size_t>(size)] > worst) worst = rad_[static_cast<size_t>(size)];
    }
    return worst;
  }
  bool bounds(int covered) const noexcept {
    bool any = false, bounded = covered <= kScanDepth;
    for (int size = 0; size <= covered && size <= kScanDepth; ++size) {
      any = any || explained_[static_cast<size_t>(size)];
      bounded = bounded && !unbounded_[static_cast<size_t>(size)];
    }
    return any && bounded;
  }

 private:
  void raise(size_t size, double level_rad) noexcept {
    if (level_rad > rad_[size]) rad_[size] = level_rad;
    if (!(level_rad < kPi)) unbounded_[size] = true;
  }

  const BlockTests& tests_;
  const SetTest& used_;
  const ProtectionTerms& protect_;
  std::array<double, kScanDepth + 1> rad_{};
  std::array<bool, kScanDepth + 1> explained_{}, unbounded_{};
};

void note_explanation(const Hypothesis& h, FaultSetScan& out) noexcept {
  const int size = h.size;
  for (int i = 0; i < kCapacity; ++i) {
    if (h.rest.has(i) && size < out.minimum_faults[static_cast<size_t>(i)])
      out.minimum_faults[static_cast<size_t>(i)] = static_cast<std::uint8_t>(size);
  }
  if (size < out.least) {
    out.least = size;
    out.suspects = h.faults;
  } else if (size == out.least) {
    out.suspects = out.suspects | h.faults;
  }
}

}  // namespace

Isolation::Grounds Isolation::grounds(const BlockTests& tests) const noexcept {
  return {recall_doubt(tests, panel_of(tests), record_), any_rejected()};
}

bool Isolation::explains(const TestLimits& limits, const Grounds& grounds, SensorSet rest,
                         const SetTest& test) const noexcept {
  return test.tested && may_be_healthy(rest, test, limits, grounds.doubt) &&
         (!grounds.rejections || !has_rejected_subset(rest));
}

FaultSetScan Isolation::scan(const BlockTests& tests, SensorSet in_service, int depth, int assumed_faults,
                             const ProtectionTerms& protect, SensorSet corroborating) const noexcept {
  const TestLimits& limits = tests.limits();
  FaultSetScan out;
  out.minimum_faults.fill(255);
  const SensorSet monitored = monitored_ & tests.block().usable;
  const SetTest& used = tests.of(in_service & tests.block().usable);
  const Grounds by = grounds(tests);
  Levels levels(tests, used, protect);
  CommonFaults common(monitored_, assumed_faults, corroborating);
  const int most = faults_covered(protect, protect.suspected(confirmed_grade()), confirmed_grade());
  if (depth < most) depth = most;
  // Who is provisionally excluded is out of the estimate as if excluded: the next fault is also one of those that are
  // left.
  const SensorSet left = monitored & in_service;
  for (const bool of_those_left : {false, true}) {
    const SensorSet all = of_those_left ? left : monitored;
    if (of_those_left && left == monitored) break;
    for_each_fault_set(units_.units_of(all), units_.size(), of_those_left ? protect.faults : depth, [&](SensorSet u) {
      const SensorSet f = sensors_of(u), rest = all - f;
      const SetTest& test = tests.of(rest);
      const Hypothesis h = {f, rest, u.size(), test, explains(limits, by, rest, test)};
      levels.note(h);
      if (of_those_left) return;
      common.note(h);
      if (h.explains) note_explanation(h, out);
    });
  }
  // A common cause is one fault, whatever the number of sensors that it moves.
  for_each_common_cause(tests.array(), left, monitored - left, [&](SensorSet alike) {
    const SensorSet rest = left - alike;
    const SetTest& test = tests.of(rest);
    levels.note({alike, rest, 1, test, explains(limits, by, rest, test)});
  });
  const int suspected = protect.suspected(out.least <= kScanDepth ? out.least : 0);
  out.covered = faults_covered(protect, suspected, confirmed_grade());
  out.protection_rad = levels.worst_rad(out.covered);
  out.protection_available = levels.bounds(out.covered);
  out.bears_more = !protect.doubted || out.covered >= suspected + protect.faults;
  const SensorSet asserted = common.found();
  if (!asserted.empty()) {
    const SetTest& rest = tests.of(monitored - asserted);
    if (rest.tested && may_be_healthy(monitored - asserted, rest, limits, by.doubt)) out.asserted = asserted;
  }
  return out;
}

bool Isolation::bounded_without(const BlockTests& tests, SensorSet in_service, const FaultSetScan& scan,
                                const ProtectionTerms& protect, double limit_rad) const noexcept {
  const SensorSet monitored = monitored_ & tests.block().usable;
  const SetTest unsuspected = tests.of((in_service & tests.block().usable) - scan.suspects);
  const int faults = scan.least > scan.covered ? scan.least : scan.covered;
  if (!unsuspected.tested || faults > kScanDepth) return false;
  const Grounds by = grounds(tests);
  return all_fault_sets(units_.units_of(monitored), units_.size(), faults, [&](SensorSet u) {
    const SensorSet rest = monitored - sensors_of(u);
    const SetTest& t = tests.of(rest);
    if (!t.tested) return mirror_separation_rad(tests, unsuspected.x_mps2, rest, protect) <= limit_rad;
    return !explains(tests.limits(), by, rest, t) ||
           separation_rad(tests, unsuspected.x_mps2, rest, t, protect) <= limit_rad;
  });
}

}  // namespace PLUMB_ABI
}  // namespace plumb
