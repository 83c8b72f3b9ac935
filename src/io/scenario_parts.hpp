/// The parts of `parse_scenario_text`, one function per section (private to src/io). They throw Refusal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "plumb/io/scenario_file.hpp"
#include "toml_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// What every section is read from.
struct ScenarioSource {
  const TomlNode& root;  ///< of the file, or of one of its [[group]]s
  const std::string& file;
  FieldKind field = FieldKind::gravity;  ///< that the sensors measure: units of accelerations
  std::string prefix;                    ///< of its sections in messages: "group[1]."
};

/// [attitude]: the law, and the times and the shaking around it. `out.rate_hz` must be set.
void read_attitude(const ScenarioSource& source, scenario::Scenario& out);
/// [truth] and [[sensor_truth]]: what the sensors of the array really are.
scenario::Tool read_truth(const ScenarioSource& source, const ArrayFile& array);

/// [temperature], [noise], [rotation], [depth].
scenario::TemperatureLaw read_temperature(const ScenarioSource& source, double reference_degc);
scenario::NoiseLaw read_noise(const ScenarioSource& source);
scenario::Turning read_rotation(const ScenarioSource& source);
scenario::DepthLaw read_depth(const ScenarioSource& source);

/// [interference]; in the inside unit of magnetic groups.
scenario::Interference read_interference(const ScenarioSource& source);

/// The true length and the dip of the field of a magnetic group, and what else makes `out` one of `array`'s kind.
/// `source` is the file where it is of this group alone, else its [[group]]. Attitude, rate and times must be set.
void read_sensed(const ScenarioSource& source, const ArrayFile& array, scenario::Scenario& out);
/// A scenario for each group of a whole tool, from that of its accelerometers, without faults.
std::vector<ScenarioFile::Group> read_scenario_groups(const ScenarioSource& source, const ScenarioFile& tool);
/// Every [[fault]], each with the sensors that it names.
void read_faults(const ScenarioSource& source, ScenarioFile& out);

// ---- what the sections share ---------------------------------------------------------------------

/// A section that may be omitted; then it is an empty table.
TomlTable section_of(const ScenarioSource& source, const char* name, const std::vector<std::string>& known);
/// The tables of [[name]], none where it is omitted; each with its field name, "fault[2]".
std::vector<TomlTable> tables_of(const ScenarioSource& source, const char* name, const std::vector<std::string>& known);
/// Refuses a key that the chosen law does not use.
void refuse_unused(const TomlTable& table, const std::string& law, const std::vector<std::string>& used);
/// The value, refused unless it lies within the bounds.
double within(const TomlTable& table, const char* key, double value, double low, double high,
              const std::string& remedy);
bool read_flag(const TomlTable& table, const char* key, bool fallback);
/// From 0 to 2^64 - 1; what TOML's integers cannot hold stands in quotes.
std::uint64_t read_seed(const TomlTable& table, const char* key, std::uint64_t fallback);

/// Texts of the scenario module end in "... Remedy: ...": what was found, and the remedy.
std::pair<std::string, std::string> without_remedy(const std::string& text);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
