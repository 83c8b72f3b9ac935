// A recorded run validates beforehand: its rows are stepped, the host says that time begins anew, and the run goes on
// with what has been learned and with nothing that was measured before.
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "snapshot_support.hpp"

namespace time_base_test {
namespace {

using namespace plumb;
using plumb_test::bits_of;
using plumb_test::Bytes;
using plumb_test::cone_array;
using plumb_test::direction_at;
using plumb_test::Life;
using plumb_test::Noise;
using plumb_test::random_direction;
using plumb_test::Rig;
using plumb_test::snapshot_of;
using plumb_test::tetrahedron;

bool not_yet_validated(const Verdict& v) { return (v.qualifiers & Qualifier::not_yet_validated) != 0; }

/// A row of that tool at rest, of a log that begins at 0.
Sample row_at(Rig& rig, const Vec3& direction, int k) {
  Sample sample = rig.sample(direction, kG0_mps2);
  sample.time_s = 0.01 * k;
  return sample;
}

// Verifies: REQ-150
TEST(TimeBase, TheRowAfterItIsTakenWhateverItsTimeAndOldEvidenceIsNoneOfNow) {
  for (const double begin_s : {-1e6, 0.0, 1.0, 1e9}) {
    Rig rig(tetrahedron());
    rig.prove();
    for (int k = 0; k < 10; ++k) rig.step(rig.sample(direction_at(100, 340), kG0_mps2));
    ASSERT_EQ(rig.monitor.verdict().validity, Validity::valid);
    rig.monitor.begin_time_base();
    EXPECT_EQ(rig.monitor.verdict().validity, Validity::held) << "from now on, not from the next row on";
    EXPECT_EQ(rig.monitor.verdict().usable & Usable::vector, 0);
    EXPECT_TRUE(rig.monitor.verdict().alert);
    for (int k = 0; k < 32; ++k) {
      Sample sample = rig.sample(direction_at(50, 50), kG0_mps2);
      sample.time_s = begin_s + 0.01 * k;
      const Verdict& v = rig.monitor.step(sample);
      EXPECT_TRUE(v.accepted) << k;
      EXPECT_FALSE(not_yet_validated(v));
      EXPECT_EQ(v.state, HealthState::nominal);
      EXPECT_EQ(v.validity, k < 31 ? Validity::invalid : Validity::valid) << begin_s << " " << k;
    }
    EXPECT_LT(angle_between_rad(rig.monitor.verdict().gravity_mps2, direction_at(50, 50)), 0.01);
    EXPECT_EQ(rig.monitor.counters().time_refused, 0U);
  }
}

/// Rows whose times go on as if nothing had happened are of the new base all the same: no block joins both.
// Negative: REQ-150
TEST(TimeBase, NoBlockHoldsRowsOfBoth) {
  Rig rig(tetrahedron());
  rig.prove();
  for (int k = 0; k < 20; ++k) rig.step(rig.sample(direction_at(100, 340), kG0_mps2));
  ASSERT_EQ(rig.monitor.verdict().block_fill, 20);
  rig.monitor.begin_time_base();
  EXPECT_EQ(rig.step(rig.sample(direction_at(100, 340), kG0_mps2)).block_fill, 1);
  EXPECT_EQ(rig.monitor.verdict().validity, Validity::invalid);
}

// Negative: REQ-150, REQ-146
TEST(TimeBase, ATimeThatIsNoNumberIsRefusedAndTheNextOneBegins) {
  Rig rig(tetrahedron());
  rig.prove();
  rig.monitor.begin_time_base();
  Sample sample = row_at(rig, direction_at(50, 50), 0);
  sample.time_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rig.monitor.step(sample).accepted);
  EXPECT_EQ(rig.monitor.verdict().validity, Validity::held);
  EXPECT_TRUE(rig.monitor.step(row_at(rig, direction_at(50, 50), 1)).accepted);
  EXPECT_FALSE(rig.monitor.step(row_at(rig, direction_at(50, 50), 1)).accepted) << "from there on time rises again";
}

// Verifies: REQ-150
TEST(TimeBase, OfAMonitorThatHasSeenNothingItChangesNothing) {
  Rig rig(tetrahedron()), same(tetrahedron());
  rig.monitor.begin_time_base();
  for (int k = 0; k < 200; ++k) {
    const Sample sample = rig.sample(direction_at(20.0 + 30.0 * (k / 50), 80.0 * (k / 50)), kG0_mps2);
    const Verdict& v = rig.step(sample);
    const Verdict& w = same.step(sample);
    ASSERT_EQ(v.validity, w.validity);
    ASSERT_EQ(v.state, w.state);
    ASSERT_EQ(v.gravity_mps2, w.gravity_mps2);
  }
  HealthMonitor never;
  never.begin_time_base();
  EXPECT_EQ(never.verdict().validity, Validity::invalid);
}

/// The power may go between the word and the first row.
// Verifies: REQ-150, REQ-163
TEST(TimeBase, ASnapshotKeepsTheWord) {
  Rig rig(cone_array(6));
  rig.prove();
  rig.monitor.begin_time_base();
  const Bytes bytes = snapshot_of(rig.monitor);
  auto twin = std::make_unique<HealthMonitor>();
  ASSERT_TRUE(twin->restore(rig.setup, bytes.data(), bytes.size()).has_value());
  EXPECT_EQ(bits_of(twin->verdict()), bits_of(rig.monitor.verdict()));
  for (int k = 0; k < 100; ++k) {
    const Sample sample = row_at(rig, direction_at(50, 50), k);
    const Verdict& v = twin->step(sample);
    ASSERT_EQ(bits_of(v), bits_of(rig.monitor.step(sample))) << k;
    ASSERT_TRUE(v.accepted);
  }
  EXPECT_EQ(twin->verdict().validity, Validity::valid);
}

/// The law of a recorded roll test, over tools of every size: rows that move every sensor validate, and from the first
/// row of the run on the qualifier is gone, by way of a snapshot as without one. The same run alone never validates.
// Verifies: REQ-093, REQ-150
TEST(TimeBase, WhatRecordedRowsValidatedIsValidatedFromTheFirstRowOfTheRunOn) {
  for (int number = 0; number < 60; ++number) {
    Noise noise(1000U + static_cast<std::uint64_t>(number));
    const int n = 4 + number % 5;
    Rig rig(n == 4 ? tetrahedron() : cone_array(n), {}, static_cast<std::uint64_t>(number) + 1);
    for (int k = 0; k < 12 && not_yet_validated(rig.monitor.verdict()); ++k) rig.stay(random_direction(noise), 2);
    ASSERT_FALSE(not_yet_validated(rig.monitor.verdict())) << number;
    rig.stay(random_direction(noise));
    const Bytes bytes = snapshot_of(rig.monitor);
    auto restored = std::make_unique<HealthMonitor>();
    ASSERT_TRUE(restored->restore(rig.setup, bytes.data(), bytes.size()).has_value());
    restored->begin_time_base();
    rig.monitor.begin_time_base();
    auto alone = std::make_unique<HealthMonitor>();
    ASSERT_TRUE(alone->configure(rig.setup).has_value());
    const Vec3 still = random_direction(noise);
    bool valid = false;
    for (int k = 0; k < 20 * 32; ++k) {
      const Sample sample = row_at(rig, still, k);
      const Verdict& v = restored->step(sample);
      ASSERT_FALSE(not_yet_validated(v)) << number << " " << k;
      ASSERT_EQ(bits_of(v), bits_of(rig.monitor.step(sample)));
      ASSERT_TRUE(not_yet_validated(alone->step(sample)));
      ASSERT_EQ(alone->verdict().state, HealthState::suspect);
      ASSERT_TRUE(v.validity != Validity::valid || k >= 31) << "nothing of the roll test is valid now";
      valid = valid || v.validity == Validity::valid;
    }
    EXPECT_TRUE(valid) << number;
  }
}

/// Rolled about the axis of the fourth sensor, as the run is: that sensor may be stuck for all the rows say.
// Negative: REQ-093
TEST(TimeBase, RowsThatLeaveASensorWhereItIsValidateNoSensor) {
  Rig rig(tetrahedron());
  for (int k = 0; k < 24; ++k) rig.stay(direction_at(40, 15.0 * k));
  const RotationRequest asked = rig.monitor.verdict().rotation;
  EXPECT_TRUE(asked.wanted);
  EXPECT_EQ(asked.along, rig.setup.array.axis(3));
  EXPECT_NEAR(asked.change_mps2, 0.02 * kG0_mps2, 0.02);
  rig.monitor.begin_time_base();
  for (int k = 0; k < 320; ++k) EXPECT_TRUE(not_yet_validated(rig.monitor.step(row_at(rig, direction_at(40, 70), k))));
  // The turn that was asked for, in the run: what the roll test has shown of the others counts.
  for (int k = 320; k < 480; ++k) rig.monitor.step(row_at(rig, direction_at(60, 70), k));
  EXPECT_FALSE(not_yet_validated(rig.monitor.verdict()));
}

/// Whatever happened before, and at whichever step of a block the word is given: nothing is usable before a block of
/// the new time base is at rest, and the monitor's own snapshot is taken up.
// Verifies: REQ-150, REQ-163
// Negative: REQ-120
TEST(TimeBase, InNoLifeIsAnythingOfBeforeValidBehindIt) {
  int valid_before = 0, states = 0;
  for (int number = 0; number < 300; ++number) {
    Life life(4 + number % 5, 77U + static_cast<std::uint64_t>(number));
    HealthMonitor& monitor = life.tool.rig.monitor;
    for (int k = 0; k < 400 + 37 * (number % 40); ++k) monitor.step(life.next({&monitor}));
    valid_before += monitor.verdict().validity == Validity::valid ? 1 : 0;
    states |= 1 << static_cast<int>(monitor.verdict().state);
    monitor.begin_time_base();
    const Bytes bytes = snapshot_of(monitor);
    auto twin = std::make_unique<HealthMonitor>();
    ASSERT_TRUE(twin->restore(life.tool.rig.setup, bytes.data(), bytes.size()).has_value()) << number;
    bool at_rest = false;
    for (int k = 0; k < 64; ++k) {
      Sample sample = life.next({});
      sample.time_s = 0.01 * k;
      const Verdict& v = monitor.step(sample);
      ASSERT_EQ(bits_of(v), bits_of(twin->step(sample)));
      at_rest = at_rest || v.tick;
      if (at_rest) continue;
      ASSERT_EQ(v.usable & Usable::vector, 0) << number << " " << k;
      ASSERT_TRUE(v.alert);
      ASSERT_FALSE(v.protection_available);
    }
  }
  EXPECT_GT(valid_before, 20);
  EXPECT_GE(states, 16) << "lives of many states";
}

/// Exclusions and doubts are not left behind with the time base.
// Negative: REQ-150
TEST(TimeBase, AnExclusionAndADoubtGoAlong) {
  Rig rig(cone_array(6));
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 0.5 : r; };
  rig.stay(direction_at(20, 10));
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::suspect);
  HealthMonitor doubting = rig.monitor;
  doubting.begin_time_base();
  EXPECT_EQ(doubting.step(row_at(rig, direction_at(20, 10), 0)).state, HealthState::suspect);
  for (int k = 0; k < 8; ++k) rig.stay(direction_at(20.0 + 18.0 * k, 75.0 * k));
  ASSERT_EQ(rig.monitor.verdict().excluded, SensorSet::of(2));
  rig.monitor.begin_time_base();
  rig.distort = [](int, double r, int) { return r; };
  for (int k = 0; k < 100; ++k) {
    const Verdict& v = rig.monitor.step(row_at(rig, direction_at(50, 50), k));
    ASSERT_EQ(v.excluded, SensorSet::of(2));
    ASSERT_EQ(v.state, HealthState::isolated);
  }
}

}  // namespace
}  // namespace time_base_test
