// Reading and writing of scenarios; what is refused is in scenario_refusal_test.cpp.
#include "plumb/io/scenario_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <tuple>

#include "io_test_support.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/scenario/library.hpp"

namespace scenario_file_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;
using namespace plumb::scenario;

const std::string kShortest = "tool = \"paper\"\n[attitude]\nlaw = \"drilling-path\"\n";

ScenarioFile scenario_of(const std::string& text, const std::string& path = "scenario.toml") {
  auto file = parse_scenario_text(text, path);
  if (!file) {
    ADD_FAILURE() << file.error().text();
    return {};
  }
  return *std::move(file);
}

template <std::size_t N>
bool same_bits(const std::array<double, N>& a, const std::array<double, N>& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

void expect_same_tool(const Tool& a, const Tool& b) {
  ASSERT_EQ(a.datasheet.size, b.datasheet.size);
  EXPECT_EQ(a.model.size, b.model.size);
  EXPECT_EQ(a.model.reads, b.model.reads);
  EXPECT_TRUE(same_bits(a.model.misalignment, b.model.misalignment));
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.datasheet.size); ++i) {
    const DatasheetSensor& s = a.datasheet.sensor[i];
    const DatasheetSensor& t = b.datasheet.sensor[i];
    EXPECT_STREQ(s.row.id.data(), t.row.id.data());
    EXPECT_EQ(s.row.axis, t.row.axis) << i;
    EXPECT_EQ(s.row.sigma_mps2, t.row.sigma_mps2) << i;
    EXPECT_EQ(s.full_scale_raw, t.full_scale_raw) << i;
    EXPECT_EQ(s.resolution_raw, t.resolution_raw) << i;
    EXPECT_EQ(s.prior.bias_mps2, t.prior.bias_mps2) << i;
    EXPECT_EQ(s.prior.scale, t.prior.scale) << i;
    EXPECT_EQ(s.prior.axis_rad, t.prior.axis_rad) << i;
    EXPECT_EQ(s.coefficients.scale, t.coefficients.scale) << i;
    EXPECT_TRUE(same_bits(a.axes[i], b.axes[i])) << i;
    EXPECT_TRUE(same_bits(a.lever_arm_m[i], b.lever_arm_m[i])) << i;
    EXPECT_TRUE(same_bits(a.model.sensor[i].bias, b.model.sensor[i].bias)) << i;
    EXPECT_TRUE(same_bits(a.model.sensor[i].scale, b.model.sensor[i].scale)) << i;
    EXPECT_EQ(a.model.sensor[i].reference_degc, b.model.sensor[i].reference_degc) << i;
  }
}

void expect_same(const Scenario& a, const Scenario& b) {
  expect_same_tool(a.tool, b.tool);
  EXPECT_EQ(a.gravity_mps2, b.gravity_mps2);
  EXPECT_EQ(a.attitudes.index(), b.attitudes.index());
  const auto one = directions_of(a.attitudes, 1);
  const auto two = directions_of(b.attitudes, 1);
  ASSERT_TRUE(one && two);
  ASSERT_EQ(one->size(), two->size());
  for (std::size_t k = 0; k < one->size(); ++k) EXPECT_TRUE(same_bits((*one)[k], (*two)[k])) << k;
  EXPECT_EQ(a.rate_hz, b.rate_hz);
  EXPECT_EQ(a.dwell_s, b.dwell_s);
  EXPECT_EQ(a.move_s, b.move_s);
  EXPECT_EQ(a.vibration_mps2, b.vibration_mps2);
  EXPECT_EQ(a.record_motion, b.record_motion);
  EXPECT_EQ(a.tag_stations, b.tag_stations);
  EXPECT_EQ(a.start_s, b.start_s);
  EXPECT_EQ(a.noise.white, b.noise.white);
  EXPECT_EQ(a.noise.quantise, b.noise.quantise);
  EXPECT_EQ(a.noise.clip, b.noise.clip);
  EXPECT_EQ(a.temperature.start_degc, b.temperature.start_degc);
  EXPECT_EQ(a.temperature.rate_degc_per_s, b.temperature.rate_degc_per_s);
  EXPECT_EQ(a.noise.instability.sigma_mps2, b.noise.instability.sigma_mps2);
  EXPECT_EQ(a.noise.instability.correlation_s, b.noise.instability.correlation_s);
  EXPECT_EQ(a.noise.instability.walk_mps2, b.noise.instability.walk_mps2);
  EXPECT_EQ(a.rest_vibration_mps2, b.rest_vibration_mps2);
  EXPECT_EQ(a.turning.rate_radps, b.turning.rate_radps);
  EXPECT_TRUE(same_bits(a.turning.axis, b.turning.axis));
  EXPECT_EQ(a.turning.from_s, b.turning.from_s);
  EXPECT_EQ(a.turning.until_s, b.turning.until_s);
  EXPECT_EQ(a.depth.station_spacing_m, b.depth.station_spacing_m);
  EXPECT_EQ(a.depth.gravity_per_s2, b.depth.gravity_per_s2);
  EXPECT_EQ(a.depth.heat_degc_per_m, b.depth.heat_degc_per_m);
  EXPECT_EQ(a.faults, b.faults);
  EXPECT_EQ(a.seed, b.seed);
}

