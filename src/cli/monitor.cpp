// plumb monitor: a log or a live stream through the health monitor.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "monitor_groups.hpp"
#include "monitor_motion.hpp"
#include "monitor_options.hpp"
#include "monitor_outputs.hpp"
#include "plumb/render/alignment_words.hpp"
#include "plumb/render/calibration_notes.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/monitor_limits.hpp"
#include "plumb/render/monitor_summary.hpp"
#include "plumb/render/nothing_judged_words.hpp"
#include "plumb/render/roll_test_words.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/session/days_since.hpp"
#include "plumb/session/incident_recorder.hpp"
#include "plumb/session/monitor_pipeline.hpp"
#include "read_array.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr const char* kMonitorAbout =
    "Monitor an array of accelerometers: read a log (or a live stream) sample by sample, say which sensors are\n"
    "valid, which way is down, and within what bound. A table line is printed at every change of state;\n"
    "a summary follows at the end. A sensor is excluded only when no other explanation of the data is left.";
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
  return session::save_snapshot(snapshot_path, monitor);
}
/// `run` has refused the options: there is nothing to keep.
io::FileExpected<void> keep(const std::string&, const PaperMonitor&) { return {}; }

/// The log once more, to see why; nothing where it cannot be read again.
std::optional<findings::NothingJudgedStudy> looked_at_again(const MonitorOptions& options, const io::ArrayFile& array) {
  if (options.log.path == "-") return std::nullopt;
  io::FileExpected<io::LogReader> reader = io::LogReader::open(options.log.path, array, io::BadRowPolicy::skip);
  if (!reader) return std::nullopt;
  findings::NothingJudgedStudent student(array);
  Sample sample;
  while (reader->next(sample) == io::LogReader::Next::row && !interrupted())
    student.add(sample, reader->rotation().turning);
  return student.study();
}

/// A run without one block at rest says nothing about any sensor, which is not the same as finding none at fault.
io::FileError nothing_judged(const MonitorOptions& options, const io::ArrayFile& array,
                             const session::MonitorRun& run) {
  io::FileError out{options.log.path,
                    0,
                    "",
                    fmt::format("nothing was judged in {}", count_text(run.samples, "sample")),
                    "",
                    io::ExitCode::nothing_judged};
  const std::optional<findings::NothingJudgedStudy> study = looked_at_again(options, array);
  if (study) {
    const render::Refusal words = render::nothing_judged_words(*study, array);
    out.what += ": " + words.reason;
    out.remedy = words.next;
    return out;
  }
  out.what += fmt::format(": none belong to a block of {} at rest", array.monitor.window);
  out.remedy =
      fmt::format("record the stream to a file and give it with --log, to be told why; a block needs {} at rest",
                  count_text(array.monitor.window, "sample"));
  return out;
}

/// The log was over first. A flight has no stations to calibrate at: what was judged in motion, by the nominal
/// coefficients, counts.
io::ExitCode still_calibrating(const MonitorMotion& motion) {
  if (motion.judged()) {
    print_error(
        "plumb: the log ended before the monitor had calibrated itself, so nothing was valid at rest; "
        "motion was judged by the nominal coefficients.\n");
    return io::ExitCode::done;
  }
  print_error(
      "plumb: the log ended before the monitor had calibrated itself, so no output was valid. Remedy: give a longer "
      "log, with about 20 still attitudes in all directions.\n");
  return io::ExitCode::not_accepted;
}

/// What the run goes on from.
struct Past {
  std::string told;    ///< in the table; empty: power-on
  io::Json roll_test;  ///< for the summary of --json; null: none
};

/// Behind the monitor of motion, so that its findings come with their row.
io::FileExpected<void> open_incidents(const MonitorOptions& options, const io::ArrayFile& array, MonitorMotion& motion,
                                      Outputs& outputs) {
  if (options.incidents.directory.empty()) return {};
  io::FileExpected<std::unique_ptr<session::IncidentRecorder>> made =
      session::IncidentRecorder::create(options.incidents, array);
  if (!made) return tl::unexpected<io::FileError>(made.error());
  outputs.incidents = *std::move(made);
  motion.tell(*outputs.incidents);
  outputs.sinks.push_back(outputs.incidents.get());
  return {};
}

std::string incidents_text(const MonitorOptions& options, const Outputs& outputs) {
  if (!outputs.incidents) return "";
  std::string out =
      fmt::format("incidents   {} recorded in {}", outputs.incidents->recorded(), options.incidents.directory);
  if (outputs.incidents->passed_over() > 0)
    out +=
        fmt::format("; {} later not", count_text(static_cast<std::size_t>(outputs.incidents->passed_over()), "change"));
  return out + "\n";
}

