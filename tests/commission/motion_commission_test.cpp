// Commissioning from simulated motion whose truth is known.
#include "plumb/commission/motion_commission.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "plumb/motion/motion_monitor.hpp"

namespace motion_commission_test {
namespace {

using namespace plumb;
using namespace plumb::commission;

constexpr double kPeriod_s = 0.01;
constexpr int kSamples = 6000;

struct Truth {
  std::array<double, 3> delay_s{0.0, 0.0334, -0.0712};
  std::array<Vec3, 3> arm_m{Vec3{}, Vec3{0.08, -0.03, 0.02}, Vec3{-0.05, 0.06, 0.04}};
  std::array<Mat3, 3> to_frame{Mat3{1, 0, 0, 0, 1, 0, 0, 0, 1}, Mat3{0, -1, 0, 1, 0, 0, 0, 0, 1},
                               Mat3{1, 0, 0, 0, 0, -1, 0, 1, 0}};
  std::array<double, 3> scale{1.0, 1.01, 0.995};
  std::array<double, 3> bias_mps2{0.0, 0.2, -0.1};
  bool turns_about_one_axis = false;
  bool accelerates = true;
};

double wave(double t_s, double a, double b, double phase) {
  return std::sin(a * t_s + phase) + 0.7 * std::sin(b * t_s + 2.0 * phase);
}

Vec3 rate_at(const Truth& truth, double t_s) {
  const double others = truth.turns_about_one_axis ? 0.0 : 1.0;
  return {others * 1.5 * wave(t_s, 3.1, 7.3, 0.3), others * 1.2 * wave(t_s, 2.3, 5.9, 1.1),
          1.4 * wave(t_s, 4.1, 6.7, 2.0)};
}

Vec3 force_at(const Truth& truth, double t_s) {
  const double size = truth.accelerates ? 1.0 : 0.0;
  return {size * 4.0 * wave(t_s, 0.7, 2.9, 0.5), size * 5.0 * wave(t_s, 0.9, 3.3, 1.7),
          size * (9.8 + 3.0 * wave(t_s, 1.3, 3.7, 2.4))};
}

Vec3 transposed_times(const Mat3& m, const Vec3& v) {
  return {m[0] * v[0] + m[3] * v[1] + m[6] * v[2], m[1] * v[0] + m[4] * v[1] + m[7] * v[2],
          m[2] * v[0] + m[5] * v[1] + m[8] * v[2]};
}

MotionLog log_of(const Truth& truth, double noise_mps2 = 0.02) {
  std::mt19937 random(20240501);
  // Sums of uniform numbers, because the standard leaves the normal distribution to the library.
  const auto noise = [&](double sigma) {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(random()) / 4294967296.0;
    return sigma * sum;
  };
  MotionLog out;
  out.period_s = kPeriod_s;
  out.unit.resize(3);
  for (std::size_t u = 0; u < 3; ++u) {
    for (int k = 0; k < kSamples; ++k) {
      const double t_s = k * kPeriod_s - truth.delay_s[u], h_s = 1e-4;
      const Vec3 w = rate_at(truth, t_s), r = truth.arm_m[u];
      const Vec3 alpha = scaled(minus(rate_at(truth, t_s + h_s), rate_at(truth, t_s - h_s)), 0.5 / h_s);
      const Vec3 felt = plus(force_at(truth, t_s), plus(cross(alpha, r), cross(w, cross(w, r))));
      Vec3 y = transposed_times(truth.to_frame[u], felt), g = transposed_times(truth.to_frame[u], w);
      for (std::size_t c = 0; c < 3; ++c) {
        y[c] = truth.scale[u] * y[c] + truth.bias_mps2[u] + noise(noise_mps2);
        g[c] += noise(0.003);
      }
      out.unit[u].force_mps2.push_back(y);
      out.unit[u].rate_radps.push_back(g);
    }
  }
  return out;
}

TEST(MotionCommission, FindsClocksMountingArmsScalesAndBiases) {
  const Truth truth;
  const auto found = commission_motion(log_of(truth));
  ASSERT_TRUE(found.has_value()) << found.error();
  for (std::size_t u = 1; u < 3; ++u) {
    const FittedUnit& unit = found->fit.unit[u];
    EXPECT_NEAR(found->alignment[u].delay_s, truth.delay_s[u], 0.2e-3);
    EXPECT_LT(found->alignment[u].delay_sigma_s, 0.2e-3);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(unit.arm_m[c], truth.arm_m[u][c], 0.001);
      EXPECT_LT(std::fabs(unit.arm_m[c] - truth.arm_m[u][c]), 4.0 * unit.arm_sigma_m[c]);
      EXPECT_LT(std::fabs(unit.bias_mps2[c] - truth.bias_mps2[u]), 4.0 * unit.bias_sigma_mps2[c]);
      const Vec3 row{unit.rows[3 * c], unit.rows[3 * c + 1], unit.rows[3 * c + 2]};
      EXPECT_NEAR(norm(row), truth.scale[u], 0.001);
    }
    EXPECT_NEAR(unit.lag_s, 0.0, 0.3e-3);
  }
}

TEST(MotionCommission, SetsUpAMonitorThatFindsAShiftInAnotherMotion) {
  Truth truth;
  const auto found = commission_motion(log_of(truth));
  ASSERT_TRUE(found.has_value()) << found.error();
  truth.delay_s = {0.0, -0.0481, 0.0127};  // another run of the clocks
  const MotionLog other = log_of(truth);
  const auto clocks = align_by_gyros(other);
  ASSERT_TRUE(clocks.has_value()) << clocks.error();
  const MotionLog aligned_log = found->aligned(other, *clocks);
  for (const double shift_mps2 : {0.0, 1.0}) {
    MotionMonitor monitor;
    ASSERT_TRUE(monitor.configure(found->array, found->setup).has_value());
    SensorSet blamed;
    for (std::size_t k = 0; k < aligned_log.samples(); ++k) {
      MotionSample sample = found->sample(aligned_log, k);
      if (k > 2000) sample.reading_mps2[4] += shift_mps2;
      const MotionVerdict& verdict = monitor.step(sample);
      blamed = blamed | verdict.isolated | verdict.excluded;
    }
    EXPECT_EQ(blamed.has(4), shift_mps2 > 0.0);
    EXPECT_TRUE(SensorSet(0x38U).contains(blamed));  // its unit at most
  }
}

TEST(MotionCommission, LeavesOutWhereAGyroOrAForceIsAtFullScale) {
  const Truth truth;
  MotionLog log = log_of(truth);
  log.full_scale_mps2 = 40.0;
  for (std::size_t k = 0; k < log.samples(); ++k) {
    if (k % 400 < 20) log.unit[1].rate_radps[k] = {std::nan(""), 0.0, 0.0};
    if (k % 1000 == 500) log.unit[2].force_mps2[k] = {40.0, 0.0, 0.0};
  }
  const auto found = commission_motion(log);
  ASSERT_TRUE(found.has_value()) << found.error();
  for (std::size_t u = 1; u < 3; ++u) {
    EXPECT_NEAR(found->alignment[u].delay_s, truth.delay_s[u], 0.2e-3);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found->fit.unit[u].arm_m[c], truth.arm_m[u][c], 0.001);
  }
  for (Vec3& rate : log.unit[1].rate_radps) rate[0] = std::nan("");
  const auto none = commission_motion(log);
  ASSERT_FALSE(none.has_value());
  EXPECT_NE(none.error().find("the gyros give too few samples"), std::string::npos) << none.error();
}

