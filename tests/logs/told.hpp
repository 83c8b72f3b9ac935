/// Who is told what a log holds and keeps it, and a log as a file, for tests.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "plumb/logs/flight_log.hpp"

namespace logs_told {

using plumb::logs::Axes;
using plumb::logs::ImuRecord;
using plumb::logs::ImuSource;

struct Note {
  std::uint64_t offset;
  std::string what;
};

struct Told final : plumb::logs::LogSink {
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

  void status(const plumb::logs::ChipStatus& status) override { statuses.push_back(status); }
  void detected(const std::string& what) override {
    EXPECT_TRUE(sources.empty());
    understood = what;
  }

  /// Its number, or that of the sources where there is none of this name.
  std::size_t number_of(const std::string& name) const {
    const auto found =
        std::find_if(sources.begin(), sources.end(), [&](const ImuSource& one) { return one.name == name; });
    return static_cast<std::size_t>(found - sources.begin());
  }
  std::vector<ImuRecord> records_of(std::size_t number) const {
    std::vector<ImuRecord> out;
    for (const auto& [source, record] : records) {
      if (source == number) out.push_back(record);
    }
    return out;
  }
  std::vector<ImuRecord> records_of(const std::string& name) const { return records_of(number_of(name)); }
  std::size_t notes_with(const std::string& words) const {
    return static_cast<std::size_t>(std::count_if(
        notes.begin(), notes.end(), [&](const Note& note) { return note.what.find(words) != std::string::npos; }));
  }
  bool noted(const std::string& words) const { return notes_with(words) > 0; }
  std::string all_notes() const {
    std::string out;
    for (const Note& note : notes) out += std::to_string(note.offset) + ": " + note.what + "\n";
    return out;
  }

  std::vector<ImuSource> sources;
  std::vector<std::pair<std::size_t, ImuRecord>> records;
  std::vector<std::pair<std::string, double>> parameters;
  std::vector<plumb::logs::ChipStatus> statuses;
  std::vector<Note> notes;
  std::string understood;
};

/// In the directory of temporary files, and gone with it. Tests run side by side.
class LogFile {
 public:
  explicit LogFile(const std::string& bytes)
      : path_(testing::TempDir() + "plumb_log_" + std::to_string(::getpid()) + ".bin") {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  ~LogFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline bool same(double a, double b) { return (std::isnan(a) && std::isnan(b)) || !(std::abs(a - b) > 0.0); }
inline bool same(const Axes& a, const Axes& b) { return same(a[0], b[0]) && same(a[1], b[1]) && same(a[2], b[2]); }
inline bool same(const ImuRecord& a, const ImuRecord& b) {
  return same(a.time_s, b.time_s) && same(a.temperature_degc, b.temperature_degc) && a.clipped == b.clipped &&
         a.count == b.count && same(a.specific_force_mps2, b.specific_force_mps2) && same(a.rate_radps, b.rate_radps) &&
         same(a.variance_m2ps4, b.variance_m2ps4);
}

/// What a part of a log told is what the whole log told first.
inline void expect_prefix(const Told& part, const Told& whole) {
  ASSERT_LE(part.records.size(), whole.records.size());
  for (std::size_t k = 0; k < part.records.size(); ++k) {
    ASSERT_EQ(part.records[k].first, whole.records[k].first);
    ASSERT_TRUE(same(part.records[k].second, whole.records[k].second)) << k;
  }
  ASSERT_LE(part.parameters.size(), whole.parameters.size());
  for (std::size_t k = 0; k < part.parameters.size(); ++k) ASSERT_EQ(part.parameters[k], whole.parameters[k]);
}

}  // namespace logs_told
