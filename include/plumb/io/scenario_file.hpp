/// The scenario file (TOML): what `plumb simulate` plays. docs/scenario-file.md lists every key.
#pragma once

#include <string>

#include "plumb/io/array_file.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/scenario/fault_text.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

struct ScenarioFile {
  /// What the sensors of a [[group]] of the array file go through, in the same attitudes at the same times.
  struct Group {
    scenario::Scenario scenario;
    std::vector<std::size_t> fault_table;
  };

  std::string path;
  std::string name;
  std::string array_path;  ///< as the scenario names it, relative to the scenario file; empty: inline or tool = "paper"
  bool array_inline = false;  ///< [array] in the scenario itself holds what an array file would
  ArrayFile array;            ///< read from there, or the one of the paper's tool: what sensors, how the log looks
  scenario::Scenario scenario;
  std::vector<std::size_t> fault_table;  ///< the [[fault]], counted from 1, that each fault of `scenario` is of
  std::vector<Group> groups;             ///< of `array.groups`, in their order
};

/// Refuses, with file, line, field and remedy, all that cannot be played and all that the log's layout
/// could not show (another sampling rate than the array file declares, say).
/// `lookup` as in `read_array_file`.
FileExpected<ScenarioFile> read_scenario(const std::string& path, const FieldLookup& lookup = {});

/// The same from text, TOML or (where it begins with a brace) JSON; `path` is used in messages, and to find the array
/// file beside it.
FileExpected<ScenarioFile> parse_scenario_text(const std::string& text, const std::string& path,
                                               const FieldLookup& lookup = {});

/// The text that reads back as the identical scenario, bit for bit, every drawn error of the sensors
/// spelled out. The tool's datasheet must be that of `file.array`; it is not written, only named,
/// and neither are what its groups go through.
std::string scenario_text(const ScenarioFile& file);
/// The same in JSON: the tables and keys of the TOML, which `parse_scenario_text` reads alike.
std::string scenario_json(const ScenarioFile& file);
/// JSON where the name ends in .json, else TOML.
FileExpected<void> write_scenario(const std::string& path, const ScenarioFile& file);

/// The array file of the paper's tool (`scenario::paper_datasheet`), as a person would write it: volts,
/// columns t_s and station.
std::string paper_array_text(double gravity_mps2);
/// The same for the tool of six sensors (`scenario::hexad_datasheet`).
std::string hexad_array_text(double gravity_mps2);

/// What the text of a fault is read against, for the log that this array file describes.
scenario::FaultContext fault_context(const ArrayFile& array);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
