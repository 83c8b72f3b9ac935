// Sections 5 and 6 of the demo: a tool is calibrated and led through the states of the monitor.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "comparison.hpp"
#include "demo_picture.hpp"
#include "demo_section.hpp"
#include "demo_story.hpp"
#include "plumb/findings/alignment.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/render/fit_report.hpp"
#include "plumb/render/timeline_plot.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/library.hpp"
#include "plumb/session/calibration_pipeline.hpp"
#include "plumb/session/monitor_pipeline.hpp"
#include "plumb/session/played_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct DrillPlan {
  std::string id;  ///< also the directory
  std::string title;
  std::string gist;
  std::vector<std::string> text;
  std::string array_text;
  scenario::Tool tool;
  scenario::Drill drill;
};

template <class T>
tl::unexpected<io::FileError> passed_on(const io::FileExpected<T>& failed) {
  return tl::unexpected<io::FileError>(failed.error());
}

/// The same steps as `plumb simulate`, `calibrate` and `monitor`, on the same files.
class DrillSection {
 public:
  DrillSection(const DemoContext& context, DrillPlan plan)
      : plan_(std::move(plan)), out_(std::filesystem::path(context.out) / plan_.id), seed_(context.seed) {}

  io::FileExpected<DemoSection> run() {
    for (const auto step : {&DrillSection::write_logs, &DrillSection::calibrate_tool, &DrillSection::monitor_tool}) {
      const io::FileExpected<void> done = (this->*step)();
      if (!done) return passed_on(done);
    }
    io::FileExpected<render::Picture> picture = draw_timeline();
    if (!picture) return passed_on(picture);
    return section(*std::move(picture));
  }

 private:
  std::string path(const char* name) const { return (out_ / name).string(); }

  /// A scenario file beside its log, every drawn error of the sensors spelled out.
  io::FileExpected<void> write_scenario(const char* name, const scenario::Scenario& scenario) const {
    io::ScenarioFile file;
    file.name = std::filesystem::path(name).stem().string();
    file.array_path = "array.toml";
    file.array = *array_;
    file.scenario = scenario;
    return io::write_scenario(path(name), file);
  }

  io::FileExpected<void> write_logs() {
    std::error_code error;
    std::filesystem::create_directories(out_, error);
    if (error) {
      return tl::unexpected<io::FileError>(io::FileError{out_.string(), 0, "",
                                                         "cannot create the directory: " + error.message(),
                                                         "choose another directory with --out", io::ExitCode::other});
    }
    io::FileExpected<void> written = io::write_file(path("array.toml"), plan_.array_text);
    if (!written) return written;
    io::FileExpected<io::ArrayFile> array = io::read_array_file(path("array.toml"));
    if (!array) return passed_on(array);
    array_ = std::make_unique<io::ArrayFile>(*std::move(array));
    const scenario::Scenario stand = scenario::calibration_run(plan_.tool, seed_);
    written = write_scenario("stand.toml", stand);
    if (written) written = write_scenario("drill.toml", plan_.drill.scenario);
    if (!written) return written;
    const auto stand_truth = session::write_log(path("calibration.csv"), *array_, stand);
    if (!stand_truth) return passed_on(stand_truth);
    auto truth = session::write_log(path("drill.csv"), *array_, plan_.drill.scenario);
    if (!truth) return passed_on(truth);
    truth_ = *std::move(truth);
    session::into_frame_of_nominal_axes(plan_.tool, truth_);
    return {};
  }

  io::FileExpected<void> calibrate_tool() {
    const session::LogSpec log{path("calibration.csv"), io::BadRowPolicy::stop};
    io::FileExpected<session::CalibrationRun> fit = session::run_calibration(*array_, log);
    if (!fit) return passed_on(fit);
    if (!fit->accepted) {
      const render::Refusal refusal = render::refusal_of(*fit, *array_);
      return tl::unexpected<io::FileError>(
          io::FileError{log.path, 0, "", refusal.reason, refusal.next, io::ExitCode::not_accepted});
    }
    return session::save_calibration(path("calibration.json"), *fit, *array_, log.path);
  }

