// Whole surveys: files read, axes and units that are not what they are called, tables written.
#include "plumb/survey/survey_run.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "plumb/survey/station_file.hpp"
#include "plumb/survey/survey_csv.hpp"
#include "simulated_survey.hpp"

namespace survey_run_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;

TEST(Survey, LaysOutItsPathFromTheNorthThatIsNamed) {
  SurveySettings settings;
  const Survey s = run_survey(bent_hole(), settings);
  EXPECT_EQ(s.north, North::true_north);
  ASSERT_TRUE(s.path.has_value()) << s.path.error().text();
  EXPECT_EQ(s.on_path.size(), 20U);
  const PathPoint& end = s.path->back();
  EXPECT_NEAR(deg_from_rad(std::atan2(end.east_m, end.north_m)), 56.0, 0.01);
  EXPECT_TRUE(s.tests && s.tests->gravity.passed() && s.tests->field.passed() && s.tests->dip.passed());
  settings.station.convergence = {true, rad_from_deg(2.0)};
  const Survey grid = run_survey(bent_hole(), settings);
  EXPECT_EQ(grid.north, North::grid);
  EXPECT_NEAR(deg_from_rad(std::atan2(grid.path->back().east_m, grid.path->back().north_m)), 54.0, 0.01);
  settings.north = North::magnetic;
  EXPECT_NEAR(deg_from_rad(std::atan2(run_survey(bent_hole(), settings).path->back().east_m,
                                      run_survey(bent_hole(), settings).path->back().north_m)),
              60.0, 0.01);
}

TEST(Survey, WithoutADeclinationIsMagnetic) {
  std::vector<ReferencedStation> stations = bent_hole();
  for (ReferencedStation& s : stations) s.reference.field.declination_known = false;
  const Survey s = run_survey(stations, {});
  EXPECT_EQ(s.north, North::magnetic);
  EXPECT_EQ(s.stations.back().true_azimuth.error().why, NoAngle::no_declination);
  EXPECT_NE(survey_csv(s).find(",magnetic\n"), std::string::npos);
}

TEST(Survey, LeavesStationsThatFailedOffThePath) {
  std::vector<ReferencedStation> stations = bent_hole();
  stations[9].measured.field_tesla[0] += 9e-6;
  stations[12].measured.gravity_mps2 = scaled(stations[12].measured.gravity_mps2, 1.01);
  const Survey s = run_survey(stations, {});
  EXPECT_EQ(s.on_path.size(), 18U);
  EXPECT_EQ(s.stations[9].status, StationStatus::inclination_only);
  EXPECT_EQ(s.stations[12].status, StationStatus::rejected);
  ASSERT_TRUE(s.path.has_value());
  EXPECT_EQ(s.path->size(), 18U);
  EXPECT_EQ(s.tests->field.worst, 9);
}

TEST(Survey, TakesInterferenceOffWhereAskedTo) {
  std::vector<ReferencedStation> stations = bent_hole();
  for (ReferencedStation& s : stations) s.measured.field_tesla[2] += 500e-9;
  SurveySettings settings;
  const Survey before = run_survey(stations, settings);
  settings.correct_axial = true;
  const Survey after = run_survey(stations, settings);
  ASSERT_TRUE(after.axial && after.axial->has_value());
  EXPECT_NEAR((*after.axial)->value[8], 500e-9, 60e-9);
  EXPECT_FALSE(before.axial.has_value());
  const double truth = rad_from_deg(56.0);
  EXPECT_LT(std::fabs(after.stations.back().true_azimuth->angle.rad - truth),
            0.2 * std::fabs(before.stations.back().true_azimuth->angle.rad - truth));
}

