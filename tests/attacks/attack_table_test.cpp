// The table, its JSON, and which promises it holds.
#include "table.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "plumb/io/output_file.hpp"

namespace attack_table_test {
namespace {

using namespace plumb_bench;

std::size_t at(int k) { return static_cast<std::size_t>(k); }

int first_with(Standing safety) {
  for (int k = 0; k < static_cast<int>(families().size()); ++k) {
    if (families()[at(k)].safety == safety) return k;
  }
  return -1;
}

/// A hundred episodes in one cell, with so many of one count.
Progress with(int family, int n, Count what, std::uint64_t many) {
  Progress out(1);
  Tally& t = out.tally[at(family)][at(n - kLeastSensors)];
  t[Count::episodes] = 100;
  t[Count::blocks] = 1000;
  t[Count::valid_blocks] = 250;
  t.to_nominal[6] = 100;
  t[what] = many;
  return out;
}

std::string line_with(const std::string& text, const std::string& word) {
  const std::size_t at_word = text.find("| " + word + " |");
  if (at_word == std::string::npos) return "";
  return text.substr(at_word, text.find('\n', at_word) - at_word);
}

TEST(AttackTable, EachSafetyColumnOfAPromisedFamilyBreaksThePromise) {
  for (const Count c : kSafety) {
    const std::string broken = broken_promises(with(first_with(Standing::promised), 4, c, 1));
    EXPECT_NE(broken.find(to_string(c)), std::string::npos) << broken;
  }
  for (const Count c : {Count::unpromised, Count::false_doubt, Count::failed}) {
    EXPECT_EQ(broken_promises(with(first_with(Standing::promised), 4, c, 9)), "") << to_string(c);
  }
}

TEST(AttackTable, WhatIsOutsideTheBoundsIsCountedAndNotHeld) {
  const int outside = first_with(Standing::outside);
  ASSERT_GE(outside, 0);
  const Progress progress = with(outside, 5, Count::wrong_exclusion, 3);
  EXPECT_EQ(broken_promises(progress), "");
  const std::string line = line_with(table_text(progress, false), families()[at(outside)].name);
  EXPECT_NE(line.find("outside"), std::string::npos) << line;
  EXPECT_NE(line.find("| 3 ([0.0062, 0.086]) |"), std::string::npos) << line;
}

TEST(AttackTable, ARowHoldsCountsWithTheirBoundsAndShares) {
  const int family = family_named("lies-motion");
  const std::string line = line_with(table_text(with(family, 5, Count::failed, 50), false), "lies-motion");
  EXPECT_NE(line.find("| 4-8 | promised | 100 | 0 (< 0.037) |"), std::string::npos) << line;
  EXPECT_NE(line.find(" 25.0 % |"), std::string::npos) << line;
  EXPECT_NE(line.find("| 6 | 50 % [39.8, 60.2] |"), std::string::npos) << line;
}

TEST(AttackTable, EveryRowHasAsManyCellsAsTheHead) {
  Progress progress = with(family_named("lies-motion"), 5, Count::failed, 50);
  progress.tally[at(family_named("drift"))] = progress.tally[at(family_named("lies-motion"))];
  progress.tally[at(family_named("adaptive-error"))] = progress.tally[at(family_named("lies-motion"))];
  const std::string text = table_text(progress, true);
  std::size_t cells = 0, lines = 0;
  for (std::size_t from = 0; from < text.size(); ++lines) {
    const std::size_t end = text.find('\n', from);
    const auto bars = static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(from),
                                                          text.begin() + static_cast<std::ptrdiff_t>(end), '|'));
    if (lines == 0) cells = bars;
    EXPECT_EQ(bars, cells) << text.substr(from, end - from);
    from = end + 1;
  }
  EXPECT_EQ(lines, 7U) << "head, rule, three rows and two sums";
}

TEST(AttackTable, SizesHaveRowsWhereTheyMatterOrAreAskedFor) {
  Progress progress(1);
  for (const char* name : {"lies-motion", "drift"}) {
    for (Tally& t : progress.tally[at(family_named(name))]) t[Count::episodes] = 10;
  }
  const auto rows = [](const std::string& text, const std::string& name) {
    int out = 0;
    for (std::size_t k = text.find("| " + name); k != std::string::npos; k = text.find("| " + name, k + 1)) ++out;
    return out;
  };
  EXPECT_EQ(rows(table_text(progress, false), "lies-motion"), 1);
  EXPECT_EQ(rows(table_text(progress, false), "drift"), 5);
  EXPECT_EQ(rows(table_text(progress, true), "lies-motion"), 5);
  EXPECT_EQ(rows(table_text(progress, false), "mirror"), 0) << "not played";
}

TEST(AttackTable, JsonHoldsTheSameFigures) {
  const Progress progress = with(family_named("drift"), 6, Count::wrong_exclusion, 35);
  const auto json = nlohmann::json::parse(table_json(progress));
  ASSERT_EQ(json["rows"].size(), 1U);
  const auto& row = json["rows"][0];
  EXPECT_EQ(row["family"], "drift");
  EXPECT_EQ(row["n"], "6");
  EXPECT_EQ(row["episodes"], 100);
  EXPECT_EQ(row["wrong_exclusion"]["count"], 35);
  EXPECT_NEAR(row["wrong_exclusion"]["low"].get<double>(), 0.2573, 1e-4);
  EXPECT_EQ(row["valid_blocks"], 250);
  EXPECT_EQ(row["blocks_to_nominal"], 6);
  EXPECT_EQ(json["cells"].size(), 1U);
}

TEST(AttackTable, ComparesWithTheTableOfAnotherBuild) {
  const std::string path = testing::TempDir() + "plumb_attacks_before_" + std::to_string(getpid());
  const int family = family_named("v4-clock");
  ASSERT_TRUE(plumb::io::write_file(path, table_json(with(family, 4, Count::stale, 100))).has_value());
  const auto text = comparison_text(path, with(family, 4, Count::stale, 0));
  ASSERT_TRUE(text.has_value()) << text.error().text();
  EXPECT_NE(line_with(*text, "v4-clock").find("| 100 (100 %) -> 0 |"), std::string::npos) << *text;
  ASSERT_TRUE(plumb::io::write_file(path, "[]").has_value());
  EXPECT_FALSE(comparison_text(path, with(family, 4, Count::stale, 0)).has_value());
  unlink(path.c_str());
  EXPECT_FALSE(comparison_text(path, with(family, 4, Count::stale, 0)).has_value()) << "gone";
}

}  // namespace
}  // namespace attack_table_test
