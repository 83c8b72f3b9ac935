/// Public recordings for tests (../shared/data, see its README). They are not part of the project: a test that
/// needs them says so and is skipped where they are missing.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace plumb_test {

/// $PLUMB_DATA_DIR, else ../shared/data beside the source tree.
inline std::string recording_path(const std::string& name) {
  const char* set = std::getenv("PLUMB_DATA_DIR");
  const std::string directory =
      set != nullptr && *set != '\0' ? set : std::string(PLUMB_SOURCE_DIR) + "/../shared/data";
  return directory + "/" + name;
}

/// A CSV file with a header row; an entry that is no number becomes NaN.
struct Recording {
  std::string path;
  std::vector<std::string> header;
  std::vector<std::vector<double>> rows;

  bool found() const { return !header.empty(); }
  std::size_t column(const std::string& name) const {
    for (std::size_t k = 0; k < header.size(); ++k) {
      if (header[k] == name) return k;
    }
    ADD_FAILURE() << path << " has no column " << name;
    return 0;
  }
  double at(std::size_t row, const std::string& name) const { return rows[row][column(name)]; }
};

inline std::vector<std::string> split_at_commas(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

/// Empty (`found()` is false) where the file is missing.
inline Recording load_recording(const std::string& name) {
  Recording out;
  out.path = recording_path(name);
  std::ifstream in(out.path);
  std::string line;
  if (!std::getline(in, line)) return out;
  while (!line.empty() && (line.back() == '\r' || line.back() == '\n')) line.pop_back();
  out.header = split_at_commas(line);
  while (std::getline(in, line)) {
    std::vector<double> row;
    for (const std::string& field : split_at_commas(line)) {
      char* end = nullptr;
      const double value = std::strtod(field.c_str(), &end);
      row.push_back(end == field.c_str() ? std::numeric_limits<double>::quiet_NaN() : value);
    }
    if (row.size() == out.header.size()) out.rows.push_back(row);
  }
  return out;
}

}  // namespace plumb_test

/// Loads a recording into `variable`, or skips the test and says what is missing.
#define PLUMB_RECORDING(variable, name)                                        \
  const ::plumb_test::Recording variable = ::plumb_test::load_recording(name); \
  if (!variable.found()) {                                                     \
    GTEST_SKIP() << "recording not found: " << variable.path                   \
                 << " (set PLUMB_DATA_DIR to the directory that holds it)";    \
  }
