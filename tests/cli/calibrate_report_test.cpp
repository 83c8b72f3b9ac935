// plumb calibrate: what its report says, in words, figures and pictures, of good and of bad recordings.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace calibrate_report_test {
namespace {

using namespace plumb_test;

const std::vector<std::string> kCalibrate = {"calibrate",       "--array", "array.toml", "--log",
                                             "calibration.csv", "--out",   "new.json"};

Outcome calibrate(const Directory& where, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = kCalibrate;
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(where, arguments);
}

nlohmann::json report_of(const Directory& where, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = more;
  arguments.emplace_back("--json");
  return nlohmann::json::parse(calibrate(where, arguments).out);
}

/// The calibration log of the demo with a fault in it.
void inject(const Workshop& where, const std::string& fault) {
  const Outcome done = run(
      where, {"inject", "--array", "array.toml", "--log", "calibration.csv", "--fault", fault, "--out", "faulty.csv"});
  ASSERT_EQ(done.code, 0) << done.err;
  std::filesystem::rename(where / "faulty.csv", where / "calibration.csv");
}

/// Every number of the channels of the log multiplied.
void scale_log(const Workshop& where, double factor) {
  std::istringstream in(where.text("calibration.csv"));
  std::ostringstream out;
  out.precision(15);
  std::string line, field;
  for (int row = 0; std::getline(in, line); ++row) {
    std::istringstream fields(line);
    for (int column = 0; std::getline(fields, field, ','); ++column) {
      if (column > 0) out << ',';
      if (row > 0 && column > 1) {
        out << factor * std::stod(field);
      } else {
        out << field;
      }
    }
    out << '\n';
  }
  where.put("calibration.csv", out.str());
}

/// A roll at one inclination: the classic recording that is not enough.
void record_circle(const Workshop& where) {
  where.put(
      "circle.toml",
      "name = \"circle\"\narray = \"array.toml\"\nseed = 1\n[truth]\nlaw = \"uniform\"\nbias = \"20 mg0\"\nscale "
      "= \"2 %\"\ntilt = \"2 deg\"\nseed = 1\n[attitude]\nlaw = \"roll-test\"\ninclination = \"30 deg\"\nstations "
      "= 24\nrecord_motion = false\ntag_stations = true\n");
  const Outcome done = run(where, {"simulate", "circle.toml", "--out", "calibration.csv"});
  ASSERT_EQ(done.code, 0) << done.err;
}

TEST(CalibrateReport, SaysEveryFigureOfAGoodFit) {
  const Workshop where;
  const Outcome outcome = calibrate(where);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"stop",
                                 "converged",
                                 "rank",
                                 "13 of 16 parameters",
                                 "common rotation",
                                 "not determined",
                                 "nothing",
                                 "condition",
                                 "parity",
                                 "chi^2",
                                 "p = ",
                                 "recordings",
                                 "held out",
                                 "times what",
                                 "48 of 48",
                                 "common scale",
                                 "e_cal",
                                 "eqs (1)-(3)",
                                 "m_i1",
                                 "distinct",
                                 "excitation",
                                 "lacking",
                                 "nothing",
                                 "accepted"}));
  EXPECT_EQ(outcome.out.find("record next"), std::string::npos) << "nobody asked";
  const auto stored = nlohmann::json::parse(where.text("new.json"));
  EXPECT_EQ(stored["paper_parameters"]["sensors"].size(), 4U);
}

TEST(CalibrateReport, JsonHoldsTheSame) {
  const Workshop where;
  const auto json = report_of(where);
  EXPECT_EQ(json["hold_out"]["judged"], 48);
  EXPECT_LT(json["hold_out"]["sigmas"].get<double>(), 1.5);
  EXPECT_EQ(json["stations"][5]["held_out"]["stands_out"], false);
  EXPECT_EQ(json["paper_parameters"]["sensors"][2]["m"].size(), 4U);
  EXPECT_EQ(json["attitudes"]["record_next"].size(), 6U);
  EXPECT_GE(json["fit"]["cost"].size(), 2U);
  EXPECT_TRUE(json["fit"]["p_value_means"].is_string());
  EXPECT_LT(std::abs(json["common_scale"]["mean"].get<double>()), 0.02);
  ASSERT_EQ(json["sensors"].size(), 4U);
  for (const auto& sensor : json["sensors"]) EXPECT_GT(sensor["scale_data_share"].get<double>(), 0.99);
}

TEST(HoldOutOption, TakesFoldsFractionOneOrNone) {
  const Workshop where;
  EXPECT_EQ(report_of(where, {"--hold-out", "8"})["hold_out"]["folds"], 8);
  const auto fraction = report_of(where, {"--hold-out", "0.25"})["hold_out"];
  EXPECT_EQ(fraction["rounds"], 1);
  EXPECT_EQ(fraction["judged"], 12);
  EXPECT_EQ(report_of(where, {"--hold-out", "one"})["hold_out"]["folds"], 48);
  EXPECT_TRUE(report_of(where, {"--hold-out", "none"})["hold_out"].is_null());
  for (const char* wrong : {"1", "0", "-3", "0.7", "2.5", "half", "", "nan", "1e-9", "1e-12"}) {
    const Outcome outcome = calibrate(where, {"--hold-out", wrong});
    EXPECT_EQ(outcome.code, 2) << wrong;
    EXPECT_TRUE(says(outcome.err, {"--hold-out", "number of folds"})) << wrong;
  }
}

