#include "toml_table.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/scenario/count_text.hpp"
#include "refusal.hpp"
#include "renamed_keys.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

TomlTable::TomlTable(const TomlNode& node, std::string file, std::string path, const std::vector<std::string>& known,
                     FieldKind field)
    : node_(&node), file_(std::move(file)), path_(std::move(path)), field_(field) {
  if (node.kind != TomlNode::Kind::table) {
    throw Refusal(FileError{file_, node.line, path_, std::string("is ") + node.kind_name() + ", must be a table",
                            "write [" + path_ + "] on a line of its own and its keys below"});
  }
  for (const auto& member : node.members) {
    if (std::find(known.begin(), known.end(), member.first) != known.end()) continue;
    if (const RenamedKey* old = renamed_key(path_, member.first))
      fail(member.second.line, member.first, what_of(*old), remedy_of(*old, file_));
    fail(member.second.line, member.first, "is not a known key",
         did_you_mean(member.first, known) + "known keys here: " + joined(known));
  }
}

std::string TomlTable::field(const std::string& key) const {
  if (path_.empty()) return key;
  return key.empty() ? path_ : path_ + "." + key;
}

int TomlTable::line_of(const char* key) const noexcept {
  const TomlNode* value = find(key);
  return value == nullptr ? node_->line : value->line;
}

void TomlTable::fail(int line, const std::string& key, const std::string& what, const std::string& remedy) const {
  throw Refusal(FileError{file_, line, field(key), what, remedy});
}

void TomlTable::wrong_kind(const TomlNode& value, const char* key, const char* wanted,
                           const std::string& remedy) const {
  fail(value.line, key, std::string("is ") + value.kind_name() + ", must be " + wanted, remedy);
}

const TomlNode& TomlTable::need(const char* key, const std::string& remedy) const {
  const TomlNode* value = find(key);
  if (value == nullptr) fail(node_->line, key, "is missing", remedy);
  return *value;
}

std::string TomlTable::text(const char* key, const std::string& fallback) const {
  return has(key) ? need_text(key, "") : fallback;
}

std::string TomlTable::need_text(const char* key, const std::string& remedy) const {
  const TomlNode& value = need(key, remedy);
  if (value.kind != TomlNode::Kind::text) wrong_kind(value, key, "a string", "put it in double quotes");
  if (trimmed(value.text).empty())
    fail(value.line, key, "is empty", remedy.empty() ? "give it a value, or remove the key" : remedy);
  return value.text;
}

int TomlTable::choice(const char* key, const std::vector<std::string>& choices, int fallback) const {
  return has(key) ? need_choice(key, choices, "") : fallback;
}

int TomlTable::need_choice(const char* key, const std::vector<std::string>& choices, const std::string& remedy) const {
  const std::string given = need_text(key, remedy);
  const auto found = std::find(choices.begin(), choices.end(), given);
  if (found == choices.end()) {
    if (const RenamedWord* old = renamed_word(path_, key, given))
      fail(line_of(key), key, "is " + in_quotes(given) + ", renamed " + in_quotes(old->new_word),
           upgrade_remedy(file_));
    fail(line_of(key), key, "is " + in_quotes(given) + ", which is not known",
         did_you_mean(given, choices) + "use one of: " + joined(choices));
  }
  return static_cast<int>(found - choices.begin());
}

std::string TomlTable::text_with_unit(const TomlNode& value, const char* key, const std::string& units) const {
  if (value.kind == TomlNode::Kind::text) return value.text;
  if (value.kind == TomlNode::Kind::number || value.kind == TomlNode::Kind::integer) {
    fail(value.line, key, "is " + shortest(value.number) + ": the unit is missing",
         "write it in double quotes with its unit, one of: " + units);
  }
  wrong_kind(value, key, "a string with a unit", "use one of: " + units);
}

double TomlTable::quantity(Quantity quantity, const char* key, double fallback) const {
  return has(key) ? need_quantity(quantity, key, "") : fallback;
}

double TomlTable::need_quantity(Quantity quantity, const char* key, const std::string& remedy) const {
  const TomlNode& value = need(key, remedy);
  const bool plain = value.kind == TomlNode::Kind::number || value.kind == TomlNode::Kind::integer;
  if (quantity == Quantity::ratio && plain) {
    if (!std::isfinite(value.number)) fail(value.line, key, "is not finite", "write a finite number");
    return value.number;
  }
  const std::string text = text_with_unit(value, key, accepted_units(quantity, field_));
  return checked(parse_quantity(quantity, text, field_), key, value);
}

std::int64_t TomlTable::integer(const char* key, std::int64_t fallback) const {
  const TomlNode* value = find(key);
  if (value == nullptr) return fallback;
  if (value->kind != TomlNode::Kind::integer)
    wrong_kind(*value, key, "a whole number", "write it without quotes, point or unit");
  return value->integer;
}

Vec3 TomlTable::need_vec3(const char* key, const std::string& remedy) const {
  const TomlNode& value = need(key, remedy);
  if (value.kind != TomlNode::Kind::array) wrong_kind(value, key, "a list of three numbers", remedy);
  if (value.items.size() != 3) {
    fail(value.line, key, "has " + count_text(value.items.size(), "number") + ", must have three", remedy);
  }
  Vec3 out{};
  for (std::size_t k = 0; k < 3; ++k) {
    const TomlNode& item = value.items[k];
    if (item.kind != TomlNode::Kind::number && item.kind != TomlNode::Kind::integer) {
      fail(value.line, key, std::string("holds ") + item.kind_name() + ", must hold three numbers", remedy);
    }
    if (!std::isfinite(item.number))
      fail(value.line, key, "holds a number that is not finite", "write three finite numbers");
    out[k] = item.number;
  }
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
