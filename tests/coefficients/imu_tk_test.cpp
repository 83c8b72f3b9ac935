// Files of imu_tk: a = T K (reading - b), by hand and for random chips.
#include <random>

#include "coefficients_support.hpp"

namespace imu_tk_test {
namespace {

using namespace coefficients_test;
using plumb::Mat3;
using plumb::Vec3;

std::string text_of(const Mat3& t, const Vec3& k, const Vec3& b) {
  const auto number = [](double value) { return plumb::io::shortest(value) + " "; };
  std::string out;
  for (std::size_t i = 0; i < 9; ++i) out += number(t[i]) + (i % 3 == 2 ? "\n" : "");
  out += "\n";
  for (std::size_t i = 0; i < 9; ++i) out += number(i % 4 == 0 ? k[i / 4] : 0.0) + (i % 3 == 2 ? "\n" : "");
  out += "\n";
  for (const double value : b) out += number(value) + "\n";
  return out + "\n";
}

const char* const kCounts = "scale = \"415 count/(m/s^2)\"\nbias = \"32768 count\"\n";

TEST(ImuTkCoefficients, WithoutMisalignmentAreScaleAndBias) {
  const auto array = array_of(drone_toml(1, "unit = \"count\"", kCounts));
  const auto found =
      adopted(array, text_of({1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.0025, 0.0024, 0.0023}, {33000, 32768, 32500}));
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_EQ(found->forms, "imu_tk");
  // 0.0025 (37000 - 33000) = 10
  EXPECT_NEAR(felt(found->calibration.model, 0, 37000.0), 10.0, 1e-12);
  EXPECT_NEAR(found->calibration.model.sensor[0].scale[0], 400.0, 1e-12);
  EXPECT_NEAR(found->calibration.model.sensor[0].bias[0], 82.5, 1e-12);
  EXPECT_EQ(found->calibration.array.axis(2), array.array.axis(2));
}

TEST(ImuTkCoefficients, AMisalignmentTurnsTheAxes) {
  const auto array = drone();
  // T^-1 of T = [1 -0.1 0; 0 1 0; 0 0 1] is [1 0.1 0; ...]: x reads (a_x + 0.1 a_y), along (1, 0.1, 0) / sqrt(1.01).
  const auto found = adopted(array, text_of({1, -0.1, 0, 0, 1, 0, 0, 0, 1}, {1, 1, 1}, {0.2, 0, 0}));
  ASSERT_TRUE(found.has_value()) << found.error().text();
  const double length = std::sqrt(1.01);
  EXPECT_NEAR(found->calibration.array.axis(0)[0], 1.0 / length, 1e-15);
  EXPECT_NEAR(found->calibration.array.axis(0)[1], 0.1 / length, 1e-15);
  EXPECT_NEAR(found->calibration.model.sensor[0].scale[0], length, 1e-15);
  EXPECT_NEAR(found->calibration.model.sensor[0].bias[0], 0.2 / length, 1e-15);
  EXPECT_EQ(found->calibration.array.axis(1), (Vec3{0, 1, 0}));
}

/// Chips that are turned in the array, and one whose y reads the other way round.
TEST(ImuTkCoefficients, OfARandomChipInAnyMountingSayWhatImuTkSays) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int judged = 0;
  for (int round = 0; round < 300; ++round) {
    // The chip's frame in the tool: columns of a rotation by quarter turns about random axes would be too tame.
    const double a = 3.0 * unit(random), b = 1.5 * unit(random), c = 3.0 * unit(random);
    const Vec3 x = {std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
    const Vec3 other = {std::sin(a) * -1.0, std::cos(a), 0.0};
    const Vec3 third = plumb::cross(x, other);
    const Vec3 y = plumb::plus(plumb::scaled(other, std::cos(c)), plumb::scaled(third, std::sin(c)));
    const Vec3 z = plumb::cross(x, y);
    const bool flipped = round % 3 == 0;
    const auto axis_text = [](const Vec3& v) {
      return "[" + plumb::io::shortest(v[0]) + ", " + plumb::io::shortest(v[1]) + ", " + plumb::io::shortest(v[2]) +
             "]";
    };
    const std::string head =
        "[gravity]\nmodel = \"value\"\nvalue = \"9.81 m/s^2\"\n[input]\nreads = "
        "\"specific-force\"\nunit = \"m/s^2\"\ntime = \"t\"\n";
    const auto array =
        array_of(head + sensor_toml("a", axis_text(x)) +
                 sensor_toml("b", axis_text(flipped ? plumb::scaled(y, -1.0) : y)) + sensor_toml("c", axis_text(z)));
    Mat3 t = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (const std::size_t k : {1U, 2U, 3U, 5U, 6U, 7U}) t[k] = 0.05 * unit(random);
    const Vec3 k = {1.0 + 0.1 * unit(random), 1.0 + 0.1 * unit(random), 1.0 + 0.1 * unit(random)};
    const Vec3 bias = {0.3 * unit(random), 0.3 * unit(random), 0.3 * unit(random)};
    pc::AdoptionChoice choice = usual_choice();
    if (flipped) choice.instances = {{1, "a,-b,c"}};
    const auto found = adopted(array, text_of(t, k, bias), choice);
    ASSERT_TRUE(found.has_value()) << found.error().text();
    // Readings of the chip, what imu_tk makes of them in the chip's frame, and that in the tool's.
    const Vec3 reading = {10.0 * unit(random), 10.0 * unit(random), 10.0 * unit(random)};
    Vec3 scaled{};
    for (std::size_t i = 0; i < 3; ++i) scaled[i] = k[i] * (reading[i] - bias[i]);
    const Vec3 chip = plumb::times(t, scaled);
    const Vec3 tool =
        plumb::plus(plumb::plus(plumb::scaled(x, chip[0]), plumb::scaled(y, chip[1])), plumb::scaled(z, chip[2]));
    for (int i = 0; i < 3; ++i) {
      const double raw = (flipped && i == 1 ? -1.0 : 1.0) * reading[static_cast<std::size_t>(i)];
      const double along = plumb::dot(found->calibration.array.axis(i), tool);
      EXPECT_NEAR(felt(found->calibration.model, i, raw), along, 1e-11) << round << " " << i;
      ++judged;
    }
  }
  EXPECT_EQ(judged, 900);
}

TEST(ImuTkCoefficients, SeveralFilesAreSeveralChips) {
  const auto array = drone(2);
  const std::string one = text_of({1, 0, 0, 0, 1, 0, 0, 0, 1}, {1.1, 1, 1}, {0, 0, 0});
  const std::string two = text_of({1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.9, 1, 1}, {0, 0, 0});
  const auto first = pc::parse_coefficients(one, "one.calib", array, std::nullopt, 1);
  const auto second = pc::parse_coefficients(two, "two.calib", array, std::nullopt, 2);
  ASSERT_TRUE(first && second);
  const auto found = pc::adopt(array, {*first, *second}, usual_choice());
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_NEAR(found->calibration.model.sensor[0].scale[0], 1.0 / 1.1, 1e-15);
  EXPECT_NEAR(found->calibration.model.sensor[3].scale[0], 1.0 / 0.9, 1e-15);
}

TEST(ImuTkCoefficients, WrongFilesAreRefused) {
  const auto array = drone();
  const auto parse = [&array](const std::string& text) {
    return pc::parse_coefficients(text, "acc.calib", array, pc::Form::imu_tk);
  };
  const Mat3 one = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_TRUE(parse(text_of(one, {1, 1, 1}, {0, 0, 0})).has_value());
  EXPECT_TRUE(refused_with(parse("1 2 3"), "fewer than the 21 numbers"));
  EXPECT_TRUE(refused_with(parse(text_of(one, {1, 1, 1}, {0, 0, 0}) + "5"), "more than the 21 numbers"));
  EXPECT_TRUE(refused_with(parse("1 0 0\n0 x 0"), "acc.calib:2: \"x\" is not a number"));
  EXPECT_TRUE(refused_with(parse(text_of(one, {1, 0, 1}, {0, 0, 0})), "scale matrix: has a 0 on its diagonal"));
  EXPECT_TRUE(refused_with(parse(text_of(one, {1, 1, 1}, {0, std::nan(""), 0})), "not finite"));
  EXPECT_TRUE(refused_with(parse(text_of({1, 1, 0, 1, 1, 0, 0, 0, 1}, {1, 1, 1}, {0, 0, 0})), "determinant 0"));
  std::string skew = text_of(one, {1, 1, 1}, {0, 0, 0});
  EXPECT_TRUE(refused_with(parse(skew.replace(skew.find("\n\n") + 4, 1, "2")), "scale matrix: is not diagonal"));
  EXPECT_TRUE(refused_with(adopted(array, text_of(one, {-1, 1, 1}, {0, 0, 0})), "has a scale that is not above 0"));
}

}  // namespace
}  // namespace imu_tk_test
