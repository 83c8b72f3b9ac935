// plumb review: from a log of another program to an answer and an exit code.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "logs/ulog_bytes.hpp"
#include "support/recording.hpp"
#include "tool_runner.hpp"

namespace review_command_test {
namespace {

using namespace plumb_test;

/// Three accelerometers of PX4, 40 s at 50 Hz, the first half at rest; chip `bad` reads `error` too much along x.
std::string flight(int bad = -1, double error = 0.0) {
  using namespace ulog_bytes;
  std::string out =
      header(0) + flags() + format("sensor_accel:uint64_t timestamp;uint32_t device_id;float x;float y;float z;");
  for (int chip = 0; chip < 3; ++chip) out += subscription(chip, chip, "sensor_accel");
  unsigned noise = 1;
  const auto next = [&noise] {
    noise = noise * 1664525U + 1013904223U;
    return static_cast<double>(noise >> 16U) / 65536.0 - 0.5;
  };
  for (int k = 0; k < 2000; ++k) {
    const double motion = k < 1000 ? 0.0 : 1.0;
    for (int chip = 0; chip < 3; ++chip) {
      const double x = (chip == bad ? error : 0.0) + 0.05 * next() + motion * std::sin(0.05 * k);
      const double y = 0.05 * next() + motion * next();
      const double z = -9.81 + 0.05 * next();
      out += data(chip, u64(static_cast<std::uint64_t>(k) * 20000U) + u32(static_cast<std::uint64_t>(501 + chip)) +
                            f32(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)));
    }
  }
  return out;
}

nlohmann::json review_of(const Workshop& where, const std::vector<std::string>& arguments, int code) {
  std::vector<std::string> all = {"review", "--json"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Outcome outcome = run(where, all);
  EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

TEST(ReviewCommand, ThreeThatAgreeAreGreen) {
  const Workshop where;
  where.put("sound.ulg", flight());
  const Outcome outcome = run(where, {"review", "sound.ulg"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"sound.ulg: GREEN", "All 3 accelerometers read gravity at rest and agree",
                                 "sensor_accel[2]", "503"}));
}

TEST(ReviewCommand, TheOneThatDisagreesIsNamedWithFigureLimitPlaceAndRemedy) {
  const Workshop where;
  where.put("bad.ulg", flight(1, 1.5));
  const nlohmann::json found = review_of(where, {"bad.ulg"}, 9);
  const nlohmann::json& worst = found["logs"][0]["findings"][0];
  EXPECT_EQ(worst["code"], "disagreement");
  EXPECT_EQ(worst["chip"], "sensor_accel[1]");
  EXPECT_TRUE(worst["one_of"].is_null());
  EXPECT_NEAR(worst["figure"].get<double>(), 1.5, 0.05);
  EXPECT_DOUBLE_EQ(worst["limit"].get<double>(), 0.35);
  EXPECT_LT(worst["to_s"].get<double>(), 21.0);
  EXPECT_NE(worst["to_do"], "");
  EXPECT_TRUE(
      says(run(where, {"review", "bad.ulg"}).out, {"bad.ulg: RED", "sensor_accel[1] differs by 1.5", "To do: "}));
}

TEST(ReviewCommand, HalfOfWhatForbidsArmingIsOrange) {
  const Workshop where;
  where.put("bad.ulg", flight(2, 0.5));
  EXPECT_EQ(review_of(where, {"bad.ulg"}, 8)["logs"][0]["grade"], "ORANGE");
}

TEST(ReviewCommand, ManyLogsAreATableAndTheWorstDecidesTheCode) {
  const Workshop where;
  where.put("one.ulg", flight());
  where.put("two.ulg", flight(0, 2.0));
  where.put("text.ulg", "\x1b[2Jno log\n\x01");
  const Outcome outcome = run(where, {"review", "one.ulg", "two.ulg", "text.ulg", "absent.ulg", "--html", "page.html"});
  EXPECT_EQ(outcome.code, 9);
  EXPECT_TRUE(
      says(outcome.out, {"one.ulg", "GREEN", "RED", "NOT READ", "The same accelerometer in several logs", "501"}));
  EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos);
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos);
  const std::string page = where.text("page.html");
  EXPECT_TRUE(says(page, {"<!DOCTYPE html>", "one.ulg", "sensor_accel[0]", "NOT READ", "What this log cannot tell"}));
  EXPECT_EQ(review_of(where, {"one.ulg", "absent.ulg"}, 3)["not_read"].size(), 1U);
}

