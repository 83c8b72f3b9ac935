// Four inertial units on one quadrotor, commissioned from one flight and judged in the others. The factors and floors
// of the bounds were fixed before the other flights were judged. The shortest block came after: with the third or fifth
// flight fitted, blocks of 4 samples of the second one contradicted each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "plumb/commission/motion_commission.hpp"
#include "plumb/core/units.hpp"
#include "plumb/motion/motion_monitor.hpp"
#include "support/recording.hpp"

namespace quadrotor_motion_test {
namespace {

using namespace plumb;
using namespace plumb::commission;
using plumb_test::Recording;

constexpr std::size_t kUnits = 4;
constexpr double kPeriod_s = 1.0 / 120.0;
// The fourth unit lost a row between these two of the third flight: its clock moves by one period.
constexpr std::size_t kBeforeLostRow = 1900, kAfterLostRow = 2100;

MotionLog log_of(const Recording& recording) {
  MotionLog out;
  out.period_s = kPeriod_s;
  out.unit.resize(kUnits);
  for (const std::vector<double>& row : recording.rows) {
    for (std::size_t u = 0; u < kUnits; ++u) {
      const std::size_t at = 1 + 6 * u;
      out.unit[u].force_mps2.push_back({row[at], row[at + 1], row[at + 2]});
      out.unit[u].rate_radps.push_back(
          {rad_from_deg(row[at + 3]), rad_from_deg(row[at + 4]), rad_from_deg(row[at + 5])});
    }
  }
  return out;
}

MotionLog part_of(const MotionLog& log, std::size_t first, std::size_t end) {
  MotionLog out = log;
  const auto cut = [&](std::vector<Vec3>& values) {
    const auto begin = values.begin();
    values = std::vector<Vec3>(begin + static_cast<std::ptrdiff_t>(first),
                               begin + static_cast<std::ptrdiff_t>(std::min(end, values.size())));
  };
  for (UnitLog& unit : out.unit) {
    cut(unit.force_mps2);
    cut(unit.rate_radps);
  }
  return out;
}

struct Flights {
  Recording second = plumb_test::load_recording("quadrotor_flight2.csv");
  Recording third = plumb_test::load_recording("quadrotor_flight3.csv");
  Recording fifth = plumb_test::load_recording("quadrotor_flight5.csv");
};

/// Units on clocks of their own are compared by means of 32 samples: the lag that the recording needs is enough then,
/// with no floor. In blocks of 4 it is not: six of twelve pairs of a fitted and a judged flight alarm, with nothing
/// wrong.
CommissionSettings settings() {
  CommissionSettings out;
  out.bounds.shortest_block = 32;
  out.bounds.lag_periods = 0.0;
  return out;
}

class QuadrotorMotion : public testing::Test {
 protected:
  void SetUp() override {
    if (!flights_.second.found() || !flights_.third.found() || !flights_.fifth.found()) {
      GTEST_SKIP() << "recording not found: " << flights_.second.path
                   << " and flights 3 and 5 (set PLUMB_DATA_DIR to the directory that holds them)";
    }
    second_ = log_of(flights_.second);
    const MotionLog third = log_of(flights_.third);
    judged_ = {part_of(third, 0, kBeforeLostRow), part_of(third, kAfterLostRow, third.samples()),
               log_of(flights_.fifth)};
    found_ = commission_motion(second_, settings());
    ASSERT_TRUE(found_.has_value()) << found_.error();
    for (MotionLog& log : judged_) {
      const auto clocks = align_by_gyros(log);
      ASSERT_TRUE(clocks.has_value()) << clocks.error();
      log = found_->aligned(log, *clocks);
    }
  }

