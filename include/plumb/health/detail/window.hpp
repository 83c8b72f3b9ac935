/// What is collected of the samples until a block is full: readings, raw values, the sliding window of the triples.
#pragma once

#include "plumb/detection/channel_monitor.hpp"
#include "plumb/detection/combination_mae.hpp"
#include "plumb/detection/detail/near_lengths.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/health/detail/in_force.hpp"
#include "plumb/health/detail/station_store.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What becomes of a row of readings.
enum class RowPlace : std::uint8_t { joins, left_out, begins_block };

struct Window {
  BlockAccumulator block;
  RawBlock raw;  ///< the same samples before the sensor model
  CombinationMae mae;
#if PLUMB_SINGLE
  NearLengths near;  ///< of the block at hand, by the map of the sensors in service
  void forget_near() noexcept { near.forget(); }
  bool near_holds() const noexcept { return near.holds(); }
#else
  void forget_near() noexcept {}
  bool near_holds() const noexcept { return true; }
#endif
  Vec3 latest_mps2{};             ///< of the last row in which every sensor in service delivered; output frame
  SensorSet clipped, not_finite;  ///< channels that did so in the block at hand

  /// A block is made of rows in which the same sensors in service deliver: where one was silent the tool may have
  /// moved, and means over other rows cannot be held against one another. A row that lacks a sensor is omitted; one
  /// that brings a sensor which the block lacks begins it anew.
  RowPlace place_of(SensorSet usable, SensorSet in_service) const noexcept {
    const SensorSet now = usable & in_service, before = block.seen() & in_service;
    return block.size() == 0 || now == before ? RowPlace::joins : place_of_others(now, before);
  }
  SensorSet delivered() const noexcept;  ///< in every row of the block
  void power_on(int triples, int window) noexcept;
  void note_channels(const GateResult& gate) noexcept {
    const bool begins = block.size() == 0;
    clipped = begins ? gate.clipped : clipped | gate.clipped;
    not_finite = begins ? gate.not_finite : not_finite | gate.not_finite;
  }
  void begin_block() noexcept;
  /// The readings of one row, behind which stand `count` raw samples.
  void add(const InForce& in_force, const LeastSquares& map, const Mat3& frame, SensorSet in_service, const Readings& y,
           SensorSet usable, double count) noexcept;

  bool holds() const noexcept { return block.holds() && raw.holds() && mae.holds() && near_holds(); }

 private:
  static RowPlace place_of_others(SensorSet now, SensorSet before) noexcept;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using W = Window;
    return field_list(&W::block, &W::raw, &W::mae,
#if PLUMB_SINGLE
                      not_stored(&W::near),
#endif
                      &W::latest_mps2, &W::clipped, &W::not_finite);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
