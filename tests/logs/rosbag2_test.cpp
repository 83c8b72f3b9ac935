// Bags of ROS 2 in SQLite, sound, damaged and hostile.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "plumb/core/vec3.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ros_fixture.hpp"
#include "rosbag2_bytes.hpp"
#include "told.hpp"

namespace rosbag2_test {
namespace {

using namespace plumb::logs;
using namespace logs_told;
using namespace rosbag2_bytes;

plumb::io::FileExpected<LogExtent> read_bag(const std::string& bytes, Told& told) {
  const LogFile file(bytes);
  return read_rosbag2(file.path(), told);
}

Told told_of_bag(const std::string& bytes) {
  Told out;
  const auto extent = read_bag(bytes, out);
  EXPECT_TRUE(extent.has_value()) << extent.error().text();
  return out;
}

std::string refusal_of(const std::string& bytes) {
  Told told;
  const auto extent = read_bag(bytes, told);
  EXPECT_FALSE(extent.has_value());
  return extent ? std::string() : extent.error().text();
}

/// Each record is one of the whole bag, in its order: which pages are lost depends on the tree.
void expect_subset(const Told& part, const Told& whole) {
  std::size_t k = 0;
  for (const auto& [number, record] : part.records) {
    const std::string& name = part.sources[number].name;
    while (k < whole.records.size() &&
           !(same(whole.records[k].second, record) && whole.sources[whole.records[k].first].name == name))
      ++k;
    ASSERT_LT(k, whole.records.size());
  }
}

std::string imu_row(int k, int topic_id = 1) { return row(topic_id, ros_bytes::imu(ros_bytes::imu_at(k))); }

TEST(Rosbag2, EachTopicIsASourceInTheOrderOfRecording) {
  Told told;
  const std::string bytes = small_bag();
  const auto extent = read_bag(bytes, told);
  ASSERT_TRUE(extent.has_value()) << extent.error().text();
  EXPECT_EQ(told.all_notes(), "");
  EXPECT_EQ(extent->bytes, bytes.size());
  EXPECT_EQ(extent->read_bytes, bytes.size());
  EXPECT_EQ(extent->records, 16U);
  ASSERT_EQ(told.sources.size(), 2U);
  EXPECT_EQ(told.sources[0].name, "/imu/data");
  EXPECT_EQ(told.sources[1].name, "/imu/spare");
  const auto spare = told.records_of("/imu/spare");
  ASSERT_EQ(spare.size(), 8U);
  EXPECT_DOUBLE_EQ(spare[7].time_s, 0.32);
  EXPECT_EQ(spare[7].specific_force_mps2, (Axes{0.5, -0.25, 9.5}));
}

TEST(Rosbag2Fixtures, FilesOfOtherWritersAreRead) {
  for (const std::string name : {"sqlite_cli_new.db3", "sqlite_cli_old.db3"}) {
    Told told;
    const auto extent = read_log(ros_fixture::path_of(name), told);
    ASSERT_TRUE(extent.has_value()) << extent.error().text();
    EXPECT_EQ(extent->read_bytes, extent->bytes) << name;
    ASSERT_NO_FATAL_FAILURE(ros_fixture::expect_left_and_right(told)) << name;
  }
}

TEST(Rosbag2, WithoutAStampTheTimeOfRecordingIsUsed) {
  ros_bytes::Imu imu;
  imu.sec = 0;
  imu.nanosec = 0;
  const Told told = told_of_bag(database(kTables + topic(1, "/imu") + row(1, ros_bytes::imu(imu))));
  ASSERT_EQ(told.records.size(), 1U);
  EXPECT_DOUBLE_EQ(told.records[0].second.time_s, 0.5);
  EXPECT_TRUE(told.noted("the stamp of a header is 0"));
}

TEST(Rosbag2, OtherSerializationsAreNoted) {
  const Told told = told_of_bag(database(kTables + topic(1, "/imu", "sensor_msgs/msg/Imu", "protobuf") + imu_row(0)));
  EXPECT_TRUE(told.records.empty());
  EXPECT_TRUE(told.noted("/imu has messages of sensor_msgs/msg/Imu in protobuf")) << told.all_notes();
}

TEST(Rosbag2, TablesWithoutAFormatAreTakenForCdrAndLargeMessagesOfOthersAreNoHindrance) {
  const std::string sql =
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);"
      "INSERT INTO topics VALUES(1,'/imu','sensor_msgs/msg/Imu'),(2,'/camera','sensor_msgs/msg/Image');"
      "INSERT INTO messages VALUES(1,2,5,zeroblob(20000000)),(2,1,5,zeroblob(2000000)),(3,1,5,NULL),(4,1,5,'text'),"
      "(5,99,5,x'00');";
  const Told told = told_of_bag(database(sql + imu_row(0), 4096));
  EXPECT_EQ(told.records.size(), 1U) << told.all_notes();
  EXPECT_TRUE(told.noted("message 2 has 2000000 bytes")) << told.all_notes();
  EXPECT_EQ(told.notes_with("shorter than its head"), 1U) << told.all_notes();
  EXPECT_EQ(told.notes.size(), 3U) << told.all_notes();
}

TEST(Rosbag2, AJournalBesideItIsNotReadAndThatIsSaid) {
  const LogFile file(small_bag());
  std::ofstream(file.path() + "-wal") << "frames";
  Told told;
  EXPECT_TRUE(read_rosbag2(file.path(), told).has_value());
  std::remove((file.path() + "-wal").c_str());
  EXPECT_TRUE(told.noted("-wal (6 bytes) is not read")) << told.all_notes();
  EXPECT_EQ(told.records.size(), 16U);
}

TEST(Rosbag2Damage, WhatIsNoBagIsRefusedWithAReason) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "0 bytes"},
      {"t,x,y,z\n", "is no SQLite database"},
      {std::string("SQLite format 3\0", 16), "inside the 100 bytes"},
      {std::string("SQLite format 3\0", 16) + std::string(4000, '\x7f'), "SQLite database"},
      {database("CREATE TABLE t(x);"), "without the tables"},
      {database("CREATE TABLE topics(x);"), "without the tables"},
      {database("CREATE TABLE topics(x); CREATE TABLE messages(x);"), "no such column"},
      {"\x89MCAP0\r\n", "MCAP"},
  };
  for (const auto& [bytes, words] : cases)
    EXPECT_NE(refusal_of(bytes).find(words), std::string::npos) << refusal_of(bytes);
}

