#include "plumb/render/machine_tables.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <set>
#include <vector>

#include "plumb/health/transition_table.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/plot.hpp"
#include "plumb/render/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using io::Json;

const char* kind_name(CellKind kind) {
  switch (kind) {
    case CellKind::taken: return "taken";
    case CellKind::ignored: return "ignored";
    case CellKind::held: return "held";
    case CellKind::impossible: return "impossible";
  }
  return "?";
}

std::vector<std::string> actions_of(const Cell& cell) {
  std::vector<std::string> out;
  for (int k = 0; k < Action::kinds; ++k) {
    const auto one = static_cast<Action::Bits>(1U << static_cast<unsigned>(k));
    if ((cell.actions & one) != 0) out.emplace_back(action_name(one));
  }
  return out;
}

std::string cell_text(const Cell& cell) {
  if (cell.kind != CellKind::taken) return kind_name(cell.kind);
  std::string out;
  for (const std::string& action : actions_of(cell)) out += action + "; ";
  return out + to_string(cell.target) + (cell.from_motion ? "; also from motion" : "");
}

bool same_cells(Mode a, Mode b) {
  for (int e = 0; e < kEventCount; ++e) {
    const auto event = static_cast<HealthEvent>(e);
    if (cell_text(cell_of(a, event)) != cell_text(cell_of(b, event))) return false;
  }
  return true;
}

/// Modes with the same row share a column, as in the design.
std::vector<std::vector<Mode>> columns() {
  std::vector<std::vector<Mode>> out;
  for (int m = 0; m < kModeCount; ++m) {
    const auto mode = static_cast<Mode>(m);
    if (!out.empty() && same_cells(out.back().front(), mode)) {
      out.back().push_back(mode);
    } else {
      out.push_back({mode});
    }
  }
  return out;
}

constexpr std::array<const char*, 4> kSizes = {"rank lost", "critical", "all configured", "reduced"};
constexpr std::array<const char*, 5> kYesNoFacts = {"not yet validated", "enough blocks passed", "from suspect",
                                                    "bounded or isolable", "calibrated"};
static_assert(sizeof(TargetFacts) == 1 + kYesNoFacts.size(), "a fact was added to the table: name it here and below");

/// A situation is a number: the size class in bits 0-1, then one bit per yes-or-no fact.
constexpr unsigned kSituations = 4U << kYesNoFacts.size();

TargetFacts facts_of(unsigned situation) {
  TargetFacts facts;
  facts.size = static_cast<SizeClass>(situation & 3U);
  facts.not_yet_validated = (situation & 4U) != 0;
  facts.enough_passed = (situation & 8U) != 0;
  facts.base_suspect = (situation & 16U) != 0;
  facts.protection_within = (situation & 32U) != 0;
  facts.calibrated = (situation & 64U) != 0;
  return facts;
}

/// Every mode that a cell can lead to, over all facts that its target may depend on.
std::set<Mode> destinations(Mode from, const Cell& cell) {
  std::set<Mode> out;
  for (unsigned s = 0; s < kSituations; ++s) out.insert(resolve(from, cell.target, facts_of(s)));
  return out;
}

/// Where a target leads in a situation; "stay" where that is the mode it came from.
std::string outcome(Target target, unsigned situation) {
  const Mode one = resolve(Mode::nominal, target, facts_of(situation));
  const Mode other = resolve(Mode::suspect, target, facts_of(situation));
  return one == other ? to_string(one) : "stay";
}

/// Whether the facts in `bits` make a difference to a target in any situation.
bool depends_on(Target target, unsigned bits) {
  for (unsigned s = 0; s < kSituations; ++s) {
    for (unsigned value = 0; value < kSituations; ++value) {
      if (outcome(target, s) != outcome(target, (s & ~bits) | (value & bits))) return true;
    }
  }
  return false;
}

/// The rows of one target: every combination of the facts that it depends on, and where it then leads.
Json resolution(Target target) {
  unsigned relevant = depends_on(target, 3U) ? 3U : 0U;
  for (std::size_t k = 0; k < kYesNoFacts.size(); ++k) {
    if (depends_on(target, 4U << k)) relevant |= 4U << k;
  }
  Json rows = Json::array();
  for (unsigned s = 0; s < kSituations; ++s) {
    if ((s & ~relevant) != 0) continue;
    Json when = Json::object();
    if ((relevant & 3U) != 0) when["size"] = kSizes[s & 3U];
    for (std::size_t k = 0; k < kYesNoFacts.size(); ++k) {
      if ((relevant & (4U << k)) != 0) when[kYesNoFacts[k]] = (s & (4U << k)) != 0;
    }
    rows.push_back(io::object({{"target", to_string(target)}, {"when", std::move(when)}, {"to", outcome(target, s)}}));
  }
  return rows;
}

}  // namespace

