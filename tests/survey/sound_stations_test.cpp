// Estimates from many stations use none that fails: which are left out, and when none is.
#include <gtest/gtest.h>

#include <vector>

#include "plumb/survey/survey_run.hpp"
#include "simulated_survey.hpp"

namespace sound_stations_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;

/// Two stations that no interference explains, in a tool with one that fails checks by itself.
std::vector<ReferencedStation> interfered(double interference_tesla) {
  std::vector<ReferencedStation> stations = bent_hole();
  for (ReferencedStation& s : stations) s.measured.field_tesla[2] += interference_tesla;
  stations[9].measured.field_tesla[0] += 9e-6;
  stations[12].measured.gravity_mps2 = scaled(stations[12].measured.gravity_mps2, 1.01);
  return stations;
}

// Verifies: REQ-236
TEST(SoundStations, EstimatesInterferenceWithoutTheStationsThatFail) {
  for (const double interference : {500e-9, 3000e-9}) {
    SurveySettings settings;
    const Survey plain = run_survey(interfered(interference), settings);
    settings.correct_axial = true;
    const Survey found = run_survey(interfered(interference), settings);
    ASSERT_TRUE(found.axial && found.axial->has_value()) << found.axial->error().text();
    EXPECT_NEAR((*found.axial)->value[8], interference, 60e-9);
    EXPECT_EQ(found.left_out, (std::vector<std::size_t>{9, 12}));
    EXPECT_TRUE(plain.left_out.empty());
    // What interference alone spoils is used, and accepted once it is taken off.
    for (std::size_t k = 0; k < found.stations.size(); ++k)
      EXPECT_EQ(found.stations[k].status == StationStatus::accepted, k != 9 && k != 12) << k;
  }
}

// Negative: REQ-236
TEST(SoundStations, LeavesNothingOutWhereMostStationsFail) {
  std::vector<ReferencedStation> stations = bent_hole();
  for (std::size_t k = 0; k < stations.size(); ++k) {
    if (k % 3 != 0)
      stations[k].measured.field_tesla[0] += (k % 2 == 0 ? 4e-6 : -6e-6) * (1.0 + 0.1 * static_cast<double>(k));
  }
  SurveySettings settings;
  settings.correct_axial = true;
  const Survey found = run_survey(stations, settings);
  ASSERT_TRUE(found.axial && !found.axial->has_value());
  EXPECT_EQ(found.axial->error().why, NoEstimate::misfit);
  EXPECT_TRUE(found.left_out.empty());
}

// Verifies: REQ-236
TEST(SoundStations, AlignsWithoutTheStationsThatFail) {
  std::vector<ReferencedStation> stations = interfered(0.0);
  SurveySettings settings;
  settings.align_within_rad = rad_from_deg(0.5);
  const Survey found = run_survey(stations, settings);
  ASSERT_TRUE(found.alignment && found.alignment->has_value()) << found.alignment->error().text();
  EXPECT_EQ(found.left_out, (std::vector<std::size_t>{9, 12}));
  EXPECT_LT(norm((*found.alignment)->turn_rad), 1e-4);
  EXPECT_NE((*found.alignment)->held_out.worst, 9);
  EXPECT_EQ(found.position_covariance.size(), found.path->size());
}

}  // namespace
}  // namespace sound_stations_test
