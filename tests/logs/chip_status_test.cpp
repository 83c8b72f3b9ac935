// What autopilots say of their accelerometers beside the readings, and several chips in one message.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "dataflash_test_support.hpp"
#include "ulog_told.hpp"

namespace chip_status_test {
namespace {

using plumb::logs::Axes;
using plumb::logs::ChipStatus;
using ulog_bytes::f32;
using ulog_bytes::u32;
using ulog_bytes::u64;
using ulog_bytes::u8;
using Health = ChipStatus::Health;

constexpr const char* kStatusFormat =
    "sensors_status_imu:uint64_t timestamp;uint32_t accel_device_id_primary;uint32_t[4] accel_device_ids;"
    "float[4] accel_inconsistency_m_s_s;bool[4] accel_healthy;uint8_t[4] accel_priority;";
constexpr const char* kThreeChips =
    "sensor_combined:uint64_t timestamp;float[9] gyro_rad;uint64_t[3] accelerometer_timestamp;"
    "float[9] accelerometer_m_s2;";

std::string three_chips(std::uint64_t time_us, const std::vector<std::uint64_t>& sampled_us) {
  std::string out = u64(time_us);
  for (int k = 0; k < 3; ++k) out += f32(0.1F * static_cast<float>(k), 0.0F, 0.0F);
  for (const std::uint64_t t : sampled_us) out += u64(t);
  for (int k = 0; k < 3; ++k) out += f32(static_cast<float>(k), 0.0F, -9.75F);
  return ulog_bytes::data(7, out);
}

std::string begin_three() {
  return ulog_bytes::header() + ulog_bytes::flags() + ulog_bytes::format(kThreeChips) +
         ulog_bytes::subscription(0, 7, "sensor_combined");
}

TEST(ChipStatusUlog, FourChipsOfAMessageAndNoneWithoutADevice) {
  std::string message = u64(2500000) + u32(42) + u32(42) + u32(43) + u32(0) + u32(0);
  message += f32(0.125F) + f32(0.5F) + f32(9.0F) + f32(9.0F) + u8(1) + u8(0) + u8(1) + u8(1) + u32(0);
  const auto told =
      ulog_told::told_of(ulog_told::begin() + ulog_bytes::format(kStatusFormat) +
                         ulog_bytes::subscription(0, 9, "sensors_status_imu") + ulog_bytes::data(9, message));
  EXPECT_EQ(told.all_notes(), "");
  ASSERT_EQ(told.statuses.size(), 2U);
  EXPECT_DOUBLE_EQ(told.statuses[0].time_s, 1.5);
  EXPECT_EQ(told.statuses[0].device_id, 42U);
  EXPECT_EQ(told.statuses[0].health, Health::sound);
  EXPECT_DOUBLE_EQ(told.statuses[0].inconsistency_mps2, 0.125);
  EXPECT_EQ(told.statuses[1].device_id, 43U);
  EXPECT_EQ(told.statuses[1].health, Health::failed);
  EXPECT_DOUBLE_EQ(told.statuses[1].inconsistency_mps2, 0.5);
}

TEST(ChipStatusUlog, AStatusWithoutItsFieldsSaysNothing) {
  const auto told = ulog_told::told_of(
      ulog_told::begin() + ulog_bytes::format("sensors_status_imu:uint64_t timestamp;uint32_t other;") +
      ulog_bytes::subscription(0, 9, "sensors_status_imu") + ulog_bytes::data(9, u64(2500000) + u32(42)));
  EXPECT_TRUE(told.statuses.empty());
}

TEST(ChipStatusUlog, EachChipOfAMessageOfThreeIsASource) {
  const auto told = ulog_told::told_of(begin_three() + three_chips(2000000, {1990000, 1980000, 1970000}));
  ASSERT_EQ(told.sources.size(), 3U);
  EXPECT_EQ(told.sources[2].name, "sensor_combined[2]");
  EXPECT_EQ(told.sources[2].instance, 2);
  const auto third = told.records_of("sensor_combined[2]");
  ASSERT_EQ(third.size(), 1U);
  EXPECT_EQ(third[0].specific_force_mps2, (Axes{2.0, 0.0, -9.75}));
  EXPECT_DOUBLE_EQ(third[0].time_s, 0.97);
  EXPECT_NEAR(third[0].rate_radps[0], 0.2, 1e-7);
}

TEST(ChipStatusUlog, AReadingThatIsRepeatedCountsOnceAndAChipThatIsNotThereNever) {
  const auto told = ulog_told::told_of(begin_three() + three_chips(2000000, {1990000, 1980000, 0}) +
                                       three_chips(2004000, {1994000, 1980000, 0}));
  ASSERT_EQ(told.sources.size(), 2U);
  EXPECT_EQ(told.records_of("sensor_combined[0]").size(), 2U);
  EXPECT_EQ(told.records_of("sensor_combined[1]").size(), 1U);
}

TEST(ChipStatusDataflash, AFailedAccelerometerIsToldWhileItLastsAndWhenItEnds) {
  dataflash_bytes::Log log;
  log.fmt(1, "IMU", "QBffffffBB", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,GH,AH");
  for (const double healthy : {1.0, 0.0, 0.0, 1.0, 1.0})
    log.message(1, {2e6, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -9.8, 1.0, healthy});
  const auto statuses = dataflash_test_support::read(log).heard.statuses;
  ASSERT_EQ(statuses.size(), 3U);
  EXPECT_EQ(statuses[0].health, Health::failed);
  EXPECT_EQ(statuses[1].health, Health::failed);
  EXPECT_EQ(statuses[2].health, Health::sound);
  EXPECT_EQ(statuses[0].instance, 1);
  EXPECT_EQ(statuses[0].device_id, 0U);
  EXPECT_DOUBLE_EQ(statuses[0].time_s, 2.0);
}

TEST(ChipStatusDataflash, VibrationHasTheInstanceOfItsMessageOrNone) {
  dataflash_bytes::Log log;
  log.fmt(1, "VIBE", "QBfffI", "TimeUS,IMU,VibeX,VibeY,VibeZ,Clip");
  log.fmt(2, "VIBE", "QfffIII", "TimeUS,VibeX,VibeY,VibeZ,Clip0,Clip1,Clip2");
  log.message(1, {1e6, 2.0, 1.5, 2.5, 3.5, 0.0});
  log.message(2, {1e6, 4.5, 5.5, 6.5, 0.0, 0.0, 0.0});
  const auto statuses = dataflash_test_support::read(log).heard.statuses;
  ASSERT_EQ(statuses.size(), 2U);
  EXPECT_EQ(statuses[0].instance, 2);
  EXPECT_EQ(statuses[0].vibration_mps2, (Axes{1.5, 2.5, 3.5}));
  EXPECT_EQ(statuses[0].health, Health::unknown);
  EXPECT_EQ(statuses[1].instance, -1);
  EXPECT_EQ(statuses[1].vibration_mps2, (Axes{4.5, 5.5, 6.5}));
}

}  // namespace
}  // namespace chip_status_test
