// The tree in and out of text other than what toml11 reads: JSON both ways, and TOML written.
#include <cmath>

#include "plumb/io/json_fields.hpp"
#include "plumb/io/records.hpp"
#include "plumb/io/units.hpp"
#include "toml_tree.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

using Json = nlohmann::ordered_json;
using Kind = TomlNode::Kind;

/// Deeper nesting than any scenario has.
constexpr int kDeepest = 64;

struct Strange {
  std::string what;
};

TomlNode converted(const Json& json, int depth) {  // NOLINT(misc-no-recursion) at most kDeepest levels
  if (depth > kDeepest) throw Strange{"brackets are nested too deeply"};
  TomlNode node;
  if (json.is_string()) {
    node.kind = Kind::text;
    node.text = json.get<std::string>();
  } else if (json.is_boolean()) {
    node.kind = Kind::boolean;
    node.boolean = json.get<bool>();
  } else if (json.is_number_integer()) {
    node.kind = Kind::integer;
    // What an integer of TOML cannot hold is the largest one, as toml11 makes it.
    const bool huge = json.is_number_unsigned() && json.get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX);
    node.integer = huge ? INT64_MAX : json.get<std::int64_t>();
    node.number = static_cast<double>(node.integer);
  } else if (json.is_number()) {
    node.kind = Kind::number;
    node.number = json.get<double>();
  } else if (json.is_array()) {
    node.kind = Kind::array;
    for (const Json& item : json) node.items.push_back(converted(item, depth + 1));
  } else if (json.is_object()) {
    node.kind = Kind::table;
    for (const auto& [key, value] : json.items()) node.members.emplace_back(key, converted(value, depth + 1));
  } else {
    throw Strange{"null is not allowed here"};
  }
  return node;
}

Json json_of(const TomlNode& node) {  // NOLINT(misc-no-recursion) as deep as the tree
  switch (node.kind) {
    case Kind::text: return node.text;
    case Kind::integer: return node.integer;
    case Kind::number: return node.number;
    case Kind::boolean: return node.boolean;
    case Kind::array: {
      Json out = Json::array();
      for (const TomlNode& item : node.items) out.push_back(json_of(item));
      return out;
    }
    case Kind::table: {
      Json out = Json::object();
      for (const auto& [key, value] : node.members) out[key] = json_of(value);
      return out;
    }
    case Kind::other: break;
  }
  return {};
}

std::string quoted(const std::string& text) {
  std::string out;
  append_json_string(out, text);
  return out;
}

std::string key_text(const std::string& key) {
  const bool bare =
      !key.empty() &&
      key.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
  return bare ? key : quoted(key);
}

std::string value_text(const TomlNode& node) {  // NOLINT(misc-no-recursion) as deep as the tree
  switch (node.kind) {
    case Kind::text: return quoted(node.text);
    case Kind::integer: return std::to_string(node.integer);
    case Kind::boolean: return node.boolean ? "true" : "false";
    case Kind::number: {
      std::string text = shortest(node.number);
      if (std::isfinite(node.number) && text.find_first_of(".e") == std::string::npos) text += ".0";
      return text;
    }
    case Kind::array: {
      std::string out = "[";
      for (const TomlNode& item : node.items) out += (out.size() > 1 ? ", " : "") + value_text(item);
      return out + "]";
    }
    case Kind::table: {
      std::string out = "{";
      for (const auto& [key, value] : node.members) {
        out += (out.size() > 1 ? ", " : "") + key_text(key) + " = " + value_text(value);
      }
      return out + "}";
    }
    case Kind::other: break;
  }
  return "\"\"";
}

bool is_list_of_tables(const TomlNode& node) {
  bool tables = node.kind == Kind::array && !node.items.empty();
  for (const TomlNode& item : node.items) tables = tables && item.kind == Kind::table;
  return tables;
}

/// The keys of a table, its own tables in braces.
std::string lines_of(const TomlNode& table) {
  std::string out;
  for (const auto& [key, value] : table.members) out += key_text(key) + " = " + value_text(value) + "\n";
  return out;
}

}  // namespace

FileExpected<TomlNode> parse_json_tree(const std::string& text, const std::string& path) {
  const auto refused = [&path](const std::string& what) {
    FileError error;
    error.file = path;
    error.what = "is not valid JSON: " + what;
    error.remedy = "correct it, or write TOML; keys and tables are the same";
    return tl::unexpected<FileError>(std::move(error));
  };
  try {
    return converted(Json::parse(text), 0);
  } catch (const Strange& strange) {
    return refused(strange.what);
  } catch (const std::exception& error) {
    return refused(error.what());
  }
}

std::string toml_text(const TomlNode& table, const std::string& prefix) {
  std::string plain, sections;
  const std::string before = prefix.empty() ? "" : prefix + ".";
  for (const auto& [key, value] : table.members) {
    if (value.kind == Kind::table) {
      sections += "\n[" + before + key_text(key) + "]\n" + lines_of(value);
    } else if (is_list_of_tables(value)) {
      for (const TomlNode& item : value.items) sections += "\n[[" + before + key_text(key) + "]]\n" + lines_of(item);
    } else {
      plain += key_text(key) + " = " + value_text(value) + "\n";
    }
  }
  return (prefix.empty() ? "" : "[" + prefix + "]\n") + plain + sections;
}

std::string json_text(const TomlNode& table) { return json_of(table).dump(2) + "\n"; }

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
