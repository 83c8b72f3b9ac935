#include "verify_parts.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fit_summary.hpp"
#include "fit_words.hpp"
#include "model.hpp"
#include "plumb/core/units.hpp"
#include "plumb/scenario/library.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr int kPlannedStations = 24;
constexpr double kPlannedDwell_s = 2.0;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double worst_of(const Calibration& calibration) {
  double out = 0.0;
  for (int i = 0; i < calibration.array.size(); ++i) out = std::fmax(out, calibration.report.e_cal_mps2[at(i)]);
  return out;
}

Json sensors_of(const Calibration& calibration) {
  Json out = Json::array();
  for (int i = 0; i < calibration.array.size(); ++i)
    out.push_back({{"id", calibration.array.row(i).id.data()},
                   {"e_cal_mps2", calibration.report.e_cal_mps2[at(i)]},
                   {"residual_rms_mps2", calibration.report.residual_rms_mps2[at(i)]}});
  return out;
}

/// Of a fit that was made here.
CalibrationPart part_of(CalibrationRun run, const io::ArrayFile& array, const char* mode) {
  CalibrationPart out;
  out.section = {{"mode", mode}, {"accepted", run.accepted != nullptr}};
  if (!run.accepted) {
    const Refusal refusal = refusal_of(run, array);
    out.section["reason"] = refusal.reason;
    out.section["remedy"] = refusal.next;
  }
  out.section["fit"] = Json::parse(fit_json(run, array));
  if (run.accepted) {
    out.section["sensors"] = sensors_of(*run.accepted);
    out.e_cal_mps2 = worst_of(*run.accepted);
    out.calibration = std::move(run.accepted);
  }
  return out;
}

/// The smallest prior of any sensor: the drawn ones lie within all of them.
scenario::TruthSpans spans_of(const Datasheet& datasheet) {
  const Prior& first = datasheet.sensor[0].prior;
  scenario::TruthSpans out{first.bias_mps2, first.scale, first.axis_rad, scenario::TruthSpans::Shape::uniform};
  for (int i = 1; i < datasheet.size; ++i) {
    const Prior& prior = datasheet.sensor[at(i)].prior;
    out.bias_mps2 = std::fmin(out.bias_mps2, prior.bias_mps2);
    out.scale = std::fmin(out.scale, prior.scale);
    out.axis_rad = std::fmin(out.axis_rad, prior.axis_rad);
  }
  return out;
}

scenario::Scenario planned_stand(const io::ArrayFile& array, std::uint64_t seed) {
  scenario::Scenario out = scenario::calibration_run(
      scenario::draw_tool(array.datasheet, seed, spans_of(array.datasheet)), seed, kPlannedStations);
  out.gravity_mps2 = array.gravity.g_mps2;
  if (array.input.rate_hz > 0.0) out.rate_hz = array.input.rate_hz;
  // A row that is a station is one sample, with the noise that the array file states for it.
  const bool rows = array.input.rows == io::RowKind::stations;
  const double samples =
      rows ? 1.0 : std::fmax(static_cast<double>(array.monitor.window), kPlannedDwell_s * out.rate_hz);
  out.dwell_s = samples / out.rate_hz;
  return out;
}

}  // namespace

io::FileExpected<CalibrationPart> calibration_of_file(const std::string& path, const io::ArrayFile& array) {
  const io::FileExpected<io::CalibrationFile> file = io::read_calibration(path, array);
  if (!file) return tl::unexpected<io::FileError>(file.error());
  CalibrationPart out;
  const FitReport& report = file->calibration.report;
  out.section = {{"mode", "calibration file"}, {"accepted", true}};
  out.section["file"] = {{"stations", report.stations},
                         {"parameters", report.parameters},
                         {"rank", report.rank},
                         {"gauge", report.gauge},
                         {"condition", report.condition},
                         {"excitation", report.excitation},
                         {"norm_rms_mps2", report.norm_rms_mps2},
                         {"parity_rms_mps2", report.parity_rms_mps2},
                         {"p_value", report.p_value},
                         {"outliers", report.outliers},
                         {"temperature_min_degc", report.temperature_min_degc},
                         {"temperature_max_degc", report.temperature_max_degc},
                         {"log", file->context.log_file},
                         {"made_by", file->context.plumb_version}};
  out.section["sensors"] = sensors_of(file->calibration);
  out.e_cal_mps2 = worst_of(file->calibration);
  out.calibration = std::make_unique<const Calibration>(file->calibration);
  return out;
}

io::FileExpected<CalibrationPart> calibration_of_positions(const std::string& path, const io::ArrayFile& array) {
  LogSpec log;
  log.path = path;
  io::FileExpected<CalibrationRun> run = run_calibration(array, log);
  if (!run) return tl::unexpected<io::FileError>(run.error());
  return part_of(*std::move(run), array, "positions");
}

CalibrationPart predicted_calibration(const io::ArrayFile& array, std::uint64_t seed) {
  auto simulator = scenario::Simulator::make(planned_stand(array, seed));
  if (!simulator) {
    CalibrationPart out;
    out.section = {
        {"mode", "predicted"}, {"accepted", false}, {"reason", "the stand cannot be simulated: " + simulator.error()}};
    return out;
  }
  std::vector<Sample> samples;
  Sample sample;
  while (simulator->next(sample)) samples.push_back(sample);
  CalibrationPart out = part_of(run_calibration(array, samples), array, "predicted");
  out.section["planned"] = {{"stations", kPlannedStations}, {"samples", samples.size()}, {"attitudes", "random"}};
  return out;
}

Json array_section(const GeometrySubject& subject, const GeometryStudy& study) {
  Json out = Json::parse(geometry_json(subject, study));
  Json map = Json::array();
  for (const report::GeometryPictures::Point& p : study.map)
    map.push_back({p.inclination_deg, p.toolface_deg, std::isfinite(p.clear_from_g0) ? Json(p.clear_from_g0) : Json(),
                   std::isfinite(p.nearest_mirror_g0) ? Json(p.nearest_mirror_g0) : Json(), p.blind_sensors});
  out["attitude_map"] = {
      {"columns", {"inclination_deg", "toolface_deg", "clear_from_g0", "nearest_mirror_g0", "blind_sensors"}},
      {"rows", std::move(map)}};
  return out;
}

Json machine_section(const Json& replayed) {
  Json out = Json::parse(model_json());
  if (replayed.is_null()) {
    out["coverage"] = Json();
    return out;
  }
  out["coverage"] = replayed["coverage"];
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
