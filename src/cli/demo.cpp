// plumb demo: the whole chain once through, on a simulated tool whose sensor dies. No file needed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "comparison.hpp"
#include "demo_files.hpp"
#include "demo_story.hpp"
#include "fit_summary.hpp"
#include "pipeline.hpp"
#include "plumb/report/page.hpp"
#include "plumb/report/plot.hpp"
#include "plumb/report/words.hpp"
#include "plumb/scenario/library.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct Options {
  std::string out = "plumb-demo";
  std::uint64_t seed = 1;
};

/// The sensor that dies, and the station at which it does.
constexpr int kDeadSensor = 1;
constexpr int kDeadStation = 6;
constexpr int kStations = 48;

constexpr const char* kAbout =
    "The whole chain once through, without any file of yours: simulates the paper's tool (four accelerometers,\n"
    "datasheet errors, noise), calibrates it from 48 attitudes, monitors a short drilling run in which one\n"
    "accelerometer dies, and writes logs, results, a plot and an index page.";
constexpr const char* kNotes =
    "Examples:\n"
    "  plumb demo\n"
    "  plumb demo --out /tmp/demo --seed 7\n\n"
    "Then open plumb-demo/index.html. The same seed gives the same bytes. Another seed draws another tool,\n"
    "other noise and other attitudes. The plot needs gnuplot; without it the rest is still written.\n"
    "Units: time in s, inclination in deg; statistic and limit in standard deviations.\n\n";

/// Opens an output of the demo, or says why not.
io::FileExpected<io::OutputFile> stream_to(const std::string& path) {
  return io::OutputFile::create(path, io::OutputFile::Mode::stream);
}

/// Everything between the log and the page: the same steps as `plumb calibrate` and `plumb monitor`.
class Demo {
 public:
  explicit Demo(const Options& options) : out_(options.out), seed_(options.seed) {}

  io::ExitCode run() {
    for (const auto step : {&Demo::prepare, &Demo::calibrate_tool, &Demo::monitor_tool, &Demo::show}) {
      const io::FileExpected<void> done = (this->*step)();
      if (!done) return report(done.error());
      if (!fit_.accepted && step == &Demo::calibrate_tool) return io::ExitCode::not_accepted;
    }
    return io::ExitCode::done;
  }

 private:
  std::string path(const char* name) const { return (std::filesystem::path(out_) / name).string(); }

  io::FileExpected<void> prepare() {
    std::error_code error;
    std::filesystem::create_directories(out_, error);
    if (error) {
      return tl::unexpected<io::FileError>(io::FileError{out_, 0, "", "cannot create the directory: " + error.message(),
                                                         "choose another directory with --out", io::ExitCode::other});
    }
    const scenario::Tool tool = scenario::paper_tool(seed_);
    const scenario::Scenario calibration = scenario::calibration_run(tool, seed_, kStations);
    const scenario::Scenario drilling =
        scenario::drilling_run(tool, seed_, {scenario::dead_at_station(kDeadSensor, kDeadStation)});
    io::FileExpected<void> written =
        io::write_file(path("array.toml"), paper_array_toml(tool.datasheet, drilling.gravity_mps2));
    if (!written) return written;
    io::FileExpected<io::ArrayFile> array = io::read_array_file(path("array.toml"));
    if (!array) return tl::unexpected<io::FileError>(array.error());
    array_ = std::make_unique<io::ArrayFile>(*std::move(array));
    const auto calibration_truth = write_log(path("calibration.csv"), *array_, calibration);
    if (!calibration_truth) return tl::unexpected<io::FileError>(calibration_truth.error());
    auto truth = write_log(path("drilling.csv"), *array_, drilling);
    if (!truth) return tl::unexpected<io::FileError>(truth.error());
    truth_ = *std::move(truth);
    into_frame_of_nominal_axes(tool, truth_);
    return {};
  }

  io::FileExpected<void> calibrate_tool() {
    const LogSpec log{path("calibration.csv"), io::BadRowPolicy::stop};
    io::FileExpected<CalibrationRun> fit = run_calibration(*array_, log);
    if (!fit) return tl::unexpected<io::FileError>(fit.error());
    fit_ = *std::move(fit);
    print(fmt::format("plumb demo, seed {}\n\n", seed_) + fit_text(fit_, *array_) + "\n");
    if (!fit_.accepted) return {};
    return save_calibration(path("calibration.json"), fit_, *array_, log.path);
  }

