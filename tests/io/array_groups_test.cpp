// [[group]] in an array file: magnetometers and gyros beside the accelerometers.
#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>

#include "io_test_support.hpp"
#include "plumb/calibration/acceptance.hpp"

namespace array_groups_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

const char* const kMagnetic = R"(
[[group]]
name = "mag"
field = "magnetic"
unit = "nT"

[group.reference]
value = "50 uT"
sigma = "100 nT"
dip = "72 deg"

[group.monitor]
disturbance_bound = "200 nT"

[[group.sensor]]
id = "m1"
axis = [1, 0, 0]
noise = "20 nT"
bias = "1.5 uT"

[[group.sensor]]
id = "m2"
axis = [0, 1, 0]
noise = "0.02 uT"
stability = "8 nT"

[[group.sensor]]
id = "m3"
axis = [0, 0, 1]
noise = "0.2 mG"
full_scale = "1 G"
)";

const char* const kRate = R"(
[[group]]
field = "rate"
unit = "deg/s"

[group.rate]
sample_period_s = 0.01
rate_bound_radps = 12
bias_bound_radps = 0.02

[[group.sensor]]
id = "g1"
axis = [1, 0, 0]
noise = "0.05 deg/s"

[[group.sensor]]
id = "g2"
axis = [0, 1, 0]
noise = "0.05 deg/s"
bias_bound_radps = 0.03

[[group.sensor]]
id = "g3"
axis = [0, 0, 1]
noise = "0.05 deg/s"
)";

std::string tool() { return std::string(kArrayText) + kMagnetic + kRate; }

ArrayFile group_of(const std::string& text, const std::string& name, const FieldLookup& lookup = {}) {
  FileExpected<ArrayFile> file = parse_array_text(text, "tool.toml", lookup, name);
  EXPECT_TRUE(file.has_value()) << file.error().text();
  return file ? *file : ArrayFile{};
}

// Verifies: REQ-240
TEST(ArrayGroups, AMagneticGroupIsReadInItsUnits) {
  const ArrayFile mag = group_of(tool(), "mag");
  EXPECT_EQ(mag.field, FieldKind::magnetic);
  EXPECT_EQ(mag.path, "tool.toml#mag");
  EXPECT_EQ(mag.gravity.model, GravityModel::magnetic);
  EXPECT_DOUBLE_EQ(mag.gravity.g_mps2, 12.5) << "50 uT, a quarter each";
  EXPECT_DOUBLE_EQ(mag.gravity.sigma_mps2, 0.025);
  EXPECT_TRUE(mag.gravity.plausible());
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(mag.array.sigma_mps2(i), 0.005, 1e-15) << "nT, uT and mG";
  EXPECT_DOUBLE_EQ(mag.datasheet.sensor[0].coefficients.bias[0], 0.375);
  EXPECT_DOUBLE_EQ(mag.datasheet.sensor[0].coefficients.scale[0], 4000.0) << "nT of the log";
  EXPECT_DOUBLE_EQ(mag.datasheet.sensor[2].full_scale_raw, 100000.0);
  EXPECT_DOUBLE_EQ(mag.stability[1].mps2, 0.002);
  EXPECT_DOUBLE_EQ(mag.monitor.acceleration_bound_mps2, 0.05);
  EXPECT_TRUE(mag.magnetic.dip_known);
  EXPECT_NEAR(mag.magnetic.dip_rad, rad_from_deg(72.0), 1e-15);
  EXPECT_EQ(mag.input.time_column, array_of().input.time_column) << "the layout of the log is that of the file";
}

