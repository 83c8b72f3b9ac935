// DataFlash logs: what they hold is handed on, in the forms of old and new ArduPilot.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dataflash_test_support.hpp"
#include "plumb/logs/flight_log.hpp"

namespace dataflash_test {
namespace {

using namespace dataflash_test_support;

TEST(Dataflash, HandsOnWhatAnImuMessageHolds) {
  Log log = new_log();
  log.message(kFmtu, {0.0, static_cast<double>(kImu), "s#EEEooo--O--zz", "F-000000-----00"});
  imu_at(log, 1234567, 1);
  const Read out = read(log);
  ASSERT_TRUE(out.is_read);
  EXPECT_TRUE(out.heard.notes.empty()) << out.heard.all_notes();
  ASSERT_EQ(out.heard.sources.size(), 1U);
  EXPECT_EQ(out.heard.sources[0].name, "IMU[1]");
  EXPECT_EQ(out.heard.sources[0].instance, 1);
  EXPECT_EQ(out.heard.sources[0].kind, RecordKind::sample);
  ASSERT_EQ(out.heard.records.size(), 1U);
  const ImuRecord& record = out.heard.records[0].second;
  EXPECT_DOUBLE_EQ(record.time_s, 1.234567);
  EXPECT_EQ(record.specific_force_mps2, (Axes{0.75, -1.5, -9.75}));
  EXPECT_EQ(record.rate_radps, (Axes{0.125, -0.25, 0.5}));
  EXPECT_EQ(record.temperature_degc, 41.5);
  EXPECT_EQ(record.count, 1U);
  EXPECT_EQ(out.extent.read_bytes, log.size());
}

TEST(Dataflash, KeepsInstancesAndMessagesApart) {
  const Read out = read(everything());
  ASSERT_TRUE(out.is_read);
  EXPECT_TRUE(out.heard.notes.empty()) << out.heard.all_notes();
  ASSERT_EQ(out.heard.sources.size(), 4U);
  EXPECT_EQ(out.heard.sources[2].name, "IMU[2]");
  EXPECT_EQ(out.heard.sources[3].name, "ACC[1]");
  EXPECT_EQ(out.heard.sources[0].device_id, 2753028U);
  EXPECT_EQ(out.heard.sources[1].device_id, 0U);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(out.heard.records_of(k).size(), 4U);
  const ImuRecord acc = out.heard.records_of(3)[0];
  EXPECT_DOUBLE_EQ(acc.time_s, 0.9999);  // when it was sampled, not when it was written
  EXPECT_EQ(acc.specific_force_mps2, (Axes{0.5, 0.25, -9.5}));
  EXPECT_TRUE(std::isnan(acc.rate_radps[0]));
  EXPECT_TRUE(std::isnan(acc.temperature_degc));
  ASSERT_EQ(out.heard.parameters.size(), 2U);
  EXPECT_EQ(out.heard.parameters[1], std::make_pair(std::string("INS_ACCOFFS_X"), 0.5));
}

TEST(Dataflash, TheFirstLookAtClipsIsNoIncrement) {
  const std::vector<ImuRecord> records = read(everything()).heard.records_of(2);
  ASSERT_EQ(records.size(), 4U);
  EXPECT_EQ(records[0].clipped[0], 0U);
  EXPECT_EQ(records[1].clipped[0], 0U);
  EXPECT_EQ(records[2].clipped[0], 7U);
  EXPECT_EQ(records[3].clipped[0], 7U);
  EXPECT_EQ(records[3].clipped[1], 0U);
}

TEST(Dataflash, ReadsLogsWithoutInstanceColumn) {
  Log log;
  log.fmt(1, "IMU", "QffffffIIfBB", "TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,ErrG,ErrA,Temp,GyHlt,AcHlt");
  log.fmt(2, "IMU2", "QffffffIIfBB", "TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,ErrG,ErrA,Temp,GyHlt,AcHlt");
  log.fmt(3, "ACC3", "QQfff", "TimeUS,SampleUS,AccX,AccY,AccZ");
  log.fmt(4, "VIBE", "QfffIII", "TimeUS,VibeX,VibeY,VibeZ,Clip0,Clip1,Clip2");
  log.fmt(5, "PARM", "QNf", "TimeUS,Name,Value");
  log.message(5, {0.0, "INS_ACC2_ID", 1442082.0});
  log.message(4, {1e6, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0});
  log.message(4, {1e6, 0.0, 0.0, 0.0, 1.0, 4.0, 6.0});
  for (const std::uint8_t type : {std::uint8_t{1}, std::uint8_t{2}}) {
    log.message(type, {2e6, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 0.0, 0.0, 30.0, 1.0, 1.0});
  }
  log.message(3, {2e6, 0.0, 1.0, 2.0, 3.0});
  const Read out = read(log);
  ASSERT_TRUE(out.is_read);
  EXPECT_TRUE(out.heard.notes.empty()) << out.heard.all_notes();
  ASSERT_EQ(out.heard.sources.size(), 3U);
  EXPECT_EQ(out.heard.sources[0].name, "IMU[0]");
  EXPECT_EQ(out.heard.sources[1].name, "IMU[1]");
  EXPECT_EQ(out.heard.sources[1].device_id, 1442082U);
  EXPECT_EQ(out.heard.sources[2].name, "ACC[2]");
  EXPECT_EQ(out.heard.records_of(0)[0].clipped[0], 0U);
  EXPECT_EQ(out.heard.records_of(1)[0].clipped[0], 2U);
  EXPECT_EQ(out.heard.records_of(2)[0].clipped[0], 3U);  // there is no IMU of the instance 2
  EXPECT_EQ(out.heard.records_of(1)[0].temperature_degc, 30.0);
  EXPECT_DOUBLE_EQ(out.heard.records_of(2)[0].time_s, 2.0);  // a driver that does not know when it sampled writes 0
}

TEST(Dataflash, ReadsMilliseconds) {
  Log log;
  log.fmt(1, "IMU3", "Iffffff", "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ");
  log.message(1, {2500.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0});
  const Read out = read(log);
  ASSERT_EQ(out.heard.records.size(), 1U);
  EXPECT_EQ(out.heard.sources[0].instance, 2);
  EXPECT_DOUBLE_EQ(out.heard.records[0].second.time_s, 2.5);
}

TEST(Dataflash, ReadsEveryFormatLetterOfANumber) {
  struct Case {
    char letter;
    double written;
    double read;
  };
  const std::vector<Case> cases = {{'b', -3, -3},     {'B', 200, 200},   {'h', -300, -300},     {'H', 65535, 65535},
                                   {'i', -7e4, -7e4}, {'I', 4e9, 4e9},   {'f', 0.5, 0.5},       {'d', 0.1, 0.1},
                                   {'c', -250, -2.5}, {'C', 250, 2.5},   {'e', -250, -2.5},     {'E', 250, 2.5},
                                   {'M', 9, 9},       {'q', -5e9, -5e9}, {'Q', 5e9, 5e9},       {'g', 0x3E00, 1.5},
                                   {'g', 0xC500, -5}, {'L', 1e7, 1.0},   {'g', 0x0001, 0x1p-24}};
  for (const Case& c : cases) {
    Log log;
    log.fmt(1, "IMU", std::string("Qnff") + c.letter + "aNZ", "TimeUS,Pad,AccX,AccY,AccZ,A,B,C");
    log.message(1, {1.0, "abc", 1.0, 2.0, c.written, 0.0, "", ""});
    const Read out = read(log);
    ASSERT_EQ(out.heard.records.size(), 1U) << c.letter;
    EXPECT_DOUBLE_EQ(out.heard.records[0].second.specific_force_mps2[2], c.read) << c.letter;
    EXPECT_TRUE(out.heard.notes.empty()) << out.heard.all_notes();
  }
}

TEST(Dataflash, ConvertsUnitsThatTheLogNames) {
  Log log = new_log();
  log.message(kUnit, {0.0, static_cast<double>('w'), "cm/s/s"});
  log.message(kUnit, {0.0, static_cast<double>('v'), "parsec"});
  log.message(kMult, {0.0, static_cast<double>('X'), 0.5});
  log.message(kFmtu, {0.0, static_cast<double>(kImu), "s#EEkwov--O--zz", "C-000X-0-----00"});
  for (int k = 0; k < 3; ++k) imu_at(log, 1e3 + k);
  const Read out = read(log);
  ASSERT_EQ(out.heard.records.size(), 3U);
  const ImuRecord& record = out.heard.records[0].second;
  EXPECT_DOUBLE_EQ(record.time_s, 1.0);
  EXPECT_DOUBLE_EQ(record.rate_radps[2], 0.5 * 3.14159265358979323846 / 180.0);
  EXPECT_DOUBLE_EQ(record.specific_force_mps2[0], 0.75 * 0.5 * 0.01);
  EXPECT_EQ(record.specific_force_mps2[1], -1.5);
  EXPECT_TRUE(std::isnan(record.specific_force_mps2[2]));                     // of a unit that nobody knows: no reading
  EXPECT_EQ(out.heard.notes_with("converted"), 3U) << out.heard.all_notes();  // once a column, not once a message
  EXPECT_EQ(out.heard.notes_with("unknown here: its readings are left out"), 1U) << out.heard.all_notes();
}

TEST(Dataflash, NotesAClockThatStartsAnew) {
  Log log = new_log();
  imu_at(log, 90e6);
  log.message(kVibe, {90e6, 0.0, 0.0, 0.0, 0.0, 5.0});
  const std::size_t second = log.size();
  imu_at(log, 2e6);
  log.message(kVibe, {2e6, 0.0, 0.0, 0.0, 0.0, 9.0});
  imu_at(log, 3e6);
  const Read out = read(log);
  ASSERT_EQ(out.heard.records.size(), 3U);
  ASSERT_EQ(out.heard.notes.size(), 1U) << out.heard.all_notes();
  EXPECT_EQ(out.heard.notes[0].offset, second);
  EXPECT_NE(out.heard.notes[0].what.find("from 90.000 s to 2.000 s"), std::string::npos);
  EXPECT_EQ(out.heard.records[2].second.clipped[0], 0U);  // counts of another start are no increment
}

TEST(Dataflash, NotesErrorsThatGrowOncePerInstance) {
  Log log = new_log();
  for (int k = 0; k < 20; ++k) {
    Imu m;
    m.time_us = 1e6 + k;
    m.force_errors = 3 + 2 * k;
    imu(log, m);
    m.instance = 1;
    m.force_errors = 8;
    imu(log, m);
  }
  log.message(kDsf, {2e6, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  const Read out = read(log);
  ASSERT_EQ(out.heard.notes.size(), 2U) << out.heard.all_notes();
  EXPECT_NE(out.heard.notes[0].what.find("IMU[0]"), std::string::npos);
  EXPECT_NE(out.heard.notes[0].what.find("38 of the accelerometer"), std::string::npos) << out.heard.all_notes();
  EXPECT_NE(out.heard.notes[1].what.find("lost (DSF.Dp) from here on: 4"), std::string::npos) << out.heard.all_notes();
}

TEST(Dataflash, FindsMessagesAcrossTheWindows) {
  Log log = new_log();
  std::size_t count = 0;
  while (log.size() < (9U << 20U)) imu_at(log, 1e6 + 1000.0 * static_cast<double>(count++));
  const Read out = read(log);
  EXPECT_EQ(out.heard.records.size(), count);
  EXPECT_TRUE(out.heard.notes.empty()) << out.heard.all_notes();
}

}  // namespace
}  // namespace dataflash_test