TEST(Survey, AlignsMagnetometersWhereAskedTo) {
  std::vector<ReferencedStation> stations = bent_hole();
  const double turn = rad_from_deg(0.6), c = std::cos(turn), s = std::sin(turn);
  for (ReferencedStation& one : stations) {
    Vec3& b = one.measured.field_tesla;
    b = {c * b[0] + s * b[1], c * b[1] - s * b[0], b[2]};
  }
  SurveySettings settings;
  const Survey before = run_survey(stations, settings);
  EXPECT_FALSE(before.alignment.has_value());
  settings.align_within_rad = rad_from_deg(0.5);
  settings.correct_axial = true;
  const Survey after = run_survey(stations, settings);
  EXPECT_FALSE(after.axial.has_value());
  ASSERT_TRUE(after.alignment && after.alignment->has_value()) << after.alignment->error().text();
  EXPECT_NEAR((*after.alignment)->turn_rad[2], turn, 1e-4);
  const auto off = [](const Survey& found) {
    return std::fabs(found.stations[12].true_azimuth->angle.rad - rad_from_deg(56.0));
  };
  EXPECT_GT(off(before), rad_from_deg(0.3));
  EXPECT_LT(off(after), rad_from_deg(0.01));
  EXPECT_GT(after.stations[12].true_azimuth->angle.sigma_rad, rad_from_deg(0.4));  // the declination's at least
  // Upright only: refused, and judged as it was read.
  stations.resize(3);
  const Survey few = run_survey(stations, settings);
  ASSERT_TRUE(few.alignment && !few.alignment->has_value());
  EXPECT_EQ(few.alignment->error().why, NoAlignment::too_few_stations);
  EXPECT_EQ(few.stations.size(), 3U);
  EXPECT_EQ(
      few.stations[0].attitude.inclination->sigma_rad,
      judge_station(stations[0].measured, stations[0].reference, settings.station).attitude.inclination->sigma_rad);
}

TEST(Survey, OfNothingHasNoPath) {
  const Survey s = run_survey({}, {});
  EXPECT_FALSE(s.path.has_value());
  EXPECT_FALSE(s.tests.has_value());
  EXPECT_NE(s.tests_refused.find("there are none"), std::string::npos);
}

