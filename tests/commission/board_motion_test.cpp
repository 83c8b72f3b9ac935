// A board with chips on both sides, tumbled by hand at 3 g and 1700 deg/s: four of its chips commissioned from one run
// and judged in two others. The gyros are at full scale in one sample of eight, so that hardly a pair of blocks of 32
// samples has them throughout: all is fitted and judged on blocks of 1 and 4 samples.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <memory>

#include "plumb/commission/motion_commission.hpp"
#include "plumb/core/units.hpp"
#include "plumb/motion/motion_monitor.hpp"
#include "support/recording.hpp"

namespace board_motion_test {
namespace {

using namespace plumb;
using namespace plumb::commission;
using plumb_test::Recording;

using Chips = std::array<std::size_t, 4>;
constexpr Chips kFront{0, 2, 4, 6};
constexpr Chips kBack{1, 3, 5, 7};
constexpr Chips kBoth{0, 1, 6, 7};

MotionLog log_of(const Recording& recording, const Chips& chips) {
  constexpr double kFullScale = 32700.0, kCountsPerG0 = 2048.0, kCountsPerDegps = 16.4;
  constexpr std::size_t kFirstForce = 1, kFirstRate = 25;
  MotionLog out;
  out.period_s = 0.016;
  out.full_scale_mps2 = mps2_from_g0(kFullScale / kCountsPerG0);
  out.unit.resize(chips.size());
  for (const std::vector<double>& row : recording.rows) {
    for (std::size_t u = 0; u < chips.size(); ++u) {
      Vec3 force{}, rate{};
      for (std::size_t c = 0; c < 3; ++c) {
        force[c] = mps2_from_g0(row[kFirstForce + 3 * chips[u] + c] / kCountsPerG0);
        const double counts = row[kFirstRate + 3 * chips[u] + c];
        const bool clipped = std::fabs(counts) >= kFullScale;
        rate[c] = clipped ? std::numeric_limits<double>::quiet_NaN() : rad_from_deg(counts / kCountsPerDegps);
      }
      out.unit[u].force_mps2.push_back(force);
      out.unit[u].rate_radps.push_back(rate);
    }
  }
  return out;
}

CommissionSettings settings() {
  CommissionSettings out;
  out.alignment.delay_s = 0.05;  // the chips hang on one clock, but for how they fill their samples
  out.alignment.smoothed_samples = 1;
  out.fit.scale = 1;
  out.bounds.noise_mps2 = 0.1;
  out.bounds.rate_bound_radps = 60.0;  // sqrt(3) times the gyros' full scale
  return out;
}

class BoardMotion : public testing::Test {
 protected:
  void SetUp() override {
    for (std::size_t run = 0; run < 3; ++run) {
      recording_[run] = plumb_test::load_recording("carlsson_motion_" + std::to_string(run + 1) + ".csv");
      if (recording_[run].found()) continue;
      GTEST_SKIP() << "recording not found: " << recording_[run].path
                   << " (set PLUMB_DATA_DIR to the directory that holds it)";
    }
  }

  MotionLog aligned(std::size_t run, const Chips& chips, const MotionCommissioning& found) const {
    const MotionLog log = log_of(recording_[run], chips);
    const auto clocks = align_by_gyros(log, settings().alignment);
    EXPECT_TRUE(clocks.has_value()) << clocks.error();
    return clocks ? found.aligned(log, *clocks) : MotionLog{};
  }

