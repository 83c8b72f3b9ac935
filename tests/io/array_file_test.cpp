#include "plumb/io/array_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "io_test_support.hpp"
#include "plumb/paper/paper_rule.hpp"

namespace array_file_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

TEST(ArrayFile, ReadsOnWhichChipASensorIs) {
  EXPECT_EQ(package_of(array_of(), 1), "");
  const std::string text = changed("id = \"A2\"", "id = \"A2\"\npackage = \"imu1\"");
  EXPECT_EQ(package_of(array_of(text), 0), "") << "of one or of all";
  EXPECT_EQ(package_of(array_of(text), 1), "imu1");
  const std::string wrong[] = {"\"\"", "\"" + std::string(32, 'x') + "\"", "1"};
  for (const std::string& value : wrong) {
    const auto answer = parse_array_text(changed("\"imu1\"", value, text), "array.toml");
    ASSERT_FALSE(answer.has_value()) << value;
    EXPECT_EQ(answer.error().field, "sensor[2].package") << value;
  }
}

// Verifies: REQ-206
TEST(ArrayFile, SensorsOfOnePackageAreOneUnit) {
  std::string text = changed("id = \"A2\"", "id = \"A2\"\npackage = \"left\"");
  EXPECT_FALSE(array_of(text).array.units().grouped()) << "alone on its chip";
  text = changed("id = \"A4\"", "id = \"A4\"\npackage = \"left\"", text);
  text = changed("id = \"A1\"", "id = \"A1\"\npackage = \"right\"", text);
  const ArrayFile file = array_of(text);
  EXPECT_EQ(file.array.units().size(), 3);
  EXPECT_EQ(file.array.units().whole(SensorSet::of(1)), SensorSet::of(1).with(3));
  EXPECT_EQ(file.datasheet.array()->units().size(), 3) << "what a fit makes its array of";
}

// Verifies: REQ-065
TEST(ArrayFile, ReadsHowTheToolTurnsAndWhereTheSensorsSit) {
  EXPECT_TRUE(array_of().lever_arm_m.empty());
  EXPECT_TRUE(array_of().input.rotation_columns.empty());
  std::string text = changed("time = \"t_s\"", "time = \"t_s\"\nrotation_radps = [\"wx\", \"wy\", \"wz\"]");
  EXPECT_EQ(array_of(text).input.rotation_columns, (std::vector<std::string>{"wx", "wy", "wz"}));
  for (int i = 4; i >= 1; --i) {
    const std::string id = "id = \"A" + std::to_string(i) + "\"";
    const std::string arm = "\nlever_arm_m = [0." + std::to_string(i) + ", 0, -0.25]";
    text = changed(id, id + arm, text);
    if (i > 1) {
      const auto some = parse_array_text(text, "array.toml");
      ASSERT_FALSE(some.has_value()) << "of every sensor or of none";
      EXPECT_EQ(some.error().field, "sensor[1].lever_arm_m");
    }
  }
  const ArrayFile file = array_of(text);
  ASSERT_EQ(file.lever_arm_m.size(), 4U);
  EXPECT_EQ(file.lever_arm_m[2], (Vec3{0.3, 0.0, -0.25}));
  const std::string second = "second_rotation_radps = [\"ux\", \"uy\", \"uz\"]\nreads";
  EXPECT_EQ(array_of(changed("reads", second, text)).input.second_rotation_columns,
            (std::vector<std::string>{"ux", "uy", "uz"}));
  const auto alone = parse_array_text(changed("reads", second), "array.toml");
  ASSERT_FALSE(alone.has_value()) << "the first one is missing";
  EXPECT_EQ(alone.error().field, "input.second_rotation_radps");
  const auto refused = [&text](const std::string& from, const std::string& to, const std::string& field) {
    const auto answer = parse_array_text(changed(from, to, text), "array.toml");
    EXPECT_FALSE(answer.has_value()) << to;
    if (!answer) {
      EXPECT_EQ(answer.error().field, field);
    }
  };
  refused("lever_arm_m = [0.3, 0, -0.25]", "lever_arm_m = [0.3, 0]", "sensor[3].lever_arm_m");
  refused("lever_arm_m = [0.3, 0, -0.25]", "lever_arm_m = [300, 0, 0]", "sensor[3].lever_arm_m");
  refused("lever_arm_m = [0.3, 0, -0.25]", "lever_arm_m = [nan, 0, 0]", "sensor[3].lever_arm_m");
  refused("[\"wx\", \"wy\", \"wz\"]", "\"wz\"", "input.rotation_radps");
  refused("[\"wx\", \"wy\", \"wz\"]", "[\"wx\", \"wy\"]", "input.rotation_radps");
  refused("[\"wx\", \"wy\", \"wz\"]", "[\"wx\", \"wy\", 3]", "input.rotation_radps");
}

