// docs/paper.md says where every equation of the paper lives. A page about code rots; here it is held to the code:
// every equation is named in exactly one docstring, in the header that the page names, and the tests that the page
// names exist.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace equations_test {
namespace {

namespace fs = std::filesystem;

constexpr int kEquations = 29;
const fs::path kSource = PLUMB_SOURCE_DIR;

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream in(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Numbers of the equations that a text names: "eq (5)", "eqs (18)-(21)", "eqs 7, 10-12", "eqs (1) and (2)".
std::set<int> equations_in(const std::string& text) {
  static const std::regex kMention(R"(\b[Ee]qs?\.? (\(?\d+\)?(?:(?:-|, | and )\(?\d+\)?)*))");
  static const std::regex kPart(R"((-|, | and )?\(?(\d+)\)?)");
  std::set<int> found;
  for (auto m = std::sregex_iterator(text.begin(), text.end(), kMention); m != std::sregex_iterator(); ++m) {
    const std::string list = (*m)[1];
    int last = 0;
    for (auto p = std::sregex_iterator(list.begin(), list.end(), kPart); p != std::sregex_iterator(); ++p) {
      const int number = std::stoi((*p)[2]);
      for (int k = (*p)[1] == "-" ? last : number; k <= number; ++k) found.insert(k);
      last = number;
    }
  }
  return found;
}

/// Docstrings of a header: a run of lines that begin with ///, or one trailing ///<.
std::vector<std::string> docstrings_of(const fs::path& header) {
  std::vector<std::string> blocks;
  bool inside = false;
  for (const std::string& line : lines_of(header)) {
    const std::size_t begin = line.find("///");
    const bool alone = begin != std::string::npos && line.find_first_not_of(' ') == begin;
    if (begin == std::string::npos) {
      inside = false;
    } else if (alone && inside) {
      blocks.back() += " " + line.substr(begin + 3);
    } else {
      blocks.push_back(line.substr(begin + 3));
      inside = alone;
    }
  }
  return blocks;
}

/// Equation -> the headers whose docstrings name it, once per docstring.
std::map<int, std::vector<std::string>> homes() {
  std::map<int, std::vector<std::string>> out;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSource / "include")) {
    if (entry.path().extension() != ".hpp") continue;
    const std::string name = fs::relative(entry.path(), kSource / "include/plumb").generic_string();
    for (const std::string& block : docstrings_of(entry.path())) {
      for (const int equation : equations_in(block)) out[equation].push_back(name);
    }
  }
  return out;
}

struct Row {
  std::set<int> equations;
  std::string text;
  std::vector<std::string> quoted;  ///< what stands in backquotes
};

/// Rows of the table of docs/paper.md: those whose first cell names equations.
std::vector<Row> rows() {
  static const std::regex kQuoted("`([^`]+)`");
  std::vector<Row> out;
  for (const std::string& line : lines_of(kSource / "docs/paper.md")) {
    if (line.rfind("| (", 0) != 0) continue;
    Row row;
    row.text = line;
    row.equations = equations_in("eqs " + line.substr(2, line.find('|', 1) - 3));
    for (auto m = std::sregex_iterator(line.begin(), line.end(), kQuoted); m != std::sregex_iterator(); ++m) {
      row.quoted.push_back((*m)[1]);
    }
    out.push_back(row);
  }
  return out;
}

/// "Suite.Name" of every test in the tree.
std::set<std::string> tests() {
  static const std::regex kTest(R"((?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\(\s*(\w+),\s*(\w+))");
  std::set<std::string> out;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSource / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path());
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    for (auto m = std::sregex_iterator(text.begin(), text.end(), kTest); m != std::sregex_iterator(); ++m) {
      out.insert((*m)[1].str() + "." + (*m)[2].str());
    }
  }
  return out;
}

TEST(Equations, ReaderUnderstandsEveryWayOfNamingThem) {
  EXPECT_EQ(equations_in("by eqs (7), (10)-(12)."), (std::set<int>{7, 10, 11, 12}));
  EXPECT_EQ(equations_in("Eq (9) and eqs 13, 14, 22-24"), (std::set<int>{9, 13, 14, 22, 23, 24}));
  EXPECT_EQ(equations_in("eqs (1) and (2), in 3 parts"), (std::set<int>{1, 2}));
  EXPECT_EQ(equations_in("the paper eq 4), H is n x 3"), (std::set<int>{4}));
  EXPECT_TRUE(equations_in("a sequence of 5, freq 3").empty());
}

TEST(Equations, EachIsNamedInExactlyOneDocstring) {
  const std::map<int, std::vector<std::string>> found = homes();
  for (int equation = 1; equation <= kEquations; ++equation) {
    const auto at = found.find(equation);
    ASSERT_NE(at, found.end()) << "no docstring names eq (" << equation << ")";
    std::string where;
    for (const std::string& header : at->second) where += " " + header;
    EXPECT_EQ(at->second.size(), 1U) << "eq (" << equation << ") is named in" << where;
  }
}

TEST(Equations, ThePageNamesTheHeaderOfEach) {
  const std::map<int, std::vector<std::string>> found = homes();
  std::map<int, int> told;
  for (const Row& row : rows()) {
    for (const int equation : row.equations) {
      ++told[equation];
      const auto at = found.find(equation);
      ASSERT_NE(at, found.end()) << row.text;
      const bool named = std::find(row.quoted.begin(), row.quoted.end(), at->second.front()) != row.quoted.end();
      EXPECT_TRUE(named) << "docs/paper.md does not name " << at->second.front() << " for eq (" << equation << ")";
    }
  }
  for (int equation = 1; equation <= kEquations; ++equation) {
    EXPECT_EQ(told[equation], 1) << "rows of docs/paper.md for eq (" << equation << ")";
  }
}

TEST(Equations, EveryRowNamesATestAndEveryTestOnThePageExists) {
  static const std::regex kTestName(R"([A-Z]\w+\.[A-Z]\w+)");
  static const std::regex kQuotedTest("`([A-Z]\\w+\\.[A-Z]\\w+)`");
  for (const Row& row : rows()) {
    const auto is_test = [](const std::string& word) { return std::regex_match(word, kTestName); };
    EXPECT_TRUE(std::any_of(row.quoted.begin(), row.quoted.end(), is_test)) << "no test is named for: " << row.text;
  }
  const std::set<std::string> known = tests();
  int named = 0;
  for (const std::string& line : lines_of(kSource / "docs/paper.md")) {
    for (auto m = std::sregex_iterator(line.begin(), line.end(), kQuotedTest); m != std::sregex_iterator(); ++m) {
      ++named;
      EXPECT_TRUE(known.count((*m)[1]) == 1) << (*m)[1] << " is no test of this tree";
    }
  }
  EXPECT_GT(named, 25);
}

}  // namespace
}  // namespace equations_test
