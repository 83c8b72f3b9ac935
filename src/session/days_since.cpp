#include "plumb/session/days_since.hpp"

#include <ctime>

#include "plumb/io/date.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
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
  return tl::unexpected<io::FileError>(io::FileError{
      path, 0, "provenance.date",
      "is " + made + ", and " + whose +
          (days < 0.0 ? ": the run would be before the calibration" : ": more than a century lies between the two"),
      "give the date of the run: --date YYYY-MM-DD", io::ExitCode::usage});
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
