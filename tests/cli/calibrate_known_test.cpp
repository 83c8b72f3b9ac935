// plumb calibrate --from and --export as a user sees them.
#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace calibrate_known_test {
namespace {

using namespace plumb_test;
using Json = nlohmann::json;

const std::string kDrone = PLUMB_SOURCE_DIR "/examples/motion/drone.toml";
const std::vector<std::string> kUncertainty = {"--uncertainty", "bias=5 mg, scale=1000 ppm, axis=0.5 deg"};

std::string vehicle_params() {
  std::string out = "# Onboard parameters for Vehicle 1\n# Vehicle-Id Component-Id Name Value Type\n";
  for (int chip = 0; chip < 3; ++chip) {
    const std::string name = "1\t1\tCAL_ACC" + std::to_string(chip) + "_";
    out += name + "ID\t" + std::to_string(1310988 + chip) + "\t6\n";
    for (const char* axis : {"X", "Y", "Z"}) {
      out += name + axis + "OFF\t0.0" + std::to_string(chip + 1) + "\t9\n";
      out += name + axis + "SCALE\t1.00" + std::to_string(chip + 1) + "\t9\n";
    }
  }
  return out;
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A directory with the drone and the parameters of its vehicle.
class Bench : public Directory {
 public:
  Bench() {
    write_text(*this / "drone.toml", read_text(kDrone));
    write_text(*this / "v.params", vehicle_params());
  }
  Outcome take(const std::vector<std::string>& more = {}) const {
    return run(*this, joined({"calibrate", "--array", "drone.toml", "--from", "v.params", "--out", "cal.json"}, more));
  }
  Outcome give(const std::string& form, const std::string& out, const std::vector<std::string>& more = {}) const {
    return run(*this, joined({"calibrate", "--array", "drone.toml", "--calibration", "cal.json", "--export", form,
                              "--out", out},
                             more));
  }
};

TEST(CalibrateKnown, ParametersOfAVehicleBecomeACalibrationThatIsNotValidated) {
  const Bench bench;
  const Outcome taken = bench.take(joined(kUncertainty, {"--serial", "0042", "--date", "2026-03-31"}));
  ASSERT_EQ(taken.code, 0) << taken.err;
  EXPECT_TRUE(says(taken.out,
                   {"drone: calibration from known coefficients (px4, v.params)", "not validated", "nothing was fitted",
                    "CAL_ACC1: x, y, z are x2, y2, z2", "at 25 degC", "z3", "written: cal.json"}));
  const Json file = Json::parse(read_text(bench / "cal.json"));
  EXPECT_EQ(file["provenance"]["coefficients"], "px4");
  EXPECT_EQ(file["provenance"]["serial"], "0042");
  EXPECT_EQ(file["report"]["stations"], 0);
  for (const auto& line : {taken.out}) {
    for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 1) {
      end = line.find('\n', at);
      EXPECT_LE(std::min(end, line.size()) - at, 118U);
    }
  }
}

TEST(CalibrateKnown, ItsReportAsJson) {
  const Bench bench;
  const Outcome taken = bench.take(joined(kUncertainty, {"--json", "--use-range-degc=-10,60"}));
  ASSERT_EQ(taken.code, 0) << taken.err;
  const Json report = Json::parse(taken.out);
  EXPECT_EQ(report["coefficients"], "px4");
  EXPECT_EQ(report["validated"], false);
  EXPECT_EQ(report["fitted"], false);
  EXPECT_EQ(report["temperature_min_degc"], -10.0);
  EXPECT_EQ(report["chips"][2]["channels"], Json({"x3", "y3", "z3"}));
  EXPECT_EQ(report["sensors"].size(), 9U);
  EXPECT_EQ(report["sensors"][0]["sigma"]["scale"], 1e-3);
}

TEST(CalibrateKnown, AMonitorSaysThatNothingHasTestedItAndValidatesIt) {
  const Workshop shop;
  const Outcome given = run(shop, {"calibrate", "--array", "array.toml", "--calibration", "calibration.json",
                                   "--export", "csv", "--out", "known.csv"});
  ASSERT_EQ(given.code, 0) << given.err;
  const Outcome taken = run(shop, {"calibrate", "--array", "array.toml", "--from", "known.csv", "--out", "known.json"});
  ASSERT_EQ(taken.code, 0) << taken.err;
  const Outcome watched = run(shop, {"monitor", "--array", "array.toml", "--calibration", "known.json", "--log",
                                     "calibration.csv", "--report", "health.html"});
  ASSERT_EQ(watched.code, 0) << watched.err;
  EXPECT_TRUE(says(watched.err, {"known.json was not fitted", "known coefficients (csv, known.csv)", "Remedy: hold"}));
  EXPECT_TRUE(says(watched.out, {"Not yet validated", "nominal"}));
  EXPECT_NE(shop.text("health.html").find("Nothing was fitted"), std::string::npos);
  const Json health = Json::parse(shop.text("health.json"));
  EXPECT_EQ(health["basis"]["calibration"]["coefficients"], "csv");
  EXPECT_TRUE(health["basis"]["calibration"]["p_value"].is_null());
}

TEST(CalibrateKnown, AMissingUncertaintyIsAskedFor) {
  const Bench bench;
  const Outcome refused = bench.take();
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(says(refused.err, {"v.params: CAL_ACC0 x: x1: states no uncertainty of bias, scale, axis",
                                 "Remedy:", "--uncertainty"}));
  EXPECT_FALSE(std::filesystem::exists(bench / "cal.json"));
  const Outcome wrong = bench.take({"--uncertainty", "bias=5 g"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(says(wrong.err, {"--uncertainty", "ambiguous"}));
}

TEST(CalibrateKnown, EveryFormIsWrittenAndReadBack) {
  const Bench bench;
  ASSERT_EQ(bench.take(kUncertainty).code, 0);
  const Json before = Json::parse(read_text(bench / "cal.json"));
  for (const std::string form : {"px4", "ardupilot", "csv", "json"}) {
    const Outcome given = bench.give(form, "out");
    ASSERT_EQ(given.code, 0) << given.err;
    EXPECT_TRUE(says(given.out, {"calibration as " + form, "lost", "nothing", "written: out"}));
    const Outcome again =
        run(bench, joined({"calibrate", "--array", "drone.toml", "--from", "out", "--out", "back.json"},
                          form == "csv" || form == "json" ? std::vector<std::string>{} : kUncertainty));
    ASSERT_EQ(again.code, 0) << again.err;
    const Json after = Json::parse(read_text(bench / "back.json"));
    EXPECT_EQ(after["provenance"]["coefficients"], form);
    for (std::size_t i = 0; i < 9; ++i) {
      const double a = before["sensors"][i]["scale"][0], b = after["sensors"][i]["scale"][0];
      EXPECT_NEAR(a, b, form == "csv" || form == "json" ? 0.0 : 1e-7) << form;
    }
  }
}

TEST(CalibrateKnown, ImuTkHoldsOneChip) {
  const Bench bench;
  ASSERT_EQ(bench.take(kUncertainty).code, 0);
  const Outcome refused = bench.give("imu_tk", "out");
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(says(refused.err, {"has 3 chips", "--instance 1=imu1"}));
  EXPECT_FALSE(std::filesystem::exists(bench / "out"));
  for (const std::string chip : {"1", "2", "3"}) {
    const Outcome given = bench.give("imu_tk", "imu" + chip, {"--instance", "1=imu" + chip, "--json"});
    ASSERT_EQ(given.code, 0) << given.err;
    EXPECT_EQ(Json::parse(given.out)["left_out"].size(), 6U);
  }
  const Outcome again = run(bench, joined({"calibrate", "--array", "drone.toml", "--from", "imu1", "--from", "imu2",
                                           "--from", "imu3", "--form", "imu_tk", "--out", "back.json"},
                                          kUncertainty));
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(says(again.out, {"(imu_tk, imu1, imu2, imu3)", "imu2: x, y, z are x2, y2, z2"}));
}

TEST(CalibrateKnown, StandardOutputHoldsTheFileAlone) {
  const Bench bench;
  ASSERT_EQ(bench.take(kUncertainty).code, 0);
  const Outcome given = bench.give("ardupilot", "-");
  ASSERT_EQ(given.code, 0);
  EXPECT_TRUE(says(given.out, {"# accelerometer calibration of drone", "INS_ACC3SCAL_Z,1.003\n"}));
  EXPECT_EQ(given.out.find("lost"), std::string::npos);
  EXPECT_TRUE(says(given.err, {"lost", "note"}));
}

TEST(CalibrateKnown, OptionsThatDoNotBelongTogetherAreRefused) {
  const Bench bench;
  const std::vector<std::string> base = {"calibrate", "--array", "drone.toml", "--out", "cal.json"};
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--from", "v.params", "--log", "x.csv"}, "--log: belongs to a calibration from a log, not to --from"},
      {{"--from", "v.params", "--hold-out", "4"}, "--hold-out: belongs to a calibration from a log, not to --from"},
      {{"--from", "v.params", "--keep-outliers"}, "--keep-outliers: belongs to a calibration from a log"},
      {{"--from", "v.params", "--temperature-order", "1"}, "--temperature-order: belongs to a calibration from a log"},
      {{"--from", "v.params", "--export", "px4"}, "--export: does not go with --from"},
      {{"--from", "v.params", "--calibration", "c.json"}, "--calibration: does not go with --from"},
      {{"--from", "v.params", "--motion", "m.csv"}, "--motion: does not go with --from"},
      {{"--export", "px4"}, "--export: needs the calibration"},
      {{"--export", "px4", "--calibration", "c.json", "--date", "2026-01-01"}, "--date: belongs to"},
      {{"--log", "x.csv", "--form", "px4"}, "--form: belongs to --from"},
      {{"--log", "x.csv", "--instance", "0=imu1"}, "--instance: belongs to --from and --export"},
      {{"--log", "x.csv", "--uncertainty", "bias=1 mg"}, "--uncertainty: belongs to --from"},
      {{"--from", "v.params", "--form", "px5"}, "px4, ardupilot, imu_tk, csv or json"},
      {{"--from", "v.params", "--instance", "imu1"}, "is no number"},
      {{}, "--log: is required"}};
  for (const auto& [arguments, words] : cases) {
    const Outcome refused = run(bench, joined(base, arguments));
    EXPECT_EQ(refused.code, 2) << words;
    EXPECT_TRUE(says(refused.err, {words}));
  }
  const Outcome same = run(
      bench, joined({"calibrate", "--array", "drone.toml", "--from", "v.params", "--out", "v.params"}, kUncertainty));
  EXPECT_EQ(same.code, 2) << same.err;
  const Outcome missing =
      run(bench, joined({"calibrate", "--array", "drone.toml", "--from", "none", "--out", "c.json"}, kUncertainty));
  EXPECT_EQ(missing.code, 3) << missing.err;
}

TEST(CalibrateKnown, NoControlCharacterOfAFileReachesTheTerminal) {
  const Bench bench;
  write_text(bench / "bad.params", "CAL_ACC0_X\x1b[2JOFF 1\x1b]0;title\x07\n");
  const Outcome refused =
      run(bench, {"calibrate", "--array", "drone.toml", "--from", "bad.params", "--form", "px4", "--out", "c.json"});
  EXPECT_EQ(refused.code, 3);
  for (const char c : refused.err) EXPECT_TRUE(c >= ' ' || c == '\n') << refused.err;
}

}  // namespace
}  // namespace calibrate_known_test
