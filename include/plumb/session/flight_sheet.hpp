/// What of a data sheet flies: the errors that are drawn within its bounds, the force at which it clips, its readings
/// as a log has them. Of numbers alone, so that what reads no array file flies by the same rules.
#pragma once

#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/motion/motion_setup.hpp"
#include "plumb/scenario/flight.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Half-widths, such that no draw is beyond a stated bound. `least`: of each bound the least that a sensor states, so
/// that what is drawn within it is within the bounds of all.
scenario::FlightErrorBox flight_errors_within(const MotionErrors& least, const GyroErrors& gyro,
                                              double bandwidth_hz) noexcept;

/// The smallest of those stated, less the bias; else `usual_mps2`.
double flight_full_scale_mps2(const Datasheet& sheet, double usual_mps2) noexcept;

/// Readings as the log has them, by the coefficients of the sensors that fly, and in codes where one is stated.
Sample flight_sample(const Datasheet& sheet, const SensorModel& model, double temperature_degc,
                     const scenario::FlightSample& flown) noexcept;

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
