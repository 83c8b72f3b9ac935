// Calibrations in the forms of others: values and losses by hand, and round trips.
#include <algorithm>
#include <random>

#include "coefficients_support.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"

namespace export_test {
namespace {

using namespace coefficients_test;
using plumb::Vec3;

/// A calibration file of these statements.
plumb::io::CalibrationFile file_of(const plumb::io::ArrayFile& array, const std::string& csv) {
  const auto found = adopted(array, csv);
  EXPECT_TRUE(found.has_value()) << (found ? "" : found.error().text());
  return found ? through_file(*found, array) : plumb::io::CalibrationFile{};
}

double parameter(const std::string& text, const std::string& name, char after) {
  const std::size_t at = text.find(name + after);
  EXPECT_NE(at, std::string::npos) << name << " in\n" << text;
  return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + name.size() + 1));
}

const std::string kThree =
    "id,scale,bias,axis_x,axis_y,axis_z\n"
    "x1,0.8,0.625 m/s^2,,,\n"
    "y1,1,-0.25 m/s^2,0.6e-2,0.999982,0\n"
    "z1,1.25,0 m/s^2,,,\n";

TEST(CalibrationExport, ToPx4HoldsOffsetAndScale) {
  const auto array = drone();
  std::string csv = kThree;
  csv.replace(csv.find("0.6e-2,0.999982,0"), 17, "0.006,0.9999819998379972,0");
  const auto made = pc::export_calibration(array, file_of(array, csv), pc::Form::px4);
  ASSERT_TRUE(made.has_value()) << made.error().text();
  // The inverse of (8.5 - 0.5) 1.25 = 10.
  EXPECT_DOUBLE_EQ(parameter(made->text, "CAL_ACC0_XOFF", '\t'), 0.5);
  EXPECT_DOUBLE_EQ(parameter(made->text, "CAL_ACC0_XSCALE", '\t'), 1.25);
  EXPECT_DOUBLE_EQ(parameter(made->text, "CAL_ACC0_YOFF", '\t'), -0.25);
  EXPECT_DOUBLE_EQ(parameter(made->text, "CAL_ACC0_ZSCALE", '\t'), 0.8);
  EXPECT_NE(made->text.find("1\t1\tCAL_ACC0_XOFF\t0.5\t9\n"), std::string::npos) << made->text;
  // The axis of y1 is turned by 0.006 rad: at worst 0.006 G of a reading.
  ASSERT_EQ(made->losses.size(), 1U);
  EXPECT_EQ(made->losses[0].sensor, 1);
  EXPECT_EQ(made->losses[0].what, "the axis");
  EXPECT_NEAR(made->losses[0].worst_mps2, 0.006 * 9.81, 1e-6);
  EXPECT_TRUE(made->left_out.empty());
}

TEST(CalibrationExport, ToArduPilotNumbersFromOne) {
  const auto array = drone();
  const auto file = file_of(array, "id,scale,bias\nx1,0.8,0.625 m/s^2\ny1,1,0 mg\nz1,1,0 mg\n");
  const auto made = pc::export_calibration(array, file, pc::Form::ardupilot);
  ASSERT_TRUE(made.has_value()) << made.error().text();
  EXPECT_DOUBLE_EQ(parameter(made->text, "INS_ACCOFFS_X", ','), 0.5);
  EXPECT_DOUBLE_EQ(parameter(made->text, "INS_ACCSCAL_X", ','), 1.25);
  EXPECT_TRUE(made->losses.empty());
  const auto fourth = pc::export_calibration(array, file, pc::Form::ardupilot, {{4, "imu1"}});
  ASSERT_TRUE(fourth.has_value());
  EXPECT_DOUBLE_EQ(parameter(fourth->text, "INS4_ACCOFFS_X", ','), 0.5);
}

