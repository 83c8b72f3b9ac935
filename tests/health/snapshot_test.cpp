// The snapshot, case by case: what comes back, and what every kind of wrong bytes is called.
#include "plumb/health/snapshot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>

#include "plumb/core/version.hpp"
#include "snapshot_support.hpp"

namespace health_snapshot_test {
namespace {

using namespace plumb;
using plumb_test::bits_of;
using plumb_test::Bytes;
using plumb_test::cone_array;
using plumb_test::direction_at;
using plumb_test::Rig;
using plumb_test::seal;
using plumb_test::snapshot_of;
using plumb_test::Tool;

/// A monitor that has excluded a sensor.
struct Isolated {
  Isolated() : rig(cone_array(6)) {
    rig.prove();
    rig.distort = [](int i, double r, int) { return i == 2 ? r + 0.5 : r; };
    for (int k = 0; k < 8; ++k) rig.stay(direction_at(20.0 + 18.0 * k, 75.0 * k));
    EXPECT_EQ(rig.monitor.verdict().state, HealthState::isolated);
    EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(2));
  }
  Expected<void> restore(const Bytes& bytes) { return after.restore(rig.setup, bytes.data(), bytes.size()); }

  Rig rig;
  HealthMonitor after;
};

// Verifies: REQ-163
TEST(Snapshot, AnExclusionOutlivesThePowerCycle) {
  Isolated tool;
  ASSERT_TRUE(tool.restore(snapshot_of(tool.rig.monitor)).has_value());
  EXPECT_EQ(bits_of(tool.after.verdict()), bits_of(tool.rig.monitor.verdict()));
  EXPECT_EQ(tool.after.verdict().excluded, SensorSet::of(2));
  EXPECT_EQ(tool.after.verdict().snapshot_refusal, Errc::ok);
}

/// Goes on from a snapshot beside the monitor that wrote it; how many verdicts differ.
int differences_after(Rig& rig, int samples) {
  const Bytes bytes = snapshot_of(rig.monitor);
  auto twin = std::make_unique<HealthMonitor>();
  EXPECT_TRUE(twin->restore(rig.setup, bytes.data(), bytes.size()).has_value());
  int differences = 0;
  for (int k = 0; k < samples; ++k) {
    const Sample sample = rig.sample(direction_at(45, 200), kG0_mps2);
    const Verdict& v = twin->step(sample);
    differences += bits_of(v) == bits_of(rig.step(sample)) ? 0 : 1;
  }
  return differences;
}

/// A channel is lost at the very sample that ends a block in alarm: the alarm waits for the next step, which comes
/// after the power cycle.
// Verifies: REQ-163
TEST(Snapshot, AnAlarmThatWaitsIsNotForgotten) {
  Rig rig(cone_array(6));
  rig.prove();
  int left = 32;
  rig.distort = [&left](int i, double r, int) {
    if (i == 0 && left > 3) return std::numeric_limits<double>::quiet_NaN();
    return i == 2 ? r + 0.3 : r;
  };
  for (; left > 0; --left) rig.step(rig.sample(direction_at(45, 200), kG0_mps2));
  ASSERT_EQ(rig.monitor.verdict().transition.event, HealthEvent::channel_back);
  EXPECT_EQ(differences_after(rig, 1), 0);
  EXPECT_EQ(rig.monitor.verdict().transition.event, HealthEvent::alarm);
  EXPECT_EQ(differences_after(rig, 100), 0);
}

/// The host's word at the same sample goes first; what the attitudes have told of gravity is said at the next.
// Verifies: REQ-163
TEST(Snapshot, ANoticeThatWaitsIsNotForgotten) {
  Rig rig(cone_array(6));
  rig.prove();
  auto before = std::make_unique<HealthMonitor>();
  for (int k = 0; k < 14 * 32; ++k) {
    const Vec3 u = direction_at(10.0 + 11.0 * (k / 32), 67.0 * (k / 32));
    const Sample sample = rig.sample(u, 1.005 * kG0_mps2);
    *before = rig.monitor;
    if (rig.step(sample).transition.cause != Cause::common_scale) continue;
    rig.monitor = *before;
    rig.monitor.inhibit(true);
    ASSERT_EQ(rig.step(sample).transition.cause, Cause::inhibited);
    EXPECT_EQ(differences_after(rig, 1), 0);
    EXPECT_EQ(rig.monitor.verdict().transition.cause, Cause::common_scale);
    return;
  }
  FAIL() << "gravity was never told";
}

/// The clock of an instrument starts anew: the history stays, the last vector is not published as of today.
// Verifies: REQ-163
TEST(Snapshot, ANewTimeBaseKeepsTheHistoryAndWaitsForANewBlock) {
  Isolated tool;
  ASSERT_TRUE(tool.restore(snapshot_of(tool.rig.monitor)).has_value());
  for (int k = 0; k < 200; ++k) {
    Sample sample = tool.rig.sample(direction_at(50, 50), kG0_mps2);
    sample.time_s = 0.01 * (k + 1);
    const Verdict& v = tool.after.step(sample);
    EXPECT_EQ(v.excluded, SensorSet::of(2));
    if (k < kNewTimeBase - 1) {
      EXPECT_EQ(v.validity, Validity::held) << k;
    }
    if (v.validity == Validity::valid) {
      EXPECT_LT(v.age_s, 1.0);
      EXPECT_LT(angle_between_rad(v.gravity_mps2, direction_at(50, 50)), 0.01);
    }
  }
  EXPECT_EQ(tool.after.verdict().validity, Validity::valid);
}

// Verifies: REQ-163
TEST(Snapshot, FailedIsLatchedThroughThePowerCycle) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  for (int k = 0; k < 50; ++k) {
    Sample sample = rig.sample(direction_at(40, 10), kG0_mps2);
    sample.delivered = SensorSet(1);
    rig.step(sample);
  }
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::failed);
  const Bytes bytes = snapshot_of(rig.monitor);
  HealthMonitor after;
  ASSERT_TRUE(after.restore(rig.setup, bytes.data(), bytes.size()).has_value());
  for (int k = 0; k < 500; ++k)
    EXPECT_EQ(after.step(rig.sample(direction_at(40, 10), kG0_mps2)).state, HealthState::failed);
  ASSERT_TRUE(after.reset(rig.setup.config.reset_key, after.array().all()).has_value());
  EXPECT_NE(after.step(rig.sample(direction_at(40, 10), kG0_mps2)).state, HealthState::failed);
}

