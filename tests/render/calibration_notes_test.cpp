// The date of a calibration: recorded, counted from, and what is said where it is missing.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/tool_runner.hpp"
#include "plumb/io/calibration_file.hpp"

namespace calibration_notes_test {
namespace {

using namespace plumb_test;

/// An array whose sensors state a stability, calibrated with `more` options into cal.json.
void calibrate(const Workshop& where, const std::string& keys, const std::vector<std::string>& more) {
  where.put("stated.toml", with(where.text("array.toml"), "[monitor]\n", "[monitor]\n" + keys));
  std::vector<std::string> arguments = {"calibrate",       "--array", "stated.toml", "--log",
                                        "calibration.csv", "--out",   "cal.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = run(where, arguments);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
}

Outcome monitor(const Workshop& where, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"monitor", "--array", "stated.toml", "--calibration", "cal.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(where, arguments);
}

const std::string kGrows = "stability = \"0.05 mg\"\nstability_per_day = \"5 ug\"\n";

double tolerance_mg(const Outcome& limits) {
  return 1e3 * nlohmann::json::parse(limits.out)["limits"]["drift_tolerance_mps2"].get<double>() / 9.80665;
}

// Verifies: REQ-040
TEST(CalibrationNotes, DateAndSerialNumberAreKeptAndTheDaysCount) {
  const Workshop where;
  calibrate(where, kGrows, {"--date", "2026-03-31", "--serial", "S/N 0042"});
  const auto provenance = nlohmann::json::parse(where.text("cal.json"))["provenance"];
  EXPECT_EQ(provenance["date"], "2026-03-31");
  EXPECT_EQ(provenance["serial"], "S/N 0042");
  const Outcome same = monitor(where, {"--limits", "--json", "--date", "2026-03-31"});
  const Outcome later = monitor(where, {"--limits", "--json", "--date", "2026-04-30"});
  EXPECT_NEAR(tolerance_mg(same), 0.2, 1e-5) << same.err;
  EXPECT_NEAR(tolerance_mg(later), 0.8, 1e-5) << "30 days at 4 x 0.005 mg more";
  const Outcome text = monitor(where, {"--limits", "--date", "2026-04-30"});
  EXPECT_TRUE(says(text.out, {"drift since the calibration allowed for: 0.8 mg in a reading, 4 sigmas"}));
  const Outcome ran = monitor(where, {"--log", "drilling.csv", "--date", "2026-04-30", "--report", "r.html"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(ran.err.empty()) << ran.err;
  EXPECT_TRUE(says(ran.out, {"drift       up to 0.8 mg0 allowed for, 4 sigmas of the stability 30 days after"}));
  EXPECT_TRUE(says(where.text("r.html"), {"30 days after the calibration", "2026-03-31", "S/N 0042"}));
  const auto basis = nlohmann::json::parse(where.text("r.json"))["basis"];
  EXPECT_EQ(basis["drift"]["days_since_calibration"], 30.0);
  EXPECT_EQ(basis["calibration"]["serial"], "S/N 0042");
}

// Negative: REQ-040
TEST(CalibrationNotes, ARunBeforeTheCalibrationIsRefused) {
  const Workshop where;
  calibrate(where, kGrows, {"--date", "2026-03-31"});
  const Outcome before = monitor(where, {"--log", "drilling.csv", "--date", "2026-03-30"});
  EXPECT_EQ(before.code, 2);
  EXPECT_TRUE(before.out.empty());
  EXPECT_TRUE(says(before.err, {"cal.json", "provenance.date", "2026-03-31", "2026-03-30", "before the calibration",
                                "Remedy", "--date"}));
  const Outcome centuries = monitor(where, {"--log", "drilling.csv", "--date", "2190-03-30"});
  EXPECT_EQ(centuries.code, 2);
  EXPECT_TRUE(says(centuries.err, {"a century"}));
  for (const std::string wrong : {"31.03.2026", "2026-02-30", "tomorrow"}) {
    const Outcome outcome = monitor(where, {"--log", "drilling.csv", "--date", wrong});
    EXPECT_EQ(outcome.code, 2) << wrong;
    EXPECT_TRUE(says(outcome.err, {wrong, "is no date", "2026-03-31"}));
  }
}

// Negative: REQ-040
TEST(CalibrationNotes, WithoutADateGrowthPerDayIsReportedAsNotCounted) {
  const Workshop where;
  calibrate(where, kGrows, {});
  EXPECT_FALSE(nlohmann::json::parse(where.text("cal.json"))["provenance"].contains("date"));
  const Outcome grows = monitor(where, {"--limits", "--json", "--date", "2026-04-30"});
  EXPECT_EQ(grows.code, 0);
  EXPECT_NEAR(tolerance_mg(grows), 0.2, 1e-5);
  EXPECT_TRUE(says(
      grows.err, {"stated.toml states stability_per_day", "cal.json has no date", "Remedy", "calibrate with --date"}));
  calibrate(where, "stability = \"0.05 mg\"\n", {});
  EXPECT_EQ(monitor(where, {"--limits"}).err, "") << "what does not grow needs no date";
}

TEST(CalibrationNotes, WhereNoStabilityIsStatedEveryPlaceSaysSo) {
  const Workshop where;
  const Outcome limits =
      run(where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--limits"});
  EXPECT_TRUE(says(limits.out, {"No stability is stated"}));
  const Outcome ran =
      run(where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--log", "drilling.csv"});
  EXPECT_TRUE(says(ran.out, {"drift       none is allowed for: no stability is stated"}));
  EXPECT_TRUE(says(run(where, {"geometry", "array.toml"}).out, {"no stability is stated"}));
}

TEST(CalibrationNotes, TheNoiseOfTheArrayFileCountsAndADifferenceIsReported) {
  const Workshop where;
  const auto limits = [&where] {
    return run(where, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--limits"});
  };
  const Outcome before = limits();
  EXPECT_EQ(before.err, "");
  where.put("array.toml", with(where.text("array.toml"), "noise = ", "noise = \"2 mg0\" # "));
  const Outcome after = limits();
  EXPECT_EQ(after.code, 0);
  EXPECT_TRUE(says(after.err, {"array.toml states another noise of a1 than when calibration.json", "Remedy"}));
  EXPECT_NE(before.out, after.out);
}

/// Writes cal.json anew without the uncertainty of its first `sensors` sensors.
void forget_uncertainty(const Workshop& where, int sensors) {
  const std::string path = where.path() / "cal.json";
  const plumb::io::ArrayFile array = *plumb::io::read_array_file(where.path() / "stated.toml");
  plumb::io::CalibrationFile file = *plumb::io::read_calibration(path, array);
  plumb::RowUncertainty left = file.calibration.array.uncertainty();
  for (int a = 0; a < 4 * array.array.size(); ++a) {
    for (int b = 0; b <= a && b < 4 * sensors; ++b)
      left.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + b)] = 0.0;
  }
  file.calibration.array.set_uncertainty(left);
  ASSERT_TRUE(plumb::io::write_calibration(path, file.calibration, array, file.context).has_value());
}

// Negative: REQ-123
TEST(CalibrationNotes, ACalibrationThatStatesNoUncertaintyIsReportedAsItIsLoaded) {
  const Workshop where;
  calibrate(where, "stability = \"0.05 mg\"\n", {});
  EXPECT_EQ(monitor(where, {"--log", "drilling.csv"}).err, "");
  forget_uncertainty(where, 1);
  const Outcome one = monitor(where, {"--log", "drilling.csv", "--json"});
  EXPECT_TRUE(says(one.err, {"cal.json states no uncertainty (covariance 0) of a1:", "Remedy"}));
  EXPECT_TRUE(says(one.out, {"\"uncertainty_unstated\""}));
  const Outcome geometry = run(where, {"geometry", "stated.toml", "--calibration", "cal.json"});
  EXPECT_TRUE(says(geometry.err, {"plumb: note: cal.json states no uncertainty (covariance 0) of a1:", "Remedy"}));
  const Outcome report = monitor(where, {"--log", "drilling.csv", "--report", "r.html"});
  EXPECT_TRUE(says(report.out, {"  - cal.json states no uncertainty (covariance 0) of a1:", "Remedy"}));
  EXPECT_TRUE(says(where.text("r.json"), {"\"actions\"", "cal.json states no uncertainty"}));
  forget_uncertainty(where, 4);
  EXPECT_TRUE(says(monitor(where, {"--limits"}).err, {"(covariance 0) of any sensor:"}));
}

TEST(CalibrationNotes, ASerialNumberIsShortAndPrintable) {
  const Workshop where;
  for (const std::string& wrong : {std::string(65, 'x'), std::string("caf\xc3\xa9"), std::string()}) {
    const Outcome outcome = run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out",
                                        "cal.json", "--serial", wrong});
    EXPECT_EQ(outcome.code, 2) << wrong;
  }
}

}  // namespace
}  // namespace calibration_notes_test
