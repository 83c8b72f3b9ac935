#include "scene.hpp"

#include <limits>
#include <string>

#include "plumb/core/detail/archive.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace campaign_kernel {

using std::size_t;

Datasheet datasheet_of(const ToolPlan& tool) noexcept {
  Datasheet datasheet;
  datasheet.size = tool.sensors < kCapacity ? tool.sensors : kCapacity;
  for (int i = 0; i < datasheet.size; ++i) {
    const auto a = static_cast<size_t>(i);
    DatasheetSensor& sensor = datasheet.sensor[a];
    sensor.row.id = make_id(("a" + std::to_string(i + 1)).c_str());
    sensor.row.axis = tool.axis[a];
    sensor.row.sigma_mps2 = tool.sigma_mps2[a];
    sensor.row.chip = tool.chip[a];
    sensor.coefficients.scale[0] = tool.volt_per_mps2;
    sensor.resolution_raw = tool.resolution_raw;
  }
  return datasheet;
}

scenario::Tool tool_of(const Plan& plan, const Spec& spec, const Datasheet& datasheet) noexcept {
  if (!(spec.calibration_mps2 > 0.0)) return scenario::perfect_tool(datasheet);
  scenario::TruthSpans spans;
  spans.bias_mps2 = 2.0 * spec.calibration_mps2;
  spans.scale = spans.axis_rad = 2.0 * spec.calibration_mps2 / plan.gravity_mps2;
  return scenario::draw_tool(datasheet, spec.seed, spans);
}

double true_gravity_mps2(const Plan& plan, const Spec& spec) noexcept {
  return plan.gravity_mps2 + spec.gravity_sigmas * plan.gravity_sigma_mps2;
}

scenario::Fault fault_of(const campaign::SpecFault& fault) noexcept {
  scenario::Fault out;
  out.kind = static_cast<scenario::FaultKind>(fault.kind);
  out.sensor = fault.sensor;
  out.clock = scenario::Clock::station;
  out.onset = fault.onset_station;
  if (fault.duration_stations > 0.0) out.duration = fault.duration_stations;
  out.magnitude = fault.magnitude;
  out.upper = fault.upper;
  return out;
}

Vec3 direction_at(const AttitudePlan& attitude, int station, int stations, const scenario::Stream& stream) noexcept {
  switch (attitude.kind) {
    case campaign::AttitudeKind::random: break;
    case campaign::AttitudeKind::roll_test: {
      // Where the roll begins is drawn: else every scenario of a cell would see the same attitudes.
      const double first_rad = 2.0 * kPi * stream.uniform(0);
      return scenario::gravity_direction({attitude.inclination_rad, 0.0, first_rad + 2.0 * kPi * station / stations});
    }
    case campaign::AttitudeKind::drilling_path: {
      scenario::DrillingPath path;
      path.first = {attitude.inclination_rad, 0.0, 2.0 * kPi * stream.uniform(1000000)};
      path.build_rad = attitude.build_rad;
      path.turn_rad = attitude.turn_rad;
      path.toolface_step_rad = attitude.toolface_step_rad;
      path.toolface_jitter_rad = attitude.toolface_jitter_rad;
      return scenario::gravity_direction(scenario::attitude_at(path, station, stream));
    }
    case campaign::AttitudeKind::fixed: return attitude.direction;
  }
  return stream.direction(static_cast<std::uint64_t>(station));
}

double start_s(const Plan& plan) noexcept {
  if (plan.start == campaign::Start::power_on) return 0.0;
  return plan.validation_stations * (plan.samples / plan.rate_hz + plan.move_s);
}

Spec trust_spec(const Plan& plan, int tool) noexcept {
  Spec spec;
  spec.number = std::numeric_limits<std::uint64_t>::max();
  spec.seed = scenario::derive_seed(plan.seed, ~static_cast<std::uint64_t>(tool));
  spec.tool = tool;
  spec.attitude = -1;  // random, whatever the plan has
  spec.stations = plan.validation_stations;
  return spec;
}

