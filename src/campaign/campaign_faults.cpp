// [[fault]] of the campaign file: what may happen, how large, to how many sensors at once.
#include <cmath>

#include "../io/text_tools.hpp"
#include "campaign_parts.hpp"
#include "plumb/scenario/fault_text.hpp"

namespace plumb {
namespace campaign {
namespace {

using io::TomlNode;
using io::TomlTable;
using std::size_t;

/// What the texts of faults are read against: volts at 3 V/g0 (the levels that the paper's sensors broke at), of
/// magnetometers at 3 V for as much inside, 39.2266 uT.
scenario::FaultContext volts(io::FieldKind field) {
  scenario::FaultContext context;
  if (field == io::FieldKind::magnetic) context.vector = scenario::FaultContext::Vector::magnetic;
  context.datasheet.size = 1;
  context.datasheet.sensor[0].row.id = make_id("a1");
  context.datasheet.sensor[0].coefficients.scale[0] = 3.0 / kG0_mps2;
  return context;
}

const char* fault_form(io::FieldKind field) {
  return field == io::FieldKind::magnetic
             ? "write a fault without its sensor: stuck=0uT, bias=500nT, random=-50uT..50uT, none"
             : "write a fault without its sensor: stuck=0V, bias=50mg0, random=-3V..3V, none";
}

/// Faults that name another sensor make no sense for a sensor that is drawn; those that lose or swap rows are of the
/// link, which a campaign does not play.
bool can_be_drawn(const scenario::Fault& fault) {
  using scenario::FaultKind;
  switch (fault.kind) {
    case FaultKind::exchange:
    case FaultKind::cross_talk:
    case FaultKind::mirror: return false;
    default: return !scenario::is_delivery(fault.kind, fault.sensor);
  }
}

FaultPlan plan_of(const TomlTable& table, const TomlNode& node, const std::string& text) {
  FaultPlan plan;
  plan.name = text;
  if (text == "none") {
    plan.healthy = true;
    return plan;
  }
  const size_t plus = text.find("+station");
  const std::string body = text.substr(0, plus);
  const std::string duration = plus == std::string::npos ? "" : text.substr(plus);
  // A kind of the whole log says so itself.
  const std::string kind = body.substr(0, body.find('='));
  bool log = false;
  for (int k = 0; k < scenario::kFaultKinds; ++k) {
    const auto which = static_cast<scenario::FaultKind>(k);
    log = log || (scenario::needs_whole_log(which) && kind == scenario::to_string(which));
  }
  const auto fault =
      scenario::parse_fault((log ? "log:" : "a1:") + body + "@station1" + duration, volts(table.field_of()));
  if (!fault) {
    const size_t at = fault.error().find(" Remedy: ");
    table.fail(node.line, "spec", io::in_quotes(text) + ": " + fault.error().substr(0, at),
               at == std::string::npos ? std::string(fault_form(table.field_of())) : fault.error().substr(at + 9));
  }
  if (!can_be_drawn(*fault)) {
    table.fail(
        node.line, "spec",
        io::in_quotes(text) + " cannot be drawn in a campaign: it needs a second sensor or acts on the data link",
        "use a fault of one channel, or turned, ghost, shake, gravity, temperature");
  }
  plan.whole_log = log;
  plan.kind = static_cast<int>(fault->kind);
  plan.magnitude = fault->magnitude;
  plan.upper = fault->upper;
  if (std::isfinite(fault->duration)) plan.duration_stations = fault->duration;
  return plan;
}

std::vector<const TomlNode*> items_of(const TomlTable& table, const char* key) {
  std::vector<const TomlNode*> out;
  const TomlNode* node = table.find(key);
  if (node == nullptr) return out;
  if (node->kind != TomlNode::Kind::array) return {node};
  for (const TomlNode& item : node->items) out.push_back(&item);
  return out;
}

FaultPlan shift(const TomlTable& table, int line, double least, double most) {
  constexpr double kMost = 1e6;
  if (!(least > 0.0) || !(most >= least) || !(most <= kMost)) {
    table.fail(line, "bias_mdb", "must be above 0",
               "give multiples of the minimum detectable bias (MDB): [0.5, 1, 2, 10], or {from = 0.5, to = 100}");
  }
  FaultPlan plan;
  plan.kind = static_cast<int>(scenario::FaultKind::bias_step);
  plan.least_mdb = least;
  plan.most_mdb = most;
  plan.name = "bias " + io::brief(least) + (most > least ? " to " + io::brief(most) : "") + " MDB";
  return plan;
}

FaultFamily family_of(const TomlTable& table) {
  FaultFamily out;
  for (const TomlNode* node : items_of(table, "spec")) {
    const std::string text = table.text_with_unit(*node, "spec", fault_form(table.field_of()));
    out.faults.push_back(plan_of(table, *node, text));
  }
  for (const TomlNode* node : items_of(table, "bias_mdb")) {
    if (node->kind == TomlNode::Kind::table) {
      const TomlTable range(*node, table.file(), table.field("bias_mdb"), {"from", "to"});
      const double from = numbers(range, "from", {0.0}, 0.0, 1e6,
                                  "give a multiple of the minimum detectable bias (MDB), for example 0.5")
                              .front();
      out.faults.push_back(
          shift(table, node->line, from,
                numbers(range, "to", {0.0}, 0.0, 1e6, "give a multiple of the MDB, at least that of `from`").front()));
    } else {
      out.faults.push_back(shift(table, node->line, node->number, node->number));
    }
  }
  if (out.faults.empty()) {
    table.fail(table.line(), "spec", "and bias_mdb are both missing",
               "state the faults: spec = [\"stuck=0V\", \"random=-3V..3V\"] or bias_mdb = [0.5, 1, 2, 10]");
  }
  for (const double count : numbers(table, "sensors", {1.0}, 1.0, kMostFaults,
                                    "give the number of sensors that fail at once: sensors = [1, 2]")) {
    out.sensors.push_back(static_cast<int>(count));
  }
  return out;
}

}  // namespace

std::vector<FaultFamily> read_faults(const TomlTable& top) {
  std::vector<FaultFamily> out;
  for (const TomlTable& table : tables_of(top, "fault", {"spec", "bias_mdb", "sensors"})) {
    out.push_back(family_of(table));
  }
  if (out.empty()) top.fail(0, "fault", "is missing", "add a table [[fault]] with spec = [\"none\", \"stuck=0V\"]");
  return out;
}

}  // namespace campaign
}  // namespace plumb
