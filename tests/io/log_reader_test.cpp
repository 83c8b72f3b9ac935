#include "plumb/io/log_reader.hpp"

#include <gtest/gtest.h>
#include <sys/time.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <string>

#include "io_test_support.hpp"

namespace log_reader_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;
using Next = LogReader::Next;

const std::string kHeader = "t_s,a1_v,a2_v,a3_v,a4_v\n";

LogContent content_of(const std::string& csv, const ArrayFile& array = array_of(),
                      BadRowPolicy policy = BadRowPolicy::stop) {
  auto log = read_log(written("log.csv", csv), array, policy);
  if (!log) {
    ADD_FAILURE() << log.error().text();
    return {};
  }
  return *std::move(log);
}

/// The refusal of a log; its path is `path`.
FileError refusal_of(const std::string& csv, std::string& path, const ArrayFile& array = array_of()) {
  path = written("log.csv", csv);
  const auto log = read_log(path, array, BadRowPolicy::stop);
  EXPECT_FALSE(log.has_value());
  return log ? FileError() : log.error();
}

void expect_bad(const std::string& csv, int line, const std::string& field, std::initializer_list<const char*> parts,
                const ArrayFile& array = array_of()) {
  std::string path;
  const FileError error = refusal_of(csv, path, array);
  expect_error(error, path, line, field, parts);
}

TEST(LogReader, ReadsRows) {
  const LogContent log = content_of(kHeader + "0,1.5,-2e-3,+3, 4 \n0.01,0.1,0.2,0.3,0.4");
  ASSERT_EQ(log.samples.size(), 2U);
  EXPECT_EQ(log.samples[0].raw[0], 1.5);
  EXPECT_EQ(log.samples[0].raw[1], -2e-3);
  EXPECT_EQ(log.samples[0].raw[2], 3.0);
  EXPECT_EQ(log.samples[0].raw[3], 4.0);
  EXPECT_EQ(log.samples[0].delivered, SensorSet::first(4));
  EXPECT_EQ(log.samples[0].temperature_degc, 25.0) << "the reference, so that nothing is compensated";
  EXPECT_EQ(log.samples[1].time_s, 0.01);
  EXPECT_EQ(log.statistics.rows, 2U);
  EXPECT_EQ(log.statistics.last_time_s, 0.01);
  EXPECT_GT(log.statistics.bytes, 40U);
  EXPECT_NE(log.statistics.hash, 0U);
}

TEST(LogReader, OrderOfColumnsQuotesCrlfBlankLinesAndByteOrderMarkDoNotMatter) {
  const LogContent log = content_of(
      "\xEF\xBB\xBF\"note\",a4_v,\"a1_v\",a2_v, a3_v ,t_s\r\n\"x, y\",4,1,2,3,\"0.5\"\r\n\r\n,8,5,6,7,1\r\n");
  ASSERT_EQ(log.samples.size(), 2U);
  EXPECT_EQ(log.samples[0].raw[0], 1.0);
  EXPECT_EQ(log.samples[0].raw[3], 4.0);
  EXPECT_EQ(log.samples[0].time_s, 0.5);
  EXPECT_EQ(log.samples[1].raw[2], 7.0);
}

// Negative: REQ-174
TEST(LogReader, MissingAndNotFiniteCellsAreFactsNotBadRows) {
  const LogContent log = content_of(kHeader + "0,,nan,NaN,4\n1,1,inf,3,-Inf\n2,1, ,3,1e999\n");
  ASSERT_EQ(log.samples.size(), 3U);
  EXPECT_FALSE(log.samples[0].delivered.has(0));
  EXPECT_TRUE(log.samples[0].delivered.has(1));
  EXPECT_TRUE(std::isnan(log.samples[0].raw[1]));
  EXPECT_TRUE(std::isinf(log.samples[2].raw[3]));
  EXPECT_EQ(log.statistics.missing[0], 1U);
  EXPECT_EQ(log.statistics.missing[1], 1U);
  EXPECT_EQ(log.statistics.not_finite[1], 2U);
  EXPECT_EQ(log.statistics.not_finite[2], 1U);
  EXPECT_EQ(log.statistics.not_finite[3], 2U);
  EXPECT_EQ(log.statistics.rows_bad, 0U);
}

