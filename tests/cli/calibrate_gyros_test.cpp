// plumb calibrate --array TOOL.toml#GYROS --motion, and plumb monitor --group by what it wrote.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/gyro_tool.hpp"
#include "support/recording.hpp"
#include "tool_runner.hpp"

namespace calibrate_gyros_test {
namespace {

using namespace plumb_test;
using Json = nlohmann::json;

/// Logs and the calibration of the accelerometers, made once.
struct GyroBench {
  GyroBench() {
    const ToolTurns turns(24, 5);
    write_text(where / "tool.toml", tool.array_file(GyroTool::usual_bounds()));
    write_text(where / "turns.csv", tool.log(turns, turns.seconds(), 6));
    write_text(where / "motion.csv", tool.log(ToolWaves{}, 60.0, 8));
    write_text(where / "other.csv", tool.log(ToolWaves{{1.5, 2.0, 1.2}}, 40.0, 21));
    done({"calibrate", "--array", "tool.toml", "--log", "turns.csv", "--out", "acc.json"});
  }
  void done(const std::vector<std::string>& arguments) const {
    const Outcome outcome = run(where, arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  }

  GyroTool tool = GyroTool::of_chips(3, 7);
  Directory where;
};

class CalibrateGyros : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { bench_ = std::make_unique<GyroBench>(); }
  static void TearDownTestSuite() { bench_.reset(); }

  const Directory& where() const { return bench_->where; }
  const GyroTool& tool() const { return bench_->tool; }
  Outcome calibrate(const std::string& log, const std::vector<std::string>& more = {}) const {
    std::error_code ignored;
    std::filesystem::remove(where() / "gyros.json", ignored);
    std::vector<std::string> arguments = {"calibrate", "--array", "tool.toml#gyros", "--motion",
                                          log,         "--out",   "gyros.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(where(), arguments);
  }
  Outcome absolute(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"--turns", "turns.csv", "--calibration", "acc.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return calibrate("motion.csv", arguments);
  }
  Outcome monitored(const std::string& log, const std::string& group, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"monitor", "--array", "tool.toml", "--calibration", "acc.json", "--log",
                                          log,       "--group", group};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(where(), arguments);
  }

