// A TOML file is parsed for where its old keys stand and then changed in its text, line by line.
#include "plumb/io/upgrade.hpp"

#include <algorithm>
#include <exception>

#include "refusal.hpp"
#include "renamed_keys.hpp"
#include "text_tools.hpp"
#include "toml_tree.hpp"
#include "upgrade_json.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

bool in_name(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// Behind a string that begins at `at`, with either mark of TOML; one that the line does not end goes to its end.
std::size_t behind_string(const std::string& line, std::size_t at) noexcept {
  const char mark = line[at];
  for (++at; at < line.size() && line[at] != mark; ++at) {
    if (line[at] == '\\' && mark == '"') ++at;
  }
  return std::min(at + 1, line.size());
}

std::size_t without_blanks(const std::string& line, std::size_t at) noexcept {
  while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  return at;
}

/// Where `name` stands as a key, in quotes or not: a name with '=' behind. npos: nowhere.
std::size_t key_in(const std::string& line, const std::string& name) {
  for (std::size_t at = 0; at < line.size() && line[at] != '#';) {
    const bool quoted = line[at] == '"' || line[at] == '\'';
    if (!quoted && !in_name(line[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    if (quoted) {
      end = behind_string(line, at);
    } else {
      while (end < line.size() && in_name(line[end])) ++end;
    }
    const std::size_t begin = quoted ? at + 1 : at;
    const std::size_t next = without_blanks(line, end);
    const bool is_key = next < line.size() && line[next] == '=';
    if (is_key && end - begin == name.size() + (quoted ? 1 : 0) && line.compare(begin, name.size(), name) == 0)
      return begin;
    at = end;
  }
  return std::string::npos;
}

struct Change {
  Renaming what;
  bool of_value = false;  ///< a word behind the key, in quotes
};

struct Search {
  std::string path;
  std::vector<Change> found;

  void look_at(const std::string& section, const std::string& key, const TomlNode& value) {
    if (const RenamedKey* old = renamed_key(section, key)) {
      if (old->new_key[0] == '\0')
        throw Refusal(FileError{path, value.line, section + "." + key, what_of(*old), remedy_of(*old, path)});
      found.push_back({{value.line, section, old->old_key, old->new_key}, false});
    }
    if (value.kind != TomlNode::Kind::text) return;
    if (const RenamedWord* old = renamed_word(section, key, value.text))
      found.push_back({{value.line, section + "." + key, old->old_word, old->new_word}, true});
  }
  void walk(const TomlNode& table, const std::string& section) {  // NOLINT(misc-no-recursion) as deep as the tree
    for (const auto& [key, value] : table.members) {
      look_at(section, key, value);
      if (value.kind == TomlNode::Kind::table) walk(value, key);
      for (const TomlNode& item : value.items) {
        if (item.kind == TomlNode::Kind::table) walk(item, key);
      }
    }
  }
};

std::vector<Change> changes_of(const TomlNode& root, const std::string& path) {
  Search search{path, {}};
  search.walk(root, "");
  std::stable_sort(search.found.begin(), search.found.end(),
                   [](const Change& a, const Change& b) { return a.what.line < b.what.line; });
  return std::move(search.found);
}

/// Where a line begins, counted from 1.
std::size_t begin_of(const std::string& text, int line) noexcept {
  std::size_t at = 0;
  for (int k = 1; k < line && at != std::string::npos; ++k) {
    at = text.find('\n', at);
    if (at != std::string::npos) ++at;
  }
  return at;
}

void apply(const Change& change, const std::string& path, std::string& text) {
  const std::size_t begin = begin_of(text, change.what.line);
  if (begin != std::string::npos) {
    const std::string line = text.substr(begin, text.find('\n', begin) - begin);
    const std::size_t at =
        change.of_value ? line.find(in_quotes(change.what.old_name)) : key_in(line, change.what.old_name);
    if (at != std::string::npos) {
      text.replace(begin + at + (change.of_value ? 1 : 0), change.what.old_name.size(), change.what.new_name);
      return;
    }
  }
  throw Refusal(FileError{path, change.what.line, change.what.section, "the old name was not found in this line",
                          "write " + change.what.new_name + " for " + change.what.old_name + " by hand"});
}

/// What is written can be read and holds nothing old: a name that stands elsewhere in its line, or beside the new one,
/// is for a person to mend.
void check(const Upgraded& done, const std::string& path) {
  const FileExpected<TomlNode> again = parse_toml(done.text, path);
  if (again && changes_of(*again, path).empty()) return;
  const int line = again ? changes_of(*again, path).front().what.line : again.error().line;
  std::string names;
  for (const Renaming& one : done.renamed)
    names += (names.empty() ? "" : ", ") + one.old_name + " (line " + std::to_string(one.line) + ")";
  throw Refusal(FileError{path, line, "",
                          again ? "an old name stands in text where plumb cannot rename it safely"
                                : "holds a key under both its old name and its new name",
                          "keep one of the two, and rename by hand: " + names});
}

Upgraded upgrade_toml(const std::string& text, const std::string& path) {
  const FileExpected<TomlNode> root = parse_toml(text, path);
  if (!root) throw Refusal(root.error());
  const std::vector<const char*> marks = {"sensor", "attitude", "scenarios"};
  const bool known =
      std::any_of(marks.begin(), marks.end(), [&](const char* key) { return root->find(key) != nullptr; });
  if (!known)
    throw Refusal(FileError{path, 0, "", "is not an array, scenario or campaign file",
                            "give one with [[sensor]], [attitude] or scenarios, or a calibration file"});
  Upgraded out{text, {}};
  for (const Change& change : changes_of(*root, path)) {
    apply(change, path, out.text);
    out.renamed.push_back(change.what);
  }
  check(out, path);
  return out;
}

}  // namespace

FileExpected<Upgraded> upgrade_text(const std::string& text, const std::string& path) {
  const std::size_t begin = text.compare(0, 3, "\xEF\xBB\xBF") == 0 ? 3 : 0;
  const std::size_t first = text.find_first_not_of(" \t\r\n", begin);
  try {
    const bool json = first != std::string::npos && text[first] == '{';
    return json ? upgrade_json(text, path) : upgrade_toml(text, path);
  } catch (const Refusal& refusal) {
    return tl::unexpected<FileError>(refusal.error());
  } catch (const std::exception& error) {
    return tl::unexpected<FileError>(
        FileError{path, 0, "", error.what(), "report this as a bug of plumb", ExitCode::other});
  }
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
