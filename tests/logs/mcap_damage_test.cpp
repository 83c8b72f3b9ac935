// Damaged, cut and hostile MCAP: what is sound is read, the rest is noted with its place.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mcap_told.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/logs/flight_log.hpp"

namespace mcap_damage_test {
namespace {

using namespace mcap_told;

std::string imus(int from, int count) {
  std::string out;
  for (int k = 0; k < count; ++k) out += imu_message(1, ros_bytes::imu_at(from + k));
  return out;
}

std::string bag_with(const std::string& middle) {
  return header() + chunk(described() + imus(0, 2)) + middle + chunk(imus(10, 3), "zstd") + data_end() + footer();
}

TEST(McapDamage, AChunkThatCannotBeTrustedIsLeftOutAndTheNextOneRead) {
  const std::string records = imus(2, 2);
  std::string flipped = zstd(records);
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 0x40);
  const std::vector<std::pair<std::string, std::string>> cases = {
      {raw_chunk(records.size(), crc32(records) ^ 1U, "", records), "check sum of a chunk"},
      {raw_chunk(records.size(), crc32(records) ^ 1U, "lz4", lz4(records)), "check sum of a chunk"},
      {raw_chunk(records.size(), 0, "zstd", records), "cannot be unpacked"},
      {raw_chunk(records.size(), 0, "lz4", records), "cannot be unpacked"},
      {raw_chunk(records.size() - 1, 0, "zstd", zstd(records)), "more bytes than it says"},
      {raw_chunk(records.size() - 1, 0, "lz4", lz4(records)), "more bytes than it says"},
      {raw_chunk(records.size() + 1, 0, "zstd", zstd(records)), "not " + std::to_string(records.size() + 1)},
      {raw_chunk(records.size() - 1, 0, "", records), "not " + std::to_string(records.size() - 1)},
      {raw_chunk(records.size(), 0, "zstd", zstd(records).substr(0, 60)), "cut short"},
      {raw_chunk(records.size(), 0, "snappy", records), "not known here"},
      {raw_chunk((256U << 20U) + 1, 0, "zstd", zstd(records)), "more than 256 MiB"},
      {raw_chunk(~std::uint64_t{0}, 0, "", records), "more than 256 MiB"},
      {record(0x06, std::string(10, '\0')), "contradicts its size"},
      {record(0x06, whole(0, 28) + text("") + whole(1000, 8) + "short"), "contradicts its size"},
  };
  for (const auto& [middle, words] : cases) {
    const Told told = told_of(bag_with(middle));
    EXPECT_EQ(told.records.size(), 5U) << words << "\n" << told.all_notes();
    EXPECT_EQ(told.notes.size(), 1U) << words << "\n" << told.all_notes();
    EXPECT_TRUE(told.noted(words)) << words << "\n" << told.all_notes();
    EXPECT_EQ(told.notes[0].offset, header().size() + chunk(described() + imus(0, 2)).size()) << words;
  }
  const Told damaged = told_of(bag_with(raw_chunk(records.size(), crc32(records), "zstd", flipped)));
  EXPECT_EQ(damaged.records.size(), 5U) << damaged.all_notes();
}

TEST(McapDamage, ASizeThatIsOnlyStatedTakesNoMemory) {
  std::string out = header();
  for (int k = 0; k < 200; ++k) out += raw_chunk(256U << 20U, 0, "zstd", zstd("x"));
  const Told told = told_of(out + data_end() + footer());
  EXPECT_EQ(told.notes_with("holds 1 bytes, not 268435456"), 5U) << told.all_notes();
  EXPECT_TRUE(told.noted("195 more notes"));
}

TEST(McapDamage, ARecordWithinAChunkThatRunsPastItsEndIsNoted) {
  std::string records = imus(2, 1);
  const std::string torn = records + record(0x05, std::string(400, 'x')).substr(0, 300);
  const Told told = told_of(bag_with(raw_chunk(torn.size(), crc32(torn), "", torn)));
  EXPECT_EQ(told.records.size(), 6U);
  EXPECT_EQ(told.notes.size(), 1U) << told.all_notes();
  EXPECT_TRUE(told.noted("what follows byte " + std::to_string(records.size()))) << told.all_notes();
}

TEST(McapDamage, BehindADamagedSizeTheNextRecordsAreFound) {
  std::string broken = record(0x0C, text("a") + text("b"));
  broken[4] = '\x7F';
  for (const std::string& middle :
       {broken, std::string(3000, '\0'), std::string(100000, '\x01'), std::string("\x05\x06\x01")}) {
    const Told told = told_of(bag_with(middle));
    EXPECT_EQ(told.records.size(), 5U) << told.all_notes();
    EXPECT_EQ(told.notes.size(), 1U) << told.all_notes();
    EXPECT_TRUE(told.noted("is left out")) << told.all_notes();
  }
  const Told nothing = told_of(header() + described() + imus(0, 3) + std::string(100000, '\x01'));
  EXPECT_EQ(nothing.records.size(), 3U);
  EXPECT_TRUE(nothing.noted("are left out")) << nothing.all_notes();
}

TEST(McapDamage, AnEndThatIsNoneAndAChunkWithAWrongSizeCostNoMore) {
  std::string wrong_size = chunk(imus(2, 2));
  wrong_size[2] = '\x04';  // 772 and not 1796 bytes, or the like: within the file
  std::string end = chunk(imus(2, 2));
  end[0] = '\x02';
  std::string no_data_end = chunk(imus(2, 2));
  no_data_end[0] = '\x0F';
  for (const std::string& middle : {wrong_size, end, no_data_end}) {
    const Told told = told_of(bag_with(middle + chunk(imus(4, 2)) + chunk(imus(6, 2))));
    EXPECT_GE(told.records.size(), 9U) << told.all_notes();
    EXPECT_EQ(told.notes.size(), 1U) << told.all_notes();
  }
}

TEST(McapDamage, MessagesThatWereLostAreCounted) {
  const auto statistics = [](std::uint64_t count) { return record(0x0B, whole(count, 8) + std::string(38, '\0')); };
  const std::string begin = header() + described() + chunk(imus(0, 3), "zstd") + imus(3, 1) + data_end();
  EXPECT_EQ(told_of(begin + statistics(4) + footer()).all_notes(), "");
  EXPECT_TRUE(told_of(begin + statistics(7) + footer()).noted("it has 7 messages, 4 were found"));
}

TEST(McapDamage, MessagesThatAreNoneAreLeftOut) {
  ros_bytes::Imu infinite;
  infinite.force[1] = std::nan("");
  std::string other = ros_bytes::imu(ros_bytes::Imu{});
  other[1] = '\x0B';
  const std::string whole_one = ros_bytes::imu(ros_bytes::Imu{});
  std::string long_frame = whole_one;
  long_frame[12] = '\xFF';
  long_frame[15] = '\xFF';
  const Told told = told_of(bag_of({ros_bytes::imu(infinite), other, whole_one.substr(0, 3), long_frame,
                                    whole_one.substr(0, whole_one.size() - 1), "", whole_one + "padding"}));
  EXPECT_EQ(told.records.size(), 1U) << told.all_notes();
  EXPECT_EQ(told.notes_with("is no number"), 1U);
  EXPECT_EQ(told.notes_with("encoding of CDR"), 1U);
  EXPECT_EQ(told.notes_with("shorter than its head"), 2U);
  EXPECT_EQ(told.notes_with("shorter than sensor_msgs/msg/Imu"), 2U) << told.all_notes();
}

TEST(McapDamage, ChannelsAndSchemasThatContradictThemselvesAreNoted) {
  const Told told = told_of(header() + described() + schema(1, "sensor_msgs/msg/Image") +
                            schema(0, "sensor_msgs/msg/Imu") + channel(1, 1, "/other") + imus(0, 1) + message(9, "x") +
                            record(0x05, "abc") + record(0x04, "ab") + record(0x03, "a") + data_end() + footer());
  EXPECT_EQ(told.records.size(), 1U);
  EXPECT_EQ(told.sources[0].name, "/imu/data");
  EXPECT_TRUE(told.noted("schema 1 comes a second time"));
  EXPECT_TRUE(told.noted("channel 1 comes a second time"));
  EXPECT_TRUE(told.noted("of channel 9, which nothing before it describes"));
  EXPECT_EQ(told.notes_with("shorter than its fields"), 3U) << told.all_notes();
}

TEST(McapDamage, NamesReachNoTerminalUnchanged) {
  const Told told = told_of(header() + schema(1, "sensor_msgs/msg/Imu") + channel(1, 1, "/imu\x1b[31m\n") + imus(0, 1) +
                            schema(2, "my\x1b]0;Imu\x07") + channel(2, 2, "/x\r") + data_end() + footer());
  ASSERT_EQ(told.sources.size(), 1U);
  EXPECT_EQ(told.sources[0].name, "/imu\\x1b[31m\\x0a");
  EXPECT_TRUE(told.noted("my\\x1b]0;Imu\\x07"));
}

TEST(McapDamage, ManyTopicsAreBounded) {
  std::string out = header() + schema(1, "sensor_msgs/msg/Imu");
  for (unsigned k = 1; k <= 1100; ++k) out += channel(k, 1, "/imu" + std::to_string(k));
  const Told told = told_of(out + data_end() + footer());
  EXPECT_TRUE(told.noted("more than 1024 topics")) << told.all_notes();
}

TEST(McapDamage, ARecordTooLargeToBeOneIsLeftOut) {
  const std::string large(17U << 20U, 'x');
  const Told told = told_of(header() + described() + schema(2, "a/Image") + channel(2, 2, "/camera") +
                            message(2, large) + message(1, large) + imus(0, 1) + data_end() + footer());
  EXPECT_EQ(told.records.size(), 1U);
  EXPECT_EQ(told.notes.size(), 1U) << told.all_notes();
  EXPECT_TRUE(told.noted("more than 16 MiB"));
}

TEST(McapDamage, WhatIsNoMcapIsRefusedWithAReason) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "0 bytes"},
      {"time_s,x,y,z\n1,2,3,4\n", "is no MCAP file"},
      {"\x89MCAP", "ends at byte 5"},
      {"\x89MCAP1\r\n", "is no MCAP file"},
      {std::string("SQLite format 3\0", 16), "SQLite"},
      {"#ROSBAG V2.0\n", "ROS 1"},
  };
  for (const auto& [bytes, what] : cases) {
    Told told;
    const auto extent = read_bytes(bytes, told);
    ASSERT_FALSE(extent.has_value()) << what;
    EXPECT_NE(extent.error().what.find(what), std::string::npos) << extent.error().text();
    EXPECT_FALSE(extent.error().remedy.empty());
  }
}