TEST(SuggestOption, ListsAttitudesAlsoWhereAllIsWell) {
  const Workshop where;
  EXPECT_TRUE(says(calibrate(where, {"--suggest"}).out, {"record next", "inclination", "toolface", "accepted"}));
}

TEST(CalibrateReport, OfOneCircleNamesWhatIsOpenAndWhatToRecord) {
  const Workshop where;
  record_circle(where);
  const Outcome outcome = calibrate(where, {"--suggest"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.out, {"8 of 16 parameters", "bias of a4 against scale of a4",
                                 "bias of a1 against scale of a1 and axis of a1", "held out", "not possible",
                                 "1 inclination; at least three are needed", "no station with a1 below", "record next",
                                 "inclination", "those of the refused fit", "NOT ACCEPTED", "8 of the 13 parameters"}));
  const auto json = report_of(where);
  EXPECT_EQ(json["unobservable"].size(), 5U);
  EXPECT_EQ(json["fit"]["rank"], 8);
  EXPECT_FALSE(json["sensors"][0]["bias_mps2"].is_null()) << "what is known of a refused fit is told";
}

TEST(CalibrateReport, FollowingTheSuggestionsMakesTheCircleSuffice) {
  const Workshop where;
  record_circle(where);
  const auto json = report_of(where);
  std::string list =
      "name = \"more\"\narray = \"array.toml\"\nseed = 2\n[truth]\nlaw = \"uniform\"\nbias = \"20 "
      "mg0\"\nscale = \"2 %\"\ntilt = \"2 deg\"\nseed = 1\n[attitude]\nlaw = \"list\"\nrecord_motion = "
      "false\ndirections = [";
  for (const auto& next : json["attitudes"]["record_next"]) list += next["down"].dump() + ", ";
  where.put("more.toml", list + "]\n");
  const Outcome more = run(where, {"simulate", "more.toml", "--out", "more.csv"});
  ASSERT_EQ(more.code, 0) << more.err;
  // Behind the circle in one log: later in time, and untagged.
  std::string log = where.text("calibration.csv");
  std::istringstream in(where.text("more.csv"));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) log += std::to_string(1000.0 + std::stod(line)) + line.substr(line.find(',')) + "\n";
  where.put("calibration.csv", log);
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"30 stations", "13 of 16 parameters", "accepted"}));
}

TEST(CalibrateRefuses, GravityThatIsNotTheEarths) {
  const Workshop where;
  where.put("array.toml", with(where.text("array.toml"), "value = \"9.80665 m/s^2\"", "value = \"9.9047 m/s^2\""));
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"gravity 9.9047 m/s^2 is more than anywhere on Earth", "[gravity]"}));
  EXPECT_EQ(report_of(where)["refusal"]["concern"], "gravity");
}

TEST(CalibrateRefuses, AllScalesOffTogether) {
  const Workshop where;
  scale_log(where, 0.94);
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err,
                   {"gravity reference or common scale off by", "all scale factors changed together by -", "`unit`"}));
}

TEST(CalibrateReport, SaysHowFarAllScalesMovedTogether) {
  const Workshop where;
  scale_log(where, 0.985);
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(
      says(outcome.out, {"all scale factors changed together by -", "gravity reference or common scale off by"}));
}

TEST(CalibrateRefuses, TheFaultySensorByName) {
  for (const char* fault : {"a2:bias=20mg0@60s", "a2:drift=0.1mg0/s@0s", "a2:last@60s", "a2:stuck=0V@0s",
                            "a2:scale=-1@0s", "a2:scale=1.4@0s", "a2:bias=300mg0@0s"}) {
    const Workshop where;
    inject(where, fault);
    const Outcome outcome = calibrate(where);
    EXPECT_EQ(outcome.code, 4) << fault;
    EXPECT_TRUE(says(outcome.err, {"not accepted", "a2", "new.json was not written"})) << fault;
    const std::string reason = outcome.err.substr(0, outcome.err.find("Remedy"));
    for (const char* healthy : {"a1", "a3", "a4"}) EXPECT_EQ(reason.find(healthy), std::string::npos) << outcome.err;
  }
}

TEST(CalibrateRefuses, ASensorThatStandsOutALittleAgainstTheOthers) {
  const Workshop where;
  inject(where, "a3:bias=0.5mg0@60s");
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.out, {"times what the declared noise", "stands out", "a3: with it"}));
  EXPECT_TRUE(says(outcome.err, {"the residuals of a3 are", "times those of the other sensors (allowed 3.0)"}));
}

