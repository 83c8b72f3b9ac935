// One door for all logs: what a file is, by its first bytes.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dataflash_test_support.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ros_fixture.hpp"
#include "told.hpp"
#include "ulog_told.hpp"

namespace read_log_test {
namespace {

using namespace plumb::logs;
using namespace logs_told;

plumb::io::FileExpected<LogFormat> format_of(const std::string& bytes) {
  const LogFile file(bytes);
  return log_format(file.path());
}

TEST(ReadLog, FormatsHaveNames) {
  std::set<std::string> names;
  for (const LogFormat format : kLogFormats) names.insert(to_string(format));
  EXPECT_EQ(names, (std::set<std::string>{"ULog", "DataFlash", "MCAP", "rosbag2", "CSV"}));
}

TEST(ReadLog, AFormatIsKnownByItsFirstBytes) {
  const std::vector<std::pair<std::string, LogFormat>> cases = {
      {ulog_told::small_log(), LogFormat::ulog},
      {dataflash_test_support::everything().bytes(), LogFormat::dataflash},
      {std::string(300, '\0') + "\xA3\x95\x80", LogFormat::dataflash},
      {std::string("\x89MCAP0\r\n\x01", 9), LogFormat::mcap},
      {std::string("SQLite format 3\0\x10", 17), LogFormat::rosbag2},
      {"t,ax,ay,az\n0,1,2,3\n", LogFormat::csv},
      {"\xEF\xBB\xBFt;ax\n", LogFormat::csv},
      {std::string("\xFF\xFEt\0,\0a\0x\0", 10), LogFormat::csv},
      {std::string("\xFE\xFF\0t\0,\0a\0x", 10), LogFormat::csv},
      {std::string("t\0,\0a\0x\0\n\0", 10), LogFormat::csv},
      {"Zeit;Beschleunigung [m/s\xB2]\r\n", LogFormat::csv},
  };
  for (const auto& [bytes, format] : cases) {
    const auto found = format_of(bytes);
    ASSERT_TRUE(found.has_value()) << found.error().text();
    EXPECT_STREQ(to_string(*found), to_string(format)) << bytes.substr(0, 20);
  }
}

TEST(ReadLog, WhatIsNoLogIsNamedForWhatItIs) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "0 bytes"},
      {std::string("\x1F\x8B\x08\0\0\0\0\0", 8), "gzip"},
      {"\x28\xB5\x2F\xFD", "zstd"},
      {std::string("\xFD"
                   "7zXZ\0\0",
                   7),
       "xz"},
      {"BZh91AY&SY\x1", "bzip2"},
      {"PK\x03\x04\x14", "zip archive"},
      {"%PDF-1.7\n", "PDF"},
      {"#ROSBAG V2.0\n", "ROS 1"},
      {"PAR1\x15\x04", "Parquet"},
      {std::string(257, 'a') + "ustar", "tar archive"},
      {"\x89PLOG\r\n\x1A", "binary log of plumb before it wrote ULog"},
      {"\x89HDF\r\n\x1A\n", "HDF5"},
      {"<!DOCTYPE html>\n<html>", "page of the web"},
      {"\x7F"
       "ELF\x02",
       "program"},
      {std::string("\0\1\2\3\4\5\6\7", 8), "binary data of no known format"},
      {std::string(2000, '\x01'), "binary data of no known format"},
  };
  for (const auto& [bytes, what] : cases) {
    const auto found = format_of(bytes);
    ASSERT_FALSE(found.has_value()) << what;
    EXPECT_NE(found.error().what.find(what), std::string::npos) << found.error().text();
    EXPECT_FALSE(found.error().remedy.empty()) << what;
    EXPECT_EQ(found.error().code, plumb::io::ExitCode::invalid_input);
    Told told;
    const LogFile file(bytes);
    EXPECT_FALSE(read_log(file.path(), told).has_value()) << what;
  }
  EXPECT_NE(log_format("/").error().what.find("directory"), std::string::npos);
  EXPECT_FALSE(log_format("/nowhere/at/all").has_value());
  EXPECT_NE(log_format("/dev/null").error().what.find("no regular file"), std::string::npos);
}

TEST(ReadLog, BagsAndTablesComeThroughTheSameDoor) {
  for (const std::string name : {"mcap_core_chunks.mcap", "sqlite_cli_new.db3"}) {
    Told told;
    ASSERT_TRUE(read_log(ros_fixture::path_of(name), told).has_value()) << name;
    ASSERT_NO_FATAL_FAILURE(ros_fixture::expect_left_and_right(told)) << name;
  }
  Told table;
  const LogFile file("time_s;ax_mps2;ay_mps2;az_mps2\n0;0,5;-0,25;9,5\n0,01;0,5;-0,25;9,5\n");
  ASSERT_TRUE(read_log(file.path(), table).has_value());
  EXPECT_EQ(table.records.size(), 2U);
  EXPECT_NE(table.understood.find("decimal comma"), std::string::npos) << table.understood;
}

TEST(ReadLog, TheReaderOfTheFormatReadsIt) {
  const std::string bytes = ulog_told::small_log();
  const Told direct = ulog_told::told_of(bytes);
  Told told;
  const LogFile file(bytes);
  const auto extent = read_log(file.path(), told);
  ASSERT_TRUE(extent.has_value()) << extent.error().text();
  EXPECT_EQ(told.records.size(), direct.records.size());
  EXPECT_EQ(told.all_notes(), "");

  const dataflash_test_support::Read expected = dataflash_test_support::read(dataflash_test_support::everything());
  Told flash;
  const LogFile other(dataflash_test_support::everything().bytes());
  ASSERT_TRUE(read_log(other.path(), flash).has_value());
  EXPECT_EQ(flash.records.size(), expected.heard.records.size());
}

}  // namespace
}  // namespace read_log_test
