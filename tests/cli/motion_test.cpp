// plumb simulate --flight, then plumb monitor with motion in the array file.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "motion_runner.hpp"

namespace cli_motion_test {
namespace {

using namespace plumb_test;
using namespace motion_runner;
using Json = nlohmann::json;

const std::string kDrone = PLUMB_SOURCE_DIR "/examples/motion/drone.toml";

/// By its header, one map a row.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& csv) {
  std::istringstream in(csv);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> out(1);
    for (const char c : line) {
      if (c == ',') out.emplace_back();
      if (c != ',') out.back() += c;
    }
    return out;
  };
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = cells(line);
  std::vector<std::map<std::string, std::string>> out;
  while (std::getline(in, line)) {
    const std::vector<std::string> row = cells(line);
    EXPECT_EQ(row.size(), names.size()) << line;
    out.emplace_back();
    for (std::size_t k = 0; k < names.size() && k < row.size(); ++k) out.back()[names[k]] = row[k];
  }
  return out;
}

/// A directory with the drone's array file, changed or not.
class Hangar : public Directory {
 public:
  explicit Hangar(const std::string& text = read_text(kDrone)) { write_text(*this / "array.toml", text); }
};

TEST(MotionCommand, TheTwoCommandsOfTheExampleIsolateTheDeadChip) {
  const Directory where;
  const std::string out = play_examples(where, {"motion/drone.toml"});
  EXPECT_TRUE(says(out, {"x2 is stuck at 0 g0 from t = 3 s on", "(in motion)", "isolated", "x2, y2, z2", "excluded",
                         "in motion   9998 of 10000 samples judged, 1 alarm, the first at 3.00",
                         "isolated  x2, y2, z2 (imu2) at 3.0", "excluded  x2, y2, z2 (imu2) at 3.0", "provisionally",
                         "force     of 311 blocks: bound of the error"}));
  EXPECT_EQ(out.find("isolated           x1"), std::string::npos);
  EXPECT_TRUE(says(out, {"blocks in motion: 312 of 312"})) << "a dead chip is quiet, and two that move are believed";
  EXPECT_EQ(out.find("check cable"), std::string::npos) << "not that six sound sensors are noisy";
  EXPECT_TRUE(says(read_text(where / "err"), {"motion was judged by the nominal coefficients"}));
  EXPECT_EQ(rows_of(read_text(where / "force.csv")).size(), 10000U);
}

TEST(MotionCommand, AGyroThatNothingCorroboratesIsOneMoreSuspect) {
  const Hangar where(with(read_text(kDrone), "second_rotation_radps = [\"ux\", \"uy\", \"uz\"]\n", ""));
  ASSERT_EQ(fly(where, {"--fault", "imu2:stuck=0g0@3s"}).code, 0);
  const Json motion = motion_of(monitor(where, {"--json"}));
  EXPECT_EQ(motion["alarms"], 1);
  ASSERT_EQ(motion["isolated"].size(), 3U);
  EXPECT_EQ(motion["isolated"][0]["id"], "x2");
  EXPECT_NEAR(motion["isolated"][0]["t_s"].get<double>(), 3.33, 0.05) << "it was 3.001 s";
}

// A gyro chip is dead from the moment on at which an accelerometer chip reads too much: both are named.
// Verifies: REQ-243
TEST(MotionCommand, AGroupOfGyrosGivesTheRateAndAFaultyChipOfItHidesNobody) {
  const Directory where;
  const std::string out = play_examples(where, {"motion/three_gyros.toml"});
  EXPECT_TRUE(says(out, {"gx2 is stuck", "in motion   9998 of 10000 samples judged, 1 alarm, the first at 3.0",
                         "isolated  x1, y1, z1 (imu1) at 3.0", "rate      the median of the group of gyros",
                         "excluded    gx2, gy2, gz2"}))
      << out;
  EXPECT_EQ(out.find("isolated           x2"), std::string::npos);
  EXPECT_EQ(out.find("it holds only while the gyro is healthy"), std::string::npos);
  const std::string text = read_text(PLUMB_SOURCE_DIR "/examples/motion/three_gyros.toml");
  write_text(where / "array.toml", text);
  const Outcome alone = monitor(where, {});
  EXPECT_TRUE(says(alone.err, {"gyro.group", "motion is not judged", "--group gyros"})) << alone.err;
  const Outcome asked = monitor(where, {"--motion", "force2.csv"});
  EXPECT_NE(asked.code, 0);
  EXPECT_TRUE(says(asked.err, {"--motion asks for its results"})) << asked.err;
}

