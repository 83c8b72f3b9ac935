/// What is said of a calibration as it is loaded: its age, and what it does not state.
#pragma once

#include <string>

#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// A note for standard error: the array file states a growth per day, and the calibration has no date. Else empty.
std::string undated_note(const io::ArrayFile& array, const io::CalibrationFile& calibration, const std::string& path);

/// A note for standard error: the calibration states no uncertainty of some sensor, so that every figure takes its row
/// for exact. Else empty.
std::string exact_words(const io::CalibrationFile& calibration, const std::string& path);
/// The same as a line for standard error.
std::string exact_note(const io::CalibrationFile& calibration, const std::string& path);

/// A note for standard error: the calibration was not fitted, but made of known coefficients. Else empty.
std::string stated_note(const io::CalibrationFile& calibration, const std::string& path);

/// A note for standard error: of the sensors in `changed` the array file states another noise than when the calibration
/// was made. Empty where there are none.
std::string noise_note(const io::ArrayFile& array, SensorSet changed, const std::string& path);

/// What the limits allow for: "up to 0.8 mg0 allowed for, 4 sigmas of the stability 31 days after the calibration", and
/// which sensors state none. Without a full stop.
std::string drift_words(const io::ArrayFile& array, double days_since_calibration);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
