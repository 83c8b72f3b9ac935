// The rate of a tool from three chips of gyros: right whichever fails.
#include "plumb/session/group_rates.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "support/gyro_tool.hpp"

namespace group_rates_test {
namespace {

using namespace plumb;
using namespace plumb::session;
using plumb_test::GyroTool;

io::ArrayFile gyros_of(const GyroTool& tool, const std::string& rate = GyroTool::usual_bounds()) {
  const auto read = io::parse_array_text(tool.array_file(rate), "tool.toml", {}, "gyros");
  EXPECT_TRUE(read.has_value()) << read.error().text();
  return *read;
}

RateGroup group_of(int chips, const std::string& rate = GyroTool::usual_bounds()) {
  return *rate_group(gyros_of(GyroTool::of_chips(chips, 1), rate));
}

/// A healthy reading at the edge of its bounds, where a draw says so.
double reading(const RateGroup& group, int i, const Vec3& rate, double force_mps2) {
  const auto sign = [] { return *rc::gen::element(-1.0, 0.0, 0.3, 1.0); };
  const RateErrors& e = group.setup.errors[static_cast<std::size_t>(i)];
  const Vec3& u = group.array.axis(i);
  // Turned across itself by `axis_rad`, towards the rate or away.
  const Vec3 across = minus(rate, scaled(u, dot(u, rate)));
  const double turn = sign() * e.axis_rad;
  const double along = std::cos(turn) * dot(u, rate) + std::sin(turn) * norm(across);
  return (1.0 + sign() * e.scale) * along + sign() * e.bias_radps + sign() * e.g_sensitivity_s_per_m * force_mps2 +
         3.0 * sign() * group.array.sigma_mps2(i);
}

double anything() {
  return *rc::gen::oneOf(rc::gen::arbitrary<double>(),
                         rc::gen::element(0.0, 1e308, -1e308, std::numeric_limits<double>::infinity(),
                                          std::numeric_limits<double>::quiet_NaN()));
}

Vec3 any_rate() {
  const auto part = [] { return 0.01 * *rc::gen::inRange(-400, 401); };
  const double x = part(), y = part(), z = part();
  return {x, y, z};
}

// Verifies: REQ-246
RC_GTEST_PROP(GroupRatesLaw, WhateverOneGyroOfThreeDoesTheTrueRateLiesWithinTheBound, ()) {
  const int chips = *rc::gen::inRange(3, 6), faulty = *rc::gen::inRange(0, chips);
  const RateGroup group = group_of(chips);
  const auto rates = GroupRates::make(group);
  RC_ASSERT(rates.has_value());
  const Vec3 truth = any_rate();
  RateSample sample;
  sample.force_mps2 = *rc::gen::element(0.0, 9.81, 15.0);
  for (int i = 0; i < group.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    const bool bad = i / 3 == faulty;
    sample.rate_radps[a] = bad ? anything() : reading(group, i, truth, sample.force_mps2);
    if (!bad || *rc::gen::arbitrary<bool>()) sample.delivered = sample.delivered.with(i);
    if (bad && *rc::gen::arbitrary<bool>()) sample.clipped = sample.clipped.with(i);
  }
  if (*rc::gen::arbitrary<bool>()) sample.force_mps2 = -1.0;  // not told: the stated bound counts
  const ToolRate found = rates->step(sample);
  if (!found.given) {
    RC_ASSERT(chips == 3);  // one of three that says nothing leaves two, of which either may be the faulty one
    RC_ASSERT(found.triads < 3);
    return;
  }
  RC_ASSERT(std::isfinite(found.bound_radps));
  RC_ASSERT(norm(minus(found.rate_radps, truth)) <= found.bound_radps);
}

// The rate of the pinned frame is a matrix times the true one; the bound has it.
// Verifies: REQ-246
RC_GTEST_PROP(GroupRatesLaw, WhatMotionAloneLeavesOpenIsInTheBound, ()) {
  RateGroup group = group_of(3, "scale_bound = 1e-4\naxis_bound_rad = 1e-4\nbias_bound_radps = 1e-4\n");
  group.common = 0.001 * *rc::gen::inRange(0, 100);
  const auto rates = GroupRates::make(group);
  RC_ASSERT(rates.has_value());
  const Vec3 truth = any_rate();
  // seen = K truth with |K - 1| = common, at its worst along the rate
  const Vec3 seen = scaled(truth, 1.0 / (1.0 + *rc::gen::element(-1.0, 1.0) * group.common));
  RateSample sample;
  sample.force_mps2 = 0.0;
  sample.delivered = group.array.all();
  for (int i = 0; i < group.array.size(); ++i)
    sample.rate_radps[static_cast<std::size_t>(i)] = reading(group, i, seen, 0.0);
  const ToolRate found = rates->step(sample);
  RC_ASSERT(found.given);
  RC_ASSERT(norm(minus(found.rate_radps, truth)) <= found.bound_radps);
}

// Negative: REQ-246
TEST(GroupRates, TwoChipsDoNotOutvoteOne) {
  const auto two = GroupRates::make(group_of(2));
  ASSERT_FALSE(two.has_value());
  EXPECT_NE(two.error().what.find("2 triads"), std::string::npos) << two.error().text();
  EXPECT_NE(two.error().remedy.find("three chips"), std::string::npos);
  EXPECT_TRUE(GroupRates::make(group_of(2), 0).has_value()) << "without a fault nobody has to be outvoted";
  EXPECT_FALSE(GroupRates::make(group_of(4), 2).has_value());
  EXPECT_TRUE(GroupRates::make(group_of(5), 2).has_value());
}

// Chips of three axes that are nearly parallel make no triads of their own, and each is in all three that they make
// together: one that fails spoils every vote.
// Negative: REQ-246
TEST(GroupRates, ChipsCountByTheTriadsThatTheySpoil) {
  GyroTool tool = GyroTool::of_chips(3, 2);
  for (std::size_t i = 0; i < 9; ++i) tool.axis[i].chip = std::string("imu") + "123"[i % 3];
  const auto spread = GroupRates::make(*rate_group(gyros_of(tool)));
  ASSERT_FALSE(spread.has_value());
  EXPECT_NE(spread.error().what.find("3 triads"), std::string::npos) << spread.error().text();
  EXPECT_NE(spread.error().what.find("7 are needed"), std::string::npos) << spread.error().text();
}

TEST(GroupRates, SingleAxesArePutTogetherThreeByThree) {
  GyroTool tool = GyroTool::of_chips(3, 2);
  std::string text = tool.array_file(GyroTool::usual_bounds());
  for (std::size_t at = 0; (at = text.find("package", at)) != std::string::npos;)
    text.erase(at, text.find('\n', at) - at + 1);
  const auto array = io::parse_array_text(text, "tool.toml", {}, "gyros");
  ASSERT_TRUE(array.has_value()) << array.error().text();
  const auto rates = GroupRates::make(*rate_group(*array));
  ASSERT_TRUE(rates.has_value()) << rates.error().text();
  EXPECT_EQ(rates->triads(), 3);
  EXPECT_TRUE(rates->left_out().empty());
}

TEST(GroupRates, AnExcludedChipVotesNoMoreWhereEnoughAreLeft) {
  const RateGroup group = group_of(4);
  const auto rates = GroupRates::make(group);
  ASSERT_TRUE(rates.has_value());
  RateSample sample;
  sample.delivered = group.array.all();
  EXPECT_EQ(rates->step(sample).triads, 4);
  EXPECT_EQ(rates->step(sample, SensorSet::of(4)).triads, 3);
  const SensorSet two = SensorSet::of(4).with(0);
  EXPECT_EQ(rates->step(sample, two).triads, 4) << "two chips are too few to outvote one: all vote";
  EXPECT_TRUE(rates->step(sample, two).given);
}

// A lag of an axis is one of the rate.
TEST(GroupRates, LagsAreToldApart) {
  const auto rates = GroupRates::make(group_of(3));
  ASSERT_TRUE(rates.has_value());
  EXPECT_GE(rates->lag_bound_s(), 0.0005);
  EXPECT_LE(rates->lag_bound_s(), 0.0005 * 3.2);
}

}  // namespace
}  // namespace group_rates_test