TEST(ArrayGroups, ARateGroupIsReadWithItsBounds) {
  const ArrayFile gyros = group_of(tool(), "rate");
  EXPECT_EQ(gyros.field, FieldKind::rate);
  EXPECT_NEAR(gyros.array.sigma_mps2(0), rad_from_deg(0.05), 1e-15);
  EXPECT_DOUBLE_EQ(gyros.rate.sample_period_s, 0.01);
  EXPECT_DOUBLE_EQ(gyros.rate.rate_bound_radps, 12.0);
  EXPECT_DOUBLE_EQ(gyros.rate.errors[0].bias_radps, 0.02);
  EXPECT_DOUBLE_EQ(gyros.rate.errors[1].bias_radps, 0.03) << "its own";
}

TEST(ArrayGroups, TheAccelerometersStayAsTheyAre) {
  const ArrayFile whole = array_of(tool()), alone = array_of();
  EXPECT_EQ(whole.fingerprint, alone.fingerprint);
  ASSERT_EQ(whole.groups.size(), 2U);
  EXPECT_TRUE(alone.groups.empty());
  EXPECT_NE(whole.groups[0].fingerprint, whole.groups[1].fingerprint);
}

// Verifies: REQ-240
TEST(ArrayGroups, PlaceAndDateAreAskedOfTheModel) {
  const std::string text =
      changed("value = \"50 uT\"\nsigma = \"100 nT\"\ndip = \"72 deg\"",
              "model = \"wmm\"\nlatitude = \"60.4 deg\"\nlongitude = \"2.1 deg\"\ndate = \"2026-03-31\"", tool());
  const auto without = parse_array_text(text, "tool.toml");
  ASSERT_FALSE(without.has_value());
  EXPECT_EQ(without.error().field, "group[1].reference.model");
  const auto lookup = [](const MagneticPlace& place) -> FileExpected<MagneticReference> {
    EXPECT_NEAR(place.latitude_deg, 60.4, 1e-12);
    EXPECT_NEAR(place.longitude_deg, 2.1, 1e-12);
    EXPECT_EQ(place.date, "2026-03-31");
    return MagneticReference{"a model", 51.0, 0.143, true, 1.27, 0.004};
  };
  const ArrayFile mag = group_of(text, "mag", lookup);
  EXPECT_DOUBLE_EQ(mag.gravity.g_mps2, 12.75);
  EXPECT_EQ(mag.magnetic.source, "a model");
  const auto refuses = [](const MagneticPlace&) -> FileExpected<MagneticReference> {
    return tl::unexpected<FileError>(FileError{"", 0, "date", "is outside of the model", "give another"});
  };
  const auto refused = parse_array_text(text, "tool.toml", refuses);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().field, "group[1].reference.date");
  EXPECT_GT(refused.error().line, 0);
}

struct Bad {
  const char *old_text, *new_text, *field, *says;
};

