/// What single channels did, as far as the others insist on it: noisy, stuck, at full scale; and why a sensor is out of
/// service or doubted.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/detection/channel_monitor.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/gravity/gravity.hpp"
#include "plumb/health/state.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class ChannelFacts {
 public:
  /// What the channels are judged by.
  struct Terms {
    const SensorArray& array;
    const GravityReference& gravity;
    const std::array<float, kCapacity>& resolution_mps2;
    int window = 0;  ///< samples of a block
    SensorSet in_service;
  };

  void clear() noexcept { *this = ChannelFacts{}; }
  /// Before a change of the sensors in service is judged: their noise over many blocks is another question now.
  void forget_scatter() noexcept { scatter_.clear(); }
  ScatterRecord& scatter() noexcept { return scatter_; }

  /// One block, which the gate ends. False where it is no evidence: the tool moved, or a channel was at full scale and
  /// the others do not deny it.
  bool note(const Terms& terms, const BlockJudgement& judged, ChannelMonitor& gate, bool moving) noexcept;
  /// Writes down why `named` are out of service, and what is held against each sensor in service.
  void name_causes(SensorSet named, Cause cause, SensorSet in_service) noexcept;

  SensorSet noisy() const noexcept { return noisy_; }
  SensorSet stuck() const noexcept { return stuck_; }
  SensorSet full_scale() const noexcept { return full_scale_; }
  SensorSet doubted() const noexcept { return noisy_ | stuck_ | full_scale_; }
  /// Noisy for certain, whichever others may be faulty, in the last block: and in so many on end that it may be
  /// provisionally excluded for that.
  SensorSet noisy_for_certain() const noexcept { return noisy_for(1); }
  SensorSet noisy_long_enough() const noexcept { return noisy_for(kConfirm); }
  /// A noisy channel is provisionally excluded after so many blocks at rest in a row, or after so many stations at each
  /// of which it alone scattered in one block at least.
  static constexpr int kConfirm = 3;
  const std::array<Cause, kCapacity>& causes() const noexcept { return cause_; }

 private:
  SensorSet noisy_for(int blocks) const noexcept;
  void note_stuck(const Terms& terms, const BlockEvidence& evidence, SensorSet repeating) noexcept;

  std::array<Cause, kCapacity> cause_{};
  std::array<std::uint8_t, kCapacity> noisy_run_{};  ///< blocks at rest in a row for certain
  std::array<double, kCapacity> stuck_since_{};      ///< what the others predicted when the reading stopped changing
  SensorSet noisy_, stuck_, full_scale_;             ///< the others insist on it
  SensorSet stuck_watch_;                            ///< readings that repeat, of which the others are asked
  ScatterRecord scatter_;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using F = ChannelFacts;
    return field_list(within(&F::cause_, 0, static_cast<int>(kLastCause)), per_sensor(&F::noisy_run_),
                      per_sensor(any(&F::stuck_since_)), &F::noisy_, &F::stuck_, &F::full_scale_, &F::stuck_watch_,
                      &F::scatter_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
