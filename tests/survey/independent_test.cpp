// The same survey by a script that shares no code with plumb: tests/survey/independent_survey.py.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "plumb/core/units.hpp"
#include "plumb/survey/error_tests.hpp"
#include "plumb/survey/joint_alignment.hpp"
#include "plumb/survey/multi_station.hpp"
#include "plumb/survey/path.hpp"
#include "plumb/survey/position_covariance.hpp"

namespace independent_test {
namespace {

using namespace plumb;
using namespace plumb::survey;

constexpr double kAgree = 1e-9;
using Records = std::map<std::string, std::vector<std::vector<double>>>;

Records run_script() {
  Records out;
  const std::string command =
      "python3 '" + std::string(PLUMB_SOURCE_DIR) + "/tests/survey/independent_survey.py' 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) return out;
  std::string text;
  char buffer[4096];
  while (const std::size_t got = std::fread(buffer, 1, sizeof buffer, pipe.get())) text.append(buffer, got);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    words >> name;
    std::vector<double> numbers;
    for (std::string word; words >> word;) numbers.push_back(std::stod(word));
    out[name].push_back(numbers);
  }
  return out;
}

/// What the script states at its head.
ReferencedStation station_of(const std::vector<double>& reading, std::size_t k) {
  ReferencedStation out;
  out.measured.md_m = 30.0 * static_cast<double>(k);
  for (std::size_t i = 0; i < 3; ++i) {
    out.measured.gravity_mps2[i] = reading[i];
    out.measured.field_tesla[i] = reading[3 + i];
  }
  out.measured.random = independent_covariance(1e-3, 20e-9);
  out.reference.gravity.g_mps2 = 9.8123;
  out.reference.gravity.sigma_mps2 = 1.5e-3;
  out.reference.field.total_tesla = 50.4e-6;
  out.reference.field.dip_rad = 1.2345;
  out.reference.field.total_tesla_sigma = {130e-9, 60e-9};
  out.reference.field.dip_rad_sigma = {rad_from_deg(0.2), rad_from_deg(0.08)};
  return out;
}

class IndependentSurvey : public testing::Test {
 protected:
  void SetUp() override {
    static const Records once = run_script();
    records_ = &once;
    if (once.count("path") == 0) GTEST_SKIP() << "python3 did not run the script";
    const auto& readings = once.at("reading");
    for (std::size_t k = 0; k < readings.size(); ++k) stations_.push_back(station_of(readings[k], k));
    ASSERT_EQ(stations_.size(), 18U);
  }
  const std::vector<std::vector<double>>& of(const char* name) const { return records_->at(name); }

  const Records* records_ = nullptr;
  std::vector<ReferencedStation> stations_;
};

void expect_alike(double found, double other, double scale) {
  EXPECT_NEAR(found, other, kAgree * scale) << "scale " << scale;
}

TEST_F(IndependentSurvey, AgreesOnAnglesAndTheirCovariance) {
  for (std::size_t k = 0; k < stations_.size(); ++k) {
    const std::vector<double>& other = of("attitude")[k];
    const Attitude a = attitude_of(stations_[k].measured, stations_[k].measured.random);
    ASSERT_TRUE(a.inclination && a.gravity_toolface && a.magnetic_toolface && a.azimuth);
    const double angles[] = {a.inclination->rad, a.gravity_toolface->rad, a.magnetic_toolface->rad,
                             a.azimuth->angle.rad};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(std::remainder(angles[i] - other[i], 2.0 * kPi), 0.0, kAgree);
      for (std::size_t j = 0; j < 4; ++j)
        expect_alike(a.covariance[4 * i + j], other[4 + 4 * i + j], std::sqrt(other[4 + 5 * i] * other[4 + 5 * j]));
    }
  }
}

TEST_F(IndependentSurvey, AgreesOnTotals) {
  for (std::size_t k = 0; k < stations_.size(); ++k) {
    const std::vector<double>& other = of("totals")[k];
    const StationChecks c =
        check_station(stations_[k].measured, stations_[k].measured.random, stations_[k].reference, CheckSettings{});
    expect_alike(c.gravity.measured, other[0], other[0]);
    expect_alike(c.field.measured, other[1], other[1]);
    expect_alike(c.dip.measured, other[2], 1.0);
    expect_alike(c.gravity.sigma, std::hypot(std::sqrt(other[3]), 1.5e-3), c.gravity.sigma);
    expect_alike(c.field.sigma, std::sqrt(other[4] + 130e-9 * 130e-9 + 60e-9 * 60e-9), c.field.sigma);
    const double common = rad_from_deg(0.2), random = rad_from_deg(0.08);
    expect_alike(c.dip.sigma, std::sqrt(other[5] + common * common + random * random), c.dip.sigma);
  }
}

TEST_F(IndependentSurvey, AgreesOnTheEstimate) {
  MultiStationSettings settings;
  settings.terms = {Term::magnetometer_bias_x, Term::magnetometer_bias_y, Term::magnetometer_bias_z};
  settings.max_correlation = 1.0;
  settings.misfit_false_alarm = 0.0;
  const auto found = estimate_terms(stations_, settings);
  ASSERT_TRUE(found.has_value()) << found.error().text();
  const std::vector<double>& x = of("estimate")[0];
  const std::vector<double>& c = of("covariance")[0];
  for (std::size_t i = 0; i < kTermCount; ++i) {
    expect_alike(found->value[i], x[i], std::sqrt(c[13 * i]));
    for (std::size_t j = 0; j < kTermCount; ++j)
      expect_alike(found->covariance[kTermCount * i + j], c[kTermCount * i + j], std::sqrt(c[13 * i] * c[13 * j]));
  }
  expect_alike(found->gravity_offset_mps2, x[12], 1.5e-3);
  expect_alike(found->field_offset_tesla, x[13], 130e-9);
  expect_alike(found->dip_offset_rad, x[14], rad_from_deg(0.2));
  expect_alike(found->chi_square, of("chi")[0][0], of("chi")[0][0]);
}

