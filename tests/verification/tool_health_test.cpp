// The rule of the health report: what makes a station green, orange or red, and when a tool may be surveyed with.
#include "plumb/verification/tool_health.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/io/array_file.hpp"

namespace tool_health_test {
namespace {

using namespace plumb;
using verification::Colour;
using verification::StationHealth;
using verification::StationReason;
using verification::SurveyUse;
using verification::ToolHealth;

constexpr double kG_mps2 = kG0_mps2;
constexpr double kSigma_mps2 = 0.15e-3 * kG0_mps2;
constexpr std::uint16_t kAll = 511;

/// A block at this inclination and toolface with which nothing is wrong.
Verdict good_block(double time_s, double inclination_deg = 30.0, double toolface_deg = 0.0) {
  Verdict v;
  v.time_s = time_s;
  v.tick = v.accepted = true;
  v.state = HealthState::nominal;
  v.validity = Validity::valid;
  v.cause = Cause::passed_block;
  v.statistic = 0.5;
  v.limit = 4.0;
  v.configured = v.in_service = SensorSet::first(4);
  v.reference_mps2 = kG_mps2;
  v.reference_sigma_mps2 = kSigma_mps2;
  v.temperature_degc = 60.0;
  const double i = rad_from_deg(inclination_deg), t = rad_from_deg(toolface_deg);
  v.gravity_mps2 = {-kG_mps2 * std::sin(i) * std::sin(t), -kG_mps2 * std::sin(i) * std::cos(t), kG_mps2 * std::cos(i)};
  v.protection_available = true;
  v.protection_level_calibrated_axes_rad = rad_from_deg(0.1);
  v.alert = false;
  v.usable = kAll;
  return v;
}

Sample at(const Verdict& verdict, std::uint32_t tag = 0) {
  Sample out;
  out.time_s = verdict.time_s;
  out.station = tag;
  out.temperature_degc = verdict.temperature_degc;
  return out;
}

void take(ToolHealth& health, const Verdict& v, std::uint32_t tag = 0, double depth_m = std::nan("")) {
  health.take(at(v, tag), v, depth_m);
}

/// The one station that these blocks make.
StationHealth station_of(std::vector<Verdict> blocks) {
  ToolHealth health(io::kIdentity3, false);
  for (const Verdict& v : blocks) take(health, v, 1);
  EXPECT_EQ(health.stations().size(), 1U);
  return health.stations().back();
}

/// Three about the tool axis, the fourth along it.
SensorArray four_sensors() { return io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml")->array; }

using Reasons = std::vector<StationReason>;

Reasons reasons_of(const Verdict& block) { return verification::reasons_against(station_of({block})); }

/// What the monitor was told to allow for is no reason against a station.
Reasons reasons_beside(const Verdict& block, double acceleration_mps2) {
  ToolHealth health(io::kIdentity3, false, acceleration_mps2);
  take(health, block, 1);
  return verification::reasons_against(health.stations().back());
}

/// With one thing changed.
template <class Change>
Verdict but(Change change) {
  Verdict v = good_block(1.0);
  change(v);
  return v;
}

// Verifies: REQ-179
TEST(ToolHealthRule, GreenIsAStationWithNothingAgainstIt) {
  EXPECT_EQ(reasons_of(good_block(1.0)), Reasons{});
  EXPECT_EQ(verification::colour_of(station_of({good_block(1.0), good_block(2.0)})), Colour::green);
}

// Negative: REQ-179
TEST(ToolHealthRule, EveryThingThatCanBeWrongIsReported) {
  const auto lacking = [](std::uint16_t bit) {
    return but([bit](Verdict& v) { v.usable = static_cast<std::uint16_t>(v.usable & ~bit); });
  };
  const std::vector<std::pair<Verdict, Reasons>> cases = {
      {but([](Verdict& v) { v.state = HealthState::failed; }), {StationReason::failed}},
      {but([](Verdict& v) { v.validity = Validity::invalid; }), {StationReason::no_direction}},
      {but([](Verdict& v) {
         v.validity = Validity::unconfirmed;
         v.statistic = 4.1;
       }),
       {StationReason::alarm, StationReason::unconfirmed}},
      {but([](Verdict& v) { v.norm_mismatch.kind = NormMismatchKind::common_bias; }), {StationReason::common_bias}},
      {lacking(Usable::reference), {StationReason::norm_mismatch}},
      {but([](Verdict& v) { v.validity = Validity::unconfirmed; }), {StationReason::unconfirmed}},
      {but([](Verdict& v) { v.validity = Validity::held; }), {StationReason::unconfirmed}},
      {but([](Verdict& v) { v.validity = Validity::degraded; }), {StationReason::degraded}},
      {but([](Verdict& v) { v.protection_available = false; }), {StationReason::no_bound}},
      {but([](Verdict& v) { v.alert = true; }), {StationReason::wide_bound}},
      {lacking(Usable::temperature), {StationReason::temperature}},
      {lacking(Usable::calibration), {StationReason::calibration}}};
  std::array<int, verification::kStationReasons> seen{};
  for (const auto& [block, reasons] : cases) {
    EXPECT_EQ(reasons_of(block), reasons) << to_string(reasons.front());
    const bool red = reasons.front() <= StationReason::last_red;
    EXPECT_EQ(verification::colour_of(station_of({block})), red ? Colour::red : Colour::orange);
    for (const StationReason reason : reasons) ++seen[static_cast<std::size_t>(reason)];
  }
  for (const StationReason elsewhere : {StationReason::length, StationReason::length_far, StationReason::changed})
    ++seen[static_cast<std::size_t>(elsewhere)];
  for (int k = 0; k < verification::kStationReasons; ++k) EXPECT_GT(seen[static_cast<std::size_t>(k)], 0) << k;
}

// Verifies: REQ-179
TEST(ToolHealthRule, TheLengthIsJudgedByThreeAndBySixSigmas) {
  const auto off_by = [](double sigmas) {
    return but([sigmas](Verdict& v) {
      const double factor = 1.0 + sigmas * kSigma_mps2 / kG_mps2;
      for (double& c : v.gravity_mps2) c *= factor;
    });
  };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(reasons_of(off_by(sign * 2.99)), Reasons{});
    EXPECT_EQ(reasons_of(off_by(sign * 3.01)), Reasons{StationReason::length});
    EXPECT_EQ(reasons_of(off_by(sign * 5.99)), Reasons{StationReason::length});
    EXPECT_EQ(reasons_of(off_by(sign * 6.01)), Reasons{StationReason::length_far});
  }
  EXPECT_EQ(reasons_beside(off_by(7.99), 5.0 * kSigma_mps2), Reasons{});
  EXPECT_EQ(reasons_beside(off_by(-8.01), 5.0 * kSigma_mps2), Reasons{StationReason::length});
  // Noise and calibration count along the vector only, and add in squares to the reference.
  Verdict noisy = off_by(4.0);
  const Vec3 down = scaled(noisy.gravity_mps2, 1.0 / norm(noisy.gravity_mps2));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) noisy.covariance[3 * i + j] = kSigma_mps2 * kSigma_mps2 * down[i] * down[j];
  }
  EXPECT_EQ(reasons_of(noisy), Reasons{});  // 3 sqrt(2) = 4.24
  Verdict across = off_by(4.0);
  across.covariance = {kSigma_mps2 * kSigma_mps2, 0, 0, 0, 0, 0, 0, 0, 0};  // x is level at toolface 0
  EXPECT_EQ(reasons_of(across), Reasons{StationReason::length});
  EXPECT_EQ(reasons_of(but([](Verdict& v) {
              v.gravity_mps2 = {std::nan(""), 0.0, 0.0};
            })),
            (Reasons{StationReason::no_direction, StationReason::length_far}));
}

