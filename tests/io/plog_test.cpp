// Binary logs: what a CSV holds they hold, and what was done to their bytes is found and said.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <future>
#include <string>
#include <vector>

#include "../../src/io/plog_format.hpp"
#include "io_test_support.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/io/mapped_file.hpp"
#include "plumb/io/units.hpp"

namespace plog_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

const std::string kAllColumns =
    "time = \"t_ms\"\ntime_unit = \"ms\"\nstation = \"att\"\nroll_group = \"ring\"\ncount = \"n\"\ntemperature = "
    "\"T\"\n"
    "rotation_radps = [\"wx\", \"wy\", \"wz\"]\nwhere = {exp = 2, kind = \"still\"}";

ArrayFile everything() { return array_of(changed("time = \"t_s\"", kAllColumns)); }

std::vector<Sample> some_samples(std::size_t count) {
  std::vector<Sample> samples(count);
  for (std::size_t k = 0; k < count; ++k) {
    Sample& s = samples[k];
    s.time_s = 0.01 * static_cast<double>(k + 1);
    s.raw = {0.1 * static_cast<double>(k), -1.0 / 3.0, std::nan(""), 4e300};
    s.delivered = SensorSet(static_cast<std::uint32_t>(k % 16));
    s.temperature_degc = 25.0;
  }
  return samples;
}

std::string written_plog(const ArrayFile& array, const std::vector<Sample>& samples,
                         const std::string& name = "log.plog") {
  const std::string path = written(name, "");
  auto writer = LogWriter::create(path, array);
  if (!writer) {
    ADD_FAILURE() << writer.error().text();
    return path;
  }
  for (const Sample& sample : samples) EXPECT_TRUE(writer->write(sample).has_value());
  EXPECT_TRUE(writer->commit().has_value());
  return path;
}

std::string bytes_of(const std::string& path) { return *read_file(path); }

/// Where the blocks begin.
std::size_t header_size(const std::string& log) {
  return u32_at(reinterpret_cast<const unsigned char*>(log.data()) + 16);
}

/// The log with another header of the same length under a true check sum.
std::string with_header(std::string log, std::size_t at, const std::string& bytes) {
  const std::size_t size = header_size(log);
  log.replace(at, bytes.size(), bytes);
  std::string crc;
  put_u32(crc, crc32_of(log.data(), size - 4));
  return log.replace(size - 4, 4, crc);
}

std::string u32_text(std::uint32_t value) {
  std::string out;
  put_u32(out, value);
  return out;
}

void expect_refused_log(const std::string& bytes, const std::string& field, std::initializer_list<const char*> parts,
                        const ArrayFile& array = array_of()) {
  const std::string path = written("bad.plog", bytes);
  const auto log = read_log(path, array, BadRowPolicy::stop);
  ASSERT_FALSE(log.has_value()) << "accepted";
  expect_error(log.error(), path, 0, field, parts);
}

/// NaN are the same whatever their bits: a CSV keeps none of them.
bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b)); }

bool same(const Sample& a, const Sample& b) {
  bool equal = same(a.time_s, b.time_s) && a.station == b.station && a.roll_group == b.roll_group &&
               a.count == b.count && same(a.temperature_degc, b.temperature_degc) && a.delivered == b.delivered;
  for (std::size_t i = 0; i < kCapacity; ++i) equal = equal && same(a.raw[i], b.raw[i]);
  return equal;
}

bool same(const Rotation& a, const Rotation& b) {
  return a.turning == b.turning && a.rate_known == b.rate_known && a.rate_radps == b.rate_radps;
}

