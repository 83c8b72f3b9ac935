/// What the user needs the array for: the limits that a verification report judges by.
#pragma once

#include <optional>
#include <string>

#include "plumb/io/array_file.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

/// A limit that is not given is not judged, but for the first two.
struct UserLimits {
  double alert_limit_rad = 0.0;  ///< largest tilt error that can be borne
  std::string alert_limit_from;  ///< where that stands: a file, or "default"
  int faults = 1;                ///< sensors at fault at once that have to be isolated
  std::string faults_from;
  /// Of the array file: 0 = a standstill is assumed. Of magnetometers its disturbance_bound.
  double acceleration_bound_mps2 = 0.0;
  double acceleration_turn_rad = 0.0;          ///< most that it turns what the sensors feel
  std::string drift;                           ///< what of it the limits allow for; empty: not given
  std::optional<double> false_alarm_rate;      ///< per block
  std::optional<double> misleading_rate;       ///< per scenario with faults: error above the alert limit, no alert
  std::optional<double> wrong_exclusion_rate;  ///< per scenario with faults
  std::optional<double> fault_mps2;            ///< least constant error of a sensor that has to be detected
  std::optional<double> detect_within_s;       ///< 95 % of the faults that are detected at all
  std::string file;                            ///< empty: none was given
};

/// Those of the array file alone.
UserLimits limits_of(const io::ArrayFile& array);

/// A limits file (TOML, table [limits]); what it omits is taken from the array file. Refuses unknown keys, values
/// out of range and missing units, with line and remedy.
io::FileExpected<UserLimits> read_limits(const std::string& path, const io::ArrayFile& array);
io::FileExpected<UserLimits> parse_limits(const std::string& text, const std::string& path, const io::ArrayFile& array);

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb
