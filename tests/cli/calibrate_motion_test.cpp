// plumb calibrate --motion, and plumb monitor with what it found.
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "tool_runner.hpp"

namespace calibrate_motion_test {
namespace {

using namespace plumb_test;
using Json = nlohmann::json;

const std::string kExamples = PLUMB_SOURCE_DIR "/examples/motion/";
constexpr double kFlight_s = 60.0, kFit_s = 30.0;

using Vec = std::array<double, 3>;
/// Of the chips of the example.
const std::array<Vec, 3> kArms_m{Vec{0.025, 0.0, 0.0}, Vec{-0.0125, 0.0217, 0.0}, Vec{-0.0125, -0.0217, 0.0}};
const std::array<const char*, 3> kArmTexts{"[0.025, 0.0, 0.0]", "[-0.0125, 0.0217, 0.0]", "[-0.0125, -0.0217, 0.0]"};

std::string everywhere(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// Without the lines that contain a word.
std::string without_lines(const std::string& text, const std::string& word) {
  std::istringstream in(text);
  std::string line, out;
  while (std::getline(in, line)) out += line.find(word) == std::string::npos ? line + "\n" : "";
  return out;
}

std::string drone() { return read_text(kExamples + "drone.toml"); }
/// The tool that flies: its arms are exactly as stated.
std::string true_tool() { return with(drone(), "lever_arm_bound_m = 0.001 ", "lever_arm_bound_m = 0 "); }

/// Arms stated wrong by up to 10 mm.
std::string wrong_tool(unsigned seed) {
  std::mt19937 random(seed);
  std::string out = drone();
  for (std::size_t chip = 0; chip < 3; ++chip) {
    std::ostringstream text;
    for (std::size_t c = 0; c < 3; ++c)
      text << (c == 0 ? "[" : ", ") << kArms_m[chip][c] + 0.01 * (static_cast<double>(random()) / 2147483648.0 - 1.0);
    out = everywhere(out, kArmTexts[chip], text.str() + "]");
  }
  return out;
}

/// Neither arms nor bounds of arms, lag and gyro.
std::string unknown_tool() {
  std::string out = drone();
  for (const char* key : {"lever_arm", "lag_bound_s", "[gyro]", "scale_bound = 0.01", "axis_bound_rad = 0.01",
                          "bias_bound_radps", "noise_radps"})
    out = without_lines(out, key);
  EXPECT_NE(out.find("axis_bound_rad = 0.0015"), std::string::npos);
  EXPECT_NE(out.find("scale_bound = 0.001"), std::string::npos);
  return out;
}

/// The example's tool, calibrated on the stand, and a flight of it in two parts.
class Hangar {
 public:
  Hangar() {
    write_text(where / "drone.toml", drone());
    write_text(where / "true.toml", true_tool());
    write_text(where / "stand.toml", read_text(kExamples + "stand.toml"));
    done({"simulate", "stand.toml", "--out", "stand.csv"});
    done({"calibrate", "--array", "drone.toml", "--log", "stand.csv", "--out", "cal.json", "--date", "2026-03-01"});
    fly("all.csv", {});
    fly("faulty.csv", {"--fault", "imu2:bias=0.1g0@45s"});
    cut("all.csv", "flight.csv", 0.0, kFit_s);
    cut("all.csv", "other.csv", kFit_s, kFlight_s);
    cut("faulty.csv", "failing.csv", kFit_s, kFlight_s);
  }
  void done(const std::vector<std::string>& arguments) const {
    const Outcome outcome = run(where, arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  void fly(const std::string& log, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"simulate", "--flight", "drone", "true.toml",  "--calibration",
                                          "cal.json", "--seed",   "3",     "--duration", std::to_string(kFlight_s),
                                          "--out",    log};
    arguments.insert(arguments.end(), more.begin(), more.end());
    done(arguments);
  }
  /// Rows of [from, to), each changed.
  void cut(const char* log, const char* to, double from_s, double to_s,
           const std::function<std::string(const std::string&)>& change = {}) const {
    std::istringstream in(read_text(where / log));
    std::string line, out;
    std::getline(in, line);
    out = line + "\n";
    while (std::getline(in, line)) {
      const double t_s = std::strtod(line.c_str(), nullptr);
      if (t_s >= from_s && t_s < to_s) out += (change ? change(line) : line) + "\n";
    }
    write_text(where / to, out);
  }

  Directory where;
};

class CalibrateMotion : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { hangar_ = std::make_unique<Hangar>(); }
  static void TearDownTestSuite() { hangar_.reset(); }

  const Directory& where() const { return hangar_->where; }
  const Hangar& hangar() const { return *hangar_; }
  Outcome commission(const std::string& array, const std::string& log, const std::vector<std::string>& more = {}) {
    write_text(where() / "array.toml", array);
    std::error_code ignored;
    std::filesystem::remove(where() / "new.json", ignored);
    std::vector<std::string> arguments = {"calibrate",  "--array",  "array.toml", "--calibration", "cal.json", "--date",
                                          "2026-03-02", "--motion", log,          "--out",         "new.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(where(), arguments);
  }
  /// The object `motion` of the summary.
  Json monitored(const std::string& calibration, const std::string& log) {
    const Outcome told = run(where(), {"monitor", "--array", "array.toml", "--calibration", calibration, "--date",
                                       "2026-03-02", "--log", log, "--json"});
    std::istringstream in(told.out);
    std::string line, last;
    while (std::getline(in, line)) last = line;
    const Json summary = Json::parse(last, nullptr, false);
    if (!summary.is_object()) {
      ADD_FAILURE() << told.out << told.err;
      return {};
    }
    return summary["summary"]["motion"];
  }
  void refused(const Outcome& outcome, int code, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_TRUE(says(outcome.err, words));
    EXPECT_NE(outcome.err.find("Remedy: "), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(where() / "new.json"));
  }
  /// Every arm is within a millimetre, and its bound, of the true one, from one reference point.
  void arms_are_true(const Json& sensors) {
    std::vector<Vec> off;
    Vec mean{};
    for (std::size_t k = 0; k < 9; ++k) {
      off.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        off[k][c] = sensors[k]["lever_arm_m"][c].get<double>() - kArms_m[k / 3][c];
        mean[c] += off[k][c] / 9.0;
      }
    }
    for (std::size_t k = 0; k < 9; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_LT(std::fabs(off[k][c] - mean[c]), 1e-3);
        EXPECT_LE(std::fabs(off[k][c] - mean[c]), sensors[k]["lever_arm_bound_m"].get<double>());
        EXPECT_LE(std::fabs(off[k][c] - mean[c]), 3.0 * sensors[k]["lever_arm_correction_m"][c]["sigma"].get<double>());
      }
    }
  }

 private:
  static inline std::unique_ptr<Hangar> hangar_;
};

// Negative: REQ-207
TEST_F(CalibrateMotion, ChipsWithClocksOfTheirOwnAreRefused) {
  const std::string clock =
      "[[clock]]\npackage = \"imu2\"\ntime = \"t_s\"\noffset_bound_s = 0\nrate_bound = 0\n\n[[sensor]]";
  const Outcome told = commission(with(drone(), "[[sensor]]", clock), "flight.csv");
  EXPECT_EQ(told.code, 3);
  EXPECT_TRUE(says(told.err, {"clock[1]: states a clock of its own, and a fit in motion takes sensors on one clock",
                              "Remedy: fit a log in which all chips sample together"}));
}

TEST_F(CalibrateMotion, WrongArmsAreFoundAndTheMonitorGoesByThem) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::string array = wrong_tool(seed);
    const Outcome told = commission(array, "flight.csv", {"--json"});
    ASSERT_EQ(told.code, 0) << told.err;
    const Json report = Json::parse(told.out);
    EXPECT_EQ(report["accepted"], true);
    EXPECT_EQ(report["held_out"]["alarm"], false);
    EXPECT_LE(report["rank"].get<int>() + report["gauge"].get<int>(), report["unknowns"].get<int>());
    arms_are_true(report["sensors"]);
    EXPECT_GT(monitored("cal.json", "other.csv")["alarms"].get<int>(), 0) << "the arms as they are stated";
    EXPECT_EQ(monitored("new.json", "other.csv")["alarms"], 0);
    const Json failing = monitored("new.json", "failing.csv");
    ASSERT_EQ(failing["isolated"].size(), 3U) << failing;
    EXPECT_EQ(failing["isolated"][0]["id"], "x2");
    EXPECT_NEAR(failing["isolated"][0]["t_s"].get<double>(), 45.0, 0.1);
  }
}