TEST_F(IndependentSurvey, AgreesOnTheAlignment) {
  std::vector<ReferencedStation> apart;
  for (std::size_t k = 0; k < stations_.size(); ++k) apart.push_back(station_of(of("apart")[k], k));
  AlignmentSettings settings;
  settings.misfit_false_alarm = 0.0;
  settings.stated_rad = rad_from_deg(2.0);
  for (const std::size_t unknown_dip : {0U, 1U}) {
    settings.dip_known = unknown_dip == 0;
    const auto found = align_magnetometers(apart, settings);
    ASSERT_TRUE(found.has_value()) << found.error().text();
    const std::vector<double>& x = of("aligned")[unknown_dip];
    const std::vector<double>& c = of("alignment")[unknown_dip];
    const auto sigma = [&](std::size_t i) { return std::sqrt(c[(kAlignmentUnknowns + 1) * i]); };
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found->rotation[i], of("rotation")[unknown_dip][i], kAgree * 1e-3);
    for (std::size_t i = 0; i < kTermCount; ++i) expect_alike(found->value[i], x[i], sigma(3 + i));
    for (std::size_t i = 0; i < kAlignmentUnknowns; ++i) {
      for (std::size_t j = 0; j < kAlignmentUnknowns; ++j)
        expect_alike(found->covariance[kAlignmentUnknowns * i + j], c[kAlignmentUnknowns * i + j], sigma(i) * sigma(j));
    }
    expect_alike(found->gravity_offset_mps2, x[12], 1.5e-3);
    expect_alike(found->field_offset_tesla, x[13], 130e-9);
    expect_alike(found->dip_offset_rad, x[14], rad_from_deg(0.2));
    expect_alike(found->dip_sigma_rad, std::sqrt(of("dip")[unknown_dip][0]), found->dip_sigma_rad);
    expect_alike(found->chi_square, x[15], x[15]);
  }
}

// Verifies: REQ-250, REQ-251
TEST_F(IndependentSurvey, AgreesOnThePositionsOfAnAlignedTool) {
  std::vector<ReferencedStation> apart;
  for (std::size_t k = 0; k < stations_.size(); ++k) apart.push_back(station_of(of("apart")[k], k));
  AlignmentSettings settings;
  settings.misfit_false_alarm = 0.0;
  settings.stated_rad = rad_from_deg(2.0);
  StationSettings all_pass;
  all_pass.checks.limits = LimitKind::fixed;
  all_pass.checks.fixed = {1.0, 1.0, 1.0};
  for (const bool dip_known : {true, false}) {
    settings.dip_known = dip_known;
    const auto found = align_magnetometers(apart, settings);
    ASSERT_TRUE(found.has_value()) << found.error().text();
    std::vector<PathStationErrors> errors;
    for (const ReferencedStation& s : apart)
      errors.push_back(path_errors(judge_corrected(aligned(s.measured, *found), s.reference, all_pass), North::magnetic,
                                   alignment_weights(s.measured, *found)));
    const std::vector<PositionCovariance> positions =
        position_covariances(errors, {found->covariance, rad_from_deg(0.4), rad_from_deg(0.1), 0.35, 5e-4});
    for (std::size_t k = 1; k < positions.size(); ++k) {
      const std::vector<double>& other = of(dip_known ? "position" : "position_unknown_dip")[k];
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
          expect_alike(positions[k][3 * i + j], other[3 * i + j], std::sqrt(other[4 * i] * other[4 * j]));
      }
    }
  }
}

TEST_F(IndependentSurvey, AgreesOnTheErrorTests) {
  const auto found = error_tests(stations_, {});
  ASSERT_TRUE(found.has_value()) << found.error().text();
  const ErrorTest* const kinds[] = {&found->gravity, &found->field, &found->dip};
  for (std::size_t kind = 0; kind < 3; ++kind) {
    const std::vector<double>& other = of("test")[kind];
    expect_alike(kinds[kind]->chi_square, other[0], other[0]);
    expect_alike(kinds[kind]->mean, other[1], other[2]);
    expect_alike(kinds[kind]->mean_sigma, other[2], other[2]);
    for (std::size_t k = 0; k < stations_.size(); ++k)
      expect_alike(kinds[kind]->normalised[k], other[3 + k], 1.0 + std::fabs(other[3 + k]));
  }
}

TEST_F(IndependentSurvey, AgreesOnThePath) {
  std::vector<PathStation> hole;
  for (const ReferencedStation& s : stations_) {
    const Attitude a = attitude_of(s.measured, s.measured.random);
    hole.push_back({s.measured.md_m, a.inclination->rad, true, a.azimuth->angle.rad});
  }
  const auto path = minimum_curvature(hole);
  ASSERT_TRUE(path.has_value());
  for (std::size_t k = 0; k < hole.size(); ++k) {
    const std::vector<double>& other = of("path")[k];
    EXPECT_NEAR((*path)[k].north_m, other[0], 1e-9);
    EXPECT_NEAR((*path)[k].east_m, other[1], 1e-9);
    EXPECT_NEAR((*path)[k].tvd_m, other[2], 1e-9);
    EXPECT_NEAR((*path)[k].dogleg_rad, other[3], 1e-12);
  }
}

}  // namespace
}  // namespace independent_test