TEST(MotionCommission, RefusesRotationAboutOneAxis) {
  Truth truth;
  truth.turns_about_one_axis = true;
  const auto found = commission_motion(log_of(truth));
  ASSERT_FALSE(found.has_value());
  EXPECT_NE(found.error().find("leave open how it is turned about the first unit's z axis"), std::string::npos)
      << found.error();
}

TEST(MotionCommission, NamesWhatAMotionWithoutForceLeavesOpen) {
  Truth truth;
  truth.accelerates = false;
  const auto found = commission_motion(log_of(truth));
  ASSERT_FALSE(found.has_value());
  EXPECT_NE(found.error().find("the motion leaves open: "), std::string::npos) << found.error();
  EXPECT_NE(found.error().find("turn of"), std::string::npos) << found.error();
}

TEST(MotionCommission, RefusesALostRow) {
  MotionLog log = log_of(Truth{});
  UnitLog& unit = log.unit[2];
  unit.force_mps2.erase(unit.force_mps2.begin() + 2500);
  unit.rate_radps.erase(unit.rate_radps.begin() + 2500);
  const auto uneven = commission_motion(log);
  ASSERT_FALSE(uneven.has_value());
  EXPECT_NE(uneven.error().find("different numbers of samples"), std::string::npos) << uneven.error();
  unit.force_mps2.push_back(unit.force_mps2.back());
  unit.rate_radps.push_back(unit.rate_radps.back());
  const auto found = commission_motion(log);
  ASSERT_FALSE(found.has_value());
  EXPECT_NE(found.error().find("unit 3: its clock moves by "), std::string::npos) << found.error();
}

TEST(MotionCommission, RefusesWhatIsNoLog) {
  const MotionLog log = log_of(Truth{});
  const auto error_of = [](const MotionLog& given) {
    const auto found = commission_motion(given);
    return found ? std::string() : found.error();
  };
  MotionLog bad = log;
  bad.unit.resize(1);
  EXPECT_NE(error_of(bad).find("the log has 1 units"), std::string::npos);
  bad = log;
  bad.period_s = 0.0;
  EXPECT_NE(error_of(bad).find("sample period"), std::string::npos);
  bad = log;
  bad.unit[1].force_mps2[17][2] = std::nan("");
  EXPECT_NE(error_of(bad).find("a force of sample 17 is not finite"), std::string::npos);
  bad = log;
  for (UnitLog& unit : bad.unit) {
    unit.force_mps2.resize(300);
    unit.rate_radps.resize(300);
  }
  EXPECT_NE(error_of(bad).find("the log has 300 samples"), std::string::npos);
}

TEST(MotionCommission, RefusesADelayBeyondTheSearch) {
  Truth truth;
  truth.delay_s[1] = 0.35;
  const auto found = align_by_gyros(log_of(truth));
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().substr(0, 6), "unit 2");
}

}  // namespace
}  // namespace motion_commission_test