TEST(MotionCommand, ACalibratedArrayIsJudgedAsWell) {
  const Directory where;
  const std::string out = play_examples(where, {"motion/stand.toml"});
  EXPECT_TRUE(says(out, {"accepted", "written: flight.csv", "in motion   9998 of 10000 samples judged, 1 alarm",
                         "isolated  x2, y2, z2 (imu2) at 3.0"}));
  EXPECT_TRUE(says(out, {"parity_in_motion   x2, y2, z2", "0 blocks at rest", "provisional x2, y2, z2"}))
      << "a dead chip is quiet, and no witness of rest";
}

TEST(MotionCommand, HealthyFlightsRaiseNoAlarm) {
  const Hangar where;
  for (const char* kind : {"drone", "drilling", "car", "launch"}) {
    // Their own largest rates.
    const std::string rate = std::string(kind) == "drilling" ? "25" : "8";
    write_text(where / "array.toml", with(read_text(kDrone), "rate_bound_radps = 8", "rate_bound_radps = " + rate));
    for (const char* seed : {"11", "12"}) {
      const Outcome flown = run(where, {"simulate", "--flight", kind, "array.toml", "--out", "flight.csv", "--seed",
                                        seed, "--duration", "4"});
      EXPECT_EQ(flown.code, 0) << flown.err;
      const Outcome told = monitor(where, {"--json"});
      EXPECT_EQ(told.code, 0) << told.err;
      const Json motion = motion_of(told);
      EXPECT_EQ(motion["alarms"], 0) << kind << seed;
      EXPECT_EQ(motion["isolated"].size(), 0U);
      EXPECT_EQ(motion["cause"], "none");
      EXPECT_EQ(motion["notes"].size(), 0U) << motion["notes"];
      EXPECT_EQ(told.out.find("\"motion\":\"alarm\""), std::string::npos);
    }
  }
}

TEST(MotionCommand, SummaryEventsAndRowsSayTheSame) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--fault", "imu3:bias=0.2g0@2s", "--duration", "4", "--seed", "5"}).code, 0);
  const Outcome told = monitor(where, {"--json", "--motion", "force.csv", "--events", "events.jsonl"});
  EXPECT_EQ(told.code, 0) << told.err;
  const Json motion = motion_of(told);
  EXPECT_EQ(motion["judged"], true);
  EXPECT_EQ(motion["samples"], 4000);
  EXPECT_EQ(motion["alarms"], 1);
  ASSERT_EQ(motion["isolated"].size(), 3U);
  EXPECT_EQ(motion["isolated"][0]["id"], "x3");
  EXPECT_NEAR(motion["isolated"][0]["t_s"].get<double>(), 2.02, 0.03);
  EXPECT_EQ(motion["excluded"].size(), 3U);
  EXPECT_GT(motion["bound_worst_mps2"].get<double>(), motion["bound_mean_mps2"].get<double>());
  std::vector<std::string> kinds;
  std::istringstream events(read_text(where / "events.jsonl"));
  for (std::string line; std::getline(events, line);) {
    const Json event = Json::parse(line);
    if (!event.contains("motion")) continue;
    kinds.push_back(event["motion"]);
    if (event["motion"] == "isolated") {
      EXPECT_EQ(event["sensors"], (Json{"x3", "y3", "z3"}));
      EXPECT_EQ(event["t_s"], motion["isolated"][0]["t_s"]);
    }
  }
  EXPECT_EQ(kinds, (std::vector<std::string>{"alarm", "isolated", "excluded", "alarm_over"}));
  const auto rows = rows_of(read_text(where / "force.csv"));
  ASSERT_EQ(rows.size(), 4000U);
  EXPECT_EQ(rows[0].at("cause"), "irregular_time");
  EXPECT_EQ(rows[1500].at("excluded"), "");
  EXPECT_EQ(rows[3999].at("excluded"), "x3 y3 z3");
}

