// [[clock]] of an array file: what is read, what is refused and where.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "io_test_support.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/io/upgrade.hpp"

namespace array_clocks_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

const std::string kClock = R"([[clock]]
package = "imu2"
gyro = "second"
time = "t2_s"
sample_period_s = 0.0025
offset_s = -0.5
rate = "30 ppm"
since_s = 7
valid_s = 100
offset_bound_s = 20e-6
rate_bound = 1e-6
)";

/// kArrayText with two chips of two sensors each, two gyros, and [motion] with these lines before the sensors.
std::string with_clocks(const std::string& clocks = kClock, const std::string& motion = "sample_period_s = 0.002\n") {
  const std::string columns =
      "rotation_radps = [\"wx\", \"wy\", \"wz\"]\nsecond_rotation_radps = [\"ux\", \"uy\", \"uz\"]\nreads = ";
  std::string out = changed("reads = ", columns, changed("[[sensor]]", "[motion]\n" + motion + clocks + "[[sensor]]"));
  for (const char* id : {"A1", "A2", "A3", "A4"}) {
    const std::string line = std::string("id = \"") + id + "\"";
    out = changed(line, line + "\npackage = \"" + (id[1] < '3' ? "imu1" : "imu2") + "\"", out);
  }
  return out;
}

int line_of(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
}

FileError refusal_of(const std::string& text) {
  const FileExpected<ArrayFile> file = parse_array_text(text, "tool.toml");
  if (!file) return file.error();
  ADD_FAILURE() << "taken:\n" << text;
  return {};
}

// Verifies: REQ-207
TEST(ArrayClocks, ReadsEveryKey) {
  const ArrayFile file = array_of(with_clocks());
  ASSERT_EQ(file.motion.clocks.size(), 1U);
  const ClockSpec& one = file.motion.clocks[0];
  EXPECT_EQ(one.name, "imu2");
  EXPECT_EQ(one.clock.sensors, SensorSet::of(2).with(3));
  EXPECT_FALSE(one.clock.gyro[0]);
  EXPECT_TRUE(one.clock.gyro[1]);
  EXPECT_EQ(one.sample_period_s, 0.0025);
  EXPECT_EQ(one.clock.offset_s, -0.5);
  EXPECT_DOUBLE_EQ(one.clock.rate, 30e-6);
  EXPECT_EQ(one.clock.since_s, 7.0);
  EXPECT_EQ(one.clock.valid_s, 100.0);
  EXPECT_EQ(one.clock.offset_bound_s, 20e-6);
  EXPECT_EQ(one.clock.rate_bound, 1e-6);
  EXPECT_EQ(file.input.clock_columns, std::vector<std::string>{"t2_s"});
  EXPECT_EQ(file.motion.clock_wait_s, 0.025) << "ten periods of the slowest chip";
  EXPECT_EQ(array_of(with_clocks(kClock, "sample_period_s = 0.002\nclock_wait_s = 0.05\n")).motion.clock_wait_s, 0.05);
}

TEST(ArrayClocks, WhatIsNotStatedIsAClockThatAgreesWithTheLogs) {
  const ArrayFile file =
      array_of(with_clocks("[[clock]]\ngyro = \"both\"\ntime = \"t_s\"\noffset_bound_s = 0\nrate_bound = 0\n"));
  const ClockSpec& one = file.motion.clocks.at(0);
  EXPECT_EQ(one.name, "both gyros");
  EXPECT_TRUE(one.clock.sensors.empty());
  EXPECT_FALSE(one.sample_period_s.has_value());
  EXPECT_EQ(one.clock.offset_s, 0.0);
  EXPECT_EQ(one.clock.valid_s, 3600.0);
  EXPECT_TRUE(array_of().motion.clocks.empty());
  EXPECT_TRUE(array_of().input.clock_columns.empty());
}

TEST(ArrayClocks, AloneTheyAskForMotion) {
  std::string text = with_clocks();
  text = changed("[motion]\nsample_period_s = 0.002\n", "", text);
  const ArrayFile file = array_of(text);
  EXPECT_FALSE(file.motion.stated);
  EXPECT_TRUE(file.motion.mentioned) << "without [motion] a clock has no effect, and somebody is to be told";
}

TEST(ArrayClocks, AnUpgradeKeepsAllOfIt) {
  const std::string old = changed("window = 16", "window = 16\npatience = 5", with_clocks());
  const auto now = upgrade_text(old, "array.toml");
  ASSERT_TRUE(now.has_value());
  EXPECT_NE(now->text.find(kClock), std::string::npos);
  EXPECT_EQ(array_of(now->text).motion.clocks.size(), 1U);
}

