// A recalibration asked for because nothing explains the evidence any more.
#include <gtest/gtest.h>

#include "recalibration_support.hpp"

// Serves: REQ-134

namespace recalibrating_suspect_test {
namespace {

using namespace plumb;
using plumb_test::Tool;

/// All four sensors have drifted, each its own way: every three of them contradict gravity, and nobody is suspected.
struct Drifted : Tool {
  explicit Drifted(MonitorConfig config = {}) : Tool(4, config, 5) {
    rig.prove();
    bias = {0.05, -0.04, 0.045, 0.035};
    visit(1);
    for (int k = 0; k < 4 && !rig.monitor.request_recalibration().has_value(); ++k) visit(1);
  }
};

TEST(RecalibratingSuspect, WithNoConsistentHypothesisAFitIsMadeAndAdopted) {
  Drifted tool;
  ASSERT_EQ(tool.state(), HealthState::suspect);
  ASSERT_EQ(tool.rig.monitor.verdict().consistent_hypotheses, 0);
  tool.visit(1);
  ASSERT_EQ(tool.state(), HealthState::recalibrating);
  const int before = tool.rig.monitor.verdict().stations_on_record;
  for (int k = 0; k < 20 && tool.state() == HealthState::recalibrating; ++k) {
    EXPECT_EQ(tool.rig.monitor.verdict().validity, Validity::unconfirmed);
    EXPECT_EQ(tool.rig.monitor.verdict().stations_on_record, before)
        << "the isolation timeout rests, else no fit is ever done";
    tool.visit(1);
  }
  ASSERT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  tool.visit(6);
  EXPECT_EQ(tool.state(), HealthState::nominal);
  EXPECT_LT(tool.bias_error(SensorSet::first(4)), 1e-3);
  EXPECT_TRUE(tool.rig.ever_blamed.empty());
}

TEST(RecalibratingSuspect, TheAlarmRanksAboveTheTimeoutAndTheFitIsDiscarded) {
  MonitorConfig config;
  config.isolation_timeout = Drifted().rig.monitor.verdict().stations_on_record + 1;
  Drifted tool(config);
  tool.visit(1);
  ASSERT_EQ(tool.state(), HealthState::recalibrating);
  // Another gravity: what died under the old one lives again, and an alarm is an alarm.
  GravityReference other = tool.rig.setup.gravity;
  other.g_mps2 *= 1.00001;
  ASSERT_TRUE(tool.rig.monitor.set_gravity(other).has_value());
  tool.bias = {0.3, 0.0, 0.0, 0.0};
  for (int k = 0; k < 8 && tool.state() == HealthState::recalibrating; ++k) {
    tool.rig.stay(plumb_test::random_direction(tool.directions));
  }
  EXPECT_EQ(tool.rig.records.back().from, HealthState::recalibrating);
  EXPECT_EQ(tool.rig.records.back().event, HealthEvent::alarm) << "though the isolation timeout is over as well";
  EXPECT_EQ(tool.state(), HealthState::suspect);
  EXPECT_EQ(tool.rig.monitor.recalibration().store().size(), 0);
  EXPECT_TRUE(tool.calibration_untouched());
}

}  // namespace
}  // namespace recalibrating_suspect_test
