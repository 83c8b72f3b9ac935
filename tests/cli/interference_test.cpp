// Interference with redundant magnetometers: all of them feel it alike, so nobody is blamed; length, dip and the
// calibration's own residuals tell, or nothing does. docs/fault-catalogue.md, M10 to M13.
#include <string>

#include "tool_runner.hpp"

namespace interference_test {
namespace {

using namespace plumb_test;

const std::string kExamples = std::string(PLUMB_SOURCE_DIR) + "/examples/";

/// The six-axis tool, calibrated, its magnetometers aligned to its accelerometers.
const Directory& desk() {
  static const Directory* const made = [] {
    auto* where = new Directory;
    for (const char* const name : {"six_axis.toml", "six_axis_stand.toml", "six_axis_run.toml"})
      std::filesystem::copy_file(kExamples + name, *where / name);
    const auto done = [where](const std::vector<std::string>& arguments) {
      const Outcome outcome = run(*where, arguments);
      EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    };
    done({"simulate", "six_axis_stand.toml", "--out", "stand.csv"});
    done({"calibrate", "--array", "six_axis.toml", "--log", "stand.csv", "--out", "acc.json"});
    done({"calibrate", "--array", "six_axis.toml#mag", "--log", "stand.csv", "--align-by", "acc.json", "--out",
          "mag.json"});
    return where;
  }();
  return *made;
}

/// The run without its faults, with this interference.
Outcome disturbed(const std::string& interference) {
  const std::string scenario = read_text(desk() / "six_axis_run.toml");
  write_text(desk() / "disturbed.toml",
             scenario.substr(0, scenario.find("[[fault]]")) + "[group.interference]\n" + interference);
  const Outcome played = run(desk(), {"simulate", "disturbed.toml", "--out", "disturbed.csv"});
  EXPECT_EQ(played.code, 0) << played.err;
  return run(desk(), {"monitor", "--array", "six_axis.toml", "--calibration", "acc.json", "--log", "disturbed.csv",
                      "--group", "mag=mag.json"});
}

void expect_nobody_blamed(const Outcome& outcome) {
  EXPECT_TRUE(says(outcome.out, {"in service  a1, a2, a3, a4", "in service  m1, m2, m3, m4"})) << outcome.out;
  EXPECT_EQ(outcome.out.find("excluded    m"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("excluded    a"), std::string::npos) << outcome.out;
}

// Verifies: REQ-255
TEST(InterferenceInTheMonitor, AxialInterferenceKeepsTheGroupFromValidation) {
  const Outcome outcome = disturbed("vector = [\"0 nT\", \"0 nT\", \"3000 nT\"]\n");
  expect_nobody_blamed(outcome);
  EXPECT_TRUE(says(outcome.out, {"calibration_contradicted", "the sensors share a bias"})) << outcome.out;
}

// Verifies: REQ-255
TEST(InterferenceInTheMonitor, AHotSpotOfTheToolContradictsTheDip) {
  const Outcome outcome = disturbed("vector = [\"2500 nT\", \"1500 nT\", \"0 nT\"]\nfrom = \"30 s\"\n");
  expect_nobody_blamed(outcome);
  EXPECT_EQ(outcome.code, 6);
  EXPECT_TRUE(says(outcome.out, {"gravity and the field DISAGREE", "norm_mismatch", "Rely on neither direction"}))
      << outcome.out;
}

// Verifies: REQ-255
TEST(InterferenceInTheMonitor, ACasingTakesTheDirectionOfTheFieldWhileItLasts) {
  const Outcome outcome = disturbed(
      "vector = [\"2000 nT\", \"-1500 nT\", \"1000 nT\"]\nframe = \"ground\"\nfrom = \"40 s\"\nuntil = \"62 s\"\n");
  expect_nobody_blamed(outcome);
  const std::size_t lost = outcome.out.find("norm_mismatch"), back = outcome.out.find("passed_block", lost);
  ASSERT_NE(lost, std::string::npos) << outcome.out;
  EXPECT_NE(back, std::string::npos) << "nominal again once it is past\n" << outcome.out;
}

// Negative: REQ-255
// What no test of this tool shows: the catalogue says so, and this is why.
TEST(InterferenceInTheMonitor, WithinTheLimitsNothingShowsIt) {
  const Outcome outcome = disturbed("vector = [\"0 nT\", \"0 nT\", \"500 nT\"]\n");
  expect_nobody_blamed(outcome);
  EXPECT_EQ(outcome.code, 0) << outcome.out;
  EXPECT_TRUE(says(outcome.out, {"gravity and the field agree"})) << outcome.out;
}

}  // namespace
}  // namespace interference_test
