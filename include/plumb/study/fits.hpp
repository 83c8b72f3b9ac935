/// The two calibrations of one tool from the same stations: the paper's, a fit for all sensors and one for every
/// triple, and plumb's one fit.
#pragma once

#include <memory>
#include <vector>

#include "plumb/paper/paper_calibration.hpp"
#include "plumb/scenario/truth.hpp"
#include "plumb/study/survey.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

struct Fits {
  Datasheet datasheet;
  SensorArray nominal;
  std::unique_ptr<const PaperCalibration> paper;
  std::unique_ptr<const Calibration> own;

  /// All sensors first, then the triples in the order of the array: 1-2-3, 1-2-4, 1-3-4, 2-3-4.
  std::vector<SensorSet> combinations() const;
  /// The paper's fit of a combination.
  const PaperFit& paper_fit(SensorSet used) const noexcept;
};

/// Stations of `scenario::calibration_run`: 48 random attitudes, means of 200 samples.
StudyExpected<std::vector<Station>> calibration_stations(const scenario::Tool& tool, std::uint64_t seed);

/// Runs both. `traces`, where given, receives the iterations of the paper's fits in the order of `combinations`.
/// For arrays of 4 sensors. Errors: another number; a fit that was refused. A paper's fit that did not converge is no
/// error.
StudyExpected<Fits> fit_both(const Datasheet& datasheet, const std::vector<Station>& stations,
                             std::vector<PaperTrace>* traces = nullptr);

/// "1-2-3": positions of the sensors, counted from 1.
std::string name_of(SensorSet used);

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
