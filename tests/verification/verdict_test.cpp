// Limits as users write them, and the verdict that follows from them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "facts_support.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/render/identity.hpp"
#include "render/verify_support.hpp"

namespace verdict_test {
namespace {

using namespace plumb;
using plumb_test::calibrated_facts;
using plumb_test::Json;
using plumb_test::paper_report;
using verification::CriterionId;
using verification::Result;

io::ArrayFile paper_array() { return *io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml"); }

verification::UserLimits limits(const std::string& keys) {
  const auto read = verification::parse_limits("[limits]\n" + keys, "limits.toml", paper_array());
  EXPECT_TRUE(read) << read.error().text();
  return *read;
}

std::string refusal(const std::string& text) {
  const auto read = verification::parse_limits(text, "limits.toml", paper_array());
  return read ? "accepted" : read.error().text();
}

std::optional<Result> result_of(const verification::Report& report, CriterionId id) {
  for (const verification::Criterion& one : report.criteria) {
    if (one.id == id) return one.result;
  }
  return std::nullopt;
}

/// The criterion as a report has it.
Json written(const Json& report, CriterionId id) {
  for (const Json& one : report["verdict"]["criteria"]) {
    if (one["id"] == entry_of(id).key) return one;
  }
  return {};
}

TEST(VerificationLimits, AreReadWithTheirUnits) {
  const verification::UserLimits read = limits(
      "alert_limit = \"0.25 deg\"\nfaults = 2\nfalse_alarm_rate = 1e-3\nmisleading_rate = \"0.1 %\"\n"
      "wrong_exclusion_rate = 2e-3\nfault = \"5 mg0\"\ndetect_within = \"2 s\"\n");
  EXPECT_NEAR(deg_from_rad(read.alert_limit_rad), 0.25, 1e-12);
  EXPECT_EQ(read.faults, 2);
  EXPECT_EQ(read.false_alarm_rate, 1e-3);
  EXPECT_NEAR(*read.misleading_rate, 1e-3, 1e-15);
  EXPECT_EQ(read.wrong_exclusion_rate, 2e-3);
  EXPECT_NEAR(*read.fault_mps2, 5e-3 * kG0_mps2, 1e-12);
  EXPECT_EQ(read.detect_within_s, 2.0);
  EXPECT_EQ(limits("").faults, 1);
  EXPECT_FALSE(limits("").false_alarm_rate);
}

/// Six sensors in two chips: what counts chips says so, and an array without chips is told as before.
// Verifies: REQ-206
TEST(VerificationWords, CountUnitsWhereTheArrayHasChips) {
  verification::Facts facts = calibrated_facts();
  facts.array.sensors.assign(6, {0.02, 0.1});
  const auto told = [&facts](int units) {
    facts.array.units = units;
    const verification::Report report = verification::judge(limits("faults = 2"), facts);
    std::string out;
    for (const auto& one : report.criteria) out += one.reason + "\n";
    for (const auto& one : report.assumptions) out += one + "\n";
    for (const auto& one : report.answers) out += one.label + "\n";
    return out;
  };
  const std::string chips = told(2), single = told(6);
  EXPECT_TRUE(plumb_test::says(
      chips,
      {"isolates 1 faulty unit (chips, and sensors on none) with confirmation",
       "At most 2 units (chips, and sensors on none) are faulty at once", "one axis of a chip being a sensor here",
       "more than 1 of 2 units (chips, and sensors on none) is faulty", "several units that all show"}));
  EXPECT_EQ(single, told(0));
  EXPECT_EQ(single.find("unit"), std::string::npos) << single;
  EXPECT_EQ(single.find("chip"), std::string::npos) << single;
  EXPECT_TRUE(plumb_test::says(single, {"isolates 1 faulty sensor with confirmation", "At most 2 sensors are faulty",
                                        "several sensors that all show"}));
}

TEST(VerificationLimits, AreRefusedWithLineAndRemedy) {
  EXPECT_TRUE(
      plumb_test::says(refusal("[limits]\nalert_limt = \"1 deg\"\n"), {"limits.toml:2", "alert_limt", "alert_limit"}));
  EXPECT_TRUE(plumb_test::says(refusal("[limits]\n\nalert_limit = 1\n"), {"limits.toml:3", "unit is missing", "deg"}));
  EXPECT_TRUE(plumb_test::says(refusal("[limits]\nfaults = 0\n"), {"limits.toml:2", "out of range", "1 to 8"}));
  EXPECT_TRUE(plumb_test::says(refusal("[limits]\nfalse_alarm_rate = 0\n"), {"out of range"}));
  EXPECT_TRUE(plumb_test::says(refusal("alert_limit = \"1 deg\"\n"), {"alert_limit", "limits"}));
  EXPECT_TRUE(plumb_test::says(refusal("name = 1"), {"limits.toml"}));
}

TEST(VerificationVerdict, EveryLimitIsMetMissedOrOpen) {
  const auto with = [](const std::string& keys) { return verification::judge(limits(keys), calibrated_facts()); };
  EXPECT_EQ(with("").fit, Result::met);
  const verification::Report turned = with("alert_limit = \"0.39 deg\"");
  EXPECT_EQ(result_of(turned, CriterionId::protection_level), Result::open) << "0.3 deg, and 0.1 deg of alignment";
  EXPECT_TRUE(plumb_test::says(turned.sentence, {"in the housing", "0.4 deg", "0.39 deg", "state it"}));
  const verification::Report tight = with("alert_limit = \"0.29 deg\"");
  EXPECT_EQ(result_of(tight, CriterionId::protection_level), Result::not_met);
  EXPECT_EQ(tight.fit, Result::not_met);
  EXPECT_TRUE(plumb_test::says(tight.sentence, {"not fit", "0.4 deg", "alert limit"}));
  EXPECT_EQ(result_of(with("alert_limit = \"0.41 deg\""), CriterionId::protection_level), Result::met);
  EXPECT_EQ(with("faults = 2").fit, Result::not_met);
  EXPECT_TRUE(
      plumb_test::says(with("faults = 2").sentence, {"isolates 1 faulty sensor with confirmation, 2 are required"}));
  EXPECT_EQ(result_of(with("fault = \"2.0 mg0\""), CriterionId::detectable_fault), Result::not_met);
  EXPECT_EQ(result_of(with("fault = \"2.1 mg0\""), CriterionId::detectable_fault), Result::met);
  EXPECT_EQ(result_of(with("detect_within = \"0.9 s\""), CriterionId::time_to_detect), Result::not_met);
  EXPECT_EQ(result_of(with("detect_within = \"1 s\""), CriterionId::time_to_detect), Result::met);
}

// Negative: REQ-183
TEST(VerificationVerdict, WithoutAKnownAttitudeNothingIsFit) {
  verification::Facts facts = calibrated_facts();
  facts.wiring = {};  // what a caller gets that says nothing of it
  const verification::Report open = verification::judge(limits(""), facts);
  EXPECT_EQ(open.fit, Result::open);
  EXPECT_EQ(result_of(open, CriterionId::wiring_confirmed), Result::open);
  EXPECT_TRUE(plumb_test::says(open.sentence, {"INCONCLUSIVE"}));
  EXPECT_EQ(verification::result_of(verification::Strategy::calibration, open.criteria), Result::open);
  EXPECT_TRUE(plumb_test::says(open.answers.back().label, {"no known attitude confirms the wiring"}));
  facts.wiring = {verification::WiringFacts::State::contradicted, "contradicted", "station 3 stands otherwise"};
  const verification::Report refuted = verification::judge(limits(""), facts);
  EXPECT_EQ(refuted.fit, Result::not_met);
  EXPECT_TRUE(plumb_test::says(refuted.sentence, {"not fit", "station 3 stands otherwise"}));
}

/// What no test can find broken stands first among the assumptions.
TEST(VerificationVerdict, AStandstillOrTheAccelerationAllowedForIsSaidFirst) {
  verification::UserLimits given = limits("");
  const auto first = [&given] { return verification::judge(given, calibrated_facts()).assumptions[0]; };
  EXPECT_TRUE(plumb_test::says(first(), {"A standstill is assumed", "acceleration_bound"}));
  io::ArrayFile array = paper_array();
  array.monitor.acceleration_bound_mps2 = 5e-3 * kG0_mps2;
  given = verification::limits_of(array);
  EXPECT_TRUE(plumb_test::says(first(), {"at most 5 mg0", "0.286", "of every protection level"})) << first();
  array.monitor.acceleration_bound_mps2 = 0.03 * kG0_mps2;
  given = verification::limits_of(array);
  EXPECT_TRUE(plumb_test::says(first(), {"at most 30 mg0", "the alert never ends"})) << first();
}

// Verifies: REQ-123
TEST(VerificationVerdict, TheDriftThatIsAllowedForIsSaidBesideIt) {
  verification::UserLimits given = limits("");
  given.drift = "none is allowed for: no stability is stated";
  EXPECT_TRUE(plumb_test::says(
      verification::judge(given, calibrated_facts()).assumptions[1],
      {"Drift since the calibration: none is allowed for", "no stability is stated", "can be excluded", "stability"}));
}

// Negative: REQ-181
TEST(VerificationVerdict, ARateIsShownRefutedOrOpenByItsInterval) {
  verification::Facts facts = calibrated_facts();
  const auto judged = [&facts](const std::string& rate) {
    return result_of(verification::judge(limits("false_alarm_rate = " + rate), facts), CriterionId::false_alarms);
  };
  facts.healthy.false_alarm_per_block = verification::rate_of(10, 10000);  // 4.8e-4 to 1.84e-3
  EXPECT_EQ(judged("2e-3"), Result::met);
  EXPECT_EQ(judged("1e-3"), Result::open);
  EXPECT_EQ(judged("4e-4"), Result::not_met);
  facts.healthy.false_alarm_per_block = verification::rate_of(0, 1000);
  const verification::Report open = verification::judge(limits("false_alarm_rate = 1e-6"), facts);
  EXPECT_EQ(open.fit, Result::open);
  EXPECT_TRUE(plumb_test::says(
      open.sentence, {"INCONCLUSIVE for paper-tetrahedron", "too few trials", "3688878"}));  // ln 0.025 / ln(1 - 1e-6)
}

Result verdict_of(void (*change)(verification::Facts&)) {
  verification::Facts facts = calibrated_facts();
  change(facts);
  return verification::judge(limits(""), facts).fit;
}

TEST(VerificationVerdict, WhatMustNeverHappenIsNeverPassedOver) {
  using verification::Facts;
  EXPECT_EQ(verdict_of([](Facts&) {}), Result::met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.faults.wrong_exclusion.count = 1; }), Result::not_met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.faults.misleading.count = 1; }), Result::not_met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.replay->agree = 1; }), Result::not_met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.calibration.accepted = false; }), Result::not_met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.array.protection_level_deg.reset(); }), Result::not_met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.trace.orphans.emplace_back("REQ-999 answers no hazard"); }), Result::not_met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.trace.counts.failed = 1; }), Result::not_met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.healthy.unavailable = verification::rate_of(500, 600); }), Result::not_met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.faults = {}; }), Result::open);
}

