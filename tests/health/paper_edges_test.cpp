// Edges of paper mode: fits that are not sound, a scale that vanishes, a fit in flight whose attitudes repeat.
#include <gtest/gtest.h>

#include <cmath>

#include "health/paper_rig.hpp"

// Serves: REQ-190

namespace paper_edges_test {
namespace {

using namespace plumb;
using paper_test::direction_at;
using paper_test::PaperRig;

/// A fit that is not sound reads nobody, nor do triples that were not fitted.
// Negative: REQ-190
TEST(PaperMonitorEdge, WithoutASoundFitNobodyHasHisOwn) {
  const Datasheet sheet = paper_test::sheet_of(4);
  const Expected<SensorArray> array = sheet.array();
  ASSERT_TRUE(array.has_value());
  const auto fits = paper_test::exact_fits(sheet);
  PaperFit rest;
  const PaperFits whole = {*array, *fits, rest};
  EXPECT_EQ(whole.own(SensorSet::first(4)), &fits->all);
  EXPECT_EQ(whole.own(SensorSet::first(3)), &fits->triple[0]);
  fits->all.converged = false;
  fits->triples = 0;
  EXPECT_EQ(whole.own(SensorSet::first(4)), nullptr);
  EXPECT_EQ(whole.own(SensorSet::first(3)), nullptr);
  rest = fits->all;
  rest.converged = true;
  EXPECT_EQ(whole.own(SensorSet::first(4)), &rest);
}

/// A cubic that passes through zero has no reading there: no vector is shown, and the block is no evidence.
// Negative: REQ-190
TEST(PaperMonitorEdge, AScaleThatVanishesShowsNoVector) {
  Datasheet sheet = paper_test::sheet_of(4);
  for (int i = 0; i < 4; ++i) {
    SensorCoefficients& c = sheet.sensor[static_cast<std::size_t>(i)].coefficients;
    c.scale = {0.25, -0.25 / 64.0, 0.0, 0.0};
    c.bias = {};
    c.reference_degc = 25.0;
  }
  PaperRig rig(sheet, 4, 1);
  rig.setup->base.config.temperature_max_degc = 200.0;
  rig.restart();
  rig.prove();
  const Vec3 before = rig.monitor->verdict().latest_mps2;
  ASSERT_GT(norm(before), 9.0);
  for (int k = 0; k < rig.setup->base.config.window; ++k) {
    Sample s = rig.sample(direction_at(50, 50));
    s.temperature_degc = 25.0 + 64.0;
    rig.step(s);
  }
  const Verdict& v = rig.monitor->verdict();
  EXPECT_TRUE(std::isfinite(norm(v.latest_mps2)));
  EXPECT_EQ(v.latest_mps2, before) << "the last that there was";
}

/// The same attitude again is no further station.
TEST(PaperMonitorEdge, AnAttitudeThatRepeatsDoesNotBringTheFitNearer) {
  PaperRig rig(6);
  rig.prove();
  rig.stick(5, 0.3 * kG0_mps2);
  rig.tour(5);
  ASSERT_EQ(rig.monitor->verdict().state, HealthState::recalibrating);
  for (int k = 0; k < 40; ++k) rig.stay(direction_at(50, 50));
  EXPECT_EQ(rig.monitor->verdict().state, HealthState::recalibrating);
  EXPECT_FALSE(rig.monitor->rest().sound());
  rig.tour(12);
  EXPECT_TRUE(rig.monitor->rest().sound());
}

}  // namespace
}  // namespace paper_edges_test
