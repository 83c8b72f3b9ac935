// What an array file states for a monitor of motion.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io_test_support.hpp"
#include "plumb/io/motion_records.hpp"
#include "plumb/io/upgrade.hpp"

namespace array_motion_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

const std::string kMotion = R"([motion]
sample_period_s = 0.002
rate_bound_radps = 8
force_bound_mps2 = 90
velocity_bound_mps = 0.3
inclination_window_s = 6
false_alarms_per_hour = 1e-2
dwell_s = 0.05
quiet_s = 4
max_faults = 1
shortest_block = 4
block_samples = [1, 5, 40, 200]
lever_arm_bound_m = 0.001
lag_bound_s = 70e-6
vibration_rectification_per_mps2 = 2e-5
scale_bound = "0.1 %"
axis_bound_rad = 0.0015
bias_bound_mps2 = 0.01
[gyro]
scale_bound = 0.01
axis_bound_rad = 0.012
bias_bound_radps = 0.006
noise_radps = 0.002
lag_bound_s = 2e-5
corroborated = true
)";

/// kArrayText with motion in front of the sensors, and the columns that a gyro needs.
std::string with_motion(const std::string& motion = kMotion) {
  return changed(
      "reads = ", "rotation_radps = [\"wx\", \"wy\", \"wz\"]\nreads = ", changed("[[sensor]]", motion + "[[sensor]]"));
}

int line_of(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key);
  EXPECT_NE(at, std::string::npos) << key;
  return static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
}

const std::string kGyros = R"(
[[group]]
name = "gyros"
field = "rate"
unit = "deg/s"
[group.rate]
sample_period_s = 0.01
[[group.sensor]]
id = "g1"
axis = [1, 0, 0]
noise = "0.1 deg/s"
[[group.sensor]]
id = "g2"
axis = [0, 1, 0]
noise = "0.1 deg/s"
[[group.sensor]]
id = "g3"
axis = [0, 0, 1]
noise = "0.1 deg/s"
)";

TEST(ArrayMotion, TheRateMayBeThatOfAGroupOfGyros) {
  const std::string gyro = "[gyro]\ngroup = \"gyros\"\nlag_bound_s = 2e-5\n";
  const auto text_of = [](const std::string& motion) { return changed("[[sensor]]", motion + "[[sensor]]") + kGyros; };
  const auto file = parse_array_text(text_of(gyro), "tool.toml");
  ASSERT_TRUE(file.has_value()) << file.error().text();
  EXPECT_EQ(file->motion.gyro.group, "gyros");
  EXPECT_EQ(file->motion.gyro.lag_s, 2e-5);
  EXPECT_TRUE(file->input.rotation_columns.empty());
  const std::string another = text_of(changed("\"gyros\"", "\"gyro\"", gyro));
  expect_refused(another, line_of(another, "group = "), "gyro.group", {"no [[group]] of gyros is called so", "gyros"});
  const std::string beside = text_of(gyro + "scale_bound = 0.01\n");
  expect_refused(beside, line_of(beside, "scale_bound"), "gyro.scale_bound", {"bounds of their own", "remove it"});
  const std::string both = changed("reads = ", "rotation_radps = [\"wx\", \"wy\", \"wz\"]\nreads = ", text_of(gyro));
  expect_refused(both, line_of(both, "group = "), "gyro.group", {"rotation_radps", "keep one"});
}

TEST(ArrayMotion, IsNotStatedInAFileWithoutIt) {
  const ArrayFile file = array_of();
  EXPECT_FALSE(file.motion.stated);
  EXPECT_FALSE(file.motion.mentioned);
  EXPECT_FALSE(file.motion.gyro.stated);
}

