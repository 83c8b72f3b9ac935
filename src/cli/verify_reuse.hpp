/// Results of longer campaigns, played elsewhere (plumb campaign, plumb-campaign-mpi), in a verification report.
#pragma once

#include <string>
#include <vector>

#include "verify_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Puts the rates of every result into `section`, under "reused" of the campaign that it is a result of, and into what
/// is judged, `out.facts`. Refused: a result of anything but the campaigns of this report with another number of
/// scenarios, one that is not complete, and one for a campaign that was not played.
io::FileExpected<void> take_reused(const std::vector<std::string>& paths, Verification& out, Json& section);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
