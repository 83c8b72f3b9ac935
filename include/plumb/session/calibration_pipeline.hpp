/// From a log to a calibration, as the commands and the demo alike do it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/findings/calibration_run.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/session/log_spec.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

using findings::CalibrationRun;

/// What a calibration is to be, beyond its log.
struct CalibrationChoice {
  findings::HoldOutChoice hold_out;
  FitOptions fit;
  TemperatureOptions temperature;  ///< its own `fit` is not looked at
  bool paper_fits = false;         ///< the paper's own fits too
  /// Of the roll groups; by default the axis from which the array file has inclinations counted in results.
  std::optional<Vec3> roll_axis;
};

/// Reads the log, finds the stations (or takes the rows as stations), fits, and judges the fit. Refuses to make the
/// paper's fits for more than kPaperCapacity sensors before it reads anything.
io::FileExpected<CalibrationRun> run_calibration(const io::ArrayFile& array, const LogSpec& log,
                                                 const CalibrationChoice& choice = {});

/// The same of samples that are in memory, each with its temperature.
CalibrationRun run_calibration(const io::ArrayFile& array, const std::vector<Sample>& samples,
                               const CalibrationChoice& choice = {});

/// The stations of a log alone, as a calibration of that array finds them.
io::FileExpected<std::vector<Station>> find_stations(const io::ArrayFile& array, const LogSpec& log);

/// What only the user can tell of a calibration; empty where not given.
struct CalibrationTag {
  std::string date;                             ///< "2026-03-31"
  std::string serial;                           ///< of the tool
  std::optional<io::FrameAlignment> alignment;  ///< of a magnetic group, where its axes were aligned
};

/// What is said of a known attitude whose station the calibration does not show.
io::FileError unknown_station(const io::KnownAttitude& known, std::size_t stations);

/// The attitudes of the stations, and what was stated of them, for the calibration file.
void note_attitudes(const CalibrationRun& run, io::CalibrationContext& context);

/// Writes the accepted calibration with its provenance.
io::FileExpected<void> save_calibration(const std::string& path, const CalibrationRun& run, const io::ArrayFile& array,
                                        const std::string& log_path, const CalibrationTag& tag = {});

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
