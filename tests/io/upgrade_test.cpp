// Old names in files: refused with the new name, and rewritten by `upgrade_text`.
#include "plumb/io/upgrade.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "io_test_support.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/scenario_file.hpp"

namespace upgrade_test {
namespace {

using namespace plumb::io;
using namespace io_test;

const std::string kOldMonitor =
    "window = 16\n# patience = 3, said the old manual\n  patience=7   # patience\n\"clean_blocks\" = 4\n"
    "excitation_angle = \"6 deg\"\nasserted_faults = 1\npatience_blocks = 40";
const std::string kNewMonitor =
    "window = 16\n# patience = 3, said the old manual\n  isolation_timeout=7   # patience\n\"passed_blocks\" = 4\n"
    "distinct_attitude_angle = \"6 deg\"\nassumed_faults = 1\nisolation_timeout_blocks = 40";
const std::string kScenario =
    "tool = \"paper\"\nname = \"patience\"\n[attitude]\nlaw = \"drilling-path\"\n[depth]\nstand = \"28 m\"\n";

Upgraded upgraded(const std::string& text) {
  auto out = upgrade_text(text, "f");
  if (!out) {
    ADD_FAILURE() << out.error().text();
    return {};
  }
  return *std::move(out);
}

std::string checksum_of(nlohmann::ordered_json content) {
  content.erase("checksum");
  const std::string text = content.dump();
  char out[32] = {};
  std::snprintf(out, sizeof out, "fnv1a64:%016llx", static_cast<unsigned long long>(fnv1a(text.data(), text.size())));
  return out;
}

TEST(Upgrade, RenamesTheKeysOfAnArrayFileAndNothingElse) {
  const std::string old = changed("window = 16", kOldMonitor);
  const auto refused = parse_array_text(old, "f");
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().line, 9);
  EXPECT_EQ(refused.error().field, "monitor.patience");
  EXPECT_EQ(refused.error().what, "is not a known key: renamed \"isolation_timeout\"");
  EXPECT_EQ(refused.error().remedy, "run `plumb upgrade f --in-place`");
  const Upgraded out = upgraded(old);
  EXPECT_EQ(out.text, changed("window = 16", kNewMonitor));
  ASSERT_EQ(out.renamed.size(), 5U);
  EXPECT_EQ(out.renamed[0].line, 9);
  EXPECT_EQ(out.renamed[0].section, "monitor");
  EXPECT_EQ(out.renamed[0].old_name, "patience");
  EXPECT_EQ(out.renamed[0].new_name, "isolation_timeout");
  EXPECT_EQ(out.renamed[4].line, 13);
  const auto config = array_of(out.text).monitor;
  EXPECT_EQ(config.isolation_timeout, 7);
  EXPECT_EQ(config.passed_blocks, 4);
  EXPECT_EQ(config.assumed_faults, 1);
  EXPECT_EQ(config.isolation_timeout_blocks, 40);
}

TEST(Upgrade, LeavesAFileOfTodayAsItIs) {
  const Upgraded out = upgraded(kArrayText);
  EXPECT_EQ(out.text, kArrayText);
  EXPECT_TRUE(out.renamed.empty());
}

TEST(Upgrade, FindsKeysInTablesOnOneLineAndWithDots) {
  EXPECT_EQ(upgraded("attitude = {law = \"fixed\"}\ndepth = { heat = \"# stand = 1\", stand = \"28 m\" }\n").text,
            "attitude = {law = \"fixed\"}\ndepth = { heat = \"# stand = 1\", station_spacing = \"28 m\" }\n");
  EXPECT_EQ(upgraded("attitude.law = \"fixed\"\narray.monitor.patience = 3").text,
            "attitude.law = \"fixed\"\narray.monitor.isolation_timeout = 3");
}

TEST(Upgrade, RenamesTheKeyOfAScenarioAndTheWordsOfACampaign) {
  const auto refused = parse_scenario_text(kScenario, "f");
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().what, "is not a known key: renamed \"station_spacing\"");
  EXPECT_EQ(upgraded(kScenario).text, changed("stand", "station_spacing", kScenario));
  const Upgraded campaign = upgraded("scenarios = 9\n[run]\nstart = \"proven\"  # proven\ntrust_stations = 4\n");
  EXPECT_EQ(campaign.text, "scenarios = 9\n[run]\nstart = \"validated\"  # proven\nvalidation_stations = 4\n");
  EXPECT_EQ(campaign.renamed.at(0).section, "run.start");
}

TEST(Upgrade, ReadsAScenarioInJsonToo) {
  const std::string old = R"({"attitude": {"law": "fixed", "stand": 1},
 "depth": {"stand": "stand"}, "array": {"monitor": {"patience" : 3, "note": "{\"patience\": 1}"}}})";
  const Upgraded out = upgraded(old);
  EXPECT_EQ(out.text, R"({"attitude": {"law": "fixed", "stand": 1},
 "depth": {"station_spacing": "stand"}, "array": {"monitor": {"isolation_timeout" : 3, "note": "{\"patience\": 1}"}}})");
  ASSERT_EQ(out.renamed.size(), 2U);
  EXPECT_EQ(out.renamed[0].line, 2);
}

