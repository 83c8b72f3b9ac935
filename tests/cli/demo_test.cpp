// plumb demo: what it writes, that it tells the truth about it, and that the same seed gives the same bytes.
#include <algorithm>

#include "tool_runner.hpp"

namespace {

using namespace plumb_test;

const std::vector<std::string> kFiles = {"array.toml",   "calibration.csv", "drilling.csv", "calibration.json",
                                         "events.jsonl", "verdicts.jsonl",  "timeline.csv", "timeline.gp",
                                         "timeline.svg", "index.html"};

bool has_gnuplot() { return std::system("command -v gnuplot > /dev/null 2>&1") == 0; }

TEST(Demo, SameSeedSameBytesWhereverItIsRun) {
  const Directory other;
  ASSERT_EQ(run(other, {"demo", "--out", "deeper/down"}).code, 0);
  for (const std::string& name : kFiles) {
    if (name == "timeline.svg" && !has_gnuplot()) continue;
    const std::string here = read_text(demo().path() / name);
    EXPECT_FALSE(here.empty()) << name;
    EXPECT_TRUE(here == read_text(other.path() / "deeper/down" / name)) << name << " differs between two runs";
    EXPECT_EQ(here.find(demo().path().string()), std::string::npos) << name << " holds a path of this machine";
  }
}

TEST(Demo, AnotherSeedIsAnotherTool) {
  const Directory other;
  ASSERT_EQ(run(other, {"demo", "--out", ".", "--seed", "2"}).code, 0);
  for (const char* name : {"calibration.csv", "drilling.csv", "calibration.json", "verdicts.jsonl"}) {
    EXPECT_NE(read_text(demo() / name), read_text(other / name)) << name;
  }
  EXPECT_EQ(read_text(demo() / "array.toml"), read_text(other / "array.toml")) << "the datasheet is the same";
}

TEST(Demo, TheDeadSensorIsFoundAndNobodyElseIsBlamed) {
  const std::string events = read_text(demo() / "events.jsonl");
  EXPECT_TRUE(says(events, {"\"to\":\"nominal\"", "\"to\":\"suspect\"", "\"cause\":\"parity\"", "\"to\":\"degraded\"",
                            "\"cause\":\"isolated_fault\"", "\"grade\":\"strict\"", "\"sensors\":[\"a2\"]"}));
  EXPECT_EQ(std::count(events.begin(), events.end(), '\n'), 3) << events;
  const std::string verdicts = read_text(demo() / "verdicts.jsonl");
  const std::string last = verdicts.substr(verdicts.rfind('\n', verdicts.size() - 2) + 1);
  EXPECT_TRUE(says(last, {"\"state\":\"degraded\"", "\"in_service\":[\"a1\",\"a3\",\"a4\"]", "\"excluded\":[\"a2\"]"}));
}

TEST(Demo, StaysWithinItsWordInEveryBlock) {
  std::istringstream in(read_text(demo() / "timeline.csv"));
  std::string line;
  std::getline(in, line);
  int bounded = 0;
  int vouched = 0;
  while (std::getline(in, line)) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',') {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    ASSERT_EQ(cells.size(), 14U) << line;
    const double error_deg = std::abs(std::stod(cells[11]));
    if (cells[2] == "valid" || cells[2] == "degraded") {
      ++vouched;
      EXPECT_LT(error_deg, 0.05) << line;
    }
    if (!cells[13].empty()) {
      ++bounded;
      EXPECT_LE(error_deg, std::stod(cells[13])) << line;
    }
  }
  EXPECT_GT(bounded, 20);
  EXPECT_GT(vouched, 30);
}

TEST(Demo, TheSameResultsByHand) {
  const Workshop where;
  ASSERT_EQ(
      run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "calibration.json"}).code,
      0);
  ASSERT_EQ(run(where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--log",
                        "drilling.csv", "--events", "events.jsonl", "--verdicts", "verdicts.jsonl"})
                .code,
            0);
  for (const char* name : {"calibration.json", "events.jsonl", "verdicts.jsonl"}) {
    EXPECT_TRUE(where.text(name) == read_text(demo() / name)) << name;
  }
}

TEST(Demo, ThePageIsSelfContainedAndSaysWhatHappened) {
  const std::string page = read_text(demo() / "index.html");
  EXPECT_EQ(page.find("http"), std::string::npos) << "nothing is loaded from the network, nor pretends to be";
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos) << "every placeholder is filled";
  EXPECT_TRUE(says(page, {"What happened", "goes dead", "unconfirmed", "a2 is excluded", "isolated_fault",
                          "plumb calibrate", "events.jsonl"}));
  for (const std::string& name : kFiles) {
    const bool linked = page.find("href=\"" + name + "\"") != std::string::npos;
    EXPECT_TRUE(linked || name == "timeline.gp" || name == "index.html") << name;
  }
  EXPECT_EQ(page.find("<svg") != std::string::npos, has_gnuplot());
}

TEST(Demo, WithoutGnuplotItSaysSoAndWritesTheRest) {
  const Directory where;
  const Outcome outcome = run(where, {"demo", "--out", "."}, "", {"PATH=/nonexistent"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.err, {"gnuplot", "not installed", "apt-get install gnuplot"}));
  EXPECT_TRUE(says(read_text(where / "index.html"), {"There is no plot", "gnuplot"}));
  EXPECT_FALSE(std::filesystem::exists(where / "timeline.svg"));
  EXPECT_TRUE(read_text(where / "events.jsonl") == read_text(demo() / "events.jsonl"));
}

}  // namespace
