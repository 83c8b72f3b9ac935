// plumb monitor: a log or a live stream through the health monitor.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "calibration_age.hpp"
#include "monitor_options.hpp"
#include "monitor_pipeline.hpp"
#include "monitor_report.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/records.hpp"
#include "plumb/navigation/tilt.hpp"
#include "plumb/report/monitor_limits.hpp"
#include "plumb/report/run_findings.hpp"
#include "plumb/report/timeline.hpp"
#include "plumb/report/words.hpp"
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

/// A table line at each change.
class TableSink : public VerdictSink {
 public:
  /// `now`: what the monitor says before the first sample; `restored`: where it goes on from a snapshot.
  TableSink(const SensorArray& array, const Mat3& frame, const Verdict& now, bool restored)
      : array_(array), frame_(frame), now_(now), restored_(restored) {}

  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override {
    if (!started_) {
      print_now(report::table_header() + report::table_line(restored_
                                                                ? report::restored_row(sample.time_s, now_, frame_)
                                                                : report::power_on_row(sample.time_s, now_.state)));
    }
    started_ = true;
    if (verdict.transition.sequence != 0) print_now(report::table_line(report::row_of(verdict, array_, frame_)));
    return {};
  }
  stepping::Wanted wanted() const override { return stepping::Wanted::changes; }

 private:
  const SensorArray& array_;
  Mat3 frame_;
  Verdict now_;
  bool restored_;
  bool started_ = false;
};

/// All that `run` opened, in the order in which samples are handed on.
struct Outputs {
  std::optional<EventsFile> events;
  std::optional<VerdictsFile> verdicts;
  std::optional<EventsFile> json;
  std::optional<TableSink> table;
  std::unique_ptr<HealthReport> report;
  std::vector<VerdictSink*> sinks;
};

io::FileExpected<void> open_outputs(const MonitorOptions& options, const io::ArrayFile& array,
                                    const SensorArray& sensors, const Verdict& now, double days, Outputs& out) {
  const bool live = options.log.path == "-" || options.log.follow;
  const bool taken = options.events == "-" || options.verdicts == "-";
  if (!options.events.empty()) {
    io::FileExpected<io::OutputFile> file = io::OutputFile::create(options.events, io::OutputFile::Mode::stream);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    out.sinks.push_back(&out.events.emplace(*std::move(file), sensors, live || options.events == "-"));
  }
  if (!options.verdicts.empty()) {
    io::FileExpected<io::OutputFile> file = io::OutputFile::create(options.verdicts, io::OutputFile::Mode::stream);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    out.sinks.push_back(
        &out.verdicts.emplace(*std::move(file), sensors, array.output_frame, options.every_sample, live));
  }
  if (!options.report.empty()) {
    io::FileExpected<std::unique_ptr<HealthReport>> report = HealthReport::create(options, array, sensors, days);
    if (!report) return tl::unexpected<io::FileError>(report.error());
    out.report = *std::move(report);
    out.sinks.push_back(out.report.get());
  }
  // --events - writes there what --json would.
  const bool told = options.events == "-";
  if (options.json && told) return {};
  if (options.json) {
    io::FileExpected<io::OutputFile> file = io::OutputFile::create("-", io::OutputFile::Mode::stream);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    out.sinks.push_back(&out.json.emplace(*std::move(file), sensors, true));
  } else if (!taken) {
    out.sinks.push_back(&out.table.emplace(sensors, array.output_frame, now, !options.snapshot_in.empty()));
  }
  return {};
}

io::FileExpected<void> commit(Outputs& out, const MonitorRun& run) {
  io::FileExpected<void> done;
  if (out.events) done = out.events->commit();
  if (done && out.verdicts) done = out.verdicts->commit();
  if (done && out.json) done = out.json->commit();
  if (done && out.report) done = out.report->write(run);
  return done;
}

/// What a recalibration is at, or why the last one was refused; empty where there was none.
std::string recalibration_text(const Verdict& v, const SensorArray& sensors, const Mat3& frame) {
  const RecalibrationProgress& p = v.recalibration;
  if (v.state != HealthState::recalibrating) {
    return p.last_refusal.code == Errc::ok ? ""
                                           : fmt::format("recalibrate refused: {}\n", describe(p.last_refusal.code));
  }
  std::string out = fmt::format("recalibrate {}: {} stations, {} held out", to_string(p.phase), p.stations, p.held_out);
  if (p.stations_wanted > 0) {
    const Tilt tilt = tilt_of(io::in_frame(frame, p.wanted_direction), Mat3{});
    out += fmt::format(", {} more wanted, best at inclination {:.0f} deg", p.stations_wanted,
                       deg_from_rad(tilt.inclination_rad));
    if (tilt.toolface_valid) out += fmt::format(", toolface {:.0f} deg", deg_from_rad(tilt.toolface_rad));
  }
  if (!p.lacking.empty()) out += fmt::format("; too little change along {}", report::sensor_names(p.lacking, sensors));
  if (p.last_refusal.code != Errc::ok)
    out += fmt::format("; the last fit was refused: {}", describe(p.last_refusal.code));
  return out + "\n";
}