TEST(McapDamage, WhatStandsBehindTheEndIsNoted) {
  EXPECT_TRUE(told_of(small_bag() + "more").noted("4 bytes behind the end"));
  const std::string bytes = small_bag();
  EXPECT_TRUE(told_of(bytes.substr(0, bytes.size() - 4)).noted("without the bytes that end"));
  EXPECT_TRUE(told_of(header() + described() + imus(0, 1)).noted("no footer"));
}

TEST(McapDamage, CutAnywhereTheRecordsBeforeTheCutAreHandedOn) {
  const std::string bytes = small_bag();
  const Told whole_log = told_of(bytes);
  std::size_t most = 0;
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    Told told;
    const auto extent = read_bytes(bytes.substr(0, cut), told);
    ASSERT_EQ(extent.has_value(), cut >= 8) << cut;
    if (!extent) continue;
    ASSERT_GE(told.records.size(), most) << cut << "\n" << told.all_notes();
    most = told.records.size();
    ASSERT_NO_FATAL_FAILURE(expect_prefix(told, whole_log)) << cut;
    for (const auto& note : told.notes) ASSERT_LE(note.offset, cut);
    ASSERT_FALSE(told.notes.empty()) << cut;
  }
  EXPECT_EQ(most, whole_log.records.size());
}

