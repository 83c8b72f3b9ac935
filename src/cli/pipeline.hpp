/// From a log to a calibration, as the commands and the demo alike do it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fit_study.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/log_reader.hpp"
#include "second_look.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct LogSpec {
  std::string path;  ///< "-" = standard input
  io::BadRowPolicy on_bad_row = io::BadRowPolicy::stop;
  bool follow = false;  ///< at the end wait for more
  bool hash = false;    ///< of its bytes, into `LogStatistics::hash`
};

struct CalibrationRun {
  std::vector<Station> stations;
  io::LogStatistics log;
  int without_temperature = 0;  ///< stations left out because nothing says how hot they were
  bool interrupted = false;     ///< Ctrl-C: the stations up to then were used
  FitOptions options;
  FitReport report;
  TemperatureReport temperature;  ///< of the fit, whichever order it had
  FitStudy study;
  Error refusal;                          ///< why it was not accepted
  Concern concern = Concern::none;        ///< what exactly, where the code alone does not say
  SecondLook second_look;                 ///< what would have made the fit settle; of values that do not fit only
  std::vector<std::string> log_findings;  ///< why no still stretch was found; empty where there were some
  std::unique_ptr<Calibration> accepted;  ///< null where it was not
  /// The paper's own fits, where they were asked for and plumb's was accepted; null where they could not be made.
  std::unique_ptr<PaperCalibration> paper;
  Error paper_refusal;  ///< why there are none, or why nothing can be monitored with them

  /// Of the fit whose figures are shown: a fit that was refused early has only part of them in `report`.
  const FitReport& told() const { return study.shown ? study.shown->report : report; }
};

/// What a calibration is to be, beyond its log.
struct CalibrationChoice {
  HoldOutChoice hold_out;
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

/// What only the user can tell of a calibration; empty where not told.
struct CalibrationTag {
  std::string date;    ///< "2026-03-31"
  std::string serial;  ///< of the tool
};

/// Writes the accepted calibration with its provenance.
io::FileExpected<void> save_calibration(const std::string& path, const CalibrationRun& run, const io::ArrayFile& array,
                                        const std::string& log_path, const CalibrationTag& tag = {});

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
