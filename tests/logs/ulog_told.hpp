/// Small logs of PX4, and what they tell, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/logs/flight_log.hpp"
#include "told.hpp"
#include "ulog_bytes.hpp"

namespace ulog_told {

using namespace plumb;
using namespace plumb::logs;
using namespace logs_told;
using namespace ulog_bytes;

inline io::FileExpected<LogExtent> read_bytes(const std::string& bytes, Told& told) {
  const LogFile file(bytes);
  return read_ulog(file.path(), told);
}

inline Told told_of(const std::string& bytes) {
  Told out;
  const auto extent = read_bytes(bytes, out);
  EXPECT_TRUE(extent.has_value()) << extent.error().text();
  return out;
}

inline const std::string kAccelFormat =
    "sensor_accel:uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float x;float y;float z;"
    "float temperature;uint32_t error_count;uint8_t[3] clip_counter;uint8_t samples;uint8_t[4] _padding0;";
inline const std::string kStatusFormat =
    "vehicle_imu_status:uint64_t timestamp;uint32_t accel_device_id;uint32_t[3] accel_clipping;float accel_rate_hz;"
    "float[3] mean_accel;float[3] mean_gyro;float[3] var_accel;float temperature_accel;uint8_t[4] _padding0;";

inline std::string accel(int id, std::uint64_t time_us, float z, std::uint64_t device = 42, std::uint64_t samples = 1) {
  return data(id, u64(time_us + 7) + u64(time_us) + u32(device) + f32(0.5F, -0.25F, z) + f32(31.5F) + u32(0) + u8(1) +
                      u8(2) + u8(3) + u8(samples));
}
inline std::string status(std::uint64_t time_us, std::uint64_t clipped) {
  return data(3, u64(time_us) + u32(77) + u32(clipped) + u32(0) + u32(5) + f32(400.0F) + f32(0.0F, 0.0F, -9.8F) +
                     f32(0.1F, 0.2F, 0.3F) + f32(1e-3F, 2e-3F, 3e-3F) + f32(40.0F));
}
inline std::string begin(unsigned incompatible = 0, const std::vector<std::uint64_t>& appended = {0, 0, 0}) {
  return header() + flags(incompatible, appended) + format(kAccelFormat) + format(kStatusFormat) +
         subscription(0, 1, "sensor_accel") + subscription(1, 2, "sensor_accel") +
         subscription(0, 3, "vehicle_imu_status");
}

/// Two instances, parameters, a sync, a dropout: all that a short flight writes.
inline std::string small_log() {
  std::string out = begin() + parameter("int32_t CAL_ACC0_ID", u32(42)) + parameter("float CAL_ACC0_XOFF", f32(0.25F));
  for (std::uint64_t k = 0; k < 6; ++k) {
    out += accel(1, 1500000 + 1000 * k, -9.75F) + accel(2, 1500300 + 1000 * k, -9.5F, 43);
    if (k == 2) out += sync_mark() + dropout(250);
    if (k % 2 == 1) out += status(1600000 + 50000 * k, 4 * k);
  }
  return out;
}

}  // namespace ulog_told
