// Another try after a failure by timeout, and none after any other.
#include "plumb/health/retry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/simulated_tool.hpp"

namespace retry_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;

SensorArray triad() {
  AxisList axes{};
  const int n = orthogonal_triad(axes);
  return plumb_test::make_array(axes, n, 2e-4 * kG0_mps2);
}

/// Three sensors, one of them off for good: what ends in failed by timeout.
struct Failing {
  explicit Failing(RetryPolicy policy) : rig(triad()), helper(policy) {
    rig.prove();
    rig.distort = [this](int i, double r, int) { return i == 0 && faulty ? r + 0.5 : r; };
  }
  /// A block at another attitude; every verdict is offered.
  void station() {
    for (int k = 0; k < rig.setup.config.window; ++k)
      offer(rig.step(rig.sample(plumb_test::random_direction(at), kG0_mps2)));
  }
  void block(const Vec3& u) {
    for (int k = 0; k < rig.setup.config.window; ++k) offer(rig.step(rig.sample(u, kG0_mps2)));
  }
  void offer(const Verdict& v) {
    const RetryRecord record = helper.offer(v, rig.monitor);
    if (record.action != RetryAction::none) told.push_back(record);
  }
  void fail() {
    for (int k = 0; k < 40 && state() != HealthState::failed; ++k) block(plumb_test::random_direction(at));
    ASSERT_EQ(state(), HealthState::failed);
  }
  HealthState state() const { return rig.monitor.verdict().state; }

  Rig rig;
  RetryAfterTimeout helper;
  bool faulty = true;
  plumb_test::Noise at{8};
  std::vector<RetryRecord> told;
};

RetryPolicy policy(double pause_s = 2.0, int most = 2) { return {pause_s, most, MonitorConfig{}.reset_key}; }

// Verifies: REQ-167
TEST(RetryAfterTimeout, AsksAfterThePauseAndTheToolIsValidatedAgain) {
  Failing tool(policy());
  tool.fail();
  ASSERT_EQ(tool.told.size(), 1U);
  EXPECT_EQ(tool.told[0].action, RetryAction::pause_began);
  EXPECT_EQ(tool.told[0].retries, 0);
  tool.faulty = false;
  const double failed_s = tool.told[0].time_s;
  while (tool.state() == HealthState::failed && tool.told.back().time_s < failed_s + 10.0)
    tool.block(direction_at(60, 10));
  ASSERT_EQ(tool.told.size(), 2U);
  EXPECT_EQ(tool.told[1].action, RetryAction::asked);
  EXPECT_EQ(tool.told[1].retries, 1);
  EXPECT_EQ(tool.told[1].sensors, SensorSet::first(3));
  EXPECT_GE(tool.told[1].time_s - failed_s, 2.0);
  EXPECT_LE(tool.told[1].time_s - failed_s, 2.02) << "no later than the next sample";
  EXPECT_EQ(tool.state(), HealthState::suspect);
  EXPECT_TRUE(tool.rig.monitor.verdict().qualifiers & Qualifier::not_yet_validated);
  EXPECT_EQ(tool.rig.records.back().event, HealthEvent::reset) << "failed is left by the keyed reset (S5)";
  EXPECT_EQ(tool.rig.prove().state, HealthState::degraded_3_sensor);
}

// Verifies: REQ-167
TEST(RetryAfterTimeout, TheRetriesAreCountedAndEnd) {
  Failing tool(policy(1.0, 2));
  for (int k = 0; k < 200; ++k) tool.block(plumb_test::random_direction(tool.at));
  std::vector<RetryAction> actions;
  for (const RetryRecord& record : tool.told) actions.push_back(record.action);
  using A = RetryAction;
  EXPECT_EQ(actions, (std::vector<A>{A::pause_began, A::asked, A::pause_began, A::asked, A::pause_began, A::given_up}));
  EXPECT_EQ(tool.helper.retries(), 2);
  EXPECT_EQ(tool.state(), HealthState::failed);
}

// Negative: REQ-167
TEST(RetryAfterTimeout, TooFewSensorsAreNeverTriedAgain) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  RetryAfterTimeout helper(policy(0.0));
  rig.distort = [](int i, double r, int) { return i <= 1 ? std::numeric_limits<double>::infinity() : r; };
  int told = 0;
  for (int k = 0; k < 300; ++k) {
    const RetryRecord record = helper.offer(rig.step(rig.sample(direction_at(60, 10), kG0_mps2)), rig.monitor);
    if (record.action == RetryAction::none) continue;
    EXPECT_EQ(record.action, RetryAction::too_few);
    ++told;
  }
  EXPECT_EQ(told, 1);
  EXPECT_EQ(helper.retries(), 0);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::failed);
  EXPECT_FALSE(rig.monitor.verdict().qualifiers & Qualifier::timed_out);
}

// Negative: REQ-167
TEST(RetryAfterTimeout, ChannelsThatFallSilentInThePauseAreNotTriedAgain) {
  Failing tool(policy());
  tool.fail();
  tool.rig.distort = [](int i, double r, int) { return i == 1 ? std::numeric_limits<double>::quiet_NaN() : r; };
  for (int k = 0; k < 20; ++k) tool.block(direction_at(60, 10));
  EXPECT_EQ(tool.told.back().action, RetryAction::too_few);
  EXPECT_EQ(tool.helper.retries(), 0);
  EXPECT_EQ(tool.state(), HealthState::failed);
}

// Negative: REQ-167
TEST(RetryAfterTimeout, AWrongKeyIsReportedOnceAndNotTriedAgain) {
  RetryPolicy wrong = policy(0.5);
  wrong.key = 1;
  Failing tool(wrong);
  tool.fail();
  for (int k = 0; k < 20; ++k) tool.block(direction_at(60, 10));
  ASSERT_EQ(tool.told.size(), 2U);
  EXPECT_EQ(tool.told[1].action, RetryAction::refused);
  EXPECT_EQ(tool.told[1].error, Errc::wrong_key);
  EXPECT_EQ(tool.state(), HealthState::failed);
}

// Negative: REQ-167
TEST(RetryAfterTimeout, TimeThatIsNoNumberOrBeginsAnewShortensNoPause) {
  Failing tool(policy(5.0));
  tool.fail();
  Verdict v = tool.rig.monitor.verdict();
  const double began_s = v.time_s;
  for (const double time_s : {began_s + 4.0, std::nan(""), began_s + 6.0, 1.0, 5.5}) {
    v.time_s = time_s;
    EXPECT_EQ(tool.helper.offer(v, tool.rig.monitor).action, RetryAction::none) << time_s;
  }
  v.time_s = 6.5;
  EXPECT_EQ(tool.helper.offer(v, tool.rig.monitor).action, RetryAction::asked);
}

// Negative: REQ-167
TEST(RetryAfterTimeout, DoesNothingWhileTheToolServes) {
  Rig rig(plumb_test::tetrahedron());
  RetryAfterTimeout helper(policy(0.0));
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(helper.offer(rig.step(rig.sample(direction_at(60, 10), kG0_mps2)), rig.monitor).action,
              RetryAction::none);
  }
  for (const RetryAction action : {RetryAction::none, RetryAction::pause_began, RetryAction::asked,
                                   RetryAction::refused, RetryAction::too_few, RetryAction::given_up}) {
    EXPECT_STRNE(to_string(action), "?");
  }
}

}  // namespace
}  // namespace retry_test
