// Chips with clocks of their own, from the array file through simulate, monitor, convert and incidents.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "motion_runner.hpp"
#include "support/simulated_tool.hpp"

namespace clocked_motion_test {
namespace {

using namespace plumb_test;
using namespace motion_runner;
using plumb::scaled;
using plumb::Vec3;
using Json = nlohmann::json;

const std::string kClocks = PLUMB_SOURCE_DIR "/examples/motion/drone_clocks.toml";

class Hangar : public Directory {
 public:
  explicit Hangar(const std::string& text = read_text(kClocks)) { write_text(*this / "array.toml", text); }
};

// Verifies: REQ-207
TEST(ClockedMotion, TheTwoCommandsOfTheExampleIsolateTheDeadChip) {
  const Directory where;
  const std::string out = play_examples(where, {"motion/drone_clocks.toml"});
  EXPECT_TRUE(says(out, {"x2 is stuck at 0 g0 from t = 3 s on", "(in motion)", "isolated", "x2, y2, z2", "excluded",
                         "samples judged, 1 alarm, the first at 3.0", "isolated  x2, y2, z2 (imu2) at 3.0",
                         "excluded  x2, y2, z2 (imu2) at 3.0", "provisionally"}))
      << out;
  EXPECT_EQ(out.find("isolated           x1"), std::string::npos);
}

// Verifies: REQ-207
TEST(ClockedMotion, HealthyFlightsRaiseNoAlarmAndNoNote) {
  const Hangar where;
  for (const char* seed : {"11", "12", "13"}) {
    ASSERT_EQ(fly(where, {"--seed", seed, "--duration", "4"}).code, 0);
    const Outcome told = monitor(where, {"--json", "--motion", "force.csv"});
    EXPECT_EQ(told.code, 0) << told.err;
    const Json motion = motion_of(told);
    EXPECT_EQ(motion["alarms"], 0) << seed;
    EXPECT_EQ(motion["isolated"].size(), 0U);
    EXPECT_EQ(motion["notes"].size(), 0U) << motion["notes"];
    EXPECT_GT(motion["samples_judged"].get<int>(), 3970) << "by common instants, a millisecond apart";
    const std::string force = read_text(where / "force.csv");
    EXPECT_EQ(std::count(force.begin(), force.end(), '\n'), motion["samples"].get<int>() + 1);
  }
}

// Negative: REQ-207
TEST(ClockedMotion, AClockThatIsOffBeyondItsBoundAccusesItsOwnChipAtMost) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--duration", "3"}).code, 0);
  write_text(where / "array.toml", with(read_text(kClocks), "offset_s = -0.0123", "offset_s = -0.0223"));
  const Json motion = motion_of(monitor(where, {"--json"}));
  EXPECT_EQ(motion["alarms"], 1) << "by 10 ms: the limits cover what is stated and no more";
  for (const Json& one : motion["isolated"]) EXPECT_EQ(one["id"].get<std::string>().back(), '2');
}

// Negative: REQ-207
TEST(ClockedMotion, AClockThatIsStatedWrongIsToldAndSaysWhatToDo) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--duration", "3"}).code, 0);
  const auto note_of = [&where](const std::string& from, const std::string& to) {
    write_text(where / "array.toml", with(read_text(kClocks), from, to));
    const Json notes = motion_of(monitor(where, {"--json"}))["notes"];
    return notes.empty() ? Json::object({{"code", "none"}, {"what", ""}, {"remedy", ""}}) : notes[0];
  };
  const Json period = note_of("sample_period_s = 0.0004", "sample_period_s = 0.0006");
  EXPECT_EQ(period["code"], "clock_period");
  EXPECT_EQ(period["what"], "samples of imu3 are 0.0004 s apart, and sample_period_s is 0.0006 s");
  EXPECT_EQ(period["remedy"], "set sample_period_s = 0.0004 in its [[clock]]");
  const Json valid = note_of("valid_s = 60", "valid_s = 2");
  EXPECT_EQ(valid["code"], "clock_not_valid");
  EXPECT_NE(valid["remedy"].get<std::string>().find("state offset_s and since_s of that time"), std::string::npos);
  const Json absent = note_of("offset_s = 4.25", "offset_s = 0");
  EXPECT_EQ(absent["code"], "clock_absent");
  EXPECT_NE(absent["what"].get<std::string>().find("-4.2"), std::string::npos) << absent;
  write_text(where / "array.toml", with(read_text(kClocks), "valid_s = 60", "valid_s = 2"));
  EXPECT_TRUE(
      says(monitor(where, {}).out, {"lie further than valid_s = 2 s from since_s = 0 s", "or a longer valid_s"}));
}

