#include "plumb/detection/isolation.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

using std::size_t;

/// A set whose every member is checked by the parity of the others at least this well may speak about gravity, and one
/// whose less checked members are no better explanation (`vouches_for_norm`).
constexpr double kMinLeverage = 0.002;
/// A set doubts gravity from this part of the limit on at which the norm would kill it: what its subsets, which measure
/// the length less well, are off by is noise on top of the same error, and must not be held against them first.
constexpr double kDoubtShare = 0.5;

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

/// Calls f(F) for every subset of `posed` with at most `depth` members (depth <= 3), smallest first.
template <class F>
void for_each_fault_set(SensorSet posed, int n, int depth, F&& f) noexcept {
  f(SensorSet{});
  if (depth < 1) return;
  for (int i = 0; i < n; ++i) {
    if (posed.has(i)) f(SensorSet::of(i));
  }
  if (depth < 2) return;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (posed.has(i) && posed.has(j)) f(SensorSet::of(i).with(j));
    }
  }
  if (depth < 3) return;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        if (posed.has(i) && posed.has(j) && posed.has(k)) f(SensorSet::of(i).with(j).with(k));
      }
    }
  }
}

}  // namespace

void Isolation::clear() noexcept {
  dead_.fill(0);
  claims_.clear();
}

void Isolation::pose(const SensorArray& array, SensorSet posed) noexcept {
  const int c = plumb::coplanarity(array, posed);
  if (c + 1 != voting_size_ || !posed_.contains(posed) || universe_ != array.size()) clear();
  resume(array, posed, c);
}

void Isolation::resume(const SensorArray& array, SensorSet posed) noexcept {
  resume(array, posed, plumb::coplanarity(array, posed));
}

void Isolation::resume(const SensorArray& array, SensorSet posed, int c) noexcept {
  posed_ = posed;
  universe_ = static_cast<std::int8_t>(array.size());
  coplanarity_ = static_cast<std::int8_t>(c);
  voting_size_ = static_cast<std::int8_t>(c + 1);
  const int sensors = (posed & array.all()).size();
  const bool strict_possible = universe_ <= kStrictCapacity;
  strict_ = static_cast<std::int8_t>(strict_possible ? plumb::strict_grade(sensors, c) : 0);
  parity_ = static_cast<std::int8_t>(plumb::parity_grade(sensors, c));
  if (!strict_possible && parity_ > kScanDepth) parity_ = kScanDepth;
  voting_ = 0;
  if (strict_ < 1) return;
  for_each_subset(universe_, voting_size_, [&](SensorSet s, int) {
    if (posed_.contains(s)) ++voting_;
  });
}

int Isolation::live() const noexcept {
  int count = 0;
  if (strict_ < 1) return count;
  for_each_subset(universe_, voting_size_, [&](SensorSet s, int index) {
    if (posed_.contains(s) && !is_dead(index)) ++count;
  });
  return count;
}

bool Isolation::any_dead() const noexcept {
  std::uint64_t any = 0;
  for (const std::uint64_t word : dead_) any |= word;
  return any != 0;
}

bool Isolation::has_dead_subset(SensorSet set) const noexcept {
  if (strict_ < 1) return false;
  const SensorSet all = SensorSet::first(universe_);
  int index = 0;
  for (SensorSet s = SensorSet::first(voting_size_); all.contains(s); s = next_of_same_size(s), ++index) {
    if (is_dead(index) && set.contains(s)) return true;
  }
  return false;
}

ReferenceDoubt Isolation::doubt_reference(const BlockTests& tests, ReferenceClaims* record) const noexcept {
  const GravityReference& gravity = tests.gravity();
  const TestLimits& limits = tests.limits();
  const BlockEvidence& block = tests.block();
  ReferenceDoubt doubt;
  const SensorSet posed = posed_ & block.usable;
  bool agrees = false;
  const auto ask = [&](SensorSet set, int rank) {
    const SetTest& t = tests.of(set);
    if (!t.tested || !t.parity_alive(limits)) return;  // four or more: there is parity
    if (t.least_leverage < kMinLeverage && !tests.vouches_for_norm(set, t)) return;
    const double off = t.norm < 0.0 ? -t.norm : t.norm;
    const double limit = t.norm_reject_limit(limits);
    const bool doubts = off > kDoubtShare * limit;
    agrees = agrees || !doubts;
    // A claim that leaves one fault alone is believed whatever the set is off by: one fault in a tool that moves
    // steadily is likelier than several that pass for a healthy set.
    const int claim = posed_.size() - set.size() >= 2 ? ReferenceClaims::index_of(set, rank, universe_) : -1;
    if (claim >= 0) {
      const double unit = t.norm_sigma_mps2 / std::sqrt(block.samples);
      const double margin = limit * unit - TestLimits::gravity * gravity.sigma_mps2;
      if (record != nullptr) record->hear(claim, t.norm_error_mps2, margin);
      if ((record != nullptr ? *record : claims_).refuted(claim)) return;
    }
    if (doubts) doubt.add(set);
  };
  const auto ask_size = [&](int size) {
    for_each_subset(universe_, size, [&](SensorSet s, int rank) {
      if (posed.contains(s)) ask(s, rank);
    });
  };
  const int smallest = coplanarity_ + 2 > 4 ? coplanarity_ + 2 : 4;
  const bool few = universe_ <= kStrictCapacity;
  const int deep = posed.size() - (few ? kScanDepth : kScanDepth - 1);
  for (int size = posed.size(); size >= smallest && size >= deep && !agrees; --size) ask_size(size);
  if (few && deep > smallest && !agrees) ask_size(smallest);
  return doubt;
}

