// plumb monitor: a log or a live stream through the health monitor.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "calibration_age.hpp"
#include "monitor_options.hpp"
#include "monitor_outputs.hpp"
#include "monitor_pipeline.hpp"
#include "monitor_summary.hpp"
#include "plumb/report/monitor_limits.hpp"
#include "roll_test.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr const char* kMonitorAbout =
    "Watch an array of accelerometers: read a log (or a live stream) sample by sample, say which sensors may\n"
    "be believed, which way is down, and within what bound. A table line is printed at every change of state;\n"
    "a summary follows at the end. A sensor is excluded only when no other explanation of the data is left.";
constexpr const char* kMonitorNotes =
    "States: nominal (all sensors agree), suspect (a limit was crossed, or trust is not yet earned; output\n"
    "unconfirmed), isolated (a faulty sensor is out, the rest still check one another), degraded (no sensor\n"
    "can be spared, usually three are left), failed (too few sensors or no bound: do not use the output).\n"
    "One attitude rarely tells which sensor is at fault: plumb waits for the tool to turn.\n\n"
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
    "returns a2 and a4 to service, with the reset_key of the array file; \"36s recalibrate\" for new biases and\n"
    "scales. A time before the first row, a negative one too, counts as asked for before that row.\n"
    "What the monitor refuses is said on standard error.\n"
    "--snapshot-in goes on where another run ended that wrote --snapshot-out: exclusions, doubts, adopted coefficients "
    "and\n"
    "`failed` outlive the end of a log as they outlive a power cycle. The snapshot must be of the same array file and\n"
    "calibration; both options may name one file.\n"
    "--roll-test validates beforehand: a recording of the tool at several attitudes, with the columns of [input], "
    "goes\n"
    "through the monitor before the log. One line on standard error says which sensors it validated, or which turn is\n"
    "still missing; the run goes on from there as from a snapshot, by the log's own time. Nothing of the recording is\n"
    "valid in the run. A doubt, an exclusion or `failed` of the roll test goes along.\n"
    "--follow waits at the end of the log for what is appended to it, as on standard input, until Ctrl-C; the "
    "snapshot\n"
    "and the files are complete then too.\n"
    "--calibrate-first: nothing is valid until the monitor has seen some 20 still attitudes all round and accepted a "
    "fit\n"
    "of its own; the log ends with exit code 4 where it did not come to that. A constant error of a sensor is what a\n"
    "calibration takes off: only what varies shows.\n"
    "--report grades every station green, orange or red and answers whether the tool may be surveyed with; it keeps\n"
    "stations and events, not samples, so that it may end a run of any length. Name the depth column in [input].\n"
    "--limits reads no log: it says what the monitor would decide by with this array file and calibration, how many\n"
    "samples a block can use, and what a given delta_f hides.\n"
    "--json prints one JSON object per change, then one with the key \"summary\".\n"
    "Ctrl-C ends the run in order: files are complete up to then, the summary is printed, exit code 1.\n\n";

/// What became of --host, where it did not become what was asked for.
void tell_refusals(const scenario::Host& host, const SensorArray& sensors) {
  for (const scenario::Host::Answer& answer : host.answers()) {
    if (answer.refusal == Errc::ok) continue;
    print_error(fmt::format("plumb: --host \"{}\" was refused: {}. Remedy: {}.\n",
                            scenario::to_text(answer.request, sensors), describe(answer.refusal),
                            remedy(answer.refusal)));
  }
  if (host.waiting() > 0)
    print_error(fmt::format("plumb: the log ended before the last {} of the --host requests.\n", host.waiting()));
}

io::FileExpected<void> keep(const std::string& snapshot_path, const HealthMonitor& monitor) {
  if (snapshot_path.empty()) return {};
  return save_snapshot(snapshot_path, monitor);
}
/// `run` has refused the options: there is nothing to keep.
io::FileExpected<void> keep(const std::string&, const PaperMonitor&) { return {}; }

/// What the run goes on from.
struct Past {
  std::string told;    ///< in the table; empty: power-on
  io::Json roll_test;  ///< for the summary of --json; null: none
};