TEST(ArrayFile, ReadsTheColumnOfTheDepth) {
  EXPECT_TRUE(array_of().input.depth_column.empty());
  const std::string text = changed("time = \"t_s\"", "time = \"t_s\"\ndepth = \"MD\"\ndepth_unit = \"ft\"");
  EXPECT_EQ(array_of(text).input.depth_column, "MD");
  EXPECT_EQ(array_of(text).input.depth_unit_m, 0.3048);
  for (const auto& [from, to] : {std::pair("depth = \"MD\"\n", ""), std::pair("\"ft\"", "\"fathom\"")}) {
    const auto answer = parse_array_text(changed(from, to, text), "array.toml");
    ASSERT_FALSE(answer.has_value()) << to;
    EXPECT_EQ(answer.error().field, "input.depth_unit");
    EXPECT_FALSE(answer.error().remedy.empty());
  }
}

TEST(ArrayFile, ReadsWhetherAnAutopilotHasCorrectedTheReadings) {
  EXPECT_FALSE(array_of(changed("reads", "reads")).input.corrected) << "where nothing is said";
  EXPECT_TRUE(array_of(changed("reads", "corrected = true\nreads")).input.corrected);
  EXPECT_FALSE(array_of(changed("reads", "corrected = false\nreads")).input.corrected);
  expect_refused(changed("reads", "corrected = \"yes\"\nreads"), 13, "input.corrected", {"must be true or false"});
}

TEST(ArrayFile, ReadsEveryPart) {
  const ArrayFile file = array_of();
  EXPECT_EQ(file.name, "four on a tool");
  EXPECT_EQ(file.array.size(), 4);
  EXPECT_STREQ(file.array.row(1).id.data(), "A2");
  EXPECT_EQ(file.gravity.g_mps2, 9.81);
  EXPECT_DOUBLE_EQ(file.gravity.sigma_mps2, 0.2e-3 * kG0_mps2);
  EXPECT_EQ(file.monitor.window, 16);
  EXPECT_DOUBLE_EQ(file.monitor.delta_f_mps2, 0.05 * kG0_mps2);
  EXPECT_DOUBLE_EQ(file.monitor.alert_limit_rad, rad_from_deg(1.0));
  EXPECT_EQ(file.monitor.isolation_timeout, MonitorConfig().isolation_timeout);
  EXPECT_EQ(file.datasheet.reads, Reads::gravity);
  EXPECT_EQ(file.input.rows, RowKind::samples);
  EXPECT_EQ(file.input.time_column, "t_s");
  EXPECT_EQ(file.input.sensor_columns, (std::vector<std::string>{"a1_v", "a2_v", "a3_v", "a4_v"}));
  const DatasheetSensor& first = file.datasheet.sensor[0];
  EXPECT_DOUBLE_EQ(first.coefficients.scale[0], 3.0 / kG0_mps2);
  EXPECT_DOUBLE_EQ(first.coefficients.bias[0], 12e-3 * kG0_mps2);
  EXPECT_DOUBLE_EQ(first.row.sigma_mps2, 0.5e-3 * kG0_mps2);
  EXPECT_EQ(first.full_scale_raw, 5.0);
  EXPECT_EQ(file.datasheet.sensor[1].prior.axis_rad, Prior().axis_rad) << "defaults where no prior is given";
  EXPECT_DOUBLE_EQ(file.datasheet.sensor[3].prior.scale, 0.02);
  EXPECT_EQ(file.datasheet.sensor[3].prior.scale_t, Prior().scale_t);
  EXPECT_EQ(file.output_frame, kIdentity3);
}