/// Reads back what is written; also the text stays as it is.
void expect_round_trip(const ScenarioFile& file, const std::string& path = "scenario.toml") {
  const std::string text = scenario_text(file);
  const ScenarioFile back = scenario_of(text, path);
  EXPECT_EQ(back.name, file.name);
  EXPECT_EQ(back.array_path, file.array_path);
  expect_same(back.scenario, file.scenario);
  EXPECT_EQ(scenario_text(back), text);
  // JSON says the same.
  const std::string json = scenario_json(file);
  ASSERT_EQ(json.substr(0, 1), "{");
  const ScenarioFile from_json = scenario_of(json, path);
  expect_same(from_json.scenario, file.scenario);
  EXPECT_EQ(scenario_text(from_json), text);
  EXPECT_EQ(scenario_json(from_json), json);
}

TEST(ScenarioFile, ShortestFileHasTheDefaultsOfTheLibrary) {
  const ScenarioFile file = scenario_of(kShortest);
  EXPECT_EQ(file.name, "scenario");
  EXPECT_EQ(file.array.array.size(), 4);
  Scenario expected;
  expected.tool = paper_tool(1);  // the tool of `plumb demo`, so that its calibration fits
  expected.attitudes = DrillingPath{};
  expect_same(file.scenario, expected);
}

TEST(ScenarioFile, ArraysOfTheLibraryAreTheirToolsAndTheExamples) {
  const std::string examples = std::string(PLUMB_SOURCE_DIR) + "/examples/";
  const std::tuple<const char*, std::string, Datasheet> tools[] = {
      {"paper_tool.toml", paper_array_text(kG0_mps2), paper_datasheet()},
      {"hexad_tool.toml", hexad_array_text(kG0_mps2), hexad_datasheet()}};
  for (const auto& [name, text, datasheet] : tools) {
    const ArrayFile array = array_of(text);
    expect_same_tool(perfect_tool(array.datasheet), perfect_tool(datasheet));
    EXPECT_EQ(array.gravity.g_mps2, kG0_mps2);
    const auto example = read_file(examples + name);
    ASSERT_TRUE(example);
    EXPECT_EQ(*example, text) << "renew it: `plumb demo` writes it as array.toml of a drill";
  }
}

TEST(ScenarioFile, DrillsOfTheExamplesAreThoseOfTheLibrary) {
  const Tool four = paper_tool(1), six = hexad_tool(1);
  const std::pair<const char*, Scenario> drills[] = {{"drill_a.toml", drill_a(four, 1).scenario},
                                                     {"drill_b.toml", drill_b(six, 1).scenario}};
  for (const auto& [name, scenario] : drills) {
    const auto file = read_scenario(std::string(PLUMB_SOURCE_DIR) + "/examples/" + name);
    ASSERT_TRUE(file) << file.error().text();
    Scenario expected = scenario;
    expected.seed = file->scenario.seed;  // of the noise: the library derives it
    expect_same(file->scenario, expected);
  }
}

