#include "verify_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "plumb/geomagnetic/field_reference.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/calibration_notes.hpp"
#include "plumb/render/change.hpp"
#include "plumb/render/evidence.hpp"
#include "plumb/render/identity.hpp"
#include "plumb/render/report_parts.hpp"
#include "plumb/render/traceability.hpp"
#include "plumb/render/trials_json.hpp"
#include "plumb/render/verdict_section.hpp"
#include "plumb/render/verification_field.hpp"
#include "tool.hpp"
#include "verify_inputs.hpp"
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
    if (on_) print_status("\r\033[K");
  }
  TrialWatch(const TrialWatch&) = delete;
  TrialWatch& operator=(const TrialWatch&) = delete;
  bool see(std::uint64_t done) {
    if (on_) {
      const double elapsed_s = seconds_since(start_);
      const double left_s = done > 0 ? elapsed_s * static_cast<double>(of_ - done) / static_cast<double>(done) : 0.0;
      print_status(fmt::format("\r{}: {} of {}{}\033[K", what_, done, of_,
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

io::FileExpected<render::CalibrationPart> calibration_of(const VerifyOptions& options, const io::ArrayFile& array) {
  if (!options.calibration.empty()) return render::calibration_of_file(options.calibration, array);
  if (!options.stations.empty()) return render::calibration_of_stations(options.stations, array);
  return render::predicted_calibration(array, options.seed);
}

/// One campaign; `reason` says why it was not played where it could not be.
io::FileExpected<std::optional<verification::Trials>> play(const std::string& text, const char* what, int threads,
                                                           std::string& reason) {
  const io::FileExpected<campaign::CampaignFile> file = campaign::parse_campaign_text(text, what, geomagnetic::lookup);
  if (!file) {
    reason = file.error().text();
    return std::optional<verification::Trials>();
  }
  TrialWatch watch(what, file->plan.scenarios);
  tl::expected<verification::Trials, std::string> trials =
      verification::play_trials(*file, threads, [&watch](std::uint64_t done) { return watch.see(done); });
  if (trials) return std::optional<verification::Trials>(*std::move(trials));
  if (interrupted()) {
    return tl::unexpected<io::FileError>(io::FileError{"verify", 0, "", "interrupted; nothing was written",
                                                       "run it again, with fewer --scenarios", io::ExitCode::other});
  }
  reason = trials.error();
  return std::optional<verification::Trials>();
}

/// Plays them into `out`, with what they showed into its facts.
io::FileExpected<void> play_campaigns(const VerifyOptions& options, const verification::TrialSettings& settings,
                                      int threads, Verification& out) {
  verification::Facts& facts = out.facts;
  if (out.array.monitor.mode == MonitorMode::paper) {
    facts.healthy.reason = facts.faults.reason =
        "the array file has mode = \"paper\"; campaigns run plumb's own monitor only";
    return {};
  }
  const std::string copy = kArrayCopy + (out.array.group.empty() ? "" : "#" + out.array.group);
  out.faults_toml = verification::fault_campaign(out.array, copy, settings);
  out.healthy_toml = verification::healthy_campaign(out.array, copy, settings);
  auto healthy = play(verification::healthy_campaign(out.array, options.array, settings), "campaign without faults",
                      threads, facts.healthy.reason);
  if (!healthy) return tl::unexpected<io::FileError>(healthy.error());
  auto faults = play(verification::fault_campaign(out.array, options.array, settings), "campaign of faults", threads,
                     facts.faults.reason);
  if (!faults) return tl::unexpected<io::FileError>(faults.error());
  out.healthy = *std::move(healthy);
  out.faults = *std::move(faults);
  std::vector<const verification::Trials*> played;
  if (out.healthy) {
    facts.healthy = healthy_facts(*out.healthy);
    played.push_back(&*out.healthy);
  }
  if (out.faults) {
    facts.faults = fault_facts(*out.faults);
    played.push_back(&*out.faults);
  }
  if (played.empty()) return {};
  auto again = verification::replay_first(played, kReplayed);
  if (!again)
    return tl::unexpected<io::FileError>(
        io::FileError{options.array, 0, "", again.error(), "report this", io::ExitCode::other});
  facts.replay = again->counted;
  out.replayed = *std::move(again);
  return {};
}

/// The section of the campaigns but for the table of the paper; takes the rates of longer ones into the facts.
io::FileExpected<Json> campaign_section(const VerifyOptions& options, Verification& out) {
  const auto not_played = [](const std::string& reason) { return io::object({{"played", false}, {"reason", reason}}); };
  const std::string replay = "plumb campaign ";
  Json section = io::object({{"healthy", out.healthy ? render::healthy_trials_json(*out.healthy, replay + kHealthyFile)
                                                     : not_played(out.facts.healthy.reason)},
                             {"faults", out.faults ? render::fault_trials_json(*out.faults, replay + kFaultsFile)
                                                   : not_played(out.facts.faults.reason)}});
  const io::FileExpected<void> reused = take_reused(options.reuse, out, section);
  if (!reused) return tl::unexpected<io::FileError>(reused.error());
  if (out.replayed) section["replayed"] = render::replayed_json(*out.replayed);
  section["table2"] = table2_section(out.array, options.seed);
  return section;
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
  add("--stations", options.stations);
  add("--test-results", options.test_results);
  add("--assurance", options.assurance);
  add("--traceability", options.traceability);
  add("--analysis", options.analysis);
  add("--resources", options.resources);
  if (options.days_since_calibration > 0.0)
    add("--days-since-calibration", io::shortest(options.days_since_calibration));
  for (const std::string& known : options.known_attitudes) add("--known-attitude", known);
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

/// Completes what is known, and judges it.
void judge_all(const VerifyInputs& inputs, const render::CalibrationPart& part, verification::ArrayFacts array,
               const verification::TraceFacts& trace, Verification& out) {
  verification::Facts& facts = out.facts;
  facts.name = out.array.name;
  facts.rows_are_stations = out.array.input.rows == io::RowKind::stations;
  facts.samples_per_row = part.samples_per_row;
  facts.array = std::move(array);
  facts.calibration = part.facts;
  facts.wiring = part.wiring;
  facts.alignment = part.alignment;
  facts.trace = trace;
  if (inputs.tests) facts.trace.tests_not_of_this = render::not_of_this_build(inputs.tests_build, false);
  if (inputs.assurance) {
    facts.trace.proofs_not_of_this = render::not_of_this_build({inputs.assurance->version, "", ""}, true);
    if (!inputs.assurance->complete)
      facts.trace.proofs_not_of_this = "they are of a run of scripts/assure that is not complete";
  }
  if (inputs.analysis) facts.analysis_findings = inputs.analysis->findings;
  if (inputs.resources) facts.target = inputs.resources->items;
  out.verdict = verification::judge(inputs.limits, facts);
}

}  // namespace

io::FileExpected<Verification> verify(const VerifyOptions& options) {
  const Clock::time_point start = Clock::now();
  Verification out;
  const io::FileExpected<VerifyInputs> inputs = read_inputs(options, out);
  if (!inputs) return tl::unexpected<io::FileError>(inputs.error());
  const io::FileExpected<render::CalibrationPart> part = calibration_of(options, out.array);
  if (!part) return tl::unexpected<io::FileError>(part.error());
  const int threads =
      options.threads > 0 ? options.threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const std::uint64_t scenarios = options.scenarios.value_or(usual_scenarios(out.array.array.size()));
  verification::TrialSettings settings;
  settings.faults = inputs->limits.faults;
  settings.alert_limit_rad = inputs->limits.alert_limit_rad;
  settings.e_cal_mps2 = part->e_cal_mps2;
  settings.seed = options.seed;
  settings.scenarios = scenarios;
  settings.samples_per_row = part->samples_per_row;
  settings.days_since_calibration = options.days_since_calibration;
  const io::FileExpected<void> played = play_campaigns(options, settings, threads, out);
  if (!played) return tl::unexpected<io::FileError>(played.error());
  io::FileExpected<Json> campaigns = campaign_section(options, out);
  if (!campaigns) return tl::unexpected<io::FileError>(campaigns.error());
  const findings::GeometrySubject subject = render::subject_of(out.array, *part, options.days_since_calibration);
  const findings::GeometryStudy study = study_geometry(subject);
  out.geometry = render::geometry_pictures(subject, study);
  out.sizes = study.sizes;
  const render::Traceability trace = render::traceability_section(out.traceability, inputs->tests, inputs->assurance);
  judge_all(*inputs, *part, render::array_facts(subject, study), trace.facts, out);

  Json& report = out.report;
  report["schema"] = render::kReportSchema;
  report["version"] = render::kReportVersion;
  report["run"] = Json::object();
  report["subject"] = io::object({{"name", out.array.name},
                                  {"sensors", out.array.array.size()},
                                  {"rows", out.array.input.rows == io::RowKind::stations ? "stations" : "samples"},
                                  {"samples_per_row", part->samples_per_row}});
  report["verdict"] = Json();
  report["array"] = render::array_section(subject, study);
  report["calibration"] = part->section;
  report["campaign"] = *std::move(campaigns);
  report["state_machine"] = render::machine_section(out.replayed);
  report["traceability"] = trace.section;
  report["traceability"]["source"] = options.traceability.empty() ? "built in" : "file";
  report["analysis"] = inputs->analysis ? inputs->analysis->section : render::no_analysis();
  report["resources"] =
      resources_section(out.array, inputs->resources ? inputs->resources->section : render::no_resources());
  report["identity"] = io::object({{"build", render::build_json()},
                                   {"inputs", inputs->files},
                                   {"seed", options.seed},
                                   {"scenarios", scenarios},
                                   {"command", command_of(options, scenarios)}});
  report["verdict"] = render::verdict_section(out.verdict);
  out.told = render::verification_in_field(report, out.array.field);
  report["change"] = inputs->before
                         ? render::change_section(*inputs->before, out.told)
                         : io::object({{"given", false}, {"how", "--compare report.json of an earlier run"}});
  report["run"] = io::object(
      {{"threads", threads},
       {"seconds", seconds_since(start)},
       {"monitor_step", render::step_times_json(out.replayed ? out.replayed->step_ns : std::vector<std::int64_t>())}});
  for (const char* const section : {"change", "run"}) out.told[section] = report[section];
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