// Negative: REQ-179
TEST(ToolHealthRule, AStationThatWasInDoubtIsNotGreenHoweverItEnded) {
  Verdict doubt = good_block(1.0);
  doubt.validity = Validity::unconfirmed;
  const StationHealth mended = station_of({doubt, good_block(2.0)});
  EXPECT_EQ(verification::reasons_against(mended), Reasons{StationReason::changed});
  EXPECT_EQ(verification::colour_of(mended), Colour::orange);
  // The other way round its end counts.
  doubt.time_s = 3.0;
  doubt.statistic = 9.0;
  EXPECT_EQ(verification::colour_of(station_of({good_block(2.0), doubt})), Colour::red);
}

TEST(ToolHealthStations, AreTheLogsOrStillStretches) {
  ToolHealth tagged(io::kIdentity3, false);
  take(tagged, good_block(1.0), 1);
  take(tagged, good_block(2.0, 40.0), 1);  // the log says that it is one
  take(tagged, good_block(3.0, 40.0), 2);
  EXPECT_EQ(tagged.stations().size(), 2U);
  EXPECT_EQ(tagged.stations()[1].label, 1);
  EXPECT_EQ(tagged.stations()[0].blocks, 2);

  ToolHealth untagged(io::kIdentity3, false);
  take(untagged, good_block(1.0));
  take(untagged, good_block(2.0, 30.5));
  EXPECT_EQ(untagged.stations().size(), 1U);
  take(untagged, good_block(3.0, 32.0));  // another attitude
  EXPECT_EQ(untagged.stations().size(), 2U);
  Verdict moving = good_block(4.0, 32.0);
  moving.tick = false;
  moving.qualifiers = Qualifier::moving;
  take(untagged, moving);
  take(untagged, good_block(5.0, 32.0));  // the same, after motion
  EXPECT_EQ(untagged.stations().size(), 3U);

  ToolHealth rows(io::kIdentity3, true);
  take(rows, good_block(1.0));
  take(rows, good_block(2.0));
  EXPECT_EQ(rows.stations().size(), 2U);
}

