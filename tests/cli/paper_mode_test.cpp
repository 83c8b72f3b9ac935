// The paper's algorithm from log to verdict: calibrate --paper, then monitor in mode = "paper".
#include <cmath>
#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace paper_mode_test {
namespace {

using namespace plumb_test;

/// The demo's files with an array file that asks for paper mode, `more` in its [monitor] table.
class PaperWorkshop : public Workshop {
 public:
  explicit PaperWorkshop(const std::string& more = "") {
    put("paper.toml", with(text("array.toml"), "[monitor]\n", "[monitor]\nmode = \"paper\"\n" + more));
  }
  Outcome calibrate(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"calibrate",       "--array", "paper.toml", "--log",
                                          "calibration.csv", "--out",   "paper.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(*this, arguments);
  }
  Outcome monitor(const std::vector<std::string>& more, const std::string& input = "") const {
    std::vector<std::string> arguments = {"monitor", "--array", "paper.toml", "--calibration", "paper.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(*this, arguments, input);
  }
};

std::vector<nlohmann::json> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<nlohmann::json> out;
  for (std::string line; std::getline(in, line);) out.push_back(nlohmann::json::parse(line));
  return out;
}

TEST(CalibratePaper, PrintsOneLineForAllAndOneForEveryTriple) {
  const Workshop where;
  const Outcome outcome =
      run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "both.json", "--paper"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"sensor", "a4", "the paper's fit of", "iterations", "rank", "E_g before", "all",
                                 "converged", "9", "a1, a2, a3", "converged", "a1, a2, a4", "a1, a3, a4", "a2, a3, a4",
                                 "accepted", "written: both.json"}));
  // Beside plumb's own fit, which is the same as without.
  auto both = nlohmann::json::parse(where.text("both.json"));
  auto alone = nlohmann::json::parse(where.text("calibration.json"));
  EXPECT_EQ(both["paper"]["triples"].size(), 4U);
  EXPECT_EQ(alone.count("paper"), 0U);
  both.erase("paper");
  both.erase("checksum");
  alone.erase("checksum");
  both["provenance"].erase("log_file");
  alone["provenance"].erase("log_file");
  EXPECT_EQ(both, alone);
}

TEST(CalibratePaper, TheArrayFileImpliesItAndJsonHoldsIt) {
  const PaperWorkshop where;
  const Outcome outcome = where.calibrate({"--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json["paper"].size(), 5U);
  EXPECT_EQ(json["paper"][0]["sensors"], "all");
  for (const auto& fit : json["paper"]) {
    EXPECT_TRUE(fit["sound"]);
    EXPECT_EQ(fit["rank"], 9);
    EXPECT_LT(fit["cost_m4ps8"], 1e-4 * fit["start_cost_m4ps8"].get<double>());
    EXPECT_LT(fit["length_error_rms_mps2"], 5e-4);
  }
}

TEST(CalibratePaper, RefusesMoreThanEightSensorsBeforeItReads) {
  const Workshop where;
  std::string array = where.text("array.toml");
  for (int k = 5; k <= 9; ++k) {
    array += "\n[[sensor]]\nid = \"a" + std::to_string(k) + "\"\naxis = [" + (k % 2 ? "0.6, 0.8, 0" : "0, 0.6, 0.8") +
             "]\nscale = \"3 V/g0\"\nnoise = \"0.2 mg\"\n";
  }
  where.put("nine.toml", array);
  const Outcome outcome =
      run(where, {"calibrate", "--array", "nine.toml", "--log", "no.csv", "--out", "c.json", "--paper"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(says(outcome.err, {"nine.toml", "at most 8 sensors", "has 9", "Remedy", "--paper"}));
}

/// Readings that sensors disagree by 1 mg0 from station to station: plumb's fit carries that as misfit; in the
/// paper's equations it looks like directions that the length of gravity does not show.
TEST(CalibratePaper, EquationsThatTheDisagreementFillsUpAreOfNoUse) {
  const Workshop where;
  std::istringstream in(where.text("calibration.csv"));
  std::string line, log;
  std::getline(in, line);
  log = line + "\n";
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell, row;
    int station = 0;
    for (int column = 0; std::getline(cells, cell, ','); ++column) {
      if (column == 1) station = std::stoi(cell);
      if (column > 1) cell = std::to_string(std::stod(cell) + 4.2e-3 * std::sin(37.0 * station + 11.0 * column));
      row += (column > 0 ? "," : "") + cell;
    }
    log += row + "\n";
  }
  where.put("calibration.csv", log);
  const std::vector<std::string> command = {"calibrate",       "--array", "array.toml", "--log",
                                            "calibration.csv", "--out",   "rough.json"};
  EXPECT_EQ(run(where, command).code, 0) << "plumb's own fit stands";
  std::filesystem::remove(where / "rough.json");
  std::vector<std::string> paper = command;
  paper.emplace_back("--paper");
  const Outcome outcome = run(where, paper);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"plumb: the fit by the paper's method was not accepted:", "its equations have rank 12",
                                 "the length of gravity shows 9 directions", "disagreement of the sensors", "mg0 rms",
                                 "Remedy", "chi^2", "without --paper"}));
  EXPECT_FALSE(std::filesystem::exists(where / "rough.json"));
}

