// docs/assurance.md ties requirements to evidence of every kind; here each name in it is held to what exists.
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "house.hpp"

namespace assurance_test {
namespace {

using house::kRoot;
using house::text_of;

/// First group of every match, "a.b" where there are two.
std::set<std::string> names(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it)
    found.insert(it->size() > 2 ? (*it)[1].str() + "." + (*it)[2].str() : (*it)[1].str());
  return found;
}

std::string all_below(const char* folder, const char* extension) {
  std::string text;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot / folder)) {
    if (entry.path().extension() == extension) text += text_of(entry.path());
  }
  return text;
}

void expect_known(const std::set<std::string>& named, const std::set<std::string>& known, std::size_t at_least) {
  EXPECT_GE(named.size(), at_least);
  for (const std::string& name : named) EXPECT_EQ(known.count(name), 1U) << name;
}

std::string table() { return text_of(kRoot / "docs/assurance.md"); }

TEST(Assurance, EveryRequirementNamedExists) {
  expect_known(names(table(), "(REQ-[0-9]{3})"), names(all_below("docs/requirements", ".sdoc"), "UID: (REQ-[0-9]{3})"),
               30);
}

TEST(Assurance, EveryTestNamedExists) {
  expect_known(names(table(), "`([A-Z][A-Za-z0-9]+)\\.([A-Z][A-Za-z0-9]+)`"),
               names(all_below("tests", ".cpp"), "(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\\(\\s*(\\w+),\\s*(\\w+)"), 20);
}

TEST(Assurance, EveryTheoremNamedIsProved) {
  expect_known(names(table(), "`([A-Za-z0-9]+_[A-Za-z0-9_]+)` \\(Coq\\)"),
               names(all_below("proofs", ".v"), "Theorem\\s+([A-Za-z0-9_]+)"), 15);
}

TEST(Assurance, EveryItemOfTheModelIsRun) {
  expect_known(names(table(), "`([a-z0-9_]+)` \\(spin\\)"), names(text_of(kRoot / "model/check.sh"), "\"item (\\w+) "),
               8);
}

TEST(Assurance, EveryItemOfTheDepthOfTestIsRun) {
  expect_known(names(table(), "`([a-z_]+)` \\(assure\\)"),
               names(text_of(kRoot / "scripts/assure"), "item tested \\w+ (\\w+) "), 5);
}

TEST(Assurance, EveryPropertyHasItsRow) {
  const std::string page = table();
  for (int k = 1; k <= 26; ++k) {
    const std::string id = k <= 20 ? "S" + std::to_string(k) : "L" + std::to_string(k - 20);
    EXPECT_NE(page.find("\n| " + id + " |"), std::string::npos) << id;
  }
}

}  // namespace
}  // namespace assurance_test
