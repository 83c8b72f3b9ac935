// Property tests of a tool of seven accelerometers on a cone: plumb brings the cases and the laws.
#include <gtest/gtest.h>
#include <plumb/testing/monitor_laws.hpp>

namespace {

/// Seven axes, 54.7 deg from the tool's axis all round it; 0.2 mg0 of noise each.
plumb::SensorArray my_tool() {
  plumb::AxisList axes{};
  const int n = plumb::cone(axes, 7);
  return plumb::testing::array_of(axes, n, 2e-4 * plumb::kG0_mps2);
}

/// As it will be configured in the tool.
plumb::MonitorConfig my_configuration() {
  plumb::MonitorConfig config;
  config.alert_limit_rad = plumb::rad_from_deg(0.5);
  return config;
}

TEST(SevenOnACone, KeepsEveryLaw) { EXPECT_MONITOR_LAWS(my_tool(), my_configuration()); }

TEST(SevenOnACone, SurvivesTheFaultThatWeFearMost) {
  plumb::testing::Case feared;
  feared.array = my_tool();
  feared.config = my_configuration();
  plumb::scenario::Fault shock;  // 50 mg0 on a2, from the third station on
  shock.kind = plumb::scenario::FaultKind::bias_step;
  shock.sensor = 1;
  shock.clock = plumb::scenario::Clock::station;
  shock.onset = 3;
  shock.magnitude = 0.05 * plumb::kG0_mps2;
  feared.faults = {shock};
  const plumb::testing::LawResult law = plumb::testing::isolates_what_is_isolable(feared);
  EXPECT_TRUE(law.applies && law.holds) << law.reason << plumb::testing::toml_of(feared);
}

}  // namespace
