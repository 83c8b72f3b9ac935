// The adapter to PX4 in flight: who is published as healthy, who is flown, and what the consumers make of it. The rules
// of the consumers stand here as PX4 has them (EKF2Selector.cpp, imuConsistencyCheck.cpp), with default parameters.
#include "navigation/px4_flight.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "motion_verdicts.hpp"
#include "navigation/stub/px4_messages.hpp"

namespace px4_flight_test {
namespace {

using example_test::any_number;
using example_test::any_verdict;
using example_test::flying;
using example_test::kChipAxes;
using plumb::SensorSet;
using Chips = std::array<plumb_px4::Instance, 4>;

/// Three chips that read `flying()`'s force; the second is preferred.
Chips three_chips() {
  Chips chips{};
  for (std::size_t i = 0; i < 3; ++i)
    chips[i] = {static_cast<std::uint32_t>(100 + i), static_cast<std::uint8_t>(i == 1 ? 75 : 50), kChipAxes[i],
                flying().sample.force_mps2};
  return chips;
}

struct Px4 {
  sensors_status_imu_s status{};
  sensor_selection_s selection{};
  plumb_px4::Differences differences_mps2{};
  bool step(const plumb::MotionVerdict& v, const Chips& chips) {
    plumb_px4::fill(status, differences_mps2, v, chips);
    return plumb_px4::select(selection, status);
  }
};

plumb::MotionVerdict isolating(SensorSet axes) {
  plumb::MotionVerdict v = flying();
  v.alarm = true;
  v.isolated = v.suspects = axes;
  v.sample.used = v.sample.used - axes;
  return v;
}
plumb::MotionVerdict doubting() {
  plumb::MotionVerdict v = flying();
  v.alarm = true;
  v.cause = plumb::MotionCause::parity;
  v.suspects = SensorSet::first(9);
  return v;
}

/// EKF2's selector: the chip that it takes to be faulty, 0 for none.
class Selector {
 public:
  std::uint32_t faulty(const sensors_status_imu_s& status) {
    const float step_s = std::min(std::max(static_cast<float>(status.timestamp - last_us_) * 1e-6F, 0.0F), 0.02F);
    last_us_ = status.timestamp;
    float largest = 0.0F;
    std::size_t index = 0;
    int chips = 0, beyond = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (status.accel_device_ids[i] == 0) continue;
      ++chips;
      error_mps_[i] = std::fmax(error_mps_[i] + (status.accel_inconsistency_m_s_s[i] - 1.0F) * step_s, 0.0F);
      beyond += error_mps_[i] > 2.0F ? 1 : 0;
      if (error_mps_[i] > largest) largest = error_mps_[i], index = i;
    }
    return beyond > 0 && chips >= 3 ? status.accel_device_ids[index] : 0;
  }

 private:
  std::uint64_t last_us_ = 0;
  float error_mps_[4] = {};
};
/// The arming check.
bool may_arm(const sensors_status_imu_s& status) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (status.accel_device_ids[i] != 0 && status.accel_inconsistency_m_s_s[i] > 0.7F) return false;
  }
  return true;
}

TEST(Px4Flight, healthyChipsAndThePreferredOneIsFlown) {
  Px4 px4;
  EXPECT_TRUE(px4.step(flying(), three_chips()));
  EXPECT_EQ(px4.status.timestamp, 12249500U);  // of the force, which is 1.5 samples old
  EXPECT_EQ(px4.selection.timestamp, 12249500U);
  EXPECT_EQ(px4.selection.accel_device_id, 101U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(px4.status.accel_healthy[i], i < 3);
    EXPECT_EQ(px4.status.accel_inconsistency_m_s_s[i], 0.0F);
  }
  EXPECT_EQ(px4.status.accel_device_ids[3], 0U);
  EXPECT_EQ(px4.status.accel_priority[3], 0);
  EXPECT_TRUE(may_arm(px4.status));
  EXPECT_FALSE(px4.step(flying(), three_chips()));  // the same once more: no selection is published
}

TEST(Px4Flight, theIsolatedChipIsLeftAtOnceAndAHealthyOneIsKept) {
  Px4 px4;
  px4.step(flying(), three_chips());
  EXPECT_TRUE(px4.step(isolating(kChipAxes[1]), three_chips()));
  EXPECT_EQ(px4.selection.accel_device_id, 100U);
  EXPECT_FALSE(px4.status.accel_healthy[1]);
  EXPECT_EQ(px4.status.accel_priority[1], 1);
  EXPECT_GE(px4.status.accel_inconsistency_m_s_s[1], 100.0F);
  EXPECT_FALSE(px4.step(flying(), three_chips()));  // 101 is healthy again and preferred: 100 is kept
  EXPECT_EQ(px4.status.accel_device_id_primary, 100U);
  EXPECT_TRUE(px4.status.accel_healthy[1]);
}

