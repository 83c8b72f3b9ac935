/// One table of the array file, read key by key; every refusal names file, line and field (private to
/// src/io). The functions throw Refusal; `parse_array_text` catches it at the boundary.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/core/vec3.hpp"
#include "plumb/io/units.hpp"
#include "toml_tree.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

class TomlTable {
 public:
  /// `known` are the keys that the table may hold; others are refused with the nearest of them. Accelerations are
  /// read in the units of `field`.
  TomlTable(const TomlNode& node, std::string file, std::string path, const std::vector<std::string>& known,
            FieldKind field = FieldKind::gravity);

  bool has(const char* key) const noexcept { return find(key) != nullptr; }
  const TomlNode* find(const char* key) const noexcept { return node_->find(key); }
  const TomlNode& need(const char* key, const std::string& remedy) const;

  std::string text(const char* key, const std::string& fallback) const;
  std::string need_text(const char* key, const std::string& remedy) const;
  /// One of `choices`; its index.
  int choice(const char* key, const std::vector<std::string>& choices, int fallback) const;
  int need_choice(const char* key, const std::vector<std::string>& choices, const std::string& remedy) const;
  double quantity(Quantity quantity, const char* key, double fallback) const;
  double need_quantity(Quantity quantity, const char* key, const std::string& remedy) const;
  std::int64_t integer(const char* key, std::int64_t fallback) const;
  Vec3 need_vec3(const char* key, const std::string& remedy) const;

  /// The value of a key as text, for values with a unit; a number is refused ("the unit is missing").
  std::string text_with_unit(const TomlNode& value, const char* key, const std::string& units) const;
  /// Adds file, line and field to a refusal of `parse_*`.
  template <class T>
  T checked(FileExpected<T> parsed, const char* key, const TomlNode& value) const {
    if (!parsed) fail(value.line, key, parsed.error().what, parsed.error().remedy);
    return *std::move(parsed);
  }

  [[noreturn]] void fail(int line, const std::string& key, const std::string& what, const std::string& remedy) const;
  std::string field(const std::string& key) const;
  int line() const noexcept { return node_->line; }
  int line_of(const char* key) const noexcept;
  const TomlNode& node() const noexcept { return *node_; }
  const std::string& file() const noexcept { return file_; }
  FieldKind field_of() const noexcept { return field_; }

 private:
  [[noreturn]] void wrong_kind(const TomlNode& value, const char* key, const char* wanted,
                               const std::string& remedy) const;

  const TomlNode* node_;
  std::string file_;
  std::string path_;
  FieldKind field_;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
