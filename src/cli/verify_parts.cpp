#include "verify_parts.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "figures.hpp"
#include "fit_summary.hpp"
#include "fit_words.hpp"
#include "model.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/scenario/library.hpp"
#include "plumb/scenario/scenario.hpp"
#include "plumb/study/paper_form.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr int kPlannedStations = 24;
constexpr double kPlannedDwell_s = 2.0;

double worst_of(const Calibration& calibration) {
  double out = 0.0;
  for (int i = 0; i < calibration.array.size(); ++i) out = std::fmax(out, calibration.report.e_cal_mps2[at(i)]);
  return out;
}

Json sensors_of(const Calibration& calibration) {
  Json out = Json::array();
  for (int i = 0; i < calibration.array.size(); ++i)
    out.push_back(io::object({{"id", calibration.array.row(i).id.data()},
                              {"e_cal_mps2", calibration.report.e_cal_mps2[at(i)]},
                              {"residual_rms_mps2", calibration.report.residual_rms_mps2[at(i)]}}));
  return out;
}

/// What the fit held for the case after every iteration, the datasheet first. Of a fit over temperature there is none.
Json trace_of(const CalibrationRun& run, const io::ArrayFile& array) {
  constexpr int kMostTraced = 1000;
  Json out = Json::array();
  if (!run.accepted || run.temperature.order > 0) return out;
  const auto add = [&out, &array](const study::CommonFrame& frame, const Json& cost) {
    Json sensors = Json::array();
    for (int i = 0; i < array.array.size(); ++i) {
      const SensorCoefficients& nominal = array.datasheet.sensor[at(i)].coefficients;
      const double along = dot(frame.axis[at(i)], array.array.axis(i));
      sensors.push_back(io::object({{"id", array.array.row(i).id.data()},
                                    {"bias_mps2", frame.bias_mps2[at(i)]},
                                    {"scale_change", frame.scale[at(i)] / nominal.scale[0] - 1.0},
                                    {"axis_shift_deg", deg_from_rad(std::acos(std::clamp(along, -1.0, 1.0)))}}));
    }
    out.push_back(io::object({{"iteration", out.size()}, {"cost", cost}, {"sensors", std::move(sensors)}}));
  };
  auto calibrator = std::make_unique<Calibrator>(array.datasheet, array.gravity, run.options);
  add(study::frame_of(array.datasheet, calibrator->parameters()), Json());
  const int stations = static_cast<int>(run.stations.size());
  for (int k = 0; k < kMostTraced && !calibrator->done(); ++k) {
    calibrator->iterate(run.stations.data(), stations);
    if (calibrator->iterations() == 0 || !std::isfinite(calibrator->cost())) continue;
    // The same point as the last iteration, turned onto the nominal axes: what the monitor is given.
    add(calibrator->done() ? study::frame_of(*run.accepted)
                           : study::frame_of(array.datasheet, calibrator->parameters()),
        calibrator->cost());
  }
  return out;
}

/// How many samples a row of this log stands for at least: what one row tells the monitor in the worst case.
std::uint32_t fewest_samples(const std::vector<Station>& stations) {
  const auto fewer = [](const Station& a, const Station& b) { return a.count < b.count; };
  const auto least = std::min_element(stations.begin(), stations.end(), fewer);
  return least == stations.end() ? 1 : std::max<std::uint32_t>(least->count, 1);
}

/// Of a fit that was made here.
CalibrationPart part_of(CalibrationRun run, const io::ArrayFile& array, const char* mode) {
  CalibrationPart out;
  out.section = io::object({{"mode", mode}, {"accepted", run.accepted != nullptr}});
  if (!run.accepted) {
    const Refusal refusal = refusal_of(run, array);
    out.section["reason"] = refusal.reason;
    out.section["remedy"] = refusal.next;
  }
  out.section["fit"] = io::parsed(fit_json(run, array));
  out.section["trace"] = trace_of(run, array);
  if (run.accepted) {
    out.section["sensors"] = sensors_of(*run.accepted);
    out.e_cal_mps2 = worst_of(*run.accepted);
    out.calibration = std::move(run.accepted);
  }
  return out;
}

