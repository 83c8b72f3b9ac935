/// ULogs of plumb in memory and on disk, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include "../../src/io/little_endian.hpp"
#include "../../src/io/ulog_header.hpp"
#include "io_test_support.hpp"
#include "plumb/io/log_reader.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/io/output_file.hpp"

namespace log_ulog_support {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

/// Bytes of a row of the array of io_test: the time and four sensors.
inline constexpr std::size_t kRow = kUlogRowNumbers + 5 * 8;

inline const unsigned char* raw(const std::string& text) { return reinterpret_cast<const unsigned char*>(text.data()); }

inline std::vector<Sample> some_samples(std::size_t count) {
  std::vector<Sample> samples(count);
  for (std::size_t k = 0; k < count; ++k) {
    Sample& s = samples[k];
    s.time_s = 0.01 * static_cast<double>(k + 1);
    s.raw = {0.1 * static_cast<double>(k), -1.0 / 3.0, std::nan(""), 4e300};
    s.delivered = SensorSet(static_cast<std::uint32_t>(k % 16));
    for (std::size_t i = 0; i < 4; ++i) {
      if (!s.delivered.has(static_cast<int>(i))) s.raw[i] = 0.0;
    }
    s.temperature_degc = 25.0;
  }
  return samples;
}

inline std::string written_ulog(const ArrayFile& array, const std::vector<Sample>& samples,
                                const std::string& name = "log.ulg") {
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

inline std::string bytes_of(const std::string& path) { return *read_file(path); }

/// Where the first block begins.
inline std::size_t header_size(const std::string& log) {
  return log.find(ulog_subscriptions()) + ulog_subscriptions().size();
}

inline std::string u32_text(std::uint32_t value) {
  std::string out;
  put_u32(out, value);
  return out;
}

/// The definitions changed under a true check sum: `from`, which is there once, for `to` of the same length.
inline std::string with_definition(std::string log, const std::string& from, const std::string& to) {
  EXPECT_EQ(from.size(), to.size());
  const std::size_t at = log.find(from);
  EXPECT_LT(at, header_size(log)) << from;
  log.replace(at, to.size(), to);
  const std::size_t sum = header_size(log) - ulog_subscriptions().size() - 4;
  const std::size_t summed = log.rfind("uint32_t plumb_header_crc32", sum) - 1 - kUlogMessageHeader;
  return log.replace(sum, 4, u32_text(crc32_of(log.data(), summed)));
}

/// The block at `at` under a true check sum.
inline std::string with_block_sum(std::string log, std::size_t at, std::size_t rows, std::size_t row_bytes = kRow) {
  const std::uint32_t head = crc32_of(log.data() + at, kUlogBlockSum);
  const std::uint32_t sum = crc32_of(log.data() + at + kUlogBlockSize, rows * row_bytes, head);
  return log.replace(at + kUlogBlockSum, 4, u32_text(sum));
}

inline void expect_refused_log(const std::string& bytes, const std::string& field,
                               std::initializer_list<const char*> parts, const ArrayFile& array = array_of()) {
  const std::string path = written("bad.ulg", bytes);
  const auto log = read_log(path, array, BadRowPolicy::stop);
  ASSERT_FALSE(log.has_value()) << "accepted";
  expect_error(log.error(), path, 0, field, parts);
}

/// NaN are the same whatever their bits: a CSV keeps none of them.
inline bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b)); }

inline bool same(const Sample& a, const Sample& b) {
  bool equal = same(a.time_s, b.time_s) && a.station == b.station && a.roll_group == b.roll_group &&
               a.count == b.count && same(a.temperature_degc, b.temperature_degc) && a.delivered == b.delivered;
  for (std::size_t i = 0; i < kCapacity; ++i) equal = equal && same(a.raw[i], b.raw[i]);
  return equal;
}

inline bool same(const Rotation& a, const Rotation& b) {
  return a.turning == b.turning && a.rate_known == b.rate_known && a.rate_radps == b.rate_radps;
}

inline bool same(const std::vector<double>& a, const std::vector<double>& b) {
  bool equal = a.size() == b.size();
  for (std::size_t k = 0; equal && k < a.size(); ++k) equal = same(a[k], b[k]);
  return equal;
}

/// All that a reader says of the row at hand, as a writer takes it.
inline LogWriter::Notes notes_of(const LogReader& reader, bool held) {
  return {held, reader.rotation(), reader.depth_m(), reader.second_rotation(), clock_times(reader.clock_s())};
}

/// Row by row the same, and counted the same.
inline void expect_same(const std::string& one, const std::string& other, const ArrayFile& array) {
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
    const std::string row = "row " + std::to_string(a->statistics().rows);
    ASSERT_TRUE(same(s, t)) << row;
    ASSERT_TRUE(same(a->rotation(), b->rotation())) << row;
    ASSERT_TRUE(same(a->second_rotation(), b->second_rotation())) << row;
    ASSERT_TRUE(same(a->clock_s(), b->clock_s())) << row;
    ASSERT_TRUE(same(a->depth_m(), b->depth_m())) << row;
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
inline void convert(const std::string& from, const std::string& to, const ArrayFile& array) {
  auto reader = LogReader::open(from, array, BadRowPolicy::stop);
  ASSERT_TRUE(reader.has_value()) << reader.error().text();
  auto writer = LogWriter::create(to, array, LogWriter::Columns::all);
  ASSERT_TRUE(writer.has_value()) << writer.error().text();
  Sample sample;
  std::uint64_t held = 0;
  while (reader->next(sample) == LogReader::Next::row) {
    const std::uint64_t now = reader->statistics().temperature_held;
    ASSERT_TRUE(writer->write(sample, notes_of(*reader, now != held)).has_value());
    held = now;
  }
  ASSERT_TRUE(writer->commit().has_value());
}

}  // namespace log_ulog_support
