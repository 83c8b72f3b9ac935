// Groups of another field in a scenario: what they sense of the attitudes, and which sensors a fault means.
#include <algorithm>
#include <string_view>

#include "plumb/io/hash.hpp"
#include "refusal.hpp"
#include "scenario_parts.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr double kLeastTrue_ut = 20.0, kMostTrue_ut = 70.0;

/// Keys of a field that the sensors do not measure.
void refuse_keys(const TomlTable& table, std::initializer_list<const char*> keys, FieldKind field) {
  for (const char* const key : keys) {
    if (table.has(key))
      table.fail(
          table.line_of(key), key, std::string("means nothing to ") + units_of(field).sensor + "s",
          field == FieldKind::gravity ? "write it into the [[group]] of the magnetometers, or remove it" : "remove it");
  }
}

void read_field(const TomlTable& table, const ScenarioSource& source, const ArrayFile& array, scenario::Scenario& out) {
  out.sensed = scenario::Sensed::magnetic;
  out.gravity_mps2 = within(table, "field", table.quantity(Quantity::acceleration, "field", array.gravity.g_mps2),
                            kLeastTrue_ut * kInside_per_ut, kMostTrue_ut * kInside_per_ut,
                            "give the true length of the magnetic field, 20 to 70 uT");
  if (!table.has("dip") && !array.magnetic.dip_known)
    table.fail(0, "dip", "is missing, and the array file does not state it",
               "give the angle of the field below the horizon: dip = \"72 deg\", here or in [group.reference] of the "
               "array file");
  out.dip_rad = within(table, "dip", table.quantity(Quantity::angle, "dip", array.magnetic.dip_rad), -kPi / 2.0,
                       kPi / 2.0, "give the angle of the field below the horizon, -90 to 90 deg");
  out.interference = read_interference(source);
}

/// The table of [[group]] for each group of the array; an empty one where there is none.
std::vector<const TomlNode*> tables_by_group(const ScenarioSource& source, const ArrayFile& tool) {
  std::vector<const TomlNode*> out(tool.groups.size(), nullptr);
  std::vector<std::string> names;
  for (const ArrayFile& group : tool.groups) names.push_back(group.group);
  for (const TomlTable& table :
       tables_of(source, "group", {"name", "field", "dip", "truth", "sensor_truth", "noise", "interference"})) {
    const std::string name = table.need_text("name", "name the group that this table describes: name = \"mag\"");
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end())
      table.fail(
          table.line_of("name"), "name", "the array file has no group " + in_quotes(name),
          names.empty() ? "remove this table, or add the [[group]] to the array file" : "groups: " + joined(names));
    const TomlNode*& node = out[static_cast<std::size_t>(at - names.begin())];
    if (node != nullptr)
      table.fail(table.line_of("name"), "name", in_quotes(name) + " has two tables", "join them into one");
    node = &table.node();
  }
  return out;
}

/// Whose sensor a fault names: 0 is the tool itself, k + 1 its group k.
std::size_t whose(const TomlTable& table, const std::string& text, const ArrayFile& tool) {
  const std::string id(trimmed(std::string_view(text).substr(0, text.find(':'))));
  const auto has = [&id](const ArrayFile& array) {
    for (int i = 0; i < array.array.size(); ++i) {
      if (id == array.array.row(i).id.data()) return true;
    }
    return false;
  };
  std::size_t found = 0;
  bool many = false, known = has(tool);
  for (std::size_t k = 0; k < tool.groups.size(); ++k) {
    if (!has(tool.groups[k])) continue;
    many = many || known;
    known = true;
    found = k + 1;
  }
  if (many)
    table.fail(table.line_of("spec"), "spec", in_quotes(id) + " is a sensor of two groups of the tool",
               "give the sensors of the array file ids of their own");
  return found;
}

/// Rows that are lost or late are so in all columns, and so is a wrong temperature.
bool of_every_column(const scenario::Fault& fault) {
  return scenario::is_delivery(fault.kind, fault.sensor) || fault.kind == scenario::FaultKind::temperature;
}

}  // namespace

void read_sensed(const ScenarioSource& source, const ArrayFile& array, scenario::Scenario& out) {
  const TomlTable table(
      source.root, source.file, source.prefix.substr(0, source.prefix.rfind('.')),
      {"name", "field", "dip", "truth", "sensor_truth", "noise", "interference", "array", "tool", "seed", "gravity",
       "rate", "start", "attitude", "temperature", "rotation", "depth", "fault", "group"},
      source.field);
  if (array.field == FieldKind::magnetic) {
    read_field(table, source, array, out);
  } else {
    refuse_keys(table, {"field", "dip", "interference"}, array.field);
  }
  if (array.field == FieldKind::rate) out.sensed = scenario::Sensed::rate;
  if (array.field == FieldKind::gravity) return;
  refuse_keys(table, {"gravity"}, array.field);
  out.part = fnv1a(array.group.data(), array.group.size());
  out.depth.gravity_per_s2 = 0.0;
}

std::vector<ScenarioFile::Group> read_scenario_groups(const ScenarioSource& source, const ScenarioFile& tool) {
  static const TomlNode nothing = [] {
    TomlNode node;
    node.kind = TomlNode::Kind::table;
    return node;
  }();
  const std::vector<const TomlNode*> nodes = tables_by_group(source, tool.array);
  std::vector<ScenarioFile::Group> out;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const ArrayFile& array = tool.array.groups[k];
    const ScenarioSource own{nodes[k] == nullptr ? nothing : *nodes[k], source.file, array.field,
                             "group " + array.group + "."};
    ScenarioFile::Group group;
    group.scenario = tool.scenario;
    group.scenario.vibration_mps2 = group.scenario.rest_vibration_mps2 = 0.0;
    group.scenario.tool = read_truth(own, array);
    group.scenario.noise = read_noise(own);
    read_sensed(own, array, group.scenario);
    out.push_back(std::move(group));
  }
  return out;
}

void read_faults(const ScenarioSource& source, ScenarioFile& out) {
  struct Named {
    std::size_t whose, table;
    scenario::Fault fault;
  };
  std::vector<Named> all;
  for (const TomlTable& table : tables_of(source, "fault", {"spec"})) {
    const std::string text = table.need_text("spec", "write the fault and its onset: spec = \"a2:stuck=0V@12s\"");
    const std::size_t owner = whose(table, text, out.array);
    const scenario::FaultContext context = fault_context(owner == 0 ? out.array : out.array.groups[owner - 1]);
    const tl::expected<std::vector<scenario::Fault>, std::string> named = scenario::parse_faults(text, context);
    const std::size_t number = all.empty() ? 1 : all.back().table + 1;
    if (!named) {
      const auto [what, remedy] = without_remedy(named.error());
      table.fail(table.line_of("spec"), "spec", what, remedy);
    }
    for (const scenario::Fault& fault : *named) all.push_back({owner, number, fault});
  }
  // The link loses the same rows of every group: what it draws goes by the position of the fault.
  if (!out.groups.empty())
    std::stable_partition(all.begin(), all.end(), [](const Named& one) { return of_every_column(one.fault); });
  for (const Named& one : all) {
    if (one.whose == 0) {
      out.scenario.faults.push_back(one.fault);
      out.fault_table.push_back(one.table);
    }
    for (std::size_t k = 0; k < out.groups.size(); ++k) {
      if (one.whose != k + 1 && !of_every_column(one.fault)) continue;
      out.groups[k].scenario.faults.push_back(one.fault);
      out.groups[k].fault_table.push_back(one.table);
    }
  }
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
