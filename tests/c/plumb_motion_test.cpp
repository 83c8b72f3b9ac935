// The monitor of motion through the C header: what it answers is what MotionMonitor answers, and no misuse is misread.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "motion/rigid_motion.hpp"
#include "plumb/c/plumb_motion.h"
#include "plumb/motion/continuous_inclination.hpp"

namespace plumb_motion_test {
namespace {

using namespace plumb;

/// A set-up in its C form, and room for a monitor.
struct CMotion {
  CMotion(const SensorArray& array, const MotionSetup& setup) {
    plumb_motion_config_defaults(&config);
    sensor.resize(static_cast<std::size_t>(array.size()));
    for (int i = 0; i < array.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const MotionErrors& e = setup.errors[k];
      plumb_motion_sensor_defaults(&sensor[k]);
      std::memcpy(sensor[k].axis, array.axis(i).data(), sizeof sensor[k].axis);
      std::memcpy(sensor[k].lever_arm_m, setup.lever_arm_m[k].data(), sizeof sensor[k].lever_arm_m);
      sensor[k].sigma_mps2 = array.sigma_mps2(i);
      sensor[k].chip = array.row(i).chip;
      sensor[k].lever_bound_m = e.lever_m;
      sensor[k].lag_bound_s = e.lag_s;
      sensor[k].rectification_bound = e.rectification;
      sensor[k].scale_bound = e.scale;
      sensor[k].axis_bound_rad = e.axis_rad;
      sensor[k].bias_bound_mps2 = e.bias_mps2;
    }
    config.sensors = array.size();
    config.sensor = sensor.data();
    config.gyros = setup.gyros;
    config.gyro_corroborated = setup.gyro_corroborated ? 1 : 0;
    config.gyro_scale_bound = setup.gyro.scale;
    config.gyro_axis_bound_rad = setup.gyro.axis_rad;
    config.gyro_bias_bound_radps = setup.gyro.bias_radps;
    config.gyro_noise_radps = setup.gyro.noise_radps;
    config.gyro_lag_bound_s = setup.gyro.lag_s;
    config.rate_bound_radps = setup.rate_bound_radps;
    config.sample_period_s = setup.sample_period_s;
    config.shortest_block = setup.shortest_block;
    std::copy(setup.block_samples.begin(), setup.block_samples.end(), config.block_samples);
    config.max_faults = setup.max_faults;
  }
  plumb_error init() { return plumb_motion_init(storage.data(), 8 * storage.size(), &config, &motion); }

