// The array files of the tools in the scenario library. Texts that are meant to be read: only the axes are filled in.
#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr const char* kPaperHead =
    R"(# The paper's tool: three accelerometers on a cone about the tool axis z, the fourth along z.
# Datasheet values only. `plumb calibrate` estimates the true parameters of the sensors.
#   plumb geometry examples/paper_tool.toml
#   plumb simulate examples/stand.toml --out stand.csv
#   plumb calibrate --array examples/paper_tool.toml --log stand.csv --out cal.json
#   plumb simulate examples/drilling.toml |
#     plumb monitor --array examples/paper_tool.toml --calibration cal.json --log -
name = "paper-tetrahedron"

[gravity]
model = "value"          # or "normal" with latitude, elevation and depth
value = ")";

constexpr const char* kHexadHead =
    R"(# Six accelerometers of the paper's kind, normal to the faces of a dodecahedron: up to three faults can be isolated.
#   plumb geometry examples/hexad_tool.toml
#   plumb simulate examples/hexad_stand.toml --out stand.csv
#   plumb calibrate --array examples/hexad_tool.toml --log stand.csv --out cal.json
name = "hexad"

[gravity]
model = "value"          # or "normal" with latitude, elevation and depth
value = ")";

constexpr const char* kInput = R"( m/s^2"
sigma = "0.15 mg"        # its uncertainty, 1 sigma

[input]
reads = "gravity"        # a sensor that points down reads +1 g0
unit = "V"               # of the numbers in the log
time = "t_s"
station = "station"      # -1: no station known, plumb finds the still stretches by itself

[monitor]
alert_frame = "calibrated-axes"  # the limit is about the direction in the frame of the axes, not in the housing
)";

/// Beside id and axis all sensors are alike.
constexpr const char* kRest = R"(
scale = "3 V/g0"
noise = "200 ug0"                  # of one sample, 1 sigma
full_scale = "5 V"                 # 1.67 g0
resolution = "152.587890625 uV"    # 16 bits over +-5 V
prior = {bias = "20 mg0", scale = "2 %", axis = "0.035 rad"}
)";

/// "0.0" rather than "0": the axis reads as numbers.
std::string component(double value) {
  const std::string text = shortest(value == 0.0 ? 0.0 : value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string array_text(const char* head, const Datasheet& datasheet, double gravity_mps2) {
  std::string out = head + shortest(gravity_mps2) + kInput;
  for (int i = 0; i < datasheet.size; ++i) {
    const SensorRow& row = datasheet.sensor[static_cast<std::size_t>(i)].row;
    out += std::string("\n[[sensor]]\nid = \"") + row.id.data() + "\"\naxis = [" + component(row.axis[0]) + ", " +
           component(row.axis[1]) + ", " + component(row.axis[2]) + "]" + kRest;
  }
  return out;
}

}  // namespace

std::string paper_array_text(double gravity_mps2) {
  return array_text(kPaperHead, scenario::paper_datasheet(), gravity_mps2);
}

std::string hexad_array_text(double gravity_mps2) {
  return array_text(kHexadHead, scenario::hexad_datasheet(), gravity_mps2);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
