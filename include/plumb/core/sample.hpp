/// What the host hands to plumb: one reading of every channel (`Sample`), and what plumb makes of a
/// stretch at rest at one attitude (`Station`).
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/sensor_set.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// One reading of all channels at one instant. Plain data; any bit pattern is acceptable input.
struct Sample {
  double time_s = 0.0;                  ///< strictly increasing from sample to sample
  std::array<double, kCapacity> raw{};  ///< channel values in the unit of the sensor model (V, counts, ...)
  SensorSet delivered;                  ///< channels that delivered a value at all
  double temperature_degc = 0.0;        ///< sensor temperature T_S
  std::uint32_t station = 0;            ///< station tag, 0 = none: plumb finds stations by itself
  std::uint32_t count = 1;              ///< raw samples behind this one (a station mean has many)
  std::uint32_t roll_group = 0;         ///< tag of `Station::roll_group`, 0 = none
};

/// Mean of the raw channels over one station: a row of the calibration problem.
struct Station {
  std::array<double, kCapacity> mean{};     ///< raw unit
  std::array<double, kCapacity> scatter{};  ///< standard deviation of the samples, raw unit; 0 = unknown
  SensorSet delivered;                      ///< channels with a mean
  double temperature_degc = 0.0;
  std::uint32_t count = 0;  ///< samples behind the mean
  std::uint32_t tag = 0;
  double begin_s = 0.0;
  double end_s = 0.0;
  /// Stations of one group differ by a roll of the tool about its own axis alone: they share an inclination. 0 = none.
  std::uint32_t roll_group = 0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb
