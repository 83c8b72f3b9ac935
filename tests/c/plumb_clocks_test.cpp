// Clocks of chips through the C header: what it answers is what MotionClocks and MotionMonitor answer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "motion/clocked_motion.hpp"
#include "plumb/c/plumb_motion.h"

namespace plumb_clocks_test {
namespace {

using namespace plumb;

/// A set-up of sensors without errors of their own, its C form, and room for a monitor.
struct CClocks {
  CClocks(const SensorArray& array, const MotionSetup& setup, const ClockSetup& stated) : wait_s(stated.wait_s) {
    plumb_motion_config_defaults(&config);
    sensor.resize(static_cast<std::size_t>(array.size()));
    for (int i = 0; i < array.size(); ++i) {
      plumb_motion_sensor& s = sensor[static_cast<std::size_t>(i)];
      plumb_motion_sensor_defaults(&s);
      std::memcpy(s.axis, array.axis(i).data(), sizeof s.axis);
      s.sigma_mps2 = array.sigma_mps2(i);
    }
    config.sensors = array.size();
    config.sensor = sensor.data();
    config.gyros = setup.gyros;
    config.gyro_noise_radps = setup.gyro.noise_radps;
    config.rate_bound_radps = setup.rate_bound_radps;
    clock.resize(static_cast<std::size_t>(stated.clocks));
    for (std::size_t c = 0; c < clock.size(); ++c) {
      const MotionClock& from = stated.clock[c];
      plumb_chip_clock& to = clock[c];
      plumb_chip_clock_defaults(&to);
      to.sensors = from.sensors.bits;
      for (std::size_t g = 0; g < from.gyro.size(); ++g) to.gyros |= from.gyro[g] ? 1U << g : 0U;
      to.sample_period_s = from.sample_period_s;
      to.offset_s = from.offset_s;
      to.rate = from.rate;
      to.since_s = from.since_s;
      to.valid_s = from.valid_s;
      to.offset_bound_s = from.offset_bound_s;
      to.rate_bound = from.rate_bound;
    }
  }
  plumb_error init() {
    return plumb_clocks_init(storage.data(), 8 * storage.size(), &config, clock.data(),
                             static_cast<std::int32_t>(clock.size()), wait_s, &clocks);
  }