/// Two triads, one of them turned, with what the tool is exposed to; the array stands in the scenario itself.
const std::string kTwoTriads = R"(
name = "two triads"
seed = 3
[array]
name = "triads"
[array.gravity]
model = "value"
value = "9.81 m/s^2"
sigma = "0.1 mg0"
[array.input]
time = "t_s"
reads = "specific-force"
unit = "m/s^2"
[[array.sensor]]
id = "x1"
column = "x1"
axis = [1.0, 0.0, 0.0]
scale = "1"
noise = "0.2 mg0"
prior = {bias = "20 mg", scale = "2 %", axis = "2 deg"}
[[array.sensor]]
id = "y1"
column = "y1"
axis = [0.0, 1.0, 0.0]
scale = "1"
noise = "0.2 mg0"
[[array.sensor]]
id = "z1"
column = "z1"
axis = [0.0, 0.0, 1.0]
scale = "1"
noise = "0.2 mg0"
[[array.sensor]]
id = "x2"
column = "x2"
axis = [0.6, 0.8, 0.0]
scale = "1"
noise = "0.2 mg0"
[[array.sensor]]
id = "y2"
column = "y2"
axis = [-0.8, 0.6, 0.0]
scale = "1"
noise = "0.2 mg0"
[[array.sensor]]
id = "z2"
column = "z2"
axis = [0.0, 0.0, 1.0]
scale = "1"
noise = "0.2 mg0"
[attitude]
law = "drilling-path"
rest_vibration = "0.1 mg0"
[noise]
instability = "20 ug0"
correlation = "30 s"
walk = "1 ug0"
[rotation]
rate = "60 deg/s"
axis = [0.0, 0.6, 0.8]
from = "2 s"
until = "8 s"
[depth]
station_spacing = "28 m"
gravity = "0.084 mGal/m"
heat = "0.03 degC/m"
[[sensor_truth]]
id = "x2"
lever_arm = ["12 mm", "0 m", "-0.5 m"]
[[fault]]
spec = "x2:clip=-1g0..2g0@3s"
[[fault]]
spec = "log:swap@#300+#20"
[[fault]]
spec = "log:late=5@#400+#1"
[[fault]]
spec = "y1:F22@station4"
)";

TEST(ScenarioFile, TriadsAndSurroundingsAreReadWrittenAndReplayedAlikeInTomlAndJson) {
  std::string text = kTwoTriads;
  text.replace(text.find("12 mm"), 5, "0.012 m");
  const ScenarioFile file = scenario_of(text);
  const Scenario& s = file.scenario;
  EXPECT_EQ(file.array.array.size(), 6);
  EXPECT_EQ(s.tool.lever_arm_m[3], (Vec3{0.012, 0.0, -0.5}));
  EXPECT_DOUBLE_EQ(s.turning.rate_radps, rad_from_deg(60.0));
  EXPECT_EQ(s.turning.until_s, 8.0);
  EXPECT_DOUBLE_EQ(s.depth.gravity_per_s2, 8.4e-7);
  EXPECT_EQ(s.noise.instability.correlation_s, 30.0);
  EXPECT_DOUBLE_EQ(s.noise.instability.walk_mps2, 1e-6 * kG0_mps2);
  EXPECT_DOUBLE_EQ(s.rest_vibration_mps2, 1e-4 * kG0_mps2);
  ASSERT_EQ(s.faults.size(), 5U) << "F22 is two";
  expect_round_trip(file);
  auto one = Simulator::make(s);
  auto two = Simulator::make(scenario_of(scenario_json(file)).scenario);
  ASSERT_TRUE(one && two);
  Sample a, b;
  std::uint64_t rows = 0;
  while (one->next(a)) {
    ASSERT_TRUE(two->next(b));
    ASSERT_TRUE(same_bits(a.raw, b.raw));
    ASSERT_EQ(a.time_s, b.time_s);
    ASSERT_EQ(a.delivered, b.delivered);
    ++rows;
  }
  EXPECT_FALSE(two->next(b));
  EXPECT_EQ(rows, one->size());
}

