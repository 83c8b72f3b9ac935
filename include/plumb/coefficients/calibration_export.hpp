/// A calibration of plumb in the forms of others, with what each cannot hold.
#pragma once

#include <string>
#include <vector>

#include "plumb/coefficients/chip_places.hpp"
#include "plumb/io/calibration_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {

/// What a form cannot hold of a sensor.
struct ExportLoss {
  int sensor = 0;
  std::string what;         ///< "the axis", "the drift of the scale"
  double worst_mps2 = 0.0;  ///< error of a reading at rest, at the worst attitude and temperature of the calibration
};

struct CalibrationExport {
  std::string text;  ///< of the file
  Form form = Form::csv;
  std::vector<PlacedChip> chips;
  std::vector<ExportLoss> losses;
  std::vector<std::string> notes;
  SensorSet left_out;  ///< sensors that are in none of the chips asked for
};

/// `calibration`: as read for this array. Refuses, with remedy: sensors that are on no chip of three where none were
/// asked for by `choices`, several chips in a form for one (imu_tk), axes of a chip that are not x, y and z of a
/// right-handed frame (px4, ardupilot), and values that the form cannot hold.
io::FileExpected<CalibrationExport> export_calibration(const io::ArrayFile& array,
                                                       const io::CalibrationFile& calibration, Form form,
                                                       const std::vector<InstanceChoice>& choices = {});

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