/// Row by row the same, and counted the same.
void expect_same(const std::string& one, const std::string& other, const ArrayFile& array) {
  auto a = LogReader::open(one, array, BadRowPolicy::stop);
  auto b = LogReader::open(other, array, BadRowPolicy::stop);
  ASSERT_TRUE(a.has_value()) << a.error().text();
  ASSERT_TRUE(b.has_value()) << b.error().text();
  Sample s;
  Sample t;
  for (;;) {
    const LogReader::Next next = a->next(s);
    ASSERT_EQ(next, b->next(t)) << a->error().text() << b->error().text();
    if (next != LogReader::Next::row) break;
    ASSERT_TRUE(same(s, t)) << "row " << a->statistics().rows;
    ASSERT_TRUE(same(a->rotation(), b->rotation())) << "row " << a->statistics().rows;
  }
  const LogStatistics& x = a->statistics();
  const LogStatistics& y = b->statistics();
  EXPECT_GT(x.rows, 0U);
  EXPECT_EQ(x.rows, y.rows);
  EXPECT_EQ(x.missing, y.missing);
  EXPECT_EQ(x.not_finite, y.not_finite);
  EXPECT_EQ(x.temperature_held, y.temperature_held);
  EXPECT_EQ(x.varied, y.varied);
}

/// The log at `from`, written again to `to`.
void convert(const std::string& from, const std::string& to, const ArrayFile& array) {
  auto reader = LogReader::open(from, array, BadRowPolicy::stop);
  ASSERT_TRUE(reader.has_value()) << reader.error().text();
  auto writer = LogWriter::create(to, array, LogWriter::Columns::all);
  ASSERT_TRUE(writer.has_value()) << writer.error().text();
  Sample sample;
  std::uint64_t held = 0;
  while (reader->next(sample) == LogReader::Next::row) {
    const std::uint64_t now = reader->statistics().temperature_held;
    ASSERT_TRUE(writer->write(sample, {now != held, reader->rotation()}).has_value());
    held = now;
  }
  ASSERT_TRUE(writer->commit().has_value());
}

TEST(BinaryLog, HoldsWhatACsvHolds) {
  const ArrayFile array = everything();
  const std::string csv = written("in.csv",
                                  "t_ms,att,ring,n,T,exp,kind,wx,wy,wz,a1_v,a2_v,a3_v,a4_v\n"
                                  "0.1,0,-1,3,20.5,2,still,0,0,0,1,nan,0.30000000000000004,\n"
                                  "0.3,4294967294,7,1,,2,still,0.1,,0,-0,inf,,-1e-300\n"
                                  "0.7,,,1,nan,2,still,0.1,-0.2,1e-9,,,,\n"
                                  "1e3,5,7,1,21,2,still,0,0,1,1,2,3,4\n");
  const std::string binary = written("log.plog", "");
  const std::string again = written("again.csv", "");
  convert(csv, binary, array);
  expect_same(csv, binary, array);
  convert(binary, again, array);
  expect_same(csv, again, array);
}

TEST(BinaryLog, IsReadTheSameFromAPipeAndAsAFile) {
  const ArrayFile array = array_of();
  const std::string path = written_plog(array, some_samples(3000));
  const auto file = read_log(path, array, BadRowPolicy::stop);
  ASSERT_TRUE(file.has_value()) << file.error().text();
  const int keep = dup(STDIN_FILENO);
  ASSERT_NE(std::freopen(path.c_str(), "r", stdin), nullptr);
  const auto piped = read_log("-", array, BadRowPolicy::stop);
  ASSERT_EQ(dup2(keep, STDIN_FILENO), STDIN_FILENO);
  close(keep);
  ASSERT_TRUE(piped.has_value()) << piped.error().text();
  ASSERT_EQ(file->samples.size(), 3000U);
  ASSERT_EQ(piped->samples.size(), 3000U);
  for (std::size_t k = 0; k < 3000; ++k) ASSERT_TRUE(same(file->samples[k], piped->samples[k])) << k;
  EXPECT_EQ(file->statistics.bytes, bytes_of(path).size());
  EXPECT_EQ(piped->statistics.bytes, file->statistics.bytes);
  EXPECT_EQ(piped->statistics.hash, file->statistics.hash);
}

/// A named pipe that is opened twice waits for a second writer, who never comes.
TEST(BinaryLog, APipeIsNotMapped) {
  const std::string path = written("pipe.plog", "");
  ASSERT_EQ(::unlink(path.c_str()), 0);
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::future<bool> mapped = std::async(std::launch::async, [&path] { return MappedFile().open(path); });
  const bool answered = mapped.wait_for(std::chrono::seconds(5)) == std::future_status::ready;
  const int release = answered ? -1 : ::open(path.c_str(), O_RDWR);  // NOLINT(*-vararg)
  EXPECT_FALSE(mapped.get());
  EXPECT_TRUE(answered) << "it waited for a writer";
  if (release >= 0) ::close(release);
  ASSERT_EQ(::unlink(path.c_str()), 0);
}

