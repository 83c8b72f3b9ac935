// Groups of sensors of another field: plumb calibrate and monitor on a six-axis tool.
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "tool_runner.hpp"

namespace groups_command_test {
namespace {

using namespace plumb_test;

using Vec = std::array<double, 3>;
using Mat = std::array<Vec, 3>;

constexpr double kRoot3 = 0.5773502691896258;
const Vec kAxes[] = {
    {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {kRoot3, kRoot3, kRoot3}, {-kRoot3, kRoot3, kRoot3}, {kRoot3, -kRoot3, kRoot3}};
constexpr double kGravity_mps2 = 9.81936, kField_nt = 51375.2, kDip_rad = 72.959 * 3.14159265358979 / 180.0;

double along(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// What is wrong from the fifth station on. Mirrored: a4 is silent, and from the ninth station on a2 reads what keeps
/// the length of gravity and turns it.
enum class Fault { none, shifted, stuck, turned, gyro, silent, mirrored };

/// A tool held still in `stations` attitudes, 3 s each, turned for half a second in between.
class Recording {
 public:
  Recording(int stations, std::uint64_t seed, Fault fault) : random_(seed), fault_(fault) {
    text_ = "a1,a2,a3,a4,m1,m2,m3,m4,g1,g2,g3,g4,g5,g6\n";
    for (int k = 0; k < stations; ++k) {
      const Mat attitude = any_attitude();
      for (int j = 0; j < 150; ++j) row(attitude, {}, k, 0.0);
      for (int j = 0; j < 25; ++j) row(any_attitude(), {0.5 * std::sin(0.3 * j), 0.8, 0.3}, k, 1.0);
    }
  }
  const std::string& csv() const { return text_; }

 private:
  double noise(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }

  Mat any_attitude() {
    Vec a{}, b{};
    do {
      for (double& x : a) x = noise(1.0);
      for (double& x : b) x = noise(1.0);
    } while (along(a, a) < 0.1 || along(b, b) < 0.1);
    const double la = std::sqrt(along(a, a));
    for (double& x : a) x /= la;
    const double on = along(a, b);
    for (std::size_t k = 0; k < 3; ++k) b[k] -= on * a[k];
    const double lb = std::sqrt(along(b, b));
    for (double& x : b) x /= lb;
    return {a, b, Vec{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
  }

  void row(const Mat& r, const Vec& rate_radps, int station, double shake) {
    Vec g{}, b{};
    for (std::size_t k = 0; k < 3; ++k) {
      g[k] = kGravity_mps2 * r[2][k];
      b[k] = kField_nt * (std::cos(kDip_rad) * r[0][k] + std::sin(kDip_rad) * r[2][k]);
    }
    const bool wrong = station >= 4;
    if (wrong && fault_ == Fault::turned) {  // by ten degrees about x, against the accelerometers
      const double c = std::cos(0.17), s = std::sin(0.17), y = b[1], z = b[2];
      b[1] = c * y - s * z;
      b[2] = s * y + c * z;
    }
    std::vector<double> cells;
    const bool silent = wrong && (fault_ == Fault::silent || fault_ == Fault::mirrored);
    const bool mirrored = station >= 8 && fault_ == Fault::mirrored;
    for (std::size_t i = 0; i < 4; ++i) {
      const double felt = (mirrored && i == 1 ? -1.0 : 1.0) * along(kAxes[i], g);
      const double reading = (1.0 + kScale[i]) * (felt + 0.02 * kOff[i]) + noise(0.003 + shake);
      cells.push_back(silent && i == 3 ? std::nan("") : reading);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      double m = (1.0 - kScale[i]) * (along(kAxes[i], b) + 900.0 * kOff[3 - i]) + noise(20.0 + 300.0 * shake);
      if (wrong && fault_ == Fault::shifted && i == 1) m += 1500.0;
      if (wrong && fault_ == Fault::stuck && i == 2) m = held_;
      if (i == 2) held_ = m;
      cells.push_back(m);
    }
    for (std::size_t i = 0; i < 6; ++i)
      cells.push_back(57.2957795 * along(kAxes[i], rate_radps) + noise(0.05) +
                      (wrong && fault_ == Fault::gyro && i == 5 ? 25.0 : 0.0));
    for (std::size_t k = 0; k < cells.size(); ++k) {
      char cell[40];
      std::snprintf(cell, sizeof cell, std::isnan(cells[k]) ? "%s" : "%s%.7g", k == 0 ? "" : ",", cells[k]);
      text_ += cell;
    }
    text_ += '\n';
  }

  static constexpr std::array<double, 4> kScale = {0.004, -0.006, 0.002, 0.005}, kOff = {1.0, -0.7, 0.4, -0.2};
  std::mt19937_64 random_;
  Fault fault_;
  double held_ = 0.0;
  std::string text_;
};

/// The example, calibrated once.
const Directory& desk() {
  static const Directory* const made = [] {
    auto* where = new Directory;
    write_text(*where / "tool.toml", read_text(std::string(PLUMB_SOURCE_DIR) + "/examples/six_axis.toml"));
    write_text(*where / "stand.csv", Recording(30, 5, Fault::none).csv());
    for (const char* const group : {"", "#mag"}) {
      const Outcome outcome = run(*where, {"calibrate", "--array", std::string("tool.toml") + group, "--log",
                                           "stand.csv", "--out", *group == '\0' ? "acc.json" : "mag.json"});
      EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    }
    return where;
  }();
  return *made;
}

std::vector<std::string> watching(const std::string& log, const std::vector<std::string>& more = {}) {
  std::vector<std::string> out = {"monitor", "--array", "tool.toml",    "--calibration", "acc.json", "--log",
                                  log,       "--group", "mag=mag.json", "--group",       "gyros"};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

Outcome watched(Fault fault, const std::vector<std::string>& more = {}) {
  write_text(desk() / "run.csv", Recording(16, 9, fault).csv());
  return run(desk(), watching("run.csv", more));
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Without the stated bound of the alignment.
std::string unstated_tool() {
  std::string out = read_text(desk() / "tool.toml");
  const std::string line = "alignment_bound = \"0.3 deg\"\n";
  const std::size_t of_group = out.rfind(line);
  return out.erase(of_group, line.size());
}

// Verifies: REQ-249
TEST(GroupsCommand, MagnetometersAreAlignedByTheCalibrationOfTheAccelerometers) {
  write_text(desk() / "open.toml", unstated_tool());
  const Outcome outcome = run(desk(), {"calibrate", "--array", "open.toml#mag", "--log", "stand.csv", "--align-by",
                                       "acc.json", "--out", "aligned.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, " stations: axes turned by ")) << outcome.out;
  const nlohmann::json file = nlohmann::json::parse(read_text(desk() / "aligned.json"));
  EXPECT_GE(file["frame_alignment"]["stations"].get<int>(), 15);
  EXPECT_NEAR(file["frame_alignment"]["base_bound_rad"].get<double>(), 0.3 / 57.2957795, 1e-5);
  const Outcome watched = run(desk(), {"monitor", "--array", "open.toml", "--calibration", "acc.json", "--log",
                                       "stand.csv", "--group", "mag=aligned.json", "--report", "watched.html"});
  EXPECT_EQ(watched.code, 0) << watched.err;
  EXPECT_TRUE(has(read_text(desk() / "watched-mag.json"), "\"source\":\"dip\"") ||
              has(read_text(desk() / "watched-mag.json"), "\"source\": \"dip\""));
}

// Negative: REQ-249
TEST(GroupsCommand, WhatDoesNotAlignAGroupIsRefusedWithWhatDoes) {
  const auto calibrate = [](std::vector<std::string> more) {
    std::vector<std::string> all = {"calibrate", "--log", "stand.csv", "--out", "none.json"};
    all.insert(all.end(), more.begin(), more.end());
    return run(desk(), all);
  };
  const Outcome known = calibrate({"--array", "tool.toml#mag", "--known-attitude", "1:45,30"});
  EXPECT_EQ(known.code, 2);
  EXPECT_TRUE(has(known.err, "takes an azimuth as well")) << known.err;
  EXPECT_TRUE(has(known.err, "--align-by ACC.json")) << known.err;
  const Outcome gravity = calibrate({"--array", "tool.toml", "--align-by", "acc.json"});
  EXPECT_EQ(gravity.code, 2);
  EXPECT_TRUE(has(gravity.err, "is no magnetic group")) << gravity.err;
  const Outcome other = calibrate({"--array", "tool.toml#mag", "--align-by", "mag.json"});
  EXPECT_NE(other.code, 0);
  EXPECT_TRUE(has(other.err, "belongs to another array")) << other.err;
  // A dip that is not that of the place looks like magnetometers turned by more than their datasheet says.
  std::string wrong = read_text(desk() / "tool.toml");
  const std::string place =
      "model = \"wmm\"\nlatitude = \"60.4 deg\"\nlongitude = \"2.1 deg\"\ndate = \"2026-03-31\"\n";
  const std::size_t from = wrong.find(place);
  ASSERT_NE(from, std::string::npos);
  wrong.replace(from, place.size(), "value = \"51.375 uT\"\ndip = \"60 deg\"\n");
  write_text(desk() / "wrong.toml", wrong);
  const Outcome refused = calibrate({"--array", "wrong.toml#mag", "--align-by", "acc.json"});
  EXPECT_EQ(refused.code, 4) << refused.out << refused.err;
  EXPECT_TRUE(has(refused.err, "the magnetometers could not be aligned")) << refused.err;
}

TEST(GroupsCommand, MagnetometersAreCalibratedInTheirOwnUnits) {
  const Outcome outcome =
      run(desk(), {"calibrate", "--array", "tool.toml#mag", "--log", "stand.csv", "--out", "again.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "the magnetic field 51.375")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, " nT rms")) << outcome.out;
  EXPECT_FALSE(has(outcome.out, "mg0")) << outcome.out;
  EXPECT_FALSE(has(outcome.out, "m/s^2")) << outcome.out;
  const Outcome json =
      run(desk(), {"calibrate", "--array", "tool.toml#mag", "--log", "stand.csv", "--out", "again.json", "--json"});
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_NEAR(report["field_nt"].get<double>(), kField_nt, 5.0);
  EXPECT_FALSE(has(json.out, "mps2")) << json.out;
  for (std::size_t i = 0; i < 4; ++i) {
    // Bias behind the scale: what the log was made with.
    const double off_nt = 900.0 * std::array<double, 4>{-0.2, 0.4, -0.7, 1.0}[i];
    EXPECT_NEAR(report["sensors"][i]["bias_nt"].get<double>(), off_nt, 15.0) << i;
  }
}

TEST(GroupsCommand, AHealthyToolIsNominalInEveryGroupAndTheDipAgrees) {
  const Outcome outcome =
      watched(Fault::none, {"--report", "health.html", "--verdicts", "v.jsonl", "--events", "e.jsonl"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_TRUE(has(outcome.out, "== mag: 4 magnetometers")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "gravity and the field agree")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "== gyros: 6 gyros")) << outcome.out;
  EXPECT_TRUE(has(read_text(desk() / "v-mag.jsonl"), "\"field_nt\":[")) << "in its own unit";
  EXPECT_FALSE(has(read_text(desk() / "v-mag.jsonl"), "mps2"));
  EXPECT_TRUE(has(read_text(desk() / "v.jsonl"), "\"gravity_mps2\":["));
  EXPECT_TRUE(has(read_text(desk() / "health-mag.html"), "nT"));
  EXPECT_FALSE(has(read_text(desk() / "health-mag.html"), "mg0"));
  EXPECT_FALSE(has(read_text(desk() / "health-mag.json"), "mps2"));
  EXPECT_TRUE(has(read_text(desk() / "health.html"), "mg0"));
  for (const char* const page : {"health.html", "health-mag.html"})
    EXPECT_TRUE(has(read_text(desk() / page), "Usable for survey: yes")) << page;
}

// One pass: what a file says standard input says too, to the byte, results and files.
TEST(GroupsCommand, AStreamSaysWhatTheFileSays) {
  for (const Fault fault : {Fault::gyro, Fault::turned}) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, std::vector<std::string>{"--json"}}) {
      std::vector<std::string> files = more, streams = more;
      files.insert(files.end(), {"--events", "fe.jsonl", "--verdicts", "fv.jsonl"});
      streams.insert(streams.end(), {"--events", "se.jsonl", "--verdicts", "sv.jsonl"});
      const Outcome file = watched(fault, files), stream = run(desk(), watching("-", streams), "run.csv");
      EXPECT_EQ(file.code, stream.code);
      EXPECT_EQ(file.out, stream.out);
      EXPECT_EQ(file.err, stream.err);
      for (const char* const name : {"e", "v", "e-mag", "v-mag", "e-gyros"}) {
        const std::string kept = read_text(desk() / ("f" + std::string(name) + ".jsonl").c_str());
        EXPECT_EQ(kept, read_text(desk() / ("s" + std::string(name) + ".jsonl").c_str())) << name;
        EXPECT_EQ(kept.empty(), fault != Fault::gyro && std::string(name) == "e-gyros") << name;
      }
    }
  }
}

// And each group what it says alone: no group changes another.
// Verifies: REQ-241
TEST(GroupsCommand, AGroupSaysInTheToolWhatItSaysAlone) {
  (void)watched(Fault::shifted, {"--events", "e.jsonl", "--verdicts", "v.jsonl"});
  for (const auto& [array, calibration, suffix] :
       {std::tuple{"tool.toml", "acc.json", ""}, std::tuple{"tool.toml#mag", "mag.json", "-mag"}}) {
    (void)run(desk(), {"monitor", "--array", array, "--calibration", calibration, "--log", "run.csv", "--events",
                       "alone-e.jsonl", "--verdicts", "alone-v.jsonl"});
    for (const char* const kind : {"e", "v"})
      EXPECT_EQ(read_text(desk() / (std::string("alone-") + kind + ".jsonl").c_str()),
                read_text(desk() / (kind + std::string(suffix) + ".jsonl").c_str()))
          << array << kind;
  }
}

TEST(GroupsCommand, AGrowingLogIsWatchedByAllGroups) {
  const std::string log = Recording(16, 9, Fault::shifted).csv();
  const std::size_t part = log.size() / 4;  // in the middle of a row
  write_text(desk() / "growing.csv", log.substr(0, part));
  const Process process(desk(), watching("growing.csv", {"--follow"}), -1, {});
  ASSERT_TRUE(process.says("nominal"));
  {
    std::ofstream more(desk() / "growing.csv", std::ios::app);
    more << log.substr(part);
  }
  ASSERT_TRUE(process.says("m2 ")) << "the shifted magnetometer, while the log may still grow";
  process.interrupt();
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(has(outcome.out, "== mag: 4 magnetometers")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "== gyros: 6 gyros")) << outcome.out;
  EXPECT_TRUE(has(outcome.err, "interrupted")) << outcome.err;
}

// Negative: REQ-241
TEST(GroupsCommand, ARowThatIsBadForOneGroupIsARowOfTheOthers) {
  std::string log = Recording(16, 9, Fault::none).csv();
  const std::string row = line_of(log, 100);
  std::string bad = row;
  bad.replace(bad.rfind(',') + 1, std::string::npos, "text");  // of a gyro
  write_text(desk() / "bad.csv", with(log, row, bad));
  const Outcome skipped = run(desk(), watching("bad.csv", {"--on-bad-row", "skip", "--json"}));
  EXPECT_EQ(skipped.code, 0) << skipped.err;
  EXPECT_TRUE(has(skipped.out, "\"rows_bad\":0")) << skipped.out;
  EXPECT_TRUE(has(skipped.out, "\"rows_bad\":1")) << skipped.out;
  const Outcome stopped = run(desk(), watching("bad.csv"));
  EXPECT_EQ(stopped.code, 3) << stopped.err;
  EXPECT_TRUE(has(stopped.err, "\"text\"")) << stopped.err;
  EXPECT_TRUE(has(stopped.out, "gravity and the field agree")) << "the others go on";
}

// The dip is the second reference of three accelerometers.
// Verifies: REQ-242
TEST(GroupsCommand, TheDipNamesAMirroredAccelerometerOfThree) {
  const Outcome healthy = watched(Fault::silent, {"--verdicts", "v.jsonl"});
  EXPECT_EQ(healthy.code, 0) << healthy.out << healthy.err;
  EXPECT_TRUE(has(healthy.out, "three accelerometers left: no fault is needed")) << healthy.out;
  EXPECT_TRUE(has(read_text(desk() / "v.jsonl"), "\"dip\":{\"group\":\"mag\",\"verdict\":\"consistent\""));
  EXPECT_TRUE(has(read_text(desk() / "v.jsonl"), "\"protected\":true"));
  const Outcome mirrored =
      watched(Fault::mirrored, {"--events", "e.jsonl", "--verdicts", "v.jsonl", "--report", "three.html"});
  EXPECT_EQ(mirrored.code, 6) << mirrored.out << mirrored.err;
  EXPECT_TRUE(has(mirrored.out, "a2 is faulty")) << mirrored.out;
  const std::string events = read_text(desk() / "e.jsonl");
  EXPECT_TRUE(has(events, "\"event\":\"dip_judged\",\"verdict\":\"fault\",\"named\":\"a2\"")) << events;
  EXPECT_TRUE(has(read_text(desk() / "v.jsonl"), "\"verdict\":\"fault\",\"named\":\"a2\""));
  const std::string page = read_text(desk() / "three.html");
  EXPECT_TRUE(has(page, "contradicts the three accelerometers left"));
  EXPECT_TRUE(has(page, "a2 is faulty"));
}

TEST(GroupsCommand, ThePageOfTheToolBeginsWithAllGroups) {
  (void)watched(Fault::gyro, {"--report", "all.html"});
  const auto data = nlohmann::json::parse(read_text(desk() / "all.json"));
  ASSERT_EQ(data["groups"].size(), 2U);
  EXPECT_EQ(data["groups"][0]["name"], "mag");
  EXPECT_EQ(data["groups"][0]["trusted"], true);
  EXPECT_EQ(data["groups"][0]["page"], "all-mag.html");
  EXPECT_EQ(data["groups"][1]["trusted"], false);
  EXPECT_EQ(data["groups"][1]["excluded"], nlohmann::json::array({"g6"}));
  const std::string page = read_text(desk() / "all.html");
  const std::size_t groups = page.find("Groups of the tool"), answer = page.find("1 Answer");
  EXPECT_LT(groups, answer);
  EXPECT_TRUE(has(page, "What not to trust"));
  EXPECT_TRUE(has(page, "all-mag.html"));
  EXPECT_FALSE(has(read_text(desk() / "all-mag.html"), "Groups of the tool"));
}

TEST(GroupsCommand, AShiftedAndAStuckMagnetometerAreNamed) {
  const Outcome shifted = watched(Fault::shifted);
  EXPECT_TRUE(has(shifted.out, "excluded    m2")) << shifted.out;
  EXPECT_TRUE(has(shifted.out, "in service  a1, a2, a3, a4")) << shifted.out;
  const Outcome stuck = watched(Fault::stuck);
  EXPECT_TRUE(has(stuck.out, "excluded    m3")) << stuck.out;
}

TEST(GroupsCommand, AFaultyGyroIsNamed) {
  const Outcome outcome = watched(Fault::gyro, {"--events", "g.jsonl"});
  EXPECT_TRUE(has(outcome.out, "excluded    g6")) << outcome.out;
  EXPECT_TRUE(has(read_text(desk() / "g-gyros.jsonl"), "\"excluded\":[\"g6\"]"));
}

// Both groups agree in themselves; only the angle between the two vectors shows it.
TEST(GroupsCommand, AGroupTurnedAgainstTheOtherIsToldByTheDip) {
  const Outcome outcome = watched(Fault::turned);
  EXPECT_EQ(outcome.code, 6) << outcome.out << outcome.err;
  EXPECT_TRUE(has(outcome.out, "DISAGREE")) << outcome.out;
  // Neither report may be signed: what is printed beside it alone would not hold a reader of the page.
  (void)watched(Fault::turned, {"--report", "turned.html"});
  for (const char* const page : {"turned", "turned-mag"}) {
    const std::string data = read_text(desk() / (std::string(page) + ".json").c_str());
    EXPECT_TRUE(has(data, "disagree by the dip")) << page;
    EXPECT_TRUE(has(read_text(desk() / (std::string(page) + ".html").c_str()), "Usable for survey: orientation only"))
        << page;
  }
  const Outcome json = watched(Fault::turned, {"--json", "--events", "turned.jsonl"});
  EXPECT_EQ(json.code, 6);
  for (const std::string& lines : {json.out, read_text(desk() / "turned.jsonl")})
    EXPECT_TRUE(has(lines, "\"event\":\"dip_disagrees\",\"dip_deg\":")) << lines;
  EXPECT_TRUE(has(json.out, "\"blocks_disagreeing\":")) << json.out;
  EXPECT_TRUE(has(json.out, "\"group\":\"mag\"")) << json.out;
}

TEST(GroupsCommand, FaultsAreInjectedInTheUnitsOfTheGroup) {
  write_text(desk() / "run.csv", Recording(16, 9, Fault::none).csv());
  const Outcome injected = run(desk(), {"inject", "--array", "tool.toml#mag", "--log", "run.csv", "--fault",
                                        "m4:bias=-1500nT@14s", "--out", "bad.csv"});
  ASSERT_EQ(injected.code, 0) << injected.err;
  const Outcome seen =
      run(desk(), {"monitor", "--array", "tool.toml#mag", "--calibration", "mag.json", "--log", "bad.csv"});
  EXPECT_TRUE(has(seen.out, "excluded    m4")) << seen.out << seen.err;
  const Outcome gyro = run(desk(), {"inject", "--array", "tool.toml#gyros", "--log", "run.csv", "--fault",
                                    "g2:stuck=3deg/s@14s", "--out", "bad.csv"});
  EXPECT_EQ(gyro.code, 0) << gyro.err;
  const Outcome unit = run(desk(), {"inject", "--array", "tool.toml#mag", "--log", "run.csv", "--fault",
                                    "m4:bias=5mg0@14s", "--out", "bad.csv"});
  EXPECT_EQ(unit.code, 2);
  EXPECT_TRUE(has(unit.err, "nT")) << unit.err;
}

struct Wrong {
  std::vector<std::string> arguments;
  const char* says;
};

TEST(GroupsCommand, WhatIsAskedForWronglyIsSaid) {
  const Wrong cases[] = {
      {{"--group", "magg=mag.json"}, "no group \"magg\""},
      {{"--group", "mag"}, "has no calibration"},
      {{"--group", "gyros=mag.json"}, "must be \"plumb-gyro-calibration\""},
      {{"--group", "gyros", "--group", "gyros"}, "given twice"},
      {{"--group", "mag=acc.json"}, "belongs to another array"},
      {{"--group", "gyros", "--limits"}, "--limits"},
      {{"--group", "gyros", "--events", "-"}, "name files"},
      {{"--group", "mag=mag.json", "--events", "e.jsonl", "--verdicts", "e-mag.jsonl"}, "e-mag.jsonl"},
  };
  write_text(desk() / "run.csv", Recording(4, 9, Fault::none).csv());
  for (const Wrong& wrong : cases) {
    std::vector<std::string> arguments = {"monitor",  "--array", "tool.toml", "--calibration",
                                          "acc.json", "--log",   "run.csv"};
    arguments.insert(arguments.end(), wrong.arguments.begin(), wrong.arguments.end());
    const Outcome outcome = run(desk(), arguments);
    EXPECT_NE(outcome.code, 0) << wrong.says;
    EXPECT_TRUE(has(outcome.err, wrong.says)) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "Remedy: ")) << outcome.err;
  }
}

TEST(GroupsCommand, LimitsAreInTheUnitsOfTheGroup) {
  const std::vector<std::string> asked = {"monitor",       "--array",  "tool.toml#mag",
                                          "--calibration", "mag.json", "--limits"};
  const Outcome text = run(desk(), asked);
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(has(text.out, " nT")) << text.out;
  EXPECT_FALSE(has(text.out, " mg")) << text.out;
  std::vector<std::string> as_json = asked;
  as_json.emplace_back("--json");
  const Outcome json = run(desk(), as_json);
  EXPECT_NEAR(nlohmann::json::parse(json.out)["limits"]["noise_nt"].get<double>(), 20.0, 0.5) << json.out;
}

// The page says what the JSON beside it says.
TEST(GroupsCommand, ThePageOfAGroupHasTheLengthOfItsField) {
  (void)watched(Fault::none, {"--report", "page.html"});
  const std::string page = read_text(desk() / "page-mag.html");
  EXPECT_TRUE(has(page, "51.375")) << "uT";
  EXPECT_TRUE(has(page, "nT = 0.001 uT"));
  EXPECT_FALSE(has(page, "9.80665"));
}

TEST(GroupsCommand, NoOutputTakesThePlaceOfTheArrayFile) {
  const Outcome outcome = run(desk(), {"inject", "--array", "tool.toml#mag", "--log", "stand.csv", "--fault",
                                       "m1:bias=1uT@2s", "--out", "tool.toml"});
  EXPECT_EQ(outcome.code, 2) << outcome.out;
  EXPECT_TRUE(has(read_text(desk() / "tool.toml"), "[[group]]"));
}

TEST(GroupsCommand, NoReportTakesThePlaceOfACalibration) {
  const std::string before = read_text(desk() / "mag.json");
  const Outcome outcome = run(desk(), {"monitor", "--array", "tool.toml", "--calibration", "acc.json", "--log",
                                       "stand.csv", "--group", "mag=mag.json", "--report", "mag.html"});
  EXPECT_EQ(outcome.code, 2) << outcome.out;
  EXPECT_TRUE(has(outcome.err, "is the same file as --group")) << outcome.err;
  EXPECT_EQ(read_text(desk() / "mag.json"), before);
}

TEST(GroupsCommand, ACommandThatDoesNotServeAGroupSaysSo) {
  const Outcome rate =
      run(desk(), {"calibrate", "--array", "tool.toml#gyros", "--log", "stand.csv", "--out", "x.json"});
  EXPECT_EQ(rate.code, 2);
  EXPECT_TRUE(has(rate.err, "does not serve a group of gyros")) << rate.err;
}

// Magnetometers in uT that are given as G, and the date beyond the model.
TEST(GroupsCommand, AWrongUnitAndAWrongDateAreGuessedAndTold) {
  const std::string text = read_text(desk() / "tool.toml");
  write_text(desk() / "gauss.toml", with(text, "unit = \"nT\"", "unit = \"mG\""));
  const Outcome unit = run(desk(), {"calibrate", "--array", "gauss.toml#mag", "--log", "stand.csv", "--out", "x.json"});
  EXPECT_EQ(unit.code, 4) << unit.out << unit.err;
  EXPECT_TRUE(has(unit.err, "as long as the magnetic field")) << unit.err;
  EXPECT_TRUE(has(unit.err, "nT")) << unit.err;
  write_text(desk() / "late.toml", with(text, "2026-03-31", "2031-03-31"));
  const Outcome date = run(desk(), {"calibrate", "--array", "late.toml#mag", "--log", "stand.csv", "--out", "x.json"});
  EXPECT_EQ(date.code, 3);
  EXPECT_TRUE(has(date.err, "group[1].reference.date")) << date.err;
  EXPECT_TRUE(has(date.err, "2025.0 to 2030.0")) << date.err;
}

}  // namespace
}  // namespace groups_command_test