TEST(ArrayFile, ReadsTemperatureFilterAndFrame) {
  std::string text = changed("unit = \"V\"",
                             "unit = \"mV\"\ntemperature = \"t\"\nstation = \"att\"\ncount = \"n\"\ntime_unit = "
                             "\"ms\"\nwhere = {exp = 1, device = \"ab\"}");
  text = changed(
      "bias = \"12 mg\"",
      "bias = \"6 mV\"\nbias_t = [\"0.1 mg/degC\", \"2 ug/degC^2\"]\nscale_t = [\"200 ppm/degC\"]\nt_ref = \"30 degC\"",
      text);
  text = changed("axis = \"2 deg\"", "axis = \"2 deg\", bias_t = [\"50 ug0/degC\", \"3 ug0/degC^2\"]", text);
  text += "[output]\nframe = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]\n";
  const ArrayFile file = array_of(text);
  const SensorCoefficients& c = file.datasheet.sensor[0].coefficients;
  EXPECT_DOUBLE_EQ(c.scale[0], 3000.0 / kG0_mps2);
  EXPECT_DOUBLE_EQ(c.scale[1], 2e-4 * c.scale[0]);
  EXPECT_DOUBLE_EQ(c.bias[0], 2e-3 * kG0_mps2);
  EXPECT_DOUBLE_EQ(c.bias[2], 2e-6 * kG0_mps2);
  EXPECT_EQ(c.reference_degc, 30.0);
  const Prior& drift = file.datasheet.sensor[3].prior;
  EXPECT_DOUBLE_EQ(drift.bias_t_mps2[0], 50e-6 * kG0_mps2);
  EXPECT_DOUBLE_EQ(drift.bias_t_mps2[1], 3e-6 * kG0_mps2);
  EXPECT_EQ(drift.bias_t_mps2[2], Prior().bias_t_mps2[2]);
  EXPECT_DOUBLE_EQ(file.datasheet.sensor[0].full_scale_raw, 5000.0);
  ASSERT_EQ(file.input.where.size(), 2U);
  EXPECT_DOUBLE_EQ(file.input.time_unit_s, 1e-3);
  EXPECT_EQ(file.output_frame[1], 1.0);
  EXPECT_EQ(file.output_frame[3], -1.0);
}

TEST(ArrayFile, StationsNeedNoTimeAndAccelerationLogsNoScale) {
  std::string text = changed("rows = \"samples\"\ntime = \"t_s\"", "rows = \"stations\"");
  text = changed("unit = \"V\"", "unit = \"m/s^2\"", text);
  for (int k = 0; k < 4; ++k) text = changed("scale = \"3 V/g0\"\n", "", text);
  text = changed("full_scale = \"5 V\"\n", "full_scale = \"2 g0\"\n", text);
  const ArrayFile file = array_of(text);
  EXPECT_EQ(file.datasheet.sensor[2].coefficients.scale[0], 1.0);
  EXPECT_DOUBLE_EQ(file.datasheet.sensor[0].full_scale_raw, 2.0 * kG0_mps2);
}

TEST(ArrayFile, CrlfAndByteOrderMarkAreFine) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : kArrayText) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(array_of(text).fingerprint, array_of().fingerprint);
}

TEST(ArrayFile, FingerprintBindsWhatACalibrationDependsOn) {
  const std::uint64_t plain = array_of().fingerprint;
  EXPECT_EQ(array_of(changed("window = 16", "window = 8")).fingerprint, plain);
  EXPECT_EQ(array_of(changed("noise = \"0.5 mg\"", "noise = \"0.6 mg\"")).fingerprint, plain);
  EXPECT_NE(array_of(changed("\"A3\"", "\"B3\"")).fingerprint, plain);
  EXPECT_NE(array_of(changed("[0.6, 0.0, 0.8]", "[0.8, 0.0, 0.6]")).fingerprint, plain);
  EXPECT_NE(array_of(changed("\"3 V/g0\"", "\"3.1 V/g0\"")).fingerprint, plain);
  EXPECT_NE(array_of(changed("\"gravity\"", "\"specific-force\"")).fingerprint, plain);
}

TEST(ArrayFile, ParallelAxesAreAllowed) {
  EXPECT_EQ(array_of(changed("[0.6, 0.0, 0.8]", "[0.0, 0.0, 1.0]")).array.size(), 4);
}

