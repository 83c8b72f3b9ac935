/// A TOML document as a plain tree with line numbers (private to src/io), so that only one file has to
/// compile toml11.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

struct TomlNode {
  enum class Kind : std::uint8_t { text, integer, number, boolean, array, table, other };
  Kind kind = Kind::other;
  int line = 0;
  std::string text;
  std::int64_t integer = 0;
  double number = 0.0;  ///< also of an integer
  bool boolean = false;
  std::vector<TomlNode> items;
  std::vector<std::pair<std::string, TomlNode>> members;  ///< in the order of their lines

  const TomlNode* find(const std::string& key) const noexcept;
  /// "a string", "a number", ... for messages.
  const char* kind_name() const noexcept;
};

/// Errors: empty file, syntax (with its line).
FileExpected<TomlNode> parse_toml(const std::string& text, const std::string& path);

/// The same tree from JSON, without line numbers. Errors: syntax, null, what is no table.
FileExpected<TomlNode> parse_json_tree(const std::string& text, const std::string& path);

/// A table as TOML text, its own tables named "prefix.key"; reads back as the same tree.
std::string toml_text(const TomlNode& table, const std::string& prefix = "");
/// The tree as JSON text, indented by two.
std::string json_text(const TomlNode& table);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