TEST(BinaryLog, BytesAreAsTheContractSays) {
  const ArrayFile array = array_of();
  std::vector<Sample> samples(1);
  samples[0].time_s = 1.0;
  samples[0].raw = {2.0, 0.0, 0.0, 0.0};
  samples[0].delivered = SensorSet::first(1);
  const std::string log = bytes_of(written_plog(array, samples));
  const std::string one(log, 0, 40);
  EXPECT_EQ(one, std::string("\x89PLOG\r\n\x1A"
                             "\x04\x03\x02\x01"
                             "\x01\0\0\0"
                             "\x6c\0\0\0"
                             "\x05\0\0\0"
                             "\0\x02\0\0"
                             "\0\0\0\0"
                             "\0\0\0\0\0\0\0\0",
                             40));
  EXPECT_EQ(log.substr(40, 12), std::string("\0\0\x03\0\x01\0\0\0t_ss", 12));
  EXPECT_EQ(log.substr(52, 13), std::string("\0\0\x04\0\x01\0\0\0a1_vV", 13));
  ASSERT_EQ(header_size(log), 108U);
  // One block of one row: present are the time and a1.
  EXPECT_EQ(log.substr(112, 12), std::string("\x01\0\0\0\0\0\0\0\0\0\0\0", 12));
  EXPECT_EQ(log.substr(124, 24), std::string("\x03\0\0\0\0\0\0\0"
                                             "\0\0\0\0\0\0\xF0\x3F"
                                             "\0\0\0\0\0\0\0\x40",
                                             24));
  EXPECT_EQ(log.size(), 108U + 16U + 48U + 16U);
  EXPECT_EQ(log.substr(log.size() - 12), std::string("\0\0\0\0\x01\0\0\0\0\0\0\0", 12));
  EXPECT_EQ(crc32_of("123456789", 9), 0xCBF43926U) << "the check value of CRC-32";
}

TEST(BinaryLog, ForeignHeadersAreReported) {
  const std::string log = bytes_of(written_plog(array_of(), some_samples(3)));
  std::string text_copy = log;
  text_copy.erase(5, 1);  // "\r\n" became "\n"
  expect_refused_log(text_copy, "header", {"line ends were changed", "binary mode"});
  std::string other = log;
  other[1] = 'p';
  expect_refused_log(other, "header", {"but its header is wrong"});
  std::string big_endian = log;
  big_endian.replace(8, 4, std::string("\x01\x02\x03\x04", 4));
  expect_refused_log(big_endian, "header", {"big-endian", "lowest byte first"});
  std::string order = log;
  order[8] = 'x';
  expect_refused_log(order, "header", {"byte-order mark", "damaged"});
  expect_refused_log(with_header(log, 12, u32_text(2)), "header", {"version 2, this plumb reads version 1"});
  std::string size = log;
  size.replace(16, 4, u32_text(70000));
  expect_refused_log(size, "header", {"70000 bytes"});
  std::string name = log;
  name[48] = 'x';
  expect_refused_log(name, "header", {"check sum is wrong"});
  expect_refused_log(with_header(log, 20, u32_text(0)), "header", {"names 0 columns"});
  expect_refused_log(with_header(log, 20, u32_text(6)), "header", {"column 6 does not match"});
  expect_refused_log(with_header(log, 20, u32_text(4)), "header", {"does not match the table of columns"});
  expect_refused_log(with_header(log, 24, u32_text(4097)), "header", {"4097 rows in a block"});
  expect_refused_log(with_header(log, 28, u32_text(1)), "header", {"reserved"});
  expect_refused_log(with_header(log, 32, std::string("\0\0\0\0\0\0\xF8\x7F", 8)), "header", {"rate"});
  for (const std::size_t cut : {std::size_t{1}, std::size_t{7}, std::size_t{39}, std::size_t{60}}) {
    expect_refused_log(log.substr(0, cut), "header", {"ends within its header", "incomplete"});
  }
}

