/// The calibration file of a group of gyros (JSON, schema "plumb-gyro-calibration" version 1): what motion showed of
/// each axis, checksummed and bound to its array as calibrations of accelerometers are (`calibration_file.hpp`).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/calibration/sensor_model.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline constexpr const char* kGyroCalibrationSchema = "plumb-gyro-calibration";
inline constexpr int kGyroCalibrationVersion = 1;

/// A log that went into it.
struct GyroCalibrationLog {
  std::string use;   ///< "fitted", "held out" or "turns"
  std::string file;  ///< only the last part of the path is kept
  std::uint64_t bytes = 0;
  std::uint64_t hash = 0;  ///< FNV-1a of its bytes
  std::uint64_t rows = 0;
};

struct GyroCalibration {
  /// Reading by the datasheet = row . rate(t - delay) + bias + per_force . specific force.
  struct Axis {
    Vec3 row{};  ///< scale against that of the datasheet times axis, tool frame
    Mat3 row_covariance{};
    double bias_radps = 0.0, bias_sigma_radps = 0.0;
    double delay_s = 0.0, delay_sigma_s = 0.0;  ///< against the mean of all
    Vec3 per_force{}, per_force_sigma{};        ///< (rad/s) / (m/s^2)
    RateErrors bound;                           ///< what a healthy axis stays within once it is corrected
  };
  std::vector<Axis> axis;  ///< in the order of the array
  /// False: gyros alone leave a 3x3 matrix open that all axes share, which the nominal axes pin.
  bool absolute = false;
  bool bias_from_rest = false;
  bool delay_fitted = false, force_fitted = false;
  double sample_radps = 0.0, block_radps = 0.0;  ///< rms that the fit leaves, in samples and means of 32
  double held_out_sample_radps = 0.0, held_out_block_radps = 0.0;
  double turns_rad = 0.0, held_out_turns_rad = 0.0;  ///< rms of gravity as carried; 0: no turns (held out)

  std::vector<GyroCalibrationLog> log;
  std::string date, serial;  ///< empty: not given
  std::string plumb_version;
};

std::string gyro_calibration_json(const GyroCalibration& calibration, const ArrayFile& array);
FileExpected<void> write_gyro_calibration(const std::string& path, const GyroCalibration& calibration,
                                          const ArrayFile& array);

/// Refuses, with remedy: what `read_calibration` refuses of a file, a calibration of accelerometers, figures that no
/// gyro has.
FileExpected<GyroCalibration> read_gyro_calibration(const std::string& path, const ArrayFile& array);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