TEST(Rosbag2Damage, ViewsAndVirtualTablesAreNoTables) {
  const std::string rows = "CREATE TABLE m(id INTEGER PRIMARY KEY, topic_id, timestamp, data);" + topic(1, "/imu");
  const std::string topics =
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format, offered_qos_profiles);";
  const std::string endless =
      "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM n) "
      "SELECT id, 1 AS topic_id, 0 AS timestamp, zeroblob(400) AS data FROM n;";
  EXPECT_NE(refusal_of(database(topics + rows + endless)).find("without the tables"), std::string::npos);
}

TEST(Rosbag2Damage, ADatabaseCutShortGivesWhatIsLeft) {
  const std::string bytes = small_bag(60);
  const Told whole_log = told_of_bag(bytes);
  std::size_t most = 0, read = 0;
  for (std::size_t cut = 0; cut < bytes.size(); cut += cut < 600 || cut % 512 > 500 ? 1 : 97) {
    Told told;
    const auto extent = read_bag(bytes.substr(0, cut), told);
    if (!extent) {
      EXPECT_FALSE(extent.error().remedy.empty());
      continue;
    }
    ++read;
    most = std::max(most, told.records.size());
    EXPECT_TRUE(told.noted("the bag ends here")) << told.all_notes();
    ASSERT_NO_FATAL_FAILURE(expect_subset(told, whole_log)) << cut;
  }
  EXPECT_GT(read, 100U);
  EXPECT_GT(most, whole_log.records.size() * 8 / 10);
}

TEST(Rosbag2Damage, BehindADamagedPageTheMessagesAreFound) {
  std::string bytes = small_bag(60);
  const Told whole_log = told_of_bag(bytes);
  for (std::size_t k = 0; k < 512; ++k) bytes[512 * 40 + k] = '\x55';
  Told told;
  const auto extent = read_bag(bytes, told);
  ASSERT_TRUE(extent.has_value());
  EXPECT_LT(told.records.size(), whole_log.records.size());
  EXPECT_GT(told.records.size(), whole_log.records.size() - 12) << told.all_notes();
  EXPECT_EQ(told.records.back().second.time_s, whole_log.records.back().second.time_s);
  EXPECT_FALSE(told.notes.empty());
}

RC_GTEST_PROP(Rosbag2DamageProperties, NoByteThatWasChangedDoesHarm, ()) {
  static const std::string kSound = small_bag(20);
  std::string bytes = kSound;
  const auto flips = *rc::gen::inRange<int>(1, 12);
  for (int k = 0; k < flips; ++k) {
    const auto place = *rc::gen::inRange<std::size_t>(0, *rc::gen::element<std::size_t>(200, 2048, bytes.size()));
    bytes[place] = static_cast<char>(*rc::gen::inRange<int>(0, 256));
  }
  Told told;
  const auto extent = read_bag(bytes, told);
  if (!extent) {
    RC_ASSERT(!extent.error().remedy.empty());
    return;
  }
  RC_ASSERT(extent->read_bytes <= extent->bytes);
  RC_ASSERT(extent->records == told.records.size());
  for (const auto& note : told.notes) RC_ASSERT(note.offset <= bytes.size());
  for (const auto& one : told.records) RC_ASSERT(std::isfinite(plumb::norm(one.second.specific_force_mps2)));
}

}  // namespace
}  // namespace rosbag2_test
