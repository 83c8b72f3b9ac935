// Sensors of one direction that move together.
#include "plumb/findings/common_cause.hpp"

#include <gtest/gtest.h>

#include "support/simulated_tool.hpp"

namespace common_cause_test {
namespace {

using namespace plumb;
using findings::common_cause;
using findings::CommonSign;

constexpr Mat3 kIdentity = {1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr Mat3 kCyclic = {0, 0, 1, 1, 0, 0, 0, 1, 0};  // z of the tool is x of the output
constexpr int kX2 = 3, kZ1 = 2, kZ2 = 5, kZ3 = 8;

/// `chips` parallel ones: x1, y1, z1, x2 ...
SensorArray parallel(int chips = 3) {
  AxisList axes{};
  for (std::size_t i = 0; i < 3U * static_cast<std::size_t>(chips); ++i) axes[i][i % 3] = 1.0;
  return plumb_test::make_array(axes, 3 * chips, 2e-3);
}

std::optional<findings::CommonCause> of(const SensorArray& array, SensorSet excluded, bool length_off = false) {
  return common_cause(array, kIdentity, {excluded, length_off}, Verdict{});
}

// Verifies: REQ-044
TEST(CommonCause, TwoExcludedSensorsOfOneDirectionNameTheThird) {
  const auto found = of(parallel(), SensorSet::of(kZ1).with(kZ3));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->sign, CommonSign::several);
  EXPECT_EQ(found->moved, SensorSet::of(kZ1).with(kZ3));
  EXPECT_EQ(found->others, SensorSet::of(kZ2));
}

// Verifies: REQ-044
TEST(CommonCause, OneSensorWithoutWhichTheLengthIsStillOffNamesTheOthers) {
  const auto found = of(parallel(), SensorSet::of(kZ3), true);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->sign, CommonSign::remaining);
  EXPECT_EQ(found->others, SensorSet::of(kZ1).with(kZ2));
}

// Negative: REQ-044
TEST(CommonCause, OneFaultTwoDirectionsAndASingleChipAreNone) {
  EXPECT_FALSE(of(parallel(), {}));
  EXPECT_FALSE(of(parallel(), {}, true));
  EXPECT_FALSE(of(parallel(), SensorSet::of(kZ1)));
  EXPECT_FALSE(of(parallel(), SensorSet::of(kZ1).with(kX2), true));
  EXPECT_FALSE(of(parallel(1), SensorSet::of(kZ1), true));
}

// Verifies: REQ-044
TEST(CommonCause, ALengthThatIsOffAlongOneDirectionIsOne) {
  Verdict v;
  v.norm_mismatch.kind = NormMismatchKind::common_bias;
  v.norm_mismatch.bias_mps2 = {0.001, -0.002, 0.05};
  const auto found = common_cause(parallel(), kIdentity, {}, v);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->sign, CommonSign::length);
  EXPECT_EQ(found->others, SensorSet::of(kZ1).with(kZ2).with(kZ3));
  v.norm_mismatch.bias_mps2 = {0.05, 0.001, -0.002};
  EXPECT_EQ(common_cause(parallel(), kCyclic, {}, v)->others, found->others) << "the bias is in the output frame";
  v.norm_mismatch.bias_mps2 = {0.05, 0.05, 0.05};
  EXPECT_FALSE(common_cause(parallel(), kIdentity, {}, v)) << "along no axis";
  v.norm_mismatch.bias_mps2 = {0.0, 0.0, 0.05};
  EXPECT_FALSE(common_cause(parallel(1), kIdentity, {}, v)) << "one sensor";
  v.norm_mismatch.kind = NormMismatchKind::common_scale;
  EXPECT_FALSE(common_cause(parallel(), kIdentity, {}, v));
}

}  // namespace
}  // namespace common_cause_test
