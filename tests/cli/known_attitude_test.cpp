// A tool that is wired otherwise than its array file says, in a way that gravity cannot see: it must never be called
// fit.
#include <fmt/format.h>

#include <sstream>

#include "render/verify_support.hpp"
#include "support/rewired_tool.hpp"

namespace known_attitude_test {
namespace {

using namespace plumb_test;
using namespace plumb;

/// The log with two of its columns exchanged.
std::string exchanged(const std::string& log, const std::string& a, const std::string& b) {
  std::istringstream in(log);
  std::string out, line;
  std::size_t i = 0, j = 0;
  for (bool header = true; std::getline(in, line); header = false) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (header) {
      i = static_cast<std::size_t>(std::find(cells.begin(), cells.end(), a) - cells.begin());
      j = static_cast<std::size_t>(std::find(cells.begin(), cells.end(), b) - cells.begin());
    } else {
      std::swap(cells[i], cells[j]);
    }
    for (std::size_t k = 0; k < cells.size(); ++k) out += (k == 0 ? "" : ",") + cells[k];
    out += "\n";
  }
  return out;
}

/// The examples, and the stand recorded by a tool whose a2 and a3 are exchanged.
class Mirrored : public Workshop {
 public:
  Mirrored() { put("swapped.csv", exchanged(text("calibration.csv"), "a2", "a3")); }
};

Outcome calibrate(const Directory& where, const std::string& log, const std::string& out,
                  const std::vector<std::string>& more = {}) {
  std::vector<std::string> all = {"calibrate", "--array", "array.toml", "--log", log, "--out", out};
  all.insert(all.end(), more.begin(), more.end());
  return run(where, all);
}

Json criterion(const Json& report) {
  for (const Json& one : report["verdict"]["criteria"]) {
    if (one["id"] == "wiring_confirmed") return one;
  }
  return {};
}

// Verifies: REQ-183
TEST(KnownAttitude, AMirroredToolIsNeverFit) {
  const Mirrored where;
  const Outcome made = calibrate(where, "swapped.csv", "swapped.json", {"--json"});
  ASSERT_EQ(made.code, 0) << made.err;  // no residual shows it
  EXPECT_EQ(Json::parse(made.out)["wiring"]["status"], "open");
  EXPECT_EQ(Json::parse(made.out)["wiring"]["unseen_by_gravity"], 47);
  for (const std::vector<std::string>& given :
       {std::vector<std::string>{"--calibration", "swapped.json"}, {"--stations", "swapped.csv"}}) {
    std::vector<std::string> all = {"--array", "array.toml", "--out", "r"};
    all.insert(all.end(), given.begin(), given.end());
    const Outcome outcome = verify(where, all);
    EXPECT_EQ(outcome.code, 6);
    EXPECT_TRUE(says(outcome.out, {"INCONCLUSIVE", "the wiring is not confirmed", "a2 and a3 exchanged",
                                   "hold the tool still at a known attitude", "--known-attitude STATION:"}));
    const Json report = report_in(where / "r");
    EXPECT_EQ(report["verdict"]["verdict"], "open");
    EXPECT_EQ(criterion(report)["result"], "open");
    EXPECT_EQ(report["calibration"]["wiring"]["status"], "open");
    const std::string page = read_text(where / "r" / "report.html");
    EXPECT_TRUE(says(page, {"INCONCLUSIVE", "Wiring confirmed by a known attitude"}));
    EXPECT_EQ(page.find("exchange of two and turn of three shows in a recording"), std::string::npos);
    // The leg of the argument is open, and so is the goal above it.
    const std::string argument = read_text(where / "r" / "argument.svg");
    EXPECT_EQ(argument.find("stroke=\"#"), argument.find("stroke=\"#b97a00\"")) << "the goal is green";
  }
}

/// Six sensors, wired so that exact axes would show it and those mounted a few degrees off do not: the vector is
/// turned, and neither command may call that fit.
class Rewired : public Workshop {
 public:
  plumb_test::RewiredTool tool;

  Rewired() : tool(first_beyond_the_datasheet()) {
    std::string array =
        "name = \"six\"\n[gravity]\nmodel = \"value\"\nvalue = \"9.80665 m/s^2\"\nsigma = \"0.15 mg\"\n"
        "[input]\nreads = \"gravity\"\nunit = \"m/s^2\"\ntime = \"t_s\"\nstation = \"station\"\n";
    std::string log = "t_s,station";
    for (int i = 0; i < 6; ++i) {
      const Vec3& axis = tool.nominal.axis(i);
      array += fmt::format("[[sensor]]\nid = \"a{}\"\naxis = [{}, {}, {}]\nscale = \"1\"\nnoise = \"0.2 mg0\"\n", i + 1,
                           axis[0], axis[1], axis[2]);
      log += fmt::format(",a{}", i + 1);
    }
    log += "\n";
    Noise noise(5);
    for (int row = 0; row < 30 * kRows; ++row) {
      if (row % kRows == 0) down_ = row == 0 ? axis_of_turn() : plumb_test::random_direction(noise);
      if (row < 2 * kRows) stands_[static_cast<std::size_t>(row / kRows)] = down_;
      log += fmt::format("{},{}", 0.01 * row, row / kRows + 1);
      const Vec3 shown = scaled(times(tool.turn, down_), kG0_mps2);
      for (int i = 0; i < 6; ++i) log += fmt::format(",{}", dot(tool.fitted.axis(i), shown) + 0.002 * noise.normal());
      log += "\n";
    }
    put("six.toml", array);
    put("six.csv", log);
  }
  /// The truth of station 1, which stands along the axis of the turn, or of station 2.
  std::string known(int station) const {
    const Vec3& down = stands_[static_cast<std::size_t>(station - 1)];
    const double toolface_deg = deg_from_rad(std::atan2(-down[0], -down[1]));
    return fmt::format("{}:{:.3f},{:.3f}", station, deg_from_rad(std::acos(down[2])), toolface_deg);
  }

