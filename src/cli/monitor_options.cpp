#include "monitor_options.hpp"

#include "plumb/session/days_since.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr const char* kMonitorNotes =
    "States: nominal (all sensors agree), suspect (a limit was exceeded, or the sensors are not yet validated; output\n"
    "unconfirmed), isolated (a faulty sensor is excluded, the rest still check one another), degraded (no\n"
    "redundancy left, usually three sensors), failed (too few sensors or no bound: do not use the output).\n"
    "One attitude rarely isolates the faulty sensor: plumb waits until the tool has turned.\n\n"
    "Examples:\n"
    "  plumb monitor --array tool.toml --calibration cal.json --log run.csv --events events.jsonl\n"
    "  tail -n +1 -f run.csv | plumb monitor --array tool.toml --calibration cal.json --log - --json\n\n"
    "Units: time in s, inclination in deg (0 = tool axis z points down). `statistic` and `limit` share a unit:\n"
    "standard deviations for parity and norm, m/s^2 for mae; an alarm is statistic > limit.\n"
    "With [monitor] mode = \"paper\" in the array file the run follows the paper's algorithm instead, for comparison:\n"
    "one limit delta_f (0.05 g0) for the length of gravity by all sensors and then by every three of them. No bound "
    "on\n"
    "the error. The calibration must hold the paper's own fits (plumb calibrate --paper).\n"
    "--host plays the host of an instrument: \"61s reset a2,a4 key 0x706c756d62\" asks at t = 61 s for a reset that\n"
    "returns a2 and a4 to service, with the reset_key of the array file (of a chip only the axes that are named: name\n"
    "all of them, the others stay excluded); \"36s recalibrate\" for new biases and\n"
    "scales. A time before the first row, a negative one too, counts as asked for before that row.\n"
    "Requests that the monitor refuses are listed on standard error.\n"
    "--snapshot-in continues from the end of a run that wrote --snapshot-out: exclusions, suspicions, adopted\n"
    "coefficients and `failed` are kept, as over a power cycle. The snapshot must be of the same array file and\n"
    "calibration; both options may name one file.\n"
    "--roll-test validates beforehand: a recording of the tool at several attitudes, with the columns of [input], "
    "goes\n"
    "through the monitor before the log. One line on standard error says which sensors it validated, or which turn is\n"
    "still missing; the run goes on from there as from a snapshot, by the log's own time. Nothing of the recording is\n"
    "valid in the run. Suspicions, exclusions and `failed` of the roll test are kept.\n"
    "--follow waits at the end of the log for what is appended to it, as on standard input, until Ctrl-C; the "
    "snapshot\n"
    "and the files are complete then too.\n"
    "--calibrate-first: no output is valid until the monitor has seen about 20 still attitudes in all directions and\n"
    "accepted its own fit; the exit code is 4 if the log ends before that. The fit removes constant errors of a\n"
    "sensor, so that the monitor detects only changes after it.\n"
    "--report grades every station green, orange or red and answers whether the tool may be surveyed with; it keeps\n"
    "stations and events, not samples, so that it may end a run of any length. Name the depth column in [input].\n"
    "With [motion] in the array file the sensors are judged while the tool moves too (docs/motion.md): events and\n"
    "summary say which ones, and --motion writes the specific force with its bound, sample by sample.\n"
    "--incidents keeps the rows before and after every change, each incident in a file that is a log again, and a "
    "list\n"
    "of them in incidents.jsonl: `plumb monitor --log DIR/incident-0001.csv` plays it.\n"
    "--group watches the magnetometers or the gyros of the tool too, in the same pass of a file or a stream, each "
    "group\n"
    "with its summary and with files of its own (events-mag.jsonl), and holds the direction of the field against that\n"
    "of gravity, by the dip; exit code 6 where they disagree. With three accelerometers left the dip is their second\n"
    "reference. The page of --report begins with all groups. --array TOOL.toml#mag watches one group alone.\n"
    "--limits reads no log: it prints the limits of the monitor with this array file and calibration, how many\n"
    "samples a block can use, and which faults a given delta_f misses.\n"
    "--json prints one JSON object per change, then one with the key \"summary\".\n"
    "Ctrl-C ends the run in order: files are complete up to then, the summary is printed, exit code 1.\n\n";

}  // namespace

