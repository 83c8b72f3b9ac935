// What plumb/io/scenario_file.hpp refers to and the page never asks for: an array file inside the scenario file.
// Reading TOML takes exceptions, which this build has none of (web/logs has).
#include "../../src/io/toml_tree.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

FileExpected<TomlNode> parse_toml(const std::string&, const std::string& path) {
  return tl::unexpected<FileError>(FileError{path, 0, "", "TOML is not read here", "", ExitCode::other});
}
std::string toml_text(const TomlNode&, const std::string&) { return {}; }

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
