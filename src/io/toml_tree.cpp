#include "toml_tree.hpp"

#include <algorithm>
#include <sstream>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#endif
#include <toml.hpp>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// Deeper nesting than any array file has; toml11 recurses, so a hostile file could end the stack.
constexpr int kDeepest = 64;

int depth_of(const std::string& text) {
  int depth = 0;
  int deepest = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if ((c == ']' || c == '}') && depth > 0) --depth;
  }
  return deepest;
}

TomlNode converted(const toml::value& value) {  // NOLINT(misc-no-recursion) at most kDeepest levels
  TomlNode node;
  node.line = static_cast<int>(value.location().line());
  if (value.is_string()) {
    node.kind = TomlNode::Kind::text;
    node.text = value.as_string().str;
  } else if (value.is_integer()) {
    node.kind = TomlNode::Kind::integer;
    node.integer = value.as_integer();
    node.number = static_cast<double>(node.integer);
  } else if (value.is_floating()) {
    node.kind = TomlNode::Kind::number;
    node.number = value.as_floating();
  } else if (value.is_boolean()) {
    node.kind = TomlNode::Kind::boolean;
    node.boolean = value.as_boolean();
  } else if (value.is_array()) {
    node.kind = TomlNode::Kind::array;
    for (const toml::value& item : value.as_array()) node.items.push_back(converted(item));
  } else if (value.is_table()) {
    node.kind = TomlNode::Kind::table;
    for (const auto& member : value.as_table()) node.members.emplace_back(member.first, converted(member.second));
    std::sort(node.members.begin(), node.members.end(), [](const auto& a, const auto& b) {
      return a.second.line != b.second.line ? a.second.line < b.second.line : a.first < b.first;
    });
  }
  return node;
}

/// The first line of toml11's message without its decoration: "[error] toml::f: what" -> "what".
std::string first_line(const std::string& message) {
  std::string line = message.substr(0, message.find('\n'));
  const std::size_t tag = line.find("[error] ");
  if (tag != std::string::npos) line = line.substr(tag + 8);
  if (line.compare(0, 6, "toml::") == 0) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) line = line.substr(colon + 2);
  }
  return line;
}

/// toml11 names the line in its message only ("  12 | text"), and 1 where it does not know.
int line_in(const std::string& message, const toml::exception& error) {
  const std::size_t bar = message.find(" | ");
  std::size_t begin = bar;
  while (bar != std::string::npos && begin > 0 && message[begin - 1] >= '0' && message[begin - 1] <= '9') --begin;
  if (bar != std::string::npos && begin < bar && bar - begin < 9) return std::stoi(message.substr(begin, bar - begin));
  return static_cast<int>(error.location().line());
}

FileError syntax(const std::string& path, int line, std::string what) {
  FileError error;
  error.file = path;
  error.line = line;
  error.what = "is not valid TOML: " + std::move(what);
  error.remedy = "correct the line: text in double quotes, key = value, one [section] or [[sensor]] per line";
  return error;
}

}  // namespace

const TomlNode* TomlNode::find(const std::string& key) const noexcept {
  for (const auto& member : members) {
    if (member.first == key) return &member.second;
  }
  return nullptr;
}

const char* TomlNode::kind_name() const noexcept {
  switch (kind) {
    case Kind::text: return "a string";
    case Kind::integer: return "an integer";
    case Kind::number: return "a number";
    case Kind::boolean: return "a boolean";
    case Kind::array: return "a list";
    case Kind::table: return "a table";
    case Kind::other: break;
  }
  return "a date";
}

FileExpected<TomlNode> parse_toml(const std::string& text, const std::string& path) {
  const bool bom = text.compare(0, 3, "\xEF\xBB\xBF") == 0;
  std::string body = text.substr(bom ? 3 : 0);
  if (body.find_first_not_of(" \t\r\n") == std::string::npos) {
    FileError error;
    error.file = path;
    error.what = "the file is empty";
    error.remedy = "describe the array: [gravity], [input] and one [[sensor]] for each accelerometer";
    return tl::unexpected<FileError>(std::move(error));
  }
  if (depth_of(body) > kDeepest) return tl::unexpected<FileError>(syntax(path, 0, "brackets are nested too deeply"));
  if (body.back() != '\n') body += '\n';
  try {
    std::istringstream stream(body);
    return converted(toml::parse(stream, path));
  } catch (const toml::exception& error) {
    return tl::unexpected<FileError>(syntax(path, line_in(error.what(), error), first_line(error.what())));
  } catch (const std::exception& error) {
    return tl::unexpected<FileError>(syntax(path, 0, first_line(error.what())));
  }
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
