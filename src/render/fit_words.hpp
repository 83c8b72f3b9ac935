/// What a fit says, in sentences: null directions, p-values, coverage, attitudes to record (private to src/render).
#pragma once

#include <string>
#include <vector>

#include "plumb/findings/calibration_run.hpp"
#include "plumb/findings/fit_figures.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

std::string id_of(const io::ArrayFile& array, int i);

/// "bias of a3 against scale of a3", "axis of a2 about x".
std::string null_words(const NullCombination& combination, const io::ArrayFile& array);

/// The directions in parameter space that the stations cannot see, one phrase each.
std::vector<std::string> unobservable(const findings::CalibrationRun& run, const io::ArrayFile& array);

/// "inclination 90 deg, toolface 180 deg (down along 0.0, 1.0, 0.0)".
std::string attitude_words(const PlannedAttitude& attitude);

/// What the p-value means, in one sentence.
std::string p_value_words(const FitReport& report);
/// The residuals are smaller than the declared noise makes them, but for one fit in a thousand.
bool noise_overstated(const FitReport& report);

/// What the attitudes lack, one sentence each; empty where nothing does.
std::vector<std::string> coverage_words(const findings::CalibrationRun& run, const io::ArrayFile& array);

/// What all scale factors have in common, and what that may mean; empty where there is no fit to show.
std::string common_scale_words(const findings::CalibrationRun& run);

/// Stations that the fit rejected: "station 7 (31.2 sigma, 98 % of it by a2)", and how many more.
std::vector<std::string> outlier_words(const findings::CalibrationRun& run, const io::ArrayFile& array);

/// "the samples of a2 scatter by 1 mg0, 5 times the 0.2 mg0 declared".
std::string noise_words(const FitReport& report, const io::ArrayFile& array, int sensor);

/// "a3: its residuals are 2.4 times ...": the sensor of higher variance than the others; empty where none is.
std::string high_variance_words(const FitReport& report, const io::ArrayFile& array);

/// How surely an inclination is known in itself, and by what.
std::string inclination_words(const FitReport& report);

/// What the roll groups of the log were good for; empty where there are none.
std::string roll_axis_words(const FitReport& report);                          ///< empty without roll groups
std::string one_of(const SensorSet& suspects, const io::ArrayFile& array);     ///< "a2", "one of a1 and a2"
std::string level_words(const FitReport& report, const io::ArrayFile& array);  ///< empty where no sensor stands out
std::string roll_words(const FitReport& report);

/// "with it 4.5 mg0 remain beyond the noise, without it 0.01 mg0".
std::string odd_sensor_words(const OddSensor& odd, const io::ArrayFile& array);

/// "all", or the ids of the three.
std::string paper_sensors(const findings::PaperFigures& figures, const io::ArrayFile& array);
/// How a fit by the paper's method ended.
std::string paper_outcome(const findings::PaperFigures& figures);

/// Why there is no form of the paper's parameters, and what to use instead.
std::string paper_words(const Error& error, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
