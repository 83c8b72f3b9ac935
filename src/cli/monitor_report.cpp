#include "monitor_report.hpp"

#include "calibration_age.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "plot_files.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/report/health_page.hpp"
#include "plumb/report/identity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

namespace fs = std::filesystem;
using Json = report::Json;

/// As a shell takes it for one word.
std::string word(const std::string& text) {
  const bool plain =
      text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:=@%+,-") ==
      std::string::npos;
  if (plain && !text.empty()) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string command_of(const MonitorOptions& o) {
  std::string out = "plumb monitor --array " + word(o.array);
  out += o.calibrate_first ? " --calibrate-first" : " --calibration " + word(o.calibration);
  out += " --log " + word(o.log.path);
  if (o.log.on_bad_row == io::BadRowPolicy::skip) out += " --on-bad-row skip";
  if (!o.snapshot_in.empty()) out += " --snapshot-in " + word(o.snapshot_in);
  if (!o.roll_test.empty()) out += " --roll-test " + word(o.roll_test);
  for (const std::string& request : o.host) out += " --host " + word(request);
  return out + " --report " + word(o.report);
}

io::FileExpected<Json> inputs_of(const MonitorOptions& options, const io::ArrayFile& array, const MonitorRun& run) {
  Json out = Json::array({report::input_json("array", array.path, array.text)});
  const std::pair<const char*, const std::string&> files[] = {
      {"calibration", options.calibration}, {"snapshot", options.snapshot_in}, {"roll test", options.roll_test}};
  for (const auto& [role, path] : files) {
    if (path.empty()) continue;
    const io::FileExpected<std::string> bytes = io::read_file(path);
    if (!bytes) return tl::unexpected<io::FileError>(bytes.error());
    out.push_back(report::input_json(role, path, *bytes));
  }
  const std::string& log = options.log.path;
  out.push_back(io::object({{"role", "log"},
                            {"name", log == "-" ? "standard input" : fs::path(log).filename().string()},
                            {"bytes", run.log.bytes},
                            {"fnv1a", fmt::format("{:016x}", run.log.hash)}}));
  return out;
}

Json coefficients_of(const Calibration& calibration) {
  Json out = Json::array();
  for (int i = 0; i < calibration.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    const SensorCoefficients& c = calibration.model.sensor[a];
    out.push_back(io::object({{"id", calibration.array.row(i).id.data()},
                              {"bias_mps2", c.bias},
                              {"scale_raw_per_mps2", c.scale},
                              {"reference_degc", c.reference_degc},
                              {"axis", calibration.array.axis(i)},
                              {"sigma_mps2", calibration.array.sigma_mps2(i)},
                              {"e_cal_mps2", calibration.report.e_cal_mps2[a]},
                              {"residual_rms_mps2", calibration.report.residual_rms_mps2[a]}}));
  }
  return out;
}

/// The drift since the calibration that the limits allow for, of every sensor; 0 where it states no stability.
Json drift_of(const io::ArrayFile& array, double days) {
  const bool paper = array.monitor.mode == MonitorMode::paper;  // whose algorithm allows for none
  const Readings tolerance = io::tolerance_mps2(array, days);
  Json sensors = Json::array();
  for (int i = 0; i < array.array.size(); ++i)
    sensors.push_back(io::object({{"id", array.array.row(i).id.data()},
                                  {"tolerance_mps2", paper ? 0.0 : tolerance[static_cast<std::size_t>(i)]}}));
  return io::object({{"days_since_calibration", days},
                     {"text", paper ? "none allowed for: the paper's algorithm takes none" : drift_words(array, days)},
                     {"sensors", std::move(sensors)}});
}

/// What every verdict of the run rests on: the length of gravity, and the calibration as it was read.
io::FileExpected<Json> basis_of(const MonitorOptions& options, const io::ArrayFile& array, double days) {
  Json out = io::object({{"gravity", io::object({{"model", to_string(array.gravity.model)},
                                                 {"g_mps2", array.gravity.g_mps2},
                                                 {"sigma_mps2", array.gravity.sigma_mps2}})},
                         {"calibration", Json()},
                         {"drift", drift_of(array, days)}});
  if (options.calibration.empty()) return out;  // made in flight: events and snapshot tell of it
  const io::FileExpected<io::CalibrationFile> file = io::read_calibration(options.calibration, array);
  if (!file) return tl::unexpected<io::FileError>(file.error());
  const FitReport& fit = file->calibration.report;
  out["calibration"] = io::object({{"log", file->context.log_file},
                                   {"made_by", file->context.plumb_version},
                                   {"date", file->context.date},
                                   {"serial", file->context.serial},
                                   {"g_mps2", file->context.gravity.g_mps2},
                                   {"stations", fit.stations},
                                   {"norm_rms_mps2", fit.norm_rms_mps2},
                                   {"parity_rms_mps2", fit.parity_rms_mps2},
                                   {"p_value", fit.p_value},
                                   {"temperature_min_degc", fit.temperature_min_degc},
                                   {"temperature_max_degc", fit.temperature_max_degc},
                                   {"sensors", coefficients_of(file->calibration)}});
  return out;
}

/// A directory of its own, removed with all that is in it.
class Scratch {
 public:
  Scratch() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "plumb-report-XXXXXX").string();
    if (!error && ::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A page without pictures is a page still: what hinders the drawing is said in their place.
report::PagePictures pictures_of(const Json& report) {
  const std::vector<std::string> names = report::health_picture_names(report);
  report::PagePictures out;
  if (names.empty()) return out;
  const Scratch scratch;
  io::FileError failure{
      "TMPDIR", 0, "", "no directory can be made in it, so there is no picture", "name another", io::ExitCode::other};
  if (!scratch.path().empty()) {
    io::FileExpected<report::PagePictures> drawn =
        draw_pictures(scratch.path(), report::health_plot_files(report), report::kHealthScript, names);
    if (drawn) return *std::move(drawn);
    failure = drawn.error();
  }
  print_error("plumb: " + failure.text() + "\n");
  for (const std::string& name : names) out.emplace(name, report::PagePicture{"", failure.text()});
  return out;
}

}  // namespace

std::string health_data_path(const std::string& path) {
  const fs::path page(path);
  return page.extension() == ".html" && !page.stem().empty() ? fs::path(page).replace_extension(".json").string() : "";
}

std::optional<io::FileError> report_misuse(const MonitorOptions& options) {
  if (options.report.empty()) return std::nullopt;
  if (options.limits) {
    return io::FileError{"--report",         0, "", "tells of a run, and --limits makes none", "leave one of them out",
                         io::ExitCode::usage};
  }
  if (!health_data_path(options.report).empty()) return std::nullopt;
  return io::FileError{"--report",
                       0,
                       "",
                       "writes a page and its data beside it, so it needs the name of a page",
                       "name it FILE.html; the data go to FILE.json",
                       io::ExitCode::usage};
}

HealthReport::HealthReport(const MonitorOptions& options, const io::ArrayFile& array, const SensorArray& sensors,
                           double days, io::OutputFile page, io::OutputFile data)
    : options_(options),
      array_(array),
      sensors_(sensors),
      days_(days),
      page_(std::move(page)),
      data_(std::move(data)),
      health_(array.output_frame, array.input.rows == io::RowKind::stations, array.monitor.acceleration_bound_mps2),
      depth_m_(std::nan("")) {}

io::FileExpected<std::unique_ptr<HealthReport>> HealthReport::create(const MonitorOptions& options,
                                                                     const io::ArrayFile& array,
                                                                     const SensorArray& sensors,
                                                                     double days_since_calibration) {
  io::FileExpected<io::OutputFile> page = io::OutputFile::create(options.report, io::OutputFile::Mode::whole);
  if (!page) return tl::unexpected<io::FileError>(page.error());
  io::FileExpected<io::OutputFile> data =
      io::OutputFile::create(health_data_path(options.report), io::OutputFile::Mode::whole);
  if (!data) return tl::unexpected<io::FileError>(data.error());
  return std::unique_ptr<HealthReport>(
      new HealthReport(options, array, sensors, days_since_calibration, *std::move(page), *std::move(data)));
}

io::FileExpected<void> HealthReport::take(const Sample& sample, const Verdict& verdict) {
  health_.take(sample, verdict, depth_m_);
  return {};
}

io::FileExpected<void> HealthReport::write(const MonitorRun& run) {
  Json report = report::health_json(health_, sensors_);
  io::FileExpected<Json> inputs = inputs_of(options_, array_, run);
  if (!inputs) return tl::unexpected<io::FileError>(inputs.error());
  io::FileExpected<Json> basis = basis_of(options_, array_, days_);
  if (!basis) return tl::unexpected<io::FileError>(basis.error());
  report["basis"] = *std::move(basis);
  const char* const ended = run.stopped ? "in an error" : (run.interrupted ? "by an interruption" : "where it ends");
  report["identity"] =
      io::object({{"name", array_.name},
                  {"build", report::build_json()},
                  {"config_hash", fmt::format("{:016x}", run.last.config_hash)},
                  {"inputs", *std::move(inputs)},
                  {"log", io::object({{"rows", run.log.rows}, {"rows_bad", run.log.rows_bad}, {"ended", ended}})},
                  {"command", command_of(options_)}});
  Json& sensors = report["extremes"]["sensors"];
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    sensors[i]["cells_empty"] = run.log.missing[i];
    sensors[i]["cells_not_finite"] = run.log.not_finite[i];
  }
  report["run"] = io::object({{"time", now_utc()}, {"host", host_name()}});
  io::FileExpected<void> done = data_.write(report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  if (done) done = data_.commit();
  const std::string data_name = fs::path(health_data_path(options_.report)).filename().string();
  if (done) done = page_.write(report::health_html(report, pictures_of(report), data_name));
  if (done) done = page_.commit();
  return done;
}

std::string HealthReport::summary() const {
  std::string out = fmt::format("report      {}\n{}\n", options_.report, health_.sentence());
  for (const std::string& action : health_.actions()) out += "  - " + action + "\n";
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
