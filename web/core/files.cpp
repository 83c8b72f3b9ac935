// A scene as files that the tool reads: the array file, its stand, the run, and the commands that play them.
#include <fmt/format.h>

#include "explorer.hpp"
#include "flight_run.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/exact_text.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/records.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/motion/motion_sets.hpp"
#include "plumb/scenario/fault_text.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb_web {

using namespace plumb;

namespace {

constexpr const char* kArrayFile = "array.toml";
constexpr const char* kCommands = "play.sh";

/// "0.0" rather than "0": the axis reads as numbers.
std::string axis_component(double value) {
  const std::string text = io::shortest(value == 0.0 ? 0.0 : value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// "3 V/g0" where that is the same number.
std::string scale_text(double scale_VpMps2, const io::RawUnit& unit) {
  const std::string per_g0 = fmt::format("{:.12g} V/g0", scale_VpMps2 * kG0_mps2);
  const io::FileExpected<double> back = io::parse_scale(per_g0, unit);
  return back && *back == scale_VpMps2 ? per_g0 : io::shortest(scale_VpMps2) + " V/(m/s^2)";
}

std::string sensor_text(const DatasheetSensor& sensor, const io::RawUnit& unit) {
  const Vec3& axis = sensor.row.axis;
  std::string out = fmt::format("\n[[sensor]]\nid = \"{}\"\naxis = [{}, {}, {}]\n", sensor.row.id.data(),
                                axis_component(axis[0]), axis_component(axis[1]), axis_component(axis[2]));
  out += fmt::format("scale = \"{}\"\n", scale_text(sensor.coefficients.scale[0], unit));
  out += fmt::format("noise = \"{}\"  # of one sample, 1 sigma\n",
                     io::exact_text(io::Quantity::acceleration, sensor.row.sigma_mps2, {"ug0", "m/s^2"}));
  out += fmt::format("full_scale = \"{} V\"\nresolution = \"{} V\"\n", io::shortest(sensor.full_scale_raw),
                     io::shortest(sensor.resolution_raw));
  if (sensor.row.chip != 0) out += fmt::format("package = \"imu{}\"\n", sensor.row.chip);
  return out;
}

const io::RawUnit& volts() {
  static const io::RawUnit unit = {io::RawUnit::Kind::voltage, 1.0, "V", io::FieldKind::gravity};
  return unit;
}

io::ArrayFile array_file_of(const Datasheet& datasheet) {
  io::ArrayFile out;
  out.datasheet = datasheet;
  out.input.unit = volts();
  return out;
}

/// All before the sensors. `input`: what [input] says beside the unit and the time.
std::string array_head(const std::string& input, const std::string& does) {
  const GravityReference gravity;
  std::string out = fmt::format(
      "# The tool of a scene of plumb's explorer. play.sh beside it {}.\nname = \"explorer\"\n\n"
      "[gravity]\nmodel = \"value\"\nvalue = \"{} m/s^2\"\nsigma = \"{}\"\n\n",
      does, io::shortest(gravity.g_mps2),
      io::exact_text(io::Quantity::acceleration, gravity.sigma_mps2, {"mg0", "m/s^2"}));
  return out + "[input]\nunit = \"V\"\ntime = \"t_s\"\n" + input + "\n[monitor]\nalert_frame = \"calibrated-axes\"\n";
}

std::string array_text(const Datasheet& datasheet) {
  std::string out = array_head("reads = \"gravity\"\nstation = \"station\"\n", "calibrates and monitors it");
  for (int i = 0; i < datasheet.size; ++i) out += sensor_text(datasheet.sensor[static_cast<std::size_t>(i)], volts());
  return out;
}

std::string key(const char* name, double value) { return fmt::format("{} = {}\n", name, io::shortest(value)); }

/// [motion] and [gyro]: the bounds of all sensors are alike.
std::string motion_text(const MotionSetup& setup) {
  const MotionErrors& e = setup.errors[0];
  const GyroErrors& g = setup.gyro;
  return "\n[motion]\n" + key("sample_period_s", setup.sample_period_s) +
         key("rate_bound_radps", setup.rate_bound_radps) + key("lever_arm_bound_m", e.lever_m) +
         key("lag_bound_s", e.lag_s) + key("vibration_rectification_per_mps2", e.rectification) +
         key("scale_bound", e.scale) + key("axis_bound_rad", e.axis_rad) + key("bias_bound_mps2", e.bias_mps2) +
         "\n[gyro]  # each of the two\n" + key("scale_bound", g.scale) + key("axis_bound_rad", g.axis_rad) +
         key("bias_bound_radps", g.bias_radps) + key("noise_radps", g.noise_radps) + key("lag_bound_s", g.lag_s);
}

std::string flight_array_text(const FlightPlan& plan) {
  std::string out = array_head(
                        "reads = \"specific-force\"\nrotation_radps = [\"wx\", \"wy\", \"wz\"]\n"
                        "second_rotation_radps = [\"ux\", \"uy\", \"uz\"]\n",
                        "flies and monitors it") +
                    motion_text(plan.setup);
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.datasheet.size); ++i) {
    const Vec3& arm = plan.setup.lever_arm_m[i];
    out += sensor_text(plan.datasheet.sensor[i], volts());
    out += fmt::format("lever_arm_m = [{}, {}, {}]\n", axis_component(arm[0]), axis_component(arm[1]),
                       axis_component(arm[2]));
  }
  return out;
}

/// The tool does not begin where nothing would come of it (`session::plan_motion`); the page shows that nothing does.
bool is_judged_in_motion(const Datasheet& datasheet) {
  const Expected<SensorArray> array = datasheet.array();
  return array && MotionSets(*array).size() > 0;
}

/// The sensors come calibrated: the nominal coefficients count, and no stand is needed.
std::string flight_commands(const FlightPlan& plan) {
  const scenario::FaultContext context = io::fault_context(array_file_of(plan.datasheet));
  std::string out = fmt::format(
      "#!/bin/sh\n# The scene, played by the tool: the flight, and what the monitor says of it.\nset -e\n"
      "plumb simulate --flight {} array.toml --seed {} --duration {}",
      to_string(plan.spec.kind), plan.spec.seed, io::shortest(plan.duration_s));
  for (const scenario::Fault& fault : plan.faults) out += " \\\n  --fault '" + to_text(fault, context) + "'";
  return out +
         " \\\n  --out flight.csv --truth truth.csv\n"
         "plumb monitor --array array.toml --calibrate-first --log flight.csv \\\n"
         "  --motion motion.csv --events events.jsonl\n";
}

/// A request stands in quotes of the shell; an apostrophe is none of its letters.
std::string commands(const std::vector<std::string>& requests) {
  std::string out =
      "#!/bin/sh\n# The scene, played by the tool: the stand, the calibration, the run, and what the monitor says of "
      "it.\n"
      "set -e\n"
      "plumb simulate stand.toml --out stand.csv\n"
      "plumb calibrate --array array.toml --log stand.csv --out calibration.json\n"
      "plumb simulate run.toml --out run.csv --truth truth.csv\n"
      "plumb monitor --array array.toml --calibration calibration.json --log run.csv \\\n"
      "  --events events.jsonl --verdicts verdicts.jsonl --every-sample";
  for (const std::string& request : requests) out += " \\\n  --host '" + request + "'";
  return out + "\n";
}

}  // namespace

std::string Play::files() const {
  io::Json out;
  if (flight_ != nullptr) {
    if (!is_judged_in_motion(flight_->plan().datasheet))
      return refusal(
          "the axes do not check each other whatever the force is, and the tool does not judge them in motion. Remedy: "
          "choose four axes, three in a plane or two parallel ones");
    out[kArrayFile] = flight_array_text(flight_->plan());
    out[kCommands] = flight_commands(flight_->plan());
    return out.dump();
  }
  const scenario::Simulator* const played = world();
  if (played == nullptr) return refusal("no scene has begun. Remedy: choose a story, or an array");
  io::ScenarioFile file;
  file.array_path = kArrayFile;
  file.array = array_file_of(played->scenario().tool.datasheet);
  out[kArrayFile] = array_text(file.array.datasheet);
  file.name = "stand";
  file.scenario = scenario::calibration_run(played->scenario().tool, stand_seed_);
  out["stand.toml"] = io::scenario_text(file);
  file.name = "run";
  file.scenario = played->scenario();
  out["run.toml"] = io::scenario_text(file);
  out[kCommands] = commands(requests_);
  return out.dump();
}

}  // namespace plumb_web