TEST(LogReader, KnowsWhichColumnsSaidTheSameInEveryRow) {
  const LogStatistics log = content_of(kHeader + "0,,5,nan,1\n1,7,5,2,1\n2,7,5,3,1.5\n").statistics;
  EXPECT_FALSE(log.varied.has(0));
  EXPECT_EQ(log.first_value[0], 7.0);
  EXPECT_FALSE(log.varied.has(1));
  EXPECT_TRUE(log.varied.has(2));
  EXPECT_EQ(log.first_value[2], 2.0);
  EXPECT_TRUE(log.varied.has(3));
}

TEST(LogReader, NumbersAreCorrectlyRounded) {
  const LogContent log = content_of(kHeader + "0,0.1,9007199254740993,2.2250738585072011e-308,4.9e-324\n");
  EXPECT_EQ(log.samples[0].raw[0], 0.1);
  EXPECT_EQ(log.samples[0].raw[1], 9007199254740992.0);
  EXPECT_EQ(log.samples[0].raw[2], 2.2250738585072011e-308);
  EXPECT_EQ(log.samples[0].raw[3], 4.9e-324);
}

TEST(LogReader, StationsCountsTemperatureAndFilters) {
  const std::string rows = changed(
      "rows = \"samples\"\ntime = \"t_s\"",
      "rows = \"stations\"\nstation = \"att\"\ncount = \"n\"\ntemperature = \"T\"\nwhere = {exp = 2, dev = \"ab\"}");
  const LogContent log = content_of(
      "exp,dev,att,n,T,a1_v,a2_v,a3_v,a4_v\n1,ab,0,10,20,1,2,3,4\n2,ab,0,10,21,1,2,3,4\n2.0,ab,7,12.0,,5,6,7,8\n2,xy,1,"
      "1,1,1,1,1,1\n2,ab,,1,22,1,2,3,4\n",
      array_of(rows));
  ASSERT_EQ(log.samples.size(), 3U);
  EXPECT_EQ(log.samples[0].station, tag_of_label(0)) << "label 0 is a station, tag 0 is none";
  EXPECT_EQ(log.samples[1].station, 8U);
  EXPECT_EQ(label_of_tag(log.samples[1].station), 7);
  EXPECT_EQ(log.samples[2].station, 0U);
  EXPECT_EQ(log.samples[1].count, 12U);
  EXPECT_EQ(log.samples[0].time_s, 0.0) << "remove this key; the row number is then the time";
  EXPECT_EQ(log.samples[2].time_s, 2.0);
  EXPECT_EQ(log.samples[1].temperature_degc, 21.0) << "held from the row before";
  EXPECT_EQ(log.statistics.temperature_held, 1U);
  EXPECT_EQ(log.statistics.rows_filtered, 2U);
}

// Verifies: REQ-065
TEST(LogReader, TheRotationRateIsReadRowByRow) {
  const char* const kColumns = "time = \"t_s\"\nrotation_radps = [\"wx\", \"wy\", \"wz\"]";
  const ArrayFile array = array_of(changed("time = \"t_s\"", kColumns));
  const std::string path =
      written("log.csv",
              "t_s,wx,wy,wz,a1_v,a2_v,a3_v,a4_v\n0,0,0,0,1,2,3,4\n1,0,0.5,-2,1,2,3,4\n2,0,,1,1,2,3,4\n"
              "3,0,nan,1,1,2,3,4\n4,0,fast,1,1,2,3,4\n");
  auto reader = LogReader::open(path, array, BadRowPolicy::stop);
  ASSERT_TRUE(reader.has_value());
  Sample sample;
  ASSERT_EQ(reader->next(sample), LogReader::Next::row);
  EXPECT_FALSE(reader->rotation().turning);
  EXPECT_TRUE(reader->rotation().rate_known);
  ASSERT_EQ(reader->next(sample), LogReader::Next::row);
  EXPECT_TRUE(reader->rotation().turning && reader->rotation().rate_known);
  EXPECT_EQ(reader->rotation().rate_radps, (Vec3{0.0, 0.5, -2.0}));
  for (int k = 0; k < 2; ++k) {
    ASSERT_EQ(reader->next(sample), LogReader::Next::row);
    EXPECT_TRUE(reader->rotation().turning) << "at a rate that is not known";
    EXPECT_FALSE(reader->rotation().rate_known);
    EXPECT_EQ(reader->rotation().rate_radps, Vec3{});
  }
  EXPECT_EQ(reader->next(sample), LogReader::Next::error);
  EXPECT_EQ(reader->error().field, "wy (column 3)");
}

