// plumb convert, and every command on a binary log: the same results as on the CSV.
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
  const Outcome there = run(where, convert("drilling.csv", "drilling.plog"));
  ASSERT_EQ(there.code, 0) << there.err;
  EXPECT_TRUE(says(there.out, {"written: drilling.plog (", " rows, 0 bad rows skipped)"}));
  const Outcome back = run(where, convert("drilling.plog", "-"));
  EXPECT_EQ(back.code, 0) << back.err;
  EXPECT_EQ(back.out, where.text("drilling.csv"));
}

TEST(Convert, MonitorSaysTheSameOfBoth) {
  const Workshop where;
  ASSERT_EQ(run(where, convert("drilling.csv", "drilling.plog")).code, 0);
  const Outcome text = run(where, monitor("drilling.csv"));
  const Outcome binary = run(where, monitor("drilling.plog"));
  const Outcome piped = run(where, monitor("-"), "drilling.plog");
  EXPECT_EQ(text.code, binary.code) << binary.err;
  EXPECT_GT(text.out.size(), 100000U);
  EXPECT_EQ(text.out, binary.out);
  EXPECT_EQ(text.out, piped.out) << piped.err;
}

TEST(Convert, CalibrateFindsTheSameInBoth) {
  const Workshop where;
  ASSERT_EQ(run(where, convert("calibration.csv", "calibration.plog")).code, 0);
  for (const char* log : {"calibration.csv", "calibration.plog"}) {
    const Outcome outcome = run(where, {"calibrate", "--array", "array.toml", "--log", log, "--out", "out.json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string text = where.text("out.json");
    where.put((std::string(log) + ".sensors").c_str(), text.substr(text.find("\"sensors\"")));
  }
  EXPECT_EQ(where.text("calibration.csv.sensors"), where.text("calibration.plog.sensors"));
}

TEST(Convert, SimulateAndInjectWriteWhatIsAskedFor) {
  const Workshop where;
  const std::string scenario = PLUMB_SOURCE_DIR "/examples/drilling.toml";
  ASSERT_EQ(run(where, {"simulate", scenario, "--out", "drilling.plog"}).code, 0);
  EXPECT_EQ(run(where, convert("drilling.plog", "-")).out, where.text("drilling.csv"));
  for (const char* out : {"broken.csv", "broken.plog"}) {
    ASSERT_EQ(run(where, {"inject", "--array", "array.toml", "--log", "drilling.plog", "--fault", "a1:stuck=0V@12s",
                          "--out", out})
                  .code,
              0);
  }
  EXPECT_EQ(run(where, monitor("broken.csv")).out, run(where, monitor("broken.plog")).out);
}

TEST(Convert, ACutOffLogKeepsWhatCameBefore) {
  const Workshop where;
  ASSERT_EQ(run(where, convert("drilling.csv", "drilling.plog")).code, 0);
  const std::string log = where.text("drilling.plog");
  where.put("cut.plog", log.substr(0, log.size() / 2));
  const Outcome stopped = run(where, monitor("cut.plog"));
  EXPECT_EQ(stopped.code, 3);
  EXPECT_TRUE(says(stopped.err, {"the results up to t = ", "cut.plog: the log is cut off: a block begins at byte ",
                                 "Remedy: copy or record the log again, or run with --on-bad-row skip"}));
  std::vector<std::string> skipping = monitor("cut.plog");
  skipping.insert(skipping.end(), {"--on-bad-row", "skip"});
  const Outcome skipped = run(where, skipping);
  EXPECT_EQ(skipped.out, stopped.out);
  EXPECT_NE(skipped.code, 3);
  // A file that begins like a binary log and is another one.
  where.put("other.plog", "\x89PNG and more than forty bytes of something else");
  EXPECT_TRUE(
      says(run(where, monitor("other.plog")).err, {"other.plog: header: ", "but its header is wrong", "Remedy:"}));
}

}  // namespace
}  // namespace convert_test