RC_GTEST_PROP(McapDamageProperties, NoByteThatWasChangedDoesHarm, ()) {
  std::string bytes = small_bag();
  const auto flips = *rc::gen::inRange<int>(1, 12);
  for (int k = 0; k < flips; ++k) {
    const auto place = *rc::gen::inRange<std::size_t>(8, bytes.size());
    bytes[place] = static_cast<char>(*rc::gen::inRange<int>(0, 256));
  }
  bytes.resize(*rc::gen::inRange<std::size_t>(bytes.size() / 2, bytes.size() + 1));
  Told told;
  const auto extent = read_bytes(bytes, told);
  RC_ASSERT(extent.has_value());
  RC_ASSERT(extent->read_bytes <= extent->bytes);
  RC_ASSERT(extent->bytes == bytes.size());
  RC_ASSERT(extent->records == told.records.size());
  for (const auto& note : told.notes) RC_ASSERT(note.offset <= bytes.size());
  for (const auto& one : told.records) RC_ASSERT(std::isfinite(plumb::norm(one.second.specific_force_mps2)));
}

/// Of twenty chunks with a check sum, one or two are lost, and no reading is a wrong one.
RC_GTEST_PROP(McapDamageProperties, AChangedByteInAChunkChangesNoReading, ()) {
  std::string bytes = header() + described();
  const std::size_t from = bytes.size();
  for (int k = 0; k < 20; ++k) bytes += chunk(imus(k, 1), k % 2 == 0 ? "zstd" : "lz4");
  const std::size_t end = bytes.size();
  bytes += data_end() + footer();
  const Told whole_log = told_of(bytes);
  const auto place = *rc::gen::inRange<std::size_t>(from, end);
  bytes[place] = static_cast<char>(*rc::gen::inRange<int>(0, 256));
  const Told told = told_of(bytes);
  RC_ASSERT(told.records.size() + 2 >= 20U);
  std::size_t k = 0;
  for (const auto& one : told.records) {
    while (k < whole_log.records.size() && !same(whole_log.records[k].second, one.second)) ++k;
    RC_ASSERT(k < whole_log.records.size());
  }
}

}  // namespace
}  // namespace mcap_damage_test
