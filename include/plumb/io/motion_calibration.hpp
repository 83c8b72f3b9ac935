/// What a log in motion showed of an array, as a calibration file keeps it beside what was found at rest. Contract:
/// docs/array-file.md, "The calibration file".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/core/vec3.hpp"
#include "plumb/motion/motion_setup.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Of the section `motion`, which a file need not have.
inline constexpr int kMotionSectionVersion = 1;

struct MotionCalibration {
  /// Bounds are what healthy sensors stay within, for the limits; the figures before them what was found, with 1 sigma.
  struct Sensor {
    Vec3 stated_lever_arm_m{};  ///< by the array file then; what was found counts for no other
    Vec3 lever_arm_m{};
    Vec3 lever_arm_sigma_m{};
    double lever_arm_bound_m = 0.0;
    double lag_s = 0.0;  ///< against the mean of all
    double lag_sigma_s = 0.0;
    double lag_bound_s = 0.0;
    double rectification_per_mps2 = 0.0;
    double rectification_sigma_per_mps2 = 0.0;
    double rectification_bound_per_mps2 = 0.0;
  };
  std::vector<Sensor> sensor;      ///< in the order of the array
  bool lever_arms_stated = false;  ///< the array file had some
  int gyros = 0;
  GyroErrors gyro;  ///< bounds of each, and its noise

  // Where it comes from.
  std::string log_file;  ///< only the last part of the path is kept
  std::uint64_t log_bytes = 0;
  std::uint64_t log_hash = 0;  ///< FNV-1a of the bytes of the log
  std::uint64_t rows = 0;
  std::string date;  ///< of the log; empty: not given
  std::string plumb_version;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
