/// What the tests of DataFlash logs share: reading bytes, and a log with everything in it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "dataflash_bytes.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/logs/flight_log.hpp"
#include "told.hpp"

namespace dataflash_test_support {

using namespace plumb::logs;
using namespace logs_told;
using namespace dataflash_bytes;

struct Read {
  Told heard;
  bool is_read = false;
  LogExtent extent;
  plumb::io::FileError error;
};

inline Read read(const std::string& bytes) {
  Read out;
  const LogFile file(bytes);
  const auto extent = read_dataflash(file.path(), out.heard);
  out.is_read = extent.has_value();
  if (extent) {
    out.extent = *extent;
    EXPECT_EQ(extent->bytes, bytes.size());
    EXPECT_LE(extent->read_bytes, extent->bytes);
    EXPECT_EQ(extent->records, out.heard.records.size());
  } else {
    out.error = extent.error();
    EXPECT_EQ(out.error.file, file.path());
    EXPECT_FALSE(out.error.what.empty());
    EXPECT_FALSE(out.error.remedy.empty());
  }
  for (const Note& note : out.heard.notes) EXPECT_LE(note.offset, bytes.size()) << note.what;
  return out;
}

inline Read read(const Log& log) { return read(log.bytes()); }

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
