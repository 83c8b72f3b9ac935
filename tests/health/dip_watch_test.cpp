// The dip beside a monitor that has three sensors left: what it sees that the monitor cannot, and what it leaves alone.
#include "plumb/health/dip_watch.hpp"

#include <gtest/gtest.h>

#include <type_traits>

#include "plumb/core/detail/archive.hpp"
#include "support/three_left.hpp"

// Serves: REQ-222

namespace dip_watch_test {
namespace {

using namespace plumb;
using namespace three_left;

// Verifies: REQ-222
TEST(DipWatch, ThreeHealthySensorsHaveABoundThatIsNoMirror) {
  ThreeLeft tool;
  DipWatch watch;
  const Vec3 down = direction_at(40, 70);
  const DipReport r = tool.report(watch, down);
  const Verdict& v = tool.rig.monitor.verdict();
  ASSERT_EQ(v.in_service.size(), 3);
  ASSERT_GT(v.protection_level_calibrated_axes_rad, rad_from_deg(20.0));
  EXPECT_EQ(r.answer.verdict, DipVerdict::consistent);
  EXPECT_TRUE(r.protected_by_dip);
  EXPECT_LT(r.protection_level_calibrated_axes_rad, rad_from_deg(8.0));
  EXPECT_EQ(r.gravity_mps2, v.gravity_mps2);
  EXPECT_LT(angle_between_rad(r.gravity_mps2, down), r.protection_level_calibrated_axes_rad);
}

// Verifies: REQ-221
TEST(DipWatch, AMirrorFaultThatTheMonitorCannotSeeIsSeenAndNamed) {
  ThreeLeft tool;
  DipWatch watch;
  const Vec3 down = direction_at(40, 70);
  tool.f_mps2 = tool.mirror_mps2(down);
  ASSERT_GT(std::fabs(tool.f_mps2), 1.0);
  const DipReport r = tool.report(watch, down, 3);
  const Verdict& v = tool.rig.monitor.verdict();
  EXPECT_LT(std::fabs(v.norm_error_mps2), 0.01);
  EXPECT_NE(v.state, HealthState::suspect);
  EXPECT_GT(angle_between_rad(v.gravity_mps2, down), rad_from_deg(10.0));
  EXPECT_EQ(r.answer.verdict, DipVerdict::fault);
  EXPECT_EQ(r.answer.named, 1);
  ASSERT_TRUE(r.protected_by_dip);
  EXPECT_LT(angle_between_rad(r.gravity_mps2, down), r.protection_level_calibrated_axes_rad);
  EXPECT_LT(r.protection_level_calibrated_axes_rad, rad_from_deg(8.0));
}

/// A bias that the length shows leaves the monitor suspect and without an answer; the dip has one.
// Verifies: REQ-221
TEST(DipWatch, UnderSuspicionTheSensorIsNamedToo) {
  ThreeLeft tool;
  DipWatch watch;
  const Vec3 down = direction_at(40, 70);
  tool.f_mps2 = 0.25 * kG0_mps2;
  const DipReport r = tool.report(watch, down, 3);
  EXPECT_EQ(tool.rig.monitor.verdict().state, HealthState::suspect);
  EXPECT_EQ(r.answer.verdict, DipVerdict::fault);
  EXPECT_EQ(r.answer.named, 1);
  EXPECT_LT(angle_between_rad(r.gravity_mps2, down), r.protection_level_calibrated_axes_rad);
}

// Negative: REQ-222
TEST(DipWatch, WithoutABlockOfThreeAtRestTheLevelStaysTheMonitors) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  DipWatch watch;
  const Vec3 down = direction_at(40, 70);
  rig.stay(down, 2);
  const DipReport four = watch.add(rig.monitor, rig.setup, field_at(down), reference());
  EXPECT_EQ(four.answer.verdict, DipVerdict::not_judged);
  EXPECT_EQ(four.answer.refusal, DipRefusal::too_few_sensors);
  EXPECT_FALSE(four.protected_by_dip);
  EXPECT_EQ(four.protection_level_calibrated_axes_rad, rig.monitor.verdict().protection_level_calibrated_axes_rad);