TEST(ArrayFileRefuses, FilesThatCannotBeRead) {
  const auto missing = read_array_file("/nonexistent/array.toml");
  ASSERT_FALSE(missing.has_value());
  expect_error(missing.error(), "/nonexistent/array.toml", 0, "", {"cannot be read", "No such file", "check the path"});
  const auto directory = read_array_file(testing::TempDir());
  ASSERT_FALSE(directory.has_value());
  EXPECT_NE(directory.error().text().find("not a directory"), std::string::npos);
}

TEST(ArrayFileRefuses, EmptyFileAndSyntaxErrors) {
  expect_refused("", 0, "", {"empty", "[[sensor]]"});
  expect_refused(" \n\r\n", 0, "", {"empty"});
  expect_refused(changed("window = 16", "window = = 16"), 7, "", {"not valid TOML"});
  expect_refused(changed("name = \"four on a tool\"", "name = \"four"), 1, "", {"not valid TOML"});
  expect_refused("a = " + std::string(100000, '['), 0, "", {"nested too deeply"});
}

TEST(ArrayFileRefuses, UnknownKeysWithTheNearestName) {
  expect_refused(changed("window = 16", "windwo = 16"), 7, "monitor.windwo",
                 {"not a known key", "did you mean \"window\"?"});
  expect_refused(changed("axis = [0.0, 1.0", "axes = [0.0, 1.0"), 26, "sensor[2].axes", {"did you mean \"axis\"?"});
  expect_refused(changed("[monitor]", "[monitro]"), 6, "monitro", {"did you mean \"monitor\"?"});
  expect_refused(changed("scale = \"2 %\"", "scael = \"2 %\""), 41, "sensor[4].prior.scael",
                 {"did you mean \"scale\"?"});
  expect_refused(changed("sigma = ", "layers = []\nsigma = "), 5, "gravity.layers", {"not used by model \"value\""});
}

TEST(ArrayFileRefuses, MissingKeys) {
  expect_refused(changed("reads = \"gravity\"\n", ""), 10, "input.reads", {"is missing", "specific-force"});
  expect_refused(changed("unit = \"V\"\n", ""), 10, "input.unit", {"is missing", "count"});
  expect_refused(changed("time = \"t_s\"\n", ""), 10, "input.time", {"is missing", "rate = \"100 Hz\""});
  expect_refused(changed("axis = [0.0, 1.0, 0.0]\n", ""), 23, "sensor[2].axis", {"is missing"});
  expect_refused(changed("noise = \"0.5 mg\"\n", ""), 15, "sensor[1].noise", {"is missing", "noise = "});
  expect_refused(changed("scale = \"3 V/g0\"\n", ""), 15, "sensor[1].scale", {"is missing", "3 V/g0"});
  expect_refused(changed("value = \"9.81 m/s^2\"\n", ""), 2, "gravity.value", {"is missing"});
  expect_refused("[input]\nreads = \"gravity\"\n", 0, "gravity", {"is missing", "latitude"});
}

// Negative: REQ-171
TEST(ArrayFileRefuses, WrongTypesAndUnits) {
  expect_refused(changed("window = 16", "window = \"16\""), 7, "monitor.window", {"a string", "whole number"});
  expect_refused(changed("delta_f = \"0.05 g0\"", "delta_f = 0.05"), 8, "monitor.delta_f",
                 {"the unit is missing", "g0"});
  expect_refused(changed("delta_f = \"0.05 g0\"", "delta_f = \"0.05\""), 8, "monitor.delta_f",
                 {"the unit is missing", "mm/s^2"});
  expect_refused(changed("delta_f = \"0.05 g0\"", "delta_f = \"0.05 g\""), 8, "monitor.delta_f", {"bare \"g\"", "g98"});
  expect_refused(changed("alert_limit = \"1 deg\"", "alert_limit = \"1 degree\""), 9, "monitor.alert_limit",
                 {"\"degree\" is not a known unit", "mrad"});
  expect_refused(changed("unit = \"V\"", "unit = \"g\""), 14, "input.unit", {"bare \"g\""});
  expect_refused(changed("rows = \"samples\"", "rows = \"sample\""), 11, "input.rows", {"did you mean \"samples\"?"});
  expect_refused(changed("scale = \"3 V/g0\"", "scale = \"3 V\""), 19, "sensor[1].scale", {"2048 count/g0"});
  expect_refused(changed("[1.0, 0.0, 0.0]", "[1.0, 0.0]"), 18, "sensor[1].axis", {"has 2 numbers"});
  expect_refused(changed("[1.0, 0.0, 0.0]", "\"x\""), 18, "sensor[1].axis", {"a string", "list of three numbers"});
  expect_refused(changed("time = \"t_s\"", "time = \"t_s\"\nrate = \"100 Hz\""), 13, "input.rate", {"keep one"});
}

