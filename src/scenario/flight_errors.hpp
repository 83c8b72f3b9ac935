/// What is wrong with healthy sensors and gyros of a flight (private to src/scenario).
#pragma once

#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/scenario/flight.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// Sensor i uses its own stream: adding one does not change the others.
std::vector<FlightSensorErrors> draw_sensor_errors(const FlightSpec& spec);
std::vector<FlightGyroErrors> draw_gyro_errors(const FlightSpec& spec);

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
