// The chain as a user runs it, on the real recording: calibrate, inject, monitor.
#include <gtest/gtest.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "../cli/tool_runner.hpp"
#include "support/recording.hpp"

namespace tool_recordings_test {
namespace {

using plumb_test::Directory;
using plumb_test::Outcome;

TEST(ToolOnMikoff, CalibratesInjectsAndExcludesTheStuckAxis) {
  PLUMB_RECORDING(recording, "mikoff5_static_means.csv")
  const std::string array = std::string(PLUMB_SOURCE_DIR) + "/examples/mikoff5_z.toml";
  const Directory dir;
  const Outcome fit =
      plumb_test::run(dir, {"calibrate", "--array", array, "--log", recording.path, "--out", "cal.json"});
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_NE(fit.out.find("accepted"), std::string::npos);

  const Outcome healthy = plumb_test::run(
      dir, {"monitor", "--array", array, "--calibration", "cal.json", "--log", recording.path, "--events", "ok.jsonl"});
  EXPECT_EQ(healthy.code, 0) << healthy.err;
  EXPECT_EQ(plumb_test::read_text(dir / "ok.jsonl").find("exclusion"), std::string::npos);

  for (const char* fault :
       {"a2z:stuck=1g0@station5", "a4z:stuck=-1g0@station5", "a0z:stuck=0g0@station5", "a3z:last@station5"}) {
    const Outcome injected = plumb_test::run(
        dir, {"inject", "--array", array, "--log", recording.path, "--fault", fault, "--out", "bad.csv"});
    ASSERT_EQ(injected.code, 0) << fault << injected.err;
    const Outcome watched = plumb_test::run(
        dir, {"monitor", "--array", array, "--calibration", "cal.json", "--log", "bad.csv", "--events", "bad.jsonl"});
    EXPECT_EQ(watched.code, 0) << fault << watched.err;
    const std::string events = plumb_test::read_text(dir / "bad.jsonl");
    const std::string named =
        "\"event\":\"exclusion\",\"cause\":\"isolated_fault\",\"grade\":\"confirmed\",\"sensors\":[\"" +
        std::string(fault, 3) + "\"]";
    EXPECT_NE(events.find(named), std::string::npos) << fault << "\n" << events;
  }
}

TEST(ToolOnXsens, FindsTheStaticStretchesAndCalibrates) {
  PLUMB_RECORDING(recording, "imutk_xsens_full.csv")
  const std::string array = std::string(PLUMB_SOURCE_DIR) + "/examples/xsens.toml";
  const Directory dir;
  const Outcome fit =
      plumb_test::run(dir, {"calibrate", "--array", array, "--log", recording.path, "--out", "cal.json"});
  EXPECT_EQ(fit.code, 0) << fit.err;
  EXPECT_NE(fit.out.find("9 of 12 parameters"), std::string::npos) << fit.out;
}

TEST(ToolOnCarlsson, CalibratesTwentyFourAxes) {
  PLUMB_RECORDING(recording, "carlsson_static_means.csv")
  const std::string array = std::string(PLUMB_SOURCE_DIR) + "/examples/carlsson.toml";
  const Directory dir;
  const Outcome fit =
      plumb_test::run(dir, {"calibrate", "--array", array, "--log", recording.path, "--out", "cal.json"});
  EXPECT_EQ(fit.code, 0) << fit.err;
  EXPECT_NE(fit.out.find("93 of 96 parameters"), std::string::npos) << fit.out;
}

/// Real residuals exceed or miss the declared noise; what counts is that stations not used are predicted as claimed,
/// and that no healthy sensor is suspected.
TEST(ToolOnRecordings, HeldOutStationsArePredictedAsClaimed) {
  const struct {
    const char *array, *log;
  } cases[] = {{"mikoff5_z", "mikoff5_static_means.csv"},
               {"mikoff5_15", "mikoff5_static_means.csv"},
               {"carlsson", "carlsson_static_means.csv"},
               {"xsens", "imutk_xsens_full.csv"}};
  for (const auto& c : cases) {
    PLUMB_RECORDING(recording, c.log)
    const std::string array = std::string(PLUMB_SOURCE_DIR) + "/examples/" + c.array + ".toml";
    const Directory dir;
    const Outcome fit =
        plumb_test::run(dir, {"calibrate", "--array", array, "--log", recording.path, "--out", "cal.json", "--json"});
    ASSERT_EQ(fit.code, 0) << c.array << fit.err;
    const auto json = nlohmann::json::parse(fit.out);
    EXPECT_EQ(json["hold_out"]["judged"], json["stations"].size()) << c.array;
    const double sigmas = json["hold_out"]["sigmas"].get<double>();
    EXPECT_GT(sigmas, 0.7) << c.array;
    EXPECT_LT(sigmas, 1.3) << c.array;
    EXPECT_LT(json["hold_out"]["norm_rms_mps2"].get<double>(), 4e-3) << c.array;
    EXPECT_TRUE(json["inconsistent_sensor"].is_null() || json["inconsistent_sensor"]["id"].is_null()) << c.array;
    std::cout << "[ measured ] " << c.array << ": held-out error over claim " << sigmas << ", norm "
              << json["hold_out"]["norm_rms_mps2"] << " m/s^2\n";
  }
}

}  // namespace
}  // namespace tool_recordings_test