  io::FileExpected<void> monitor_tool() {
    const io::FileExpected<io::CalibrationFile> calibration = io::read_calibration(path("calibration.json"), *array_);
    if (!calibration) return passed_on(calibration);
    const auto monitor =
        session::make_monitor(findings::with_alignment(*array_, &*calibration), &calibration->calibration);
    if (!monitor) return passed_on(monitor);
    io::FileExpected<io::OutputFile> events =
        io::OutputFile::create(path("events.jsonl"), io::OutputFile::Mode::stream);
    if (!events) return passed_on(events);
    io::FileExpected<io::OutputFile> verdicts =
        io::OutputFile::create(path("verdicts.jsonl"), io::OutputFile::Mode::stream);
    if (!verdicts) return passed_on(verdicts);
    session::EventsFile events_file(*std::move(events), (*monitor)->array(), false);
    session::VerdictsFile verdicts_file(*std::move(verdicts), (*monitor)->array(), array_->output_frame, false, false);
    ComparisonSink comparison(*array_, calibration->calibration, truth_);
    scenario::Host host(plan_.drill.requests);
    const io::FileExpected<session::MonitorRun> done = session::run_monitor(
        **monitor, *array_, {path("drill.csv")}, {&events_file, &verdicts_file, &comparison}, host);
    if (!done) return passed_on(done);
    if (done->stopped) return tl::unexpected<io::FileError>(done->stop);
    const io::FileExpected<void> kept = events_file.commit();
    if (!kept) return kept;
    record_.emplace(DrillRecord{*array_, plan_.drill.scenario,
                                fault_records(plan_.drill.scenario.faults, comparison.timeline()), host.answers(),
                                comparison.timeline()});
    record_->timeline.marks = marks_of(*record_);
    return verdicts_file.commit();
  }

  io::FileExpected<render::Picture> draw_timeline() const {
    const io::FileExpected<void> written =
        io::write_file(path("timeline.csv"), render::timeline_csv(record_->timeline));
    if (!written) return passed_on(written);
    return draw(
        out_.string(), "timeline",
        [this](bool narrow) { return render::timeline_script(record_->timeline, "timeline.csv", "timeline", narrow); },
        "The run in one picture",
        "Every dot is one block of samples taken while the tool stands still; the gaps are the moves between "
        "stations. Without plumb: the plain least-squares answer of all sensors with the same calibration. Amber "
        "dots are outputs that plumb publishes as unconfirmed; in the state failed it publishes none. Inclination is "
        "measured in the frame of the array: gravity does not show how the array is mounted in its housing.");
  }

  std::vector<std::string> commands() const {
    std::vector<std::string> out = {
        "cd " + plan_.id, "plumb simulate stand.toml --out calibration.csv",
        "plumb calibrate --array array.toml --log calibration.csv --out calibration.json",
        "plumb simulate drill.toml --out drill.csv",
        "plumb monitor --array array.toml --calibration calibration.json --log drill.csv \\"};
    for (const scenario::HostRequest& request : plan_.drill.requests) {
      out.push_back("    --host \"" + scenario::to_text(request, array_->array) + "\" \\");
    }
    out.emplace_back("    --events events.jsonl --verdicts verdicts.jsonl");
    out.emplace_back("gnuplot timeline.gp");
    return out;
  }

  std::vector<render::FileLink> files() const {
    const std::string at = plan_.id + "/";
    return {{at + "array.toml", "the array: axes, scales and noise as a datasheet gives them"},
            {at + "stand.toml", "the calibration stand as a scenario, with the true sensor parameters"},
            {at + "calibration.csv", "its log, in volts"},
            {at + "calibration.json", "the calibration that plumb estimated"},
            {at + "drill.toml", "the drill as a scenario, the faults included"},
            {at + "drill.csv", "its log, in volts"},
            {at + "events.jsonl", "one line per change of state"},
            {at + "verdicts.jsonl", "one line per block at rest: state, statistic, limit, sensors, vector, bound"},
            {at + "timeline.csv", "the data of the picture, with the true values"}};
  }

