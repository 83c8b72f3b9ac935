// Parameters of PX4 and ArduPilot: what they make of a reading, by hand, and what is refused.
#include "coefficients_support.hpp"

namespace parameter_file_test {
namespace {

using namespace coefficients_test;

std::string ardupilot_text(const std::string& prefix, const std::array<double, 3>& offset,
                           const std::array<double, 3>& scale) {
  std::string out = prefix + "_ID,2883874\n";
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis(1, "XYZ"[k]);
    out += prefix + "OFFS_" + axis + "," + plumb::io::shortest(offset[k]) + "\n";
    out += prefix + "SCAL_" + axis + "," + plumb::io::shortest(scale[k]) + "\n";
  }
  return out;
}

TEST(Px4Coefficients, CorrectAReadingAsTheFirmwareDoes) {
  const auto array = drone();
  const auto found = adopted(array, px4_text(0, {0.5, -0.25, 0.0}, {1.25, 1.0, 0.8}));
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_EQ(found->forms, "px4");
  // (8.5 - 0.5) 1.25 = 10, (9 + 0.25) 1 = 9.25, (10 - 0) 0.8 = 8
  EXPECT_DOUBLE_EQ(felt(found->calibration.model, 0, 8.5), 10.0);
  EXPECT_DOUBLE_EQ(felt(found->calibration.model, 1, 9.0), 9.25);
  EXPECT_DOUBLE_EQ(felt(found->calibration.model, 2, 10.0), 8.0);
  EXPECT_DOUBLE_EQ(found->calibration.model.sensor[0].scale[0], 0.8);
  EXPECT_DOUBLE_EQ(found->calibration.model.sensor[0].bias[0], 0.625);
  EXPECT_EQ(found->calibration.array.axis(0), array.array.axis(0));
}

TEST(Px4Coefficients, ALogInG0OrCountsIsConvertedAsItsDriverDoes) {
  const auto g0 = array_of(drone_toml(1, "unit = \"g0\""));
  const std::string text = px4_text(0, {0.5, 0.0, 0.0}, {1.25, 1.0, 1.0});
  const auto in_g0 = adopted(g0, text);
  ASSERT_TRUE(in_g0.has_value()) << in_g0.error().text();
  EXPECT_NEAR(felt(in_g0->calibration.model, 0, 8.5 / 9.80665), 10.0, 1e-13);
  // 400 count/(m/s^2) with its zero at 32768: 8.5 m/s^2 are 36168 counts.
  const auto counts =
      array_of(drone_toml(1, "unit = \"count\"", "scale = \"400 count/(m/s^2)\"\nbias = \"32768 count\"\n"));
  const auto in_counts = adopted(counts, text);
  ASSERT_TRUE(in_counts.has_value()) << in_counts.error().text();
  EXPECT_NEAR(felt(in_counts->calibration.model, 0, 36168.0), 10.0, 1e-12);
  EXPECT_NEAR(felt(in_counts->calibration.model, 1, 36168.0), 8.5, 1e-12);
}

TEST(Px4Coefficients, AreReadAsGroundStationsWriteThem) {
  const auto array = drone();
  const std::string columns =
      "# Onboard parameters for Vehicle 1\r\n#\r\n# Vehicle-Id Component-Id Name Value Type\r\n"
      "1\t1\tBAT1_CAPACITY\t-1.000000000000000000\t9\r\n1\t1\tCAL_ACC0_ID\t1310988\t6\r\n"
      "1\t1\tCAL_ACC0_XOFF\t0.500000000000000000\t9\r\n1\t1\tCAL_ACC0_XSCALE\t1.25\t9\r\n"
      "1\t1\tCAL_ACC0_YOFF\t0\t9\r\n1\t1\tCAL_ACC0_YSCALE\t1\t9\r\n"
      "1\t1\tCAL_ACC0_ZOFF\t0\t9\r\n1\t1\tCAL_ACC0_ZSCALE\t1\t9\r\n1\t1\tCAL_ACC1_ID\t0\t6\r\n"
      "1\t1\tCAL_GYRO0_XOFF\t0.01\t9\r\n";
  for (const std::string& text :
       std::vector<std::string>{columns, "\xef\xbb\xbf" + columns, px4_text(0, {0.5, 0.0, 0.0}, {1.25, 1.0, 1.0}),
                                "CAL_ACC0_XOFF=0.5\nCAL_ACC0_XSCALE = 1.25 # by hand\nCAL_ACC0_YOFF,0\n"
                                "CAL_ACC0_YSCALE,1\nCAL_ACC0_ZOFF 0\nCAL_ACC0_ZSCALE 1"}) {
    const auto file = pc::parse_coefficients(text, "v.params", array);
    ASSERT_TRUE(file.has_value()) << file.error().text();
    EXPECT_EQ(file->form, pc::Form::px4);
    ASSERT_EQ(file->chips.size(), 1U) << text;
    EXPECT_EQ(file->chips[0].offset[0][0], 0.5);
    EXPECT_EQ(file->chips[0].matrix[0], 1.25);
    EXPECT_FALSE(file->chips[0].has_temperature_terms());
  }
}

TEST(Px4Coefficients, AThermalOffsetIsTakenOver) {
  const auto array = array_of(drone_toml(1, "unit = \"m/s^2\"\ntemperature = \"temp\"", "t_ref = \"30 degC\"\n"));
  std::string text = px4_text(0, {0.1, 0.0, 0.0}, {1.25, 1.0, 1.0},
                              "TC_A_ENABLE 1\nTC_A0_ID 1310\nTC_A0_TREF 20\nTC_A0_TMIN 0\nTC_A0_TMAX 60\n");
  for (const char* order : {"0", "1", "2", "3"}) {
    for (const char* axis : {"0", "1", "2"})
      text += std::string("TC_A0_X") + order + "_" + axis + (std::string(axis) == "0" ? " 0.001\n" : " 0\n");
  }
  const auto found = adopted(array, text);
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_EQ(found->span.min_degc, 0.0);
  EXPECT_EQ(found->span.max_degc, 60.0);
  // At 22 degC the offset is 0.1 + 0.001 (1 + 2 + 4 + 8) = 0.115, at 20 degC 0.101; t_ref of the array is 30.
  EXPECT_NEAR(felt(found->calibration.model, 0, 8.115, 22.0), 10.0, 1e-12);
  EXPECT_NEAR(felt(found->calibration.model, 0, 8.101, 20.0), 10.0, 1e-12);
  EXPECT_NEAR(felt(found->calibration.model, 1, 8.0, 22.0), 8.0, 1e-12);
  EXPECT_EQ(found->calibration.model.sensor[0].reference_degc, 30.0);
}

TEST(Px4Coefficients, WhatIsNotTakenOverIsSaid) {
  const auto file = pc::parse_coefficients(
      px4_text(0, {0, 0, 0}, {1, 1, 1}, "CAL_ACC0_ROT 8\nCAL_ACC0_PRIO 0\nTC_A_ENABLE 1\n"), "v.params", drone());
  ASSERT_TRUE(file.has_value()) << file.error().text();
  std::string notes;
  for (const std::string& note : file->notes) notes += note + "\n";
  EXPECT_NE(notes.find("CAL_ACC0_ROT is 8"), std::string::npos) << notes;
  EXPECT_NE(notes.find("CAL_ACC0 is disabled"), std::string::npos) << notes;
  EXPECT_NE(notes.find("no thermal offset"), std::string::npos) << notes;
  EXPECT_NE(notes.find("sensor_accel"), std::string::npos) << notes;
}

TEST(Px4Coefficients, WrongParametersAreRefusedWithTheirName) {
  const auto array = drone();
  const auto parse = [&array](const std::string& text) {
    return pc::parse_coefficients(text, "v.params", array, pc::Form::px4);
  };
  const std::string good = px4_text(0, {0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(parse(good).has_value());
  EXPECT_TRUE(refused_with(parse("CAL_ACC0_ID 7\nCAL_ACC0_XOFF 0\n"), "CAL_ACC0_XSCALE: is missing"));
  EXPECT_TRUE(refused_with(parse(px4_text(0, {0, 0, 0}, {1, 0, 1})), "CAL_ACC0_YSCALE: is 0"));
  EXPECT_TRUE(refused_with(parse(px4_text(0, {0, 0, 0}, {1, 1, -1})), "CAL_ACC0_ZSCALE: is -1"));
  EXPECT_TRUE(refused_with(parse("CAL_ACC0_ID 0\n"), "no calibrated accelerometer"));
  EXPECT_TRUE(refused_with(parse(""), "no calibrated accelerometer"));
  EXPECT_TRUE(refused_with(parse(good + "CAL_ACC0_XOFF 0.1\n"), "v.params:8: CAL_ACC0_XOFF: is 0.1, and 0 in line 2"));
  EXPECT_TRUE(parse(good + "CAL_ACC0_XOFF 0\n").has_value()) << "twice the same is no matter";
  EXPECT_TRUE(refused_with(parse(good + "CAL_ACC1_XOFF nan\n"), "v.params:8"));
  EXPECT_TRUE(refused_with(parse(good + "CAL_ACC1_XOFF inf\n"), "v.params:8"));
  EXPECT_TRUE(refused_with(parse(good + "CAL_ACC1_YOFF 1e5x\n"), "\"1e5x\" is not a number"));
  EXPECT_TRUE(refused_with(parse(good + "CAL_ACC1_XOFF\n"), "has no value"));
  EXPECT_TRUE(refused_with(parse(good + "CAL_ACC1_XOFF 0,1\n"), "has more than the value \"0\"")) << "decimal comma";
  EXPECT_TRUE(refused_with(parse(good + "1\t1\tCAL_ACC1_XOFF\t0,1\t9\n"), "has more than the value"));
  std::string many;
  for (int k = 0; k < 3000; ++k) many += "CAL_ACC_" + std::to_string(k) + " 0\n";
  EXPECT_TRUE(refused_with(parse(many), "more than 2000"));
}

TEST(Px4Coefficients, OfALogAreTheSame) {
  const auto read = pc::coefficients_of({{"CAL_ACC0_ID", 7.0},
                                         {"CAL_ACC0_XOFF", 0.5},
                                         {"CAL_ACC0_YOFF", 0.0},
                                         {"CAL_ACC0_ZOFF", 0.0},
                                         {"CAL_ACC0_XSCALE", 1.25},
                                         {"CAL_ACC0_YSCALE", 1.0},
                                         {"CAL_ACC0_ZSCALE", 1.0},
                                         {"MC_ROLL_P", 6.5}},
                                        pc::Form::px4, "flight.ulg");
  ASSERT_TRUE(read.has_value()) << read.error().text();
  ASSERT_EQ(read->chips.size(), 1U);
  EXPECT_EQ(read->chips[0].offset[0][0], 0.5);
  EXPECT_TRUE(refused_with(pc::coefficients_of({{"MC_ROLL_P", 6.5}}, pc::Form::px4, "flight.ulg"),
                           "flight.ulg: holds no calibrated accelerometer"));
}

TEST(ArduPilotCoefficients, CorrectAReadingAsTheFirmwareDoes) {
  const auto array = drone(2);
  const auto found = adopted(array, "# saved\n" + ardupilot_text("INS_ACC", {0.5, 0.0, 0.0}, {1.25, 1.0, 1.0}) +
                                        ardupilot_text("INS_ACC2", {0.0, 0.0, -1.0}, {1.0, 1.0, 0.8}) +
                                        "INS_ACC3_ID,0\nINS_ACC3OFFS_X,0\nINS_GYROFFS_X,0.1\n");
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_EQ(found->forms, "ardupilot");
  EXPECT_DOUBLE_EQ(felt(found->calibration.model, 0, 8.5), 10.0);
  EXPECT_DOUBLE_EQ(felt(found->calibration.model, 5, 9.0), 8.0);
  ASSERT_EQ(found->chip_names.size(), 2U);
  EXPECT_EQ(found->chip_names[1], "INS_ACC2");
}

TEST(ArduPilotCoefficients, LaterInstancesHaveNamesOfTheirOwn) {
  const auto file =
      pc::parse_coefficients(ardupilot_text("INS4_ACC", {0.1, 0.2, 0.3}, {1.0, 1.0, 1.0}), "a.param", drone());
  ASSERT_TRUE(file.has_value()) << file.error().text();
  ASSERT_EQ(file->chips.size(), 1U);
  EXPECT_EQ(file->chips[0].instance, 4);
  EXPECT_EQ(file->chips[0].offset[0][2], 0.3);
}

TEST(ArduPilotCoefficients, ADriftWithTemperatureIsTakenOver) {
  const auto array = array_of(drone_toml(1, "unit = \"m/s^2\"\ntemperature = \"temp\""));
  std::string text = ardupilot_text("INS_ACC", {0.5, 0.0, 0.0}, {1.25, 1.0, 1.0}) +
                     "INS_TCAL1_ENABLE,1\nINS_TCAL1_TMIN,10\nINS_TCAL1_TMAX,60\nINS_ACC1_CALTEMP,37\n";
  for (const char* order : {"1", "2", "3"}) {
    for (const char* axis : {"X", "Y", "Z"})
      text += std::string("INS_TCAL1_ACC") + order + "_" + axis + (*axis == 'X' ? ",1000\n" : ",0\n");
  }
  const auto found = adopted(array, text);
  ASSERT_TRUE(found.has_value()) << found.error().text();
  // P(d) = 0.001 (d + d^2 + d^3): at 37 degC 0.014, at 36 degC 0.003, at 45 degC 1.11.
  EXPECT_NEAR(felt(found->calibration.model, 0, 8.5, 37.0), 10.0, 1e-12);
  EXPECT_NEAR(felt(found->calibration.model, 0, 8.5 + 0.003 - 0.014, 36.0), 10.0, 1e-12);
  EXPECT_NEAR(felt(found->calibration.model, 0, 8.5 + 1.11 - 0.014, 45.0), 10.0, 1e-12);
  EXPECT_EQ(found->span.min_degc, 10.0);
  EXPECT_EQ(found->span.max_degc, 60.0);
}

TEST(ArduPilotCoefficients, WhatIsWrongOrUntouchedIsSaid) {
  const auto array = drone();
  const auto untouched = pc::parse_coefficients(
      ardupilot_text("INS_ACC", {0, 0, 0}, {1, 1, 1}) + "INS_TCAL1_ENABLE 2\n", "a.param", array);
  ASSERT_TRUE(untouched.has_value()) << untouched.error().text();
  ASSERT_EQ(untouched->notes.size(), 3U);
  EXPECT_NE(untouched->notes[0].find("before any calibration"), std::string::npos);
  EXPECT_NE(untouched->notes[1].find("being learned"), std::string::npos);
  EXPECT_TRUE(refused_with(pc::parse_coefficients(ardupilot_text("INS_ACC", {0, 0, 0}, {0, 1, 1}), "a.param", array),
                           "INS_ACCSCAL_X: is 0"));
  EXPECT_TRUE(refused_with(pc::parse_coefficients("INS_ACC_ID 5\nINS_ACCOFFS_X 0\n", "a.param", array),
                           "INS_ACCSCAL_X: is missing"));
  EXPECT_TRUE(refused_with(
      pc::parse_coefficients(ardupilot_text("INS_ACC", {0, 0, 0}, {1, 1, 1}) + "INS_TCAL1_ENABLE 1\nINS_TCAL1_TMIN 9\n"
                                                                               "INS_TCAL1_TMAX 8\n",
                             "a.param", array),
      "INS_TCAL1_TMAX: is below"));
}

TEST(CoefficientForms, AreToldApartByTheirContent) {
  const auto array = drone();
  const auto parse = [&array](const std::string& text) { return pc::parse_coefficients(text, "file", array); };
  EXPECT_TRUE(refused_with(parse(""), "is empty"));
  EXPECT_TRUE(refused_with(parse(" \n\n"), "is empty"));
  EXPECT_TRUE(refused_with(parse("hello\n"), "holds no coefficients"));
  EXPECT_TRUE(refused_with(parse("t_s,a1,a2\n0,1,2\n"), "holds no coefficients"));
  EXPECT_TRUE(refused_with(parse(std::string("ULog\x01\x12\x35\x01", 8)), "is binary"));
  EXPECT_TRUE(refused_with(parse(px4_text(0, {0, 0, 0}, {1, 1, 1}) + ardupilot_text("INS_ACC", {0, 0, 0}, {1, 1, 1})),
                           "PX4 and of ArduPilot"));
  EXPECT_TRUE(refused_with(parse("{\"schema\": \"plumb-calibration\"}"), "this is a calibration file of plumb"));
  EXPECT_TRUE(refused_with(pc::read_coefficients("/nonexistent/file", array), "/nonexistent/file"));
}

TEST(CoefficientForms, AFileTooLargeIsRefusedBeforeItIsRead) {
  const ScratchFile file("CAL_ACC0_XOFF 0\n");
  ASSERT_EQ(::truncate(file.path().c_str(), static_cast<off_t>(pc::kLargestFile) + 1), 0);  // sparse
  EXPECT_TRUE(refused_with(pc::read_coefficients(file.path(), drone()), "larger than 16 MiB"));
}

}  // namespace
}  // namespace parameter_file_test
