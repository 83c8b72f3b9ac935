// Requirements on the states, their record and what is published in them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>
#include <string>

#include "support/simulated_tool.hpp"

namespace requirements_state_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::Rig;

// Verifies: REQ-091
TEST(RequirementRank, EventsAreInTheOrderOfTheHandWrittenTable) {
  std::ifstream file(std::string(PLUMB_SOURCE_DIR) + "/model/state_table.txt");
  std::string line;
  int rank = 0;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string mode, bar, event;
    words >> mode >> bar >> event;
    if (mode != "nominal") continue;
    EXPECT_EQ(event, to_string(static_cast<HealthEvent>(rank)));
    ++rank;
  }
  EXPECT_EQ(rank, kEventCount - 1);
}

// Verifies: REQ-077
TEST(RequirementNoConsistentHypothesis, NoCellExcludesOrProvisionallyExcludesOrFails) {
  for (int m = 0; m < kModeCount; ++m) {
    const auto mode = static_cast<Mode>(m);
    const Cell& cell = cell_of(mode, HealthEvent::no_consistent_hypothesis);
    EXPECT_EQ(cell.actions & (Action::exclude | Action::exclude_provisionally | Action::mark_absent), 0)
        << to_string(mode);
    for (const SizeClass size : {SizeClass::critical, SizeClass::all_configured, SizeClass::reduced}) {
      TargetFacts facts;
      facts.size = size;
      EXPECT_EQ(resolve(mode, cell.target, facts) == Mode::failed, mode == Mode::failed) << to_string(mode);
    }
  }
}

// Negative: REQ-093
TEST(RequirementValidation, ASensorWhosePredictionNeverMovedIsNotValidated) {
  // Rolled about the axis of sensor 4, the other three move and it does not: stuck, it would look the same.
  Rig rig(plumb_test::tetrahedron());
  for (int k = 0; k < 24; ++k) {
    const Verdict& v = rig.stay(direction_at(40, 15.0 * k));
    EXPECT_EQ(v.state, HealthState::suspect);
    EXPECT_TRUE(v.qualifiers & Qualifier::not_yet_validated);
    EXPECT_EQ(v.validity, Validity::valid) << "the bound holds a fault of any one sensor, this one too";
    EXPECT_EQ(v.faults_covered, 1);
  }
}

// Negative: REQ-101
TEST(RequirementRecords, TheyChainWithoutHolesAndNothingChangesWithoutOne) {
  Rig rig(plumb_test::cone_array(7));
  Verdict before = rig.monitor.verdict();
  std::uint32_t sequence = 0;
  const auto play = [&](int blocks, double toolface) {
    for (int k = 0; k < blocks * rig.setup.config.window; ++k) {
      const Verdict v = rig.step(rig.sample(direction_at(40 + toolface / 6, toolface), kG0_mps2));
      const bool changed = v.state != before.state || v.in_service != before.in_service ||
                           v.provisionally_excluded != before.provisionally_excluded || v.excluded != before.excluded ||
                           v.absent != before.absent;
      EXPECT_EQ(changed, v.transition.sequence != 0);
      if (v.transition.sequence != 0) {
        EXPECT_EQ(v.transition.sequence, ++sequence);
        EXPECT_EQ(v.transition.from, before.state);
        EXPECT_EQ(v.transition.to, v.state);
        EXPECT_EQ(v.transition.time_s, v.time_s);
      }
      const SensorSet sets[] = {v.in_service, v.provisionally_excluded, v.excluded, v.absent};
      int members = 0;
      for (const SensorSet s : sets) members += s.size();
      EXPECT_EQ(members, 7) << "nobody stands in two sets";
      before = v;
    }
  };
  for (int k = 0; k < 6; ++k) play(1, 50.0 * k);
  rig.distort = [](int i, double r, int) { return i == 5 ? r + 0.3 : r; };
  for (int k = 0; k < 6; ++k) play(1, 50.0 * k);
  rig.distort = [](int i, double r, int) {
    if (i == 2) return std::numeric_limits<double>::quiet_NaN();
    return i == 5 ? r + 0.3 : i == 0 ? r - 0.4 : r;
  };
  for (int k = 0; k < 3; ++k) play(1, 25.0 + 50.0 * k);
  EXPECT_EQ(before.excluded, SensorSet::of(5));
  EXPECT_EQ(before.absent, SensorSet::of(2));
  EXPECT_TRUE((before.provisionally_excluded | before.in_service).has(0));
  EXPECT_GE(sequence, 4U) << "else the test shows nothing";
}

