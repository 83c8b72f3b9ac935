#include "plumb/scenario/fault.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace plumb {
namespace scenario {
namespace fault_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Stream kStream(1, Purpose::fault, 0);
const ChannelLaw kLaw = {0.3, 0.1};  // raw unit per m/s^2, raw value at zero acceleration

Fault make(FaultKind kind, double magnitude, double upper = 0.0) {
  Fault fault;
  fault.kind = kind;
  fault.onset = 10.0;
  fault.magnitude = magnitude;
  fault.upper = upper;
  return fault;
}

double applied(const Fault& fault, double raw, const Moment& now, const FaultMemory& memory = {}) {
  return apply(fault, memory, now, raw, kLaw, kStream);
}

TEST(Fault, StuckLevelForgetsTheTruth) {
  EXPECT_EQ(applied(make(FaultKind::stuck_level, -3.0), 1.0, {12.0, 100, 1}), -3.0);
}

TEST(Fault, StuckLastHoldsTheValueBefore) {
  FaultMemory memory;
  memory.has_last = true;
  memory.last_raw = 0.7;
  EXPECT_EQ(applied(make(FaultKind::stuck_last, 0.0), 1.0, {12.0, 100, 1}, memory), 0.7);
  EXPECT_EQ(applied(make(FaultKind::stuck_last, 0.0), 1.0, {12.0, 100, 1}), 1.0) << "nothing to remember yet";
  bool moved = false;
  for (std::uint64_t row = 0; row < 100; ++row) {
    const double held = applied(make(FaultKind::stuck_last, 0.01), 1.0, {12.0, row, 1}, memory);
    EXPECT_NEAR(held, 0.7, 0.01);
    moved = moved || held != 0.7;
  }
  EXPECT_TRUE(moved) << "dither";
}

TEST(Fault, RandomKindsStayInRangeAndDependOnTheRowAlone) {
  const Fault each = make(FaultKind::random_range, -3.0, 3.0);
  const Fault held = make(FaultKind::random_level, -3.0, 3.0);
  double sum = 0.0;
  for (std::uint64_t row = 0; row < 1000; ++row) {
    const double value = applied(each, 1.0, {0.0, row, 1});
    EXPECT_GE(value, -3.0);
    EXPECT_LE(value, 3.0);
    EXPECT_EQ(value, applied(each, 2.0, {5.0, row, 2}));
    EXPECT_NE(value, applied(each, 1.0, {0.0, row + 1, 1}));
    EXPECT_EQ(applied(held, 1.0, {0.0, row, 1}), applied(held, 1.0, {0.0, 0, 1}));
    sum += value;
  }
  EXPECT_NEAR(sum / 1000.0, 0.0, 4.0 * 3.0 / std::sqrt(3.0 * 1000.0));
}

TEST(Fault, BiasAndDriftAreAccelerationsAtTheSensor) {
  EXPECT_DOUBLE_EQ(applied(make(FaultKind::bias_step, 0.5), 1.0, {12.0, 0, 1}), 1.0 + 0.3 * 0.5);
  FaultMemory memory;
  memory.begun_s = 10.0;
  EXPECT_DOUBLE_EQ(applied(make(FaultKind::drift, 0.01), 1.0, {10.0, 0, 1}, memory), 1.0);
  EXPECT_DOUBLE_EQ(applied(make(FaultKind::drift, 0.01), 1.0, {30.0, 0, 1}, memory), 1.0 + 0.3 * 0.01 * 20.0);
}

TEST(Fault, ScaleChangeTurnsAboutZeroAccelerationNotAboutZeroVolt) {
  EXPECT_DOUBLE_EQ(applied(make(FaultKind::scale_change, 1.1), kLaw.zero_raw, {12.0, 0, 1}), kLaw.zero_raw);
  EXPECT_DOUBLE_EQ(applied(make(FaultKind::scale_change, 1.1), 1.1, {12.0, 0, 1}), 0.1 + 1.1 * 1.0);
}

TEST(Fault, OnsetAndEndOnEveryClock) {
  Fault fault = make(FaultKind::stuck_level, 0.0);
  fault.duration = 5.0;
  EXPECT_FALSE(in_effect(fault, {9.99, 0, 0}));
  EXPECT_TRUE(in_effect(fault, {10.0, 0, 0}));
  EXPECT_TRUE(in_effect(fault, {14.99, 0, 0}));
  EXPECT_FALSE(in_effect(fault, {15.0, 0, 0}));
  EXPECT_TRUE(has_begun(fault, {15.0, 0, 0}));
  fault.clock = Clock::row;
  EXPECT_FALSE(in_effect(fault, {0.0, 8, 0})) << "row number 9";
  EXPECT_TRUE(in_effect(fault, {0.0, 9, 0})) << "row number 10";
  EXPECT_TRUE(in_effect(fault, {0.0, 13, 0}));
  EXPECT_FALSE(in_effect(fault, {0.0, 14, 0}));
  fault.clock = Clock::station;
  EXPECT_FALSE(in_effect(fault, {0.0, 100, 9}));
  EXPECT_TRUE(in_effect(fault, {0.0, 100, 10}));
  EXPECT_FALSE(in_effect(fault, {0.0, 100, 15}));
  fault.duration = kInfinity;
  EXPECT_TRUE(in_effect(fault, {0.0, 100, 1000000}));
}

TEST(Fault, NonsenseIsRefusedWithARemedy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Fault> bad;
  const auto add = [&bad](auto change) {
    Fault fault = make(FaultKind::stuck_level, 0.0);
    change(fault);
    bad.push_back(fault);
  };
  add([](Fault& f) { f.sensor = 4; });
  add([](Fault& f) { f.sensor = -1; });
  add([&](Fault& f) { f.magnitude = nan; });
  add([](Fault& f) { f.magnitude = -1.1e12; });
  add([](Fault& f) { f.kind = FaultKind::drift, f.magnitude = 1e306; });
  add([](Fault& f) { f.kind = FaultKind::random_range, f.upper = 1.1e12; });
  add([&](Fault& f) { f.onset = nan; });
  add([](Fault& f) { f.onset = kInfinity; });
  add([](Fault& f) { f.duration = 0.0; });
  add([](Fault& f) { f.duration = -kInfinity; });
  add([&](Fault& f) { f.duration = nan; });
  add([](Fault& f) { f.clock = Clock::row, f.onset = 0.0; });
  add([](Fault& f) { f.clock = Clock::station, f.onset = 2.5; });
  add([](Fault& f) { f.clock = Clock::row, f.duration = 0.5; });
  add([](Fault& f) { f.kind = FaultKind::random_range, f.magnitude = 3.0, f.upper = 3.0; });
  add([](Fault& f) { f.kind = FaultKind::random_level, f.magnitude = 3.0, f.upper = -3.0; });
  add([](Fault& f) { f.kind = FaultKind::stuck_last, f.magnitude = -1.0; });
  add([](Fault& f) { f.kind = FaultKind::scale_change, f.magnitude = 1.0; });
  for (std::size_t k = 0; k < bad.size(); ++k) {
    const auto checked = check(bad[k], 4);
    ASSERT_FALSE(checked) << k;
    EXPECT_NE(checked.error().find("Remedy: "), std::string::npos) << checked.error();
  }
  EXPECT_TRUE(check(make(FaultKind::stuck_level, 0.0), 4));
  EXPECT_TRUE(check(make(FaultKind::drift, -1e12), 4));
}

}  // namespace
}  // namespace fault_test
}  // namespace scenario
}  // namespace plumb
