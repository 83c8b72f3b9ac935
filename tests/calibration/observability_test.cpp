/// Coverage is counted as a hand would, and following the plan makes any set of stations sufficient.
#include "plumb/calibration/observability.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "calibration/bench.hpp"

namespace observability_test {
namespace {

using namespace calibration_test;

constexpr double kSigma = 2e-4 * plumb::kG0_mps2;

Vec3 unit(const Vec3& v) { return plumb::scaled(v, 1.0 / plumb::norm(v)); }

plumb::SeenAttitude seen(const Vec3& direction, int n) { return {unit(direction), plumb::SensorSet::first(n), 100.0}; }

plumb::FitReport report_of(const plumb::Datasheet& d, const std::vector<plumb::Station>& stations) {
  plumb::FitOptions lenient;
  lenient.require_full_rank = false;
  plumb::FitReport report;
  const auto fit =
      plumb::calibrate(d, standard_gravity(), stations.data(), static_cast<int>(stations.size()), lenient, &report);
  RC_ASSERT(fit.has_value());
  return report;
}

TEST(Coverage, CountsWhatWasRecorded) {
  const plumb::Datasheet d = paper_tool(kSigma);
  std::vector<plumb::SeenAttitude> attitudes;
  for (const double inclination : {0.0, 45.0, 46.0, 90.0}) {
    for (int k = 0; k < 6; ++k) attitudes.push_back(seen(rolled(inclination, 60.0 * k), 4));
  }
  const plumb::Coverage c = plumb::coverage_of(d, attitudes.data(), static_cast<int>(attitudes.size()));
  EXPECT_EQ(c.attitudes, 24);
  EXPECT_EQ(c.inclinations, 3);
  EXPECT_NEAR(c.inclination_min_rad, 0.0, 1e-9);
  EXPECT_NEAR(c.inclination_max_rad, plumb::kPi / 2.0, 1e-9);
  EXPECT_NEAR(c.highest[3], 1.0, 1e-9);
  EXPECT_NEAR(c.lowest[3], 0.0, 1e-9);
  EXPECT_NEAR(c.lowest[0], -std::sqrt(8.0) / 3.0, 1e-9);
}

TEST(Coverage, OfNothingIsNothing) {
  const plumb::Datasheet d = paper_tool(kSigma);
  EXPECT_EQ(plumb::coverage_of(d, nullptr, 7).attitudes, 0);
  plumb::SeenAttitude bad = seen({0, 0, 1}, 4);
  bad.direction[1] = std::nan("");
  EXPECT_EQ(plumb::coverage_of(d, &bad, 1).attitudes, 0);
  const plumb::SeenAttitude one = {{0, 0, 1}, plumb::SensorSet::of(2), 1.0};
  const plumb::Coverage c = plumb::coverage_of(d, &one, 1);
  EXPECT_EQ(c.inclinations, 1);
  EXPECT_EQ(c.highest[3], 0.0) << "a sensor that never delivered";
  EXPECT_NEAR(c.highest[2], 1.0 / 3.0, 1e-12);
}

TEST(StationPlanner, ProposesTheOppositeOfWhatItHas) {
  const plumb::Datasheet d = paper_tool(kSigma);
  auto planner = std::make_unique<plumb::StationPlanner>(d, plumb::kG0_mps2);
  for (int k = 0; k < 24; ++k) ASSERT_TRUE(planner->add(seen(rolled(15.0 * k, 0.0), 4)));
  // All in the plane of x and z: what is missing lies off it.
  const plumb::PlannedAttitude first = planner->best(100.0);
  EXPECT_GT(first.gain, 1.0);
  EXPECT_GT(std::fabs(first.direction[1]), 0.5);
  const plumb::PlannedAttitude again = planner->best(100.0);
  EXPECT_EQ(first.direction, again.direction) << "asking changes nothing";
  EXPECT_NEAR(plumb::norm(first.direction), 1.0, 1e-12);
}

TEST(StationPlanner, GainFallsAsStationsComeIn) {
  const plumb::Datasheet d = paper_tool(kSigma);
  auto planner = std::make_unique<plumb::StationPlanner>(d, plumb::kG0_mps2);
  std::array<plumb::PlannedAttitude, 30> plan{};
  ASSERT_EQ(planner->plan(100.0, 30, plan.data()), 30);
  for (std::size_t k = 1; k < plan.size(); ++k) EXPECT_LE(plan[k].gain, plan[k - 1].gain * (1.0 + 1e-6)) << k;
  EXPECT_LT(plan[29].gain, 0.2 * plan[0].gain);
}

TEST(StationPlanner, RefusesSamplesWithoutInformation) {
  const plumb::Datasheet d = paper_tool(kSigma);
  auto planner = std::make_unique<plumb::StationPlanner>(d, plumb::kG0_mps2);
  EXPECT_FALSE(planner->add({{0, 0, 1}, plumb::SensorSet(3U), 100.0}));
  EXPECT_FALSE(planner->add({{0, 0, 2}, plumb::SensorSet::first(4), 100.0}));
  EXPECT_FALSE(planner->add({{0, 0, std::nan("")}, plumb::SensorSet::first(4), 100.0}));
  EXPECT_FALSE(planner->add({{0, 0, 1}, plumb::SensorSet::first(4), 0.0}));
  EXPECT_TRUE(planner->add({{0, 0, 1}, plumb::SensorSet::first(4), 1.0}));
  plumb::Datasheet broken = d;
  broken.sensor[1].row.sigma_mps2 = 0.0;
  auto idle = std::make_unique<plumb::StationPlanner>(broken, plumb::kG0_mps2);
  EXPECT_EQ(idle->best(1.0).gain, 0.0);
  plumb::PlannedAttitude out;
  EXPECT_EQ(idle->plan(1.0, 1, &out), 0);
  EXPECT_EQ(planner->plan(1.0, 5, nullptr), 0);
}

TEST(StationPlanner, BeatsAsManyRandomStations) {
  // Smallest eigenvalue of the information, in the excitation of the fit report.
  double planned = 0.0, random = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Noise noise(seed);
    const plumb::Datasheet d = paper_tool(kSigma);
    const Truth truth = draw_truth(d, noise);
    auto planner = std::make_unique<plumb::StationPlanner>(d, plumb::kG0_mps2);
    std::array<plumb::PlannedAttitude, 12> plan{};
    ASSERT_EQ(planner->plan(1.0, 12, plan.data()), 12);
    std::vector<plumb::Station> stations;
    for (const auto& p : plan)
      stations.push_back(station_at(d, truth, plumb::scaled(p.direction, plumb::kG0_mps2), noise, kSigma));
    planned += report_of(d, stations).excitation / 20.0;
    random += report_of(d, random_stations(d, truth, 12, noise, kSigma)).excitation / 20.0;
  }
  std::cout << "[ measured ] excitation of 12 planned stations " << planned << ", of 12 random ones " << random << '\n';
  EXPECT_GT(planned, 2.0 * random);
}

/// So few samples that they weigh nothing, and so many that no number holds what they would tell.
TEST(StationPlanner, SamplesOfNoWeightAndBeyondAllNumbersAddNothing) {
  plumb::Datasheet d = paper_tool(kSigma);
  for (int i = 0; i < d.size; ++i) d.sensor[at(i)].prior.bias_mps2 = 50.0;
  const auto planner = std::make_unique<plumb::StationPlanner>(d, plumb::kG0_mps2);
  const auto with = [](double samples) {
    return plumb::SeenAttitude{{0.0, 0.0, 1.0}, plumb::SensorSet::first(4), samples};
  };
  EXPECT_FALSE(planner->add(with(1e-30)));
  EXPECT_GT(planner->best(100.0).gain, 0.0);
  for (const double samples : {1e302, 1e305}) EXPECT_EQ(planner->best(samples).gain, 0.0) << samples;
  EXPECT_FALSE(planner->add(with(1e305)));
  EXPECT_TRUE(planner->add(with(100.0)));
}

/// Stations that do not suffice: one circle, two circles, a plane, a few, or all alike.
std::vector<Vec3> poor_set(int kind, Noise& noise) {
  std::vector<Vec3> out;
  const double tilt = 10.0 + 70.0 * noise.uniform();
  for (int k = 0; k < 12; ++k) {
    if (kind == 0) out.push_back(rolled(tilt, 30.0 * k));
    if (kind == 1) out.push_back(rolled(k % 2 == 0 ? tilt : tilt + 20.0, 60.0 * k));
    if (kind == 2) out.push_back(rolled(30.0 * k, tilt));
    if (kind == 3) out.push_back(rolled(tilt, tilt));
    if (kind == 4 && k < 3) out.push_back(plumb::scaled(noise.direction(), plumb::kG0_mps2));
  }
  return out;
}

RC_GTEST_PROP(StationPlannerLaw, FollowingThePlanMakesAnySetSufficient, ()) {
  const int kind = *rc::gen::inRange(0, 6);
  const int n = *rc::gen::inRange(3, std::min(plumb::kCapacity, 8) + 1);
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  plumb::AxisList axes{};
  if (n == 3) plumb::orthogonal_triad(axes);
  if (n == 4) plumb::paper_tetrahedron(axes);
  if (n > 4) plumb::cone_with_axis(axes, n);
  const plumb::Datasheet d = datasheet_of(axes, n, kSigma);
  const Truth truth = draw_truth(d, noise);
  auto planner = std::make_unique<plumb::StationPlanner>(d, plumb::kG0_mps2);
  std::vector<plumb::Station> stations;
  for (const Vec3& g : poor_set(kind, noise)) {
    stations.push_back(station_at(d, truth, g, noise, 0.1 * kSigma));
    planner->add({unit(g), plumb::SensorSet::first(n), 100.0});
  }
  // The length of gravity needs nine directions; beyond that, a few.
  const int directions = kind == 3 ? 1 : static_cast<int>(stations.size());
  const int enough = std::max(6, 9 - directions);
  std::array<plumb::PlannedAttitude, 9> plan{};
  RC_ASSERT(planner->plan(100.0, enough, plan.data()) == enough);
  for (int k = 0; k < enough; ++k) {
    const Vec3 g = plumb::scaled(plan[at(k)].direction, plumb::kG0_mps2);
    stations.push_back(station_at(d, truth, g, noise, 0.1 * kSigma));
  }
  const auto fit = plumb::calibrate(d, standard_gravity(), stations.data(), static_cast<int>(stations.size()));
  RC_ASSERT(fit.has_value());
  RC_ASSERT(fit->report.rank == 4 * n - 3);
}

TEST(Coverage, NeighbouringBinsAreOneInclinationWhateverTheOrder) {
  const Datasheet d = paper_tool(kSigma);
  std::vector<SeenAttitude> seen;
  for (const double inclination : {60.0, 50.0, 45.0, 10.0, 90.0}) {
    const Vec3 g = rolled(inclination, 0.0);
    seen.push_back({scaled(g, 1.0 / norm(g)), SensorSet::first(4), 10.0});
  }
  const Coverage c = coverage_of(d, seen.data(), 5);
  EXPECT_EQ(c.inclinations, 4);
  EXPECT_NEAR(c.inclination_min_rad, rad_from_deg(10.0), 1e-9);
  EXPECT_NEAR(c.inclination_max_rad, rad_from_deg(90.0), 1e-9);
}

TEST(StationPlanner, WithoutAUsableDatasheetItProposesNothing) {
  const auto idle = [](const Datasheet& sheet, double g_mps2) {
    auto planner = std::make_unique<StationPlanner>(sheet, g_mps2);
    const bool taken = planner->add({{0, 0, 1}, SensorSet::first(4), 100.0});
    return !taken && planner->best(100.0).gain == 0.0;
  };
  Datasheet sheet = paper_tool(kSigma);
  EXPECT_FALSE(idle(sheet, kG0_mps2));
  EXPECT_TRUE(idle(sheet, 0.0));
  EXPECT_TRUE(idle(sheet, HUGE_VAL));
  sheet.size = 2;
  EXPECT_TRUE(idle(sheet, kG0_mps2));
  sheet.size = kCapacity + 1;
  EXPECT_TRUE(idle(sheet, kG0_mps2));
}

TEST(StationPlanner, AnAttitudeThatASensorMissedIsTaken) {
  AxisList axes{};
  const Datasheet sheet = datasheet_of(axes, cone(axes, 5), kSigma);
  auto planner = std::make_unique<StationPlanner>(sheet, kG0_mps2);
  EXPECT_TRUE(planner->add({{0, 0, 1}, SensorSet::first(5).without(1), 100.0}));
  EXPECT_FALSE(planner->add({{0, 0, 1}, SensorSet::first(5), HUGE_VAL}));
  EXPECT_EQ(planner->best(0.0).gain, 0.0);
}

}  // namespace
}  // namespace observability_test
