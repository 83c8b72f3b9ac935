// Redundant gyros through the C header: what it answers is what the C++ answers, and no misuse is misread.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "motion/gyro_array.hpp"
#include "plumb/c/plumb_rates.h"
#include "plumb/motion/median_rate.hpp"

namespace plumb_rates_test {
namespace {

using namespace plumb;
using plumb_test::cone_array;
using plumb_test::GyroArray;
using plumb_test::rate_setup;

constexpr double kNoise_radps = 0.002;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A set-up in its C form, and room for a monitor.
struct CRates {
  CRates(const SensorArray& array, const RateSetup& setup) : axis(static_cast<std::size_t>(array.size())) {
    plumb_rates_config_defaults(&config);
    for (int i = 0; i < array.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const RateErrors& e = setup.errors[k];
      plumb_gyro_axis_defaults(&axis[k]);
      std::memcpy(axis[k].axis, array.axis(i).data(), sizeof axis[k].axis);
      axis[k].sigma_radps = array.sigma_mps2(i);
      axis[k].chip = array.row(i).chip;
      axis[k].scale_bound = e.scale;
      axis[k].axis_bound_rad = e.axis_rad;
      axis[k].bias_bound_radps = e.bias_radps;
      axis[k].lag_bound_s = e.lag_s;
      axis[k].g_sensitivity_bound_s_per_m = e.g_sensitivity_s_per_m;
    }
    config.axes = array.size();
    config.axis = axis.data();
    config.max_faults = setup.max_faults;
    std::copy(setup.block_samples.begin(), setup.block_samples.end(), config.block_samples);
    config.sample_period_s = setup.sample_period_s;
    config.rate_bound_radps = setup.rate_bound_radps;
    config.force_bound_mps2 = setup.force_bound_mps2;
    config.at_rest_radps = setup.at_rest_radps;
    config.false_alarms_per_hour = setup.false_alarms_per_hour;
    config.dwell_s = setup.dwell_s;
    config.quiet_s = setup.quiet_s;
  }
  plumb_error init() { return plumb_rates_init(storage.data(), 8 * storage.size(), &config, &rates); }