TEST(ScenarioFile, BadSurroundingsAreRefusedWithFieldAndRemedy) {
  const std::tuple<const char*, const char*, const char*> cases[] = {
      {"rate = \"60 deg/s\"", "rate = \"60 deg\"", "rotation.rate"},
      {"axis = [0.0, 0.6, 0.8]", "axis = [0.0, 0.6, 0.9]", "rotation.axis"},
      {"until = \"8 s\"", "until = \"1 s\"", "rotation.until"},
      {"station_spacing = \"28 m\"", "station_spacing = 28", "depth.station_spacing"},
      {"heat = \"0.03 degC/m\"", "heat = \"0.03 degC\"", "depth.heat"},
      {"correlation = \"30 s\"", "correlation = \"0 s\"", "noise.correlation"},
      {"walk = \"1 ug0\"", "walk = \"-1 ug0\"", "noise.walk"},
      {"\"12 mm\"", "\"12 s\"", "sensor_truth[1].lever_arm[1]"},
      {"[array.input]", "[array.inptu]", "inptu"},
      {"log:swap", "log:stop", "fault[2].spec"}};
  for (const auto& [good, bad, field] : cases) {
    std::string text = kTwoTriads;
    text.replace(text.find("12 mm"), 5, good == std::string("\"12 mm\"") ? "12 mm" : "0.012 m");
    text.replace(text.find(good), std::string(good).size(), bad);
    const auto file = parse_scenario_text(text, "bad.toml");
    ASSERT_FALSE(file) << bad;
    EXPECT_NE(file.error().text().find(field), std::string::npos) << file.error().text();
    EXPECT_FALSE(file.error().remedy.empty());
  }
  for (const char* json : {"{\"tool\": ", "{\"tool\": null}", "{}"}) {
    const auto file = parse_scenario_text(json, "bad.json");
    ASSERT_FALSE(file) << json;
    EXPECT_FALSE(file.error().remedy.empty());
  }
}

