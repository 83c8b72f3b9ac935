#include "plumb/io/records.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "io_test_support.hpp"

namespace records_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using namespace io_test;
using Json = nlohmann::ordered_json;

Verdict some_verdict() {
  Verdict v;
  v.time_s = 0.1 + 0.2;
  v.state = HealthState::suspect;
  v.qualifiers = Qualifier::not_yet_validated | Qualifier::no_redundancy;
  v.tick = true;
  v.statistic = std::numeric_limits<double>::infinity();
  v.limit = 4.5;
  v.margin = std::nan("");
  v.configured = SensorSet::first(4);
  v.in_service = SensorSet::first(4).without(2);
  v.excluded = SensorSet::of(2);
  v.minimum_faults = {0, 1, kNoHypothesis, 2};
  v.gravity_mps2 = {0.0, -5.0, 5.0};
  v.covariance = {1.0, 0.5, 0.0, 0.5, 2.0, 0.0, 0.0, 0.0, 3.0};
  v.protection_level_calibrated_axes_rad = rad_from_deg(0.5);
  return v;
}

TEST(Records, EventIsOneObjectWithStableKeys) {
  TransitionRecord record;
  record.sequence = 7;
  record.time_s = 12.25;
  record.from = HealthState::suspect;
  record.to = HealthState::isolated;
  record.event = HealthEvent::exclusion;
  record.cause = Cause::isolated_fault;
  record.grade = Grade::confirmed;
  record.sensors = SensorSet::of(1).with(3);
  record.statistic = 12.0;
  record.limit = 4.5;
  const std::string json = event_json(record, array_of().array);
  EXPECT_EQ(json.find('\n'), std::string::npos);
  const Json object = Json::parse(json);
  EXPECT_EQ(object["sequence"], 7);
  EXPECT_EQ(object["t_s"], 12.25);
  EXPECT_EQ(object["from"], to_string(HealthState::suspect));
  EXPECT_EQ(object["to"], to_string(HealthState::isolated));
  EXPECT_EQ(object["event"], to_string(HealthEvent::exclusion));
  EXPECT_EQ(object["grade"], to_string(Grade::confirmed));
  EXPECT_EQ(object["sensors"], Json({"A2", "A4"}));
  std::string keys;
  for (const auto& item : object.items()) keys += item.key() + " ";
  EXPECT_EQ(keys, "sequence t_s from to event cause grade sensors statistic limit ");
}

TEST(Records, VerdictCarriesEverything) {
  const ArrayFile file = array_of();
  const Json object = Json::parse(verdict_json(some_verdict(), file.array));
  EXPECT_EQ(object["t_s"].get<double>(), 0.1 + 0.2) << "full precision";
  EXPECT_EQ(object["qualifiers"], Json({"not_yet_validated", "no_redundancy"}));
  EXPECT_TRUE(object["statistic"].is_null()) << "not finite";
  EXPECT_TRUE(object["margin"].is_null());
  EXPECT_EQ(object["in_service"], Json({"A1", "A2", "A4"}));
  EXPECT_EQ(object["excluded"], Json({"A3"}));
  EXPECT_EQ(object["absent"], Json::array());
  EXPECT_EQ(object["minimum_faults"], Json({0, 1, nullptr, 2}));
  EXPECT_NEAR(object["inclination_deg"].get<double>(), 45.0, 1e-12);
  EXPECT_NEAR(object["toolface_deg"].get<double>(), 0.0, 1e-12);
  EXPECT_TRUE(object.at("protection_level_calibrated_axes_deg").is_null()) << "not available";
  EXPECT_TRUE(object.at("protection_level_housing_deg").is_null());
  EXPECT_EQ(object["transition"], 0);
  for (const char* key : {"state",
                          "validity",
                          "cause",
                          "tick",
                          "accepted",
                          "limit",
                          "configured",
                          "provisionally_excluded",
                          "suspects",
                          "clipped",
                          "scattering",
                          "not_finite",
                          "grade",
                          "confirmed_grade",
                          "provisional_grade",
                          "consistent_hypotheses",
                          "stations_on_record",
                          "wants_rotation",
                          "recalibration",
                          "mae_all_mps2",
                          "mae_worst_mps2",
                          "mae_worst_limit_mps2",
                          "parity",
                          "parity_limit",
                          "norm_error_mps2",
                          "age_s",
                          "gravity_mps2",
                          "covariance_mps2_2",
                          "latest_mps2",
                          "protection_available",
                          "faults_covered",
                          "alert",
                          "snapshot_refused",
                          "inclination_sigma_deg",
                          "toolface_sigma_deg"}) {
    EXPECT_TRUE(object.contains(key)) << key;
  }
}

