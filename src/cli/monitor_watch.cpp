#include "monitor_watch.hpp"

#include <fmt/format.h>

#include <utility>

#include "plumb/render/alignment_words.hpp"
#include "plumb/render/calibration_notes.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/monitor_limits.hpp"
#include "plumb/render/monitor_summary.hpp"
#include "plumb/render/nothing_judged_words.hpp"
#include "plumb/render/roll_test_words.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/session/days_since.hpp"
#include "read_array.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

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

/// --limits: what the monitor would decide by.
io::ExitCode tell_limits(const MonitorOptions& options, const io::ArrayFile& array, const SensorArray& calibrated,
                         double days) {
  const findings::MonitorLimits limits =
      findings::monitor_limits(calibrated, array.gravity, array.monitor, io::tolerance_mps2(array, days));
  print_now(options.json ? render::limits_json(limits, array.field) : render::limits_text(limits, array.field));
  return io::ExitCode::done;
}

void warn_of_stations(const io::ArrayFile& array) {
  if (array.input.rows != io::RowKind::stations || array.monitor.window <= 1) return;
  print_error(
      fmt::format("plumb: {}: every row of the log is a station, but [monitor] window = {} joins that many rows to one "
                  "block. Remedy: set window = 1.\n",
                  array.path, array.monitor.window));
}

std::optional<io::FileError> misuse_of(const MonitorOptions& options) {
  for (const auto check : {follow_misuse, calibration_misuse, report_misuse, motion_misuse, incidents_misuse}) {
    if (const std::optional<io::FileError> misuse = check(options)) return misuse;
  }
  std::vector<NamedFile> to_write = {{"--events", options.events}, {"--verdicts", options.verdicts},
                                     {"--motion", options.motion}, {"--inclination", options.inclination},
                                     {"--report", options.report}, {"--report", health_data_path(options.report)}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, {{"--snapshot-in", options.snapshot_in}}))
    return clash;
  to_write.push_back({"--snapshot-out", options.snapshot_out});
  return overwritten(to_write, {{"--array", array_file_of(options.array)},
                                {"--calibration", options.calibration},
                                {"--log", options.log.path},
                                {"--roll-test", options.roll_test}});
}

std::optional<io::FileError> past_misuse(const MonitorOptions& options, const io::ArrayFile& array) {
  const std::optional<io::FileError> misuse = snapshot_misuse(options, array);
  return misuse ? misuse : roll_test_misuse(options, array);
}

}  // namespace

tl::expected<std::unique_ptr<ArrayWatch>, io::ExitCode> ArrayWatch::begin(const MonitorOptions& options,
                                                                          const session::RateGroup* gyros) {
  if (const std::optional<io::FileError> misuse = misuse_of(options))
    return tl::unexpected<io::ExitCode>(report(*misuse));
  io::FileExpected<io::ArrayFile> array = read_array(options.array, "plumb monitor", Serves::lengths);
  if (!array) return tl::unexpected<io::ExitCode>(report(array.error()));
  std::unique_ptr<ArrayWatch> out(new ArrayWatch(options, *std::move(array), gyros));
  Ended ended = options.calibrate_first ? out->prepare_without_calibration() : out->prepare();
  if (!ended) ended = out->open();
  if (ended) return tl::unexpected<io::ExitCode>(*ended);
  return out;
}

ArrayWatch::Ended ArrayWatch::prepare() {
  io::FileExpected<io::CalibrationFile> calibration = io::read_calibration(options_.calibration, array_);
  if (!calibration) return report(calibration.error());
  calibration_ = *std::move(calibration);
  const io::FileExpected<double> days = session::days_since(*calibration_, options_.calibration, options_.date);
  if (!days) return report(days.error());
  days_ = *days;
  print_error(
      render::undated_note(array_, *calibration_, options_.calibration) +
      render::exact_note(*calibration_, options_.calibration) +
      render::stated_note(*calibration_, options_.calibration) +
      render::noise_note(array_, session::noise_changed(array_, calibration_->calibration), options_.calibration));
  if (array_.monitor.mode == MonitorMode::plumb)  // the paper's method has no bound
    print_error(render::in_field_words(render::alignment_note(array_, findings::alignment_of(array_, &*calibration_)),
                                       array_.field));
  aligned_ = findings::with_alignment(array_, &*calibration_);
  if (const std::optional<io::FileError> misuse = past_misuse(options_, array_)) return report(*misuse);
  warn_of_stations(array_);
  return array_.monitor.mode == MonitorMode::paper ? take_paper() : take_monitor();
}