TEST(ScenarioFile, ReadsEveryKey) {
  const ScenarioFile file = scenario_of(R"(
name = "all of it"
tool = "paper"
seed = 7
gravity = "9.81 m/s^2"
rate = "0.2 kHz"
start = "1 min"
[truth]
law = "normal"
bias = "5 mg0"
scale = "1000 ppm"
tilt = "1 mrad"
seed = 3
[[sensor_truth]]
id = "a2"
axis = [0, 0.6, 0.8]
scale = "2.9 V/g0"
bias = "29 mV"
bias_t = ["0.1 mg/degC", "2 ug/degC^2"]
scale_t = ["100 ppm/degC", "1 uV/g0/degC^2"]
t_ref = "30 degC"
cross = [0, 0, 1e-3, 0]
[attitude]
law = "drilling-path"
stations = 5
inclination = "10 deg"
azimuth = "20 deg"
toolface = "30 deg"
build = "4 deg"
turn = "5 deg"
toolface_step = "90 deg"
toolface_jitter = "6 deg"
dwell = "3 s"
motion = "500 ms"
vibration = "0.2 g0"
record_motion = false
tag_stations = true
[temperature]
law = "linear"
start = "60 degC"
rate = "3 degC/min"
[noise]
factor = 0.5
quantise = false
clip = false
[[fault]]
spec = "a1:bias=50mg0@70s+10s"
[[fault]]
spec = "a3:stuck=-FS@station4"
)");
  const Scenario& s = file.scenario;
  EXPECT_EQ(file.name, "all of it");
  EXPECT_EQ(file.array.gravity.g_mps2, 9.81) << "the array file of the paper's tool follows";
  EXPECT_EQ(s.seed, 7U);
  EXPECT_EQ(s.gravity_mps2, 9.81);
  EXPECT_EQ(s.rate_hz, 200.0);
  EXPECT_EQ(s.start_s, 60.0);
  TruthSpans spans{5e-3 * kG0_mps2, 1e-3, 1e-3, TruthSpans::Shape::normal};
  const Tool drawn = draw_tool(paper_datasheet(), derive_seed(3, 0), spans);
  EXPECT_EQ(s.tool.axes[0], drawn.axes[0]);
  EXPECT_DOUBLE_EQ(s.tool.model.sensor[3].bias[0], drawn.model.sensor[3].bias[0]);
  const SensorCoefficients& a2 = s.tool.model.sensor[1];
  EXPECT_EQ(s.tool.axes[1], (Vec3{0.0, 0.6, 0.8}));
  EXPECT_DOUBLE_EQ(a2.scale[0], 2.9 / kG0_mps2);
  EXPECT_DOUBLE_EQ(a2.bias[0], 0.01 * kG0_mps2);
  EXPECT_DOUBLE_EQ(a2.bias[2], 2e-6 * kG0_mps2);
  EXPECT_DOUBLE_EQ(a2.scale[1], 1e-4 * a2.scale[0]);
  EXPECT_DOUBLE_EQ(a2.scale[2], 1e-6 / kG0_mps2);
  EXPECT_EQ(a2.reference_degc, 30.0);
  EXPECT_EQ(s.tool.model.misalignment[1 * kCapacity + 2], 1e-3);
  const auto& path = std::get<DrillingPath>(s.attitudes);
  EXPECT_EQ(path.stations, 5);
  EXPECT_DOUBLE_EQ(path.first.inclination_rad, rad_from_deg(10.0));
  EXPECT_DOUBLE_EQ(path.first.azimuth_rad, rad_from_deg(20.0));
  EXPECT_DOUBLE_EQ(path.first.toolface_rad, rad_from_deg(30.0));
  EXPECT_DOUBLE_EQ(path.build_rad, rad_from_deg(4.0));
  EXPECT_DOUBLE_EQ(path.turn_rad, rad_from_deg(5.0));
  EXPECT_DOUBLE_EQ(path.toolface_step_rad, rad_from_deg(90.0));
  EXPECT_DOUBLE_EQ(path.toolface_jitter_rad, rad_from_deg(6.0));
  EXPECT_EQ(s.dwell_s, 3.0);
  EXPECT_EQ(s.move_s, 0.5);
  EXPECT_DOUBLE_EQ(s.vibration_mps2, 0.2 * kG0_mps2);
  EXPECT_FALSE(s.record_motion);
  EXPECT_TRUE(s.tag_stations);
  EXPECT_EQ(s.temperature.start_degc, 60.0);
  EXPECT_DOUBLE_EQ(s.temperature.rate_degc_per_s, 0.05);
  EXPECT_EQ(s.noise.white, 0.5);
  EXPECT_FALSE(s.noise.quantise);
  EXPECT_FALSE(s.noise.clip);
  ASSERT_EQ(s.faults.size(), 2U);
  EXPECT_EQ(s.faults[1].magnitude, -kPaperFullScale_V);
  EXPECT_EQ(s.faults[1].clock, Clock::station);
  expect_round_trip(file);
}

TEST(ScenarioFile, EveryAttitudeLaw) {
  const auto attitude = [](const std::string& keys) {
    const ScenarioFile file = scenario_of("tool = \"paper\"\n[attitude]\n" + keys);
    expect_round_trip(file);
    return directions_of(file.scenario.attitudes, file.scenario.seed);
  };
  const auto fixed = attitude("law = \"fixed\"\ndirection = {inclination = \"90 deg\", toolface = \"180 deg\"}\n");
  ASSERT_TRUE(fixed);
  EXPECT_NEAR((*fixed)[0][1], 1.0, 1e-15);
  const auto list = attitude("law = \"list\"\ndirections = [[0, 0, 1], {inclination = \"180 deg\"}, [0.6, 0, 0.8]]\n");
  ASSERT_TRUE(list);
  ASSERT_EQ(list->size(), 3U);
  EXPECT_EQ((*list)[1][2], -1.0);
  EXPECT_EQ((*list)[2], (Vec3{0.6, 0.0, 0.8}));
  EXPECT_EQ(attitude("law = \"random\"\nstations = 9\n")->size(), 9U);
  const auto roll = attitude("law = \"roll-test\"\nstations = 4\ninclination = \"30 deg\"\ntoolface = \"90 deg\"\n");
  ASSERT_EQ(roll->size(), 4U);
  EXPECT_NEAR((*roll)[0][0], -0.5, 1e-15);
}