  double wait_s;
  std::vector<plumb_motion_sensor> sensor;
  std::vector<plumb_chip_clock> clock;
  plumb_motion_config config{};
  std::vector<std::uint64_t> storage = std::vector<std::uint64_t>(plumb_clocks_size() / 8 + 1);
  plumb_clocks* clocks = nullptr;
};

MotionSetup plain_setup() {
  MotionSetup out;
  out.gyros = 2;
  out.gyro.noise_radps = 1e-3;
  out.rate_bound_radps = 10.0;
  return out;
}

plumb_motion_sample c_form(const MotionSample& s) {
  plumb_motion_sample out;
  plumb_motion_sample_defaults(&out);
  out.time_s = s.time_s;
  out.delivered = s.delivered.bits;
  for (std::size_t i = 0; i < static_cast<std::size_t>(kMotionCapacity); ++i) out.reading_mps2[i] = s.reading_mps2[i];
  for (std::size_t g = 0; g < static_cast<std::size_t>(kGyros); ++g) {
    std::memcpy(out.rate_radps[g], s.rate_radps[g].data(), sizeof out.rate_radps[g]);
    out.rates_given |= s.rate_given[g] ? 1U << g : 0U;
  }
  return out;
}

// Verifies: REQ-207
TEST(CClocks, AnswersAsClocksAndMonitorDoThroughAFault) {
  plumb_test::Noise noise(7);
  SensorArray array = plumb_test::cone_array(6, 0.01);
  const SensorArray sensors = array;
  MotionSetup setup = plain_setup();
  const MotionSetup bounds = setup;
  const ClockSetup stated = plumb_test::clocks_of(6, 6, setup, noise);
  CClocks c(array, setup, stated);
  ASSERT_EQ(c.init().code, PLUMB_OK);
  const auto clocks = std::make_unique<MotionClocks>();
  const auto monitor = std::make_unique<MotionMonitor>();
  ASSERT_TRUE(clocks->configure(array, setup, stated).has_value());
  ASSERT_TRUE(with_clocks(stated, array, setup).has_value());
  ASSERT_TRUE(monitor->configure(array, setup).has_value());
  plumb_test::RigidMotion motion(sensors, bounds, 7);
  plumb_test::ChipClocks chips(stated, noise, true);
  plumb_motion_verdict verdict;
  plumb_motion_verdict_defaults(&verdict);
  int steps = 0, alarms = 0;
  for (int k = 0; k < 800; ++k) {
    const double now_s = 0.0005 * k;
    chips.deliver(
        now_s, *clocks,
        [&](int, double t) {
          MotionSample s = motion.sample_at(t);
          if (t > 0.2) s.reading_mps2[1] += 5.0;
          return s;
        },
        [&](int clock, const MotionSample& s) {
          const plumb_motion_sample sample = c_form(s);
          std::int32_t push = -1;
          EXPECT_EQ(plumb_clocks_push(c.clocks, clock, &sample, &push).code, PLUMB_OK);
          EXPECT_STREQ(plumb_clock_push_text(push), "taken");
        });
    MotionSample common;
    std::int32_t drawn = 0;
    while (clocks->next(now_s, common)) {
      const MotionVerdict& v = monitor->step(common);
      ASSERT_EQ(plumb_clocks_next(c.clocks, now_s, &verdict, &drawn).code, PLUMB_OK);
      EXPECT_EQ(drawn, 1);
      EXPECT_EQ(verdict.isolated, v.isolated.bits);
      EXPECT_EQ(verdict.excluded, v.excluded.bits);
      EXPECT_EQ(verdict.block.bound_mps2, v.block.bound_mps2);
      EXPECT_EQ(std::memcmp(verdict.sample.force_mps2, v.sample.force_mps2.data(), sizeof verdict.sample.force_mps2),
                0);
      ++steps;
      alarms += v.alarm ? 1 : 0;
    }
    EXPECT_EQ(plumb_clocks_next(c.clocks, now_s, &verdict, &drawn).code, PLUMB_OK);
    EXPECT_EQ(drawn, 0);
  }
  EXPECT_GT(steps, 350);
  EXPECT_GT(alarms, 20);
  EXPECT_EQ(verdict.excluded, SensorSet::of(1).bits);
  EXPECT_EQ(plumb_motion_forget(plumb_clocks_motion(c.clocks)).code, PLUMB_OK);
}

TEST(CClocks, SayWhatIsWrong) {
  plumb_test::Noise noise(8);
  const SensorArray array = plumb_test::cone_array(5, 0.01);
  const MotionSetup setup = plain_setup();
  const ClockSetup stated = plumb_test::clocks_of(5, 5, setup, noise);
  const auto refused = [&](auto spoil) {
    CClocks c(array, setup, stated);
    spoil(c);
    const plumb_error e = c.init();
    EXPECT_EQ(c.clocks == nullptr, e.code != PLUMB_OK);
    return e;
  };
  EXPECT_EQ(refused([](CClocks&) {}).code, PLUMB_OK);
  EXPECT_EQ(refused([](CClocks& c) { c.clock[1].sensors = 0; }).index, 1);
  EXPECT_EQ(refused([](CClocks& c) { c.clock[2].rate = std::nan(""); }).index, 222);
  EXPECT_EQ(refused([](CClocks& c) { c.wait_s = 1.0; }).index, 198);
  EXPECT_EQ(refused([](CClocks& c) { c.clock.resize(kMotionClocks + 1); }).index, 199);
  EXPECT_EQ(refused([](CClocks& c) { c.clock[3].struct_size = 1; }).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(refused([](CClocks& c) { c.config.sensors = 2; }).code, static_cast<int>(Errc::too_few_sensors));
  EXPECT_EQ(refused([](CClocks& c) { c.storage.resize(2); }).code, PLUMB_STORAGE_TOO_SMALL);
  EXPECT_EQ(plumb_chip_clock_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_clocks_capacity(), kMotionClocks);
  EXPECT_EQ(plumb_clocks_align() % alignof(double), 0U);
  EXPECT_STREQ(plumb_clock_push_text(-1), "?");
}

TEST(CClocks, MisuseIsAnsweredAndLeavesNoForceBehind) {
  plumb_test::Noise noise(9);
  const SensorArray array = plumb_test::cone_array(5, 0.01);
  const MotionSetup setup = plain_setup();
  CClocks c(array, setup, plumb_test::clocks_of(5, 5, setup, noise));
  plumb_motion_sample sample;
  plumb_motion_sample_defaults(&sample);
  plumb_motion_verdict verdict;
  plumb_motion_verdict_defaults(&verdict);
  verdict.sample.validity = PLUMB_FORCE_BOUNDED;
  std::int32_t drawn = 1, push = 0;
  EXPECT_EQ(plumb_clocks_next(nullptr, 0.0, &verdict, &drawn).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(verdict.sample.validity, PLUMB_FORCE_NONE);
  EXPECT_EQ(drawn, 0);
  auto* nowhere = reinterpret_cast<plumb_clocks*>(c.storage.data());
  EXPECT_EQ(plumb_clocks_push(nowhere, 0, &sample, &push).code, PLUMB_NOT_INITIALISED);
  EXPECT_STREQ(plumb_clock_push_text(push), "not_configured");
  EXPECT_EQ(plumb_clocks_motion(nowhere), nullptr);
  EXPECT_EQ(plumb_clocks_set(nullptr, 0, 0.0, 0.0, 0.0).code, PLUMB_NULL_POINTER);
  ASSERT_EQ(c.init().code, PLUMB_OK);
  EXPECT_EQ(plumb_clocks_set(c.clocks, 0, 0.0, 1.0, 0.0).index, 202);
  EXPECT_EQ(plumb_clocks_set(c.clocks, 0, 1.0, 0.0, 1.0).code, PLUMB_OK);
  EXPECT_EQ(plumb_clocks_push(c.clocks, 9, &sample, &push).code, PLUMB_OK);
  EXPECT_STREQ(plumb_clock_push_text(push), "unknown_clock");
  sample.struct_size = 1;
  EXPECT_EQ(plumb_clocks_push(c.clocks, 0, &sample, nullptr).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(plumb_clocks_next(c.clocks, 0.0, &verdict, nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_clocks_next(c.clocks, std::nan(""), nullptr, &drawn).code, PLUMB_OK);
  EXPECT_EQ(drawn, 0);
}

}  // namespace
}  // namespace plumb_clocks_test
