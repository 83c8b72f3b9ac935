/// Motion that is simulated sample by sample: a drone, a drill string, a car, a launcher. What the accelerometers and
/// gyros of an array read there, healthy or not, and what was really the case. It is the truth by which a monitor of
/// motion is judged, and shares neither limits nor parameters with one.
///
/// Everything is in the tool frame; lever arms start at one reference point. Motion is computed at eight instants per
/// sample. A pure function of the specification: the same one gives the same bits on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// What carries the array. Each flight draws its own course from the seed and begins with 1 to 2 s of moderate motion.
/// Vibration in g rms is that of the vector, before any filter.
enum class FlightKind : std::uint8_t {
  drone,     ///< 0.3 to 2.5 g, turns to 300 deg/s, 0.5 to 5 g rms in tones of 60 to 250 Hz and broadband, angular
             ///< vibration
  drilling,  ///< 0 to 180 rpm about tool axis z under gravity, lateral vibration of 0.3 to 3 g rms, shocks of 5 to 30 g
  car,       ///< horizontally to 1 g, bumps of 0.5 to 2 g, turns to 40 deg/s, 0.02 to 0.3 g rms
  launch,    ///< 1 to 8 g along z and stages that fall off, roll to 180 deg/s, 0.5 to 5 g rms
};
inline constexpr int kFlightKinds = 4;
const char* to_string(FlightKind kind) noexcept;

/// What one healthy accelerometer does wrong.
struct FlightSensorErrors {
  double scale = 0.0;  ///< relative
  /// Turns of the sensitive axis [rad] about two directions across it (one rotation by their vector sum).
  double axis_x_rad = 0.0, axis_y_rad = 0.0;
  double bias_mps2 = 0.0;
  Vec3 lever_error_m{};        ///< true lever arm less the stated one, tool frame
  double skew_s = 0.0;         ///< the reading is of the instant time_s + skew_s
  double bandwidth = 0.0;      ///< relative error of the bandwidth
  double rectification = 0.0;  ///< [(m/s^2) per (m/s^2)^2] of the mean square of the vibration along the own axis
};

/// What one healthy triad of gyros does wrong, for its axes x, y, z.
struct FlightGyroErrors {
  Vec3 scale{};                     ///< relative
  Vec3 axis_x_rad{}, axis_y_rad{};  ///< turns of each axis, as of an accelerometer [rad]
  Vec3 bias_radps{};
  double skew_s = 0.0;     ///< the rates are of the instant time_s + skew_s
  double bandwidth = 0.0;  ///< relative error of the bandwidth
};

/// Half-widths of the box from which errors are drawn, each on its own.
struct FlightErrorBox {
  double scale = 1e-3;
  double axis_rad = 1e-3;
  double bias_mps2 = 1e-3 * kG0_mps2;
  double lever_m = 1e-3;
  double skew_s = 50e-6;
  double bandwidth = 0.02;
  double rectification = 100e-6 / kG0_mps2;  ///< [(m/s^2) per (m/s^2)^2]: 100 ug per g^2
  double gyro_scale = 0.01;
  double gyro_axis_rad = 0.005;
  double gyro_bias_radps = rad_from_deg(0.2);
  double gyro_skew_s = 15e-6;
  double gyro_bandwidth = 0.005;

  /// No errors at all.
  static constexpr FlightErrorBox none() noexcept {
    return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  }
};

enum class FlightFaultKind : std::uint8_t {
  bias,         ///< reads `size` [m/s^2] too much
  dead,         ///< senses nothing: its bias, its noise and what later faults add are left; no size
  stuck,        ///< stands at the last value before onset; no size
  noise,        ///< white noise of `size` rms [m/s^2] on top
  scale,        ///< reads (1 + `size`) times what it did
  skew,         ///< samples `size` [s] later (below 0: earlier) than before
  drift,        ///< the error grows by `size` [m/s^2 per s]
  oscillation,  ///< a sine of amplitude `size` [m/s^2] and `frequency_hz` on top, 0 at onset
  saturated,    ///< stands at full scale, with the sign of `size`
};
inline constexpr int kFlightFaultKinds = 9;

