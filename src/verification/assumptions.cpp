// What a verdict rests on without having shown it.
#include <fmt/format.h>

#include "field_figures.hpp"
#include "plumb/core/units.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/verification/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

/// What a row of a log of stations is taken for.
std::string row_words(std::uint64_t samples) {
  if (samples > 1)
    return fmt::format(
        "Every row is the mean of {} samples, the fewest behind any row of the log of positions, and scatters by the "
        "noise of the array file over the root of that. The monitor must not get rows of fewer samples.",
        samples);
  return "Every row counts as one sample with the noise of the array file. Where rows are means, let `count` of "
         "[input] "
         "name the column that says of how many samples, and give the log (--stations).";
}

/// First of all: it is the one that no test of plumb can find broken.
std::string standstill_words(const UserLimits& limits) {
  if (!(limits.acceleration_bound_mps2 > 0.0))
    return "A standstill is assumed: no acceleration_bound is stated, and every figure here holds for a tool that does "
           "not accelerate while its readings are steady. No test detects a steady acceleration across gravity; 30 mg "
           "turn the direction by 1.7 deg.";
  const std::string size = "A steady acceleration of at most " +
                           fine_words(limits.acceleration_bound_mps2, io::FieldKind::gravity, 4) + " is allowed for";
  if (limits.acceleration_turn_rad > limits.alert_limit_rad)
    return size + fmt::format(
                      ", which alone turns the direction by more than the alert limit ({:.4g} deg): the alert "
                      "never ends. A tool that accelerates by more is not covered.",
                      deg_from_rad(limits.alert_limit_rad));
  return size + fmt::format(
                    ": {:.4g} deg of every protection level, and of what the length may be off. A tool that "
                    "accelerates by more is not covered.",
                    deg_from_rad(limits.acceleration_turn_rad));
}

/// The same of magnetometers: what adds to the Earth's field, of the ground, of a casing or of the tool itself.
std::string undisturbed_words(const UserLimits& limits) {
  const char* const others =
      "The checks of plumb survey and of the monitor with both groups (length, dip, interference along the tool) see "
      "more than this group alone.";
  if (!(limits.acceleration_bound_mps2 > 0.0))
    return std::string(
               "An undisturbed field is assumed: no disturbance_bound is stated, and every figure here holds where "
               "nothing adds to the Earth's field. No test of this group detects a steady disturbance across the "
               "field; 1000 nT turn the direction by 1.1 deg where the field is 50 uT. ") +
           others;
  const std::string size = "A steady disturbance of the field of at most " +
                           fine_words(limits.acceleration_bound_mps2, io::FieldKind::magnetic, 4) + " is allowed for";
  if (limits.acceleration_turn_rad > limits.alert_limit_rad)
    return size +
           fmt::format(
               ", which alone turns the direction by more than the alert limit ({:.4g} deg): the alert never ends. ",
               deg_from_rad(limits.alert_limit_rad)) +
           others;
  return size +
         fmt::format(
             ": {:.4g} deg of every protection level, and of what the length may be off. A larger one is not covered. ",
             deg_from_rad(limits.acceleration_turn_rad)) +
         others;
}

/// The length that everything is judged by.
std::string length_words(const ArrayFacts& array) {
  if (is_magnetic(array.field))
    return fmt::format(
        "The magnetic field is {:.3f} uT within three times its stated sigma; the noise of every sensor is white and "
        "as stated in the array file.",
        io::units_of(array.field).coarse_per_inside * array.gravity_mps2);
  return fmt::format(
      "Gravity is {:.6f} m/s^2 within three times its stated sigma; the noise of every sensor is "
      "white and as stated in the array file.",
      array.gravity_mps2);
}

/// Beside it: no test tells drift that all sensors share from gravity, and what a limit does not hold makes suspect
/// somebody.
std::string drift_sentence(const UserLimits& limits) {
  return "Drift since the calibration: " + limits.drift +
         ". A healthy sensor that has drifted further can be excluded, and the direction can be off by more than the "
         "protection level. The array file states it: stability.";
}

}  // namespace

std::vector<std::string> assumptions_of(const UserLimits& limits, const Facts& facts) {
  const bool magnetic = is_magnetic(facts.array.field);
  std::vector<std::string> out = {magnetic ? undisturbed_words(limits) : standstill_words(limits)};
  if (!limits.drift.empty()) out.push_back(drift_sentence(limits));
  const std::string faulty = facts.array.chips() ? count_text(limits.faults, "unit") + " (chips, and sensors on none)"
                                                 : count_text(limits.faults, "sensor");
  out.push_back(fmt::format("At most {} {} faulty at once; no guarantee holds beyond {} (confirmed grade).", faulty,
                            by_count(limits.faults, "is", "are"), facts.array.confirmed_grade));
  out.push_back(length_words(facts.array));
  if (magnetic)
    out.push_back(
        "Angles are of the direction of the field in the tool, not of azimuths: azimuth, with its own protection "
        "level, needs gravity as well (plumb survey).");
  if (facts.calibration.predicted())
    out.push_back(
        "No calibration was given: what it leaves is predicted from a simulated stand with sensors drawn from the "
        "priors of the array file. Verify again with the real one (--stations or --calibration).");
  if (facts.calibration.stated())
    out.push_back(
        "The calibration was not fitted: coefficients and their uncertainty are as stated, and no station of this tool "
        "has tested either.");
  if (!facts.calibration.taken_for_exact.empty())
    out.push_back("The calibration is exact for " + facts.calibration.taken_for_exact +
                  ": it states no uncertainty of them, so no limit and no protection level includes its errors. "
                  "Calibrate again with plumb calibrate, which states it.");
  if (!facts.calibration.accepted)
    out.push_back(
        "The calibration was refused: bounds and campaigns treat axes, scales and biases of the array file as exact. "
        "A real tool is worse; correct the calibration before any figure here is used.");
  if (facts.rows_are_stations) out.push_back(row_words(facts.samples_per_row));
  out.push_back(
      "The campaigns know the truth in the frame of the calibrated axes: their errors, alerts and availability are "
      "without "
      "the alignment to the housing, which the protection level of section 1 has on top.");
  out.push_back(
      "The campaign rates hold for the simulated scenarios: the faults, sizes and attitudes listed, in equal shares. "
      "Rates in the field differ.");
  return out;
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