TEST_F(CalibrateMotion, ArmsThatNobodyStatedAreFound) {
  const std::string array = unknown_tool();
  const Outcome told = commission(array, "flight.csv", {"--json"});
  ASSERT_EQ(told.code, 0) << told.err;
  const Json report = Json::parse(told.out);
  arms_are_true(report["sensors"]);
  EXPECT_EQ(monitored("cal.json", "other.csv")["judged"], false);
  EXPECT_EQ(monitored("new.json", "other.csv")["alarms"], 0);
  const Json failing = monitored("new.json", "failing.csv");
  ASSERT_EQ(failing["isolated"].size(), 3U) << failing;
  EXPECT_EQ(failing["isolated"][0]["id"], "x2");
}

TEST_F(CalibrateMotion, TheReportSaysWhatWasFoundWhatIsOpenAndWhatCounts) {
  const Outcome told = commission(wrong_tool(1), "flight.csv");
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_TRUE(says(told.out, {"Calibration of drone in motion",
                              "30000 rows",
                              "block pairs of 32 samples",
                              "free by choice of the reference point",
                              "lever arm",
                              "x1",
                              "z3",
                              "lag, us",
                              "gyro scale",
                              "parity residual",
                              "before the fit",
                              "held out",
                              "no alarm",
                              "left open (*)",
                              "rectification of",
                              "bound that the array file states is kept",
                              "stated",
                              "vibration_rectification_per_mps2",
                              "written: new.json",
                              "next: plumb monitor"}));
  const std::string first = read_text(where() / "new.json");
  EXPECT_NE(first.find("\"log_file\": \"flight.csv\""), std::string::npos);
  EXPECT_NE(first.find("\"date\": \"2026-03-02\""), std::string::npos);
  commission(wrong_tool(1), "flight.csv");
  EXPECT_EQ(read_text(where() / "new.json"), first) << "the same input gives the same bytes";
}

