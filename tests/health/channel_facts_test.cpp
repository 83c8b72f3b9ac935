// Noisy, stuck, at full scale: facts about a channel stand only where the others insist on them.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "detection/still_block.hpp"
#include "plumb/health/detail/channel_facts.hpp"
#include "support/simulated_tool.hpp"

namespace channel_facts_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Noise;
using plumb_test::Rig;

constexpr double kSigma = 2e-4 * kG0_mps2;

/// Sensor `which` at `times` its sigma.
Rig::Distort noise_of(int which, double times, Noise& noise) {
  return [which, times, &noise](int i, double r, int) {
    return i == which ? r + std::sqrt(times * times - 1.0) * kSigma * noise.normal() : r;
  };
}

// Verifies: REQ-142
TEST(ChannelFacts, TwoSigmasOfNoiseAreDetectedByTheResidualWithinAFewBlocks) {
  for (const double times : {2.0, 2.25, 2.5, 4.0, 50.0}) {
    int held = 0, noisy = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Rig rig(plumb_test::tetrahedron(), {}, seed);
      rig.prove();
      Noise own(seed + 50);
      rig.distort = noise_of(2, times, own);
      for (int k = 0; k < 40; ++k) {
        const Verdict& v = rig.stay(direction_at(100, 340));
        held += v.qualifiers & Qualifier::moving ? 1 : 0;
        noisy += v.noisy == SensorSet::of(2) ? 1 : 0;
        EXPECT_TRUE(SensorSet::of(2).contains(v.noisy));
        if (v.noisy.has(2)) {
          EXPECT_NE(v.validity, Validity::valid) << "no other sensor corroborates it";
          EXPECT_EQ(v.sensor_cause[2], Cause::noisy);
        }
      }
      EXPECT_TRUE(SensorSet::of(2).contains(rig.ever_blamed));
      if (rig.ever_blamed.empty()) {
        EXPECT_GT(rig.monitor.channels().counters(2).noisy_blocks, 10U);
      }
    }
    EXPECT_GT(noisy, 0) << times;
    EXPECT_LE(held, 20 * 8) << times << " sigma: " << held << " of 800 blocks held";
    RecordProperty("held_at_" + std::to_string(times), held);
  }
}

// Verifies: REQ-143
TEST(ChannelFacts, WhereTheOthersCheckOneAnotherANoisyChannelIsProvisionallyExcludedWithItsCause) {
  for (const int n : {5, 6, 7}) {
    Rig rig(plumb_test::cone_array(n));
    rig.prove();
    Noise own(9);
    rig.distort = noise_of(1, 6.0, own);
    rig.stay(direction_at(45, 200), 12);
    const Verdict& v = rig.monitor.verdict();
    EXPECT_EQ(v.provisionally_excluded, SensorSet::of(1)) << n;
    EXPECT_EQ(v.sensor_cause[1], Cause::noisy);
    EXPECT_EQ(v.validity, n == 5 ? v.validity : Validity::valid);
    EXPECT_EQ(v.grade, Grade::provisional);
    bool recorded = false;
    for (const TransitionRecord& r : rig.records)
      recorded = recorded || (r.event == HealthEvent::provisional_exclusion && r.cause == Cause::noisy);
    EXPECT_TRUE(recorded);
    // Calm again, it returns by probation, as any sensor does.
    rig.distort = [](int, double r, int) { return r; };
    Noise noise(3);
    for (int k = 0; k < 14; ++k) rig.stay(plumb_test::random_direction(noise));
    EXPECT_EQ(rig.monitor.verdict().in_service, SensorSet::first(n));
    EXPECT_EQ(rig.monitor.verdict().sensor_cause[1], Cause::none);
  }
}

