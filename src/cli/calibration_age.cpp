#include "calibration_age.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "plumb/core/units.hpp"
#include "plumb/io/date.hpp"
#include "plumb/report/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// By the calendar of where the machine stands.
std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  char text[32] = {};
  std::strftime(text, sizeof text, "%Y-%m-%d", &parts);
  return text;
}

}  // namespace

std::string date_refusal(const std::string& text) {
  const io::FileExpected<int> day = io::day_number(text);
  return day ? "" : day.error().what + "; " + day.error().remedy;
}

io::FileExpected<double> days_since(const io::CalibrationFile& calibration, const std::string& path,
                                    const std::string& date) {
  const std::string& made = calibration.context.date;
  if (made.empty()) return 0.0;
  const std::string run = date.empty() ? today() : date;
  const io::FileExpected<int> from = io::day_number(made), to = io::day_number(run);
  if (!from) return tl::unexpected<io::FileError>(from.error());
  if (!to) return tl::unexpected<io::FileError>(to.error());
  const double days = *to - *from;
  if (days >= 0.0 && days <= kMostDaysSinceCalibration) return days;
  const std::string whose = date.empty() ? "today is " + run + " by the clock of this machine" : "--date is " + run;
  return tl::unexpected<io::FileError>(
      io::FileError{path, 0, "provenance.date",
                    "is " + made + ", and " + whose +
                        (days < 0.0 ? ": the run would be before the calibration" : ": a century lies between the two"),
                    "give the date of the run: --date YYYY-MM-DD", io::ExitCode::usage});
}

std::string undated_note(const io::ArrayFile& array, const io::CalibrationFile& calibration, const std::string& path) {
  if (!calibration.context.date.empty()) return "";
  const bool grows = std::any_of(array.stability.begin(), array.stability.end(),
                                 [](const Stability& s) { return s.per_day_mps2 > 0.0; });
  if (!grows) return "";
  return "plumb: note: " + array.path + " states stability_per_day, but " + path +
         " has no date: the drift allowed for is that of the day of the calibration. Remedy: calibrate with --date "
         "YYYY-MM-DD.\n";
}

std::string drift_words(const io::ArrayFile& array, double days_since_calibration) {
  const SensorSet untold = io::without_stability(array);
  if (untold == array.array.all()) return "none is allowed for: no stability is stated";
  const Readings tolerance = io::tolerance_mps2(array, days_since_calibration);
  const double most_mg = 1e3 * g0_from_mps2(*std::max_element(tolerance.begin(), tolerance.end()));
  std::string out = fmt::format(
      "up to {:.3g} mg0 allowed for, {:.0f} sigmas of the stability {:.0f} days after the "
      "calibration",
      most_mg, kStabilitySigmas, days_since_calibration);
  if (!untold.empty()) out += "; none for " + report::sensor_names(untold, array.array);
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
