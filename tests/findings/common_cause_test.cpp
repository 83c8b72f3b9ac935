// Sensors of one direction on several chips that move together.
#include "plumb/findings/common_cause.hpp"

#include <gtest/gtest.h>

#include <string>

namespace common_cause_test {
namespace {

using namespace plumb;
using findings::common_cause;
using findings::CommonSign;

/// Three parallel chips of three axes each: x1, y1, z1, x2, ...
io::ArrayFile chips(bool named) {
  std::string text =
      "name = \"chips\"\n[gravity]\nmodel = \"value\"\nvalue = \"9.80665 m/s^2\"\n[input]\nrows = \"stations\"\n"
      "unit = \"m/s^2\"\nreads = \"gravity\"\n";
  const char* const axes[] = {"[1,0,0]", "[0,1,0]", "[0,0,1]"};
  for (int k = 1; k <= 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      text += std::string("[[sensor]]\nid = \"") + "xyz"[a] + std::to_string(k) + "\"\naxis = " + axes[a] +
              "\nnoise = \"0.2 mg\"\n";
      if (named) text += "package = \"imu" + std::to_string(k) + "\"\n";
    }
  }
  io::FileExpected<io::ArrayFile> array = io::parse_array_text(text, "chips.toml");
  EXPECT_TRUE(array) << (array ? "" : array.error().text());
  return *array;
}

constexpr int kZ1 = 2, kZ2 = 5, kZ3 = 8, kX2 = 3;

findings::CommonEvidence without(SensorSet out, bool length_off = false) { return {out, length_off}; }

// Verifies: REQ-044
TEST(CommonCause, TwoSensorsOfOneDirectionOnTwoChipsNameTheThird) {
  for (const bool named : {false, true}) {
    const auto found = common_cause(chips(named), without(SensorSet::of(kZ1).with(kZ3)), Verdict{});
    ASSERT_TRUE(found) << named;
    EXPECT_EQ(found->sign, CommonSign::several);
    EXPECT_EQ(found->moved, SensorSet::of(kZ1).with(kZ3));
    EXPECT_EQ(found->others, SensorSet::of(kZ2));
  }
}

// Verifies: REQ-044
TEST(CommonCause, OneSensorWithoutWhichTheLengthIsStillOffNamesTheOthers) {
  const auto found = common_cause(chips(true), without(SensorSet::of(kZ3), true), Verdict{});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->sign, CommonSign::remaining);
  EXPECT_EQ(found->others, SensorSet::of(kZ1).with(kZ2));
}

// Negative: REQ-044
TEST(CommonCause, OneSensorTwoDirectionsAndOneChipAreNone) {
  io::ArrayFile array = chips(true);
  EXPECT_FALSE(common_cause(array, without({}), Verdict{}));
  EXPECT_FALSE(common_cause(array, without(SensorSet::of(kZ1)), Verdict{}));
  EXPECT_FALSE(common_cause(array, without(SensorSet::of(kZ1).with(kX2), true), Verdict{}));
  array.package[kZ3] = array.package[kZ1];
  EXPECT_FALSE(common_cause(array, without(SensorSet::of(kZ1).with(kZ3)), Verdict{})) << "two of one chip";
}

// Verifies: REQ-044
TEST(CommonCause, ALengthThatIsOffAlongOneDirectionIsOne) {
  const io::ArrayFile array = chips(true);
  Verdict v;
  v.norm_mismatch.kind = NormMismatchKind::common_bias;
  v.norm_mismatch.bias_mps2 = {0.001, -0.002, 0.05};
  const auto found = common_cause(array, without({}), v);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->sign, CommonSign::length);
  EXPECT_EQ(found->others, SensorSet::of(kZ1).with(kZ2).with(kZ3));
  v.norm_mismatch.bias_mps2 = {0.05, 0.05, 0.05};
  EXPECT_FALSE(common_cause(array, without({}), v)) << "along no axis";
  v.norm_mismatch.bias_mps2 = {0.0, 0.0, 0.05};
  v.norm_mismatch.kind = NormMismatchKind::common_scale;
  EXPECT_FALSE(common_cause(array, without({}), v));
}

}  // namespace
}  // namespace common_cause_test
