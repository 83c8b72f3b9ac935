#include "calibrate_gyros.hpp"

#include <algorithm>

#include "plumb/geomagnetic/field_reference.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/render/gyro_fit_report.hpp"
#include "read_array.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr const char* kWithoutDelay = "delay";
constexpr const char* kWithoutForce = "g-sensitivity";

bool among(const std::vector<std::string>& list, const char* what) {
  return std::find(list.begin(), list.end(), what) != list.end();
}

std::optional<io::FileError> gyro_misuse(const GyroOptions& own, const CalibrateGyrosOptions& options) {
  for (const std::string& one : own.without) {
    if (one != kWithoutDelay && one != kWithoutForce)
      return io::FileError{"--without",
                           0,
                           "",
                           "\"" + one + "\" is nothing that a fit can leave out",
                           "give delay or g-sensitivity",
                           io::ExitCode::usage};
  }
  if (!own.turns.empty() && options.calibration.empty())
    return io::FileError{"--turns",
                         0,
                         "",
                         "needs calibrated accelerometers, by which gravity turns, and none are given",
                         "calibrate them first (plumb calibrate --array " + array_file_of(options.array) +
                             " --log), then give --calibration CAL.json",
                         io::ExitCode::usage};
  std::vector<std::string> logs = own.turns;
  logs.insert(logs.end(), own.held_out.begin(), own.held_out.end());
  logs.push_back(options.log.path);
  if (among(logs, "-"))
    return io::FileError{
        "--motion",         0, "", "is read twice, and standard input can be read once", "record the log to a file",
        io::ExitCode::usage};
  if (among(own.held_out, options.log.path.c_str()))
    return io::FileError{"--held-out",       0, "", "is the log that is fitted", "give another log of the same gyros",
                         io::ExitCode::usage};
  return std::nullopt;
}

}  // namespace

const char* GyroOptions::given() const {
  return !turns.empty() ? "--turns" : !held_out.empty() ? "--held-out" : !without.empty() ? "--without" : nullptr;
}

void add_gyro_options(const Options& command, GyroOptions& options) {
  command
      .add_option("--turns", options.turns,
                  "gyros: a log in which the tool turns from rest to rest in many attitudes: gravity's turns tell the "
                  "scale, shear and turn that all gyros share; may be given several times")
      .type_name("LOG.csv");
  command
      .add_option("--held-out", options.held_out,
                  "gyros: a log of the same gyros that judges the fit, in the place of the last third of --motion; may "
                  "be given several times")
      .type_name("LOG.csv");
  command
      .add_option("--without", options.without,
                  "gyros: leave this out of the fit, its bound in the array file covers it; may be given several times")
      .type_name("delay|g-sensitivity");
}

io::ExitCode run_calibrate_gyros(const GyroOptions& own, const CalibrateGyrosOptions& options) {
  const std::string file = array_file_of(options.array);
  std::vector<NamedFile> to_read = {
      {"--array", file}, {"--calibration", options.calibration}, {"--motion", options.log.path}};
  for (const std::string& path : own.turns) to_read.push_back({"--turns", path});
  for (const std::string& path : own.held_out) to_read.push_back({"--held-out", path});
  if (const std::optional<io::FileError> clash = overwritten({{"--out", options.out}}, to_read)) return report(*clash);
  if (const std::optional<io::FileError> wrong = gyro_misuse(own, options)) return report(*wrong);
  const io::FileExpected<io::ArrayFile> group = io::read_array_file(options.array, geomagnetic::lookup);
  if (!group) return report(group.error());
  if (group->field != io::FieldKind::rate)
    return report(io::FileError{options.array, 0, "",
                                "plumb calibrate --motion does not serve a group of magnetometers",
                                "give --log with a log of still attitudes", io::ExitCode::usage});
  const io::FileExpected<io::ArrayFile> tool = read_array(file, "plumb calibrate --motion", Serves::gravity);
  if (!tool) return report(tool.error());
  session::GyroCommissioningLogs logs{options.log,
                                      own.held_out,
                                      own.turns,
                                      nullptr,
                                      !among(own.without, kWithoutDelay),
                                      !among(own.without, kWithoutForce)};
  std::optional<io::CalibrationFile> accelerometers;
  if (!options.calibration.empty()) {
    io::FileExpected<io::CalibrationFile> read = io::read_calibration(options.calibration, *tool);
    if (!read) return report(read.error());
    accelerometers = *std::move(read);
    logs.accelerometers = &*accelerometers;
  }
  watch_interrupts();
  io::FileExpected<session::GyroCommissioning> run = session::run_gyro_commissioning(*tool, *group, logs);
  if (!run) return report(run.error());
  print(options.json ? render::gyro_fit_json(*run, *group).dump(1) + "\n" : render::gyro_fit_text(*run, *group));
  if (!run->refusal.empty()) {
    print_error("plumb: the calibration of gyros was not accepted: " + run->refusal + ". " + options.out +
                " was not written. Remedy: " + run->next + ".\n");
    return interrupted() ? io::ExitCode::other : io::ExitCode::not_accepted;
  }
  run->found.date = options.date;
  run->found.serial = options.serial;
  if (const auto saved = io::write_gyro_calibration(options.out, run->found, *group); !saved)
    return report(saved.error());
  if (!options.json && options.out != "-")
    print("written: " + options.out + "\nnext: plumb monitor --array " + file + " --calibration ACC.json --group " +
          group->group + "=" + options.out + " --log LOG.csv\n");
  if (!interrupted()) return io::ExitCode::done;
  print_error("plumb: interrupted; the fit uses the rows read before the interruption.\n");
  return io::ExitCode::other;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
