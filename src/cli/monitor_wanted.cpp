#include "monitor_wanted.hpp"

#include <utility>

#include "monitor_groups.hpp"
#include "monitor_report.hpp"
#include "plumb/io/calibration_file.hpp"
#include "read_array.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

io::FileError wrong_group(std::string what, std::string remedy) {
  return io::FileError{"--group", 0, "", std::move(what), std::move(remedy), io::ExitCode::usage};
}

std::string names_of(const io::ArrayFile& tool) {
  std::string out;
  for (const io::ArrayFile& one : tool.groups) out += (out.empty() ? "" : ", ") + one.group;
  return out;
}

}  // namespace

io::FileExpected<std::vector<WantedGroup>> wanted_groups(const MonitorOptions& options, const io::ArrayFile& tool) {
  std::vector<WantedGroup> out;
  for (const std::string& text : options.groups) {
    const std::size_t sign = text.find('=');
    WantedGroup one{text.substr(0, sign), sign == std::string::npos ? "" : text.substr(sign + 1), nullptr};
    for (const io::ArrayFile& group : tool.groups) one.array = group.group == one.name ? &group : one.array;
    if (one.array == nullptr)
      return tl::unexpected<io::FileError>(wrong_group(
          options.array + " has no group \"" + one.name + "\"",
          tool.groups.empty() ? "add a [[group]] to the array file" : "name one of its groups: " + names_of(tool)));
    const bool rate = one.array->field == io::FieldKind::rate;
    if (!rate && one.calibration.empty())
      return tl::unexpected<io::FileError>(
          wrong_group("\"" + one.name + "\" has no calibration", "write --group " + one.name +
                                                                     "=CAL.json, with what plumb calibrate --array " +
                                                                     options.array + "#" + one.name + " wrote"));
    for (const WantedGroup& before : out) {
      if (before.name == one.name)
        return tl::unexpected<io::FileError>(wrong_group("\"" + one.name + "\" is given twice", "give it once"));
    }
    if (rate && !one.calibration.empty()) {
      io::FileExpected<io::GyroCalibration> gyros = io::read_gyro_calibration(one.calibration, *one.array);
      if (!gyros) return tl::unexpected<io::FileError>(gyros.error());
      one.gyros = *std::move(gyros);
    }
    if (!rate) {
      const io::FileExpected<io::CalibrationFile> calibration = io::read_calibration(one.calibration, *one.array);
      if (!calibration) return tl::unexpected<io::FileError>(calibration.error());
    }
    out.push_back(std::move(one));
  }
  return out;
}

std::optional<io::FileError> groups_clash(const MonitorOptions& options, const std::vector<WantedGroup>& groups) {
  std::vector<NamedFile> files;
  const auto add = [&](const std::string& group) {
    for (const auto& [option, path] : {std::pair<const char*, std::string>{"--events", options.events},
                                       {"--verdicts", options.verdicts},
                                       {"--motion", options.motion},
                                       {"--inclination", options.inclination},
                                       {"--report", options.report},
                                       {"--report", health_data_path(options.report)}}) {
      if (!path.empty()) files.push_back({option, group.empty() ? path : name_for_group(path, group)});
    }
  };
  add("");
  std::vector<NamedFile> read = {
      {"--array", array_file_of(options.array)}, {"--calibration", options.calibration}, {"--log", options.log.path}};
  for (const WantedGroup& group : groups) {
    add(group.name);
    read.push_back({"--group", group.calibration});
  }
  return overwritten(files, read);
}

std::optional<io::FileError> groups_misuse(const MonitorOptions& o) {
  if (o.limits || !o.roll_test.empty() || !o.snapshot_in.empty() || !o.snapshot_out.empty())
    return io::FileError{"--group",
                         0,
                         "",
                         "does not go with --limits, --roll-test or a snapshot",
                         "leave --group out for these; magnetometers by themselves: --array TOOL.toml#GROUP",
                         io::ExitCode::usage};
  for (const std::string* path : {&o.events, &o.verdicts, &o.motion, &o.inclination}) {
    if (*path == "-")
      return io::FileError{"--group",
                           0,
                           "",
                           "writes one file a group, and standard output is one",
                           "name files; --json writes all groups to standard output",
                           io::ExitCode::usage};
  }
  return std::nullopt;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