TEST_F(CalibrateMotion, FiguresCountForTheStatedArmsOnly) {
  ASSERT_EQ(commission(wrong_tool(1), "flight.csv").code, 0);
  write_text(where() / "array.toml", wrong_tool(2));
  const Json motion = monitored("new.json", "other.csv");
  EXPECT_EQ(motion["judged"], false);
  EXPECT_EQ(motion["field"], "sensor[1].lever_arm_m");
  EXPECT_TRUE(says(motion["why"].get<std::string>(), {"has changed since the calibration in motion"}));
  write_text(where() / "array.toml", with(wrong_tool(1), "second_rotation_radps = [\"ux\", \"uy\", \"uz\"]\n", ""));
  EXPECT_EQ(monitored("new.json", "other.csv")["field"], "input.rotation_radps");
}

/// Accelerates in all directions and turns about none, with the sensors of a calibration.
std::string still_flight(const Json& calibration) {
  std::mt19937 random(11);
  const auto noise = [&random](double sigma) {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(random()) / 4294967296.0;
    return sigma * sum;
  };
  std::ostringstream out;
  out.precision(10);
  out << "t_s,wx,wy,wz,ux,uy,uz,x1,y1,z1,x2,y2,z2,x3,y3,z3\n";
  for (int k = 0; k < 15000; ++k) {
    const double t_s = 1e-3 * k;
    const Vec force{4.0 * std::sin(9.0 * t_s), 5.0 * std::sin(7.0 * t_s + 1.0), 9.8 + 3.0 * std::sin(11.0 * t_s)};
    out << t_s;
    for (int g = 0; g < 6; ++g) out << ',' << noise(0.0017);
    for (const Json& sensor : calibration["sensors"]) {
      double reading = sensor["bias_mps2"][0].get<double>() + noise(0.02);
      for (std::size_t c = 0; c < 3; ++c) reading += sensor["axis"][c].get<double>() * force[c];
      out << ',' << sensor["scale"][0].get<double>() * reading;
    }
    out << '\n';
  }
  return out.str();
}