TEST(ScenarioFile, DrawnScenariosReadBackIdentical) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    ScenarioFile file = scenario_of(kShortest);
    const Tool tool = paper_tool(seed);
    file.scenario = seed % 2 == 0 ? calibration_run(tool, seed) : drilling_run(tool, seed);
    const Stream stream(seed, Purpose::test);
    file.name = "a \"name\"\\ with\ttabs";
    file.scenario.gravity_mps2 = stream.uniform(0, 9.5, 10.2);
    file.scenario.rate_hz = stream.uniform(1, 10.0, 1000.0);
    file.scenario.dwell_s = stream.uniform(2, 1.0, 3.0);
    file.scenario.move_s = stream.uniform(3);
    file.scenario.vibration_mps2 = stream.uniform(4);
    file.scenario.temperature = {stream.uniform(5, 0.0, 150.0), stream.uniform(6, -0.1, 0.1)};
    file.scenario.start_s = stream.uniform(7, -10.0, 1e6);
    file.scenario.seed = seed == 1 ? std::numeric_limits<std::uint64_t>::max() : stream.bits(8);
    file.scenario.noise.white = stream.uniform(9);
    file.scenario.tool.axes[2] = stream.direction(10);
    if (seed % 4 == 0) file.scenario.attitudes = DirectionList{{stream.direction(11), {-0.0, 0.0, 1.0}}};
    file.scenario.faults = {dead_at_station(1, 6)};
    Fault fault;
    fault.kind = FaultKind::random_range;
    fault.onset = stream.uniform(12, 0.0, 20.0);
    fault.magnitude = stream.uniform(13, -3.0, 0.0);
    fault.upper = stream.uniform(14, 0.1, 3.0);
    file.scenario.faults.push_back(fault);
    // The array file of the paper's tool follows the gravity of the scenario.
    file.array = array_of(paper_array_text(file.scenario.gravity_mps2));
    expect_round_trip(file);
  }
}

TEST(ScenarioFile, ToolWithTemperatureInCountsReadsBackIdentical) {
  std::string text = changed("unit = \"V\"", "unit = \"mV\"\ntemperature = \"t\"\nstation = \"att\"");
  text = changed("noise = \"0.5 mg\"\nfull",
                 "noise = \"0.5 mg\"\nbias_t = [\"0.1 mg/degC\"]\nscale_t = [\"200 ppm/degC\"]\nfull", text);
  const std::string array_path = written("array.toml", text);
  const std::string path = array_path + ".scenario.toml";
  const std::string base = "array = \"" + array_path.substr(array_path.rfind('/') + 1) +
                           "\"\n[attitude]\nlaw = \"random\"\n[truth]\nseed = ";
  for (int seed = 1; seed <= 20; ++seed) {
    ScenarioFile file = scenario_of(base + std::to_string(seed) + "\n", path);
    ASSERT_EQ(file.array.array.size(), 4);
    EXPECT_EQ(file.scenario.gravity_mps2, 9.81) << "of the array file";
    const Stream stream(static_cast<std::uint64_t>(seed), Purpose::test);
    for (std::size_t k = 1; k < 4; ++k) {
      file.scenario.tool.model.sensor[0].scale[k] = stream.uniform(k, -1e-3, 1e-3);
      file.scenario.tool.model.sensor[0].bias[k] = stream.uniform(10 + k, -1e-3, 1e-3);
      file.scenario.tool.model.sensor[1].bias[k] = stream.uniform(20 + k, -1e-3, 1e-3);
      file.scenario.tool.model.misalignment[2 * kCapacity + k] = stream.uniform(30 + k, -1e-2, 1e-2);
    }
    file.scenario.tool.model.sensor[0].scale[2] = 0.0;
    file.scenario.tool.model.sensor[3].reference_degc = stream.uniform(40, 0.0, 100.0);
    expect_round_trip(file, path);
  }
}

}  // namespace
}  // namespace scenario_file_test
