#include "plumb/gravity/gravity.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace plumb {
namespace gravity_test {
namespace {

NormalGravityInput at_latitude(double latitude_deg, double depth_m = 0.0, double elevation_m = 0.0) {
  NormalGravityInput in;
  in.latitude_deg = latitude_deg;
  in.depth_m = depth_m;
  in.elevation_m = elevation_m;
  return in;
}

double any_in(double low, double high) {
  const int k = *rc::gen::weightedOneOf<int>(
      {{8, rc::gen::inRange(0, 1000001)}, {1, rc::gen::elementOf(std::vector<int>{0, 1, 500000, 999999, 1000000})}});
  return low + (high - low) * (k / 1e6);
}

NormalGravityInput any_input() {
  NormalGravityInput in = at_latitude(any_in(-90, 90), any_in(0, 15000), any_in(-500, 9000));
  in.layer_count = *rc::gen::inRange(0, 9);
  for (DensityLayer& layer : in.layers) {
    layer.density_kgpm3 = any_in(900, 3500);
    layer.thickness_m = any_in(0, 5000);
  }
  return in;
}

// Verifies: REQ-020
TEST(NormalGravity, EquatorAndPole) {
  EXPECT_NEAR(normal_gravity(at_latitude(0))->g_mps2, 9.7803253359, 1e-8);
  EXPECT_NEAR(normal_gravity(at_latitude(90))->g_mps2, 9.8321849379, 1e-8);
  EXPECT_NEAR(normal_gravity(at_latitude(-90))->g_mps2, 9.8321849379, 1e-8);
}

// Negative: REQ-020
TEST(NormalGravity, FiveKilometresOfRock) {
  NormalGravityInput in = at_latitude(45, 5000);
  const double surface = normal_gravity(at_latitude(45))->g_mps2;
  EXPECT_NEAR(normal_gravity(in)->g_mps2 - surface, 4.249e-3, 5e-6);
  in.layer_count = 1;
  in.layers[0] = {0.0, 2670.0};  // the only layer goes on for ever
  EXPECT_NEAR(normal_gravity(in)->g_mps2 - surface, 4.249e-3, 5e-6);
  // Table of docs/theory.md, section 1.3: 2.50 and 2.30 g/cm^3.
  in.layers[0].density_kgpm3 = 2500.0;
  EXPECT_NEAR((normal_gravity(in)->g_mps2 - surface) / kG0_mps2, 0.506e-3, 6e-7);
  in.layers[0].density_kgpm3 = 2300.0;
  EXPECT_NEAR((normal_gravity(in)->g_mps2 - surface) / kG0_mps2, 0.591e-3, 6e-7);
}

TEST(NormalGravity, WaterOverSedimentOfTheNote) {
  NormalGravityInput in = at_latitude(45, 5000);
  in.layer_count = 2;
  in.layers[0] = {2000.0, 1030.0};
  in.layers[1] = {3000.0, 2300.0};
  EXPECT_NEAR((normal_gravity(in)->g_mps2 - normal_gravity(at_latitude(45))->g_mps2) / kG0_mps2, 0.81e-3, 5e-6);
}

TEST(NormalGravity, FreeAirOfARigAtTwoThousandMetres) {
  const double change = normal_gravity(at_latitude(45, 0, 2000))->g_mps2 - normal_gravity(at_latitude(45))->g_mps2;
  EXPECT_NEAR(change / kG0_mps2, -0.63e-3, 5e-6);
}

// Verifies: REQ-022
TEST(NormalGravity, CarriesSigmaAndModel) {
  EXPECT_DOUBLE_EQ(normal_gravity(at_latitude(45))->sigma_mps2, 0.15e-3 * 9.80665);
  EXPECT_EQ(normal_gravity(at_latitude(45))->model, GravityModel::normal);
}

template <class Change>
void expect_refused(const Change& change, Errc code, int index) {
  NormalGravityInput in = at_latitude(45, 1000);
  in.layer_count = 2;
  change(in);
  const Expected<GravityReference> g = normal_gravity(in);
  ASSERT_FALSE(g.has_value()) << index;
  EXPECT_EQ(g.error().code, code) << index;
  EXPECT_EQ(g.error().index, index);
}

// Verifies: REQ-023
TEST(NormalGravity, RefusesWhatIsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const auto each = [&](double low, double high, int index, auto set) {
    for (const double v : {low, high}) {
      expect_refused([&](NormalGravityInput& in) { set(in, v); }, Errc::out_of_range, index);
    }
    for (const double v : {nan, inf, -inf}) {
      expect_refused([&](NormalGravityInput& in) { set(in, v); }, Errc::not_finite, index);
    }
  };
  each(-90.001, 90.001, 0, [](NormalGravityInput& in, double v) { in.latitude_deg = v; });
  each(-501, 9001, 1, [](NormalGravityInput& in, double v) { in.elevation_m = v; });
  each(-1, 15001, 2, [](NormalGravityInput& in, double v) { in.depth_m = v; });
  each(899, 3501, 3, [](NormalGravityInput& in, double v) { in.layers[1].density_kgpm3 = v; });
  each(-1, 1e9, 4, [](NormalGravityInput& in, double v) { in.layers[0].thickness_m = v; });
  each(-1e-9, 0.2, 5, [](NormalGravityInput& in, double v) { in.sigma_mps2 = v; });
  expect_refused([](NormalGravityInput& in) { in.layer_count = 9; }, Errc::out_of_range, 4);
  expect_refused([](NormalGravityInput& in) { in.layer_count = -1; }, Errc::out_of_range, 4);
  NormalGravityInput unused = at_latitude(45);
  unused.layers[0].density_kgpm3 = nan;
  EXPECT_TRUE(normal_gravity(unused).has_value()) << "layers beyond layer_count are not read";
}

// Verifies: REQ-021
TEST(PaperGravity, IsEqs8And9) {
  // Eq (8) written out in degrees of the check: sin^2 45 = 1/2, sin^2 90 = 1.
  EXPECT_NEAR(paper_gravity(45, 0)->g_mps2, 9.780327 * (1.0 + 0.0026512 - 0.0000058), 1e-9);
  EXPECT_NEAR(paper_gravity(0, 0)->g_mps2, 9.780327, 1e-9);
  EXPECT_NEAR(paper_gravity(90, 0)->g_mps2, 9.780327 * 1.0053024, 1e-9);
  const double surface = paper_gravity(45, 0)->g_mps2;
  EXPECT_NEAR(paper_gravity(45, 5000)->g_mps2, surface * (6371000.0 - 5000.0) / 6371000.0, 1e-9);
  EXPECT_NEAR((paper_gravity(45, 5000)->g_mps2 - surface) / kG0_mps2, -0.785e-3, 6e-7);
  EXPECT_EQ(paper_gravity(45, 0)->model, GravityModel::paper);
}

TEST(PaperGravity, RefusesBadInput) {
  EXPECT_EQ(paper_gravity(91, 0).error().index, 0);
  EXPECT_EQ(paper_gravity(45, -1).error().index, 2);
  EXPECT_EQ(paper_gravity(45, 0, -1).error().index, 5);
}

// Negative: REQ-023
TEST(GivenGravity, AcceptsItsRangeOnly) {
  EXPECT_EQ(given_gravity(9.5, 0.0)->g_mps2, 9.5);
  EXPECT_EQ(given_gravity(10.2, 0.1)->sigma_mps2, 0.1);
  EXPECT_EQ(given_gravity(9.81, 0.001)->model, GravityModel::value);
  EXPECT_TRUE(given_gravity(9.4999, 0.0).error() == (Error{Errc::out_of_range, 0, 0, 0}));
  EXPECT_EQ(given_gravity(9.4999, 0.0).error().limit, 9.5);
  EXPECT_EQ(given_gravity(1.0, 0.0).error().index, 0) << "a value in g0 is refused";
  EXPECT_EQ(given_gravity(9.81, 0.11).error().limit, 0.1);
  EXPECT_EQ(given_gravity(std::nan(""), 0.0).error().code, Errc::not_finite);
  EXPECT_EQ(given_gravity(9.81, std::nan("")).error().index, 5);
}

TEST(TableGravity, InterpolatesAndRefusesOutside) {
  const double depth[3] = {0, 1000, 3000};
  const double g[3] = {9.80, 9.81, 9.79};
  EXPECT_EQ(table_gravity(depth, g, 3, 0, 0.001)->g_mps2, 9.80);
  EXPECT_EQ(table_gravity(depth, g, 3, 1000, 0.001)->g_mps2, 9.81);
  EXPECT_EQ(table_gravity(depth, g, 3, 3000, 0.001)->g_mps2, 9.79);
  EXPECT_NEAR(table_gravity(depth, g, 3, 500, 0.001)->g_mps2, 9.805, 1e-14);
  EXPECT_NEAR(table_gravity(depth, g, 3, 2500, 0.001)->g_mps2, 9.795, 1e-14);
  EXPECT_EQ(table_gravity(depth, g, 1, 0, 0.001)->g_mps2, 9.80);
  EXPECT_EQ(table_gravity(depth, g, 3, 10, 0.001)->model, GravityModel::table);
  for (const double bad : {-0.1, 3000.1}) {
    EXPECT_TRUE(table_gravity(depth, g, 3, bad, 0.001).error() == (Error{Errc::out_of_range, 2, 0, 0}));
  }
  EXPECT_EQ(table_gravity(depth, g, 3, std::nan(""), 0.001).error().code, Errc::not_finite);
  EXPECT_EQ(table_gravity(depth, g, 0, 0, 0.001).error().index, 2);
  EXPECT_EQ(table_gravity(nullptr, g, 3, 0, 0.001).error().index, 2);
  EXPECT_EQ(table_gravity(g, nullptr, 3, 0, 0.001).error().index, 2);
  EXPECT_EQ(table_gravity(depth, g, 3, 0, 0.2).error().index, 5);
}

TEST(TableGravity, ChecksEveryRow) {
  const double g[3] = {9.80, 9.81, 9.79};
  const double repeated[3] = {0, 1000, 1000};
  EXPECT_EQ(table_gravity(repeated, g, 3, 0, 0.001).error().index, 2);
  const double broken[3] = {0, std::nan(""), 1000};
  EXPECT_EQ(table_gravity(broken, g, 3, 0, 0.001).error().code, Errc::not_finite);
  const double depth[3] = {0, 1000, 3000};
  const double in_g0[3] = {9.8, 1.0, 9.8};
  EXPECT_EQ(table_gravity(depth, in_g0, 3, 0, 0.001).error().index, 0);
}

TEST(GravityModelText, NamesOfTheArrayFile) {
  EXPECT_STREQ(to_string(GravityModel::normal), "normal");
  EXPECT_STREQ(to_string(GravityModel::paper), "paper");
  EXPECT_STREQ(to_string(GravityModel::value), "value");
  EXPECT_STREQ(to_string(GravityModel::table), "table");
  EXPECT_STREQ(to_string(static_cast<GravityModel>(200)), "unknown");
}

RC_GTEST_PROP(NormalGravityLaw, IsContinuousInDepthLatitudeAndElevation, ()) {
  const NormalGravityInput in = any_input();
  NormalGravityInput near = in;
  near.depth_m += in.depth_m > 1.0 ? -1e-3 : 1e-3;
  near.elevation_m += in.elevation_m > 0.0 ? -1e-3 : 1e-3;
  near.latitude_deg += in.latitude_deg > 0.0 ? -1e-6 : 1e-6;
  const auto a = normal_gravity(in);
  const auto b = normal_gravity(near);
  RC_ASSERT(a.has_value() && b.has_value());
  // 1 mm is at most 3.1e-9 in height and as much in mass; 1e-6 deg at most 9.1e-10.
  RC_ASSERT(std::fabs(a->g_mps2 - b->g_mps2) <= 1.2e-8);
}

RC_GTEST_PROP(NormalGravityLaw, IsEvenInLatitudeAndGrowsTowardsThePole, ()) {
  const double latitude = any_in(0, 89.9);
  const double north = normal_gravity(at_latitude(latitude))->g_mps2;
  RC_ASSERT(north == normal_gravity(at_latitude(-latitude))->g_mps2);
  RC_ASSERT(normal_gravity(at_latitude(latitude + 0.1))->g_mps2 > north);
}

RC_GTEST_PROP(NormalGravityLaw, DensitiesActLinearly, ()) {
  NormalGravityInput a = any_input();
  a.layer_count = *rc::gen::inRange(1, 9);
  NormalGravityInput b = a;
  NormalGravityInput mean = a;
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    b.layers[i].density_kgpm3 = any_in(900, 3500);
    mean.layers[i].density_kgpm3 = 0.5 * (a.layers[i].density_kgpm3 + b.layers[i].density_kgpm3);
  }
  const double ga = normal_gravity(a)->g_mps2;
  const double gb = normal_gravity(b)->g_mps2;
  RC_ASSERT(std::fabs(normal_gravity(mean)->g_mps2 - 0.5 * (ga + gb)) <= 1e-14);
}

RC_GTEST_PROP(NormalGravityLaw, SplittingALayerChangesNothing, ()) {
  NormalGravityInput one = any_input();
  one.layer_count = 2;
  NormalGravityInput two = one;
  two.layer_count = 3;
  const double share = any_in(0, 1);
  two.layers[0].thickness_m = share * one.layers[0].thickness_m;
  two.layers[1] = {(1.0 - share) * one.layers[0].thickness_m, one.layers[0].density_kgpm3};
  two.layers[2] = one.layers[1];
  RC_ASSERT(std::fabs(normal_gravity(one)->g_mps2 - normal_gravity(two)->g_mps2) <= 1e-14);
}

RC_GTEST_PROP(NormalGravityLaw, DenserRockAboveMeansLessGravity, ()) {
  NormalGravityInput in = any_input();
  in.layer_count = 1;
  in.layers[0].density_kgpm3 = any_in(900, 3400);
  NormalGravityInput denser = in;
  denser.layers[0].density_kgpm3 += 100.0;
  const double change = normal_gravity(denser)->g_mps2 - normal_gravity(in)->g_mps2;
  // 0.0839 mGal per metre and g/cm^3.
  RC_ASSERT(std::fabs(change + 0.0839e-5 * 0.1 * in.depth_m) <= 5e-4 * 0.0839e-5 * 0.1 * in.depth_m + 4e-15);
}

RC_GTEST_PROP(TableGravityLaw, IsMonotoneBetweenRowsAndExactOnALine, ()) {
  const double slope = any_in(-1e-6, 1e-6);
  std::vector<double> depth{any_in(-1000, 0)};
  const int rows = *rc::gen::inRange(2, 12);
  while (static_cast<int>(depth.size()) < rows) depth.push_back(depth.back() + any_in(1e-3, 2000));
  std::vector<double> g;
  for (const double d : depth) g.push_back(9.8 + slope * d);
  const double at = std::fmin(depth.back(), depth.front() + (depth.back() - depth.front()) * any_in(0, 1));
  const auto value = table_gravity(depth.data(), g.data(), rows, at, 0.001);
  RC_ASSERT(value.has_value());
  RC_ASSERT(std::fabs(value->g_mps2 - (9.8 + slope * at)) <= 1e-14);
}

}  // namespace
}  // namespace gravity_test
}  // namespace plumb