/// The run itself, with either monitor, `days` after the calibration; `motion` goes beside it, and `stepper`, where
/// there is one, is stepped in its place.
template <class Monitor>
io::ExitCode watch(const MonitorOptions& options, const io::ArrayFile& array, Monitor& monitor, double days,
                   MonitorMotion& motion, session::VerdictSink* beside, const Past& past = {},
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
  io::FileExpected<void> opened = open_outputs(options, array, sensors, monitor.verdict(), past.told, days, outputs);
  if (opened) opened = motion.open(options, array, outputs);
  if (opened) opened = open_incidents(options, array, motion, outputs);
  if (!opened) return report(opened.error());
  if (beside != nullptr) outputs.sinks.push_back(beside);
  watch_interrupts();
  session::LogSpec log = options.log;
  log.hash = !options.report.empty();
  const io::FileExpected<session::MonitorRun> done =
      stepper != nullptr ? session::run_stepper(*stepper, array, log, outputs.sinks)
                         : session::run_monitor(monitor, array, log, outputs.sinks, host);
  if (!done) return report(done.error());
  io::FileExpected<void> kept = commit(outputs, *done, motion.told());
  if (kept) kept = motion.commit();
  if (kept) kept = keep(options.snapshot_out, monitor);
  if (!kept) return report(kept.error());
  if (options.report_only) {
    if (!options.json) print_now(outputs.report->summary());
    return io::ExitCode::done;
  }
  tell_refusals(host, sensors);
  if (options.json) {
    print_now(render::summary_json(*done, array, sensors, days, past.roll_test, motion.told()));
  } else if (outputs.table) {
    print_now(render::summary_text(*done, array, sensors, days, motion.told()) + incidents_text(options, outputs) +
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
  if ((done->last.qualifiers & Qualifier::initial_calibration) != 0) return still_calibrating(motion);
  return done->blocks > 0 || motion.judged() ? io::ExitCode::done : report(nothing_judged(options, array, *done));
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
  return kept ? nullptr : session::make_stepper(array, calibration, 0, days);
}

/// --limits: what the monitor would decide by.
io::ExitCode tell_limits(const MonitorOptions& options, const io::ArrayFile& array, const SensorArray& calibrated,
                         double days) {
  const findings::MonitorLimits limits =
      findings::monitor_limits(calibrated, array.gravity, array.monitor, io::tolerance_mps2(array, days));
  print_now(options.json ? render::limits_json(limits, array.field) : render::limits_text(limits, array.field));
  return io::ExitCode::done;
}

/// The run after a recorded roll test, from which the monitor goes on as it would from a snapshot.
io::ExitCode watch_after_roll_test(const MonitorOptions& options, const io::ArrayFile& array, HealthMonitor& monitor,
                                   double days, MonitorMotion& motion, session::VerdictSink* beside) {
  const io::FileExpected<session::RollTest> test =
      session::play_roll_test(monitor, array, {options.roll_test, options.log.on_bad_row});
  if (!test) return report(test.error());
  if (test->run.interrupted) {
    print_error("plumb: interrupted in the roll test; the log was not read.\n");
    return io::ExitCode::other;
  }
  print_error(render::roll_test_text(*test, options.roll_test, monitor, array.output_frame));
  const io::Json told = options.json ? render::roll_test_json(*test, monitor, array.output_frame) : io::Json();
  return watch(options, array, monitor, days, motion, beside, Past{"the roll test", told});
}

/// --calibrate-first: the datasheet in the array file is all that is known.
io::ExitCode run_without_calibration(const MonitorOptions& options, const io::ArrayFile& array,
                                     session::VerdictSink* beside) {
  if (array.monitor.mode == MonitorMode::paper) {
    return report(
        io::FileError{"--calibrate-first", 0, "", "the paper's algorithm needs a calibration with the paper's fits",
                      "run plumb calibrate --paper and give --calibration, or set mode = \"plumb\" in " + array.path,
                      io::ExitCode::usage});
  }
  print_error(render::alignment_note(array, findings::alignment_of(array, nullptr)));
  const io::ArrayFile aligned = findings::with_alignment(array, nullptr);
  const auto monitor = options.snapshot_in.empty() ? session::make_monitor(aligned, nullptr)
                                                   : session::restore_monitor(aligned, nullptr, options.snapshot_in);
  if (!monitor) return report(monitor.error());
  io::FileExpected<MonitorMotion> motion = MonitorMotion::make(options, aligned, nullptr, 0.0);
  if (!motion) return report(motion.error());
  return watch(options, array, **monitor, 0.0, *motion, beside, past_of(options),
               stepper_of(options, aligned, nullptr, 0.0).get());
}

void warn_of_stations(const io::ArrayFile& array) {
  if (array.input.rows != io::RowKind::stations || array.monitor.window <= 1) return;
  print_error(
      fmt::format("plumb: {}: every row of the log is a station, but [monitor] window = {} joins that many rows to one "
                  "block. Remedy: set window = 1.\n",
                  array.path, array.monitor.window));
}

}  // namespace

io::ExitCode monitor_array(const MonitorOptions& options, session::VerdictSink* beside) {
  const auto tell = [&options](const std::string& note) {
    if (!options.report_only) print_error(note);
  };
  if (const std::optional<io::FileError> misuse = follow_misuse(options)) return report(*misuse);
  if (const std::optional<io::FileError> misuse = calibration_misuse(options)) return report(*misuse);
  if (const std::optional<io::FileError> misuse = report_misuse(options)) return report(*misuse);
  if (const std::optional<io::FileError> misuse = motion_misuse(options)) return report(*misuse);
  if (const std::optional<io::FileError> misuse = incidents_misuse(options)) return report(*misuse);
  std::vector<NamedFile> to_write = {{"--events", options.events}, {"--verdicts", options.verdicts},
                                     {"--motion", options.motion}, {"--inclination", options.inclination},
                                     {"--report", options.report}, {"--report", health_data_path(options.report)}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, {{"--snapshot-in", options.snapshot_in}}))
    return report(*clash);
  to_write.push_back({"--snapshot-out", options.snapshot_out});
  const std::vector<NamedFile> to_read = {{"--array", array_file_of(options.array)},
                                          {"--calibration", options.calibration},
                                          {"--log", options.log.path},
                                          {"--roll-test", options.roll_test}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, to_read)) return report(*clash);
  const io::FileExpected<io::ArrayFile> array = read_array(options.array, "plumb monitor", Serves::lengths);
  if (!array) return report(array.error());
  if (options.calibrate_first) {
    if (const std::optional<io::FileError> misuse = past_misuse(options, *array)) return report(*misuse);
    warn_of_stations(*array);
    return run_without_calibration(options, *array, beside);
  }
  const io::FileExpected<io::CalibrationFile> calibration = io::read_calibration(options.calibration, *array);
  if (!calibration) return report(calibration.error());
  const io::FileExpected<double> days = session::days_since(*calibration, options.calibration, options.date);
  if (!days) return report(days.error());
  tell(render::undated_note(*array, *calibration, options.calibration) +
       render::exact_note(*calibration, options.calibration) + render::stated_note(*calibration, options.calibration) +
       render::noise_note(*array, session::noise_changed(*array, calibration->calibration), options.calibration));
  if (array->monitor.mode == MonitorMode::plumb)  // the paper's method has no bound
    tell(render::in_field_words(render::alignment_note(*array, findings::alignment_of(*array, &*calibration)),
                                array->field));
  const io::ArrayFile aligned = findings::with_alignment(*array, &*calibration);
  if (const std::optional<io::FileError> misuse = past_misuse(options, *array)) return report(*misuse);
  warn_of_stations(*array);
  io::FileExpected<MonitorMotion> motion = MonitorMotion::make(options, aligned, &*calibration, *days);
  if (!motion) return report(motion.error());
  if (array->monitor.mode == MonitorMode::paper) {
    const auto monitor = session::make_paper_monitor(*array, *calibration, options.calibration);
    if (!monitor) return report(monitor.error());
    if (options.limits) return report(limits_of_paper(*array));
    return watch(options, *array, **monitor, *days, *motion, beside);
  }
  const auto monitor = options.snapshot_in.empty()
                           ? session::make_monitor(aligned, &calibration->calibration, *days)
                           : session::restore_monitor(aligned, &calibration->calibration, options.snapshot_in, *days);
  if (!monitor) return report(monitor.error());
  if (options.limits) return tell_limits(options, *array, (*monitor)->array(), *days);
  if (!options.roll_test.empty()) return watch_after_roll_test(options, *array, **monitor, *days, *motion, beside);
  const auto stepper = stepper_of(options, aligned, &calibration->calibration, *days);
  return watch(options, *array, **monitor, *days, *motion, beside, past_of(options), stepper.get());
}

Command add_monitor(const Options& tool) {
  auto options = std::make_shared<MonitorOptions>();
  const Options command =
      tool.add_command("monitor", "monitor a log or a live stream: which sensors are valid, which way is down");
  add_monitor_options(command, *options);
  return {command, kMonitorAbout,
          [options] { return options->groups.empty() ? monitor_array(*options, nullptr) : monitor_tool(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
