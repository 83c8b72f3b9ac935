/// What may fail at once: a chip with all its axes, or a sensor that is on no stated chip (docs/theory.md,
/// section 5.7). Grades and fault sets count these units.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/sensor_set.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// The units of an array, numbered by their first sensor. A set of units is a `SensorSet` of unit numbers. Where no two
/// sensors share a chip, unit i is sensor i, and both kinds of sets are the same.
class SensorUnits {
 public:
  SensorUnits() noexcept = default;

  /// `chip_of(i)`: the number of the chip that sensor i is on; 0 = a unit of its own.
  template <class ChipOf>
  static SensorUnits of_chips(int sensors, ChipOf&& chip_of) noexcept {
    SensorUnits out;
    for (int i = 0; i < sensors && i < kCapacity; ++i) {
      int unit = out.count_;
      for (int j = 0; j < i && chip_of(i) != 0; ++j) {
        if (chip_of(j) == chip_of(i)) unit = out.of(j);
      }
      out.unit_[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(unit);
      if (unit == out.count_) ++out.count_;
      out.sensors_ = static_cast<std::uint8_t>(i + 1);
    }
    return out;
  }

  /// Number of units.
  int size() const noexcept { return count_; }
  SensorSet all() const noexcept { return SensorSet::first(count_); }
  /// Whether some unit has more than one sensor.
  bool grouped() const noexcept { return count_ != sensors_; }
  int of(int sensor) const noexcept { return unit_[static_cast<std::size_t>(sensor)]; }

  /// The sensors of a set of units.
  SensorSet sensors_of(SensorSet units) const noexcept { return grouped() ? spread(units) : units; }
  /// The units with a member among these sensors.
  SensorSet units_of(SensorSet sensors) const noexcept { return grouped() ? gathered(sensors) : sensors; }
  /// How many units have a member among these sensors.
  int count(SensorSet sensors) const noexcept { return units_of(sensors).size(); }
  /// The sensors of all units that have a member among these.
  SensorSet whole(SensorSet sensors) const noexcept { return sensors_of(units_of(sensors)); }
  /// The units all of whose members among `present` are in `sensors`, and that have one there.
  SensorSet units_within(SensorSet sensors, SensorSet present) const noexcept {
    return units_of(sensors & present) - units_of(present - sensors);
  }

 private:
  SensorSet spread(SensorSet units) const noexcept;
  SensorSet gathered(SensorSet sensors) const noexcept;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using U = SensorUnits;
    return field_list(&U::unit_, within(&U::count_, 0, kCapacity), within(&U::sensors_, 0, kCapacity));
  }

  std::array<std::uint8_t, kCapacity> unit_{};
  std::uint8_t count_ = 0;
  std::uint8_t sensors_ = 0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
