// A run in two parts with a snapshot between them, and snapshots that the tool will not go on from.
#include "plumb/health/snapshot.hpp"
#include "plumb/core/version.hpp"
#include "tool_runner.hpp"

namespace cli_snapshot_test {
namespace {

using namespace plumb_test;

/// Lines `first` .. `last` of a log, under its header.
std::string part(const std::string& log, int first, int last) {
  std::istringstream in(log);
  std::string line;
  std::string out;
  for (int k = 0; std::getline(in, line); ++k) {
    if (k == 0 || (k >= first && k <= last)) out += line + "\n";
  }
  return out;
}

std::vector<std::string> monitor(const std::string& log, std::vector<std::string> more) {
  std::vector<std::string> out = {"monitor", "--array",    "array.toml", "--calibration", "calibration.json", "--log",
                                  log,       "--verdicts", "-",          "--every-sample"};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

// Verifies: REQ-163
TEST(MonitorSnapshot, TwoPartsWithASnapshotBetweenThemAreOneRun) {
  const Workshop where;
  const std::string log = where.text("drilling.csv");
  // Cut within a block, after a2 has died and before it is excluded.
  where.put("one.csv", part(log, 1, 2345));
  where.put("two.csv", part(log, 2346, 1 << 30));
  const Outcome whole = run(where, monitor("drilling.csv", {}));
  const Outcome one = run(where, monitor("one.csv", {"--snapshot-out", "state.bin"}));
  const Outcome two = run(where, monitor("two.csv", {"--snapshot-in", "state.bin", "--snapshot-out", "state.bin"}));
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(two.code, whole.code) << two.err;
  EXPECT_EQ(one.out + two.out, whole.out);
  EXPECT_TRUE(says(two.out, {"\"excluded\":[\"a2\"]"}));
  // The end of the second part in turn: the exclusion is known from the first sample on.
  where.put("three.csv", part(log, 1, 5));
  const Outcome table = run(where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--log",
                                    "three.csv", "--snapshot-in", "state.bin"});
  EXPECT_TRUE(says(table.out, {"degraded", "goes on from the snapshot", "excluded    a2"}));
}

/// Refused with the name of the file, of the cause and of the way out; nothing runs as if nothing had been asked.
// Negative: REQ-163
TEST(MonitorSnapshot, ImplausibleValuesAreRefusedByName) {
  const Workshop where;
  ASSERT_EQ(run(where, monitor("drilling.csv", {"--snapshot-out", "state.bin"})).code, 0);
  const std::string good = where.text("state.bin");
  const auto refused = [&](const std::string& bytes, const std::vector<std::string>& words) {
    where.put("state.bin", bytes);
    const Outcome outcome = run(where, monitor("drilling.csv", {"--snapshot-in", "state.bin"}));
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_TRUE(outcome.out.empty());
    return says(outcome.err, words);
  };
  std::string damaged = good;
  damaged[300] = static_cast<char>(damaged[300] ^ 4);
  EXPECT_TRUE(refused(damaged, {"state.bin", "damaged", "leave out --snapshot-in"}));
  EXPECT_TRUE(refused(good.substr(0, good.size() / 2), {"state.bin", "ends too early"}));
  EXPECT_TRUE(refused(good + "garbage", {"state.bin", "7 bytes behind the end", "leave out --snapshot-in"}));
  EXPECT_TRUE(refused("", {"state.bin", "ends too early"}));
  EXPECT_TRUE(refused(where.text("drilling.csv"), {"state.bin", "not a snapshot"}));
  where.put("array.toml", with(where.text("array.toml"), "[monitor]\n", "[monitor]\npassed_blocks = 4\n"));
  EXPECT_TRUE(refused(good, {"state.bin", "another configuration"}));
  std::filesystem::remove(where / "state.bin");
  const Outcome missing = run(where, monitor("drilling.csv", {"--snapshot-in", "state.bin"}));
  EXPECT_EQ(missing.code, 3);
  EXPECT_TRUE(says(missing.err, {"state.bin"}));
}

TEST(MonitorSnapshot, OptionsThatMakeNoSenseAreRefused) {
  const Workshop where;
  const std::vector<std::vector<std::string>> senseless = {{"--snapshot-out", "-"},
                                                           {"--snapshot-in", "-"},
                                                           {"--snapshot-out", "calibration.json"},
                                                           {"--snapshot-in", "e.jsonl", "--events", "e.jsonl"}};
  for (const std::vector<std::string>& options : senseless) {
    const Outcome outcome = run(where, monitor("drilling.csv", options));
    EXPECT_EQ(outcome.code, 2) << options[0] << options[1] << outcome.err;
    EXPECT_TRUE(says(outcome.err, {"--snapshot"}));
  }
}

TEST(Version, IsTheNumberThatSnapshotsCarry) {
  const Directory where;
  const std::uint32_t v = plumb::kLibraryVersion;
  const std::string expected =
      "plumb " + std::to_string(v >> 16U) + "." + std::to_string(v >> 8U & 255U) + "." + std::to_string(v & 255U);
  EXPECT_EQ(run(where, {"--version"}).out, expected + "\n");
}

}  // namespace
}  // namespace cli_snapshot_test
