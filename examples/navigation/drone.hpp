// A drone in flight, simulated: three chips of three accelerometers and two gyros. At 8 s the second chip fails. Yours
// go in its place: the array, what its sensors may be off by, and the samples.
#pragma once

#include <cmath>

#include "plumb/array/named.hpp"
#include "plumb/motion/motion_monitor.hpp"
#include "plumb/scenario/flight.hpp"

inline constexpr double kPeriod_s = 0.001, kFailure_s = 8.0;
inline constexpr int kChips = 3, kSensors = 3 * kChips, kFailedChip = 1;  // counted from 0
inline constexpr double kNoise_mps2 = 0.02, kFullScale_mps2 = 16.0 * plumb::kG0_mps2;

constexpr plumb::SensorSet sensors_of(int chip) {
  return plumb::SensorSet::of(3 * chip).with(3 * chip + 1).with(3 * chip + 2);
}

class Drone {
 public:
  explicit Drone(const plumb::scenario::FlightSpec& spec) : flight_(spec) {
    plumb::SensorRow rows[kSensors];
    for (std::size_t i = 0; i < spec.axis.size(); ++i) {
      const char id[] = {'a', static_cast<char>('1' + i), '\0'};
      rows[i] = {plumb::make_id(id), spec.axis[i], kNoise_mps2, static_cast<std::uint8_t>(1 + i / 3)};
      setup_.lever_arm_m[i] = spec.lever_arm_m[i];
      // Of data sheets: 1 mm, 70 us, 2e-5 of the mean square, 0.1 %, 1.5 mrad, 1 mg.
      setup_.errors[i] = {1e-3, 70e-6, 2e-5, 1e-3, 1.5e-3, 1e-3 * plumb::kG0_mps2};
    }
    const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(rows, kSensors);
    if (array) array_ = *array;  // else empty: the monitor refuses it
    setup_.sample_period_s = kPeriod_s;
    setup_.gyros = 2;
    setup_.gyro = {5e-4, 5e-4, plumb::rad_from_deg(0.01), plumb::rad_from_deg(0.1), 20e-6};
    setup_.rate_bound_radps = 8.0;
  }

  const plumb::SensorArray& array() const { return array_; }
  const plumb::MotionSetup& setup() const { return setup_; }
  const plumb::scenario::FlightSample& truth() const { return truth_; }  // of the last sample

  plumb::MotionSample next() {
    truth_ = flight_.next();
    plumb::MotionSample out;
    out.time_s = truth_.time_s;
    out.reading_mps2 = truth_.reading_mps2;
    out.delivered = array_.all();
    for (int i = 0; i < array_.size(); ++i) {
      const double reading_mps2 = truth_.reading_mps2[static_cast<std::size_t>(i)];
      if (std::fabs(reading_mps2) >= 0.999 * kFullScale_mps2) out.clipped = out.clipped.with(i);
    }
    out.rate_radps = truth_.rate_radps;
    out.rate_given = {true, true};
    return out;
  }

  /// Its healthy accelerometers are off by up to 1 mg, 0.1 % and 1 mrad about two directions, its gyros are good ones.
  static plumb::scenario::FlightSpec spec_of(std::uint64_t seed, plumb::scenario::FlightFaultKind kind, double size) {
    plumb::scenario::FlightSpec spec;
    spec.seed = seed;
    for (int i = 0; i < kSensors; ++i) {
      const double around_rad = plumb::rad_from_deg(120.0) * (i / 3);  // 25 mm from the reference point, on a circle
      spec.lever_arm_m.push_back({0.025 * std::cos(around_rad), 0.025 * std::sin(around_rad), 0.0});
      spec.axis.push_back({i % 3 == 0 ? 1.0 : 0.0, i % 3 == 1 ? 1.0 : 0.0, i % 3 == 2 ? 1.0 : 0.0});
    }
    spec.gyros = 2;
    spec.box.gyro_bias_radps = plumb::rad_from_deg(0.003);
    spec.box.gyro_scale = spec.box.gyro_axis_rad = 3e-4;
    spec.faults = {{kind, sensors_of(kFailedChip), size, kFailure_s}};
    return spec;
  }

 private:
  plumb::SensorArray array_;
  plumb::MotionSetup setup_;
  plumb::scenario::Flight flight_;
  plumb::scenario::FlightSample truth_;
};
