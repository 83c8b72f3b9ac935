#include "plumb/scenario/scenario.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "plumb/scenario/library.hpp"

namespace plumb {
namespace scenario {
namespace scenario_test {
namespace {

bool same(const Sample& a, const Sample& b) {
  return a.time_s == b.time_s && std::memcmp(a.raw.data(), b.raw.data(), sizeof a.raw) == 0 &&
         a.delivered == b.delivered && a.temperature_degc == b.temperature_degc && a.station == b.station &&
         a.count == b.count;
}

Simulator simulator(const Scenario& scenario) {
  auto made = Simulator::make(scenario);
  EXPECT_TRUE(made) << (made ? "" : made.error());
  return *made;
}

Fault make(FaultKind kind, int sensor, double onset, double magnitude, double upper = 0.0) {
  Fault fault;
  fault.kind = kind;
  fault.sensor = sensor;
  fault.onset = onset;
  fault.magnitude = magnitude;
  fault.upper = upper;
  return fault;
}

/// One of each kind, some on the same sensor, some ending.
std::vector<Fault> many_faults() {
  Fault dither = make(FaultKind::stuck_last, 0, 9.0, 1e-4);
  dither.duration = 4.0;
  return {make(FaultKind::bias_step, 0, 5.0, 0.3),           dither,
          make(FaultKind::stuck_last, 1, 7.005, 0.0),        make(FaultKind::random_range, 2, 6.0, -3.0, 3.0),
          make(FaultKind::scale_change, 2, 3.0, 1.1),        make(FaultKind::drift, 3, 2.5, 0.02),
          make(FaultKind::random_level, 3, 20.0, -3.0, 3.0), make(FaultKind::stuck_last, 3, 22.0, 0.0)};
}

// Verifies: REQ-180
TEST(Simulator, SameScenarioSameBits) {
  const Scenario scenario = drilling_run(paper_tool(5), 5, many_faults());
  Simulator one = simulator(scenario);
  Simulator two = simulator(scenario);
  Sample a;
  Sample b;
  std::uint64_t rows = 0;
  while (one.next(a)) {
    ASSERT_TRUE(two.next(b));
    ASSERT_TRUE(same(a, b)) << rows;
    ++rows;
  }
  EXPECT_EQ(rows, one.size());
  EXPECT_FALSE(one.next(a)) << "stays at the end";
  one.rewind();
  ASSERT_TRUE(one.next(a));
  EXPECT_TRUE(same(a, two.at(0)));
}

// Verifies: REQ-180
TEST(Simulator, EverySampleIsAFunctionOfItsRow) {
  const Simulator run = simulator(drilling_run(paper_tool(5), 5, many_faults()));
  std::vector<Sample> forward;
  for (std::uint64_t row = 0; row < run.size(); ++row) forward.push_back(run.at(row));
  const Simulator again = simulator(drilling_run(paper_tool(5), 5, many_faults()));
  for (std::uint64_t row = run.size(); row-- > 0;) {
    ASSERT_TRUE(same(again.at(row), forward[static_cast<std::size_t>(row)])) << row;
  }
}

TEST(Simulator, FaultsInASimulationAreThoseInjectedIntoItsLog) {
  const Scenario faulty = drilling_run(paper_tool(5), 5, many_faults());
  Scenario healthy = faulty;
  healthy.faults.clear();
  Simulator broken = simulator(faulty);
  Simulator whole = simulator(healthy);
  Injector injector = *Injector::make(faulty.tool.datasheet, faulty.tool.model, many_faults(), faulty.seed);
  Sample a;
  Sample b;
  while (broken.next(a)) {
    ASSERT_TRUE(whole.next(b));
    EXPECT_EQ(injector.apply(b), broken.truth().faulty);
    ASSERT_TRUE(same(a, b)) << a.time_s;
  }
}

// Negative: REQ-180
TEST(Simulator, SeedsGiveDifferentRunsAndFaultsDoNotDisturbTheRest) {
  const Tool tool = paper_tool(1);
  Simulator one = simulator(drilling_run(tool, 1));
  Simulator other = simulator(drilling_run(tool, 2));
  Simulator broken = simulator(drilling_run(tool, 1, {dead_at_station(1, 1)}));
  EXPECT_FALSE(same(one.at(0), other.at(0)));
  for (std::uint64_t row = 0; row < one.size(); row += 7) {
    const Sample a = one.at(row);
    const Sample b = broken.at(row);
    for (const std::size_t i : {0U, 2U, 3U}) EXPECT_EQ(a.raw[i], b.raw[i]);
    EXPECT_EQ(b.raw[1], 0.0);
  }
}

TEST(Simulator, StationsOfOneInclinationGetARollGroup) {
  Scenario scenario = drilling_run(paper_tool(5), 5);
  std::vector<Vec3> directions;
  for (const double inclination_deg : {45.0, 0.0, 45.0, 90.0, 90.0, 10.0}) {
    const double toolface_rad = 0.7 * static_cast<double>(directions.size());
    directions.push_back(gravity_direction({rad_from_deg(inclination_deg), 0.0, toolface_rad}));
  }
  scenario.attitudes = DirectionList{directions};
  scenario.tag_stations = true;
  const std::uint32_t groups[] = {1, 0, 1, 2, 2, 0};
  for (const bool tagged : {true, false}) {
    scenario.tag_rolls = tagged;
    Simulator run = simulator(scenario);
    Sample sample;
    while (run.next(sample)) {
      const std::uint32_t expected = tagged && !run.truth().moving ? groups[run.truth().station - 1] : 0U;
      ASSERT_EQ(sample.roll_group, expected) << sample.time_s;
    }
  }
}

TEST(Simulator, WithoutNoiseItIsTheSensorModelOfHg) {
  Scenario scenario = drilling_run(paper_tool(9), 9);
  scenario.noise = {0.0, false, false};
  scenario.vibration_mps2 = 0.0;
  scenario.gravity_mps2 = 9.81;
  scenario.temperature = {20.0, 0.5};
  for (SensorCoefficients& sensor : scenario.tool.model.sensor) {
    sensor.scale[1] = 1e-5;
    sensor.bias[2] = 1e-4;
  }
  Simulator run = simulator(scenario);
  Sample sample;
  while (run.next(sample)) {
    Readings along{};
    for (std::size_t i = 0; i < 4; ++i) along[i] = dot(scenario.tool.axes[i], run.truth().gravity_mps2);
    const auto raw = scenario.tool.model.raw_from(along, sample.temperature_degc);
    ASSERT_TRUE(raw);
    for (std::size_t i = 0; i < 4; ++i) ASSERT_EQ(sample.raw[i], (*raw)[i]);
    ASSERT_NEAR(norm(run.truth().gravity_mps2), 9.81, 1e-13);
    ASSERT_NEAR(sample.temperature_degc, 20.0 + 0.5 * sample.time_s, 1e-12);
  }
}

TEST(Simulator, NoiseHasTheDatasheetSigma) {
  Scenario scenario;
  scenario.tool = perfect_tool(paper_datasheet());
  scenario.dwell_s = 200.0;
  scenario.noise.quantise = false;
  scenario.attitudes = FixedAttitude{{0.0, 1.0, 0.0}};
  Simulator run = simulator(scenario);
  ASSERT_EQ(run.size(), 20000U);
  Sample sample;
  std::array<double, 4> square{};
  while (run.next(sample)) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double error = sample.raw[i] / kPaperScale_VpMps2 - dot(scenario.tool.axes[i], {0.0, kG0_mps2, 0.0});
      square[i] += error * error;
    }
  }
  for (const double s : square) {
    EXPECT_NEAR(std::sqrt(s / 20000.0) / kPaperNoise_mps2, 1.0, 4.0 / std::sqrt(40000.0));
  }
}

TEST(Simulator, EveryKindOfFaultAtOnsetBeforeAndAfter) {
  Scenario scenario;
  scenario.tool = perfect_tool(paper_datasheet());
  scenario.dwell_s = 10.0;
  scenario.noise.quantise = false;
  const Simulator healthy = simulator(scenario);
  for (int kind = 0; kind <= static_cast<int>(FaultKind::scale_change); ++kind) {
    Fault fault = make(static_cast<FaultKind>(kind), 2, 4.0, 0.5, 0.75);
    fault.duration = 3.0;
    scenario.faults = {fault};
    const Simulator broken = simulator(scenario);
    for (std::uint64_t row = 0; row < healthy.size(); ++row) {
      Truth truth;
      const double raw = broken.at(row, &truth).raw[2];
      const double whole = healthy.at(row).raw[2];
      const bool in_fault = row >= 400 && row < 700;
      ASSERT_EQ(truth.faulty.has(2), in_fault) << to_string(fault.kind) << " at row " << row;
      if (!in_fault) {
        ASSERT_EQ(raw, whole) << to_string(fault.kind) << " at row " << row;
        continue;
      }
      const double passed_s = 0.01 * static_cast<double>(row - 400);
      switch (fault.kind) {
        case FaultKind::stuck_level: ASSERT_EQ(raw, 0.5); break;
        case FaultKind::stuck_last: ASSERT_NEAR(raw, healthy.at(399).raw[2], 0.5); break;
        case FaultKind::random_range: ASSERT_TRUE(raw >= 0.5 && raw <= 0.75 && raw != broken.at(row + 1).raw[2]); break;
        case FaultKind::random_level: ASSERT_TRUE(raw >= 0.5 && raw <= 0.75 && raw == broken.at(400).raw[2]); break;
        case FaultKind::bias_step: ASSERT_NEAR(raw, whole + 0.5 * kPaperScale_VpMps2, 1e-12); break;
        case FaultKind::drift: ASSERT_NEAR(raw, whole + 0.5 * passed_s * kPaperScale_VpMps2, 1e-12); break;
        case FaultKind::scale_change: ASSERT_NEAR(raw, 0.5 * whole, 1e-12); break;
        default: FAIL() << "channel_faults_test.cpp has the others";
      }
    }
  }
}

TEST(Simulator, FullScaleFaultReadsFullScale) {
  const Simulator run = simulator(drilling_run(paper_tool(1), 1, {make(FaultKind::stuck_level, 0, 1.0, -5.0)}));
  EXPECT_EQ(run.at(200).raw[0], -kPaperFullScale_V);
}

TEST(Simulator, UnrecordedMotionLeavesGapsInTime) {
  Scenario scenario = calibration_run(paper_tool(1), 1, 3);
  scenario.start_s = 100.0;
  Simulator run = simulator(scenario);
  EXPECT_EQ(run.size(), 600U);
  EXPECT_DOUBLE_EQ(run.at(199).time_s, 101.99);
  EXPECT_DOUBLE_EQ(run.at(200).time_s, 103.0);
  EXPECT_EQ(run.at(199).station, 1U);
  EXPECT_EQ(run.at(200).station, 2U);
  EXPECT_NEAR(run.duration_s(), 7.99, 1e-12);
}

TEST(Simulator, BadScenariosAreRefusedWithARemedy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Scenario good = drilling_run(paper_tool(1), 1);
  std::vector<Scenario> bad;
  const auto add = [&](auto change) {
    bad.push_back(good);
    change(bad.back());
  };
  add([](Scenario& s) { s.tool = Tool{}; });
  add([](Scenario& s) { s.tool.model.size = 3; });
  add([&](Scenario& s) { s.rate_hz = nan; });
  add([](Scenario& s) { s.rate_hz = 0.0; });
  add([](Scenario& s) { s.dwell_s = -1.0; });
  add([](Scenario& s) { s.dwell_s = 0.0; });
  add([&](Scenario& s) { s.move_s = nan; });
  add([](Scenario& s) { s.rate_hz = 1e9, s.dwell_s = 1e9; });
  add([](Scenario& s) { s.gravity_mps2 = -1.0; });
  add([&](Scenario& s) { s.vibration_mps2 = nan; });
  add([](Scenario& s) { s.noise.white = -1.0; });
  add([&](Scenario& s) { s.start_s = nan; });
  add([&](Scenario& s) { s.temperature.rate_degc_per_s = nan; });
  add([](Scenario& s) { s.attitudes = RandomStations{0}; });
  add([](Scenario& s) { s.faults = {dead_at_station(4, 1)}; });
  for (std::size_t k = 0; k < bad.size(); ++k) {
    const auto run = Simulator::make(bad[k]);
    ASSERT_FALSE(run) << k;
    EXPECT_NE(run.error().find("Remedy: "), std::string::npos) << run.error();
  }
}

}  // namespace
}  // namespace scenario_test
}  // namespace scenario
}  // namespace plumb
