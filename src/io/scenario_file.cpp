#include "plumb/io/scenario_file.hpp"

#include <exception>
#include <filesystem>

#include "array_parts.hpp"
#include "plumb/io/output_file.hpp"
#include "refusal.hpp"
#include "scenario_parts.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

const std::vector<std::string>& known_sections() {
  static const std::vector<std::string> names = {
      "name",        "array", "tool",     "seed",  "gravity", "rate",  "start", "truth", "sensor_truth", "attitude",
      "temperature", "noise", "rotation", "depth", "fault",   "group", "field", "dip",   "interference"};
  return names;
}

/// Bounds of the length of gravity that an array file may declare.
constexpr double kLeastGravity_mps2 = 9.5;
constexpr double kMostGravity_mps2 = 10.2;

double read_gravity_value(const TomlTable& top, double fallback_mps2) {
  return within(top, "gravity", top.quantity(Quantity::acceleration, "gravity", fallback_mps2), kLeastGravity_mps2,
                kMostGravity_mps2, "give the true length of gravity, 9.5 to 10.2 m/s^2");
}

ArrayFile paper_array(const TomlTable& top) {
  top.need_choice("tool", {"paper"}, "");
  FileExpected<ArrayFile> array =
      parse_array_text(paper_array_text(read_gravity_value(top, kG0_mps2)), "paper_tool.toml");
  if (!array) throw Refusal(array.error());
  return *std::move(array);
}

/// The array file that the scenario names, beside the scenario unless the path is absolute.
ArrayFile named_array(const TomlTable& top, const FieldLookup& lookup) {
  const std::string given = top.text("array", "");
  const std::string path = (std::filesystem::path(top.file()).parent_path() / given).string();
  std::error_code error;
  const auto exists = [&error](const std::string& name) { return std::filesystem::exists(name, error); };
  if (!exists(path) && !exists(path.substr(0, path.rfind('#')))) {
    top.fail(top.line_of("array"), "array", "there is no file " + in_quotes(path),
             "give the path of the array file, relative to the scenario file");
  }
  FileExpected<ArrayFile> array = read_array_file(path, lookup);
  if (!array) throw Refusal(array.error());
  return *std::move(array);
}

/// [array]: what an array file would hold, in the scenario itself.
ArrayFile inline_array(const TomlTable& top, const TomlNode& node, const FieldLookup& lookup) {
  return array_of(node, toml_text(node), top.file(), lookup);
}

ArrayFile read_tool(const TomlTable& top, const FieldLookup& lookup) {
  const TomlNode* array = top.find("array");
  if (array != nullptr && top.has("tool"))
    top.fail(top.line_of("tool"), "tool", "and array both name the sensors", "keep one of the two");
  if (array != nullptr)
    return array->kind == TomlNode::Kind::table ? inline_array(top, *array, lookup) : named_array(top, lookup);
  if (top.has("tool")) return paper_array(top);
  top.fail(0, "array", "is missing",
           "name the sensors: array = \"my_tool.toml\" (an array file), or tool = \"paper\" for the paper's tool");
}

/// What the log could not show, and its reader would therefore take for something else.
void refuse_what_the_log_cannot_hold(const TomlTable& top, const ScenarioSource& source, const ArrayFile& array,
                                     const scenario::Scenario& scenario) {
  const auto refuse = [&top, &source](const char* key, const std::string& what, const std::string& remedy) {
    const TomlNode* value = source.root.find("attitude")->find(key);
    top.fail(value == nullptr ? 0 : value->line, std::string("attitude.") + key, what, remedy);
  };
  if (scenario.tag_stations && array.input.station_column.empty()) {
    refuse("tag_stations", "is true, but the array file names no station column",
           "add station = \"station\" to [input] of the array file, or remove tag_stations");
  }
  if (!array.input.time_column.empty() || array.input.rows == RowKind::stations) return;
  const std::string remedy = "add time = \"t_s\" to [input] of the array file instead of rate, or ";
  if (scenario.rate_hz != array.input.rate_hz) {
    top.fail(top.line_of("rate"), "rate",
             "is " + brief(scenario.rate_hz) + " Hz, but a log of this array has no time column and is read at " +
                 brief(array.input.rate_hz) + " Hz",
             remedy + "remove rate here");
  }
  if (scenario.start_s != 0.0) {
    top.fail(top.line_of("start"), "start", "but a log of this array has no time column", remedy + "remove start");
  }
  if (!scenario.record_motion) {
    refuse("record_motion", "is false, but a log of this array has no time column to show the gaps",
           remedy + "remove record_motion");
  }
}

