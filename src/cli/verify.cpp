// plumb verify: everything about one array, in a report that can be signed.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "known_attitude_option.hpp"
#include "plot_files.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/detection_sizes.hpp"
#include "plumb/render/evidence.hpp"
#include "plumb/render/paper.hpp"
#include "plumb/render/plot.hpp"
#include "plumb/render/verification_exports.hpp"
#include "plumb/render/verification_field.hpp"
#include "plumb/render/verification_page.hpp"
#include "plumb/scenario/count_text.hpp"
#include "tool.hpp"
#include "verify_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVerifyAbout =
    "Verify an array: judge its geometry, its calibration and its monitor against your own limits, by analysis and\n"
    "by campaigns of simulated faults, and write a report that says what the array can detect, isolate and\n"
    "guarantee, how that is known, and what remains open.";
constexpr const char* kVerifyNotes =
    "Examples:\n"
    "  plumb verify --array examples/paper_tool.toml --scenarios 2000\n"
    "  plumb verify --array tool.toml --limits limits.toml --stations stand.csv --out report\n"
    "  plumb verify --array tool.toml#mag --calibration mag.json --out report-mag      # a magnetic group\n"
    "  plumb verify --array tool.toml --calibration cal.json --compare report/report.json --out report2\n\n"
    "A limits file (all keys optional):\n"
    "  [limits]\n"
    "  alert_limit = \"0.5 deg\"        # largest tilt error allowed\n"
    "  faults = 1                     # number of simultaneous sensor faults to isolate\n"
    "  fault = \"5 mg0\"                # smallest constant error to detect; of magnetometers \"500 nT\"\n"
    "  false_alarm_rate = 1e-3        # per block\n"
    "  misleading_rate = 1e-3         # per scenario, as the next\n"
    "  wrong_exclusion_rate = 1e-3\n"
    "  detect_within = \"2 s\"\n\n"
    "The directory holds report.html to read, report.json with every figure in it, and the campaigns to play again.\n"
    "Without --calibration or --stations what calibration leaves is predicted from a simulated stand, the verdict\n"
    "is `open` at best, and the report lists what to record. The same inputs give the same bytes but for the block\n"
    "`run`. docs/verification-report.md explains every section.\n"
    "Exit code 6 where the array is not fit, where that is open, where the evidence on plumb itself is incomplete\n"
    "(--test-results, --assurance), or where a requirement is an orphan.\n\n";

std::optional<io::FileError> misused(const VerifyOptions& options) {
  const auto refuse = [](const char* option, const char* what, const char* remedy) {
    return io::FileError{option, 0, "", what, remedy, io::ExitCode::usage};
  };
  if (!options.calibration.empty() && !options.stations.empty())
    return refuse("--stations", "and --calibration are both given", "give the log or the calibration made from it");
  if (options.scenarios == std::uint64_t{0}) return refuse("--scenarios", "is 0", "give at least 1");
  if (options.out.empty() || options.out == "-")
    return refuse("--out", "must name a directory", "give one: --out report");
  const std::vector<NamedFile> to_write = {{"--out", (fs::path(options.out) / "report.json").string()}};
  const std::vector<NamedFile> to_read = {{"--compare", options.compare},
                                          {"--traceability", options.traceability},
                                          {"--analysis", options.analysis},
                                          {"--resources", options.resources}};
  return overwritten(to_write, to_read);
}

/// What a terminal shows.
std::string summary(const Verification& found, const std::string& out) {
  const verification::Report& verdict = found.verdict;
  std::string text = verdict.sentence + "\n\n";
  for (const verification::Criterion& c : verdict.criteria)
    text += fmt::format("  {:<8} {:<52} {}\n", to_string(c.result),
                        render::in_direction_words(entry_of(c.id).title, found.array.field), c.found);
  text = render::in_direction_words(std::move(text), found.array.field);
  text += render::sizes_text(found.sizes, found.array.array.size(), found.array.field);
  const verification::RequirementCounts& n = verdict.requirements;
  text += fmt::format("\nrequirements: {} ({} active): {} verified, {} failed, {} open, {} traced without results\n",
                      n.requirements, n.active, n.verified, n.failed, n.open, n.traced);
  for (const std::string& orphan : verdict.orphans) text += "orphan: " + orphan + "\n";
  return text + "written to " + out + "\n";
}