/// The run itself, with either monitor, `days` after the calibration; `stepper`, where there is one, is stepped in its
/// place.
template <class Monitor>
io::ExitCode watch(const MonitorOptions& options, const io::ArrayFile& array, Monitor& monitor, double days,
                   const Past& past = {}, stepping::Stepper* stepper = nullptr) {
  const SensorArray& sensors = monitor.array();
  std::vector<scenario::HostRequest> requests;
  for (const std::string& text : options.host) {
    const tl::expected<scenario::HostRequest, std::string> request = scenario::parse_host_request(text, sensors);
    if (!request) return report(io::FileError{"--host", 0, "", request.error(), "", io::ExitCode::usage});
    requests.push_back(*request);
  }
  scenario::Host host(std::move(requests));
  Outputs outputs;
  const io::FileExpected<void> opened =
      open_outputs(options, array, sensors, monitor.verdict(), past.told, days, outputs);
  if (!opened) return report(opened.error());
  watch_interrupts();
  LogSpec log = options.log;
  log.hash = !options.report.empty();
  const io::FileExpected<MonitorRun> done = stepper != nullptr ? run_stepper(*stepper, array, log, outputs.sinks)
                                                               : run_monitor(monitor, array, log, outputs.sinks, host);
  if (!done) return report(done.error());
  io::FileExpected<void> kept = commit(outputs, *done);
  if (kept) kept = keep(options.snapshot_out, monitor);
  if (!kept) return report(kept.error());
  tell_refusals(host, sensors);
  if (options.json) {
    print_now(summary_json(*done, sensors, array.output_frame, days, past.roll_test));
  } else if (outputs.table) {
    print_now(summary_text(*done, array, sensors, days) + (outputs.report ? outputs.report->summary() : ""));
  }
  if (done->stopped) {
    print_error(
        fmt::format("plumb: the log ended in an error; the results up to t = {:.3f} s are kept.\n", done->last_time_s));
    return report(done->stop);
  }
  if (done->interrupted) {
    print_error(fmt::format("plumb: interrupted; the results up to t = {:.3f} s are kept.\n", done->last_time_s));
    return io::ExitCode::other;
  }
  if (done->last.state == HealthState::failed) return io::ExitCode::monitor_failed;
  if ((done->last.qualifiers & Qualifier::initial_calibration) == 0) return io::ExitCode::done;
  print_error("plumb: the log ended before the monitor had calibrated itself: no output was ever valid.\n");
  return io::ExitCode::not_accepted;
}

std::optional<io::FileError> past_misuse(const MonitorOptions& options, const io::ArrayFile& array) {
  const std::optional<io::FileError> misuse = snapshot_misuse(options, array);
  return misuse ? misuse : roll_test_misuse(options, array);
}

Past past_of(const MonitorOptions& options) { return {options.snapshot_in.empty() ? "" : "the snapshot", io::Json()}; }

/// The monitor that a run steps: of the smallest build that holds the array. A snapshot is bound to the capacity that
/// wrote it, so that a run with one, with a roll test or with requests of a host keeps to the monitor for all arrays
/// (null).
std::unique_ptr<stepping::Stepper> stepper_of(const MonitorOptions& options, const io::ArrayFile& array,
                                              const Calibration* calibration, double days) {
  const bool kept = !options.snapshot_in.empty() || !options.snapshot_out.empty() || !options.roll_test.empty() ||
                    !options.host.empty();
  return kept ? nullptr : make_stepper(array, calibration, 0, days);
}

/// --limits: what the monitor would decide by.
io::ExitCode tell_limits(const MonitorOptions& options, const io::ArrayFile& array, const SensorArray& calibrated,
                         double days) {
  const report::MonitorLimits limits =
      report::monitor_limits(calibrated, array.gravity, array.monitor, io::tolerance_mps2(array, days));
  print_now(options.json ? report::limits_json(limits) : report::limits_text(limits));
  return io::ExitCode::done;
}

/// The run after a recorded roll test, from which the monitor goes on as it would from a snapshot.
io::ExitCode watch_after_roll_test(const MonitorOptions& options, const io::ArrayFile& array, HealthMonitor& monitor,
                                   double days) {
  const io::FileExpected<RollTest> test = play_roll_test(monitor, array, options);
  if (!test) return report(test.error());
  if (test->run.interrupted) {
    print_error("plumb: interrupted in the roll test; the log was not read.\n");
    return io::ExitCode::other;
  }
  print_error(roll_test_text(*test, options.roll_test, monitor, array.output_frame));
  const io::Json told = options.json ? roll_test_json(*test, monitor, array.output_frame) : io::Json();
  return watch(options, array, monitor, days, Past{"the roll test", told});
}

/// --calibrate-first: the datasheet in the array file is all that is known.
io::ExitCode run_without_calibration(const MonitorOptions& options, const io::ArrayFile& array) {
  if (array.monitor.mode == MonitorMode::paper) {
    return report(io::FileError{"--calibrate-first", 0, "", "the paper's algorithm needs its own fits, made beforehand",
                                "run plumb calibrate, or set mode = \"plumb\" in " + array.path, io::ExitCode::usage});
  }
  const auto monitor =
      options.snapshot_in.empty() ? make_monitor(array, nullptr) : restore_monitor(array, nullptr, options.snapshot_in);
  if (!monitor) return report(monitor.error());
  return watch(options, array, **monitor, 0.0, past_of(options), stepper_of(options, array, nullptr, 0.0).get());
}

void warn_of_stations(const io::ArrayFile& array) {
  if (array.input.rows != io::RowKind::stations || array.monitor.window <= 1) return;
  print_error(
      fmt::format("plumb: {}: every row of the log is a station, but [monitor] window = {} joins that many rows to one "
                  "block. Remedy: set window = 1.\n",
                  array.path, array.monitor.window));
}

