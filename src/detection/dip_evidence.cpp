#include "plumb/detection/dip_evidence.hpp"

#include <cmath>

#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {}  // namespace

const char* to_string(DipVerdict verdict) noexcept {
  switch (verdict) {
    case DipVerdict::not_judged: return "not_judged";
    case DipVerdict::consistent: return "consistent";
    case DipVerdict::unseen: return "unseen";
    case DipVerdict::fault: return "fault";
    case DipVerdict::unexplained: return "unexplained";
  }
  return "?";
}

/// What this station allows of sensor i, and the stations before if its bias is constant.
FaultRanges DipEvidence::shifts(const DipJudgement& station, int i) const noexcept {
  const DipHypothesis& h = station.faulty[at(i)];
  if (assumption_ == DipAssumption::any_fault) return h.shift;
  return h.shift.with(bias_[at(i)].widened(h.margin_mps2));
}

void DipEvidence::take_up(const DipJudgement& station) noexcept {
  const bool first = stations_ == 0;
  if (first) {
    used_ = suspects_ = station.used;
    faultless_ = true;
  }
  faultless_ = faultless_ && station.none.consistent();
  for (int i = 0; i < kCapacity; ++i) {
    if (!suspects_.has(i)) continue;
    const DipHypothesis& h = station.faulty[at(i)];
    if (assumption_ == DipAssumption::constant_bias) bias_[at(i)] = first ? h.fault() : h.fault().with(bias_[at(i)]);
    const bool possible = assumption_ == DipAssumption::any_fault || !bias_[at(i)].empty();
    if (!h.consistent() || !possible) suspects_ = suspects_.without(i);
  }
  if (stations_ < kMostStations) ++stations_;
}

/// The direction of x - t column turns steadily with t: of every range, and of all together, the ends are furthest. No
/// fault is among those of every sensor.
void DipEvidence::bound(const DipJudgement& station, DipAnswer& answer) const noexcept {
  double worst = 0.0;
  bool any = false;
  for (int i = 0; i < kCapacity; ++i) {
    if (!suspects_.has(i)) continue;
    const FaultRanges left = shifts(station, i);
    for (int k = 0; k < left.count; ++k) {
      for (const double t : {left.range[at(k)].low_mps2, left.range[at(k)].high_mps2}) {
        const Vec3 end = minus(station.x_mps2, scaled(station.column[at(i)], t));
        worst = std::fmax(worst, angle_between_rad(answer.gravity_mps2, end) + station.faulty[at(i)].turn_rad);
        any = true;
      }
    }
  }
  answer.bound_rad = any ? std::fmin(worst, kPi) : kPi;
}

/// The one that is left: what its fault has moved the vector by is taken off, in the middle of what is possible.
void DipEvidence::name(const DipJudgement& station, DipAnswer& answer) const noexcept {
  answer.named = suspects_.lowest();
  const FaultRanges left = shifts(station, answer.named);
  if (left.empty()) return;
  const double middle = 0.5 * (left.range[0].low_mps2 + left.range[at(left.count - 1)].high_mps2);
  answer.gravity_mps2 = minus(station.x_mps2, scaled(station.column[at(answer.named)], middle));
}

DipAnswer DipEvidence::add(const DipJudgement& station) noexcept {
  DipAnswer out;
  out.refusal = station.refusal;
  if (out.refusal == DipRefusal::none && stations_ > 0 && station.used != used_)
    out.refusal = DipRefusal::sensors_changed;
  if (out.refusal != DipRefusal::none) return out;
  take_up(station);
  out.suspects = suspects_;
  out.gravity_mps2 = station.x_mps2;
  for (int i = 0; i < kCapacity; ++i) {
    if (!suspects_.has(i)) continue;
    const FaultRanges possible = shifts(station, i).widened(station.faulty[at(i)].margin_mps2);
    if (possible.count > 1 || (possible.count == 1 && !possible.has(0.0))) out.mirrors = out.mirrors.with(i);
  }
  if (faultless_) {
    out.verdict = out.mirrors.empty() ? DipVerdict::consistent : DipVerdict::unseen;
  } else {
    out.verdict = suspects_.empty() ? DipVerdict::unexplained : DipVerdict::fault;
    if (suspects_.size() == 1) name(station, out);
  }
  bound(station, out);
  return out;
}

bool DipEvidence::plausible() const noexcept {
  return used_.contains(suspects_) && (stations_ > 0 || (used_.empty() && faultless_));
}

}  // namespace PLUMB_ABI
}  // namespace plumb