  Flights flights_;
  MotionLog second_;
  std::vector<MotionLog> judged_;  // aligned
  CommissionExpected<MotionCommissioning> found_ = tl::unexpected<std::string>("not commissioned");
};

double mg(double mps2) { return 1e3 * g0_from_mps2(mps2); }

TEST_F(QuadrotorMotion, GyrosGiveClocksThatAgreeFromFlightToFlight) {
  // Published nowhere: three flights of one session are held against each other.
  const auto third = align_by_gyros(part_of(log_of(flights_.third), kAfterLostRow, 100000));
  const auto fifth = align_by_gyros(log_of(flights_.fifth));
  ASSERT_TRUE(third.has_value() && fifth.has_value());
  for (std::size_t u = 1; u < kUnits; ++u) {
    EXPECT_NEAR((*third)[u].delay_s, (*fifth)[u].delay_s, 0.2e-3);
    EXPECT_LT((*third)[u].delay_sigma_s, 0.1e-3);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR((*third)[u].to_frame[k], found_->alignment[u].to_frame[k], 2e-3);
  }
  // The fourth unit, one row earlier since the row that it lost.
  EXPECT_NEAR((*fifth)[3].delay_s, found_->alignment[3].delay_s - kPeriod_s, 0.2e-3);
}

TEST_F(QuadrotorMotion, ARowThatAUnitLostInFlightIsFound) {
  const auto whole = align_by_gyros(log_of(flights_.third));
  ASSERT_FALSE(whole.has_value());
  EXPECT_NE(whole.error().find("unit 4: its clock moves by -58"), std::string::npos) << whole.error();
}

TEST_F(QuadrotorMotion, LeverArmsFormTheRectangleOfTheMounting) {
  const std::vector<FittedUnit>& unit = found_->fit.unit;
  const Vec3 open = minus(unit[3].arm_m, plus(unit[1].arm_m, unit[2].arm_m));
  EXPECT_LT(norm(open), 0.005);  // three arms known to 1.3 mm along x
  EXPECT_NEAR(norm(unit[1].arm_m), 0.040, 0.003);
  EXPECT_NEAR(norm(unit[2].arm_m), 0.102, 0.003);
  for (std::size_t u = 1; u < kUnits; ++u) {
    for (const double sigma : unit[u].arm_sigma_m) EXPECT_LT(sigma, 0.002);
  }
}

TEST_F(QuadrotorMotion, LeverArmsExplainHeldOutFlights) {
  constexpr int kBlocks = 2;
  const auto residual_mg = [&](const MotionLog& log, bool with_arms) {
    return mg(residual_of(log, found_->fit, kBlocks, with_arms));
  };
  std::cout << "[ measured ] parity residual of blocks of 32 samples, mg rms: fit " << mg(found_->fit.residual_mps2);
  for (const MotionLog& log : judged_) {
    std::cout << ", held out " << residual_mg(log, true) << " (without lever arms " << residual_mg(log, false) << ")";
    EXPECT_LT(residual_mg(log, true), 1.9);
    EXPECT_GT(residual_mg(log, false), 15.0);
  }
  std::cout << "\n";
  EXPECT_LT(mg(found_->fit.residual_mps2), 1.8);
}

/// What the monitor said of a flight.
struct Outcome {
  bool alarm = false;
  SensorSet blamed;
};

enum class Injected { none, plus_50_mg, minus_50_mg, plus_01_g0, minus_01_g0, plus_02_g0, minus_02_g0, dead, stuck };

/// The fault begins at a row and stays.
Outcome judge(const MotionCommissioning& found, const MotionLog& log, Injected fault, SensorSet faulty,
              std::size_t begin) {
  const auto monitor = std::make_unique<MotionMonitor>();
  EXPECT_TRUE(monitor->configure(found.array, found.setup).has_value());
  const Readings frozen = found.sample(log, begin).reading_mps2;
  Outcome out;
  for (std::size_t k = 0; k < log.samples(); ++k) {
    MotionSample sample = found.sample(log, k);
    for (std::size_t i = 0; i < 3 * kUnits && k >= begin; ++i) {
      if (!faulty.has(static_cast<int>(i))) continue;
      double& y = sample.reading_mps2[i];
      switch (fault) {
        case Injected::none: break;
        case Injected::plus_50_mg: y += mps2_from_g0(0.05); break;
        case Injected::minus_50_mg: y -= mps2_from_g0(0.05); break;
        case Injected::plus_01_g0: y += mps2_from_g0(0.1); break;
        case Injected::minus_01_g0: y -= mps2_from_g0(0.1); break;
        case Injected::plus_02_g0: y += mps2_from_g0(0.2); break;
        case Injected::minus_02_g0: y -= mps2_from_g0(0.2); break;
        case Injected::dead: y = 0.0; break;
        case Injected::stuck: y = frozen[i]; break;
      }
    }
    const MotionVerdict& verdict = monitor->step(sample);
    out.alarm = out.alarm || verdict.alarm;
    out.blamed = out.blamed | verdict.isolated | verdict.excluded;
  }
  return out;
}

TEST_F(QuadrotorMotion, NobodyIsBlamedAndNothingAlarmsInHealthyFlights) {
  for (const MotionLog& log : judged_) {
    const Outcome outcome = judge(*found_, log, Injected::none, {}, 0);
    EXPECT_FALSE(outcome.alarm);
    EXPECT_TRUE(outcome.blamed.empty());
  }
}

TEST_F(QuadrotorMotion, WhicheverFlightIsFittedTheOthersAreWithoutAlarm) {
  const MotionLog third = log_of(flights_.third), fifth = log_of(flights_.fifth);
  const std::vector<MotionLog> logs = {second_, part_of(third, 0, kBeforeLostRow),
                                       part_of(third, kAfterLostRow, third.samples()), fifth};
  for (const std::size_t fitted : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
    const auto found = commission_motion(logs[fitted], settings());
    ASSERT_TRUE(found.has_value()) << found.error();
    for (std::size_t k = 0; k < logs.size(); ++k) {
      const auto clocks = align_by_gyros(logs[k]);
      ASSERT_TRUE(clocks.has_value()) << clocks.error();
      const Outcome outcome = judge(*found, found->aligned(logs[k], *clocks), Injected::none, {}, 0);
      EXPECT_FALSE(outcome.alarm) << "fitted on " << fitted << ", judged " << k;
      EXPECT_TRUE(outcome.blamed.empty()) << "fitted on " << fitted << ", judged " << k;
    }
  }
}

TEST_F(QuadrotorMotion, ALostRowWithinTheBoundOfTheLagIsNoFault) {
  AlignmentLimits whatever;
  whatever.slip_s = 1.0;
  const MotionLog third = log_of(flights_.third);
  const auto clocks = align_by_gyros(third, whatever);
  ASSERT_TRUE(clocks.has_value()) << clocks.error();
  const Outcome outcome = judge(*found_, found_->aligned(third, *clocks), Injected::none, {}, 0);
  EXPECT_FALSE(outcome.alarm);
  EXPECT_TRUE(outcome.blamed.empty());
}

struct Count {
  int flights = 0, detected = 0, right = 0, wrong = 0;
};

void add(const Outcome& outcome, SensorSet unit, Count* count) {
  ++count->flights;
  count->detected += outcome.alarm ? 1 : 0;
  count->wrong += unit.contains(outcome.blamed) ? 0 : 1;
  count->right += !outcome.blamed.empty() && unit.contains(outcome.blamed) ? 1 : 0;
}

/// Every axis alone and every unit as a whole, from two instants on, in all judged flights.
Count inject(const MotionCommissioning& found, const std::vector<MotionLog>& logs, Injected fault, const char* name) {
  Count out;
  for (const MotionLog& log : logs) {
    for (const std::size_t begin : {std::size_t{600}, std::size_t{1000}}) {
      for (int u = 0; u < static_cast<int>(kUnits); ++u) {
        const SensorSet unit = SensorSet(7U << static_cast<unsigned>(3 * u));
        add(judge(found, log, fault, unit, begin), unit, &out);
        for (int c = 0; c < 3; ++c) add(judge(found, log, fault, SensorSet::of(3 * u + c), begin), unit, &out);
      }
    }
  }
  std::cout << "[ measured ] " << name << ": of " << out.flights << " detected " << out.detected << ", right "
            << out.right << ", wrong " << out.wrong << "\n";
  return out;
}

void expect_all_isolated(const MotionCommissioning& found, const std::vector<MotionLog>& logs,
                         std::initializer_list<Injected> faults, const char* name) {
  for (const Injected fault : faults) {
    const Count count = inject(found, logs, fault, name);
    EXPECT_EQ(count.right, 96);
    EXPECT_EQ(count.flights, 96);
    EXPECT_EQ(count.wrong, 0);
  }
}

TEST_F(QuadrotorMotion, AShiftOfFiftyMilligravityIsIsolated) {
  expect_all_isolated(*found_, judged_, {Injected::plus_50_mg, Injected::minus_50_mg}, "50 mg0");
}

TEST_F(QuadrotorMotion, AShiftOfATenthOfGravityIsIsolated) {
  expect_all_isolated(*found_, judged_, {Injected::plus_01_g0, Injected::minus_01_g0}, "0.1 g0");
}

TEST_F(QuadrotorMotion, AShiftOfAFifthOfGravityIsIsolated) {
  expect_all_isolated(*found_, judged_, {Injected::plus_02_g0, Injected::minus_02_g0}, "0.2 g0");
}

TEST_F(QuadrotorMotion, DeadAxesAndUnitsAreIsolated) {
  expect_all_isolated(*found_, judged_, {Injected::dead}, "dead");
}

TEST_F(QuadrotorMotion, StuckAxesAndUnitsAreIsolated) {
  // 96 % are asked. One lateral axis stops close to the mean of a flight in which the force along it hardly changes.
  const Count count = inject(*found_, judged_, Injected::stuck, "stuck");
  EXPECT_GE(count.right, 95);
  EXPECT_GE(count.detected, 96);
  EXPECT_EQ(count.flights, 96);
  EXPECT_EQ(count.wrong, 0);
}

}  // namespace
}  // namespace quadrotor_motion_test
