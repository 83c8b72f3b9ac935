/// What the tests of io share: an array file that is right, and a way to make it wrong.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <string>

#include "plumb/io/array_file.hpp"
#include "plumb/io/file_error.hpp"

namespace io_test {

using plumb::io::FileError;

/// Lines are counted on in the tests: line 1 is `name`.
inline const std::string kArrayText = R"(name = "four on a tool"
[gravity]
model = "value"
value = "9.81 m/s^2"
sigma = "0.2 mg"
[monitor]
window = 16
delta_f = "0.05 g0"
alert_limit = "1 deg"
[input]
rows = "samples"
time = "t_s"
reads = "gravity"
unit = "V"
[[sensor]]
id = "A1"
column = "a1_v"
axis = [1.0, 0.0, 0.0]
scale = "3 V/g0"
bias = "12 mg"
noise = "0.5 mg"
full_scale = "5 V"
[[sensor]]
id = "A2"
column = "a2_v"
axis = [0.0, 1.0, 0.0]
scale = "3 V/g0"
noise = "0.5 mg"
[[sensor]]
id = "A3"
column = "a3_v"
axis = [0.0, 0.0, 1.0]
scale = "3 V/g0"
noise = "0.5 mg"
[[sensor]]
id = "A4"
column = "a4_v"
axis = [0.6, 0.0, 0.8]
scale = "3 V/g0"
noise = "0.5 mg"
prior = {bias = "20 mg", scale = "2 %", axis = "2 deg"}
)";

/// kArrayText with the first `from` replaced.
inline std::string changed(const std::string& from, const std::string& to, std::string text = kArrayText) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    ADD_FAILURE() << "the text has no " << from;
    return text;
  }
  return text.replace(at, from.size(), to);
}

inline plumb::io::ArrayFile array_of(const std::string& text = kArrayText) {
  auto array = plumb::io::parse_array_text(text, "array.toml");
  if (!array) {
    ADD_FAILURE() << array.error().text();
    return {};
  }
  return *std::move(array);
}

/// A new file of this test; what an earlier run left under its name (a link, say) is removed, not written through.
inline std::string written(const std::string& name, const std::string& text) {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const std::string path = testing::TempDir() + "plumb_io_" + info->test_suite_name() + "_" + info->name() + "_" + name;
  (void)std::remove(path.c_str());
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

inline void expect_error(const FileError& error, const std::string& file, int line, const std::string& field,
                         std::initializer_list<const char*> parts) {
  const std::string text = error.text();
  EXPECT_EQ(error.file, file) << text;
  EXPECT_EQ(error.line, line) << text;
  EXPECT_EQ(error.field, field) << text;
  EXPECT_FALSE(error.remedy.empty()) << text;
  EXPECT_EQ(error.code, plumb::io::ExitCode::invalid_input) << text;
  for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
}

inline void expect_refused(const std::string& array_text, int line, const std::string& field,
                           std::initializer_list<const char*> parts) {
  const auto array = plumb::io::parse_array_text(array_text, "array.toml");
  ASSERT_FALSE(array.has_value()) << "accepted";
  expect_error(array.error(), "array.toml", line, field, parts);
}

}  // namespace io_test
