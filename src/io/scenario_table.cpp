// What the sections of the scenario file share.
#include <algorithm>
#include <charconv>
#include <limits>

#include "refusal.hpp"
#include "scenario_parts.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

TomlTable section_of(const ScenarioSource& source, const char* name, const std::vector<std::string>& known) {
  static const TomlNode nothing = [] {
    TomlNode node;
    node.kind = TomlNode::Kind::table;
    return node;
  }();
  const TomlNode* node = source.root.find(name);
  return {node == nullptr ? nothing : *node, source.file, source.prefix + name, known, source.field};
}

std::vector<TomlTable> tables_of(const ScenarioSource& source, const char* name,
                                 const std::vector<std::string>& known) {
  std::vector<TomlTable> tables;
  const TomlNode* list = source.root.find(name);
  if (list == nullptr) return tables;
  if (list->kind != TomlNode::Kind::array) {
    throw Refusal(FileError{source.file, list->line, name, std::string("is ") + list->kind_name() + ", must be a list",
                            std::string("write [[") + name + "]] with two brackets"});
  }
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    tables.emplace_back(list->items[i], source.file, source.prefix + name + "[" + std::to_string(i + 1) + "]", known,
                        source.field);
  }
  return tables;
}

void refuse_unused(const TomlTable& table, const std::string& law, const std::vector<std::string>& used) {
  for (const auto& [key, value] : table.node().members) {
    if (std::find(used.begin(), used.end(), key) != used.end()) continue;
    table.fail(value.line, key, "cannot be used with law = " + in_quotes(law),
               "remove it, or choose another law; keys of this law: " + joined(used));
  }
}

double within(const TomlTable& table, const char* key, double value, double low, double high,
              const std::string& remedy) {
  if (value >= low && value <= high) return value;  // not so for NaN
  const TomlNode* given = table.find(key);
  const bool text = given != nullptr && given->kind == TomlNode::Kind::text;
  table.fail(table.line_of(key), key, "is " + (text ? in_quotes(given->text) : brief(value)) + ", out of range",
             remedy);
}

bool read_flag(const TomlTable& table, const char* key, bool fallback) {
  const TomlNode* value = table.find(key);
  if (value == nullptr) return fallback;
  if (value->kind == TomlNode::Kind::boolean) return value->boolean;
  table.fail(value->line, key, std::string("is ") + value->kind_name() + ", must be true or false",
             "write true or false, without quotes");
}

std::uint64_t read_seed(const TomlTable& table, const char* key, std::uint64_t fallback) {
  const TomlNode* value = table.find(key);
  if (value == nullptr) return fallback;
  // toml11 makes the largest integer of all that do not fit; another seed than the one written is no seed.
  const bool fits = value->integer < std::numeric_limits<std::int64_t>::max();
  if (value->kind == TomlNode::Kind::integer && value->integer >= 0 && fits) {
    return static_cast<std::uint64_t>(value->integer);
  }
  if (value->kind == TomlNode::Kind::text) {
    std::uint64_t seed = 0;
    const char* end = value->text.data() + value->text.size();
    const auto [stop, status] = std::from_chars(value->text.data(), end, seed);
    if (status == std::errc() && stop == end) return seed;
  }
  table.fail(value->line, key, "is not a seed",
             "write a whole number, 0 or more, without a unit, as in " + std::string(key) +
                 " = 1 (from 2^63 - 1 to 2^64 - 1 "
                 "in quotes)");
}

std::pair<std::string, std::string> without_remedy(const std::string& text) {
  static const std::string mark = ". Remedy: ";
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return {text, "correct the value"};
  return {text.substr(0, at), text.substr(at + mark.size())};
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
