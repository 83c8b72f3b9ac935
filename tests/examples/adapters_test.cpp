// The adapters to MAVLink, PX4 and F Prime: masks, signs, and what becomes of a vector that may not be used.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "motion_verdicts.hpp"
#include "navigation/fprime.hpp"
#include "navigation/mavlink.hpp"
#include "navigation/px4.hpp"
#include "navigation/stub/fprime_component.hpp"
#include "navigation/stub/mavlink_messages.hpp"
#include "navigation/stub/px4_messages.hpp"
#include "verdicts.hpp"

namespace adapters_test {
namespace {

using example_test::good;
using plumb::SensorSet;
using plumb::Validity;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(MavlinkSysStatus, setsTheAccelerometersBitInAllThreeMasks) {
  mavlink_sys_status_t out{};
  plumb_mavlink::fill(out, good());
  EXPECT_EQ(out.onboard_control_sensors_present, 2U);  // MAV_SYS_STATUS_SENSOR_3D_ACCEL
  EXPECT_EQ(out.onboard_control_sensors_enabled, 2U);
  EXPECT_EQ(out.onboard_control_sensors_health, 2U);
}

TEST(MavlinkSysStatus, touchesNoOtherSensorsBits) {
  for (const Validity validity : example_test::kAllValidities) {
    plumb::Verdict v = good();
    v.validity = validity;
    mavlink_sys_status_t ones{~0U, ~0U, ~0U}, zeros{};
    plumb_mavlink::fill(ones, v);
    plumb_mavlink::fill(zeros, v);
    EXPECT_EQ(ones.onboard_control_sensors_health & ~2U, ~2U);
    EXPECT_EQ(zeros.onboard_control_sensors_health & ~2U, 0U);
    EXPECT_EQ(ones.onboard_control_sensors_health & 2U, zeros.onboard_control_sensors_health & 2U);
  }
}

TEST(MavlinkSysStatus, isHealthyOnlyWhereTheVectorMayBeUsed) {
  for (const Validity validity : example_test::kAllValidities) {
    plumb::Verdict v = good();
    v.validity = validity;
    mavlink_sys_status_t strict{}, lenient{};
    plumb_mavlink::fill(strict, v);
    plumb_mavlink::fill(lenient, v, true);
    EXPECT_EQ(strict.onboard_control_sensors_health != 0, validity == Validity::valid);
    EXPECT_EQ(lenient.onboard_control_sensors_health != 0,
              validity == Validity::valid || validity == Validity::degraded);
  }
  plumb::Verdict v = good();
  v.gravity_mps2[2] = kNan;
  mavlink_sys_status_t out{};
  plumb_mavlink::fill(out, v);
  EXPECT_EQ(out.onboard_control_sensors_health, 0U);
  EXPECT_EQ(out.onboard_control_sensors_enabled, 2U);
}

TEST(MavlinkSysStatus, twoSensorsInServiceAreNotEnabledAndNotHealthy) {
  plumb::Verdict v = good();
  v.in_service = SensorSet(0b0101);
  mavlink_sys_status_t out{};
  plumb_mavlink::fill(out, v);
  EXPECT_EQ(out.onboard_control_sensors_present, 2U);
  EXPECT_EQ(out.onboard_control_sensors_enabled, 0U);
  EXPECT_EQ(out.onboard_control_sensors_health, 0U);
}

TEST(MavlinkSysStatus, throughAFailureHealthIsEnabledAndEnabledIsPresent) {
  int healthy_before = 0, healthy_doubt = 0;
  for (const plumb::Verdict& v : example_test::run()) {
    mavlink_sys_status_t out{};
    plumb_mavlink::fill(out, v, true);
    EXPECT_EQ(out.onboard_control_sensors_health & ~out.onboard_control_sensors_enabled, 0U);
    EXPECT_EQ(out.onboard_control_sensors_enabled & ~out.onboard_control_sensors_present, 0U);
    if (v.time_s < 30.0) healthy_before += out.onboard_control_sensors_health != 0;
    if (v.state == plumb::HealthState::suspect && v.time_s > 30.0) {
      healthy_doubt += out.onboard_control_sensors_health != 0;
    }
  }
  EXPECT_GT(healthy_before, 1000);
  EXPECT_EQ(healthy_doubt, 0);
}

TEST(MavlinkSysStatus, inMotionHealthIsABoundedForce) {
  const SensorSet all = SensorSet::first(9);
  mavlink_sys_status_t out{};
  plumb_mavlink::fill(out, example_test::flying(), all);
  EXPECT_EQ(out.onboard_control_sensors_present & out.onboard_control_sensors_enabled & 2U, 2U);
  EXPECT_EQ(out.onboard_control_sensors_health, 2U);
  plumb::MotionVerdict v = example_test::flying();
  v.sample.validity = plumb::ForceValidity::unchecked;
  plumb_mavlink::fill(out, v, all);
  EXPECT_EQ(out.onboard_control_sensors_health, 0U);
  plumb_mavlink::fill(out, v, all, true);
  EXPECT_EQ(out.onboard_control_sensors_health, 2U);
  plumb_mavlink::fill(out, plumb::MotionVerdict{}, all, true);
  EXPECT_EQ(out.onboard_control_sensors_enabled, 2U);
  EXPECT_EQ(out.onboard_control_sensors_health, 0U);
  v.excluded = SensorSet(0b111111100);
  plumb_mavlink::fill(out, v, all, true);  // two axes are left
  EXPECT_EQ(out.onboard_control_sensors_present, 2U);
  EXPECT_EQ(out.onboard_control_sensors_enabled, 0U);
  EXPECT_EQ(out.onboard_control_sensors_health, 0U);
}

TEST(MavlinkHighresImu, isTheForceAtItsInstant) {
  mavlink_highres_imu_t out{};
  out.fields_updated = 0x38;  // the gyro's
  EXPECT_TRUE(plumb_mavlink::fill(out, example_test::flying()));
  EXPECT_EQ(out.time_usec, 12249500U);
  EXPECT_EQ(out.zacc, -9.75F);
  EXPECT_EQ(out.fields_updated, 0x3F);
  plumb::MotionVerdict v = example_test::flying();
  v.sample.time_s = 13.0;
  v.sample.force_mps2[1] = kNan;
  EXPECT_FALSE(plumb_mavlink::fill(out, v));
  EXPECT_EQ(out.time_usec, 12249500U);
  EXPECT_EQ(out.xacc, 0.0F);
  EXPECT_EQ(out.yacc, 0.0F);
  EXPECT_EQ(out.zacc, 0.0F);
  EXPECT_EQ(out.fields_updated, 0x38);
}

RC_GTEST_PROP(MavlinkLaw, InMotionHealthIsEnabledIsPresentAndOnlyOfAForce, ()) {
  const plumb::MotionVerdict v = example_test::any_verdict();
  mavlink_sys_status_t out{};
  mavlink_highres_imu_t imu{};
  plumb_mavlink::fill(out, v, example_test::any_set(), true);
  plumb_mavlink::fill(imu, v);
  RC_ASSERT((out.onboard_control_sensors_health & ~out.onboard_control_sensors_enabled) == 0U);
  RC_ASSERT((out.onboard_control_sensors_enabled & ~out.onboard_control_sensors_present) == 0U);
  RC_ASSERT(out.onboard_control_sensors_health == 0U ||
            (v.cause == plumb::MotionCause::none && v.sample.validity != plumb::ForceValidity::none));
  RC_ASSERT(std::isfinite(imu.xacc) && std::isfinite(imu.yacc) && std::isfinite(imu.zacc));
  RC_ASSERT((imu.fields_updated & 7U) == 0U || v.sample.validity == plumb::ForceValidity::bounded);
}

/// Two chips of three axes each: sensors 0 to 2 and 3 to 5.
std::array<plumb_px4::Instance, 4> two_chips() {
  std::array<plumb_px4::Instance, 4> chips{};
  chips[0] = {101, 75, SensorSet(0b000111), {-0.1, 0.2, -9.8}};  // specific force = - gravity of good()
  chips[1] = {202, 50, SensorSet(0b111000), {-0.1, 0.2, -9.5}};
  return chips;
}
plumb::Verdict of_two_chips() {
  plumb::Verdict v = good();
  v.configured = v.in_service = SensorSet::first(6);
  return v;
}

TEST(Px4SensorsStatusImu, theDistanceIsThatOfSpecificForces) {
  sensors_status_imu_s out{};
  plumb_px4::fill(out, of_two_chips(), two_chips());
  EXPECT_EQ(out.timestamp, 12250000U);
  EXPECT_EQ(out.accel_device_id_primary, 101U);
  EXPECT_EQ(out.accel_inconsistency_m_s_s[0], 0.0F);         // the primary
  EXPECT_NEAR(out.accel_inconsistency_m_s_s[1], 0.3, 1e-6);  // not 19.3: that would be a sign wrong
  EXPECT_TRUE(out.accel_healthy[0] && out.accel_healthy[1]);
  EXPECT_EQ(out.accel_device_ids[2], 0U);  // an empty place is zero throughout
  EXPECT_FALSE(out.accel_healthy[2]);
  EXPECT_EQ(out.accel_priority[2], 0);
  EXPECT_EQ(out.accel_inconsistency_m_s_s[2], 0.0F);
}

TEST(Px4SensorsStatusImu, aChipWithAnAxisOutLosesItsPlace) {
  for (int axis = 0; axis < 3; ++axis) {
    plumb::Verdict v = of_two_chips();
    v.in_service = v.in_service.without(axis);
    v.excluded = SensorSet::of(axis);
    sensors_status_imu_s out{};
    plumb_px4::fill(out, v, two_chips());
    EXPECT_FALSE(out.accel_healthy[0]);
    EXPECT_TRUE(out.accel_healthy[1]);
    EXPECT_EQ(out.accel_device_id_primary, 202U);
    EXPECT_EQ(out.accel_priority[0], 1);
    EXPECT_EQ(out.accel_priority[1], 50);
    EXPECT_EQ(out.accel_inconsistency_m_s_s[1], 0.0F);
  }
}

TEST(Px4SensorsStatusImu, aChipUnderSuspicionIsNotHealthy) {
  plumb::Verdict v = of_two_chips();
  v.validity = Validity::unconfirmed;
  v.suspects = SensorSet::of(4);
  sensors_status_imu_s out{};
  plumb_px4::fill(out, v, two_chips());
  EXPECT_TRUE(out.accel_healthy[0]);
  EXPECT_FALSE(out.accel_healthy[1]);
}

TEST(Px4SensorsStatusImu, withoutAVectorNobodyMayArmAndNobodyIsBlamed) {
  for (const Validity validity : {Validity::unconfirmed, Validity::held, Validity::invalid}) {
    plumb::Verdict v = of_two_chips();
    v.validity = validity;
    sensors_status_imu_s out{};
    plumb_px4::fill(out, v, two_chips());
    EXPECT_GT(out.accel_inconsistency_m_s_s[1], 0.7F);  // COM_ARM_IMU_ACC
    EXPECT_LE(out.accel_inconsistency_m_s_s[1], 1.0F);  // EKF2_SEL_IMU_ACC: its selector adds up what is beyond
  }
  plumb::Verdict v = of_two_chips();
  v.gravity_mps2[0] = kNan;
  sensors_status_imu_s out{};
  plumb_px4::fill(out, v, two_chips());
  EXPECT_EQ(out.accel_inconsistency_m_s_s[1], 1.0F);  // NaN would pass as "not beyond the limit"
}

TEST(Px4SensorsStatusImu, aBrokenClockMakesNoTimestamp) {
  plumb::Verdict v = of_two_chips();
  sensors_status_imu_s out{};
  for (const double time_s : {std::nan(""), std::numeric_limits<double>::infinity(), -1.0, 0.0, 1e14, 1e300}) {
    v.time_s = time_s;
    plumb_px4::fill(out, v, two_chips());
    EXPECT_EQ(out.timestamp, 0U) << time_s;
  }
  v.time_s = 1.5;
  plumb_px4::fill(out, v, two_chips());
  EXPECT_EQ(out.timestamp, 1500000U);
}

TEST(Px4SensorsStatusImu, invalidMeansNoPrimaryAtAll) {
  plumb::Verdict v = of_two_chips();
  v.validity = Validity::invalid;
  sensors_status_imu_s out{};
  plumb_px4::fill(out, v, two_chips());
  EXPECT_EQ(out.accel_device_id_primary, 0U);
  EXPECT_FALSE(out.accel_healthy[0] || out.accel_healthy[1]);
}

using Component = Nav::PlumbMonitor<fprime_stub::PlumbMonitorComponentBase>;

TEST(FprimeComponent, tellsAFailureOnceAndSendsNoVectorWhileItDoubts) {
  const auto component = std::make_unique<Component>();
  Body body(30.0);
  ASSERT_TRUE(component->configure(body.setup()));
  std::size_t vectors_at_30 = 0, vectors_at_41 = 0;
  for (int k = 0; k < 6000; ++k) {
    if (k == 3010) vectors_at_30 = component->vectors.size();
    if (k == 4100) vectors_at_41 = component->vectors.size();
    component->sampleIn(body.next());
  }
  ASSERT_EQ(component->events.size(), 3U);
  EXPECT_EQ(component->events[0], "healthy nominal passed_block");
  EXPECT_EQ(component->events[1], "doubt suspect parity");
  EXPECT_EQ(component->events[2], "lost degraded isolated_fault 2");
  EXPECT_GT(vectors_at_30, 40U);
  EXPECT_EQ(vectors_at_41, vectors_at_30);
  EXPECT_GT(component->vectors.size(), vectors_at_41);
  EXPECT_EQ(component->sent_state, static_cast<int>(plumb::HealthState::degraded_3_sensor));
  EXPECT_EQ(component->sent_in_service, 0b1101U);
}

TEST(FprimeComponent, answersAPingOnlyWhereSamplesCame) {
  const auto component = std::make_unique<Component>();
  Body body(30.0);
  ASSERT_TRUE(component->configure(body.setup()));
  component->pingIn(7);
  EXPECT_TRUE(component->pings.empty());
  component->sampleIn(body.next());
  component->pingIn(8);
  component->pingIn(9);  // nothing came since
  EXPECT_EQ(component->pings, std::vector<std::uint32_t>{8});
}

TEST(FprimeComponent, saysWhyItWasNotConfigured) {
  const auto component = std::make_unique<Component>();
  EXPECT_FALSE(component->configure(plumb::MonitorSetup{}));
  ASSERT_EQ(component->events.size(), 1U);
  EXPECT_EQ(component->events[0], std::string("not configured ") + plumb::describe(plumb::Errc::too_few_sensors));
}

}  // namespace
}  // namespace adapters_test
