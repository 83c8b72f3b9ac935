// A scene as files that the tool reads: the array file, its stand, the run, and the commands that play them.
#include <fmt/format.h>

#include "explorer.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/exact_text.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/records.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb_web {

using namespace plumb;

namespace {

constexpr const char* kArrayFile = "array.toml";

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

std::string array_text(const Datasheet& datasheet, const io::RawUnit& unit) {
  const GravityReference gravity;
  std::string out = fmt::format(
      "# The tool of a scene of plumb's explorer. play.sh beside it calibrates and monitors it.\nname = "
      "\"explorer\"\n\n"
      "[gravity]\nmodel = \"value\"\nvalue = \"{} m/s^2\"\nsigma = \"{}\"\n\n",
      io::shortest(gravity.g_mps2), io::exact_text(io::Quantity::acceleration, gravity.sigma_mps2, {"mg0", "m/s^2"}));
  out +=
      "[input]\nreads = \"gravity\"\nunit = \"V\"\ntime = \"t_s\"\nstation = \"station\"\n\n"
      "[monitor]\nalert_frame = \"calibrated-axes\"\n";
  for (int i = 0; i < datasheet.size; ++i) out += sensor_text(datasheet.sensor[static_cast<std::size_t>(i)], unit);
  return out;
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
  const scenario::Simulator* const played = world();
  if (played == nullptr) {
    return refusal(
        "a flight is no scenario of stations. Remedy: choose a motion from station to station, or play it by "
        "plumb simulate --flight with the array file of the first view");
  }
  io::ScenarioFile file;
  file.array_path = kArrayFile;
  file.array.datasheet = played->scenario().tool.datasheet;
  file.array.input.unit = {io::RawUnit::Kind::voltage, 1.0, "V", io::FieldKind::gravity};
  io::Json out;
  out[kArrayFile] = array_text(file.array.datasheet, file.array.input.unit);
  file.name = "stand";
  file.scenario = scenario::calibration_run(played->scenario().tool, stand_seed_);
  out["stand.toml"] = io::scenario_text(file);
  file.name = "run";
  file.scenario = played->scenario();
  out["run.toml"] = io::scenario_text(file);
  out["play.sh"] = commands(requests_);
  return out.dump();
}

}  // namespace plumb_web
