/// A fit in words and figures: one source for the text, the JSON and the page.
#pragma once

#include <string>
#include <vector>

#include "pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// One sensor of a fit. Bias, scale and axis are known only where the fit was accepted.
struct SensorFigures {
  std::string id;
  double bias_mg = 0.0;  ///< mg0
  double bias_sigma_mg = 0.0;
  double scale = 0.0;           ///< log unit per g0
  double scale_change = 0.0;    ///< relative to the datasheet
  double axis_shift_deg = 0.0;  ///< against the nominal axis
  double data_share = 0.0;      ///< least of its four parameters: 1 = from data, 0 = from the datasheet
  double e_cal_mg = 0.0;
  double residual_rms_mg = 0.0;
};
std::vector<SensorFigures> sensor_figures(const CalibrationRun& run, const io::ArrayFile& array);

/// The directions in parameter space that the stations cannot see, in words.
std::vector<std::string> unobservable(const FitReport& report, const io::ArrayFile& array);

/// Attitudes that would tell most, as "inclination 90 deg, toolface 180 deg": those farthest from what has
/// been recorded.
std::vector<std::string> attitudes_to_record(const CalibrationRun& run, const io::ArrayFile& array, int count);

/// Why the fit was refused, and what to do about it.
struct Refusal {
  std::string reason;
  std::string next;
};
Refusal refusal_of(const CalibrationRun& run, const io::ArrayFile& array);

/// The same for the fits by the paper's method.
Refusal paper_refusal_of(const CalibrationRun& run, const io::ArrayFile& array);

/// One fit by the paper's method.
struct PaperFigures {
  std::string sensors;  ///< "all", or the ids of the three
  bool sound = false;
  std::string outcome;  ///< how it ended
  int iterations = 0;
  int rank = 0;
  double start_cost = 0.0, cost = 0.0;  ///< E_g of eq (10) [(m/s^2)^4]
  double length_error_mg = 0.0;         ///< rms of the length of gravity that is left, mg0
};
std::vector<PaperFigures> paper_figures(const PaperCalibration& paper, const io::ArrayFile& array);

/// The report as text and as JSON.
std::string fit_text(const CalibrationRun& run, const io::ArrayFile& array, bool with_stations);
std::string fit_json(const CalibrationRun& run, const io::ArrayFile& array);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