void add_monitor_options(const Options& command, MonitorOptions& options) {
  command.add_option("--array", options.array, "the array file: what the sensors are, how the log looks")
      .required()
      .type_name("ARRAY.toml");
  command.add_option("--calibration", options.calibration, "what `plumb calibrate` wrote for this array")
      .type_name("CAL.json");
  command.add_flag("--calibrate-first", options.calibrate_first,
                   "there is no calibration: the monitor makes its own from the log's first stations");
  command
      .add_option("--log", options.log.path,
                  "the log, CSV with a header row or a ULog that plumb wrote; `-` (default) reads standard input")
      .type_name("LOG.csv|-");
  command.add_flag("--follow", options.log.follow, "at the end of the log wait for the rows that are appended to it");
  command
      .add_option("--events", options.events,
                  "write one JSON line per change; `-` = standard output, instead of the table")
      .type_name("E.jsonl");
  command.add_option("--verdicts", options.verdicts, "write one JSON line per block at rest; `-` = standard output")
      .type_name("V.jsonl");
  command.add_flag("--every-sample", options.every_sample, "with --verdicts: one line per sample instead");
  command
      .add_option("--report", options.report,
                  "write the tool health report: a page, and its data as JSON beside it; docs/health-report.md")
      .type_name("R.html");
  command
      .add_option("--motion", options.motion,
                  "write one CSV row per sample: the specific force in motion, its bound, who is isolated; `-` = "
                  "standard output")
      .type_name("M.csv");
  command
      .add_option("--inclination", options.inclination,
                  "write one CSV row per window: the inclination while the tool moves, between two limits; `-` = "
                  "standard output")
      .type_name("I.csv");
  command
      .add_option(
          "--incidents", options.incidents.directory,
          "record the rows before and after every change of state and every finding in motion, in this directory")
      .type_name("DIR");
  command
      .add_option("--incident-rows", options.incidents.rows,
                  "with --incidents: rows before a change, and after it; 1000 by default")
      .told_range(1, session::IncidentRecorder::kMostRows)
      .type_name("N");
  command.add_option("--snapshot-in", options.snapshot_in, "go on from this snapshot instead of from power-on")
      .type_name("S.bin");
  command
      .add_option("--roll-test", options.roll_test,
                  "validate the sensors by this recorded roll test first; its columns are those of the log")
      .type_name("ROLL.csv");
  command.add_option("--snapshot-out", options.snapshot_out, "write the state of the monitor at the end of the run")
      .type_name("S.bin");
  command
      .add_option("--host", options.host, "a request of the host to the monitor, as below; may be given several times")
      .type_name("REQUEST");
  command
      .add_option("--group", options.groups,
                  "watch this [[group]] of the array file as well, by its own calibration; gyros without one by their "
                  "datasheet; may be "
                  "given several times")
      .type_name("NAME[=CAL.json]");
  add_bad_row_option(command, options.log.on_bad_row);
  command
      .add_option("--date", options.date,
                  "date of the run, for the drift since the calibration (stability_per_day); today by default")
      .check(session::date_refusal)
      .type_name("YYYY-MM-DD");
  command.add_flag("--limits", options.limits, "print the limits of the tests and what they can detect; read no log");
  command.add_flag("--json", options.json, "JSON lines instead of the table, for machines");
  command.footer(kMonitorNotes + exit_codes_help());
}

std::optional<io::FileError> follow_misuse(const MonitorOptions& options) {
  if (!options.log.follow || options.log.path != "-") return std::nullopt;
  return io::FileError{"--follow",
                       0,
                       "",
                       "standard input is always followed until it is closed",
                       "leave out --follow, or name the growing file with --log",
                       io::ExitCode::usage};
}

