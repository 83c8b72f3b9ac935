// PX4's logs: what was done to the bytes of one is noted and survived.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "plumb/core/vec3.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ulog_told.hpp"

namespace ulog_damage_test {
namespace {

using namespace ulog_told;

TEST(UlogDamage, AppendedOffsetsThatLeadNowhereAreNoted) {
  const std::string bytes = begin(1, {1U << 30U, 3, 0}) + accel(1, 1500000, -9.5F);
  const Told told = told_of(bytes);
  EXPECT_EQ(told.records.size(), 1U);
  EXPECT_TRUE(told.noted("behind the end of the file"));
  EXPECT_TRUE(told.noted("before what they are appended to"));
}

TEST(UlogDamage, DataOfARemovedOrMissingSubscriptionAreLeftOut) {
  const std::string after = accel(1, 1501000, -9.0F);
  std::string bytes = begin() + accel(2, 1500000, -9.5F, 43) + removal(2) + after;
  for (int k = 0; k < 9; ++k) bytes += accel(2, 1502000, -9.0F, 43) + after;
  const Told told = told_of(bytes + data(99, u64(0)) + after + after);
  EXPECT_EQ(told.records_of("sensor_accel[1]").size(), 1U);
  EXPECT_EQ(told.records_of("sensor_accel[0]").size(), 12U) << told.all_notes();
  EXPECT_TRUE(told.noted("was removed"));
  EXPECT_EQ(told.notes.size(), 6U) << "five and a sum\n" << told.all_notes();
  EXPECT_TRUE(told.noted("5 more notes from here on are left out: data without a subscription"));
}

TEST(UlogDamage, FormatsThatMakeNoSenseAreNoted) {
  const std::string good = accel(1, 1500000, -9.5F);
  const std::vector<std::pair<std::string, std::string>> cases = {
      {format("a:b x;") + format("b:a x;") + subscription(0, 20, "a"), "contains itself"},
      {format("a:a[9] x;") + subscription(0, 20, "a"), "contains itself"},
      {subscription(0, 20, "nobody"), "has no format"},
      {format("a:missing x;") + subscription(0, 20, "a"), "has no format \"missing\""},
      {format("a:uint8_t[99999] x;"), "has no field in"},
      {format("a:uint64_t[65000] x;") + subscription(0, 20, "a"), "larger than a message"},
      {format("a:uint8_t[0] x;"), "has no field in"},
      {format("a:uint8_t[-1] x;"), "has no field in"},
      {format("nothing at all"), "without a name"},
      {format("a:;;;"), "no fields"},
      {format("a:uint8_t \x1b[31m x;"), "\\x1b"},
      {format("sensor_accel:uint64_t timestamp;"), "comes a second time"},
      {format(std::string(300, 'n') + ":int8_t x;"), "more than 255"},
      {subscription(1, 1, "vehicle_imu_status"), "is \"sensor_accel\" already"},
      {format("vehicle_acceleration:uint64_t timestamp;float[2] xyz;") + subscription(0, 8, "vehicle_acceleration") +
           subscription(1, 9, "vehicle_acceleration"),
       "vehicle_acceleration has no xyz"},
      {parameter("char[3] NAME", "abc"), "has no number"},
      {message('P',
               "\xff"
               "float"),
       "runs past its message"},
      {message('S', "12345678"), "without its magic bytes"},
      {message('Z', "12345678"), "unknown type 90"},
      {flags(), "do not come first"},
      {message('F', ""), "cannot have 0 bytes"},
  };
  for (const auto& one : cases) {
    const Told told = told_of(begin() + good + one.first + good + good + good);
    EXPECT_TRUE(told.noted(one.second)) << one.second << "\n" << told.all_notes();
    EXPECT_EQ(told.notes.size(), 1U) << one.second << "\n" << told.all_notes();
    EXPECT_EQ(told.records.size(), 4U) << one.second << "\n" << told.all_notes();
  }
}

TEST(UlogDamage, CapsHoldAndAreSaid) {
  std::string formats = begin(), ids = begin() + format("a:int8_t x;");
  for (int k = 0; k < 2100; ++k) formats += format("f" + std::to_string(k) + ":int8_t x;");
  for (int k = 10; k < 4200; ++k) ids += subscription(0, k, "a");
  EXPECT_TRUE(told_of(formats).noted("more than 2048 formats"));
  EXPECT_TRUE(told_of(ids).noted("more than 4096 subscriptions"));
  std::string many = "wide:", deep = begin();
  for (int k = 0; k < 1025; ++k) many += "int8_t x;";
  EXPECT_TRUE(told_of(begin() + format(many)).noted("more than 1024 fields"));
  for (int k = 0; k < 40; ++k) deep += format("d" + std::to_string(k) + ":d" + std::to_string(k + 1) + " x;");
  EXPECT_TRUE(told_of(deep + format("d40:int8_t x;") + subscription(0, 20, "d0")).noted("more than 16 deep"));
}

TEST(UlogDamage, BehindADamagedSizeTheNextMessagesAreFound) {
  std::string tail;
  for (std::uint64_t k = 0; k < 8; ++k) tail += accel(1, 1600000 + 1000 * k, -9.5F);
  std::string broken = accel(1, 1500000, -9.5F);
  broken[0] = '\x11';
  const Told told = told_of(begin() + broken + tail);
  EXPECT_EQ(told.records.size(), 8U) << told.all_notes();
  const Told noise = told_of(begin() + std::string(100000, '\x01') + sync_mark() + accel(1, 1600000, -9.5F));
  EXPECT_EQ(noise.records.size(), 1U) << noise.all_notes();
  EXPECT_EQ(noise.notes.size(), 1U) << noise.all_notes();
  const Told nothing = told_of(begin() + accel(1, 1600000, -9.5F) + std::string(100000, '\x01'));
  EXPECT_EQ(nothing.records.size(), 1U);
  EXPECT_TRUE(nothing.noted("can be read")) << nothing.all_notes();
}

TEST(UlogDamage, TimeThatGoesBackAndAnotherDeviceAreNoted) {
  const Told told = told_of(begin() + accel(1, 1500000, -9.5F) + accel(1, 1400000, -9.5F) +
                            accel(1, 1600000, -9.5F, 44) + accel(1, 500000, std::nanf("")));
  EXPECT_EQ(told.records.size(), 2U);
  EXPECT_TRUE(told.noted("goes back by 0.1"));
  EXPECT_TRUE(told.noted("comes from device 44, not from 42"));
  EXPECT_TRUE(told.noted("is no number"));
}

TEST(UlogDamage, WhatIsNoUlogIsRefusedWithAReason) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "has 0 bytes"},
      {"time_s,x,y,z\n1,2,3,4\n", "is no ULog"},
      {"UL", "inside its header"},
      {header().substr(0, 15), "ends at byte 15"},
      {header() + flags(2), "at byte 27"},
      {header() + flags(0x100), "at byte 28"},
  };
  for (const auto& one : cases) {
    Told told;
    const auto extent = read_bytes(one.first, told);
    ASSERT_FALSE(extent.has_value()) << one.second;
    EXPECT_NE(extent.error().what.find(one.second), std::string::npos) << extent.error().text();
    EXPECT_FALSE(extent.error().remedy.empty());
  }
  Told told;
  EXPECT_FALSE(read_ulog("/nowhere/at/all.ulg", told).has_value());
  EXPECT_FALSE(read_ulog("/", told).has_value());
  std::string newer = small_log();
  newer[7] = '\x09';
  EXPECT_TRUE(told_of(newer).noted("version 9"));
}