std::string summary_text(const MonitorRun& run, const SensorArray& sensors, const Mat3& frame) {
  const Verdict& v = run.last;
  std::string out = fmt::format("\nstate       {}: {}\n", to_string(v.state), report::meaning(v.state));
  out += fmt::format("log         {} samples, {} quiet blocks, {} changes, {} bad rows skipped\n", run.samples,
                     run.blocks, run.transitions, run.log.rows_bad);
  const bool failed = v.state == HealthState::failed;
  out += fmt::format("in service  {}\n", failed ? "none may be used" : report::sensor_names(v.in_service, sensors));
  out += fmt::format("excluded    {}\n", report::sensor_names(v.excluded, sensors));
  if (!v.set_aside.empty()) out += fmt::format("set aside   {}\n", report::sensor_names(v.set_aside, sensors));
  if (!v.absent.empty()) out += fmt::format("absent      {}\n", report::sensor_names(v.absent, sensors));
  out += recalibration_text(v, sensors, frame);
  double inclination_deg = 0.0;
  const bool known = report::inclination_of(v.gravity_mps2, frame, inclination_deg);
  out += fmt::format("inclination {}, {} ({})\n", known ? fmt::format("{:.3f} deg", inclination_deg) : "not known",
                     to_string(v.validity), report::meaning(v.validity));
  out += "protection  ";
  out += v.protection_available
             ? fmt::format("the direction is within {:.3f} deg of the truth\n", deg_from_rad(v.protection_level_rad))
             : std::string("no bound on the error can be given\n");
  return out + report::findings_text(v);
}

/// What of drift the run allowed for; the paper's method allows for none.
std::string drift_of(const io::ArrayFile& array, double days) {
  if (array.monitor.mode == MonitorMode::paper) return "none allowed for: the paper's algorithm takes none";
  return drift_words(array, days);
}

std::string summary_json(const MonitorRun& run, const SensorArray& sensors, const Mat3& frame, double days) {
  nlohmann::ordered_json s;
  s["state"] = to_string(run.last.state);
  s["output"] = to_string(run.last.validity);
  s["samples"] = run.samples;
  s["blocks"] = run.blocks;
  s["changes"] = run.transitions;
  s["rows_bad"] = run.log.rows_bad;
  s["last_time_s"] = run.last_time_s;
  s["interrupted"] = run.interrupted;
  s["days_since_calibration"] = days;
  s["last_verdict"] = io::parsed(io::verdict_json(run.last, sensors, frame));
  return io::object({{"summary", std::move(s)}}).dump() + "\n";
}

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

/// The run itself, with either monitor, `days` after the calibration; `stepper`, where there is one, is stepped in its
/// place.
template <class Monitor>
io::ExitCode watch(const MonitorOptions& options, const io::ArrayFile& array, Monitor& monitor, double days,
                   stepping::Stepper* stepper = nullptr) {
  const SensorArray& sensors = monitor.array();
  std::vector<scenario::HostRequest> requests;
  for (const std::string& text : options.host) {
    const tl::expected<scenario::HostRequest, std::string> request = scenario::parse_host_request(text, sensors);
    if (!request) return report(io::FileError{"--host", 0, "", request.error(), "", io::ExitCode::usage});
    requests.push_back(*request);
  }
  scenario::Host host(std::move(requests));
  Outputs outputs;
  const io::FileExpected<void> opened = open_outputs(options, array, sensors, monitor.verdict(), days, outputs);
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
    print_now(summary_json(*done, sensors, array.output_frame, days));
  } else if (outputs.table) {
    print_now(summary_text(*done, sensors, array.output_frame) + "drift       " + drift_of(array, days) + "\n" +
              (outputs.report ? outputs.report->summary() : ""));
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

/// The monitor that a run steps: of the smallest build that holds the array. A snapshot is bound to the capacity that
/// wrote it, so that a run with one, or with requests of a host, keeps to the monitor for all arrays (null).
std::unique_ptr<stepping::Stepper> stepper_of(const MonitorOptions& options, const io::ArrayFile& array,
                                              const Calibration* calibration, double days) {
  const bool kept = !options.snapshot_in.empty() || !options.snapshot_out.empty() || !options.host.empty();
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

/// --calibrate-first: the datasheet in the array file is all that is known.
io::ExitCode run_without_calibration(const MonitorOptions& options, const io::ArrayFile& array) {
  if (array.monitor.mode == MonitorMode::paper) {
    return report(io::FileError{"--calibrate-first", 0, "", "the paper's algorithm needs its own fits, made beforehand",
                                "run plumb calibrate, or set mode = \"plumb\" in " + array.path, io::ExitCode::usage});
  }
  const auto monitor =
      options.snapshot_in.empty() ? make_monitor(array, nullptr) : restore_monitor(array, nullptr, options.snapshot_in);
  if (!monitor) return report(monitor.error());
  return watch(options, array, **monitor, 0.0, stepper_of(options, array, nullptr, 0.0).get());
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
  const std::vector<NamedFile> to_read = {
      {"--array", options.array}, {"--calibration", options.calibration}, {"--log", options.log.path}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, to_read)) return report(*clash);
  const io::FileExpected<io::ArrayFile> array = io::read_array_file(options.array);
  if (!array) return report(array.error());
  if (options.calibrate_first) {
    if (const std::optional<io::FileError> misuse = snapshot_misuse(options, *array)) return report(*misuse);
    warn_of_stations(*array);
    return run_without_calibration(options, *array);
  }
  const io::FileExpected<io::CalibrationFile> calibration = io::read_calibration(options.calibration, *array);
  if (!calibration) return report(calibration.error());
  const io::FileExpected<double> days = days_since(*calibration, options.calibration, options.date);
  if (!days) return report(days.error());
  print_error(undated_note(*array, *calibration, options.calibration));
  if (const std::optional<io::FileError> misuse = snapshot_misuse(options, *array)) return report(*misuse);
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
  const auto stepper = stepper_of(options, *array, &calibration->calibration, *days);
  return watch(options, *array, **monitor, *days, stepper.get());
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
