#include "verify_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "calibration_age.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/report/change.hpp"
#include "plumb/report/evidence.hpp"
#include "plumb/report/identity.hpp"
#include "plumb/report/limits.hpp"
#include "plumb/report/traceability.hpp"
#include "tool.hpp"
#include "verify_parts.hpp"
#include "verify_reuse.hpp"
#include "verify_table2.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// A line on standard error, only where that is a terminal.
class TrialWatch {
 public:
  TrialWatch(std::string what, std::uint64_t of) : what_(std::move(what)), of_(of), on_(::isatty(STDERR_FILENO) != 0) {}
  ~TrialWatch() {
    if (on_) print_error("\r\033[K");
  }
  TrialWatch(const TrialWatch&) = delete;
  TrialWatch& operator=(const TrialWatch&) = delete;
  bool see(std::uint64_t done) {
    if (on_) {
      const double elapsed_s = seconds_since(start_);
      const double left_s = done > 0 ? elapsed_s * static_cast<double>(of_ - done) / static_cast<double>(done) : 0.0;
      print_error(fmt::format("\r{}: {} of {}{}\033[K", what_, done, of_,
                              done > 0 ? fmt::format(", {:.0f} s left", left_s) : std::string()));
    }
    return !interrupted();
  }

 private:
  std::string what_;
  std::uint64_t of_;
  bool on_;
  Clock::time_point start_ = Clock::now();
};

/// Everything that is read, before anything is computed.
struct Inputs {
  report::UserLimits limits;
  std::optional<report::TestResults> tests;
  std::optional<report::AssuranceResults> assurance;
  std::optional<Json> before;
  Json analysis = report::no_analysis();
  Json resources =
      io::object({{"given", false}, {"how", "--resources build/metal/results.json, from scripts/baremetal"}});
  Json files = Json::array();  ///< what the report rests on, hashed
};

io::FileExpected<void> note_input(const char* role, const std::string& path, Inputs& inputs) {
  if (path.empty()) return {};
  const io::FileExpected<std::string> bytes = io::read_file(path);
  if (!bytes) return tl::unexpected<io::FileError>(bytes.error());
  inputs.files.push_back(report::input_json(role, path, *bytes));
  return {};
}

/// Takes the value of `from`, or keeps its error.
template <class T, class To>
bool take(io::FileExpected<T> from, To& to, std::optional<io::FileError>& error) {
  if (!from) {
    error = from.error();
    return false;
  }
  to = *std::move(from);
  return true;
}

io::FileExpected<Inputs> read_inputs(const VerifyOptions& options, Verification& out) {
  Inputs inputs;
  std::optional<io::FileError> error;
  const auto fail = [&error] { return tl::unexpected<io::FileError>(*error); };
  if (!take(io::read_array_file(options.array), out.array, error)) return fail();
  inputs.limits = report::limits_of(out.array);
  if (!options.limits.empty() && !take(report::read_limits(options.limits, out.array), inputs.limits, error))
    return fail();
  inputs.limits.drift = drift_words(out.array, options.days_since_calibration);
  if (!options.test_results.empty() && !take(report::read_test_results(options.test_results), inputs.tests, error))
    return fail();
  if (!options.assurance.empty() && !take(report::read_assurance(options.assurance), inputs.assurance, error))
    return fail();
  if (!options.analysis.empty() && !take(report::read_analysis(options.analysis), inputs.analysis, error))
    return fail();
  if (!options.resources.empty() && !take(report::read_resources(options.resources), inputs.resources, error))
    return fail();
  if (!options.compare.empty() && !take(report::read_report(options.compare), inputs.before, error)) return fail();
  if (options.traceability.empty()) {
    if (!take(report::parse_traceability(report::built_in_traceability(), "built in"), out.traceability, error))
      return fail();
  } else if (!take(report::read_traceability(options.traceability), out.traceability, error)) {
    return fail();
  }
  for (const auto& [role, path] : {std::pair<const char*, const std::string&>{"array", options.array},
                                   {"limits", options.limits},
                                   {"calibration", options.calibration},
                                   {"positions", options.positions},
                                   {"test results", options.test_results},
                                   {"assurance results", options.assurance},
                                   {"traceability", options.traceability},
                                   {"static analysis", options.analysis},
                                   {"resources", options.resources}}) {
    const io::FileExpected<void> noted = note_input(role, path, inputs);
    if (!noted) return tl::unexpected<io::FileError>(noted.error());
  }
  for (const std::string& path : options.reuse) {
    const io::FileExpected<void> noted = note_input("campaign result", path, inputs);
    if (!noted) return tl::unexpected<io::FileError>(noted.error());
  }
  return inputs;
}