/// Writes one file into the directory of the report.
class Folder {
 public:
  explicit Folder(std::string path) : path_(std::move(path)) {}
  io::FileExpected<void> make() const {
    std::error_code error;
    fs::create_directories(path_, error);
    if (!error) return {};
    return tl::unexpected<io::FileError>(io::FileError{path_, 0, "--out",
                                                       "cannot create the directory: " + error.message(),
                                                       "choose another directory with --out", io::ExitCode::other});
  }
  void write(const std::string& name, const std::string& text) {
    if (failure_) return;
    const io::FileExpected<void> done = io::write_file((fs::path(path_) / name).string(), text);
    if (!done) failure_ = done.error();
  }
  /// A file that this report does not have: what stands there is of an earlier one, and must not be signed with it.
  void leave_out(const std::string& name) {
    std::error_code ignored;
    if (fs::remove(fs::path(path_) / name, ignored))
      print_error("plumb: note: removed " + name + " of an earlier report from " + path_ + "\n");
  }
  /// Writes what is there, and omits what is not.
  void put(const std::string& name, const std::string& text) { text.empty() ? leave_out(name) : write(name, text); }
  const std::optional<io::FileError>& failure() const { return failure_; }

 private:
  std::string path_;
  std::optional<io::FileError> failure_;
};

/// The page on paper.
void print_pdf(const std::string& out, const std::string& html) {
  const std::string copy = (fs::path(out) / "report-print.html").string();
  io::FileExpected<void> done = io::write_file(copy, render::for_paper(html));
  if (done)
    done = render::run_program(out, "weasyprint", {"--quiet", "report-print.html", "report.pdf"}, "weasyprint", "PDF");
  std::error_code ignored;
  if (done) fs::remove(copy, ignored);  // else it stays, to see why
  if (!done) print_error("plumb: " + done.error().text() + "\n");
}

io::ExitCode run_verify(const VerifyOptions& options) {
  if (const std::optional<io::FileError> wrong = misused(options)) return report(*wrong);
  watch_interrupts();
  Folder folder(options.out);  // before the long work: where it cannot be, nothing is played in vain
  const io::FileExpected<void> made = folder.make();
  if (!made) return report(made.error());
  io::FileExpected<Verification> found = verify(options);
  if (!found) return report(found.error());
  const io::FieldKind field = found->array.field;
  for (Json* const one : {&found->report, &found->told}) {
    (*one)["run"]["time"] = now_utc();
    (*one)["run"]["host"] = host_name();
    (*one)["run"]["machine"] = machine_name();
  }
  const std::string text = found->told.dump(1) + "\n";
  folder.write("report.json", text);
  folder.write("traceability.json", found->traceability.dump(1) + "\n");
  folder.write(kArrayCopy, found->array.text);
  folder.put(kFaultsFile, found->faults_toml);
  folder.put(kHealthyFile, found->healthy_toml);
  folder.put("trials-faults.csv", found->faults ? verification::trials_csv(*found->faults) : "");
  folder.put("trials-healthy.csv", found->healthy ? verification::trials_csv(*found->healthy) : "");
  if (folder.failure()) return report(*folder.failure());
  const Json shown = render::verification_shown(found->report, field);
  const io::FileExpected<render::PagePictures> pictures =
      draw_pictures((fs::path(options.out) / render::kChartFolder).string(),
                    render::verification_plots_in_field(render::verification_plot_files(shown, found->geometry), field),
                    render::kVerificationScript, render::verification_picture_names(shown, found->geometry));
  if (!pictures) return report(pictures.error());
  const std::string page =
      render::verification_page_in_field(render::verification_html(shown, *pictures), shown, field);
  folder.write("report.html", page);
  folder.write("junit.xml", render::junit_xml(found->told));
  folder.write("needs.json", render::needs_json(found->told));
  folder.write("requirements.sdoc", render::requirements_sdoc(found->told));
  folder.write("spdx.json", render::spdx_json(found->told));
  const bool analysed = found->facts.analysis_findings.has_value();
  folder.put("analysis.sarif", analysed ? render::sarif_json(found->told["analysis"], PLUMB_VERSION) : "");
  folder.write("argument.svg", render::in_direction_words(render::argument_svg(shown), shown, field));
  if (folder.failure()) return report(*folder.failure());
  folder.leave_out("report.pdf");
  if (options.pdf) print_pdf(options.out, page);
  print(options.json ? text : summary(*found, options.out));
  const bool fit = found->verdict.fit == verification::Result::met;
  if (!fit) print_error("plumb: " + render::in_direction_words(found->verdict.sentence, shown, field) + "\n");
  return fit ? io::ExitCode::done : io::ExitCode::verification_failed;
}

}  // namespace