// Negative: REQ-240
TEST(ArrayGroups, WhatIsWrongIsSaidWithItsPlaceAndItsRemedy) {
  const Bad cases[] = {
      {"field = \"magnetic\"", "field = \"magnetc\"", "group[1].field", "magnetic"},
      {"unit = \"nT\"", "", "group[1].unit", "uT"},
      {"unit = \"nT\"", "unit = \"m/s^2\"", "group[1].unit", "nT"},
      {"value = \"50 uT\"", "value = \"50 nT\"", "group[1].reference.value", "20 to 70 uT"},
      {"value = \"50 uT\"", "value = \"50\"", "group[1].reference.value", "uT"},
      {"value = \"50 uT\"", "value = \"9.81 m/s^2\"", "group[1].reference.value", "uT"},
      {"value = \"50 uT\"", "value = \"50 uT\"\nlatitude = \"60 deg\"", "group[1].reference.latitude", "remove it"},
      {"sigma = \"100 nT\"", "sigma = \"1 uT\"", "group[1].reference.sigma", "0.4 uT"},
      {"dip = \"72 deg\"", "dip = \"95 deg\"", "group[1].reference.dip", "-1.57"},
      {"dip = \"72 deg\"", "dip_sigma = \"0.2 deg\"", "group[1].reference.dip_sigma", "add dip"},
      {"full_scale = \"1 G\"", "full_scale = \"0.4 G\"", "group[1].sensor[3].full_scale", "the magnetic field"},
      {"noise = \"20 nT\"", "noise = \"20 mg\"", "group[1].sensor[1].noise", "nT"},
      {"disturbance_bound", "acceleration_bound", "group[1].monitor.acceleration_bound", "disturbance_bound"},
      {"disturbance_bound = \"200 nT\"", "mode = \"paper\"", "group[1].monitor.mode", "gravity only"},
      {"stability = \"8 nT\"", "stability = \"90 uT\"", "group[1].sensor[2].stability", "40 uT"},
      {"id = \"m2\"", "id = \"m2\"\nlever_arm_m = [0, 0, 1]", "group[1].sensor[2].lever_arm_m", "not a known key"},
      {"name = \"mag\"", "name = \"rate\"", "group[2].name", "two groups"},
      {"name = \"mag\"", "name = \"../mag\"", "group[1].name", "letters"},
      {"name = \"mag\"", "name = \"a b\"", "group[1].name", "letters"},
      {"name = \"mag\"", "name = \"-m\"", "group[1].name", "letters"},
      {"id = \"g3\"", "id = \"m3\"", "group[2].sensor", "column"},
      {"id = \"m3\"", "id = \"m3\"\ncolumn = \"a1_v\"", "group[1].sensor", "accelerometer"},
      {"sample_period_s = 0.01", "", "group[2].rate.sample_period_s", "sample_period_s"},
      {"rate_bound_radps = 12", "rate_bound_radps = -1", "group[2].rate.rate_bound_radps", "rad/s"},
      {"bias_bound_radps = 0.03", "stability = \"1 deg/s\"", "group[2].sensor[2].stability", "not a known key"},
  };
  for (const Bad& bad : cases) {
    const auto file = parse_array_text(changed(bad.old_text, bad.new_text, tool()), "tool.toml");
    ASSERT_FALSE(file.has_value()) << bad.new_text;
    EXPECT_EQ(file.error().field, bad.field) << file.error().text();
    EXPECT_NE(file.error().text().find(bad.says), std::string::npos) << file.error().text();
    EXPECT_FALSE(file.error().remedy.empty()) << bad.new_text;
  }
}

TEST(ArrayGroups, AnUnknownGroupIsAnsweredWithThoseThatThereAre) {
  const auto file = parse_array_text(tool(), "tool.toml", {}, "gyro");
  ASSERT_FALSE(file.has_value());
  EXPECT_NE(file.error().remedy.find("tool.toml#mag, tool.toml#rate"), std::string::npos) << file.error().text();
  const auto none = parse_array_text(std::string(kArrayText), "tool.toml", {}, "mag");
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().field, "group");
}

/// What the core knows of a field is its length: a reading that a calibration brings to that length passes.
RC_GTEST_PROP(ArrayGroups, EveryUnitOfAFieldMeansTheSame, ()) {
  const double ut = 0.001 * *rc::gen::inRange(-70000, 70001);
  const struct {
    const char* unit;
    double per_ut;
  } units[] = {{"uT", 1.0}, {"nT", 1000.0}, {"mG", 10.0}, {"G", 0.01}, {"mT", 1e-3}, {"T", 1e-6}, {"gamma", 1000.0}};
  for (const auto& one : units) {
    const auto read =
        parse_quantity(Quantity::acceleration, shortest(ut * one.per_ut) + " " + one.unit, FieldKind::magnetic);
    RC_ASSERT(read.has_value());
    RC_ASSERT(std::fabs(*read - kInside_per_ut * ut) <= 1e-12 * std::fabs(ut));
  }
  RC_ASSERT(!parse_quantity(Quantity::acceleration, shortest(ut) + " mg", FieldKind::magnetic).has_value());
  RC_ASSERT(!parse_quantity(Quantity::acceleration, shortest(ut) + " uT").has_value());
}

}  // namespace
}  // namespace array_groups_test
