/// Everything that is said about a fit beside the fit: held-out stations, sensors omitted, coverage, what to record
/// next, the paper's parameters, how it converged. One source for the text, the JSON and the pictures.
#pragma once

#include <memory>
#include <vector>

#include "plumb/calibration/acceptance.hpp"
#include "plumb/calibration/null_directions.hpp"
#include "plumb/calibration/observability.hpp"
#include "plumb/calibration/temperature_fit.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/paper/paper_parameters.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// How the stations are held out of the fits that predict them.
struct HoldOutChoice {
  int folds = 0;      ///< 0: 4 folds, or leave-one-out below 16 stations
  bool once = false;  ///< only the first fold is held out (a fraction of the stations)
  bool all = false;   ///< leave-one-out
  bool none = false;  ///< nothing is held out
};
struct FitStudy {
  std::unique_ptr<Calibration> shown;  ///< accepted, or what was refused; null where nothing converged
  Judgement judgement;                 ///< of `judge`; code ok where it was not reached or all is well
  HoldOutPlan plan;
  HoldOut held_out;
  std::vector<StationPrediction> predicted;  ///< by station; empty: none held out; outliers are not judged
  std::vector<int> kept;                     ///< stations that an accepted fit did not reject; else all
  std::vector<int> set_aside;                ///< the others
  bool odd_sought = false;
  OddSensor odd;
  std::vector<SeenAttitude> attitudes;     ///< by station; direction 0 where unknown
  std::vector<StationResidual> residuals;  ///< by station; empty where nothing converged
  Coverage coverage;
  std::vector<PlannedAttitude> next;
  std::unique_ptr<NullCombinations> nulls = std::make_unique<NullCombinations>();
  int null_count = 0;
  Expected<SensorModel> paper = fail(Errc::not_calibrated);
  std::vector<double> cost;  ///< of the fit, by iteration
};

/// Those of the stations whose index is listed.
std::vector<Station> chosen(const std::vector<Station>& stations, const std::vector<int>& which);

/// Attitudes that are proposed.
inline constexpr int kPlanned = 6;

/// `fit` is what `calibrate_over_temperature` returned for the stations with `options`, their order the one that was
/// fitted, `report` what it wrote. Of a fit over temperature all but the stations held out are studied with the drift
/// that it found; the fits that predict these find their own.
FitStudy study_fit(const io::ArrayFile& array, const std::vector<Station>& stations, const Expected<Calibration>& fit,
                   const FitReport& report, const TemperatureOptions& options, const HoldOutChoice& choice);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
