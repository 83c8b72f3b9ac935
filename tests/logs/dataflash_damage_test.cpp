// DataFlash logs with bytes that are damaged, missing or of another format: what is wrong is noted, and the rest is
// read.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>

#include "dataflash_test_support.hpp"
#include "plumb/logs/flight_log.hpp"

namespace dataflash_damage_test {
namespace {

using namespace dataflash_test_support;

TEST(DataflashDamage, FindsItsWayAfterGarbage) {
  Log log = new_log();
  imu_at(log, 1e6);
  const std::size_t garbage = log.size();
  log.raw("what is this \xA3\x95\xFE\xA3\x95 and \xA3 this");
  const std::size_t bytes = log.size() - garbage + 3 + static_cast<std::size_t>(Log::size_of(kImuLetters));
  imu_at(log, 2e6);
  imu_at(log, 3e6);
  const Read out = read(log);
  EXPECT_EQ(out.heard.records.size(), 2U);  // what garbage follows may have been cut short
  ASSERT_EQ(out.heard.notes.size(), 1U) << out.heard.all_notes();
  EXPECT_NE(out.heard.notes[0].what.find(std::to_string(bytes) + " bytes were passed over"), std::string::npos)
      << out.heard.all_notes();
}

TEST(DataflashDamage, AMessageThatWasCutShortIsNotReadWithTheNextOnesBytes) {
  Log log = new_log();
  imu_at(log, 1e6);
  Log one = new_log();
  const std::size_t begin = one.size();
  imu_at(one, 2e6);
  log.raw(one.bytes().substr(begin, 30));
  for (int k = 0; k < 3; ++k) imu_at(log, 3e6 + k);
  const Read out = read(log);
  ASSERT_EQ(out.heard.records.size(), 4U);
  for (const auto& [source, record] : out.heard.records) EXPECT_EQ(record.specific_force_mps2[2], -9.75);
  EXPECT_EQ(out.heard.notes.size(), 1U) << out.heard.all_notes();
}

TEST(DataflashDamage, SkipsAMessageThatNoFmtDescribes) {
  Log log = new_log();
  imu_at(log, 1e6);
  const std::size_t at = log.size();
  log.raw(std::string("\xA3\x95\x63", 3) + "12345");
  imu_at(log, 2e6);
  const Read out = read(log);
  EXPECT_EQ(out.heard.records.size(), 2U);
  ASSERT_EQ(out.heard.notes.size(), 1U) << out.heard.all_notes();
  EXPECT_EQ(out.heard.notes[0].offset, at);
  EXPECT_NE(out.heard.notes[0].what.find("type 99: 8 bytes"), std::string::npos) << out.heard.all_notes();
}

TEST(DataflashDamage, TheSameTroubleIsToldFiveTimesAndThenCounted) {
  Log log = new_log();
  for (int k = 0; k < 100; ++k) {
    imu_at(log, 1e6 + k);
    log.raw(std::string("\xA3\x95\x63", 3));
  }
  const Read out = read(log);
  EXPECT_EQ(out.heard.records.size(), 100U);
  ASSERT_EQ(out.heard.notes.size(), 6U) << out.heard.all_notes();
  EXPECT_NE(out.heard.notes[5].what.find("95 more"), std::string::npos) << out.heard.all_notes();
}

TEST(DataflashDamage, TakesAnFmtThatIsDefinedAnew) {
  Log log = new_log();
  imu_at(log, 1e6);
  log.fmt(kImu, "IMU", kImuLetters, kImuLabels);  // the same again, as in logs put behind each other
  imu_at(log, 2e6);
  const std::size_t at = log.size();
  log.fmt(kImu, "IMU", "Qddd", "TimeUS,AccX,AccY,AccZ");
  log.message(kImu, {3e6, 1.0, 2.0, 3.0});
  const Read out = read(log);
  ASSERT_EQ(out.heard.records.size(), 3U);
  EXPECT_EQ(out.heard.records[2].second.specific_force_mps2, (Axes{1.0, 2.0, 3.0}));
  ASSERT_EQ(out.heard.notes.size(), 1U) << out.heard.all_notes();
  EXPECT_EQ(out.heard.notes[0].offset, at);
}

TEST(DataflashDamage, GoesOnPastAnFmtThatContradictsItself) {
  Log log = new_log();
  log.fmt(20, "IMU2", "Qffff", "TimeUS,AccX,AccY,AccZ", 0);  // a label is missing
  log.fmt(21, "ACC1", "Qff", "TimeUS,AccX,AccY,AccZ", 0);    // a letter is missing
  log.fmt(22, "ACC2", "Qfff", "TimeUS,AccX,AccY,AccZ", 40);  // longer than its letters
  log.fmt(23, "ACC3", "Qfff", "TimeUS,AccX,AccY,AccZ", 2);   // shorter than its head
  log.fmt(24, "IMU3", "Qfffff", "TimeUS,AccX,AccY,AccZ,Gone,Far");
  std::string bytes = log.bytes();
  bytes[bytes.rfind("Qfffff") + 4] = '?';
  Log rest = log;
  rest.message(20, {1e6, 1.0, 2.0, 3.0, 4.0}).message(21, {1e6, 1.0, 2.0});
  rest.message(22, {1e6, 1.0, 2.0, 3.0}).raw(std::string(40 - 23, 'x'));
  rest.message(24, {1e6, 1.0, 2.0, 3.0, 4.0, 5.0});
  imu_at(rest, 2e6);
  const Read out = read(bytes + rest.bytes().substr(bytes.size()));
  ASSERT_TRUE(out.is_read);
  ASSERT_EQ(out.heard.records.size(), 3U) << out.heard.all_notes();
  EXPECT_EQ(out.heard.sources[0].name, "IMU[1]");
  EXPECT_EQ(out.heard.sources[1].name, "IMU[2]");
  EXPECT_DOUBLE_EQ(out.heard.records[1].second.time_s, 1.0);
  EXPECT_EQ(out.heard.sources[2].name, "IMU[0]");
  EXPECT_EQ(out.heard.notes.size(), 5U) << out.heard.all_notes();
  EXPECT_EQ(out.heard.notes_with("length of 2 bytes"), 1U) << out.heard.all_notes();
  EXPECT_EQ(out.heard.notes_with("40 bytes long"), 1U) << out.heard.all_notes();
  EXPECT_EQ(out.heard.notes_with("unknown format letter '?'"), 1U) << out.heard.all_notes();
}

TEST(DataflashDamage, ReadingsThatAreNoNumberAreAbsent) {
  Log log = new_log();
  Imu m;
  m.force[1] = std::numeric_limits<double>::infinity();
  m.temperature = std::nan("");
  imu(log, m);
  const Read out = read(log);
  ASSERT_EQ(out.heard.records.size(), 1U);
  EXPECT_EQ(out.heard.records[0].second.specific_force_mps2[0], 0.75);
  EXPECT_TRUE(std::isnan(out.heard.records[0].second.specific_force_mps2[1]));
  EXPECT_EQ(out.heard.notes_with("no finite number"), 1U) << out.heard.all_notes();
}

TEST(DataflashDamage, ParametersWithoutANameAreLeftOut) {
  Log log = new_log();
  log.message(kParm, {0.0, "", 1.0, 0.0});
  log.message(kParm, {0.0, "A\x1b[31mB", 1.0, 0.0});
  log.message(kParm, {0.0, "SIXTEEN_LETTERS_", 1.0, 0.0});
  const Read out = read(log);
  ASSERT_EQ(out.heard.parameters.size(), 1U);
  EXPECT_EQ(out.heard.parameters[0].first, "SIXTEEN_LETTERS_");
  EXPECT_EQ(out.heard.notes_with("\\x1b"), 1U) << out.heard.all_notes();
}

TEST(DataflashDamage, SaysWhereALogHasNoAccelerometer) {
  Log log = new_log();
  log.message(kParm, {0.0, "INS_ACC_ID", 1.0, 0.0});
  const Read out = read(log);
  ASSERT_TRUE(out.is_read);
  EXPECT_EQ(out.heard.parameters.size(), 1U);
  EXPECT_EQ(out.heard.notes_with("no message of an accelerometer"), 1U);
}

TEST(DataflashDamage, RefusesWhatIsNone) {
  const std::map<std::string, std::string> cases = {
      {"", "empty"},
      {"hello, world", "no FMT message"},
      {"\xA3", "no FMT message"},
      {std::string("\xA3\x95\x80\x80", 4), "no FMT message"},
      {std::string(100000, '\xA3'), "no FMT message"},
      {"FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns", "turned into text"},
      {std::string("ULog\x01\x12\x35\x01", 8), "ULog"},
      {std::string("\x1F\x8B\x08\x00", 4), "gzip"},
      {"\x89MCAP0\r\n", "MCAP"},
      {std::string("SQLite format 3\0", 16), "SQLite"}};
  for (const auto& [bytes, what] : cases) {
    const Read out = read(bytes);
    ASSERT_FALSE(out.is_read) << what;
    EXPECT_NE(out.error.what.find(what), std::string::npos) << out.error.text();
    EXPECT_TRUE(out.heard.notes.empty()) << out.heard.all_notes();
  }
  Told heard;
  EXPECT_FALSE(read_dataflash(testing::TempDir() + "no/such/file.bin", heard).has_value());
  EXPECT_FALSE(read_dataflash(testing::TempDir(), heard).has_value());
}

TEST(DataflashDamage, ALogCutAtAnyByteHandsOnThePrefix) {
  const std::string bytes = everything().bytes();
  const Read whole = read(bytes);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Read part = read(bytes.substr(0, size));
    EXPECT_EQ(part.is_read, size >= 89);
    if (!part.is_read) continue;
    EXPECT_EQ(part.extent.read_bytes < size, part.heard.notes_with("the log ends within") == 1);
    ASSERT_NO_FATAL_FAILURE(expect_prefix(part.heard, whole.heard)) << size;
  }
}

/// Of a damaged log the last message counts where the file ends behind it, and does not where garbage follows.
RC_GTEST_PROP(DataflashDamage, ADamagedLogCutShortHandsOnThePrefixButForTheLastMessage, ()) {
  std::string bytes = everything().bytes();
  for (int k = *rc::gen::inRange(1, 20); k > 0; --k) {
    bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] = *rc::gen::arbitrary<char>();
  }
  const Read whole = read(bytes);
  Read part = read(bytes.substr(0, *rc::gen::inRange<std::size_t>(0, bytes.size() + 1)));
  if (!part.heard.records.empty()) part.heard.records.pop_back();
  if (!part.heard.parameters.empty()) part.heard.parameters.pop_back();
  ASSERT_NO_FATAL_FAILURE(expect_prefix(part.heard, whole.heard));
}

RC_GTEST_PROP(DataflashDamage, FlippedDroppedAndInsertedBytesNeverStopTheReading, ()) {
  std::string bytes = everything().bytes();
  for (int k = *rc::gen::inRange(1, 60); k > 0; --k) {
    const std::size_t at = *rc::gen::inRange<std::size_t>(0, bytes.size());
    const auto value = static_cast<char>(*rc::gen::element(0x00, 0x80, 0x95, 0xA3, 0xFF, *rc::gen::inRange(0, 256)));
    switch (*rc::gen::inRange(0, 4)) {
      case 0: bytes.erase(at, *rc::gen::inRange<std::size_t>(1, 100)); break;
      case 1: bytes.insert(at, 1, value); break;
      default: bytes[at] = value; break;
    }
    if (bytes.empty()) bytes = "x";
  }
  const Read out = read(bytes);
  RC_ASSERT(out.heard.notes.size() < 100U);
}

}  // namespace
}  // namespace dataflash_damage_test
