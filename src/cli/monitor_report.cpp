#include "monitor_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "plot_files.hpp"
#include "plumb/findings/geometry_study.hpp"
#include "plumb/io/field_json.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/basis_json.hpp"
#include "plumb/render/calibration_notes.hpp"
#include "plumb/render/detection_sizes.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/health_page.hpp"
#include "plumb/render/identity.hpp"
#include "plumb/render/sensor_notes.hpp"
#include "plumb/render/verification_field.hpp"
#include "plumb/render/wiring_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

namespace fs = std::filesystem;
using Json = render::Json;

std::string command_of(const MonitorOptions& o) {
  std::string out = "plumb monitor --array " + io::shell_word(o.array);
  out += o.calibrate_first ? " --calibrate-first" : " --calibration " + io::shell_word(o.calibration);
  out += " --log " + io::shell_word(o.log.path);
  if (o.log.on_bad_row == io::BadRowPolicy::skip) out += " --on-bad-row skip";
  if (!o.snapshot_in.empty()) out += " --snapshot-in " + io::shell_word(o.snapshot_in);
  if (!o.roll_test.empty()) out += " --roll-test " + io::shell_word(o.roll_test);
  for (const std::string& group : o.groups) out += " --group " + io::shell_word(group);
  for (const std::string& request : o.host) out += " --host " + io::shell_word(request);
  return out + " --report " + io::shell_word(o.report);
}

io::FileExpected<Json> inputs_of(const MonitorOptions& options, const io::ArrayFile& array,
                                 const session::MonitorRun& run) {
  Json out = Json::array({render::input_json("array", array.path, array.text)});
  const std::pair<const char*, const std::string&> files[] = {
      {"calibration", options.calibration}, {"snapshot", options.snapshot_in}, {"roll test", options.roll_test}};
  for (const auto& [role, path] : files) {
    if (path.empty()) continue;
    const io::FileExpected<std::string> bytes = io::read_file(path);
    if (!bytes) return tl::unexpected<io::FileError>(bytes.error());
    out.push_back(render::input_json(role, path, *bytes));
  }
  const std::string& log = options.log.path;
  out.push_back(io::object({{"role", "log"},
                            {"name", log == "-" ? "standard input" : fs::path(log).filename().string()},
                            {"bytes", run.log.bytes},
                            {"fnv1a", fmt::format("{:016x}", run.log.hash)}}));
  return out;
}

/// Of the tool that was monitored, before any fault shows.
Json sizes_of(const io::ArrayFile& array, const io::CalibrationFile& calibration, double days) {
  const SensorArray sensors = session::array_to_certify(array, calibration.calibration);
  return render::sizes_json(findings::size_table(sensors, array.gravity, findings::settings_of(array, days), true,
                                                 calibration.context.down, findings::full_scale_of(array)),
                            sensors.size());
}

/// What the verdicts of the run do not hold.
void put_counts(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors,
                Json& extremes) {
  extremes["blocks_in_motion"] = run.counts.known ? Json(run.counts.blocks_in_motion) : Json();
  extremes["blocks_in_motion_text"] = render::motion_words(run);
  Json& by_sensor = extremes["sensors"];
  for (std::size_t i = 0; i < by_sensor.size(); ++i) {
    render::put_sensor_counts(by_sensor[i], run, array, sensors, static_cast<int>(i));
    by_sensor[i]["cells_empty"] = run.log.missing[i];
    by_sensor[i]["cells_not_finite"] = run.log.not_finite[i];
  }
}

render::PagePictures pictures_of(const Json& report) {
  return draw_for_page(render::health_plot_files(report), render::kHealthScript, render::health_picture_names(report));
}

}  // namespace

std::string health_data_path(const std::string& path) {
  const fs::path page(path);
  return page.extension() == ".html" && !page.stem().empty() ? fs::path(page).replace_extension(".json").string() : "";
}

std::optional<io::FileError> report_misuse(const MonitorOptions& options) {
  if (options.report.empty()) return std::nullopt;
  if (options.limits) {
    return io::FileError{
        "--report",         0, "", "describes a run, and --limits runs nothing", "leave out one of the two",
        io::ExitCode::usage};
  }
  if (!health_data_path(options.report).empty()) return std::nullopt;
  return io::FileError{"--report",
                       0,
                       "",
                       "needs a file name that ends in .html",
                       "name it FILE.html; the data are written to FILE.json",
                       io::ExitCode::usage};
}

