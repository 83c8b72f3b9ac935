// The ROS 2 adapter: signs, the covariance -1 rule, levels. Compiled twice: against stand-ins, and (ros2_messages.sh)
// against the types that Debian's rosidl generates.
#include "navigation/ros2.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "verdicts.hpp"

#ifdef PLUMB_ROS2_GENERATED
#include "diagnostic_msgs/msg/diagnostic_status.hpp"
#include "sensor_msgs/msg/imu.hpp"
using sensor_msgs::msg::Imu;
using Status = diagnostic_msgs::msg::DiagnosticStatus;
#else
#include "navigation/stub/ros2_messages.hpp"
using ros2_stub::Imu;
using Status = ros2_stub::DiagnosticStatus;
#endif

namespace ros2_test {
namespace {

using example_test::good;
using plumb::Validity;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool told(const Imu& imu) { return imu.linear_acceleration_covariance[0] != -1.0; }

TEST(Ros2Imu, atRestTheSpecificForcePointsUpWhereGravityPointsDown) {
  // REP 103: z up. A level body's gravity is -z there, so its specific force is +z.
  plumb::Verdict v = good();
  v.gravity_mps2 = {0.0, 0.0, -9.81};
  Imu imu;
  plumb_ros2::fill(imu, v, "imu_link");
  EXPECT_DOUBLE_EQ(imu.linear_acceleration.z, 9.81);
  v.gravity_mps2 = {1.5, -2.5, -9.3};
  plumb_ros2::fill(imu, v, "imu_link");
  EXPECT_DOUBLE_EQ(imu.linear_acceleration.x, -1.5);
  EXPECT_DOUBLE_EQ(imu.linear_acceleration.y, 2.5);
  EXPECT_EQ(imu.header.frame_id, "imu_link");
}

TEST(Ros2Imu, theCovarianceOfANegatedVectorIsThatOfTheVector) {
  Imu imu;
  plumb_ros2::fill(imu, good(), "");
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(imu.linear_acceleration_covariance[i], good().covariance[i]);
}

TEST(Ros2Imu, orientationAndRatesAreMarkedAsNotEstimated) {
  Imu imu;
  plumb_ros2::fill(imu, good(), "");
  EXPECT_EQ(imu.orientation_covariance[0], -1.0);
  EXPECT_EQ(imu.angular_velocity_covariance[0], -1.0);
}

TEST(Ros2Imu, onlyAVectorThatMayBeUsedIsPublishedAndTheOthersAreZeroWithMinusOne) {
  for (const Validity validity : example_test::kAllValidities) {
    for (const bool accept_degraded : {false, true}) {
      plumb::Verdict v = good();
      v.validity = validity;
      Imu imu;
      plumb_ros2::fill(imu, v, "", accept_degraded);
      const bool expected = validity == Validity::valid || (accept_degraded && validity == Validity::degraded);
      EXPECT_EQ(told(imu), expected) << plumb::to_string(validity);
      if (expected) continue;
      EXPECT_EQ(imu.linear_acceleration.x, 0.0);
      EXPECT_EQ(imu.linear_acceleration.y, 0.0);
      EXPECT_EQ(imu.linear_acceleration.z, 0.0);
    }
  }
}

TEST(Ros2Imu, aBrokenClockMakesNoStamp) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double time_s : {kNan, kInf, -kInf, 1e300, -1e300, 1.8e18, 2147483648.0}) {
    plumb::Verdict v = good();
    v.time_s = time_s;
    Imu imu;
    plumb_ros2::fill(imu, v, "");
    EXPECT_EQ(imu.header.stamp.sec, 0) << time_s;
    EXPECT_EQ(imu.header.stamp.nanosec, 0U) << time_s;
  }
  plumb::Verdict v = good();
  v.time_s = -1e-20;
  Imu imu;
  plumb_ros2::fill(imu, v, "");
  EXPECT_EQ(imu.header.stamp.sec, -1);
  EXPECT_EQ(imu.header.stamp.nanosec, 999999999U) << "a whole second would belong to sec";
}