  ThreeLeft tool;
  tool.report(watch, down);
  tool.rig.step(tool.rig.sample(down, kG0_mps2));  // within a block
  const DipReport between = watch.add(tool.rig.monitor, tool.rig.setup, field_at(down), reference());
  EXPECT_EQ(between.answer.verdict, DipVerdict::not_judged);
  EXPECT_EQ(watch.evidence().stations(), 1);
  tool.rig.stay(down, 1);
  tool.rig.shake(down, 0.3);
  const DipReport moving = watch.add(tool.rig.monitor, tool.rig.setup, field_at(down), reference());
  EXPECT_EQ(moving.answer.verdict, DipVerdict::not_judged);
}

/// What the field's length refuses leaves the verdict's level, and the evidence, as they were.
// Negative: REQ-223
TEST(DipWatch, ADisturbedFieldChangesNothing) {
  ThreeLeft tool;
  DipWatch watch;
  const Vec3 down = direction_at(40, 70);
  tool.report(watch, down);
  tool.rig.stay(down, 1);
  FieldReading disturbed = field_at(down);
  disturbed.field_nt = scaled(disturbed.field_nt, 1.05);
  const DipReport r = watch.add(tool.rig.monitor, tool.rig.setup, disturbed, reference());
  EXPECT_EQ(r.answer.refusal, DipRefusal::field_length);
  EXPECT_FALSE(r.protected_by_dip);
  EXPECT_EQ(r.protection_level_calibrated_axes_rad, tool.rig.monitor.verdict().protection_level_calibrated_axes_rad);
  EXPECT_EQ(watch.evidence().stations(), 1);
  const DipReport undisturbed = watch.add(tool.rig.monitor, tool.rig.setup, field_at(down), reference());
  EXPECT_TRUE(undisturbed.protected_by_dip);
}

TEST(DipWatch, TheStationIsThatOfTheMonitorAndItsFrame) {
  ThreeLeft tool;
  const Vec3 down = direction_at(40, 70);
  tool.rig.stay(down, 2);
  const DipStation s = dip_station(tool.rig.monitor, tool.rig.setup, field_at(down), reference());
  EXPECT_EQ(s.used, tool.rig.monitor.verdict().in_service);
  for (int i = 1; i < 4; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(s.mean_mps2[k], dot(tool.rig.setup.array.axis(i), down) * kG0_mps2, 1e-3) << i;
    EXPECT_NEAR(s.sigma_mps2[k], 2e-4 * kG0_mps2 / std::sqrt(32.0), 2e-5) << i;
    EXPECT_EQ(s.bound_mps2[k], 0.0) << i;
  }
  EXPECT_EQ(s.gravity.sigma_mps2, tool.rig.monitor.verdict().reference_sigma_mps2);
  // Stated stability, age and code are bounds; an output frame turns what is published, not what is judged.
  MonitorSetup stated = tool.rig.setup;
  stated.stability.fill({1e-3, 1e-4, 0.0, 0.0});
  stated.days_since_calibration = 10.0;
  stated.resolution_raw.fill(2e-3);
  const DipStation wider = dip_station(tool.rig.monitor, stated, field_at(down), reference());
  EXPECT_NEAR(wider.bound_mps2[1], 4.0 * 2e-3 + 1e-3, 1e-6);
}

/// Noise as the monitor has learned it, what calibration left, gravity where the tool was calibrated.
TEST(DipWatch, TheErrorsAreThoseOfTheMonitor) {
  ThreeLeft tool(
      [](MonitorSetup& setup) {
        RowUncertainty left;
        left.common_scale = 1e-4;
        for (std::size_t k : {3U, 7U, 11U, 15U}) left.covariance[k * (k + 1) / 2 + k] = 1e-3 * 1e-3;
        setup.array.set_uncertainty(left);
      },
      2e-3, 0.95);
  for (int k = 0; k < 10; ++k) tool.rig.stay(direction_at(40, 70));
  const Verdict& v = tool.rig.monitor.verdict();
  ASSERT_GT(v.noise_factor, 1.2);
  ASSERT_GT(v.noise_correlation, 1.5);
  const DipStation s = dip_station(tool.rig.monitor, tool.rig.setup, field_at(direction_at(40, 70)), reference());
  const double noise = 2e-4 * kG0_mps2 * v.noise_factor * std::sqrt(v.noise_correlation / 32.0);
  EXPECT_NEAR(s.sigma_mps2[1], std::hypot(noise, 1e-3), 1e-9);
  EXPECT_NEAR(s.gravity.sigma_mps2, v.reference_sigma_mps2 + 1e-4 * v.reference_mps2, 1e-12);
}

/// The level is that of the housing where the turn of the axes in it is stated, and never larger than the verdict's.
TEST(DipWatch, TheLevelAddsTheTurnOfTheAxesAndNeverGrows) {
  ThreeLeft tool([](MonitorSetup& setup) { setup.config.alignment_bound_rad = 0.004F; });
  DipWatch watch;
  const Vec3 down = direction_at(40, 70);
  const DipReport r = tool.report(watch, down);
  ASSERT_TRUE(r.protected_by_dip);
  EXPECT_NEAR(r.protection_level_housing_rad - r.protection_level_calibrated_axes_rad, 0.004, 1e-6);
  for (const double dip_error_rad : {0.1, 0.5, 1.0, 3.2}) {
    FieldReference vague = reference();
    vague.dip_error_rad.bound = dip_error_rad;
    DipWatch other;
    const Verdict& v = tool.rig.stay(down, 1);
    const DipReport wide = other.add(tool.rig.monitor, tool.rig.setup, field_at(down), vague);
    ASSERT_TRUE(v.protection_available);
    EXPECT_LE(wide.protection_level_calibrated_axes_rad, v.protection_level_calibrated_axes_rad) << dip_error_rad;
    EXPECT_EQ(wide.protected_by_dip, wide.answer.bound_rad < v.protection_level_calibrated_axes_rad) << dip_error_rad;
  }
}

/// A host that states more drift than the monitor knows gets no level that is larger than the monitor's.
// Negative: REQ-222
TEST(DipWatch, ALargerBoundDoesNotTakeThePlaceOfTheLevel) {
  ThreeLeft tool;
  DipWatch watch;
  const Vec3 down = direction_at(40, 70);
  tool.rig.stay(down, 2);
  MonitorSetup vague = tool.rig.setup;
  vague.stability.fill({0.4, 0.0, 0.0, 0.0});
  FieldReference unknown = reference();
  unknown.dip_error_rad.bound = kPi;
  const DipReport r = watch.add(tool.rig.monitor, vague, field_at(down), unknown);
  const Verdict& v = tool.rig.monitor.verdict();
  ASSERT_GT(r.answer.bound_rad, v.protection_level_calibrated_axes_rad);
  EXPECT_FALSE(r.protected_by_dip);
  EXPECT_EQ(r.protection_level_calibrated_axes_rad, v.protection_level_calibrated_axes_rad);
}

/// One fault is all that the dip's bound is for.
// Negative: REQ-222
TEST(DipWatch, WhereTwoMayBeFaultyOrTheMonitorHasFailedTheLevelStaysTheMonitors) {
  ThreeLeft likely([](MonitorSetup& setup) { setup.config.fault_prior = 0.01; });
  DipWatch watch;
  const Vec3 down = direction_at(40, 70);
  const DipReport r = likely.report(watch, down);
  EXPECT_FALSE(likely.rig.monitor.verdict().protection_available);
  EXPECT_EQ(r.answer.verdict, DipVerdict::consistent);
  EXPECT_FALSE(r.protected_by_dip);
  EXPECT_EQ(r.protection_level_calibrated_axes_rad, kPi);

  ThreeLeft failing;
  failing.f_mps2 = 0.25 * kG0_mps2;
  DipWatch other;
  DipReport last;
  for (int k = 0; k < 40 && failing.rig.monitor.verdict().state != HealthState::failed; ++k)
    last = failing.report(other, direction_at(10.0 + 25.0 * (k % 6), 50.0 * k), 2);
  ASSERT_EQ(failing.rig.monitor.verdict().state, HealthState::failed);
  EXPECT_FALSE(last.protected_by_dip);
}

/// Of a tool that turns slowly three sensors give no block at rest: nothing is judged.
TEST(DipWatch, ASlowTurnIsNoStation) {
  ThreeLeft tool;
  DipWatch watch;
  int judged = 0;
  for (int k = 0; k < 20 * 32; ++k) {
    const Vec3 down = direction_at(40.0 + 0.01 * k, 70);
    tool.rig.step(tool.rig.sample(down, kG0_mps2));
    const DipReport r = watch.add(tool.rig.monitor, tool.rig.setup, field_at(down), reference());
    if (r.answer.verdict != DipVerdict::not_judged) ++judged;
  }
  EXPECT_LE(judged, 1);  // the block that begins at rest
}

TEST(DipWatch, AnOutputFrameTurnsWhatIsPublished) {
  Rig rig(plumb_test::tetrahedron());
  rig.setup.output_frame = {0, 1, 0, 0, 0, 1, 1, 0, 0};
  rig.restart();
  rig.prove();
  rig.distort = [](int i, double reading, int) { return i == 0 ? std::nan("") : reading; };
  rig.stay(direction_at(30, 40));
  rig.stay(direction_at(70, 140));
  const Vec3 down = direction_at(40, 70);
  rig.stay(down, 2);
  DipWatch watch(DipAssumption::constant_bias);
  const DipReport r = watch.add(rig.monitor, rig.setup, field_at(down), reference());
  EXPECT_EQ(r.answer.verdict, DipVerdict::consistent);
  EXPECT_LT(angle_between_rad(r.answer.gravity_mps2, down), rad_from_deg(0.1));
  EXPECT_LT(angle_between_rad(r.gravity_mps2, times(rig.setup.output_frame, down)), rad_from_deg(0.1));
  EXPECT_TRUE(std::is_trivially_copyable_v<DipWatch>);
}

TEST(DipWatch, BeginsAnewWhereOtherSensorsServeAndIsWrittenWithItsMonitor) {
  DipWatch watch;
  const Vec3 down = direction_at(40, 70);
  {
    ThreeLeft tool;
    tool.report(watch, down);
    tool.report(watch, direction_at(60, 10));
    EXPECT_EQ(watch.evidence().stations(), 2);
    std::array<std::uint8_t, 1000> bytes{};
    ArchiveWriter out(bytes.data(), bytes.size(), 4);
    out.put(watch);
    DipWatch back;
    ArchiveReader in(bytes.data(), out.used(), 4);
    in.get(back);
    EXPECT_TRUE(in.sound());
    EXPECT_EQ(back.evidence().stations(), 2);
    watch.forget();
    EXPECT_EQ(watch.evidence().stations(), 0);
    watch = back;
  }
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double reading, int) { return i == 3 ? std::nan("") : reading; };
  rig.stay(direction_at(30, 40));
  rig.stay(down, 2);
  const DipReport r = watch.add(rig.monitor, rig.setup, field_at(down), reference());
  EXPECT_NE(r.answer.verdict, DipVerdict::not_judged);
  EXPECT_EQ(watch.evidence().stations(), 1);
}

}  // namespace
}  // namespace dip_watch_test