io::FileExpected<CalibrationPart> calibration_of(const VerifyOptions& options, const io::ArrayFile& array) {
  if (!options.calibration.empty()) return calibration_of_file(options.calibration, array);
  if (!options.positions.empty()) return calibration_of_positions(options.positions, array);
  return predicted_calibration(array, options.seed);
}

GeometrySubject subject_of(const io::ArrayFile& array, const CalibrationPart& part, double days_since_calibration) {
  GeometrySubject out;
  out.name = array.name;
  out.array = part.calibration ? part.calibration->array : array.array;
  out.model = part.calibration ? part.calibration->model : array.datasheet.model();
  out.calibrated = part.calibration != nullptr;
  out.gravity = array.gravity;
  out.settings = settings_of(array, days_since_calibration);
  out.settings.samples *= part.samples_per_row;
  out.file = std::make_unique<const io::ArrayFile>(array);
  return out;
}

Json not_played(const std::string& reason) { return io::object({{"played", false}, {"reason", reason}}); }

/// One campaign; `section` says why it was not played where it could not be.
io::FileExpected<std::optional<report::Trials>> play(const std::string& text, const char* what, int threads,
                                                     Json& section) {
  const io::FileExpected<campaign::CampaignFile> file = campaign::parse_campaign_text(text, what);
  if (!file) {
    section = not_played(file.error().text());
    return std::optional<report::Trials>();
  }
  TrialWatch watch(what, file->plan.scenarios);
  tl::expected<report::Trials, std::string> trials =
      report::play_trials(*file, threads, [&watch](std::uint64_t done) { return watch.see(done); });
  if (trials) return std::optional<report::Trials>(*std::move(trials));
  if (interrupted()) {
    return tl::unexpected<io::FileError>(io::FileError{"verify", 0, "", "interrupted; nothing was written",
                                                       "run it again, with fewer --scenarios", io::ExitCode::other});
  }
  section = not_played(trials.error());
  return std::optional<report::Trials>();
}

io::FileExpected<void> play_campaigns(const VerifyOptions& options, const report::TrialSettings& settings, int threads,
                                      Verification& out, Json& section, std::vector<std::int64_t>& step_ns) {
  section = io::object({{"healthy", Json()}, {"faults", Json()}});
  if (out.array.monitor.mode == MonitorMode::paper) {
    section["healthy"] = section["faults"] =
        not_played("the array file asks for the paper's mode; campaigns play plumb's monitor only");
    return {};
  }
  out.faults_toml = report::fault_campaign(out.array, kArrayCopy, settings);
  out.healthy_toml = report::healthy_campaign(out.array, kArrayCopy, settings);
  auto healthy = play(report::healthy_campaign(out.array, options.array, settings), "campaign without faults", threads,
                      section["healthy"]);
  if (!healthy) return tl::unexpected<io::FileError>(healthy.error());
  auto faults = play(report::fault_campaign(out.array, options.array, settings), "campaign of faults", threads,
                     section["faults"]);
  if (!faults) return tl::unexpected<io::FileError>(faults.error());
  out.healthy = *std::move(healthy);
  out.faults = *std::move(faults);
  const std::string replay = "plumb campaign ";
  if (out.healthy) section["healthy"] = report::healthy_trials_json(*out.healthy, replay + kHealthyFile);
  if (out.faults) section["faults"] = report::fault_trials_json(*out.faults, replay + kFaultsFile);
  const io::FileExpected<void> reused = take_reused(options.reuse, out, section);
  if (!reused) return reused;
  std::vector<const report::Trials*> played;
  if (out.healthy) played.push_back(&*out.healthy);
  if (out.faults) played.push_back(&*out.faults);
  if (played.empty()) return {};
  const auto again = report::replayed_json(played, kReplayed, &step_ns);
  if (!again)
    return tl::unexpected<io::FileError>(
        io::FileError{options.array, 0, "", again.error(), "report this", io::ExitCode::other});
  section["replayed"] = *again;
  return {};
}