std::string machine_markdown() {
  const std::vector<std::vector<Mode>> modes = columns();
  std::string out = "| event (rank order) |";
  std::string rule = "|---|";
  for (const std::vector<Mode>& column : modes) {
    std::string title;
    for (const Mode mode : column) title += (title.empty() ? "" : ", ") + std::string(to_string(mode));
    out += " " + title + " |";
    rule += "---|";
  }
  out += "\n" + rule + "\n";
  for (int e = 0; e < kEventCount; ++e) {
    const auto event = static_cast<HealthEvent>(e);
    if (event == HealthEvent::none) continue;  // nothing happened: ignored everywhere
    out += fmt::format("| {} |", to_string(event));
    for (const std::vector<Mode>& column : modes) out += " " + cell_text(cell_of(column.front(), event)) + " |";
    out += "\n";
  }
  return out;
}

std::string machine_graph() {
  std::string out =
      "digraph plumb {\n  rankdir=LR;\n  node [shape=box, style=\"rounded,filled\", fontname=\"sans-serif\", "
      "fontcolor=white];\n"
      "  edge [fontname=\"sans-serif\", fontsize=10];\n";
  for (int m = 0; m < kModeCount; ++m) {
    const auto mode = static_cast<Mode>(m);
    out += fmt::format("  \"{}\" [fillcolor=\"{}\", color=\"{}\"];\n", to_string(mode), colour_of(state_of(mode)),
                       colour_of(state_of(mode)));
  }
  std::map<std::pair<Mode, Mode>, std::string> edges;
  for (int m = 0; m < kModeCount; ++m) {
    const auto from = static_cast<Mode>(m);
    for (int e = 0; e < kEventCount; ++e) {
      const auto event = static_cast<HealthEvent>(e);
      const Cell& cell = cell_of(from, event);
      if (cell.kind != CellKind::taken) continue;
      for (const Mode to : destinations(from, cell)) {
        if (to == from) continue;
        std::string& label = edges[{from, to}];
        label += (label.empty() ? "" : "\\n") + std::string(to_string(event));
      }
    }
  }
  for (const auto& [ends, label] : edges) {
    out += fmt::format("  \"{}\" -> \"{}\" [label=\"{}\"];\n", to_string(ends.first), to_string(ends.second), label);
  }
  return out + "}\n";
}

std::string machine_json() {
  Json out;
  Json states = Json::array();
  for (int m = 0; m < kModeCount; ++m) {
    const auto mode = static_cast<Mode>(m);
    states.push_back(io::object(
        {{"mode", to_string(mode)}, {"state", to_string(state_of(mode))}, {"meaning", meaning(state_of(mode))}}));
  }
  out["modes"] = std::move(states);
  Json events = Json::array();
  for (int e = 0; e < kEventCount; ++e) events.push_back(to_string(static_cast<HealthEvent>(e)));
  out["events_in_rank_order"] = std::move(events);
  Json cells = Json::array();
  for (int m = 0; m < kModeCount; ++m) {
    const auto from = static_cast<Mode>(m);
    for (int e = 0; e < kEventCount; ++e) {
      const auto event = static_cast<HealthEvent>(e);
      const Cell& cell = cell_of(from, event);
      Json to = Json::array();
      for (const Mode mode : destinations(from, cell)) to.push_back(to_string(mode));
      cells.push_back(io::object({{"mode", to_string(from)},
                                  {"event", to_string(event)},
                                  {"kind", kind_name(cell.kind)},
                                  {"actions", actions_of(cell)},
                                  {"from_motion", cell.from_motion},
                                  {"target", to_string(cell.target)},
                                  {"leads_to", std::move(to)}}));
    }
  }
  out["cells"] = std::move(cells);
  Json targets = Json::array();
  for (int t = 0; t <= static_cast<int>(Target::failed); ++t) {
    for (Json& row : resolution(static_cast<Target>(t))) targets.push_back(std::move(row));
  }
  out["targets"] = std::move(targets);
  return out.dump(2) + "\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
