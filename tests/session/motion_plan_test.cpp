// From an array file to a monitor of motion: what is taken over, what follows from calibration, what is missing.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "motion_support.hpp"
#include "plumb/motion/motion_monitor.hpp"
#include "plumb/session/monitor_pipeline.hpp"
#include "plumb/session/motion_plan.hpp"

namespace motion_plan_test {
namespace {

using namespace plumb;
using namespace motion_support;
using plumb_test::with;
using session::MotionPlan;

io::FileExpected<MotionPlan> plan_of(const std::string& text, const Calibration* calibration = nullptr,
                                     double days = 0.0) {
  return session::plan_motion(array_of(text), calibration, days);
}

io::FileError refusal_of(const std::string& text, const Calibration* calibration = nullptr) {
  const io::FileExpected<MotionPlan> plan = plan_of(text, calibration);
  if (!plan) return plan.error();
  ADD_FAILURE() << "a plan was made";
  return {};
}

/// What `calibrate` would leave: each parameter with its sigma, apart from all others.
std::unique_ptr<Calibration> calibrated(const io::ArrayFile& array, double sigma_w, double sigma_b_mps2) {
  auto out = std::make_unique<Calibration>();
  out->model = array.datasheet.model();
  out->array = array.array;
  auto left = std::make_unique<RowUncertainty>();
  for (int a = 0; a < 4 * array.array.size(); ++a)
    left->covariance[static_cast<std::size_t>(a * (a + 1) / 2 + a)] = std::pow(a % 4 == 3 ? sigma_b_mps2 : sigma_w, 2);
  for (std::size_t k = 0; k < static_cast<std::size_t>(array.array.size()); ++k) left->misfit_mps2[k] = 2e-3;
  left->common_scale = 1e-5;
  out->array.set_uncertainty(*left);
  out->report.temperature_min_degc = 15.0;
  out->report.temperature_max_degc = 45.0;
  return out;
}

TEST(MotionPlan, TakesOverWhatTheFileStates) {
  const io::FileExpected<MotionPlan> plan = plan_of(drone_text());
  ASSERT_TRUE(plan.has_value()) << plan.error().text();
  const MotionSetup& s = plan->setup;
  EXPECT_EQ(s.sample_period_s, 0.001);
  EXPECT_EQ(s.rate_bound_radps, 8.0);
  EXPECT_EQ(s.lever_arm_m[0], (Vec3{0.025, 0.0, 0.0}));
  EXPECT_EQ(s.errors[8].lever_m, 0.001);
  EXPECT_EQ(s.errors[8].lag_s, 70e-6);
  EXPECT_EQ(s.errors[8].rectification, 2e-5);
  EXPECT_EQ(s.errors[8].scale, 0.001);
  EXPECT_EQ(s.errors[8].axis_rad, 0.0015);
  EXPECT_EQ(s.errors[8].bias_mps2, 0.0098);
  EXPECT_EQ(s.gyros, 2);
  EXPECT_FALSE(s.gyro_corroborated);
  EXPECT_EQ(s.gyro.scale, 0.01);
  EXPECT_EQ(s.gyro.axis_rad, 0.01);
  EXPECT_EQ(s.gyro.bias_radps, 0.006);
  EXPECT_EQ(s.gyro.noise_radps, 0.0017);
  EXPECT_EQ(s.gyro.lag_s, 20e-6);
  EXPECT_EQ(plan->array.units().size(), 3);
  EXPECT_EQ(plan->array.units().whole(SensorSet::of(2)), SensorSet::first(3));
  EXPECT_EQ(s.max_faults, kMotionDepth);
  EXPECT_NEAR(plan->clip_raw[0], 0.995 * 156.9, 1e-9);
  MotionMonitor monitor;
  EXPECT_TRUE(monitor.configure(plan->array, s).has_value());
}

TEST(MotionPlan, SensorsWithoutAPackageAreUnitsOfTheirOwn) {
  const auto plan = plan_of(without_all("package", drone_text()));
  ASSERT_TRUE(plan.has_value());
  EXPECT_FALSE(plan->array.units().grouped());
}

TEST(MotionPlan, ASamplingRateIsAPeriod) {
  std::string text = with(drone_text(), "time = \"t_s\"", "rate = \"500 Hz\"");
  const auto plan = plan_of(without("sample_period_s", text));
  ASSERT_TRUE(plan.has_value()) << plan.error().text();
  EXPECT_EQ(plan->setup.sample_period_s, 0.002);
}

TEST(MotionPlan, OneGyroMayBeCorroborated) {
  const auto plan =
      plan_of(with(without("second_rotation_radps", drone_text()), "noise_radps", "corroborated = true\nnoise_radps"));
  ASSERT_TRUE(plan.has_value()) << plan.error().text();
  EXPECT_EQ(plan->setup.gyros, 1);
  EXPECT_TRUE(plan->setup.gyro_corroborated);
}

TEST(MotionPlan, WithoutAGyroTheStatedLargestRateIsEnough) {
  std::string text = without("rotation_radps", without("second_rotation_radps", drone_text()));
  const std::size_t gyro = text.find("[gyro]");
  text.erase(gyro, text.find("[[sensor]]") - gyro);
  const auto plan = plan_of(text);
  ASSERT_TRUE(plan.has_value()) << plan.error().text();
  EXPECT_EQ(plan->setup.gyros, 0);
  EXPECT_EQ(refusal_of(without("rate_bound_radps", text)).field, "motion.rate_bound_radps");
}

TEST(MotionPlan, NamesEveryKeyThatIsMissing) {
  struct Case {
    const char *key, *field;
  };
  for (const Case& one :
       {Case{"sample_period_s", "motion.sample_period_s"}, Case{"lever_arm_bound_m", "motion.lever_arm_bound_m"},
        Case{"lag_bound_s = 70e-6", "motion.lag_bound_s"},
        Case{"vibration_rectification", "motion.vibration_rectification_per_mps2"},
        Case{"scale_bound = 0.001", "motion.scale_bound"}, Case{"axis_bound_rad = 0.0015", "motion.axis_bound_rad"},
        Case{"bias_bound_mps2", "motion.bias_bound_mps2"}, Case{"scale_bound = 0.01\n", "gyro.scale_bound"},
        Case{"axis_bound_rad = 0.01\n", "gyro.axis_bound_rad"}, Case{"bias_bound_radps", "gyro.bias_bound_radps"},
        Case{"noise_radps", "gyro.noise_radps"}, Case{"lag_bound_s = 20e-6", "gyro.lag_bound_s"}}) {
    const io::FileError error = refusal_of(without(one.key, drone_text()));
    EXPECT_EQ(error.file, "drone.toml") << one.key;
    EXPECT_EQ(error.field, one.field) << error.text();
    EXPECT_EQ(error.what, "is missing: motion is not judged");
    EXPECT_NE(error.remedy.find("state it"), std::string::npos);
  }
  const io::FileError both = refusal_of(without("noise_radps", without("bias_bound_radps", drone_text())));
  EXPECT_EQ(both.field, "gyro.bias_bound_radps");
  EXPECT_NE(both.what.find("and so is gyro.noise_radps"), std::string::npos) << both.what;
  EXPECT_EQ(refusal_of(without_all("lever_arm_m", drone_text())).field, "sensor[1].lever_arm_m");
}

TEST(MotionPlan, SaysWhatCannotBeDone) {
  const std::string text = drone_text();
  const std::size_t motion = text.find("\n[motion]") + 1;
  std::string no_table = text;
  no_table.erase(motion, no_table.find("\n[gyro]") + 1 - motion);
  EXPECT_NE(refusal_of(no_table).remedy.find("add [motion]"), std::string::npos);
  EXPECT_EQ(refusal_of(with(text, "[input]", "[monitor]\nmode = \"paper\"\n[input]")).field, "monitor.mode");
  EXPECT_EQ(refusal_of(with(text, "[input]", "[input]\nrows = \"stations\"")).field, "input.rows");
  std::string many = text;
  for (int k = 0; k < 4; ++k) {
    const std::string last = text.substr(text.rfind("[[sensor]]"));
    many += with(last, "\"z3\"", "\"more" + std::to_string(k) + "\"");
  }
  const io::FileError error = refusal_of(many);
  EXPECT_EQ(error.what, "is judged for at most 12 sensors, and these are 13: motion is not judged");
  std::string three = text.substr(0, text.find("id = \"x2\""));
  three.erase(three.rfind("[[sensor]]"));
  EXPECT_NE(refusal_of(three).what.find("has no axes that check each other"), std::string::npos);
  const std::string brief = "[motion]\nvelocity_bound_mps = 0.1\ninclination_window_s = 0.1\n";
  EXPECT_EQ(refusal_of(with(text, "[motion]\n", brief)).field, "motion.inclination_window_s");
}

TEST(MotionPlan, CalibrationAndStabilityBoundWhatTheFileLeavesToThem) {
  std::string text = without("scale_bound = 0.001", without("axis_bound_rad = 0.0015", drone_text()));
  text = without("bias_bound_mps2", text);
  const io::ArrayFile unstable = array_of(text);
  const auto calibration = calibrated(unstable, 1e-4, 1e-3);
  const io::FileExpected<MotionPlan> open = session::plan_motion(unstable, calibration.get(), 10.0);
  ASSERT_FALSE(open.has_value()) << "drift is not stated";
  EXPECT_EQ(open.error().field, "motion.scale_bound");

  const std::string stability =
      "[monitor]\nstability = \"0.2 mg\"\nstability_per_day = \"1 ug\"\n"
      "stability_per_degc = \"5 ug\"\n[input]";
  const io::ArrayFile array = array_of(with(text, "[input]", stability));
  const io::FileExpected<MotionPlan> plan = session::plan_motion(array, calibration.get(), 10.0);
  ASSERT_TRUE(plan.has_value()) << plan.error().text();
  const double tolerance_mps2 = 4.0 * 1e-3 * kG0_mps2 * (0.2 + 0.01 + 0.005 * 20.0);  // 45 degC, t_ref 25 degC
  const MotionErrors& e = plan->setup.errors[4];
  EXPECT_NEAR(e.bias_mps2, 3.0 * (1e-3 + 2e-3) + tolerance_mps2, 1e-7);
  EXPECT_NEAR(e.scale, 3.0 * (1e-4 + 1e-5) + tolerance_mps2 / kG0_mps2, 1e-8);
  EXPECT_NEAR(e.axis_rad, 3.0 * std::sqrt(2.0) * 1e-4, 1e-10);
  EXPECT_EQ(plan->model.sensor[0].scale, calibration->model.sensor[0].scale);

  const io::ArrayFile stated =
      array_of(with(with(text, "[input]", stability), "[gyro]", "bias_bound_mps2 = 0.3\n[gyro]"));
  EXPECT_EQ(session::plan_motion(stated, calibration.get(), 10.0)->setup.errors[4].bias_mps2, 0.3) << "a key counts";
  const auto hopeless = calibrated(array, 1.0, 1e-3);
  EXPECT_NE(session::plan_motion(array, hopeless.get(), 0.0).error().what.find("beyond what motion can be judged with"),
            std::string::npos);
}

TEST(MotionPlan, RowsBecomeSamplesOfSpecificForce) {
  for (const char* reads : {"specific-force", "gravity"}) {
    const io::FileExpected<MotionPlan> plan = plan_of(with(drone_text(), "specific-force", reads));
    ASSERT_TRUE(plan.has_value());
    session::MotionSampler sampler(*plan);
    Sample row;
    row.time_s = 2.5;
    row.temperature_degc = 25.0;
    row.delivered = plan->array.all().without(8);
    row.raw.fill(3.0);
    row.raw[1] = std::numeric_limits<double>::quiet_NaN();
    row.raw[2] = -156.5;
    const MotionSample sample = sampler.sample(row);
    EXPECT_EQ(sample.time_s, 2.5);
    EXPECT_EQ(sample.delivered, plan->array.all().without(8).without(1)) << "no number is no reading";
    EXPECT_EQ(sample.clipped, SensorSet::of(2)) << "full scale is 156.9";
    EXPECT_EQ(sample.reading_mps2[0], plan->model.reads == Reads::gravity ? -3.0 : 3.0);
    EXPECT_FALSE(sample.rate_given[0]);
  }
}

TEST(MotionPlan, ARowWithoutTemperatureHasTheLastOne) {
  const io::FileExpected<MotionPlan> drone = plan_of(drone_text());
  ASSERT_TRUE(drone.has_value());
  MotionPlan plan = *drone;
  plan.model.sensor[0].bias[1] = 0.1;
  session::MotionSampler sampler(plan);
  Sample row;
  row.delivered = plan.array.all();
  row.temperature_degc = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(sampler.sample(row).reading_mps2[0], 0.0, 1e-12) << "none yet: that of the coefficients";
  row.temperature_degc = plan.model.sensor[0].reference_degc + 10.0;
  const double warm_mps2 = sampler.sample(row).reading_mps2[0];
  EXPECT_NEAR(std::fabs(warm_mps2), 1.0, 1e-9);
  row.temperature_degc = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sampler.sample(row).reading_mps2[0], warm_mps2);
}

/// A chip at 2 kHz stands in 3.25 of the 6500 rows a second that three clocks make at most, one at 2.5 kHz in 2.6.
// Verifies: REQ-207
TEST(MotionPlan, AtRestNoiseIsLargerByTheRowsThatRepeatASample) {
  const auto factors = [](const std::string& text) {
    const io::ArrayFile array = array_of(text);
    const auto monitor = session::make_monitor(array, nullptr);
    EXPECT_TRUE(monitor.has_value());
    std::vector<double> out;
    for (int i = 0; i < array.array.size(); i += 3)
      out.push_back((*monitor)->array().sigma_mps2(i) / array.array.sigma_mps2(i));
    return out;
  };
  const std::string clocked = plumb_test::read_text(PLUMB_SOURCE_DIR "/examples/motion/drone_clocks.toml");
  const std::vector<double> found = factors(clocked);
  EXPECT_NEAR(found[0], std::sqrt(3.25), 1e-12);
  EXPECT_NEAR(found[1], std::sqrt(3.25), 1e-12);
  EXPECT_NEAR(found[2], std::sqrt(2.6), 1e-12);
  // On one column they deliver together: 2000 rows a second, and 2500.
  EXPECT_NEAR(factors(plumb_test::with(clocked, "t2_s\"", "t1_s\""))[0], std::sqrt(2.25), 1e-12);
  for (const double one : factors(drone_text())) EXPECT_EQ(one, 1.0);
}

}  // namespace
}  // namespace motion_plan_test