TEST(VerificationVerdict, APredictedCalibrationIsOpenAndSaysWhatToRecord) {
  const Json& report = paper_report();
  EXPECT_EQ(report["verdict"]["verdict"], "open");
  EXPECT_TRUE(plumb_test::says(report["verdict"]["sentence"], {"not calibrated", "what to record", "--stations"}));
  EXPECT_EQ(written(report, CriterionId::calibration_accepted)["result"], "open");
  EXPECT_EQ(report["calibration"]["planned"]["attitudes"].size(), report["calibration"]["planned"]["stations"]);
  // What cannot be calibrated even in a simulation is not fit.
  EXPECT_EQ(verdict_of([](verification::Facts& f) {
              f.calibration = {false, "predicted", "why", ""};
            }),
            Result::not_met);
}

TEST(VerificationVerdict, CoefficientsThatNothingHasTestedAreOpen) {
  EXPECT_EQ(verdict_of([](verification::Facts& f) {
              f.calibration = {true, "calibration file", "", ""};
            }),
            Result::met);
  EXPECT_EQ(verdict_of([](verification::Facts& f) {
              f.calibration = {true, "known coefficients", "", ""};
            }),
            Result::open);
  EXPECT_EQ(verdict_of([](verification::Facts& f) {
              f.calibration = {false, "known coefficients", "why", ""};
            }),
            Result::not_met);
}