// Of many logs of one accelerometer the figures stay on a line that can be read.
TEST(ReviewCommand, ManyLogsOfOneAccelerometerAreToldByFirstLastAndFurthest) {
  const Workshop where;
  std::vector<std::string> arguments = {"review"};
  for (int k = 0; k < 30; ++k) {
    const std::string name = "log" + std::to_string(k) + ".ulg";
    where.put(name.c_str(), flight(0, k == 17 ? 3.0 : 0.0));
    arguments.push_back(name);
  }
  const Outcome outcome = run(where, arguments);
  EXPECT_EQ(outcome.code, 9);
  const std::size_t table = outcome.out.find("The same accelerometer in several logs");
  ASSERT_NE(table, std::string::npos) << outcome.out;
  std::istringstream lines(outcome.out.substr(table));
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line) && line.find("log17.ulg: RED") == std::string::npos;) {
    EXPECT_LT(line.size(), 119U) << line;
    rows += line.find("  30 ") != std::string::npos ? 1U : 0U;
  }
  EXPECT_EQ(rows, 3U) << outcome.out;
  EXPECT_TRUE(says(outcome.out, {"first +0.01", "last +0.01", "furthest +0.4", "in log17.ulg"})) << outcome.out;
}

// A chip that the pilot has switched off is said, and is no warning by itself.
TEST(ReviewCommand, AChipSwitchedOffIsSaidAndGreen) {
  const Workshop where;
  using namespace ulog_bytes;
  const std::string log = flight();
  const std::size_t head = (header(0) + flags()).size();
  std::string parameters;
  for (int k = 0; k < 3; ++k) {
    const std::string prefix = "CAL_ACC" + std::to_string(k) + "_";
    parameters += parameter("int32_t " + prefix + "ID", u32(static_cast<std::uint64_t>(501 + k))) +
                  parameter("int32_t " + prefix + "PRIO", u32(k == 1 ? 0 : 50)) +
                  parameter("float " + prefix + "XOFF", f32(0.01F));
  }
  where.put("off.ulg", log.substr(0, head) + parameters + log.substr(head));
  const Outcome outcome = run(where, {"review", "off.ulg"});
  EXPECT_EQ(outcome.code, 0) << outcome.out;
  EXPECT_TRUE(says(outcome.out, {"off.ulg: GREEN", "read gravity at rest and agree. Switched off in the autopilot: 1.",
                                 "applied here; switched off", "GREEN   sensor_accel[1] is switched off"}))
      << outcome.out;
  const nlohmann::json found = review_of(where, {"off.ulg"}, 0);
  EXPECT_EQ(found["logs"][0]["findings"][0]["code"], "disabled");
  EXPECT_EQ(found["logs"][0]["findings"][0]["grade"], "GREEN");
  EXPECT_EQ(found["logs"][0]["chips"][1]["disabled"], true);
  EXPECT_EQ(found["logs"][0]["chips"][0]["disabled"], false);
}

// Where nothing is at rest and there is one chip, nothing was judged, and that is not green.
TEST(ReviewCommand, NothingJudgedIsNotGreen) {
  const Workshop where;
  using namespace ulog_bytes;
  where.put("empty.ulg", header(0) + flags());
  const Outcome outcome = run(where, {"review", "empty.ulg"});
  EXPECT_EQ(outcome.code, 7);
  EXPECT_TRUE(says(outcome.out, {"NOT JUDGED", "No accelerometer in this log"}));
}

TEST(ReviewCommand, ALogThatIsCutShortIsJudgedByWhatIsThere) {
  const Workshop where;
  const std::string whole = flight(1, 1.5);
  where.put("cut.ulg", whole.substr(0, whole.size() * 3 / 4 + 11));
  const nlohmann::json found = review_of(where, {"cut.ulg"}, 9);
  EXPECT_EQ(found["logs"][0]["findings"][0]["chip"], "sensor_accel[1]");
  EXPECT_GE(found["logs"][0]["notes"].size(), 1U);
}