Command add_verify(const Options& tool) {
  auto options = std::make_shared<VerifyOptions>();
  const Options command = tool.add_command("verify", "a report on one array: what it can guarantee, with the evidence");
  command.add_option("--array", options->array, "the array file to verify, or a magnetic group of it: tool.toml#mag")
      .required()
      .type_name("ARRAY.toml");
  command.add_option("--limits", options->limits, "your limits; see below").type_name("LIMITS.toml");
  command.add_option("--calibration", options->calibration, "what `plumb calibrate` wrote for this array")
      .type_name("CAL.json");
  command
      .add_option("--days-since-calibration", options->days_since_calibration,
                  "the age of the calibration for which sizes and bounds are stated (stability_per_day); 0 by default")
      .range(0.0, kMostDaysSinceCalibration)
      .type_name("N");
  command.add_option("--stations", options->stations, "a log of attitudes held still, to calibrate from")
      .type_name("LOG.csv");
  add_known_attitude_option(command, options->known_attitudes);
  command
      .add_option("--scenarios", options->scenarios,
                  "of each campaign; by default 20000 up to 6 sensors, 10000 up to 8, 2000 up to 12, 500 above")
      .check(seed_refusal)
      .type_name("N");
  command.add_flag(
      "--thorough", [options] { options->scenarios = kThoroughScenarios; }, "a million scenarios of each campaign");
  command.add_option("--seed", options->seed, "of the campaigns and of the predicted calibration; 1 by default")
      .check(seed_refusal)
      .type_name("S");
  command.add_option("--out", options->out, "the directory to write; `verification` by default").type_name("DIR");
  command.add_option("--compare", options->compare, "an earlier report.json, to list what has changed since")
      .type_name("REPORT.json");
  command.add_option("--test-results", options->test_results, "results of plumb's own tests, from ctest --output-junit")
      .type_name("JUNIT.xml");
  command.add_option("--assurance", options->assurance, "results of scripts/assure: build/assure/results.json")
      .type_name("RESULTS.json");
  command
      .add_option("--traceability", options->traceability,
                  "your own requirements, hazards and tests in place of plumb's, in the format of a report's "
                  "traceability.json")
      .type_name("TRACE.json");
  command
      .add_option("--reuse", options->reuse,
                  "the finished result of faults.toml or healthy.toml with more scenarios, from plumb campaign or\n"
                  "plumb-campaign-mpi: its rates are judged; may be given twice")
      .type_name("RESULT.json");
  command.add_option("--analysis", options->analysis, "the output of clang-tidy; written as SARIF and evaluated")
      .type_name("LOG");
  command
      .add_option("--resources", options->resources, "the measurements of scripts/baremetal: build/metal/results.json")
      .type_name("RESULTS.json");
  command
      .add_option("--threads", options->threads,
                  "number of threads; the result does not depend on it; one per processor by default")
      .range(1, 1024)
      .type_name("N");
  command.add_flag("--pdf", options->pdf, "print the page to report.pdf too (needs weasyprint; takes half a minute)");
  command.add_flag("--json", options->json, "print the report as JSON instead of a summary");
  command.footer(kVerifyNotes + exit_codes_help());
  return {command, kVerifyAbout, [options] { return run_verify(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