TEST(Px4Flight, inDoubtNobodyIsHealthyNobodyIsBlamedAndNobodyChosen) {
  Px4 px4;
  Selector selector;
  EXPECT_FALSE(px4.step(doubting(), three_chips()));
  EXPECT_EQ(px4.status.accel_device_id_primary, 0U);  // nobody is chosen in doubt
  px4.step(flying(), three_chips());
  Chips chips = three_chips();
  chips[2].specific_force_mps2[0] += 9.0;  // PX4 itself would take this one for the faulty one
  for (int k = 1; k < 5000; ++k) {
    plumb::MotionVerdict v = doubting();
    v.sample.time_s += 0.001 * k;
    EXPECT_FALSE(px4.step(v, chips));
    EXPECT_EQ(px4.status.accel_device_id_primary, 101U);  // flown on, and not called healthy
    for (const bool healthy : px4.status.accel_healthy) EXPECT_FALSE(healthy);
    EXPECT_EQ(selector.faulty(px4.status), 0U);
    EXPECT_FALSE(may_arm(px4.status));
  }
}

TEST(Px4Flight, withoutAForceTheStampStaysAndNobodyIsHealthy) {
  Px4 px4;
  px4.step(flying(), three_chips());
  EXPECT_FALSE(px4.step(plumb::MotionVerdict{}, three_chips()));
  EXPECT_EQ(px4.status.timestamp, 12249500U);
  EXPECT_EQ(px4.status.accel_device_id_primary, 101U);
  for (const bool healthy : px4.status.accel_healthy) EXPECT_FALSE(healthy);
  EXPECT_FALSE(may_arm(px4.status));
}

TEST(Px4Flight, whereTheFlownChipIsFaultyAndNobodyIsHealthyNoneIsChosen) {
  Px4 px4;
  px4.step(flying(), three_chips());
  plumb::MotionVerdict v = doubting();
  v.excluded = kChipAxes[1];
  EXPECT_FALSE(px4.step(v, three_chips()));
  EXPECT_EQ(px4.status.accel_device_id_primary, 0U);
}

TEST(Px4Flight, anUncheckedChipIsFlownAndNotHealthy) {
  Px4 px4;
  plumb::MotionVerdict v = isolating(kChipAxes[1]);
  v.sample.validity = plumb::ForceValidity::unchecked;
  EXPECT_TRUE(px4.step(v, three_chips()));
  EXPECT_EQ(px4.status.accel_device_id_primary, 100U);
  EXPECT_FALSE(px4.status.accel_healthy[0]);
}

TEST(Px4Flight, aChipThatIsSwitchedOffIsNotThere) {
  Chips chips = three_chips();
  chips[1].priority = 0;  // CAL_ACCn_PRIO 0
  Px4 px4;
  px4.step(flying(), chips);
  EXPECT_EQ(px4.status.accel_device_ids[1], 0U);
  EXPECT_FALSE(px4.status.accel_healthy[1]);
  EXPECT_EQ(px4.status.accel_device_id_primary, 100U);
}

TEST(Px4Flight, theDistanceIsFilteredAsPx4Does) {
  Chips chips = three_chips();
  chips[0].specific_force_mps2[1] += 0.4;
  Px4 px4;
  px4.step(flying(), chips);
  EXPECT_NEAR(px4.status.accel_inconsistency_m_s_s[0], 0.05 * 0.4, 1e-6);
  px4.step(flying(), chips);
  EXPECT_NEAR(px4.status.accel_inconsistency_m_s_s[0], (0.95 * 0.05 + 0.05) * 0.4, 1e-6);
  for (int k = 0; k < 500; ++k) px4.step(flying(), chips);
  EXPECT_NEAR(px4.status.accel_inconsistency_m_s_s[0], 0.4, 1e-6);
  chips[0].specific_force_mps2[1] = std::nan("");  // keeps what it had
  px4.step(flying(), chips);
  EXPECT_NEAR(px4.status.accel_inconsistency_m_s_s[0], 0.4, 1e-6);
}

TEST(Px4Flight, theSelectorBlamesTheIsolatedChipWithin25Samples) {
  Px4 px4;
  Selector selector;
  Chips chips = three_chips();
  chips[1].specific_force_mps2[0] += 0.3;  // 30 mg: less than the selector's threshold, it alone would never see it
  int sample = 0;
  for (std::uint32_t blamed = 0; blamed == 0 && sample < 1000; ++sample) {
    plumb::MotionVerdict v = sample == 0 ? flying() : isolating(kChipAxes[1]);
    v.sample.time_s += 0.001 * sample;
    px4.step(v, chips);
    blamed = selector.faulty(px4.status);
    EXPECT_TRUE(blamed == 0 || blamed == 101U) << blamed;
  }
  EXPECT_LE(sample, 25);
}

