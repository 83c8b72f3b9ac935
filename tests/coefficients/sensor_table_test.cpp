// plumb's own tables of coefficients, CSV and JSON.
#include "coefficients_support.hpp"

namespace sensor_table_test {
namespace {

using namespace coefficients_test;

plumb::io::ArrayFile volts() {
  return array_of(drone_toml(1, "unit = \"V\"\ntemperature = \"temp\"",
                             "scale = \"3 V/g0\"\nscale_t = [\"100 ppm/degC\"]\nbias_t = [\"0.1 mg/degC\"]\n"));
}

const char* const kCsv =
    "# certificate 17\n"
    "id,scale,bias,axis_x,axis_y,axis_z,sigma_bias,sigma_scale,sigma_axis\n"
    "y1,2.95 V/g0,-10 mg,0,0.8,0.6,2 mg,500 ppm,0.1 deg\n"
    "x1,310 mV/(m/s^2),0.0310 V,,,,2 mg,500 ppm,0.1 deg\r\n"
    "\n"
    "z1,\"3 V/g0\",0 m/s^2,0,0,1,2 mg,0.05 %,6 arcmin\n";

TEST(CoefficientTable, GivesValuesWithTheUnitsOfTheArrayFile) {
  std::string toml = drone_toml(1, "unit = \"V\"\ntemperature = \"temp\"",
                                "scale = \"3 V/g0\"\nscale_t = [\"100 ppm/degC\"]\nbias_t = [\"0.1 mg/degC\"]\n");
  toml.replace(toml.find("[0, 1, 0]"), 9, "[0, 0.8, 0.6]");
  const auto array = array_of(toml);
  const auto found = adopted(array, kCsv, {});
  ASSERT_TRUE(found.has_value()) << found.error().text();
  const auto& model = found->calibration.model;
  EXPECT_DOUBLE_EQ(model.sensor[0].scale[0], 0.310);
  EXPECT_DOUBLE_EQ(model.sensor[0].bias[0], 0.1);
  EXPECT_DOUBLE_EQ(model.sensor[1].scale[0], 2.95 / 9.80665);
  EXPECT_DOUBLE_EQ(model.sensor[1].bias[0], -0.0980665);
  // What the table does not state of the drift stays as in the array file.
  EXPECT_DOUBLE_EQ(model.sensor[0].scale[1], 0.310 * 1e-4);
  EXPECT_DOUBLE_EQ(model.sensor[0].bias[1], 0.1e-3 * 9.80665);
  EXPECT_EQ(found->calibration.array.axis(0), (plumb::Vec3{1, 0, 0})) << "no axis stated: the nominal one";
  EXPECT_EQ(found->calibration.array.axis(1), (plumb::Vec3{0, 0.8, 0.6}));
  for (const pc::SensorStatement& one : found->sensors) {
    EXPECT_DOUBLE_EQ(*one.sigma.bias_mps2, 0.002 * 9.80665);
    EXPECT_DOUBLE_EQ(*one.sigma.scale, 5e-4);
    EXPECT_DOUBLE_EQ(*one.sigma.axis_rad, 0.1 * plumb::kPi / 180.0);
  }
}

TEST(CoefficientTable, TheSameAsJson) {
  const auto array = volts();
  const std::string json = R"json({"schema": "plumb-coefficients", "version": 1, "comment": "certificate 17",
  "sigma": {"bias": "2 mg", "scale": "500 ppm", "axis": "0.1 deg"},
  "sensors": [{"id": "x1", "scale": "310 mV/(m/s^2)", "bias": "0.031 V", "sigma": {"bias": "3 mg"}},
              {"id": "y1", "scale": "2.95 V/g0", "bias": "-10 mg", "axis": [0, 1, 0],
               "bias_t": ["0.2 mg/degC", "1 ug/degC^2"], "scale_t": [], "t_ref": "20 degC"},
              {"id": "z1", "scale": "3 V/g0", "bias": "0 mg", "t_min": "0 degC", "t_max": "50 degC"}]})json";
  const auto found = adopted(array, json, {});
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_EQ(found->forms, "json");
  EXPECT_DOUBLE_EQ(found->calibration.model.sensor[0].bias[0], 0.1);
  EXPECT_DOUBLE_EQ(*found->sensors[0].sigma.bias_mps2, 0.003 * 9.80665);
  EXPECT_DOUBLE_EQ(*found->sensors[0].sigma.scale, 5e-4);
  EXPECT_DOUBLE_EQ(found->calibration.model.sensor[1].bias[1], 0.2e-3 * 9.80665);
  EXPECT_DOUBLE_EQ(found->calibration.model.sensor[1].bias[2], 1e-6 * 9.80665);
  EXPECT_EQ(found->calibration.model.sensor[1].reference_degc, 20.0);
  EXPECT_EQ(found->span.min_degc, 0.0);
  EXPECT_EQ(found->span.max_degc, 50.0);
}

