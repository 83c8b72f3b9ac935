// plumb monitor --report: the health report of a run, from the command line to the files.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "plumb/core/units.hpp"
#include "tool_runner.hpp"

namespace monitor_report_test {
namespace {

using namespace plumb_test;
using Json = nlohmann::ordered_json;

std::vector<std::string> reported(const std::string& log, std::vector<std::string> more = {}) {
  std::vector<std::string> out = {"monitor", "--array", "array.toml", "--calibration", "calibration.json",
                                  "--log",   log,       "--report",   "r.html"};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

constexpr double kG0 = plumb::kG0_mps2;
const bool kHasGnuplot = std::system("command -v gnuplot >/dev/null 2>&1") == 0;  // NOLINT(cert-env33-c)

Json report_of(const Directory& where) { return Json::parse(read_text(where / "r.json")); }

/// The drilling run of the examples without its fault.
const std::string& clean_log() {
  static const std::string text = [] {
    Directory where;
    std::string scenario = read_text(PLUMB_SOURCE_DIR "/examples/drilling.toml");
    scenario =
        with(scenario.substr(0, scenario.find("[[fault]]")), "array = \"paper_tool.toml\"", "array = \"array.toml\"");
    write_text(where / "clean.toml", scenario);
    std::filesystem::copy_file(example_files() / "array.toml", where / "array.toml");
    EXPECT_EQ(run(where, {"simulate", "clean.toml", "--out", "clean.csv"}).code, 0);
    return read_text(where / "clean.csv");
  }();
  return text;
}

std::string colours(const Json& report) {
  std::string out;
  for (const Json& s : report["stations"]) out += s["colour"].get<std::string>()[0];
  return out;
}

// Verifies: REQ-179
TEST(MonitorReport, ARunWithoutAlarmsEndsGreen) {
  const Workshop shop;
  shop.put("clean.csv", clean_log());
  const Outcome outcome = run(shop, reported("clean.csv"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out,
                   {" blocks at rest, 1 change, 0 bad rows skipped", "r.html", "Usable for survey: yes", "Continue."}));
  const Json report = report_of(shop);
  EXPECT_EQ(report["schema"], "plumb-health");
  EXPECT_EQ(report["answer"]["usable_for_survey"], "yes");
  ASSERT_EQ(report["stations"].size(), 14U);
  const std::string seen = colours(report);
  EXPECT_EQ(seen.find('r'), std::string::npos) << seen;
  EXPECT_EQ(seen.substr(8), "gggggg") << seen;  // once validated
  const Json& last = report["stations"][13];
  const double inclination_deg = last["inclination_deg"];
  EXPECT_NEAR(inclination_deg, 5.0 + 13 * 4.2, 2.0);  // gravity does not show how all axes sit in the housing
  EXPECT_TRUE(says(outcome.out, {fmt::format("inclination {:.2f}", std::floor(100.0 * inclination_deg) / 100.0)}));
  EXPECT_LT(last["inclination_sigma_deg"].get<double>(), 0.05);
  EXPECT_EQ(last["used"].size(), 4U);
  EXPECT_NEAR(last["length_mps2"].get<double>(), plumb::kG0_mps2, last["length_limit_mps2"].get<double>());
  EXPECT_TRUE(last["depth_m"].is_null());
  EXPECT_TRUE(says(read_text(shop / "r.html"), {"Usable for survey: yes", "<svg", "Roll test", "<svg"}));
}

// Negative: REQ-179
TEST(MonitorReport, AFaultIsRedThenOrangeAndNoTripContinuesUnwarned) {
  const Workshop shop;
  const Outcome outcome = run(shop, reported("drilling.csv"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json report = report_of(shop);
  const std::string seen = colours(report);
  ASSERT_EQ(seen.size(), 14U);
  EXPECT_EQ(seen[5], 'r') << seen;                                 // a2 is dead, and it is not yet known who
  EXPECT_EQ(seen.substr(6).find('g'), std::string::npos) << seen;  // three sensors are left
  EXPECT_EQ(seen.back(), 'o') << seen;
  EXPECT_EQ(report["answer"]["usable_for_survey"], "orientation only");
  EXPECT_EQ(report["answer"]["excluded"], Json::array({"a2"}));
  EXPECT_EQ(report["stations"][13]["used"], Json::array({"a1", "a3", "a4"}));
  EXPECT_TRUE(says(outcome.out, {"orientation only", "next trip", "Do not use the red stations: 6"}));
  bool excluded = false;
  for (const Json& e : report["events"])
    excluded = excluded || (e["cause"] == "isolated_fault" && e["sensors"] == Json::array({"a2"}));
  EXPECT_TRUE(excluded) << report["events"].dump(1);
  EXPECT_TRUE(says(read_text(shop / "r.html"), {"orientation only", "the sensors disagree with one another"}));
}

// Verifies: REQ-179
TEST(MonitorReport, AMonitorThatGaveUpMeansNo) {
  const Workshop shop;
  ASSERT_EQ(run(shop, {"inject", "--array", "array.toml", "--log", "drilling.csv", "--fault", "a1:off@34s", "--out",
                       "two.csv"})
                .code,
            0);
  const Outcome outcome = run(shop, reported("two.csv"));
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  EXPECT_EQ(report_of(shop)["answer"]["usable_for_survey"], "no");
  EXPECT_TRUE(says(outcome.out, {"in service  none", "Usable for survey: no", "Do not survey or steer"}));
  EXPECT_EQ(report_of(shop)["answer"]["state"], "failed");
  EXPECT_EQ(report_of(shop)["answer"]["in_service"], Json::array()) << "as the summary says";
}

/// Every output names the sensor, and what to do names the figure to write.
TEST(MonitorReport, ANoisySensorIsNamedWithItsNoiseAndARemedy) {
  const Workshop shop;
  shop.put("clean.csv", clean_log());
  ASSERT_EQ(run(shop, {"inject", "--array", "array.toml", "--log", "clean.csv", "--fault", "a3:noise=2mg0@20s", "--out",
                       "noisy.csv"})
                .code,
            0);
  const Outcome outcome = run(shop, reported("noisy.csv", {"--events", "e.jsonl"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"a3 scatters while the others are at rest", "excluded", "a3 (noisy)",
                                 "noisy       a3 scatters by ", " mg0 declared", "cable, connector", "state noise = \"",
                                 " mg0\" for it in array.toml", "  - a3 scatters by "}));
  const Json report = report_of(shop);
  EXPECT_TRUE(says(report["events"].dump(), {"isolated_fault", "a3 scatters while the others are at rest"}));
  EXPECT_TRUE(says(report["answer"]["actions"].dump(), {"a3 scatters by "}));
  const Json& sensors = report["extremes"]["sensors"];
  EXPECT_EQ(sensors[2]["noisy"], true);
  EXPECT_NEAR(sensors[2]["noise_measured_mps2"].get<double>(), 2e-3 * plumb::kG0_mps2, 2e-4 * plumb::kG0_mps2);
  EXPECT_EQ(sensors[0]["noisy"], false);
  EXPECT_TRUE(sensors[0]["noise_measured_mps2"].is_null());
  EXPECT_TRUE(says(read_text(shop / "e.jsonl"), {"isolated_fault", "\"a3\""}));
}

/// The readings of a1 in this log, with those within a stretch of time put at full scale.
std::string at_full_scale(const std::string& log, double from_s, double to_s) {
  std::istringstream in(log);
  std::string line, out;
  std::size_t column = 0;
  for (int k = 0; std::getline(in, line); ++k) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (k == 0) column = static_cast<std::size_t>(std::find(cells.begin(), cells.end(), "a1") - cells.begin());
    if (k > 0 && std::stod(cells[0]) > from_s && std::stod(cells[0]) < to_s) cells.at(column) = "5";
    for (std::size_t c = 0; c < cells.size(); ++c) out += (c == 0 ? "" : ",") + cells[c];
    out += '\n';
  }
  return out;
}

TEST(MonitorReport, FullScaleAndBlocksInMotionAreCounted) {
  const Workshop shop;
  shop.put("clipped.csv", at_full_scale(clean_log(), 32.2, 32.805));
  const Outcome outcome = run(shop, reported("clipped.csv"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"blocks in motion: ", " of ", " %)",
                                 "full scale  a1 was at full scale in 60 rows in motion and "
                                 "0 rows at rest",
                                 "shock or vibration", "drift rate  none found"}));
  const Json extremes = report_of(shop)["extremes"];
  EXPECT_GT(extremes["blocks_in_motion"].get<int>(), 10);
  EXPECT_EQ(extremes["sensors"][0]["rows_full_scale_in_motion"], 60);
  EXPECT_EQ(extremes["sensors"][1]["rows_full_scale_in_motion"], 0);
  EXPECT_TRUE(says(read_text(shop / "r.html"), {"blocks in motion", "rows at full scale in motion"}));
  const Outcome json = run(shop, {"monitor", "--array", "array.toml", "--calibration", "calibration.json", "--log",
                                  "clipped.csv", "--json"});
  const std::string last = json.out.substr(json.out.rfind("{\"summary\""));
  const Json summary = Json::parse(last)["summary"];
  EXPECT_EQ(summary["blocks_in_motion"], extremes["blocks_in_motion"]);
  EXPECT_EQ(summary["sensors"][0]["rows_full_scale_in_motion"], 60);
}

TEST(MonitorReport, WithoutAStationTheAnswerIsNo) {
  const Workshop shop;
  const std::string log = shop.text("drilling.csv");
  const std::string header = line_of(log, 1) + "\n";
  shop.put("empty.csv", header);
  EXPECT_EQ(run(shop, reported("empty.csv")).code, 3);
  EXPECT_EQ(report_of(shop)["answer"]["usable_for_survey"], "no");
  EXPECT_EQ(report_of(shop)["identity"]["log"]["ended"], "in an error");
  std::string few = header;
  for (int k = 2; k < 12; ++k) few += line_of(log, k) + "\n";
  shop.put("few.csv", few);
  const Outcome outcome = run(shop, reported("few.csv"));
  EXPECT_EQ(outcome.code, 7);
  EXPECT_TRUE(says(outcome.out, {"Usable for survey: no", "no stretch at rest", "hold the tool still"}));
  const Json report = report_of(shop);
  EXPECT_EQ(report["extremes"]["samples"], 10);
  EXPECT_TRUE(report["stations"].empty());
  EXPECT_TRUE(says(read_text(shop / "r.html"), {"no complete block at rest", "No station has a toolface"}));
}

TEST(MonitorReport, TakesDepthFromTheLog) {
  const Workshop shop;
  shop.put("array.toml", with(shop.text("array.toml"), "[input]", "[input]\ndepth = \"MD\"\ndepth_unit = \"ft\""));
  std::istringstream in(shop.text("drilling.csv"));
  std::string line, out;
  for (int k = 0; std::getline(in, line); ++k)
    out += line + (k == 0 ? ",MD" : (k % 100 == 1 ? "," + std::to_string(1000 + k / 100) : ",")) + "\n";
  shop.put("deep.csv", out);
  EXPECT_EQ(run(shop, reported("deep.csv")).code, 0);
  const Json report = report_of(shop);
  double before_m = 0.0;
  for (const Json& s : report["stations"]) {
    EXPECT_GT(s["depth_m"].get<double>(), before_m);
    before_m = s["depth_m"];
    EXPECT_NEAR(before_m / 0.3048, 1000.0 + s["end_s"].get<double>(), 1.0);
    EXPECT_TRUE(says(read_text(shop / "r.html"), {fmt::format(">{:.2f}<", before_m)}));
  }
  shop.put("bad.csv", with(out, ",1003", ",deep"));
  const Outcome bad = run(shop, reported("bad.csv"));
  EXPECT_EQ(bad.code, 3);
  EXPECT_TRUE(says(bad.err, {"MD", "\"deep\" is not a depth"}));
  // A log with a fault keeps its depths.
  ASSERT_EQ(run(shop, {"inject", "--array", "array.toml", "--log", "deep.csv", "--fault", "a1:bias=1mg0@30s", "--out",
                       "injected.csv"})
                .code,
            0);
  EXPECT_EQ(run(shop, reported("injected.csv")).code, 0);
  EXPECT_EQ(report_of(shop)["stations"][0]["depth_m"], report["stations"][0]["depth_m"]);
  EXPECT_TRUE(report["stations"][0]["depth_m"].is_number());
}

TEST(MonitorReport, AFlightShowsForceBoundAndWhoWasIsolated) {
  const Directory where;
  std::filesystem::copy_file(PLUMB_SOURCE_DIR "/examples/motion/drone.toml", where / "array.toml");
  ASSERT_EQ(run(where, {"simulate", "--flight", "drone", "array.toml", "--seed", "1", "--duration", "5", "--fault",
                        "imu2:stuck=0g0@3s", "--out", "flight.csv"})
                .code,
            0);
  const std::vector<std::string> monitored = {"monitor", "--array",    "array.toml", "--calibrate-first",
                                              "--log",   "flight.csv", "--report",   "r.html"};
  const Outcome outcome = run(where, monitored);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json motion = report_of(where)["motion"];
  ASSERT_TRUE(motion.is_object());
  EXPECT_EQ(motion["isolated"].size(), 3U);
  ASSERT_EQ(motion["events"].size(), 4U) << motion["events"].dump();
  EXPECT_EQ(motion["events"][0]["event"], "alarm");
  EXPECT_EQ(motion["events"][2]["event"], "excluded");
  EXPECT_EQ(motion["events"][2]["sensors"], Json({"x2", "y2", "z2"}));
  ASSERT_GT(motion["trace"].size(), 100U);
  EXPECT_EQ(motion["trace"].front()["sensors_used"], 9);
  EXPECT_EQ(motion["trace"].back()["sensors_used"], 6);
  int alarmed = 0;
  for (const Json& point : motion["trace"]) {
    EXPECT_LT(point["bound_mps2"].get<double>(), 0.2 * kG0) << point.dump();
    alarmed += point["alarm"].get<bool>() ? 1 : 0;
  }
  EXPECT_GT(alarmed, 0);
  const std::string page = read_text(where / "r.html");
  EXPECT_TRUE(says(page, {"In motion x2, y2, z2 (imu2) at 3.001 s contradicted the others", "5 In motion",
                          "provisionally excluded", "x2, y2, z2", "Events in motion"}));
  EXPECT_EQ(page.find("contradictions on record") != std::string::npos, kHasGnuplot) << "the picture";
}

TEST(MonitorReport, MotionThatIsNotJudgedIsSaidWithWhatIsMissing) {
  const Directory where;
  const std::string text = read_text(PLUMB_SOURCE_DIR "/examples/motion/drone.toml");
  write_text(where / "array.toml", with(text, "lag_bound_s = 70e-6 ", "# "));
  ASSERT_EQ(run(where, {"simulate", "--flight", "drone", PLUMB_SOURCE_DIR "/examples/motion/drone.toml", "--duration",
                        "3", "--out", "flight.csv"})
                .code,
            0);
  run(where, {"monitor", "--array", "array.toml", "--calibrate-first", "--log", "flight.csv", "--report", "r.html"});
  const Json motion = report_of(where)["motion"];
  EXPECT_EQ(motion["judged"], false) << motion.dump();
  EXPECT_TRUE(says(read_text(where / "r.html"), {"5 In motion", "Not judged: ", "lag_bound_s"}));
}

TEST(MonitorReport, StandsBesideTheOtherOutputsAndRepeats) {
  const Workshop shop;
  const std::vector<std::string> more = {"--events", "e.jsonl", "--verdicts", "v.jsonl", "--snapshot-out", "s.bin"};
  ASSERT_EQ(run(shop, reported("drilling.csv", more)).code, 0);
  Json first = report_of(shop);
  const std::string events = read_text(shop / "e.jsonl");
  EXPECT_EQ(static_cast<std::size_t>(std::count(events.begin(), events.end(), '\n')), first["events"].size());
  EXPECT_FALSE(read_text(shop / "v.jsonl").empty());
  ASSERT_EQ(run(shop, reported("drilling.csv")).code, 0);
  Json second = report_of(shop);
  EXPECT_FALSE(first["run"].empty());
  first.erase("run");
  second.erase("run");
  EXPECT_EQ(first, second);
  EXPECT_TRUE(says(first["identity"]["command"].get<std::string>(),
                   {"plumb monitor", "--array array.toml", "--log drilling.csv", "--report r.html"}));
}

TEST(MonitorReport, AnInterruptionLosesNothing) {
  const Workshop shop;
  Process process(shop, reported("drilling.csv", {"--follow"}), -1, {});
  ASSERT_TRUE(process.says("is faulty and excluded"));
  process.interrupt();
  EXPECT_EQ(process.wait().code, 1);
  const Json report = report_of(shop);
  EXPECT_EQ(report["identity"]["log"]["ended"], "by an interruption");
  EXPECT_GE(report["stations"].size(), 7U);
  EXPECT_NE(read_text(shop / "r.html").find("by an interruption"), std::string::npos);
}

TEST(MonitorReport, WithoutGnuplotThePageSaysSo) {
  const Workshop shop;
  const Outcome outcome = run(shop, reported("drilling.csv"), "", {"PATH=/nowhere"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("gnuplot"), std::string::npos);
  EXPECT_NE(read_text(shop / "r.html").find("There is no picture: gnuplot: is not installed"), std::string::npos);
}

TEST(MonitorReport, WrongUseIsAnsweredWithWhatAndHow) {
  const Workshop shop;
  const auto answered = [&shop](const std::string& report, std::vector<std::string> more, int code,
                                const std::vector<std::string>& words) {
    std::vector<std::string> arguments = reported("drilling.csv", std::move(more));
    *(std::find(arguments.begin(), arguments.end(), "--report") + 1) = report;
    const Outcome outcome = run(shop, arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_TRUE(says(outcome.err, words));
  };
  answered("-", {}, 2, {"--report", "needs a file name that ends in .html", "FILE.html"});
  answered("report.pdf", {}, 2, {"--report", "FILE.html"});
  answered("r.html", {"--limits"}, 2, {"--report", "--limits", "leave out one"});
  answered("r.html", {"--events", "r.json"}, 2, {"r.json", "--events"});
  answered("calibration.html", {}, 2, {"calibration.json", "overwritten"});
  answered("nowhere/r.html", {}, 1, {"nowhere"});
  EXPECT_FALSE(std::filesystem::exists(shop / "r.html"));
}

TEST(MonitorReport, NamesCannotBreakOut) {
  const Workshop shop;
  shop.put("array.toml", with(shop.text("array.toml"), "paper-tetrahedron", "<script>alert(1)</script>"));
  EXPECT_EQ(run(shop, reported("drilling.csv")).code, 0);
  const std::string page = read_text(shop / "r.html");
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find("<script"), page.rfind("<script")) << "the one of the charts";
  EXPECT_NE(page.find("&lt;script&gt;alert(1)"), std::string::npos) << "it is told, as text";
}

/// From the heading of the sign-off to its end.
std::string sign_off_of(const std::string& page) {
  const std::size_t begin = page.find("<section id=\"signoff\"");
  return begin == std::string::npos ? "" : page.substr(begin, page.find("</section>", begin) - begin);
}

TEST(MonitorReport, TheSignOffComesFirstAndHoldsAllThatIsSigned) {
  const Workshop shop;
  ASSERT_EQ(run(shop, reported("drilling.csv")).code, 0);
  const std::string page = read_text(shop / "r.html"), sheet = sign_off_of(page);
  EXPECT_LT(page.find("id=\"signoff\""), page.find("id=\"verdict\""));
  const Json report = report_of(shop);
  for (const Json& input : report["identity"]["inputs"]) {
    const char* const hash = input.contains("sha256") ? "sha256" : "fnv1a";
    EXPECT_TRUE(says(sheet, {input["role"], input[hash]})) << input;
  }
  EXPECT_TRUE(says(sheet, {"orientation only", "Usable for survey?", "Which stations?", "Which sensors?",
                           "excluded: a2", "How far off can it be?", "Is |G| right?", "What not to trust?",
                           "serial number", "calibration date", report["run"]["time"], "Approved by", "Signature"}));
  EXPECT_NE(sheet.find("<p class=\"card notice open\">"), std::string::npos) << "in the colour of its verdict";
  EXPECT_NE(sheet.find("<div class=\"card bad\"><span>Which stations?"), std::string::npos) << "one is red";
}

TEST(MonitorReport, EverySensorHasATraceThatShowsItsFault) {
  const Workshop shop;
  ASSERT_EQ(run(shop, reported("drilling.csv")).code, 0);
  const Json report = report_of(shop);
  const Json& residuals = report["residuals"];
  EXPECT_EQ(residuals["sensors"], Json::array({"a1", "a2", "a3", "a4"}));
  double healthy_mg0 = 0.0, dead_mg0 = 0.0;
  for (const Json& point : residuals["points"]) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double off_mg0 = 1e3 * std::fabs(point["off_mps2"][i].get<double>()) / kG0;
      if (i == 1) dead_mg0 = std::fmax(dead_mg0, off_mg0);
      // At the end a2 is out of service and the three others determine the vector without a rest.
      if (i != 1 && point["t_s"].get<double>() > 25.0) healthy_mg0 = std::fmax(healthy_mg0, off_mg0);
    }
  }
  EXPECT_GT(dead_mg0, 100.0);
  EXPECT_LT(healthy_mg0, 1.0);
  if (!kHasGnuplot) return;
  EXPECT_TRUE(says(read_text(shop / "r.html"), {"Sensor by sensor", "a2, mg0", "up to -"}));
}

TEST(MonitorReport, ARunThatCalibratesItselfHasNoTraces) {
  const Workshop shop;
  const Outcome outcome = run(
      shop, {"monitor", "--array", "array.toml", "--calibrate-first", "--log", "drilling.csv", "--report", "r.html"});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_TRUE(report_of(shop)["residuals"].is_null());
  EXPECT_TRUE(says(read_text(shop / "r.html"), {"Sensor by sensor: not drawn"}));
}

}  // namespace
}  // namespace monitor_report_test