TEST(ClockedMotion, AULogAndAnIncidentKeepTheTimesOfTheChips) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--fault", "imu2:stuck=0g0@1s", "--duration", "2"}).code, 0);
  const Json plain = motion_of(monitor(where, {"--json", "--incidents", "found"}));
  ASSERT_EQ(run(where, {"convert", "--array", "array.toml", "--log", "flight.csv", "--out", "flight.ulg"}).code, 0);
  EXPECT_EQ(motion_of(monitor(where, {"--json"}, "flight.ulg")), plain);
  ASSERT_EQ(run(where, {"convert", "--array", "array.toml", "--log", "flight.ulg", "--out", "again.csv"}).code, 0);
  EXPECT_EQ(read_text(where / "again.csv"), read_text(where / "flight.csv"));
  ASSERT_EQ(run(where, {"inject", "--array", "array.toml", "--log", "flight.csv", "--out", "injected.csv", "--fault",
                        "x3:bias=1g0@1.5s"})
                .code,
            0);
  EXPECT_EQ(read_text(where / "injected.csv").substr(0, 200), read_text(where / "flight.csv").substr(0, 200));
  const Json again = motion_of(monitor(where, {"--json"}, "found/incident-0001.csv"));
  EXPECT_EQ(again["isolated"].size(), 3U);
  EXPECT_EQ(again["isolated"][0]["id"], "x2");
}

/// At rest, in an attitude after another. A row for every sample of imu3 at 2.5 kHz, which repeats those of the others
/// at 500 Hz: as if each were new, some of the blocks would raise an alarm.
std::string repeating_log(double duration_s) {
  Noise noise(6);
  std::string out = "t_s,t1_s,t2_s,t3_s,wx,wy,wz,ux,uy,uz,x1,y1,z1,x2,y2,z2,x3,y3,z3\n";
  std::array<double, 9> reading{};
  Vec3 force{};
  for (int row = 0; row < static_cast<int>(2500.0 * duration_s); ++row) {
    const double time_s = 0.0004 * row, sampled_s = 0.0004 * (row - row % 5);
    if (row % 1000 == 0) force = scaled(random_direction(noise), 9.81733);
    for (std::size_t i = row % 5 == 0 ? 0 : 6; i < 9; ++i) reading[i] = force[i % 3] + 0.02 * noise.normal();
    out += fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},0.1,0,0,0.1,0,0", time_s, sampled_s, sampled_s, time_s);
    for (const double y : reading) out += fmt::format(",{:.5f}", y);
    out += '\n';
  }
  return out;
}

// Negative: REQ-207
TEST(ClockedMotion, RowsThatRepeatASampleRaiseNoAlarmAtRest) {
  std::string text = read_text(kClocks);
  for (const auto& [from, to] :
       {std::pair("sample_period_s = 0.0005", "sample_period_s = 0.002"),
        std::pair("offset_s = -0.0123", "offset_s = 0"), std::pair("offset_s = 4.25", "offset_s = 0"),
        std::pair("since_s = 4.25", "since_s = 0"), std::pair("30e-6", "0"), std::pair("-12e-6", "0")}) {
    while (text.find(from) != std::string::npos) text = with(text, from, to);
  }
  const Hangar where(text);
  write_text(where / "rest.csv", repeating_log(30.0));
  const Outcome outcome = monitor(where, {"--events", "events.jsonl"}, "rest.csv");
  EXPECT_TRUE(says(outcome.out, {"new calibration accepted", "nominal", "excluded    -"}))
      << outcome.out << outcome.err;
  EXPECT_EQ(outcome.out.find("disagree with one another"), std::string::npos) << outcome.out;
}

TEST(ClockedMotion, WhatCannotBeDoneWithClocksIsRefused) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--duration", "1"}).code, 0);
  write_text(where / "array.toml", with(read_text(kClocks), "time = \"t3_s\"", "time = \"t4_s\""));
  const Outcome column = monitor(where, {});
  EXPECT_EQ(column.code, 3);
  EXPECT_TRUE(says(column.err, {"t4_s: the column is missing in the log; clock[3].time in the array file names it"}));
  write_text(where / "array.toml", with(read_text(kClocks), "package = \"imu3\"\ntime", "package = \"imu4\"\ntime"));
  const Outcome chip = monitor(where, {});
  EXPECT_EQ(chip.code, 3);
  EXPECT_TRUE(says(chip.err, {"clock[3].package: \"imu4\" is the package of no sensor", "imu1, imu2, imu3"}));
}

}  // namespace
}  // namespace clocked_motion_test
