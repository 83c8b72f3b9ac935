// The gyros of a group in a simulated flight: within the bounds that the file states, and the rate of motion by them.
#include "session/flight_gyros.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "motion_support.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/fault_text.hpp"
#include "plumb/scenario/flight.hpp"
#include "plumb/session/flight_play.hpp"
#include "plumb/session/motion_watch.hpp"
#include "plumb/session/rate_run.hpp"

namespace flight_gyros_test {
namespace {

using namespace plumb;
using namespace motion_support;
using plumb_test::with;
using session::FlightGyros;

std::string three_text() { return plumb_test::read_text(PLUMB_SOURCE_DIR "/examples/motion/three_gyros.toml"); }

TEST(FlightGyros, ReadTheTrueRateWithinTheBoundsOfTheFile) {
  std::string text = three_text();
  for (int i = 0; i < 9; ++i) text = with(text, "0.1 deg/s", "1e-6 deg/s");
  const io::ArrayFile tool = array_of(text);
  const io::ArrayFile& gyros = tool.groups.at(0);
  const RateErrors& e = gyros.rate.errors[0];
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    io::FileExpected<FlightGyros> group = FlightGyros::make(gyros, {}, seed, 0);
    ASSERT_TRUE(group.has_value()) << group.error().text();
    scenario::Flight flight(*session::flight_spec_of(tool, {}));
    Vec3 last_radps{};
    for (int k = 0; k < 500; ++k) {
      const scenario::FlightSample flown = flight.next();
      SensorSet faulty;
      const Sample sample = group->next(flown, faulty);
      EXPECT_TRUE(faulty.empty());
      const RateSample read = session::rate_sample(gyros, gyros.datasheet.model(), sample);
      const Vec3& w = flown.true_rate_radps;
      const double slope = k == 0 ? 0.0 : norm(minus(w, last_radps)) / 0.001;
      const double most = (e.scale + (1.0 + e.scale) * e.axis_rad) * norm(w) + e.bias_radps +
                          e.g_sensitivity_s_per_m * norm(flown.specific_force_mps2) + (1.0 + e.scale) * e.lag_s * slope;
      for (int i = 0; i < gyros.array.size(); ++i)
        EXPECT_NEAR(read.rate_radps[static_cast<std::size_t>(i)], dot(gyros.array.axis(i), w), most + 1e-6);
      last_radps = w;
    }
  }
}

TEST(FlightGyros, AFaultIsOnTheGyroThatItNamesAndAMagneticGroupIsRefused) {
  const io::ArrayFile tool = array_of(three_text());
  const io::ArrayFile& gyros = tool.groups.at(0);
  const auto faults = scenario::parse_faults("gy2:bias=20deg/s@0.1s", io::fault_context(gyros));
  ASSERT_TRUE(faults.has_value()) << faults.error();
  io::FileExpected<FlightGyros> healthy = FlightGyros::make(gyros, {}, 3, 0),
                                shifted = FlightGyros::make(gyros, *faults, 3, 0);
  scenario::Flight flight(*session::flight_spec_of(tool, {}));
  for (int k = 0; k < 200; ++k) {
    const scenario::FlightSample flown = flight.next();
    SensorSet none, faulty;
    const Sample a = healthy->next(flown, none), b = shifted->next(flown, faulty);
    EXPECT_EQ(faulty, k >= 100 ? SensorSet::of(4) : SensorSet{});
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(b.raw[i] - a.raw[i], i == 4 && k >= 100 ? 20.0 : 0.0, 1e-9);
  }
  EXPECT_TRUE(shifted->without_effect().empty());
  const std::string mag = plumb_test::read_text(PLUMB_SOURCE_DIR "/examples/six_axis.toml");
  const auto magnetic = io::parse_array_text(with(mag,
                                                  "model = \"wmm\"\nlatitude = \"60.4 deg\"\nlongitude = \"2.1 deg\"\n"
                                                  "date = \"2026-03-31\"",
                                                  "value = \"50.8 uT\""),
                                             "tool.toml", {}, "mag");
  ASSERT_TRUE(magnetic.has_value()) << magnetic.error().text();
  const auto refused = FlightGyros::make(*magnetic, {}, 1, 0);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().what.find("a flight has none"), std::string::npos);
}

/// What one gyro does from the 600th row on, as a fault of a chip.
const char* const kGyroFaults[] = {"",
                                   ":stuck=0deg/s@0.6s",
                                   ":last@0.6s",
                                   ":bias=30deg/s@0.6s",
                                   ":bias=-200deg/s@0.6s",
                                   ":scale=2@0.6s",
                                   ":drift=100deg/s/s@0.6s",
                                   ":missing@0.6s"};