  DemoSection section(render::Picture picture) const {
    DemoSection out;
    out.chapter.id = plan_.id;
    out.chapter.title = plan_.title;
    out.chapter.gist = plan_.gist;
    out.chapter.text = plan_.text;
    out.chapter.figures = key_figures(*record_);
    out.chapter.story = story_of(*record_);
    out.chapter.pictures = {std::move(picture)};
    out.chapter.tables = {changes_table(record_->timeline), states_table()};
    out.chapter.commands = commands();
    out.chapter.files = files();
    link_drawn(out.chapter, plan_.id + "/timeline", "the picture");
    out.facts = facts_of(*record_);
    out.facts["commands"] = out.chapter.commands;
    const DrillFigures f = figures_of(record_->timeline);
    out.console = plan_.title + "\n ";
    for (const render::TimelineRow& row : record_->timeline.rows) {
      out.console += fmt::format(" {:.1f} s {}", row.time_s, to_string(row.state));
    }
    out.console += fmt::format(
        "\n"
        "  inclination error: {:.2g} deg in valid outputs of plumb, {:.2g} deg without plumb; within the bound in {} "
        "of {} blocks\n",
        f.published_deg, f.plain_deg, f.kept, f.bounded);
    return out;
  }

  DrillPlan plan_;
  std::filesystem::path out_;
  std::uint64_t seed_;
  std::unique_ptr<io::ArrayFile> array_;
  std::vector<scenario::Truth> truth_;
  std::optional<DrillRecord> record_;
};

}  // namespace

io::FileExpected<DemoSection> demo_drill_a(const DemoContext& context) {
  DrillPlan plan;
  plan.id = "drill_a";
  plan.title = "5 Drill A: four sensors";
  plan.gist =
      "Two of four sensors fail, one after the other; the host resets; the recovered sensor is validated again.";
  plan.text = {
      "The paper's tool surveys a well. Two of its four sensors fail on the way, one after the other. With four "
      "sensors the first fault can be isolated. With the three that are left the second fault can be detected but "
      "not isolated, and plumb reports that. When one of the two sensors works again, the host resets the monitor."};
  plan.tool = context.tool;
  plan.drill = scenario::drill_a(context.tool, context.seed);
  plan.array_text = io::paper_array_text(plan.drill.scenario.gravity_mps2);
  return DrillSection(context, std::move(plan)).run();
}

io::FileExpected<DemoSection> demo_drill_b(const DemoContext& context) {
  DrillPlan plan;
  plan.id = "drill_b";
  plan.title = "6 Drill B: six sensors";
  plan.gist = "A fault, a recalibration in flight, a second fault; the sensor that recovers is reinstated.";
  plan.text = {
      "A tool of six such sensors, normal to the faces of a dodecahedron, surveys a longer stretch. With this "
      "redundancy plumb provisionally excludes a suspected sensor at once, tests the others and stays usable. A "
      "sensor that is healthy again is reinstated only after it has agreed with the others for long enough.",
      "In between the host asks for a recalibration: biases and scales are estimated again from the survey stations, "
      "while the present coefficients stay in use. Nothing has drifted here, so the new ones are at best as good as "
      "those from the stand. The run shows that they must pass their tests, and that the sensors must be validated "
      "again."};
  plan.tool = scenario::hexad_tool(context.seed);
  plan.drill = scenario::drill_b(plan.tool, context.seed);
  plan.array_text = io::hexad_array_text(plan.drill.scenario.gravity_mps2);
  return DrillSection(context, std::move(plan)).run();
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