  std::vector<plumb_motion_sensor> sensor;
  plumb_motion_config config{};
  std::vector<std::uint64_t> storage = std::vector<std::uint64_t>(plumb_motion_size() / 8 + 1);
  plumb_motion* motion = nullptr;
};

plumb_motion_sample c_form(const MotionSample& s) {
  plumb_motion_sample out;
  plumb_motion_sample_defaults(&out);
  out.time_s = s.time_s;
  out.delivered = s.delivered.bits;
  out.clipped = s.clipped.bits;
  for (std::size_t i = 0; i < static_cast<std::size_t>(kMotionCapacity); ++i) out.reading_mps2[i] = s.reading_mps2[i];
  for (std::size_t g = 0; g < static_cast<std::size_t>(kGyros); ++g) {
    std::memcpy(out.rate_radps[g], s.rate_radps[g].data(), sizeof out.rate_radps[g]);
    out.rates_given |= s.rate_given[g] ? 1U << g : 0U;
    out.rate_error_radps[g] = s.interpolation_radps[g];
  }
  return out;
}

void expect_same(const plumb_specific_force& a, const SpecificForce& b) {
  EXPECT_EQ(a.validity, static_cast<int>(b.validity));
  EXPECT_EQ(a.dominant, static_cast<int>(b.dominant));
  EXPECT_EQ(a.used, b.used.bits);
  EXPECT_EQ(a.gyro_assumed != 0, b.gyro_assumed);
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.span_s, b.span_s);
  EXPECT_EQ(std::memcmp(a.force_mps2, b.force_mps2.data(), sizeof a.force_mps2), 0);
  EXPECT_EQ(std::memcmp(a.covariance_m2ps4, b.covariance_m2ps4.data(), sizeof a.covariance_m2ps4), 0);
  EXPECT_EQ(a.bound_mps2, b.bound_mps2);
}

void expect_same(const plumb_motion_verdict& a, const MotionVerdict& b) {
  EXPECT_EQ(a.alarm != 0, b.alarm);
  EXPECT_EQ(a.block_ended != 0, b.block_ended);
  EXPECT_EQ(a.rejected, b.rejected.bits);
  EXPECT_EQ(a.suspects, b.suspects.bits);
  EXPECT_EQ(a.isolated, b.isolated.bits);
  EXPECT_EQ(a.excluded, b.excluded.bits);
  EXPECT_EQ(a.least_faults, b.least_faults);
  EXPECT_EQ(a.cause, static_cast<int>(b.cause));
  expect_same(a.sample, b.sample);
  expect_same(a.block, b.block);
}

// Verifies: REQ-201, REQ-205
TEST(CMotion, AnswersAsTheMonitorDoesThroughAFaultAndItsExclusion) {
  MotionSetup setup = plumb_test::motion_setup(6, 3);
  setup.gyros = 2;
  const SensorArray array = plumb_test::cone_array(6, 0.01);
  plumb_test::RigidMotion flight(array, setup, 3);
  MotionMonitor monitor;
  ASSERT_TRUE(monitor.configure(array, setup).has_value());
  CMotion c(array, setup);
  ASSERT_EQ(c.init().code, PLUMB_OK);
  plumb_motion_verdict verdict;
  plumb_motion_verdict_defaults(&verdict);
  for (std::uint64_t k = 0; k < 900 && !HasFailure(); ++k) {
    MotionSample s = flight.sample(k);
    if (k >= 300) s.reading_mps2[4] += 3.0;
    if (k % 2 == 0) s.interpolation_radps = {0.02, 0.01};
    if (k == 700) {
      monitor.set_in_service(array.all().without(1));
      EXPECT_EQ(plumb_motion_set_in_service(c.motion, array.all().without(1).bits).code, PLUMB_OK);
    }
    if (k == 800) {
      EXPECT_EQ(verdict.excluded, SensorSet::of(4).bits);
      monitor.forget();
      EXPECT_EQ(plumb_motion_forget(c.motion).code, PLUMB_OK);
    }
    const plumb_motion_sample sample = c_form(s);
    EXPECT_EQ(plumb_motion_step(c.motion, &sample, &verdict).code, PLUMB_OK);
    expect_same(verdict, monitor.step(s));
  }
  const plumb_motion_sample sample = c_form(flight.sample(900));
  EXPECT_EQ(plumb_motion_step(c.motion, &sample, nullptr).code, PLUMB_OK) << "the verdict may be null";
}

/// What init answers to a set-up that is spoilt.
template <class Spoil>
plumb_error refused(Spoil spoil) {
  CMotion c(plumb_test::cone_array(5, 0.01), plumb_test::motion_setup(5));
  spoil(c);
  const plumb_error e = c.init();
  EXPECT_EQ(c.motion == nullptr, e.code != PLUMB_OK);
  return e;
}

TEST(CMotion, SaysWhatIsWrongWithASetUp) {
  const auto number = [](Errc code) { return static_cast<int>(code); };
  EXPECT_EQ(refused([](CMotion&) {}).code, PLUMB_OK);
  EXPECT_EQ(refused([](CMotion& c) { c.config.sensors = 2; }).code, number(Errc::too_few_sensors));
  EXPECT_EQ(refused([](CMotion& c) { c.config.sensors = 1000; }).code, number(Errc::too_many_sensors));
  EXPECT_EQ(refused([](CMotion& c) { c.config.sensor = nullptr; }).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(refused([](CMotion& c) { c.config.struct_size = 7; }).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(refused([](CMotion& c) { c.storage.resize(2); }).code, PLUMB_STORAGE_TOO_SMALL);
  const plumb_error sensor = refused([](CMotion& c) { c.sensor[3].struct_size = 7; });
  EXPECT_EQ(sensor.code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(sensor.index, 3);
  const plumb_error chip = refused([](CMotion& c) { c.sensor[2].chip = 256; });
  EXPECT_EQ(chip.code, number(Errc::out_of_range));
  EXPECT_EQ(chip.index, 2);
  EXPECT_EQ(refused([](CMotion& c) { c.sensor[1].lag_bound_s = std::nan(""); }).index, 1);
  EXPECT_EQ(refused([](CMotion& c) { c.sensor[1].axis[0] = 9.0; }).code, number(Errc::axis_not_unit));
  EXPECT_EQ(refused([](CMotion& c) { c.config.gyros = 3; }).index, 101);
  EXPECT_EQ(refused([](CMotion& c) { c.config.shortest_block = 33; }).index, 113);
  EXPECT_EQ(refused([](CMotion& c) { c.config.block_samples[2] = 33; }).index, 116);
}

TEST(CMotion, MisuseIsAnsweredAndLeavesNoForceBehind) {
  CMotion c(plumb_test::cone_array(5, 0.01), plumb_test::motion_setup(5));
  plumb_motion_sample sample;
  plumb_motion_sample_defaults(&sample);
  plumb_motion_verdict verdict;
  plumb_motion_verdict_defaults(&verdict);
  verdict.sample.validity = PLUMB_FORCE_BOUNDED;
  EXPECT_EQ(plumb_motion_step(nullptr, &sample, &verdict).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(verdict.sample.validity, PLUMB_FORCE_NONE);
  auto* nowhere = reinterpret_cast<plumb_motion*>(c.storage.data());
  EXPECT_EQ(plumb_motion_step(nowhere, &sample, &verdict).code, PLUMB_NOT_INITIALISED);
  EXPECT_EQ(plumb_motion_forget(nowhere).code, PLUMB_NOT_INITIALISED);
  EXPECT_EQ(plumb_motion_set_in_service(nullptr, 1).code, PLUMB_NULL_POINTER);
  ASSERT_EQ(c.init().code, PLUMB_OK);
  sample.struct_size = 1;
  EXPECT_EQ(plumb_motion_step(c.motion, &sample, &verdict).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(plumb_motion_init(c.storage.data(), 8 * c.storage.size(), nullptr, &c.motion).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_motion_init(c.storage.data(), 8 * c.storage.size(), &c.config, nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_motion_config_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_motion_sensor_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_motion_sample_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_motion_verdict_defaults(nullptr).code, PLUMB_NULL_POINTER);
}

TEST(CMotion, EveryNumberHasAName) {
  EXPECT_STREQ(plumb_force_validity_text(PLUMB_FORCE_BOUNDED), "bounded");
  EXPECT_STREQ(plumb_force_term_text(1), "lever arm");
  EXPECT_STREQ(plumb_motion_cause_text(2), "gyro_inconsistent");
  for (const int number : {-1, 99, 1 << 30}) {
    EXPECT_STREQ(plumb_force_validity_text(number), "?");
    EXPECT_STREQ(plumb_force_term_text(number), "?");
    EXPECT_STREQ(plumb_motion_cause_text(number), "?");
  }
  EXPECT_EQ(plumb_motion_capacity(), kMotionCapacity);
}

/// Inclination in its C form, on top of a monitor's.
struct CInclination {
  CInclination() {
    plumb_inclination_config_defaults(&config);
    config.axis_bound_rad = 0.002;
    config.velocity_bound_mps = 0.1;
    config.window_s = 1.0;
  }
  plumb_error init(const CMotion& c) {
    return plumb_inclination_init(storage.data(), 8 * storage.size(), &c.config, &config, &inclination);
  }
  plumb_inclination_config config{};
  std::vector<std::uint64_t> storage = std::vector<std::uint64_t>(plumb_inclination_size() / 8 + 1);
  plumb_inclination* inclination = nullptr;
};

InclinationSetup cpp_form(const plumb_inclination_config& config) {
  InclinationSetup out;
  out.axis = {config.axis[0], config.axis[1], config.axis[2]};
  out.axis_bound_rad = config.axis_bound_rad;
  out.velocity_bound_mps = config.velocity_bound_mps;
  out.window_s = config.window_s;
  out.gravity_mps2 = config.gravity_mps2;
  out.gravity_bound_mps2 = config.gravity_bound_mps2;
  return out;
}

void expect_same(const plumb_inclination_interval& a, const InclinationInterval& b) {
  EXPECT_EQ(a.status, static_cast<int>(b.status));
  EXPECT_EQ(a.widest, static_cast<int>(b.widest));
  EXPECT_EQ(a.gyro_assumed != 0, b.gyro_assumed);
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.span_s, b.span_s);
  EXPECT_EQ(a.inclination_rad, b.inclination_rad);
  EXPECT_EQ(a.low_rad, b.low_rad);
  EXPECT_EQ(a.high_rad, b.high_rad);
}

/// A tool at rest, but for a rate about its axis; its gyro falls silent for a while.
MotionSample turning_sample(const SensorArray& array, std::uint64_t k) {
  MotionSample out;
  out.time_s = 0.001 * static_cast<double>(k);
  out.delivered = array.all();
  for (int i = 0; i < array.size(); ++i)
    out.reading_mps2[static_cast<std::size_t>(i)] = dot(array.axis(i), {4.0, 0.0, -8.9});
  for (std::size_t g = 0; g < 2; ++g) {
    out.rate_radps[g] = {0.0, 0.0, 1.0};
    out.rate_given[g] = k < 2500 || k > 2540;
  }
  return out;
}

// Verifies: REQ-211
TEST(CInclination, AnswersAsContinuousInclinationDoes) {
  MotionSetup setup = plumb_test::motion_setup(6, 3);
  setup.gyros = 2;
  const SensorArray array = plumb_test::cone_array(6, 0.01);
  CMotion c(array, setup);
  CInclination tilt;
  ASSERT_EQ(c.init().code, PLUMB_OK);
  ASSERT_EQ(tilt.init(c).code, PLUMB_OK);
  MotionMonitor monitor;
  ContinuousInclination inclination;
  ASSERT_TRUE(monitor.configure(array, setup).has_value());
  ASSERT_TRUE(inclination.configure(array, setup, cpp_form(tilt.config)).has_value());
  plumb_inclination_interval interval;
  plumb_inclination_interval_defaults(&interval);
  int known = 0, without_rate = 0;
  for (std::uint64_t k = 0; k < 4500 && !HasFailure(); ++k) {
    const MotionSample s = turning_sample(array, k);
    const plumb_motion_sample sample = c_form(s);
    ASSERT_EQ(plumb_motion_step(c.motion, &sample, nullptr).code, PLUMB_OK);
    ASSERT_EQ(plumb_inclination_step(tilt.inclination, &sample, c.motion, &interval).code, PLUMB_OK);
    EXPECT_EQ(interval.is_new != 0, inclination.step(s, monitor.step(s)));
    expect_same(interval, inclination.interval());
    known += interval.is_new != 0 && interval.status == PLUMB_INCLINATION_KNOWN ? 1 : 0;
    without_rate += interval.status == PLUMB_INCLINATION_RATE_UNKNOWN ? 1 : 0;
  }
  EXPECT_GE(known, 3);
  EXPECT_GT(without_rate, 0);
}

TEST(CInclination, MisuseIsAnsweredAndLeavesNoAngleBehind) {
  CMotion c(plumb_test::cone_array(5, 0.01), plumb_test::motion_setup(5));
  ASSERT_EQ(c.init().code, PLUMB_OK);
  CInclination without_bound;
  plumb_inclination_config_defaults(&without_bound.config);
  EXPECT_EQ(without_bound.init(c).index, 201) << "the bound of the axis has no default";
  EXPECT_EQ(without_bound.inclination, nullptr);
  CInclination tilt;
  plumb_motion_sample sample;
  plumb_motion_sample_defaults(&sample);
  plumb_inclination_interval interval;
  plumb_inclination_interval_defaults(&interval);
  interval.status = PLUMB_INCLINATION_KNOWN;
  auto* nowhere = reinterpret_cast<plumb_inclination*>(tilt.storage.data());
  EXPECT_EQ(plumb_inclination_step(nowhere, &sample, c.motion, &interval).code, PLUMB_NOT_INITIALISED);
  EXPECT_EQ(interval.status, PLUMB_INCLINATION_FILLING);
  EXPECT_EQ(plumb_inclination_init(tilt.storage.data(), 8, &c.config, &tilt.config, &tilt.inclination).code,
            PLUMB_STORAGE_TOO_SMALL);
  ASSERT_EQ(tilt.init(c).code, PLUMB_OK);
  EXPECT_EQ(plumb_inclination_step(nullptr, &sample, c.motion, &interval).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_inclination_step(tilt.inclination, &sample, nullptr, &interval).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_inclination_step(tilt.inclination, &sample, c.motion, nullptr).code, PLUMB_NULL_POINTER);
  interval.struct_size = 3;
  EXPECT_EQ(plumb_inclination_step(tilt.inclination, &sample, c.motion, &interval).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(plumb_inclination_config_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_inclination_interval_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_STREQ(plumb_inclination_status_text(PLUMB_INCLINATION_NO_FORCE), "no_force");
  EXPECT_STREQ(plumb_inclination_term_text(1), "velocity");
  EXPECT_STREQ(plumb_inclination_status_text(77), "?");
  EXPECT_STREQ(plumb_inclination_term_text(-1), "?");
}

}  // namespace
}  // namespace plumb_motion_test
