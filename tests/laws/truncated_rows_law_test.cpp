// Law 10: rows that lack channels while the tool begins to move, or moves, blame nobody.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "laws/law_run.hpp"

namespace truncated_rows_law_test {
namespace {

using namespace plumb;
using plumb_test::bounded_noise;
using plumb_test::every_tool;
using plumb_test::kLawCases;
using plumb_test::LawCount;
using plumb_test::LawOutcome;
using plumb_test::LawTool;
using plumb_test::names_of;
using plumb_test::run_law;
using plumb_test::slot;
using plumb_test::Strata;
using plumb_test::TrialNoise;

constexpr int kRows = 32;

/// A tool without a fault, row by row.
class Bus {
 public:
  Bus(const LawTool& tool, const MonitorConfig& config) : tool_(&tool) {
    MonitorSetup setup;
    setup.array = tool.tool.array;
    setup.model.size = tool.n();
    setup.gravity = tool.tool.gravity;
    setup.config = config;
    setup.config.window = kRows;
    EXPECT_TRUE(monitor.configure(setup).has_value());
  }
  const Verdict& row(const Vec3& direction, SensorSet delivered, TrialNoise& noise) {
    Sample s;
    s.time_s = time_s_ += 0.01;
    s.delivered = delivered;
    s.temperature_degc = 25.0;
    const auto z = bounded_noise(tool_->n(), noise);
    for (int i = 0; i < tool_->n(); ++i) {
      const double truth = kG0_mps2 * dot(tool_->tool.row[slot(i)], direction) + tool_->tool.offset_mps2[slot(i)];
      s.raw[slot(i)] = truth + tool_->tool.array.sigma_mps2(i) * z[slot(i)];
    }
    return monitor.step(s);
  }
  void stay(const Vec3& direction, int rows, TrialNoise& noise) {
    for (int k = 0; k < rows; ++k) row(direction, monitor.array().all(), noise);
  }
  /// Rests for a block, and until one has just ended.
  void begin_block(const Vec3& direction, TrialNoise& noise) {
    stay(direction, kRows, noise);
    for (int k = 0; k < kRows && monitor.verdict().block_fill != 0; ++k) stay(direction, 1, noise);
  }

  HealthMonitor monitor;

 private:
  const LawTool* tool_;
  double time_s_ = 0.0;
};

/// About a unit axis, by Rodrigues' formula.
Vec3 turned(const Vec3& v, const Vec3& axis, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return plus(plus(scaled(v, c), scaled(cross(axis, v), s)), scaled(axis, (1.0 - c) * dot(axis, v)));
}

/// A proven monitor of the tool under that claim, kept for the next case like it.
const Bus& proven(const LawTool& tool, int asserted, int stations) {
  static std::map<std::pair<const LawTool*, int>, std::unique_ptr<Bus>> known;
  auto& kept = known[{&tool, 8 * asserted + stations}];
  if (!kept) {
    MonitorConfig config;
    config.assumed_faults = asserted;
    config.isolation_stations = stations;
    kept = std::make_unique<Bus>(tool, config);
    TrialNoise noise(11);
    for (int k = 0; k < 6; ++k) kept->stay(noise.direction(), kRows, noise);
  }
  return *kept;
}

/// Rests, turns with one or two rows truncated anywhere around the start, rests again: three times.
LawOutcome play(const LawTool& tool, Bus& bus, int position, TrialNoise& noise) {
  const SensorSet all = bus.monitor.array().all();
  Vec3 direction = noise.direction();
  for (int episode = 0; episode < 3; ++episode) {
    const Vec3 axis = noise.direction();
    // Up to 570 deg/s at 100 rows a second.
    const double step_rad = noise.uniform() < 0.5 ? noise.between(0.02, 0.1) : noise.log_between(1e-4, 0.1);
    const int moving = 1 + noise.below(kRows), truncated = 1 + noise.below(2), early = noise.below(2);
    bus.begin_block(direction, noise);
    for (int k = 0; k < position + moving; ++k) {
      if (k >= position) direction = turned(direction, axis, step_rad);
      const bool cut = k >= position - early && k < position - early + truncated;
      SensorSet delivered = all;
      if (cut && noise.uniform() < 0.8) delivered = SensorSet::of(noise.below(tool.n()));
      for (int i = 0; cut && delivered == all && i < tool.n(); ++i) {
        if (noise.uniform() < 0.5) delivered = delivered.without(i);
      }
      bus.row(direction, delivered, noise);
    }
    bus.stay(direction, (1 + noise.below(3)) * kRows, noise);
    const Verdict& v = bus.monitor.verdict();
    const SensorSet out = v.excluded | v.provisionally_excluded | v.absent;
    if (!out.empty()) {
      return {true,
              "of " + std::to_string(tool.n()) + " sensors " + names_of(out) + " are out, truncated at row " +
                  std::to_string(position) + " of a block, turning by " + std::to_string(step_rad) + " rad a row",
              {tool.n(), 0, episode}};
    }
  }
  return {};
}

// Verifies: REQ-078
TEST(Law, TenRowsThatLackChannelsExcludeNoSensor) {
  const LawCount count = run_law(10, kLawCases, [](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    const int position = strata.digit(kRows);
    const int asserted = strata.of(std::array<int, 5>{-1, 0, 1, 2, 3});
    const int stations = strata.of(std::array<int, 2>{1, 4});
    Bus bus = proven(tool, asserted, stations);
    return play(tool, bus, position, noise);
  });
  EXPECT_EQ(count.broken, 0U);
}

}  // namespace
}  // namespace truncated_rows_law_test
