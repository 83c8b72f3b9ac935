/// The array file of a command, or one of its groups: "tool.toml#magnetometers".
#pragma once

#include <string>

#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Which groups of sensors a command serves.
enum class Serves : std::uint8_t {
  gravity,  ///< accelerometers
  lengths,  ///< every field whose length is known at rest
  all,
};

/// "tool.toml" of "tool.toml#mag"; a file that has the sign in its name stays.
std::string array_file_of(const std::string& path);

/// A log that is written anew holds the columns of one group; empty where the tool has no other.
std::string columns_left_out(const io::ArrayFile& array, const std::string& out);

/// The file, with WMM2025 for magnetic groups that state a place and a date. Refuses a group that `command` does not
/// serve.
io::FileExpected<io::ArrayFile> read_array(const std::string& path, const char* command, Serves serves);

/// The same of a command that serves accelerometers alone. `instead` says what serves a group, with "{}" for its path:
/// "plumb geometry {} has its sizes".
io::FileExpected<io::ArrayFile> read_accelerometers(const std::string& path, const char* command, const char* instead);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
