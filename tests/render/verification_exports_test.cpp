// What a report gives to other programs says the same as the report.
#include "plumb/render/verification_exports.hpp"

#include <gtest/gtest.h>

#include "plumb/render/traceability.hpp"
#include "verify_support.hpp"

namespace verification_exports_test {
namespace {

using namespace plumb;
using plumb_test::Json;
using plumb_test::paper_report;

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t out = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++out;
  return out;
}

Json with_a_failure() {
  Json report = paper_report();
  report["verdict"]["criteria"][1]["result"] = "not met";
  report["verdict"]["criteria"][1]["reason"] = "5 < 6 & \"more\"";
  report["traceability"]["requirements"][0]["result"] = "failed";
  report["traceability"]["requirements"][1]["result"] = "verified";
  return report;
}

TEST(VerificationExports, JunitIsReadBackWithEveryResult) {
  const Json report = with_a_failure();
  const std::string path = ::testing::TempDir() + "/junit.xml";
  plumb_test::write_text(path, render::junit_xml(report));
  const auto read = render::read_test_results(path);
  ASSERT_TRUE(read) << read.error().text();
  const Json& requirements = report["traceability"]["requirements"];
  EXPECT_EQ(read->size(), report["verdict"]["criteria"].size() + requirements.size());
  const auto result = [&](const Json& r) {
    return read->at(r["id"].get<std::string>() + " " + r["title"].get<std::string>());
  };
  EXPECT_EQ(result(requirements[0]), render::TestResult::failed);
  EXPECT_EQ(result(requirements[1]), render::TestResult::passed);
  EXPECT_EQ(result(requirements[2]), render::TestResult::not_run);  // traced: nobody said how its tests ended
  EXPECT_EQ(read->at(report["verdict"]["criteria"][1]["name"]), render::TestResult::failed);
  EXPECT_EQ(read->at(report["verdict"]["criteria"][0]["name"]), render::TestResult::passed);
}

TEST(VerificationExports, NeedsHoldEveryNodeAndNoLinkIsLoose) {
  const Json& report = paper_report();
  const Json needs = Json::parse(render::needs_json(report));
  const Json& all = needs["versions"][needs["current_version"].get<std::string>()]["needs"];
  const Json& trace = report["traceability"];
  EXPECT_EQ(all.size(), trace["hazards"].size() + trace["requirements"].size() + trace["tests"].size());
  std::size_t links = 0;
  for (const auto& [id, need] : all.items()) {
    EXPECT_EQ(need["id"], id);
    for (const Json& link : need["links"]) EXPECT_TRUE(all.contains(link.get<std::string>())) << id << " -> " << link;
    links += need["links"].size();
  }
  EXPECT_GE(links, trace["requirements"].size()) << "each answers a hazard";
}

TEST(VerificationExports, TheRequirementsReadBackAsADocument) {
  const Json& report = paper_report();
  const std::string text = render::requirements_sdoc(report);
  EXPECT_EQ(count_of(text, "\n[REQUIREMENT]\n"), report["traceability"]["requirements"].size());
  EXPECT_EQ(count_of(text, "\n[HAZARD]\n"), report["traceability"]["hazards"].size());
  std::size_t links = 0;
  for (const Json& r : report["traceability"]["requirements"]) links += r["hazards"].size();
  EXPECT_EQ(count_of(text, "- TYPE: Parent\n  VALUE: HAZ-"), links);
}

TEST(VerificationExports, TheBillOfMaterialsNamesEveryLibraryOnce) {
  const Json& report = paper_report();
  const Json spdx = Json::parse(render::spdx_json(report));
  const Json& libraries = report["identity"]["build"]["libraries"];
  EXPECT_EQ(spdx["spdxVersion"], "SPDX-2.3");
  EXPECT_EQ(spdx["packages"].size(), libraries.size() + 1);
  EXPECT_EQ(spdx["relationships"].size(), libraries.size() + 1);
  std::set<std::string> ids;
  for (const Json& package : spdx["packages"]) EXPECT_TRUE(ids.insert(package["SPDXID"]).second);
  for (const Json& relation : spdx["relationships"]) EXPECT_EQ(ids.count(relation["relatedSpdxElement"]), 1U);
}

TEST(VerificationExports, TheArgumentTurnsRedWithItsEvidence) {
  const std::string fit = render::argument_svg(paper_report());
  EXPECT_EQ(count_of(fit, "#c53a3a"), 0U);
  EXPECT_NE(fit.find("section 5: results not</text>"), std::string::npos);
  EXPECT_EQ(count_of(fit, "#2c8f57"), 6U);  // geometry and campaign; calibration is but predicted, so the goal is open
  Json given = paper_report();
  for (Json& c : given["verdict"]["criteria"]) c["result"] = "met";
  given["verdict"]["verdict"] = "fit";
  EXPECT_EQ(count_of(render::argument_svg(given), "#2c8f57"), 16U)
      << "the goal and five branches; of the build nothing was judged";
  const auto add = [&given](const char* id, const char* result) {
    Json one = given["verdict"]["criteria"][0];
    one["id"] = id;
    one["result"] = result;
    given["verdict"]["criteria"].push_back(one);
  };
  add("proofs_hold", "not met");
  EXPECT_EQ(count_of(render::argument_svg(given), "#c53a3a"), 3U);
  add("analysis_findings", "met");
  EXPECT_EQ(count_of(render::argument_svg(given), "#2c8f57"), 16U);
  Json report = with_a_failure();
  report["verdict"]["verdict"] = "not fit";
  for (Json& c : report["verdict"]["criteria"]) {
    if (c["id"] == "requirements_traced") c["result"] = "not met";
  }
  EXPECT_EQ(count_of(render::argument_svg(report), "#c53a3a"), 7U);  // the goal, and two of six branches of three
  report["subject"]["name"] = "<b>";
  EXPECT_EQ(render::argument_svg(report).find("<b>"), std::string::npos);
}

}  // namespace
}  // namespace verification_exports_test
