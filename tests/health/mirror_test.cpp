// Faults that look exactly like those of another sensor at one attitude (theorem T1): ambiguous there, however long the
// tool stays, and isolated by a change of attitude.
#include <gtest/gtest.h>

#include "support/simulated_tool.hpp"

namespace health_mirror_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;

MonitorConfig one_fault_asserted() {
  MonitorConfig config;
  config.assumed_faults = 1;
  return config;
}

/// Sensor 1 stuck at -1 g0 once the tool hangs vertical: there the reading is that of gravity mirrored in the plane of
/// the axes 2 and 3.
Rig stuck_in_a_vertical_tool(const MonitorConfig& config) {
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 0 ? -kG0_mps2 : r; };
  return rig;
}

/// A bias of sensor 1 that mirrors gravity in the plane of axes 2 and 4 at 20 deg inclination and toolface
/// `toolface_deg`.
Rig biased_into_the_mirror(const MonitorConfig& config, double toolface_deg) {
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  const Mat3 map = triple_map(rig.setup.array, rig.setup.array.triple_index(0, 1, 3));
  const Vec3 w = {map[0], map[3], map[6]};
  const double bias = -2.0 * kG0_mps2 * dot(direction_at(20, toolface_deg), w) / dot(w, w);
  rig.distort = [bias](int i, double r, int) { return i == 0 ? r + bias : r; };
  return rig;
}

// Verifies: REQ-073, REQ-103
TEST(MirrorFault, StuckInAVerticalToolIsAmbiguousAtEveryToolfaceAndIsolatedByFiveDegrees) {
  Rig rig = stuck_in_a_vertical_tool(one_fault_asserted());
  for (int toolface = 0; toolface < 360; toolface += 30) {
    const Verdict& v = rig.stay(direction_at(0, toolface), 2);
    EXPECT_EQ(v.state, HealthState::suspect) << toolface;
    EXPECT_TRUE(rig.ever_blamed.empty()) << toolface;
    EXPECT_TRUE(v.suspects.has(0)) << "the truth is among those that one fault explains";
    EXPECT_GE(v.suspects.size(), 2) << "and so is its mirror";
    EXPECT_TRUE(v.wants_rotation);
  }
  EXPECT_EQ(rig.stay(direction_at(5, 40)).excluded, SensorSet::of(0));
  EXPECT_EQ(rig.monitor.verdict().grade, Grade::assumed);
  EXPECT_EQ(rig.ever_blamed, SensorSet::of(0));
}

// Negative: REQ-071
TEST(MirrorFault, WithoutAnAssumptionTheStuckSensorTakesFourStations) {
  Rig rig = stuck_in_a_vertical_tool({});
  for (int toolface = 0; toolface < 360; toolface += 60) rig.stay(direction_at(0, toolface), 2);
  EXPECT_TRUE(rig.ever_blamed.empty());
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(rig.stay(direction_at(6 + 6 * k, 40)).excluded.empty()) << "station " << k + 1 << " off the mirror";
  }
  EXPECT_EQ(rig.stay(direction_at(24, 40)).excluded, SensorSet::of(0));
  EXPECT_EQ(rig.monitor.verdict().grade, Grade::confirmed);
}

// Verifies: REQ-073
TEST(MirrorFault, AnExactMirrorBiasIsAmbiguousUntilTheToolfaceTurnsByTenDegrees) {
  for (int toolface = 15; toolface < 360; toolface += 30) {
    Rig rig = biased_into_the_mirror(one_fault_asserted(), toolface);
    const Verdict& v = rig.stay(direction_at(20, toolface), 6);
    EXPECT_EQ(v.state, HealthState::suspect) << toolface;
    EXPECT_TRUE(rig.ever_blamed.empty()) << toolface;
    EXPECT_GE(v.suspects.size(), 2) << toolface;
    EXPECT_EQ(rig.stay(direction_at(20, toolface + 10)).excluded, SensorSet::of(0)) << toolface;
  }
}

// Negative: REQ-103
TEST(MirrorFault, WithoutAnAssumptionTheMirrorBiasTakesFourStations) {
  Rig rig = biased_into_the_mirror({}, 45);
  rig.stay(direction_at(20, 45), 6);
  // The directions of stations have to differ by 5 deg: at 20 deg of inclination that is a quarter of the toolface.
  for (int k = 1; k < 4; ++k) {
    EXPECT_TRUE(rig.stay(direction_at(20, 45 + 20 * k)).excluded.empty()) << "station " << k;
  }
  for (int k = 4; k < 6; ++k) rig.stay(direction_at(20, 45 + 20 * k));
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(0));
  EXPECT_EQ(rig.monitor.verdict().grade, Grade::confirmed);
}

}  // namespace
}  // namespace health_mirror_test
