// plumb simulate: the pipe into the monitor, the same bytes again, and what it says to bad input.
#include <sys/wait.h>

#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace simulate_test {
namespace {

using namespace plumb_test;

const std::string kExamples = std::string(PLUMB_SOURCE_DIR) + "/examples/";
const std::string kShortest = "tool = \"paper\"\n[attitude]\nlaw = \"drilling-path\"\n";

/// A directory with the examples, the log of the stand and its calibration.
const Directory& bench() {
  static const Directory directory;
  static const bool ready = [] {
    for (const char* name : {"paper_tool.toml", "stand.toml", "drilling.toml"}) {
      std::filesystem::copy_file(kExamples + name, directory / name);
    }
    const Outcome stand = run(directory, {"simulate", "stand.toml", "--out", "stand.csv"});
    EXPECT_EQ(stand.code, 0) << stand.err;
    EXPECT_TRUE(says(stand.out, {"written: stand.csv (9600 rows, 48 stations"}));
    const Outcome fit =
        run(directory, {"calibrate", "--array", "paper_tool.toml", "--log", "stand.csv", "--out", "cal.json"});
    EXPECT_EQ(fit.code, 0) << fit.out << fit.err;
    return true;
  }();
  EXPECT_TRUE(ready);
  return directory;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

TEST(Simulate, PipeIntoTheMonitorFindsTheFault) {
  const Directory& where = bench();
  const std::string tool = std::string("'") + PLUMB_TOOL_PATH + "'";
  const std::string command = "cd '" + where.path().string() + "' && " + tool + " simulate drilling.toml | " + tool +
                              " monitor --array paper_tool.toml --calibration cal.json --log - > pipe.txt 2> pipe.err";
  const int status = std::system(command.c_str());  // NOLINT(*-env33-c,*-mt-unsafe) a real pipe needs a shell
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << read_text(where / "pipe.err");
  EXPECT_EQ(read_text(where / "pipe.err"), "");
  EXPECT_TRUE(says(read_text(where / "pipe.txt"), {"nominal", "suspect", "degraded", "a2", "4100 samples", "in service",
                                                   "a1, a3, a4", "excluded    a2"}));
}

TEST(Simulate, CalibrationOfTheExamplesFitsTheToolOfTheirSeed) {
  const Workshop where;
  where.put("scenario.toml", kShortest);
  ASSERT_EQ(run(where, {"simulate", "scenario.toml", "--out", "log.csv"}).code, 0);
  const Outcome outcome = run(
      where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--log", "log.csv", "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(lines_of(outcome.out).back())["summary"];
  EXPECT_EQ(summary["state"], "nominal");
  EXPECT_EQ(summary["output"], "valid");
}

TEST(Simulate, SameSeedSameBytes) {
  const Directory& where = bench();
  const Outcome once = run(where, {"simulate", "drilling.toml"});
  const Outcome again = run(where, {"simulate", "drilling.toml", "--out", "-"});
  const Outcome same = run(where, {"simulate", "drilling.toml", "--seed", "2"});
  const Outcome other = run(where, {"simulate", "drilling.toml", "--seed", "3"});
  EXPECT_EQ(once.code, 0) << once.err;
  EXPECT_EQ(once.err, "");
  EXPECT_EQ(lines_of(once.out).size(), 4101U);
  EXPECT_EQ(once.out, again.out);
  EXPECT_EQ(once.out, same.out) << "the scenario's own seed is 2";
  EXPECT_EQ(lines_of(once.out).size(), lines_of(other.out).size());
  EXPECT_NE(once.out, other.out);
}

TEST(Simulate, ToFileReportsWhatWasPlayed) {
  const Directory& where = bench();
  const Outcome outcome = run(where, {"simulate", "drilling.toml", "--out", "d.csv", "--truth", "t.csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"a2 is stuck at 0 V from station 6 on",
                                 "written: d.csv (4100 rows, 14 stations, t = 0.000 to 40.990 s)", "written: t.csv"}));
  EXPECT_EQ(read_text(where / "d.csv"), run(where, {"simulate", "drilling.toml"}).out);
}

TEST(Simulate, TruthIsInTheFrameOfTheVerdicts) {
  const Directory& where = bench();
  ASSERT_EQ(run(where, {"simulate", "drilling.toml", "--out", "d.csv", "--truth", "t.csv"}).code, 0);
  ASSERT_EQ(run(where, {"monitor", "--array", "paper_tool.toml", "--calibration", "cal.json", "--log", "d.csv",
                        "--verdicts", "v.jsonl"})
                .code,
            0);
  const std::vector<std::string> truth = lines_of(read_text(where / "t.csv"));
  ASSERT_EQ(truth.size(), 4101U);
  EXPECT_EQ(truth[0], "t_s,station,moving,gx_mps2,gy_mps2,gz_mps2,inclination_deg,toolface_deg,faulty");
  EXPECT_EQ(cells_of(truth[1500]).back(), "") << "station 5";
  EXPECT_EQ(cells_of(truth[1501]).back(), "a2") << "station 6";
  int valid = 0;
  for (const std::string& line : lines_of(read_text(where / "v.jsonl"))) {
    const auto verdict = nlohmann::json::parse(line);
    if (verdict["validity"] != "valid" && verdict["validity"] != "degraded") continue;
    const auto row = static_cast<std::size_t>(verdict["t_s"].get<double>() * 100.0 + 1.5);
    EXPECT_NEAR(verdict["inclination_deg"].get<double>(), std::stod(cells_of(truth[row])[6]), 0.02) << line;
    ++valid;
  }
  EXPECT_GT(valid, 20);
}

TEST(Simulate, ArrayOutIsTheFileThatTheLogNeeds) {
  const Directory where;
  write_text(where / "s.toml", "gravity = \"9.82 m/s^2\"\n" + kShortest);
  const Outcome outcome = run(where, {"simulate", "s.toml", "--out", "log.csv", "--array-out", "array.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"written: log.csv", "written: array.toml"}));
  EXPECT_TRUE(says(read_text(where / "array.toml"), {"value = \"9.82 m/s^2\""}));
  EXPECT_EQ(run(where, {"geometry", "array.toml"}).code, 0);
  EXPECT_EQ(
      run(where, {"inject", "--array", "array.toml", "--log", "log.csv", "--fault", "a1:stuck=0V@5s", "--out", "-"})
          .code,
      0);
}

TEST(Simulate, TheDepthColumnHoldsTheDepthBelowTheFirstStation) {
  const Directory where;
  write_text(where / "tool.toml",
             with(read_text(kExamples + "paper_tool.toml"), "[input]\n", "[input]\ndepth = \"md\"\n"));
  write_text(where / "run.toml",
             "array = \"tool.toml\"\n[attitude]\nlaw = \"drilling-path\"\n[depth]\nstation_spacing = \"28.5 m\"\n");
  const Outcome outcome = run(where, {"simulate", "run.toml", "--out", "run.csv"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<std::string> lines = lines_of(read_text(where / "run.csv"));
  const std::vector<std::string> names = cells_of(lines[0]), first = cells_of(lines[1]), last = cells_of(lines.back());
  const auto column = static_cast<std::size_t>(std::find(names.begin(), names.end(), "md") - names.begin());
  ASSERT_LT(column, names.size()) << lines[0];
  EXPECT_EQ(first[column], "0");
  const double stands = std::stod(last[column]) / 28.5;
  EXPECT_GE(stands, 1.0);
  EXPECT_NEAR(stands, std::round(stands), 1e-9);
}

TEST(Simulate, OneRowPerStationWhereTheArrayFileSaysSo) {
  const Directory where;
  const std::string array = with(read_text(kExamples + "paper_tool.toml"), "time = \"t_s\"",
                                 "time = \"t_s\"\nrows = \"stations\"\ncount = \"n\"");
  write_text(where / "array.toml", array);
  write_text(where / "s.toml", with(kShortest, "tool = \"paper\"", "array = \"array.toml\"") + "tag_stations = true\n");
  const Outcome outcome = run(where, {"simulate", "s.toml", "--truth", "t.csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<std::string> lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 15U);
  EXPECT_EQ(lines[0], "t_s,station,n,a1,a2,a3,a4");
  EXPECT_EQ(cells_of(lines[1])[2], "200");
  EXPECT_NEAR(std::stod(cells_of(lines[2])[0]), 3.995, 1e-9);
  EXPECT_EQ(cells_of(lines[14])[1], "13") << "labels count from 0";
  EXPECT_EQ(lines_of(read_text(where / "t.csv")).size(), 15U);
}

TEST(Simulate, FaultOutsideTheRunIsReported) {
  const Directory where;
  write_text(where / "s.toml", kShortest + "[[fault]]\nspec = \"a1:stuck=0V@2h\"\n");
  const Outcome outcome = run(where, {"simulate", "s.toml"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(says(outcome.err, {"s.toml: fault[1].spec: a1:stuck=0V@7200s changed nothing", "40.990 s", "14"}));
}

TEST(Simulate, BadInputIsExplained) {
  const Directory where;
  write_text(where / "good.toml", kShortest);
  write_text(where / "named.toml", "array = \"" + kExamples + "paper_tool.toml\"\n[attitude]\nlaw = \"random\"\n");
  write_text(where / "bad.toml", kShortest + "dwel = \"2 s\"\n");
  struct Case {
    std::vector<std::string> arguments;
    int code;
    std::vector<std::string> words;
  };
  const std::vector<Case> cases = {
      {{"simulate"}, 2, {"scenario is required", "plumb simulate --help"}},
      {{"simulate", "good.toml", "more.toml"}, 2, {"\"more.toml\" is not expected"}},
      {{"simulate", "good.toml", "--sead", "1"}, 2, {"Did you mean \"--seed\"?"}},
      {{"simulate", "good.toml", "--seed", "-1"}, 2, {"--seed", "whole number from 0 to 2^64 - 1"}},
      {{"simulate", "nowhere.toml"}, 3, {"nowhere.toml", "No such file", "Remedy: "}},
      {{"simulate", "bad.toml"}, 3, {"bad.toml:4: attitude.dwel", "did you mean \"dwell\"?"}},
      {{"simulate", "named.toml", "--array-out", "a.toml"}, 2, {"--array-out", "paper_tool.toml", "Remedy: use that"}},
      {{"simulate", "good.toml", "--truth", "-"}, 2, {"--truth", "names the same file as another output", "Remedy: "}},
      {{"simulate", "good.toml", "--out", "x", "--array-out", "x"},
       2,
       {"--array-out", "names the same file as the log", "Remedy: "}},
      {{"simulate", "good.toml", "--out", "no/such.csv"}, 1, {"no/such.csv", "cannot write", "Remedy: "}},
      {{"simulate", "good.toml", "--truth", "no/t.csv"}, 1, {"no/t.csv", "cannot write"}},
      {{"simulate", "good.toml", "--array-out", "no/a.toml"}, 1, {"no/a.toml", "cannot write"}},
  };
  for (const Case& c : cases) {
    const Outcome outcome = run(where, c.arguments);
    EXPECT_EQ(outcome.code, c.code) << outcome.err;
    EXPECT_EQ(outcome.out.size(), 0U);
    EXPECT_TRUE(says(outcome.err, c.words));
  }
  EXPECT_FALSE(std::filesystem::exists(where / "a.toml"));
}

TEST(Simulate, HelpIsForStrangers) {
  const Directory where;
  const Outcome help = run(where, {"simulate", "--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_TRUE(says(help.out, {"Usage: plumb simulate", "Example", "plumb simulate examples/stand.toml", "plumb monitor",
                              "Units", "Exit codes:", "0  done"}));
  EXPECT_TRUE(says(run(where, {"--help"}).out, {"simulate"}));
}

}  // namespace
}  // namespace simulate_test
