// What each kind of fault beyond those of scenario_test.cpp does to a channel or to the whole log.
#include <gtest/gtest.h>

#include <cmath>

#include "plumb/scenario/fault_text.hpp"
#include "plumb/scenario/injector.hpp"
#include "plumb/scenario/library.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
namespace scenario {
namespace channel_faults_test {
namespace {

constexpr double kScale = kPaperScale_VpMps2;

FaultContext volts() {
  FaultContext context;
  context.datasheet = paper_datasheet();
  return context;
}

/// Twenty seconds of the paper's tool at one attitude that every sensor reads differently, without noise or steps.
Scenario still(const char* fault, const char* second = nullptr) {
  Scenario scenario;
  scenario.tool = perfect_tool(paper_datasheet());
  scenario.attitudes = FixedAttitude{gravity_direction({0.7, 0.0, 0.4})};
  scenario.dwell_s = 20.0;
  scenario.noise.white = 0.0;
  scenario.noise.quantise = false;
  for (const char* text : {fault, second}) {
    if (text == nullptr) continue;
    const auto parsed = parse_fault(text, volts());
    EXPECT_TRUE(parsed) << parsed.error();
    if (parsed) scenario.faults.push_back(*parsed);
  }
  return scenario;
}

Simulator play(const Scenario& scenario) {
  auto simulator = Simulator::make(scenario);
  EXPECT_TRUE(simulator) << simulator.error();
  return *simulator;
}

/// Value of a2 at rows 0 and on, as acceleration.
double mps2(const Simulator& run, std::uint64_t row, int sensor = 1) {
  return run.at(row).raw[static_cast<std::size_t>(sensor)] / kScale;
}

TEST(ChannelFault, NoiseHasItsRmsAndLeavesTheMean) {
  const Simulator run = play(still("a2:noise=10mg0@0s"));
  const double whole = mps2(play(still("a1:noise=10mg0@0s")), 0);
  double sum = 0.0, square = 0.0;
  for (std::uint64_t row = 0; row < run.size(); ++row) {
    const double error = (mps2(run, row) - whole) / (0.01 * kG0_mps2);
    sum += error;
    square += error * error;
  }
  const auto n = static_cast<double>(run.size());
  EXPECT_NEAR(sum / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(square / n, 1.0, 5.0 * std::sqrt(2.0 / n));
}

TEST(ChannelFault, SpikesHaveTheirSizeAndTheirRate) {
  const Simulator run = play(still("a2:spikes=0.1g0*5%@0s"));
  const double whole = mps2(play(still("a1:noise=10mg0@0s")), 0);
  int up = 0, down = 0;
  for (std::uint64_t row = 0; row < run.size(); ++row) {
    const double error = mps2(run, row) - whole;
    if (std::abs(error) < 1e-9) continue;
    EXPECT_NEAR(std::abs(error), 0.1 * kG0_mps2, 1e-9);
    ++(error > 0.0 ? up : down);
  }
  EXPECT_NEAR((up + down) / 2000.0, 0.05, 5.0 * std::sqrt(0.05 * 0.95 / 2000.0));
  EXPECT_GT(up, 20);
  EXPECT_GT(down, 20);
}

TEST(ChannelFault, ChatterComesAndGoesAndWarmUpFadesAway) {
  const Simulator chatter = play(still("a2:chatter=50mg0*2s@4s"));
  const Simulator warm = play(still("a2:warmup=2mg0*3s@4s"));
  const double whole = mps2(chatter, 0);
  for (std::uint64_t row = 0; row < chatter.size(); ++row) {
    const double since_s = 0.01 * (static_cast<double>(row) - 400.0);
    if (row % 200 == 0) continue;  // on the edge, rounding decides
    const bool there = row >= 400 && (row - 400) / 200 % 2 == 0;
    EXPECT_NEAR(mps2(chatter, row) - whole, there ? 0.05 * kG0_mps2 : 0.0, 1e-9) << row;
    const double left = row >= 400 ? 0.002 * kG0_mps2 * std::exp(-since_s / 3.0) : 0.0;
    EXPECT_NEAR(mps2(warm, row) - whole, left, 1e-9) << row;
  }
}

TEST(ChannelFault, ClippedCoarseAndInvertedBits) {
  const double whole = mps2(play(still("a1:noise=10mg0@0s")), 0);
  EXPECT_DOUBLE_EQ(play(still("a2:clip=-5V..0.1V@0s")).at(5).raw[1], std::min(0.1, whole * kScale));
  EXPECT_DOUBLE_EQ(play(still("a2:clip=2V..5V@0s")).at(5).raw[1], 2.0);
  const double coarse = play(still("a2:coarse=0.25V@0s")).at(5).raw[1];
  EXPECT_NEAR(coarse, whole * kScale, 0.125);
  EXPECT_EQ(std::fmod(coarse, 0.25), 0.0);
  const double flipped = play(still("a2:bit=10@0s")).at(5).raw[1];
  EXPECT_NEAR(std::abs(flipped - whole * kScale), 1024.0 * kPaperResolution_V, kPaperResolution_V);
  const Scenario twice = still("a2:bit=10@0s", "a2:bit=10@0s");
  EXPECT_NEAR(play(twice).at(5).raw[1], whole * kScale, kPaperResolution_V);
}

TEST(ChannelFault, PatternsAreDeliveredAsTheyAre) {
  for (int k = 0; k < kBitPatterns; ++k) {
    const auto pattern = static_cast<BitPattern>(k);
    const std::string text = std::string("a2:pattern=") + to_string(pattern) + "@0s";
    const double raw = play(still(text.c_str())).at(3).raw[1];
    const double expected = value_of(pattern);
    EXPECT_TRUE(raw == expected || (std::isnan(raw) && std::isnan(expected))) << text;
    EXPECT_EQ(std::signbit(raw), std::signbit(expected)) << text;
  }
}

TEST(ChannelFault, MissingIsNotDelivered) {
  const Simulator off = play(still("a2:missing@5s"));
  EXPECT_TRUE(off.at(499).delivered.has(1));
  EXPECT_FALSE(off.at(500).delivered.has(1));
  const Simulator half = play(still("a2:missing=50%@0s"));
  int there = 0;
  for (std::uint64_t row = 0; row < half.size(); ++row) there += half.at(row).delivered.has(1) ? 1 : 0;
  EXPECT_NEAR(there / 2000.0, 0.5, 5.0 * 0.5 / std::sqrt(2000.0));
}

/// The channel shows what it should have shown earlier; alike in a simulation and in a log row by row.
TEST(ChannelFault, LateAndSlowShowOlderRows) {
  Scenario moving = drilling_run(paper_tool(1), 3);
  const Simulator whole = play(moving);
  for (const bool slow : {false, true}) {
    moving.faults = {*parse_fault(slow ? "a2:slow=10@#40" : "a2:late=7@#40", volts())};
    const Simulator run = play(moving);
    const Datasheet sheet = paper_datasheet();
    auto injector = Injector::make(sheet, moving.tool.model, moving.faults, moving.seed);
    ASSERT_TRUE(injector);
    for (std::uint64_t row = 0; row < 400; ++row) {
      const std::uint64_t source = row < 39 ? row : (slow ? row - row % 10 : row - 7);
      EXPECT_EQ(run.at(row).raw[1], whole.at(source).raw[1]) << row;
      Sample sample = whole.at(row);
      injector->apply(sample);
      EXPECT_EQ(sample.raw[1], run.at(row).raw[1]) << row;
      EXPECT_EQ(sample.raw[0], whole.at(row).raw[0]) << row;
    }
  }
}

TEST(ChannelFault, ExchangedAndCrossTalkingChannels) {
  const Simulator whole = play(still("a4:noise=10mg0@1000s"));
  const Simulator swapped = play(still("a2:exchange=a3@0s"));
  Truth truth;
  const Sample sample = swapped.at(5, &truth);
  EXPECT_EQ(truth.faulty, SensorSet::of(1).with(2));
  EXPECT_EQ(sample.raw[1], whole.at(5).raw[2]);
  EXPECT_EQ(sample.raw[2], whole.at(5).raw[1]);
  EXPECT_NEAR(mps2(play(still("a2:cross=a4*5%@0s")), 5), mps2(whole, 5) + 0.05 * mps2(whole, 5, 3), 1e-12);
}

/// Turned axis, turned gravity, mirrored gravity: against the vectors themselves, in both senses of counting.
TEST(ChannelFault, FaultsOfDirectionAreWhatTheySay) {
  for (const Reads reads : {Reads::gravity, Reads::specific_force}) {
    Scenario scenario = still("a2:turned=3deg*40deg@0s");
    scenario.tool.model.reads = scenario.tool.datasheet.reads = reads;
    const Vec3 g = scaled(gravity_direction({0.7, 0.0, 0.4}), kG0_mps2);
    const double sense = reads == Reads::gravity ? 1.0 : -1.0;
    const Vec3 axis = scenario.tool.axes[1];
    const double shown = sense * mps2(play(scenario), 5);
    EXPECT_GT(std::abs(shown - dot(axis, g)), 1e-3);
    EXPECT_LE(std::abs(shown - dot(axis, g)), 2.0 * std::sin(rad_from_deg(1.5)) * kG0_mps2);

    scenario.faults = {*parse_fault("a2:ghost=5deg*90deg@0s", volts())};
    const double s = std::sin(rad_from_deg(5.0)), c = std::cos(rad_from_deg(5.0));
    const Vec3 about_y = {c * g[0] - s * g[2], g[1], s * g[0] + c * g[2]};
    EXPECT_NEAR(sense * mps2(play(scenario), 5), dot(axis, about_y), 1e-9);

    scenario.faults = {*parse_fault("a2:mirror=a1*a4@0s", volts())};
    const Vec3 across = cross(scenario.tool.axes[0], scenario.tool.axes[3]);
    const Vec3 mirrored = minus(g, scaled(across, 2.0 * dot(g, across) / dot(across, across)));
    EXPECT_NEAR(sense * mps2(play(scenario), 5), dot(axis, mirrored), 1e-9);
  }
}

TEST(WholeLogFault, GravityShakeAndTemperature) {
  const Simulator whole = play(still("a4:noise=10mg0@1000s"));
  const Simulator longer = play(still("log:gravity=3mg0@0s"));
  const Simulator shaking = play(still("log:shake=0.2g0@0s"));
  const Simulator hot = play(still("log:temperature=20degC@10s"));
  EXPECT_EQ(hot.at(999).temperature_degc, 25.0);
  EXPECT_EQ(hot.at(1000).temperature_degc, 45.0);
  Vec3 square{};
  for (std::uint64_t row = 0; row < whole.size(); ++row) {
    Truth truth;
    const Sample sample = shaking.at(row, &truth);
    EXPECT_TRUE(truth.faulty.empty());
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(longer.at(row).raw[i], whole.at(row).raw[i] * 1.003, 1e-9);
    }
    // The tetrahedron's first three axes give the vibration back; here the sum of squares over all four is enough.
    for (std::size_t i = 0; i < 3; ++i) square[i] += std::pow((sample.raw[i] - whole.at(row).raw[i]) / kScale, 2);
  }
  for (const double s : square) EXPECT_NEAR(std::sqrt(s / 2000.0) / (0.2 * kG0_mps2), 1.0, 5.0 / std::sqrt(4000.0));
}

TEST(Surroundings, DepthChangesGravityAndHeat) {
  Scenario scenario = still("a4:noise=10mg0@1000s");
  scenario.attitudes = RandomStations{5};
  scenario.depth = {28.0, 8.4e-7, 0.03};
  const Simulator run = play(scenario);
  Truth truth;
  const Sample sample = run.at(run.size() - 1, &truth);
  EXPECT_DOUBLE_EQ(truth.depth_m, 4 * 28.0);
  EXPECT_NEAR(norm(truth.gravity_mps2), kG0_mps2 + 4 * 28.0 * 8.4e-7, 1e-12);
  EXPECT_NEAR(sample.temperature_degc, 25.0 + 4 * 28.0 * 0.03, 1e-12);
  run.at(0, &truth);
  EXPECT_EQ(truth.depth_m, 0.0);
}

/// The tool turns about an axis of its own: gravity goes round in its frame, sensors off the axis feel the turn, and
/// what the monitor takes off with known lever arms is just that.
TEST(Surroundings, TurningMovesGravityAndIsFeltThroughLeverArms) {
  Scenario scenario = still("a4:noise=10mg0@1000s");
  scenario.turning = {2.0, {0.0, 0.0, 1.0}, 5.0, 10.0};
  for (std::size_t i = 0; i < 4; ++i) scenario.tool.lever_arm_m[i] = {0.01 * static_cast<double>(i), 0.02, 0.3};
  const Simulator run = play(scenario);
  Truth before, during, after;
  run.at(499, &before);
  const Sample sample = run.at(600, &during);
  run.at(1500, &after);
  EXPECT_EQ(before.rate_radps, (Vec3{}));
  EXPECT_EQ(during.rate_radps, (Vec3{0.0, 0.0, 2.0}));
  EXPECT_NEAR(angle_between_rad(before.gravity_mps2, during.gravity_mps2),
              angle_between_rad(before.gravity_mps2, seen_from_turned(before.gravity_mps2, {0, 0, 1}, 2.0)), 1e-12);
  EXPECT_NEAR(norm(minus(after.gravity_mps2, seen_from_turned(before.gravity_mps2, {0, 0, 1}, 10.0))), 0.0, 1e-9);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 w = during.rate_radps;
    const Vec3 axis = scenario.tool.axes[i];
    const double with_turn_taken_off =
        sample.raw[i] / kScale + dot(axis, cross(w, cross(w, scenario.tool.lever_arm_m[i])));
    EXPECT_NEAR(with_turn_taken_off, dot(axis, during.gravity_mps2), 1e-9) << i;
  }
}

TEST(Surroundings, TurningAQuarterAboutZTakesXToMinusY) {
  // A tool that turns by +90 deg about its z sees what stood along its x along -y.
  const Vec3 seen = seen_from_turned({1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.5 * kPi);
  EXPECT_NEAR(seen[0], 0.0, 1e-15);
  EXPECT_NEAR(seen[1], -1.0, 1e-15);
}

TEST(Surroundings, VibrationAtRestAndWanderOfTheBiasAreThere) {
  Scenario scenario = still("a4:noise=10mg0@1000s");
  scenario.rest_vibration_mps2 = 0.1;
  Truth truth;
  play(scenario).at(7, &truth);
  EXPECT_GT(norm(truth.body_acceleration_mps2), 0.0);
  scenario.rest_vibration_mps2 = 0.0;
  scenario.noise.instability.sigma_mps2 = 0.01;
  scenario.noise.instability.correlation_s = 5.0;
  const Simulator run = play(scenario);
  const Instability wander(scenario.noise.instability, 2100, 0.01, scenario.seed, 1);
  const double whole = mps2(play(still("a4:noise=10mg0@1000s")), 0);
  for (const std::uint64_t row : {0U, 77U, 1999U}) EXPECT_NEAR(mps2(run, row) - whole, wander.at(row), 1e-12) << row;
}

TEST(Surroundings, WhatCannotBePlayedIsRefused) {
  const auto refused = [](auto change) {
    Scenario scenario = still("a4:noise=10mg0@1000s");
    change(scenario);
    const auto simulator = Simulator::make(scenario);
    return !simulator && simulator.error().find("Remedy: ") != std::string::npos;
  };
  EXPECT_TRUE(refused([](Scenario& s) { s.rest_vibration_mps2 = -1.0; }));
  EXPECT_TRUE(refused([](Scenario& s) { s.noise.instability.sigma_mps2 = -1.0; }));
  EXPECT_TRUE(refused([](Scenario& s) { s.noise.instability.correlation_s = 0.0; }));
  EXPECT_TRUE(refused([](Scenario& s) { s.turning.axis = {0.0, 0.0, 2.0}; }));
  EXPECT_TRUE(refused([](Scenario& s) { s.turning.until_s = -1.0; }));
  EXPECT_TRUE(refused([](Scenario& s) { s.turning.rate_radps = std::nan(""); }));
  EXPECT_TRUE(refused([](Scenario& s) { s.depth.station_spacing_m = std::nan(""); }));
  EXPECT_TRUE(refused([](Scenario& s) { s.tool.lever_arm_m[1][2] = 1e9; }));
}

}  // namespace
}  // namespace channel_faults_test
}  // namespace scenario
}  // namespace plumb