TEST(Px4Flight, aHealthyChipFarFromTheReferencePointIsNotBlamedAndForbidsArming) {
  Px4 px4;
  Selector selector;
  Chips chips = three_chips();
  chips[0].specific_force_mps2[0] += 3.0;  // fast turns on a long arm
  for (int k = 0; k < 5000; ++k) {
    plumb::MotionVerdict v = flying();
    v.sample.time_s += 0.001 * k;
    px4.step(v, chips);
    EXPECT_TRUE(px4.status.accel_healthy[0]);
    EXPECT_EQ(selector.faulty(px4.status), 0U);
  }
  EXPECT_FALSE(may_arm(px4.status));
}

/// A sequence of verdicts, with readings of all kinds.
template <class Check>
void fly_any(Check check) {
  Px4 px4;
  Chips chips = three_chips();
  const int samples = *rc::gen::inRange(1, 40);
  for (int k = 0; k < samples; ++k) {
    const plumb::MotionVerdict v = any_verdict();
    for (std::size_t i = 0; i < 3; ++i) {
      for (double& x : chips[i].specific_force_mps2) x = any_number(-20.0, 20.0);
    }
    const sensors_status_imu_s before = px4.status;
    const bool published = px4.step(v, chips);
    check(v, chips, before, px4, published);
  }
}

bool faulty(const plumb::MotionVerdict& v, SensorSet axes) { return !((v.isolated | v.excluded) & axes).empty(); }

RC_GTEST_PROP(Px4FlightLaw, NobodyIsolatedIsHealthyOrFlown, ()) {
  fly_any([](const auto& v, const Chips& chips, const auto&, const Px4& px4, bool) {
    for (std::size_t i = 0; i < 3; ++i) {
      const bool told = px4.status.accel_healthy[i] || px4.status.accel_device_id_primary == chips[i].device_id;
      RC_ASSERT(!told || !faulty(v, chips[i].axes));
    }
  });
}

RC_GTEST_PROP(Px4FlightLaw, WithoutABoundedForceNobodyIsHealthyAndNobodyIsNewlyChosen, ()) {
  fly_any([](const auto& v, const Chips&, const auto& before, const Px4& px4, bool published) {
    const bool told = v.cause == plumb::MotionCause::none && v.sample.validity != plumb::ForceValidity::none;
    for (std::size_t i = 0; i < 4; ++i)
      RC_ASSERT(!px4.status.accel_healthy[i] || (told && v.sample.validity == plumb::ForceValidity::bounded));
    const std::uint32_t primary = px4.status.accel_device_id_primary;
    RC_ASSERT(told || primary == before.accel_device_id_primary || primary == 0);
    RC_ASSERT(told || !published);
  });
}

RC_GTEST_PROP(Px4FlightLaw, ThePrimaryChangesOnlyIfItIsNoLongerClear, ()) {
  fly_any([](const auto&, const Chips& chips, const auto& before, const Px4& px4, bool) {
    for (std::size_t i = 0; i < 3; ++i) {
      const bool flown_and_healthy =
          before.accel_device_id_primary == chips[i].device_id && px4.status.accel_healthy[i];
      RC_ASSERT(!flown_and_healthy || px4.status.accel_device_id_primary == chips[i].device_id);
    }
  });
}

RC_GTEST_PROP(Px4FlightLaw, NumbersAreNumbersAndTheStampIsThatOfTheForce, ()) {
  fly_any([](const auto& v, const Chips&, const auto& before, const Px4& px4, bool) {
    for (const float x : px4.status.accel_inconsistency_m_s_s) RC_ASSERT(std::isfinite(x) && x >= 0.0F);
    RC_ASSERT(px4.status.timestamp == before.timestamp ||
              std::fabs(static_cast<double>(px4.status.timestamp) - 1e6 * v.sample.time_s) <= 0.5 + 1e-6);
  });
}

RC_GTEST_PROP(Px4FlightLaw, TheSelectorBlamesNobodyWhoWasNeverFaulty, ()) {
  Selector selector;
  std::array<bool, 3> ever{};
  bool blames = false;
  fly_any([&](const auto& v, const Chips& chips, const auto&, const Px4& px4, bool) {
    for (std::size_t i = 0; i < 3; ++i) ever[i] = ever[i] || faulty(v, chips[i].axes);
    const std::uint32_t blamed = selector.faulty(px4.status);
    blames = blames || blamed != 0;
    const bool just = blamed == 0 || ever[blamed - 100];  // apart: RC_ASSERT evaluates both sides
    RC_ASSERT(just);
  });
  RC_CLASSIFY(blames, "blames");
}

}  // namespace
}  // namespace px4_flight_test
