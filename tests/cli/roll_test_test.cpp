// A recorded roll test before the log: what it validates, what it says, and what goes along into the run.
#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace cli_roll_test_test {
namespace {

using namespace plumb_test;
using Json = nlohmann::json;

/// The paper's tool, exactly as its datasheet says and calibrated: `still.csv` at one attitude for 3 s, `turned.csv` at
/// four attitudes that move every sensor, `rolled.csv` about the axis of a4, which then feels nothing of it.
class Field : public Workshop {
 public:
  Field() {
    simulate("stand", "law = \"list\"\n" + at({{0, 0},
                                               {180, 0},
                                               {90, 0},
                                               {90, 60},
                                               {90, 120},
                                               {90, 180},
                                               {90, 240},
                                               {90, 300},
                                               {45, 30},
                                               {45, 150},
                                               {45, 270},
                                               {135, 90},
                                               {135, 210},
                                               {135, 330},
                                               {60, 0},
                                               {120, 180}},
                                              "2 s"));
    const Outcome done = run(*this, {"calibrate", "--array", "array.toml", "--log", "stand.csv", "--out", "cal.json"});
    EXPECT_EQ(done.code, 0) << done.err;
    simulate("still", "law = \"list\"\n" + at({{40, 70}}, "3 s"));
    simulate("turned", "law = \"list\"\n" + at({{90, 0}, {90, 90}, {60, 180}, {110, 270}}));
    simulate("rolled", "law = \"roll-test\"\nstations = 8\ninclination = \"40 deg\"\ndwell = \"1 s\"\n");
  }
  void simulate(const std::string& name, const std::string& attitude) const {
    put((name + ".toml").c_str(), "name = \"" + name + "\"\narray = \"array.toml\"\nseed = 5\nrate = \"100 Hz\"\n" +
                                      "[truth]\nlaw = \"none\"\n[attitude]\n" + attitude);
    const Outcome done = run(*this, {"simulate", name + ".toml", "--out", name + ".csv"});
    EXPECT_EQ(done.code, 0) << done.err;
  }
  Outcome monitor(const std::vector<std::string>& more, const std::string& log = "still.csv") const {
    std::vector<std::string> arguments = {"monitor",  "--array", "array.toml", "--calibration",
                                          "cal.json", "--log",   log};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(*this, arguments);
  }
  /// A verdict for every row of the run.
  std::vector<Json> verdicts(std::vector<std::string> more, Outcome& outcome) const {
    more.insert(more.end(), {"--verdicts", "-", "--every-sample"});
    outcome = monitor(more);
    std::vector<Json> out;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) out.push_back(Json::parse(line));
    return out;
  }

 private:
  struct Attitude {
    int inclination, toolface;
  };
  static std::string at(const std::vector<Attitude>& attitudes, const std::string& dwell = "1 s") {
    std::string list;
    for (const Attitude& a : attitudes) {
      list += "{inclination = \"" + std::to_string(a.inclination) + " deg\", toolface = \"" +
              std::to_string(a.toolface) + " deg\"}, ";
    }
    return "dwell = \"" + dwell + "\"\nmotion = \"1 s\"\ndirections = [" + list + "]\n";
  }
};

std::string first_lines(const std::string& text, int count) {
  std::size_t end = 0;
  for (int k = 0; k < count; ++k) end = text.find('\n', end) + 1;
  return text.substr(0, end);
}

bool is_unproven(const Json& verdict) {
  const Json& all = verdict["qualifiers"];
  return std::find(all.begin(), all.end(), "not_yet_validated") != all.end();
}

