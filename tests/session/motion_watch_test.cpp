// The monitor of motion beside the one at rest, on simulated flights of the example.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "motion_support.hpp"
#include "plumb/render/motion_words.hpp"
#include "plumb/session/flight_play.hpp"
#include "plumb/session/motion_watch.hpp"

namespace motion_watch_test {
namespace {

using namespace plumb;
using namespace motion_support;
using io::MotionEventKind;
using plumb_test::with;

class Heard final : public session::MotionSink {
 public:
  io::FileExpected<void> take(double, const MotionVerdict& verdict, const std::vector<io::MotionEvent>& some) override {
    events.insert(events.end(), some.begin(), some.end());
    last = verdict;
    ++samples;
    return {};
  }
  std::vector<io::MotionEvent> events;
  MotionVerdict last;
  int samples = 0;
};

/// A flight row by row, with a verdict at rest that leaves `in_service` in service.
struct Flown {
  io::ArrayFile array;
  scenario::Flight flight;
  session::MotionWatch watch;
  Heard heard;
  Verdict rest;

  static scenario::FlightSpec spec(const io::ArrayFile& array, std::uint64_t seed) {
    session::FlightRequest request;
    request.seed = seed;
    return *session::flight_spec_of(array, request);
  }
  explicit Flown(const std::string& text, std::uint64_t seed = 1)
      : array(array_of(text)), flight(spec(array, seed)), watch(*session::plan_motion(array, nullptr, 0.0)) {
    watch.tell(heard);
    rest.in_service = array.array.all();
  }
  /// `dead` reads 0.
  void fly(int samples, SensorSet dead = {}, bool rates = true, double unit = 1.0, bool second = true) {
    for (int k = 0; k < samples; ++k) {
      const scenario::FlightSample now = flight.next();
      Sample sample;
      sample.time_s = now.time_s;
      sample.delivered = array.array.all();
      sample.temperature_degc = 25.0;
      const double sense = array.datasheet.reads == Reads::gravity ? -1.0 : 1.0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(array.array.size()); ++i)
        sample.raw[i] = dead.has(static_cast<int>(i)) ? 0.0 : sense * now.reading_mps2[i];
      Vec3 rate = now.rate_radps[0];
      for (double& part : rate) part *= unit;
      watch.at_turn({rates, rates, rate});
      watch.at_second_turn({true, second, now.rate_radps[1]});
      EXPECT_TRUE(watch.take(sample, rest).has_value());
      rest.transition = TransitionRecord{};
    }
  }
  bool notes(const std::string& code) const {
    for (const render::MotionNote& note :
         render::motion_notes(watch.run(), session::plan_motion(array, nullptr, 0.0)->setup)) {
      if (note.code == code) return true;
    }
    return false;
  }
};

const SensorSet kSecond = SensorSet::of(3).with(4).with(5);

TEST(MotionWatch, AHealthyFlightIsJudgedWithoutAlarm) {
  Flown f(drone_text());
  f.fly(3000);
  const session::MotionRun& run = f.watch.run();
  EXPECT_EQ(run.samples, 3000U);
  EXPECT_EQ(run.judged, 2998U) << "the first two have no neighbours yet";
  EXPECT_EQ(run.alarms, 0U);
  EXPECT_TRUE(f.heard.events.empty());
  EXPECT_EQ(f.heard.samples, 3000);
  EXPECT_GT(run.blocks, 80U);
  EXPECT_GT(run.worst_bound_mps2, run.bound_sum_mps2 / static_cast<double>(run.blocks));
  EXPECT_TRUE(render::motion_notes(run, session::plan_motion(f.array, nullptr, 0.0)->setup).empty());
}

TEST(MotionWatch, ADeadChipIsIsolatedThenExcludedAndNobodyElse) {
  for (const char* reads : {"specific-force", "gravity"}) {
    Flown f(with(drone_text(), "specific-force", reads));
    f.fly(2000);
    f.fly(1000, kSecond);
    const session::MotionRun& run = f.watch.run();
    EXPECT_EQ(run.isolated, kSecond) << reads;
    EXPECT_EQ(run.excluded, kSecond) << reads;
    EXPECT_NEAR(run.isolated_at_s[4], 2.01, 0.02);
    EXPECT_NEAR(run.excluded_at_s[4] - run.isolated_at_s[4], 0.064, 0.01);
    ASSERT_GE(f.heard.events.size(), 4U);
    EXPECT_EQ(f.heard.events[0].kind, MotionEventKind::alarm);
    EXPECT_EQ(f.heard.events[1].kind, MotionEventKind::isolated);
    EXPECT_EQ(f.heard.events[1].sensors, kSecond);
    EXPECT_EQ(f.heard.events[2].kind, MotionEventKind::excluded);
    EXPECT_EQ(f.heard.events[3].kind, MotionEventKind::alarm_over);
  }
}

TEST(MotionWatch, WhatRestHasTakenOutIsNotJudged) {
  Flown f(drone_text());
  f.fly(1000);
  f.rest.in_service = f.array.array.all() - kSecond;
  f.fly(1000, kSecond);
  EXPECT_EQ(f.watch.run().alarms, 0U);
  EXPECT_TRUE((f.heard.last.sample.used & kSecond).empty());
}

TEST(MotionWatch, ExclusionsEndWhereRestHasJudged) {
  Flown f(drone_text());
  f.fly(1000);
  f.fly(500, kSecond);
  f.fly(600);
  ASSERT_EQ(f.heard.last.excluded, kSecond) << "well again, but that is for rest to say";
  f.rest.transition.sequence = 1;
  f.rest.transition.from = HealthState::suspect;
  f.rest.transition.to = HealthState::nominal;
  f.rest.transition.event = HealthEvent::passed_block;
  f.fly(1);
  EXPECT_EQ(f.heard.events.back().kind, MotionEventKind::forgotten);
  EXPECT_EQ(f.heard.events.back().sensors, kSecond);
  f.fly(1000);
  EXPECT_EQ(f.heard.events.back().kind, MotionEventKind::forgotten);
  EXPECT_TRUE(f.heard.last.excluded.empty());
}

TEST(MotionWatch, AGyroThatIsNotWhatTheFileSaysIsTold) {
  Flown degrees(drone_text());
  degrees.fly(2000, {}, true, 180.0 / 3.141592653589793);
  EXPECT_TRUE(degrees.notes("rate_too_large"));
  const std::string text = render::motion_text(
      {&degrees.watch.run(), &session::plan_motion(degrees.array, nullptr, 0.0)->setup, nullptr}, degrees.array);
  EXPECT_NE(text.find("the columns seem to hold deg/s"), std::string::npos) << text;
  Flown off(drone_text());
  off.fly(2000, {}, true, 0.0);
  EXPECT_TRUE(off.notes("rate_stuck"));
  Flown absent(drone_text());
  absent.fly(1000, {}, false);
  EXPECT_TRUE(absent.notes("rate_missing"));
  EXPECT_EQ(absent.watch.run().alarms, 0U);
  EXPECT_EQ(absent.watch.run().judged, 998U) << "by the second gyro";
  Flown neither(drone_text());
  neither.fly(1000, {}, false, 1.0, false);
  EXPECT_EQ(neither.watch.run().inputs.gyro[1].missing, 1000U);
  EXPECT_EQ(neither.watch.run().isolated, SensorSet());
}

TEST(MotionWatch, AClockThatIsNotWhatTheFileSaysIsTold) {
  Flown f(with(drone_text(), "sample_period_s = 0.001", "sample_period_s = 0.002"));
  session::MotionWatch& watch = f.watch;
  for (int k = 0; k < 100; ++k) {
    Sample sample;
    sample.time_s = 0.0005 * (k == 50 ? 20 : k);
    EXPECT_TRUE(watch.take(sample, f.rest).has_value());
  }
  EXPECT_TRUE(f.notes("period"));
  EXPECT_TRUE(f.notes("time_backwards"));
  EXPECT_EQ(watch.run().judged, 0U);
  EXPECT_EQ(watch.run().samples_with(MotionCause::irregular_time), 100U);
}

TEST(MotionWatch, JitterAndGapsAreTold) {
  Flown f(drone_text());
  for (int k = 0; k < 100; ++k) {
    Sample sample;
    sample.time_s = 0.001 * k + (k % 2 == 0 ? 2e-4 : 0.0) + (k > 60 ? 0.01 : 0.0);
    EXPECT_TRUE(f.watch.take(sample, f.rest).has_value());
  }
  EXPECT_TRUE(f.notes("jitter"));
  EXPECT_TRUE(f.notes("gaps"));
  EXPECT_FALSE(f.notes("period"));
}

}  // namespace
}  // namespace motion_watch_test