// Verifies: REQ-208
TEST_F(CalibrateMotion, WhatNoMotionShowsIsNamedAndKeepsItsStatedBoundOrIsRefused) {
  write_text(where() / "still.csv", still_flight(Json::parse(read_text(where() / "cal.json"))));
  const Outcome told = commission(unknown_tool(), "still.csv");
  refused(told, 4,
          {"the motion leaves open: lever arm of imu1, imu2 and imu3 along x",
           "lever arm of imu1, imu2 and imu3 along y", "lever arm of imu1, imu2 and imu3 along z",
           "new.json was not written", "turn the tool to and fro about axes across x, y and z"});
  const Outcome stated = commission(drone(), "still.csv", {"--json"});
  ASSERT_EQ(stated.code, 0) << stated.err;
  const Json report = Json::parse(stated.out);
  EXPECT_EQ(report["open"][0], "lever arm of imu1, imu2 and imu3 along x");
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_EQ(report["sensors"][k]["lever_arm_bound_m"], 1e-3);
    EXPECT_EQ(report["sensors"][k]["lever_arm_m"][0], kArms_m[k / 3][0]);
  }
}

TEST_F(CalibrateMotion, RectificationThatAllShareIsOpenWhereNothingIsStated) {
  const Outcome told = commission(without_lines(drone(), "vibration_rectification"), "flight.csv");
  refused(told, 4, {"the motion leaves open", "rectification of x1", "state vibration_rectification_per_mps2"});
}

/// With the cells of these columns multiplied.
std::string scaled_cells(const std::string& line, int first, int last, double factor) {
  std::istringstream in(line);
  std::ostringstream out;
  out.precision(10);
  std::string cell;
  for (int c = 0; std::getline(in, cell, ','); ++c) {
    if (c > 0) out << ',';
    if (c >= first && c <= last) {
      out << factor * std::stod(cell);
    } else {
      out << cell;
    }
  }
  return out.str();
}

TEST_F(CalibrateMotion, RatesInDegreesAreToldByTheirSizeAndByTheirNoise) {
  const auto degrees = [](const std::string& line) { return scaled_cells(line, 1, 6, 57.29577951308232); };
  hangar().cut("all.csv", "deg.csv", 0.0, kFit_s, degrees);
  refused(commission(drone(), "deg.csv"), 4, {"the rates reach", "beyond 8 rad/s", "write rad/s"});
  // A car turns slowly: no rate is too large for a gyro, but gyros have less noise.
  const std::string unbounded = without_lines(drone(), "rate_bound_radps");
  write_text(where() / "unbounded.toml", without_lines(true_tool(), "rate_bound_radps"));
  hangar().done({"simulate", "--flight", "car", "unbounded.toml", "--calibration", "cal.json", "--duration", "20",
                 "--out", "car.csv"});
  hangar().cut("car.csv", "car_deg.csv", 0.0, 20.0, degrees);
  refused(commission(unbounded, "car_deg.csv"), 4, {"the two gyros scatter by", "beyond 0.0085 rad/s", "write rad/s"});
}

TEST_F(CalibrateMotion, AGyroThatStandsStillIsNamed) {
  const auto dead = [](int first, double from_s) {
    return [=](const std::string& line) {
      return std::strtod(line.c_str(), nullptr) < from_s ? line : scaled_cells(line, first, first + 2, 0.0);
    };
  };
  hangar().cut("all.csv", "first.csv", 0.0, kFit_s, dead(1, 0.0));
  refused(commission(drone(), "first.csv"), 4, {"the first gyro (wx, wy and wz) stands still for", "record again"});
  hangar().cut("all.csv", "second.csv", 0.0, kFit_s, dead(4, 0.8 * kFit_s));  // in the part that is held out
  refused(commission(unknown_tool(), "second.csv"), 4,
          {"the second gyro (ux, uy and uz) stands still for", "record again"});
}

