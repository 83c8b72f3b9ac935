// Options that say what gravity and the field should be at the stations of a survey.
#pragma once

#include <string>
#include <vector>

#include "plumb/io/units.hpp"
#include "plumb/survey/terms.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

enum class ReferenceErrors { iscwsa, wmm };

struct ReferenceOptions {
  std::string place, height, date, coefficients;
  ReferenceErrors errors = ReferenceErrors::iscwsa;
  std::string gravity, gravity_sigma;
  std::string field, field_sigma = "130 nT";
  std::string dip, dip_sigma = "0.2 deg";
  std::string declination, declination_sigma = "0.4 deg";
};

void add_reference_options(const Options& command, ReferenceOptions& options);

/// Every station with the gravity and the field of its depth: by the model at --place and --date, by what is stated, or
/// partly by either. Refuses what is neither stated nor to be had.
io::FileExpected<std::vector<survey::ReferencedStation>> referenced(const std::vector<survey::Measurement>& stations,
                                                                    const ReferenceOptions& options);

/// A value of an option, its name in the error.
io::FileExpected<double> quantity_option(io::Quantity quantity, const char* option, const std::string& text);
io::FileExpected<double> field_option(const char* option, const std::string& text);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
