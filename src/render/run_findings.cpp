#include "plumb/render/run_findings.hpp"

#include <fmt/format.h>

#include "plumb/core/units.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

namespace {

/// Samples that are worth one independent one before it is reported.
constexpr double kToldCorrelation = 1.5;

}  // namespace

std::string findings_text(const Verdict& last, const io::ArrayFile& array) {
  std::string out;
  const NormMismatch& gravity = last.norm_mismatch;
  if (gravity.configure_mps2 > 0.0) {
    out += fmt::format("gravity     off by {} mg0, within {:.2f} mg0: configure [gravity] value = \"{:.5f} m/s^2\"\n",
                       unsigned_zero(fmt::format("{:+.2f}", in_fine(array, gravity.length_mps2))),
                       in_fine(array, gravity.length_bound_mps2),
                       io::units_of(array.field).coarse_per_inside * gravity.configure_mps2);
  }
  if (last.noise_factor > 1.0) {
    out +=
        fmt::format("noise       {:.1f} times what is stated: write {:.1f} times the noise into the array file; {}\n",
                    last.noise_factor, last.noise_factor, measure_noise_words(array));
  }
  if (last.noise_correlation > kToldCorrelation) {
    out += fmt::format(
        "noise       correlated: {:.0f} samples carry the information of one; state the output filter's rate; {}\n",
        last.noise_correlation, measure_noise_words(array));
  }
  const CalibrationFinding& calibration = last.calibration;
  if (calibration.contradicted) {
    out += fmt::format(
        "calibration contradicted at {}: residuals are {:.1f} times what its covariance allows, by a drift since the "
        "calibration or a covariance that is too small; {}. "
        "Remedy: calibrate again\n",
        count_text(calibration.attitudes, "attitude"), calibration.ratio,
        calibration.refused
            ? std::string("no output is valid")
            : fmt::format("every limit is wider by {:.2f} mg0", in_fine(array, calibration.tolerance_mps2)));
  }
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
