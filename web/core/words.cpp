// The words and numbers that core and page share, so that the page writes none of them down a second time.
#include "explorer.hpp"
#include "flight_run.hpp"
#include "plumb/health/transition_table.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/scenario/catalogue.hpp"
#include "plumb/study/experiments.hpp"

namespace plumb_web {

using namespace plumb;

namespace {

template <class Enum>
io::Json names_of(int count) {
  io::Json out = io::Json::array();
  for (int k = 0; k < count; ++k) out.push_back(std::string(to_string(static_cast<Enum>(k))));
  return out;
}

/// The cells that something happens in: from, event, where it leads.
io::Json table() {
  io::Json out = io::Json::array();
  for (int m = 0; m < kModeCount; ++m) {
    for (int e = 0; e < kEventCount; ++e) {
      const Cell& cell = cell_of(static_cast<Mode>(m), static_cast<HealthEvent>(e));
      if (cell.kind != CellKind::taken) continue;
      out.push_back(io::object({{"mode", m}, {"event", e}, {"target", to_string(cell.target)}}));
    }
  }
  return out;
}

io::Json catalogue_json() {
  io::Json out = io::Json::array();
  for (const scenario::CatalogueEntry& entry : scenario::catalogue()) {
    io::Json parameters = io::Json::array();
    for (const scenario::CatalogueParameter& p : entry.parameters) {
      parameters.push_back(
          io::object({{"name", p.name}, {"unit", p.unit}, {"standard", p.standard}, {"sweep", p.sweep}}));
    }
    io::Json one = io::object({{"id", entry.id},
                               {"name", entry.name},
                               {"title", entry.title},
                               {"source", entry.source},
                               {"known_limit", entry.known_limit},
                               {"whole_log", entry.parts.front().victim == scenario::Victim::log}});
    one["parameters"] = std::move(parameters);
    out.push_back(std::move(one));
  }
  return out;
}

/// The paper's Table 2 as it is printed, each experiment with its faults as text. "random" is one level, drawn and
/// kept.
io::Json table2_json() {
  io::Json out = io::Json::array();
  for (const study::Table2Row& row : study::kTable2) {
    const char* const kind = row.level == study::Level::zero       ? "stuck=0V"
                             : row.level == study::Level::minus_3v ? "stuck=-3V"
                             : row.level == study::Level::plus_3v  ? "stuck=3V"
                                                                   : "held=-3V..3V";
    io::Json faults = io::Json::array();
    for (int i = 0; i < 4; ++i) {
      if (row.faulty.has(i)) faults.push_back("a" + std::to_string(i + 1) + ":" + kind);
    }
    io::Json one = io::object({{"number", row.number},
                               {"faulty", row.faulty.bits},
                               {"level", study::to_string(row.level)},
                               {"detected", row.detected},
                               {"isolated", row.isolated.bits}});
    one["faults"] = std::move(faults);
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace

std::string vocabulary() {
  io::Json out;
  out["capacity"] = kCapacity;
  out["states"] = names_of<HealthState>(kStateCount);
  out["events"] = names_of<HealthEvent>(kEventCount);
  out["causes"] = names_of<Cause>(static_cast<int>(kLastCause) + 1);
  out["validities"] = names_of<Validity>(static_cast<int>(Validity::valid) + 1);
  out["flight_events"] = names_of<FlightEvent>(kFlightEvents);
  out["flight_causes"] = names_of<MotionCause>(static_cast<int>(MotionCause::irregular_time) + 1);
  out["flight_validities"] = names_of<ForceValidity>(static_cast<int>(ForceValidity::bounded) + 1);
  out["table2"] = table2_json();
  out["modes"] = names_of<Mode>(kModeCount);
  out["table"] = table();
  out["catalogue"] = catalogue_json();
  io::Json records = io::Json::array();
  for (const std::string& name : record_names()) records.push_back(name);
  out["records"] = std::move(records);
  return out.dump();
}

}  // namespace plumb_web
