// The counterpart of Fig 11 of the paper, in numbers.
#include "plumb/study/gravity_error_study.hpp"

#include <algorithm>
#include <cmath>

#include "study_test_support.hpp"

namespace gravity_error_study_test {
namespace {

using namespace study_test;
using namespace plumb::study;

TEST(GravityErrorStudy, CalibrationLeavesTheNoiseAtAttitudesItHasNotSeen) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Bench bench = bench_of(seed);
    const auto study = gravity_error_study(bench.fits, bench.tool, seed);
    ASSERT_TRUE(study.has_value()) << study.error();
    ASSERT_EQ(study->combination.size(), 5U);
    for (const GravityErrors& e : study->combination) {
      ASSERT_EQ(e.paper_mps2.size(), static_cast<std::size_t>(kValidationAttitudes));
      EXPECT_GT(rms_of(e.datasheet_mps2), 2e-3 * plumb::kG0_mps2) << name_of(e.used);
      // One sample: noise of 2e-4 g0 a sensor, times the norm of the row of the map (at most 1.7 for a triple).
      EXPECT_LT(rms_of(e.paper_mps2), 4e-4 * plumb::kG0_mps2) << name_of(e.used);
      EXPECT_LT(rms_of(e.own_mps2), 4e-4 * plumb::kG0_mps2) << name_of(e.used);
    }
  }
}

TEST(GravityErrorStudy, ValidatesOnFreshAttitudes) {
  const auto tool = plumb::scenario::paper_tool(5);
  const auto fitted = record(plumb::scenario::calibration_run(tool, 5));
  const auto fresh = record(survey_run(tool, 5, Part::validation, kValidationAttitudes, 1));
  ASSERT_TRUE(fitted && fresh);
  ASSERT_EQ(fresh->attitude.size(), static_cast<std::size_t>(kValidationAttitudes));
  ASSERT_FALSE(fitted->attitude.empty());
  // Other attitudes, and not other noise: some channel differs by ten sigmas at least.
  const double sigma_raw = 2e-4 * plumb::kG0_mps2 * std::fabs(tool.datasheet.sensor[0].coefficients.scale[0]);
  for (const auto& a : fresh->attitude) {
    ASSERT_EQ(a.size(), 1U);
    for (const auto& b : fitted->attitude) {
      double most = 0.0;
      for (std::size_t i = 0; i < 4; ++i) most = std::max(most, std::fabs(a.front().raw[i] - b.front().raw[i]));
      EXPECT_GT(most, 10.0 * sigma_raw);
    }
  }
}

TEST(Survey, StationsAreTheMeansOfTheirSamples) {
  const auto tool = plumb::scenario::paper_tool(5);
  const auto survey = record(survey_run(tool, 5, Part::faults, 7, 32));
  ASSERT_TRUE(survey.has_value());
  ASSERT_EQ(survey->attitude.size(), 7U);
  const auto stations = stations_of(*survey);
  for (std::size_t k = 0; k < stations.size(); ++k) {
    ASSERT_EQ(survey->attitude[k].size(), 32U);
    EXPECT_EQ(stations[k].count, 32U);
    EXPECT_EQ(stations[k].tag, k + 1);
    double sum = 0.0;
    for (const plumb::Sample& s : survey->attitude[k]) sum += s.raw[2];
    EXPECT_NEAR(stations[k].mean[2], sum / 32.0, 1e-12);
    EXPECT_NEAR(stations[k].temperature_degc, 25.0, 1e-9);
  }
}

}  // namespace
}  // namespace gravity_error_study_test
