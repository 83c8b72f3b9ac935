#include "plumb/detection/detail/norm_mismatch_doubt.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

/// A set whose every member is checked by the parity of the others at least this well may speak about gravity, and one
/// whose less checked members are no better explanation (`corroborates_norm`).
constexpr double kMinLengthLeverage = 0.002;
/// A set doubts gravity from this part of the limit on where the norm would reject it: what its subsets, which measure
/// the length less well, are off by is noise on top of the same error, and must not be held against them first.
constexpr double kDoubtShare = 0.5;

/// The sets of units that are asked, one after another: large ones first, smaller ones only while none agrees with
/// gravity.
class Questions {
 public:
  explicit Questions(const ReferencePanel& panel) noexcept
      : asked_(panel.asked()),
        all_(panel.units.all()),
        smallest_(panel.smallest_checked()),
        few_(panel.universe() <= kStrictCapacity),
        deep_(asked_.size() - (few_ ? kScanDepth : kScanDepth - 1)) {
    begin(asked_.size() < smallest_ ? 0 : asked_.size());
    find(false);
  }
  bool open() const noexcept { return size_ > 0; }
  SensorSet set() const noexcept { return set_; }
  int rank() const noexcept { return rank_; }  ///< its number among all sets of its size
  void advance(bool agrees) noexcept {
    step();
    find(agrees);
  }

 private:
  void begin(int size) noexcept {
    size_ = size;
    set_ = SensorSet::first(size);
    rank_ = 0;
  }
  void step() noexcept {
    set_ = next_of_same_size(set_);
    ++rank_;
  }
  int next_size() const noexcept {
    if (size_ > smallest_ && size_ > deep_) return size_ - 1;
    return few_ && size_ > smallest_ ? smallest_ : 0;
  }
  /// From here on the first that is monitored; none where all that are asked have been.
  void find(bool agrees) noexcept {
    while (open() && !asked_.contains(set_)) {
      if (all_.contains(set_)) {
        step();
      } else {
        begin(agrees ? 0 : next_size());
      }
    }
  }

  SensorSet asked_, all_, set_;
  int smallest_;
  bool few_;
  int deep_, size_ = 0, rank_ = 0;
};

/// What a set of sensors says of gravity.
struct Testimony {
  bool heard = false;   ///< it agrees with itself, and its members are checked
  bool doubts = false;  ///< gravity
  int claim = -1;       ///< its number on the episode's record, -1 where it is believed without
  LengthError off;      ///< what it claims
};

Testimony testimony_of(const BlockTests& tests, const ReferencePanel& panel, const ParitySums& sums, SensorSet units,
                       int rank) noexcept {
  const TestLimits& limits = tests.limits();
  const SensorSet set = panel.sensors_of(units);
  Testimony out;
  const SetTest& t = tests.of(set);
  if (!t.tested || !t.parity_consistent(limits)) return out;  // one unit to spare: there is parity
  if (!sums.agrees(tests.array(), limits, set)) return out;
  if (t.least_leverage < kMinLengthLeverage && !tests.corroborates_norm(set, t)) return out;
  const double off = t.norm < 0.0 ? -t.norm : t.norm;
  const double limit = t.norm_reject_limit(limits);
  out.heard = true;
  out.doubts = off > kDoubtShare * limit;
  // A claim that leaves one fault alone is believed whatever the set is off by: one fault in a tool that moves
  // steadily is likelier than several that pass for a healthy set. A unit that did not deliver counts among those left.
  if (panel.units.count(panel.monitored) - units.size() < 2) return out;
  out.claim = ReferenceClaims::index_of(units, rank, panel.universe());
  out.off = length_error(tests, t);
  return out;
}

struct Hear {
  VoteRecord& record;
  bool refutes(const Testimony& t) const noexcept {
    record.claims.hear(t.claim, t.off);
    return record.claims.refuted(t.claim);
  }
};

struct Recall {
  const VoteRecord& record;
  bool refutes(const Testimony& t) const noexcept { return record.claims.refuted(t.claim); }
};

/// `claims` is what is done with a claim, Hear or Recall.
template <class Claims>
NormMismatchDoubt doubt_reference(const BlockTests& tests, const ReferencePanel& panel, const Claims& claims) noexcept {
  NormMismatchDoubt doubt;
  bool agrees = false;
  for (Questions asked(panel); asked.open(); asked.advance(agrees)) {
    const Testimony t = testimony_of(tests, panel, claims.record.parity, asked.set(), asked.rank());
    if (!t.heard) continue;
    agrees = agrees || !t.doubts;
    const bool refuted = t.claim >= 0 && claims.refutes(t);
    if (t.doubts && !refuted) doubt.add(panel.sensors_of(asked.set()));
  }
  return doubt;
}

}  // namespace

int ReferencePanel::smallest_checked() const noexcept {
  // Of chips two may do; sensors lie in a plane by twos at least, so that it takes four.
  return units.grouped() || coplanarity > 2 ? coplanarity + 2 : 4;
}

void NormMismatchDoubt::add(SensorSet set) noexcept {
  if (count_ < kMax) set_[static_cast<std::size_t>(count_)] = set;
  if (count_ <= kMax) ++count_;
}

bool NormMismatchDoubt::excuses(SensorSet set) const noexcept {
  if (count_ > kMax) return true;
  for (int k = 0; k < count_; ++k) {
    if (set_[static_cast<std::size_t>(k)].contains(set)) return true;
  }
  return false;
}

void ReferenceClaims::hear(int index, const LengthError& off) noexcept {
  const auto from = static_cast<float>(off.error_mps2 - off.margin_mps2);
  const auto to = static_cast<float>(off.error_mps2 + off.margin_mps2);
  const bool first = !heard_[slot(index)];
  if (first || from > low_[slot(index)]) low_[slot(index)] = from;
  if (first || to < high_[slot(index)]) high_[slot(index)] = to;
  heard_[slot(index)] = true;
}

double constant_length_error_mps2(const BlockTests& tests) noexcept {
  const double scale = tests.array().perfectly_known() ? 0.0 : tests.array().uncertainty().common_scale;
  return TestLimits::gravity * (tests.gravity().sigma_mps2 + scale * tests.gravity().g_mps2);
}

LengthError length_error(const BlockTests& tests, const SetTest& test) noexcept {
  const double unit = test.norm_sigma_mps2 / std::sqrt(test.samples);
  const double margin = test.norm_reject_limit(tests.limits()) * unit - constant_length_error_mps2(tests);
  return {test.norm_error_mps2, margin > 0.0 ? margin : 0.0};
}

NormMismatchDoubt hear_doubt(const BlockTests& tests, const ReferencePanel& panel, VoteRecord& record) noexcept {
  if (panel.delivered == panel.monitored) record.parity.add(tests, panel.monitored);
  return doubt_reference(tests, panel, Hear{record});
}

NormMismatchDoubt recall_doubt(const BlockTests& tests, const ReferencePanel& panel,
                               const VoteRecord& record) noexcept {
  return doubt_reference(tests, panel, Recall{record});
}

}  // namespace PLUMB_ABI
}  // namespace plumb
