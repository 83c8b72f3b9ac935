// The commands on good input: help, pipes, interruption, the printed model.
#include <sys/ioctl.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tool_runner.hpp"

namespace commands_test {
namespace {

using namespace plumb_test;

const std::vector<std::string> kMonitor = {"monitor", "--array", "array.toml", "--calibration", "calibration.json"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Verifies: REQ-175
TEST(Help, EveryCommandSaysWhatItDoesAndItsExitCodes) {
  const Directory where;
  const Outcome top = run(where, {"--help"});
  EXPECT_EQ(top.code, 0);
  for (const char* command : {"demo", "geometry", "calibrate", "monitor", "simulate", "inject", "convert", "model"}) {
    EXPECT_NE(top.out.find(command), std::string::npos) << command;
    const Outcome help = run(where, {command, "--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_TRUE(says(help.out, {"Usage: plumb " + std::string(command), "Example", "plumb " + std::string(command),
                                "Exit codes:", "0  done", "3  a file is unreadable", "5  the monitor ended"}));
  }
}

TEST(Version, IsPrinted) {
  const Directory where;
  const Outcome outcome = run(where, {"--version"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out.substr(0, 6), "plumb ");
}

TEST(Geometry, JsonSaysTheSameAsTheText) {
  const Directory where;
  const auto json = nlohmann::json::parse(run(where, {"geometry", "--name", "cone:5", "--json"}).out);
  EXPECT_EQ(json["sensors"].size(), 5U);
  EXPECT_EQ(json["triples"].size(), 10U);
  EXPECT_EQ(json["figures_of_merit"]["confirmed_grade"], 2);
  const Outcome text = run(where, {"geometry", "--name", "cone:5"});
  EXPECT_TRUE(says(text.out, {"with confirmation", " 2 "}));
}

TEST(Geometry, BuiltInNamesAllWork) {
  const Directory where;
  const std::pair<const char*, std::size_t> arrays[] = {{"paper-tetrahedron", 4}, {"triad", 3},       {"cone:3", 3},
                                                        {"cone:24", 24},          {"cone-axis:8", 8}, {"platonic:3", 3},
                                                        {"platonic:10", 10}};
  for (const auto& [name, sensors] : arrays) {
    const Outcome outcome = run(where, {"geometry", "--name", name, "--json"});
    ASSERT_EQ(outcome.code, 0) << name;
    EXPECT_EQ(nlohmann::json::parse(outcome.out)["sensors"].size(), sensors) << name;
  }
}

TEST(Calibrate, JsonReportIsComplete) {
  const Workshop where;
  const Outcome outcome =
      run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "new.json", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(json["accepted"]);
  EXPECT_EQ(json["stations"].size(), 48U);
  EXPECT_EQ(json["fit"]["rank"], 13);
  EXPECT_EQ(json["sensors"].size(), 4U);
  EXPECT_TRUE(outcome.err.empty()) << "quiet when piped: " << outcome.err;
}

TEST(Calibrate, VerboseListsTheStations) {
  const Workshop where;
  const Outcome outcome = run(
      where, {"calibrate", "--array", "array.toml", "--log", "-", "--out", "new.json", "--verbose"}, "calibration.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"station", "begin s", "48 ", "sensor", "bias", "accepted", "written: new.json"}));
}

TEST(Monitor, ReadsAPipe) {
  const Workshop where;
  const Outcome file = run(where, kMonitor + std::vector<std::string>{"--log", "drilling.csv"});
  const Outcome pipe = run(where, kMonitor + std::vector<std::string>{"--log", "-"}, "drilling.csv");
  EXPECT_EQ(file.code, 0) << file.err;
  EXPECT_EQ(file.out, pipe.out);
  EXPECT_TRUE(says(file.out, {"suspect", "power_on", "nominal", "suspect", "parity", "degraded", "a2", "4100 samples",
                              "in service  a1, a3, a4", "excluded    a2"}));
  EXPECT_TRUE(file.err.empty()) << file.err;
}

TEST(Monitor, JsonIsOneObjectALine) {
  const Workshop where;
  const Outcome outcome = run(where, kMonitor + std::vector<std::string>{"--log", "drilling.csv", "--json"});
  std::istringstream in(outcome.out);
  std::string line;
  std::vector<nlohmann::json> objects;
  while (std::getline(in, line)) objects.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(objects.size(), 4U);
  EXPECT_EQ(objects[2]["sensors"], nlohmann::json({"a2"}));
  EXPECT_EQ(objects[3]["summary"]["state"], "degraded");
  EXPECT_EQ(objects[3]["summary"]["samples"], 4100);
}

TEST(Monitor, EventsToStandardOutputAndJsonAreOneStream) {
  const std::vector<std::string> plain = {"monitor",          "--array", "array.toml",   "--calibration",
                                          "calibration.json", "--log",   "drilling.csv", "--json"};
  std::vector<std::string> both = plain;
  both.insert(both.end(), {"--events", "-"});
  const Outcome once = run(example_files(), plain);
  EXPECT_NE(once.out.find("\"sequence\":1,"), std::string::npos);
  EXPECT_EQ(run(example_files(), both).out, once.out) << "every change once, then the summary";
}

TEST(Monitor, VerdictsPerBlockOrPerSample) {
  const Workshop where;
  const std::vector<std::string> quietly =
      kMonitor + std::vector<std::string>{"--log", "drilling.csv", "--verdicts", "-"};
  const std::string blocks = run(where, quietly).out;
  const std::string samples = run(where, quietly + std::vector<std::string>{"--every-sample"}).out;
  EXPECT_EQ(std::count(blocks.begin(), blocks.end(), '\n'), 76);
  EXPECT_EQ(std::count(samples.begin(), samples.end(), '\n'), 4100);
}

TEST(Monitor, TheHostsResetNeedsItsKey) {
  const Workshop where;
  ASSERT_EQ(run(where, {"inject", "--array", "array.toml", "--log", "drilling.csv", "--fault", "a1:bias=50mg0@15s",
                        "--out", "two.csv"})
                .code,
            0);
  const std::vector<std::string> two = kMonitor + std::vector<std::string>{"--log", "two.csv"};
  const Outcome wrong = run(where, two + std::vector<std::string>{"--host", "40s reset a1 key 5"});
  EXPECT_EQ(wrong.code, 5) << wrong.out;
  EXPECT_TRUE(says(wrong.err, {"--host \"40s reset a1 key 0x5\" was refused", "key does not match", "Remedy: "}));
  const Outcome right = run(where, two + std::vector<std::string>{"--host", "40s reset a1 key 0x706c756d62"});
  EXPECT_EQ(right.code, 0) << right.out << right.err;
  EXPECT_TRUE(says(right.out, {"failed", "suspect", "host_request", "a1"}));
  EXPECT_TRUE(right.err.empty()) << right.err;
  const Outcome late = run(where, two + std::vector<std::string>{"--host", "1h reset a1 key 5"});
  EXPECT_TRUE(says(late.err, {"ended before", "--host"}));
  const Outcome unread = run(where, two + std::vector<std::string>{"--host", "40s reset a7 key 5"});
  EXPECT_EQ(unread.code, 2);
  EXPECT_TRUE(says(unread.err, {"--host", "no sensor 'a7'", "Remedy: "}));
}

TEST(Inject, RefusesASeedThatIsNoSeed) {
  const Workshop where;
  const Outcome outcome = run(where, {"inject", "--array", "array.toml", "--log", "drilling.csv", "--fault",
                                      "a2:random=-3V..3V@20s", "--seed", "-1", "--out", "x.csv"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(says(outcome.err, {"--seed", "whole number from 0 to 2^64 - 1"}));
}

// Negative: REQ-175
TEST(Monitor, TwoFaultsAmongFourEndInFailedWithCodeFive) {
  const Workshop where;
  ASSERT_EQ(run(where, {"inject", "--array", "array.toml", "--log", "drilling.csv", "--fault", "a1:bias=50mg0@15s",
                        "--out", "two.csv"})
                .code,
            0);
  const Outcome outcome = run(where, kMonitor + std::vector<std::string>{"--log", "two.csv"});
  EXPECT_EQ(outcome.code, 5) << outcome.out << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"failed", "isolation_timeout", "state       failed", "in service  none"}));
}

// Negative: REQ-175
TEST(Monitor, ARunWithoutABlockAtRestEndsWithCodeSeven) {
  const Workshop where;
  const std::string log = where.text("drilling.csv");
  where.put("drilling.csv", log.substr(0, log.find(line_of(log, 22))));
  const Outcome outcome = run(where, kMonitor + std::vector<std::string>{"--log", "drilling.csv"});
  EXPECT_EQ(outcome.code, 7) << outcome.out << outcome.err;
  EXPECT_TRUE(says(outcome.err, {"drilling.csv", "nothing was judged", "20 samples", "Remedy"}));
}

TEST(Monitor, BadRowKeepsWhatCameBefore) {
  const Workshop where;
  const std::string log = where.text("drilling.csv");
  where.put("drilling.csv", with(log, "\n" + line_of(log, 2002) + "\n", "\nnot a row\n"));
  const Outcome outcome =
      run(where, kMonitor + std::vector<std::string>{"--log", "drilling.csv", "--events", "events.jsonl"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(says(outcome.err, {"results up to t = 19.99", "drilling.csv:2002"}));
  EXPECT_TRUE(says(outcome.out, {"nominal", "suspect", "2000 samples"}));
  EXPECT_TRUE(says(where.text("events.jsonl"), {"nominal", "suspect"}));
}

TEST(Monitor, InterruptKeepsTheResults) {
  const Workshop where;
  const std::string log = where.text("drilling.csv");
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  const Process process(where, kMonitor + std::vector<std::string>{"--log", "-", "--events", "events.jsonl"}, ends[0],
                        {});
  ::close(ends[0]);
  // A live stream that goes on: the pipe stays open, the tool waits for more when the interrupt comes.
  std::size_t sent = 0;
  const std::size_t part = log.find(line_of(log, 2000));
  while (sent < part) {
    const ssize_t count = ::write(ends[1], log.data() + sent, part - sent);
    ASSERT_GT(count, 0);
    sent += static_cast<std::size_t>(count);
  }
  ASSERT_TRUE(process.says("disagree")) << "the alarm is printed while the stream is open";
  process.interrupt();
  const Outcome outcome = process.wait();
  ::close(ends[1]);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(says(outcome.err, {"interrupted", "kept"}));
  EXPECT_TRUE(says(outcome.out, {"nominal", "suspect", "state       suspect", "in service"}));
  EXPECT_TRUE(says(where.text("events.jsonl"), {"\"to\":\"nominal\"", "\"to\":\"suspect\""}));
}

TEST(Monitor, FollowsALogThatGrows) {
  const Workshop where;
  const std::string log = where.text("drilling.csv");
  const std::size_t part = log.find(line_of(log, 2000)), row = log.find(line_of(log, 1000)) + 7;
  where.put("growing.csv", log.substr(0, row));  // in the middle of a row
  const Process process(where, kMonitor + std::vector<std::string>{"--log", "growing.csv", "--follow"}, -1, {});
  ASSERT_TRUE(process.says("nominal"));
  {
    std::ofstream more(where / "growing.csv", std::ios::app);
    more << log.substr(row, part - row);
  }
  ASSERT_TRUE(process.says("disagree")) << "what was appended is monitored";
  process.interrupt();
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(says(outcome.out, {"nominal", "suspect", " samples"})) << outcome.out;
  // The interrupt may come before the last rows have been read, but not before those that showed the fault.
  std::smatch samples;
  ASSERT_TRUE(std::regex_search(outcome.out, samples, std::regex("([0-9]+) samples"))) << outcome.out;
  EXPECT_GT(std::stoi(samples[1]), 998);
  EXPECT_LE(std::stoi(samples[1]), 1998);
}

TEST(Monitor, FollowIsForFiles) {
  const Workshop where;
  const Outcome outcome = run(where, kMonitor + std::vector<std::string>{"--log", "-", "--follow"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(says(outcome.err, {"--follow", "standard input"})) << outcome.err;
}

TEST(Calibrate, InterruptFitsTheStationsFoundSoFar) {
  const Workshop where;
  const std::string log = where.text("calibration.csv");
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  const Process process(where, {"calibrate", "--array", "array.toml", "--log", "-", "--out", "new.json"}, ends[0], {});
  const std::size_t part = log.find(line_of(log, 30 * 200));
  for (std::size_t sent = 0; sent < part;) {
    const ssize_t count = ::write(ends[1], log.data() + sent, part - sent);
    ASSERT_GT(count, 0);
    sent += static_cast<std::size_t>(count);
  }
  for (int left = 1; left > 0;) ASSERT_EQ(::ioctl(ends[0], FIONREAD, &left), 0);  // until all has been read
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  process.interrupt();
  const Outcome outcome = process.wait();
  ::close(ends[0]);
  ::close(ends[1]);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(says(outcome.out, {"interrupted: the fit uses the stations up to then", "accepted"}));
  EXPECT_TRUE(says(outcome.err, {"interrupted", "stations found before the interruption."}));
  EXPECT_TRUE(std::filesystem::exists(where / "new.json"));
}

TEST(Inject, ChangesOnlyTheNamedChannelFromTheOnsetOn) {
  const Workshop where;
  const Outcome outcome = run(
      where, {"inject", "--array", "array.toml", "--log", "drilling.csv", "--fault", "a1:stuck=0V@12s", "--out", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string before = where.text("drilling.csv");
  EXPECT_EQ(line_of(outcome.out, 1), line_of(before, 1));
  EXPECT_EQ(line_of(outcome.out, 1201), line_of(before, 1201));
  const std::string changed = line_of(outcome.out, 1202);
  EXPECT_EQ(changed.substr(0, 8), "12,-1,0,");
  EXPECT_EQ(changed.substr(8), line_of(before, 1202).substr(line_of(before, 1202).find(',', 6) + 1));
}

TEST(Inject, DepthAndRatesOfTurnTravelWithTheirRow) {
  const Workshop where;
  where.put("array.toml", with(where.text("array.toml"), "[input]\n",
                               "[input]\ndepth = \"md\"\ndepth_unit = \"ft\"\n"
                               "rotation_radps = [\"wx\", \"wy\", \"wz\"]\n"));
  where.put("log.csv",
            "t_s,station,md,wx,wy,wz,a1,a2,a3,a4\n"
            "0,-1,40505.12,0,0,0,1,1,1,3\n0.01,-1,,0,0,0.5,1,1,1,3\n0.02,-1,40505.25,0,0,0,1,1,1,3\n");
  const std::vector<std::string> inject = {"inject", "--array", "array.toml",  "--log",   "log.csv",       "--out",
                                           "-",      "--fault", "log:swap@#1", "--fault", "a1:stuck=0V@0s"};
  const Outcome outcome = run(where, inject);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {",40505.12,0,0,0,0,1,1,3"})) << "in whatever order the rows come";
  EXPECT_TRUE(says(outcome.out, {"0.01,-1,,0,0,0.5,0,1,1,3"}));
  EXPECT_TRUE(says(outcome.out, {",40505.25,0,0,0,0,1,1,3"}));
}

TEST(Inject, SaysSoWhereAFaultNeverBegan) {
  const Workshop where;
  const Outcome outcome = run(where, {"inject", "--array", "array.toml", "--log", "drilling.csv", "--fault",
                                      "a1:stuck=0V@1000s", "--out", "same.csv"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(says(outcome.err, {"a1:stuck=0V@1000s", "changed nothing"}));
  EXPECT_TRUE(where.text("same.csv") == where.text("drilling.csv")) << "what is not in fault is copied bit for bit";
}

TEST(Model, ThreeFormatsOfOneTable) {
  const Directory where;
  const Outcome markdown = run(where, {"model"});
  EXPECT_TRUE(says(markdown.out, {"| event (rank order) | nominal, isolated | suspect | degraded |", "| reset |",
                                  "| exclusion | exclude; by size |", "| passed_block |"}));
  const Outcome dot = run(where, {"model", "--format", "dot"});
  EXPECT_TRUE(says(dot.out, {"digraph plumb {", "\"nominal\" -> \"suspect\"", "}"}));
  EXPECT_EQ(dot.out.find("\"failed\" -> \"nominal\""), std::string::npos);
  const auto json = nlohmann::json::parse(run(where, {"model", "--format", "json"}).out);
  EXPECT_EQ(json["cells"].size(), 7U * 15U);
  for (const auto& cell : json["cells"]) {
    const bool latched =
        cell["mode"] != "failed" || cell["event"] == "reset" || cell["leads_to"] == nlohmann::json({"failed"});
    EXPECT_TRUE(latched) << cell;
  }
}

/// docs/state-machine.svg is `plumb model --format dot | dot -Tsvg`, drawn by some version of Graphviz.
TEST(Model, ThePictureInTheDocsIsOfThisTable) {
  const Directory where;
  std::ifstream file(std::string(PLUMB_SOURCE_DIR) + "/docs/state-machine.svg");
  const std::string picture((std::istreambuf_iterator<char>(file)), {});
  std::istringstream dot(run(where, {"model", "--format", "dot"}).out);
  std::size_t arrows = 0;
  for (std::string line; std::getline(dot, line);) {
    const std::size_t arrow = line.find("\" -> \""), label = line.find("\" [label=\"");
    if (arrow == std::string::npos) continue;
    ++arrows;
    const std::string from = line.substr(3, arrow - 3), to = line.substr(arrow + 6, label - arrow - 6);
    const std::size_t drawn = picture.find("<title>" + from + "&#45;&gt;" + to + "</title>");
    ASSERT_NE(drawn, std::string::npos) << line;
    const std::string group = picture.substr(drawn, picture.find("</g>", drawn) - drawn);
    std::string events = line.substr(label + 10, line.rfind('"') - label - 10);
    for (std::size_t cut; !events.empty(); events = cut == std::string::npos ? "" : events.substr(cut + 2)) {
      cut = events.find("\\n");
      EXPECT_NE(group.find(">" + events.substr(0, cut) + "</text>"), std::string::npos) << line;
    }
  }
  std::size_t titles = 0;
  for (std::size_t at = 0; (at = picture.find("&gt;", at)) != std::string::npos; ++at) ++titles;
  EXPECT_EQ(titles, 2 * arrows) << "each arrow once as a comment, once as a title";
}

TEST(Model, EveryTargetStatesItsCondition) {
  const Directory where;
  const auto json = nlohmann::json::parse(run(where, {"model", "--format", "json"}).out);
  std::map<std::string, std::vector<nlohmann::json>> rows;
  for (const auto& row : json["targets"]) rows[row["target"]].push_back(row);
  const auto& isolation_timeout = rows["stay while bounded or isolable, else failed"];
  ASSERT_EQ(isolation_timeout.size(), 2U);
  EXPECT_EQ(isolation_timeout[0]["when"], nlohmann::json({{"bounded or isolable", false}}));
  EXPECT_EQ(isolation_timeout[0]["to"], "failed");
  EXPECT_EQ(isolation_timeout[1]["to"], "stay");
  EXPECT_EQ(rows["by size"].size(), 4U);
  EXPECT_EQ(rows["by size when enough blocks passed"].size(), 8U);
  for (const auto& cell : json["cells"]) EXPECT_TRUE(rows.count(cell["target"]) == 1) << cell;
}

TEST(Output, FullDiskIsNotSuccess) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Directory where;
  EXPECT_EQ(std::system((std::string(PLUMB_TOOL_PATH) + " model > /dev/full 2> /dev/null").c_str()), 1 << 8);
}

}  // namespace
}  // namespace commands_test
