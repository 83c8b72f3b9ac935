#include "plumb/testing/case.hpp"

#include <cstdio>

#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/scenario/fault_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace testing {
namespace {

constexpr double kRate_hz = 100.0;
constexpr double kGravitySigma_mps2 = 1e-4 * kG0_mps2;

Datasheet datasheet_of(const SensorArray& array) {
  Datasheet datasheet;
  datasheet.size = array.size();
  for (int i = 0; i < array.size(); ++i) {
    DatasheetSensor& sensor = datasheet.sensor[static_cast<std::size_t>(i)];
    sensor.row = array.row(i);
    sensor.resolution_raw = kG0_mps2 / 65536.0;
  }
  return datasheet;
}

/// The fault as the scenario counts its stations.
scenario::Fault placed(scenario::Fault fault) {
  fault.clock = scenario::Clock::station;
  fault.onset += kTrustStations;
  return fault;
}

scenario::AttitudeLaw attitudes_of(const Case& c) {
  const int stations = kTrustStations + c.stations;
  if (c.walk == Walk::rolling) return scenario::RollTest{c.inclination_rad, stations, 0.0};
  if (c.walk == Walk::drilling) {
    scenario::DrillingPath path;
    path.stations = stations;
    path.first.inclination_rad = c.inclination_rad;
    path.build_rad = rad_from_deg(1.0);
    return path;
  }
  return scenario::RandomStations{stations};
}

std::string id_of(const SensorArray& array, int i) { return array.row(i).id.data(); }

/// As an array file would say it.
std::string array_toml(const SensorArray& array) {
  std::string text =
      "name = \"case\"\n[gravity]\nmodel = \"value\"\nvalue = \"9.80665 m/s^2\"\nsigma = \"0.1 mg0\"\n"
      "[input]\ntime = \"t_s\"\nstation = \"station\"\nreads = \"gravity\"\nunit = \"m/s^2\"\n";
  for (int i = 0; i < array.size(); ++i) {
    const Vec3& axis = array.axis(i);
    char line[200];
    std::snprintf(line, sizeof line, "axis = [%.17g, %.17g, %.17g]\nnoise = \"%.17g m/s^2\"\n", axis[0], axis[1],
                  axis[2], array.sigma_mps2(i));
    text +=
        "[[sensor]]\nid = \"" + id_of(array, i) + "\"\ncolumn = \"" + id_of(array, i) + "\"\nscale = \"1\"\n" + line;
    std::snprintf(line, sizeof line, "resolution = \"%.17g m/s^2\"\n", kG0_mps2 / 65536.0);
    text += line;
  }
  return text;
}

}  // namespace

SensorSet faulty_of(const Case& c) noexcept {
  SensorSet set;
  for (const scenario::Fault& fault : c.faults) {
    if (fault.sensor != scenario::kWholeLog) set = set.with(fault.sensor);
    if (fault.kind == scenario::FaultKind::exchange) set = set.with(static_cast<int>(fault.magnitude));
  }
  return set;
}

scenario::Scenario scenario_of(const Case& c) {
  scenario::Scenario out;
  out.seed = c.seed;
  scenario::TruthSpans spans;
  spans.bias_mps2 = 2.0 * c.calibration_mps2;
  spans.scale = 2.0 * c.calibration_mps2 / kG0_mps2;
  spans.axis_rad = spans.scale;
  out.tool = scenario::draw_tool(datasheet_of(c.array), scenario::derive_seed(c.seed, 0), spans);
  out.gravity_mps2 = kG0_mps2 + c.gravity_error * kGravitySigma_mps2;
  out.attitudes = attitudes_of(c);
  out.rate_hz = kRate_hz;
  out.dwell_s = kStationBlocks * c.config.window / kRate_hz;
  out.move_s = 1.0;
  out.record_motion = false;
  out.tag_stations = true;
  out.noise.white = c.noise;
  for (const scenario::Fault& fault : c.faults) out.faults.push_back(placed(fault));
  return out;
}

MonitorSetup setup_of(const Case& c) {
  MonitorSetup setup;
  setup.array = c.array;
  setup.model = datasheet_of(c.array).model();
  setup.gravity = {kG0_mps2, kGravitySigma_mps2, GravityModel::value};
  setup.config = c.config;
  if (c.calibration_mps2 > 0.0) {
    RowUncertainty left;
    for (int k = 0; k < 4 * c.array.size(); ++k) {
      const double sigma = k % 4 == 3 ? c.calibration_mps2 : 2.0 * c.calibration_mps2 / kG0_mps2;
      left.covariance[static_cast<std::size_t>(k * (k + 1) / 2 + k)] = sigma * sigma;
    }
    setup.array.set_uncertainty(left);
  }
  return setup;
}

std::string sentence_of(const Case& c) {
  scenario::FaultContext context;
  context.datasheet = datasheet_of(c.array);
  context.raw = scenario::FaultContext::Raw::acceleration;
  context.raw_unit = "m/s^2";
  std::string text = count_text(c.array.size(), "sensor") + ", " + count_text(kTrustStations, "station") +
                     " for validation and " + std::to_string(c.stations) + " more";
  if (c.walk != Walk::random) {
    char where[60];
    std::snprintf(where, sizeof where, ", %s inclination %g deg",
                  c.walk == Walk::rolling ? "rolling at" : "drilling from", deg_from_rad(c.inclination_rad));
    text += where;
  }
  text += ": ";
  if (c.faults.empty()) return text + "no fault.";
  for (std::size_t k = 0; k < c.faults.size(); ++k) {
    text += (k == 0 ? "" : "; ") + scenario::describe(placed(c.faults[k]), context);
  }
  return text + ".";
}

std::string toml_of(const Case& c) {
  io::ScenarioFile file;
  file.name = "case";
  auto array = io::parse_array_text(array_toml(c.array), "case.toml");
  if (!array) return "# " + array.error().text() + "\n";
  file.array = *std::move(array);
  file.array_inline = true;
  file.scenario = scenario_of(c);
  return io::scenario_text(file);
}

}  // namespace testing
}  // namespace PLUMB_ABI
}  // namespace plumb
