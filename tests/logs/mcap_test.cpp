// MCAP and the message sensor_msgs/msg/Imu in it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mcap_told.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ros_fixture.hpp"

namespace mcap_test {
namespace {

using namespace mcap_told;

TEST(Mcap, EachTopicIsASourceAndItsHeadersGiveTheTime) {
  Told told;
  const std::string bytes = small_bag();
  const auto extent = read_bytes(bytes, told);
  ASSERT_TRUE(extent.has_value()) << extent.error().text();
  EXPECT_EQ(told.all_notes(), "");
  EXPECT_EQ(extent->bytes, bytes.size());
  EXPECT_EQ(extent->read_bytes, bytes.size());
  EXPECT_EQ(extent->records, 25U);
  ASSERT_EQ(told.sources.size(), 2U);
  EXPECT_EQ(told.sources[0].name, "/imu/data");
  EXPECT_EQ(told.sources[0].frame_id, "imu_link");
  EXPECT_EQ(told.sources[0].kind, RecordKind::sample);
  EXPECT_EQ(told.sources[1].name, "/imu/spare");
  ASSERT_EQ(told.parameters.size(), 1U);
  EXPECT_EQ(told.parameters[0], (std::pair<std::string, double>("log_zero_unix_s", 1700000000.0)));
  const auto records = told.records_of("/imu/data");
  ASSERT_EQ(records.size(), 13U);
  EXPECT_DOUBLE_EQ(records[0].time_s, 0.25);
  EXPECT_DOUBLE_EQ(records[12].time_s, 0.37);
  EXPECT_EQ(records[0].specific_force_mps2, (Axes{0.5, -0.25, 9.75}));
  EXPECT_EQ(records[0].rate_radps, (Axes{0.01, -0.02, 0.03}));
  EXPECT_TRUE(std::isnan(records[0].variance_m2ps4[0])) << "zeros mean that it is not known";
  EXPECT_EQ(told.records_of("/imu/spare")[3].specific_force_mps2[2], 9.5);
}

TEST(Mcap, EveryEncapsulationAndAlignmentIsRead) {
  for (const Cdr kind : {Cdr::big, Cdr::little, Cdr::big_2, Cdr::little_2}) {
    for (const std::string frame : {"", "a", "ab", "abc", "abcd", "abcde", "abcdef", "abcdefg"}) {
      ros_bytes::Imu imu;
      imu.frame_id = frame;
      imu.force_covariance = 1e-4;
      const Told told = told_of(bag_of({ros_bytes::imu(imu, kind)}));
      ASSERT_EQ(told.records.size(), 1U) << told.all_notes();
      EXPECT_EQ(told.sources[0].frame_id, frame);
      EXPECT_EQ(told.records[0].second.specific_force_mps2, imu.force) << frame;
      EXPECT_EQ(told.records[0].second.rate_radps, imu.rate) << frame;
      EXPECT_EQ(told.records[0].second.variance_m2ps4, (Axes{1e-4, 1e-4, 1e-4}));
    }
  }
}

TEST(Mcap, WhatTheDriverDoesNotMeasureIsAbsent) {
  ros_bytes::Imu no_force, no_rate;
  no_force.force_covariance = no_rate.rate_covariance = -1.0;
  const Told told = told_of(bag_of({ros_bytes::imu(no_force), ros_bytes::imu(no_rate)}));
  ASSERT_EQ(told.records.size(), 1U);
  EXPECT_TRUE(told.noted("measures no acceleration"));
  EXPECT_TRUE(std::isnan(told.records[0].second.rate_radps[0]));
  EXPECT_EQ(told.records[0].second.specific_force_mps2[2], 9.75);
}

TEST(Mcap, WithoutAStampTheTimeOfRecordingIsUsedAndSaid) {
  ros_bytes::Imu imu;
  imu.sec = 0;
  imu.nanosec = 0;
  ros_bytes::Imu impossible;
  impossible.nanosec = 1000000000;
  const Told told =
      told_of(header() + described() + message(1, ros_bytes::imu(imu)) + message(1, ros_bytes::imu(impossible)) +
              message(1, ros_bytes::imu(ros_bytes::imu_at(100))) + data_end() + footer());
  ASSERT_EQ(told.records.size(), 3U);
  EXPECT_DOUBLE_EQ(told.records[0].second.time_s, 0.5);
  EXPECT_DOUBLE_EQ(told.records[1].second.time_s, 0.5);
  EXPECT_DOUBLE_EQ(told.records[2].second.time_s, 1.25);
  EXPECT_EQ(told.notes_with("the stamp of a header is 0"), 1U) << told.all_notes();
  EXPECT_EQ(told.notes_with("2 headers have no stamp"), 1U) << told.all_notes();
}

TEST(Mcap, TimesBeforeTheFirstOneAndFarFromItStayExact) {
  ros_bytes::Imu first = ros_bytes::imu_at(0), before = ros_bytes::imu_at(0), far = ros_bytes::imu_at(0);
  before.sec -= 3;
  far.sec = 1;
  far.nanosec = 1;
  const Told told = told_of(bag_of({ros_bytes::imu(first), ros_bytes::imu(before), ros_bytes::imu(far)}));
  ASSERT_EQ(told.records.size(), 3U);
  EXPECT_DOUBLE_EQ(told.records[1].second.time_s, -2.75);
  EXPECT_DOUBLE_EQ(told.records[2].second.time_s, -1699999999.0 + 1e-9);
  EXPECT_EQ(told.notes_with("goes back"), 2U) << told.all_notes();
}

TEST(Mcap, WhatIsNotReadIsNotedOnceEach) {
  const std::string bytes =
      header() + schema(1, "sensor_msgs/Imu", "ros1msg") + channel(1, 1, "/old", "ros1") +
      channel(2, 1, "/older", "ros1") + schema(2, "foxglove.Imu", "protobuf") + channel(3, 2, "/fox", "protobuf") +
      schema(4, "my_msgs/msg/RawAccel") + channel(4, 4, "/raw") + schema(5, "sensor_msgs/msg/Imu") +
      channel(5, 5, "/json", "json") + schema(6, "sensor_msgs/msg/Image") + channel(6, 6, "/camera") +
      channel(7, 0, "/without", "json") + message(1, "x") + message(6, "y") + data_end() + footer();
  const Told told = told_of(bytes);
  EXPECT_TRUE(told.records.empty());
  EXPECT_EQ(told.notes_with("/old has messages of sensor_msgs/Imu in ros1"), 1U) << told.all_notes();
  EXPECT_EQ(told.notes_with("/older"), 0U) << told.all_notes();
  EXPECT_EQ(told.notes_with("foxglove.Imu, which are not read"), 1U) << told.all_notes();
  EXPECT_EQ(told.notes_with("my_msgs/msg/RawAccel, which are not read"), 1U) << told.all_notes();
  EXPECT_EQ(told.notes_with("/json has messages of sensor_msgs/msg/Imu in json"), 1U) << told.all_notes();
  EXPECT_EQ(told.notes_with("no message sensor_msgs/msg/Imu that could be read; it has"), 1U) << told.all_notes();
  EXPECT_EQ(told.notes.size(), 5U) << told.all_notes();
}

TEST(Mcap, AMessagePackedByTheRecorderIsUnpacked) {
  const std::string one = ros_bytes::imu(ros_bytes::imu_at(3));
  const Told told = told_of(bag_of({zstd(one), zstd(one).substr(0, 40), zstd(std::string(2U << 20U, 'x'))}));
  ASSERT_EQ(told.records.size(), 1U);
  EXPECT_DOUBLE_EQ(told.records[0].second.time_s, 0.28);
  EXPECT_EQ(told.notes_with("packed with zstd and cannot be unpacked"), 2U) << told.all_notes();
}

TEST(Mcap, ATopicOfTwoPublishersIsOneSource) {
  const Told told = told_of(header() + described() + channel(2, 1, "/imu/data") + imu_message(1, ros_bytes::imu_at(0)) +
                            imu_message(2, ros_bytes::imu_at(1)) + data_end() + footer());
  EXPECT_EQ(told.sources.size(), 1U);
  EXPECT_EQ(told.records.size(), 2U);
}

TEST(McapFixtures, FilesOfTheFormatsOwnLibraryAreRead) {
  for (const std::string name : {"mcap_core_chunks.mcap", "mcap_core_plain.mcap"}) {
    Told told;
    const auto extent = read_mcap(ros_fixture::path_of(name), told);
    ASSERT_TRUE(extent.has_value()) << extent.error().text();
    EXPECT_EQ(extent->read_bytes, extent->bytes) << name;
    ASSERT_NO_FATAL_FAILURE(ros_fixture::expect_left_and_right(told)) << name;
  }
}

}  // namespace
}  // namespace mcap_test