// Verifies: REQ-101
TEST(RequirementRecords, OnlyTheRecordOfAnExclusionHasAGrade) {
  Rig rig(plumb_test::cone_array(7));
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 5 ? r + 0.3 : r; };
  for (int k = 0; k < 8; ++k) rig.stay(direction_at(40 + 10 * k, 50.0 * k));
  int aside = 0, out = 0;
  for (const TransitionRecord& record : rig.records) {
    const bool provisionally_excluded = record.event == HealthEvent::provisional_exclusion,
               exclusion = record.event == HealthEvent::exclusion;
    EXPECT_EQ(record.grade, provisionally_excluded ? Grade::provisional
                            : exclusion            ? Grade::confirmed
                                                   : Grade::none)
        << to_string(record.event);
    if (provisionally_excluded || exclusion) {
      EXPECT_EQ(record.sensors, SensorSet::of(5));
    }
    aside += provisionally_excluded ? 1 : 0;
    out += exclusion ? 1 : 0;
  }
  EXPECT_EQ(aside, 1);
  EXPECT_EQ(out, 1);
}

// Negative: REQ-122
TEST(RequirementNoRedundancy, ATriadIsDegradedFromTheStartAndItsBoundHoldsTheMirrorVector) {
  AxisList axes{};
  Rig rig(plumb_test::make_array(axes, orthogonal_triad(axes), 2e-4 * kG0_mps2));
  const Verdict& v = rig.prove();
  EXPECT_EQ(v.state, HealthState::degraded_3_sensor);
  EXPECT_EQ(v.validity, Validity::degraded);
  EXPECT_TRUE(v.qualifiers & Qualifier::no_redundancy);
  EXPECT_TRUE(v.protection_available);
  EXPECT_GT(v.protection_level_calibrated_axes_rad, rad_from_deg(30.0))
      << "a fault of one may show the vector mirrored";
  EXPECT_TRUE(v.alert);
}

// Verifies: REQ-010
TEST(RequirementFrame, TurnsThePublishedVectorAndNoDecision) {
  Rig rig(plumb_test::tetrahedron());
  MonitorSetup turned = rig.setup;
  turned.output_frame = {0, 1, 0, -1, 0, 0, 0, 0, 1};
  auto twin = std::make_unique<HealthMonitor>();
  ASSERT_TRUE(twin->configure(turned).has_value());
  rig.distort = [](int i, double r, int k) { return i == 2 && k > 200 ? 0.0 : r; };
  for (int k = 0; k < 700; ++k) {
    const Sample s = rig.sample(direction_at(30 + k / 64, 60.0 * (k / 64)), kG0_mps2);
    const Verdict& v = rig.monitor.step(s);
    const Verdict& w = twin->step(s);
    ASSERT_EQ(v.state, w.state);
    ASSERT_EQ(v.statistic, w.statistic);
    ASSERT_EQ(v.in_service, w.in_service);
    ASSERT_EQ(v.protection_level_calibrated_axes_rad, w.protection_level_calibrated_axes_rad);
    EXPECT_EQ(w.gravity_mps2[0], v.gravity_mps2[1]);
    EXPECT_EQ(w.gravity_mps2[1], -v.gravity_mps2[0]);
    EXPECT_EQ(w.covariance[0], v.covariance[4]);
    EXPECT_EQ(w.covariance[1], -v.covariance[3]);
  }
  EXPECT_GT(std::fabs(rig.monitor.verdict().gravity_mps2[0]), 1.0) << "else the test shows nothing";
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(2));
}

// Verifies: REQ-010
TEST(RequirementFrame, TheVectorPointsDown) {
  Rig rig(plumb_test::tetrahedron());
  const Verdict& v = rig.stay({0, 0, 1});
  EXPECT_NEAR(v.gravity_mps2[2], kG0_mps2, 1e-2) << "z down hole, tool hanging: positive down";
}

