// Known coefficients as a calibration: what it states, and what is refused.
#include <algorithm>

#include "coefficients_support.hpp"

namespace adoption_test {
namespace {

using namespace coefficients_test;

const std::string kGood = px4_text(0, {0.1, 0.0, 0.0}, {1.0, 1.0, 1.0});

TEST(Adoption, TheUncertaintyStatedIsThatOfTheCalibration) {
  const auto array = drone();
  const auto found = adopted(array, "id,scale,bias\nx1,1,0 mg\ny1,1,0 mg\nz1,1,0 mg\n");
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_EQ(found->common_scale, 0.0);
  const plumb::SensorArray& rows = found->calibration.array;
  // Of the sensor along x: scale 1e-3 along x, axis 0.01 along y and z, bias 0.05.
  const double expected[] = {1e-6, 1e-4, 1e-4, 2.5e-3};
  for (int k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(rows.row_covariance(k, k), expected[k]);
  EXPECT_EQ(rows.row_covariance(0, 3), 0.0);
  EXPECT_EQ(rows.row_covariance(0, 4), 0.0);
  EXPECT_TRUE(rows.taken_for_exact().empty());
  // e_cal: sqrt(G^2 (1e-6 + 2e-4) / 3 + 0.05^2).
  EXPECT_NEAR(found->calibration.report.e_cal_mps2[0], std::sqrt(9.81 * 9.81 * 2.01e-4 / 3.0 + 2.5e-3), 1e-15);
  EXPECT_DOUBLE_EQ(rows.sigma_mps2(0), 0.5e-3 * 9.80665);
}

TEST(Adoption, AutopilotsCalibrateAgainstG0AndThatIsAllowedFor) {
  const auto found = adopted(drone(), kGood);
  ASSERT_TRUE(found.has_value()) << found.error().text();
  const double off = 1.0 - 9.80665 / 9.81;
  EXPECT_NEAR(found->common_scale, off, 1e-15);
  EXPECT_NEAR(found->calibration.array.row_covariance(0, 0), 1e-6 + off * off, 1e-18);
  EXPECT_NEAR(found->calibration.array.row_covariance(0, 5), off * off, 1e-18) << "x1 and y1 have it in common";
  EXPECT_NE(found->notes.back().find("341 ppm is allowed for"), std::string::npos) << found->notes.back();
}

TEST(Adoption, TheNoiseIsThatOfTheArrayFileInTheNewScale) {
  const auto found = adopted(drone(), px4_text(0, {0, 0, 0}, {0.8, 1.0, 1.0}));
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_DOUBLE_EQ(found->calibration.array.sigma_mps2(0), 0.8 * 0.5e-3 * 9.80665);
}

TEST(Adoption, NothingWasFittedAndTheFileSaysSo) {
  const auto array = drone(2);
  const auto found = adopted(array, kGood + px4_text(1, {0, 0, 0}, {1, 1, 1}));
  ASSERT_TRUE(found.has_value()) << found.error().text();
  const plumb::io::CalibrationFile file = through_file(*found, array);
  EXPECT_EQ(file.context.coefficients, "px4");
  EXPECT_EQ(file.context.log_file, "known.txt");
  EXPECT_EQ(file.context.stations, 0);
  EXPECT_EQ(file.context.date, "2026-03-31");
  EXPECT_EQ(file.context.serial, "0042");
  EXPECT_TRUE(file.context.down.empty());
  const plumb::FitReport& report = file.calibration.report;
  EXPECT_EQ(report.stations, 0);
  EXPECT_EQ(report.rank, 0);
  EXPECT_EQ(report.stop, plumb::StopReason::none);
  for (int k = 0; k < 24; ++k) EXPECT_EQ(report.data_share[static_cast<std::size_t>(k)], 0.0);
  for (int i = 0; i < 6; ++i) {
    const auto a = static_cast<std::size_t>(i);
    EXPECT_EQ(file.calibration.model.sensor[a].scale, found->calibration.model.sensor[a].scale);
    EXPECT_EQ(file.calibration.model.sensor[a].bias, found->calibration.model.sensor[a].bias);
  }
}

TEST(Adoption, ParallelAxesAreNoReasonToRefuse) {
  const auto array = drone(3);
  const std::string text = kGood + px4_text(1, {0, 0, 0}, {1, 1, 1}) + px4_text(2, {0, 0, 0}, {1, 1, 1});
  const auto found = adopted(array, text);
  ASSERT_TRUE(found.has_value()) << found.error().text();
  for (int i = 3; i < 9; ++i) EXPECT_EQ(found->calibration.array.axis(i), found->calibration.array.axis(i - 3));
}

TEST(Adoption, AMissingUncertaintyIsRefusedByName) {
  const auto array = drone();
  EXPECT_TRUE(refused_with(adopted(array, kGood, {}), "CAL_ACC0 x: x1: states no uncertainty of bias, scale, axis"));
  pc::AdoptionChoice choice = usual_choice();
  choice.usual.axis_rad.reset();
  EXPECT_TRUE(refused_with(adopted(array, kGood, choice), "states no uncertainty of axis"));
  const std::string table = "id,scale,bias,sigma_bias\nx1,1,0 mg,1 mg\ny1,1,0 mg,\nz1,1,0 mg,1 mg\n";
  choice = usual_choice();
  choice.usual.bias_mps2.reset();
  EXPECT_TRUE(refused_with(adopted(array, table, choice), "known.txt:3: y1: states no uncertainty of bias"));
  const auto found = adopted(array, table);
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_DOUBLE_EQ(*found->sensors[0].sigma.bias_mps2, 1e-3 * 9.80665) << "its own";
  EXPECT_DOUBLE_EQ(*found->sensors[1].sigma.bias_mps2, 0.05) << "the usual one";
}

TEST(Adoption, EverySensorNeedsCoefficientsOnce) {
  const auto array = drone(2);
  EXPECT_TRUE(refused_with(adopted(array, kGood), "known.txt: holds 1 chip, but array.toml has 2"));
  pc::AdoptionChoice choice = usual_choice();
  choice.instances = {{0, "imu2"}};
  EXPECT_TRUE(refused_with(adopted(array, kGood, choice), "states no coefficients of x1, y1, z1"));
  const auto chip = pc::parse_coefficients(kGood, "v.params", array);
  const auto rest = pc::parse_coefficients("id,scale,bias\nx1,1,0 mg\ny1,1,0 mg\nz1,1,2 mg\n", "rest.csv", array);
  ASSERT_TRUE(chip && rest);
  const auto both = pc::adopt(array, {*chip, *rest}, choice);
  ASSERT_TRUE(both.has_value()) << both.error().text();
  EXPECT_EQ(both->forms, "px4, csv");
  EXPECT_EQ(both->file_name, "v.params, rest.csv");
  EXPECT_DOUBLE_EQ(both->calibration.model.sensor[3].bias[0], 0.1);
  const auto implied = pc::adopt(array, {*rest, *chip}, usual_choice());
  ASSERT_TRUE(implied.has_value()) << "what a table states is no chip that is left: " << implied.error().text();
  EXPECT_DOUBLE_EQ(implied->calibration.model.sensor[3].bias[0], 0.1);
  choice.instances = {{0, "imu1"}};
  EXPECT_TRUE(refused_with(pc::adopt(array, {*chip, *rest}, choice), "is stated by"));
  EXPECT_TRUE(refused_with(pc::adopt(array, {*rest, *rest}, usual_choice()), "is stated by rest.csv:2 already"));
  EXPECT_TRUE(refused_with(pc::adopt(array, {*chip, *chip}, usual_choice()), "beside one of px4"));
  EXPECT_TRUE(refused_with(pc::adopt(array, {}, usual_choice()), "names no file"));
  choice.instances = {{0, "imu1"}};
  EXPECT_TRUE(refused_with(pc::adopt(array, {*rest}, choice), "belongs to files of chips"));
}

TEST(Adoption, ValuesThatNoSuchSensorHasAreRefused) {
  const auto array = drone();
  const auto with = [&array](const std::string& row) {
    return adopted(array, "id,scale,bias,axis_x,axis_y,axis_z\n" + row + "\ny1,1,0 mg,,,\nz1,1,0 mg,,,\n");
  };
  EXPECT_TRUE(with("x1,1.25,0 mg,,,").has_value());
  EXPECT_TRUE(refused_with(with("x1,1.26,0 mg,,,"), "x1: has a scale of 1.26"));
  EXPECT_TRUE(refused_with(with("x1,0.79,0 mg,,,"), "has a scale"));
  EXPECT_TRUE(refused_with(with("x1,-1,0 mg,,,"), "-1 times the nominal one"));
  EXPECT_TRUE(with("x1,1,159 mg,,,").has_value());
  EXPECT_TRUE(refused_with(with("x1,1,161 mg,,,"), "x1: has a bias 161 mg0"));
  EXPECT_TRUE(with("x1,1,0 mg,0.9702957262759965,0.24192189559966773,0").has_value()) << "14 deg";
  EXPECT_TRUE(refused_with(with("x1,1,0 mg,0.9612616959383189,0.27563735581699916,0"), "has an axis 16 deg from"));
  EXPECT_TRUE(refused_with(with("x1,1,0 mg,0,1,0"), "has an axis 90 deg from"));
  EXPECT_TRUE(refused_with(
      adopted(array, "id,scale,bias,bias_t3\nx1,1,0 mg,1e200 m/s^2/degC^3\ny1,1,0 mg,\nz1,1,0 mg,\n"), "out of range"));
}

// What an autopilot has applied is refused where the array file says so, and where it does not the reader is told for
// which readings it is; a table states what it states of these readings, and is taken.
TEST(Adoption, WhatTheReadingsHaveAlreadyIsNotAppliedAgain) {
  const auto raw = adopted(array_of(drone_toml(1, "unit = \"m/s^2\"")), kGood);
  ASSERT_TRUE(raw.has_value());
  EXPECT_TRUE(std::any_of(raw->notes.begin(), raw->notes.end(), [](const std::string& note) {
    return note.find("are for readings before them") != std::string::npos;
  }));
  const auto corrected = array_of(drone_toml(1, "unit = \"m/s^2\"\ncorrected = true"));
  EXPECT_TRUE(refused_with(adopted(corrected, kGood), "which the readings have already"));
  EXPECT_TRUE(adopted(corrected, "id,scale,bias\nx1,1,0 mg\ny1,1,0 mg\nz1,1,0 mg\n").has_value());
}

TEST(Adoption, TheTemperaturesAreThoseStated) {
  const auto array = array_of(drone_toml(1, "unit = \"m/s^2\"\ntemperature = \"temp\""));
  const auto alone = adopted(array, kGood);
  ASSERT_TRUE(alone.has_value());
  EXPECT_EQ(alone->span.min_degc, 25.0);
  EXPECT_EQ(alone->span.max_degc, 25.0);
  ASSERT_EQ(alone->notes.size(), 4U);
  EXPECT_NE(alone->notes[2].find("25 degC alone"), std::string::npos);
  pc::AdoptionChoice choice = usual_choice();
  choice.span = pc::TemperatureSpan{-10.0, 60.0};
  const auto stated = adopted(array, kGood, choice);
  ASSERT_TRUE(stated.has_value());
  EXPECT_EQ(stated->calibration.report.temperature_min_degc, -10.0);
  EXPECT_EQ(stated->calibration.report.temperature_max_degc, 60.0);
  const std::string apart =
      "id,scale,bias,t_min,t_max\nx1,1,0 mg,0 degC,20 degC\ny1,1,0 mg,30 degC,40 degC\nz1,1,0 mg,,\n";
  EXPECT_TRUE(refused_with(adopted(array, apart), "hold at no common temperature"));
}

TEST(ChipPlaces, FollowPackagesOrTheOrderOfTheFile) {
  const auto by_three = array_of(drone_toml(2, "unit = \"m/s^2\"", "", false));
  const auto found = adopted(by_three, kGood + px4_text(3, {0, 0, 0.2}, {1, 1, 1}));
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_DOUBLE_EQ(found->calibration.model.sensor[5].bias[0], 0.2);
  EXPECT_EQ(found->chips[1].instance, 3);
  // A package whose sensors do not stand in a row.
  std::string mixed = drone_toml(2);
  const std::size_t x2 = mixed.find("\n[[sensor]]\nid = \"x2\"");
  const std::size_t y2 = mixed.find("\n[[sensor]]\nid = \"y2\"");
  const std::string moved = mixed.substr(x2, y2 - x2);
  mixed.erase(x2, y2 - x2);
  mixed.insert(mixed.find("\n[[sensor]]\nid = \"x1\""), moved);
  const auto array = array_of(mixed);
  const auto places = pc::places_of(array);
  ASSERT_TRUE(places.has_value()) << places.error().text();
  ASSERT_EQ(places->size(), 2U);
  EXPECT_EQ((*places)[0].name, "imu2");
  EXPECT_EQ((*places)[0].sensor, (std::array<int, 3>{0, 4, 5}));
}

TEST(ChipPlaces, WhatIsNoChipIsRefused) {
  const auto array = array_of(drone_toml(1) + sensor_toml("s", "[0.6, 0.8, 0]"));
  EXPECT_TRUE(refused_with(pc::places_of(array), "sensors without a package: has 1 sensor"));
  EXPECT_TRUE(pc::places_of(array, plumb::SensorSet::of(3)).has_value());
  const auto skew = array_of(drone_toml(1, "unit = \"m/s^2\"", "", false) + sensor_toml("s", "[0.6, 0.8, 0]") +
                             sensor_toml("t", "[0.6, 0, 0.8]") + sensor_toml("u", "[0, 0.6, 0.8]"));
  EXPECT_TRUE(refused_with(pc::places_of(skew), "chip 2: does not lie at right angles (s, t, u)"));
}

TEST(ChipPlaces, AreNamedByHand) {
  const auto array = drone(2);
  const auto named = pc::place_named(array, "x2,-y2,-");
  ASSERT_TRUE(named.has_value()) << named.error().text();
  EXPECT_EQ(named->sensor, (std::array<int, 3>{3, 4, -1}));
  EXPECT_EQ(named->sign, (std::array<int, 3>{1, -1, 1}));
  EXPECT_TRUE(refused_with(pc::place_named(array, "x1,x1,z1"), "twice"));
  EXPECT_TRUE(refused_with(pc::place_named(array, "x1,y1"), "names 2"));
  EXPECT_TRUE(refused_with(pc::place_named(array, "-,-,-"), "no package"));
  EXPECT_TRUE(refused_with(pc::place_named(array, "x1,y1,z1,x2"), "names 4"));
  EXPECT_TRUE(refused_with(pc::place_named(array, "imu3"), "\"imu3\" is neither a package nor a sensor"));
  EXPECT_TRUE(refused_with(pc::parse_instance("imu1"), "is no number"));
  EXPECT_TRUE(refused_with(pc::parse_instance("=imu1"), "is no number"));
  EXPECT_TRUE(refused_with(pc::parse_instance("-1=imu1"), "is no number"));
  EXPECT_TRUE(refused_with(pc::parse_instance("1000=imu1"), "is no number"));
  EXPECT_TRUE(refused_with(pc::parse_instance("1="), "names no sensors"));
  EXPECT_EQ(pc::parse_instance("3= imu1")->who, "imu1");
  pc::AdoptionChoice choice = usual_choice();
  choice.instances = {{7, "imu1"}};
  EXPECT_TRUE(refused_with(adopted(array, kGood, choice), "there is no chip 7 in known.txt"));
  choice.instances = {{0, "imu1"}, {0, "imu2"}};
  EXPECT_TRUE(refused_with(adopted(array, kGood, choice), "chip 0 is named twice"));
  const std::string two = kGood + px4_text(1, {0, 0, 0}, {1, 1, 1});
  choice.instances = {{0, "imu1"}, {1, "x1,y2,z2"}};
  EXPECT_TRUE(refused_with(adopted(array, two, choice), "\"x1\" is in two chips"));
}

TEST(ChipPlaces, AChannelThatReadsTheOtherWayRoundHasTheOtherOffset) {
  std::string toml = drone_toml(1);
  toml.replace(toml.find("[0, 1, 0]"), 9, "[0, -1, 0]");
  toml.replace(toml.find("[0, 0, 1]"), 9, "[0, 0, -1]");
  const auto array = array_of(toml);  // a log in FLU: y and z are minus those of PX4
  const std::string text = px4_text(0, {0.1, 0.2, 0.3}, {1.0, 1.25, 1.0});
  pc::AdoptionChoice choice = usual_choice();
  choice.instances = {{0, "x1,-y1,-z1"}};
  const auto found = adopted(array, text, choice);
  ASSERT_TRUE(found.has_value()) << found.error().text();
  // PX4's y reads 8.2 where the channel reads -8.2: (8.2 - 0.2) 1.25 = 10 along PX4's y, -10 along the channel's axis.
  EXPECT_NEAR(felt(found->calibration.model, 1, -8.2), -10.0, 1e-12);
}

TEST(ChipPlaces, AnOrderThatIsNoFrameIsRefusedForAutopilots) {
  std::string toml = drone_toml(1);
  toml.replace(toml.find("[0, 1, 0]"), 9, "[0, -1, 0]");
  const auto mirrored = array_of(toml);
  EXPECT_TRUE(refused_with(adopted(mirrored, kGood), "imu1: is no right-handed frame in the order x1, y1, z1"));
  pc::AdoptionChoice choice = usual_choice();
  choice.instances = {{0, "x1,-y1,z1"}};
  EXPECT_TRUE(adopted(mirrored, kGood, choice).has_value());
  // Axes that state what gravity does: the channels of an autopilot along minus its axes.
  std::string gravity = drone_toml(1);
  gravity.replace(gravity.find("specific-force"), 14, "gravity");
  gravity.replace(gravity.find("[1, 0, 0]"), 9, "[-1, 0, 0]");
  gravity.replace(gravity.find("[0, 1, 0]"), 9, "[0, -1, 0]");
  gravity.replace(gravity.find("[0, 0, 1]"), 9, "[0, 0, -1]");
  EXPECT_TRUE(adopted(array_of(gravity), kGood).has_value());
}

}  // namespace
}  // namespace adoption_test