 private:
  static inline std::unique_ptr<GyroBench> bench_;
};

// Verifies: REQ-245
TEST_F(CalibrateGyros, SaysWhatWasFoundWithItsUncertaintyAndWhatLimitsIt) {
  const Outcome told = absolute({"--date", "2026-03-02", "--serial", "T7"});
  ASSERT_EQ(told.code, 0) << told.out << told.err;
  EXPECT_TRUE(says(told.out, {"Calibration of tool gyros in motion",
                              "6000 rows",
                              "rest",
                              "common matrix",
                              "between stations",
                              "held out",
                              "scale, %",
                              "turn, deg",
                              "bias, deg/s",
                              "delay, us",
                              "x1",
                              "z3",
                              "bounds",
                              "fitted",
                              "deg/s rms a sample",
                              "held out",
                              "the last third",
                              "no alarm",
                              "limited by",
                              "noise",
                              "written: gyros.json",
                              "next: plumb monitor"}))
      << told.out;
  const std::string first = read_text(where() / "gyros.json");
  const Json file = Json::parse(first);
  EXPECT_EQ(file["schema"], "plumb-gyro-calibration");
  EXPECT_EQ(file["version"], 1);
  EXPECT_EQ(file["provenance"]["date"], "2026-03-02");
  EXPECT_EQ(file["provenance"]["serial"], "T7");
  EXPECT_EQ(file["provenance"]["logs"][0]["file"], "motion.csv");
  EXPECT_EQ(file["provenance"]["logs"][1]["use"], "turns");
  EXPECT_EQ(file["report"]["absolute"], true);
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(file["sensors"][i]["row"][c].get<double>(), tool().axis[i].row[c], 0.004) << i << c;
  }
  absolute({"--date", "2026-03-02", "--serial", "T7"});
  EXPECT_EQ(read_text(where() / "gyros.json"), first) << "the same input gives the same bytes";
}

TEST_F(CalibrateGyros, OtherLogsJudgeWhereTheyAreGiven) {
  const Outcome told = calibrate("motion.csv", {"--held-out", "other.csv", "--without", "g-sensitivity", "--json"});
  ASSERT_EQ(told.code, 0) << told.err;
  const Json report = Json::parse(told.out);
  EXPECT_EQ(report["accepted"], true);
  EXPECT_EQ(report["rows_fitted"], 6000);
  EXPECT_EQ(report["absolute"], false);
  ASSERT_EQ(report["held_out"].size(), 1U);
  EXPECT_EQ(report["held_out"][0]["log"], "other.csv");
  EXPECT_EQ(report["held_out"][0]["alarm"], false);
  EXPECT_LT(report["held_out"][0]["residual_radps"].get<double>(), 0.002);
  EXPECT_GT(report["common_part"].get<double>(), 0.0);
}

// Verifies: REQ-247
TEST_F(CalibrateGyros, TheMonitorTakesTheFileAndWithoutOneTheDatasheet) {
  ASSERT_EQ(absolute().code, 0);
  const Outcome by_datasheet = monitored("other.csv", "gyros", {"--json"});
  const Outcome calibrated = monitored("other.csv", "gyros=gyros.json", {"--json"});
  ASSERT_EQ(by_datasheet.code, 0) << by_datasheet.err;
  ASSERT_EQ(calibrated.code, 0) << calibrated.err;
  const auto bound = [](const std::string& out) {
    const std::size_t at = out.find("\"bound_worst_radps\":");
    return at == std::string::npos ? -1.0 : std::strtod(out.c_str() + at + 20, nullptr);
  };
  EXPECT_TRUE(says(by_datasheet.out, {"\"calibrated\":false"}));
  EXPECT_TRUE(says(calibrated.out, {"\"calibrated\":true"}));
  EXPECT_GT(bound(calibrated.out), 0.0);
  EXPECT_LT(bound(calibrated.out), 0.6 * bound(by_datasheet.out));
  EXPECT_TRUE(says(monitored("other.csv", "gyros=gyros.json").out, {"calibrated  scales, axes and biases"}));
}

// Negative: REQ-247
TEST_F(CalibrateGyros, AFileOfOtherGyrosOrAnEditedOneIsRefused) {
  ASSERT_EQ(absolute().code, 0);
  const std::string good = read_text(where() / "gyros.json");
  const auto refused = [&](const std::string& text, const std::vector<std::string>& words) {
    write_text(where() / "bad.json", text);
    const Outcome told = monitored("other.csv", "gyros=bad.json");
    EXPECT_EQ(told.code, 3) << told.err;
    EXPECT_TRUE(says(told.err, words)) << told.err;
    EXPECT_NE(told.err.find("Remedy: "), std::string::npos);
  };
  refused(with(good, "\"absolute\": true", "\"absolute\": false"), {"checksum"});
  refused(read_text(where() / "acc.json"), {"schema", "plumb-gyro-calibration"});
  refused(with(good, "\"version\": 1", "\"version\": 2"), {"version", "reads version 1"});
  refused(good.substr(0, good.size() / 2), {"truncated"});
  write_text(where() / "tool.toml", with(tool().array_file(GyroTool::usual_bounds()), "id = \"x1\"", "id = \"q1\""));
  EXPECT_TRUE(says(monitored("other.csv", "gyros=gyros.json").err, {"belongs to another array"}));
  write_text(where() / "tool.toml", tool().array_file(GyroTool::usual_bounds()));
}

// Negative: REQ-245
TEST_F(CalibrateGyros, WhatTheMotionDoesNotTellIsNamedAndNothingIsWritten) {
  write_text(where() / "flat.csv", tool().log(ToolWaves{{2.0, 0.0, 0.0}}, 40.0, 8));
  const Outcome flat = calibrate("flat.csv");
  EXPECT_EQ(flat.code, 4) << flat.err;
  EXPECT_TRUE(says(flat.err, {"the calibration of gyros was not accepted", "turned too little about",
                              "gyros.json was not written", "Remedy: "}))
      << flat.err;
  EXPECT_FALSE(std::filesystem::exists(where() / "gyros.json"));
}

TEST_F(CalibrateGyros, OptionsThatDoNotBelongTogetherAreToldApart) {
  const auto wrong = [&](const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
    const Outcome told = run(where(), arguments);
    EXPECT_EQ(told.code, 2) << told.err;
    EXPECT_TRUE(says(told.err, words)) << told.err;
  };
  wrong({"calibrate", "--array", "tool.toml#gyros", "--log", "motion.csv", "--out", "g.json"},
        {"does not serve a group of gyros", "--motion"});
  wrong(
      {"calibrate", "--array", "tool.toml#gyros", "--motion", "motion.csv", "--turns", "turns.csv", "--out", "g.json"},
      {"--turns", "needs calibrated accelerometers"});
  wrong({"calibrate", "--array", "tool.toml", "--log", "turns.csv", "--turns", "turns.csv", "--out", "g.json"},
        {"--turns", "belongs to a calibration of gyros"});
  wrong({"calibrate", "--array", "tool.toml#gyros", "--motion", "motion.csv", "--without", "bias", "--out", "g.json"},
        {"--without", "delay or g-sensitivity"});
  wrong({"calibrate", "--array", "tool.toml#gyros", "--motion", "-", "--out", "g.json"}, {"standard input"});
  wrong({"calibrate", "--array", "tool.toml#gyros", "--motion", "motion.csv", "--held-out", "motion.csv", "--out",
         "g.json"},
        {"--held-out", "the log that is fitted"});
}

/// The board: eight chips, every second one turned; two of them give the accelerometers.
std::string board(int first, int chips) {
  const auto axes = [](int chip) {
    return chip % 2 == 0 ? std::vector<std::string>{"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"}
                         : std::vector<std::string>{"[0, -1, 0]", "[-1, 0, 0]", "[0, 0, -1]"};
  };
  const auto one = [&](const char* table, char kind, int chip, std::size_t k, const std::string& more) {
    const std::string id = std::string(1, kind) + std::to_string(chip) + "xyz"[k];
    return std::string("[[") + table + "]]\nid = \"" + id + "\"\ncolumn = \"" + id + "_cnt\"\naxis = " + axes(chip)[k] +
           "\n" + more;
  };
  std::string out =
      "name = \"board\"\n[gravity]\nmodel = \"value\"\nvalue = \"9.818 m/s^2\"\n[input]\nreads = "
      "\"specific-force\"\nunit = \"count\"\ntime = \"t_s\"\n";
  for (int chip = 0; chip < 2; ++chip) {
    for (std::size_t k = 0; k < 3; ++k)
      out += one("sensor", 'a', chip, k, "scale = \"208.8 count/(m/s^2)\"\nnoise = \"10 mg\"\n");
  }
  out +=
      "[[group]]\nname = \"gyros\"\nfield = \"rate\"\nunit = \"count\"\n[group.rate]\nsample_period_s = 0.016\n"
      "rate_bound_radps = 60\nforce_bound_mps2 = 280\nscale_bound = 0.03\naxis_bound_rad = 0.03\nbias_bound_radps = "
      "0.35\nlag_bound_s = "
      "0.002\ng_sensitivity_bound_s_per_m = 1.8e-4\nmax_faults = 1\ndwell_s = 0.1\n";
  for (int chip = first; chip < first + chips; ++chip) {
    for (std::size_t k = 0; k < 3; ++k)
      out += one("group.sensor", 'g', chip, k,
                 "scale = \"939.65 count/(rad/s)\"\nnoise = \"0.2 deg/s\"\nfull_scale = \"32700 count\"\n");
  }
  return out;
}

// A sample differs by 9 to 12 deg/s rms above 1000 deg/s, for each chip samples by its own clock; means of 32 do not.
TEST(CalibrateGyrosBoard, TheFitOfRunOneHoldsOnRunsTwoAndThree) {
  PLUMB_RECORDING(recording, "carlsson_motion_1.csv")
  const Directory where;
  const auto log = [](int number) { return recording_path("carlsson_motion_" + std::to_string(number) + ".csv"); };
  write_text(where / "board.toml", board(0, 8));
  const Outcome told =
      run(where, {"calibrate", "--array", "board.toml#gyros", "--motion", log(1), "--held-out", log(2), "--held-out",
                  log(3), "--without", "g-sensitivity", "--out", "gyros.json", "--json"});
  ASSERT_EQ(told.code, 0) << told.err;
  const Json report = Json::parse(told.out);
  EXPECT_GT(report["limit"]["timing_share"].get<double>(), 0.5) << "what limits it is when each chip samples";
  for (const Json& one : report["held_out"]) {
    EXPECT_LT(one["fast_residual_32_radps"].get<double>() * 57.29578, 2.5);
    EXPECT_LT(one["fast_residual_radps"].get<double>() * 57.29578, 12.0);
    EXPECT_EQ(one["alarm"], false);
  }
}

}  // namespace
}  // namespace calibrate_gyros_test