TEST(Survey, DepthFollowsTheInclination) {
  std::vector<Measurement> stations;
  for (int k = 0; k < 90; ++k)
    stations.push_back(station_of({rad_from_deg(1.0 * k), 0.0, 0.0}, World{}, 500.0 + 10.0 * k));
  const std::vector<double> depth = depths_m(stations);
  EXPECT_EQ(depth.front(), 500.0);
  EXPECT_NEAR(depth.back() - 500.0, 10.0 / rad_from_deg(1.0) * std::sin(rad_from_deg(89.0)), 0.02);
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out(1);
  for (const char c : line) {
    if (c == ',')
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

TEST(SurveyCsv, HasTheColumnsOfTheTrade) {
  std::vector<ReferencedStation> stations = bent_hole();
  stations[9].measured.field_tesla[0] += 9e-6;
  std::istringstream lines(survey_csv(run_survey(stations, {})));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(cells(line));
  ASSERT_EQ(rows.size(), 21U);
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows.front().size());
  EXPECT_EQ(rows[0][0], "MD_m");
  EXPECT_EQ(rows[1][0], "1000.00");
  EXPECT_EQ(rows[1][1], "0.00");
  EXPECT_EQ(rows[1][2], "");  // vertical: no azimuth
  EXPECT_EQ(rows[1][14], "V");
  EXPECT_EQ(rows[1][13], "accepted");
  EXPECT_EQ(rows[20][1], "85.00");
  EXPECT_EQ(rows[20][2], "60.00");
  EXPECT_EQ(rows[20][3], "56.00");
  EXPECT_EQ(rows[20][4], "");  // no convergence
  EXPECT_EQ(rows[20][8], "50000");
  EXPECT_EQ(rows[20][10], "0.00");
  EXPECT_EQ(rows[20][11], "0");
  EXPECT_EQ(rows[20].back(), "true");
  EXPECT_EQ(rows[10][13], "inclination only");
  EXPECT_EQ(rows[10][3], "");
  EXPECT_EQ(rows[10][19], "");
  EXPECT_GT(std::stod(rows[20][18]), 3.0 * std::stod(rows[20][16]));
}

TEST(SurveyCsv, WritesNorthAsZero) {
  std::vector<ReferencedStation> stations{bent_hole()[19]};
  stations[0].reference.field.declination_rad = rad_from_deg(-60.001);
  EXPECT_NE(survey_csv(run_survey(stations, {})).find(",60.00,0.00,"), std::string::npos);
}

// Verifies: REQ-235
TEST(SurveyWiring, TellsExchangedAxesOfOneTriad) {
  const char* const said[] = {"x and y of one triad", "x and z of one triad", "y and z of one triad"};
  const std::pair<std::size_t, std::size_t> swaps[] = {{0, 1}, {0, 2}, {1, 2}};
  for (std::size_t k = 0; k < 3; ++k) {
    for (const bool of_gravity : {false, true}) {
      std::vector<ReferencedStation> stations = bent_hole();
      for (ReferencedStation& s : stations) {
        Vec3& v = of_gravity ? s.measured.gravity_mps2 : s.measured.field_tesla;
        std::swap(v[swaps[k].first], v[swaps[k].second]);
      }
      const WiringStudy study = study_wiring(stations, iscwsa_tool());
      EXPECT_TRUE(study.swapped);
      EXPECT_NE(study.text().find(said[k]), std::string::npos) << study.text();
      EXPECT_GT(study.rms_as_is_rad, 20.0 * study.rms_best_rad);
    }
  }
}

TEST(SurveyWiring, TellsATurnedSign) {
  std::vector<ReferencedStation> stations = bent_hole();
  for (ReferencedStation& s : stations) s.measured.field_tesla[1] *= -1.0;
  EXPECT_NE(study_wiring(stations, iscwsa_tool()).text().find("x = x, y = -y, z = z"), std::string::npos);
}

// Negative: REQ-235
TEST(SurveyWiring, SaysNothingOfAGoodSurveyNorOfOneThatCannotTell) {
  EXPECT_FALSE(study_wiring(bent_hole(), iscwsa_tool()).swapped);
  EXPECT_EQ(study_wiring(bent_hole(), iscwsa_tool()).text(), "");
  EXPECT_FALSE(study_wiring({}, iscwsa_tool()).swapped);
  std::vector<ReferencedStation> few = bent_hole(4), vertical;
  for (ReferencedStation& s : few) std::swap(s.measured.field_tesla[0], s.measured.field_tesla[1]);
  few.pop_back();
  EXPECT_FALSE(study_wiring(few, iscwsa_tool()).swapped);
  std::vector<ReferencedStation> off = bent_hole();  // another field altogether
  for (ReferencedStation& s : off) s.measured.field_tesla = {30e-6, 1e-6, 5e-6};
  EXPECT_FALSE(study_wiring(off, iscwsa_tool()).swapped);
}

// Verifies: REQ-237
TEST(SurveySaturation, TellsAChannelAtTheEndOfItsRange) {
  std::vector<ReferencedStation> stations = bent_hole();
  for (ReferencedStation& s : stations) s.measured.field_tesla[2] = std::fmin(s.measured.field_tesla[2], 40e-6);
  const Survey s = run_survey(stations, {});
  ASSERT_EQ(s.saturated.size(), 1U);
  EXPECT_EQ(s.saturated[0].component, 5U);
  EXPECT_EQ(s.saturated[0].text().substr(0, 22), "bz reads 40000 nT at 1") << s.saturated[0].text();
  EXPECT_NE(s.saturated[0].text().find("saturated or stuck"), std::string::npos);
}

TEST(SurveySaturation, TellsAChannelThatIsStuck) {
  std::vector<ReferencedStation> stations = bent_hole();
  for (ReferencedStation& s : stations) s.measured.gravity_mps2[0] = -3.25;
  const Survey s = run_survey(stations, {});
  for (const SurveyStation& one : s.stations) EXPECT_EQ(one.status, StationStatus::rejected);
  ASSERT_EQ(s.saturated.size(), 1U);
  EXPECT_NE(s.saturated[0].text().find("gx reads -3.2500 m/s^2 at 20 stations"), std::string::npos);
}

// Negative: REQ-237
TEST(SurveySaturation, AccusesNoReadingThatIsEqualByRoundingOrOfAGoodStation) {
  std::vector<ReferencedStation> stations = bent_hole();
  for (ReferencedStation& s : stations) s.measured.field_tesla[2] = 1e-7 * std::round(s.measured.field_tesla[2] / 1e-7);
  EXPECT_TRUE(run_survey(stations, {}).saturated.empty());  // three vertical ones read the same
  stations[4].measured.field_tesla = scaled(stations[4].measured.field_tesla, 1.5);
  EXPECT_TRUE(run_survey(stations, {}).saturated.empty());  // one that fails is no range
}

io::CsvColumns table(std::vector<std::string> names, const std::vector<std::vector<double>>& rows) {
  io::CsvColumns out;
  out.names = std::move(names);
  out.values.resize(out.names.size());
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) out.values[k].push_back(row[k]);
  }
  return out;
}

