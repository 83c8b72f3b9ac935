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

/// The third of three equal samples: by then the slope of the rate is known.
ToolRate stepped(GroupRates& rates, RateSample sample, SensorSet excluded = {}) {
  ToolRate out;
  sample.time_s += 100.0;  // a gap from whatever came before
  for (int k = 0; k < 3; ++k) {
    out = rates.step(sample, excluded);
    sample.time_s += 0.01;
  }
  return out;
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
  auto rates = GroupRates::make(group);
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
  const ToolRate found = stepped(*rates, sample);
  if (!found.given) {
    RC_ASSERT(chips == 3);  // the faulty one of the two that are left reads no number that can be halved
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
  auto rates = GroupRates::make(group);
  RC_ASSERT(rates.has_value());
  const Vec3 truth = any_rate();
  // seen = K truth with |K - 1| = common, at its worst along the rate
  const Vec3 seen = scaled(truth, 1.0 / (1.0 + *rc::gen::element(-1.0, 1.0) * group.common));
  RateSample sample;
  sample.force_mps2 = 0.0;
  sample.delivered = group.array.all();
  for (int i = 0; i < group.array.size(); ++i)
    sample.rate_radps[static_cast<std::size_t>(i)] = reading(group, i, seen, 0.0);
  const ToolRate found = stepped(*rates, sample);
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

TEST(GroupRates, AnExcludedChipVotesNoMore) {
  const RateGroup group = group_of(4);
  auto rates = GroupRates::make(group);
  ASSERT_TRUE(rates.has_value());
  RateSample sample;
  sample.delivered = group.array.all();
  EXPECT_EQ(stepped(*rates, sample).triads, 4);
  EXPECT_EQ(stepped(*rates, sample, SensorSet::of(4)).triads, 3);
  const SensorSet two = SensorSet::of(4).with(0);
  EXPECT_EQ(stepped(*rates, sample, two).triads, 2);
  EXPECT_TRUE(stepped(*rates, sample, two).given) << "one of the two is healthy";
  EXPECT_FALSE(stepped(*rates, sample, two.with(8)).given) << "the last one may be the next to fail";
}

// Two chips are left after one was excluded, and one of them fails: the rate is between them, and half of what they
// differ by is in the bound.
// Verifies: REQ-246
RC_GTEST_PROP(GroupRatesLaw, OfTwoThatAreLeftEitherMayFail, ()) {
  const RateGroup group = group_of(3);
  auto rates = GroupRates::make(group);
  RC_ASSERT(rates.has_value());
  const int excluded = *rc::gen::inRange(0, 3);
  const int faulty = (excluded + *rc::gen::inRange(1, 3)) % 3;
  const Vec3 truth = any_rate();
  RateSample sample;
  sample.force_mps2 = 9.81;
  sample.delivered = group.array.all();
  SensorSet out;
  for (int i = 0; i < group.array.size(); ++i) {
    if (i / 3 == excluded) out = out.with(i);
    const bool bad = i / 3 == faulty || i / 3 == excluded;
    sample.rate_radps[static_cast<std::size_t>(i)] = bad ? anything() : reading(group, i, truth, 9.81);
  }
  const ToolRate found = stepped(*rates, sample, out);
  if (found.given) RC_ASSERT(norm(minus(found.rate_radps, truth)) <= found.bound_radps);
}

/// The group on a tone of the rate: the first chip leads by its lag, the second lags, the third lies as it likes.
struct Tone {
  RateGroup group;
  double hz = 1.0, amplitude_radps = 6.0, lag_s = 0.0005;
  int lie_samples = 8;
  double lie_radps = 20.0;

  double truth(double t_s) const { return amplitude_radps * std::sin(2.0 * kPi * hz * t_s); }
  RateSample at(int k) const {
    RateSample out;
    out.time_s = group.setup.sample_period_s * k;
    out.delivered = group.array.all();
    out.force_mps2 = 0.0;
    const double radps[] = {truth(out.time_s + lag_s), truth(out.time_s - lag_s),
                            truth(out.time_s) + (k / lie_samples % 2 == 0 ? lie_radps : -lie_radps)};
    for (int i = 0; i < 9; ++i)
      out.rate_radps[static_cast<std::size_t>(i)] = dot(group.array.axis(i), scaled({0.6, 0.0, 0.8}, radps[i / 3]));
    return out;
  }
};

// A median jumps between a chip that leads and one that lags where a third lies on either side in turn: an error that
// no delay describes, and that nothing but the bound of the sample can hold. Verifies: REQ-246
RC_GTEST_PROP(GroupRatesLaw, AMedianThatJumpsBetweenALeaderAndALaggardIsWithinItsBound, ()) {
  Tone tone{group_of(3, "scale_bound = 1e-6\naxis_bound_rad = 1e-6\nbias_bound_radps = 1e-6\nlag_bound_s = 0.0005\n")};
  tone.hz = 0.1 * *rc::gen::inRange(1, 100);
  tone.amplitude_radps = 0.1 * *rc::gen::inRange(1, 80);
  tone.lie_samples = *rc::gen::inRange(1, 40);
  tone.lie_radps = *rc::gen::element(0.5, 20.0, -300.0);
  auto rates = GroupRates::make(tone.group);
  RC_ASSERT(rates.has_value());
  for (int k = 0; k < 300; ++k) {
    const RateSample sample = tone.at(k);
    const ToolRate found = rates->step(sample);
    RC_ASSERT(found.given == (k >= 2));
    if (!found.given) continue;
    const Vec3 truth = scaled({0.6, 0.0, 0.8}, tone.truth(sample.time_s));
    RC_ASSERT(norm(minus(found.rate_radps, truth)) <= found.bound_radps);
  }
}

// Without a lag in the bounds the same jumps pass them: a fast turn, chips without noise.
// Negative: REQ-246
TEST(GroupRates, WithoutTheLagTheBoundIsPassed) {
  const std::string bounds = "scale_bound = 1e-6\naxis_bound_rad = 1e-6\nbias_bound_radps = 1e-6\n";
  const auto passed = [&bounds](const std::string& lag) {
    Tone tone{group_of(3, bounds + lag)};
    tone.hz = 8.0;
    for (int i = 0; i < 9; ++i) EXPECT_GT(tone.group.array.sigma_mps2(i), 0.0);
    auto rates = GroupRates::make(tone.group);
    int out = 0;
    for (int k = 0; k < 300; ++k) {
      const RateSample sample = tone.at(k);
      const ToolRate found = rates->step(sample);
      const Vec3 truth = scaled({0.6, 0.0, 0.8}, tone.truth(sample.time_s));
      if (found.given && norm(minus(found.rate_radps, truth)) > found.bound_radps) ++out;
    }
    return out;
  };
  EXPECT_GT(passed(""), 100);
  EXPECT_EQ(passed("lag_bound_s = 0.0005\n"), 0);
}

}  // namespace
}  // namespace group_rates_test
