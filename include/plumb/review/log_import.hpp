/// From a log of another program to files of plumb: an array file for its chips, and what its log is to hold.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "plumb/review/log_review.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

/// The error of direction that the array file accepts. With what an autopilot's calibration by hand leaves, the monitor
/// bounds the direction in the housing to 6.8 deg with two chips, 5.2 deg with three, and 6.3 deg once one of three is
/// excluded (tests/cli/import_test.cpp); 1 deg, which it takes where nothing is stated, is never met.
constexpr double kImportAlertLimit_deg = 8.0;

struct ImportSettings {
  std::string message;                 ///< of the log, "sensor_accel"; empty: the one that the review judges by
  bool rates = false;                  ///< with the rate of the first chip that has one
  std::optional<double> gravity_mps2;  ///< else that of the ground of the Earth, as wide as that is
};

/// What of the log is taken.
struct ImportPlan {
  std::vector<std::size_t> sources;  ///< of the digest, one for each chip, in the order of the array file
  std::size_t reference =
      0;  ///< whose instants the rows have: the slowest that is there all the time, so that nothing is made up
  std::vector<double> longest_gap_s;
  std::size_t rates_from = kNoChip;  ///< the source with the rates that are taken
  bool temperature = false;
  bool uncalibrated = false;  ///< of a chip at least the readings are those before the autopilot's calibration
  bool corrected = false;     ///< of a chip at least they are those after it
  std::size_t left_out = 0;   ///< chips beyond what an array can have
  std::string array_text;     ///< three sensors for each chip along x, y and z; chips as packages
  /// The table for `plumb calibrate --from`: the installed calibration of each chip by its device, scale 1 and bias 0
  /// where the readings have it already; "" where a chip has none in the log.
  std::string coefficients_text;
};

/// Refused where the log has no accelerometer, or none in `message`; the error has no file name.
io::FileExpected<ImportPlan> plan_import(const LogDigest& digest, const LogReview& found,
                                         const ImportSettings& settings = {});

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
