/// A fit in figures: one source for the text, the JSON, the page and the pictures.
#pragma once

#include <string>
#include <vector>

#include "plumb/core/units.hpp"
#include "plumb/findings/calibration_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

inline constexpr double kMilliG0_mps2 = 1e-3 * kG0_mps2;

/// One sensor of a fit; nothing is known where no fit converged. Shares: 1 = from data, 0 = from the datasheet.
struct SensorFigures {
  std::string id;
  bool known = false;
  double bias_mg = 0.0;  ///< mg0
  double bias_sigma_mg = 0.0;
  double bias_share = 0.0;
  double scale = 0.0;         ///< log unit per g0
  double scale_change = 0.0;  ///< relative to the datasheet
  double scale_sigma = 0.0;   ///< relative
  double scale_share = 0.0;
  double axis_shift_deg = 0.0;  ///< against the nominal axis
  double axis_sigma_deg = 0.0;  ///< about each of the two directions across it
  double axis_share = 0.0;
  double data_share = 0.0;  ///< least of its parameters
  double e_cal_mg = 0.0;
  double residual_rms_mg = 0.0;
  double sample_noise_mg = 0.0;  ///< of the samples of the stations; 0: not known
};
std::vector<SensorFigures> sensor_figures(const CalibrationRun& run, const io::ArrayFile& array);

/// A station whose readings the fit to the others does not predict.
struct OddStation {
  int number = 0;  ///< as counted in the report, from 1
  double sigmas = 0.0;
};
/// Beyond `kOddStation_sigmas`, the worst first.
inline constexpr double kOddStation_sigmas = 4.0;
std::vector<OddStation> odd_stations(const CalibrationRun& run);

/// One fit by the paper's method.
struct PaperFigures {
  SensorSet used;  ///< of three sensors or more
  bool sound = false;
  StopReason stop = StopReason::none;  ///< none: not possible
  int iterations = 0;
  int rank = 0;
  double start_cost = 0.0, cost = 0.0;  ///< the paper's cost E_g [(m/s^2)^4]
  double length_error_mg = 0.0;         ///< rms of the length of gravity that is left, mg0
};
std::vector<PaperFigures> paper_figures(const PaperCalibration& paper, const io::ArrayFile& array);

/// Noise of a sensor's own samples over the declared one; 0 where the stations do not know it.
double noise_factor(const FitReport& report, const io::ArrayFile& array, int sensor);

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
