// JSON is valid before it is changed: then its keys are the strings with a colon behind, and the text is walked through
// once with the keys of the objects around.
#include "upgrade_json.hpp"

#include <algorithm>
#include <vector>

#include "calibration_json.hpp"
#include "calibration_source.hpp"
#include "renamed_keys.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// Deeper nesting than any of the files has.
constexpr int kDeepest = 64;

Json parsed(const std::string& text, const std::string& path) {
  const auto shallow = [&path](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) throw Refusal(FileError{path, 0, "", "brackets are nested too deeply", kMakeAnew});
    return true;
  };
  try {
    return Json::parse(text, shallow);
  } catch (const Json::exception& error) {
    throw Refusal(FileError{path, 0, "", std::string("is not valid JSON: ") + error.what(), kMakeAnew});
  }
}

/// Behind the string that begins at `at`.
std::size_t behind_string(const std::string& text, std::size_t at) noexcept {
  for (++at; at < text.size() && text[at] != '"'; ++at) {
    if (text[at] == '\\') ++at;
  }
  return std::min(at + 1, text.size());
}

/// One walk through valid JSON.
class Walk {
 public:
  Walk(const std::string& text, const std::string& path) : text_(text), path_(path) {}

  Upgraded result() && {
    for (std::size_t at = 0; at < text_.size();) {
      const char c = text_[at];
      if (c == '"') {
        at = take_string(at);
        continue;
      }
      if (c == '\n') ++line_;
      if (c == '{' || c == '[') sections_.push_back(key_);
      if ((c == '}' || c == ']') && !sections_.empty()) {
        key_ = sections_.back();
        sections_.pop_back();
      }
      out_.text += c;
      ++at;
    }
    return std::move(out_);
  }

 private:
  std::string section() const { return sections_.empty() ? std::string() : sections_.back(); }

  std::size_t take_string(std::size_t at) {
    const std::size_t end = behind_string(text_, at);
    std::string word = text_.substr(at + 1, end - at - 2);
    const std::size_t next = text_.find_first_not_of(" \t\r\n", end);
    if (next != std::string::npos && text_[next] == ':') {
      key_ = word;
      if (const RenamedKey* old = renamed_key(section(), word)) {
        if (old->new_key[0] == '\0')
          throw Refusal(FileError{path_, line_, section() + "." + word, what_of(*old), remedy_of(*old, path_)});
        rename(section(), word, old->new_key);
      }
    } else if (const RenamedWord* old = renamed_word(section(), key_, word)) {
      rename(section() + "." + key_, word, old->new_word);
    }
    out_.text += '"' + word + '"';
    return end;
  }
  void rename(const std::string& where, std::string& word, const char* now) {
    out_.renamed.push_back({line_, where, word, now});
    word = now;
  }

  const std::string& text_;
  const std::string& path_;
  std::vector<std::string> sections_;  ///< the keys of the objects and lists around
  std::string key_;                    ///< the last one
  int line_ = 1;
  Upgraded out_;
};

/// Of all objects in it: fewer where a key stands twice, of which the parser keeps one.
std::size_t members_of(const Json& root) {
  const Json flat = root.flatten();
  return flat.size();
}

/// The check sum of a calibration file as it stands; throws Refusal where that is not the one of its content.
std::string sound_checksum(const Json& root, const std::string& path) {
  const Source source{path, ""};
  const std::string stated = source.text_of(root, "checksum");
  if (stated == checksum_of(root)) return stated;
  source.fail(0, "checksum",
              "is " + stated + ", but the content gives " + checksum_of(root) + ": the file was edited or damaged",
              kMakeAnew);
}

}  // namespace

Upgraded upgrade_json(const std::string& text, const std::string& path) {
  const Json root = parsed(text, path);
  const bool calibration = root.contains("schema") && root["schema"] == kCalibrationSchema;
  if (!calibration && !root.contains("sensor") && !root.contains("attitude") && !root.contains("scenarios"))
    throw Refusal(FileError{path, 0, "", "is not a calibration, array, scenario or campaign file",
                            "give one that plumb calibrate wrote, or one with sensor, attitude or scenarios"});
  const std::string stated = calibration ? sound_checksum(root, path) : "";
  Upgraded out = Walk(text, path).result();
  if (members_of(parsed(out.text, path)) != members_of(root))
    throw Refusal(FileError{path, out.renamed.front().line, out.renamed.front().section,
                            "holds a key under both its old name and its new name", "keep one of the two"});
  if (!calibration || out.renamed.empty()) return out;
  const std::size_t at = out.text.find('"' + stated + '"');
  out.text.replace(at + 1, stated.size(), checksum_of(parsed(out.text, path)));
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