/// In the middle of a fit, and in every step of it: the calibration that comes of it is the same.
// Verifies: REQ-163
TEST(Snapshot, AFitGoesOnWhereItWas) {
  Tool tool(6, {}, 5);
  tool.drift(2e-3);
  tool.begin();
  HealthMonitor twin;
  int in_fit = 0;
  for (int k = 0; k < 40 && tool.count(HealthEvent::fit_accepted) == 0; ++k) {
    const Vec3 u = plumb_test::random_direction(tool.directions);
    for (int s = 0; s < 64; ++s) {
      const Bytes bytes = snapshot_of(tool.rig.monitor);
      const Expected<void> taken = twin.restore(tool.rig.setup, bytes.data(), bytes.size());
      ASSERT_TRUE(taken.has_value());
      const Sample sample = tool.rig.sample(u, kG0_mps2);
      const Verdict& v = tool.rig.step(sample);
      ASSERT_EQ(bits_of(v), bits_of(twin.step(sample)));
      if (v.recalibration.phase == RecalibrationPhase::fitting) ++in_fit;
    }
  }
  EXPECT_GE(in_fit, 3);
  ASSERT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  EXPECT_TRUE(plumb_test::same_model(tool.rig.monitor.model(), twin.model()));
  EXPECT_EQ(tool.rig.monitor.array().uncertainty().covariance, twin.array().uncertainty().covariance);
  // What was adopted outlives the power cycle, too.
  const Bytes bytes = snapshot_of(twin);
  HealthMonitor after;
  ASSERT_TRUE(after.restore(tool.rig.setup, bytes.data(), bytes.size()).has_value());
  EXPECT_TRUE(plumb_test::same_model(after.model(), twin.model()));
}

/// Gravity is no part of the identity; that of the snapshot is in force.
// Verifies: REQ-163
TEST(Snapshot, IsTakenUpAtAnotherDepth) {
  Isolated tool;
  MonitorSetup elsewhere = tool.rig.setup;
  elsewhere.gravity.g_mps2 += 0.01;
  const Bytes bytes = snapshot_of(tool.rig.monitor);
  ASSERT_TRUE(tool.after.restore(elsewhere, bytes.data(), bytes.size()).has_value());
  EXPECT_EQ(snapshot_of(tool.after), bytes);
}

void expect_refused(Isolated& tool, const Bytes& bytes, Errc cause) {
  const Expected<void> taken = tool.restore(bytes);
  ASSERT_FALSE(taken.has_value());
  EXPECT_EQ(taken.error().code, cause) << describe(taken.error().code);
  const Verdict& v = tool.after.verdict();
  EXPECT_EQ(v.snapshot_refusal, cause);
  EXPECT_EQ(v.cause, Cause::snapshot_refused);
  EXPECT_EQ(v.state, HealthState::suspect);
  EXPECT_NE(v.qualifiers & Qualifier::not_yet_validated, 0);
  EXPECT_TRUE(v.excluded.empty());
  // It goes on as any monitor that was just switched on, and keeps the reason in its verdict.
  const Verdict& next = tool.after.step(tool.rig.sample(direction_at(50, 50), kG0_mps2));
  EXPECT_TRUE(next.accepted);
  EXPECT_EQ(next.snapshot_refusal, cause);
}

