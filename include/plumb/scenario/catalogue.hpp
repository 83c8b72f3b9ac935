/// The fault catalogue F01 to F29: what can go wrong with redundant accelerometers, where it comes from, how it is
/// injected, and what a monitor is expected to make of it. docs/fault-catalogue.md is this table in print.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/core/units.hpp"
#include "plumb/health/state.hpp"
#include "plumb/scenario/fault.hpp"
#include "plumb/scenario/fault_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// Whom a part of an entry strikes.
enum class Victim : std::uint8_t {
  named,  ///< the sensor that the user names
  next,   ///< the one behind it in the array
  every,  ///< all sensors alike
  log,    ///< the tool, its clock or its link: no sensor
};

/// One fault of an entry. `$1` in the body stands for the sensor behind the named one.
struct CataloguePart {
  const char* body = "";  ///< as in the fault language, with the default size: "bias=50mg0"
  Victim victim = Victim::named;
  bool later = false;  ///< begins 6 stations, 20 s or 2000 rows after the onset
};

/// States as bits, 1 << HealthState.
using StateMask = std::uint8_t;
constexpr StateMask state_bit(HealthState state) noexcept {
  return static_cast<StateMask>(1U << static_cast<unsigned>(state));
}

/// Which sensors the monitor may have excluded, also provisionally, at the end.
enum class AllowedMask : std::uint8_t {
  nobody,       ///< none
  only_faulty,  ///< none, some or all of the faulty ones
  the_faulty,   ///< exactly the faulty ones
};

/// What the monitor makes of it on the course (course.hpp), counted in blocks from the onset on.
struct Outcome {
  int earliest_block = 0;  ///< first block that may tell (0: the one in which the fault begins)
  int latest_block = 0;    ///< by this block the output is no longer plainly valid; 0 = it may never tell
  StateMask states = 0;    ///< allowed at the end
  AllowedMask mask = AllowedMask::only_faulty;
  double tilt_bound_rad = rad_from_deg(0.5);  ///< of the error while the output is published as valid
};

/// A number that a user may turn.
struct CatalogueParameter {
  const char* name = "";
  const char* unit = "";
  const char* standard = "";  ///< default
  const char* sweep = "";     ///< values worth trying
};

struct CatalogueEntry {
  const char* id = "";      ///< "F04"
  const char* name = "";    ///< "bias-step", also accepted where an id is
  const char* title = "";   ///< "Bias step"
  const char* source = "";  ///< what does this in a real tool
  std::vector<CatalogueParameter> parameters;
  std::vector<CataloguePart> parts;
  bool from_power_on = false;    ///< on the course: from the first row on, not from the onset
  Outcome four;                  ///< four sensors: one to spare
  Outcome six;                   ///< six sensors: three to spare
  const char* known_limit = "";  ///< what no monitor of this kind can do about it; "" = nothing to say
};

/// In the order of their ids.
const std::vector<CatalogueEntry>& catalogue();

/// A name of PX4's failure injection, and the fault that it means here.
struct Px4Alias {
  const char* word = "";  ///< "off"
  const char* id = "";    ///< entry
  const char* body = "";  ///< in the place of the entry's first part
};
const std::vector<Px4Alias>& px4_aliases();

/// By id, name or PX4's word; an alias comes with its body in the place of the first part.
std::optional<CatalogueEntry> find_entry(std::string_view word);

struct CatalogueOptions {
  int sensor = 0;
  Clock clock = Clock::time;
  double onset = 0.0;
  double duration = std::numeric_limits<double>::infinity();
  std::string size;  ///< in the place of the first part's; empty = default
};

/// The faults of an entry. Errors are texts that say what was found and end in a remedy.
tl::expected<std::vector<Fault>, std::string> faults_of(const CatalogueEntry& entry, const CatalogueOptions& options,
                                                        const FaultContext& context);

/// The whole page docs/fault-catalogue.md.
std::string catalogue_page();

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
