/// Files of an earlier plumb in the words of this one: names of keys alone change, comments and layout stay.
#pragma once

#include <string>
#include <vector>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

struct Renaming {
  int line = 0;
  std::string section;  ///< "monitor"
  std::string old_name, new_name;
};

struct Upgraded {
  std::string text;
  std::vector<Renaming> renamed;  ///< in the order of the lines; empty: nothing is old, and `text` is what was given
};

/// Of an array, scenario or campaign file (TOML, or JSON as the Python module takes it) or a calibration file (JSON),
/// whose check sum is made anew. Errors: no such file, damaged; a key that no other stands for, with what to write.
FileExpected<Upgraded> upgrade_text(const std::string& text, const std::string& path);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
