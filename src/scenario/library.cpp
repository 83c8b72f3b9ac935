#include "plumb/scenario/library.hpp"

#include <limits>
#include <utility>

#include "plumb/array/named.hpp"
#include "plumb/health/monitor_config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// Runs of one demo draw from different streams though they share a seed.
enum Part : std::uint64_t { kTruthPart = 0, kCalibrationPart = 1, kDrillingPart = 2, kDrillPart = 3 };

constexpr double kForGood = std::numeric_limits<double>::infinity();

/// Sensors like those of the paper's tool along the given axes.
Datasheet datasheet_of(const AxisList& axes, int n) noexcept {
  static constexpr const char* kIds[] = {"a1", "a2", "a3", "a4", "a5", "a6"};
  Datasheet datasheet;
  datasheet.size = n;
  datasheet.reads = Reads::gravity;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    DatasheetSensor& sensor = datasheet.sensor[i];
    sensor.row.id = make_id(kIds[i]);
    sensor.row.axis = axes[i];
    sensor.row.sigma_mps2 = kPaperNoise_mps2;
    sensor.coefficients.scale[0] = kPaperScale_VpMps2;
    sensor.full_scale_raw = kPaperFullScale_V;
    sensor.resolution_raw = kPaperResolution_V;
  }
  return datasheet;
}

Fault stuck(int sensor, double level_V, int station, double stations) noexcept {
  Fault fault;
  fault.sensor = sensor;
  fault.magnitude = level_V;
  fault.clock = Clock::station;
  fault.onset = station;
  fault.duration = stations;
  return fault;
}

/// A drilling run that begins at 20 deg, so that every sensor is moved from the first stations on.
Scenario drill_run(const Tool& tool, std::uint64_t seed, int stations, double build_deg) {
  Scenario scenario = drilling_run(tool, seed);
  DrillingPath path;
  path.stations = stations;
  path.first.inclination_rad = rad_from_deg(20.0);
  path.build_rad = rad_from_deg(build_deg);
  scenario.attitudes = path;
  scenario.seed = derive_seed(seed, kDrillPart);
  return scenario;
}

}  // namespace

Datasheet paper_datasheet() noexcept {
  AxisList axes{};
  const int n = paper_tetrahedron(axes);
  return datasheet_of(axes, n);
}

Tool paper_tool(std::uint64_t seed) noexcept { return draw_tool(paper_datasheet(), derive_seed(seed, kTruthPart)); }

Datasheet hexad_datasheet() noexcept {
  AxisList axes{};
  const int n = platonic(axes, 6);
  return datasheet_of(axes, n);
}

Tool hexad_tool(std::uint64_t seed) noexcept { return draw_tool(hexad_datasheet(), derive_seed(seed, kTruthPart)); }

Scenario calibration_run(const Tool& tool, std::uint64_t seed, int stations) {
  Scenario scenario;
  scenario.tool = tool;
  scenario.attitudes = RandomStations{stations};
  scenario.record_motion = false;
  scenario.tag_stations = true;
  scenario.seed = derive_seed(seed, kCalibrationPart);
  return scenario;
}

Scenario drilling_run(const Tool& tool, std::uint64_t seed, std::vector<Fault> faults) {
  Scenario scenario;
  scenario.tool = tool;
  scenario.attitudes = DrillingPath{};
  scenario.vibration_mps2 = 0.1 * kG0_mps2;
  scenario.faults = std::move(faults);
  scenario.seed = derive_seed(seed, kDrillingPart);
  return scenario;
}

Fault dead_at_station(int sensor, int station) noexcept { return stuck(sensor, 0.0, station, kForGood); }

Drill drill_a(const Tool& tool, std::uint64_t seed) {
  Drill drill;
  drill.scenario = drill_run(tool, seed, 30, 1.5);
  drill.scenario.faults = {stuck(1, 0.0, 6, 15), stuck(2, 3.0, 12, kForGood)};
  const std::uint64_t key = MonitorConfig().reset_key;
  const HostRequest wrong = {63.5, HostRequest::Kind::reset, SensorSet::of(1), key + 1};
  const HostRequest right = {64.0, HostRequest::Kind::reset, SensorSet::of(1), key};
  drill.requests = {wrong, right};
  return drill;
}

Drill drill_b(const Tool& tool, std::uint64_t seed) {
  Drill drill;
  drill.scenario = drill_run(tool, seed, 44, 1.5);
  Fault offset = stuck(1, 0.05 * kG0_mps2, 6, 20);
  offset.kind = FaultKind::bias_step;
  drill.scenario.faults = {offset, stuck(4, 0.0, 30, kForGood)};
  HostRequest recalibrate;
  recalibrate.time_s = 36.5;
  recalibrate.kind = HostRequest::Kind::recalibrate;
  drill.requests = {recalibrate};
  return drill;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
