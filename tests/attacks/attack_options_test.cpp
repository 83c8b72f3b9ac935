// The command line of plumb_monitor_attacks.
#include "options.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "family.hpp"

namespace attack_options_test {
namespace {

using namespace plumb_bench;

tl::expected<Options, std::string> said(std::initializer_list<const char*> words) {
  std::vector<const char*> argv{"plumb_monitor_attacks"};
  argv.insert(argv.end(), words.begin(), words.end());
  return options_of(static_cast<int>(argv.size()), argv.data());
}

TEST(AttackOptions, WithoutAnyEveryFamilyIsPlayed) {
  const auto options = said({});
  ASSERT_TRUE(options.has_value());
  EXPECT_EQ(options->chosen.size(), families().size());
  EXPECT_FALSE(options->quick);
}

TEST(AttackOptions, AreTaken) {
  const auto options = said({"--seed", "9", "--episodes", "1000000", "--adaptive-share", "0.25", "--family", "b3",
                             "--family", "drift", "--state", "s", "--json", "j", "--before", "b", "--by-n"});
  ASSERT_TRUE(options.has_value()) << options.error();
  EXPECT_EQ(options->seed, 9U);
  EXPECT_EQ(options->episodes, 1000000U);
  EXPECT_DOUBLE_EQ(options->adaptive_share, 0.25);
  EXPECT_EQ(options->chosen.size(), families_like("b3").size() + families_like("drift").size());
  EXPECT_EQ(options->state, "s");
  EXPECT_EQ(options->json, "j");
  EXPECT_EQ(options->before, "b");
  EXPECT_TRUE(options->every_n);
}

TEST(AttackOptions, WhatIsNoneIsRefused) {
  for (const auto& words : std::vector<std::vector<const char*>>{{"--seed"},
                                                                 {"--seed", "nine"},
                                                                 {"--episodes", "0"},
                                                                 {"--episodes", "-1"},
                                                                 {"--adaptive-share", "1.5"},
                                                                 {"--family", "nobody"},
                                                                 {"--situation", "motion"},
                                                                 {"--family", "b3", "--episode", "4"},
                                                                 {"--state", "s", "--first", "5"},
                                                                 {"more"}}) {
    std::vector<const char*> argv{"plumb_monitor_attacks"};
    argv.insert(argv.end(), words.begin(), words.end());
    EXPECT_FALSE(options_of(static_cast<int>(argv.size()), argv.data()).has_value()) << words.front();
  }
}

/// docs/isolation.md and the tests name episodes by their number among those of all situations.
TEST(AttackOptions, AnEpisodeWithoutAFamilyIsNumberedAsOfOld) {
  const auto options = said({"--seed", "5", "--episode", "138685"});
  ASSERT_TRUE(options.has_value()) << options.error();
  ASSERT_EQ(options->chosen.size(), 1U);
  EXPECT_EQ(options->chosen[0], family_named("lies-motion"));
  EXPECT_EQ(options->first, 5U * (138685U / 40U));
  EXPECT_TRUE(options->one);
}

}  // namespace
}  // namespace attack_options_test