HealthReport::HealthReport(const MonitorOptions& options, const io::ArrayFile& array, const SensorArray& sensors,
                           double days, std::optional<io::CalibrationFile> calibration, io::OutputFile page,
                           io::OutputFile data)
    : options_(options),
      array_(array),
      sensors_(sensors),
      days_(days),
      calibration_(std::move(calibration)),
      page_(std::move(page)),
      data_(std::move(data)),
      health_(array.output_frame, array.input.rows == io::RowKind::stations, array.monitor.acceleration_bound_mps2),
      depth_m_(std::nan("")) {
  if (calibration_)
    residuals_.emplace(calibration_->calibration.model, calibration_->calibration.array, array.monitor.window);
}

io::FileExpected<std::unique_ptr<HealthReport>> HealthReport::create(const MonitorOptions& options,
                                                                     const io::ArrayFile& array,
                                                                     const SensorArray& sensors,
                                                                     double days_since_calibration) {
  io::FileExpected<io::OutputFile> page = io::OutputFile::create(options.report, io::OutputFile::Mode::whole);
  if (!page) return tl::unexpected<io::FileError>(page.error());
  io::FileExpected<io::OutputFile> data =
      io::OutputFile::create(health_data_path(options.report), io::OutputFile::Mode::whole);
  if (!data) return tl::unexpected<io::FileError>(data.error());
  std::optional<io::CalibrationFile> calibration;
  if (!options.calibration.empty()) {
    io::FileExpected<io::CalibrationFile> read = io::read_calibration(options.calibration, array);
    if (!read) return tl::unexpected<io::FileError>(read.error());
    calibration = *std::move(read);
  }
  return std::unique_ptr<HealthReport>(new HealthReport(options, array, sensors, days_since_calibration,
                                                        std::move(calibration), *std::move(page), *std::move(data)));
}

io::FileExpected<void> HealthReport::take(const Sample& sample, const Verdict& verdict) {
  health_.take(sample, verdict, depth_m_);
  if (residuals_) residuals_->take(sample, verdict, depth_m_);
  return {};
}

io::FileExpected<void> HealthReport::write(const session::MonitorRun& run, const render::MotionTold& motion) {
  io::FileExpected<Json> inputs = inputs_of(options_, array_, run);
  if (!inputs) return tl::unexpected<io::FileError>(inputs.error());
  const io::CalibrationFile* const calibration = calibration_ ? &*calibration_ : nullptr;
  if (render::common_cause_of(run, array_)) health_.doubt("one cause may have moved several sensors of one direction");
  if (!doubt_.empty()) health_.doubt(doubt_);
  beside_ = render::note_actions(run, array_, sensors_);
  for (std::string& action : render::motion_actions(motion, array_)) beside_.push_back(std::move(action));
  if (const std::string exact = calibration ? render::exact_words(*calibration, options_.calibration) : "";
      !exact.empty())
    beside_.push_back(exact);
  Json report = render::health_json(health_, sensors_, beside_);
  if (!groups_.is_null()) report["groups"] = groups_;
  put_counts(run, array_, sensors_, report["extremes"]);
  report["residuals"] = residuals_ ? render::residuals_json(*residuals_, sensors_) : Json();
  report["motion"] = render::motion_report_json(motion, motion_, array_);
  report["basis"] = render::basis_json(array_, calibration, days_);
  report["detection_sizes"] = calibration ? sizes_of(array_, *calibration, days_) : Json();
  const findings::WiringCheck wiring = findings::check_wiring_of(calibration, array_);
  report["basis"]["wiring"] = render::wiring_json(wiring, array_);
  report["answer"]["open_items"] = render::wiring_items(wiring, array_);
  const char* const ended = run.stopped ? "in an error" : (run.interrupted ? "by an interruption" : "log complete");
  report["identity"] =
      io::object({{"name", array_.name},
                  {"build", render::build_json()},
                  {"config_hash", fmt::format("{:016x}", run.last.config_hash)},
                  {"inputs", *std::move(inputs)},
                  {"log", io::object({{"rows", run.log.rows}, {"rows_bad", run.log.rows_bad}, {"ended", ended}})},
                  {"command", command_of(options_)}});
  report["run"] = io::object({{"time", now_utc()}, {"host", host_name()}});
  io::FileExpected<void> done =
      data_.write(io::in_field_units(report, array_.field).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  if (done) done = data_.commit();
  const std::string data_name = fs::path(health_data_path(options_.report)).filename().string();
  const Json shown = io::with_fine_as_mg0(report, array_.field);
  if (done)
    done = page_.write(
        render::in_direction_words(render::health_html(shown, pictures_of(shown), data_name), array_.field));
  if (done) done = page_.commit();
  return done;
}

std::string HealthReport::summary() const {
  std::string out = fmt::format("report      {}\n{}\n", options_.report, health_.sentence());
  for (const std::string& action : health_.actions(sensors_, beside_)) out += "  - " + action + "\n";
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