TEST(LogReader, RollGroupsAreTagsLikeThoseOfStations) {
  const ArrayFile array = array_of(changed("time = \"t_s\"", "time = \"t_s\"\nroll_group = \"ring\""));
  const LogContent log =
      content_of("t_s,ring,a1_v,a2_v,a3_v,a4_v\n0,0,1,2,3,4\n1,12,1,2,3,4\n2,,1,2,3,4\n3,-1,1,2,3,4\n", array);
  ASSERT_EQ(log.samples.size(), 4U);
  EXPECT_EQ(log.samples[0].roll_group, tag_of_label(0));
  EXPECT_EQ(log.samples[1].roll_group, tag_of_label(12));
  EXPECT_EQ(log.samples[2].roll_group, 0U);
  EXPECT_EQ(log.samples[3].roll_group, 0U);
  EXPECT_EQ(log.samples[1].station, 0U);
}

TEST(LogReader, RateGivesTimeAlsoAcrossBadRows) {
  const ArrayFile array = array_of(changed("time = \"t_s\"", "rate = \"50 Hz\""));
  const LogContent log = content_of("a1_v,a2_v,a3_v,a4_v\n1,2,3,4\n1,2,x,4\n1,2,3,4\n", array, BadRowPolicy::skip);
  ASSERT_EQ(log.samples.size(), 2U);
  EXPECT_DOUBLE_EQ(log.samples[1].time_s, 0.04);
}

TEST(LogReaderRefuses, EmptyAndUnreadableLogs) {
  expect_bad("", 0, "", {"the log is empty", "header row"});
  expect_bad("\r\n\n", 0, "", {"the log is empty"});
  expect_bad(kHeader, 1, "", {"the log has a header but no usable row ("});
  const auto missing = read_log("/nonexistent/log.csv", array_of(), BadRowPolicy::stop);
  ASSERT_FALSE(missing.has_value());
  expect_error(missing.error(), "/nonexistent/log.csv", 0, "", {"No such file", "check the path"});
  const auto directory = read_log(testing::TempDir(), array_of(), BadRowPolicy::stop);
  ASSERT_FALSE(directory.has_value());
  EXPECT_NE(directory.error().text().find("not a directory"), std::string::npos);
}

TEST(LogReaderRefuses, MissingColumnsByName) {
  expect_bad("t_s,a1_v,a2_v,a3v,a4_v\n0,1,2,3,4\n", 1, "a3_v",
             {"the column is missing", "sensor[3].column", "did you mean \"a3v\"?", "columns present: t_s, a1_v"});
  expect_bad("time,a1_v,a2_v,a3_v,a4_v\n", 1, "t_s", {"input.time"});
  expect_bad("t_s;a1_v;a2_v;a3_v;a4_v\n", 1, "t_s", {"semicolons"});
  expect_bad("t_s,a1_v,a1_v,a2_v,a3_v,a4_v\n", 1, "a1_v", {"two columns"});
  expect_bad("0,1,2,3,4\n1,1,2,3,4\n", 1, "", {"first row holds numbers", "t_s,a1_v"});
}

// Verifies: REQ-174
TEST(LogReaderRefuses, BadRowsByLineAndColumn) {
  expect_bad(kHeader + "0,1,2,3,4\n1,1,2,abc,4\n", 3, "a3_v (column 4)",
             {"\"abc\" is not a number", "--on-bad-row skip"});
  expect_bad(kHeader + "0,1,2,1.5V,4\n", 2, "a3_v (column 4)", {"\"1.5V\" is not a number"});
  expect_bad(kHeader + "0,1,2,3\n", 2, "", {"has 4 cells, but the header has 5"});
  expect_bad(kHeader + "0,1,2,3,4\n1,1,2,3,4,5\n", 3, "", {"has 6 cells"});
  expect_bad(kHeader + "0,1,2,3,4\n0,1,2,3,4\n", 3, "t_s (column 1)",
             {"time 0 s does not increase", "row before has 0 s"});
  expect_bad(kHeader + "2,1,2,3,4\n1.5,1,2,3,4\n", 3, "t_s (column 1)", {"time 1.5 s does not increase"});
  expect_bad(kHeader + "nan,1,2,3,4\n", 2, "t_s (column 1)", {"not finite"});
  expect_bad(kHeader + ",1,2,3,4\n", 2, "t_s (column 1)", {"is not a time"});
}

