// plumb survey: from stations in a CSV to a checked survey.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulated_hole.hpp"

namespace survey_command_test {
namespace {

TEST(SurveyCommand, PrintsStationsTestsAndThePath) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  const Outcome outcome = run(where, stated());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(
      outcome.out,
      {"run.csv: 21 stations, accelerometers in m/s^2, magnetometers in nT",
       "field 51000 nT (130 nT), dip 73.00 deg (0.20 deg); stated", "Declination: -2.50 deg from true north",
       "azimuths from true north", "1500.00", "accepted (V)", "2100.00   80.00  117.50", "accepted", "gravity passed",
       "field   passed", "dip     passed", "Path of 21 stations, minimum curvature from true north"}));
}

TEST(SurveyCommand, WritesTheTableAndJson) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  const Outcome outcome = run(where, stated({"--convergence", "1.5 deg", "--csv", "out.csv", "--json"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json found = survey_json_of(outcome);
  ASSERT_FALSE(found.is_discarded());
  EXPECT_EQ(found["north"], "grid");
  const nlohmann::json last = found["stations"][20];
  EXPECT_NEAR(last["azimuth_magnetic"]["deg"].get<double>(), 120.0, 1e-3);
  EXPECT_NEAR(last["azimuth_true"]["deg"].get<double>(), 117.5, 1e-3);
  EXPECT_NEAR(last["azimuth_grid"]["deg"].get<double>(), 116.0, 1e-3);
  EXPECT_GT(last["azimuth_grid"]["protection_level_deg"].get<double>(),
            3.0 * last["azimuth_grid"]["sigma_deg"].get<double>());
  EXPECT_TRUE(found["stations"][0]["azimuth_true"]["deg"].is_null());
  EXPECT_NE(found["stations"][0]["azimuth_true"]["why"].get<std::string>().find("of vertical"), std::string::npos);
  EXPECT_EQ(found["path"].size(), 21U);
  EXPECT_TRUE(says(where.text("out.csv"), {"MD_m,Inc_deg,AziMag_deg,AziTrue_deg,AziGrid_deg", "\n1500.00,0.00,,,",
                                           "\n2100.00,80.00,120.00,117.50,116.00", ",grid\n"}));
}

TEST(SurveyCommand, TakesGravityAndFieldFromPlaceAndDate) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  const Outcome outcome =
      run(where, {"survey", "run.csv", "--place", "60.4, 2.1", "--height", "25 m", "--date", "2026-03-31", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json found = survey_json_of(outcome);
  EXPECT_EQ(found["field_source"], "WMM-2025, ISCWSA MWD rev. 5, standard resolution");
  const nlohmann::json first = found["stations"][0];
  EXPECT_NEAR(first["field_nt"]["reference"].get<double>(), 51100.0, 400.0);
  EXPECT_NEAR(first["gravity_mps2"]["reference"].get<double>(), 9.8205, 1e-3);
  // Deeper by 20 stations: both grow.
  EXPECT_GT(found["stations"][20]["field_nt"]["reference"].get<double>(),
            first["field_nt"]["reference"].get<double>() + 5.0);
  EXPECT_GT(found["stations"][20]["gravity_mps2"]["reference"].get<double>(),
            first["gravity_mps2"]["reference"].get<double>());
  const Outcome wmm =
      run(where, {"survey", "run.csv", "--place", "60.4, 2.1", "--date", "2026-03-31", "--reference-errors", "wmm"});
  EXPECT_TRUE(says(wmm.out, {"(138 nT)", "WMM-2025, WMM2025 error model"}));
}

TEST(SurveyCommand, EstimatesInterferenceOrSaysWhyNot) {
  const Desk where;
  Hole hole;
  hole.interference_nt = 400.0;
  where.put("run.csv", hole.csv());
  const Outcome found = run(where, stated({"--axial"}));
  EXPECT_EQ(found.code, 0) << found.err;
  EXPECT_TRUE(says(found.out, {"Axial interference: ", "nT, 1 sigma", "taken off every station"}));
  // One station after another at the same attitude.
  const std::string whole = hole.csv();
  const std::string line = whole.substr(whole.rfind("\n2100.0") + 1);
  std::string tangent = hole.header;
  for (int k = 0; k < 12; ++k) tangent += std::to_string(2100 + 30 * k) + line.substr(line.find(','));
  where.put("run.csv", tangent);
  const Outcome refused = run(where, stated({"--axial"}));
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(says(refused.out, {"Axial interference: not estimated",
                                 "do not tell magnetometer bias z from an error of the reference"}));
  EXPECT_TRUE(says(refused.err, {"could not be estimated"}));
}

TEST(SurveyCommand, AlignsTheMagnetometersOrSaysWhyNot) {
  const Desk where;
  Hole hole;
  hole.turned_deg = 0.7;
  where.put("run.csv", hole.csv());
  const nlohmann::json before = survey_json_of(run(where, stated({"--json"})));
  const Outcome outcome = run(where, stated({"--align-magnetometers", "--json"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json after = survey_json_of(outcome);
  EXPECT_TRUE(before["magnetometer_alignment"].is_null());
  const nlohmann::json alignment = after["magnetometer_alignment"];
  EXPECT_EQ(alignment["estimated"], true);
  EXPECT_NEAR(alignment["turn_deg"][0].get<double>(), 0.0, 0.01);
  EXPECT_NEAR(alignment["turn_deg"][2].get<double>(), 0.7, 0.02);
  EXPECT_LT(alignment["sigma_deg"][2].get<double>(), 0.1);
  EXPECT_EQ(alignment["axes"].size(), 3U);
  EXPECT_LT(alignment["axes"][0]["sigma_deg"].get<double>(), 0.1);
  const auto off = [](const nlohmann::json& found) {
    return std::fabs(found["stations"][10]["azimuth_magnetic"]["deg"].get<double>() - 120.0);
  };
  EXPECT_GT(off(before), 0.3);
  EXPECT_LT(off(after), 0.05);
  EXPECT_TRUE(says(run(where, stated({"--align-magnetometers"})).out,
                   {"Alignment of the magnetometers: turned by ", "deg about tool x, y, z (1 sigma", "Weakest about ",
                    "Dips held out"}));
  // Rolled upright: nothing shows the rotation about the axis of the tool. The survey is printed as it was read.
  const std::string whole = hole.csv();
  const std::size_t first = whole.find('\n') + 1;
  std::string upright = hole.header;
  for (int k = 0; k < 12; ++k) {
    const std::string line = whole.substr(first, whole.find('\n', first) + 1 - first);
    upright += std::to_string(1500 + 30 * k) + line.substr(line.find(','));
  }
  where.put("run.csv", upright);
  const Outcome refused = run(where, stated({"--align-magnetometers"}));
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(says(refused.out, {"accepted (V)", "Alignment of the magnetometers: not estimated",
                                 "these stations do not show", "towards magnetic east"}));
  EXPECT_TRUE(says(refused.err, {"the alignment of the magnetometers could not be estimated"}));
  const nlohmann::json why = survey_json_of(run(where, stated({"--align-magnetometers", "--json"})));
  EXPECT_EQ(why["magnetometer_alignment"]["estimated"], false);
  EXPECT_LT(why["magnetometer_alignment"]["rank"].get<int>(), 3);
}

TEST(SurveyCommand, RefusesAnAlignmentThatIsNotStatedWell) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  const std::pair<std::vector<std::string>, std::vector<std::string>> cases[] = {
      {{"--align-magnetometers", "--axial"}, {"--align-magnetometers", "together with --axial", "leave one out"}},
      {{"--align-magnetometers", "--alignment-sigma", "0 deg"}, {"--alignment-sigma", "at most 30 deg"}},
      {{"--align-magnetometers", "--alignment-sigma", "31 deg"}, {"--alignment-sigma", "at most 30 deg"}},
      {{"--align-magnetometers", "--alignment-sigma", "1"}, {"--alignment-sigma"}},
      {{"--alignment-sigma", "1 deg"}, {"--alignment-sigma", "--align-magnetometers"}},
  };
  for (const auto& [more, words] : cases) {
    const Outcome outcome = run(where, stated(more));
    EXPECT_EQ(outcome.code, 2) << more.back();
    EXPECT_TRUE(says(outcome.err, words));
  }
}

TEST(SurveyCommand, RefusesUnitsAndAxesThatCannotBe) {
  const Desk where;
  Hole hole;
  hole.unit_nt = 1000.0;  // uT under the name of G
  hole.header = "md_m,gx_mps2,gy_mps2,gz_mps2,bx_G,by_G,bz_G\n";
  where.put("run.csv", hole.csv());
  Outcome outcome = run(where, stated());
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(says(outcome.err, {"bx_G", "a field of 5100 uT", "right in uT"}));
  hole = Hole{};
  hole.exchanged = true;
  where.put("run.csv", hole.csv());
  outcome = run(where, stated());
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(says(outcome.err, {"x and y of one triad are exchanged", "rename the columns"}));
}

// Verifies: REQ-234
TEST(SurveyCommand, AtAPoleHasNoTrueNorthAndSaysSo) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  for (const char* place : {"90, 0", "-90, 120"}) {
    const Outcome outcome = run(where, {"survey", "run.csv", "--place", place, "--date", "2026-03-31"});
    EXPECT_TRUE(says(outcome.out,
                     {"Declination: not known; azimuths are magnetic",
                      "Declination: at a pole of rotation there is no true north", "azimuths from magnetic north"}));
    const Outcome refused =
        run(where, {"survey", "run.csv", "--place", place, "--date", "2026-03-31", "--north", "true"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(
        says(refused.err, {"--north", "there is no declination", "at a pole of rotation there is no true north"}));
  }
  const Outcome weak = run(where, {"survey", "run.csv", "--place", "86.0, 140", "--date", "2026-03-31"});
  EXPECT_TRUE(says(weak.out, {"Declination: blackout zone: the horizontal field is", "too weak to rely on"}));
}

TEST(SurveyCommand, OfAVerticalToolPrintsNoAzimuthAndSaysWhy) {
  const Desk where;
  const std::string whole = Hole{}.csv();
  const std::size_t first = whole.find('\n') + 1;
  where.put("run.csv", whole.substr(0, whole.find('\n', first) + 1));  // one station, vertical
  const Outcome outcome = run(where, stated({"--csv", "out.csv", "--report", "page.html"}));
  EXPECT_TRUE(
      says(outcome.out, {"1500.00    0.00       -", "accepted (V)", "Flags: V too near vertical for an azimuth"}));
  EXPECT_TRUE(says(where.text("out.csv"), {"\n1500.00,0.00,,,,,"}));
  EXPECT_TRUE(says(where.text("page.html"), {"azimuth</td>", "of vertical"}));
}

// Verifies: REQ-232
TEST(SurveyCommand, WithoutADeclinationNamesMagneticNorthEverywhere) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  const std::vector<std::string> magnetic{"survey", "run.csv", "--gravity", "9.81912 m/s^2", "--field",  "51000 nT",
                                          "--dip",  "73 deg",  "--csv",     "out.csv",       "--report", "page.html"};
  const Outcome outcome = run(where, magnetic);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"Declination: not known; azimuths are magnetic", "azimuths from magnetic north",
                                 "minimum curvature from magnetic north"}));
  EXPECT_TRUE(says(where.text("out.csv"), {"2100.00,80.00,120.00,,", ",magnetic\n"}));
  EXPECT_TRUE(
      says(where.text("page.html"), {"magnetic north", "every azimuth of this page is magnetic", "azi magnetic"}));
  std::vector<std::string> json = magnetic;
  json.push_back("--json");
  const nlohmann::json found = survey_json_of(run(where, json));
  EXPECT_EQ(found["north"], "magnetic");
  EXPECT_TRUE(found["stations"][20]["azimuth_true"]["deg"].is_null());
  EXPECT_EQ(found["stations"][20]["azimuth_true"]["why"], "the reference states no declination");
}

TEST(SurveyCommand, TellsAMagnetometerAtTheEndOfItsRange) {
  const Desk where;
  Hole hole;
  hole.full_scale_nt = 40000.0;
  where.put("run.csv", hole.csv());
  const Outcome outcome = run(where, stated({"--report", "page.html"}));
  EXPECT_TRUE(says(outcome.out, {"inclination only (B", "bz reads 40000 nT at", "saturated or stuck"}));
  EXPECT_TRUE(says(where.text("page.html"), {"bz reads 40000 nT at", "saturated or stuck"}));
  EXPECT_FALSE(says(run(where, stated({"--json"})).out, {"\"saturated\": []"}));
}

TEST(SurveyCommand, SaysWhatIsMissing) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  const std::pair<std::vector<std::string>, std::vector<std::string>> cases[] = {
      {{"survey", "run.csv"}, {"--gravity", "state it, or give --place"}},
      {{"survey", "run.csv", "--gravity", "9.81 m/s^2"}, {"--field", "give --place and --date"}},
      {{"survey", "run.csv", "--place", "60,2"}, {"--date", "give --place and --date"}},
      {{"survey", "run.csv", "--place", "60", "--date", "2026-01-01"}, {"--place", "write it as in"}},
      {{"survey", "run.csv", "--place", "91,2", "--date", "2026-01-01"}, {"--place"}},
      {{"survey", "run.csv", "--place", "60,2", "--date", "2031-01-01"},
       {"--date", "holds from 2025.0 to 2030.0", "coefficients"}},
      {{"survey", "run.csv", "--place", "60,2", "--date", "1.1.2026"}, {"--date"}},
      {{"survey", "run.csv", "--gravity", "9.81", "--field", "50000 nT", "--dip", "70 deg"}, {"--gravity"}},
      {{"survey", "run.csv", "--gravity", "9.81 m/s^2", "--field", "50000 nT"}, {"--dip", "state both"}},
      {{"survey", "run.csv", "--gravity", "9.81 m/s^2", "--field", "50 nT", "--dip", "70 deg"},
       {"total field", "1 uT is 1000 nT"}},
      {{"survey", "run.csv", "--gravity", "9.81 m/s^2", "--field", "50000 nT", "--dip", "70 deg", "--north", "true"},
       {"--north", "no declination"}},
      {{"survey", "run.csv", "--gravity", "9.81 m/s^2", "--field", "50000 nT", "--dip", "70 deg", "--north", "up"},
       {"magnetic, true or grid"}},
      {stated({"--north", "grid"}), {"no convergence", "--convergence"}},
      {stated({"--height", "3 m"}), {"--height", "without a place"}},
  };
  for (const auto& [arguments, words] : cases) {
    const Outcome outcome = run(where, arguments);
    EXPECT_NE(outcome.code, 0) << arguments.back();
    EXPECT_TRUE(says(outcome.err, words));
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(SurveyCommand, WritesThePageWithTheCommandThatMakesItAgain) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  const Outcome outcome =
      run(where, stated({"--noise-field", "30 nT", "--false-alarm", "0.01", "--report", "page.html"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string page = where.text("page.html");
  EXPECT_TRUE(says(page, {"Survey: run.csv", "21 of 21 stations accepted", "azi true, deg", "1500.00", "2100.00",
                          "run.csv", "plumb survey run.csv --gravity &apos;9.81912 m/s^2&apos; --field",
                          "--noise-field", "--report page.html --false-alarm 0.01"}));
  EXPECT_EQ(page.find("http"), std::string::npos);
  EXPECT_EQ(page.find("--risk"), std::string::npos);
  EXPECT_EQ(run(where, stated({"--report", "run.csv"})).code, 2);
  EXPECT_EQ(run(where, stated({"--report", "no/such/place.html"})).code, 1);
}

TEST(SurveyCommand, OfAToolUpsideDownJudgesNothing) {
  const Desk where;
  where.put(
      "run.csv",
      "md_m,gx_mps2,gy_mps2,gz_mps2,bx_nT,by_nT,bz_nT\n1,0.1,0.2,9.0,1000,2000,48000\n2,0.1,0.3,9.1,1000,2000,48000\n");
  const Outcome outcome = run(where, stated());
  EXPECT_EQ(outcome.code, 7);
  EXPECT_TRUE(says(outcome.out, {"rejected (G"}));
  EXPECT_TRUE(says(outcome.err, {"no station passed the check of gravity"}));
}

}  // namespace
}  // namespace survey_command_test
