// Options that say what gravity and the field should be at the stations of a survey.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/geomagnetic/field_model.hpp"
#include "plumb/gravity/gravity.hpp"
#include "plumb/io/units.hpp"
#include "plumb/survey/terms.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

enum class ReferenceErrors { iscwsa, wmm };

struct ReferenceOptions {
  std::string array, place, height, date, coefficients;
  ReferenceErrors errors = ReferenceErrors::iscwsa;
  std::string gravity, gravity_sigma;
  std::string field, field_sigma;
  std::string dip, dip_sigma;
  std::string declination, declination_sigma;
  std::optional<NormalGravityInput> normal_gravity;  ///< of an array file; else that of the place
};

void add_reference_options(const Options& command, ReferenceOptions& options);

/// --place, "60.4, 2.1" in degrees north and east, and --height.
io::FileExpected<geomagnetic::Place> place_of(const ReferenceOptions& options);

/// What the options leave open, from the array file that they name; `notes` says what they override with another value,
/// a line each. Refuses a file without a magnetic group, or with several of which none is named.
io::FileExpected<ReferenceOptions> with_array(const ReferenceOptions& options, std::string& notes);

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