TEST(CalibrationExport, ADriftThatIsLostIsSaidWithItsSize) {
  const auto array = array_of(drone_toml(1, "unit = \"m/s^2\"\ntemperature = \"temp\""));
  const auto file = file_of(array,
                            "id,scale,bias,scale_t1,bias_t1,t_min,t_max\n"
                            "x1,1,0.1 m/s^2,100 ppm/degC,0.001 m/s^2/degC,15 degC,45 degC\n"
                            "y1,1,0 mg,,,15 degC,45 degC\nz1,1,0 mg,,,15 degC,45 degC\n");
  const auto made = pc::export_calibration(array, file, pc::Form::px4);
  ASSERT_TRUE(made.has_value()) << made.error().text();
  ASSERT_EQ(made->losses.size(), 1U);
  EXPECT_EQ(made->losses[0].what, "the drift with temperature");
  // At 45 degC, 20 from t_ref: 2e-3 G of scale, and 1.002 (0.1 + 0.02) - 0.1 of bias.
  EXPECT_NEAR(made->losses[0].worst_mps2, 0.002 * 9.81 + 1.002 * 0.12 - 0.1, 1e-12);
}

TEST(CalibrationExport, WhatAFormCannotHoldIsRefused) {
  const auto two = drone(2);
  const std::string six = "id,scale,bias\nx1,1,0 mg\ny1,1,0 mg\nz1,1,0 mg\nx2,1,0 mg\ny2,1,0 mg\nz2,1,0 mg\n";
  const auto file = file_of(two, six);
  EXPECT_TRUE(refused_with(pc::export_calibration(two, file, pc::Form::imu_tk), "has 2 chips, and a file of imu_tk"));
  EXPECT_TRUE(refused_with(pc::export_calibration(two, file, pc::Form::csv, {{0, "imu1"}}), "names sensors by their"));
  EXPECT_TRUE(refused_with(pc::export_calibration(two, file, pc::Form::px4, {{4, "imu1"}}), "chip 4 is none of px4"));
  EXPECT_TRUE(refused_with(pc::export_calibration(two, file, pc::Form::ardupilot, {{0, "imu1"}}), "chip 0 is none"));
  EXPECT_TRUE(refused_with(pc::export_calibration(two, file, pc::Form::px4, {{0, "imu9"}}), "\"imu9\" is neither"));
  const auto one = pc::export_calibration(two, file, pc::Form::px4, {{2, "imu2"}});
  ASSERT_TRUE(one.has_value()) << one.error().text();
  EXPECT_EQ(one->left_out, plumb::SensorSet::first(3));
  EXPECT_NE(one->text.find("CAL_ACC2_ZOFF"), std::string::npos);
  EXPECT_EQ(one->text.find("CAL_ACC0"), std::string::npos);
  const auto skew = array_of(drone_toml(1) + sensor_toml("s", "[0.6, 0.8, 0]"));
  const auto of_skew = file_of(skew, "id,scale,bias\nx1,1,0 mg\ny1,1,0 mg\nz1,1,0 mg\ns,1,0 mg\n");
  EXPECT_TRUE(refused_with(pc::export_calibration(skew, of_skew, pc::Form::px4), "sensors without a package"));
  EXPECT_TRUE(pc::export_calibration(skew, of_skew, pc::Form::csv).has_value());
  EXPECT_TRUE(refused_with(pc::export_calibration(skew, of_skew, pc::Form::imu_tk, {{1, "x1,y1,s"}}), "in one plane"));
  EXPECT_TRUE(refused_with(pc::export_calibration(two, file, pc::Form::px4, {{0, "y1,x1,z1"}}), "right-handed"));
}

TEST(CalibrationExport, AnIdThatNoCellCanHoldIsRefusedAsCsvAndWrittenAsJson) {
  std::string toml = drone_toml(1);
  toml.replace(toml.find("\"x1\""), 4, "'a\"1'");
  const auto array = array_of(toml);
  const auto found = adopted(array, px4_text(0, {0, 0, 0}, {1, 1, 1}));
  ASSERT_TRUE(found.has_value()) << found.error().text();
  const auto file = through_file(*found, array);
  EXPECT_TRUE(refused_with(pc::export_calibration(array, file, pc::Form::csv), "cannot stand in a cell"));
  const auto json = pc::export_calibration(array, file, pc::Form::json);
  ASSERT_TRUE(json.has_value()) << json.error().text();
  EXPECT_TRUE(adopted(array, json->text, {}).has_value());
}

