/// The paper's calibration experiment (Figs 4 to 10): every iteration of its method and of plumb's on the same
/// stations, in the same parameters, beside what is really the case.
#pragma once

#include <vector>

#include "plumb/study/fits.hpp"
#include "plumb/study/paper_form.hpp"
#include "plumb/study/proportion.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

struct IterationPoint {
  PaperParameters parameter{};  ///< bias [m/s^2], scale [raw per m/s^2], misalignments
  double cost_g4 = 0.0;         ///< E_g of eq (10) of the method's own vectors [g0^4]
};

/// One combination of sensors. Both histories start at the datasheet.
struct FitHistory {
  SensorSet used;
  PaperParameters truth{};            ///< in the frame in which the true axes lie nearest to the nominal ones
  std::vector<IterationPoint> paper;  ///< a fit of this combination alone
  std::vector<IterationPoint> own;    ///< plumb's one fit of all sensors, read for this combination
  bool paper_converged = false;
  int paper_rank = 0;  ///< of its n(n+1) parameters
};

/// rms over the parameters of a kind of (fitted - true).
struct ParameterError {
  double bias_mps2 = 0.0;
  double scale = 0.0;  ///< relative
  double misalignment = 0.0;
};
ParameterError error_of(const FitHistory& history, const IterationPoint& at) noexcept;

struct CalibrationStudy {
  std::vector<Station> stations;
  Fits fits;
  std::vector<FitHistory> history;  ///< in the order of `Fits::combinations`
};

StudyExpected<CalibrationStudy> calibration_study(const scenario::Tool& tool, std::uint64_t seed);

/// Eq (11) as it is printed, with the plain inverse of the Hessian, over `tools` tools of four sensors: how often the
/// stop rule is met within 100 iterations. The Hessian is singular, so that what happens hangs on the rounding of the
/// machine; that it hardly ever ends does not.
StudyExpected<Proportion> plain_inverse_ends(std::uint64_t seed, int tools);

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
