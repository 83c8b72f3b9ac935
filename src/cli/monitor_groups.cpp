#include "monitor_groups.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "monitor_report.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/gyro_calibration.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/group_report.hpp"
#include "plumb/session/group_track.hpp"
#include "plumb/session/rate_run.hpp"
#include "read_array.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// Blocks of two groups belong together within so many blocks' length.
constexpr double kTogether = 1.0;

struct Wanted {
  std::string name, calibration;
  const io::ArrayFile* array = nullptr;
  std::optional<io::GyroCalibration> gyros{};  ///< of a rate that is calibrated
};

io::FileError wrong_group(std::string what, std::string remedy) {
  return io::FileError{"--group", 0, "", std::move(what), std::move(remedy), io::ExitCode::usage};
}

std::string names_of(const io::ArrayFile& tool) {
  std::string out;
  for (const io::ArrayFile& one : tool.groups) out += (out.empty() ? "" : ", ") + one.group;
  return out;
}

/// "mag=mag.json": a calibration, which a rate need not have.
io::FileExpected<std::vector<Wanted>> groups_of(const MonitorOptions& options, const io::ArrayFile& tool) {
  std::vector<Wanted> out;
  for (const std::string& text : options.groups) {
    const std::size_t sign = text.find('=');
    Wanted one{text.substr(0, sign), sign == std::string::npos ? "" : text.substr(sign + 1), nullptr};
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
    for (const Wanted& before : out) {
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

/// Two groups that would write the same file.
std::optional<io::FileError> clash_of(const MonitorOptions& options, const std::vector<Wanted>& groups) {
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
  for (const Wanted& group : groups) add(group.name);
  return overwritten(
      files,
      {{"--array", array_file_of(options.array)}, {"--calibration", options.calibration}, {"--log", options.log.path}});
}

std::optional<io::FileError> misuse(const MonitorOptions& o) {
  std::error_code ignored;
  const bool once = o.log.path == "-" || (std::filesystem::exists(o.log.path, ignored) &&
                                          !std::filesystem::is_regular_file(o.log.path, ignored));
  if (once)
    return io::FileError{"--group",
                         0,
                         "",
                         "needs the log several times, and standard input or a pipe can be read once",
                         "record the stream to a file and give it with --log",
                         io::ExitCode::usage};
  if (o.log.follow || o.limits || !o.roll_test.empty() || !o.snapshot_in.empty() || !o.snapshot_out.empty())
    return io::FileError{"--group",
                         0,
                         "",
                         "does not go with --follow, --limits, --roll-test or a snapshot",
                         "run each group by itself: --array TOOL.toml#GROUP",
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

MonitorOptions options_of(const MonitorOptions& tool, const Wanted& group) {
  MonitorOptions out = tool;
  out.groups.clear();
  out.array = tool.array + "#" + group.name;
  out.calibration = group.calibration;
  out.calibrate_first = false;
  out.events = name_for_group(tool.events, group.name);
  out.verdicts = name_for_group(tool.verdicts, group.name);
  out.report = name_for_group(tool.report, group.name);
  out.incidents.directory = name_for_group(tool.incidents.directory, group.name);
  out.motion.clear();
  out.inclination.clear();
  out.host.clear();
  return out;
}

/// The worse of two ways to end.
io::ExitCode worse(io::ExitCode a, io::ExitCode b) {
  if (a == io::ExitCode::done) return b;
  if (b == io::ExitCode::monitor_failed) return b;
  return a;
}

io::FileExpected<void> write_events(const std::string& path, const session::RateRun& run, const SensorArray& array) {
  if (path.empty()) return {};
  std::string text;
  for (const session::RateEvent& event : run.events) text += session::rate_event_json(event, array) + "\n";
  return io::write_file(path, text);
}

io::ExitCode monitor_rates(const MonitorOptions& options, const Wanted& group,
                           const std::vector<session::TrackPoint>& gravity) {
  session::RestTimes rest(gravity);
  const io::FileExpected<session::RateRun> run =
      session::run_rates(*group.array, options.log, &rest, group.gyros ? &*group.gyros : nullptr);
  if (!run) return report(run.error());
  if (const io::FileExpected<void> kept =
          write_events(name_for_group(options.events, group.name), *run, group.array->array);
      !kept)
    return report(kept.error());
  print_now(options.json ? render::rate_run_json(*run, *group.array) : render::rate_run_text(*run, *group.array));
  if (!run->stopped) return run->interrupted ? io::ExitCode::other : io::ExitCode::done;
  print_error("plumb: the log ended in an error; what came before counts.\n");
  return report(run->stop);
}

/// Blocks of the two groups that end together end within this.
double together_s(const std::vector<session::TrackPoint>& a) {
  double shortest_s = 0.0;
  for (std::size_t k = 1; k < a.size(); ++k) {
    const double apart_s = a[k].time_s - a[k - 1].time_s;
    if (apart_s > 0.0 && (shortest_s == 0.0 || apart_s < shortest_s)) shortest_s = apart_s;
  }
  return kTogether * shortest_s;
}

}  // namespace

std::string name_for_group(const std::string& path, const std::string& group) {
  if (path.empty() || path == "-") return path;
  const std::filesystem::path whole(path);
  const std::string name = whole.stem().string() + "-" + group + whole.extension().string();
  return (whole.parent_path() / name).string();
}

io::ExitCode monitor_tool(const MonitorOptions& options) {
  const io::FileExpected<io::ArrayFile> tool = read_array(options.array, "plumb monitor", Serves::lengths);
  if (!tool) return report(tool.error());
  if (const std::optional<io::FileError> wrong = misuse(options)) return report(*wrong);
  const io::FileExpected<std::vector<Wanted>> groups = groups_of(options, *tool);
  if (!groups) return report(groups.error());
  if (const std::optional<io::FileError> clash = clash_of(options, *groups)) return report(*clash);
  session::GroupTrack gravity;
  MonitorOptions own = options;
  own.groups.clear();
  own.report.clear();
  io::ExitCode worst = monitor_array(own, &gravity);
  if (worst == io::ExitCode::usage || worst == io::ExitCode::invalid_input || worst == io::ExitCode::other)
    return worst;  // said already; what the groups would be held against is not there
  std::vector<MonitorOptions> reports = {own};
  for (const Wanted& group : *groups) {
    if (interrupted()) return io::ExitCode::other;
    print_now(options.json ? render::group_heading_json(*group.array) : render::group_heading(*group.array));
    if (group.array->field == io::FieldKind::rate) {
      worst = worse(worst, monitor_rates(options, group, gravity.points()));
      continue;
    }
    session::GroupTrack field;
    MonitorOptions wanted = options_of(own, group);
    worst = worse(worst, monitor_array(wanted, &field));
    const session::DipCheck dip =
        group.array->magnetic.dip_known
            ? session::check_dip(gravity.points(), field.points(), group.array->magnetic, together_s(field.points()))
            : session::DipCheck{};
    print_now(options.json ? render::dip_json(dip, *group.array) : render::dip_text(dip, *group.array));
    if (dip.disagreeing > 0) {
      worst = worse(worst, io::ExitCode::verification_failed);
      wanted.report_doubt = reports.front().report_doubt =
          fmt::format("gravity and the field of {} disagree by the dip", group.name);
    }
    wanted.report = name_for_group(options.report, group.name);
    reports.push_back(std::move(wanted));
  }
  if (options.report.empty()) return worst;
  reports.front().report = options.report;
  for (MonitorOptions& one : reports) {
    one.report_only = true;
    for (std::string* file : {&one.events, &one.verdicts, &one.motion, &one.inclination, &one.incidents.directory})
      file->clear();
    worst = worse(worst, monitor_array(one, nullptr));
  }
  return worst;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
