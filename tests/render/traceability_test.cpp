// What the tool knows of requirements and tests without a source tree, and what it says of an orphan.
#include "plumb/render/traceability.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

namespace traceability_test {
namespace {

using namespace plumb;
using render::Json;

Json built_in() {
  const auto trace = render::parse_traceability(render::built_in_traceability(), "built in");
  EXPECT_TRUE(trace) << trace.error().text();
  return *trace;
}

Json small() {
  return Json::parse(R"({"schema": "plumb-traceability", "version": 1,
    "hazards": [{"id": "HAZ-01", "title": "h"}],
    "requirements": [{"id": "REQ-001", "title": "t", "status": "active", "methods": ["test"], "statement": "It shall.", "hazards": ["HAZ-01"]}],
    "tests": [{"name": "A.Does", "kind": "test", "file": "tests/a/a_test.cpp", "line": 1, "verifies": ["REQ-001"], "negative": [], "sources": ["src/a/a.cpp"]},
              {"name": "A.Refuses", "kind": "test", "file": "tests/a/a_test.cpp", "line": 9, "verifies": [], "negative": ["REQ-001"], "sources": ["src/a/a.cpp"]}],
    "assurance": [{"about": "S1", "requirements": ["REQ-001"], "items": [{"name": "theorem_a", "tool": "Coq"}], "tests": []}]})");
}

Json section(const Json& trace) { return render::traceability_section(trace, std::nullopt, std::nullopt).section; }

std::string orphans(const Json& trace) { return section(trace)["orphans"].dump(); }

render::TestResults results(const std::string& xml) {
  const std::string path = ::testing::TempDir() + "/results.xml";
  std::ofstream(path) << xml;
  const auto read = render::read_test_results(path);
  EXPECT_TRUE(read) << read.error().text();
  return *read;
}

std::string result_of(const render::TestResults& tests, const std::optional<render::AssuranceResults>& assurance = {}) {
  return render::traceability_section(small(), tests, assurance).section["requirements"][0]["result"];
}

TEST(Traceability, TheBuiltInOneIsCompleteInBothDirections) {
  const Json out = section(built_in());
  EXPECT_EQ(out["orphans"].size(), 0U) << out["orphans"].dump();
  EXPECT_GE(out["counts"]["requirements"].get<int>(), 90);
  EXPECT_EQ(out["counts"]["traced"], out["counts"]["active"]);
  EXPECT_EQ(out["counts"]["verified"], 0);
  for (const Json& requirement : out["requirements"]) {
    bool in_a_room = false;  // not what the build itself checks: what must not compile, and proofs
    for (const Json& test : requirement["tests"])
      in_a_room = in_a_room || test["file"].get<std::string>().rfind("tests/", 0) == 0;
    EXPECT_EQ(requirement["design"].empty(), !in_a_room) << requirement["id"];
    for (const Json& test : requirement["tests"]) {
      bool back = false;
      for (const Json& other : out["tests"]) {
        if (other["name"] != test["name"]) continue;
        for (const Json& id : other["verifies"]) back = back || id == requirement["id"];
      }
      EXPECT_TRUE(back) << test["name"];
    }
  }
}

TEST(Traceability, EveryLooseEndIsAnOrphan) {
  EXPECT_EQ(orphans(small()), "[]");
  Json one = small();
  one["requirements"][0]["hazards"] = Json::array();
  EXPECT_EQ(orphans(one), R"(["REQ-001 answers no hazard","HAZ-01 is answered by no requirement"])");
  one = small();
  one["requirements"][0]["hazards"].push_back("HAZ-77");
  EXPECT_EQ(orphans(one), R"(["REQ-001 answers HAZ-77, which is unknown"])");
  one = small();
  one["tests"][0]["verifies"] = {"REQ-002"};
  EXPECT_EQ(orphans(one), R"(["REQ-001 has no test that verifies it","A.Does names REQ-002, which is unknown"])");
  one = small();
  one["tests"].erase(1);
  EXPECT_EQ(orphans(one), R"(["REQ-001 has no negative test"])");
  one = small();
  one["assurance"][0]["requirements"].push_back("REQ-003");
  EXPECT_EQ(orphans(one), R"(["docs/assurance.md names REQ-003, which is unknown"])");
  one = small();
  one["findings"] = {"a.sdoc:3: no"};
  EXPECT_EQ(orphans(one), R"(["a.sdoc:3: no"])");
}

TEST(Traceability, VerifiedMeansThatEveryTestRanAndPassed) {
  const std::string head = "<?xml version=\"1.0\"?><testsuite>", tail = "</testsuite>";
  const std::string does = "<testcase name=\"A.Does\" status=\"run\"/>",
                    refuses = "<testcase name=\"A.Refuses\" status=\"run\"/>";
  EXPECT_EQ(result_of(results(head + does + refuses + tail)), "verified");
  EXPECT_EQ(result_of(results(head + does + tail)), "open");
  EXPECT_EQ(
      result_of(results(head + does +
                        "<testcase name=\"A.Refuses\" status=\"fail\"><failure message=\"\"/></testcase>" + tail)),
      "failed");
  EXPECT_EQ(
      result_of(results(head + does + "<testcase name=\"A.Refuses\" status=\"notrun\"><skipped/></testcase>" + tail)),
      "open");
  // As GoogleTest writes them, the suite apart.
  const std::string apart =
      R"(<testsuite name="A"><testcase name="Does" classname="A" status="run"/><testcase name="Refuses" classname="A" status="run"/></testsuite>)";
  EXPECT_EQ(result_of(results(apart)), "verified");
  // With parameters: one instance that fails is enough.
  const std::string many =
      "<testcase name=\"All/A.Refuses/0\" status=\"run\"/><testcase name=\"All/A.Refuses/1\" status=\"fail\"/>";
  EXPECT_EQ(result_of(results(head + does + many + tail)), "failed");
}

TEST(Traceability, AFormalItemThatFailsFailsItsRequirement) {
  const render::TestResults passed = {{"A.Does", render::TestResult::passed},
                                      {"A.Refuses", render::TestResult::passed}};
  render::AssuranceResults assurance;
  assurance.item["theorem_a"].holds = true;
  EXPECT_EQ(result_of(passed, assurance), "verified");
  assurance.item["theorem_a"].holds = false;
  EXPECT_EQ(result_of(passed, assurance), "failed");
}

TEST(Traceability, FilesAreRefusedInWords) {
  const std::string path = ::testing::TempDir() + "/no.json";
  std::ofstream(path) << "{}";
  EXPECT_NE(render::read_assurance(path).error().text().find("schema 2"), std::string::npos);
  // Complete, of this commit, and nothing in it: no proof of anything.
  std::ofstream(path) << R"({"schema": 2, "version": "0", "complete": true, "items": []})";
  EXPECT_NE(render::read_assurance(path).error().text().find("holds no item"), std::string::npos);
  std::ofstream(path) << "{}";
  EXPECT_NE(render::read_traceability(path).error().text().find("plumb-traceability"), std::string::npos);
  EXPECT_NE(render::read_test_results(path).error().text().find("not XML"), std::string::npos);
  Json broken = small();
  broken["tests"][0].erase("verifies");
  EXPECT_NE(render::parse_traceability(broken.dump(), "x").error().text().find("lacks the list \"verifies\""),
            std::string::npos);
}

}  // namespace
}  // namespace traceability_test
