#include "plumb/io/log_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "io_test_support.hpp"
#include "plumb/io/log_reader.hpp"

namespace log_writer_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

std::string written_log(const ArrayFile& array, const std::vector<Sample>& samples) {
  const std::string path = written("out.csv", "");
  auto writer = LogWriter::create(path, array);
  EXPECT_TRUE(writer.has_value());
  for (const Sample& sample : samples) EXPECT_TRUE(writer->write(sample).has_value());
  EXPECT_TRUE(writer->commit().has_value());
  return path;
}

TEST(LogWriter, WritesTheColumnsOfTheArrayFile) {
  const ArrayFile array =
      array_of(changed("time = \"t_s\"",
                       "time = \"t_s\"\nstation = \"att\"\nroll_group = \"ring\"\ncount = \"n\"\ntemperature = "
                       "\"T\"\nwhere = {exp = 2, att = 5}"));
  Sample sample;
  sample.roll_group = tag_of_label(7);
  sample.time_s = 0.1;
  sample.station = tag_of_label(5);
  sample.count = 3;
  sample.temperature_degc = 20.5;
  sample.raw = {1.0, std::numeric_limits<double>::quiet_NaN(), 0.1 + 0.2, 0.0};
  sample.delivered = SensorSet::first(3);
  const auto text = read_file(written_log(array, {sample}));
  ASSERT_TRUE(text.has_value());
  EXPECT_EQ(*text, "t_s,att,ring,n,T,exp,a1_v,a2_v,a3_v,a4_v\n0.1,5,7,3,20.5,2,1,nan,0.30000000000000004,\n");
}

TEST(LogWriter, SaysWhyItCannotWrite) {
  const auto writer = LogWriter::create("/nonexistent/out.csv", array_of());
  ASSERT_FALSE(writer.has_value());
  EXPECT_EQ(writer.error().code, ExitCode::other);
  EXPECT_NE(writer.error().text().find("/nonexistent/out.csv: cannot write: No such file"), std::string::npos);
  EXPECT_NE(writer.error().text().find("Remedy: create the directory"), std::string::npos);
}

double any_double() {
  const std::uint64_t bits = *rc::gen::arbitrary<std::uint64_t>();
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b)); }

RC_GTEST_PROP(LogWriterLaw, WhatIsWrittenReadsBackBitForBit, ()) {
  static const ArrayFile array =
      array_of(changed("time = \"t_s\"", "time = \"t_s\"\nstation = \"att\"\ncount = \"n\""));
  std::vector<Sample> samples(5);
  double time_s = 0.0;
  for (Sample& sample : samples) {
    time_s += 1e-3 * static_cast<double>(*rc::gen::inRange(1, 1000000));
    sample.time_s = time_s;
    sample.temperature_degc = 25.0;
    sample.station = *rc::gen::inRange<std::uint32_t>(0U, 4000000000U);
    sample.count = *rc::gen::inRange<std::uint32_t>(1U, 4000000000U);
    sample.delivered = SensorSet(*rc::gen::inRange<std::uint32_t>(0U, 16U));
    for (int i = 0; i < 4; ++i) {
      if (sample.delivered.has(i)) sample.raw[static_cast<std::size_t>(i)] = any_double();
    }
  }
  const auto log = read_log(written_log(array, samples), array, BadRowPolicy::stop);
  RC_ASSERT(log.has_value());
  RC_ASSERT(log->samples.size() == samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Sample& in = samples[k];
    const Sample& out = log->samples[k];
    RC_ASSERT(in.time_s == out.time_s);
    RC_ASSERT(in.station == out.station);
    RC_ASSERT(in.count == out.count);
    RC_ASSERT(in.delivered == out.delivered);
    for (std::size_t i = 0; i < 4; ++i) RC_ASSERT(same(in.raw[i], out.raw[i]));
  }
}

}  // namespace
}  // namespace log_writer_test