/// A calibration as a fit leaves it: sensors correlated, with a misfit and the gravity of the stand.
plumb::io::CalibrationFile fitted_file(const plumb::io::ArrayFile& array, std::mt19937& random) {
  std::normal_distribution<double> normal;
  plumb::io::CalibrationFile out;
  out.array_name = array.name;
  out.calibration.model = array.datasheet.model();
  out.calibration.array = array.array;
  const int n = array.array.size();
  std::vector<std::vector<double>> root(static_cast<std::size_t>(4 * n));
  for (auto& row : root) {
    for (int k = 0; k < 4 * n; ++k) row.push_back(1e-3 * normal(random));
  }
  plumb::RowUncertainty uncertainty;
  for (std::size_t a = 0; a < root.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      double sum = 0.0;
      for (std::size_t k = 0; k < root.size(); ++k) sum += root[a][k] * root[b][k];
      uncertainty.covariance[a * (a + 1) / 2 + b] = sum;
    }
  }
  uncertainty.misfit_mps2[1] = 0.01;
  uncertainty.common_scale = 2e-4;
  out.calibration.array.set_uncertainty(uncertainty);
  return out;
}

TEST(CalibrationExport, TheSigmasOfATableClaimNoMoreThanTheCalibration) {
  const auto array = drone(2);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 20; ++round) {
    const auto file = fitted_file(array, random);
    const auto made = pc::export_calibration(array, file, pc::Form::csv);
    ASSERT_TRUE(made.has_value()) << made.error().text();
    ASSERT_EQ(made->notes.size(), 1U);
    EXPECT_NE(made->notes[0].find("keeps no correlations"), std::string::npos);
    const auto again = adopted(array, made->text, {});
    ASSERT_TRUE(again.has_value()) << again.error().text();
    // Whatever combination of errors is asked for, its variance is no smaller.
    for (int draw = 0; draw < 200; ++draw) {
      std::vector<double> z;
      for (int k = 0; k < 24; ++k) z.push_back(normal(random));
      double before = 0.0, after = 0.0;
      for (int a = 0; a < 24; ++a) {
        for (int b = 0; b < 24; ++b) {
          const double zz = z[static_cast<std::size_t>(a)] * z[static_cast<std::size_t>(b)];
          before += zz * file.calibration.array.row_covariance(a, b);
          after += zz * again->calibration.array.row_covariance(a, b);
        }
      }
      const double misfit = z[7] * 0.01;
      EXPECT_GE(after * (1.0 + 1e-9), before + misfit * misfit);
    }
  }
}

/// Random coefficients within what an array file allows, of every sensor of the array.
std::string random_csv(const plumb::io::ArrayFile& array, std::mt19937& random, bool axes, bool drifts) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto text = [](double value) { return plumb::io::shortest(value); };
  std::string out =
      "id,scale,bias,axis_x,axis_y,axis_z,bias_t1,bias_t3,scale_t1,scale_t2,t_ref,t_min,t_max,sigma_bias,"
      "sigma_scale,sigma_axis\n";
  for (int i = 0; i < array.array.size(); ++i) {
    const auto& nominal = array.datasheet.sensor[static_cast<std::size_t>(i)].coefficients;
    Vec3 axis = array.array.axis(i);
    for (double& c : axis) c += axes ? 0.1 * unit(random) : 0.0;
    axis = plumb::scaled(axis, 1.0 / plumb::norm(axis));
    const double ratio = 1.0 + 0.2 * unit(random);
    out += std::string(array.array.row(i).id.data()) + "," + text(nominal.scale[0] * ratio) + " " +
           array.input.unit.name + "/(m/s^2)," + text((nominal.bias[0] + 1.5 * unit(random)) / ratio) + " m/s^2";
    for (const double c : axis) out += "," + text(c);
    out += drifts ? "," + text(1e-3 * unit(random)) + " m/s^2/degC," + text(1e-7 * unit(random)) + " m/s^2/degC^3," +
                        text(200.0 * unit(random)) + " ppm/degC," + text(2.0 * unit(random)) + " ppm/degC^2,"
                  : ",,,,,";
    out += "31.5 degC,-20 degC,70.25 degC," + text(0.05 + 0.04 * unit(random)) + " m/s^2," +
           text(1e-3 + 9e-4 * unit(random)) + "," + text(0.02 + 0.01 * unit(random)) + " rad\n";
  }
  return out;
}

