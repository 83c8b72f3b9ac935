// Replay and safety with drift, faults and recalibration all at once.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "recalibration_support.hpp"

// Serves: REQ-130

namespace recalibrating_laws_test {
namespace {

using namespace plumb;
using plumb_test::after_exclusion;
using plumb_test::direction_at;
using plumb_test::Tool;

/// S18 and replay: a copy taken at any step goes on as the original does, fit and adoption included.
TEST(Recalibrating, ReplayIsExactThroughFitAndAdoption) {
  Tool tool(6, after_exclusion(), 9);
  tool.drift(2e-3);
  auto copy = std::make_unique<HealthMonitor>(tool.rig.monitor);
  for (int k = 0; k < 50; ++k) {
    if (k == 10) tool.fault = [](int i, double r, int) { return i == 3 ? r + 0.3 : r; };
    const Vec3 u = plumb_test::random_direction(tool.directions);
    for (int s = 0; s < 64; ++s) {
      const Sample sample = tool.rig.sample(u, kG0_mps2);
      const Verdict& v = tool.rig.step(sample);
      const Verdict& w = copy->step(sample);
      ASSERT_EQ(std::memcmp(&v.gravity_mps2, &w.gravity_mps2, sizeof(Vec3)), 0);
      ASSERT_EQ(v.state, w.state);
      ASSERT_EQ(v.recalibration.phase, w.recalibration.phase);
      if ((k * 64 + s) % 7 == 0) *copy = HealthMonitor(tool.rig.monitor);
    }
  }
  EXPECT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  EXPECT_TRUE(plumb_test::same_model(tool.rig.monitor.model(), copy->model()));
}

/// S1, S13, S17 with drift, faults and recalibration all at once.
RC_GTEST_PROP(RecalibratingLaw, NoHealthySensorIsExcludedAndValidOutputIsWithinItsBound, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const bool faulty = *rc::gen::arbitrary<bool>();
  Tool tool(n, after_exclusion(), seed);
  tool.drift(2e-3);
  tool.rig.prove();
  const int which = static_cast<int>(tool.directions.uniform() * n);
  const double size = 0.05 * std::pow(20.0, tool.directions.uniform());
  const int onset = 3000 + static_cast<int>(3000.0 * tool.directions.uniform());
  if (faulty) tool.fault = [=](int i, double r, int k) { return i == which && k > onset ? r + size : r; };
  for (int station = 0; station < 60; ++station) {
    if (station == 20) tool.rig.monitor.request_recalibration();
    const Vec3 u = plumb_test::random_direction(tool.directions);
    for (int s = 0; s < 64; ++s) {
      const Verdict& v = tool.rig.step(tool.rig.sample(u, kG0_mps2));
      if (!v.tick || v.validity != Validity::valid) continue;
      RC_ASSERT(v.protection_available);
      RC_ASSERT(angle_between_rad(v.gravity_mps2, u) <= v.protection_level_calibrated_axes_rad);
    }
    RC_ASSERT((faulty ? SensorSet::of(which) : SensorSet{}).contains(tool.rig.ever_blamed));
  }
  RC_CLASSIFY(tool.count(HealthEvent::fit_accepted) > 0, "accepted");
  RC_CLASSIFY(tool.count(HealthEvent::fit_rejected) > 0, "rejected");
}

}  // namespace
}  // namespace recalibrating_laws_test
