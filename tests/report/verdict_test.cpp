// Limits as users write them, and the verdict that follows from them.
#include <gtest/gtest.h>

#include "plumb/core/units.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/report/identity.hpp"
#include "plumb/report/limits.hpp"
#include "plumb/report/trials.hpp"
#include "verify_support.hpp"

namespace verdict_test {
namespace {

using namespace plumb;
using plumb_test::calibrated_report;
using plumb_test::Json;
using plumb_test::paper_report;

io::ArrayFile paper_array() { return *io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml"); }

report::UserLimits limits(const std::string& keys) {
  const auto read = report::parse_limits("[limits]\n" + keys, "limits.toml", paper_array());
  EXPECT_TRUE(read) << read.error().text();
  return *read;
}

std::string refusal(const std::string& text) {
  const auto read = report::parse_limits(text, "limits.toml", paper_array());
  return read ? "accepted" : read.error().text();
}

std::string result_of(const Json& verdict, const std::string& name) {
  for (const Json& one : verdict["criteria"]) {
    if (one["name"] == name) return one["result"];
  }
  return "not judged";
}

TEST(VerificationLimits, AreReadWithTheirUnits) {
  const report::UserLimits read = limits(
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
  const Json report = calibrated_report();
  const char* const level = "Protection level against the alert limit";
  const double found_deg = report["array"]["protection_level_deg"];
  const auto with = [&report](const std::string& keys) { return report::verdict_section(limits(keys), report); };
  EXPECT_EQ(with("")["verdict"], "fit");
  const Json tight = with("alert_limit = \"" + std::to_string(0.99 * found_deg) + " deg\"");
  EXPECT_EQ(result_of(tight, level), "not met");
  EXPECT_EQ(tight["verdict"], "not fit");
  EXPECT_TRUE(plumb_test::says(tight["sentence"], {"not fit", "tilt error", "alert limit"}));
  EXPECT_EQ(result_of(with("alert_limit = \"" + std::to_string(1.01 * found_deg) + " deg\""), level), "met");
  EXPECT_EQ(with("faults = 2")["verdict"], "not fit");
  EXPECT_TRUE(plumb_test::says(with("faults = 2")["sentence"], {"isolates 1 faulty sensor for good, 2 are asked for"}));
  EXPECT_EQ(result_of(with("fault = \"0.1 mg0\""), "Least constant error that is detected in one block"), "not met");
  EXPECT_EQ(result_of(with("fault = \"50 mg0\""), "Least constant error that is detected in one block"), "met");
  EXPECT_EQ(result_of(with("detect_within = \"1 ms\""), "Time to detect, 95 % of the detected faults"), "not met");
  EXPECT_EQ(result_of(with("detect_within = \"1 h\""), "Time to detect, 95 % of the detected faults"), "met");
}

/// What no test can find broken stands first among the assumptions.
TEST(VerificationVerdict, AStandstillOrTheAccelerationAllowedForIsSaidFirst) {
  const Json report = calibrated_report();
  report::UserLimits given = limits("");
  const auto first = [&] { return report::verdict_section(given, report)["assumptions"][0].get<std::string>(); };
  EXPECT_TRUE(plumb_test::says(first(), {"A standstill is assumed", "acceleration_bound"}));
  io::ArrayFile array = paper_array();
  array.monitor.acceleration_bound_mps2 = 5e-3 * kG0_mps2;
  given = report::limits_of(array);
  EXPECT_TRUE(plumb_test::says(first(), {"at most 5 mg0", "0.286", "of every protection level"})) << first();
  array.monitor.acceleration_bound_mps2 = 0.03 * kG0_mps2;
  given = report::limits_of(array);
  EXPECT_TRUE(plumb_test::says(first(), {"at most 30 mg0", "the alert never ends"})) << first();
}

// Verifies: REQ-123
TEST(VerificationVerdict, TheDriftThatIsAllowedForIsSaidBesideIt) {
  report::UserLimits given = limits("");
  const Json report = calibrated_report();
  const auto second = [&] { return report::verdict_section(given, report)["assumptions"][1].get<std::string>(); };
  given.drift = "none is allowed for: no stability is stated";
  EXPECT_TRUE(plumb_test::says(second(), {"Drift since the calibration: none is allowed for", "no stability is stated",
                                          "can be excluded", "stability"}));
}

// Negative: REQ-181
TEST(VerificationVerdict, ARateIsShownRefutedOrOpenByItsInterval) {
  Json report = calibrated_report();
  const auto judged = [&report](const std::string& rate) {
    return result_of(report::verdict_section(limits("false_alarm_rate = " + rate), report), "False alarms");
  };
  Json& rate = report["campaign"]["healthy"]["false_alarm_per_block"];
  rate = report::rate_json(10, 10000);  // 4.8e-4 to 1.84e-3
  EXPECT_EQ(judged("2e-3"), "met");
  EXPECT_EQ(judged("1e-3"), "open");
  EXPECT_EQ(judged("4e-4"), "not met");
  rate = report::rate_json(0, 1000);
  const Json open = report::verdict_section(limits("false_alarm_rate = 1e-6"), report);
  EXPECT_EQ(open["verdict"], "open");
  EXPECT_TRUE(plumb_test::says(open["sentence"], {"open", "too few trials", "3688878"}));  // ln 0.025 / ln(1 - 1e-6)
}

TEST(VerificationVerdict, WhatMustNeverHappenIsNeverPassedOver) {
  const auto broken = [](void (*change)(Json&)) {
    Json report = calibrated_report();
    change(report);
    return report::verdict_section(limits(""), report)["verdict"].get<std::string>();
  };
  EXPECT_EQ(broken([](Json&) {}), "fit");
  EXPECT_EQ(broken([](Json& r) { r["campaign"]["faults"]["rates"]["wrong_exclusion"]["count"] = 1; }), "not fit");
  EXPECT_EQ(broken([](Json& r) { r["campaign"]["faults"]["rates"]["misleading"]["count"] = 1; }), "not fit");
  EXPECT_EQ(broken([](Json& r) { r["campaign"]["replayed"]["agree"] = 1; }), "not fit");
  EXPECT_EQ(broken([](Json& r) { r["calibration"]["accepted"] = false; }), "not fit");
  EXPECT_EQ(broken([](Json& r) { r["array"]["protection_level_deg"] = Json(); }), "not fit");
  EXPECT_EQ(broken([](Json& r) { r["traceability"]["orphans"].push_back("REQ-999 answers no hazard"); }), "not fit");
  EXPECT_EQ(broken([](Json& r) { r["traceability"]["counts"]["failed"] = 1; }), "not fit");
  EXPECT_EQ(broken([](Json& r) { r["campaign"]["healthy"]["unavailable"] = report::rate_json(500, 600); }), "not fit");
  EXPECT_EQ(broken([](Json& r) { r["campaign"]["faults"] = {{"played", false}, {"reason", "why"}}; }), "open");
}

TEST(VerificationVerdict, APredictedCalibrationIsOpenAndSaysWhatToRecord) {
  const Json& report = paper_report();
  EXPECT_EQ(report["verdict"]["verdict"], "open");
  EXPECT_TRUE(plumb_test::says(report["verdict"]["sentence"], {"not calibrated", "what to record", "--positions"}));
  EXPECT_EQ(result_of(report["verdict"], "Calibration accepted"), "open");
  EXPECT_EQ(report["calibration"]["planned"]["attitudes"].size(), report["calibration"]["planned"]["stations"]);
  EXPECT_EQ(report::verdict_section(limits(""), calibrated_report())["verdict"], "fit");
  Json refused = paper_report();  // what cannot be calibrated even in a simulation is not fit
  refused["calibration"]["accepted"] = false;
  EXPECT_EQ(report::verdict_section(limits(""), refused)["verdict"], "not fit");
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
  EXPECT_TRUE(plumb_test::says(answer("How sure?")["label"], {"healthy sensor", "95 % confidence"}));
  EXPECT_TRUE(plumb_test::says(answer("What not to trust?")["label"],
                               {"more than 1 of 4", "three sensors", "same wrong gravity", "not calibrated"}));
  const Json& isolated = paper_report()["campaign"]["faults"]["rates"]["isolated"];
  EXPECT_EQ(answer("How often left out?")["value"], isolated["count"].dump() + " of " + isolated["of"].dump());
  EXPECT_TRUE(plumb_test::says(answer("How often left out?")["label"], {"nobody left out"}));
}

// What no result was given of has not failed, and has not passed either.
TEST(VerificationVerdict, RequirementsAreJudgedByResultsThatWereGiven) {
  Json report = calibrated_report();
  EXPECT_EQ(result_of(report::verdict_section(limits(""), report), "Requirements failed"), "not judged");
  report["traceability"]["test_results"]["given"] = true;
  EXPECT_EQ(result_of(report::verdict_section(limits(""), report), "Requirements failed"), "met");
  report["traceability"]["counts"]["failed"] = 1;
  EXPECT_EQ(result_of(report::verdict_section(limits(""), report), "Requirements failed"), "not met");
}

TEST(VerificationVerdict, EvidenceThatIsGivenIsJudged) {
  const auto verdict_of = [](void (*change)(Json&)) {
    Json report = calibrated_report();
    change(report);
    return report::verdict_section(limits(""), report)["verdict"].get<std::string>();
  };
  EXPECT_EQ(verdict_of([](Json& r) { r["analysis"] = {{"given", true}, {"findings", 0}}; }), "fit");
  EXPECT_EQ(verdict_of([](Json& r) { r["analysis"] = {{"given", true}, {"findings", 2}}; }), "not fit");
  const auto target = [](double value) {
    return Json{{"given", true}, {"items", {{{"name", "stack"}, {"value", value}, {"limit", 100}}}}};
  };
  Json report = calibrated_report();
  report["resources"]["target"] = target(100.0);
  EXPECT_EQ(report::verdict_section(limits(""), report)["verdict"], "fit");
  report["resources"]["target"] = target(101.0);
  EXPECT_TRUE(plumb_test::says(report::verdict_section(limits(""), report)["sentence"], {"not fit", "stack"}));
  EXPECT_EQ(verdict_of([](Json& r) {
              r["traceability"]["assurance_results"] = {{"given", true},
                                                        {"items", {{{"title", "spin"}, {"result", "fails"}}}}};
            }),
            "not fit");
}

TEST(VerificationVerdict, ALongCampaignIsJudgedInThePlaceOfTheShortOne) {
  Json report = calibrated_report();
  Json& faults = report["campaign"]["faults"];
  faults["reused"] = {{"rates", faults["rates"]}};
  EXPECT_EQ(report::verdict_section(limits(""), report)["verdict"], "fit");
  faults["reused"]["rates"]["wrong_exclusion"] = report::rate_json(1, 1000000);
  EXPECT_EQ(report::verdict_section(limits(""), report)["verdict"], "not fit");
  EXPECT_EQ(report::verdict_section(limits("wrong_exclusion_rate = 1e-5"), report)["verdict"], "fit");
}

TEST(VerificationIdentity, HashesAreThoseOfTheStandard) {
  EXPECT_EQ(report::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(report::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(report::sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(report::sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace verdict_test