TEST(CoefficientTable, AWrongCsvIsRefusedWithItsLine) {
  const auto array = drone();
  const auto parse = [&array](const std::string& text) {
    return pc::parse_coefficients(text, "cert.csv", array, pc::Form::csv);
  };
  const std::string head = "id,scale,bias,sigma_bias\n";
  EXPECT_TRUE(parse(head + "x1,1,0 mg,1 mg\n").has_value());
  EXPECT_TRUE(refused_with(parse("id,scal,bias\n"), "cert.csv:1: \"scal\" is no column"));
  EXPECT_TRUE(refused_with(parse("id;scale;bias\n"), "is no column"));
  EXPECT_TRUE(refused_with(parse("id,scale,bias,id\n"), "stands there twice"));
  EXPECT_TRUE(refused_with(parse(head), "holds no row"));
  EXPECT_TRUE(refused_with(parse(head + "x1,1,0 mg\n"), "cert.csv:2: the row has 3 cells, but the header has 4"));
  EXPECT_TRUE(refused_with(parse(head + "x9,1,0 mg,1 mg\n"), "cert.csv:2: id: \"x9\" is no sensor"));
  EXPECT_TRUE(refused_with(parse(head + "x1,1,0 mg,1 mg\nx1,1,0 mg,1 mg\n"), "cert.csv:3: id: \"x1\" stands in"));
  EXPECT_TRUE(refused_with(parse(head + "x1,0,0 mg,1 mg\n"), "scale: \"0\": the scale must not be zero"));
  EXPECT_TRUE(refused_with(parse(head + "x1,nan,0 mg,1 mg\n"), "cert.csv:2: scale"));
  EXPECT_TRUE(refused_with(parse(head + "x1,3 V/g0,0 mg,1 mg\n"), "is in V, but the log is in m/s^2"));
  EXPECT_TRUE(refused_with(parse(head + "x1,1,0 g,1 mg\n"), "a bare \"g\" is ambiguous"));
  EXPECT_TRUE(refused_with(parse(head + "x1,1,5,1 mg\n"), "the unit is missing"));
  EXPECT_TRUE(refused_with(parse(head + "x1,1,,1 mg\n"), "bias: is missing"));
  EXPECT_TRUE(refused_with(parse(head + "x1,1,0 mg,0 mg\n"), "sigma_bias: is 0 m/s^2, must be above 0"));
  EXPECT_TRUE(refused_with(parse(head + "x1,1,0 mg,-1 mg\n"), "must be above 0"));
  EXPECT_TRUE(refused_with(parse(head + "x1,1,0 mg,1 g0\n"), "at most"));
  EXPECT_TRUE(refused_with(parse("id,scale,bias,axis_x,axis_y,axis_z\nx1,1,0 mg,1,1,0\n"), "must be of unit length"));
  EXPECT_TRUE(refused_with(parse("id,scale,bias,axis_x,axis_y,axis_z\nx1,1,0 mg,1,,0\n"), "axis_y: is missing"));
  EXPECT_TRUE(refused_with(parse("id,scale,bias,t_min,t_max\nx1,1,0 mg,30 degC,20 degC\n"), "no less than t_min"));
  EXPECT_TRUE(refused_with(parse("id,scale,bias,t_min\nx1,1,0 mg,30 degC\n"), "t_max: is missing"));
  EXPECT_TRUE(refused_with(parse("id,scale,bias,bias_t1\nx1,1,0 mg,1 mg\n"), "must be per degC"));
  std::string many = head;
  for (int k = 0; k < 40; ++k) many += "x1,1,0 mg,1 mg\n";
  EXPECT_TRUE(refused_with(parse(many), "more rows than an array has sensors"));
}