 private:
  static constexpr int kRows = 200;
  Vec3 down_{};
  std::array<Vec3, 2> stands_{};

  Vec3 axis_of_turn() const {
    Vec3 sum = {0.3, 0.5, 0.8};
    for (int power = 0; power < 40; ++power) sum = plus(sum, times(tool.turn, sum));
    return scaled(sum, 1.0 / norm(sum));
  }

  static plumb_test::RewiredTool first_beyond_the_datasheet() {
    Noise noise(21);
    for (int k = 0; k < 100000; ++k) {
      const auto drawn = plumb_test::draw_rewired(6, noise);
      if (!drawn) continue;
      const auto exact = findings::unseen_wirings(drawn->nominal, drawn->nominal, findings::kUnseenAxis_rad);
      if (!drawn->is_listed(exact)) return *drawn;
    }
    ADD_FAILURE() << "no such tool was drawn";
    return {};
  }
};

/// Station 1 stands along the axis of the turn, as stated, and excludes every wiring that exact axes would hide.
// Negative: REQ-183
TEST(KnownAttitude, AStationOnTheAxisOfTheTurnDoesNotMakeSixRewiredSensorsFit) {
  const Rewired where;
  const auto calibrate_with = [&where](const std::string& known) {
    return run(where, {"calibrate", "--array", "six.toml", "--log", "six.csv", "--out", "six.json", "--known-attitude",
                       known, "--json"});
  };
  const Outcome made = calibrate_with(where.known(1));
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(Json::parse(made.out)["wiring"]["status"], "open");
  const Outcome judged = verify(where, {"--array", "six.toml", "--calibration", "six.json", "--out", "r"});
  EXPECT_EQ(judged.code, 6) << judged.out;
  EXPECT_TRUE(says(judged.out, {"INCONCLUSIVE", "the wiring is not confirmed"}));
  const Outcome refused = calibrate_with(where.known(2));
  EXPECT_EQ(refused.code, 4) << refused.out;
  EXPECT_TRUE(says(refused.err, {"station 2", "as if the sensors were wired otherwise"}));
}

/// The same station on the same log, straight and swapped.
// Negative: REQ-183
TEST(KnownAttitude, OneStationClosesTheItemOrRefusesTheTool) {
  const Mirrored where;
  const std::vector<std::string> known = {"--known-attitude", kKnownStation};
  EXPECT_EQ(calibrate(where, "calibration.csv", "good.json", known).code, 0);
  const Outcome good = verify(where, {"--array", "array.toml", "--calibration", "good.json", "--out", "g"});
  EXPECT_TRUE(says(good.out, {"fit, evidence incomplete"}));
  EXPECT_EQ(report_in(where / "g")["verdict"]["verdict"], "fit, evidence incomplete");
  EXPECT_EQ(criterion(report_in(where / "g"))["found"], "confirmed by station 5");
  const Outcome bad = calibrate(where, "swapped.csv", "bad.json", known);
  EXPECT_EQ(bad.code, 4);
  EXPECT_TRUE(
      says(bad.err, {"station 5", "65.0 deg away", "as if the sensors were wired otherwise (a2 and a3 exchanged)",
                     "bad.json was not written", "Remedy: check the wiring"}));
  EXPECT_FALSE(std::filesystem::exists(where / "bad.json"));
  // Given late, to a calibration that was made without it.
  ASSERT_EQ(calibrate(where, "swapped.csv", "swapped.json").code, 0);
  const Outcome late = verify(where, {"--array", "array.toml", "--calibration", "swapped.json", "--known-attitude",
                                      kKnownStation, "--out", "b"});
  EXPECT_EQ(late.code, 6);
  EXPECT_TRUE(says(late.out, {"not fit", "as if the sensors were wired otherwise (a2 and a3 exchanged)"}));
  EXPECT_EQ(criterion(report_in(where / "b"))["result"], "not met");
  EXPECT_EQ(verify(where, {"--array", "array.toml", "--stations", "swapped.csv", "--known-attitude", kKnownStation,
                           "--out", "c"})
                .code,
            6);
}

TEST(KnownAttitude, TheArrayFileTakesItToo) {
  const Mirrored where;
  const std::string plain = where.text("array.toml");
  const auto state = [&where, &plain](const std::string& list) {
    where.put("array.toml", with(plain, "[input]\n", "[input]\nknown_attitudes = " + list + "\n"));
  };
  state("[\"" + std::string(kKnownStation) + "\"]");
  EXPECT_EQ(calibrate(where, "swapped.csv", "s.json").code, 4);
  (void)verify(where, {"--array", "array.toml", "--calibration", "calibration.json", "--out", "r"});
  EXPECT_EQ(report_in(where / "r")["verdict"]["verdict"], "fit, evidence incomplete");
  state("[\"5:33.5\"]");
  const Outcome wrong = calibrate(where, "calibration.csv", "s.json");
  EXPECT_EQ(wrong.code, 3);
  EXPECT_TRUE(says(wrong.err, {"known_attitudes", "STATION:INCLINATION,TOOLFACE"}));
  state("[5]");
  EXPECT_EQ(calibrate(where, "calibration.csv", "s.json").code, 3);
}

TEST(KnownAttitude, AStationThatDoesNotExistIsRefused) {
  const Mirrored where;
  const Outcome outcome = calibrate(where, "calibration.csv", "s.json", {"--known-attitude", "49:10,20"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(says(outcome.err, {"--known-attitude", "station 49", "48 stations", "--verbose"}));
  EXPECT_EQ(calibrate(where, "calibration.csv", "s.json", {"--known-attitude", "5:10"}).code, 2);
  EXPECT_EQ(verify(where, {"--array", "array.toml", "--calibration", "calibration.json", "--known-attitude", "49:10,20",
                           "--out", "r"})
                .code,
            2);
}

// Verifies: REQ-183
TEST(KnownAttitude, TheHealthReportHoldsTheOpenItem) {
  const Workshop where;
  const auto watched = [&where](const char* calibration) {
    run(where, {"monitor", "--array", "array.toml", "--calibration", calibration, "--log", "drilling.csv", "--report",
                "r.html"});
    return Json::parse(read_text(where / "r.json"));
  };
  const Json open = watched("calibration.json");
  ASSERT_EQ(open["answer"]["open_items"].size(), 1U);
  EXPECT_EQ(open["answer"]["open_items"][0]["name"], "wiring_confirmed");
  EXPECT_EQ(open["basis"]["wiring"]["status"], "open");
  EXPECT_TRUE(says(read_text(where / "r.html"), {"Open items", "wiring_confirmed", "a2 and a3 exchanged"}));
  ASSERT_EQ(calibrate(where, "calibration.csv", "known.json", {"--known-attitude", kKnownStation}).code, 0);
  const Json closed = watched("known.json");
  EXPECT_TRUE(closed["answer"]["open_items"].empty());
  EXPECT_EQ(closed["basis"]["wiring"]["status"], "confirmed");
  EXPECT_EQ(closed["basis"]["wiring"]["known_attitudes"][0]["station"], 5);
  EXPECT_EQ(read_text(where / "r.html").find("Open items"), std::string::npos);
}

/// Fitted axes come out wherever the wiring put them, so that they break the symmetry that hides it.
TEST(KnownAttitude, GeometryWithACalibrationCountsForTheDatasheetAxes) {
  const Mirrored where;
  ASSERT_EQ(calibrate(where, "swapped.csv", "swapped.json").code, 0);
  const Json nominal = Json::parse(run(where, {"geometry", "array.toml", "--json"}).out);
  const Json fitted =
      Json::parse(run(where, {"geometry", "array.toml", "--calibration", "swapped.json", "--json"}).out);
  EXPECT_EQ(nominal["unobservable_permutations"].size(), 8U);
  EXPECT_EQ(fitted["unobservable_permutations"], nominal["unobservable_permutations"]);
  const Outcome text = run(where, {"geometry", "array.toml", "--calibration", "swapped.json"});
  EXPECT_TRUE(says(text.out, {"not detected at any attitude", "a2 and a3 exchanged"}));
}

/// Not both can be right, and neither the wiring nor one station alone is to blame.
TEST(KnownAttitude, TwoThatContradictOneAnotherAreBothNamed) {
  const Workshop where;
  const Outcome outcome =
      calibrate(where, "calibration.csv", "s.json", {"--known-attitude", "1:10,20,1", "--known-attitude", "1:60,20,2"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"the known attitudes contradict one another", "station 1 at inclination 10.0 deg",
                                 "and station 1 at inclination 60.0 deg", "are 50.0 deg apart",
                                 "shows these stations 0.0 deg apart (tolerances 1 and 2 deg)",
                                 "Remedy: check the stated angles and the numbers of both stations"}));
  const Outcome two =
      calibrate(where, "calibration.csv", "s.json", {"--known-attitude", "2:45,20,1", "--known-attitude", "5:45,20,1"});
  EXPECT_EQ(two.code, 4);
  EXPECT_TRUE(says(two.err, {"contradict one another: station 2 at", "and station 5 at", "0.0 deg apart"}));
}

}  // namespace
}  // namespace known_attitude_test
