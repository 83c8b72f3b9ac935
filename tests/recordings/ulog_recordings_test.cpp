// Public recordings as CSV and as the ULog that plumb convert makes of them: every command says the same of both.
#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "../cli/tool_runner.hpp"
#include "support/recording.hpp"

namespace ulog_recordings_test {
namespace {

using plumb_test::Directory;
using plumb_test::Outcome;
using Texts = std::vector<std::string>;

std::string example(const std::string& name) {
  return plumb_test::read_text(std::string(PLUMB_SOURCE_DIR) + "/examples/" + name + ".toml");
}

std::string with(std::string text, const std::vector<std::pair<std::string, std::string>>& changes) {
  for (const auto& [from, to] : changes) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) {
      ADD_FAILURE() << "the array file has no " << from;
      return text;
    }
    text.replace(at, from.size(), to);
  }
  return text;
}

/// The names of files differ, and with them the hashes of what they hold.
std::string without_names(std::string text) {
  for (const std::string key : {"log.csv", "log.ulg", "\"log_bytes\"", "\"log_hash\"", "\"checksum\""}) {
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key)) {
      const std::size_t end = key[0] == '"' ? text.find('\n', at) : at + key.size();
      text.erase(at, end - at);
    }
  }
  return text;
}

/// Converts the recording there and back; the same rows must come out of both.
void convert(const Directory& dir, const std::string& recording) {
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{recording, "log.csv"}, {"log.csv", "log.ulg"}, {"log.ulg", "again.csv"}}) {
    const Outcome outcome = plumb_test::run(dir, {"convert", "--array", "array.toml", "--log", from, "--out", to});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  ASSERT_EQ(plumb_test::read_text(dir / "again.csv"), plumb_test::read_text(dir / "log.csv"));
}

/// The monitor's table, events, verdicts of every sample and motion, of each of the logs.
void expect_same_monitor(const Directory& dir, const std::string& recording) {
  std::vector<Texts> said;
  for (const std::string& log : {recording, std::string("log.csv"), std::string("log.ulg")}) {
    const Outcome outcome = plumb_test::run(
        dir, {"monitor", "--array", "array.toml", "--calibration", "cal.json", "--log", log, "--events", "events.jsonl",
              "--verdicts", "verdicts.jsonl", "--every-sample", "--date", "2026-01-01", "--json"});
    Texts one = {std::to_string(outcome.code), outcome.out, outcome.err, plumb_test::read_text(dir / "events.jsonl"),
                 plumb_test::read_text(dir / "verdicts.jsonl")};
    ASSERT_GT(one[4].size(), 1000U) << outcome.err;
    said.push_back(std::move(one));
  }
  EXPECT_EQ(said[0], said[1]);
  EXPECT_EQ(said[1], said[2]);
  std::cout << "[ measured ] " << said[2][4].size() << " bytes of verdicts are the same\n";
}

Outcome calibrate(const Directory& dir, const std::string& log) {
  return plumb_test::run(dir, {"calibrate", "--array", "array.toml", "--log", log, "--out", "cal.json", "--json"});
}

/// The fit on each form of the log, then the monitor with it.
void expect_same(const std::string& array, const plumb_test::Recording& recording) {
  const Directory dir;
  plumb_test::write_text(dir / "array.toml", array);
  ASSERT_NO_FATAL_FAILURE(convert(dir, recording.path));
  const Outcome text = calibrate(dir, "log.csv");
  ASSERT_EQ(text.code, 0) << text.err;
  const std::string fit = plumb_test::read_text(dir / "cal.json");
  const Outcome ulog = calibrate(dir, "log.ulg");
  ASSERT_EQ(ulog.code, 0) << ulog.err;
  EXPECT_EQ(without_names(text.out), without_names(ulog.out));
  EXPECT_EQ(without_names(fit), without_names(plumb_test::read_text(dir / "cal.json")));
  ASSERT_GT(without_names(fit).size(), 2000U);
}

TEST(UlogOfRecordings, MikoffsStationsGiveTheSameCalibrationAndVerdicts) {
  PLUMB_RECORDING(recording, "mikoff5_static_means.csv")
  for (const char* array : {"mikoff5_z", "mikoff5_15"}) {
    expect_same(example(array), recording);
    const Directory dir;
    plumb_test::write_text(dir / "array.toml", example(array));
    ASSERT_NO_FATAL_FAILURE(convert(dir, recording.path)) << array;
    ASSERT_EQ(calibrate(dir, recording.path).code, 0);
    expect_same_monitor(dir, recording.path);
  }
}

TEST(UlogOfRecordings, MikoffsSamplesGiveTheSameVerdicts) {
  PLUMB_RECORDING(recording, "mikoff5_static_samples.csv")
  PLUMB_RECORDING(means, "mikoff5_static_means.csv")
  const Directory dir;
  plumb_test::write_text(dir / "array.toml", example("mikoff5_z"));
  ASSERT_EQ(calibrate(dir, means.path).code, 0);
  plumb_test::write_text(dir / "array.toml",
                         with(example("mikoff5_z"), {{"rows = \"stations\" ", "rows = \"samples\" "},
                                                     {"time = \"t_mid_s\"", "rate = \"100 Hz\""},
                                                     {"count = \"n\"\n", ""},
                                                     {"window = 1 ", "window = 32 "}}));
  ASSERT_NO_FATAL_FAILURE(convert(dir, recording.path));
  expect_same_monitor(dir, recording.path);
}

TEST(UlogOfRecordings, CarlssonsTwentyFourAxesGiveTheSameCalibrationAndVerdicts) {
  PLUMB_RECORDING(recording, "carlsson_static_means.csv")
  expect_same(example("carlsson"), recording);
  const Directory dir;
  plumb_test::write_text(dir / "array.toml", example("carlsson"));
  ASSERT_NO_FATAL_FAILURE(convert(dir, recording.path));
  ASSERT_EQ(calibrate(dir, recording.path).code, 0);
  expect_same_monitor(dir, recording.path);
}

TEST(UlogOfRecordings, CarlssonsBoardInMotionGivesTheSameVerdicts) {
  PLUMB_RECORDING(means, "carlsson_static_means.csv")
  const Directory dir;
  plumb_test::write_text(dir / "array.toml", example("carlsson"));
  ASSERT_EQ(calibrate(dir, means.path).code, 0);
  plumb_test::write_text(dir / "array.toml", with(example("carlsson"), {{"rows = \"stations\"", "rows = \"samples\""},
                                                                        {"station = \"att\"\n", ""},
                                                                        {"time = \"t_mid_s\"", "time = \"t_s\""},
                                                                        {"count = \"n\"\n", ""},
                                                                        {"where = { exp = 2 }\n", ""},
                                                                        {"window = 1\n", "window = 32\n"}}));
  for (const char* name : {"carlsson_motion_1.csv", "carlsson_motion_2.csv", "carlsson_motion_3.csv"}) {
    PLUMB_RECORDING(recording, name)
    ASSERT_NO_FATAL_FAILURE(convert(dir, recording.path)) << name;
    expect_same_monitor(dir, recording.path);
  }
}

TEST(UlogOfRecordings, AHandHeldTriadGivesTheSameCalibration) {
  PLUMB_RECORDING(recording, "imutk_xsens_full.csv")
  expect_same(example("xsens"), recording);
}

}  // namespace
}  // namespace ulog_recordings_test
