/// What recalibration remembers of the run: raw channel means at up to 24 attitudes, entered one station
/// late, so that an alarm can still take back the last one.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/detail/fields.hpp"
#include "plumb/core/detail/station_mean.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Collects the raw values of one block.
class RawBlock {
 public:
  void clear() noexcept { *this = RawBlock{}; }
  void add(const std::array<double, kCapacity>& raw, SensorSet usable, double temperature_degc) noexcept;
  /// Channels that delivered every sample of the block: the others have no mean at its temperature.
  SensorSet complete() const noexcept { return complete_; }
  StationMean mean(SensorSet of, const Vec3& direction, double samples) const noexcept;
  /// Whether all is as `add` left it.
  bool holds() const noexcept { return check_ == check(); }

 private:
  std::uint64_t check() const noexcept;
  void rebuild() noexcept { check_ = check(); }

  std::array<double, kCapacity> sum_{};
  SensorSet complete_;
  int size_ = 0;
  double temperature_sum_ = 0.0;
  std::uint64_t check_ = 0;  ///< sum of the bits of the others

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using B = RawBlock;
    return field_list(per_sensor(any(&B::sum_)), &B::complete_, within(&B::size_, 0, kWindowCapacity),
                      any(&B::temperature_sum_), not_stored(&B::check_));
  }
};

class StationStore {
 public:
  static constexpr int kMax = 24;
  /// Every fourth station is held out of the fit.
  static constexpr int kHeldOutStride = 4;
  /// Blocks of one station are pooled while the tool stands within this angle: the mean over it is shorter than
  /// gravity by less than 0.4 ppm.
  static constexpr double kPoolAngle_rad = rad_from_deg(0.1);

  /// Two stations nearer than this are one attitude: the later one takes the place of the earlier.
  explicit StationStore(double same_attitude_rad = rad_from_deg(2.0)) noexcept : same_rad_(same_attitude_rad) {}

  /// A block of the station at hand.
  void add_block(const StationMean& block) noexcept;
  /// The tool has moved on: the station before the last one is entered, the last one waits.
  void end_station() noexcept;
  /// Takes back what has not been entered: the station at hand and the one before it.
  void drop_last() noexcept;
  void clear() noexcept;

  int size() const noexcept { return size_; }
  const StationMean* data() const noexcept { return station_.data(); }
  const StationMean& station(int k) const noexcept { return station_[static_cast<std::size_t>(k)]; }
  /// Cosine of the angle to the nearest station, those that wait to be entered and the one at hand among them; -1
  /// without any.
  double nearest_cosine(const Vec3& direction) const noexcept;
  /// A replaced station leaves its part to its successor, so that the share of both stays.
  static constexpr bool held_out(int k) noexcept { return k % kHeldOutStride == kHeldOutStride - 1; }
  int held_out_count() const noexcept { return size_ / kHeldOutStride; }
  int fit_count() const noexcept { return size_ - held_out_count(); }
  /// Changes with every entry.
  std::uint32_t entries() const noexcept { return entries_; }

 private:
  void enter(const StationMean& mean) noexcept;
  int crowded_slot(int nearest, double nearest_cosine) const noexcept;

  int size_ = 0;
  std::uint32_t entries_ = 0;
  double same_rad_;
  std::array<StationMean, kMax> station_{};
  StationMean current_, waiting_;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using S = StationStore;
    return field_list(within(&S::size_, 0, kMax), &S::entries_, not_stored(&S::same_rad_),
                      counted(&S::station_, &S::size), &S::current_, &S::waiting_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
