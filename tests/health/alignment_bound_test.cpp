// How the calibrated axes, as a whole, sit in the housing shows in no reading: the bound that the host states on it is
// part of the level in the housing, and of the alert where the alert limit is about that.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "support/simulated_tool.hpp"

// Serves: REQ-042

namespace alignment_bound_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;
using plumb_test::tetrahedron;

MonitorConfig turned(double bound_deg, AlertFrame frame, double alert_deg = 1.0) {
  MonitorConfig config;
  config.alignment_bound_rad = static_cast<float>(rad_from_deg(bound_deg));
  config.alert_frame = frame;
  config.alert_limit_rad = rad_from_deg(alert_deg);
  return config;
}

// Verifies: REQ-042
RC_GTEST_PROP(AlignmentBound, IsTheDifferenceOfTheTwoLevelsAndDecidesTheAlertInItsFrame, ()) {
  const double bound_deg = *rc::gen::map(rc::gen::inRange(0, 3000), [](int k) { return 1e-3 * k; });
  const double alert_deg = *rc::gen::map(rc::gen::inRange(100, 3000), [](int k) { return 1e-3 * k; });
  const AlertFrame frame = *rc::gen::element(AlertFrame::housing, AlertFrame::calibrated_axes);
  Rig rig(tetrahedron(), turned(bound_deg, frame, alert_deg));
  const Verdict& v = rig.prove();
  RC_ASSERT(v.state == HealthState::nominal);
  RC_ASSERT(v.protection_available);
  const auto bound_rad = static_cast<double>(rig.setup.config.alignment_bound_rad);
  RC_ASSERT(v.protection_level_housing_rad == v.protection_level_calibrated_axes_rad + bound_rad);
  const double counts =
      frame == AlertFrame::housing ? v.protection_level_housing_rad : v.protection_level_calibrated_axes_rad;
  RC_ASSERT(v.alert == (counts > rig.setup.config.alert_limit_rad));
  RC_ASSERT((v.validity == Validity::valid) == !v.alert);
}

// Negative: REQ-042
TEST(AlignmentBound, BeyondTheAlertLimitNothingIsValidInTheHousing) {
  Rig housing(tetrahedron(), turned(1.0, AlertFrame::housing)),
      axes(tetrahedron(), turned(1.0, AlertFrame::calibrated_axes));
  EXPECT_EQ(housing.prove().validity, Validity::unconfirmed);
  EXPECT_TRUE(housing.monitor.verdict().alert);
  EXPECT_EQ(axes.prove().validity, Validity::valid);
  EXPECT_FALSE(axes.monitor.verdict().alert);
  EXPECT_EQ(housing.monitor.verdict().state, HealthState::nominal) << "what sits askew is no fault";
}

/// The state machine asks whether sensors agree, which the alignment does not touch.
TEST(AlignmentBound, ChangesNoStateAndNoExclusion) {
  const auto records_of = [](double bound_deg) {
    Rig rig(plumb_test::cone_array(5), turned(bound_deg, AlertFrame::housing));
    rig.prove();
    rig.distort = [](int i, double reading, int) { return i == 1 ? reading + 0.5 : reading; };
    plumb_test::Noise noise(3);
    for (int k = 0; k < 20; ++k) rig.stay(plumb_test::random_direction(noise), 2);
    EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(1)) << bound_deg;
    return rig.records;
  };
  const auto exact = records_of(0.0);
  for (const double bound_deg : {0.9, 30.0, 179.0}) {
    const auto other = records_of(bound_deg);
    ASSERT_EQ(other.size(), exact.size()) << bound_deg;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      EXPECT_EQ(other[k].time_s, exact[k].time_s) << bound_deg;
      EXPECT_EQ(other[k].to, exact[k].to) << bound_deg;
      EXPECT_EQ(other[k].cause, exact[k].cause) << bound_deg;
    }
  }
}

TEST(AlignmentBound, TheToolfaceIsThatOfTheHousing) {
  Rig exact(tetrahedron(), turned(0.0, AlertFrame::housing)), off(tetrahedron(), turned(0.5, AlertFrame::housing));
  exact.prove();
  off.prove();
  const Verdict &a = exact.stay(direction_at(30, 10)), &b = off.stay(direction_at(30, 10));
  const double sine = std::sin(b.protection_level_housing_rad) / std::sin(rad_from_deg(30.0));
  EXPECT_NEAR(b.toolface_protection_housing_rad, std::asin(sine), 1e-3);
  EXPECT_GT(b.toolface_protection_housing_rad, a.toolface_protection_housing_rad + rad_from_deg(0.9));
  Rig lost(tetrahedron(), turned(180.0 - 1e-4, AlertFrame::calibrated_axes));
  EXPECT_EQ(lost.prove().protection_level_housing_rad, kPi);
  EXPECT_EQ(lost.monitor.verdict().toolface_protection_housing_rad, kPi);
}

// Verifies: REQ-042
TEST(AlignmentBound, WithoutOneEveryVerdictSaysSo) {
  for (const double bound_deg : {0.0, 0.1}) {
    Rig rig(tetrahedron(), turned(bound_deg, AlertFrame::housing));
    const auto unstated = [&rig] { return (rig.monitor.verdict().qualifiers & Qualifier::alignment_unstated) != 0; };
    EXPECT_EQ(unstated(), bound_deg == 0.0) << "before the first sample";
    rig.prove();
    EXPECT_EQ(unstated(), bound_deg == 0.0);
  }
}

TEST(AlignmentBound, RefusesWhatIsNoAngle) {
  for (const float bound : {-0.1F, 3.2F, std::nanf("")}) {
    MonitorConfig config;
    config.alignment_bound_rad = bound;
    EXPECT_FALSE(checked(config)) << bound;
  }
}

/// What a host gives as a double is refused by the same range, however far beyond a float it lies.
TEST(AlignmentBound, ADoubleBeyondEveryFloatIsRefusedToo) {
  for (const double bound : {-1e300, 1e300, kPi * 1.001, -1e-3, std::nan(""), HUGE_VAL}) {
    MonitorConfig config;
    config.alignment_bound_rad = alignment_bound_of(bound);
    EXPECT_FALSE(checked(config)) << bound;
  }
  EXPECT_EQ(alignment_bound_of(0.25), 0.25F);
}

}  // namespace
}  // namespace alignment_bound_test
