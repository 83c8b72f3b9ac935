// Errors of a tool found from many stations, and refused where the stations cannot tell.
#include "plumb/survey/multi_station.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <random>

#include "plumb/survey/error_tests.hpp"
#include "simulated_survey.hpp"

namespace multi_station_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;

constexpr double kNoiseG_mps2 = 1e-3, kNoiseB_tesla = 20e-9;

/// Readings with errors of the tool, noise, and a field that is not the reference's.
struct ToolRun {
  TermValues errors{};
  World world;
  bool noisy = true;
  unsigned seed = 1;

  std::vector<ReferencedStation> of(const std::vector<Truth>& hole, const World& stated = World{}) const {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::vector<ReferencedStation> out;
    for (std::size_t i = 0; i < hole.size(); ++i) {
      Measurement m = station_of(hole[i], world, 30.0 * static_cast<double>(i));
      for (std::size_t k = 0; k < 3; ++k) {
        m.gravity_mps2[k] = (1.0 + errors[3 + k]) * m.gravity_mps2[k] + errors[k];
        m.field_tesla[k] = (1.0 + errors[9 + k]) * m.field_tesla[k] + errors[6 + k];
        if (noisy) m.gravity_mps2[k] += kNoiseG_mps2 * normal(generator);
        if (noisy) m.field_tesla[k] += kNoiseB_tesla * normal(generator);
      }
      m.random = independent_covariance(kNoiseG_mps2, kNoiseB_tesla);
      out.push_back({m, reference_of(stated)});
    }
    return out;
  }
};

/// From vertical to horizontal on one azimuth, the tool turned at every station.
std::vector<Truth> build_up(double azimuth_deg, int stations, double from_deg = 2.0, double to_deg = 90.0) {
  std::vector<Truth> out;
  for (int k = 0; k < stations; ++k)
    out.push_back({rad_from_deg(from_deg + (to_deg - from_deg) * k / (stations - 1)), rad_from_deg(azimuth_deg),
                   rad_from_deg(77.0 * k)});
  return out;
}

std::size_t at(Term term) { return static_cast<std::size_t>(term); }

TEST(MultiStation, FindsTheInterferenceOfTheDrillString) {
  for (const double azimuth_deg : {0.0, 45.0, 90.0, 135.0}) {
    ToolRun run;
    run.errors[at(Term::magnetometer_bias_z)] = 600e-9;
    const auto found = estimate_axial_interference(run.of(build_up(azimuth_deg, 25)), iscwsa_tool());
    ASSERT_TRUE(found.has_value()) << azimuth_deg << ": " << found.error().text();
    const double sigma = found->sigma[at(Term::magnetometer_bias_z)];
    EXPECT_NEAR(found->value[at(Term::magnetometer_bias_z)], 600e-9, 4.0 * sigma);
    EXPECT_LT(sigma, 120e-9) << azimuth_deg;
    EXPECT_GT(found->chance, 1e-3);
    std::cout << "[ measured ] azimuth " << azimuth_deg << ": sigma " << sigma * 1e9
              << " nT, correlation with a reference " << found->largest_reference_correlation << "\n";
  }
}

// Negative: REQ-236
TEST(MultiStation, DoesNotTakeAnErrorOfTheReferenceForInterference) {
  // The field is 3 sigma from the reference, in length and in dip: the estimate stays within its own sigma of nothing.
  ToolRun run;
  run.world.field_tesla += 390e-9;
  run.world.dip_rad += rad_from_deg(0.6);
  const auto found = estimate_axial_interference(run.of(build_up(90.0, 25)), iscwsa_tool());
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_NEAR(found->value[at(Term::magnetometer_bias_z)], 0.0, 3.0 * found->sigma[at(Term::magnetometer_bias_z)]);
  EXPECT_GT(found->field_offset_tesla, 200e-9);
}

// Negative: REQ-236
TEST(MultiStation, RefusesInterferenceWhereTheHoleDoesNotTurn) {
  // A tangent: one inclination, one azimuth, however many stations and toolfaces.
  ToolRun run;
  run.errors[at(Term::magnetometer_bias_z)] = 600e-9;
  const auto found = estimate_axial_interference(run.of(build_up(90.0, 60, 60.0, 60.0)), iscwsa_tool());
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().why, NoEstimate::not_observable);
  EXPECT_NEAR(std::fabs(found.error().direction[at(Term::magnetometer_bias_z)]), 1.0, 1e-9);
  EXPECT_NE(found.error().text().find("do not tell magnetometer bias z from an error of the reference"),
            std::string::npos);
}

