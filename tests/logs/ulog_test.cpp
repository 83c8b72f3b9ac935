// PX4's logs: what the real ones and small ones hold is read.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "plumb/core/vec3.hpp"
#include "plumb/logs/flight_log.hpp"
#include "support/recording.hpp"
#include "ulog_told.hpp"

namespace ulog_test {
namespace {

using namespace ulog_told;

TEST(Ulog, EachInstanceIsASourceOfItsDevice) {
  Told told;
  const std::string bytes = small_log();
  const auto extent = read_bytes(bytes, told);
  ASSERT_TRUE(extent.has_value()) << extent.error().text();
  EXPECT_EQ(told.all_notes(), "");
  EXPECT_EQ(extent->bytes, bytes.size());
  EXPECT_EQ(extent->read_bytes, bytes.size());
  EXPECT_EQ(extent->records, 15U);
  EXPECT_DOUBLE_EQ(extent->dropped_s, 0.25);
  ASSERT_EQ(told.sources.size(), 3U);
  EXPECT_EQ(told.sources[1].name, "sensor_accel[1]");
  EXPECT_EQ(told.sources[1].instance, 1);
  EXPECT_EQ(told.sources[1].device_id, 43U);
  EXPECT_EQ(told.sources[1].kind, RecordKind::sample);
  const ImuRecord& first = told.records.front().second;
  EXPECT_DOUBLE_EQ(first.time_s, 0.5);
  EXPECT_EQ(first.specific_force_mps2, (Axes{0.5, -0.25, -9.75}));
  EXPECT_DOUBLE_EQ(first.temperature_degc, 31.5);
  EXPECT_EQ(first.clipped, (std::array<std::uint32_t, 3>{1, 2, 3}));
  ASSERT_EQ(told.parameters.size(), 2U);
  EXPECT_EQ(told.parameters[1], (std::pair<std::string, double>("CAL_ACC0_XOFF", 0.25)));
}

TEST(Ulog, ClipsThatAddUpAreCountedSinceTheLastRecordAndTheMeanHasAVariance) {
  const Told told = told_of(begin() + status(2000000, 10) + status(2050000, 14) + status(3000000, 3));
  const auto records = told.records_of("vehicle_imu_status[0]");
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(told.sources[0].kind, RecordKind::mean);
  EXPECT_EQ(records[0].clipped[0], 0U);
  EXPECT_EQ(records[1].clipped[0], 4U);
  EXPECT_EQ(records[2].clipped[0], 3U) << "the counter began anew";
  EXPECT_EQ(records[0].count, 1U);
  EXPECT_EQ(records[1].count, 20U);
  EXPECT_EQ(records[2].count, 40U) << "PX4 begins a mean each 0.1 s";
  EXPECT_NEAR(records[1].variance_m2ps4[2], 3e-3, 1e-9);
  EXPECT_NEAR(records[1].rate_radps[1], 0.2, 1e-7);
}

TEST(Ulog, AMeanOfSeveralSamplesIsSaidToBeOne) {
  const Told told = told_of(begin() + accel(1, 1500000, -9.5F, 42, 8));
  ASSERT_EQ(told.records.size(), 1U);
  EXPECT_EQ(told.sources[0].kind, RecordKind::mean);
  EXPECT_EQ(told.records[0].second.count, 8U);
}

TEST(Ulog, AChangeOfVelocityIsDividedByItsTimeInWhateverUnit) {
  const std::string tail = "uint8_t delta_velocity_clipping;";
  const std::string whole =
      header() +
      format(
          "vehicle_imu:uint64_t timestamp;float[3] delta_angle;float[3] delta_velocity;uint16_t delta_angle_dt;"
          "uint16_t delta_velocity_dt;" +
          tail) +
      subscription(0, 9, "vehicle_imu");
  const std::string readings = u64(1000000) + f32(0.01F, 0.0F, 0.0F) + f32(0.0F, 0.0F, -0.049F);
  const Told told = told_of(whole + data(9, readings + u16(2500) + u16(5000) + u8(5)) +
                            data(9, readings + u16(2500) + u16(0) + u8(0)));
  ASSERT_EQ(told.records.size(), 1U) << "no time, no force";
  EXPECT_TRUE(told.noted("not above zero"));
  EXPECT_NEAR(told.records[0].second.specific_force_mps2[2], -9.8, 1e-6);
  EXPECT_NEAR(told.records[0].second.rate_radps[0], 4.0, 1e-6);
  EXPECT_EQ(told.records[0].second.clipped, (std::array<std::uint32_t, 3>{1, 0, 1}));
  for (const float dt : {0.005F, 5000.0F}) {
    const Told other =
        told_of(header() + format("vehicle_imu:uint64_t timestamp;float[3] delta_velocity;float dt;") +
                subscription(0, 9, "vehicle_imu") + data(9, u64(1000000) + f32(0.0F, 0.0F, -0.049F) + f32(dt)));
    ASSERT_EQ(other.records.size(), 1U);
    EXPECT_NEAR(other.records[0].second.specific_force_mps2[2], -9.8, 1e-5);
  }
}

TEST(Ulog, FieldsAreFoundBehindNestedOnesAndArrays) {
  const Told told = told_of(
      header() + format("inner:uint8_t[3] a;deep[2] b;") + format("deep:int16_t q;char c;") +
      format("sensor_combined:inner[2] first;uint64_t timestamp;float[3] gyro_rad;double[3] accelerometer_m_s2;"
             "int32_t accelerometer_timestamp_relative;") +
      subscription(0, 5, "sensor_combined") +
      data(5, std::string(18, '\x7f') + u64(2000000) + f32(1, 2, 3) + u64(0x4000000000000000) + u64(0) + u64(0) +
                  u32(0xFFFFFC18)) +
      data(5, std::string(18, '\x7f') + u64(2000000) + f32(1, 2, 3) + u64(0) + u64(0) + u64(0) + u32(0x7FFFFFFF)));
  ASSERT_EQ(told.records.size(), 1U) << told.all_notes();
  EXPECT_TRUE(told.noted("marked as invalid"));
  EXPECT_EQ(told.records[0].second.specific_force_mps2[0], 2.0);
  EXPECT_EQ(told.records[0].second.rate_radps, (Axes{1.0, 2.0, 3.0}));
  EXPECT_NEAR(told.records[0].second.time_s, 0.999, 1e-12);
}

TEST(Ulog, APartAppendedBehindHalfAMessageIsRead) {
  const std::string first = begin() + accel(1, 1500000, -9.5F) + accel(1, 1501000, -9.5F).substr(0, 20);
  const std::string second = accel(1, 1502000, -9.25F);
  const std::vector<std::uint64_t> offsets = {first.size(), first.size() + second.size(), 0};
  const std::string bytes = begin(1, offsets) + first.substr(begin().size()) + second + accel(1, 1503000, -9.0F);
  const Told told = told_of(bytes);
  ASSERT_EQ(told.records.size(), 3U) << told.all_notes();
  EXPECT_EQ(told.records[2].second.specific_force_mps2[2], -9.0);
  EXPECT_EQ(told.notes.size(), 1U) << told.all_notes();
}

TEST(Ulog, PaddingAtTheEndMayBeThereOrNot) {
  const std::string bare = accel(1, 1500000, -9.5F);
  const std::string padded = data(1, bare.substr(5) + std::string(4, '\0'));
  const std::string longer = data(1, bare.substr(5) + std::string(5, '\0'));
  const Told told = told_of(begin() + bare + padded + longer + data(1, bare.substr(5, 40)) + bare);
  EXPECT_EQ(told.records.size(), 3U);
  EXPECT_EQ(told.notes.size(), 2U) << told.all_notes();
  EXPECT_TRUE(told.noted("not what its format says"));
}

/// What a real log must hold.
struct Expected {
  std::string name;
  std::uint64_t device;
  std::size_t records;
};

void expect_log(const std::string& name, const std::vector<Expected>& sources, std::size_t parameters,
                double dropped_s) {
  const std::string path = plumb_test::recording_path("logs/" + name);
  if (!std::ifstream(path)) {
    GTEST_SKIP() << "log not found: " << path << " (set PLUMB_DATA_DIR to the directory that holds logs/)";
  }
  Told told;
  const auto extent = read_ulog(path, told);
  ASSERT_TRUE(extent.has_value()) << extent.error().text();
  EXPECT_EQ(extent->read_bytes, extent->bytes);
  EXPECT_DOUBLE_EQ(extent->dropped_s, dropped_s);
  EXPECT_EQ(told.parameters.size(), parameters);
  EXPECT_EQ(told.sources.size(), sources.size());
  for (const Expected& source : sources) {
    const std::size_t number = told.number_of(source.name);
    ASSERT_LT(number, told.sources.size()) << source.name;
    EXPECT_EQ(told.sources[number].device_id, source.device) << source.name;
    const auto records = told.records_of(source.name);
    EXPECT_EQ(records.size(), source.records) << source.name;
    double sum = 0.0;
    for (const ImuRecord& record : records) sum += plumb::norm(record.specific_force_mps2);
    EXPECT_NEAR(sum / static_cast<double>(records.size()), 9.8, 0.5) << source.name;
    EXPECT_LT(records.back().time_s - records.front().time_s, 100.0) << source.name;
    EXPECT_GT(records.back().time_s, records.front().time_s) << source.name;
  }
  std::cout << told.all_notes();
}

TEST(UlogRecordings, FlightOfThreeImus) {
  expect_log("sample_log_small.ulg",
             {{"sensor_accel[0]", 0x25000a, 6},
              {"sensor_accel[1]", 0x380022, 6},
              {"sensor_accel[2]", 0x280022, 6},
              {"vehicle_imu[0]", 0x25000a, 12},
              {"vehicle_imu[1]", 0x380022, 12},
              {"vehicle_imu[2]", 0x280022, 12},
              {"sensor_combined[0]", 0, 1298}},
             980, 0.030);
}

TEST(UlogRecordings, SimulatedFlightWithDefaultParameters) {
  expect_log("sample_px4_events.ulg",
             {{"sensor_accel[0]", 0x14010c, 31},
              {"vehicle_imu[0]", 0x14010c, 62},
              {"vehicle_imu_status[0]", 0x14010c, 31},
              {"sensor_combined[0]", 0, 7783},
              {"vehicle_acceleration[0]", 0, 624}},
             875, 0.0);
}

TEST(UlogRecordings, LogWithThreeAppendedParts) {
  expect_log("sample_appended_multiple.ulg", {{"sensor_combined[0]", 0, 2373}}, 750, 0.0);
}

}  // namespace
}  // namespace ulog_test