TEST(MonitorPaper, WithoutThePapersFitsItSaysWhatToDo) {
  const PaperWorkshop where;
  const Outcome outcome =
      run(where, {"monitor", "--array", "paper.toml", "--calibration", "calibration.json", "--log", "drilling.csv"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(says(outcome.err, {"calibration.json", "paper", "is missing", "Remedy", "plumb calibrate"}));
  EXPECT_TRUE(outcome.out.empty());
}

TEST(MonitorPaper, ADeadSensorIsIsolatedAndAPipeSaysTheSame) {
  const PaperWorkshop where;
  ASSERT_EQ(where.calibrate().code, 0);
  const Outcome file = where.monitor({"--log", "drilling.csv", "--events", "events.jsonl"});
  EXPECT_EQ(file.code, 0) << file.err;
  EXPECT_TRUE(says(file.out, {"suspect", "power_on", "nominal", "passed_block", "suspect", "mae", "0.4903", "degraded",
                              "isolated_fault", "a2", "4100 samples", "in service  a1, a3, a4", "excluded    a2",
                              "no bound on the error can be given"}));
  EXPECT_TRUE(file.err.empty()) << file.err;
  EXPECT_EQ(where.monitor({"--log", "-"}, "drilling.csv").out, file.out);
  const auto events = lines_of(where.text("events.jsonl"));
  ASSERT_GE(events.size(), 3U);
  EXPECT_EQ(events.back()["event"], "exclusion");
  EXPECT_EQ(events.back()["sensors"], nlohmann::json({"a2"}));
  EXPECT_EQ(events.back()["to"], "degraded");
  for (const auto& event : events) {
    const bool alarm = event["event"] == "alarm";
    EXPECT_EQ(event["statistic"] > event["limit"], alarm || event["event"] == "exclusion") << event;
  }
}

TEST(MonitorPaper, OneAttitudeDecidesWhereAskedFor) {
  const PaperWorkshop where("isolation_stations = 1\n");
  ASSERT_EQ(where.calibrate().code, 0);
  const auto lines = lines_of(where.monitor({"--log", "drilling.csv", "--json"}).out);
  ASSERT_GE(lines.size(), 3U);
  EXPECT_EQ(lines[1]["event"], "exclusion") << "without a suspicion before it";
  EXPECT_EQ(lines[1]["from"], "nominal");
  EXPECT_EQ(lines.back()["summary"]["state"], "degraded");
}

TEST(MonitorPaper, TwoDeadSensorsOfFourAreNotIsolatedAndEndInCodeFive) {
  const PaperWorkshop where;
  ASSERT_EQ(where.calibrate().code, 0);
  ASSERT_EQ(run(where, {"inject", "--array", "paper.toml", "--log", "drilling.csv", "--fault", "a1:stuck=-3V@4s",
                        "--fault", "a3:stuck=3V@4s", "--out", "two.csv"})
                .code,
            0);
  const Outcome outcome = where.monitor({"--log", "two.csv"});
  EXPECT_EQ(outcome.code, 5) << outcome.out << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"suspect", "mae", "failed", "isolation_timeout", "state       failed"}));
  EXPECT_EQ(outcome.out.find("isolated_fault"), std::string::npos) << outcome.out;
}

TEST(MonitorPaper, HelpSaysWhatItIs) {
  const Directory where;
  EXPECT_TRUE(says(run(where, {"monitor", "--help"}).out, {"mode = \"paper\"", "delta_f", "plumb calibrate --paper"}));
  EXPECT_TRUE(says(run(where, {"calibrate", "--help"}).out, {"--paper"}));
}

}  // namespace
}  // namespace paper_mode_test
