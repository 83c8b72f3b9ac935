#include "plumb/scenario/library.hpp"

#include <utility>

#include "plumb/array/named.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// Runs of one demo draw from different streams though they share a seed.
enum Part : std::uint64_t { kTruthPart = 0, kCalibrationPart = 1, kDrillingPart = 2 };

}  // namespace

Datasheet paper_datasheet() noexcept {
  static constexpr const char* kIds[] = {"a1", "a2", "a3", "a4"};
  AxisList axes{};
  Datasheet datasheet;
  datasheet.size = paper_tetrahedron(axes);
  datasheet.reads = Reads::gravity;
  for (std::size_t i = 0; i < 4; ++i) {
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

Tool paper_tool(std::uint64_t seed) noexcept { return draw_tool(paper_datasheet(), derive_seed(seed, kTruthPart)); }

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

Fault dead_at_station(int sensor, int station) noexcept {
  Fault fault;
  fault.kind = FaultKind::stuck_level;
  fault.sensor = sensor;
  fault.clock = Clock::station;
  fault.onset = station;
  fault.magnitude = 0.0;
  return fault;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