// Negative: REQ-163
TEST(Snapshot, EveryKindOfWrongBytesHasItsName) {
  Isolated tool;
  const Bytes good = snapshot_of(tool.rig.monitor);
  const auto altered = [&good](std::size_t at, std::uint8_t byte) {
    Bytes bytes = good;
    bytes[at] = byte;
    seal(bytes);
    return bytes;
  };
  expect_refused(tool, {}, Errc::snapshot_truncated);
  expect_refused(tool, Bytes(good.begin(), good.end() - 1), Errc::snapshot_truncated);
  expect_refused(tool, Bytes(5000, 0), Errc::snapshot_damaged);
  expect_refused(tool, altered(0, 'P'), Errc::snapshot_damaged);
  expect_refused(tool, altered(8, 0), Errc::snapshot_older);
  expect_refused(tool, altered(8, kSnapshotFormat + 1), Errc::snapshot_newer);
  expect_refused(tool, altered(10, 4), Errc::snapshot_capacity);
  expect_refused(tool, altered(16, static_cast<std::uint8_t>(good[16] ^ 1U)), Errc::snapshot_foreign);
  Bytes longer = good;
  longer.insert(longer.end() - 8, 0);
  seal(longer);
  expect_refused(tool, longer, Errc::snapshot_implausible);
  EXPECT_FALSE(tool.after.restore(tool.rig.setup, nullptr, 5000).has_value());
  EXPECT_TRUE(tool.restore(good).has_value());
}

/// A version that only differs in the library is told, not judged.
// Serves: REQ-163
TEST(Snapshot, StatesWhatWroteIt) {
  Isolated tool;
  Bytes bytes = snapshot_of(tool.rig.monitor);
  const Expected<SnapshotHeader> header = snapshot_header(bytes.data(), bytes.size());
  ASSERT_TRUE(header.has_value());
  EXPECT_EQ(header->format, kSnapshotFormat);
  EXPECT_EQ(header->capacity, kCapacity);
  EXPECT_EQ(header->plumb_version, kLibraryVersion);
  EXPECT_EQ(header->size, bytes.size());
  bytes[12] = 0x77;
  seal(bytes);
  EXPECT_TRUE(tool.restore(bytes).has_value());
  bytes.resize(bytes.size() + 100, 0xFF);  // the rest of an erased page
  EXPECT_TRUE(tool.restore(bytes).has_value());
}

/// All but gravity makes it another monitor.
// Negative: REQ-163
TEST(Snapshot, IsBoundToEverySetting) {
  Isolated tool;
  const Bytes bytes = snapshot_of(tool.rig.monitor);
  const auto refused = [&](const std::function<void(MonitorSetup&)>& change) {
    MonitorSetup setup = tool.rig.setup;
    change(setup);
    const Expected<void> taken = tool.after.restore(setup, bytes.data(), bytes.size());
    return !taken && taken.error().code == Errc::snapshot_foreign;
  };
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.config.window = 16; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.config.false_alarm_rate *= 1.01; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.config.reset_key ^= 1U; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.config.recalibrate_after_exclusion = true; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.stability[2].mps2 = 1e-3; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.config.isolation_timeout_blocks = 100; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.stability[2].per_degc_mps2 = 1e-5; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.lever_arm_m[5][1] = 0.01; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.lever_arms_known = true; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.model.reads = Reads::specific_force; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.model.sensor[3].scale[0] = 1.0 + 1e-15; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.model.sensor[3].bias[2] = 1e-9; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.model.sensor[3].reference_degc = 20.0; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.full_scale_raw[1] = 50.0; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.output_frame = {0, 1, 0, 1, 0, 0, 0, 0, -1}; }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { plumb_test::leave_uncertainty(s.array); }));
  EXPECT_TRUE(refused([](MonitorSetup& s) { s.array = cone_array(6, 3e-4 * kG0_mps2); }));
  EXPECT_TRUE(refused([](MonitorSetup& s) {
    s.array = cone_array(7);
    s.model.size = 7;
  }));
  EXPECT_TRUE(refused([](MonitorSetup& s) {
    std::array<SensorRow, 6> rows;
    for (int i = 0; i < 6; ++i) rows[static_cast<std::size_t>(i)] = s.array.row(i);
    rows[4].id = make_id("other");
    s.array = *SensorArray::make(rows.data(), 6);
  }));
  EXPECT_FALSE(refused([](MonitorSetup&) {}));
}