/// A frozen sensor does not feel the vibration that the healthy ones feel: it must not make one of them look noisy.
// Negative: REQ-143
RC_GTEST_PROP(ChannelFactsLaw, AFrozenSensorNeverCausesTheProvisionalExclusionOfAHealthyOne, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Noise noise(seed);
  Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), {}, seed);
  rig.prove();
  const Vec3 u = plumb_test::random_direction(noise);
  const Vec3 along = plumb_test::random_direction(noise);
  const int frozen = static_cast<int>(noise.uniform() * n);
  const double value = dot(rig.setup.array.axis(frozen), u) * kG0_mps2;
  rig.distort = [frozen, value](int i, double r, int) { return i == frozen ? value : r; };
  const double rms = kSigma * std::pow(10.0, 2.0 * noise.uniform());
  for (int k = 0; k < 40 * 32; ++k) {
    const Vec3 a = plus(scaled(u, kG0_mps2), scaled(along, rms * noise.normal()));
    rig.step(rig.sample(scaled(a, 1.0 / norm(a)), norm(a)));
    RC_ASSERT(SensorSet::of(frozen).contains(rig.ever_blamed));
  }
  for (int k = 0; k < 10; ++k) rig.stay(plumb_test::random_direction(noise));
  RC_ASSERT(rig.monitor.verdict().excluded == SensorSet::of(frozen));
}

/// S7 from below: vibration at and around the limit of what is quiet, over many blocks.
// Negative: REQ-142
RC_GTEST_PROP(ChannelFactsLaw, VibrationIsNeverOneChannelsNoise, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Noise noise(seed);
  Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), {}, seed);
  rig.prove();
  const Vec3 along = plumb_test::random_direction(noise);
  const double rms = kSigma * (1.0 + 9.0 * noise.uniform());
  for (int k = 0; k < 40; ++k) {
    for (int s = 0; s < rig.setup.config.window; ++s) {
      const Vec3 a = plus(scaled(direction_at(30, 40), kG0_mps2), scaled(along, rms * noise.normal()));
      rig.step(rig.sample(scaled(a, 1.0 / norm(a)), norm(a)));
    }
    RC_ASSERT(rig.monitor.verdict().noisy.empty());
  }
  RC_ASSERT(rig.ever_blamed.empty());
  rig.distort = [&noise](int i, double r, int) { return i == 1 ? r + 0.02 * kG0_mps2 * noise.normal() : r; };
  rig.stay(direction_at(30, 40), 2);
  RC_ASSERT(rig.monitor.verdict().noisy == SensorSet::of(1));  // noise of its own is told
}

// Verifies: REQ-145
TEST(ChannelFacts, StuckIsReportedWhenTheOthersPredictAChange) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  const double frozen = dot(rig.setup.array.axis(1), direction_at(40, 30)) * kG0_mps2;
  rig.distort = [frozen](int i, double r, int) { return i == 1 ? frozen : r; };
  rig.stay(direction_at(40, 30), 10);
  EXPECT_TRUE(rig.monitor.verdict().stuck.empty()) << "at rest a reading may stand still";
  EXPECT_EQ(rig.monitor.channels().counters(1).stuck_blocks, 0U);
  rig.stay(direction_at(60, 90));
  EXPECT_EQ(rig.monitor.verdict().stuck, SensorSet::of(1));
  EXPECT_EQ(rig.monitor.verdict().sensor_cause[1], Cause::stuck);
  EXPECT_GT(rig.monitor.channels().counters(1).stuck_blocks, 0U);
  for (int k = 0; k < 5; ++k) rig.stay(direction_at(70 + 10 * k, 120 + 40 * k));
  EXPECT_EQ(rig.monitor.verdict().excluded, SensorSet::of(1)) << "by the evidence";
  EXPECT_EQ(rig.monitor.verdict().sensor_cause[1], Cause::stuck) << "with the reason";
}

// Negative: REQ-145
TEST(ChannelFacts, ACoarseSensorThatRepeatsAtEveryAttitudeIsNotStuck) {
  // Steps of 5 mg0, 25 times the noise: at rest the code never changes, and after each turn it is another one.
  Rig rig(plumb_test::cone_array(5, 30e-4 * kG0_mps2));
  const double step = 5e-3 * kG0_mps2;
  const SensorArray array = rig.setup.array;
  Vec3 u{};
  rig.distort = [step, array, &u](int i, double, int) {
    return step * std::round(dot(array.axis(i), u) * kG0_mps2 / step);
  };
  for (int k = 0; k < 20; ++k) {
    u = direction_at(30 + 4 * k, 37.0 * k);
    rig.stay(u, 4);
    EXPECT_TRUE(rig.monitor.verdict().stuck.empty());
  }
  for (int i = 0; i < 5; ++i) EXPECT_EQ(rig.monitor.channels().counters(i).stuck_blocks, 0U);
}