TEST(MotionCommand, TheForceIsWithinItsBoundOfTheTruth) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--truth", "truth.csv", "--fault", "imu2:stuck=0g0@1s", "--duration", "3", "--seed", "8"}).code,
            0);
  ASSERT_EQ(monitor(where, {"--motion", "force.csv"}).code, 0);
  const auto truth = rows_of(read_text(where / "truth.csv"));
  const auto rows = rows_of(read_text(where / "force.csv"));
  ASSERT_EQ(truth.size(), rows.size());
  int bounded = 0;
  for (std::size_t k = 3; k < rows.size(); ++k) {
    if (rows[k].at("validity") != "bounded") continue;
    ++bounded;
    double squares = 0.0;
    for (const char* part : {"fx_mps2", "fy_mps2", "fz_mps2"}) {  // the mean of two samples, the newest but one at most
      const double mean = 0.5 * (std::stod(truth[k - 1].at(part)) + std::stod(truth[k - 2].at(part)));
      squares += std::pow(std::stod(rows[k].at(part)) - mean, 2);
    }
    EXPECT_LE(std::sqrt(squares), std::stod(rows[k].at("bound_mps2"))) << k;
  }
  EXPECT_GT(bounded, 2900);
  EXPECT_EQ(truth[2000].at("faulty"), "x2 y2 z2");
}

TEST(MotionCommand, WithoutMotionInTheFileNothingChanges) {
  const Workshop where;
  const std::vector<std::string> arguments = {"monitor",          "--array", "array.toml",  "--calibration",
                                              "calibration.json", "--log",   "drilling.csv"};
  const Outcome text = run(where, arguments);
  EXPECT_EQ(text.out.find("in motion)"), std::string::npos);
  EXPECT_EQ(text.out.find("in motion   "), std::string::npos);
  std::vector<std::string> json = arguments;
  json.emplace_back("--json");
  EXPECT_EQ(motion_of(run(where, json)), Json());
  // Motion that cannot be judged says so, and what rest says stays the same byte for byte.
  where.put("array.toml", with(where.text("array.toml"), "[input]", "[motion]\nsample_period_s = 0.01\n[input]"));
  const Outcome mentioned = run(where, arguments);
  EXPECT_EQ(mentioned.code, text.code);
  EXPECT_EQ(mentioned.out.substr(0, text.out.size()), text.out);
  EXPECT_TRUE(says(mentioned.out.substr(text.out.size()),
                   {"in motion   not judged: sensor[1].lever_arm_m is missing, and so are motion.lever_arm_bound_m"}));
  EXPECT_TRUE(says(mentioned.err,
                   {"array.toml: sensor[1].lever_arm_m: is missing", "motion is not judged", "Remedy: state it"}));
  const Json motion = motion_of(run(where, json));
  EXPECT_EQ(motion["judged"], false);
  EXPECT_EQ(motion["field"], "sensor[1].lever_arm_m");
}

TEST(MotionCommand, AHealthyFlightLeavesWhatRestSaysAlone) {
  const Hangar judged;
  ASSERT_EQ(fly(judged, {"--duration", "3"}).code, 0);
  const Outcome with_it = monitor(judged, {"--verdicts", "with.jsonl", "--every-sample"});
  std::string plain = read_text(kDrone);
  const std::size_t from = plain.find("\n[motion]");
  plain.erase(from, plain.find("\n[[sensor]]") - from);
  write_text(judged / "array.toml", plain);
  const Outcome without_it = monitor(judged, {"--verdicts", "without.jsonl", "--every-sample"});
  EXPECT_EQ(with_it.code, 0);
  EXPECT_EQ(without_it.code, 4);
  EXPECT_EQ(read_text(judged / "with.jsonl"), read_text(judged / "without.jsonl"));
  EXPECT_GT(read_text(judged / "with.jsonl").size(), 100000U);
}

TEST(MotionCommand, SaysWhatIsWrongWithTheGyro) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--duration", "3"}).code, 0);
  // The same flight with deg/s in the columns of the rate.
  std::istringstream in(read_text(where / "flight.csv"));
  std::string line, out;
  for (int k = 0; std::getline(in, line); ++k) {
    std::istringstream cells(line);
    std::string cell, row;
    for (int c = 0; std::getline(cells, cell, ','); ++c) {
      if (k > 0 && c >= 1 && c <= 3) cell = std::to_string(std::stod(cell) * 57.29577951);
      row += (c > 0 ? "," : "") + cell;
    }
    out += row + "\n";
  }
  write_text(where / "flight.csv", out);
  const Outcome told = monitor(where, {});
  EXPECT_TRUE(says(told.out, {"note      the rate of the first gyro reaches", "beyond rate_bound_radps = 8 rad/s",
                              "taken as deg/s", "the columns seem to hold deg/s", "Remedy: write rad/s"}))
      << told.err;
}