TEST(ArrayFileRefuses, AxesThatAreNotDirections) {
  expect_refused(changed("[0.6, 0.0, 0.8]", "[0.612, 0.0, 0.816]"), 38, "sensor[4].axis",
                 {"is 1.02 long, must be of unit length", "divide it by its length: [0.6, 0, 0.79"});
  expect_refused(changed("[0.6, 0.0, 0.8]", "[0.0, 0.0, 0.0]"), 38, "sensor[4].axis",
                 {"is 0 long", "must not all be zero"});
  expect_refused(changed("[0.6, 0.0, 0.8]", "[nan, 0.0, 0.8]"), 38, "sensor[4].axis", {"not finite"});
  expect_refused(changed("[0.6, 0.0, 0.8]", "[0.6, 0.0, 0.80001]"), 38, "sensor[4].axis", {"1.000008", "unit length"});
}

TEST(ArrayFileRefuses, CoplanarAxes) {
  const std::string text = changed("[0.0, 1.0, 0.0]", "[0.8, 0.0, 0.6]");
  expect_refused(text, 18, "sensor[1].axis", {"one plane", "smallest singular value", "out of the plane"});
}

TEST(ArrayFileRefuses, TooFewTooManyAndTwins) {
  const std::string two = kArrayText.substr(0, kArrayText.find("[[sensor]]\nid = \"A3\""));
  expect_refused(two, 15, "sensor", {"2 sensors", "3 are needed"});
  const std::string none = kArrayText.substr(0, kArrayText.find("[[sensor]]"));
  expect_refused(none, 0, "sensor", {"no sensor"});
  expect_refused(
      changed("id = \"A3\"", "id = \"A1\""), 30, "sensor[3].id",
      {"\"A1\" is already the id of sensor[1] (line 16)", "give every sensor its own id (parallel axes are allowed,"});
  expect_refused(changed("column = \"a3_v\"", "column = \"a1_v\""), 31, "sensor[3].column",
                 {"already the column of sensor[1]"});
  std::string many = kArrayText;
  for (int k = 5; k <= kCapacity + 1; ++k) {
    many += "[[sensor]]\nid = \"A" + std::to_string(k) + "\"\naxis = [0, 0, 1]\nscale = \"3 V/g0\"\nnoise = \"1 mg\"\n";
  }
  const int line = 42 + 5 * (kCapacity - 4);
  expect_refused(many, line, "sensor[" + std::to_string(kCapacity + 1) + "]",
                 {"more than this build holds", "PLUMB_CAPACITY"});
}

TEST(ArrayFileRefuses, ValuesOutOfRange) {
  expect_refused(changed("full_scale = \"5 V\"", "full_scale = \"1 g0\""), 22, "sensor[1].full_scale",
                 {"below gravity plus a margin", "clips"});
  expect_refused(changed("noise = \"0.5 mg\"", "noise = \"1e-300 mg\""), 21, "sensor[1].noise",
                 {"below 1e-9 m/s^2", "noise = "});
  expect_refused(changed("noise = \"0.5 mg\"", "noise = \"1 g0\""), 21, "sensor[1].noise",
                 {"times that of sensor[", "at most 300 times", "unit of both"});
  expect_refused(changed("noise = \"0.5 mg\"", "noise = \"0 mg\""), 21, "sensor[1].noise", {"above zero"});
  expect_refused(changed("noise = \"0.5 mg\"", "noise = \"nan mg\""), 21, "sensor[1].noise", {"not finite"});
  expect_refused(changed("id = \"A1\"", "id = \"a name far too long\""), 16, "sensor[1].id", {"longer than 15"});
  expect_refused(changed("id = \"A1\"", "id = \" \""), 16, "sensor[1].id", {"is empty"});
  expect_refused(changed("bias = \"20 mg\"", "bias = \"0 mg\""), 41, "sensor[4].prior.bias", {"above zero"});
  const auto drift = [](const std::string& terms) { return changed("axis = \"2 deg\"", "axis = \"2 deg\", " + terms); };
  expect_refused(drift("scale_t = [\"-200 ppm/degC\"]"), 41, "sensor[4].prior.scale_t", {"above zero"});
  expect_refused(drift("bias_t = [\"1 ug0/degC\", \"0 ug0/degC^2\"]"), 41, "sensor[4].prior.bias_t", {"above zero"});
  expect_refused(drift("bias_t = \"1 ug0/degC\""), 41, "sensor[4].prior.bias_t", {"list of one to three"});
  expect_refused(changed("9.81 m/s^2", "1.62 m/s^2"), 4, "gravity.value", {"1.62"});
  expect_refused(changed("window = 16", "window = 0"), 7, "monitor.window", {"is 0, out of range", "at least 1"});
  expect_refused(changed("window = 16", "window = 16\nfalse_alarm_rate = nan"), 8, "monitor.false_alarm_rate",
                 {"finite"});
  expect_refused(changed("bias = \"12 mg\"", "bias = \"12 mg\"\nbias_t = [\"1 mg/degC\"]"), 21, "sensor[1].bias_t",
                 {"needs the temperature"});
  expect_refused(kArrayText + "[output]\nframe = [[1, 0, 0], [0, 1, 0], [0, 0, 2]]\n", 43, "output.frame",
                 {"row 3 is not of unit length"});
}