TEST(ArrayMotion, ReadsEveryKey) {
  const MotionSpec motion = array_of(with_motion()).motion;
  EXPECT_TRUE(motion.stated);
  EXPECT_TRUE(motion.mentioned);
  EXPECT_EQ(motion.sample_period_s, 0.002);
  EXPECT_EQ(motion.rate_bound_radps, 8.0);
  EXPECT_EQ(motion.limits.force_bound_mps2, 90.0);
  EXPECT_EQ(motion.velocity_bound_mps, 0.3);
  EXPECT_EQ(motion.inclination_window_s, 6.0);
  EXPECT_EQ(motion.limits.false_alarms_per_hour, 1e-2);
  EXPECT_EQ(motion.limits.dwell_s, 0.05);
  EXPECT_EQ(motion.limits.quiet_s, 4.0);
  EXPECT_EQ(motion.limits.max_faults, 1);
  EXPECT_EQ(motion.limits.shortest_block, 4);
  EXPECT_EQ(motion.limits.block_samples, (BlockSamples{1, 5, 40, 200}));
  for (std::size_t k = 0; k < 4; ++k) {
    const MotionBounds& sensor = motion.sensor[k];
    EXPECT_EQ(sensor.lever_arm_m, 0.001);
    EXPECT_EQ(sensor.lag_s, 70e-6);
    EXPECT_EQ(sensor.rectification_per_mps2, 2e-5);
    EXPECT_EQ(sensor.scale, 0.001);
    EXPECT_EQ(sensor.axis_rad, 0.0015);
    EXPECT_EQ(sensor.bias_mps2, 0.01);
  }
  EXPECT_EQ(motion.gyro.scale, 0.01);
  EXPECT_EQ(motion.gyro.axis_rad, 0.012);
  EXPECT_EQ(motion.gyro.bias_radps, 0.006);
  EXPECT_EQ(motion.gyro.noise_radps, 0.002);
  EXPECT_EQ(motion.gyro.lag_s, 2e-5);
  EXPECT_TRUE(motion.gyro.corroborated);
}

TEST(ArrayMotion, ASensorsOwnBoundsComeBeforeThoseOfAll) {
  std::string own;
  for (const char* line : {"lever_arm_bound_m = 0.002", "lag_bound_s = 1e-5", "vibration_rectification_per_mps2 = 0",
                           "scale_bound = 0.02", "axis_bound_rad = 0.03", "bias_bound_mps2 = 0.4"})
    own += std::string("\n") + line;
  const MotionSpec motion = array_of(changed("id = \"A2\"", "id = \"A2\"" + own, with_motion())).motion;
  EXPECT_EQ(motion.sensor[1].lever_arm_m, 0.002);
  EXPECT_EQ(motion.sensor[1].lag_s, 1e-5);
  EXPECT_EQ(motion.sensor[1].rectification_per_mps2, 0.0);
  EXPECT_EQ(motion.sensor[1].scale, 0.02);
  EXPECT_EQ(motion.sensor[1].axis_rad, 0.03);
  EXPECT_EQ(motion.sensor[1].bias_mps2, 0.4);
  EXPECT_EQ(motion.sensor[0].bias_mps2, 0.01);
  const MotionSpec alone = array_of(changed("id = \"A2\"", "id = \"A2\"" + own)).motion;
  EXPECT_FALSE(alone.stated);
  EXPECT_TRUE(alone.mentioned) << "without [motion] these keys would have no effect, and somebody is to be told";
}

TEST(ArrayMotion, WhatIsNotStatedStaysOpen) {
  const MotionSpec motion = array_of(with_motion("[motion]\n")).motion;
  EXPECT_TRUE(motion.stated);
  EXPECT_FALSE(motion.sample_period_s.has_value());
  EXPECT_FALSE(motion.rate_bound_radps.has_value());
  EXPECT_FALSE(motion.sensor[0].lag_s.has_value());
  EXPECT_FALSE(motion.gyro.stated);
  EXPECT_EQ(motion.limits.dwell_s, MotionSetup().dwell_s);
}

