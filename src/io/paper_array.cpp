// The array file of the paper's tool. A text rather than a generator: it is meant to be read.
#include "plumb/io/scenario_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr const char* kHead =
    R"(# The paper's tool: three accelerometers on a cone about the tool axis z, the fourth along z.
# Only what a datasheet says. What the sensors really do is found by `plumb calibrate`.
#   plumb geometry examples/paper_tool.toml
#   plumb simulate examples/stand.toml --out stand.csv
#   plumb calibrate --array examples/paper_tool.toml --log stand.csv --out cal.json
#   plumb simulate examples/drilling.toml |
#     plumb monitor --array examples/paper_tool.toml --calibration cal.json --log -
name = "paper-tetrahedron"

[gravity]
model = "value"          # or "normal" with latitude, elevation and depth
value = ")";

constexpr const char* kInput = R"( m/s^2"
sigma = "0.15 mg"        # how far it may be off, 1 sigma

[input]
reads = "gravity"        # a sensor that points down reads +1 g0
unit = "V"               # of the numbers in the log
time = "t_s"
station = "station"      # -1: no station known, plumb finds the still stretches by itself
)";

/// Beside id and axis all sensors are alike.
constexpr const char* kRest = R"(
scale = "3 V/g0"
noise = "200 ug0"                  # of one sample, 1 sigma
full_scale = "5 V"                 # 1.67 g0
resolution = "152.587890625 uV"    # 16 bits over +-5 V
prior = {bias = "20 mg0", scale = "2 %", axis = "0.035 rad"}
)";

struct IdAndAxis {
  const char* id;
  const char* axis;
};

// Eq (16) to the last bit, so that the file holds the tool of `scenario::paper_datasheet` itself.
constexpr IdAndAxis kSensors[] = {{"a1", "[0.9428090415820635, 0.0, 0.3333333333333333]"},
                                  {"a2", "[-0.47140452079103173, 0.8164965809277259, 0.3333333333333333]"},
                                  {"a3", "[-0.47140452079103173, -0.8164965809277259, 0.3333333333333333]"},
                                  {"a4", "[0.0, 0.0, 1.0]"}};

}  // namespace

std::string paper_array_text(double gravity_mps2) {
  std::string out = kHead + shortest(gravity_mps2) + kInput;
  for (const IdAndAxis& sensor : kSensors) {
    out += std::string("\n[[sensor]]\nid = \"") + sensor.id + "\"\naxis = " + sensor.axis + kRest;
  }
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