/// --calibrate-first: the datasheet in the array file is all that is known.
ArrayWatch::Ended ArrayWatch::prepare_without_calibration() {
  if (const std::optional<io::FileError> misuse = past_misuse(options_, array_)) return report(*misuse);
  warn_of_stations(array_);
  if (array_.monitor.mode == MonitorMode::paper) {
    return report(
        io::FileError{"--calibrate-first", 0, "", "the paper's algorithm needs a calibration with the paper's fits",
                      "run plumb calibrate --paper and give --calibration, or set mode = \"plumb\" in " + array_.path,
                      io::ExitCode::usage});
  }
  print_error(render::alignment_note(array_, findings::alignment_of(array_, nullptr)));
  aligned_ = findings::with_alignment(array_, nullptr);
  return take_monitor();
}

ArrayWatch::Ended ArrayWatch::take_paper() {
  io::FileExpected<MonitorMotion> motion = MonitorMotion::make(options_, aligned_, &*calibration_, days_, gyros_);
  if (!motion) return report(motion.error());
  motion_.emplace(*std::move(motion));
  io::FileExpected<std::unique_ptr<PaperMonitor>> monitor =
      session::make_paper_monitor(array_, *calibration_, options_.calibration);
  if (!monitor) return report(monitor.error());
  paper_ = *std::move(monitor);
  if (options_.limits) return report(limits_of_paper(array_));
  return std::nullopt;
}

ArrayWatch::Ended ArrayWatch::take_monitor() {
  io::FileExpected<MonitorMotion> motion =
      MonitorMotion::make(options_, aligned_, calibration_ ? &*calibration_ : nullptr, days_, gyros_);
  if (!motion) return report(motion.error());
  motion_.emplace(*std::move(motion));
  io::FileExpected<std::unique_ptr<HealthMonitor>> monitor =
      options_.snapshot_in.empty() ? session::make_monitor(aligned_, calibration(), days_)
                                   : session::restore_monitor(aligned_, calibration(), options_.snapshot_in, days_);
  if (!monitor) return report(monitor.error());
  monitor_ = *std::move(monitor);
  if (options_.limits) return tell_limits(options_, array_, monitor_->array(), days_);
  if (!options_.snapshot_in.empty()) past_ = "the snapshot";
  if (!options_.roll_test.empty()) return play_roll_test();
  // Of the smallest build that holds the array. A snapshot is bound to the capacity that wrote it, so that a run with
  // one, with a roll test, with requests of a host or beside a group that looks into it keeps to the monitor for all
  // arrays.
  const bool kept = !options_.snapshot_in.empty() || !options_.snapshot_out.empty() || !options_.host.empty() ||
                    (!options_.label.empty() && array_.group.empty());
  if (!kept) stepper_ = session::make_stepper(aligned_, calibration(), 0, days_);
  return std::nullopt;
}

/// A recorded roll test, from which the monitor goes on as it would from a snapshot.
ArrayWatch::Ended ArrayWatch::play_roll_test() {
  const io::FileExpected<session::RollTest> test =
      session::play_roll_test(*monitor_, array_, {options_.roll_test, options_.log.on_bad_row});
  if (!test) return report(test.error());
  if (test->run.interrupted) {
    print_error("plumb: interrupted in the roll test; the log was not read.\n");
    return io::ExitCode::other;
  }
  print_error(render::roll_test_text(*test, options_.roll_test, *monitor_, array_.output_frame));
  if (options_.json) roll_test_ = render::roll_test_json(*test, *monitor_, array_.output_frame);
  past_ = "the roll test";
  return std::nullopt;
}