TEST(Upgrade, KeepsAByteOrderMarkInFrontOfTomlAndJson) {
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(upgraded(mark + "attitude.law = \"fixed\"\narray.monitor.patience = 3").text,
            mark + "attitude.law = \"fixed\"\narray.monitor.isolation_timeout = 3");
  EXPECT_EQ(upgraded(mark + R"({"attitude": {"law": "fixed"}, "array": {"monitor": {"patience": 3}}})").text,
            mark + R"({"attitude": {"law": "fixed"}, "array": {"monitor": {"isolation_timeout": 3}}})");
}

TEST(Upgrade, MakesTheCheckSumOfACalibrationAnew) {
  auto old = nlohmann::ordered_json::parse(
      R"({"schema": "plumb-calibration", "version": 1, "checksum": "", "report": {"roll": {"groups": 2, "lone": 1,
          "wobble_rad": 0.25}}, "sensors": [{"id": "lone"}]})");
  old["checksum"] = checksum_of(old);
  const Upgraded out = upgraded(old.dump(1));
  const auto now = nlohmann::ordered_json::parse(out.text);
  EXPECT_EQ(now["report"]["roll"]["single_station_groups"], 1);
  EXPECT_EQ(now["report"]["roll"]["axis_deviation_rad"], 0.25);
  EXPECT_EQ(now["checksum"], checksum_of(now));
  EXPECT_EQ(now["sensors"], old["sensors"]);
  old["report"]["roll"]["groups"] = 3;
  const auto damaged = upgrade_text(old.dump(), "f");
  ASSERT_FALSE(damaged.has_value());
  EXPECT_NE(damaged.error().what.find("edited or damaged"), std::string::npos);
}

TEST(Upgrade, SaysWhatToWriteForDriftKeysAndChangesNothing) {
  for (const std::string key : {"drift_bias", "drift_scale", "common_drift"}) {
    const auto out = upgrade_text(changed("window = 16", "patience = 3\n" + key + " = \"0.1 mg\""), "f");
    ASSERT_FALSE(out.has_value()) << key;
    EXPECT_EQ(out.error().line, 8);
    EXPECT_EQ(out.error().field, "monitor." + key);
    EXPECT_NE(out.error().remedy.find("stability = \"0.2 mg\""), std::string::npos);
    EXPECT_EQ(out.error().code, ExitCode::invalid_input);
  }
}

TEST(Upgrade, RefusesAFileThatHasAKeyByBothNames) {
  const auto toml = upgrade_text(changed("window = 16", "patience = 3\nisolation_timeout = 4"), "f");
  ASSERT_FALSE(toml.has_value());
  EXPECT_NE(toml.error().what.find("holds a key under both its old name and its new name"), std::string::npos)
      << toml.error().what;
  EXPECT_NE(toml.error().remedy.find("patience (line 7)"), std::string::npos) << toml.error().remedy;
  const auto json = upgrade_text("{\"sensor\": [], \"monitor\": {\"patience\": 3, \"isolation_timeout\": 4}}", "f");
  ASSERT_FALSE(json.has_value());
  EXPECT_NE(json.error().what.find("holds a key under both its old name and its new name"), std::string::npos)
      << json.error().what;
}

TEST(Upgrade, RefusesWhereAnOldNameCannotBeDistinguishedFromOtherText) {
  const std::string one_line = "sensor = []\nx = {a = {patience = 1}, monitor = {patience = 9}}\n";
  const auto out = upgrade_text(one_line, "f");
  ASSERT_FALSE(out.has_value());
  EXPECT_NE(out.error().remedy.find("by hand"), std::string::npos);
}

TEST(Upgrade, KnowsEveryKeyThatWasRenamed) {
  const auto out = upgrade_text("scenarios = 10\n[expect]\nwrong_set_aside = 0\n", "f");
  ASSERT_TRUE(out.has_value());
  EXPECT_EQ(out->text, "scenarios = 10\n[expect]\nwrong_provisional_exclusion = 0\n");
}

TEST(Upgrade, RefusesWhatIsNoSuchFile) {
  for (const char* text :
       {"", "t_s,a1\n0,1\n", "[monitor]\npatience = 3\n", "{\"a\": 1}", "{\"a\": ", "{}{", "a = [1"}) {
    const auto out = upgrade_text(text, "f");
    EXPECT_FALSE(out.has_value()) << text;
    if (!out) {
      EXPECT_FALSE(out.error().remedy.empty()) << text;
    }
  }
  EXPECT_FALSE(upgrade_text(std::string(100000, '['), "f").has_value());
  EXPECT_FALSE(upgrade_text("{\"a\": " + std::string(100000, '['), "f").has_value());
}

}  // namespace
}  // namespace upgrade_test
