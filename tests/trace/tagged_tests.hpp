/// Finds tests and the requirements that they name. A tag is a comment line directly above its test:
///   // Verifies: REQ-012, REQ-013     the test shows the behaviour
///   // Negative: REQ-012              the test breaks where the rule is taken away
/// and, once in a file, for tests that have no tag of their own:
///   // Serves: REQ-012                says which requirement they belong to; counts as neither of the two above
/// The same in CMake (# Verifies: ... above plumb_compile_check or add_test) and in a proof (; Verifies: ...).
#pragma once

#include <regex>
#include <string>
#include <vector>

#include "trace/sdoc.hpp"

namespace trace {

enum class Kind { test, law, compile, proof };

struct TaggedTest {
  std::string name, file, room;
  int line = 0;
  Kind kind = Kind::test;
  std::vector<std::string> verifies, negative, serves;
};

class TagScanner {
 public:
  TagScanner(const std::string& file, const std::string& room, Findings& findings)
      : file_(file), room_(room), findings_(findings) {}

  /// Tests of a C++ file.
  std::vector<TaggedTest> cpp(const std::string& text) {
    static const std::regex macro(R"(^(TEST|TEST_F|TEST_P|RC_GTEST_PROP|RC_GTEST_FIXTURE_PROP)\((\w+), *(\w+))");
    return scan(text, "//", macro, [](const std::smatch& m) {
      return std::make_pair(m[2].str() + "." + m[3].str(), m[1].str()[0] == 'R' ? Kind::law : Kind::test);
    });
  }
  /// Tests that CMake registers.
  std::vector<TaggedTest> cmake(const std::string& text) {
    static const std::regex call(R"(^\s*(plumb_compile_check|add_test)\((NAME )?([\w.]+))");
    return scan(text, "#", call, [](const std::smatch& m) {
      return std::make_pair(m[3].str(), m[1].str() == "add_test" ? Kind::test : Kind::compile);
    });
  }
  /// A proof file is one test.
  std::vector<TaggedTest> proof(const std::string& text, const std::string& name) {
    TaggedTest out;
    out.name = "proof." + name;
    out.file = file_;
    out.room = room_;
    out.kind = Kind::proof;
    for (const std::string& line : lines_of(text)) read_tag(line, ";", out);
    return {out};
  }

 private:
  bool read_tag(const std::string& line, const std::string& comment, TaggedTest& into) {
    static const std::regex tag(R"(^\s*(//|#|;) (Verifies|Negative|Serves): (.*)$)");
    std::smatch m;
    if (!std::regex_match(line, m, tag) || m[1].str() != comment) return false;
    std::vector<std::string>& list = m[2].str() == "Verifies"   ? into.verifies
                                     : m[2].str() == "Negative" ? into.negative
                                                                : into.serves;
    for (const std::string& id : listed(m[3].str())) list.push_back(id);
    return true;
  }

  template <class Name>
  std::vector<TaggedTest> scan(const std::string& text, const std::string& comment, const std::regex& pattern,
                               Name&& name) {
    std::vector<TaggedTest> out;
    TaggedTest pending;
    std::vector<std::string> serves;
    int number = 0;
    for (const std::string& line : lines_of(text)) {
      ++number;
      std::smatch m;
      if (std::regex_search(line, m, pattern)) {
        std::tie(pending.name, pending.kind) = name(m);
        pending.file = file_;
        pending.room = room_;
        pending.line = number;
        out.push_back(pending);
        pending = TaggedTest{};
      } else if (!read_tag(line, comment, pending)) {
        const bool is_comment = line.find(comment) == line.find_first_not_of(' ') && !line.empty();
        if (!is_comment && !(pending.verifies.empty() && pending.negative.empty())) {
          findings_.push_back(file_ + ":" + std::to_string(number) + ": a tag that stands directly above no test");
          pending = TaggedTest{};
        }
      } else if (!pending.serves.empty()) {
        serves.insert(serves.end(), pending.serves.begin(), pending.serves.end());
        pending.serves.clear();
      }
    }
    for (TaggedTest& test : out) test.serves = serves;
    return out;
  }

  std::string file_, room_;
  Findings& findings_;
};

}  // namespace trace
