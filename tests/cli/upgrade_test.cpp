// plumb upgrade: says what is old, writes where it is told to, and the other commands then read the file.
#include "tool_runner.hpp"

namespace upgrade_command_test {
namespace {

using namespace plumb_test;

TEST(UpgradeCommand, ReportsWithoutWritingAndThenWritesInPlace) {
  const Workshop where;
  const std::string today = where.text("array.toml");
  const std::string old = with(today, "[monitor]\n", "[monitor]\npatience = 9  # attitudes\n");
  where.put("array.toml", old);
  const Outcome refused = run(where, {"geometry", "array.toml"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(says(refused.err,
                   {"monitor.patience", "renamed \"isolation_timeout\"", "`plumb upgrade array.toml --in-place`"}));
  const Outcome told = run(where, {"upgrade", "array.toml"});
  EXPECT_EQ(told.code, 0) << told.err;
  EXPECT_TRUE(says(told.out, {"array.toml:", "monitor: patience -> isolation_timeout"}));
  EXPECT_EQ(where.text("array.toml"), old);
  const Outcome done = run(where, {"upgrade", "array.toml", "--in-place"});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(says(done.out, {"patience -> isolation_timeout", "written: array.toml"}));
  EXPECT_EQ(where.text("array.toml"), with(today, "[monitor]\n", "[monitor]\nisolation_timeout = 9  # attitudes\n"));
  EXPECT_EQ(run(where, {"geometry", "array.toml"}).code, 0);
  const Outcome again = run(where, {"upgrade", "array.toml", "--in-place"});
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(again.out, "array.toml: no old key found\n");
}

TEST(UpgradeCommand, WritesToAnotherFileOrToStandardOutput) {
  const Workshop where;
  const std::string today = where.text("array.toml");
  where.put("old.toml", with(today, "[monitor]\n", "[monitor]\nclean_blocks = 3\n"));
  const std::string now = with(today, "[monitor]\n", "[monitor]\npassed_blocks = 3\n");
  EXPECT_EQ(run(where, {"upgrade", "old.toml", "--output", "new.toml"}).code, 0);
  EXPECT_EQ(where.text("new.toml"), now);
  EXPECT_EQ(run(where, {"upgrade", "old.toml", "--output", "-"}).out, now);
  EXPECT_EQ(run(where, {"upgrade", "new.toml", "--output", "-"}).out, now) << "what is not old comes out as it is";
}

TEST(UpgradeCommand, RefusesWhatItCannotDo) {
  const Workshop where;
  where.put("drift.toml",
            with(where.text("array.toml"), "[monitor]\n", "[monitor]\npatience = 3\ndrift_bias = \"1 mg\"\n"));
  const std::string drift = where.text("drift.toml");
  const Outcome by_hand = run(where, {"upgrade", "drift.toml", "--in-place"});
  EXPECT_EQ(by_hand.code, 3);
  EXPECT_TRUE(says(by_hand.err, {"drift_bias", "stability = \"0.2 mg\""}));
  EXPECT_EQ(where.text("drift.toml"), drift);
  EXPECT_EQ(run(where, {"upgrade", "drilling.csv"}).code, 3);
  EXPECT_EQ(run(where, {"upgrade", "nothing.toml"}).code, 3);
  EXPECT_EQ(run(where, {"upgrade"}).code, 2);
  EXPECT_EQ(run(where, {"upgrade", "array.toml", "--in-place", "--output", "b.toml"}).code, 2);
  EXPECT_EQ(run(where, {"upgrade", "array.toml", "--output", "array.toml"}).code, 2);
}

TEST(UpgradeCommand, ARenamedOptionIsReported) {
  const Workshop where;
  EXPECT_TRUE(
      says(run(where, {"verify", "--positions", "x.csv"}).err, {"\"--positions\" was renamed to \"--stations\""}));
  EXPECT_TRUE(
      says(run(where, {"calibrate", "--roll-wobble-deg", "1"}).err, {"renamed to \"--roll-axis-deviation-deg\""}));
}

}  // namespace
}  // namespace upgrade_command_test
