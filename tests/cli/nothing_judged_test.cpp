// What a command makes of the columns of a log: which it needs, which it writes, why none of them could be judged.
#include <functional>
#include <sstream>

#include "tool_runner.hpp"

namespace nothing_judged_test {
namespace {

using namespace plumb_test;

const std::vector<std::string> kMonitor = {"monitor", "--array", "array.toml", "--calibration", "calibration.json"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Verifies: REQ-175
TEST(NothingJudged, NamesItsCauseAndARemedyThatWorks) {
  const Workshop where;
  const std::string array = where.text("array.toml"), log = where.text("drilling.csv");
  // Ten seconds, so that more than one block fits; the first row is the header.
  const std::string short_log = log.substr(0, log.find(line_of(log, 1002)));
  const auto monitored = [&where](const std::vector<std::string>& words) {
    const Outcome outcome = run(where, kMonitor + std::vector<std::string>{"--log", "log.csv"});
    EXPECT_EQ(outcome.code, 7) << outcome.out << outcome.err;
    EXPECT_TRUE(says(outcome.err, words));
  };
  /// The same rows, each sensor's cell put through `change`.
  const auto changed = [&short_log](const std::function<std::string(double)>& change) {
    std::istringstream in(short_log);
    std::string out, line;
    for (bool header = true; std::getline(in, line); header = false) {
      std::istringstream cells(line);
      std::string cell, row;
      for (int c = 0; std::getline(cells, cell, ','); ++c)
        row += (c == 0 ? "" : ",") + (header || c < 2 ? cell : change(std::stod(cell)));
      out += row + "\n";
    }
    return out;
  };
  where.put("log.csv", log.substr(0, log.find(line_of(log, 22))));
  monitored(
      {"nothing was judged in 20 samples", "the log has 20 rows, and a block has 32", "Remedy: record at least 32"});
  where.put("log.csv", changed([](double) { return std::string(); }));
  monitored({"`a1` (a1), `a2` (a2), `a3` (a3) and `a4` (a4) have no number", "Remedy", "`column`"});
  where.put("log.csv", changed([](double) { return std::string("5"); }));
  monitored({"are at full scale in most rows", "Remedy: check `full_scale`, `scale` and `unit`"});
  int row = 0;
  where.put("log.csv", changed([&row](double v) { return std::to_string(v + (++row / 4 % 2 == 0 ? 0.3 : -0.3)); }));
  monitored({"was not at rest for a block of 32", "Remedy: hold the tool still for at least 32 samples", "`noise`",
             "plumb noise STILL.csv --array"});
  int cell = 0;
  where.put("log.csv", changed([&cell](double v) { return cell++ % 40 < 4 ? "nan" : std::to_string(v); }));
  monitored(
      {"100 of 1000 rows lack a number (NaN or empty cells), 100 of them from every sensor, and at most 9 in a row "
       "are between those without any; a block has 32",
       "Remedy: log all sensors in every row"});
  where.put("log.csv", log.substr(0, log.find(line_of(log, 22))));
  where.put("array.toml", with(array, "[input]\n", "[input]\nrows = \"stations\"\n"));
  monitored({"every row is a station", "joins 32 of them", "Remedy: set window = 1"});
}

TEST(NothingJudged, AnUnknownRotationIsNamedWhereItLeavesNothingToJudge) {
  const Workshop where;
  std::istringstream in(where.text("drilling.csv"));
  std::string out, line;
  for (int row = 0; row < 1000 && std::getline(in, line); ++row) out += line + (row == 0 ? ",wx,wy,wz\n" : ",0,0,5\n");
  where.put("log.csv", out);
  const std::string array = where.text("array.toml");
  where.put("array.toml", with(array, "[input]\n", "[input]\nrotation_radps = [\"wx\", \"wy\", \"wz\"]\n"));
  const Outcome outcome = run(where, kMonitor + std::vector<std::string>{"--log", "log.csv"});
  EXPECT_EQ(outcome.code, 7) << outcome.out << outcome.err;
  EXPECT_TRUE(says(outcome.err, {"turns in most rows", "lever arm", "Remedy: state `lever_arm_m`"}));
}

TEST(WhatIsRead, CalibrateNeedsNoColumnThatItDoesNotUse) {
  const Workshop where;
  where.put("array.toml", with(where.text("array.toml"), "[input]\n",
                               "[input]\ndepth = \"md\"\nrotation_radps = [\"wx\", \"wy\", \"wz\"]\n"));
  const Outcome outcome =
      run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "again.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST(WhatIsRead, NoControlCharacterOfAFileReachesTheTerminal) {
  const Workshop where;
  const std::string escape = "\x1b]0;owned\x07", array = where.text("array.toml"), log = where.text("drilling.csv");
  const auto clean = [](const Outcome& outcome) {
    for (const std::string& text : {outcome.out, outcome.err}) {
      EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
      EXPECT_EQ(text.find('\x07'), std::string::npos) << text;
    }
  };
  where.put("log.csv", "x" + escape + "," + log);
  where.put("array.toml", with(array, "time = \"t_s\"", "time = \"nowhere\""));
  const Outcome header = run(where, kMonitor + std::vector<std::string>{"--log", "log.csv"});
  EXPECT_EQ(header.code, 3);
  clean(header);
  where.put("array.toml", with(array, "name = \"paper-tetrahedron\"", "name = \"p\\u001b]0;owned\\u0007\""));
  const Outcome name =
      run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "c.json"});
  EXPECT_TRUE(says(name.out, {"\\x1b]0;owned\\x07"})) << name.out << name.err;
  clean(name);
  clean(run(where, {"geometry", "array.toml"}));
  where.put("array.toml", with(array, "time = \"t_s\"", "time = \"t\\u001b[31m\""));
  const Outcome column = run(where, kMonitor + std::vector<std::string>{"--log", "drilling.csv"});
  EXPECT_EQ(column.code, 3);
  clean(column);
}

TEST(WhatIsRead, SimulateWritesTheRatesThatMonitorReads) {
  const Workshop where;
  where.put("array.toml",
            with(where.text("array.toml"), "[input]\n", "[input]\nrotation_radps = [\"wx\", \"wy\", \"wz\"]\n"));
  const std::string scenario = read_text(PLUMB_SOURCE_DIR "/examples/drilling.toml");
  where.put("s.toml", with(scenario, "array = \"paper_tool.toml\"", "array = \"array.toml\""));
  const Outcome made = run(where, {"simulate", "s.toml", "--out", "log.csv"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(says(line_of(where.text("log.csv"), 1), {",wx,wy,wz,"}));
  EXPECT_TRUE(says(line_of(where.text("log.csv"), 2), {",0,0,0,"}));
  EXPECT_EQ(run(where, kMonitor + std::vector<std::string>{"--log", "log.csv"}).code, 0);
}

}  // namespace
}  // namespace nothing_judged_test