TEST(StationFile, ReadsUnitsFromTheHeader) {
  const auto file =
      stations_of(table({"shot", "md_ft", "gx_g", "gy_g", "gz_g", "mx_uT", "my_uT", "mz_uT"},
                        {{0, 1000, 0.6, 0.0, 0.8, 10, 20, 40}, {1, 1100, 0.0, 0.0, std::nan(""), 10, 20, 40}}),
                  "x.csv");
  ASSERT_TRUE(file.has_value()) << file.error().text();
  ASSERT_EQ(file->stations.size(), 1U);
  EXPECT_EQ(file->rows_left_out, 1U);
  EXPECT_DOUBLE_EQ(file->stations[0].md_m, 304.8);
  EXPECT_DOUBLE_EQ(file->stations[0].gravity_mps2[0], 0.6 * kG0_mps2);
  EXPECT_DOUBLE_EQ(file->stations[0].field_tesla[2], 40e-6);
  EXPECT_FALSE(file->specific_force);
  const auto force = stations_of(table({"md_m", "ax_mps2", "ay_mps2", "az_mps2", "bx_nT", "by_nT", "bz_nT"},
                                       {{1, 0.0, 0.0, -9.81, 10000, 20000, 40000}}),
                                 "x.csv");
  ASSERT_TRUE(force.has_value());
  EXPECT_TRUE(force->specific_force);
  EXPECT_DOUBLE_EQ(force->stations[0].gravity_mps2[2], 9.81);
}

void expect_refused(const io::CsvColumns& columns, const char* what, const char* remedy) {
  const auto file = stations_of(columns, "x.csv");
  ASSERT_FALSE(file.has_value()) << what;
  EXPECT_NE(file.error().what.find(what), std::string::npos) << file.error().text();
  EXPECT_NE(file.error().remedy.find(remedy), std::string::npos) << file.error().text();
}

// Verifies: REQ-235
TEST(StationFile, RefusesUnitsThatCannotBe) {
  const std::vector<double> row{100, 0.6, 0.0, 0.8, 10, 20, 40};
  expect_refused(table({"md_m", "gx_g", "gy_g", "gz_g", "bx_G", "by_G", "bz_G"}, {row}), "a field of 4583 uT",
                 "right in uT: end the columns' names in _uT");
  expect_refused(table({"md_m", "gx_g", "gy_g", "gz_g", "bx_T", "by_T", "bz_T"}, {row}), "a field of", "right in uT");
  expect_refused(table({"md_m", "gx_mps2", "gy_mps2", "gz_mps2", "bx_uT", "by_uT", "bz_uT"}, {row}),
                 "a gravity of 1 m/s^2", "right in g:");
  expect_refused(table({"md_m", "gx_mg", "gy_mg", "gz_mg", "bx_uT", "by_uT", "bz_uT"}, {row}), "a gravity of",
                 "right in g:");
  expect_refused(table({"md_m", "gx_g", "gy_g", "gz_g", "bx_uT", "by_uT", "bz_uT"}, {{100, 0.6, 0.0, 0.8, 0, 0, 0}}),
                 "a field of 0 uT", "check the unit");
}