/// Largest skew, of a healthy sensor or gyro as of the faults of a sensor together, to either side [s].
inline constexpr double kMostSkew_s = 0.05;

/// In effect in the samples with time_s >= onset_s, in all sensors of the set at once (noise is drawn for each on its
/// own). Faults of one sensor act in the order of the list.
struct FlightFault {
  FlightFaultKind kind = FlightFaultKind::bias;
  SensorSet sensors;
  double size = 0.0;  ///< unit by kind
  double onset_s = 0.0;
  double frequency_hz = 10.0;  ///< of an oscillation
};

enum class GyroFaultKind : std::uint8_t {
  dead,   ///< senses nothing: bias and noise are left; no size
  stuck,  ///< stands at the last value before onset; no size
  scale,  ///< reads (1 + `size`) times what it did
  bias,   ///< every axis reads `size` [rad/s] too much
};
inline constexpr int kGyroFaultKinds = 4;

/// A fault of a whole triad.
struct GyroFault {
  GyroFaultKind kind = GyroFaultKind::dead;
  int gyro = 0;       ///< 0 or 1
  double size = 0.0;  ///< unit by kind
  double onset_s = 0.0;
};

inline constexpr int kMostGyros = 2;

struct FlightSpec {
  FlightKind kind = FlightKind::drone;
  double rate_hz = 1000.0;  ///< samples, 500 to 10000
  std::uint64_t seed = 0;
  std::vector<Vec3> axis;         ///< stated unit axes, tool frame; 1 to kCapacity sensors
  std::vector<Vec3> lever_arm_m;  ///< stated, of each sensor from the reference point, tool frame
  double noise_mps2 = 0.02;       ///< white, 1 sigma of one sample
  /// Of the second-order Butterworth filter in every accelerometer and gyro (3 dB) [Hz]; from 10 Hz to rate_hz.
  double bandwidth_hz = 260.0;
  double full_scale_mps2 = 16.0 * kG0_mps2;
  FlightErrorBox box{};
  bool vertices = false;  ///< every error is + or - its half-width; else uniform between
  /// What vibration is rectified: that before the sensor's filter, or only what passes it.
  bool rectifies_before_filter = true;
  double vibration = 1.0;  ///< factor on vibration, angular vibration, shocks and bumps; 0 leaves the smooth motion
  int gyros = 1;           ///< triads, 0 to 2; their axes are those of the tool frame
  double gyro_noise_radps = rad_from_deg(0.1);  ///< white, 1 sigma of one sample
  std::vector<FlightFault> faults;
  std::vector<GyroFault> gyro_faults;
};

/// Refuses, with a remedy, what cannot be flown: sizes, rates, widths, sensors and sizes of faults.
tl::expected<void, std::string> check(const FlightSpec& spec);

struct FlightSample {
  double time_s = 0.0;                           ///< number of the sample over the rate; the first is at 0
  std::array<double, kCapacity> reading_mps2{};  ///< by sensor, lever terms included; 0 beyond the array
  std::array<Vec3, kMostGyros> rate_radps{};     ///< by triad; 0 where there is none
  /// The truth at time_s, tool frame, behind the nominal filter as an errorless sensor would have it: specific force at
  /// the reference point (at rest +g0 upward), angular rate, and its derivative.
  Vec3 specific_force_mps2{};
  Vec3 true_rate_radps{};
  Vec3 true_angular_acceleration_radps2{};
};

/// One flight without end, sample by sample.
class Flight {
 public:
  /// Refuses, with the words of `check`, what cannot be flown.
  static tl::expected<Flight, std::string> make(const FlightSpec& spec);
  /// The same, and throws these words as std::invalid_argument.
  explicit Flight(const FlightSpec& spec);
  Flight(Flight&&) noexcept;
  Flight& operator=(Flight&&) noexcept;
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;
  ~Flight();

  FlightSample next();

  /// What was drawn: by sensor, and by triad.
  const std::vector<FlightSensorErrors>& errors() const noexcept;
  const std::vector<FlightGyroErrors>& gyro_errors() const noexcept;

 private:
  class Parts;
  explicit Flight(std::unique_ptr<Parts> parts) noexcept;
  std::unique_ptr<Parts> parts_;
};

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
