/// What the tests of the pages share: where the house stands, and what a file of it says.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace house {

inline const std::filesystem::path kRoot = PLUMB_SOURCE_DIR;

inline std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace house