TEST(MotionCommand, AULogHoldsBothGyros) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--duration", "1"}).code, 0);
  ASSERT_EQ(monitor(where, {"--motion", "text.csv"}).code, 0);
  ASSERT_EQ(run(where, {"convert", "--array", "array.toml", "--log", "flight.csv", "--out", "flight.ulg"}).code, 0);
  ASSERT_EQ(run(where, {"convert", "--array", "array.toml", "--log", "flight.ulg", "--out", "flight.csv"}).code, 0);
  ASSERT_EQ(monitor(where, {"--motion", "ulog.csv"}).code, 0);
  EXPECT_EQ(read_text(where / "ulog.csv"), read_text(where / "text.csv"));
  EXPECT_TRUE(says(line_of(read_text(where / "flight.csv"), 1), {"wx", "wy", "wz", "ux", "uy", "uz", "x1"}));
}

TEST(MotionCommand, AChipMayFailInARecordedLogToo) {
  const Hangar where;
  const std::vector<std::string> fault = {"--fault", "imu2:bias=0.3g0@0.5s"};
  ASSERT_EQ(fly(where, {"--duration", "1", fault[0], fault[1]}).code, 0);
  const std::string flown = read_text(where / "flight.csv");
  ASSERT_EQ(fly(where, {"--duration", "1"}).code, 0);
  EXPECT_NE(read_text(where / "flight.csv"), flown);
  const Outcome injected =
      run(where, {"inject", "--array", "array.toml", "--log", "flight.csv", "--out", "broken.csv", fault[0], fault[1]});
  EXPECT_EQ(injected.code, 0) << injected.err;
  EXPECT_TRUE(says(injected.out, {"x2 reads", "y2 reads", "z2 reads"}));
  EXPECT_EQ(read_text(where / "broken.csv"), flown);
}

TEST(MotionCommand, AnIncidentIsALogOfItsOwn) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--duration", "5", "--fault", "imu2:stuck=0g0@3s"}).code, 0);
  const Outcome first = monitor(where, {"--incidents", "incidents", "--incident-rows", "400"});
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_TRUE(says(first.out, {"incidents   1 recorded in incidents"})) << first.out;
  const Outcome again = monitor(where, {"--incidents", "incidents"});
  EXPECT_EQ(again.code, 2);
  EXPECT_TRUE(says(again.err, {"--incidents", "another run"}));
  EXPECT_EQ(monitor(where, {"--incidents", "more", "--limits"}).code, 2);
  std::filesystem::copy_file(where / "incidents/incident-0001.csv", where / "flight.csv",
                             std::filesystem::copy_options::overwrite_existing);
  const Json motion = motion_of(monitor(where, {"--json"}));
  EXPECT_EQ(motion["isolated"].size(), 3U) << motion.dump();
  EXPECT_EQ(motion["samples"], 400 + 1 + 65 + 400) << "400 rows before the alarm, to 400 after it was over";
}

/// The axis of a drill string that rotates stands still: all windows share an inclination. With a velocity that is said
/// not to change they do not, so they can fail to. In the housing the alignment of the axes is in the interval too.
// Verifies: REQ-211
TEST(MotionCommand, ADrillStringHasItsInclinationWhileItRotates) {
  const Hangar where;
  const auto drill = [&where](const std::string& velocity, const std::string& frame) {
    const std::string keys = "[monitor]\nalert_frame = \"" + frame + "\"\n[motion]\nvelocity_bound_mps = " + velocity +
                             "\ninclination_window_s = 2\n";
    write_text(where / "array.toml",
               with(with(read_text(kDrone), "[motion]\n", keys), "rate_bound_radps = 8", "rate_bound_radps = 25"));
    const std::vector<std::string> play = {"simulate", "--flight",   "drilling", "array.toml",
                                           "--out",    "flight.csv", "--seed",   "4"};
    EXPECT_EQ(run(where, play).code, 0);
    return monitor(where, {"--json", "--inclination", "inclination.csv"});
  };
  const auto common = [&where](std::size_t windows) {
    const auto rows = rows_of(read_text(where / "inclination.csv"));
    EXPECT_EQ(rows.size(), windows);
    double low_deg = 0.0, high_deg = 180.0;
    for (const auto& row : rows) {
      EXPECT_EQ(row.at("status"), "known");
      low_deg = std::max(low_deg, std::stod(row.at("low_deg")));
      high_deg = std::min(high_deg, std::stod(row.at("high_deg")));
    }
    return low_deg <= high_deg;
  };
  const Json told = motion_of(drill("2", "calibrated-axes"))["inclination"];
  EXPECT_TRUE(common(5));
  EXPECT_EQ(told["windows"], 5);
  EXPECT_EQ(told["breaks"], 0);
  EXPECT_TRUE(told["last_break"].is_null());
  EXPECT_EQ(told["last"]["inclination_deg"].get<double>(),
            std::stod(rows_of(read_text(where / "inclination.csv")).back().at("inclination_deg")));
  EXPECT_LT(told["last"]["low_deg"], told["last"]["high_deg"]);
  const Json housed = motion_of(drill("2", "housing"))["inclination"]["last"];
  EXPECT_EQ(housed["inclination_deg"], told["last"]["inclination_deg"]);
  EXPECT_GT(housed["high_deg"].get<double>(), told["last"]["high_deg"].get<double>() + 4.0);
  EXPECT_LE(housed["low_deg"].get<double>(), std::max(told["last"]["low_deg"].get<double>() - 4.0, 0.0));
  (void)drill("0", "calibrated-axes");
  EXPECT_FALSE(common(5));
  EXPECT_TRUE(says(monitor(where, {}).out, {"inclined", "5 windows", "widest part: force"}));
}