TEST(ToolHealthStations, KeepDepthAndDirectionOfTheirLastBlock) {
  ToolHealth health(io::kIdentity3, false);
  take(health, good_block(1.0, 30.0, 90.0), 1, 1000.0);
  take(health, good_block(2.0, 31.0, 90.0), 1);  // the last depth that was known
  take(health, good_block(3.0, 1.0, 0.0), 2, 1030.0);
  const StationHealth& first = health.stations()[0];
  EXPECT_EQ(first.depth_m, 1000.0);
  EXPECT_NEAR(deg_from_rad(first.tilt.inclination_rad), 31.0, 1e-9);
  EXPECT_NEAR(deg_from_rad(first.tilt.toolface_rad), 90.0, 1e-9);
  EXPECT_EQ(first.begin_s, 1.0);
  EXPECT_EQ(first.end_s, 2.0);
  EXPECT_EQ(health.stations()[1].depth_m, 1030.0);
  EXPECT_FALSE(health.stations()[1].tilt.toolface_valid);
}

TEST(ToolHealthStations, MemoryIsOfStationsAndEventsNotOfSamples) {
  ToolHealth health(io::kIdentity3, false);
  Verdict v = good_block(0.0);
  for (int k = 0; k < 200000; ++k) {
    v.time_s = 0.01 * k;
    v.tick = k % 32 == 0;
    take(health, v, 1);
  }
  EXPECT_EQ(health.stations().size(), 1U);
  EXPECT_EQ(health.events().size(), 0U);
  EXPECT_EQ(health.extremes().samples, 200000U);
  EXPECT_EQ(health.extremes().blocks, 6250U);
}

/// A run of these blocks, a station each.
ToolHealth run_of(const std::vector<Verdict>& blocks) {
  ToolHealth health(io::kIdentity3, true);
  for (const Verdict& v : blocks) take(health, v);
  return health;
}

// Verifies: REQ-179
TEST(ToolHealthAnswer, IsThatOfTheLastStation) {
  Verdict degraded = good_block(2.0), alarm = good_block(2.0);
  degraded.validity = Validity::degraded;
  degraded.state = HealthState::degraded_3_sensor;
  alarm.validity = Validity::unconfirmed;
  alarm.state = HealthState::suspect;
  alarm.statistic = 9.0;
  EXPECT_EQ(run_of({good_block(1.0)}).use(), SurveyUse::yes);
  EXPECT_EQ(run_of({good_block(1.0), degraded}).use(), SurveyUse::orientation_only);
  EXPECT_EQ(run_of({good_block(1.0), alarm}).use(), SurveyUse::no);
  Verdict isolated = good_block(3.0);
  isolated.state = HealthState::isolated;
  const ToolHealth mended = run_of({good_block(1.0), alarm, isolated});
  EXPECT_EQ(mended.use(), SurveyUse::yes);
  EXPECT_EQ(mended.count(Colour::red), 1);
  EXPECT_EQ(mended.count(Colour::green), 2);
  EXPECT_EQ(mended.actions(four_sensors()), (std::vector<std::string>{"Do not use the red stations: 2.", "Continue."}));
}

// Negative: REQ-179
TEST(ToolHealthAnswer, IsNoWithoutAStationOrAfterTheMonitorGaveUp) {
  EXPECT_EQ(run_of({}).use(), SurveyUse::no);
  EXPECT_NE(run_of({}).sentence().find("no stretch at rest"), std::string::npos);
  Verdict failed = good_block(2.0);
  failed.tick = false;  // between two stations
  failed.state = HealthState::failed;
  failed.validity = Validity::invalid;
  EXPECT_EQ(run_of({good_block(1.0), failed}).use(), SurveyUse::no);
  EXPECT_NE(run_of({good_block(1.0), failed}).actions(four_sensors()).front().find("Do not survey"), std::string::npos);
  Verdict doubt = good_block(2.0);
  doubt.tick = false;
  doubt.state = HealthState::suspect;
  doubt.validity = Validity::held;
  EXPECT_EQ(run_of({good_block(1.0), doubt}).use(), SurveyUse::orientation_only);
}