TEST(ArrayFile, GravityModels) {
  const std::string value = "model = \"value\"\nvalue = \"9.81 m/s^2\"\n";
  const ArrayFile normal =
      array_of(changed(value,
                       "latitude = \"45 deg\"\ndepth = \"1 km\"\nlayers = [{thickness = \"500 m\", density = \"1.03 "
                       "g/cm^3\"}, {thickness = \"1 km\", density = \"2670 kg/m^3\"}]\n"));
  EXPECT_EQ(normal.gravity.model, GravityModel::normal);
  EXPECT_NEAR(normal.gravity.g_mps2, 9.807, 0.005);
  const ArrayFile paper = array_of(changed(value, "model = \"paper\"\nlatitude = \"45 deg\"\n"));
  EXPECT_EQ(paper.gravity.model, GravityModel::paper);
  const ArrayFile table = array_of(changed(value,
                                           "model = \"table\"\ndepth = \"1 km\"\ntable = [{depth = \"0 m\", g = \"9.81 "
                                           "m/s^2\"}, {depth = \"2 km\", g = \"9.82 m/s^2\"}]\n"));
  EXPECT_NEAR(table.gravity.g_mps2, 9.815, 1e-9);
  expect_refused(changed(value, "latitude = \"95 deg\"\n"), 3, "gravity.latitude", {"95"});
  expect_refused(changed(value, "model = \"normal\"\n"), 2, "gravity.latitude", {"is missing"});
}

TEST(ArrayFile, AGravityThatIsGivenIsComparedWithThatOfThePlace) {
  const auto given = [](const std::string& value, const std::string& place) {
    return changed("value = \"9.81 m/s^2\"\n", "value = \"" + value + " m/s^2\"\n" + place);
  };
  const std::string equator = "latitude = \"0 deg\"\n";  // 9.7803 m/s^2; 9.7649 at 5 km
  EXPECT_EQ(array_of(given("9.79", equator)).gravity.g_mps2, 9.79);
  EXPECT_EQ(array_of(given("9.7649", equator + "elevation = \"5 km\"\n")).gravity.model, GravityModel::value);
  for (const char* off : {"9.8781", "9.6825"})
    expect_refused(given(off, equator), 4, "gravity.value", {"gravity value is wrong by 1 %", "9.78033", "latitude"});
  expect_refused(given("9.8625", equator + "elevation = \"5 km\"\n"), 4, "gravity.value", {"wrong by 1 %"});
  expect_refused(given("9.81", "depth = \"1 km\"\n"), 5, "gravity.depth", {"without latitude"});
  const std::string table =
      "model = \"table\"\nlatitude = \"0 deg\"\ntable = [{depth = \"0 m\", g = \"9.88 m/s^2\"}, {depth = \"2 km\", g = "
      "\"9.89 m/s^2\"}]\n";
  expect_refused(changed("model = \"value\"\nvalue = \"9.81 m/s^2\"\n", table), 5, "gravity.table", {"wrong by 1 %"});
}

