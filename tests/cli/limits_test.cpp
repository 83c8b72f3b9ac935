// plumb monitor --limits: what the monitor would decide by, before any log is read.
#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace limits_test {
namespace {

using namespace plumb_test;

// Verifies: REQ-178
TEST(MonitorLimitsCommand, SaysThemWithoutALog) {
  const Workshop where;
  const Outcome text =
      run(where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--limits"});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(says(text.out, {"4 sensors", "parity", "length of the vector", "triple, the widest",
                              "left by calibration", "bring no gain at one attitude"}));
  const Outcome json =
      run(where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--limits", "--json"});
  const auto limits = nlohmann::json::parse(json.out)["limits"];
  EXPECT_EQ(limits["sensors"], 4);
  EXPECT_GT(limits["useful_samples"].get<double>(), 1.0);
}

// Verifies: REQ-178
TEST(MonitorLimitsCommand, SaysWhatDeltaFHides) {
  const Workshop where;
  where.put("given.toml", with(where.text("array.toml"), "[monitor]\n", "[monitor]\ndelta_f = \"0.05 g0\"\n"));
  const Outcome outcome =
      run(where, {"monitor", "--array", "given.toml", "--calibration", "calibration.json", "--limits"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"delta_f = 50 mg the triples miss", "deg", "parity still detects"}));
}

// Negative: REQ-178
TEST(MonitorLimitsCommand, RefusesPaperMode) {
  const Workshop where;
  where.put("paper.toml", with(where.text("array.toml"), "[monitor]\n", "[monitor]\nmode = \"paper\"\n"));
  const Outcome fit =
      run(where, {"calibrate", "--array", "paper.toml", "--log", "calibration.csv", "--out", "paper.json"});
  ASSERT_EQ(fit.code, 0) << fit.err;
  const Outcome outcome = run(where, {"monitor", "--array", "paper.toml", "--calibration", "paper.json", "--limits"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(outcome.out.empty());
  EXPECT_TRUE(says(outcome.err, {"monitor.mode", "paper", "Remedy", "--limits"}));
}

}  // namespace
}  // namespace limits_test