// Verifies: REQ-172
TEST(RollTest, AToolThatStaysStillIsValidatedFromItsFirstRowOn) {
  const Field where;
  Outcome alone, after;
  const std::vector<Json> without = where.verdicts({}, alone);
  const std::vector<Json> with_it = where.verdicts({"--roll-test", "turned.csv"}, after);
  ASSERT_EQ(alone.code, 0) << alone.err;
  ASSERT_EQ(after.code, 0) << after.err;
  EXPECT_TRUE(alone.err.empty());
  EXPECT_EQ(after.err,
            "plumb: roll test turned.csv: 700 samples, 4 attitudes at rest; validated: a1, a2, a3, a4; "
            "the run begins in nominal\n");
  ASSERT_EQ(without.size(), 300U);
  ASSERT_EQ(with_it.size(), without.size());
  for (std::size_t k = 0; k < without.size(); ++k) {
    EXPECT_EQ(without[k]["state"], "suspect");
    EXPECT_TRUE(is_unproven(without[k]));
    EXPECT_EQ(with_it[k]["state"], "nominal") << k;
    EXPECT_FALSE(is_unproven(with_it[k])) << k;
    // By the log's own time, though it begins before the recording ends; and nothing of the recording is valid.
    EXPECT_EQ(with_it[k]["t_s"], without[k]["t_s"]);
    EXPECT_EQ(with_it[k]["accepted"], true) << k;
    EXPECT_EQ(with_it[k]["validity"], k < 31 ? "invalid" : "valid") << k;
    EXPECT_EQ(with_it[k]["tick"], without[k]["tick"]) << "the blocks are those of the log";
  }
  EXPECT_EQ(with_it.back()["gravity_mps2"], without.back()["gravity_mps2"]);
  const Outcome table = where.monitor({"--roll-test", "turned.csv"});
  EXPECT_TRUE(says(table.out, {"0.000  nominal", "goes on from the roll test", "300 samples"}));
}

/// The monitor's own request is told, and what was shown counts: the run goes on, not validated.
// Negative: REQ-172
TEST(RollTest, TheTurnThatIsMissingIsReported) {
  const Field where;
  Outcome outcome;
  const std::vector<Json> verdicts = where.verdicts({"--roll-test", "rolled.csv"}, outcome);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(says(outcome.err, {"roll test rolled.csv", "8 attitudes at rest",
                                 "not validated: still missing is a turn", "changes gravity by 0.1",
                                 "along (0.000, 0.000, 1.000), the axis of a4", "the run begins in suspect"}));
  EXPECT_TRUE(is_unproven(verdicts.at(299)));
  // Too short for a block.
  where.put("short.csv", first_lines(where.text("turned.csv"), 20));
  const Outcome brief = where.monitor({"--roll-test", "short.csv"});
  EXPECT_EQ(brief.code, 0);
  EXPECT_TRUE(says(brief.err, {"not validated: no block was at rest: hold the tool still for 32 rows"}));
  // The rest of it in the run: what the roll test has shown of the others counts.
  const Outcome both = where.monitor({"--roll-test", "rolled.csv"}, "turned.csv");
  EXPECT_TRUE(says(both.out, {"nominal", "passed_block"}));
}

// Verifies: REQ-172
TEST(RollTest, AnExclusionADoubtAndAFailureGoAlong) {
  const Workshop where;
  const std::string examples = PLUMB_SOURCE_DIR "/examples/";
  for (const std::string name : {"drill_a", "drilling"}) {
    ASSERT_EQ(run(where, {"simulate", examples + name + ".toml", "--out", name + ".csv"}).code, 0);
  }
  const std::string log = where.text("drilling.csv");
  where.put("doubt.csv", first_lines(log, 1700));
  where.put("healthy.csv", first_lines(log, 1300));
  const auto monitor = [&where](const std::string& roll, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"monitor",       "--array",          "array.toml",
                                          "--calibration", "calibration.json", "--log",
                                          "healthy.csv",   "--roll-test",      roll};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(where, arguments);
  };
  const Outcome excluded = monitor("drilling.csv", {});
  EXPECT_EQ(excluded.code, 0) << excluded.err;
  EXPECT_TRUE(says(excluded.err, {"a2 excluded", "validated: a1, a3, a4", "the run begins in degraded"}));
  EXPECT_TRUE(says(excluded.out, {"0.000  degraded", "goes on from the roll test"}));
  const Outcome doubt = monitor("doubt.csv", {});
  EXPECT_TRUE(says(doubt.err,
                   {"ended in suspect (parity: ", "suspected are a", "remedy: a turn", "the run begins in suspect"}));
  EXPECT_TRUE(says(doubt.out, {"0.000  suspect"}));
  const Outcome failed = monitor("drill_a.csv", {});
  EXPECT_EQ(failed.code, 5);
  EXPECT_TRUE(says(failed.err, {"roll test drill_a.csv", "ended in failed, because ", "valid until a reset (--host)"}));
  EXPECT_TRUE(says(failed.out, {"0.000  failed"}));
  // A reset that the host asks of the run, by the run's time.
  const Outcome reset = monitor("drill_a.csv", {"--host", "1s reset a1,a2,a3,a4 key 0x706c756d62"});
  EXPECT_EQ(reset.code, 0) << reset.err;
}