TEST(CoefficientLaws, ATableReadsBackExactly) {
  std::mt19937 random(1);
  const std::vector<std::pair<std::string, std::string>> units = {
      {"unit = \"m/s^2\"", ""},
      {"unit = \"g0\"", ""},
      {"unit = \"mV\"", "scale = \"3 V/g0\"\nbias = \"1.5 V\"\n"},
      {"unit = \"count\"", "scale = \"2048 count/g0\"\nbias = \"32768 count\"\n"}};
  for (int round = 0; round < 120; ++round) {
    const auto& [unit, more] = units[static_cast<std::size_t>(round) % units.size()];
    const auto array = array_of(drone_toml(1 + round % 3, unit + "\ntemperature = \"temp\"", more));
    const auto first = adopted(array, random_csv(array, random, true, true), {});
    ASSERT_TRUE(first.has_value()) << first.error().text();
    for (const auto form : {pc::Form::csv, pc::Form::json}) {
      const auto made = pc::export_calibration(array, through_file(*first, array), form);
      ASSERT_TRUE(made.has_value()) << made.error().text();
      EXPECT_TRUE(made->notes.empty()) << made->notes.front();
      const auto second = adopted(array, made->text, {});
      ASSERT_TRUE(second.has_value()) << second.error().text();
      EXPECT_EQ(second->span.min_degc, -20.0);
      EXPECT_EQ(second->span.max_degc, 70.25);
      for (std::size_t i = 0; i < first->sensors.size(); ++i) {
        const auto& a = first->sensors[i];
        const auto& b = second->sensors[i];
        EXPECT_EQ(a.model.scale[0], b.model.scale[0]);
        EXPECT_EQ(a.model.bias, b.model.bias);
        EXPECT_EQ(a.axis, b.axis);
        EXPECT_EQ(a.model.reference_degc, b.model.reference_degc);
        for (std::size_t k = 1; k < 4; ++k)
          EXPECT_NEAR(a.model.scale[k], b.model.scale[k], 4e-16 * std::fabs(a.model.scale[k]));
        EXPECT_NEAR(*a.sigma.bias_mps2, *b.sigma.bias_mps2, 1e-12 * *a.sigma.bias_mps2);
        EXPECT_NEAR(*a.sigma.scale, *b.sigma.scale, 1e-10 * *a.sigma.scale);
        EXPECT_NEAR(*a.sigma.axis_rad, *b.sigma.axis_rad, 1e-10 * *a.sigma.axis_rad);
      }
    }
  }
}

/// What a calibration makes of readings, within the precision of the form.
void expect_same_readings(const plumb::io::ArrayFile& array, const pc::Adoption& a, const pc::Adoption& b,
                          double within_mps2, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < array.array.size(); ++i) {
    const auto& nominal = array.datasheet.sensor[static_cast<std::size_t>(i)].coefficients;
    const double raw = nominal.scale[0] * (nominal.bias[0] + 20.0 * unit(random));
    EXPECT_NEAR(felt(a.calibration.model, i, raw), felt(b.calibration.model, i, raw), within_mps2);
  }
}

