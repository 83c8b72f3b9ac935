// plumb convert, and every command on a ULog that plumb wrote: the same results as on the CSV.
#include "tool_runner.hpp"

namespace convert_test {
namespace {

using namespace plumb_test;

std::vector<std::string> convert(const std::string& log, const std::string& out) {
  return {"convert", "--array", "array.toml", "--log", log, "--out", out};
}

std::vector<std::string> monitor(const std::string& log) {
  return {"monitor", "--array",    "array.toml", "--calibration", "calibration.json", "--log",
          log,       "--verdicts", "-",          "--every-sample"};
}

TEST(Convert, ThereAndBackIsTheSameLog) {
  const Workshop where;
  const Outcome there = run(where, convert("drilling.csv", "drilling.ulg"));
  ASSERT_EQ(there.code, 0) << there.err;
  EXPECT_TRUE(says(there.out, {"written: drilling.ulg (", " rows, 0 bad rows skipped)"}));
  const Outcome back = run(where, convert("drilling.ulg", "-"));
  EXPECT_EQ(back.code, 0) << back.err;
  EXPECT_EQ(back.out, where.text("drilling.csv"));
}

TEST(Convert, MonitorSaysTheSameOfBoth) {
  const Workshop where;
  ASSERT_EQ(run(where, convert("drilling.csv", "drilling.ulg")).code, 0);
  const Outcome text = run(where, monitor("drilling.csv"));
  const Outcome binary = run(where, monitor("drilling.ulg"));
  const Outcome piped = run(where, monitor("-"), "drilling.ulg");
  EXPECT_EQ(text.code, binary.code) << binary.err;
  EXPECT_GT(text.out.size(), 100000U);
  EXPECT_EQ(text.out, binary.out);
  EXPECT_EQ(text.out, piped.out) << piped.err;
}

TEST(Convert, CalibrateFindsTheSameInBoth) {
  const Workshop where;
  ASSERT_EQ(run(where, convert("calibration.csv", "calibration.ulg")).code, 0);
  for (const char* log : {"calibration.csv", "calibration.ulg"}) {
    const Outcome outcome = run(where, {"calibrate", "--array", "array.toml", "--log", log, "--out", "out.json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string text = where.text("out.json");
    where.put((std::string(log) + ".sensors").c_str(), text.substr(text.find("\"sensors\"")));
  }
  EXPECT_EQ(where.text("calibration.csv.sensors"), where.text("calibration.ulg.sensors"));
}

TEST(Convert, SimulateAndInjectWriteWhatIsAskedFor) {
  const Workshop where;
  const std::string scenario = PLUMB_SOURCE_DIR "/examples/drilling.toml";
  ASSERT_EQ(run(where, {"simulate", scenario, "--out", "drilling.ulg"}).code, 0);
  EXPECT_EQ(run(where, convert("drilling.ulg", "-")).out, where.text("drilling.csv"));
  for (const char* out : {"broken.csv", "broken.ulg"}) {
    ASSERT_EQ(run(where, {"inject", "--array", "array.toml", "--log", "drilling.ulg", "--fault", "a1:stuck=0V@12s",
                          "--out", out})
                  .code,
              0);
  }
  EXPECT_EQ(run(where, monitor("broken.csv")).out, run(where, monitor("broken.ulg")).out);
}

TEST(Convert, ACutOffLogKeepsWhatCameBefore) {
  const Workshop where;
  ASSERT_EQ(run(where, convert("drilling.csv", "drilling.ulg")).code, 0);
  const std::string log = where.text("drilling.ulg");
  where.put("cut.ulg", log.substr(0, log.size() / 2));
  const Outcome stopped = run(where, monitor("cut.ulg"));
  EXPECT_EQ(stopped.code, 3);
  EXPECT_TRUE(says(stopped.err, {"the results up to t = ", "cut.ulg: the log is cut off: a block begins at byte ",
                                 "Remedy: copy or record the log again, or run with --on-bad-row skip"}));
  std::vector<std::string> skipping = monitor("cut.ulg");
  skipping.insert(skipping.end(), {"--on-bad-row", "skip"});
  const Outcome skipped = run(where, skipping);
  EXPECT_EQ(skipped.out, stopped.out);
  EXPECT_NE(skipped.code, 3);
}

TEST(Convert, ToDecidesWhateverTheNameIs) {
  const Workshop where;
  std::vector<std::string> there = convert("drilling.csv", "drilling.bin");
  there.insert(there.end(), {"--to", "ulog"});
  ASSERT_EQ(run(where, there).code, 0);
  EXPECT_EQ(where.text("drilling.bin").substr(0, 4), "ULog");
  std::vector<std::string> back = convert("drilling.bin", "back.ulg");
  back.insert(back.end(), {"--to", "csv"});
  ASSERT_EQ(run(where, back).code, 0);
  EXPECT_EQ(where.text("back.ulg"), where.text("drilling.csv"));
  std::vector<std::string> piped = convert("-", "-");
  piped.insert(piped.end(), {"--to", "ulog"});
  EXPECT_EQ(run(where, piped, "drilling.csv").out, where.text("drilling.bin"));
  std::vector<std::string> other = convert("drilling.csv", "x.csv");
  other.insert(other.end(), {"--to", "plog"});
  EXPECT_EQ(run(where, other).code, 2);
}

TEST(Convert, LogsOfOthersAreNamedForWhatTheyAreAndSayTheWay) {
  const Workshop where;
  where.put("px4.ulg", std::string("ULog\x01\x12\x35\x01", 8) + std::string(300, '\0'));
  const Outcome px4 = run(where, monitor("px4.ulg"));
  EXPECT_EQ(px4.code, 3);
  EXPECT_TRUE(
      says(px4.err, {"px4.ulg: header: is a ULog that plumb did not write", "PX4", "plumb import LOG --out DIR"}));
  where.put("old.plog", std::string("\x89PLOG\r\n\x1A", 8) + std::string(300, '\0'));
  const Outcome old = run(where, monitor("old.plog"));
  EXPECT_EQ(old.code, 3);
  EXPECT_TRUE(says(old.err, {"old.plog: is a .plog, the binary log of plumb", "read no longer", "plumb convert"}));
  const Outcome written = run(where, convert("drilling.csv", "new.plog"));
  EXPECT_EQ(written.code, 3);
  EXPECT_TRUE(says(written.err, {"new.plog: ends in .plog", "name it .ulg"}));
  // And the other way round: what needs no array file says who reads the log of one.
  ASSERT_EQ(run(where, convert("drilling.csv", "drilling.ulg")).code, 0);
  const Outcome reviewed = run(where, {"review", "drilling.ulg"});
  EXPECT_TRUE(says(reviewed.err + reviewed.out, {"is a ULog that plumb wrote", "plumb monitor"})) << reviewed.err;
}

}  // namespace
}  // namespace convert_test