  io::FileExpected<void> monitor_tool() {
    const io::FileExpected<io::CalibrationFile> calibration = io::read_calibration(path("calibration.json"), *array_);
    if (!calibration) return tl::unexpected<io::FileError>(calibration.error());
    const auto monitor = make_monitor(*array_, calibration->calibration);
    if (!monitor) return tl::unexpected<io::FileError>(monitor.error());
    io::FileExpected<io::OutputFile> events = stream_to(path("events.jsonl"));
    if (!events) return tl::unexpected<io::FileError>(events.error());
    io::FileExpected<io::OutputFile> verdicts = stream_to(path("verdicts.jsonl"));
    if (!verdicts) return tl::unexpected<io::FileError>(verdicts.error());
    EventsFile events_file(*std::move(events), (*monitor)->array(), false);
    VerdictsFile verdicts_file(*std::move(verdicts), (*monitor)->array(), array_->output_frame, false, false);
    ComparisonSink comparison(*array_, calibration->calibration, truth_);
    const io::FileExpected<MonitorRun> done =
        run_monitor(**monitor, *array_, {path("drilling.csv"), io::BadRowPolicy::stop},
                    {&events_file, &verdicts_file, &comparison});
    if (!done) return tl::unexpected<io::FileError>(done.error());
    if (done->stopped) return tl::unexpected<io::FileError>(done->stop);
    const io::FileExpected<void> kept = events_file.commit();
    if (!kept) return kept;
    last_ = done->last;
    timeline_ = comparison.timeline();
    fault_s_ = comparison.fault_s();
    timeline_.marks.push_back({fault_s_, report::sensor_names(SensorSet::of(kDeadSensor), array_->array) + " dies"});
    return verdicts_file.commit();
  }

  /// The plot's SVG, or an empty text and the reason.
  io::FileExpected<std::string> draw(std::string& missing) const {
    const io::FileExpected<void> script =
        io::write_file(path("timeline.gp"), report::timeline_script(timeline_, "timeline.csv", "timeline.svg"));
    if (!script) return tl::unexpected<io::FileError>(script.error());
    const io::FileExpected<void> drawn = report::run_gnuplot(out_, "timeline.gp");
    if (drawn) return io::read_file(path("timeline.svg"));
    missing = drawn.error().text();
    print_error("plumb: " + missing + "\n");
    return std::string();
  }

  io::FileExpected<void> show() {
    print(report::table_header());
    for (const report::TimelineRow& row : timeline_.rows) print(report::table_line(row));
    io::FileExpected<void> written = io::write_file(path("timeline.csv"), report::timeline_csv(timeline_));
    if (!written) return written;
    report::RunPage page = demo_page({seed_, *array_, fit_, timeline_, last_, SensorSet::of(kDeadSensor), fault_s_});
    const io::FileExpected<std::string> svg = draw(page.plot_missing);
    if (!svg) return tl::unexpected<io::FileError>(svg.error());
    page.plot_svg = report::inline_svg(*svg);
    written = io::write_file(path("index.html"), report::run_html(page));
    if (!written) return written;
    std::string text = "\n";
    for (const std::string& line : page.story) text += "- " + line + "\n";
    print(text + fmt::format("\nwritten to {}: index.html (open this), ", out_) +
          "timeline.svg, timeline.csv, events.jsonl, verdicts.jsonl,\n  calibration.json, array.toml, calibration.csv, "
          "drilling.csv\n");
    return {};
  }

  std::string out_;
  std::uint64_t seed_;
  std::unique_ptr<io::ArrayFile> array_;
  std::vector<scenario::Truth> truth_;
  CalibrationRun fit_;
  Verdict last_;
  report::Timeline timeline_;
  double fault_s_ = 0.0;
};

io::ExitCode run(const Options& options) { return Demo(options).run(); }

}  // namespace

Command add_demo(CLI::App& tool) {
  auto options = std::make_shared<Options>();
  CLI::App* app = tool.add_subcommand("demo", "the whole chain on a simulated tool whose sensor dies; needs no file");
  app->add_option("--out", options->out, "the directory to write to, plumb-demo by default")->type_name("DIR");
  app->add_option("--seed", options->seed, "which tool, noise and attitudes are drawn, 1 by default")->type_name("N");
  app->footer(kNotes + exit_codes_help());
  return {app, kAbout, [options] { return run(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