scenario::Scenario scenario_of(const Plan& plan, const Spec& spec, double from_s) {
  scenario::Scenario out;
  out.tool = tool_of(plan, spec, datasheet_of(plan.tools[static_cast<size_t>(spec.tool)]));
  out.gravity_mps2 = true_gravity_mps2(plan, spec);
  const scenario::Stream stream(spec.seed, scenario::Purpose::attitude);
  const AttitudePlan anywhere;
  const AttitudePlan& attitude = spec.attitude < 0 ? anywhere : plan.attitudes[static_cast<size_t>(spec.attitude)];
  scenario::DirectionList list;
  for (int k = 0; k < spec.stations; ++k) {
    list.directions.push_back(direction_at(attitude, k, plan.stations, stream));
  }
  out.attitudes = std::move(list);
  out.rate_hz = plan.rate_hz;
  out.dwell_s = plan.samples / plan.rate_hz;
  out.move_s = plan.move_s;
  out.record_motion = false;
  out.tag_stations = true;
  out.start_s = from_s;
  for (int k = 0; k < spec.faults; ++k) out.faults.push_back(fault_of(spec.fault[static_cast<size_t>(k)]));
  out.seed = spec.seed;
  return out;
}

Expected<MonitorSetup> setup_of(const Plan& plan, int tool) noexcept {
  const Datasheet datasheet = datasheet_of(plan.tools[static_cast<size_t>(tool)]);
  const Expected<SensorArray> array = datasheet.array();
  if (!array) return tl::unexpected<Error>(array.error());
  MonitorSetup setup;
  setup.array = *array;
  setup.model = datasheet.model();
  setup.gravity = {plan.gravity_mps2, plan.gravity_sigma_mps2,
                   plan.magnetic ? GravityModel::magnetic : GravityModel::value};
  ArchiveReader reader(plan.monitor.data(), plan.monitor.size(), datasheet.size);
  reader.get(setup.config);
  if (!reader.sound()) return fail(Errc::out_of_range, 1, plan.window, kWindowCapacity);
  for (int i = 0; i < datasheet.size; ++i) {
    setup.resolution_raw[static_cast<size_t>(i)] = datasheet.sensor[static_cast<size_t>(i)].resolution_raw;
    const std::array<double, 4>& s = plan.tools[static_cast<size_t>(tool)].stability[static_cast<size_t>(i)];
    setup.stability[static_cast<size_t>(i)] = {s[0], s[1], s[2], s[3]};
  }
  setup.days_since_calibration = plan.days_since_calibration;
  if (plan.calibration_mps2 > 0.0) {
    RowUncertainty left;
    const double rows = 2.0 * plan.calibration_mps2 / plan.gravity_mps2;  // scale and axis, each as large as the bias
    for (int k = 0; k < 4 * datasheet.size; ++k) {
      const double sigma = k % 4 == 3 ? plan.calibration_mps2 : rows;
      left.covariance[static_cast<size_t>(k * (k + 1) / 2 + k)] = sigma * sigma;
    }
    setup.array.set_uncertainty(left);
  }
  return setup;
}

Vec3 common_turn_rad(const scenario::Tool& tool) noexcept {
  Vec3 first{}, second{}, third{}, moment{};
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const auto a = static_cast<size_t>(i);
    const Vec3& h = tool.datasheet.sensor[a].row.axis;
    first = plus(first, minus({1.0, 0.0, 0.0}, scaled(h, h[0])));
    second = plus(second, minus({0.0, 1.0, 0.0}, scaled(h, h[1])));
    third = plus(third, minus({0.0, 0.0, 1.0}, scaled(h, h[2])));
    moment = plus(moment, cross(h, tool.axes[a]));
  }
  const double det = dot(first, cross(second, third));
  if (!(det > 0.0)) return {};
  return {dot(moment, cross(second, third)) / det, dot(first, cross(moment, third)) / det,
          dot(first, cross(second, moment)) / det};
}

}  // namespace campaign_kernel
}  // namespace PLUMB_ABI
}  // namespace plumb