std::optional<io::FileError> calibration_misuse(const MonitorOptions& options) {
  if (options.calibrate_first == options.calibration.empty()) {
    if (!options.calibrate_first || !options.limits) return std::nullopt;
    return io::FileError{"--limits",
                         0,
                         "",
                         "needs a calibrated array, and --calibrate-first says that there is no calibration yet",
                         "name one with --calibration",
                         io::ExitCode::usage};
  }
  return io::FileError{"--calibration",
                       0,
                       "",
                       options.calibrate_first ? "and --calibrate-first exclude each other"
                                               : "is missing, and without a calibration no output can be valid",
                       "give the calibration file with --calibration (plumb calibrate writes it), or let the monitor "
                       "calibrate itself with --calibrate-first",
                       io::ExitCode::usage};
}

std::optional<io::FileError> snapshot_misuse(const MonitorOptions& options, const io::ArrayFile& array) {
  const NamedFile named[] = {{"--snapshot-in", options.snapshot_in}, {"--snapshot-out", options.snapshot_out}};
  for (const NamedFile& file : named) {
    if (file.path.empty()) continue;
    if (file.path == "-") {
      return io::FileError{file.option,        0, "", "a snapshot needs a file; a pipe cannot hold it", "name a file",
                           io::ExitCode::usage};
    }
    if (array.monitor.mode == MonitorMode::paper) {
      return io::FileError{file.option,
                           0,
                           "",
                           "the paper's algorithm (mode = \"paper\") has no snapshot",
                           "leave the option out, or set mode = \"plumb\" in " + array.path,
                           io::ExitCode::usage};
    }
  }
  return std::nullopt;
}

std::optional<io::FileError> roll_test_misuse(const MonitorOptions& options, const io::ArrayFile& array) {
  if (options.roll_test.empty()) return std::nullopt;
  const auto refused = [](const std::string& what, const std::string& remedy) {
    return io::FileError{"--roll-test", 0, "", what, remedy, io::ExitCode::usage};
  };
  if (options.roll_test == "-") return refused("needs a file; a pipe cannot be read before the log", "name a file");
  if (!options.snapshot_in.empty())
    return refused("and --snapshot-in both set the start of the run", "leave out one of the two");
  if (options.calibrate_first)
    return refused("needs a calibrated tool, and --calibrate-first says that there is no calibration yet",
                   "name a calibration with --calibration, or leave --roll-test out");
  if (options.limits) return refused("has no effect with --limits, which reads no log", "leave out one of the two");
  if (array.monitor.mode == MonitorMode::paper)
    return refused(
        "validates the sensors for plumb's monitor; the paper's algorithm (mode = \"paper\") has no validation",
        "leave the option out, or set mode = \"plumb\" in " + array.path);
  return std::nullopt;
}

std::optional<io::FileError> motion_misuse(const MonitorOptions& options) {
  if (options.motion == "-" && options.inclination == "-")
    return io::FileError{"--inclination",
                         0,
                         "",
                         "is \"-\", and --motion writes to standard output already",
                         "name a file for one of the two",
                         io::ExitCode::usage};
  if ((options.motion.empty() && options.inclination.empty()) || !options.limits) return std::nullopt;
  return io::FileError{options.motion.empty() ? "--inclination" : "--motion",
                       0,
                       "",
                       "describes a run, and --limits runs nothing",
                       "leave out one of the two",
                       io::ExitCode::usage};
}

std::optional<io::FileError> incidents_misuse(const MonitorOptions& options) {
  if (options.incidents.directory.empty() || !options.limits) return std::nullopt;
  return io::FileError{
      "--incidents",      0, "", "describes a run, and --limits runs nothing", "leave out one of the two",
      io::ExitCode::usage};
}

io::FileError limits_of_paper(const io::ArrayFile& array) {
  return io::FileError{
      array.path,
      0,
      "monitor.mode",
      "is \"paper\", whose only limit is delta_f; --limits prints the limits of plumb's own tests",
      "leave out --limits, or set mode = \"plumb\" with the same delta_f to see which faults it misses",
      io::ExitCode::usage};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
