/// The channel gate: what each channel delivered, before any number enters a sum.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/sample.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Counters stop at the top instead of wrapping: a wrapped counter would deny a broken channel.
template <class T>
constexpr void count_up(T& counter) noexcept {
  if (counter != static_cast<T>(~T{0})) ++counter;
}

/// Facts about the channels of one sample.
struct GateResult {
  SensorSet usable;  ///< delivered and finite; the only channels whose raw value may be read
  SensorSet not_finite;
  SensorSet missing;
  SensorSet clipped;  ///< at or beyond 99.5 % of full scale: still evidence, never an exclusion by itself
  bool gap = false;   ///< nothing usable from any channel: a gap of the bus, not n lost sensors
};

/// Confirms losses and returns over several samples. Plain state, copyable.
class ChannelMonitor {
 public:
  /// `full_scale_raw[i]` 0 = unknown; `confirm` samples in a row decide.
  void configure(int n, const std::array<double, kCapacity>& full_scale_raw, int confirm) noexcept;

  GateResult gate(const Sample& sample) noexcept;
  /// Channels that have been unusable for `confirm` samples in a row (a level, until they deliver).
  SensorSet lost() const noexcept { return lost_; }
  int size() const noexcept { return size_; }
  /// Lost channels that have delivered usable values for `confirm` samples in a row again.
  SensorSet back() const noexcept { return back_; }
  /// Counts the channels as lost whatever their last samples were (half of them missing, block after block).
  void mark_lost(SensorSet channels) noexcept;
  /// Forgets that the channels had been lost (the monitor has taken note).
  void reinstate(SensorSet channels) noexcept;

  /// Channels that were at full scale in more than `share` of the samples since `begin_block`.
  SensorSet clipped_beyond(double share) const noexcept;
  /// Channels that have read one and the same number, bit for bit, in at least `samples` samples in a row.
  SensorSet repeating(int samples) const noexcept;
  /// Channels that have not changed their reading since `begin_block`.
  SensorSet unchanged() const noexcept { return SensorSet::first(size_) - changed_; }
  void begin_block() noexcept;

  struct Counters {
    std::uint32_t not_finite = 0, missing = 0, clipped = 0;                ///< samples
    std::uint32_t noisy_blocks = 0, stuck_blocks = 0, clipped_blocks = 0;  ///< blocks in which the fact stood
    static constexpr auto fields() noexcept {
      using C = Counters;
      return field_list(&C::not_finite, &C::missing, &C::clipped, &C::noisy_blocks, &C::stuck_blocks,
                        &C::clipped_blocks);
    }
  };
  /// Counts one block for each fact.
  void count_facts(SensorSet noisy, SensorSet stuck, SensorSet clipped) noexcept;
  const Counters& counters(int i) const noexcept { return counters_[static_cast<std::size_t>(i)]; }

 private:
  void note_trouble(const GateResult& sample) noexcept;

  std::array<double, kCapacity> clip_raw_{};  ///< from here on a reading counts as clipped; infinite = nowhere
  std::array<Counters, kCapacity> counters_{};
  std::array<std::uint16_t, kCapacity> bad_run_{}, good_run_{};
  std::array<double, kCapacity> last_raw_{};
  std::array<std::uint16_t, kCapacity> repeats_{}, clipped_in_block_{};
  SensorSet changed_;
  int block_samples_ = 0;  ///< counted up to kMostBlockSamples
  static constexpr int kMostBlockSamples = 1000000;
  SensorSet lost_, back_;
  int size_ = 0;
  int confirm_ = 3;

  friend struct FieldsOf;
  bool plausible() const noexcept { return lost_.contains(back_); }
  static constexpr auto core() noexcept { return field_list(&ChannelMonitor::lost_, &ChannelMonitor::back_); }
  static constexpr auto changing() noexcept {
    using C = ChannelMonitor;
    return field_list(&C::counters_, &C::bad_run_, &C::good_run_, &C::last_raw_, &C::repeats_, &C::clipped_in_block_,
                      &C::changed_, &C::block_samples_, &C::lost_, &C::back_);
  }
  static constexpr auto fields() noexcept {
    using C = ChannelMonitor;
    return field_list(not_stored(&C::clip_raw_), per_sensor(&C::counters_), per_sensor(&C::bad_run_),
                      per_sensor(&C::good_run_), per_sensor(any(&C::last_raw_)), per_sensor(&C::repeats_),
                      per_sensor(&C::clipped_in_block_), &C::changed_, within(&C::block_samples_, 0, kMostBlockSamples),
                      &C::lost_, &C::back_, not_stored(&C::size_), not_stored(&C::confirm_));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