struct Flown {
  session::MotionRun run;
  int bounds = 0, bounds_passed = 0;  ///< of the force of a sample
};

stepping::Rows row_of(const Sample& sample, int sensors) {
  stepping::Rows out;
  out.sensors = sensors;
  out.resize(1, false, false);
  out.row[0] = {sample.time_s, sample.temperature_degc, sample.delivered.bits, sample.station,
                sample.count,  sample.roll_group};
  for (std::size_t i = 0; i < out.raw.size(); ++i) out.raw[i] = sample.raw[i];
  return out;
}

/// Accelerometers and gyros of the file, row by row, as `plumb monitor --group gyros` has them.
Flown fly(const io::ArrayFile& tool, std::uint64_t seed, const std::vector<scenario::Fault>& own,
          const std::vector<scenario::Fault>& of_gyros, int rows) {
  session::FlightRequest request;
  request.seed = seed;
  scenario::Flight flight(*session::flight_spec_of(tool, request));
  const io::ArrayFile& gyros = tool.groups.at(0);
  FlightGyros group = *FlightGyros::make(gyros, of_gyros, seed, 0);
  scenario::Injector injector = *scenario::Injector::make(tool.datasheet, tool.datasheet.model(), own, seed);
  const std::unique_ptr<session::RateWatch> rates = *session::RateWatch::make(gyros, true);
  session::MotionWatch watch(*session::plan_motion(tool, nullptr, 0.0, nullptr, &rates->group()));
  watch.take_rates_of(*rates);
  Verdict rest;
  rest.in_service = tool.array.all();
  Flown out;
  struct Bounds final : session::MotionSink {
    io::FileExpected<void> take(double, const MotionVerdict& verdict, const std::vector<io::MotionEvent>&) override {
      last = verdict;
      return {};
    }
    MotionVerdict last;
  } bounds;
  watch.tell(bounds);
  std::array<Vec3, 2> before_mps2{};
  for (int k = 0; k < rows; ++k) {
    const scenario::FlightSample flown = flight.next();
    SensorSet faulty;
    EXPECT_TRUE(rates->take(row_of(group.next(flown, faulty), gyros.array.size())).has_value());
    Sample own_row;
    own_row.time_s = flown.time_s;
    own_row.delivered = tool.array.all();
    for (std::size_t i = 0; i < static_cast<std::size_t>(tool.array.size()); ++i)
      own_row.raw[i] = flown.reading_mps2[i];
    (void)injector.apply(own_row);
    EXPECT_TRUE(watch.take(own_row, rest).has_value());
    const SpecificForce& now = bounds.last.sample;
    const Vec3 mean_mps2 = scaled(plus(before_mps2[0], before_mps2[1]), 0.5);  // it is of the two samples before
    before_mps2 = {before_mps2[1], flown.specific_force_mps2};
    if (now.validity != ForceValidity::bounded) continue;
    EXPECT_NEAR(now.time_s, flown.time_s - 0.0015, 1e-9);
    ++out.bounds;
    out.bounds_passed += norm(minus(now.force_mps2, mean_mps2)) > now.bound_mps2 ? 1 : 0;
  }
  out.run = watch.run();
  return out;
}

std::vector<scenario::Fault> chip_faults(const io::ArrayFile& array, int chip, const std::string& what) {
  std::vector<scenario::Fault> out;
  for (int i = 3 * chip; i < 3 * chip + 3; ++i) {
    const auto one = scenario::parse_faults(array.array.row(i).id.data() + what, io::fault_context(array));
    EXPECT_TRUE(one.has_value()) << what;
    out.insert(out.end(), one->begin(), one->end());
  }
  return out;
}

