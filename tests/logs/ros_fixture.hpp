/// What the bags in tests/logs/fixtures hold: the same forty messages of two IMUs, as their README says.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "plumb/logs/flight_log.hpp"
#include "told.hpp"

namespace ros_fixture {

inline std::string path_of(const std::string& name) {
  return std::string(PLUMB_SOURCE_DIR) + "/tests/logs/fixtures/" + name;
}

inline void expect_left_and_right(const logs_told::Told& told) {
  using plumb::logs::Axes;
  EXPECT_EQ(told.all_notes(), "");
  ASSERT_EQ(told.sources.size(), 2U);
  EXPECT_EQ(told.sources[0].name, "/imu/left");
  EXPECT_EQ(told.sources[0].frame_id, "imu_left");
  EXPECT_EQ(told.sources[1].name, "/imu/right");
  EXPECT_EQ(told.sources[1].frame_id, "imu_right_link");
  for (const std::string name : {"/imu/left", "/imu/right"}) {
    const auto records = told.records_of(name);
    ASSERT_EQ(records.size(), 20U);
    for (std::size_t k = 0; k < records.size(); ++k) {
      const auto n = static_cast<double>(k);
      EXPECT_DOUBLE_EQ(records[k].time_s, 0.125 + 0.01 * n);
      EXPECT_EQ(records[k].specific_force_mps2, (Axes{0.25 * n, name == "/imu/left" ? -0.5 : 0.5, 9.8125}));
      EXPECT_EQ(records[k].rate_radps, (Axes{0.5, 0.0625 * n, -1.0}));
      EXPECT_EQ(records[k].variance_m2ps4, (Axes{0.25, 0.5, 0.75}));
    }
  }
  ASSERT_EQ(told.parameters.size(), 1U);
  EXPECT_EQ(told.parameters[0].second, 1700000100.0);
}

}  // namespace ros_fixture
