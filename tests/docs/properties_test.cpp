// docs/properties.md names the test behind every property; here it is held to the tests that exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace properties_test {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

const std::filesystem::path kSource = PLUMB_SOURCE_DIR;

std::set<std::string> tests_in_the_house() {
  const std::regex macro(R"((?:TEST|TEST_F|RC_GTEST_PROP)\(\s*(\w+),\s*(\w+))");
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSource / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), macro), end; it != end; ++it) {
      names.insert((*it)[1].str() + "." + (*it)[2].str());
    }
  }
  return names;
}

TEST(Properties, EveryTestThatThePageNamesExists) {
  const std::string page = text_of(kSource / "docs/properties.md");
  const std::set<std::string> tests = tests_in_the_house();
  const std::regex name(R"(`([A-Z]\w+\.[A-Z]\w+)`)");
  int named = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), name), end; it != end; ++it) {
    ++named;
    EXPECT_EQ(tests.count((*it)[1].str()), 1U) << (*it)[1].str();
  }
  EXPECT_GT(named, 26);
}

TEST(Properties, EveryPropertyHasItsRow) {
  const std::string page = text_of(kSource / "docs/properties.md");
  for (int k = 1; k <= 26; ++k) {
    const std::string id = k <= 20 ? "S" + std::to_string(k) : "L" + std::to_string(k - 20);
    EXPECT_NE(page.find("\n| " + id + " |"), std::string::npos) << id;
  }
}

}  // namespace
}  // namespace properties_test