TEST(StationFile, RefusesWhatIsNoSurvey) {
  const std::vector<double> row{100, 0.6, 0.0, 0.8, 10, 20, 40};
  expect_refused(table({"depth", "gx_g", "gy_g", "gz_g", "bx_uT", "by_uT", "bz_uT"}, {row}), "no measured depth",
                 "md_m");
  expect_refused(table({"md_m", "gx_g", "gy_g", "gz_mg", "bx_uT", "by_uT", "bz_uT"}, {row}),
                 "no three accelerometers in one unit", "gx_mps2");
  expect_refused(table({"md_m", "gx_g", "gy_g", "gz_g", "bx_ut", "by_uT", "bz_uT"}, {row}), "no three magnetometers",
                 "bx_nT");
  expect_refused(table({"md_m", "gx_g", "gy_g", "gz_g", "bx_uT", "by_uT", "bz_uT", "mx_uT", "my_uT", "mz_uT"},
                       {{100, 0.6, 0.0, 0.8, 1, 2, 3, 1, 2, 3}}),
                 "magnetometers twice", "keep the columns of one");
  expect_refused(table({"md_m", "md_ft", "gx_g", "gy_g", "gz_g", "bx_uT", "by_uT", "bz_uT"}, {}),
                 "measured depth twice", "keep one");
  expect_refused(table({"md_m", "gx_g", "gy_g", "gz_g", "bx_uT", "by_uT", "bz_uT"}, {}), "no row", "one row a station");
}

RC_GTEST_PROP(StationFileLaw, AnyNumbersAreASurveyOrAnError, ()) {
  const double values[] = {0.0,
                           1.0,
                           -1.0,
                           9.81,
                           -9.81,
                           4e4,
                           -4e4,
                           1e-300,
                           1e300,
                           -1e308,
                           std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()};
  const int rows = *rc::gen::inRange(1, 8);
  std::vector<std::vector<double>> cells_of_rows;
  for (int k = 0; k < rows; ++k) {
    std::vector<double> row{30.0 * k, 0.0, 0.0, 9.81, 15e3, 0.0, 48e3};
    const int odd = *rc::gen::inRange(0, 4);
    for (int n = 0; n < odd; ++n)
      row[static_cast<std::size_t>(*rc::gen::inRange(0, 7))] =
          values[*rc::gen::inRange(0, static_cast<int>(std::size(values)))];
    cells_of_rows.push_back(row);
  }
  const auto file =
      stations_of(table({"md_m", "gx_mps2", "gy_mps2", "gz_mps2", "bx_nT", "by_nT", "bz_nT"}, cells_of_rows), "x.csv");
  if (!file) {
    RC_ASSERT(!file.error().what.empty() && !file.error().remedy.empty());
    return;
  }
  std::vector<ReferencedStation> stations;
  for (Measurement m : file->stations) {
    m.random = independent_covariance(1e-3, 20e-9);
    stations.push_back({m, reference_of(World{})});
  }
  SurveySettings settings;
  settings.correct_axial = *rc::gen::arbitrary<bool>();
  if (*rc::gen::arbitrary<bool>()) settings.align_within_rad = rad_from_deg(0.5);
  const Survey s = run_survey(stations, settings);
  RC_ASSERT(s.stations.size() == stations.size());
  for (const SurveyStation& one : s.stations) {
    if (one.status == StationStatus::accepted) RC_ASSERT(one.checks.gravity.passed && one.checks.field_passed());
    if (one.true_azimuth) RC_ASSERT(std::isfinite(one.true_azimuth->angle.rad + one.true_azimuth->angle.sigma_rad));
  }
  std::istringstream lines(survey_csv(s));
  for (std::string line; std::getline(lines, line);) RC_ASSERT(cells(line).size() == 27U);
}

}  // namespace
}  // namespace survey_run_test
