/// What a drill has to say for itself: everything is reported from its records alone, so that it holds for every seed.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "plumb/io/array_file.hpp"
#include "plumb/render/chapter.hpp"
#include "plumb/render/timeline.hpp"
#include "plumb/scenario/host_request.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// A fault as the truth behind the log shows it.
struct FaultRecord {
  scenario::Fault fault;
  double begin_s = 0.0;
  double end_s = 0.0;  ///< infinite: it lasts
};

struct DrillRecord {
  const io::ArrayFile& array;
  scenario::Scenario scenario;
  std::vector<FaultRecord> faults;
  std::vector<scenario::Host::Answer> answers;
  render::Timeline timeline;
};

/// When the faults of the scenario came and went, as the phases of the timeline have it.
std::vector<FaultRecord> fault_records(const std::vector<scenario::Fault>& faults, const render::Timeline& timeline);

/// Faults and requests of the host, to be marked in the picture.
std::vector<render::TimelineMark> marks_of(const DrillRecord& record);

/// How far off the answers were, and whether the bound was kept. Angles in deg.
struct DrillFigures {
  int blocks = 0;
  int published = 0;             ///< blocks with valid or degraded output
  double published_deg = 0.0;    ///< worst inclination error in them
  double unconfirmed_deg = 0.0;  ///< worst error of what plumb called unconfirmed
  double plain_deg = 0.0;        ///< worst error without plumb
  int bounded = 0;               ///< blocks for which plumb gave a bound
  int kept = 0;                  ///< those in which it was kept
};
DrillFigures figures_of(const render::Timeline& timeline);

std::vector<render::Figure> key_figures(const DrillRecord& record);
std::vector<std::string> story_of(const DrillRecord& record);
render::Table changes_table(const render::Timeline& timeline);
render::Table states_table();
nlohmann::ordered_json facts_of(const DrillRecord& record);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
