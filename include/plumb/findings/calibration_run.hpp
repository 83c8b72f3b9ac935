/// All that is known of a recording that was to become a calibration: what findings are made from.
#pragma once

#include <memory>
#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/findings/finding.hpp"
#include "plumb/findings/fit_study.hpp"
#include "plumb/findings/second_look.hpp"
#include "plumb/findings/unseen_wiring.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/paper/paper_calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

struct CalibrationRun {
  std::vector<Station> stations;
  io::LogStatistics log;
  int without_temperature = 0;  ///< stations not used because their temperature is not known
  bool interrupted = false;     ///< Ctrl-C: the stations up to then were used
  FitOptions options;
  FitReport report;
  TemperatureReport temperature;  ///< of the fit, whichever order it had
  FitStudy study;
  Error refusal;                          ///< why it was not accepted
  Concern concern = Concern::none;        ///< what exactly, where the code alone does not say
  SecondLook second_look;                 ///< what would have made the fit settle; of values that do not fit only
  std::vector<Finding> log_findings;      ///< why no still stretch was found; empty where there were some
  std::unique_ptr<Calibration> accepted;  ///< null where it was not
  /// The paper's own fits, where they were asked for and plumb's was accepted; null where they could not be made.
  std::unique_ptr<PaperCalibration> paper;
  WiringCheck wiring;   ///< of the fit that is shown
  Error paper_refusal;  ///< why there are none, or why nothing can be monitored with them

  /// Of the fit whose figures are shown: a fit that was refused early has only part of them in `report`.
  const FitReport& told() const { return study.shown ? study.shown->report : report; }
};

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
