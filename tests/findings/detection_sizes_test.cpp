// The four sizes against the tests that the monitor makes.
#include "plumb/findings/detection_sizes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "detection/threshold_support.hpp"
#include "plumb/health/stability.hpp"

// Serves: REQ-016

namespace detection_sizes_test {
namespace {

using namespace plumb;
using namespace plumb_test;
using findings::detection_sizes;
using findings::DetectionSizes;
using findings::SizeCondition;
using findings::SizeTable;
using findings::VisitedKnown;

constexpr double kMilli = 1e-3 * kG0_mps2;

/// Each sensor's axis is known worse along x of the tool than along y and z: what is left depends on the attitude.
SensorArray known_worse_along_x(SensorArray array) {
  RowUncertainty left;
  for (int i = 0; i < array.size(); ++i) {
    for (int p = 0; p < 4; ++p) {
      const int a = 4 * i + p;
      left.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = p == 0 ? 4e-8 : 1e-9;
    }
  }
  array.set_uncertainty(left);
  return array;
}

/// Whether parity alarms at an error f of sensor i, with noise in parity at its quantile and all that is systematic
/// against the fault.
bool alarms(const SensorArray& array, const TestSettings& settings, int i, double f_mps2, const Vec3& down) {
  const ErrorBudget budget = error_budget(array, kExact, settings);
  BlockEvidence block = exact_block(array, down, settings.samples);
  const SetTest healthy = test_set(array, kExact, budget.limits, block, array.all());
  const LeastSquares map = least_squares(array, array.all());
  const std::size_t rows = static_cast<std::size_t>(healthy.parity_rows);
  const double against = (budget.limits.reject[rows] + healthy.parity_systematic) * budget.noise_mps2[0];
  const double length = std::sqrt(1.0 - dot(array.axis(i), map.column[static_cast<std::size_t>(i)]));
  for (int j = 0; j < array.size(); ++j) {
    const double along = (j == i ? 1.0 : 0.0) - dot(array.axis(j), map.column[static_cast<std::size_t>(i)]);
    block.mean_mps2[static_cast<std::size_t>(j)] += along * (f_mps2 - against / length);
  }
  const SetTest test = test_set(array, kExact, budget.limits, block, array.all());
  return test.parity > test.parity_alarm_limit(budget.limits);
}

// Verifies: REQ-016
TEST(DetectionSizes, TheGuaranteedSizeRaisesTheAlarmAndNoSmallerOneIsGuaranteed) {
  const TestSettings settings;
  Noise noise(1);
  for (const SensorArray& exact : {tetrahedron(), cone_array(5), cone_array(8)}) {
    for (const SensorArray& array : {exact, known_worse_along_x(exact)}) {
      const Thresholds t = thresholds_of(array, kExact, settings);
      const Vec3 worst = {1.0, 0.0, 0.0};
      for (int i = 0; i < array.size(); ++i) {
        const double sure = t.sensor[static_cast<std::size_t>(i)].guaranteed_detection_mps2;
        for (int k = 0; k < 50; ++k) EXPECT_TRUE(alarms(array, settings, i, 1.0001 * sure, random_direction(noise)));
        EXPECT_TRUE(alarms(array, settings, i, 1.0001 * sure, worst));
        if (array.perfectly_known() || array.size() == 4) {
          EXPECT_FALSE(alarms(array, settings, i, 0.999 * sure, worst)) << array.size();
        }
      }
    }
  }
}

TEST(DetectionSizes, AtVisitedAttitudesItIsThatOfTheTestsThere) {
  const SensorArray array = known_worse_along_x(tetrahedron());
  const TestSettings settings;
  const Vec3 best = {0.0, 1.0, 0.0}, worst = {1.0, 0.0, 0.0};
  const DetectionSizes there = detection_sizes(array, kExact, settings, {best, {}, scaled(best, -1.0)});
  EXPECT_LT(there.guaranteed_detection_visited_mps2, 0.8 * there.guaranteed_detection_any_mps2);
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(alarms(array, settings, i, 1.0001 * there.guaranteed_detection_visited_mps2, best));
    EXPECT_FALSE(alarms(array, settings, i, 0.999 * there.guaranteed_detection_visited_mps2, best));
  }
  const DetectionSizes both = detection_sizes(array, kExact, settings, {best, worst});
  EXPECT_NEAR(both.guaranteed_detection_visited_mps2 / both.guaranteed_detection_any_mps2, 1.0, 1e-6);
  EXPECT_TRUE(std::isnan(detection_sizes(array, kExact, settings).guaranteed_detection_visited_mps2));
  EXPECT_EQ(there.minimum_detectable_bias_mps2, both.minimum_detectable_bias_mps2) << "of any attitude";
  EXPECT_LT(there.minimum_detectable_bias_mps2, there.guaranteed_detection_any_mps2);
}

/// With four sensors the explanation "sensor j" is the group of three without j.
// Verifies: REQ-017
TEST(DetectionSizes, FourSensorsIsolateOverTheirAttitudesTogether) {
  const SensorArray array = tetrahedron();
  const TestSettings settings;
  const double size = detection_sizes(array, kExact, settings).guaranteed_isolation_mps2;
  const OneAttitude one(array, kExact, error_budget(array, kExact, settings));
  EXPECT_LT(size, 0.1 * one.any_attitude_mps2(0));
  EXPECT_LT(size, 0.5 * one.blind_half_width_mps2(0));
  const TestLimits limits = TestLimits::from_rates(4, settings.false_alarm_rate, settings.rejection_rate);
  for (int i = 0; i < 4; ++i) {
    for (double f = size * 1.0001; f < 2.0 * kG0_mps2; f *= 1.01) {
      for (const double fault : {f, -f}) {
        for (int j = 0; j < 4; ++j) {
          bool rejected = false;
          for (int k = 0; j != i && k < settings.isolation_attitudes; ++k) {
            BlockEvidence block = exact_block(array, findings::spread_direction(k, 4), settings.samples);
            block.mean_mps2[static_cast<std::size_t>(i)] += fault;
            rejected = rejected || !test_set(array, kExact, limits, block, array.all().without(j)).consistent(limits);
          }
          EXPECT_EQ(rejected, j != i) << fault << " of " << i << " by " << j;
        }
      }
    }
  }
  TestSettings once = settings;
  once.isolation_attitudes = 1;
  EXPECT_GT(detection_sizes(array, kExact, once).guaranteed_isolation_mps2, 2.0 * size) << "one attitude hides more";
}

TEST(DetectionSizes, OverSeveralAttitudesNoSmallerFigureWouldDo) {
  const SensorArray array = tetrahedron();
  const OneAttitude one(array, kExact, error_budget(array, kExact, TestSettings{}));
  Noise noise(4);
  for (int k = 0; k < 200; ++k) {
    const Vec3 down[3] = {random_direction(noise), random_direction(noise), random_direction(noise)};
    for (int i = 0; i < 4; ++i) {
      const double single = one.clear_over_mps2(down, 1, i), all = one.clear_over_mps2(down, 3, i);
      EXPECT_LE(all, single);
      EXPECT_TRUE(one.isolates(down[0], i, 1.000001 * single) && one.isolates(down[0], i, -1.000001 * single));
      EXPECT_FALSE(one.isolates(down[0], i, 0.999999 * single) && one.isolates(down[0], i, -0.999999 * single));
    }
  }
  EXPECT_TRUE(std::isinf(one.clear_over_mps2(nullptr, 0, 0)));
}

/// Without an alarm nothing is isolated, however unlike the sensors are.
// Verifies: REQ-016
TEST(DetectionSizes, IsolationIsNeverGuaranteedBelowDetection) {
  for (const double factor : {1.0, 10.0, 100.0}) {
    for (int n = 4; n <= 8; ++n) {
      AxisList axes{};
      cone_with_axis(axes, n);
      std::array<SensorRow, kCapacity> rows{};
      for (int i = 0; i < n; ++i) {
        const auto a = static_cast<std::size_t>(i);
        rows[a].id = make_id(("a" + std::to_string(i + 1)).c_str());
        rows[a].axis = axes[a];
        rows[a].sigma_mps2 = i == 1 ? factor * 0.2 * kMilli : 0.2 * kMilli;
      }
      const DetectionSizes sizes = detection_sizes(*SensorArray::make(rows.data(), n), kExact, {});
      EXPECT_GE(sizes.guaranteed_isolation_mps2, sizes.guaranteed_detection_any_mps2) << n << ' ' << factor;
    }
  }
}

// Verifies: REQ-123
TEST(SizeTable, StatesTheSameConditionsWhateverTheArrayFileSays) {
  const SensorArray array = cone_array(6);
  TestSettings stated;
  stated.acceleration_mps2 = 5.0 * kMilli;
  for (std::size_t i = 0; i < 6; ++i) stated.tolerance_mps2[i] = 0.3 * kMilli;
  const SizeTable said = findings::size_table(array, kExact, stated, false, {});
  const SizeTable usual = findings::size_table(array, kExact, TestSettings{}, false, {});
  for (const std::size_t row : {0U, 1U}) {
    EXPECT_EQ(said.at[row].minimum_detectable_bias_mps2, usual.at[row].minimum_detectable_bias_mps2);
    EXPECT_EQ(said.at[row].protection_level_at_rest_rad, usual.at[row].protection_level_at_rest_rad);
  }
  EXPECT_EQ(usual.at[2].protection_level_at_rest_rad, usual.at[0].protection_level_at_rest_rad);
  EXPECT_EQ(said.at[2].protection_level_at_rest_rad, protection_level_rad(array, kExact, stated));
  EXPECT_GT(said.at[2].protection_level_at_rest_rad, said.at[0].protection_level_at_rest_rad + 4e-3);
  EXPECT_DOUBLE_EQ(said.tolerance_mps2(SizeCondition::stability_0_2_mg0, 6), kStabilitySigmas * 0.2 * kMilli);
  EXPECT_EQ(said.acceleration_mps2(SizeCondition::stability_0_2_mg0), 0.0);
  EXPECT_EQ(said.acceleration_mps2(SizeCondition::as_stated), stated.acceleration_mps2);
}

// Negative: REQ-016
TEST(SizeTable, SaysWhatItDoesNotKnow) {
  const Vec3 z = {0.0, 0.0, 1.0};
  const SensorArray array = cone_array(5);
  EXPECT_EQ(findings::size_table(array, kExact, TestSettings{}, false, {}).known, VisitedKnown::no_calibration);
  EXPECT_EQ(findings::size_table(array, kExact, TestSettings{}, true, {}).known, VisitedKnown::not_in_the_file);
  EXPECT_EQ(findings::size_table(array, kExact, TestSettings{}, true, {{}, {}}).known, VisitedKnown::not_in_the_file);
  const SizeTable known = findings::size_table(array, kExact, TestSettings{}, true, {z, {}});
  EXPECT_EQ(known.known, VisitedKnown::yes);
  EXPECT_EQ(known.visited, 1);
  AxisList axes{};
  const SizeTable triad =
      findings::size_table(make_array(axes, orthogonal_triad(axes), kMilli), kExact, TestSettings{}, true, {z});
  for (const DetectionSizes& sizes : triad.at) {
    EXPECT_TRUE(std::isinf(sizes.minimum_detectable_bias_mps2));
    EXPECT_TRUE(std::isinf(sizes.guaranteed_detection_visited_mps2));
    EXPECT_TRUE(std::isinf(sizes.guaranteed_detection_any_mps2));
    EXPECT_TRUE(std::isinf(sizes.guaranteed_isolation_mps2));
    EXPECT_EQ(sizes.protection_level_at_rest_rad, kPi);
  }
}

}  // namespace
}  // namespace detection_sizes_test