// Negative: REQ-207
TEST(ArrayClocks, RefusesWhatIsWrongWithLineFieldAndRemedy) {
  struct Case {
    const char *from, *to, *field, *what, *remedy;
  };
  const Case cases[] = {
      {"package = \"imu2\"\ngyro", "package = \"imu3\"\ngyro", "clock[1].package", "is the package of no sensor",
       "packages of this file: imu1, imu2"},
      {"gyro = \"second\"", "gyro = \"third\"", "clock[1].gyro", "third", "first"},
      {"package = \"imu2\"\ngyro = \"second\"\n", "", "clock[1]", "neither which chip nor which gyro", "package"},
      {"time = \"t2_s\"\n", "", "clock[1].time", "is missing", "name the column"},
      {"time = \"t2_s\"", "time = \"a1_v\"", "clock[1].time", "is a sensor's column already", "name the column"},
      {"time = \"t2_s\"", "time = \"uy\"", "clock[1].time", "is in input.second_rotation_radps already", "name"},
      {"time = \"t2_s\"", "time = \"\"", "clock[1].time", "is empty", "name the column"},
      {"offset_bound_s = 20e-6\n", "", "clock[1].offset_bound_s", "is missing", "0 where it cannot be"},
      {"rate_bound = 1e-6\n", "", "clock[1].rate_bound", "is missing", "0 where it cannot be"},
      {"rate_bound = 1e-6", "rate_bound = -1e-6", "clock[1].rate_bound", "out of range", "0.05"},
      {"rate = \"30 ppm\"", "rate = 0.06", "clock[1].rate", "out of range", "-0.05"},
      {"sample_period_s = 0.0025", "sample_period_s = 2", "clock[1].sample_period_s", "out of range", "1 s"},
      {"offset_s = -0.5", "offset_s = \"-0.5 s\"", "clock[1].offset_s", "must be a number", "without quotes"},
      {"offset_s = -0.5", "offset = -0.5", "clock[1].offset", "is not a known key", "offset_s"},
      {"valid_s = 100", "valid_s = 2000", "clock[1].offset_bound_s", "more than one common sample period",
       "a shorter valid_s"},
      {"sample_period_s = 0.0025", "sample_period_s = 0.02", "clock[1].sample_period_s", "more than eight times",
       "lower rate"},
      {"[motion]\n", "[motion]\nclock_wait_s = 0.2\n", "motion.clock_wait_s", "out of range", "5 to 40"},
      {"[[clock]]", "[clock]", "clock", "must be a list", "two brackets"},
  };
  for (const Case& one : cases) {
    const std::string text = changed(one.from, one.to, with_clocks());
    const FileError error = refusal_of(text);
    EXPECT_EQ(error.file, "tool.toml");
    EXPECT_GT(error.line, 0) << one.to;
    EXPECT_EQ(error.field, one.field) << error.text();
    EXPECT_NE(error.what.find(one.what), std::string::npos) << error.text();
    EXPECT_NE(error.remedy.find(one.remedy), std::string::npos) << error.text();
  }
  const std::string unknown = changed("package = \"imu2\"\ngyro", "package = \"imu3\"\ngyro", with_clocks());
  EXPECT_EQ(refusal_of(unknown).line, line_of(unknown, "package = \"imu3\""));
}

// Negative: REQ-207
TEST(ArrayClocks, RefusesAClockThatIsStatedTwiceOrForNothing) {
  const std::string twice = with_clocks(kClock + changed("gyro = \"second\"\n", "", kClock));
  EXPECT_EQ(refusal_of(twice).field, "clock[2].package");
  EXPECT_NE(refusal_of(twice).what.find("has a clock already (clock[1], line " +
                                        std::to_string(line_of(twice, "[[clock]]")) + ")"),
            std::string::npos)
      << refusal_of(twice).text();
  const std::string gyro = with_clocks(kClock + changed("package = \"imu2\"\n", "", kClock));
  EXPECT_EQ(refusal_of(gyro).field, "clock[2].gyro");
  const std::string none = changed("second_rotation_radps = [\"ux\", \"uy\", \"uz\"]\n", "", with_clocks());
  EXPECT_NE(refusal_of(none).what.find("names no second_rotation_radps"), std::string::npos);
  const std::string wait = with_clocks("", "sample_period_s = 0.002\nclock_wait_s = 0.02\n");
  EXPECT_EQ(refusal_of(wait).what, "is given without a [[clock]]");
}

