/// What the dip and the length of gravity say over several stations: is a sensor faulty, which one, and how far the
/// direction may be off (docs/theory.md, T16).
///
///   plumb::DipEvidence evidence;                      // or DipEvidence(plumb::DipAssumption::constant_bias)
///   const plumb::DipAnswer answer = evidence.add(plumb::judge_dip(array, station));
///   if (answer.verdict == plumb::DipVerdict::fault && answer.named >= 0) distrust(answer.named);
///   use(answer.gravity_mps2, answer.bound_rad);
#pragma once

#include "plumb/detection/dip_reference.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

enum class DipVerdict : std::uint8_t {
  not_judged,  ///< `DipAnswer::refusal` says why
  consistent,  ///< no fault is needed; those that would not show are connected to none, and in the bound
  unseen,      ///< no fault is needed, yet a mirror fault of a sensor of `mirrors` would not show: it is in the bound
  fault,       ///< no explanation without a fault; `named` is the sensor where one alone is left
  unexplained  ///< not by one faulty sensor either: several are, or an error is beyond what was stated
};
const char* to_string(DipVerdict verdict) noexcept;

/// What a fault may do from station to station. Either way the faulty sensor stays the same.
enum class DipAssumption : std::uint8_t { any_fault, constant_bias };

struct DipAnswer {
  DipVerdict verdict = DipVerdict::not_judged;
  DipRefusal refusal = DipRefusal::none;
  int named = -1;      ///< faulty sensor, -1 where no single one is left
  SensorSet suspects;  ///< sensors one of which may be the faulty one
  SensorSet mirrors;   ///< those with a possible fault that is not connected to no fault
  /// Gravity at the last station: least squares of all that serve; where a sensor is named, of the others and the two
  /// references, in the middle of what they leave.
  Vec3 gravity_mps2{};
  /// Largest angle between that and the truth over all explanations left: pi where nothing is.
  double bound_rad = kPi;
};

/// Trivially copyable; a monitor's snapshot can hold it (`fields`).
class DipEvidence {
 public:
  DipEvidence() noexcept = default;
  explicit DipEvidence(DipAssumption assumption) noexcept : assumption_(assumption) {}

  /// A station more. One that was refused changes nothing and is answered `not_judged`; so is one of other sensors
  /// (`sensors_changed`): `forget` first.
  DipAnswer add(const DipJudgement& station) noexcept;
  /// Begins anew: after an exclusion or a repair, and with `constant_bias` whenever a fault may have begun, for a
  /// sensor that was healthy before would not be one of constant bias.
  void forget() noexcept { *this = DipEvidence(assumption_); }

  int stations() const noexcept { return stations_; }
  SensorSet suspects() const noexcept { return suspects_; }
  /// Biases of sensor i that are consistent with all stations, where it may be constant.
  const FaultRanges& bias(int i) const noexcept { return bias_[static_cast<std::size_t>(i)]; }

 private:
  FaultRanges shifts(const DipJudgement& station, int i) const noexcept;
  void take_up(const DipJudgement& station) noexcept;
  void name(const DipJudgement& station, DipAnswer& answer) const noexcept;
  void bound(const DipJudgement& station, DipAnswer& answer) const noexcept;

  std::array<FaultRanges, kCapacity> bias_{};  ///< of `constant_bias`
  SensorSet used_, suspects_;
  int stations_ = 0;
  DipAssumption assumption_ = DipAssumption::any_fault;
  bool faultless_ = true;  ///< "none is faulty" was consistent at every station

  static constexpr int kMostStations = 1000000;
  friend struct FieldsOf;
  bool plausible() const noexcept;
  static constexpr auto fields() noexcept {
    using E = DipEvidence;
    return field_list(per_sensor(&E::bias_), &E::used_, &E::suspects_, within(&E::stations_, 0, kMostStations),
                      up_to(&E::assumption_, DipAssumption::constant_bias), &E::faultless_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