TEST(UlogDamage, CutAnywhereTheRecordsBeforeTheCutAreHandedOn) {
  const std::string bytes = small_log();
  const Told whole = told_of(bytes);
  std::size_t most = 0;
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    Told told;
    const auto extent = read_bytes(bytes.substr(0, cut), told);
    ASSERT_EQ(extent.has_value(), cut >= 16) << cut;
    if (!extent) continue;
    ASSERT_GE(told.records.size(), most) << cut;
    most = told.records.size();
    ASSERT_NO_FATAL_FAILURE(expect_prefix(told, whole)) << cut;
    for (const auto& note : told.notes) ASSERT_LT(note.offset, cut);
    ASSERT_EQ(told.notes.empty(), extent->read_bytes == cut) << cut << "\n" << told.all_notes();
  }
  EXPECT_EQ(most + 1, whole.records.size());
}

RC_GTEST_PROP(UlogDamageProperties, NoByteThatWasChangedDoesHarm, ()) {
  std::string bytes = small_log();
  const auto flips = *rc::gen::inRange<int>(1, 12);
  for (int k = 0; k < flips; ++k) {
    const auto place = *rc::gen::inRange<std::size_t>(0, bytes.size());
    bytes[place] = static_cast<char>(*rc::gen::inRange<int>(0, 256));
  }
  bytes.resize(*rc::gen::inRange<std::size_t>(bytes.size() / 2, bytes.size() + 1));
  Told told;
  const auto extent = read_bytes(bytes, told);
  if (!extent) {
    RC_ASSERT(!extent.error().remedy.empty());
    return;
  }
  RC_ASSERT(extent->read_bytes <= extent->bytes);
  RC_ASSERT(extent->bytes == bytes.size());
  RC_ASSERT(extent->records == told.records.size());
  for (const auto& note : told.notes) RC_ASSERT(note.offset < bytes.size());
  for (const auto& one : told.records) RC_ASSERT(std::isfinite(plumb::norm(one.second.specific_force_mps2)));
}

RC_GTEST_PROP(UlogDamageProperties, OneChangedByteCostsFewRecords, ()) {
  std::string bytes = begin();
  const std::size_t from = bytes.size();
  for (std::uint64_t k = 0; k < 40; ++k) bytes += accel(1, 1500000 + 1000 * k, -9.75F);
  const auto place = *rc::gen::inRange<std::size_t>(from, bytes.size());
  bytes[place] = static_cast<char>(*rc::gen::inRange<int>(0, 256));
  Told told;
  RC_ASSERT(read_bytes(bytes, told).has_value());
  RC_ASSERT(told.records.size() + 4 >= 40U || told.sources[0].device_id != 42U);
}

}  // namespace
}  // namespace ulog_damage_test