io::ExitCode run_monitor(const MonitorOptions& options) {
  if (const std::optional<io::FileError> misuse = follow_misuse(options)) return report(*misuse);
  if (const std::optional<io::FileError> misuse = calibration_misuse(options)) return report(*misuse);
  if (const std::optional<io::FileError> misuse = report_misuse(options)) return report(*misuse);
  std::vector<NamedFile> to_write = {{"--events", options.events},
                                     {"--verdicts", options.verdicts},
                                     {"--report", options.report},
                                     {"--report", health_data_path(options.report)}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, {{"--snapshot-in", options.snapshot_in}}))
    return report(*clash);
  to_write.push_back({"--snapshot-out", options.snapshot_out});
  const std::vector<NamedFile> to_read = {{"--array", options.array},
                                          {"--calibration", options.calibration},
                                          {"--log", options.log.path},
                                          {"--roll-test", options.roll_test}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, to_read)) return report(*clash);
  const io::FileExpected<io::ArrayFile> array = io::read_array_file(options.array);
  if (!array) return report(array.error());
  if (options.calibrate_first) {
    if (const std::optional<io::FileError> misuse = past_misuse(options, *array)) return report(*misuse);
    warn_of_stations(*array);
    return run_without_calibration(options, *array);
  }
  const io::FileExpected<io::CalibrationFile> calibration = io::read_calibration(options.calibration, *array);
  if (!calibration) return report(calibration.error());
  const io::FileExpected<double> days = days_since(*calibration, options.calibration, options.date);
  if (!days) return report(days.error());
  print_error(undated_note(*array, *calibration, options.calibration));
  if (const std::optional<io::FileError> misuse = past_misuse(options, *array)) return report(*misuse);
  warn_of_stations(*array);
  if (array->monitor.mode == MonitorMode::paper) {
    const auto monitor = make_paper_monitor(*array, *calibration, options.calibration);
    if (!monitor) return report(monitor.error());
    if (options.limits) return report(limits_of_paper(*array));
    return watch(options, *array, **monitor, *days);
  }
  const auto monitor = options.snapshot_in.empty()
                           ? make_monitor(*array, &calibration->calibration, *days)
                           : restore_monitor(*array, &calibration->calibration, options.snapshot_in, *days);
  if (!monitor) return report(monitor.error());
  if (options.limits) return tell_limits(options, *array, (*monitor)->array(), *days);
  if (!options.roll_test.empty()) return watch_after_roll_test(options, *array, **monitor, *days);
  const auto stepper = stepper_of(options, *array, &calibration->calibration, *days);
  return watch(options, *array, **monitor, *days, past_of(options), stepper.get());
}

}  // namespace

Command add_monitor(const Options& tool) {
  auto options = std::make_shared<MonitorOptions>();
  const Options command =
      tool.add_command("monitor", "watch a log or a live stream: which sensors may be believed, which way is down");
  command.add_option("--array", options->array, "the array file: what the sensors are, how the log looks")
      .required()
      .type_name("ARRAY.toml");
  command.add_option("--calibration", options->calibration, "what `plumb calibrate` wrote for this array")
      .type_name("CAL.json");
  command.add_flag("--calibrate-first", options->calibrate_first,
                   "there is no calibration: the monitor makes its own from the log's first stations");
  command.add_option("--log", options->log.path, "the log, CSV with a header row; `-` (default) reads standard input")
      .type_name("LOG.csv|-");
  command.add_flag("--follow", options->log.follow, "at the end of the log wait for the rows that are appended to it");
  command
      .add_option("--events", options->events,
                  "write one JSON line per change; `-` = standard output, instead of the table")
      .type_name("E.jsonl");
  command.add_option("--verdicts", options->verdicts, "write one JSON line per block of quiet samples; `-` likewise")
      .type_name("V.jsonl");
  command.add_flag("--every-sample", options->every_sample, "with --verdicts: one line per sample instead");
  command
      .add_option("--report", options->report,
                  "write the tool health report: a page, and its data as JSON beside it; docs/health-report.md")
      .type_name("R.html");
  command.add_option("--snapshot-in", options->snapshot_in, "go on from this snapshot instead of from power-on")
      .type_name("S.bin");
  command
      .add_option("--roll-test", options->roll_test,
                  "validate the sensors by this recorded roll test first; its columns are those of the log")
      .type_name("ROLL.csv");
  command.add_option("--snapshot-out", options->snapshot_out, "at the end of the run, write what the monitor remembers")
      .type_name("S.bin");
  command.add_option("--host", options->host, "what the host asks of the monitor, as below; may be given several times")
      .type_name("REQUEST");
  add_bad_row_option(command, options->log.on_bad_row);
  command
      .add_option("--date", options->date,
                  "of the run, for what drifts per day since the calibration (stability_per_day); today by default")
      .check(date_refusal)
      .type_name("YYYY-MM-DD");
  command.add_flag("--limits", options->limits, "print the limits of the tests and what they can see, read no log");
  command.add_flag("--json", options->json, "JSON lines instead of the table, for machines");
  command.footer(kMonitorNotes + exit_codes_help());
  return {command, kMonitorAbout, [options] { return run_monitor(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
