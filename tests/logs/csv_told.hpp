/// Tables of text, and what they tell, for tests.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "plumb/logs/csv_log.hpp"
#include "plumb/logs/flight_log.hpp"
#include "told.hpp"

namespace csv_told {

using namespace plumb;
using namespace plumb::logs;
using namespace logs_told;

/// In a folder of its own: the name of a file may say what it holds.
class Table {
 public:
  Table(const std::string& bytes, const std::string& name)
      : folder_(testing::TempDir() + "plumb_table_" + std::to_string(::getpid()) + "_"), path_(folder_ + name) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;
  ~Table() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string folder_;
  std::string path_;
};

inline io::FileExpected<LogExtent> read_table(const std::string& bytes, Told& told, const CsvHints& hints = {},
                                              const std::string& name = "log.csv") {
  const Table table(bytes, name);
  return read_csv_log(table.path(), hints, told);
}

inline Told told_of_table(const std::string& bytes, const CsvHints& hints = {}, const std::string& name = "log.csv") {
  Told out;
  const auto extent = read_table(bytes, out, hints, name);
  EXPECT_TRUE(extent.has_value()) << extent.error().text() << "\n" << bytes.substr(0, 200);
  if (extent) {
    EXPECT_EQ(extent->bytes, bytes.size());
    EXPECT_EQ(extent->read_bytes, bytes.size());
    EXPECT_EQ(extent->records, out.records.size());
  }
  return out;
}

inline io::FileError refusal_of_table(const std::string& bytes, const CsvHints& hints = {}) {
  Told told;
  const auto extent = read_table(bytes, told, hints);
  EXPECT_FALSE(extent.has_value()) << bytes.substr(0, 200);
  return extent ? io::FileError{} : extent.error();
}

/// ASCII in UTF-16.
inline std::string utf16(const std::string& text, bool is_big) {
  std::string out;
  for (const char c : text) out += is_big ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

}  // namespace csv_told
