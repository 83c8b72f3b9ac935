/// A calibration of known coefficients: nothing is fitted, and nothing has tested them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/coefficients/chip_places.hpp"
#include "plumb/io/calibration_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {

struct AdoptionChoice {
  std::vector<InstanceChoice> instances;
  Uncertainty usual;                    ///< of sensors of which the files state none
  std::optional<TemperatureSpan> span;  ///< of all; empty: what the files state, else the reference temperature
};

struct Adoption {
  Calibration calibration;               ///< with the report of a fit that was not made: no station, rank 0
  std::vector<SensorStatement> sensors;  ///< in the order of the array, uncertainties complete
  std::vector<PlacedChip> chips;         ///< which chip was taken for which sensors
  std::vector<std::string> chip_names;   ///< of these, in the file: "CAL_ACC0"
  std::vector<std::string> notes;        ///< what is not taken over, and what holds only as far as stated
  TemperatureSpan span;
  /// Autopilots calibrate against g0 wherever they are: 1 sigma of the scale that all sensors share for it, else 0.
  double common_scale = 0.0;
  std::string forms;                  ///< "px4", "px4, csv"
  std::string file_name;              ///< without folders; of several: all of them
  std::uint64_t bytes = 0, hash = 0;  ///< of the files: all bytes, and of several the hash of their hashes
};

/// The files together. Refuses, with remedy: sensors without coefficients or with two,
/// a missing uncertainty, values that no such sensor has (by the limits of `FitOptions`: scale 25 %, axis 15 deg, bias
/// 8 sigma of its prior), axes in one plane, forms that cannot stand beside each other. Parallel axes are no reason to
/// refuse.
io::FileExpected<Adoption> adopt(const io::ArrayFile& array, const std::vector<CoefficientFile>& files,
                                 const AdoptionChoice& choice);

/// Writes the calibration file, with where it comes from. `date` and `serial` as in `io::CalibrationContext`.
io::FileExpected<void> save_adoption(const std::string& path, const Adoption& adoption, const io::ArrayFile& array,
                                     const std::string& date, const std::string& serial);

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