/// The simulator has the last word; what is said before is said with the line.
void refuse_unplayable(const scenario::Scenario& scenario, const std::string& path) {
  const tl::expected<scenario::Simulator, std::string> playable = scenario::Simulator::make(scenario);
  if (playable) return;
  const auto [what, remedy] = without_remedy(playable.error());
  throw Refusal(FileError{path, 0, "", what, remedy});
}

ScenarioFile parsed(const TomlNode& root, const std::string& path, const FieldLookup& lookup) {
  const TomlTable top(root, path, "", known_sections());
  ScenarioFile out;
  out.path = path;
  const std::string file_name = last_part(path);
  out.name = top.text("name", file_name.substr(0, file_name.rfind('.')));
  out.array = read_tool(top, lookup);
  const ScenarioSource source{root, path, out.array.field, ""};
  const TomlNode* array = top.find("array");
  out.array_inline = array != nullptr && array->kind == TomlNode::Kind::table;
  if (!out.array_inline) out.array_path = top.text("array", "");
  scenario::Scenario& scenario = out.scenario;
  const double declared_hz = out.array.input.rate_hz;
  scenario.seed = read_seed(top, "seed", scenario.seed);
  if (out.array.field == FieldKind::gravity) scenario.gravity_mps2 = read_gravity_value(top, out.array.gravity.g_mps2);
  scenario.rate_hz =
      within(top, "rate", top.quantity(Quantity::rate, "rate", declared_hz > 0.0 ? declared_hz : scenario.rate_hz),
             1e-6, 1e9, "give the samples per second, as in rate = \"100 Hz\"");
  scenario.start_s = within(top, "start", top.quantity(Quantity::time, "start", scenario.start_s), -1e12, 1e12,
                            "give the time of the first sample, as in \"0 s\"");
  read_attitude(source, scenario);
  scenario.tool = read_truth(source, out.array);
  scenario.temperature = read_temperature(source, out.array.datasheet.sensor[0].coefficients.reference_degc);
  scenario.noise = read_noise(source);
  scenario.turning = read_rotation(source);
  scenario.depth = read_depth(source);
  read_sensed(source, out.array, scenario);
  scenario.tag_rolls = scenario.tag_stations && !out.array.input.roll_group_column.empty();
  refuse_what_the_log_cannot_hold(top, source, out.array, scenario);
  out.groups = read_scenario_groups(source, out);
  read_faults(source, out);
  refuse_unplayable(scenario, path);
  for (const ScenarioFile::Group& group : out.groups) refuse_unplayable(group.scenario, path);
  return out;
}

}  // namespace

FileExpected<ScenarioFile> parse_scenario_text(const std::string& text, const std::string& path,
                                               const FieldLookup& lookup) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    return tl::unexpected<FileError>(
        FileError{path, 0, "", "the file is empty",
                  "name the array to simulate: array = \"my_tool.toml\" (or tool = \"paper\") and [attitude] with "
                  "its law"});
  }
  try {
    const bool json = text[text.find_first_not_of(" \t\r\n")] == '{';
    const FileExpected<TomlNode> root = json ? parse_json_tree(text, path) : parse_toml(text, path);
    if (!root) return tl::unexpected<FileError>(root.error());
    return parsed(*root, path, lookup);
  } catch (const Refusal& refusal) {
    return tl::unexpected<FileError>(refusal.error());
  } catch (const std::exception& error) {
    return tl::unexpected<FileError>(
        FileError{path, 0, "", error.what(), "report this as a bug of plumb", ExitCode::other});
  }
}

FileExpected<ScenarioFile> read_scenario(const std::string& path, const FieldLookup& lookup) {
  const FileExpected<std::string> text = read_file(path);
  if (!text) return tl::unexpected<FileError>(text.error());
  return parse_scenario_text(*text, path, lookup);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