TEST(LogReaderRefuses, BadTagsCountsAndTemperatures) {
  const ArrayFile array =
      array_of(changed("time = \"t_s\"", "time = \"t_s\"\nstation = \"att\"\ncount = \"n\"\ntemperature = \"T\""));
  const std::string header = "t_s,att,n,T,a1_v,a2_v,a3_v,a4_v\n";
  expect_bad(header + "0,1.5,1,20,1,2,3,4\n", 2, "att (column 2)", {"is not a station number"}, array);
  expect_bad(header + "0,-2,1,20,1,2,3,4\n", 2, "att (column 2)", {"is not a station number"}, array);
  expect_bad(header + "0,1,0,20,1,2,3,4\n", 2, "n (column 3)", {"is not a number of samples"}, array);
  expect_bad(header + "0,1,1,warm,1,2,3,4\n", 2, "T (column 4)", {"is not a temperature"}, array);
  expect_bad(header + "0,1,1,,1,2,3,4\n", 2, "T (column 4)", {"neither this row nor a row before it has a temperature"},
             array);
  const ArrayFile rolled = array_of(changed("time = \"t_s\"", "time = \"t_s\"\nroll_group = \"ring\""));
  for (const char* label : {"1.5", "-2", "nan", "one", "4294967295"})
    expect_bad("t_s,ring,a1_v,a2_v,a3_v,a4_v\n0," + std::string(label) + ",1,2,3,4\n", 2, "ring (column 2)",
               {"is not the number of a roll group"}, rolled);
}

// Verifies: REQ-174
TEST(LogReader, SkipsAndCountsBadRows) {
  std::string csv = kHeader + "0,1,2,3,4\n";
  for (int k = 0; k < 30; ++k) csv += "x,1,2,3,4\n";
  csv += "1,1,2,3,4\n";
  const LogContent log = content_of(csv, array_of(), BadRowPolicy::skip);
  EXPECT_EQ(log.samples.size(), 2U);
  EXPECT_EQ(log.statistics.rows_bad, 30U);
  ASSERT_EQ(log.statistics.bad_rows.size(), LogStatistics::kBadRowsKept);
  EXPECT_EQ(log.statistics.bad_rows[0].line, 3);
  std::string path;
  const auto none = read_log(written("log.csv", kHeader + "x,1,2,3,4\n"), array_of(), BadRowPolicy::skip);
  ASSERT_FALSE(none.has_value());
  EXPECT_NE(none.error().text().find("1 bad"), std::string::npos) << none.error().text();
}

TEST(LogReader, LinesLongerThanTheBufferAreRead) {
  const std::string padding(1U << 20U, ' ');
  const LogContent log = content_of("note," + kHeader + "\"" + padding + "\",0,1,2,3,4\nb,1,1,2,3,4\n");
  EXPECT_EQ(log.samples.size(), 2U);
  expect_bad("note," + kHeader + std::string(20U << 20U, 'x'), 2, "", {"longer than 16 MB"});
}

