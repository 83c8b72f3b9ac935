#include "plumb/render/calibration_notes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plumb/core/units.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

std::string undated_note(const io::ArrayFile& array, const io::CalibrationFile& calibration, const std::string& path) {
  if (!calibration.context.date.empty()) return "";
  const bool grows = std::any_of(array.stability.begin(), array.stability.end(),
                                 [](const Stability& s) { return s.per_day_mps2 > 0.0; });
  if (!grows) return "";
  return "plumb: note: " + array.path + " states stability_per_day, but " + path +
         " has no date: no drift since the calibration is allowed for. Remedy: calibrate with --date YYYY-MM-DD.\n";
}

std::string exact_words(const io::CalibrationFile& calibration, const std::string& path) {
  const SensorArray& array = calibration.calibration.array;
  const SensorSet exact = array.taken_for_exact();
  if (exact.empty()) return "";
  return path + " states no uncertainty (covariance 0) of " +
         (exact == array.all() ? "any sensor" : sensor_names(exact, array)) +
         ": every limit and protection level treats its scale, bias and axis as exact, and is too small otherwise. "
         "Remedy: calibrate again with plumb calibrate, which writes the uncertainty.";
}

std::string exact_note(const io::CalibrationFile& calibration, const std::string& path) {
  const std::string words = exact_words(calibration, path);
  return words.empty() ? "" : "plumb: note: " + words + "\n";
}

std::string stated_note(const io::CalibrationFile& calibration, const std::string& path) {
  if (calibration.context.coefficients.empty()) return "";
  return "plumb: note: " + path + " was not fitted: it holds known coefficients (" + calibration.context.coefficients +
         ", " + calibration.context.log_file +
         "), which no station of this array has tested; every limit rests on the uncertainty stated with them. Remedy: "
         "hold the tool still in several orientations first, so that the monitor validates them.\n";
}

std::string noise_note(const io::ArrayFile& array, SensorSet changed, const std::string& path) {
  if (changed.empty()) return "";
  return "plumb: note: " + array.path + " states another noise of " + sensor_names(changed, array.array) +
         " than when " + path +
         " was made: the array file counts, in every limit and protection level. Remedy: none is needed if the noise "
         "of "
         "the sensors has changed; calibrate again if it was misstated then.\n";
}

std::string drift_words(const io::ArrayFile& array, double days_since_calibration) {
  const SensorSet untold = io::without_stability(array);
  if (untold == array.array.all()) return "none is allowed for: no stability is stated";
  const Readings tolerance = io::tolerance_mps2(array, days_since_calibration);
  const double most = in_fine(array, *std::max_element(tolerance.begin(), tolerance.end()));
  std::string out = fmt::format(
      "up to {:.3g} mg0 allowed for, {:.0f} sigmas of the stability {} after the "
      "calibration",
      most, kStabilitySigmas, count_text(std::round(days_since_calibration), "day"));
  if (!untold.empty()) out += "; none for " + sensor_names(untold, array.array);
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
