// T8 at single attitudes, against the vote of the monitor.
#include "plumb/detection/one_attitude.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "plumb/detection/isolation.hpp"
#include "threshold_support.hpp"

// Serves: REQ-017

namespace one_attitude_test {
namespace {

using namespace plumb;
using namespace plumb_test;

/// A budget whose only term is the limit d of every triple, as the note has it.
ErrorBudget limit_only(double d_mps2) {
  ErrorBudget budget;
  budget.noise_mps2.fill(1e-12);
  budget.gravity_mps2 = 0.5 * d_mps2;  // what the reference may be off counts twice: in the limit and in the truth
  return budget;
}

/// docs/theory.md, section 8.3: delta' .05, .005, .002, .0005 g give .261, .082, .052, .026 g
/// and 1.673, 1.636, 1.634, 1.633 g.
// Verifies: REQ-017
TEST(OneAttitude, HasTheNotesFiguresForTheTetrahedron) {
  const double g = 0.9995;
  const struct {
    double limit, half_width, any;
  } rows[] = {{0.05, 0.261, 1.673}, {0.005, 0.082, 1.636}, {0.002, 0.052, 1.634}, {0.0005, 0.026, 1.633}};
  for (const auto& row : rows) {
    const GravityReference gravity{g, 0.0, GravityModel::value};
    const OneAttitude one(tetrahedron(1e-12), gravity, limit_only(row.limit));
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(one.blind_half_width_mps2(i), row.half_width, 6e-4);
      EXPECT_NEAR(one.any_attitude_mps2(i), row.any, 1.1e-3);
    }
  }
}

// Negative: REQ-017
TEST(OneAttitude, TheMirrorIsNotIsolatedAndItsNeighbourIs) {
  const SensorArray array = tetrahedron();
  const OneAttitude one(array, kExact, error_budget(array, kExact, TestSettings{}));
  const Vec3 vertical = {0.0, 0.0, 1.0};
  const double mirror = -4.0 / 3.0 * kG0_mps2;
  EXPECT_FALSE(one.isolates(vertical, 0, mirror));
  EXPECT_FALSE(one.isolates(vertical, 0, 0.001));
  EXPECT_TRUE(one.isolates(vertical, 0, 0.9 * mirror));
  EXPECT_TRUE(one.isolates(vertical, 0, 0.5 * kG0_mps2));
  EXPECT_TRUE(one.isolates(vertical, 3, 1.01 * one.any_attitude_mps2(3)));
}

TEST(OneAttitude, MapFiguresAreThoseOfTheIntervals) {
  const SensorArray array = tetrahedron();
  const OneAttitude one(array, kExact, error_budget(array, kExact, TestSettings{}));
  Noise noise(3);
  int blind = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3 down = random_direction(noise);
    const AttitudeFigures at = one.at(down);
    if (!at.blind.empty()) ++blind;
    bool hidden = false;
    for (int i = 0; i < 4; ++i) {
      EXPECT_TRUE(one.isolates(down, i, 1.000001 * at.clear_from_mps2));
      EXPECT_TRUE(one.isolates(down, i, -1.000001 * at.clear_from_mps2));
      for (const double sign : {1.0, -1.0}) {
        if (!one.isolates(down, i, sign * 0.999999 * at.clear_from_mps2)) hidden = true;
        EXPECT_LE(at.clear_from_mps2, one.any_attitude_mps2(i) * (1.0 + 1e-12));
      }
    }
    EXPECT_TRUE(hidden) << "no smaller figure would do";
  }
  EXPECT_GT(blind, 50);
  EXPECT_LT(blind, 450);
  // Gravity in the plane of two other axes: a3 and a4, seen from a1.
  const Vec3 plane = plus(array.axis(2), array.axis(3));
  EXPECT_TRUE(one.at(scaled(plane, 1.0 / norm(plane))).blind.has(0));
  EXPECT_NEAR(one.at(scaled(plane, 1.0 / norm(plane))).nearest_mirror_mps2, 0.0, 1e-12);
}

TEST(OneAttitude, ASensorWithoutAMonitoredTripleIsNeverIsolated) {
  const Vec3 up = {0.0, 0.0, 1.0};
  const double s = 0.02, c = std::sqrt(1.0 - s * s);
  AxisList axes{};
  axes[0] = {c, 0.0, s};
  axes[1] = {0.0, c, s};
  axes[2] = {-c, 0.0, s};
  axes[3] = {0.0, -c, s};
  const SensorArray array = make_array(axes, 4, 1e-3);
  const OneAttitude one(array, kExact, error_budget(array, kExact, TestSettings{}));
  EXPECT_TRUE(std::isinf(one.blind_half_width_mps2(0)));
  EXPECT_TRUE(std::isinf(one.any_attitude_mps2(0)));
  EXPECT_FALSE(one.isolates(up, 0, 1e3));
}

/// The vote itself: outside the intervals, and where parity sees it, exactly the faulty sensor is suspected at this one
/// attitude, whatever the noise below k_e sigmas.
// Verifies: REQ-017
RC_GTEST_PROP(OneAttitudeLaw, AnErrorOutsideTheIntervalsIsIsolated, ()) {
  const SensorArray array = drawn_array();
  RC_PRE(coplanarity(array, array.all()) == 2 && figures_of_merit(array).near_singular_triples == 0);
  const TestSettings settings;
  const GravityReference truth = kGravity;
  const ErrorBudget budget = error_budget(array, truth, settings);
  const OneAttitude one(array, truth, budget);
  const Thresholds t = thresholds_of(array, truth, settings);
  const Vec3 down = drawn_direction();
  // Anywhere, or close to one of the two errors that a triple cannot see.
  const int triple = *rc::gen::inRange(0, array.triple_count());
  const int member = *rc::gen::inRange(0, 3);
  const bool close = *rc::gen::arbitrary<bool>();
  const bool mirrored = *rc::gen::arbitrary<bool>();
  const double away = drawn(-1.0, 1.0);
  const int i = array.triple(triple).sensors[static_cast<std::size_t>(member)];
  const double near_one = mirrored ? mirror_error(array, triple, member, scaled(down, kG0_mps2)) : 0.0;
  const double f = close ? near_one + 0.1 * away * std::fabs(away) * kG0_mps2 : 2.0 * away * kG0_mps2;
  const double reference_error = drawn(-1.0, 1.0) * budget.gravity_mps2;
  BlockEvidence block = exact_block(array, down, settings.samples);
  for (int k = 0; k < array.size(); ++k) {
    const auto s = static_cast<std::size_t>(k);
    block.mean_mps2[s] *= 1.0 + reference_error / kG0_mps2;
    block.mean_mps2[s] += drawn(-1.0, 1.0) * 0.5 * budget.noise_mps2[s];
  }
  block.mean_mps2[static_cast<std::size_t>(i)] += f;
  Isolation isolation;
  isolation.pose(array, array.all());
  const SensorSet strict = isolation.vote({array, truth, budget.limits, block}).strict;
  RC_ASSERT(strict.empty() || strict == SensorSet::of(i));
  const double parity_floor = t.sure.fault[static_cast<std::size_t>(array.size() - 3)][static_cast<std::size_t>(i)];
  if (one.isolates(down, i, f) && std::fabs(f) > parity_floor) RC_ASSERT(strict == SensorSet::of(i));
}

}  // namespace
}  // namespace one_attitude_test
