// The attitude filter of examples/navigation: the figures that docs/navigation.md states, from the program's own
// output; and what it does with each validity.
#include "navigation/attitude_filter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "verdicts.hpp"

namespace attitude_filter_test {
namespace {

using example_test::good;

struct Row {
  double time_s, with_deg, sigma_deg, without_deg;
  std::string validity;
};

std::vector<Row> table() {
  std::vector<Row> rows;
  FILE* pipe = popen(PLUMB_ATTITUDE_FILTER_PATH, "r");
  if (pipe == nullptr) return rows;
  std::array<char, 256> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr) {
    std::istringstream in(line.data());
    Row row{};
    in >> row.time_s >> row.with_deg >> row.sigma_deg >> row.without_deg >> row.validity;
    if (in) rows.push_back(row);
  }
  pclose(pipe);
  return rows;
}

TEST(AttitudeFilter, ridesThroughTheFailureAndTheLeastSquaresDoesNot) {
  double before = 0, coasting = 0, after = 0, without_before = 0, without_after = 0, worst_ratio = 0;
  int rows = 0;
  for (const Row& row : table()) {
    if (row.time_s < 6.0) continue;  // plumb has published nothing as valid yet
    ++rows;
    double& worst = row.time_s < 30.0 ? before : row.time_s < 41.6 ? coasting : after;
    worst = std::max(worst, row.with_deg);
    double& without = row.time_s < 30.0 ? without_before : without_after;
    without = std::max(without, row.without_deg);
    worst_ratio = std::max(worst_ratio, row.with_deg / row.sigma_deg);
  }
  std::printf(
      "[ measured ] largest error [deg] with plumb: %.3f before, %.3f on gyros, %.3f on three; without: %.3f "
      "before, %.1f after; largest error / sigma %.2f\n",
      before, coasting, after, without_before, without_after, worst_ratio);
  EXPECT_EQ(rows, 660);
  EXPECT_LT(before, 0.02);
  EXPECT_LT(coasting, 0.05);
  EXPECT_LT(after, 0.05);
  EXPECT_LT(without_before, 0.02);
  EXPECT_GT(without_after, 5.0);
  EXPECT_LT(worst_ratio, 3.5);  // the covariance is honest, on gyros too
}

TEST(AttitudeFilter, takesOnlyWhatMayBeUsed) {
  for (const plumb::Validity validity : example_test::kAllValidities) {
    plumb::Verdict v = good();
    v.validity = validity;
    AttitudeFilter filter(1e-3, 1e-4);
    const bool usable = validity == plumb::Validity::valid || validity == plumb::Validity::degraded;
    EXPECT_EQ(filter.correct(v), usable) << plumb::to_string(validity);
    EXPECT_EQ((filter.gravity_mps2() - Eigen::Vector3d(0.1, -0.2, 9.8)).norm() < 1e-3, usable);
  }
  plumb::Verdict v = good();
  v.tick = false;  // the block was used already
  AttitudeFilter filter(1e-3, 1e-4);
  EXPECT_FALSE(filter.correct(v));
  v = good();
  v.gravity_mps2[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(filter.correct(v));
  EXPECT_TRUE(filter.gravity_mps2().allFinite());
}

TEST(AttitudeFilter, aDegradedVectorWeighsLess) {
  AttitudeFilter valid(1e-3, 1e-4), degraded(1e-3, 1e-4);
  plumb::Verdict v = good();
  valid.correct(v);
  v.validity = plumb::Validity::degraded;
  degraded.correct(v);
  EXPECT_NEAR(degraded.tilt_sigma_rad() / valid.tilt_sigma_rad(), 3.0, 1e-3);
}

TEST(AttitudeFilter, turnsTheVectorBackwards) {
  AttitudeFilter filter(1e-3, 1e-4);
  plumb::Verdict v = good();
  v.gravity_mps2 = {0.0, 0.0, 9.8};
  filter.correct(v);
  for (int k = 0; k < 100; ++k) filter.turn({0.5, 0.0, 0.0}, 0.01);  // 0.5 rad about x
  EXPECT_NEAR(filter.gravity_mps2()[1], 9.8 * std::sin(0.5), 1e-3);  // as seen from the body, down moves to +y
  EXPECT_NEAR(filter.gravity_mps2()[2], 9.8 * std::cos(0.5), 1e-3);
}

}  // namespace
}  // namespace attitude_filter_test
