// Serves: REQ-213
// Each fault of one gyro axis of six, as docs/fault-catalogue.md lists them: who is excluded, and the bound of the
// rate.
#include <gtest/gtest.h>

#include <functional>

#include "motion/gyro_array.hpp"

namespace gyro_faults_test {
namespace {

using namespace plumb;
using plumb_test::cone_array;
using plumb_test::GyroArray;
using plumb_test::rate_setup;

constexpr std::size_t kFaulty = 2;
constexpr double kOnset_s = 0.3;

/// Six axes on a cone that turn by some 4 rad/s; the fault from 0.3 s on, played for 4 s.
GyroArray played(const std::function<void(double& reading_radps, RateSample& sample)>& fault) {
  GyroArray gyros(cone_array(6, 0.002), rate_setup(), 11);
  gyros.distort = [fault](RateSample& s) {
    if (s.time_s >= kOnset_s) fault(s.rate_radps[kFaulty], s);
  };
  gyros.turn(0, 4000);
  return gyros;
}

void expect_excluded(const GyroArray& gyros) {
  EXPECT_TRUE(gyros.ever_excluded == SensorSet::of(kFaulty));
  EXPECT_TRUE(SensorSet::of(kFaulty).contains(gyros.ever_isolated));
  EXPECT_LT(gyros.worst_ratio, 1.0);
}

TEST(GyroFaults, AStuckAxisIsExcluded) {
  double held = 0.0;
  bool begun = false;
  expect_excluded(played([&](double& y, RateSample&) {
    if (!begun) held = y;
    begun = true;
    y = held;
  }));
}

TEST(GyroFaults, ABiasStepIsExcluded) {
  expect_excluded(played([](double& y, RateSample&) { y += 0.5; }));
}

TEST(GyroFaults, AWrongScaleIsExcluded) {
  expect_excluded(played([](double& y, RateSample&) { y *= 1.5; }));
}

TEST(GyroFaults, GSensitivityBeyondItsBoundIsExcluded) {
  expect_excluded(played([](double& y, RateSample& s) { y += 0.02 * s.force_mps2; }));
}

TEST(GyroFaults, ALateAxisIsExcluded) {
  std::array<double, 40> late{};
  std::size_t count = 0;
  expect_excluded(played([&](double& y, RateSample&) {
    const double now = y;
    if (count >= late.size()) y = late[count % late.size()];
    late[count++ % late.size()] = now;
  }));
}

TEST(GyroFaults, ASaturatedAxisThatSaysSoIsNotBlamed) {
  constexpr double kRange_radps = 1.0;
  int clipped = 0;
  const GyroArray gyros = played([&](double& y, RateSample& s) {
    if (std::fabs(y) < kRange_radps) return;
    y = std::copysign(kRange_radps, y);
    s.clipped = SensorSet::of(kFaulty);
    ++clipped;
  });
  EXPECT_GT(clipped, 500);
  EXPECT_TRUE(gyros.ever_isolated.empty());
  EXPECT_LT(gyros.worst_ratio, 1.0);
}

TEST(GyroFaults, ASaturatedAxisThatDoesNotSaySoIsExcluded) {
  expect_excluded(played([](double& y, RateSample&) { y = std::fmax(-1.0, std::fmin(1.0, y)); }));
}

// Below what the bounds allow nobody is blamed, and the rate keeps its bound.
// Negative: REQ-213
TEST(GyroFaults, ABiasWithinItsBoundIsNoFault) {
  const GyroArray gyros = played([](double& y, RateSample&) { y += 0.001; });
  EXPECT_TRUE(gyros.ever_isolated.empty());
  EXPECT_LT(gyros.worst_ratio, 1.0);
}

}  // namespace
}  // namespace gyro_faults_test