TEST(CoefficientTable, AWrongJsonIsRefusedWithItsKey) {
  const auto array = drone();
  const auto parse = [&array](const std::string& text) { return pc::parse_coefficients(text, "cert.json", array); };
  const auto of = [](const std::string& sensor) {
    return "{\"schema\": \"plumb-coefficients\", \"version\": 1, \"sensors\": [" + sensor + "]}";
  };
  EXPECT_TRUE(parse(of(R"({"id": "x1", "scale": 1, "bias": "0 mg"})")).has_value());
  EXPECT_TRUE(refused_with(parse("{\"schema\": 1\n,}"), "cert.json:2: is not valid JSON"));
  EXPECT_TRUE(refused_with(parse("{}"), "schema: must be \"plumb-coefficients\""));
  EXPECT_TRUE(refused_with(parse("{\"schema\": \"plumb-coefficients\", \"version\": 2}"), "version: must be 1"));
  EXPECT_TRUE(refused_with(parse(of("")), "sensors: must be a list"));
  EXPECT_TRUE(refused_with(parse(of("5")), "sensors[1]: is not an object"));
  EXPECT_TRUE(refused_with(parse(of(R"({"id": "x1", "skale": 1})")), "sensors[1].\"skale\": is no key"));
  EXPECT_TRUE(refused_with(parse(of(R"({"id": "x1", "scale": 1, "bias": null})")), "sensors[1].bias: must be a text"));
  EXPECT_TRUE(
      refused_with(parse(of(R"({"id": "x1", "scale": 1, "bias": "0 mg", "axis": [1, 0]})")), "must have three"));
  EXPECT_TRUE(refused_with(parse(of(R"({"id": "x1", "scale": [1]})")), "is a list"));
  EXPECT_TRUE(
      refused_with(parse(of(R"({"id": "x1", "scale": 1, "bias": "0 mg", "sigma": {"bisa": 1}})")), "is no key"));
  EXPECT_TRUE(refused_with(parse(of(R"({"id": "x1", "scale": 1e400, "bias": "0 mg"})")), "out of range"));
  std::string deep = "{\"sensors\": ";
  for (int k = 0; k < 5000; ++k) deep += '[';
  EXPECT_TRUE(refused_with(parse(deep), "nested too deeply"));
}

TEST(CoefficientTable, NoControlCharacterOfAFileIsInARefusal) {
  const auto array = drone();
  for (const auto form : {pc::Form::csv, pc::Form::px4, pc::Form::imu_tk}) {
    const auto read = pc::parse_coefficients("id,scale\x1b[2J,bias\nCAL_ACC0_XOFF \x1b]0;x\x07\n", "f", array, form);
    ASSERT_FALSE(read.has_value());
    for (const char c : read.error().text()) EXPECT_TRUE(c >= ' ' && c != 0x7f) << read.error().text();
  }
}

TEST(StatedUncertainty, IsThreeQuantitiesWithTheirUnits) {
  const auto all = pc::parse_uncertainty("bias=5 mg, scale=1000 ppm,axis = 0.5 deg");
  ASSERT_TRUE(all.has_value()) << all.error().text();
  EXPECT_DOUBLE_EQ(*all->bias_mps2, 0.005 * 9.80665);
  EXPECT_DOUBLE_EQ(*all->scale, 1e-3);
  EXPECT_DOUBLE_EQ(*all->axis_rad, 0.5 * plumb::kPi / 180.0);
  const auto one = pc::parse_uncertainty("scale=0.1 %");
  ASSERT_TRUE(one.has_value());
  EXPECT_FALSE(one->bias_mps2.has_value());
  EXPECT_TRUE(refused_with(pc::parse_uncertainty(""), "has no \"=\""));
  EXPECT_TRUE(refused_with(pc::parse_uncertainty("bias"), "has no \"=\""));
  EXPECT_TRUE(refused_with(pc::parse_uncertainty("bias=5 mg,"), "has no \"=\""));
  EXPECT_TRUE(refused_with(pc::parse_uncertainty("gain=5 %"), "none of bias, scale and axis"));
  EXPECT_TRUE(refused_with(pc::parse_uncertainty("bias=5 mg,bias=4 mg"), "twice"));
  EXPECT_TRUE(refused_with(pc::parse_uncertainty("bias=5"), "the unit is missing"));
  EXPECT_TRUE(refused_with(pc::parse_uncertainty("bias=0 mg"), "bias is 0 m/s^2, must be above 0"));
  EXPECT_TRUE(refused_with(pc::parse_uncertainty("scale=-1 %"), "must be above 0"));
  EXPECT_TRUE(refused_with(pc::parse_uncertainty("axis=20 deg"), "at most 0.1 rad"));
}

}  // namespace
}  // namespace sensor_table_test