// Verifies: REQ-147
TEST(RequirementGap, ALongerPauseStartsBlockAndWindowsAnew) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  for (int k = 0; k < 20; ++k) rig.step(rig.sample(direction_at(40, 30), kG0_mps2));
  double later = 5.1;
  for (int k = 1; k <= 32; ++k) {
    Sample s = rig.sample(direction_at(40, 30), kG0_mps2);
    s.time_s += later;
    const Verdict& v = rig.step(s);
    EXPECT_EQ(rig.monitor.mae().all_samples(), k);
    EXPECT_EQ(v.tick, k == 32) << k;
    EXPECT_NE(v.state, HealthState::failed);
  }
}

// Negative: REQ-147
TEST(RequirementGap, AShorterPauseDoesNot) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  for (int k = 0; k < 20; ++k) rig.step(rig.sample(direction_at(40, 30), kG0_mps2));
  for (int k = 21; k <= 32; ++k) {
    Sample s = rig.sample(direction_at(40, 30), kG0_mps2);
    s.time_s += 4.9;
    EXPECT_EQ(rig.step(s).tick, k == 32) << k;
  }
  EXPECT_EQ(rig.monitor.mae().all_samples(), 32);
}

// Negative: REQ-144
TEST(RequirementStuck, AToolAtRestRepeatsItsCodesAndNoSensorIsExcluded) {
  Rig rig(plumb_test::cone_array(5));
  rig.prove();
  const SensorArray array = rig.setup.array;
  rig.distort = [array](int i, double, int) {
    return std::round(dot(array.axis(i), direction_at(40, 30)) * kG0_mps2 * 1e4) * 1e-4;
  };
  for (int k = 0; k < 100; ++k) {
    const Verdict& v = rig.stay(direction_at(40, 30));
    EXPECT_EQ(v.state, HealthState::nominal);
    EXPECT_TRUE(rig.ever_blamed.empty());
  }
}

// Negative: REQ-162
TEST(RequirementReplay, AnotherSampleGivesAnotherVerdict) {
  // The law of exact replay compares these fields: they do tell two runs apart.
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  auto twin = std::make_unique<HealthMonitor>(rig.monitor);
  for (int k = 0; k < 32; ++k) {
    Sample s = rig.sample(direction_at(50, 30), kG0_mps2);
    const Verdict v = rig.monitor.step(s);
    if (k == 5) s.raw[1] += 1e-9;
    const Verdict& w = twin->step(s);
    if (k < 31) continue;
    EXPECT_NE(std::memcmp(&v.gravity_mps2, &w.gravity_mps2, sizeof(Vec3)), 0);
    EXPECT_NE(v.statistic, w.statistic);
  }
}

// Verifies: REQ-120
TEST(RequirementAge, JustBelowTAgeTheOutputIsStillValid) {
  MonitorConfig config;
  config.max_age_s = 2.0;
  Rig rig(plumb_test::tetrahedron(), config);
  rig.prove();
  Sample sample = rig.sample(direction_at(100, 340), kG0_mps2);
  const double last_block_s = sample.time_s - 0.01;
  for (const double age_s : {0.8, 1.6, 1.99, 2.01, 2.8}) {
    sample.time_s = last_block_s + age_s;
    EXPECT_EQ(rig.monitor.step(sample).validity, age_s < 2.0 ? Validity::valid : Validity::held) << age_s;
    EXPECT_EQ(rig.monitor.verdict().alert, age_s > 2.0) << age_s;
  }
}

/// A request is served once, or not at all: what fails later needs a key of its own.
// Negative: REQ-095
TEST(RequirementReset, OneRequestLeavesFailedOnce) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  ASSERT_TRUE(rig.monitor.reset(rig.setup.config.reset_key, SensorSet::first(4)).has_value());
  EXPECT_EQ(rig.stay(direction_at(60, 10)).state, HealthState::nominal) << "nothing to leave";
  const auto break_down = [&] {
    rig.distort = [](int i, double r, int) { return i <= 1 ? std::numeric_limits<double>::infinity() : r; };
    rig.stay(direction_at(60, 10));
    rig.distort = [](int, double r, int) { return r; };
    return rig.stay(direction_at(60, 10)).state;
  };
  EXPECT_EQ(break_down(), HealthState::failed) << "the request from before the failure is spent";
  ASSERT_TRUE(rig.monitor.reset(rig.setup.config.reset_key, SensorSet::first(4)).has_value());
  EXPECT_EQ(rig.stay(direction_at(60, 10)).state, HealthState::suspect);
  EXPECT_EQ(break_down(), HealthState::failed) << "and so is this one";
}

}  // namespace
}  // namespace requirements_state_test
