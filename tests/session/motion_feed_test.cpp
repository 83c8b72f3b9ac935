// Rows of a log on their way to the monitor of motion, where chips have clocks of their own and where they have not.
#include "plumb/session/motion_feed.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "clocked_support.hpp"
#include "plumb/render/motion_words.hpp"
#include "plumb/session/flight_play.hpp"

namespace motion_feed_test {
namespace {

using namespace plumb;
using namespace motion_support;
using namespace clocked_support;
using plumb_test::with;
using session::ClockRun;
using session::MotionFeed;
using session::MotionPlan;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One clock of its own, without error, for imu2 and the second gyro, at the period of the log.
std::string one_clock(const std::string& lines = "offset_bound_s = 0\nrate_bound = 0\n") {
  return with(drone_text(), "[gyro] ",
              "[[clock]]\npackage = \"imu2\"\ngyro = \"second\"\ntime = \"t2_s\"\n" + lines + "\n[gyro] ");
}

MotionPlan plan_of(const std::string& text) { return *session::plan_motion(array_of(text), nullptr, 0.0); }

MotionSample sample_at(double time_s) {
  MotionSample out;
  out.time_s = time_s;
  out.delivered = SensorSet::first(9);
  out.rate_given = {true, true};
  return out;
}

std::vector<std::string> notes_of(const MotionFeed& feed, const MotionPlan& plan) {
  session::MotionRun run;
  run.clocks = feed.clocks();
  std::vector<std::string> out;
  for (const render::MotionNote& note : render::motion_notes(run, plan.setup)) out.emplace_back(note.code);
  return out;
}

TEST(MotionFeed, WithoutClocksEveryRowIsASample) {
  const MotionPlan plan = plan_of(drone_text());
  EXPECT_FALSE(plan.clocks.has_value());
  MotionFeed feed(plan);
  EXPECT_EQ(feed.stated(), 0U);
  MotionSample out;
  EXPECT_FALSE(feed.next(out));
  for (const double time_s : {0.0, 0.001, 0.0005, kNone}) {
    feed.take(sample_at(time_s), nullptr);
    ASSERT_TRUE(feed.next(out));
    EXPECT_TRUE(out.time_s == time_s || std::isnan(time_s));
    EXPECT_EQ(out.delivered, SensorSet::first(9));
    EXPECT_FALSE(feed.next(out));
  }
}

// Verifies: REQ-207
TEST(MotionFeed, EverySensorAndGyroIsOnOneClock) {
  const MotionPlan plan = plan_of(one_clock());
  ASSERT_TRUE(plan.clocks.has_value());
  EXPECT_EQ(plan.clocks->stated, 1U);
  ASSERT_EQ(plan.clocks->setup.clocks, 2);
  const MotionClock &chip = plan.clocks->setup.clock[0], &log = plan.clocks->setup.clock[1];
  EXPECT_EQ(chip.sensors, SensorSet::of(3).with(4).with(5));
  EXPECT_EQ(log.sensors, SensorSet::first(9) - chip.sensors);
  EXPECT_TRUE(!chip.gyro[0] && chip.gyro[1] && log.gyro[0] && !log.gyro[1]);
  EXPECT_EQ(chip.sample_period_s, 0.001) << "that of [motion]";
  EXPECT_EQ(log.offset_bound_s + log.rate_bound, 0.0);
  EXPECT_EQ(plan_of(clocked_text()).clocks->setup.clocks, 3);
}

// Verifies: REQ-207
TEST(MotionFeed, TheMonitorsLimitsKnowTheClocks) {
  const MotionPlan plain = plan_of(drone_text());
  const MotionPlan plan = plan_of(one_clock("valid_s = 10\noffset_bound_s = 30e-6\nrate_bound = 2e-6\n"));
  EXPECT_DOUBLE_EQ(plan.setup.errors[4].lag_s, plain.setup.errors[4].lag_s + 50e-6);
  EXPECT_DOUBLE_EQ(plan.setup.errors[0].lag_s, plain.setup.errors[0].lag_s);
  EXPECT_DOUBLE_EQ(plan.setup.gyro.lag_s, plain.setup.gyro.lag_s + 50e-6);
  EXPECT_GT(plan.array.sigma_mps2(4), plain.array.sigma_mps2(4)) << "interpolation";
}

// Verifies: REQ-207
TEST(MotionFeed, ATimeThatStandsOrIsMissingIsNoNewSample) {
  const MotionPlan plan = plan_of(one_clock());
  MotionFeed feed(plan);
  MotionSample out;
  int instants = 0, whole = 0;
  for (int k = 0; k < 200; ++k) {  // two rows a millisecond, of which the second one repeats what the chip said
    const double time_s = 0.0005 * k;
    MotionSample row = sample_at(time_s);
    if (k % 2 == 1) {
      row.delivered = SensorSet::of(3).with(4).with(5);
      row.rate_given = {false, true};
    }
    const double clock_s = k % 4 == 3 ? kNone : 0.001 * (k / 2);
    feed.take(row, &clock_s);
    while (feed.next(out)) {
      ++instants;
      whole += out.delivered == SensorSet::first(9) ? 1 : 0;
    }
  }
  EXPECT_EQ(feed.clocks()[0].samples, 100U);
  EXPECT_EQ(feed.clocks()[1].samples, 100U) << "rows in which a chip says nothing are none of it";
  EXPECT_GT(instants, 90);
  EXPECT_GT(whole, instants - 5);
  EXPECT_TRUE(notes_of(feed, plan).empty());
}

// Verifies: REQ-207
TEST(MotionFeed, SaysWhatIsWrongWithAClock) {
  struct Case {
    const char* lines;
    double period_s, offset_s;
    const char* code;
  };
  const std::string exact = "offset_bound_s = 0\nrate_bound = 0\n";
  for (const Case& one :
       {Case{"", 0.00125, 0.0, "clock_period"}, Case{"valid_s = 0.2\n", 0.001, 0.0, "clock_not_valid"},
        Case{"", 0.001, 5.0, "clock_absent"}, Case{"offset_s = 5\n", 0.001, 5.0, ""}}) {
    const MotionPlan plan = plan_of(one_clock(one.lines + exact));
    MotionFeed feed(plan);
    MotionSample out;
    for (int k = 0; k < 500; ++k) {
      const double clock_s = one.offset_s + one.period_s * std::floor(0.001 * k / one.period_s + 1e-9);
      feed.take(sample_at(0.001 * k), &clock_s);
      while (feed.next(out)) {
      }
    }
    const std::vector<std::string> notes = notes_of(feed, plan);
    const std::vector<std::string> expected =
        *one.code == '\0' ? std::vector<std::string>{} : std::vector<std::string>{one.code};
    EXPECT_EQ(notes, expected);
  }
}

// Negative: REQ-207
TEST(MotionFeed, LostEarlyAndAbsentSamplesAreTold) {
  const MotionPlan plan = plan_of(one_clock());
  MotionFeed lost(plan), early(plan), silent(plan);
  MotionSample out;
  for (int k = 0; k < 500; ++k) {
    const MotionSample row = sample_at(0.001 * k);
    const double gaps_s = k % 100 == 50 ? kNone : row.time_s;
    const double jumps_s = row.time_s - (k % 100 == 50 ? 5e-4 : 0.0);
    lost.take(row, &gaps_s);
    early.take(row, &jumps_s);
    silent.take(row, &kNone);
    for (MotionFeed* feed : {&lost, &early, &silent}) {
      while (feed->next(out)) EXPECT_TRUE(feed != &silent || !out.delivered.has(4));
    }
  }
  EXPECT_EQ(lost.clocks()[0].anew, 5U);
  EXPECT_EQ(early.clocks()[0].early, 5U);
  EXPECT_EQ(notes_of(lost, plan), std::vector<std::string>{"clock_gaps"});
  EXPECT_EQ(notes_of(silent, plan), std::vector<std::string>{"clock_silent"});
}

// Verifies: REQ-207
RC_GTEST_PROP(MotionFeedLaw, ChipsThatShareTheRowsClockIsolateNobodyHealthy, ()) {
  session::FlightRequest request;
  request.seed = *rc::gen::inRange<std::uint64_t>(1, 1000000);
  const io::ArrayFile array = array_of(one_clock());
  scenario::Flight flight(*session::flight_spec_of(array_of(drone_text()), request));
  session::MotionWatch watch(*session::plan_motion(array, nullptr, 0.0));
  Verdict rest;
  rest.in_service = array.array.all();
  for (int k = 0; k < 600; ++k) {
    const scenario::FlightSample now = flight.next();
    Sample row;
    row.time_s = now.time_s;
    row.delivered = array.array.all();
    row.temperature_degc = 25.0;
    for (std::size_t i = 0; i < 9; ++i) row.raw[i] = now.reading_mps2[i];
    watch.at_turn({true, true, now.rate_radps[0]});
    watch.at_second_turn({true, true, now.rate_radps[1]});
    watch.at_clocks({now.time_s});
    RC_ASSERT(watch.take(row, rest).has_value());
  }
  RC_ASSERT(watch.run().judged > 580U);
  RC_ASSERT(watch.run().isolated.empty());
  RC_ASSERT(watch.run().excluded.empty());
}

// Verifies: REQ-207
RC_GTEST_PROP(MotionFeedLaw, AnyRowsAndAnyTimesAreTaken, ()) {
  const MotionPlan plan = plan_of(one_clock());
  MotionFeed feed(plan);
  MotionSample out;
  for (int k = 0; k < 200; ++k) {
    const auto any = [] {
      const double values[] = {0.0, 1e-3, -1.0, 1e300, -1e300, kNone, std::numeric_limits<double>::infinity()};
      return *rc::gen::inRange(0, 2) == 0 ? values[*rc::gen::inRange(0, 7)] : 1e-3 * *rc::gen::inRange(0, 300);
    };
    MotionSample row = sample_at(any());
    row.reading_mps2[4] = any();
    row.rate_radps[1][0] = any();
    const double clock_s = any();
    feed.take(row, &clock_s);
    int drawn = 0;
    while (feed.next(out)) RC_ASSERT(++drawn < 1000);
  }
}

}  // namespace
}  // namespace motion_feed_test
