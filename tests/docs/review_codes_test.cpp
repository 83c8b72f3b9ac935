// docs/review.md has a row for every code of a review: a finding that the page does not explain is one that nobody can
// look up.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "../../src/render/review_words.hpp"

namespace review_codes_test {
namespace {

using plumb::render::code_word;
using plumb::review::FindingCode;
using plumb::review::OpenQuestion;

/// The codes in backquotes in the first column of every table below a heading.
std::set<std::string> rows_below(const std::string& heading) {
  std::ifstream in(std::string(PLUMB_SOURCE_DIR) + "/docs/review.md");
  std::set<std::string> out;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind('#', 0) == 0) inside = line == heading;
    if (!inside || line.rfind("| `", 0) != 0) continue;
    std::istringstream cell(line.substr(2, line.find('|', 2) - 2));
    for (std::string part; std::getline(cell, part, '`') && std::getline(cell, part, '`');) out.insert(part);
  }
  return out;
}

TEST(ReviewCodes, EveryFindingHasARowWithItsLimitAndNoRowIsOfNone) {
  std::set<std::string> codes;
  for (int k = 0; k <= static_cast<int>(FindingCode::damage); ++k) codes.insert(code_word(static_cast<FindingCode>(k)));
  EXPECT_EQ(codes.size(), static_cast<std::size_t>(FindingCode::damage) + 1) << "two codes of one name";
  EXPECT_EQ(rows_below("## Limits"), codes);
}

TEST(ReviewCodes, EveryOpenQuestionHasARow) {
  std::set<std::string> codes;
  for (int k = 0; k <= static_cast<int>(OpenQuestion::more_calibration); ++k)
    codes.insert(code_word(static_cast<OpenQuestion>(k)));
  EXPECT_EQ(codes.size(), static_cast<std::size_t>(OpenQuestion::more_calibration) + 1) << "two codes of one name";
  EXPECT_EQ(rows_below("## What is left open"), codes);
}

}  // namespace
}  // namespace review_codes_test