/// The verdict that is written is that on the figures which the sections show.
TEST(VerificationVerdict, IsOnTheFiguresThatTheSectionsShow) {
  const Json& report = paper_report();
  const auto found = [&report](CriterionId id) { return written(report, id)["found"].get<std::string>(); };
  EXPECT_EQ(found(CriterionId::faults_isolated),
            report["array"]["figures_of_merit"]["confirmed_grade"].dump() + " (confirmed grade)");
  EXPECT_EQ(found(CriterionId::protection_level),
            fmt::format("{:.4g} deg",
                        report["array"]["detection_sizes"]["as_stated"]["protection_level_at_rest_deg"].get<double>()));
  EXPECT_EQ(found(CriterionId::calibration_accepted), report["calibration"]["mode"].get<std::string>() + ", accepted");
  const auto counted = [](const Json& rate) { return rate["count"].dump() + " of " + rate["of"].dump() + ","; };
  const Json& campaign = report["campaign"];
  EXPECT_TRUE(
      plumb_test::says(found(CriterionId::available_while_healthy), {counted(campaign["healthy"]["unavailable"])}));
  const Json& rates = campaign["faults"]["rates"];
  EXPECT_TRUE(plumb_test::says(found(CriterionId::wrong_exclusion), {counted(rates["wrong_exclusion"])}));
  EXPECT_TRUE(plumb_test::says(found(CriterionId::misleading), {counted(rates["misleading"])}));
  EXPECT_EQ(found(CriterionId::replay_agrees),
            campaign["replayed"]["agree"].dump() + " of " + campaign["replayed"]["scenarios"].dump());
  EXPECT_EQ(report["verdict"]["requirements"], report["traceability"]["counts"]);
  EXPECT_EQ(report["verdict"]["orphans"], report["traceability"]["orphans"]);
}