SensorSet Isolation::convict_by_parity(const BlockTests& tests, SensorSet witnesses) const noexcept {
  const TestLimits& limits = tests.limits();
  // Where a posed sensor did not deliver, the published grade does not hold for the rest: nobody is convicted.
  const SensorSet asked = posed_;
  const int grade = parity_grade();
  if (grade < 1 || !tests.block().usable.contains(asked)) return {};
  SensorSet cleared;
  const auto hear = [&](SensorSet s) {
    if (cleared.contains(s)) return;
    if (!witnesses.contains(s) || tests.of(s).parity_alive(limits)) cleared = cleared | s;
  };
  if (universe_ <= kStrictCapacity) {
    const int size = asked.size() - grade;
    for_each_subset(universe_, size, [&](SensorSet s, int) {
      if (asked.contains(s)) hear(s);
    });
  }
  for_each_fault_set(asked, universe_, grade < kScanDepth ? grade : kScanDepth, [&](SensorSet f) { hear(asked - f); });
  const SensorSet convicted = asked - cleared;
  if (convicted.empty() || convicted.size() > grade) return {};
  const SetTest& rest = tests.of(asked - convicted);
  const bool agree = rest.tested && rest.parity_alive(limits);
  return agree ? convicted : SensorSet{};
}

IsolationAnswer Isolation::vote(const BlockTests& tests, SensorSet witnesses) noexcept {
  const TestLimits& limits = tests.limits();
  IsolationAnswer out;
  out.voting = voting_;
  const ReferenceDoubt doubt = doubt_reference(tests, witnesses.contains(posed_) ? &claims_ : nullptr);
  out.norm_void = doubt.any();
  out.parity = convict_by_parity(tests, witnesses);
  const auto alive_here = [&](SensorSet s) {
    const SetTest& t = tests.of(s);
    return t.parity_alive(limits) && (t.alive(limits) || doubt.excuses(s));
  };
  out.full_alive = (!any_dead() || !has_dead_subset(posed_)) && alive_here(posed_);
  if (strict_ < 1) return out;

  SensorSet innocent;
  for_each_subset(universe_, voting_size_, [&](SensorSet s, int index) {
    if (!posed_.contains(s) || is_dead(index)) return;
    if (!witnesses.contains(s) || alive_here(s)) {
      innocent = innocent | s;
      ++out.live;
    } else {
      kill(index);
    }
  });
  out.contradiction = out.live == 0;
  const SensorSet accused = posed_ - innocent;
  if (!out.contradiction && !accused.empty() && accused.size() <= strict_) {
    const SensorSet survivors = posed_ - accused;
    const bool tested = tests.of(survivors).tested;
    if (tested && alive_here(survivors)) out.strict = accused;
  }
  return out;
}

namespace {

/// The protection level under construction: the worst of the explanations by the size of their fault sets.
struct Levels {
  std::array<double, kScanDepth + 1> rad{};
  std::array<bool, kScanDepth + 1> explained{}, unbounded{};

  void note(int size, double level_rad) noexcept {
    double& worst = rad[static_cast<size_t>(size)];
    if (level_rad > worst) worst = level_rad;
    if (!(level_rad < kPi)) unbounded[static_cast<size_t>(size)] = true;
  }
  /// Over all fault sets of at most `covered` members.
  void close(int covered, FaultSetScan& out) const noexcept {
    out.covered = covered;
    bool any = false, bounded = covered <= kScanDepth;
    for (int size = 0; size <= covered && size <= kScanDepth; ++size) {
      const auto a = static_cast<size_t>(size);
      any = any || explained[a];
      bounded = bounded && !unbounded[a];
      if (rad[a] > out.protection_rad) out.protection_rad = rad[a];
    }
    out.protection_available = any && bounded;
  }
};

/// The faults `f` explain the block, with `rest` healthy.
void note_explanation(SensorSet f, SensorSet rest, FaultSetScan& out) noexcept {
  const int size = f.size();
  for (int i = 0; i < kCapacity; ++i) {
    if (rest.has(i) && size < out.fewest_faults[static_cast<size_t>(i)])
      out.fewest_faults[static_cast<size_t>(i)] = static_cast<std::uint8_t>(size);
  }
  if (size < out.least) {
    out.least = size;
    out.suspects = f;
  } else if (size == out.least) {
    out.suspects = out.suspects | f;
  }
}

}  // namespace