TEST(Records, RecalibrationIsAnObjectWhileItGoesOnOrWasRefused) {
  const ArrayFile file = array_of();
  Verdict v = some_verdict();
  EXPECT_TRUE(Json::parse(verdict_json(v, file.array))["recalibration"].is_null());
  v.state = HealthState::recalibrating;
  v.recalibration.phase = RecalibrationPhase::collecting;
  v.recalibration.stations = 5;
  v.recalibration.held_out = 1;
  v.recalibration.stations_wanted = 4;
  v.recalibration.lacking = SensorSet::of(1);
  v.recalibration.wanted_direction = {0.0, 1.0, 0.0};
  const Mat3 turned = {1, 0, 0, 0, 0, -1, 0, 1, 0};
  const Json object = Json::parse(verdict_json(v, file.array, turned))["recalibration"];
  std::string keys;
  for (const auto& item : object.items()) keys += item.key() + " ";
  EXPECT_EQ(keys, "phase offered stations held_out stations_wanted lacking wanted_direction refused ");
  EXPECT_EQ(object["phase"], "collecting");
  EXPECT_EQ(object["stations"], 5);
  EXPECT_EQ(object["held_out"], 1);
  EXPECT_EQ(object["stations_wanted"], 4);
  EXPECT_EQ(object["lacking"], Json({"A2"}));
  EXPECT_EQ(object["wanted_direction"], Json({0.0, 0.0, 1.0})) << "in the output frame";
  EXPECT_TRUE(object["refused"].is_null());
  v.state = HealthState::isolated;
  v.recalibration.last_refusal.code = Errc::not_confirmed;
  EXPECT_EQ(Json::parse(verdict_json(v, file.array))["recalibration"]["refused"], describe(Errc::not_confirmed));
}

TEST(Records, EveryQualifierHasItsName) {
  Verdict v;
  v.qualifiers = 2047;
  const Json object = Json::parse(verdict_json(v, array_of().array));
  EXPECT_EQ(object["qualifiers"], Json({"not_yet_validated", "moving", "initial_calibration", "provisional",
                                        "no_redundancy", "timed_out", "three_sensor_fit", "inhibited",
                                        "standstill_assumed", "stability_unstated", "uncertainty_unstated"}));
}

