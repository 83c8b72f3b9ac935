/// Keys and words that files of an earlier plumb have under another name (private to src/io). The one table behind the
/// refusal of an old key and behind `plumb upgrade`.
#pragma once

#include <string>
#include <string_view>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

struct RenamedKey {
  const char* section;  ///< "monitor" of [monitor], "roll" of "report": {"roll": {...}}
  const char* old_key;
  const char* new_key;  ///< "" where no key means the same: the file is changed by hand
};

struct RenamedWord {
  const char* section;
  const char* key;
  const char* old_word;
  const char* new_word;
};

/// Null where the key has no other name. `path` is that of the table: "monitor", "array.monitor", "sensor[2]".
const RenamedKey* renamed_key(std::string_view path, std::string_view key) noexcept;
const RenamedWord* renamed_word(std::string_view path, std::string_view key, std::string_view word) noexcept;

/// What a refusal says of it: what was found, and what to do.
std::string what_of(const RenamedKey& key);
std::string remedy_of(const RenamedKey& key, const std::string& file);
/// The remedy where a file holds something old that `plumb upgrade` changes.
std::string upgrade_remedy(const std::string& file);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