FaultSetScan Isolation::scan(const BlockTests& tests, SensorSet in_service, int depth, int asserted_faults,
                             const ProtectionTerms& protect, SensorSet witnesses) const noexcept {
  const TestLimits& limits = tests.limits();
  FaultSetScan out;
  out.fewest_faults.fill(255);
  const SensorSet posed = posed_ & tests.block().usable;
  const SetTest& used = tests.of(in_service & tests.block().usable);
  const ReferenceDoubt doubt = doubt_reference(tests, nullptr);
  const bool deaths = any_dead();
  bool any_asserted = false;
  Levels levels;
  SensorSet common = posed;
  const auto explains = [&](SensorSet rest, const SetTest& t) {
    const bool here = t.parity_alive(limits) && (t.alive(limits) || doubt.excuses(rest));
    return here && (!deaths || !has_dead_subset(rest));
  };
  // What the fault sets of a size leave open of the estimate in use; without a test of what is left, one of two
  // vectors.
  const auto cover = [&](int size, SensorSet rest, const SetTest& t, bool explained) {
    if (!used.tested) return;
    if (!t.tested) levels.note(size, mirror_separation_rad(tests, used.x_mps2, rest, protect));
    if (explained) levels.note(size, separation_rad(tests, used.x_mps2, rest, t, protect));
    if (explained) levels.explained[static_cast<size_t>(size)] = true;
  };
  const int most = faults_covered(protect, protect.suspected(strict_grade()), strict_grade());
  if (depth < most) depth = most;
  for_each_fault_set(posed, universe_, depth > kScanDepth ? kScanDepth : depth, [&](SensorSet f) {
    const int size = f.size();
    const SensorSet rest = posed - f;
    const SetTest& t = tests.of(rest);
    const bool explained = t.tested && explains(rest, t);
    if (size <= asserted_faults && (explained || !t.tested || !witnesses.contains(rest))) {
      common = common & f;
      any_asserted = true;
    }
    cover(size, rest, t, explained);
    if (explained) note_explanation(f, rest, out);
  });
  // Who is set aside is out of the estimate as if latched out: the next fault is one of those that are left.
  const SensorSet left = posed & in_service;
  for_each_fault_set(left != posed ? left : SensorSet{}, universe_, protect.faults, [&](SensorSet f) {
    const SensorSet rest = left - f;
    const SetTest t = tests.of(rest);
    cover(f.size(), rest, t, t.tested && explains(rest, t));
  });
  const int suspected = protect.suspected(out.least <= kScanDepth ? out.least : 0);
  levels.close(faults_covered(protect, suspected, strict_grade()), out);
  out.bears_more = !protect.doubted || out.covered >= suspected + protect.faults;
  if (any_asserted && !common.empty()) {
    const SetTest& rest = tests.of(posed - common);
    const bool alive = rest.parity_alive(limits) && (rest.alive(limits) || doubt.excuses(posed - common));
    if (rest.tested && alive) out.asserted = common;
  }
  return out;
}

bool Isolation::bounded_without(const BlockTests& tests, SensorSet in_service, const FaultSetScan& scan,
                                const ProtectionTerms& protect, double limit_rad) const noexcept {
  const TestLimits& limits = tests.limits();
  const SensorSet posed = posed_ & tests.block().usable;
  const SetTest unsuspected = tests.of((in_service & tests.block().usable) - scan.suspects);
  const int faults = scan.least > scan.covered ? scan.least : scan.covered;
  if (!unsuspected.tested || faults > kScanDepth) return false;
  const ReferenceDoubt doubt = doubt_reference(tests, nullptr);
  bool bounded = true;
  for_each_fault_set(posed, universe_, faults, [&](SensorSet f) {
    if (!bounded) return;
    const SensorSet rest = posed - f;
    const SetTest& t = tests.of(rest);
    if (!t.tested) {
      bounded = mirror_separation_rad(tests, unsuspected.x_mps2, rest, protect) <= limit_rad;
    } else if (t.parity_alive(limits) && (t.alive(limits) || doubt.excuses(rest)) && !has_dead_subset(rest)) {
      bounded = separation_rad(tests, unsuspected.x_mps2, rest, t, protect) <= limit_rad;
    }
  });
  return bounded;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
