#include "scene.hpp"

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/findings/best_turn.hpp"
#include "plumb/scenario/fault_text.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb_web {

using namespace plumb;

namespace {

constexpr int kMostStations = 200;

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

int stations_asked(const json& scene) {
  const double stations = number(scene, "stations", 14.0);
  return stations >= 1.0 && stations <= kMostStations ? static_cast<int>(stations) : kMostStations;
}

}  // namespace

std::string motion_of(const json& scene) {
  const auto found = scene.find("motion");
  return found != scene.end() && found->is_string() ? found->get<std::string>() : "stations";
}

Make paper_make() {
  return {scenario::kPaperScale_VpMps2, scenario::kPaperFullScale_V, scenario::kPaperResolution_V, Reads::gravity};
}

Datasheet datasheet_of(const AxisList& axes, const ChipList& chips, int n, double noise_mps2, const Make& make) {
  Datasheet out;
  out.size = n;
  out.reads = make.reads;
  for (int i = 0; i < n; ++i) {
    DatasheetSensor& sensor = out.sensor[slot(i)];
    sensor.row = row_of(axes, chips, i, noise_mps2);
    sensor.coefficients.scale[0] = make.scale_per_mps2;
    sensor.full_scale_raw = make.full_scale_raw;
    sensor.resolution_raw = make.resolution_raw;
  }
  return out;
}

std::vector<Station> stations_of(const scenario::Tool& tool, const SensorArray& array, const GravityReference& gravity,
                                 std::uint64_t seed) {
  std::vector<Station> out;
  auto stand = scenario::Simulator::make(scenario::calibration_run(tool, seed));
  if (!stand) return out;
  const SensorModel model = tool.datasheet.model();
  const MonitorConfig config;
  StationFinder::Settings settings;
  settings.station_angle_rad = config.station_angle_rad;
  settings.max_gap_s = config.max_gap_s;
  const auto finder = std::make_unique<StationFinder>(array, gravity.g_mps2, settings);
  Station finished;
  for (Sample sample; stand->next(sample);) {
    const SensorSet usable = sample.delivered & array.all();
    const Readings y = model.apply(sample.raw, sample.temperature_degc, usable);
    if (finder->add(sample, y, usable, finished)) out.push_back(finished);
  }
  if (finder->finish(finished)) out.push_back(finished);
  return out;
}

scenario::Scenario world_of(const json& scene, const scenario::Tool& tool) {
  scenario::Scenario out = scenario::drilling_run(tool, 1);
  const double inclination_rad = rad_from_deg(number(scene, "inclination_deg", 20.0));
  if (motion_of(scene) == "roll") {
    scenario::RollTest roll;
    roll.inclination_rad = inclination_rad;
    roll.stations = stations_asked(scene);
    out.attitudes = roll;
  } else {
    scenario::DrillingPath path;
    path.stations = stations_asked(scene);
    path.first.inclination_rad = inclination_rad;
    path.build_rad = rad_from_deg(number(scene, "build_deg", 1.5));
    path.toolface_step_rad = rad_from_deg(number(scene, "toolface_step_deg", 137.5));
    out.attitudes = path;
  }
  out.dwell_s = number(scene, "dwell_s", 2.0);
  out.move_s = number(scene, "move_s", 1.0);
  out.vibration_mps2 = number(scene, "vibration_mps2", 0.1 * kG0_mps2);
  out.seed = seed_of(scene, "seed", 3.0);
  return out;
}

std::unique_ptr<MonitorSetup> setup_of(const Datasheet& datasheet, const Calibration& fit,
                                       const GravityReference& gravity) {
  auto out = std::make_unique<MonitorSetup>();
  out->model = fit.model;
  out->array = fit.array;
  out->gravity = gravity;
  out->config.alert_frame = AlertFrame::calibrated_axes;
  out->config.temperature_min_degc = fit.report.temperature_min_degc;
  out->config.temperature_max_degc = fit.report.temperature_max_degc;
  for (int i = 0; i < datasheet.size; ++i) {
    out->full_scale_raw[slot(i)] = datasheet.sensor[slot(i)].full_scale_raw;
    out->resolution_raw[slot(i)] = datasheet.sensor[slot(i)].resolution_raw;
  }
  return out;
}

Mat3 turn_of(const scenario::Tool& tool) {
  findings::BestTurn best;
  for (int i = 0; i < tool.datasheet.size; ++i) {
    best.add(tool.datasheet.sensor[slot(i)].row.axis, tool.axes[slot(i)]);
  }
  const findings::Turn turn = best.find(findings::Hand::kept);
  Mat3 out{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) out[3 * r + c] = turn[r][c];
  }
  return out;
}

tl::expected<SceneFaults, std::string> faults_of(const json& scene, const Datasheet& datasheet) {
  scenario::FaultContext context;
  context.datasheet = datasheet;
  SceneFaults out;
  for (const std::string& text : texts(scene, "faults")) {
    const auto faults = scenario::parse_faults(text, context);
    if (!faults) return tl::unexpected<std::string>(text + ": " + faults.error());
    for (const scenario::Fault& fault : *faults) {
      out.words.push_back(scenario::describe(fault, context));
      out.faults.push_back(fault);
    }
  }
  return out;
}

tl::expected<std::vector<scenario::HostRequest>, std::string> requests_of(const json& scene, const SensorArray& array) {
  std::vector<scenario::HostRequest> out;
  for (const std::string& text : texts(scene, "requests")) {
    const auto request = scenario::parse_host_request(text, array);
    if (!request) return tl::unexpected<std::string>(text + ": " + request.error());
    out.push_back(*request);
  }
  return out;
}

}  // namespace plumb_web
