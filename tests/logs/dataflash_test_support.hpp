/// What the tests of DataFlash logs share: a sink that keeps what it is told, and a log with everything in it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "dataflash_bytes.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/logs/flight_log.hpp"

namespace dataflash_test_support {

using namespace plumb::logs;
using namespace dataflash_bytes;

struct Note {
  std::uint64_t offset;
  std::string what;
};

struct Heard : LogSink {
  void source(std::size_t number, const ImuSource& source) override {
    EXPECT_EQ(number, sources.size());
    sources.push_back(source);
  }
  void record(std::size_t number, const ImuRecord& record) override {
    EXPECT_LT(number, sources.size());
    records.emplace_back(number, record);
  }
  void parameter(const std::string& name, double value) override { parameters.emplace_back(name, value); }
  void note(std::uint64_t offset, const std::string& what) override {
    EXPECT_FALSE(what.empty());
    EXPECT_EQ(what.find_first_of("\n\r\x1b"), std::string::npos) << what;
    notes.push_back({offset, what});
  }
  /// Of the records of one source.
  std::vector<ImuRecord> of(std::size_t number) const {
    std::vector<ImuRecord> out;
    for (const auto& [source, record] : records) {
      if (source == number) out.push_back(record);
    }
    return out;
  }
  std::size_t notes_with(const std::string& text) const {
    std::size_t count = 0;
    for (const Note& note : notes) count += note.what.find(text) != std::string::npos ? 1U : 0U;
    return count;
  }
  std::string told() const {
    std::string out;
    for (const Note& note : notes) out += std::to_string(note.offset) + ": " + note.what + "\n";
    return out;
  }

  std::vector<ImuSource> sources;
  std::vector<std::pair<std::size_t, ImuRecord>> records;
  std::vector<std::pair<std::string, double>> parameters;
  std::vector<Note> notes;
};

struct Read {
  Heard heard;
  bool is_read = false;
  LogExtent extent;
  plumb::io::FileError error;
};

inline std::string file_of(const std::string& bytes) {
  // Tests run side by side.
  const std::string path = testing::TempDir() + "dataflash_" + std::to_string(::getpid()) + ".bin";
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

inline Read read(const std::string& bytes) {
  Read out;
  const std::string path = file_of(bytes);
  const auto extent = read_dataflash(path, out.heard);
  out.is_read = extent.has_value();
  if (extent) {
    out.extent = *extent;
    EXPECT_EQ(extent->bytes, bytes.size());
    EXPECT_LE(extent->read_bytes, extent->bytes);
    EXPECT_EQ(extent->records, out.heard.records.size());
  } else {
    out.error = extent.error();
    EXPECT_EQ(out.error.file, path);
    EXPECT_FALSE(out.error.what.empty());
    EXPECT_FALSE(out.error.remedy.empty());
  }
  for (const Note& note : out.heard.notes) EXPECT_LE(note.offset, bytes.size()) << note.what;
  std::remove(path.c_str());
  return out;
}

inline Read read(const Log& log) { return read(log.bytes()); }

inline bool same(double a, double b) { return (std::isnan(a) && std::isnan(b)) || !(std::abs(a - b) > 0.0); }

inline bool same(const ImuRecord& a, const ImuRecord& b) {
  bool out = same(a.time_s, b.time_s) && same(a.temperature_degc, b.temperature_degc) && a.clipped == b.clipped;
  for (std::size_t k = 0; k < 3; ++k) {
    out = out && same(a.specific_force_mps2[k], b.specific_force_mps2[k]) && same(a.rate_radps[k], b.rate_radps[k]);
  }
  return out;
}

inline void expect_prefix(const Heard& part, const Heard& whole) {
  ASSERT_LE(part.records.size(), whole.records.size());
  for (std::size_t k = 0; k < part.records.size(); ++k) {
    ASSERT_EQ(part.records[k].first, whole.records[k].first);
    ASSERT_TRUE(same(part.records[k].second, whole.records[k].second)) << k;
  }
  ASSERT_LE(part.parameters.size(), whole.parameters.size());
  for (std::size_t k = 0; k < part.parameters.size(); ++k) ASSERT_EQ(part.parameters[k], whole.parameters[k]);
}

/// A log with everything that is read, some hundred messages.
inline Log everything() {
  Log log = new_log();
  log.message(kUnit, {0.0, static_cast<double>('o'), "m/s/s"});
  log.message(kMult, {0.0, static_cast<double>('F'), 1e-6});
  log.message(kFmtu, {0.0, static_cast<double>(kImu), "s#EEEooo--O--zz", "F-000000-----00"});
  log.message(kParm, {1e5, "INS_ACC_ID", 2753028.0, 0.0});
  log.message(kParm, {1e5, "INS_ACCOFFS_X", 0.5, 0.0});
  for (int k = 0; k < 4; ++k) {
    const double time_us = 1e6 + 2500.0 * k;
    for (int instance = 0; instance < 3; ++instance) imu_at(log, time_us + instance, instance);
    log.message(kAcc, {time_us + 5, 1.0, time_us - 100, 0.5, 0.25, -9.5});
    log.message(kVibe, {time_us + 6, 2.0, 0.0, 0.0, 0.0, 7.0 * k});
    log.message(kOther, {time_us + 7, 100.0, -100.0, 0.0});
  }
  return log;
}

}  // namespace dataflash_test_support