TEST_F(CalibrateMotion, GyrosThatDisagreeAreToldInEitherPart) {
  for (const double from_s :
       {0.3 * kFit_s, 0.8 * kFit_s}) {  // in the part that is fitted, and in that which is held out
    hangar().cut("all.csv", "apart.csv", 0.0, kFit_s, [=](const std::string& line) {
      return std::strtod(line.c_str(), nullptr) < from_s ? line : scaled_cells(line, 4, 6, 1.3);
    });
    const Outcome told = commission(drone(), "apart.csv");
    EXPECT_EQ(told.code, 4) << told.err;
    EXPECT_NE(told.err.find("gyro"), std::string::npos) << told.err;
    if (from_s > 0.5 * kFit_s) refused(told, 4, {"the two gyros read more apart than their bounds allow at t = "});
  }
}

TEST_F(CalibrateMotion, RefusesLogsThatCannotBeFitted) {
  refused(commission(without_lines(unknown_tool(), "rotation_radps"), "flight.csv"), 3,
          {"array.toml: input.rotation_radps: is missing, and lever arms show only by the rates of a gyro"});
  hangar().cut("all.csv", "short.csv", 0.0, 2.0);
  refused(commission(drone(), "short.csv"), 4, {"the log has 2.0 s, and the fit with its check needs"});
  hangar().cut("all.csv", "slow.csv", 0.0, 10.0);
  refused(commission(with(drone(), "sample_period_s = 0.001", "sample_period_s = 0.002"), "slow.csv"), 4,
          {"steps from row to row are not the stated period of 0.002 s (most are 0.001 s)", "sample_period_s"});
  hangar().cut("faulty.csv", "fault.csv", 40.0, kFlight_s);
  refused(commission(drone(), "fault.csv"), 4, {"x2, y2, z2", "contradict the others"});
  hangar().cut("all.csv", "g0.csv", 0.0, 10.0,
               [](const std::string& line) { return scaled_cells(line, 7, 15, 1.0 / 9.80665); });
  refused(commission(drone(), "g0.csv"), 4, {"of the stated noise", "unit of the log"});
  refused(commission(with(drone(), "sample_period_s", "rate_period_s"), "flight.csv"), 3, {"array.toml"});
}

// Negative: REQ-208
TEST_F(CalibrateMotion, AFaultInTheHeldOutPartIsRefused) {
  hangar().cut("faulty.csv", "late.csv", 15.0, 47.0);
  refused(commission(drone(), "late.csv"), 4,
          {"with the bounds of the fit x2, y2, z2 contradict the others at t = 45.0", "held-out part"});
}

TEST_F(CalibrateMotion, ASensorThatTheCalibrationDoesNotFitIsNamed) {
  hangar().cut("all.csv", "scaled.csv", 0.0, kFit_s,
               [](const std::string& line) { return scaled_cells(line, 9, 9, 1.05); });
  const Outcome told = commission(drone(), "scaled.csv");
  refused(told, 4, {"z1"});
}

TEST_F(CalibrateMotion, OptionsOfOneKindStayTogether) {
  refused(run(where(), {"calibrate", "--array", "drone.toml", "--motion", "flight.csv", "--out", "new.json"}), 2,
          {"--motion", "adds to a calibration made at rest"});
  refused(run(where(), {"calibrate", "--array", "drone.toml", "--out", "new.json"}), 2, {"--log: is required"});
  refused(run(where(), {"calibrate", "--array", "drone.toml", "--log", "stand.csv", "--calibration", "cal.json",
                        "--out", "new.json"}),
          2, {"--calibration", "belongs to --motion"});
  refused(commission(drone(), "flight.csv", {"--log", "stand.csv"}), 2, {"--log: belongs to a calibration at rest"});
  refused(commission(drone(), "flight.csv", {"--paper"}), 2, {"--paper: belongs to a calibration at rest"});
}

}  // namespace
}  // namespace calibrate_motion_test