TEST(CoefficientLaws, ParametersOfAutopilotsReadBackInSinglePrecision) {
  std::mt19937 random(2);
  const std::vector<std::pair<std::string, std::string>> units = {
      {"unit = \"m/s^2\"", ""},
      {"unit = \"mg\"", ""},
      {"unit = \"count\"", "scale = \"2048 count/g0\"\nbias = \"-300 count\"\n"}};
  for (int round = 0; round < 120; ++round) {
    const auto& [unit, more] = units[static_cast<std::size_t>(round) % units.size()];
    const auto array = array_of(drone_toml(1 + round % 3, unit, more));
    const auto first = adopted(array, random_csv(array, random, false, false), {});
    ASSERT_TRUE(first.has_value()) << first.error().text();
    const auto file = through_file(*first, array);
    for (const auto form : {pc::Form::px4, pc::Form::ardupilot}) {
      const auto made = pc::export_calibration(array, file, form);
      ASSERT_TRUE(made.has_value()) << made.error().text();
      EXPECT_TRUE(made->losses.empty());
      const auto second = adopted(array, made->text);
      ASSERT_TRUE(second.has_value()) << second.error().text();
      EXPECT_EQ(second->forms, pc::to_string(form));
      expect_same_readings(array, *first, *second, 5e-6, random);
    }
  }
}

TEST(CoefficientLaws, AFileOfImuTkReadsBackWithItsAxes) {
  std::mt19937 random(4);
  for (int round = 0; round < 120; ++round) {
    const auto array =
        array_of(drone_toml(1, round % 2 == 0 ? "unit = \"m/s^2\"" : "unit = \"count\"",
                            round % 2 == 0 ? "" : "scale = \"2048 count/g0\"\nbias = \"32768 count\"\n"));
    const auto first = adopted(array, random_csv(array, random, true, false), {});
    ASSERT_TRUE(first.has_value()) << first.error().text();
    const auto made = pc::export_calibration(array, through_file(*first, array), pc::Form::imu_tk);
    ASSERT_TRUE(made.has_value()) << made.error().text();
    const auto second = adopted(array, made->text);
    ASSERT_TRUE(second.has_value()) << second.error().text() << made->text;
    EXPECT_EQ(second->forms, "imu_tk");
    expect_same_readings(array, *first, *second, 1e-10, random);
    for (int i = 0; i < 3; ++i)
      EXPECT_LT(plumb::angle_between_rad(first->calibration.array.axis(i), second->calibration.array.axis(i)), 1e-13);
  }
}

/// Any small edit of a good file is read or refused, never worse.
TEST(CoefficientLaws, AnEditedFileIsReadOrRefused) {
  const auto array = drone(1);
  std::mt19937 random(5);
  const std::string csv = random_csv(array, random, true, true);
  const auto first = adopted(array, csv, {});
  ASSERT_TRUE(first.has_value());
  std::vector<std::string> good = {csv, px4_text(0, {0.1, 0.2, 0.3}, {1, 1, 1})};
  for (const auto form : {pc::Form::json, pc::Form::imu_tk, pc::Form::ardupilot})
    good.push_back(pc::export_calibration(array, through_file(*first, array), form)->text);
  int read = 0, refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = good[static_cast<std::size_t>(round) % good.size()];
    for (int edit = 0; edit <= round % 4; ++edit) {
      const std::size_t at = random() % text.size();
      const char with = "0123456789.-e,\n\t {}[]\"=\x1b\xff"[random() % 25];
      if (random() % 2 == 0) {
        text[at] = with;
      } else {
        text.erase(at, 1 + random() % 8);
      }
    }
    const auto result = adopted(array, text);
    ++(result ? read : refused);
    if (!result) {
      EXPECT_FALSE(result.error().what.empty()) << text;
      continue;
    }
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(felt(result->calibration.model, i, 1.0)));
  }
  EXPECT_GT(read, 300);
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace export_test
