// A criterion is known by its id: a title can be reworded, and no result is lost on its way to the argument.
#include "plumb/verification/criterion.hpp"

#include <gtest/gtest.h>

#include <set>

#include "facts_support.hpp"
#include "plumb/render/verdict_section.hpp"
#include "plumb/render/verification_exports.hpp"
#include "plumb/render/verification_page.hpp"
#include "render/verify_support.hpp"

namespace criterion_test {
namespace {

using namespace plumb;
using plumb_test::Json;
using plumb_test::paper_report;
using verification::CriterionEntry;
using verification::CriterionId;
using verification::Result;

constexpr const char* kRed = "#c53a3a";

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t out = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++out;
  return out;
}

/// A report in which every criterion of the table is judged and met.
Json with_every_criterion_met() {
  Json report = paper_report();
  Json list = Json::array();
  for (const CriterionEntry& row : verification::kCriterionTable)
    list.push_back({{"id", row.key},
                    {"name", row.title},
                    {"limit", "l"},
                    {"limit_from", "f"},
                    {"found", "x"},
                    {"result", "met"},
                    {"reason", ""}});
  report["verdict"]["criteria"] = list;
  report["verdict"]["verdict"] = "fit";
  return report;
}

TEST(Criterion, IsReadBackFromItsKeyAndItsResultFromItsWord) {
  for (const CriterionEntry& row : verification::kCriterionTable)
    EXPECT_EQ(verification::criterion_of(row.key), row.id) << row.key;
  EXPECT_FALSE(verification::criterion_of("Misleading output")) << "a title is no id";
  for (const Result result : {Result::met, Result::open, Result::not_met})
    EXPECT_EQ(verification::result_of(to_string(result)), result);
  EXPECT_FALSE(verification::result_of("fit"));
}

TEST(Criterion, ARewordedTitleChangesNoResult) {
  Json reworded = paper_report();
  for (Json& c : reworded["verdict"]["criteria"]) c["name"] = "something else";
  EXPECT_EQ(render::argument_svg(reworded), render::argument_svg(paper_report()));
  EXPECT_EQ(render::junit_xml(reworded), render::junit_xml(paper_report()));
  EXPECT_EQ(render::verification_html(reworded, {}), render::verification_html(paper_report(), {}));
}

TEST(Criterion, EveryOneOfThemTurnsItsBranchOfTheArgumentRed) {
  const Json good = with_every_criterion_met();
  EXPECT_EQ(count_of(render::argument_svg(good), kRed), 0U);
  for (std::size_t k = 0; k < verification::kCriterionTable.size(); ++k) {
    Json bad = good;
    bad["verdict"]["criteria"][k]["result"] = "not met";
    EXPECT_EQ(count_of(render::argument_svg(bad), kRed), 3U) << verification::kCriterionTable[k].key;
  }
}

TEST(Criterion, OneThatIsUnknownIsRefusedRatherThanPassedOver) {
  Json report = paper_report();
  report["verdict"]["criteria"][0]["id"] = "faults_isolatd";
  EXPECT_THROW(render::criteria_of(report), std::invalid_argument);
  report = paper_report();
  report["verdict"]["criteria"][0]["result"] = "nearly";
  EXPECT_THROW(render::argument_svg(report), std::invalid_argument);
}

/// Figures with which everything that can be judged is judged.
verification::Facts everything() {
  verification::Facts facts = plumb_test::calibrated_facts();
  facts.analysis_findings = 0;
  facts.target = std::vector<verification::Resource>{{"stack", 1.0, 2.0}};
  return facts;
}

TEST(Criterion, EveryIdOfTheTableIsJudgedOnceWhereItsFiguresAreGiven) {
  verification::UserLimits limits;
  limits.alert_limit_rad = 0.01;
  limits.false_alarm_rate = limits.misleading_rate = limits.wrong_exclusion_rate = limits.fault_mps2 = 0.5;
  limits.detect_within_s = 2.0;
  verification::Facts facts = everything();
  std::multiset<CriterionId> judged;
  const auto take = [&] {
    for (const verification::Criterion& c : verification::judge(limits, facts).criteria) judged.insert(c.id);
  };
  take();
  for (const auto& c : verification::judge(limits, facts).criteria)
    EXPECT_EQ(c.reason.empty(), c.result == Result::met) << entry_of(c.id).key;
  EXPECT_EQ(judged.size(), std::set<CriterionId>(judged.begin(), judged.end()).size()) << "none twice";
  facts.healthy.played = facts.faults.played = false;
  take();
  for (const CriterionEntry& row : verification::kCriterionTable)
    EXPECT_EQ(judged.count(row.id) > 0, true) << row.key << " is in the table and is never judged";
}

TEST(Criterion, ABranchIsAsGoodAsItsWorstCriterionAndOpenWithoutAny) {
  using verification::Strategy;
  std::vector<verification::Criterion> list;
  EXPECT_EQ(verification::result_of(Strategy::geometry, list), Result::open);
  list.push_back({CriterionId::faults_isolated, Result::met, "", "", "", ""});
  EXPECT_EQ(verification::result_of(Strategy::geometry, list), Result::met);
  list.push_back({CriterionId::protection_level, Result::open, "", "", "", "why"});
  EXPECT_EQ(verification::result_of(Strategy::geometry, list), Result::open);
  list.push_back({CriterionId::detectable_fault, Result::not_met, "", "", "", "why"});
  EXPECT_EQ(verification::result_of(Strategy::geometry, list), Result::not_met);
  EXPECT_EQ(verification::result_of(Strategy::campaign, list), Result::open);
}

}  // namespace
}  // namespace criterion_test
