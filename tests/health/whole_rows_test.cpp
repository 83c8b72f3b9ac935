// Rows that lack a sensor: a block holds none of them beside others that have it, and so they are no evidence.
#include <gtest/gtest.h>

#include <cmath>

#include "support/simulated_tool.hpp"

namespace whole_rows_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;

const Vec3 kHere = direction_at(45, 200);

/// 31 rows at rest; in the 32nd one channel alone, as the tool starts to turn; then it turns on.
// Negative: REQ-078
TEST(WholeRows, OneChannelAloneAsTheToolStartsToTurnExcludesNoSensor) {
  for (const int asserted : {-1, 0, 1, 2}) {
    for (int n = 4; n <= kCapacity && n <= 8; ++n) {
      for (int alone = 0; alone < n; ++alone) {
        MonitorConfig config;
        config.assumed_faults = asserted;
        Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), config, 7);
        rig.prove();
        for (int k = 0; k < 31; ++k) rig.step(rig.sample(kHere, kG0_mps2));
        Sample cut = rig.sample(direction_at(49, 200), kG0_mps2);
        cut.delivered = SensorSet::of(alone);
        rig.step(cut);
        for (int k = 2; k < 20; ++k) rig.step(rig.sample(direction_at(45.0 + 4.0 * k, 200), kG0_mps2));
        rig.stay(direction_at(125, 200), 3);
        EXPECT_TRUE(rig.ever_blamed.empty()) << asserted << ": " << n << ": " << alone;
        EXPECT_EQ(rig.monitor.verdict().state, HealthState::nominal) << asserted << ": " << n << ": " << alone;
      }
    }
  }
}

/// A row short of a sensor is left out, so the block takes one row more; the others go on.
// Verifies: REQ-078
TEST(WholeRows, ABlockIsFullWhenAsManyWholeRowsHaveCome) {
  for (const int lacking : {1, 2}) {
    Rig rig(plumb_test::tetrahedron());
    rig.prove();
    for (int k = 1; k <= rig.setup.config.window + lacking; ++k) {
      Sample s = rig.sample(kHere, kG0_mps2);
      if (k > 5 && k <= 5 + lacking) s.delivered = s.delivered.without(2);
      EXPECT_EQ(rig.step(s).tick, k == rig.setup.config.window + lacking) << lacking << ": " << k;
    }
  }
}

/// A block that began without a sensor begins anew when the sensor is back.
// Verifies: REQ-078
TEST(WholeRows, ABlockThatBeganWithoutASensorBeginsAnew) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  for (int k = 1; k <= rig.setup.config.window + 2; ++k) {
    Sample s = rig.sample(kHere, kG0_mps2);
    if (k <= 2) s.delivered = s.delivered.without(2);
    EXPECT_EQ(rig.step(s).tick, k == rig.setup.config.window + 2) << k;
  }
}

/// A channel that is lost leaves service, and then whole rows are those of the others.
// Verifies: REQ-078
TEST(WholeRows, ALostChannelDoesNotStopTheEvidence) {
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 1 ? std::nan("") : i == 4 ? r + 0.5 : r; };
  rig.stay(kHere, 2);
  EXPECT_EQ(rig.monitor.verdict().absent, SensorSet::of(1));
  EXPECT_EQ(rig.monitor.verdict().provisionally_excluded, SensorSet::of(4));
}

/// Where every row lacks another sensor nothing can be said, and nothing is.
// Negative: REQ-078
TEST(WholeRows, WithoutACompleteRowNothingIsClaimedAndNoSensorIsExcluded) {
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  for (int k = 0; k < 3200; ++k) {
    Sample s = rig.sample(direction_at(45.0 + 0.05 * k, 200), kG0_mps2);
    s.delivered = s.delivered.without(k % 6);
    const Verdict& v = rig.step(s);
    if (k >= rig.setup.config.missing_confirm) {
      ASSERT_EQ(v.validity, Validity::held) << k;
      ASSERT_TRUE(v.alert) << k;
    }
  }
  EXPECT_TRUE(rig.ever_blamed.empty());
  EXPECT_TRUE(rig.monitor.verdict().absent.empty());
}

}  // namespace
}  // namespace whole_rows_test