TEST(Records, RotationAndReferenceAreObjectsInTheOutputFrame) {
  const ArrayFile file = array_of();
  Verdict v = some_verdict();
  const Json plain = Json::parse(verdict_json(v, file.array));
  EXPECT_TRUE(plain["rotation"].is_null());
  EXPECT_TRUE(plain["norm_mismatch"].is_null());
  EXPECT_EQ(plain["sensor_cause"].size(), 4U);
  v.rotation = {true, {0.0, 1.0, 0.0}, 0.5, 0.1};
  v.norm_mismatch.kind = NormMismatchKind::common_bias;
  v.norm_mismatch.attitudes = 7;
  v.norm_mismatch.bias_mps2 = {0.0, 2.0, 0.0};
  v.sensor_cause[2] = Cause::noisy;
  v.drift_mps2_per_h[1] = 0.25F;
  v.noise_factor = 2.5;
  v.noise_correlation = 1.5;
  const Mat3 turned = {1, 0, 0, 0, 0, -1, 0, 1, 0};
  const Json object = Json::parse(verdict_json(v, file.array, turned));
  EXPECT_EQ(object["rotation"]["along"], Json({0.0, 0.0, 1.0}));
  EXPECT_EQ(object["rotation"]["change_mps2"], 0.5);
  EXPECT_EQ(object["norm_mismatch"]["kind"], "common_bias");
  EXPECT_EQ(object["norm_mismatch"]["bias_mps2"], Json({0.0, 0.0, 2.0}));
  EXPECT_TRUE(object["norm_mismatch"]["turn_deg"].is_null());
  EXPECT_EQ(object["sensor_cause"], Json({"none", "none", "noisy", "none"}));
  EXPECT_EQ(object["drift_mps2_per_h"], Json({0.0, 0.25, 0.0, 0.0}));
  EXPECT_EQ(object["noise_factor"], 2.5);
  EXPECT_EQ(object["noise_correlation"], 1.5);
  v.rotation.change_mps2 = 0.0;
  EXPECT_TRUE(Json::parse(verdict_json(v, file.array))["rotation"]["along"].is_null()) << "any turn does";
}

TEST(Records, TriplesUseTemperatureAndConfigurationAreNamed) {
  const ArrayFile file = array_of();
  Verdict v = some_verdict();
  EXPECT_TRUE(Json::parse(verdict_json(v, file.array))["config_hash"].is_null());
  v.triples_tested.add(0);
  v.triples_tested.add(1);
  v.triples_tested.add(3);
  v.triples_passed.add(1);
  v.usable = Usable::vector | Usable::toolface | Usable::reference;
  v.temperature_degc = 81.5;
  v.temperature_rate_degc_per_min = -0.25;
  v.config_hash = 0x0123456789abcdefULL;
  const Json object = Json::parse(verdict_json(v, file.array));
  EXPECT_EQ(object["triples_tested"], 3);
  EXPECT_EQ(object["triples_failing"], Json::parse(R"([["A1","A2","A3"],["A2","A3","A4"]])"));
  EXPECT_EQ(object["usable"], Json({"vector", "toolface", "reference"}));
  EXPECT_EQ(object["temperature_degc"], 81.5);
  EXPECT_EQ(object["temperature_rate_degc_per_min"], -0.25);
  EXPECT_EQ(object["config_hash"], "0123456789abcdef");
}

TEST(Records, NoVectorNoAngles) {
  const Json object = Json::parse(verdict_json(Verdict(), array_of().array));
  EXPECT_TRUE(object["inclination_deg"].is_null());
  EXPECT_TRUE(object["toolface_deg"].is_null());
}

TEST(Records, FrameIsAppliedToVectorCovarianceAndAngles) {
  const Mat3 turned = {1, 0, 0, 0, 0, -1, 0, 1, 0};  // y' = -z, z' = y
  const Json object = Json::parse(verdict_json(some_verdict(), array_of().array, turned));
  EXPECT_EQ(object["gravity_mps2"], Json({0.0, -5.0, -5.0}));
  EXPECT_NEAR(object["inclination_deg"].get<double>(), 135.0, 1e-12);
  EXPECT_EQ(object["covariance_mps2_2"][4], 3.0);
  EXPECT_EQ(object["covariance_mps2_2"][8], 2.0);
  EXPECT_EQ(object["covariance_mps2_2"][2], 0.5);
}

TEST(Records, StringsAreEscaped) {
  std::string out;
  append_json_string(out, "a\"b\\c\n\x01 \xC3\xA9 \xFF \xED\xA0\x80");
  EXPECT_EQ(out, "\"a\\\"b\\\\c\\u000a\\u0001 \xC3\xA9 \\ufffd \\ufffd\\ufffd\\ufffd\"");
  EXPECT_EQ(Json::parse(out).get<std::string>().substr(0, 6), "a\"b\\c\n");
}

}  // namespace
}  // namespace records_test
