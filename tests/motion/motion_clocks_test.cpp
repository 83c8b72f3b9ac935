// Clocks of chips: cubics are met exactly, tones within the limits, and what cannot be interpolated is not delivered.
#include "plumb/motion/motion_clocks.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

#include "motion/clocked_motion.hpp"
#include "plumb/motion/motion_parity.hpp"

// Serves: REQ-207

namespace motion_clocks_test {
namespace {

using namespace plumb;
using plumb_test::ChipClocks;
using plumb_test::clocks_of;
using plumb_test::cone_array;
using plumb_test::Noise;
using plumb_test::one_clock;
using plumb_test::still_setup;

static_assert(std::is_trivially_copyable_v<MotionClocks>);

/// n sensors that all feel `signal`, each by a clock of its own.
struct Bench {
  SensorArray array;
  MotionSetup setup;
  ClockSetup stated;
  std::unique_ptr<MotionClocks> clocks = std::make_unique<MotionClocks>();
  ClockPush last = ClockPush::not_configured;

  Bench(int n, const MotionSetup& motion, Noise& noise)
      : array(cone_array(n, 0.01)), setup(motion), stated(clocks_of(n, n, motion, noise)) {}
  void configure() { ASSERT_TRUE(clocks->configure(array, setup, stated).has_value()); }