/// One sensor of 12 bits over +-100 g0: its code covers 4.9 % of gravity, more than the change by which others are told
/// to be stuck.
// Negative: REQ-145
TEST(ChannelFacts, WithinItsKnownResolutionASensorMayRepeat) {
  const double code = 0.0488 * kG0_mps2;
  for (const bool known : {true, false}) {
    Rig rig(plumb_test::cone_array(5, 0.1 * kG0_mps2));  // no test of the readings sees any of this
    if (known) rig.setup.resolution_raw[1] = code;
    rig.restart();
    rig.distort = [code](int i, double r, int) { return i == 1 ? code * std::round(r / code) : r; };
    rig.setup.array = plumb_test::cone_array(5, 1e-9);  // what the samples are drawn with
    const Vec3& h = rig.setup.array.axis(1);
    const Vec3 aside = cross(h, {0.0, 0.0, 1.0});
    const Vec3 across = scaled(aside, 1.0 / norm(aside));
    const auto at_reading = [&](double share) {
      return plus(scaled(h, share), scaled(across, std::sqrt(1.0 - share * share)));
    };
    // From near one edge of the code to near the other.
    const double edge = 0.0488 * (std::round(0.5 / 0.0488) - 0.45);
    rig.stay(at_reading(edge), 4);
    rig.stay(at_reading(edge + 0.9 * 0.0488), 2);
    EXPECT_EQ(rig.monitor.verdict().stuck, known ? SensorSet{} : SensorSet::of(1));
    rig.stay(at_reading(edge + 0.9 * 0.0488 + 0.06), 2);  // another code: it lives
    EXPECT_TRUE(rig.monitor.verdict().stuck.empty());
    const double frozen = code * std::round(0.5 * kG0_mps2 / code);
    rig.distort = [frozen](int i, double r, int) { return i == 1 ? frozen : r; };
    rig.stay(at_reading(0.5), 4);
    rig.stay(at_reading(0.62), 2);
    EXPECT_EQ(rig.monitor.verdict().stuck, SensorSet::of(1)) << "beyond two codes nobody is excused";
  }
}

Rig with_range(double full_scale_mps2) {
  Rig rig(plumb_test::tetrahedron());
  rig.setup.full_scale_raw.fill(full_scale_mps2);
  return rig;
}

// Verifies: REQ-148
TEST(ChannelFacts, FullScaleIsAFaultWhereTheOthersPredictLess) {
  Rig rig = with_range(2.0 * kG0_mps2);
  rig.distort = [](int, double r, int) { return r; };
  rig.restart();
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 0 ? 2.0 * kG0_mps2 : r; };
  rig.stay(direction_at(45, 200), 2);
  EXPECT_EQ(rig.monitor.verdict().contradicted_clip, SensorSet::of(0));
  EXPECT_EQ(rig.monitor.verdict().sensor_cause[0], Cause::clipped);
  EXPECT_EQ(rig.monitor.verdict().state, HealthState::suspect);
  EXPECT_GT(rig.monitor.channels().counters(0).clipped_blocks, 0U);
}

// Negative: REQ-148
TEST(ChannelFacts, FullScaleThatTheOthersPredictIsMotionAndNoEvidence) {
  Rig rig = with_range(1.2 * kG0_mps2);
  rig.distort = [](int, double r, int) { return r; };
  rig.restart();
  rig.prove();
  // A long push along the axis of sensor 4: it is the only one to reach its range.
  rig.distort = [](int i, double r, int) { return i == 3 ? std::fmin(r, 1.2 * kG0_mps2) : r; };
  for (int k = 0; k < 6; ++k) {
    const Verdict& v = rig.stay({0, 0, 1}, 1, 1.25 * kG0_mps2);
    EXPECT_EQ(v.cause, Cause::moving);
    EXPECT_EQ(v.state, HealthState::nominal);
    EXPECT_TRUE(v.contradicted_clip.empty());
  }
  EXPECT_TRUE(rig.ever_blamed.empty());
}