TEST(VerificationVerdict, TheFirstPageAnswersTheFourQuestionsInWords) {
  const Json& answers = paper_report()["verdict"]["answers"];
  const auto answer = [&answers](const char* question) -> Json {
    for (const Json& one : answers) {
      if (one["question"] == question) return one;
    }
    return {{"value", "none"}, {"label", "none"}};
  };
  EXPECT_EQ(answer("How many faults?")["value"], "1");
  EXPECT_TRUE(plumb_test::says(answer("How large?")["value"], {"mg0"}));
  EXPECT_TRUE(plumb_test::says(answer("How sure?")["label"], {"healthy sensor", "at most", "97.5 % confidence"}));
  EXPECT_TRUE(plumb_test::says(answer("What not to trust?")["label"],
                               {"more than 1 of 4", "three sensors", "same wrong gravity", "not calibrated"}));
  const Json& isolated = paper_report()["campaign"]["faults"]["rates"]["isolated"];
  EXPECT_EQ(answer("How often isolated?")["value"], isolated["count"].dump() + " of " + isolated["of"].dump());
  EXPECT_TRUE(plumb_test::says(answer("How often isolated?")["label"], {"without an exclusion"}));
}

// What no result was given of has not failed, and has not passed either.
TEST(VerificationVerdict, RequirementsAreJudgedByResultsThatWereGiven) {
  verification::Facts facts = calibrated_facts();
  const auto judged = [&facts] {
    return result_of(verification::judge(limits(""), facts), CriterionId::requirements_failed);
  };
  facts.trace.tests_given = false;
  facts.trace.proofs.reset();
  EXPECT_EQ(judged(), std::nullopt);
  facts.trace.tests_given = true;
  EXPECT_EQ(judged(), Result::met);
  facts.trace.counts.failed = 1;
  EXPECT_EQ(judged(), Result::not_met);
}