TEST(CalibrateReport, NamesTheOutlierStation) {
  const Workshop where;
  inject(where, "a2:bias=50mg0@60s+10s");
  const Outcome outcome = calibrate(where);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"rejected", "station ", "of it from a2", "the values come from the other stations"}));
  const nlohmann::json json = report_of(where, {"--paper"});
  EXPECT_TRUE(json["paper"][0]["sound"]) << "the paper's fits get the same stations";
  const auto count = json["outliers"]["count"].get<std::size_t>();
  EXPECT_GE(count, 1U);
  ASSERT_EQ(json["outliers"]["listed"].size(), count);
  for (const auto& outlier : json["outliers"]["listed"]) {
    EXPECT_EQ(outlier["sensor"], "a2");
    const auto& station = json["stations"][outlier["station"].get<std::size_t>() - 1];
    EXPECT_LE(station["begin_s"].get<double>(), 70.0);
    EXPECT_GE(station["end_s"].get<double>(), 60.0);
  }
  EXPECT_EQ(json["hold_out"]["judged"].get<std::size_t>() + count, json["stations"].size());
}

TEST(KeepOutliersOption, LetsThemSpoilTheFit) {
  const Workshop where;
  inject(where, "a2:bias=50mg0@60s+10s");
  const Outcome outcome = calibrate(where, {"--keep-outliers"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_EQ(outcome.out.find("rejected  "), std::string::npos) << outcome.out;
}

TEST(CalibrateReport, NamesNoiseUnitAndTimeWhereNothingIsStill) {
  const Workshop noise;
  noise.put("array.toml", with(noise.text("array.toml"), "noise = \"200 ug0\"", "noise = \"20 ug0\""));
  EXPECT_TRUE(says(calibrate(noise).err, {"no stretch at rest", "`noise`", "a1", "times the",
                                          "plumb noise STILL.csv --array", "array.toml measures it"}));
  const Workshop unit;
  scale_log(unit, 1000.0);
  const std::string named = calibrate(unit).err;
  EXPECT_TRUE(
      says(named, {"no stretch at rest", "`unit` and `scale`", "times as long as gravity", "they look like mV"}));
  EXPECT_EQ(named.find("`noise`"), std::string::npos) << "in another unit it is no noise to declare: " << named;
  const Workshop time;
  time.put("array.toml", with(time.text("array.toml"), "[monitor]\n", "[monitor]\nmax_gap = \"1 ms\"\n"));
  EXPECT_TRUE(says(calibrate(time).err, {"no stretch at rest", "`time`", "max_gap"}));
  const Workshop brief;
  const std::string log = brief.text("calibration.csv");
  brief.put("calibration.csv", log.substr(0, log.find('\n', 2000) + 1));
  EXPECT_TRUE(says(calibrate(brief).err,
                   {"no stretch at rest", "a station needs at least 128 at rest", "rows = \"stations\""}));
  const Outcome none = calibrate(noise);
  EXPECT_EQ(none.code, 4);
  EXPECT_EQ(none.out.find(" 0.000 "), std::string::npos) << "what is not known is a dash:\n" << none.out;
}

TEST(CalibrateReport, AnOverstatedNoiseIsToldWithTheCommandThatMeasuresIt) {
  const Workshop where;
  EXPECT_EQ(calibrate(where).out.find("plumb noise"), std::string::npos) << "the noise is as declared";
  where.put("array.toml", with(where.text("array.toml"), "noise = \"200 ug0\"", "noise = \"2 mg0\""));
  EXPECT_TRUE(says(calibrate(where).out, {"the declared noise is too large", "plumb noise STILL.csv --array"}));
}

TEST(PlotsOption, DrawsFourPictures) {
  const Workshop where;
  const Outcome outcome = calibrate(where, {"--plots", "pictures"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* name : {"fit.gp", "fit-stations.csv", "fit-parameters.csv", "fit-cost.csv", "fit-next.csv"})
    EXPECT_TRUE(std::filesystem::exists(where.path() / "pictures" / name)) << name;
  if (outcome.err.find("gnuplot") != std::string::npos) GTEST_SKIP() << "no gnuplot here";
  for (const char* name : {"fit-residuals.svg", "fit-parameters.svg", "fit-convergence.svg", "fit-attitudes.svg"}) {
    EXPECT_NE(outcome.out.find(name), std::string::npos);
    EXPECT_NE(read_text(where.path() / "pictures" / name).find("</svg>"), std::string::npos) << name;
  }
  EXPECT_TRUE(outcome.err.empty()) << outcome.err;
}

TEST(PlotsOption, WithoutGnuplotTheRestIsDone) {
  const Workshop where;
  std::vector<std::string> arguments = kCalibrate;
  arguments.insert(arguments.end(), {"--plots", "pictures"});
  const Outcome outcome = run(where, arguments, "", {"PATH=/nonexistent"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.err, {"gnuplot", "not installed"}));
  EXPECT_TRUE(std::filesystem::exists(where / "new.json"));
  EXPECT_TRUE(std::filesystem::exists(where.path() / "pictures" / "fit.gp"));
  EXPECT_EQ(calibrate(where, {"--plots", "array.toml"}).code, 1) << "a file is no directory";
}

}  // namespace
}  // namespace calibrate_report_test
