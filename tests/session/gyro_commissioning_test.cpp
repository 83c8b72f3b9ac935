// Gyros calibrated by motion and by gravity's turns: from logs to a calibration file.
#include "plumb/session/gyro_commissioning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "plumb/session/rate_group.hpp"
#include "plumb/session/rate_run.hpp"
#include "support/gyro_tool.hpp"

namespace gyro_commissioning_test {
namespace {

using namespace plumb;
using namespace plumb::session;
using plumb_test::GyroTool;
using plumb_test::ToolTurns;
using plumb_test::ToolWaves;

/// Files of one tool, removed with it.
class Desk {
 public:
  Desk() {
    std::string name = (std::filesystem::temp_directory_path() / "plumb-gyros-XXXXXX").string();
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    path_ = name;
  }
  ~Desk() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  std::string put(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

struct Bench {
  Desk desk;
  GyroTool tool;
  io::ArrayFile array, gyros;
  GyroCommissioningLogs logs;
  io::CalibrationFile accelerometers;

  explicit Bench(GyroTool of, const std::string& rate = GyroTool::usual_bounds()) : tool(std::move(of)) {
    const std::string path = desk.put("tool.toml", tool.array_file(rate));
    array = *io::read_array_file(path);
    gyros = *io::read_array_file(path + "#gyros");
    // Accelerometers that read what they should: the datasheet is their calibration.
    accelerometers.calibration.array = array.array;
    accelerometers.calibration.model = array.datasheet.model();
    logs.force = false;
  }
  void turn() {
    const ToolTurns turns(24, 5);
    logs.turns = {desk.put("turns.csv", tool.log(turns, turns.seconds(), 6))};
    logs.accelerometers = &accelerometers;
  }
  GyroCommissioning run() const {
    const auto out = run_gyro_commissioning(array, gyros, logs);
    EXPECT_TRUE(out.has_value()) << out.error().text();
    return out ? *out : GyroCommissioning{};
  }
};

double worst_row(const GyroCommissioning& run, const GyroTool& tool) {
  double out = 0.0;
  for (std::size_t i = 0; i < tool.axis.size(); ++i)
    out = std::fmax(out, norm(minus(run.found.axis[i].row, tool.axis[i].row)));
  return out;
}

struct Watched {
  RateRun run;
  std::size_t events = 0;
};
/// The whole log, as gyros without accelerometers beside them.
Watched watched(const io::ArrayFile& array, const LogSpec& log, const io::GyroCalibration* calibration = nullptr) {
  Watched out;
  const auto watch = RateWatch::make(array, false, calibration);
  EXPECT_TRUE(watch.has_value()) << watch.error().text();
  (*watch)->tell([&out](const RateEvent&) {
    ++out.events;
    return io::FileExpected<void>();
  });
  std::vector<LogShare> shares = {{&array, watch->get(), {}}};
  EXPECT_TRUE(run_log(log, shares).has_value());
  out.run = *(*watch)->end(std::move(shares.front().end));
  return out;
}

bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

// Verifies: REQ-245
TEST(GyroCommissioning, MotionAndTurnsTellEveryRowBiasAndDelay) {
  Bench bench(GyroTool::of_chips(3, 7));
  bench.logs.motion.path = bench.desk.put("motion.csv", bench.tool.log(ToolWaves{}, 60.0, 8));
  const GyroCommissioning relative = bench.run();
  ASSERT_TRUE(relative.refusal.empty()) << relative.refusal;
  EXPECT_FALSE(relative.found.absolute);
  EXPECT_GT(relative.common_part, 0.01) << "what motion alone does not tell is in the bound";
  bench.turn();
  const GyroCommissioning run = bench.run();
  ASSERT_TRUE(run.refusal.empty()) << run.refusal;
  EXPECT_TRUE(run.found.absolute);
  EXPECT_EQ(run.common_part, 0.0);
  EXPECT_EQ(run.turns + run.turns_held_out, 24);
  EXPECT_GE(run.turns_held_out, 7);
  EXPECT_LT(worst_row(run, bench.tool), 0.003);
  EXPECT_LT(worst_row(run, bench.tool), 0.5 * worst_row(relative, bench.tool));
  EXPECT_LT(run.found.held_out_turns_rad, 0.005);
  double mean_delay_s = 0.0;
  for (const GyroTool::Axis& one : bench.tool.axis) mean_delay_s += one.delay_s / 9.0;
  for (std::size_t i = 0; i < 9; ++i) {
    const io::GyroCalibration::Axis& found = run.found.axis[i];
    const GyroTool::Axis& truth = bench.tool.axis[i];
    EXPECT_NEAR(found.bias_radps, truth.bias_radps, found.bound.bias_radps) << i;
    EXPECT_NEAR(found.delay_s, truth.delay_s - mean_delay_s, 5.0 * found.delay_sigma_s) << i;
    EXPECT_NEAR(norm(found.row), norm(truth.row), found.bound.scale) << i;
    EXPECT_LT(angle_between_rad(found.row, truth.row), found.bound.axis_rad) << i;
    EXPECT_GE(found.bound.lag_s, std::fabs(found.delay_s));
  }
}

// Verifies: REQ-247
TEST(GyroCommissioning, TheMonitorGoesByTheCalibratedReadingsAndBounds) {
  Bench bench(GyroTool::of_chips(3, 9),
              "scale_bound = 0.1\naxis_bound_rad = 0.1\nbias_bound_radps = 0.1\n"
              "lag_bound_s = 0.0005\ng_sensitivity_bound_s_per_m = 2e-4\nstability = \"0.01 deg/s\"\n");
  bench.logs.motion.path = bench.desk.put("motion.csv", bench.tool.log(ToolWaves{}, 60.0, 8));
  bench.turn();
  const GyroCommissioning run = bench.run();
  ASSERT_TRUE(run.refusal.empty()) << run.refusal;
  const LogSpec other{bench.desk.put("other.csv", bench.tool.log(ToolWaves{{1.5, 2.0, 1.2}}, 40.0, 21))};
  const auto by_datasheet = watched(bench.gyros, other);
  const auto calibrated = watched(bench.gyros, other, &run.found);
  EXPECT_TRUE(calibrated.run.calibrated);
  EXPECT_FALSE(by_datasheet.run.calibrated);
  EXPECT_EQ(calibrated.events, 0U) << "healthy gyros";
  EXPECT_GT(calibrated.run.bounded_blocks, 0U);
  EXPECT_LT(calibrated.run.bound_sum_radps, 0.5 * by_datasheet.run.bound_sum_radps);
  // A scale that changes by 5 % passes within the datasheet's bounds and not within those of the calibration.
  const auto faulty = [](std::size_t i, double t_s, double y) { return i == 4 && t_s > 20.0 ? 1.05 * y : y; };
  const LogSpec failing{bench.desk.put("failing.csv", bench.tool.log(ToolWaves{}, 40.0, 22, faulty))};
  EXPECT_TRUE(watched(bench.gyros, failing).run.ever_excluded.empty());
  EXPECT_TRUE(watched(bench.gyros, failing, &run.found).run.ever_excluded.has(4));
  // Stability adds to what the calibration leaves of the bias.
  const auto group = rate_group(bench.gyros, &run.found);
  ASSERT_TRUE(group.has_value());
  EXPECT_NEAR(group->setup.errors[0].bias_radps, run.found.axis[0].bound.bias_radps + 4.0 * 0.01 * kPi / 180.0, 1e-9);
}

// Negative: REQ-245
TEST(GyroCommissioning, WhatTheLogDoesNotTellIsRefusedByName) {
  Bench bench(GyroTool::of_chips(3, 7));
  const auto refused = [&](const std::string& log) {
    bench.logs.motion.path = bench.desk.put("motion.csv", log);
    return bench.run();
  };
  const GyroCommissioning flat = refused(bench.tool.log(ToolWaves{{2.0, 0.0, 0.0}}, 40.0, 8));
  EXPECT_TRUE(says(flat.refusal, "turned too little about")) << flat.refusal;
  EXPECT_TRUE(says(flat.next, "all three axes"));
  EXPECT_TRUE(flat.found.axis.empty());
  const auto moving = [](double t_s) { return ToolWaves{}(t_s + 10.0); };
  const GyroCommissioning restless = refused(bench.tool.log(moving, 40.0, 8));
  EXPECT_TRUE(says(restless.refusal, "bias:")) << restless.refusal;
  EXPECT_TRUE(says(restless.next, "hold the tool still"));
  // On a turntable about the vertical accelerometers feel nothing.
  const auto table = [](double) { return Vec3{0.0, 0.06, 0.08}; };
  const GyroCommissioning turntable = refused(bench.tool.log(table, 40.0, 8));
  EXPECT_FALSE(turntable.refusal.empty());
  const auto stuck = [](std::size_t i, double t_s, double y) { return i == 5 && t_s > 30.0 ? 3.0 : y; };
  const GyroCommissioning held = refused(bench.tool.log(ToolWaves{}, 60.0, 8, stuck));
  EXPECT_FALSE(held.refusal.empty());
  const auto late = [](std::size_t i, double t_s, double y) { return i == 5 && t_s > 50.0 ? 3.0 : y; };
  const GyroCommissioning last = refused(bench.tool.log(ToolWaves{}, 60.0, 8, late));
  EXPECT_TRUE(says(last.refusal, "parity: ")) << last.refusal;
  EXPECT_TRUE(says(last.refusal, "z2")) << last.refusal;
  EXPECT_TRUE(says(last.refusal, "held out")) << last.refusal;
}

// Negative: REQ-245
TEST(GyroCommissioning, TurnsThatDoNotTellTheCommonMatrixAreRefused) {
  Bench bench(GyroTool::of_chips(3, 7));
  bench.logs.motion.path = bench.desk.put("motion.csv", bench.tool.log(ToolWaves{}, 60.0, 8));
  bench.turn();
  ToolTurns one(12, 3);
  for (std::size_t k = 0; k < one.angle_rad.size(); ++k) one.angle_rad[k] = {k % 2 == 0 ? 1.2 : -1.2, 0.0, 0.0};
  bench.logs.turns = {bench.desk.put("one.csv", bench.tool.log(one, one.seconds(), 6))};
  const GyroCommissioning run = bench.run();
  EXPECT_TRUE(says(run.refusal, "common matrix: ")) << run.refusal;
  EXPECT_TRUE(says(run.refusal, "of 9 directions open")) << run.refusal;
  EXPECT_TRUE(says(run.next, "leave --turns out"));
}

// Stretches in which the tool turned about the vertical give no bias.
TEST(GyroCommissioning, RestsThatTheGyrosContradictAreLeftOut) {
  Bench bench(GyroTool::of_chips(3, 7));
  const auto rate = [](double t_s) {
    // Down is (0, 0.6, 0.8) until the waves begin at 24 s.
    if (t_s < 20.0)
      return t_s > 10.0 && t_s < 14.0 ? Vec3{0.0, 0.3 * 0.6 * std::sin(t_s), 0.3 * 0.8 * std::sin(t_s)} : Vec3{};
    return ToolWaves{}(t_s - 20.0);
  };
  bench.logs.motion.path = bench.desk.put("motion.csv", bench.tool.log(rate, 80.0, 8));
  const GyroCommissioning run = bench.run();
  for (std::size_t i = 0; i < run.found.axis.size(); ++i)
    EXPECT_NEAR(run.found.axis[i].bias_radps, bench.tool.axis[i].bias_radps, 0.01) << i;
}

}  // namespace
}  // namespace gyro_commissioning_test
