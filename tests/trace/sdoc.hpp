/// Reads the part of StrictDoc's text format that docs/requirements uses: one grammar per document, flat nodes whose
/// fields stand in the order of the grammar, single lines or blocks between >>> and <<<, relations to parents.
/// Whatever else stands in a file is a finding, so that StrictDoc never meets a surprise here.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace trace {

using Findings = std::vector<std::string>;

struct Node {
  std::string tag, file;
  int line = 0;
  std::map<std::string, std::string> field;
  std::vector<std::string> parents;

  std::string get(const std::string& name) const {
    const auto found = field.find(name);
    return found == field.end() ? std::string() : found->second;
  }
};

struct GrammarField {
  std::string name, type;
  bool required = false;
};
struct Grammar {
  std::string tag;
  std::vector<GrammarField> fields;
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

/// The parts of "a, b, c".
inline std::vector<std::string> listed(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    const auto first = part.find_first_not_of(' ');
    if (first != std::string::npos) out.push_back(part.substr(first, part.find_last_not_of(' ') - first + 1));
  }
  return out;
}

class SdocReader {
 public:
  SdocReader(const std::string& file, const std::string& text, Findings& findings)
      : file_(file), lines_(lines_of(text)), findings_(findings) {}

  std::vector<Node> nodes() {
    expect("[DOCUMENT]");
    if (value_of("TITLE").empty()) complain("the document has no TITLE");
    expect("");
    expect("[GRAMMAR]");
    expect("ELEMENTS:");
    grammar();
    std::vector<Node> out;
    while (at_ < lines_.size()) {
      const std::size_t before = at_;
      expect("");
      out.push_back(node());
      if (at_ == before) ++at_;  // something unreadable: on with the next line
    }
    return out;
  }

 private:
  void complain(const std::string& what) { findings_.push_back(file_ + ":" + std::to_string(at_ + 1) + ": " + what); }
  bool take(const std::string& line) {
    if (at_ >= lines_.size() || lines_[at_] != line) return false;
    ++at_;
    return true;
  }
  void expect(const std::string& line) {
    if (!take(line)) complain("expected \"" + line + "\"");
  }
  bool starts(const std::string& text) const { return at_ < lines_.size() && lines_[at_].rfind(text, 0) == 0; }
  /// The rest of a line "NAME: rest"; empty where the line is another one.
  std::string value_of(const std::string& name) {
    if (!starts(name + ": ")) return {};
    return lines_[at_++].substr(name.size() + 2);
  }

  void grammar() {
    grammar_.tag = value_of("- TAG");
    expect("  FIELDS:");
    while (starts("  - TITLE: ")) {
      GrammarField field;
      field.name = value_of("  - TITLE");
      field.type = value_of("    TYPE");
      const std::string required = value_of("    REQUIRED");
      field.required = required == "True";
      if (field.type.empty() || required.empty()) complain("a grammar field needs TYPE and REQUIRED");
      grammar_.fields.push_back(field);
    }
    if (take("  RELATIONS:")) expect("  - TYPE: Parent");
  }

  void check_choice(const GrammarField& field, const std::string& value) {
    const auto open = field.type.find('(');
    if (open == std::string::npos) return;
    const std::vector<std::string> allowed = listed(field.type.substr(open + 1, field.type.size() - open - 2));
    const std::vector<std::string> chosen = listed(value);
    if (field.type.rfind("SingleChoice", 0) == 0 && chosen.size() != 1) complain(field.name + " is one word");
    for (const std::string& word : chosen) {
      bool known = false;
      for (const std::string& other : allowed) known = known || other == word;
      if (!known) complain(field.name + " \"" + word + "\" is none of " + field.type);
    }
  }

  std::string block() {
    std::string out;
    while (at_ < lines_.size() && lines_[at_] != "<<<") out += (out.empty() ? "" : " ") + lines_[at_++];
    expect("<<<");
    return out;
  }

  Node node() {
    Node out;
    out.file = file_;
    out.line = static_cast<int>(at_) + 1;
    out.tag = grammar_.tag;
    expect("[" + grammar_.tag + "]");
    for (const GrammarField& field : grammar_.fields) {
      std::string value = value_of(field.name);
      if (value == ">>>") value = block();
      if (value.empty()) {
        if (field.required) complain("a " + out.tag + " lacks its " + field.name);
        continue;
      }
      check_choice(field, value);
      out.field[field.name] = value;
    }
    if (take("RELATIONS:")) {
      while (take("- TYPE: Parent")) {
        const std::string parent = value_of("  VALUE");
        if (parent.empty()) complain("a relation needs a VALUE");
        out.parents.push_back(parent);
      }
    }
    return out;
  }

  std::string file_;
  std::vector<std::string> lines_;
  Findings& findings_;
  Grammar grammar_;
  std::size_t at_ = 0;
};

inline std::string content_of(const std::string& path, Findings& findings) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file || text.str().empty()) findings.push_back(path + ": cannot be read, or is empty");
  return text.str();
}

}  // namespace trace
