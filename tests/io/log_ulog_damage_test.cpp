// ULogs that plumb wrote and that were cut, changed or forged since, and those that it did not write: found, and said.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "log_ulog_support.hpp"

namespace log_ulog_damage_test {
namespace {

using namespace log_ulog_support;

TEST(LogUlogDamage, ForeignHeadersAreReported) {
  const std::string log = bytes_of(written_ulog(array_of(), some_samples(3)));
  std::string name = log;
  name[log.find("a1_v")] = 'x';
  expect_refused_log(name, "header", {"check sum is wrong"});
  std::string subscriptions = log;
  subscriptions[header_size(log) - 1] = 'x';
  expect_refused_log(subscriptions, "header", {"check sum is wrong"});
  std::string key = log;
  key.replace(key.find("plumb_header_crc32"), 5, "PLUMB");
  expect_refused_log(key, "header", {"ends within its header"});
  const std::string version = "plumb_log_version\x01";
  expect_refused_log(with_definition(log, version, "plumb_log_version\x02"), "header",
                     {"version 2, this plumb reads version 1"});
  expect_refused_log(
      with_definition(log, "uint32_t plumb_block_rows" + u32_text(512), "uint32_t plumb_block_rows" + u32_text(4097)),
      "header", {"more than 4096", "shorter blocks"});
  expect_refused_log(with_definition(log, "uint32_t plumb_block_rows", "uint16_t plumb_block_rows"), "header",
                     {"what is not of its type"});
  expect_refused_log(with_definition(log, "char[1] plumb_unit_a2_v", "char[1] plumb_unit_a1_v"), "header",
                     {"says twice what"});
  expect_refused_log(with_definition(log, "double a4_v;", "uint64 a4_v;"), "header", {"none of plumb's"});
  expect_refused_log(with_definition(log, "uint64_t present", "uint64_t absence"), "a1_v", {"V"},
                     array_of(changed("unit = \"V\"", "unit = \"mV\"")));
  expect_refused_log(with_definition(log, "uint32_t crc32", "uint32_t crc64"), "header", {"format of its blocks"});
  expect_refused_log(with_definition(log, "plumb_row:", "plumb_raw:"), "header", {"format of its rows"});
  const std::string paced =
      bytes_of(written_ulog(array_of(changed("time = \"t_s\"", "rate = \"100 Hz\"")), some_samples(3)));
  expect_refused_log(with_definition(paced, std::string("plumb_rate_hz\0\0\0\0\0\0\x59\x40", 21),
                                     std::string("plumb_rate_hz\0\0\0\0\0\0\xF8\x7F", 21)),
                     "header", {"rate is negative or not a number"},
                     array_of(changed("time = \"t_s\"", "rate = \"100 Hz\"")));
}

TEST(LogUlogDamage, ULogsOfOthersAndOldBinaryLogsAreNamedForWhatTheyAre) {
  const std::string magic("ULog\x01\x12\x35\x01", 8);
  const std::string of_px4 = magic + std::string("\x40\x42\x0F\0\0\0\0\0", 8) + std::string("\x28\0B", 3) +
                             std::string(40, '\0') + std::string("\x0B\0F", 3) + "a:uint8_t b;";
  for (const std::string& log : {of_px4, magic + std::string(200, '\0')})
    expect_refused_log(log, "header", {"is a ULog that plumb did not write", "PX4", "plumb import"});
  expect_refused_log(std::string("\x89PLOG\r\n\x1A\x04\x03\x02\x01", 12) + std::string(200, '\0'), "",
                     {".plog", "read no longer", "plumb convert"});
  const auto writer = LogWriter::create(written("new.plog", ""), array_of());
  ASSERT_FALSE(writer.has_value());
  EXPECT_NE(writer.error().text().find(".ulg"), std::string::npos) << writer.error().text();
}

/// Row by row what is read of the first `size` bytes of a log: nothing but what the whole log holds, and a sentence.
void expect_beginning(const std::string& log, std::size_t size, const std::vector<Sample>& samples) {
  const std::string path = written("cut.ulg", log.substr(0, size));
  auto reader = LogReader::open(path, array_of(), BadRowPolicy::stop);
  if (!reader) {
    ASSERT_LT(size, header_size(log));
    ASSERT_FALSE(reader.error().what.empty() || reader.error().remedy.empty());
    return;
  }
  ASSERT_GE(size, header_size(log));
  Sample sample;
  std::size_t rows = 0;
  LogReader::Next next = reader->next(sample);
  for (; next == LogReader::Next::row; next = reader->next(sample))
    ASSERT_TRUE(same(sample, samples.at(rows++))) << size;
  ASSERT_EQ(next, LogReader::Next::error) << size;
  const std::size_t blocks = (size - header_size(log)) / (kUlogBlockSize + 512 * kRow);
  ASSERT_EQ(rows, size < log.size() - kUlogBlockSize ? blocks * 512 : samples.size()) << size;
  const std::string come = rows == 0 ? "0 rows come before" : std::to_string(rows) + " rows come before";
  const std::size_t begins =
      header_size(log) + blocks * kUlogBlockSize + rows * kRow + (rows == samples.size() ? kUlogBlockSize : 0);
  const std::string where = "a block begins at byte " + std::to_string(begins);
  ASSERT_NE(reader->error().what.find("the log is cut off"), std::string::npos) << reader->error().text();
  ASSERT_NE(reader->error().what.find(where), std::string::npos) << reader->error().text() << where;
  ASSERT_NE(reader->error().what.find(come), std::string::npos) << reader->error().text();
}

TEST(LogUlogDamage, CutAtEveryByteOfItsHeaderAndItsLastBlockItKeepsWhatCameBefore) {
  const std::vector<Sample> samples = some_samples(520);
  const std::string log = bytes_of(written_ulog(array_of(), samples));
  const std::size_t second = header_size(log) + kUlogBlockSize + 512 * kRow;
  for (std::size_t size = 7; size < header_size(log) + 2 * kRow; ++size)
    ASSERT_NO_FATAL_FAILURE(expect_beginning(log, size, samples)) << size;
  for (std::size_t size = second - 2 * kRow; size < log.size(); ++size)
    ASSERT_NO_FATAL_FAILURE(expect_beginning(log, size, samples)) << size;
  const auto skipped = read_log(written("cut.ulg", log.substr(0, second + 100)), array_of(), BadRowPolicy::skip);
  ASSERT_TRUE(skipped.has_value());
  EXPECT_EQ(skipped->samples.size(), 512U);
  EXPECT_EQ(skipped->statistics.rows_bad, 1U);
}

TEST(LogUlogDamage, ADamagedBlockIsSkippedWhole) {
  const ArrayFile array = array_of();
  std::string log = bytes_of(written_ulog(array, some_samples(1500)));
  const std::size_t second = header_size(log) + kUlogBlockSize + 512 * kRow;
  log[second + 1000] = static_cast<char>(log[second + 1000] ^ 4);
  const std::string where = "check sum of the block at byte " + std::to_string(second) + " is wrong (rows 513 to 1024)";
  expect_refused_log(log, "", {where.c_str()});
  const auto rest = read_log(written("damaged.ulg", log), array, BadRowPolicy::skip);
  ASSERT_TRUE(rest.has_value());
  EXPECT_EQ(rest->samples.size(), 1500U - 512U);
  EXPECT_EQ(rest->statistics.rows_bad, 512U);
  EXPECT_EQ(rest->samples[512].time_s, 0.01 * 1025);
}

TEST(LogUlogDamage, ForgedBlocksAreReported) {
  const ArrayFile array = array_of();
  const std::string log = bytes_of(written_ulog(array, some_samples(600)));
  const std::size_t first = header_size(log);
  std::string rows = log;
  rows.replace(first + kUlogDataHead + 16, 4, u32_text(513));
  expect_refused_log(rows, "", {"states 513 rows, but the header allows 512"});
  std::string without_first = log;
  without_first.erase(first, kUlogBlockSize + 512 * kRow);
  expect_refused_log(without_first, "", {"begins with row 513, row 1 is expected"});
  std::string no_rows = log;
  no_rows.erase(first, log.size() - first - kUlogBlockSize);
  expect_refused_log(no_rows, "", {"states 600 rows, but the log has 0"});
  expect_refused_log(log + log, "", {"bytes follow the end mark", "two logs"});
  std::string mark = log;
  mark.back() = static_cast<char>(mark.back() ^ 1);
  expect_refused_log(mark, "", {"check sum of the end mark"});
  std::string none = log;
  none[first + 2] = 'L';
  expect_refused_log(none, "", {"no block begins at byte", "0 rows come before"});
  // Other tools would see another message in the place of the second row.
  std::string message = log;
  message[first + kUlogBlockSize + kRow + 3] = '\x01';
  expect_refused_log(with_block_sum(message, first, 512), "", {"a message of the block at byte"});
  EXPECT_FALSE(
      read_log(written("empty.ulg", bytes_of(written_ulog(array, {}))), array, BadRowPolicy::stop).has_value());
}

TEST(LogUlogDamage, BadRowsAreReportedByNumberAndColumn) {
  const ArrayFile array = array_of(changed("time = \"t_s\"", "time = \"t_s\"\nstation = \"att\""));
  std::vector<Sample> samples = some_samples(3);
  samples[2].time_s = samples[1].time_s;
  const std::string log = bytes_of(written_ulog(array, samples));
  expect_refused_log(log, "row 3, t_s (column 1)", {"0.02 s does not increase", "--on-bad-row skip"}, array);
  // A row that marks a value where there is no column, under a true check sum.
  std::string forged = log;
  const std::size_t block = header_size(log);
  forged[block + kUlogBlockSize + kUlogRowMarks + 1] = 0x10;
  expect_refused_log(with_block_sum(forged, block, 3, kRow + 8), "row 1", {"marks values in more columns"}, array);
}

RC_GTEST_PROP(LogUlogDamageLaw, NoChangedByteGoesUnnoticed, ()) {
  static const ArrayFile array = array_of();
  static const std::string log = bytes_of(written_ulog(array, some_samples(700)));
  std::string changed_log = log;
  const std::size_t at = *rc::gen::inRange<std::size_t>(0, log.size());
  changed_log[at] = static_cast<char>(changed_log[at] ^ *rc::gen::inRange(1, 256));
  RC_ASSERT(!read_log(written("bad.ulg", changed_log), array, BadRowPolicy::stop).has_value());
}

}  // namespace
}  // namespace log_ulog_damage_test
