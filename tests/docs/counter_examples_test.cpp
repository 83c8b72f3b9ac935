// docs/counter-examples.md and the table of planted defects in docs/property-testing.md, held to what exists.
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "house.hpp"

namespace docs_counter_examples_test {
namespace {

using house::kRoot;
using house::text_of;

/// "Suite.Name" of every test in the house.
std::set<std::string> tests_in_the_house() {
  const std::regex macro(R"((?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\(\s*(\w+),\s*(\w+))");
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), macro), end; it != end; ++it)
      found.insert((*it)[1].str() + "." + (*it)[2].str());
  }
  // Episodes of the attacks, which are tests without a source file.
  std::istringstream inventory(text_of(kRoot / "tests/inventory.txt"));
  for (std::string name; std::getline(inventory, name);) {
    if (name.rfind("attacks.", 0) == 0) found.insert(name);
  }
  return found;
}

TEST(CounterExamplesPage, EveryRowNamesTestsThatExist) {
  const std::set<std::string> known = tests_in_the_house();
  const std::regex test(R"(`([A-Z]\w+\.[A-Z]\w+|attacks\.[-\w.]+)`)");
  std::istringstream page(text_of(kRoot / "docs/counter-examples.md"));
  std::string line;
  int rows = 0;
  while (std::getline(page, line)) {
    if (line.rfind("| ", 0) != 0 || line.rfind("| case ", 0) == 0) continue;
    ++rows;
    std::sregex_iterator it(line.begin(), line.end(), test);
    EXPECT_NE(it, std::sregex_iterator()) << "no test: " << line;
    for (; it != std::sregex_iterator(); ++it) EXPECT_EQ(known.count((*it)[1]), 1U) << (*it)[1];
  }
  EXPECT_GE(rows, 40);
}

/// Who reads the tests finds the page, too: each of them stands in it.
TEST(CounterExamplesPage, NamesEveryTestThatIsCalledOne) {
  const std::string page = text_of(kRoot / "docs/counter-examples.md");
  int count = 0;
  for (const std::string& name : tests_in_the_house()) {
    if (name.rfind("CounterExample.", 0) != 0) continue;
    ++count;
    EXPECT_NE(page.find("`" + name + "`"), std::string::npos) << name;
  }
  EXPECT_GE(count, 9);
}

TEST(PlantedDefectsPage, ListsEveryDefectWithItsRule) {
  const std::string page = text_of(kRoot / "docs/property-testing.md");
  const std::regex said("(^|\n)rule: ([^\n]+)\n");
  std::size_t defects = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kRoot / "tests/laws/defects")) {
    if (entry.path().extension() != ".defect") continue;
    ++defects;
    const std::string text = text_of(entry.path());
    std::smatch rule;
    ASSERT_TRUE(std::regex_search(text, rule, said)) << entry.path();
    const std::string row = "| `" + entry.path().stem().string() + "` | " + rule[2].str() + " | ";
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
  std::size_t rows = 0;
  for (std::size_t at = page.find("\n| `no_"); at != std::string::npos; at = page.find("\n| `no_", at + 1)) ++rows;
  for (std::size_t at = page.find("\n| `shipped_no_"); at != std::string::npos;
       at = page.find("\n| `shipped_no_", at + 1))
    ++rows;
  EXPECT_EQ(rows, defects) << "a row without its defect";
  EXPECT_GE(defects, 19U);
}

}  // namespace
}  // namespace docs_counter_examples_test