/// The work of a scenario grows steeply with the number of sensors.
std::uint64_t usual_scenarios(int sensors) {
  return sensors <= 6 ? 20000 : sensors <= 8 ? 10000 : sensors <= 12 ? 2000 : 500;
}

/// What says the same for the same inputs, wherever it runs.
std::string command_of(const VerifyOptions& options, std::uint64_t scenarios) {
  std::string out = "plumb verify";
  const auto add = [&out](const char* name, const std::string& value) {
    if (!value.empty()) out += std::string(" ") + name + " " + value;
  };
  add("--array", options.array);
  add("--limits", options.limits);
  add("--calibration", options.calibration);
  add("--positions", options.positions);
  add("--test-results", options.test_results);
  add("--assurance", options.assurance);
  add("--traceability", options.traceability);
  add("--analysis", options.analysis);
  add("--resources", options.resources);
  if (options.days_since_calibration > 0.0)
    add("--days-since-calibration", io::shortest(options.days_since_calibration));
  for (const std::string& path : options.reuse) add("--reuse", path);
  add("--compare", options.compare);
  return out + fmt::format(" --scenarios {} --seed {}", scenarios, options.seed);
}

Json resources_section(const io::ArrayFile& array, const Json& target) {
  return io::object({{"sensors", array.array.size()},
                     {"tool_capacity", kCapacity},
                     {"tool_monitor_bytes", sizeof(HealthMonitor)},
                     {"target", target}});
}

}  // namespace

io::FileExpected<Verification> verify(const VerifyOptions& options) {
  const Clock::time_point start = Clock::now();
  Verification out;
  const io::FileExpected<Inputs> inputs = read_inputs(options, out);
  if (!inputs) return tl::unexpected<io::FileError>(inputs.error());
  const io::FileExpected<CalibrationPart> part = calibration_of(options, out.array);
  if (!part) return tl::unexpected<io::FileError>(part.error());
  const int threads =
      options.threads > 0 ? options.threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const std::uint64_t scenarios = options.scenarios.value_or(usual_scenarios(out.array.array.size()));
  report::TrialSettings settings;
  settings.faults = inputs->limits.faults;
  settings.alert_limit_rad = inputs->limits.alert_limit_rad;
  settings.e_cal_mps2 = part->e_cal_mps2;
  settings.seed = options.seed;
  settings.scenarios = scenarios;
  settings.samples_per_row = part->samples_per_row;
  settings.days_since_calibration = options.days_since_calibration;
  Json campaigns;
  std::vector<std::int64_t> step_ns;
  const io::FileExpected<void> played = play_campaigns(options, settings, threads, out, campaigns, step_ns);
  if (!played) return tl::unexpected<io::FileError>(played.error());
  campaigns["table2"] = table2_section(out.array, options.seed);
  const GeometrySubject subject = subject_of(out.array, *part, options.days_since_calibration);

  Json& report = out.report;
  report["schema"] = report::kReportSchema;
  report["version"] = report::kReportVersion;
  report["run"] = Json::object();
  report["subject"] = io::object({{"name", out.array.name},
                                  {"sensors", out.array.array.size()},
                                  {"rows", out.array.input.rows == io::RowKind::stations ? "stations" : "samples"},
                                  {"samples_per_row", part->samples_per_row}});
  report["verdict"] = Json();
  report["array"] = array_section(subject, study_geometry(subject));
  report["calibration"] = part->section;
  report["campaign"] = std::move(campaigns);
  report["state_machine"] = machine_section(report["campaign"].value("replayed", Json()));
  report["traceability"] = report::traceability_section(out.traceability, inputs->tests, inputs->assurance);
  report["traceability"]["source"] = options.traceability.empty() ? "built in" : "file";
  report["analysis"] = inputs->analysis;
  report["resources"] = resources_section(out.array, inputs->resources);
  report["identity"] = io::object({{"build", report::build_json()},
                                   {"inputs", inputs->files},
                                   {"seed", options.seed},
                                   {"scenarios", scenarios},
                                   {"command", command_of(options, scenarios)}});
  report["verdict"] = report::verdict_section(inputs->limits, report);
  report["change"] = inputs->before
                         ? report::change_section(*inputs->before, report)
                         : io::object({{"given", false}, {"how", "--compare report.json of an earlier run"}});
  report["run"] = io::object({{"threads", threads},
                              {"seconds", seconds_since(start)},
                              {"monitor_step", report::step_times_json(std::move(step_ns))}});
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