/// Half a roll test is none: the run does not begin, and no file is written.
// Negative: REQ-172
TEST(RollTest, ARecordingThatCannotBeReadEndsTheRunBeforeItBegins) {
  const Field where;
  const std::string good = where.text("turned.csv");
  const auto refused = [&where](const std::string& bytes, const std::vector<std::string>& words) {
    where.put("bad.csv", bytes);
    const Outcome outcome = where.monitor({"--roll-test", "bad.csv", "--events", "events.jsonl"});
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    EXPECT_FALSE(std::filesystem::exists(where / "events.jsonl"));
    return says(outcome.err, words);
  };
  EXPECT_TRUE(refused("", {"bad.csv", "empty"}));
  EXPECT_TRUE(refused(line_of(good, 1) + "\n", {"bad.csv", "no usable row"}));
  EXPECT_TRUE(refused(with(good, ",a3", ",b3"), {"bad.csv", "a3"}));
  const std::string torn = good + "7.5,-1,two,1,1,1\n";
  EXPECT_TRUE(refused(torn, {"bad.csv:702", "Remedy", "of --roll-test; the log was not read"}));
  const Outcome missing = where.monitor({"--roll-test", "nowhere.csv"});
  EXPECT_EQ(missing.code, 3);
  EXPECT_TRUE(says(missing.err, {"nowhere.csv"}));
  where.put("bad.csv", torn);
  const Outcome skipped = where.monitor({"--roll-test", "bad.csv", "--on-bad-row", "skip"});
  EXPECT_EQ(skipped.code, 0) << skipped.err;
  EXPECT_TRUE(says(skipped.err, {"700 samples", "1 bad row skipped", "validated: a1, a2, a3, a4"}));
}

TEST(RollTest, OptionsThatMakeNoSenseAreRefused) {
  const Field where;
  const std::vector<std::vector<std::string>> senseless = {{"--roll-test", "-"},
                                                           {"--roll-test", "turned.csv", "--snapshot-in", "state.bin"},
                                                           {"--roll-test", "turned.csv", "--limits"},
                                                           {"--roll-test", "e.jsonl", "--events", "e.jsonl"}};
  for (const std::vector<std::string>& options : senseless) {
    const Outcome outcome = where.monitor(options);
    EXPECT_EQ(outcome.code, 2) << options.back() << outcome.err;
    EXPECT_TRUE(says(outcome.err, {"--roll-test"}));
  }
  const Outcome first = run(where, {"monitor", "--array", "array.toml", "--calibrate-first", "--log", "still.csv",
                                    "--roll-test", "turned.csv"});
  EXPECT_EQ(first.code, 2);
  EXPECT_TRUE(says(first.err, {"--roll-test", "--calibrate-first"}));
  where.put("array.toml", with(where.text("array.toml"), "[monitor]\n", "[monitor]\nmode = \"paper\"\n"));
  const Outcome paper = where.monitor({"--roll-test", "turned.csv"});
  EXPECT_EQ(paper.code, 2) << paper.err;
  EXPECT_TRUE(says(paper.err, {"--roll-test", "paper"}));
}

TEST(RollTest, IsInTheJsonAndInTheReport) {
  const Field where;
  const Outcome outcome =
      where.monitor({"--roll-test", "turned.csv", "--json", "--report", "r.html", "--snapshot-out", "state.bin"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::size_t last = outcome.out.rfind("{\"summary\"");
  const Json summary = Json::parse(outcome.out.substr(last))["summary"];
  EXPECT_EQ(summary["roll_test"]["samples"], 700);
  EXPECT_EQ(summary["roll_test"]["attitudes"], 4);
  EXPECT_EQ(summary["roll_test"]["validated"], true);
  EXPECT_EQ(summary["roll_test"]["last_verdict"]["state"], "nominal");
  EXPECT_EQ(summary["samples"], 300) << "of the log alone";
  const Json report = Json::parse(where.text("r.json"));
  EXPECT_EQ(report["identity"]["inputs"][2]["role"], "roll test");
  EXPECT_TRUE(says(report["identity"]["command"].get<std::string>(), {"--roll-test turned.csv"}));
  // What it validated is kept as everything else is.
  const Outcome next = where.monitor({"--snapshot-in", "state.bin"});
  EXPECT_EQ(next.code, 0);
  EXPECT_TRUE(says(next.out, {"nominal"}));
  const Outcome none = where.monitor({"--json"});
  EXPECT_FALSE(Json::parse(none.out.substr(none.out.rfind("{\"summary\"")))["summary"].contains("roll_test"));
}

}  // namespace
}  // namespace cli_roll_test_test