/// Intact bytes that would make a bad calibration look like the commissioned one.
// Negative: REQ-163
TEST(Snapshot, AScaleFactorThatWasNotFittedIsRefused) {
  Isolated tool;
  const Bytes good = snapshot_of(tool.rig.monitor);
  Bytes bytes = good;
  ASSERT_EQ(bytes[kSnapshotHeaderSize + 6], 0xF0);  // 1.0, the first scale factor
  bytes[kSnapshotHeaderSize + 5] = 1;
  seal(bytes);
  expect_refused(tool, bytes, Errc::snapshot_implausible);
}

/// A published variance below zero, with a check sum that is right: found by the fuzzer of `fuzz/snapshot_restore.cpp`.
// Negative: REQ-163
TEST(Snapshot, AVarianceBelowZeroIsRefused) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  const double variance = rig.monitor.verdict().covariance[4];
  ASSERT_GT(variance, 0.0);
  Bytes bytes = snapshot_of(rig.monitor);
  const auto* first = reinterpret_cast<const std::uint8_t*>(&variance);
  const auto at = std::search(bytes.begin(), bytes.end(), first, first + sizeof variance);
  ASSERT_NE(at, bytes.end());
  at[7] = static_cast<std::uint8_t>(at[7] ^ 0x80U);  // little-endian: its sign
  plumb_test::seal(bytes);
  const Expected<void> taken = rig.monitor.restore(rig.setup, bytes.data(), bytes.size());
  ASSERT_FALSE(taken.has_value());
  EXPECT_EQ(taken.error().code, Errc::snapshot_implausible);
}

/// What a block has added up, beyond anything that readings can add up to, with a check sum that is right: its
/// covariance overflowed into a verdict that was usable and not finite. Found by the same fuzzer.
// Negative: REQ-163
TEST(Snapshot, ASumThatNoReadingsMakeIsRefused) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  const Sample first_of_block = rig.sample(direction_at(20, 10), kG0_mps2);
  rig.step(first_of_block);
  rig.step(rig.sample(direction_at(20, 10), kG0_mps2));
  const Bytes good = snapshot_of(rig.monitor);
  // The origins of four sensors, then their sums, then the six and four sums of products.
  const auto* origin = reinterpret_cast<const std::uint8_t*>(first_of_block.raw.data());
  constexpr std::ptrdiff_t kOrigins = 4 * sizeof(double);
  const auto at = std::search(good.begin(), good.end(), origin, origin + kOrigins) - good.begin();
  ASSERT_LT(at + 18 * 8, static_cast<std::ptrdiff_t>(good.size()));
  EXPECT_TRUE(rig.monitor.restore(rig.setup, good.data(), good.size()).has_value());
  for (const std::ptrdiff_t place : {0, 3, 4, 7, 8, 17}) {
    for (const double absurd : {1e200, -1e200, std::numeric_limits<double>::quiet_NaN()}) {
      Bytes bytes = good;
      const auto* value = reinterpret_cast<const std::uint8_t*>(&absurd);
      std::copy(value, value + sizeof absurd, bytes.begin() + at + 8 * place);
      seal(bytes);
      const Expected<void> taken = rig.monitor.restore(rig.setup, bytes.data(), bytes.size());
      ASSERT_FALSE(taken.has_value()) << "double " << place << " = " << absurd;
      EXPECT_EQ(taken.error().code, Errc::snapshot_implausible);
    }
  }
}

// Serves: REQ-163
TEST(Snapshot, NeedsAConfiguredMonitorAndRoom) {
  HealthMonitor none;
  Bytes bytes(HealthMonitor::snapshot_size_max());
  const Expected<std::size_t> nothing = none.snapshot(bytes.data(), bytes.size());
  ASSERT_FALSE(nothing.has_value());
  EXPECT_EQ(nothing.error().code, Errc::not_calibrated);
  Rig rig(plumb_test::tetrahedron());
  const Expected<std::size_t> written = rig.monitor.snapshot(bytes.data(), rig.monitor.snapshot_size() - 1);
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().code, Errc::buffer_too_small);
  EXPECT_EQ(written.error().limit, static_cast<double>(rig.monitor.snapshot_size()));
  EXPECT_EQ(bytes, Bytes(bytes.size(), 0)) << "nothing was written";
  EXPECT_FALSE(rig.monitor.snapshot(nullptr, 1U << 20U).has_value());
}

// Negative: REQ-163
TEST(Snapshot, ASizeWithoutRoomForItsOwnHeaderIsDamage) {
  Rig rig(plumb_test::tetrahedron());
  plumb_test::Bytes bytes = snapshot_of(rig.monitor);
  for (std::size_t k = 24; k < 28; ++k) bytes[k] = 0;
  EXPECT_EQ(snapshot_header(bytes.data(), bytes.size()).error().code, Errc::snapshot_damaged);
}

}  // namespace
}  // namespace health_snapshot_test