TEST(Ros2Imu, whatIsNotFiniteIsNeverPublished) {
  for (std::size_t i = 0; i < 3; ++i) {
    plumb::Verdict v = good();
    v.gravity_mps2[i] = kNan;
    Imu imu;
    plumb_ros2::fill(imu, v, "");
    EXPECT_FALSE(told(imu));
    EXPECT_TRUE(std::isfinite(imu.linear_acceleration.x + imu.linear_acceleration.y + imu.linear_acceleration.z));
  }
  plumb::Verdict v = good();
  v.covariance[4] = std::numeric_limits<double>::infinity();
  Imu imu;
  plumb_ros2::fill(imu, v, "");
  EXPECT_FALSE(told(imu));
}

TEST(Ros2Imu, aVectorWithoutACovarianceIsNotPassedOnAsCovarianceUnknown) {
  plumb::Verdict v = good();
  v.covariance = {};  // all zero reads as "unknown" to a consumer of Imu
  Imu imu;
  plumb_ros2::fill(imu, v, "");
  EXPECT_FALSE(told(imu));
}

TEST(Ros2Imu, theStampIsThatOfTheBlock) {
  plumb::Verdict v = good();
  v.age_s = 0.5;
  Imu imu;
  plumb_ros2::fill(imu, v, "");
  EXPECT_EQ(imu.header.stamp.sec, 11);
  EXPECT_EQ(imu.header.stamp.nanosec, 750000000U);
}

TEST(Ros2Imu, throughAFailureNoWrongVectorIsPublished) {
  Body body(30.0);
  int told_count = 0;
  for (const plumb::Verdict& v : example_test::run()) {
    body.next();
    if (!v.tick) continue;
    Imu imu;
    plumb_ros2::fill(imu, v, "", true);
    if (!told(imu)) continue;
    ++told_count;
    const Eigen::Vector3d force(imu.linear_acceleration.x, imu.linear_acceleration.y, imu.linear_acceleration.z);
    EXPECT_LT((force + body.gravity_mps2()).norm(), 0.01) << v.time_s;  // specific force = - gravity
  }
  EXPECT_GT(told_count, 70);
}

Status status_of(const plumb::Verdict& v) {
  Body body(1e9);
  Status status;
  plumb_ros2::fill_status(status, v, body.setup().array);
  return status;
}

TEST(Ros2Status, levelsFollowTheValidity) {
  const unsigned char expected[] = {Status::OK, Status::WARN, Status::WARN, Status::STALE, Status::ERROR};
  for (std::size_t i = 0; i < 5; ++i) {
    plumb::Verdict v = good();
    v.validity = example_test::kAllValidities[i];
    EXPECT_EQ(status_of(v).level, expected[i]) << plumb::to_string(v.validity);
    v.state = plumb::HealthState::failed;
    EXPECT_EQ(status_of(v).level, static_cast<unsigned char>(Status::ERROR));
  }
}

TEST(Ros2Status, aValidVectorOfFewerSensorsWarnsAndNamesTheExcludedOne) {
  plumb::Verdict v = good();
  v.state = plumb::HealthState::isolated;
  v.in_service = v.in_service.without(1);
  v.excluded = plumb::SensorSet::of(1);
  v.sensor_cause[1] = plumb::Cause::isolated_fault;
  const Status status = status_of(v);
  EXPECT_EQ(status.level, static_cast<unsigned char>(Status::WARN));
  EXPECT_EQ(status.message, "isolated: passed_block");
  ASSERT_EQ(status.values.size(), 4U);
  EXPECT_EQ(status.values.back().key, "a2");
  EXPECT_EQ(status.values.back().value, "isolated_fault");
}

TEST(Ros2Status, figuresThatAreNotFiniteAreTextAllTheSame) {
  plumb::Verdict v = good();
  v.statistic = kNan;
  EXPECT_EQ(status_of(v).values.front().value, "nan");
}

}  // namespace
}  // namespace ros2_test
