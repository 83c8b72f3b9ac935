#include "plumb/scenario/delivery.hpp"

#include <algorithm>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

Delivery::Delivery(std::vector<Fault> faults, std::uint64_t seed)
    : faults_(std::move(faults)), effective_(faults_.size(), false), seed_(seed) {
  for (const Fault& fault : faults_) any_ = any_ || is_delivery(fault.kind, fault.sensor);
}

void Delivery::push(const Sample& sample, const Moment& now, const Beside& beside) {
  Parcel parcel{sample, now.row, beside};
  std::uint64_t wait = 0;
  int copies = 1;
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    const Fault& fault = faults_[k];
    if (!is_delivery(fault.kind, fault.sensor) || !in_effect(fault, now)) continue;
    effective_[k] = true;
    switch (fault.kind) {
      case FaultKind::drop: {
        const Stream stream(seed_, Purpose::link, static_cast<std::uint32_t>(k));
        if (stream.uniform(now.row) < fault.magnitude) copies = 0;
        break;
      }
      case FaultKind::repeat: copies *= 2; break;
      case FaultKind::back: parcel.sample.time_s -= fault.magnitude; break;
      case FaultKind::late: wait += static_cast<std::uint64_t>(fault.magnitude); break;
      case FaultKind::swap:
        if (first_of_pair_) ++wait;
        first_of_pair_ = !first_of_pair_;
        break;
      default: break;
    }
  }
  if (wait == 0) ready_.insert(ready_.end(), static_cast<std::size_t>(copies), parcel);
  for (Held& held : held_) --held.wait;
  for (const Held& held : held_) {
    if (held.wait == 0) ready_.push_back(held.parcel);
  }
  held_.erase(std::remove_if(held_.begin(), held_.end(), [](const Held& held) { return held.wait == 0; }), held_.end());
  if (wait > 0) held_.insert(held_.end(), static_cast<std::size_t>(copies), Held{parcel, wait});
}

void Delivery::finish() {
  for (const Held& held : held_) ready_.push_back(held.parcel);
  held_.clear();
}

bool Delivery::pop(Parcel& parcel) {
  if (taken_ < ready_.size()) {
    parcel = ready_[taken_++];
    return true;
  }
  ready_.clear();
  taken_ = 0;
  return false;
}

std::vector<int> Delivery::without_effect() const {
  std::vector<int> waiting;
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    if (is_delivery(faults_[k].kind, faults_[k].sensor) && !effective_[k]) waiting.push_back(static_cast<int>(k));
  }
  return waiting;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
