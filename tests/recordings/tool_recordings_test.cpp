// The chain as a user runs it, on the real recording: calibrate, inject, monitor.
#include <gtest/gtest.h>

#include "../cli/tool_runner.hpp"
#include "support/recording.hpp"

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
  EXPECT_EQ(plumb_test::read_text(dir / "ok.jsonl").find("culprit"), std::string::npos);

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
        "\"event\":\"culprit\",\"cause\":\"isolated_fault\",\"grade\":\"strict\",\"sensors\":[\"" +
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

}  // namespace