/// Not yet validated at these inclinations and toolfaces, in deg.
std::string advised(const std::vector<std::pair<double, double>>& attitudes) {
  std::vector<Verdict> blocks;
  for (const auto& [inclination_deg, toolface_deg] : attitudes) {
    blocks.push_back(good_block(1.0 + static_cast<double>(blocks.size()), inclination_deg, toolface_deg));
    blocks.back().state = HealthState::suspect;
    blocks.back().validity = Validity::unconfirmed;
    blocks.back().qualifiers = Qualifier::not_yet_validated;
  }
  std::string out;
  for (const std::string& one : run_of(blocks).actions(four_sensors())) out += one + "\n";
  return out;
}

TEST(ToolHealthAnswer, ATangentSectionIsNotSentToAnotherToolface) {
  const std::string tangent = advised({{60.0, 0.0}, {60.0, 120.0}, {60.0, 240.0}});
  EXPECT_EQ(tangent.find("toolface and re-shoot"), std::string::npos) << tangent;
  EXPECT_NE(tangent.find("another inclination, 2 deg or more away from 60.0 deg: the reading of a4"), std::string::npos)
      << tangent;
  EXPECT_NE(tangent.find("--roll-test roll.csv"), std::string::npos) << tangent;
  const std::string held = advised({{60.0, 0.0}, {60.0, 0.0}});
  EXPECT_NE(held.find("Roll the tool to another toolface and re-shoot: validation needs a change of the reading of a1, "
                      "a2, a3"),
            std::string::npos)
      << held;
  EXPECT_NE(held.find("the reading of a4"), std::string::npos) << held;
  const std::string upright = advised({{0.5, 0.0}, {0.5, 180.0}});
  EXPECT_EQ(upright.find("another toolface and re-shoot"), std::string::npos) << upright;
  EXPECT_NE(upright.find("the reading of a1, a2, a3, a4"), std::string::npos) << upright;
  const std::string moved = advised({{20.0, 0.0}, {60.0, 120.0}, {60.0, 240.0}});
  EXPECT_EQ(moved.find("inclination"), std::string::npos) << moved;
  EXPECT_NE(moved.find("hold the tool still"), std::string::npos) << moved;
}

/// The turn that the monitor asks for says whether a roll can isolate the sensor.
TEST(ToolHealthAnswer, AnAlarmAlongTheAxisAsksForAnotherInclination) {
  const auto answer = [](const Vec3& along, double change_mps2) {
    Verdict alarm = good_block(1.0, 60.0);
    alarm.validity = Validity::unconfirmed;
    alarm.state = HealthState::suspect;
    alarm.statistic = 9.0;
    alarm.rotation.wanted = true;
    alarm.rotation.along = along;
    alarm.rotation.change_mps2 = change_mps2;
    return run_of({alarm}).actions(four_sensors()).front();
  };
  EXPECT_NE(answer({1.0, 0.0, 0.0}, 1.0).find("Roll the tool"), std::string::npos);
  EXPECT_NE(answer({0.0, 0.0, 1.0}, 1.0).find("another inclination"), std::string::npos);
  EXPECT_NE(answer({1.0, 0.0, 0.0}, 18.0).find("another inclination"), std::string::npos);
  EXPECT_NE(answer({1.0, 0.0, 0.0}, 30.0).find("too small for any turn"), std::string::npos);
}

TEST(ToolHealthStations, AFailedToolUsesNoSensor) {
  Verdict failed = good_block(1.0);
  failed.state = HealthState::failed;
  EXPECT_TRUE(station_of({failed}).used.empty());
  EXPECT_EQ(station_of({good_block(1.0)}).used, SensorSet::first(4));
}

TEST(ToolHealthAnswer, EveryReasonHasWordsAndSomethingToDo) {
  for (int k = 0; k < verification::kStationReasons; ++k) {
    const auto reason = static_cast<StationReason>(k);
    EXPECT_STRNE(to_string(reason), "?");
    EXPECT_STRNE(explain(reason), "?");
  }
}

TEST(ToolHealthExtremes, CountAndKeepTheWorst) {
  ToolHealth health(io::kIdentity3, true);
  Verdict v = good_block(1.0);
  v.clipped = SensorSet::of(2);
  take(health, v);
  v = good_block(2.0);
  v.statistic = 6.0;
  v.temperature_degc = 150.0;
  v.temperature_rate_degc_per_min = -7.0;
  v.accepted = false;
  take(health, v);
  const verification::RunExtremes& e = health.extremes();
  EXPECT_EQ(e.clipped[2], 1U);
  EXPECT_EQ(e.clipped[1], 0U);
  EXPECT_EQ(e.ratio, 1.5);
  EXPECT_EQ(e.ratio_at_s, 2.0);
  EXPECT_EQ(e.temperature_min_degc, 60.0);
  EXPECT_EQ(e.temperature_max_degc, 150.0);
  EXPECT_EQ(e.temperature_rate_degc_per_min, 7.0);
  EXPECT_EQ(e.refused, 1U);
}

}  // namespace
}  // namespace tool_health_test