TEST(MotionCommand, RefusesOptionsThatMakeNoSense) {
  const Hangar where;
  const auto refused = [&where](const std::vector<std::string>& arguments, int code,
                                const std::vector<std::string>& words) {
    const Outcome outcome = run(where, arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_TRUE(says(outcome.err, words));
  };
  refused({"simulate", "--flight", "kite", "array.toml"}, 2, {"\"kite\" is no flight", "drone, drilling, car, launch"});
  refused({"simulate", "--flight", "drone", "array.toml", "--duration", "-1"}, 2, {"is no duration"});
  refused({"simulate", "--flight", "drone", "array.toml", "--array-out", "a.toml"}, 2,
          {"--array-out", "array file already"});
  refused({"simulate", "--flight", "drone", "array.toml", "--fault", "imu9:stuck=0g0@1s"}, 2, {"--fault", "imu9"});
  refused({"simulate", "scenario.toml", "--fault", "x1:stuck=0g0@1s"}, 2, {"--fault", "belongs to --flight"});
  refused({"simulate", "scenario.toml", "--duration", "3"}, 2, {"--duration", "belongs to --flight"});
  refused({"simulate", "--flight", "drone", "array.toml", "--out", "array.toml"}, 2, {"would be overwritten"});
  ASSERT_EQ(fly(where, {"--duration", "1", "--fault", "x1:stuck=0g0@5s"}).code, 0);
  write_text(where / "array.toml", with(read_text(kDrone), "lag_bound_s = 70e-6", ""));
  refused({"monitor", "--array", "array.toml", "--calibrate-first", "--log", "flight.csv", "--motion", "m.csv"}, 3,
          {"motion.lag_bound_s", "motion is not judged, and --motion asks for its results"});
  refused({"monitor", "--array", PLUMB_SOURCE_DIR "/examples/paper_tool.toml", "--calibrate-first", "--log",
           "flight.csv", "--motion", "m.csv"},
          3, {"motion: is missing", "add [motion]"});
  refused({"monitor", "--array", "array.toml", "--calibration", "c.json", "--limits", "--motion", "m.csv"}, 2,
          {"--motion", "--limits runs nothing"});
  refused({"monitor", "--array", "array.toml", "--calibrate-first", "--log", "flight.csv", "--motion", "-",
           "--inclination", "-"},
          2, {"--inclination", "--motion writes to standard output already"});
  refused({"monitor", "--array", "array.toml", "--calibration", "c.json", "--limits", "--inclination", "i.csv"}, 2,
          {"--inclination", "--limits runs nothing"});
  write_text(where / "array.toml", read_text(kDrone));
  refused({"monitor", "--array", "array.toml", "--calibrate-first", "--log", "flight.csv", "--inclination", "i.csv"}, 3,
          {"motion.velocity_bound_mps", "is missing, and --inclination asks for its results"});
}

TEST(MotionCommand, RowsMayGoToStandardOutput) {
  const Hangar where;
  ASSERT_EQ(fly(where, {"--duration", "1"}).code, 0);
  const Outcome told = monitor(where, {"--motion", "-"});
  EXPECT_EQ(rows_of(told.out).size(), 1000U);
}

}  // namespace
}  // namespace cli_motion_test