ArrayWatch::Ended ArrayWatch::open() {
  std::vector<scenario::HostRequest> requests;
  for (const std::string& text : options_.host) {
    const tl::expected<scenario::HostRequest, std::string> request = scenario::parse_host_request(text, sensors());
    if (!request) return report(io::FileError{"--host", 0, "", request.error(), "", io::ExitCode::usage});
    requests.push_back(*request);
  }
  host_ = std::make_unique<scenario::Host>(std::move(requests));
  if (!stepper_ && monitor_) stepper_ = std::make_unique<session::HostedStepper<HealthMonitor>>(*monitor_, *host_);
  if (paper_) stepper_ = std::make_unique<session::HostedStepper<PaperMonitor>>(*paper_, *host_);
  const Verdict& now = monitor_ ? monitor_->verdict() : paper_->verdict();
  io::FileExpected<void> opened = open_outputs(options_, array_, sensors(), now, past_, days_, outputs_);
  if (opened) opened = motion_->open(options_, array_, outputs_);
  if (opened) opened = open_incidents();
  if (!opened) return report(opened.error());
  watch_interrupts();
  return std::nullopt;
}

/// Behind the monitor of motion, so that its findings come with their row.
io::FileExpected<void> ArrayWatch::open_incidents() {
  if (options_.incidents.directory.empty()) return {};
  io::FileExpected<std::unique_ptr<session::IncidentRecorder>> made =
      session::IncidentRecorder::create(options_.incidents, array_);
  if (!made) return tl::unexpected<io::FileError>(made.error());
  outputs_.incidents = *std::move(made);
  motion_->tell(*outputs_.incidents);
  outputs_.sinks.push_back(outputs_.incidents.get());
  return {};
}

session::LogSpec ArrayWatch::log() const {
  session::LogSpec out = options_.log;
  out.hash = !options_.report.empty();
  return out;
}

io::FileExpected<std::unique_ptr<MonitorSetup>> ArrayWatch::setup() const {
  return session::monitor_setup(aligned_, calibration(), days_);
}

session::LogShare ArrayWatch::share() {
  stepping_.emplace(*stepper_, outputs_.sinks);
  return {&array_, &*stepping_, {}};
}

io::FileExpected<void> ArrayWatch::keep(session::LogEnd end) {
  run_ = stepping_->end(std::move(end));
  io::FileExpected<void> kept = commit(outputs_, run_, motion_->told());
  if (kept) kept = motion_->commit();
  if (kept && !options_.snapshot_out.empty()) kept = session::save_snapshot(options_.snapshot_out, *monitor_);
  return kept;
}

std::string ArrayWatch::incidents_text() const {
  if (!outputs_.incidents) return "";
  std::string out =
      fmt::format("incidents   {} recorded in {}", outputs_.incidents->recorded(), options_.incidents.directory);
  if (outputs_.incidents->passed_over() > 0)
    out += fmt::format("; {} later not",
                       count_text(static_cast<std::size_t>(outputs_.incidents->passed_over()), "change"));
  return out + "\n";
}

io::ExitCode ArrayWatch::say() {
  tell_refusals(*host_, sensors());
  if (options_.json) {
    print_now(render::summary_json(run_, array_, sensors(), days_, roll_test_, motion_->told()));
  } else if (outputs_.table) {
    print_now(render::summary_text(run_, array_, sensors(), days_, motion_->told()) + incidents_text() +
              (outputs_.report ? outputs_.report->summary() : ""));
  }
  return code();
}

io::ExitCode ArrayWatch::code() const {
  if (run_.stopped) {
    print_error(
        fmt::format("plumb: the log ended in an error; the results up to t = {:.3f} s are kept.\n", run_.last_time_s));
    return report(run_.stop);
  }
  if (run_.interrupted) {
    if (array_.group.empty() || options_.label.empty())  // said once
      print_error(fmt::format("plumb: interrupted; the results up to t = {:.3f} s are kept.\n", run_.last_time_s));
    return io::ExitCode::other;
  }
  if (run_.last.state == HealthState::failed) return io::ExitCode::monitor_failed;
  if ((run_.last.qualifiers & Qualifier::initial_calibration) != 0) return still_calibrating(*motion_);
  return run_.blocks > 0 || motion_->judged() ? io::ExitCode::done : report(nothing_judged(options_, array_, run_));
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
