// Go or no-go at a survey station: only a bounded, checked vector of this station is a go.
#include "navigation/survey_station.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "navigation/body.hpp"
#include "verdicts.hpp"

namespace survey_test {
namespace {

using example_test::good;
using plumb::Usable;
using plumb::Validity;

TEST(SurveyStation, goWithTheAnglesOfTheVector) {
  plumb::Verdict v = good();
  v.gravity_mps2 = {-3.0, 0.0, 9.3};  // high side: gravity along -x
  const SurveyStation station = survey(v, 10.0);
  EXPECT_EQ(station.go, Go::go);
  EXPECT_NEAR(station.tilt.inclination_rad, std::atan2(3.0, 9.3), 1e-12);
  EXPECT_NEAR(station.tilt.toolface_rad, std::atan2(3.0, 0.0), 1e-12);
  EXPECT_EQ(station.protection_level_housing_rad, 1e-3);
}

TEST(SurveyStation, whileThePumpsRunThereIsNoStation) {
  EXPECT_EQ(survey(good(), -1.0).go, Go::wait);
  EXPECT_STREQ(survey(good(), -1.0).reason, "pumps are on");
}

TEST(SurveyStation, aVectorFromBeforeThePumpsStoppedIsNotThisStations) {
  plumb::Verdict v = good();
  v.age_s = 3.0;  // taken at 9.25 s
  EXPECT_EQ(survey(v, 10.0).go, Go::wait);
  v.age_s = 2.0;
  EXPECT_EQ(survey(v, 10.0).go, Go::go);
  v.age_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(survey(v, 10.0).go, Go::wait);
}

TEST(SurveyStation, everythingThatIsMissingIsAReasonOfItsOwn) {
  const auto reason_without = [](std::uint16_t bit) {
    plumb::Verdict v = good();
    v.usable = static_cast<std::uint16_t>(v.usable & ~bit);
    const SurveyStation station = survey(v, 10.0);
    EXPECT_NE(station.go, Go::go) << bit;
    return std::string(station.reason);
  };
  EXPECT_EQ(reason_without(Usable::stationary), "not still yet");
  EXPECT_EQ(reason_without(Usable::temperature), "temperature outside the calibration");
  EXPECT_EQ(reason_without(Usable::reference), "length of gravity is in doubt");
  EXPECT_EQ(reason_without(Usable::monitored), "nothing checks them");
  EXPECT_EQ(reason_without(Usable::protection_level), "tilt is not bounded well enough");
}

TEST(SurveyStation, onlyValidIsAGo) {
  for (const Validity validity : example_test::kAllValidities) {
    plumb::Verdict v = good();
    v.validity = validity;
    EXPECT_EQ(survey(v, 10.0).go == Go::go, validity == Validity::valid) << plumb::to_string(validity);
  }
  plumb::Verdict v = good();
  v.alert = true;
  EXPECT_EQ(survey(v, 10.0).go, Go::no_go);
  v = good();
  v.gravity_mps2[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(survey(v, 10.0).go, Go::no_go);
  v = good();
  v.state = plumb::HealthState::failed;
  EXPECT_EQ(survey(v, 10.0).go, Go::no_go);
}

TEST(SurveyStation, throughAFailureEveryGoIsTrueToItsBound) {
  Body body(30.0, 0.0);
  int gos = 0, late_gos = 0;
  for (const plumb::Verdict& v : example_test::run()) {
    body.next();
    const SurveyStation station = survey(v, 0.0);
    if (station.go != Go::go) continue;
    ++gos;
    late_gos += v.time_s > 30.1;
    if (!v.tick) continue;  // else the body has turned since
    const Eigen::Vector3d& g = body.gravity_mps2();
    const double inclination_rad = std::atan2(std::hypot(g[0], g[1]), g[2]);
    EXPECT_LT(std::abs(station.tilt.inclination_rad - inclination_rad), station.protection_level_housing_rad)
        << v.time_s;
  }
  EXPECT_GT(gos, 1000);
  EXPECT_EQ(late_gos, 0);  // three sensors are left: nothing checks them
}

}  // namespace
}  // namespace survey_test
