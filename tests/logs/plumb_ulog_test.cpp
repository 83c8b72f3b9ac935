// A ULog that plumb wrote, seen by the reader of ULogs that others write: whole, and of no accelerometer that it knows.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "plumb/io/array_file.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/io/output_file.hpp"
#include "told.hpp"

namespace plumb_ulog_test {
namespace {

using namespace plumb;

std::string written_log(std::size_t rows) {
  const auto array = io::read_array_file(std::string(PLUMB_SOURCE_DIR) + "/examples/paper_tool.toml");
  const std::string path = testing::TempDir() + "plumb_logs_own_" + std::to_string(::getpid()) + ".ulg";
  auto writer = io::LogWriter::create(path, *array);
  Sample sample;
  sample.delivered = array->array.all();
  for (std::size_t k = 0; k < rows; ++k) {
    sample.time_s = 0.01 * static_cast<double>(k);
    sample.temperature_degc = 25.0;
    sample.raw[0] = std::sin(sample.time_s);
    EXPECT_TRUE(writer->write(sample).has_value());
  }
  EXPECT_TRUE(writer->commit().has_value());
  return path;
}

TEST(PlumbUlog, IsAULogToTheLastByte) {
  const std::string path = written_log(3000);
  logs_told::Told told;
  const auto extent = logs::read_ulog(path, told);
  ASSERT_TRUE(extent.has_value()) << extent.error().text();
  EXPECT_GT(extent->bytes, 3000U * 60U);
  EXPECT_EQ(extent->read_bytes, extent->bytes);
  EXPECT_EQ(told.all_notes(), "");
  EXPECT_TRUE(told.sources.empty());
  std::remove(path.c_str());
}

TEST(PlumbUlog, WhoReadsLogsWithoutAnArrayFileSaysWhoReadsIt) {
  const std::string path = written_log(3);
  const auto format = logs::log_format(path);
  ASSERT_FALSE(format.has_value());
  EXPECT_NE(format.error().text().find("is a ULog that plumb wrote"), std::string::npos) << format.error().text();
  EXPECT_NE(format.error().remedy.find("plumb monitor"), std::string::npos) << format.error().text();
  // It is known by what comes behind the header: one of PX4 is read as before.
  std::string bytes = *io::read_file(path);
  bytes.replace(bytes.find("plumb"), 5, "PX4v1");
  const logs_told::LogFile other(bytes);
  const auto px4 = logs::log_format(other.path());
  ASSERT_TRUE(px4.has_value());
  EXPECT_STREQ(to_string(*px4), "ULog");
  std::remove(path.c_str());
}

}  // namespace
}  // namespace plumb_ulog_test