  std::vector<plumb_gyro_axis> axis;
  plumb_rates_config config{};
  std::vector<std::uint64_t> storage = std::vector<std::uint64_t>(plumb_rates_size() / 8 + 1);
  plumb_rates* rates = nullptr;
};

plumb_rates_sample c_form(const RateSample& s) {
  plumb_rates_sample out;
  plumb_rates_sample_defaults(&out);
  out.time_s = s.time_s;
  out.delivered = s.delivered.bits;
  out.clipped = s.clipped.bits;
  out.at_rest = s.at_rest ? 1 : 0;
  out.force_mps2 = s.force_mps2;
  for (std::size_t i = 0; i < static_cast<std::size_t>(kMotionCapacity); ++i) out.rate_radps[i] = s.rate_radps[i];
  return out;
}

bool same(const plumb_angular_rate& a, const AngularRate& b) {
  return a.validity == static_cast<int>(b.validity) && a.used == b.used.bits && a.time_s == b.time_s &&
         a.span_s == b.span_s && std::memcmp(a.rate_radps, b.rate_radps.data(), sizeof a.rate_radps) == 0 &&
         std::memcmp(a.covariance_rad2ps2, b.covariance_rad2ps2.data(), sizeof a.covariance_rad2ps2) == 0 &&
         a.bound_radps == b.bound_radps;
}

bool same(const plumb_rates_verdict& a, const RateVerdict& b) {
  return a.suspects == b.suspects.bits && a.isolated == b.isolated.bits && a.excluded == b.excluded.bits &&
         a.off_at_rest == b.off_at_rest.bits && (a.alarm != 0) == b.alarm &&
         (a.turned_at_rest != 0) == b.turned_at_rest && (a.block_ended != 0) == b.block_ended &&
         a.cause == static_cast<int>(b.cause) && same(a.sample, b.sample) && same(a.block, b.block);
}

// One axis is off from a drawn sample on, in motion or at rest; the host says forces, or not, and forgets once.
// Verifies: REQ-213
RC_GTEST_PROP(CRatesLaw, AnswersAsTheMonitorDoesThroughAFault, ()) {
  const int n = *rc::gen::inRange(4, 9);
  GyroArray gyros(cone_array(n, kNoise_radps), rate_setup(), *rc::gen::arbitrary<std::uint32_t>());
  CRates c(gyros.array, gyros.setup);
  RC_ASSERT(c.init().code == PLUMB_OK);
  const auto faulty = static_cast<std::size_t>(*rc::gen::inRange(0, n));
  const auto from = static_cast<std::uint64_t>(*rc::gen::inRange(0, 200));
  const double size = *rc::gen::element(0.05, -1.0, 40.0, kNan, static_cast<double>(INFINITY));
  const bool clipped = *rc::gen::arbitrary<bool>(), force_known = *rc::gen::arbitrary<bool>();
  gyros.at_rest = *rc::gen::arbitrary<bool>();
  plumb_rates_verdict verdict;
  plumb_rates_verdict_defaults(&verdict);
  for (std::uint64_t k = 0; k < 400; ++k) {
    RateSample s = gyros.sample(k);
    if (k >= from) s.rate_radps[faulty] += size;
    if (k >= from && clipped) s.clipped = SensorSet::of(static_cast<int>(faulty));
    if (!force_known) s.force_mps2 = -1.0;
    if (k == 350) {
      gyros.monitor.forget();
      RC_ASSERT(plumb_rates_forget(c.rates).code == PLUMB_OK);
    }
    const plumb_rates_sample sample = c_form(s);
    RC_ASSERT(plumb_rates_step(c.rates, &sample, &verdict).code == PLUMB_OK);
    RC_ASSERT(same(verdict, gyros.monitor.step(s)));
  }
}

TEST(CRates, ExcludesTheAxisThatSticksAndGoesOn) {
  GyroArray gyros(cone_array(6, kNoise_radps), rate_setup(), 3);
  CRates c(gyros.array, gyros.setup);
  ASSERT_EQ(c.init().code, PLUMB_OK);
  plumb_rates_verdict verdict;
  plumb_rates_verdict_defaults(&verdict);
  for (std::uint64_t k = 0; k < 1000; ++k) {
    plumb_rates_sample sample = c_form(gyros.sample(k));
    if (k >= 300) sample.rate_radps[4] = 0.0;
    ASSERT_EQ(plumb_rates_step(c.rates, &sample, k % 3 == 0 ? nullptr : &verdict).code, PLUMB_OK);
  }
  EXPECT_EQ(verdict.excluded, SensorSet::of(4).bits);
  EXPECT_EQ(verdict.sample.validity, PLUMB_FORCE_BOUNDED);
  EXPECT_EQ(verdict.sample.used, gyros.array.all().without(4).bits);
}

TEST(CRates, DefaultsAreThoseOfTheMonitor) {
  const RateSetup d;
  plumb_rates_config config;
  ASSERT_EQ(plumb_rates_config_defaults(&config).code, PLUMB_OK);
  EXPECT_EQ(config.max_faults, d.max_faults);
  EXPECT_EQ(config.block_samples[2], d.block_samples[2]);
  EXPECT_EQ(config.sample_period_s, d.sample_period_s);
  EXPECT_EQ(config.rate_bound_radps, d.rate_bound_radps);
  EXPECT_EQ(config.force_bound_mps2, d.force_bound_mps2);
  EXPECT_EQ(config.at_rest_radps, d.at_rest_radps);
  EXPECT_EQ(config.false_alarms_per_hour, d.false_alarms_per_hour);
  EXPECT_EQ(config.dwell_s, d.dwell_s);
  EXPECT_EQ(config.quiet_s, d.quiet_s);
}

/// What init answers to a set-up that is spoilt.
template <class Spoil>
plumb_error refused(Spoil spoil) {
  CRates c(cone_array(5, kNoise_radps), rate_setup());
  spoil(c);
  const plumb_error e = c.init();
  EXPECT_EQ(c.rates == nullptr, e.code != PLUMB_OK);
  return e;
}

void expect(const plumb_error& e, Errc code, int index) {
  EXPECT_EQ(e.code, static_cast<int>(code));
  EXPECT_EQ(e.index, index);
}

// Negative: REQ-213
TEST(CRates, SaysWhatIsWrongWithASetUp) {
  EXPECT_EQ(refused([](CRates&) {}).code, PLUMB_OK);
  expect(refused([](CRates& c) { c.config.axes = 2; }), Errc::too_few_sensors, -1);
  expect(refused([](CRates& c) { c.config.axes = 1000; }), Errc::too_many_sensors, -1);
  EXPECT_EQ(refused([](CRates& c) { c.config.axis = nullptr; }).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(refused([](CRates& c) { c.config.struct_size = 7; }).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(refused([](CRates& c) { c.storage.resize(2); }).code, PLUMB_STORAGE_TOO_SMALL);
  const plumb_error axis = refused([](CRates& c) { c.axis[3].struct_size = 7; });
  EXPECT_EQ(axis.code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(axis.index, 3);
  expect(refused([](CRates& c) { c.axis[2].chip = 256; }), Errc::out_of_range, 2);
  expect(refused([](CRates& c) { c.axis[1].axis[0] = 9.0; }), Errc::axis_not_unit, 1);
  expect(refused([](CRates& c) { c.axis[1].g_sensitivity_bound_s_per_m = kNan; }), Errc::not_finite, 1);
  EXPECT_EQ(refused([](CRates& c) { c.axis[4].lag_bound_s = kNan; }).index, 4);
  expect(refused([](CRates& c) { c.config.at_rest_radps = kNan; }), Errc::not_finite, 120);
  expect(refused([](CRates& c) { c.config.force_bound_mps2 = -1.0; }), Errc::out_of_range, 121);
  expect(refused([](CRates& c) { c.config.rate_bound_radps = 0.0; }), Errc::out_of_range, 107);
  EXPECT_EQ(refused([](CRates& c) { c.config.block_samples[2] = 33; }).index, 116);
}

TEST(CRates, MisuseIsAnsweredAndLeavesNoRateBehind) {
  CRates c(cone_array(5, kNoise_radps), rate_setup());
  plumb_rates_sample sample;
  plumb_rates_sample_defaults(&sample);
  plumb_rates_verdict verdict;
  plumb_rates_verdict_defaults(&verdict);
  verdict.sample.validity = PLUMB_FORCE_BOUNDED;
  EXPECT_EQ(plumb_rates_step(nullptr, &sample, &verdict).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(verdict.sample.validity, PLUMB_FORCE_NONE);
  EXPECT_EQ(verdict.sample.bound_radps, static_cast<double>(INFINITY));
  auto* nowhere = reinterpret_cast<plumb_rates*>(c.storage.data());
  EXPECT_EQ(plumb_rates_step(nowhere, &sample, &verdict).code, PLUMB_NOT_INITIALISED);
  EXPECT_EQ(plumb_rates_forget(nowhere).code, PLUMB_NOT_INITIALISED);
  EXPECT_EQ(plumb_rates_forget(nullptr).code, PLUMB_NULL_POINTER);
  ASSERT_EQ(c.init().code, PLUMB_OK);
  EXPECT_EQ(plumb_rates_step(c.rates, nullptr, &verdict).code, PLUMB_NULL_POINTER);
  sample.struct_size = 1;
  EXPECT_EQ(plumb_rates_step(c.rates, &sample, &verdict).code, PLUMB_WRONG_STRUCT);
  plumb_rates_sample_defaults(&sample);
  verdict.struct_size = 3;
  EXPECT_EQ(plumb_rates_step(c.rates, &sample, &verdict).code, PLUMB_WRONG_STRUCT);
  auto* odd = reinterpret_cast<unsigned char*>(c.storage.data()) + 1;
  EXPECT_EQ(plumb_rates_init(odd, plumb_rates_size(), &c.config, &c.rates).code, PLUMB_STORAGE_MISALIGNED);
  EXPECT_EQ(plumb_rates_init(nullptr, 8 * c.storage.size(), &c.config, &c.rates).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_rates_init(c.storage.data(), 8 * c.storage.size(), nullptr, &c.rates).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_rates_init(c.storage.data(), 8 * c.storage.size(), &c.config, nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_gyro_axis_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_rates_config_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_rates_sample_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_rates_verdict_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_rates_size() % plumb_rates_align(), 0U);
}

/// What a triad may read, one that failed too.
double reading() {
  return *rc::gen::weightedOneOf<double>(
      {{6, rc::gen::map(rc::gen::inRange(-10000, 10001), [](int k) { return 0.001 * k; })},
       {1, rc::gen::element(0.0, -0.0, 1e308, -1e308, static_cast<double>(INFINITY), kNan)}});
}

// Verifies: REQ-214
RC_GTEST_PROP(CMedianLaw, AnswersAsTheMedianDoes, ()) {
  plumb_triad_rates c;
  plumb_triad_rates_defaults(&c);
  TriadRates cpp;
  cpp.triads = c.triads = *rc::gen::inRange(0, kMostTriads + 1);
  c.faults = *rc::gen::inRange(-1, 5);
  c.given = *rc::gen::inRange<std::uint32_t>(0, 256) | *rc::gen::inRange<std::uint32_t>(0, 256);
  for (std::size_t k = 0; k < static_cast<std::size_t>(kMostTriads); ++k) {
    cpp.given[k] = (c.given >> k & 1U) != 0;
    for (std::size_t i = 0; i < 3; ++i) cpp.rate_radps[k][i] = c.rate_radps[k][i] = reading();
  }
  double rate_radps[3] = {7.0, 7.0, 7.0};
  std::int32_t given = 7;
  RC_ASSERT(plumb_median_rate(&c, rate_radps, &given).code == PLUMB_OK);
  const MedianRate expected = median_rate(cpp, c.faults);
  RC_ASSERT(given == (expected.given ? 1 : 0));
  RC_ASSERT(std::memcmp(rate_radps, expected.rate_radps.data(), sizeof rate_radps) == 0);
}

// Verifies: REQ-214
RC_GTEST_PROP(CMedianLaw, TheErrorIsThatOfTheMedian, ()) {
  const auto drawn = [](double most) { return most * 0.001 * *rc::gen::inRange(0, 1001); };
  plumb_triad_bounds c;
  plumb_triad_bounds_defaults(&c);
  c.scale = drawn(0.8);
  c.axis_rad = drawn(0.3);
  c.bias_radps = drawn(1.0);
  c.noise_radps = drawn(0.1);
  const double rate_radps = drawn(40.0);
  double error_radps = 0.0;
  RC_ASSERT(plumb_median_error(&c, rate_radps, &error_radps).code == PLUMB_OK);
  const GyroErrors triad{c.scale, c.axis_rad, c.bias_radps, c.noise_radps, 0.0};
  RC_ASSERT(error_radps == median_error_radps(triad, rate_radps, 6.0));
}

// Negative: REQ-214
TEST(CMedian, MisuseIsAnsweredAndLeavesNoRateAndNoBoundBehind) {
  plumb_triad_rates triads;
  plumb_triad_rates_defaults(&triads);
  double rate_radps[3] = {1.0, 1.0, 1.0}, error_radps = 0.0;
  std::int32_t given = 1;
  EXPECT_EQ(plumb_median_rate(nullptr, rate_radps, &given).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(given, 0);
  EXPECT_EQ(rate_radps[2], 0.0);
  EXPECT_EQ(plumb_median_rate(&triads, nullptr, &given).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_median_rate(&triads, rate_radps, nullptr).code, PLUMB_NULL_POINTER);
  for (const int wrong : {-1, 9, 1 << 30}) {
    triads.triads = wrong;
    expect(plumb_median_rate(&triads, rate_radps, &given), Errc::out_of_range, 0);
  }
  triads.struct_size = 4;
  EXPECT_EQ(plumb_median_rate(&triads, rate_radps, &given).code, PLUMB_WRONG_STRUCT);

  plumb_triad_bounds bounds;
  plumb_triad_bounds_defaults(&bounds);
  EXPECT_EQ(plumb_median_error(&bounds, 1.0, nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_median_error(nullptr, 1.0, &error_radps).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(error_radps, static_cast<double>(INFINITY));
  expect(plumb_median_error(&bounds, kNan, &error_radps), Errc::not_finite, 5);
  expect(plumb_median_error(&bounds, -1.0, &error_radps), Errc::out_of_range, 5);
  double* const values[] = {&bounds.scale, &bounds.axis_rad, &bounds.bias_radps, &bounds.noise_radps,
                            &bounds.noise_in_sigmas};
  for (int i = 0; i < 5; ++i) {
    double& value = *values[i];
    value = kNan;
    expect(plumb_median_error(&bounds, 1.0, &error_radps), Errc::not_finite, i);
    value = -1.0;
    expect(plumb_median_error(&bounds, 1.0, &error_radps), Errc::out_of_range, i);
    EXPECT_EQ(error_radps, static_cast<double>(INFINITY));
    value = 0.0;
  }
  EXPECT_EQ(plumb_median_error(&bounds, 1.0, &error_radps).code, PLUMB_OK);
  EXPECT_EQ(error_radps, 0.0) << "no bound is above zero";
  bounds.struct_size = 4;
  EXPECT_EQ(plumb_median_error(&bounds, 1.0, &error_radps).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(plumb_triad_rates_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_triad_bounds_defaults(nullptr).code, PLUMB_NULL_POINTER);
}

}  // namespace
}  // namespace plumb_rates_test