// Whatever one chip of gyros does, 0.5 g of an accelerometer is named, nobody else is, and no bound is passed.
// Verifies: REQ-243
RC_GTEST_PROP(GyroGroupInMotionLaw, WhateverOneGyroChipDoesTheFaultyAccelerometersAreNamedAndNobodyElse, ()) {
  static const io::ArrayFile tool = array_of(three_text());
  const std::string what =
      *rc::gen::elementOf(std::vector<std::string>(std::begin(kGyroFaults), std::end(kGyroFaults)));
  const int gyro = *rc::gen::inRange(0, 3), sensor = *rc::gen::inRange(-1, tool.array.size());
  const double bias_g0 = *rc::gen::element(0.5, -0.5, 2.0);
  const auto seed = static_cast<std::uint64_t>(*rc::gen::inRange(0, 1 << 20));
  std::vector<scenario::Fault> own, of_gyros;
  if (!what.empty()) of_gyros = chip_faults(tool.groups[0], gyro, what);
  if (sensor >= 0) {
    const std::string text =
        std::string(tool.array.row(sensor).id.data()) + ":bias=" + std::to_string(bias_g0) + "g0@0.7s";
    own = *scenario::parse_faults(text, io::fault_context(tool));
  }
  const Flown flown = fly(tool, seed, own, of_gyros, 2000);
  RC_ASSERT(flown.bounds > 1500);
  RC_ASSERT(flown.bounds_passed == 0);
  const SensorSet faulty = sensor < 0 ? SensorSet{} : tool.array.units().whole(SensorSet::of(sensor));
  RC_ASSERT((flown.run.isolated - faulty).empty());
  RC_ASSERT(flown.run.isolated == faulty);
  RC_ASSERT((flown.run.alarms == 0) == (sensor < 0));
}

// A plan without the group, or with too few of its chips, judges no motion and says why.
// Negative: REQ-243
TEST(GyroGroupInMotion, WithoutTheGroupMotionIsNotJudged) {
  const io::ArrayFile tool = array_of(three_text());
  const auto alone = session::plan_motion(tool, nullptr, 0.0);
  ASSERT_FALSE(alone.has_value());
  EXPECT_EQ(alone.error().field, "gyro.group");
  EXPECT_NE(alone.error().what.find("motion is not judged"), std::string::npos);
  EXPECT_NE(alone.error().remedy.find("--group gyros"), std::string::npos);
  std::string two = three_text();
  two.erase(two.find("\n[[group.sensor]]\nid = \"gx3\""));
  const io::ArrayFile few = array_of(two);
  const auto group = session::rate_group(few.groups.at(0));
  ASSERT_TRUE(group.has_value());
  const auto refused = session::plan_motion(few, nullptr, 0.0, nullptr, &*group);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().what.find("2 triads"), std::string::npos) << refused.error().text();
  session::RateGroup open = *session::rate_group(tool.groups.at(0));
  open.common = std::numeric_limits<double>::infinity();
  const auto unbounded = session::plan_motion(tool, nullptr, 0.0, nullptr, &open);
  ASSERT_FALSE(unbounded.has_value());
  EXPECT_NE(unbounded.error().remedy.find("--turns"), std::string::npos) << unbounded.error().text();
}

// A row in which the gyros deliver nothing has no rate: what is stated of the fastest turn counts there.
// Negative: REQ-243
TEST(GyroGroupInMotion, ARowWithoutGyrosHasNoRate) {
  const io::ArrayFile tool = array_of(three_text());
  const io::ArrayFile& gyros = tool.groups.at(0);
  const std::unique_ptr<session::RateWatch> rates = *session::RateWatch::make(gyros, true);
  session::MotionWatch watch(*session::plan_motion(tool, nullptr, 0.0, nullptr, &rates->group()));
  watch.take_rates_of(*rates);
  Verdict rest;
  rest.in_service = tool.array.all();
  const auto both = [&](double time_s, SensorSet delivered) {
    Sample turn, still;
    turn.time_s = still.time_s = time_s;
    turn.delivered = delivered;
    still.delivered = tool.array.all();
    for (int i = 0; i < tool.array.size(); ++i) still.raw[static_cast<std::size_t>(i)] = 9.8 * tool.array.axis(i)[2];
    EXPECT_TRUE(rates->take(row_of(turn, gyros.array.size())).has_value());
    EXPECT_TRUE(watch.take(still, rest).has_value());
  };
  for (int k = 0; k < 12; ++k) both(0.001 * k, k < 6 ? gyros.array.all() : SensorSet::first(k < 10 ? 6 : 3));
  Sample alone;
  alone.time_s = 0.012;
  alone.delivered = tool.array.all();
  EXPECT_TRUE(watch.take(alone, rest).has_value());
  EXPECT_EQ(watch.run().inputs.gyro[0].rates, 8U)
      << "all but the first two, of which the slope is not known, two chips too";
  EXPECT_EQ(watch.run().inputs.gyro[0].missing, 3U) << "one chip alone, and the row without gyros";
  // Gyros in every second row: how the rate changes is never known, and that is told.
  for (int k = 0; k < 20; ++k) both(1.0 + 0.001 * k, k % 2 == 0 ? gyros.array.all() : SensorSet{});
  EXPECT_EQ(watch.run().inputs.gyro[0].rates, 8U);
  EXPECT_EQ(watch.run().inputs.gyro[0].missing, 23U);
}

}  // namespace
}  // namespace flight_gyros_test
