// plumb monitor on a log that says how the tool turns.
#include <sstream>

#include "tool_runner.hpp"

namespace rotation_test {
namespace {

using namespace plumb_test;

/// The log with three more columns, the same in every row.
std::string turning(const std::string& log, const std::string& rates) {
  std::istringstream in(log);
  std::string line;
  std::string out;
  for (int k = 0; std::getline(in, line); ++k) out += line + (k == 0 ? ",wx,wy,wz" : "," + rates) + "\n";
  return out;
}

/// The array file with those columns, and with every sensor on the axis of rotation where `arms`.
std::string told(std::string array, bool arms) {
  array = with(array, "[input]", "[input]\nrotation_radps = [\"wx\", \"wy\", \"wz\"]");
  for (std::size_t at = array.find("[[sensor]]"); arms && at != std::string::npos;
       at = array.find("[[sensor]]", at + 1))
    array.insert(at + 10, "\nlever_arm_m = [0.0, 0.0, 0.0]");
  return array;
}

std::vector<std::string> monitor(const std::string& array, const std::string& log) {
  return {"monitor", "--array", array, "--calibration", "calibration.json", "--log", log, "--events", "-"};
}

// Verifies: REQ-065
TEST(MonitorRotation, WithKnownArmsATurnIsNoEvidenceOfAnything) {
  const Workshop where;
  const std::string log = where.text("drilling.csv");
  where.put("on_axis.toml", told(where.text("array.toml"), true));
  where.put("turning.csv", turning(log, "0,0,3"));
  const Outcome plain = run(where, monitor("array.toml", "drilling.csv"));
  const Outcome turned = run(where, monitor("on_axis.toml", "turning.csv"));
  EXPECT_EQ(turned.code, plain.code) << turned.err;
  EXPECT_FALSE(plain.out.empty());
  EXPECT_EQ(turned.out, plain.out) << "on the axis a turn is not felt";
}

// Negative: REQ-065
TEST(MonitorRotation, WithoutTheArmsEvidenceRests) {
  const Workshop where;
  where.put("somewhere.toml", told(where.text("array.toml"), false));
  where.put("turning.csv", turning(where.text("drilling.csv"), "0,0,3"));
  where.put("unknown.csv", turning(where.text("drilling.csv"), "0,0,"));
  where.put("still.csv", turning(where.text("drilling.csv"), "0,0,0"));
  EXPECT_TRUE(run(where, monitor("somewhere.toml", "turning.csv")).out.empty());
  EXPECT_TRUE(run(where, monitor("somewhere.toml", "unknown.csv")).out.empty());
  EXPECT_FALSE(run(where, monitor("somewhere.toml", "still.csv")).out.empty());
}

}  // namespace
}  // namespace rotation_test