  std::array<Recording, 3> recording_;
};

enum class Injected { none, shift, dead, stuck };

struct Outcome {
  bool alarm = false;
  SensorSet blamed;
};

/// A fault of one axis from 40 s on.
Outcome judge(const MotionCommissioning& found, const MotionLog& log, Injected fault, int axis = 0, double g0 = 0.0) {
  constexpr std::size_t kBegin = 2500;
  const auto monitor = std::make_unique<MotionMonitor>();
  EXPECT_TRUE(monitor->configure(found.array, found.setup).has_value());
  const auto i = static_cast<std::size_t>(axis);
  const double frozen = found.sample(log, kBegin).reading_mps2[i];
  Outcome out;
  for (std::size_t k = 0; k < log.samples(); ++k) {
    MotionSample sample = found.sample(log, k);
    if (k >= kBegin && fault != Injected::none) {
      double& y = sample.reading_mps2[i];
      y = fault == Injected::shift ? y + mps2_from_g0(g0) : fault == Injected::dead ? 0.0 : frozen;
      if (fault != Injected::shift) sample.clipped = sample.clipped.without(axis);
    }
    const MotionVerdict& verdict = monitor->step(sample);
    out.alarm = out.alarm || verdict.alarm;
    out.blamed = out.blamed | verdict.isolated | verdict.excluded;
  }
  return out;
}

TEST_F(BoardMotion, ArmsOfTheChipsFormASquareAndShowTheBoardsThickness) {
  for (const Chips& chips : {kFront, kBack}) {
    const auto found = commission_motion(log_of(recording_[0], chips), settings());
    ASSERT_TRUE(found.has_value()) << found.error();
    const std::vector<FittedUnit>& unit = found->fit.unit;
    // Chips of one side: two neighbours at one pitch, the fourth across the diagonal.
    const Vec3 far = unit[3].arm_m, open = minus(far, plus(unit[1].arm_m, unit[2].arm_m));
    std::cout << "[ measured ] arms, mm:";
    for (std::size_t u = 1; u < 4; ++u) {
      for (const double x : unit[u].arm_m) std::cout << " " << 1e3 * x;
      std::cout << (u < 3 ? "," : "\n");
      EXPECT_NEAR(unit[u].arm_m[2], 0.0, 0.5e-3);
      EXPECT_LT(unit[u].arm_sigma_m[0], 0.3e-3);
    }
    EXPECT_LT(norm(open), 0.7e-3);
    EXPECT_NEAR(norm(unit[1].arm_m), 18.9e-3, 0.5e-3);
    EXPECT_NEAR(norm(unit[2].arm_m), 18.9e-3, 0.5e-3);
  }
  const auto both = commission_motion(log_of(recording_[0], kBoth), settings());
  ASSERT_TRUE(both.has_value()) << both.error();
  EXPECT_NEAR(both->fit.unit[1].arm_m[2], -2.2e-3, 0.4e-3);  // chip 1 lies behind chip 0, chip 7 behind chip 6
  EXPECT_NEAR(both->fit.unit[3].arm_m[2], both->fit.unit[1].arm_m[2], 0.5e-3);
}

TEST_F(BoardMotion, NobodyIsBlamedAndNothingAlarmsInOtherRuns) {
  for (const Chips& chips : {kFront, kBack, kBoth}) {
    const auto found = commission_motion(log_of(recording_[0], chips), settings());
    ASSERT_TRUE(found.has_value()) << found.error();
    for (const std::size_t run : {std::size_t{1}, std::size_t{2}}) {
      const MotionLog log = aligned(run, chips, *found);
      EXPECT_LT(g0_from_mps2(residual_of(log, found->fit, 1)), 0.15);
      EXPECT_GT(g0_from_mps2(residual_of(log, found->fit, 1, false)), 0.45);
      const Outcome outcome = judge(*found, log, Injected::none);
      EXPECT_FALSE(outcome.alarm);
      EXPECT_TRUE(outcome.blamed.empty());
    }
  }
}

TEST_F(BoardMotion, DeadStuckAndShiftedAxesAreIsolated) {
  // Dead and stuck axes are isolated within seconds of tumbling. Shifts of 0.5 g and 1 g mostly are only where the
  // tumbling slows down at the end: blocks of four samples at 3 g leave 0.13 g rms by the skews of chips that sample
  // freely.
  const auto found = commission_motion(log_of(recording_[0], kFront), settings());
  ASSERT_TRUE(found.has_value()) << found.error();
  struct Case {
    const char* name;
    Injected fault;
    double g0;
  };
  for (const std::size_t run : {std::size_t{1}, std::size_t{2}}) {
    const MotionLog log = aligned(run, kFront, *found);
    for (const Case& c : {Case{"dead", Injected::dead, 0.0}, Case{"stuck", Injected::stuck, 0.0},
                          Case{"0.5 g0", Injected::shift, 0.5}, Case{"1 g0", Injected::shift, 1.0}}) {
      int right = 0;
      for (int axis = 0; axis < 12; ++axis) {
        const SensorSet chip(7U << static_cast<unsigned>(axis / 3 * 3));
        const Outcome outcome = judge(*found, log, c.fault, axis, c.g0);
        EXPECT_TRUE(chip.contains(outcome.blamed)) << c.name << " on " << axis;
        right += outcome.blamed.empty() ? 0 : 1;
      }
      std::cout << "[ measured ] run " << run + 1 << ", " << c.name << ": isolated right " << right << " of 12\n";
      EXPECT_EQ(right, 12) << c.name;
    }
  }
}

}  // namespace
}  // namespace board_motion_test