TEST(ArrayFile, PaperModeHasThePapersLimitUnlessAnotherIsGiven) {
  const std::string both = "window = 16\ndelta_f = \"0.05 g0\"";
  const ArrayFile paper = array_of(changed(both, "mode = \"paper\""));
  EXPECT_EQ(paper.monitor.mode, MonitorMode::paper);
  EXPECT_EQ(paper.monitor.delta_f_mps2, kPaperDeltaF_mps2);
  EXPECT_EQ(array_of(changed(both, "mode = \"paper\"\ndelta_f = \"0.09 m/s^2\"")).monitor.delta_f_mps2, 0.09);
  EXPECT_EQ(array_of(changed(both, "mode = \"plumb\"")).monitor.delta_f_mps2, 0.0);
}

TEST(ArrayFile, RecalibrationIsAskedForInTheMonitorTable) {
  const MonitorConfig unset = array_of().monitor;
  EXPECT_FALSE(unset.recalibrate_after_exclusion);
  EXPECT_TRUE(
      array_of(changed("window = 16", "recalibrate = \"after-exclusion\"")).monitor.recalibrate_after_exclusion);
  EXPECT_FALSE(array_of(changed("window = 16", "recalibrate = \"never\"")).monitor.recalibrate_after_exclusion);
  expect_refused(changed("window = 16", "recalibrate = \"always\""), 7, "monitor.recalibrate",
                 {"always", "never", "after-exclusion"});
}

TEST(ArrayFile, AnAccelerationIsAllowedForInTheMonitorTable) {
  EXPECT_EQ(array_of().monitor.acceleration_bound_mps2, 0.0);
  const MonitorConfig given = array_of(changed("window = 16", "acceleration_bound = \"5 mg\"")).monitor;
  EXPECT_NEAR(given.acceleration_bound_mps2, 5e-3 * kG0_mps2, 1e-12);
  const char* const key = "monitor.acceleration_bound";
  expect_refused(changed("window = 16", "acceleration_bound = \"11 m/s^2\""), 7, key, {"at most 10 m/s^2"});
  expect_refused(changed("window = 16", "acceleration_bound = \"-1 mg\""), 7, key, {"at least 0 m/s^2"});
  expect_refused(changed("window = 16", "acceleration_bound = 0.05"), 7, key, {"unit"});
  expect_refused(changed("window = 16", "acceleration_bound = \"5 mg\"\nrecalibrate = \"after-exclusion\""), 7, key,
                 {"at most 0 m/s^2"});
}

TEST(ArrayFile, TheMeaningOfTheRateIsChosenInTheMonitorTable) {
  EXPECT_EQ(array_of().monitor.alarm_form, AlarmForm::every_tool);
  EXPECT_EQ(array_of().monitor.triple_false_alarm_rate, 0.0);
  const MonitorConfig given =
      array_of(changed("window = 16", "alarm_form = \"average-tool\"\ntriple_false_alarm_rate = 1e-4")).monitor;
  EXPECT_EQ(given.alarm_form, AlarmForm::average_tool);
  EXPECT_EQ(given.triple_false_alarm_rate, 1e-4);
  EXPECT_EQ(array_of(changed("window = 16", "alarm_form = \"every-tool\"")).monitor.alarm_form, AlarmForm::every_tool);
  expect_refused(changed("window = 16", "alarm_form = \"some\""), 7, "monitor.alarm_form", {"some", "average-tool"});
  expect_refused(changed("window = 16", "triple_false_alarm_rate = 0.5"), 7, "monitor.triple_false_alarm_rate",
                 {"at most 0.01"});
}

// Negative: REQ-170
TEST(ArrayFileRefuses, WhatTheMonitorRefuses) {
  expect_refused(changed("window = 16", "mode = \"papr\""), 7, "monitor.mode", {"papr", "paper"});
  expect_refused(changed("\"1 deg\"", "\"200 deg\""), 9, "monitor.alert_limit", {"3.49066 rad", "at most 3.14159 rad"});
  expect_refused(changed("window = 16", "temperature_min = \"50 degC\"\ntemperature_max = \"10 degC\""), 7,
                 "monitor.temperature_min", {"50 degC", "at most 10 degC"});
}

}  // namespace
}  // namespace array_file_test
