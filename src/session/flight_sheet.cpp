#include "plumb/session/flight_sheet.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

using scenario::FlightErrorBox;

/// Delay of the simulator's second-order Butterworth filter far below its bandwidth f: sqrt(2) / (2 pi f).
constexpr double kFilterDelay = 0.2250790790392765;
/// Of a bound of lag so much is skew, the rest another bandwidth.
constexpr double kSkewShare = 0.7;

double skew_of(double lag_s) noexcept { return std::fmin(kSkewShare * lag_s, scenario::kMostSkew_s); }
double bandwidth_of(double lag_s, double bandwidth_hz) noexcept {
  return std::fmin((1.0 - kSkewShare) * lag_s * bandwidth_hz / kFilterDelay, 0.5);
}

}  // namespace

/// An axis turns about two directions, a gyro has three axes, and vibration is rectified before the filter, which lets
/// as little as half of it pass.
FlightErrorBox flight_errors_within(const MotionErrors& least, const GyroErrors& gyro, double bandwidth_hz) noexcept {
  FlightErrorBox box = FlightErrorBox::none();
  box.scale = least.scale;
  box.axis_rad = least.axis_rad / std::sqrt(2.0);
  box.bias_mps2 = least.bias_mps2;
  box.lever_m = least.lever_m;
  box.skew_s = skew_of(least.lag_s);
  box.bandwidth = bandwidth_of(least.lag_s, bandwidth_hz);
  box.rectification = 0.5 * least.rectification;
  box.gyro_scale = gyro.scale;
  box.gyro_axis_rad = 0.5 * gyro.axis_rad;
  box.gyro_bias_radps = gyro.bias_radps / std::sqrt(3.0);
  box.gyro_skew_s = skew_of(gyro.lag_s);
  box.gyro_bandwidth = bandwidth_of(gyro.lag_s, bandwidth_hz);
  return box;
}

double flight_full_scale_mps2(const Datasheet& sheet, double usual_mps2) noexcept {
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < static_cast<std::size_t>(sheet.size); ++k) {
    const DatasheetSensor& sensor = sheet.sensor[k];
    if (!(sensor.full_scale_raw > 0.0)) continue;
    const SensorCoefficients& c = sensor.coefficients;
    least = std::fmin(least, sensor.full_scale_raw / std::fabs(c.scale[0]) - std::fabs(c.bias[0]));
  }
  return std::isfinite(least) ? least : usual_mps2;
}

Sample flight_sample(const Datasheet& sheet, const SensorModel& model, double temperature_degc,
                     const scenario::FlightSample& flown) noexcept {
  Sample out;
  out.time_s = flown.time_s;
  out.delivered = SensorSet::first(sheet.size);
  out.temperature_degc = temperature_degc;
  for (std::size_t i = 0; i < static_cast<std::size_t>(sheet.size); ++i) {
    const int sensor = static_cast<int>(i);
    const double sense = model.reads == Reads::gravity ? -1.0 : 1.0;
    const double bias_mps2 = model.bias_at(sensor, temperature_degc);
    out.raw[i] = model.scale_at(sensor, temperature_degc) * (sense * flown.reading_mps2[i] + bias_mps2);
    const double code = sheet.sensor[i].resolution_raw;
    if (code > 0.0) out.raw[i] = code * std::nearbyint(out.raw[i] / code);
  }
  return out;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
