/// How long ago a calibration was made: the monitor has no calendar, so that the host tells it at every power-on.
#pragma once

#include <string>

#include "plumb/io/calibration_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// For an option that takes a date: what is wrong with the text, "" where nothing is.
std::string date_refusal(const std::string& text);

/// From the date of the calibration in `path` to `date`, or to today by the clock of this machine where that is empty;
/// 0 where the calibration has no date. Refuses a date before the calibration, and one a century after it.
io::FileExpected<double> days_since(const io::CalibrationFile& calibration, const std::string& path,
                                    const std::string& date);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
