// Clock and gyro of a log in motion.
#include <gtest/gtest.h>

#include "plumb/session/motion_inputs.hpp"

namespace motion_inputs_test {
namespace {

using plumb::session::MotionInputs;
using plumb::session::MotionInputsWatch;

TEST(MotionInputs, ARegularClockAndANoisyGyroShowNothing) {
  MotionInputsWatch watch(0.001);
  for (int k = 0; k < 3000; ++k) {
    watch.add(0.001 * k);
    watch.add_rate(0, true, {0.01 * (k % 7), 0.0, 0.0});
  }
  const MotionInputs& f = watch.found();
  EXPECT_EQ(f.rows, 3000U);
  EXPECT_EQ(f.gyro[0].rates, 3000U);
  EXPECT_EQ(f.steps_back + f.steps_irregular + f.gyro[0].missing, 0U);
  EXPECT_NEAR(f.mean_step_s, 0.001, 1e-12);
  EXPECT_LT(f.jitter_s, 1e-9);
  EXPECT_DOUBLE_EQ(f.gyro[0].largest_radps, 0.06);
  EXPECT_EQ(f.gyro[0].still_s, 0.0);
}

TEST(MotionInputs, StepsThatAreNoPeriodAreCountedWithTheirTime) {
  MotionInputsWatch watch(0.01);
  for (const double t_s : {0.0, 0.01, 0.0225, 0.03, 0.03, 0.02, 0.03, 0.04, 0.09, 0.1}) watch.add(t_s);
  const MotionInputs& f = watch.found();
  EXPECT_EQ(f.steps_back, 2U);
  EXPECT_EQ(f.first_back_s, 0.03);
  EXPECT_EQ(f.steps_irregular, 1U);
  EXPECT_EQ(f.first_irregular_s, 0.09);
  EXPECT_NEAR(f.jitter_s, 0.0025, 1e-12);
  EXPECT_FALSE(f.period_is_another);
}

TEST(MotionInputs, AnotherPeriodIsMeasured) {
  MotionInputsWatch watch(0.001);
  for (int k = 0; k < 50; ++k) watch.add(0.02 * k);
  EXPECT_TRUE(watch.found().period_is_another);
  EXPECT_NEAR(watch.found().mean_step_s, 0.02, 1e-12);
}

TEST(MotionInputs, ARateThatStandsStillAndOneThatIsMissing) {
  MotionInputsWatch watch(0.001);
  for (int k = 0; k < 4000; ++k) {
    watch.add(0.001 * k);
    const bool still = k >= 1000 && k < 3000;
    watch.add_rate(0, k != 3500, {still ? 0.5 : 0.001 * (k % 11), 0.0, 0.0});
  }
  const MotionInputs& f = watch.found();
  EXPECT_NEAR(f.gyro[0].still_s, 1.999, 1e-9);
  EXPECT_NEAR(f.gyro[0].still_from_s, 1.0, 1e-9);
  EXPECT_FALSE(f.gyro[0].still_at_zero);
  EXPECT_EQ(f.gyro[0].missing, 1U);
  EXPECT_NEAR(f.gyro[0].first_missing_s, 3.5, 1e-9);
}

TEST(MotionInputs, AGyroThatIsOffStandsAtZero) {
  MotionInputsWatch watch(0.001);
  for (int k = 0; k < 100; ++k) {
    watch.add(0.001 * k);
    watch.add_rate(0, true, {0.0, 0.0, 0.0});
  }
  EXPECT_TRUE(watch.found().gyro[0].still_at_zero);
  EXPECT_NEAR(watch.found().gyro[0].still_s, 0.099, 1e-9);
}

}  // namespace
}  // namespace motion_inputs_test