// Verifies: REQ-185
TEST(VerificationVerdict, IsIncompleteWithoutTheResultsOfThisBuild) {
  using verification::Facts;
  EXPECT_STREQ(fitness(verification::judge(limits(""), calibrated_facts())), "fit");
  const std::vector<std::pair<void (*)(Facts&), const char*>> lacking = {
      {[](Facts& f) { f.trace.tests_given = false; }, "--test-results"},
      {[](Facts& f) { f.trace.tests_not_of_this = "commit \"a\""; }, "evidence of another build: commit \"a\""},
      {[](Facts& f) { f.trace.counts.verified = 89; }, "only 89 of 90 active requirements are verified"},
      {[](Facts& f) { f.trace.proofs.reset(); }, "--assurance"},
      {[](Facts& f) { f.trace.proofs_not_of_this = "commit \"b\""; }, "evidence of another build: commit \"b\""}};
  for (const auto& [plant, words] : lacking) {
    Facts facts = calibrated_facts();
    plant(facts);
    const verification::Report report = verification::judge(limits(""), facts);
    EXPECT_EQ(report.fit, Result::open) << words;
    EXPECT_STREQ(fitness(report), "fit, evidence incomplete") << words;
    EXPECT_TRUE(plumb_test::says(report.sentence, {"fit, evidence incomplete", words}));
    facts.wiring = {verification::WiringFacts::State::open, "", "the wiring is not confirmed"};
    EXPECT_STREQ(fitness(verification::judge(limits(""), facts)), "open") << "more than evidence is open";
    facts.array.confirmed_grade = 0;
    EXPECT_STREQ(fitness(verification::judge(limits(""), facts)), "not fit");
  }
}

TEST(VerificationVerdict, EvidenceThatIsGivenIsJudged) {
  using verification::Facts;
  EXPECT_EQ(verdict_of([](Facts& f) { f.analysis_findings = 0; }), Result::met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.analysis_findings = 2; }), Result::not_met);
  EXPECT_EQ(verdict_of([](Facts& f) { f.target.emplace().push_back({"stack", 100.0, 100.0}); }), Result::met);
  Facts above = calibrated_facts();
  above.target.emplace().push_back({"stack", 101.0, 100.0});
  EXPECT_TRUE(plumb_test::says(verification::judge(limits(""), above).sentence, {"not fit", "stack"}));
  EXPECT_EQ(verdict_of([](Facts& f) { f.trace.proofs.emplace().push_back({"spin", false}); }), Result::not_met);
}

TEST(VerificationVerdict, ALongCampaignIsJudgedInThePlaceOfTheShortOne) {
  verification::Facts facts = calibrated_facts();
  facts.faults.wrong_exclusion = verification::rate_of(1, 1000000);
  EXPECT_EQ(verification::judge(limits(""), facts).fit, Result::not_met);
  EXPECT_EQ(verification::judge(limits("wrong_exclusion_rate = 1e-5"), facts).fit, Result::met);
}

TEST(VerificationIdentity, HashesAreThoseOfTheStandard) {
  EXPECT_EQ(render::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(render::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(render::sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(render::sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace verdict_test