/// Where down points in the stations of the stand, as angles.
Json planned_attitudes(const Json& stations) {
  Json out = Json::array();
  for (const Json& station : stations) {
    if (!station["down"].is_array()) continue;
    const double x = station["down"][0], y = station["down"][1], z = station["down"][2];
    const double turn = std::atan2(-x, -y);
    out.push_back(io::object({{"inclination_deg", deg_from_rad(std::acos(std::clamp(z, -1.0, 1.0)))},
                              {"toolface_deg", deg_from_rad(turn < 0.0 ? turn + 2.0 * kPi : turn)}}));
  }
  return out;
}

scenario::Scenario planned_stand(const io::ArrayFile& array, std::uint64_t seed) {
  scenario::Scenario out = scenario::calibration_run(
      scenario::draw_tool(array.datasheet, seed, smallest_priors(array.datasheet)), seed, kPlannedStations);
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

scenario::TruthSpans smallest_priors(const Datasheet& datasheet) {
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

io::FileExpected<CalibrationPart> calibration_of_file(const std::string& path, const io::ArrayFile& array) {
  const io::FileExpected<io::CalibrationFile> file = io::read_calibration(path, array);
  if (!file) return tl::unexpected<io::FileError>(file.error());
  CalibrationPart out;
  const FitReport& report = file->calibration.report;
  out.section = io::object({{"mode", "calibration file"}, {"accepted", true}});
  out.section["file"] = io::object({{"stations", report.stations},
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
                                    {"date", file->context.date},
                                    {"serial", file->context.serial},
                                    {"log", file->context.log_file},
                                    {"made_by", file->context.plumb_version}});
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
  const bool means = array.input.rows == io::RowKind::stations && !array.input.count_column.empty();
  const std::uint32_t fewest = means ? fewest_samples(run->stations) : 1;
  CalibrationPart out = part_of(*std::move(run), array, "positions");
  out.samples_per_row = fewest;
  return out;
}

CalibrationPart predicted_calibration(const io::ArrayFile& array, std::uint64_t seed) {
  const scenario::Scenario stand = planned_stand(array, seed);
  const double dwell_s = stand.dwell_s;
  auto simulator = scenario::Simulator::make(stand);
  if (!simulator) {
    CalibrationPart out;
    out.section = io::object({{"mode", "predicted"},
                              {"accepted", false},
                              {"reason", "the stand cannot be simulated: " + simulator.error()}});
    return out;
  }
  std::vector<Sample> samples;
  Sample sample;
  while (simulator->next(sample)) samples.push_back(sample);
  CalibrationPart out = part_of(run_calibration(array, samples), array, "predicted");
  out.section["planned"] = io::object({{"stations", kPlannedStations},
                                       {"samples_each", samples.size() / kPlannedStations},
                                       {"seconds_each", dwell_s},
                                       {"attitudes", planned_attitudes(out.section["fit"]["stations"])}});
  return out;
}

Json array_section(const GeometrySubject& subject, const GeometryStudy& study) {
  Json out = io::parsed(geometry_json(subject, study));
  Json map = Json::array();
  for (const report::GeometryPictures::Point& p : study.map)
    map.push_back({p.inclination_deg, p.toolface_deg, std::isfinite(p.clear_from_g0) ? Json(p.clear_from_g0) : Json(),
                   std::isfinite(p.nearest_mirror_g0) ? Json(p.nearest_mirror_g0) : Json(), p.blind_sensors});
  out["attitude_map"] = io::object({{"columns", io::texts({"inclination_deg", "toolface_deg", "clear_from_g0",
                                                           "nearest_mirror_g0", "blind_sensors"})},
                                    {"rows", std::move(map)}});
  return out;
}

namespace {

/// Pairs of modes that some cell leads from and to.
std::set<std::pair<std::string, std::string>> possible_moves(const Json& machine) {
  std::set<std::pair<std::string, std::string>> out;
  for (const Json& cell : machine["cells"]) {
    if (cell["kind"] != "taken") continue;
    for (const Json& to : cell["leads_to"]) {
      if (to != cell["mode"]) out.insert({cell["mode"].get<std::string>(), to.get<std::string>()});
    }
  }
  return out;
}

}  // namespace

Json machine_section(const Json& replayed) {
  Json out = io::parsed(model_json());
  if (replayed.is_null()) {
    out["coverage"] = Json();
    return out;
  }
  out["coverage"] = replayed["coverage"];
  out["coverage"]["moves_possible"] = possible_moves(out).size();
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