TEST(ArrayMotion, RefusesEveryNumberBeyondItsRangeWithItsLine) {
  struct Case {
    const char *from, *to, *field;
  };
  const Case cases[] = {
      {"sample_period_s = 0.002", "sample_period_s = 2", "motion.sample_period_s"},
      {"sample_period_s = 0.002", "sample_period_s = 0", "motion.sample_period_s"},
      {"rate_bound_radps = 8", "rate_bound_radps = -8", "motion.rate_bound_radps"},
      {"force_bound_mps2 = 90", "force_bound_mps2 = 1e6", "motion.force_bound_mps2"},
      {"velocity_bound_mps = 0.3", "velocity_bound_mps = -1", "motion.velocity_bound_mps"},
      {"inclination_window_s = 6", "inclination_window_s = 700", "motion.inclination_window_s"},
      {"false_alarms_per_hour = 1e-2", "false_alarms_per_hour = 0", "motion.false_alarms_per_hour"},
      {"dwell_s = 0.05", "dwell_s = 11", "motion.dwell_s"},
      {"quiet_s = 4", "quiet_s = nan", "motion.quiet_s"},
      {"max_faults = 1", "max_faults = 5", "motion.max_faults"},
      {"shortest_block = 4", "shortest_block = 2049", "motion.shortest_block"},
      {"max_faults = 1", "max_faults = 0", "motion.max_faults"},
      {"lever_arm_bound_m = 0.001", "lever_arm_bound_m = 2", "motion.lever_arm_bound_m"},
      {"lag_bound_s = 70e-6", "lag_bound_s = 70", "motion.lag_bound_s"},
      {"vibration_rectification_per_mps2 = 2e-5", "vibration_rectification_per_mps2 = -1",
       "motion.vibration_rectification_per_mps2"},
      {"scale_bound = \"0.1 %\"", "scale_bound = \"60 %\"", "motion.scale_bound"},
      {"axis_bound_rad = 0.0015", "axis_bound_rad = 1", "motion.axis_bound_rad"},
      {"bias_bound_mps2 = 0.01", "bias_bound_mps2 = inf", "motion.bias_bound_mps2"},
      {"scale_bound = 0.01", "scale_bound = 1", "gyro.scale_bound"},
      {"axis_bound_rad = 0.012", "axis_bound_rad = -1", "gyro.axis_bound_rad"},
      {"bias_bound_radps = 0.006", "bias_bound_radps = 20", "gyro.bias_bound_radps"},
      {"noise_radps = 0.002", "noise_radps = 20", "gyro.noise_radps"},
      {"lag_bound_s = 2e-5", "lag_bound_s = 2", "gyro.lag_bound_s"},
  };
  for (const Case& one : cases) {
    const std::string text = changed(one.from, one.to, with_motion());
    expect_refused(text, line_of(text, one.to), one.field, {"out of range", "give "});
  }
}

TEST(ArrayMotion, RefusesBlocksThatAreNotMadeOfOneAnother) {
  const std::string blocks = "[1, 5, 40, 200]", text = with_motion();
  for (const char* spoilt : {"[5, 10, 40, 200]", "[1, 5, 42, 210]", "[1, 5, 40, 40]", "[1, 5, 40, 40000]",
                             "[1, 5, 40.0, 200]", "[1, 5, -40, 200]"}) {
    expect_refused(changed(blocks, spoilt, text), line_of(text, blocks), "motion.block_samples",
                   {"has a length that does not fit", "write four whole numbers, each a multiple of the one before"});
  }
  for (const char* spoilt : {"32", "[1, 5, 40]", "[]"})
    expect_refused(changed(blocks, spoilt, text), line_of(text, blocks), "motion.block_samples",
                   {"must be a list of four lengths"});
  expect_refused(changed("shortest_block = 4", "shortest_block = 41", text), line_of(text, "shortest_block"),
                 "motion.shortest_block", {"is 41, longer than the third of the blocks (40)", "give 1 to 40"});
}