std::vector<Truth> scattered(int stations) {
  std::vector<Truth> out;
  for (int k = 0; k < stations; ++k)
    out.push_back({std::acos(1.0 - 2.0 * (k + 0.5) / stations), 2.399963 * k, 1.1 * k + 0.3 * k * k});
  return out;
}

TEST(MultiStation, FindsSixBiasesAtScatteredAttitudes) {
  ToolRun run;
  run.errors = {0.006, -0.004, 0.005, 0.0, 0.0, 0.0, 90e-9, -120e-9, 300e-9, 0.0, 0.0, 0.0};
  MultiStationSettings settings;
  settings.terms = {Term::accelerometer_bias_x, Term::accelerometer_bias_y, Term::accelerometer_bias_z,
                    Term::magnetometer_bias_x,  Term::magnetometer_bias_y,  Term::magnetometer_bias_z};
  const auto found = estimate_terms(run.of(scattered(40)), settings);
  ASSERT_TRUE(found.has_value()) << found.error().text();
  EXPECT_LT(found->largest_correlation, 0.4);
  for (const Term term : settings.terms) {
    EXPECT_NEAR(found->value[at(term)], run.errors[at(term)], 4.0 * found->sigma[at(term)]) << to_string(term);
    EXPECT_LT(found->sigma[at(term)], 0.2 * sigma_of(term, settings.tool)) << to_string(term);
  }
}

// Verifies: REQ-236
TEST(MultiStation, ErrorsAreAsLargeAsStated) {
  // 300 tools with errors drawn as stated, references too: squares of value over sigma, within four sigma of counting.
  constexpr int kTools = 300;
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  const std::vector<Truth> hole = build_up(40.0, 20);
  double squares = 0.0, chi = 0.0;
  int freedom = 0;
  for (int k = 0; k < kTools; ++k) {
    ToolRun run;
    run.seed = static_cast<unsigned>(k + 1);
    for (std::size_t t = 0; t < kTermCount; ++t)
      run.errors[t] = sigma_of(static_cast<Term>(t), iscwsa_tool()) * normal(generator);
    run.errors[at(Term::magnetometer_bias_z)] = 700e-9 * normal(generator);  // no prior: as large as it likes
    run.world.g_mps2 += 1.5e-3 * normal(generator);
    run.world.field_tesla += 130e-9 * normal(generator);
    run.world.dip_rad += rad_from_deg(0.2) * normal(generator);
    const auto found = estimate_axial_interference(run.of(hole), iscwsa_tool());
    ASSERT_TRUE(found.has_value()) << found.error().text();
    const double off = (found->value[8] - run.errors[8]) / found->sigma[8];
    squares += off * off;
    chi += found->chi_square;
    freedom += found->freedom;
  }
  EXPECT_NEAR(squares / kTools, 1.0, 4.0 * std::sqrt(2.0 / kTools));
  EXPECT_NEAR(chi / freedom, 1.0, 4.0 * std::sqrt(2.0 / freedom) + 0.01);
}

TEST(MultiStation, RefusesTermsThatCorrelate) {
  // A slow build keeps bias and scale of one axis together.
  ToolRun run;
  MultiStationSettings settings;
  settings.terms = {Term::magnetometer_bias_z, Term::magnetometer_scale_z};
  const auto found = estimate_terms(run.of(build_up(20.0, 40, 10.0, 60.0)), settings);
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().why, NoEstimate::correlated) << found.error().text();
  EXPECT_GT(found.error().value, 0.4);
  EXPECT_NE(found.error().text().find("magnetometer bias z and magnetometer scale z correlate by"), std::string::npos);
}

TEST(MultiStation, RefusesByTheCorrelationThatIsAllowed) {
  ToolRun run;
  MultiStationSettings settings;
  settings.terms = {Term::magnetometer_bias_x, Term::magnetometer_bias_z};
  settings.max_correlation = 0.0;
  const auto found = estimate_terms(run.of(scattered(40)), settings);
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().why, NoEstimate::correlated);
  EXPECT_EQ(found.error().first, Term::magnetometer_bias_x);
  EXPECT_EQ(found.error().second, Term::magnetometer_bias_z);
  EXPECT_GT(found.error().value, 0.0);
}

