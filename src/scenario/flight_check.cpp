#include <cmath>
#include <utility>

#include "plumb/scenario/flight.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

using Checked = tl::expected<void, std::string>;
Checked refuse(std::string why) { return tl::unexpected<std::string>(std::move(why)); }

/// Largest size of anything: beyond it products overflow.
constexpr double kMost = 1e12;

bool sane(double x) noexcept { return std::isfinite(x) && std::abs(x) <= kMost; }
bool sane(const Vec3& v) noexcept { return sane(v[0]) && sane(v[1]) && sane(v[2]); }
bool width(double x, double most) noexcept { return x >= 0.0 && x <= most; }

Checked check_array(const FlightSpec& spec) {
  if (spec.axis.empty() || spec.axis.size() > static_cast<std::size_t>(kCapacity))
    return refuse("1 to " + std::to_string(kCapacity) + " sensors can fly: state that many axes");
  if (spec.lever_arm_m.size() != spec.axis.size()) return refuse("state one lever arm per axis");
  for (const Vec3& axis : spec.axis) {
    if (!sane(axis) || !(std::abs(norm(axis) - 1.0) <= 1e-6)) return refuse("an axis is no unit vector: normalise it");
  }
  for (const Vec3& arm : spec.lever_arm_m) {
    if (!sane(arm) || !(norm(arm) <= 100.0)) return refuse("a lever arm is longer than 100 m: state it in metres");
  }
  return {};
}

Checked check_numbers(const FlightSpec& spec) {
  if (!(spec.rate_hz >= 500.0 && spec.rate_hz <= 1e4)) return refuse("the rate must be 500 to 10000 Hz");
  if (!(spec.bandwidth_hz >= 10.0 && spec.bandwidth_hz <= spec.rate_hz))
    return refuse("the bandwidth must be from 10 Hz to the rate");
  if (!(spec.full_scale_mps2 > 0.0 && spec.full_scale_mps2 <= kMost)) return refuse("the full scale must be positive");
  if (!width(spec.noise_mps2, kMost) || !width(spec.gyro_noise_radps, kMost)) return refuse("noise must be 0 or more");
  if (!width(spec.vibration, 100.0)) return refuse("the factor on vibration must be 0 to 100");
  if (spec.gyros < 0 || spec.gyros > kMostGyros) return refuse("the number of gyros must be 0, 1 or 2");
  const FlightErrorBox& box = spec.box;
  const bool angles = width(box.axis_rad, 0.5) && width(box.gyro_axis_rad, 0.5);
  const bool factors = width(box.scale, 1.0) && width(box.gyro_scale, 1.0) && width(box.bandwidth, 0.5) &&
                       width(box.gyro_bandwidth, 0.5);
  const bool sizes = width(box.bias_mps2, kMost) && width(box.gyro_bias_radps, kMost) && width(box.lever_m, 100.0) &&
                     width(box.rectification, kMost) && width(box.skew_s, kMostSkew_s) &&
                     width(box.gyro_skew_s, kMostSkew_s);
  if (!angles || !factors || !sizes)
    return refuse("half-widths must be 0 or more; of angles and the bandwidth at most 0.5, of scales 1, of the skew " +
                  std::to_string(kMostSkew_s) + " s");
  return {};
}

Checked check_fault(const FlightFault& fault, int sensors) {
  if (fault.sensors.empty() || !SensorSet::first(sensors).contains(fault.sensors))
    return refuse("a fault acts on sensors that do not fly: name some of the array");
  if (!sane(fault.size) || !sane(fault.onset_s)) return refuse("size and onset of a fault must be finite");
  if (static_cast<int>(fault.kind) >= kFlightFaultKinds) return refuse("a fault has an unknown kind");
  if (fault.kind == FlightFaultKind::noise && fault.size < 0.0) return refuse("noise must be 0 or more");
  if (fault.kind == FlightFaultKind::oscillation && !(fault.frequency_hz > 0.0 && fault.frequency_hz <= 1e4))
    return refuse("an oscillation must have a frequency above 0, to 10000 Hz");
  return {};
}

Checked check_fault(const GyroFault& fault, int gyros) {
  if (fault.gyro < 0 || fault.gyro >= gyros) return refuse("a fault acts on a gyro that does not fly");
  if (!sane(fault.size) || !sane(fault.onset_s)) return refuse("size and onset of a fault must be finite");
  if (static_cast<int>(fault.kind) >= kGyroFaultKinds) return refuse("a fault has an unknown kind");
  return {};
}

/// Faults of one sensor add up.
Checked check_skew(const FlightSpec& spec) {
  for (int i = 0; i < static_cast<int>(spec.axis.size()); ++i) {
    double sum_s = 0.0;
    for (const FlightFault& fault : spec.faults) {
      if (fault.kind == FlightFaultKind::skew && fault.sensors.has(i)) sum_s += std::abs(fault.size);
    }
    if (!(sum_s <= kMostSkew_s))
      return refuse("faults may shift a sensor's time by at most " + std::to_string(kMostSkew_s) + " s together");
  }
  return {};
}

}  // namespace

Checked check(const FlightSpec& spec) {
  if (Checked array = check_array(spec); !array) return array;
  if (Checked numbers = check_numbers(spec); !numbers) return numbers;
  constexpr std::size_t kMostFaults = 1000;
  if (spec.faults.size() > kMostFaults || spec.gyro_faults.size() > kMostFaults)
    return refuse("at most 1000 faults can be flown at once");
  for (const FlightFault& fault : spec.faults) {
    if (Checked one = check_fault(fault, static_cast<int>(spec.axis.size())); !one) return one;
  }
  for (const GyroFault& fault : spec.gyro_faults) {
    if (Checked one = check_fault(fault, spec.gyros); !one) return one;
  }
  return check_skew(spec);
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