TEST(ArrayMotion, RefusesWhatIsNoNumberOrNoKey) {
  const std::string text = with_motion();
  expect_refused(changed("lag_bound_s = 70e-6", "lag_bound_s = \"70 us\"", text), line_of(text, "lag_bound_s"),
                 "motion.lag_bound_s", {"is a string, must be a number", "write a number in s, without quotes"});
  expect_refused(changed("noise_radps = 0.002", "noise_radps = \"0.1 deg/s\"", text), line_of(text, "noise_radps"),
                 "gyro.noise_radps", {"must be a number", "in rad/s"});
  expect_refused(changed("scale_bound = \"0.1 %\"", "scale_bound = \"1 mg\"", text), line_of(text, "scale_bound"),
                 "motion.scale_bound", {});
  expect_refused(changed("max_faults = 1", "max_faults = 1.5", text), line_of(text, "max_faults"), "motion.max_faults",
                 {"must be a whole number"});
  expect_refused(changed("corroborated = true", "corroborated = 1", text), line_of(text, "corroborated"),
                 "gyro.corroborated", {"must be true or false"});
  expect_refused(changed("dwell_s", "dwel_s", text), line_of(text, "dwell_s"), "motion.dwel_s",
                 {"did you mean \"dwell_s\"?"});
  expect_refused(changed("noise_radps", "noise_dps", text), line_of(text, "noise_radps"), "gyro.noise_dps",
                 {"is not a known key"});
  expect_refused(changed("id = \"A3\"", "id = \"A3\"\nlag_bound_s = 3", text), line_of(text, "id = \"A3\"") + 1,
                 "sensor[3].lag_bound_s", {"out of range"});
}

TEST(ArrayMotion, AGyroNeedsItsColumns) {
  const std::string text = changed("rotation_radps = [\"wx\", \"wy\", \"wz\"]\n", "", with_motion());
  expect_refused(text, line_of(text, "[gyro]"), "gyro", {"names no columns", "rotation_radps = "});
}

TEST(ArrayMotion, AnUpgradeKeepsAllOfIt) {
  const std::string old = changed("window = 16", "window = 16\npatience = 5", with_motion());
  const auto now = upgrade_text(old, "array.toml");
  ASSERT_TRUE(now.has_value());
  EXPECT_NE(now->text.find("isolation_timeout = 5"), std::string::npos);
  EXPECT_NE(now->text.find(kMotion), std::string::npos);
  EXPECT_EQ(array_of(now->text).motion.gyro.noise_radps, 0.002);
}

TEST(MotionRecords, ARowHasACellForEveryColumn) {
  const auto cells = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  const ArrayFile file = array_of();
  MotionVerdict verdict;
  verdict.cause = MotionCause::irregular_time;
  std::string nothing, all;
  append_motion_row(nothing, 1.5, verdict, file.array, kIdentity3);
  EXPECT_EQ(nothing, "1.5,,,,,,none,,0,,,,,,,,0,,,,irregular_time,0\n");
  verdict.sample = {ForceValidity::bounded, 1.25, 0.001, {1.0, 2.0, 3.0}, {}, 0.5, ForceTerm::lever_arm, true, {}};
  verdict.block = {ForceValidity::unchecked, 1.0, 0.032, {4.0, 5.0, 6.0}, {}, 0.25, ForceTerm::lag, false, {}};
  verdict.block_ended = verdict.alarm = true;
  verdict.suspects = SensorSet::of(0).with(2);
  verdict.isolated = SensorSet::of(2);
  verdict.excluded = SensorSet::of(3);
  verdict.cause = MotionCause::none;
  append_motion_row(all, 1.5, verdict, file.array, {0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0});
  EXPECT_EQ(all, "1.5,1.25,2,1,3,0.5,bounded,lever arm,1,1,5,4,6,0.25,unchecked,lag,1,A1 A3,A3,A4,none,0\n");
  verdict.gyros_disagree = true;
  append_motion_row(all, 1.5, verdict, file.array, kIdentity3);
  EXPECT_EQ(all.substr(all.size() - 8), ",none,1\n");
  EXPECT_EQ(2 * cells(motion_csv_header()), cells(all));
  EXPECT_EQ(2 * cells(nothing), cells(all));
}

TEST(MotionRecords, AnEventIsOneLineOfJson) {
  std::string out;
  append_motion_event_json(out, {MotionEventKind::alarm, 2.5, SensorSet::of(0).with(1), MotionCause::parity, 1},
                           array_of().array);
  EXPECT_EQ(out, R"({"t_s":2.5,"motion":"alarm","sensors":["A1","A2"],"cause":"parity","least_faults":1})");
  for (const MotionEventKind kind : {MotionEventKind::alarm, MotionEventKind::isolated, MotionEventKind::excluded,
                                     MotionEventKind::alarm_over, MotionEventKind::forgotten})
    EXPECT_STRNE(to_string(kind), "?");
}

}  // namespace
}  // namespace array_motion_test