// Verifies: REQ-149
TEST(ChannelFacts, RefusedTimesGapsAndHeatAreCounted) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  Sample s = rig.sample(direction_at(40, 30), kG0_mps2);
  rig.step(s);
  rig.step(s);
  EXPECT_EQ(rig.monitor.counters().time_refused, 1U);
  s.time_s += 10.0;
  rig.step(s);
  EXPECT_EQ(rig.monitor.counters().gaps, 1U);
  s.time_s += 0.01;
  s.temperature_degc = std::numeric_limits<double>::quiet_NaN();
  rig.step(s);
  EXPECT_EQ(rig.monitor.counters().temperature_out, 1U);
  EXPECT_EQ(rig.monitor.counters().samples, rig.monitor.verdict().sample);
}

/// a2 repeats one number. In the first block of its watch a4 is not usable, so that two others are left, which do not
/// determine a2: the watch begins where they do.
// Verifies: REQ-144
TEST(ChannelFacts, AStuckChannelIsReportedThoughAnotherWasSilentAsTheWatchBegan) {
  const SensorArray array = plumb_test::tetrahedron();
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const std::array<float, kCapacity> resolution_mps2{};
  const ChannelFacts::Terms terms{array, gravity, resolution_mps2, 32, array.all()};
  ChannelMonitor gate;
  gate.configure(4, {}, 3);
  ChannelFacts facts;
  double other = 0.0;
  const auto block = [&](const Vec3& down, SensorSet usable) {
    Sample sample;
    sample.delivered = array.all();
    for (int k = 0; k < 64; ++k) {
      for (std::size_t i = 0; i < 4; ++i) sample.raw[i] = i == 1 ? 1.5 : other += 1e-3;
      (void)gate.gate(sample);
    }
    BlockJudgement judged;
    judged.quiet = true;
    judged.evidence = plumb_test::block_at(array, down);
    judged.evidence.mean_mps2[1] = 1.5;
    judged.evidence.usable = usable;
    facts.note(terms, judged, gate, false);
  };
  block(direction_at(100, 340), array.all().without(3));
  EXPECT_TRUE(facts.stuck().empty());
  block(direction_at(100, 340), array.all());
  EXPECT_TRUE(facts.stuck().empty()) << "the others have predicted no change yet";
  block(direction_at(40, 100), array.all());
  EXPECT_EQ(facts.stuck(), SensorSet::of(1));
}

// Negative: REQ-149
TEST(ChannelFacts, AHealthyRunCountsNothing) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  const MonitorCounters& c = rig.monitor.counters();
  EXPECT_EQ(c.time_refused + c.gaps + c.temperature_out + c.moving_blocks + c.rotating_blocks, 0U);
  EXPECT_GT(c.samples, 100U);
}

/// It jumps from one end of its range to the other: full scale says more than noise.
// Verifies: REQ-148
TEST(ChannelFacts, NoisyAndAtFullScaleIsReportedAsFullScale) {
  Rig rig(plumb_test::cone_array(6));
  rig.setup.full_scale_raw.fill(1.05 * kG0_mps2);
  rig.restart();
  rig.prove();
  rig.distort = [](int i, double r, int k) { return i == 2 ? 1.05 * kG0_mps2 - (k % 2) * 0.02 : r; };
  for (int k = 0; k < 8; ++k) rig.stay(direction_at(30 + 15 * k, 50 * k));
  const Verdict& v = rig.monitor.verdict();
  ASSERT_TRUE((v.excluded | v.provisionally_excluded).has(2));
  EXPECT_EQ(v.sensor_cause[2], Cause::clipped) << to_string(v.sensor_cause[2]);
}

}  // namespace
}  // namespace channel_facts_test