// What is found out of a table is said, and what is stated of it goes instead.
TEST(ReviewCommand, ATableIsReadAsItIsStated) {
  const Workshop where;
  std::string bare, with_names = "n;ax;ay;az\n";
  for (int k = 0; k < 600; ++k) {
    const std::string noise = "0," + std::to_string(10 + k % 3);
    bare += std::to_string(10 * k) + ";" + noise + ";" + noise + ";-9" + noise.substr(1) + "\n";
    with_names += "7;" + noise + ";" + noise + ";-9" + noise.substr(1) + "\n";
  }
  where.put("bare.csv", bare);
  where.put("names.csv", with_names);
  EXPECT_TRUE(says(run(where, {"review", "bare.csv"}).err, {"has no header"}));
  const Outcome stated = run(where, {"review", "bare.csv", "--table-header", "t,ax,ay,az", "--table-time", "ms"});
  EXPECT_TRUE(says(stated.out, {"decimal comma", "Log: 6.0 s", "100 Hz"})) << stated.out << stated.err;
  EXPECT_EQ(run(where, {"review", "names.csv"}).code, 3) << "it has no time";
  const Outcome timed = run(where, {"review", "names.csv", "--table-rate", "50 Hz"});
  EXPECT_TRUE(says(timed.out, {"Log: 12.0 s", "50 Hz"})) << timed.out << timed.err;
  const nlohmann::json in_g = review_of(where, {"names.csv", "--table-rate", "50 Hz", "--table-unit", "mg"}, 9);
  EXPECT_EQ(in_g["logs"][0]["findings"][0]["code"], "gravity_length");
  const Outcome imported =
      run(where, {"import", "bare.csv", "--out", "made", "--table-header", "t,ax,ay,az", "--table-time", "ms"});
  EXPECT_EQ(imported.code, 0) << imported.err;
  EXPECT_TRUE(says(where.text("made/log.csv"), {"t_s,x0,y0,z0"}));
  for (const char* wrong : {"g", "furlong"})
    EXPECT_EQ(run(where, {"review", "names.csv", "--table-unit", wrong}).code, 2) << wrong;
  EXPECT_EQ(run(where, {"review", "names.csv", "--table-rate", "0 Hz"}).code, 2);
  EXPECT_EQ(run(where, {"review", "names.csv", "--table-header", "t"}).code, 2);
}

TEST(ReviewCommand, OptionsThatCannotBeAreRefused) {
  const Workshop where;
  where.put("sound.ulg", flight());
  EXPECT_EQ(run(where, {"review"}).code, 2);
  const Outcome gravity = run(where, {"review", "sound.ulg", "--gravity", "9.81"});
  EXPECT_EQ(gravity.code, 2);
  EXPECT_TRUE(says(gravity.err, {"--gravity", "Remedy"}));
  EXPECT_EQ(run(where, {"review", "sound.ulg", "--gravity", "-1 m/s^2"}).code, 2);
  EXPECT_EQ(run(where, {"review", "sound.ulg", "--html", "sound.ulg"}).code, 2);
  EXPECT_EQ(run(where, {"review", "sound.ulg", "--html", "no/such/place.html"}).code, 1);
}

TEST(ReviewCommand, RealLogsOfAutopilotsAreGreen) {
  const std::vector<std::pair<std::string, std::size_t>> logs = {
      {"sample_log_small.ulg", 3}, {"sample_px4_events.ulg", 1}, {"sample_appended_multiple.ulg", 1}};
  for (const auto& [name, chips] : logs) {
    const std::string path = recording_path("logs/" + name);
    if (!std::filesystem::exists(path))
      GTEST_SKIP() << "recording not found: " << path << " (set PLUMB_DATA_DIR to the directory that holds it)";
    const Workshop where;
    const nlohmann::json found = review_of(where, {path}, 0);
    EXPECT_EQ(found["logs"][0]["chips"].size(), chips) << name;
    EXPECT_EQ(found["logs"][0]["bytes_read"], found["logs"][0]["bytes"]) << name;
    EXPECT_GT(found["logs"][0]["at_rest_s"].get<double>(), 2.9) << name;
  }
}

}  // namespace
}  // namespace review_command_test