  /// Feeds them for `seconds`, and hands every common instant to `take`.
  template <class Signal, class Take>
  void run(ChipClocks& chips, double seconds, Signal signal, Take take) {
    for (double now_s = 0.0; now_s < seconds; now_s += 0.5 * setup.sample_period_s) {
      chips.deliver(now_s, *clocks, [&](int c, double t) {
        MotionSample s;
        s.delivered = array.all();
        s.rate_given = {true, true};
        for (std::size_t i = 0; i < static_cast<std::size_t>(array.size()); ++i) s.reading_mps2[i] = signal(t);
        for (Vec3& rate : s.rate_radps) rate = {signal(t), -signal(t), 0.5 * signal(t)};
        (void)c;
        return s;
      });
      last = chips.last;
      MotionSample s;
      while (clocks->next(now_s, s)) take(s);
    }
  }
};

// Verifies: REQ-207
RC_GTEST_PROP(MotionClocks, CubicsAreMetExactlyWhateverOffsetAndRate, ()) {
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  MotionSetup motion = still_setup();
  motion.gyros = 2;
  Bench bench(4, motion, noise);
  bench.configure();
  ChipClocks chips(bench.stated, noise, true, 0.0, 0.09);
  const double a = noise.normal(), b = 10.0 * noise.normal(), c = 100.0 * noise.normal(), d = 1e3 * noise.normal();
  const auto cubic = [=](double t) { return a + t * (b + t * (c + t * d)); };
  int met = 0;
  bench.run(chips, 0.1, cubic, [&](const MotionSample& s) {
    RC_ASSERT(s.delivered == bench.array.all());
    for (std::size_t i = 0; i < 4; ++i) {
      RC_ASSERT(std::fabs(s.reading_mps2[i] - cubic(s.time_s)) < 1e-6);
      RC_ASSERT(s.interpolation_mps2[i] < 1e-3);
    }
    for (std::size_t g = 0; g < 2; ++g) {
      RC_ASSERT(s.rate_given[g]);
      RC_ASSERT(std::fabs(s.rate_radps[g][1] + cubic(s.time_s)) < 1e-6);
    }
    ++met;
  });
  RC_ASSERT(met >= 85);
}

/// By which the means of what is interpolated differ from those of the truth, over what the limits allow.
struct Ratios {
  std::array<double, kMotionScales> worst{};
  double unlimited = 0.0;  ///< the largest over what they would allow without the term of the interpolation
};

template <class Signal>
void measure(Bench& bench, ChipClocks& chips, double seconds, Signal signal, Ratios& ratios) {
  SensorArray array = bench.array;
  MotionSetup setup = bench.setup;
  ASSERT_TRUE(with_clocks(bench.stated, array, setup).has_value());
  const auto seen = std::make_unique<MotionWindow>(array.size(), 0, setup.sample_period_s);
  const auto truth = std::make_unique<MotionWindow>(array.size(), 0, setup.sample_period_s);
  bench.run(chips, seconds, signal, [&](const MotionSample& s) {
    MotionSample exact = s;
    exact.reading_mps2.fill(signal(s.time_s));
    exact.interpolation_mps2 = {};
    seen->add(s);
    truth->add(exact);
    for (int scale = 0; scale < kMotionScales; ++scale) {
      if ((seen->ended() >> static_cast<unsigned>(scale) & 1U) == 0) continue;
      const MotionMeans means = seen->means(scale), true_means = truth->means(scale);
      MotionMeans without = means;
      without.interpolation_mps2 = {};
      const RotationTerm still = rotation_term(setup, means, RotationSource::bound, 0.0);
      const MotionReadings readings = corrected(array, setup, means, still, 0.0);
      const MotionReadings unlimited = corrected(array, setup, without, still, 0.0);
      for (std::size_t i = 0; i < static_cast<std::size_t>(array.size()); ++i) {
        if (!readings.usable.has(static_cast<int>(i))) continue;
        const double error = std::fabs(means.reading_mps2[i] - true_means.reading_mps2[i]);
        const double rounding = 1e-9;
        double& worst = ratios.worst[static_cast<std::size_t>(scale)];
        worst = std::fmax(worst, error / (readings.error_mps2[i] + rounding));
        ratios.unlimited = std::fmax(ratios.unlimited, error / (unlimited.error_mps2[i] + rounding));
      }
    }
  });
}

/// Tones up to a quarter of each chip's rate, clocks at the vertices of their bounds.
// Verifies: REQ-207
TEST(MotionClocks, TonesAreWithinTheLimits) {
  Noise noise(1);
  Ratios ratios;
  for (int k = 0; k < 3000; ++k) {
    const MotionSetup motion = still_setup();
    Bench bench(4, motion, noise);
    double highest_hz = 0.45 / motion.sample_period_s;
    for (std::size_t c = 0; c < 4; ++c)
      highest_hz = std::fmin(highest_hz, 0.25 / bench.stated.clock[c].sample_period_s);
    bench.configure();
    ChipClocks chips(bench.stated, noise, true, 1.0, k % 2 == 0 ? 0.0 : 0.09);
    const int tones = 1 + k % 3;
    std::array<double, 3> amplitude{}, radps{}, phase{};
    for (std::size_t n = 0; n < static_cast<std::size_t>(tones); ++n) {
      amplitude[n] = 100.0 * noise.uniform();
      radps[n] = 2.0 * kPi * highest_hz * std::sqrt(noise.uniform());
      phase[n] = 7.0 * noise.uniform();
    }
    const auto signal = [=](double t) {
      double sum = 0.0;
      for (std::size_t n = 0; n < 3; ++n) sum += amplitude[n] * std::sin(radps[n] * t + phase[n]);
      return sum;
    };
    measure(bench, chips, k % 20 == 0 ? 0.6 : 0.12, signal, ratios);
  }
  std::printf("[ measured ] error over limit, blocks of 1, 4, 32, 256: %.3f, %.3f, %.3f, %.3f\n", ratios.worst[0],
              ratios.worst[1], ratios.worst[2], ratios.worst[3]);
  for (const double worst : ratios.worst) EXPECT_LE(worst, 1.0);
  EXPECT_GT(*std::max_element(ratios.worst.begin(), ratios.worst.end()), 0.3) << "the limits are not far too wide";
}

/// Without the term of the interpolation the limits would be passed.
// Negative: REQ-207
TEST(MotionClocks, LagAloneDoesNotAccountForWhatInterpolationAdds) {
  Noise noise(2);
  Ratios ratios;
  for (int k = 0; k < 50; ++k) {
    Bench bench(4, still_setup(), noise);
    bench.configure();
    ChipClocks chips(bench.stated, noise, true);
    const double phase = 7.0 * noise.uniform();
    measure(
        bench, chips, 0.12, [phase](double t) { return 100.0 * std::sin(2.0 * kPi * 190.0 * t + phase); }, ratios);
  }
  EXPECT_GT(ratios.unlimited, 1.5);
  for (const double worst : ratios.worst) EXPECT_LE(worst, 1.0);
}

/// A step behind a second-order filter, between two samples.
TEST(MotionClocks, ShocksAreWithinTheLimits) {
  Noise noise(3);
  Ratios ratios;
  for (int k = 0; k < 1000; ++k) {
    Bench bench(4, still_setup(), noise);
    double highest_hz = 1e9;
    for (std::size_t c = 0; c < 4; ++c)
      highest_hz = std::fmin(highest_hz, 0.25 / bench.stated.clock[c].sample_period_s);
    bench.configure();
    ChipClocks chips(bench.stated, noise, true);
    const double start_s = 0.03 + 1e-3 * noise.uniform(), w = std::sqrt(2.0) * kPi * 0.8 * highest_hz;
    const auto signal = [=](double t) {
      const double p = w * (t - start_s);
      return p > 0.0 ? 400.0 * (1.0 - std::exp(-p) * (std::cos(p) + std::sin(p))) : 0.0;
    };
    measure(bench, chips, 0.12, signal, ratios);
  }
  std::printf("[ measured ] shocks, error over limit, blocks of 1, 4, 32: %.3f, %.3f, %.3f\n", ratios.worst[0],
              ratios.worst[1], ratios.worst[2]);
  for (const double worst : ratios.worst) EXPECT_LE(worst, 1.0);
}

/// Noise of means of interpolated samples, of slow chips above all, is what `with_clocks` makes of it at most.
TEST(MotionClocks, NoiseIsWithinWhatIsStated) {
  for (const double share : {0.25, 1.0, 1.003, 2.5}) {
    Noise noise(4);
    Bench bench(4, still_setup(), noise);
    for (std::size_t c = 0; c < 4; ++c) bench.stated.clock[c].sample_period_s = 0.001 * share;
    bench.stated.wait_s = 0.03 * share;
    bench.configure();
    SensorArray array = bench.array;
    MotionSetup setup = bench.setup;
    ASSERT_TRUE(with_clocks(bench.stated, array, setup).has_value());
    ChipClocks chips(bench.stated, noise, false, 1.0, 0.05);
    const auto window = std::make_unique<MotionWindow>(4, 0, setup.sample_period_s);
    std::array<double, 3> square{};
    std::array<int, 3> count{};
    bench.run(
        chips, 30.0, [&](double) { return noise.normal(); },
        [&](const MotionSample& s) {
          window->add(s);
          for (std::size_t scale = 0; scale < 3; ++scale) {
            if ((window->ended() >> scale & 1U) == 0) continue;
            const MotionMeans means = window->means(static_cast<int>(scale));
            for (std::size_t i = 0; i < 4; ++i) square[scale] += means.reading_mps2[i] * means.reading_mps2[i];
            count[scale] += 4;
          }
        });
    for (std::size_t scale = 0; scale < 3; ++scale) {
      ASSERT_GT(count[scale], 1000);
      const double n = kMotionSamples[scale], alone = (4.0 * n * n - 1.0) / (6.0 * n * n * n);
      const double factor = std::sqrt(square[scale] / count[scale] / alone);
      EXPECT_LT(factor, 1.02 * array.sigma_mps2(0) / bench.array.sigma_mps2(0)) << share << ", " << n;
    }
  }
}

/// Three chips deliver, one does not: after the wait the instants come without it.
TEST(MotionClocks, AChipThatFallsSilentIsLeftOutAfterTheWait) {
  Noise noise(5);
  Bench bench(4, still_setup(), noise);
  bench.configure();
  ChipClocks chips(bench.stated, noise, false);
  double latest_s = 0.0;
  int without = 0, with = 0;
  for (double now_s = 0.0; now_s < 0.2; now_s += 0.0005) {
    chips.deliver(now_s, *bench.clocks, [&](int c, double t) {
      MotionSample s;
      s.delivered = c == 2 && t > 0.1 ? SensorSet{} : bench.array.all();
      return s;
    });
    MotionSample s;
    while (bench.clocks->next(now_s, s)) {
      latest_s = s.time_s;
      (s.delivered.has(2) ? with : without) += 1;
      EXPECT_TRUE(s.delivered.contains(bench.array.all() - SensorSet::of(2)) || s.time_s < 0.01);
    }
    EXPECT_LE(now_s - latest_s, bench.stated.wait_s + 0.0021);
  }
  EXPECT_GT(with, 80);
  EXPECT_GT(without, 80);
}

MotionSample stamped(double time_s, double reading_mps2 = 1.0) {
  MotionSample s;
  s.time_s = time_s;
  s.delivered = SensorSet::first(4);
  s.reading_mps2.fill(reading_mps2);
  return s;
}

TEST(MotionClocks, SaysWhatBecameOfASample) {
  const auto clocks = std::make_unique<MotionClocks>();
  EXPECT_EQ(clocks->push(0, stamped(0.0)), ClockPush::not_configured);
  ASSERT_TRUE(clocks->configure(cone_array(4, 0.01), still_setup(), one_clock()).has_value());
  EXPECT_EQ(clocks->push(-1, stamped(0.0)), ClockPush::unknown_clock);
  EXPECT_EQ(clocks->push(1, stamped(0.0)), ClockPush::unknown_clock);
  EXPECT_EQ(clocks->push(0, stamped(std::numeric_limits<double>::quiet_NaN())), ClockPush::not_finite);
  EXPECT_EQ(clocks->push(0, stamped(1e11)), ClockPush::not_finite);
  EXPECT_EQ(clocks->push(0, stamped(1000.5)), ClockPush::not_valid);
  EXPECT_EQ(clocks->push(0, stamped(1.0)), ClockPush::taken);
  EXPECT_EQ(clocks->push(0, stamped(1.0)), ClockPush::out_of_order) << "its time again";
  EXPECT_EQ(clocks->push(0, stamped(1.001)), ClockPush::taken);
  EXPECT_EQ(clocks->push(0, stamped(1.0015)), ClockPush::out_of_order) << "too early";
  EXPECT_EQ(clocks->push(0, stamped(1.003)), ClockPush::began_anew) << "one is missing";
  EXPECT_EQ(clocks->push(0, stamped(1.002)), ClockPush::began_anew) << "the clock went back";
  EXPECT_EQ(clocks->push(0, stamped(1.003)), ClockPush::taken);
}

/// Samples of a chip of 1 kHz from 0 to 40 ms but for one that `distort` makes, and what is drawn about it.
template <class Distort>
std::array<SensorSet, 2> drawn_about(Distort distort) {
  const auto clocks = std::make_unique<MotionClocks>();
  EXPECT_TRUE(clocks->configure(cone_array(4, 0.01), still_setup(), one_clock()).has_value());
  std::array<SensorSet, 2> out{};
  for (int k = 0; k <= 40; ++k) {
    MotionSample s = stamped(0.001 * k + 0.0004);
    if (k == 20 ? distort(s) : true) (void)clocks->push(0, s);
    MotionSample common;
    while (clocks->next(0.001 * k, common)) {
      if (std::fabs(common.time_s - 0.021) < 1e-4) out[0] = common.delivered;
      if (std::fabs(common.time_s - 0.021) < 1e-4 && common.clipped.has(1)) out[1] = common.clipped;
      if (std::fabs(common.time_s - 0.010) < 1e-4) {
        EXPECT_EQ(common.delivered, SensorSet::first(4));
        EXPECT_NEAR(common.reading_mps2[2], 1.0, 1e-12);
      }
    }
  }
  return out;
}

TEST(MotionClocks, WhatCannotBeInterpolatedIsNotDelivered) {
  const SensorSet all = SensorSet::first(4), rest = all - SensorSet::of(1);
  EXPECT_EQ(drawn_about([](MotionSample&) { return true; })[0], all);
  EXPECT_EQ(drawn_about([](MotionSample&) { return false; })[0], SensorSet{}) << "a sample is lost";
  EXPECT_EQ(drawn_about([&](MotionSample& s) { return s.delivered = rest, true; })[0], rest);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(drawn_about([=](MotionSample& s) { return s.reading_mps2[1] = nan, true; })[0], rest);
  EXPECT_EQ(drawn_about([](MotionSample& s) { return s.reading_mps2[1] = 1e300, true; })[0], rest);
  const auto clipped = drawn_about([](MotionSample& s) { return s.clipped = SensorSet::of(1), true; });
  EXPECT_EQ(clipped[1], SensorSet::of(1));
  EXPECT_EQ(clipped[0], rest) << "between a reading and an inequality nothing can be interpolated";
}

/// A limit of the true force stays one where all samples around an instant are at full scale, in one sense.
// Verifies: REQ-212
TEST(MotionClocks, FullScaleThroughoutIsFullScaleInBetween) {
  for (const bool both_senses : {false, true}) {
    const auto clocks = std::make_unique<MotionClocks>();
    ASSERT_TRUE(clocks->configure(cone_array(4, 0.01), still_setup(), one_clock()).has_value());
    int drawn = 0;
    for (int k = 0; k <= 40; ++k) {
      MotionSample s = stamped(0.001 * k + 0.0004);
      s.clipped = SensorSet::of(1);
      s.reading_mps2[1] = both_senses && k % 2 == 0 ? -20.0 : 20.0;
      (void)clocks->push(0, s);
      MotionSample common;
      while (clocks->next(0.001 * k, common)) {
        if (common.time_s < 0.01) continue;
        ++drawn;
        EXPECT_EQ(common.delivered.has(1), !both_senses);
        EXPECT_TRUE(common.clipped.has(1));
        EXPECT_TRUE(both_senses || std::fabs(common.reading_mps2[1] - 20.0) < 1e-9);
      }
    }
    EXPECT_GT(drawn, 20);
  }
}

TEST(MotionClocks, AClockIsStatedAnew) {
  const auto clocks = std::make_unique<MotionClocks>();
  EXPECT_FALSE(clocks->set_clock(0, 0.0, 0.0, 0.0).has_value());
  ASSERT_TRUE(clocks->configure(cone_array(4, 0.01), still_setup(), one_clock()).has_value());
  EXPECT_FALSE(clocks->set_clock(1, 0.0, 0.0, 0.0).has_value());
  EXPECT_EQ(clocks->set_clock(0, 0.0, 0.1, 0.0).error(), (Error{Errc::out_of_range, 202}));
  EXPECT_EQ(clocks->push(0, stamped(1500.0)), ClockPush::not_valid);
  ASSERT_TRUE(clocks->set_clock(0, 1000.0, 1e-5, 1500.0).has_value());
  EXPECT_EQ(clocks->push(0, stamped(1500.0)), ClockPush::taken);
}

TEST(MotionClocks, TheHostsTimeMayJump) {
  const auto clocks = std::make_unique<MotionClocks>();
  ASSERT_TRUE(clocks->configure(cone_array(4, 0.01), still_setup(), one_clock()).has_value());
  MotionSample s;
  for (const double now_s : {0.0, 500.0, 1.0, -300.0, 1e10, 2.0}) {
    int drawn = 0;
    for (; drawn < 1000 && clocks->next(now_s, s); ++drawn) {
    }
    EXPECT_LT(drawn, 100) << now_s;
  }
  EXPECT_FALSE(clocks->next(std::numeric_limits<double>::quiet_NaN(), s));
  EXPECT_FALSE(clocks->next(std::numeric_limits<double>::infinity(), s));
}

RC_GTEST_PROP(MotionClocks, IsTotalOverAllBitPatterns, ()) {
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  Bench bench(4, still_setup(), noise);
  bench.configure();
  MotionSample s, common;
  for (int k = 0; k < 200; ++k) {
    std::array<unsigned char, sizeof s> bytes{};
    for (unsigned char& b : bytes) b = static_cast<unsigned char>(256.0 * noise.uniform());
    std::array<double, kCapacity> wild{};
    std::memcpy(wild.data(), bytes.data(), sizeof wild);
    s = stamped(0.001 * k + bench.stated.clock[0].offset_s);
    s.reading_mps2 = wild;
    if (noise.uniform() < 0.1) s.time_s = wild[0];
    (void)bench.clocks->push(k % 5 - 1, s);
    for (int n = 0; n < 200 && bench.clocks->next(0.001 * k, common); ++n) {
      for (std::size_t i = 0; i < 4; ++i) {
        if (common.delivered.has(static_cast<int>(i))) RC_ASSERT(std::isfinite(common.reading_mps2[i]));
      }
    }
  }
}

}  // namespace
}  // namespace motion_clocks_test