TEST(MultiStation, AllScalesTogetherAreTheReference) {
  ToolRun run;
  MultiStationSettings settings;
  settings.terms = {Term::magnetometer_scale_x, Term::magnetometer_scale_y, Term::magnetometer_scale_z};
  const auto found = estimate_terms(run.of(scattered(60)), settings);
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().why, NoEstimate::not_observable);
  for (const Term term : settings.terms)
    EXPECT_NEAR(std::fabs(found.error().direction[at(term)]), std::sqrt(1.0 / 3.0), 1e-3);
}

TEST(MultiStation, RefusesDataWithAnotherError) {
  ToolRun run;
  std::vector<ReferencedStation> stations = run.of(build_up(60.0, 25));
  stations[11].measured.field_tesla[0] += 5e-6;
  const auto found = estimate_axial_interference(stations, iscwsa_tool());
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().why, NoEstimate::misfit);
  const auto tests = error_tests(stations, {});
  ASSERT_TRUE(tests.has_value());
  EXPECT_FALSE(tests->field.one_passed());
  EXPECT_EQ(tests->field.worst, 11);
  EXPECT_TRUE(tests->gravity.passed());
}

TEST(MultiStation, SaysWhatIsMissing) {
  ToolRun run;
  const std::vector<ReferencedStation> good = run.of(build_up(60.0, 25));
  MultiStationSettings settings;
  EXPECT_EQ(estimate_terms(good, settings).error().why, NoEstimate::nothing_asked);
  settings.terms = {Term::magnetometer_bias_z, Term::magnetometer_bias_z};
  EXPECT_EQ(estimate_terms(good, settings).error().why, NoEstimate::nothing_asked);
  EXPECT_EQ(estimate_axial_interference({}, iscwsa_tool()).error().why, NoEstimate::too_few_stations);
  EXPECT_EQ(estimate_axial_interference({good[0], good[1], good[2]}, iscwsa_tool()).error().why,
            NoEstimate::too_few_stations);
  std::vector<ReferencedStation> broken = good;
  broken[3].measured.field_tesla[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(estimate_axial_interference(broken, iscwsa_tool()).error().why, NoEstimate::not_finite);
  EXPECT_EQ(estimate_axial_interference(broken, iscwsa_tool()).error().value, 3.0);
  broken = good;
  broken[4].measured.random = {};
  EXPECT_EQ(estimate_axial_interference(broken, iscwsa_tool()).error().why, NoEstimate::no_random_error);
  for (const NoEstimate why :
       {NoEstimate::nothing_asked, NoEstimate::too_few_stations, NoEstimate::not_finite, NoEstimate::no_random_error,
        NoEstimate::not_converged, NoEstimate::not_observable, NoEstimate::correlated, NoEstimate::misfit}) {
    EstimateRefusal refusal;
    refusal.why = why;
    EXPECT_GT(refusal.text().size(), 20U);
  }
}

TEST(MultiStation, CorrectionTakesTheErrorOffTheAzimuth) {
  // Horizontal to the east: 600 nT along the tool are 2.2 degrees of azimuth.
  ToolRun run;
  run.errors[at(Term::magnetometer_bias_z)] = 600e-9;
  const std::vector<ReferencedStation> stations = run.of(build_up(90.0, 25));
  const auto found = estimate_axial_interference(stations, iscwsa_tool());
  ASSERT_TRUE(found.has_value());
  const ReferencedStation& last = stations.back();
  const CorrectedStation better = corrected(last.measured, *found);
  const Attitude before = attitude_of(last.measured, total_covariance(last.measured, iscwsa_tool()));
  const SurveyStation after = judge_corrected(better, last.reference, {});
  ASSERT_TRUE(before.azimuth && after.attitude.azimuth);
  EXPECT_GT(std::fabs(deg_from_rad(before.azimuth->angle.rad) - 90.0), 1.5);
  EXPECT_NEAR(after.attitude.azimuth->angle.rad, 0.5 * kPi, 4.0 * after.attitude.azimuth->angle.sigma_rad);
  EXPECT_LT(after.attitude.azimuth->angle.sigma_rad, before.azimuth->angle.sigma_rad);
  EXPECT_EQ(after.status, StationStatus::accepted);
  EXPECT_EQ(after.measured.random, last.measured.random);
}

// Verifies: REQ-236
RC_GTEST_PROP(MultiStationLaw, WithoutNoiseTheErrorsComeBack, ()) {
  ToolRun run;
  run.noisy = false;
  const auto part = [](double most) { return *rc::gen::inRange(-1000, 1001) / 1000.0 * most; };
  for (std::size_t k = 0; k < 3; ++k) {
    run.errors[k] = part(0.02);
    run.errors[6 + k] = part(2e-6);
  }
  MultiStationSettings settings;
  settings.terms = {Term::accelerometer_bias_x, Term::accelerometer_bias_y, Term::accelerometer_bias_z,
                    Term::magnetometer_bias_x,  Term::magnetometer_bias_y,  Term::magnetometer_bias_z};
  const auto found = estimate_terms(run.of(scattered(*rc::gen::inRange(20, 60))), settings);
  RC_ASSERT(found.has_value());
  for (const Term term : settings.terms)
    RC_ASSERT(std::fabs(found->value[at(term)] - run.errors[at(term)]) < 1e-6 * sigma_of(term, settings.tool));
  RC_ASSERT(found->chi_square < 1e-9);
}

TEST(ErrorTests, FalseAlarmsAreAsRareAsStated) {
  constexpr int kWells = 1000;
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal;
  ErrorTestSettings settings;
  settings.false_alarm = 0.05;
  const std::vector<Truth> hole = build_up(70.0, 12);
  int one = 0, all = 0, mean = 0;
  for (int k = 0; k < kWells; ++k) {
    ToolRun run;
    run.seed = static_cast<unsigned>(1000 + k);
    for (std::size_t t = 0; t < kTermCount; ++t)
      run.errors[t] = sigma_of(static_cast<Term>(t), settings.tool) * normal(generator);
    run.world.field_tesla += 130e-9 * normal(generator);
    const auto tests = error_tests(run.of(hole), settings);
    ASSERT_TRUE(tests.has_value());
    one += tests->field.one_passed() ? 0 : 1;
    all += tests->field.all_passed() ? 0 : 1;
    mean += tests->field.mean_passed() ? 0 : 1;
  }
  const double allowed = 4.0 * std::sqrt(0.05 * 0.95 * kWells);
  EXPECT_NEAR(all, 0.05 * kWells, allowed);
  EXPECT_NEAR(mean, 0.05 * kWells, allowed);
  EXPECT_LT(one, 0.05 * kWells + allowed);  // shared among the stations by Bonferroni's inequality
}

TEST(ErrorTests, NameTheKindAndTheStation) {
  ToolRun run;
  std::vector<ReferencedStation> stations = run.of(build_up(70.0, 12));
  stations[7].measured.gravity_mps2 = scaled(stations[7].measured.gravity_mps2, 1.002);
  const auto tests = error_tests(stations, {});
  ASSERT_TRUE(tests.has_value());
  EXPECT_FALSE(tests->gravity.passed());
  EXPECT_EQ(tests->gravity.worst, 7);
  EXPECT_TRUE(tests->field.passed());
  run.world.dip_rad += rad_from_deg(2.0);
  EXPECT_FALSE(error_tests(run.of(build_up(70.0, 12)), {})->dip.mean_passed());
  EXPECT_TRUE(error_tests(run.of(build_up(70.0, 12)), {})->dip.one_passed());
}

/// A reading of 1e12 m/s^2: its shared error is so much larger than its random one that the inverse rounds to nothing.
TEST(ErrorTests, OfAnAbsurdStationAreFiniteAndNameIt) {
  std::vector<ReferencedStation> stations;
  for (int k = 0; k < 6; ++k) {
    Measurement m = station_of({0.1 + 0.2 * k, 1.0, 1.7 * k}, World{}, 30.0 * k);
    m.random = independent_covariance(1e-3, 20e-9);
    stations.push_back({m, reference_of(World{})});
  }
  stations[3].measured.gravity_mps2[1] = 7.8e11;
  const auto tests = error_tests(stations, {});
  ASSERT_TRUE(tests.has_value());
  for (const double w : tests->gravity.normalised) EXPECT_TRUE(std::isfinite(w));
  EXPECT_TRUE(std::isfinite(tests->gravity.mean + tests->gravity.mean_limit));
  EXPECT_FALSE(tests->gravity.passed());
}

TEST(ErrorTests, RefuseWhatCannotBeTested) {
  ToolRun run;
  EXPECT_FALSE(error_tests({}, {}).has_value());
  std::vector<ReferencedStation> stations = run.of(build_up(70.0, 12));
  stations[2].measured.random = {};
  EXPECT_EQ(error_tests(stations, {}).error().field, "station at 60.00 m");
  stations[2].measured.gravity_mps2[0] = std::numeric_limits<double>::infinity();
  EXPECT_NE(error_tests(stations, {}).error().what.find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace multi_station_test
