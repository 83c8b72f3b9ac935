// What other programs found: clang-tidy's lines as SARIF, and the target's figures.
#include "plumb/render/evidence.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/tool_runner.hpp"

namespace evidence_test {
namespace {

using namespace plumb;
using render::Json;

constexpr const char* kLog =
    "[1/2] Processing file /src/a.cpp.\n"
    "/src/a.hpp:10:5: warning: use auto [modernize-use-auto]\n"
    "/src/a.cpp:3:7: error: overflow: a + b [bugprone-overflow,-warnings-as-errors]\n"
    "    3 |   a + b;\n"
    "/src/a.cpp:1:2: note: declared here\n"
    "/src/a.hpp:10:5: warning: use auto [modernize-use-auto]\n"
    "/src/a.cpp:9:1: warning: use auto [modernize-use-auto]\n"
    "3 warnings generated.\n";

Json parsed(const std::string& text) {
  const auto read = render::parse_analysis(text, "tidy.log");
  EXPECT_TRUE(read) << read.error().text();
  return read ? read->section : Json();
}

TEST(VerificationEvidence, FindingsOfClangTidyAreReadOnceEach) {
  const Json read = parsed(kLog);
  ASSERT_EQ(read["findings"], 3);
  EXPECT_EQ(read["by_check"], Json::parse(R"([{"check": "bugprone-overflow", "count": 1},
                                              {"check": "modernize-use-auto", "count": 2}])"));
  const Json& error = read["results"][1];
  EXPECT_EQ(error["file"], "/src/a.cpp");
  EXPECT_EQ(error["line"], 3);
  EXPECT_EQ(error["column"], 7);
  EXPECT_EQ(error["level"], "error");
  EXPECT_EQ(error["text"], "overflow: a + b");
  ASSERT_EQ(error["notes"].size(), 1U);
  EXPECT_EQ(error["notes"][0]["line"], 1);
  EXPECT_EQ(parsed("")["findings"], 0);
  EXPECT_EQ(parsed("12 warnings generated.\n")["findings"], 0);
}

TEST(VerificationEvidence, WhatIsNoLogOfClangTidyIsRefused) {
  const auto refused = render::parse_analysis("name = \"tool\"\n", "tool.toml");
  ASSERT_FALSE(refused);
  EXPECT_TRUE(plumb_test::says(refused.error().text(), {"tool.toml", "not the output of clang-tidy", "Remedy"}));
}

TEST(VerificationEvidence, SarifNamesEveryRuleAndPlace) {
  const Json sarif = Json::parse(render::sarif_json(parsed(kLog), "1.2.3"));
  EXPECT_EQ(sarif["version"], "2.1.0");
  ASSERT_EQ(sarif["runs"].size(), 1U);
  const Json& run = sarif["runs"][0];
  const Json& rules = run["tool"]["driver"]["rules"];
  ASSERT_EQ(run["results"].size(), 3U);
  for (const Json& result : run["results"]) {
    EXPECT_EQ(rules[result["ruleIndex"].get<std::size_t>()]["id"], result["ruleId"]);
    const Json& place = result["locations"][0]["physicalLocation"];
    EXPECT_TRUE(place["artifactLocation"]["uri"].is_string());
    EXPECT_GE(place["region"]["startLine"], 1);
  }
  EXPECT_EQ(run["results"][1]["relatedLocations"][0]["message"]["text"], "declared here");
}

TEST(VerificationEvidence, ResourcesAreReadOrRefusedWithARemedy) {
  const std::string good = R"({"schema": "plumb-resources", "version": 1, "commit": "abc", "items": [)"
                           R"({"target": "Cortex-M7", "name": "stack", "value": 4000, "limit": null, "unit": "B"}]})";
  const auto read = render::parse_resources(good, "results.json");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->section["items"][0]["value"], 4000);
  ASSERT_EQ(read->items.size(), 1U);
  EXPECT_EQ(read->items[0].value, 4000.0);
  EXPECT_FALSE(read->items[0].limit);
  for (const auto& [from, to] : {std::pair<const char*, const char*>{"plumb-resources", "other"},
                                 {"4000", "\"4000\""},
                                 {"\"unit\": \"B\"", "\"more\": 1"},
                                 {"null", "\"none\""},
                                 {"\"commit\": \"abc\"", "\"commit\": 1"}}) {
    const auto refused = render::parse_resources(plumb_test::with(good, from, to), "results.json");
    ASSERT_FALSE(refused) << to;
    EXPECT_TRUE(plumb_test::says(refused.error().text(), {"results.json", "scripts/baremetal"}));
  }
}

}  // namespace
}  // namespace evidence_test