TEST(BinaryLog, UnitsAndRateMustBeThoseOfTheArrayFile) {
  const std::string log = bytes_of(written_plog(array_of(), some_samples(3)));
  expect_refused_log(log, "a1_v",
                     {"is in \"V\" according to the log and in \"mV\" according to the array file", "[input] unit"},
                     array_of(changed("unit = \"V\"", "unit = \"mV\"")));
  expect_refused_log(log, "t_s", {"is in \"s\" according to the log and in \"ms\"", "time_unit"},
                     array_of(changed("time = \"t_s\"", "time = \"t_s\"\ntime_unit = \"ms\"")));
  const std::string paced =
      bytes_of(written_plog(array_of(changed("time = \"t_s\"", "rate = \"100 Hz\"")), some_samples(3)));
  expect_refused_log(paced, "rate", {"100 Hz according to the log and 50 Hz"},
                     array_of(changed("time = \"t_s\"", "rate = \"50 Hz\"")));
  expect_refused_log(log, "t_s", {"holds numbers", "without quotes"},
                     array_of(changed("time = \"t_s\"", "time = \"t_s\"\nwhere = {t_s = \"one\"}")));
  // Two names of one unit.
  ArrayFile mg = array_of();
  mg.input.unit = *parse_raw_unit("mg");
  ArrayFile mg0 = mg;
  mg0.input.unit = *parse_raw_unit("mg0");
  const std::string path = written_plog(mg, some_samples(3), "mg.plog");
  EXPECT_TRUE(read_log(path, mg0, BadRowPolicy::stop).has_value());
  EXPECT_FALSE(read_log(path, array_of(), BadRowPolicy::stop).has_value());
}

TEST(BinaryLog, WhatIsCutOffIsSaid) {
  const ArrayFile array = array_of();
  const std::string log = bytes_of(written_plog(array, some_samples(1000)));
  const std::size_t block = kPlogBlockHead + 512 * 48;
  const std::size_t second = header_size(log) + block;
  for (const std::size_t cut : {second, second + 5, second + 100, log.size() - 16, log.size() - 1}) {
    const std::string path = written("cut.plog", log.substr(0, cut));
    auto reader = LogReader::open(path, array, BadRowPolicy::stop);
    ASSERT_TRUE(reader.has_value());
    Sample sample;
    LogReader::Next next = reader->next(sample);
    for (; next == LogReader::Next::row; next = reader->next(sample)) {
    }
    EXPECT_EQ(next, LogReader::Next::error) << cut;
    EXPECT_EQ(reader->statistics().rows, cut < log.size() - 16 ? 512U : 1000U);
    expect_error(reader->error(), path, 0, "", {"the log is cut off", "--on-bad-row skip"});
    const auto skipped = read_log(path, array, BadRowPolicy::skip);
    ASSERT_TRUE(skipped.has_value());
    EXPECT_EQ(skipped->statistics.rows_bad, 1U);
  }
}

TEST(BinaryLog, ADamagedBlockIsSkippedWhole) {
  const ArrayFile array = array_of();
  std::string log = bytes_of(written_plog(array, some_samples(1500)));
  const std::size_t second = header_size(log) + kPlogBlockHead + 512 * 48;
  log[second + 1000] = static_cast<char>(log[second + 1000] ^ 4);
  expect_refused_log(log, "", {"check sum of the block at byte 24700 is wrong (rows 513 to 1024)"});
  const auto rest = read_log(written("damaged.plog", log), array, BadRowPolicy::skip);
  ASSERT_TRUE(rest.has_value());
  EXPECT_EQ(rest->samples.size(), 1500U - 512U);
  EXPECT_EQ(rest->statistics.rows_bad, 512U);
  EXPECT_EQ(rest->samples[512].time_s, 0.01 * 1025);
}

