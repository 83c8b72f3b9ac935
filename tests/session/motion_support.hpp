/// The example array in motion, to be changed by the tests of the session.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "cli/tool_runner.hpp"
#include "plumb/io/array_file.hpp"

namespace motion_support {

inline std::string drone_text() { return plumb_test::read_text(PLUMB_SOURCE_DIR "/examples/motion/drone.toml"); }

inline plumb::io::ArrayFile array_of(const std::string& text) {
  auto array = plumb::io::parse_array_text(text, "drone.toml");
  if (!array) {
    ADD_FAILURE() << array.error().text();
    return {};
  }
  return *std::move(array);
}

/// Without the line that begins with `key`; fails the test where there is none.
inline std::string without(const std::string& key, std::string text) {
  const std::size_t at = text.find("\n" + key);
  EXPECT_NE(at, std::string::npos) << key;
  return at == std::string::npos ? text : text.erase(at, text.find('\n', at + 1) - at);
}

/// Without each line that begins with it.
inline std::string without_all(const std::string& key, std::string text) {
  while (text.find("\n" + key) != std::string::npos) text = without(key, text);
  return text;
}

}  // namespace motion_support