// Verifies: REQ-207
TEST(ArrayClocks, TimesOfChipsAreReadAndWrittenInTheUnitOfTheLog) {
  const ArrayFile array = array_of(changed("time = \"t_s\"", "time = \"t_ms\"\ntime_unit = \"ms\"", with_clocks()));
  const std::string head = "t_ms,wx,wy,wz,ux,uy,uz,t2_s,a1_v,a2_v,a3_v,a4_v\n";
  const std::string rows = "0,0,0,0,0,0,0,4.5,1,2,3,4\n1,0,0,0,0,0,0,,1,2,3,4\n2,0,0,0,0,0,0,nan,1,2,3,4\n";
  auto reader = LogReader::open(written("clocked.csv", head + rows), array, BadRowPolicy::stop);
  ASSERT_TRUE(reader.has_value()) << reader.error().text();
  const std::string again = written("again.csv", "");
  auto writer = LogWriter::create(again, array, LogWriter::Columns::all);
  ASSERT_TRUE(writer.has_value());
  Sample sample;
  std::vector<double> times_s;
  while (reader->next(sample) == LogReader::Next::row) {
    times_s.push_back(reader->clock_s().at(0));
    const LogWriter::Notes notes{false, reader->rotation(), 0.0, reader->second_rotation(),
                                 clock_times(reader->clock_s())};
    ASSERT_TRUE(writer->write(sample, notes).has_value());
  }
  ASSERT_EQ(times_s.size(), 3U);
  EXPECT_DOUBLE_EQ(times_s[0], 0.0045);
  EXPECT_TRUE(std::isnan(times_s[1]));
  EXPECT_TRUE(std::isnan(times_s[2]));
  ASSERT_TRUE(writer->commit().has_value());
  EXPECT_EQ(*read_file(again), head + changed("nan", "", rows));
}

// Negative: REQ-207
TEST(ArrayClocks, ALogWithoutTheColumnOrWithoutATimeInItIsRefused) {
  const ArrayFile array = array_of(with_clocks());
  const auto without =
      LogReader::open(written("without.csv", "t_s,wx,wy,wz,ux,uy,uz,a1_v,a2_v,a3_v,a4_v\n"), array, BadRowPolicy::stop);
  ASSERT_FALSE(without.has_value());
  EXPECT_EQ(without.error().field, "t2_s");
  EXPECT_NE(without.error().what.find("clock[1].time in the array file names it"), std::string::npos);
  for (const char* cell : {"soon", "inf"}) {
    auto reader = LogReader::open(written("bad.csv", "t_s,wx,wy,wz,ux,uy,uz,t2_s,a1_v,a2_v,a3_v,a4_v\n0,0,0,0,0,0,0," +
                                                         std::string(cell) + ",1,2,3,4\n"),
                                  array, BadRowPolicy::stop);
    ASSERT_TRUE(reader.has_value());
    Sample sample;
    EXPECT_EQ(reader->next(sample), LogReader::Next::error);
    EXPECT_NE(reader->error().field.find("t2_s"), std::string::npos) << reader->error().text();
  }
}

// Verifies: REQ-207
RC_GTEST_PROP(ArrayClocksLaw, WhateverATableHoldsItIsTakenOrRefusedWithARemedy, ()) {
  static const std::vector<std::string> values = {"\"imu1\"",   "\"imu2\"",
                                                  "\"\"",       "\"first\"",
                                                  "\"second\"", "\"both\"",
                                                  "\"t2_s\"",   "\"t_s\"",
                                                  "\"a1_v\"",   "0",
                                                  "1",          "-1",
                                                  "1e-6",       "1e-3",
                                                  "1e300",      "-1e300",
                                                  "inf",        "nan",
                                                  "true",       "[]",
                                                  "[1, 2]",     "{}",
                                                  "{a = 1}",    "\"30 ppm\"",
                                                  "\"1 g\"",    "9223372036854775807",
                                                  "1979-05-27"};
  static const std::vector<std::string> keys = {"package", "gyro",    "time",    "sample_period_s", "offset_s",
                                                "rate",    "since_s", "valid_s", "offset_bound_s",  "rate_bound"};
  std::string tables;
  for (int k = *rc::gen::inRange(0, 4); k > 0; --k) {
    tables += "[[clock]]\n";
    for (const std::string& key : keys) {
      if (*rc::gen::inRange(0, 4) > 0) tables += key + " = " + *rc::gen::elementOf(values) + "\n";
    }
  }
  const FileExpected<ArrayFile> file = parse_array_text(with_clocks(tables), "tool.toml");
  if (file) {
    RC_ASSERT(file->motion.clocks.size() == file->input.clock_columns.size());
    RC_ASSERT(file->motion.clocks.empty() || file->motion.clock_wait_s.has_value());
  } else {
    RC_ASSERT(!file.error().remedy.empty());
    RC_ASSERT(file.error().code == ExitCode::invalid_input);
  }
}

}  // namespace
}  // namespace array_clocks_test