TEST(BinaryLog, ForgedBlocksAreReported) {
  const ArrayFile array = array_of();
  const std::string log = bytes_of(written_plog(array, some_samples(600)));
  const std::size_t first = header_size(log);
  std::string rows = log;
  rows.replace(first + 4, 4, u32_text(513));
  expect_refused_log(rows, "", {"states 513 rows, but the header allows 512"});
  std::string without_first = log;
  without_first.erase(first, kPlogBlockHead + 512 * 48);
  expect_refused_log(without_first, "", {"begins with row 513, row 1 is expected"});
  std::string no_rows = log;
  no_rows.erase(first, log.size() - first - 16);
  expect_refused_log(no_rows, "", {"states 600 rows, but the log has 0"});
  expect_refused_log(log + log, "", {"bytes follow the end mark", "two logs"});
  std::string mark = log;
  mark.back() = 1;
  expect_refused_log(mark, "", {"check sum of the end mark"});
  EXPECT_FALSE(
      read_log(written("empty.plog", bytes_of(written_plog(array, {}))), array, BadRowPolicy::stop).has_value());
}

TEST(BinaryLog, BadRowsAreReportedByNumberAndColumn) {
  const ArrayFile array = array_of(changed("time = \"t_s\"", "time = \"t_s\"\nstation = \"att\""));
  std::vector<Sample> samples = some_samples(3);
  samples[2].time_s = samples[1].time_s;
  const std::string log = bytes_of(written_plog(array, samples));
  expect_refused_log(log, "row 3, t_s (column 1)", {"0.02 s does not increase", "--on-bad-row skip"}, array);
  // A row that marks a value where there is no column, under a true check sum.
  std::string forged = log;
  const std::size_t block = header_size(log);
  forged[block + kPlogBlockHead + 1] = 0x10;
  const std::size_t size = kPlogBlockHead + 3 * 56;
  forged.replace(block, 4, u32_text(crc32_of(forged.data() + block + 4, size - 4)));
  expect_refused_log(forged, "row 1", {"marks values in more columns"}, array);
}

TEST(BinaryLog, ColumnsThatDoNotFitAreLeftToCsv) {
  ArrayFile array = array_of();
  for (int k = 0; k < 64; ++k) array.input.where.push_back({"c" + std::to_string(k), "1", 1.0, true});
  const auto writer = LogWriter::create(written("wide.plog", ""), array);
  ASSERT_FALSE(writer.has_value());
  EXPECT_NE(writer.error().text().find("at most 64 columns, but the array file needs 69"), std::string::npos);
}

RC_GTEST_PROP(BinaryLogLaw, NoChangedByteGoesUnnoticed, ()) {
  static const ArrayFile array = array_of();
  static const std::string log = bytes_of(written_plog(array, some_samples(700)));
  std::string changed_log = log;
  const std::size_t at = *rc::gen::inRange<std::size_t>(1, log.size());
  changed_log[at] = static_cast<char>(changed_log[at] ^ *rc::gen::inRange(1, 256));
  RC_ASSERT(!read_log(written("bad.plog", changed_log), array, BadRowPolicy::stop).has_value());
}

RC_GTEST_PROP(BinaryLogLaw, EveryRowComesBackBitForBit, ()) {
  static const ArrayFile array =
      array_of(changed("time = \"t_s\"", "time = \"t_s\"\nstation = \"att\"\ncount = \"n\""));
  std::vector<Sample> samples(*rc::gen::inRange<std::size_t>(1, 40));
  double time_s = 0.0;
  for (Sample& sample : samples) {
    time_s += 1e-3 * static_cast<double>(*rc::gen::inRange(1, 1000000));
    sample.time_s = time_s;
    sample.temperature_degc = 25.0;
    sample.station = *rc::gen::inRange<std::uint32_t>(0U, 4000000000U);
    sample.count = *rc::gen::inRange<std::uint32_t>(1U, 4000000000U);
    sample.delivered = SensorSet(*rc::gen::inRange<std::uint32_t>(0U, 16U));
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint64_t bits = *rc::gen::arbitrary<std::uint64_t>();
      if (sample.delivered.has(static_cast<int>(i))) std::memcpy(&sample.raw[i], &bits, sizeof bits);
    }
  }
  const auto log = read_log(written_plog(array, samples), array, BadRowPolicy::stop);
  RC_ASSERT(log.has_value());
  RC_ASSERT(log->samples.size() == samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    RC_ASSERT(same(samples[k], log->samples[k]));
    RC_ASSERT(std::memcmp(samples[k].raw.data(), log->samples[k].raw.data(), 4 * sizeof(double)) == 0);
  }
}

}  // namespace
}  // namespace plog_test