/// Standard input replaced by a pipe, for one test.
class PipedInput {
 public:
  PipedInput() : keep_(::dup(STDIN_FILENO)) {
    EXPECT_EQ(::pipe(ends_), 0);
    EXPECT_GE(::dup2(ends_[0], STDIN_FILENO), 0);
  }
  PipedInput(const PipedInput&) = delete;
  PipedInput& operator=(const PipedInput&) = delete;
  ~PipedInput() {
    ::dup2(keep_, STDIN_FILENO);
    for (const int descriptor : {ends_[0], ends_[1], keep_}) ::close(descriptor);
  }
  void say(const std::string& text) {
    ASSERT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

 private:
  int ends_[2] = {-1, -1};
  int keep_;
};

volatile std::sig_atomic_t stop_flag = 0;

TEST(LogReader, ALiveStreamIsNotHeldBack) {
  PipedInput input;
  input.say(kHeader + "0,1,2,3,4\n1,1,2");
  auto reader = LogReader::open("-", array_of(), BadRowPolicy::stop);
  ASSERT_TRUE(reader.has_value());
  Sample sample;
  EXPECT_EQ(reader->next(sample), Next::row) << "although the pipe is still open";
  input.say(",3,4\n");
  EXPECT_EQ(reader->next(sample), Next::row);
  EXPECT_EQ(sample.time_s, 1.0);
}

/// The array, reading these columns of the log.
ArrayFile array_over(std::initializer_list<const char*> columns) {
  ArrayFile out = array_of();
  out.input.sensor_columns.assign(columns.begin(), columns.end());
  return out;
}

// Verifies: REQ-241
TEST(LogReader, SeveralArraysReadOnePassOfAStream) {
  PipedInput input;
  const ArrayFile one = array_over({"a", "b", "c", "d"}), other = array_over({"w", "x", "y", "z"});
  input.say("t_s,a,b,c,d,w,x,y,z\n0,1,2,3,4,5,6,7,8\n0.01,1");
  auto readers = LogReader::open("-", {&one, &other}, BadRowPolicy::skip);
  ASSERT_TRUE(readers.has_value()) << readers.error().text();
  Sample first, second;
  ASSERT_EQ((*readers)[0].next(first), Next::row) << "although the pipe is still open";
  ASSERT_EQ((*readers)[1].next(second), Next::row);
  EXPECT_EQ(first.raw[0], 1.0);
  EXPECT_EQ(second.raw[0], 5.0);
  // A row that is bad for one is a row of the other; each stands where it has read to.
  input.say(",1,1,1,bad,1,1,1\n0.02,9,9,9,9,9,9,9,9\n0.03,10,1,1,1,11,1,1,1\n");
  ASSERT_EQ((*readers)[1].next(second), Next::row);
  EXPECT_EQ(second.time_s, 0.02);
  for (const double time_s : {0.01, 0.02}) {
    ASSERT_EQ((*readers)[0].next(first), Next::row);
    EXPECT_EQ(first.time_s, time_s);
  }
  EXPECT_EQ((*readers)[1].statistics().rows_bad, 1U);
  EXPECT_EQ((*readers)[0].statistics().rows_bad, 0U);
  readers->erase(readers->begin());  // one has ended: the other reads on
  ASSERT_EQ(readers->front().next(second), Next::row);
  EXPECT_EQ(second.raw[0], 11.0);
}

TEST(LogReaderRefuses, AColumnThatOneOfSeveralArraysMisses) {
  const ArrayFile one = array_of(), other = array_over({"w", "x", "y", "z"});
  const std::string path = written("log.csv", kHeader + "0,1,2,3,4\n");
  const auto readers = LogReader::open(path, {&one, &other}, BadRowPolicy::stop);
  ASSERT_FALSE(readers.has_value());
  EXPECT_EQ(readers.error().field, "w");
}

TEST(LogReader, ASignalEndsTheWaitForALiveStream) {
  PipedInput input;
  input.say(kHeader + "0,1,2,3,4\n");
  auto reader = LogReader::open("-", array_of(), BadRowPolicy::stop);
  ASSERT_TRUE(reader.has_value());
  stop_flag = 0;
  reader->stop_when(&stop_flag);
  Sample sample;
  EXPECT_EQ(reader->next(sample), Next::row);
  struct sigaction action = {};
  struct sigaction before = {};
  action.sa_handler = [](int) { stop_flag = 1; };  // no SA_RESTART: read returns with EINTR
  ASSERT_EQ(::sigaction(SIGALRM, &action, &before), 0);
  itimerval timer = {};
  timer.it_value.tv_usec = 50000;
  timer.it_interval.tv_usec = 50000;  // again, should the first come before the read
  ASSERT_EQ(::setitimer(ITIMER_REAL, &timer, nullptr), 0);
  EXPECT_EQ(reader->next(sample), Next::end);
  EXPECT_EQ(reader->statistics().rows, 1U);
  timer = {};
  ::setitimer(ITIMER_REAL, &timer, nullptr);
  ::sigaction(SIGALRM, &before, nullptr);
}

}  // namespace
}  // namespace log_reader_test
