// Each fault of a magnetometer, as docs/fault-catalogue.md lists them: what of a survey sees it, and what does not.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "plumb/survey/survey_run.hpp"
#include "simulated_survey.hpp"

namespace magnetometer_faults_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;

constexpr std::size_t kStations = 24;

/// From vertical to 85 degrees on 60 degrees, the tool turned at every station; the fault changes what the field reads.
Survey surveyed(const std::function<void(std::size_t station, Vec3& field_tesla)>& fault, bool axial = false) {
  std::vector<ReferencedStation> stations;
  for (std::size_t k = 0; k < kStations; ++k) {
    const double n = static_cast<double>(k);
    Measurement m =
        station_of({rad_from_deg(85.0 * n / 23.0), rad_from_deg(60.0), 1.7 * n}, World{}, 1000.0 + 30.0 * n);
    fault(k, m.field_tesla);
    m.random = independent_covariance(1e-3, 20e-9);
    stations.push_back({m, reference_of(World{})});
  }
  SurveySettings settings;
  settings.correct_axial = axial;
  return run_survey(stations, settings);
}

int not_accepted(const Survey& s, std::size_t from = 0, std::size_t to = kStations) {
  int out = 0;
  for (std::size_t k = from; k < to; ++k) out += s.stations[k].status == StationStatus::accepted ? 0 : 1;
  return out;
}

void expect_inclinations(const Survey& s) {
  for (const SurveyStation& one : s.stations) EXPECT_TRUE(one.attitude.inclination.has_value());
}

Vec3 turned(const Vec3& v, std::size_t about, double deg) {
  const double c = std::cos(rad_from_deg(deg)), s = std::sin(rad_from_deg(deg));
  const std::size_t i = (about + 1) % 3, j = (about + 2) % 3;
  Vec3 out = v;
  out[i] = c * v[i] - s * v[j];
  out[j] = s * v[i] + c * v[j];
  return out;
}

TEST(MagnetometerFaults, AxialInterferenceIsFoundFromAllStations) {
  const auto fault = [](std::size_t, Vec3& b) { b[2] += 600e-9; };
  const Survey plain = surveyed(fault);  // no gross error: the tool states 220 nT of it, 1 sigma
  EXPECT_TRUE(plain.tests->field.passed() && plain.tests->dip.passed());
  const Survey s = surveyed(fault, true);
  ASSERT_TRUE(s.axial && s.axial->has_value());
  EXPECT_NEAR((*s.axial)->value[8], 600e-9, 100e-9);
  EXPECT_EQ(not_accepted(s), 0);
  const auto off_deg = [](const Survey& of) {
    return std::fabs(deg_from_rad(of.stations.back().attitude.azimuth->angle.rad) - 60.0);
  };
  ASSERT_EQ(not_accepted(plain), 0);
  EXPECT_GT(off_deg(plain), 1.5);
  EXPECT_LT(off_deg(s), 0.5);
}

TEST(MagnetometerFaults, CrossAxialBiasFailsTheTestOfTheField) {
  const Survey s = surveyed([](std::size_t, Vec3& b) { b[0] += 900e-9; });
  EXPECT_FALSE(s.tests->field.passed());
  EXPECT_GT(not_accepted(s), 0);
  expect_inclinations(s);
}

TEST(MagnetometerFaults, AHotSpotTakesTheAzimuthOfItsStation) {
  const Survey s = surveyed([](std::size_t k, Vec3& b) { b[1] += k == 14 ? 3e-6 : 0.0; });
  EXPECT_EQ(s.stations[14].status, StationStatus::inclination_only);
  EXPECT_EQ(not_accepted(s), 1);
  EXPECT_TRUE(s.tests->field.worst == 14 || s.tests->dip.worst == 14);
  expect_inclinations(s);
}

TEST(MagnetometerFaults, AStuckChannelIsNamed) {
  const Survey s = surveyed([](std::size_t, Vec3& b) { b[0] = 12e-6; });
  EXPECT_GT(not_accepted(s), 12);
  ASSERT_EQ(s.saturated.size(), 0U);  // some stations pass by chance, and none of those is accused
  const Survey far = surveyed([](std::size_t, Vec3& b) { b[0] = 60e-6; });
  ASSERT_EQ(far.saturated.size(), 1U);
  EXPECT_EQ(far.saturated[0].component, 3U);
}

TEST(MagnetometerFaults, ASaturatedChannelIsNamed) {
  const Survey s = surveyed([](std::size_t, Vec3& b) { b[2] = std::fmin(b[2], 40e-6); });
  EXPECT_GT(not_accepted(s), 3);
  ASSERT_EQ(s.saturated.size(), 1U);
  EXPECT_EQ(s.saturated[0].component, 5U);
}

TEST(MagnetometerFaults, ABiasThatShiftsAfterAShockShowsFromThereOn) {
  const Survey s = surveyed([](std::size_t k, Vec3& b) { b[0] += k >= 12 ? 1500e-9 : 0.0; });
  EXPECT_EQ(not_accepted(s, 0, 12), 0);
  EXPECT_GT(not_accepted(s, 12), 6);
  EXPECT_FALSE(s.tests->field.passed());
}

TEST(MagnetometerFaults, ATurnedTriadFailsTheTestOfTheDip) {
  for (std::size_t about = 0; about < 2; ++about) {
    const Survey s = surveyed([about](std::size_t, Vec3& b) { b = turned(b, about, 2.0); });
    EXPECT_TRUE(s.tests->field.passed());
    EXPECT_FALSE(s.tests->dip.passed()) << about;
  }
}

TEST(MagnetometerFaults, ATriadTurnedByLessThanItsLimitsIsNotSeen) {
  const Survey s = surveyed([](std::size_t, Vec3& b) { b = turned(b, 0, 0.1); });
  EXPECT_EQ(not_accepted(s), 0);
  EXPECT_TRUE(s.tests->dip.passed());
}

}  // namespace
}  // namespace magnetometer_faults_test
