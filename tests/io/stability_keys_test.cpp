// The stability of sensors in the array file, and the keys that it took the place of.
#include <gtest/gtest.h>

#include "io_test_support.hpp"
#include "plumb/core/units.hpp"

namespace stability_keys_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;

constexpr double kMg = 1e-3 * kG0_mps2;

// Verifies: REQ-123
TEST(StabilityKeys, OfASensorGoBeforeThoseOfTheMonitorTable) {
  EXPECT_EQ(without_stability(array_of()), array_of().array.all());
  const std::string usual =
      changed("window = 16", "window = 16\nstability = \"0.2 mg\"\nstability_per_degc = \"20 ug\"");
  const ArrayFile file = array_of(changed(
      "id = \"A3\"",
      "id = \"A3\"\nstability = \"0.05 mg\"\nstability_per_day = \"1 ug\"\nstability_per_degc_per_min = \"0.1 mg\"",
      usual));
  for (const std::size_t i : {0U, 1U, 3U}) {
    EXPECT_DOUBLE_EQ(file.stability[i].mps2, 0.2 * kMg);
    EXPECT_DOUBLE_EQ(file.stability[i].per_degc_mps2, 0.02 * kMg);
    EXPECT_EQ(file.stability[i].per_day_mps2, 0.0);
  }
  EXPECT_DOUBLE_EQ(file.stability[2].mps2, 0.05 * kMg);
  EXPECT_DOUBLE_EQ(file.stability[2].per_day_mps2, 0.001 * kMg);
  EXPECT_DOUBLE_EQ(file.stability[2].per_degc_mps2, 0.02 * kMg) << "what a sensor leaves out is the usual";
  EXPECT_DOUBLE_EQ(file.stability[2].per_degc_per_min_mps2, 0.1 * kMg);
  EXPECT_TRUE(without_stability(file).empty());
  const ArrayFile one = array_of(changed("id = \"A3\"", "id = \"A3\"\nstability = \"0.05 mg\""));
  EXPECT_EQ(without_stability(one), one.array.all().without(2));
  EXPECT_EQ(one.fingerprint, array_of().fingerprint) << "a calibration stays that of the array";
}

TEST(StabilityKeys, TheUnitMaySayPerWhat) {
  const auto per_day = [](const std::string& key, const std::string& value) {
    return array_of(changed("window = 16", "window = 16\n" + key + " = \"" + value + "\"")).stability[0];
  };
  EXPECT_DOUBLE_EQ(per_day("stability_per_day", "1 ug/day").per_day_mps2, 0.001 * kMg);
  EXPECT_DOUBLE_EQ(per_day("stability_per_degc", "1 ug/degC").per_degc_mps2, 0.001 * kMg);
  EXPECT_DOUBLE_EQ(per_day("stability_per_degc_per_min", "1 ug/degC/min").per_degc_per_min_mps2, 0.001 * kMg);
  const Stability whole{0.3 * kMg, 1e-6, 2e-5, 3e-4};
  const Stability again = array_of(changed("window = 16", "window = 16\n" + stability_toml(whole))).stability[3];
  EXPECT_EQ(again.mps2, whole.mps2);
  EXPECT_EQ(again.per_day_mps2, whole.per_day_mps2);
  EXPECT_EQ(again.per_degc_mps2, whole.per_degc_mps2);
  EXPECT_EQ(again.per_degc_per_min_mps2, whole.per_degc_per_min_mps2);
  EXPECT_EQ(stability_toml({}), "");
}

// Negative: REQ-123
TEST(StabilityKeys, WhatIsNoStabilityIsRefused) {
  const auto refused = [](const std::string& line, const std::string& field, const std::string& words) {
    for (const char* where : {"window = 16", "id = \"A1\""}) {
      const bool of_sensor = where[0] == 'i';
      const auto answer = parse_array_text(changed(where, std::string(where) + "\n" + line), "array.toml");
      ASSERT_FALSE(answer.has_value()) << line;
      EXPECT_EQ(answer.error().line, of_sensor ? 17 : 8);
      EXPECT_EQ(answer.error().field, (of_sensor ? "sensor[1]." : "monitor.") + field);
      EXPECT_NE(answer.error().text().find(words), std::string::npos) << answer.error().text();
    }
  };
  refused("stability = 0.2", "stability", "the unit is missing");
  refused("stability = \"0.2 g\"", "stability", "ambiguous");
  refused("stability = \"-0.2 mg\"", "stability", "out of range");
  refused("stability = \"2 g0\"", "stability", "out of range");
  refused("stability = \"0.2 mg/day\"", "stability", "unit \"mg/day\" is not a known unit");
  refused("stability_per_day = \"0.2 mg/degC\"", "stability_per_day", "unit \"mg/degC\" is not a known unit");
  refused("stability_day = \"1 ug\"", "stability_day", "did you mean \"stability");
}

// Negative: REQ-123
TEST(StabilityKeys, KeysOfVersionOneAreRefusedWithTheirReplacement) {
  for (const std::string key : {"drift_bias", "drift_scale", "common_drift"}) {
    const auto answer = parse_array_text(changed("window = 16", "window = 16\n" + key + " = \"0.1 mg\""), "array.toml");
    ASSERT_FALSE(answer.has_value()) << key;
    EXPECT_EQ(answer.error().line, 8);
    EXPECT_EQ(answer.error().field, "monitor." + key);
    EXPECT_NE(answer.error().what.find("is no longer a key"), std::string::npos);
    EXPECT_NE(answer.error().remedy.find("stability = \"0.2 mg\""), std::string::npos);
  }
}

TEST(StabilityKeys, TheToleranceIsFourSigmasOfThatDay) {
  const ArrayFile file =
      array_of(changed("window = 16", "window = 16\nstability = \"0.2 mg\"\nstability_per_day = \"10 ug\""));
  EXPECT_NEAR(tolerance_mps2(file, 0.0)[3], 0.8 * kMg, 1e-6 * kMg);
  EXPECT_NEAR(tolerance_mps2(file, 30.0)[3], 2.0 * kMg, 1e-6 * kMg);
  EXPECT_EQ(tolerance_mps2(file, 30.0)[4], 0.0) << "there is no fifth sensor";
}

}  // namespace
}  // namespace stability_keys_test
