// What is kept of a run in motion for the health report.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "plumb/session/motion_trace.hpp"

namespace motion_trace_test {
namespace {

using namespace plumb;
using session::MotionTrace;

MotionVerdict block(double time_s, double bound_mps2, bool alarm) {
  MotionVerdict out;
  out.block_ended = true;
  out.alarm = alarm;
  out.block.validity = std::isfinite(bound_mps2) ? ForceValidity::bounded : ForceValidity::none;
  out.block.time_s = time_s;
  out.block.bound_mps2 = bound_mps2;
  out.block.force_mps2 = {3.0, 4.0, 0.0};
  out.block.used = SensorSet::first(6);
  return out;
}

RC_GTEST_PROP(MotionTraceLaw, KeepsTheWorstBoundEveryAlarmAndTheOrderOfTime, ()) {
  const int blocks = *rc::gen::inRange(1, 12000);
  const int unbounded = *rc::gen::inRange(-1, blocks), alarmed = *rc::gen::inRange(0, blocks);
  const int worst = *rc::gen::inRange(0, blocks);
  MotionTrace trace;
  for (int k = 0; k < blocks; ++k) {
    double bound = k == worst ? 9.0 : 0.25 + 1e-5 * k;
    if (k == unbounded) bound = std::numeric_limits<double>::infinity();
    MotionVerdict verdict = block(k, bound, k == alarmed);
    RC_ASSERT(trace.take(k, verdict, {}).has_value());
    verdict.block_ended = verdict.alarm = false;  // samples in between
    RC_ASSERT(trace.take(k + 0.5, verdict, {}).has_value());
  }
  const auto& points = trace.points();
  RC_ASSERT(points.size() <= MotionTrace::kMostPoints);
  RC_ASSERT(points.size() >= std::min<std::size_t>(static_cast<std::size_t>(blocks), MotionTrace::kMostPoints / 2));
  RC_ASSERT(
      std::is_sorted(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; }));
  const auto count = [&](auto test) { return std::count_if(points.begin(), points.end(), test); };
  RC_ASSERT(count([](const auto& p) { return p.alarm; }) == 1);
  RC_ASSERT(count([](const auto& p) { return std::isinf(p.bound_mps2); }) == (unbounded >= 0 ? 1 : 0));
  const bool hidden = count([&](const auto& p) { return p.bound_mps2 == 9.0 && p.time_s == worst; }) == 0;
  RC_ASSERT(!hidden || unbounded >= 0);  // behind a block without any bound, which is worse
}

TEST(MotionTrace, AnAlarmBetweenTwoBlocksIsKept) {
  MotionTrace trace;
  MotionVerdict between;
  between.alarm = true;
  ASSERT_TRUE(trace.take(1.0, block(1.0, 0.3, false), {}).has_value());
  ASSERT_TRUE(trace.take(1.5, between, {}).has_value());
  ASSERT_TRUE(trace.take(2.0, block(2.0, 0.3, false), {}).has_value());
  ASSERT_TRUE(trace.take(3.0, block(3.0, 0.3, false), {}).has_value());
  ASSERT_EQ(trace.points().size(), 3U);
  EXPECT_FALSE(trace.points()[0].alarm);
  EXPECT_TRUE(trace.points()[1].alarm);
  EXPECT_FALSE(trace.points()[2].alarm);
}

TEST(MotionTrace, ABlockWithoutAForceHasNoLengthOfOne) {
  MotionTrace trace;
  ASSERT_TRUE(trace.take(1.0, block(1.0, std::numeric_limits<double>::infinity(), true), {}).has_value());
  ASSERT_TRUE(
      trace.take(2.0, block(2.0, 0.3, false), {{io::MotionEventKind::alarm, 2.0, SensorSet::of(1)}}).has_value());
  ASSERT_EQ(trace.points().size(), 2U);
  EXPECT_TRUE(std::isnan(trace.points()[0].force_mps2));
  EXPECT_EQ(trace.points()[0].used, 0);
  EXPECT_DOUBLE_EQ(trace.points()[1].force_mps2, 5.0);
  EXPECT_EQ(trace.points()[1].used, 6);
  ASSERT_EQ(trace.events().size(), 1U);
  EXPECT_EQ(trace.events()[0].sensors, SensorSet::of(1));
}

}  // namespace
}  // namespace motion_trace_test
