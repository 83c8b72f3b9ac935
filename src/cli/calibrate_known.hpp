/// `plumb calibrate --from` and `--export`: known coefficients in, or a calibration in the forms of others out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/coefficients/adoption.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// The options that only these two have.
struct KnownCoefficientOptions {
  std::vector<std::string> from;
  std::string form;                    ///< of `from`; empty: found out
  std::string to;                      ///< the form of --export; empty: none
  std::vector<std::string> instances;  ///< as written
  coefficients::Uncertainty uncertainty;
  bool states_uncertainty = false;

  bool given() const { return !from.empty() || !to.empty(); }
};

/// What they share with the rest of the command.
struct KnownCoefficientFiles {
  std::string array, calibration, out, date, serial;
  std::optional<coefficients::TemperatureSpan> span;
  bool json = false;
};

void add_known_coefficient_options(const Options& command, KnownCoefficientOptions& options);

/// Which of them do not belong together, or are given without what they belong to.
std::optional<io::FileError> misuse_of(const KnownCoefficientOptions& options, const std::string& calibration);

io::ExitCode run_calibrate_from(const KnownCoefficientOptions& options, const KnownCoefficientFiles& files);
io::ExitCode run_calibrate_export(const KnownCoefficientOptions& options, const KnownCoefficientFiles& files);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
