// Every bit of a monitor's storage, flipped in every state: reported within 64 steps, or without harm. This file is
// built twice: with the core tests for eight sensors, sampled, and by itself for four (plumb_memory_tests), where
// PLUMB_LONG=1 flips every single bit.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <limits>

#include "bit_flip_support.hpp"
#include "support/long_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Makes the sums true again: storage that was forged and does not tell, as if nothing protected it.
struct StorageAccess {
  static void seal(HealthMonitor& monitor) { monitor.seal(); }
  template <class T>
  static void overwrite(HealthMonitor& monitor, const T& member, T value) {
    std::memcpy(const_cast<T*>(&member), &value, sizeof value);
    monitor.seal();
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

namespace bit_flip_test {
namespace {

using namespace plumb;
using plumb_test::FlipOutcome;
using plumb_test::FlipResult;
using plumb_test::Predicament;
using plumb_test::Rig;

Predicament predicament(const std::string& state, int n) {
  return state == "initial" ? plumb_test::in_first_calibration(n) : plumb_test::in_state(state, n);
}

using Outcomes = std::array<long, plumb_test::kFlipOutcomes>;

/// Flips every `stride`-th bit; the worst are told one by one.
Outcomes flip_bits(const Predicament& at, std::size_t stride, int& slowest) {
  Outcomes out{};
  auto scratch = std::make_unique<HealthMonitor>();
  for (std::size_t bit = stride / 2; bit < 8 * sizeof(HealthMonitor); bit += stride) {
    const FlipResult r = plumb_test::flip(at, bit, *scratch);
    ++out[static_cast<std::size_t>(r.outcome)];
    if (r.outcome == FlipOutcome::reported) slowest = std::max(slowest, r.steps);
    EXPECT_FALSE(plumb_test::is_wrong(r.outcome)) << at.name << ": byte " << bit / 8 << " bit " << bit % 8 << ": "
                                                  << to_string(r.outcome) << " at step " << r.steps;
  }
  return out;
}

/// The table of docs/memory-faults.md.
void flip_in_every_state(int n, std::size_t stride) {
  long flips = 0, wrong = 0;
  int slowest = 0;
  std::printf("%d sensors, capacity %d, %zu bytes, every %zu. bit\n", n, kCapacity, sizeof(HealthMonitor), stride);
  for (const std::string& state : plumb_test::flipped_states()) {
    const Predicament at = predicament(state, n);
    HealthMonitor unhurt = *at.monitor;
    ASSERT_EQ(plumb_test::play_flip(unhurt, at).outcome, FlipOutcome::same) << "who was not hurt is not called so";
    const Outcomes outcomes = flip_bits(at, stride, slowest);
    std::printf("  %-14s %-13s", state.c_str(), to_string(at.monitor->verdict().state));
    for (int k = 0; k < plumb_test::kFlipOutcomes; ++k) {
      const long count = outcomes[static_cast<std::size_t>(k)];
      flips += count;
      wrong += plumb_test::is_wrong(static_cast<FlipOutcome>(k)) ? count : 0;
      std::printf("  %s %ld", to_string(static_cast<FlipOutcome>(k)), count);
    }
    std::printf("\n");
  }
  std::printf("figure: %ld flips, %ld wrong, <= %d steps\n", flips, wrong, slowest);
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(slowest, plumb_test::kFlipSteps);
}

// Verifies: REQ-166
TEST(BitFlips, AreReportedWithin64StepsOrHarmless) {
  const bool every = kCapacity == 4 && plumb_test::long_run();
  flip_in_every_state(4, every ? 1 : 97);
  if (kCapacity >= 8) flip_in_every_state(6, plumb_test::long_run() ? 13 : 331);
}

/// What the sums are for: forged storage whose sums agree excludes the healthy and publishes nonsense.
// Negative: REQ-166
TEST(BitFlips, WithoutTheSumsTheyAreFoundWrong) {
  const Predicament at = predicament("nominal", 4);
  auto scratch = std::make_unique<HealthMonitor>();
  Outcomes outcomes{};
  for (int i = 0; i < 4; ++i) {
    for (unsigned bit = 40; bit < 64; ++bit) {
      *scratch = *at.monitor;
      for (const double* place : {&scratch->array().axis(i)[0], &scratch->verdict().gravity_mps2[2]}) {
        const double& component = *place;
        std::uint64_t bits = 0;
        std::memcpy(&bits, &component, sizeof bits);
        bits ^= std::uint64_t{1} << bit;
        double flipped = 0.0;
        std::memcpy(&flipped, &bits, sizeof bits);
        *scratch = *at.monitor;
        StorageAccess::overwrite(*scratch, component, flipped);
        ++outcomes[static_cast<std::size_t>(plumb_test::play_flip(*scratch, at).outcome)];
      }
    }
  }
  EXPECT_EQ(outcomes[static_cast<std::size_t>(FlipOutcome::reported)], 0);
  EXPECT_GT(outcomes[static_cast<std::size_t>(FlipOutcome::wrong_exclusion)], 0);
  EXPECT_GT(outcomes[static_cast<std::size_t>(FlipOutcome::wrong_output)], 0);
}

// Verifies: REQ-166
TEST(BitFlips, AReportIsTheEndUntilTheMonitorIsConfiguredAnew) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  HealthMonitor& monitor = rig.monitor;
  const HealthState before = monitor.verdict().state;
  ASSERT_EQ(before, HealthState::nominal);
  const MonitorSetup setup = rig.setup;
  double gravity_mps2 = monitor.array().axis(2)[1];
  std::memcpy(const_cast<double*>(&monitor.array().axis(1)[0]), &gravity_mps2, sizeof gravity_mps2);

  // The host can neither write it down nor build on it.
  std::vector<std::uint8_t> bytes(monitor.snapshot_size());
  EXPECT_EQ(monitor.snapshot(bytes.data(), bytes.size()).error().code, Errc::not_calibrated);
  EXPECT_EQ(monitor.request_recalibration().error().code, Errc::not_calibrated);
  EXPECT_EQ(monitor.offer_calibration(setup.model, setup.array).error().code, Errc::not_calibrated);
  EXPECT_EQ(monitor.set_gravity(setup.gravity).error().code, Errc::not_calibrated);
  EXPECT_EQ(monitor.set_rotation({}).error().code, Errc::not_calibrated);
  EXPECT_EQ(monitor.reset(setup.config.reset_key, setup.array.all()).error().code, Errc::not_calibrated);
  monitor.inhibit(true);
  monitor.set_motion({true, SensorSet::of(1)});

  int records = 0;
  for (int k = 0; k < plumb_test::kFlipSteps; ++k) {
    const Verdict& v = monitor.step(rig.sample(plumb_test::direction_at(20, 30), kG0_mps2));
    if (v.transition.sequence == 0) continue;
    ++records;
    EXPECT_EQ(v.transition.from, before);
    EXPECT_EQ(v.transition.to, HealthState::failed);
    EXPECT_EQ(v.transition.cause, Cause::memory);
  }
  EXPECT_EQ(records, 1);
  const Verdict& v = monitor.verdict();
  EXPECT_EQ(v.state, HealthState::failed);
  EXPECT_EQ(v.cause, Cause::memory);
  EXPECT_EQ(v.validity, Validity::invalid);
  EXPECT_TRUE(v.qualifiers & Qualifier::not_yet_validated);
  EXPECT_TRUE(v.alert);
  EXPECT_EQ(v.usable, 0);
  EXPECT_FALSE(v.protection_available);

  rig.restart();
  EXPECT_EQ(rig.prove().state, HealthState::nominal);
}

/// Were a figure of the evidence no number after all, it would be beyond its limit.
// Negative: REQ-166
TEST(BitFlips, AFigureThatIsNotANumberNeverPasses) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (int figure = 0; figure < 5; ++figure) {
    Rig rig(plumb_test::tetrahedron());
    plumb_test::leave_uncertainty(rig.setup.array);
    rig.restart();
    HealthMonitor& m = rig.monitor;
    switch (figure) {
      case 0: StorageAccess::overwrite(m, m.array().axis(0)[0], kNan); break;
      case 1: StorageAccess::overwrite(m, m.array().row(1).sigma_mps2, kNan); break;
      case 2: StorageAccess::overwrite(m, m.array().uncertainty().covariance[0], kNan); break;
      case 3: StorageAccess::overwrite(m, m.array().uncertainty().misfit_mps2[3], kNan); break;
      default: StorageAccess::overwrite(m, m.config().max_age_s, kNan); break;
    }
    for (int k = 0; k < 12; ++k) {
      const Verdict& v = rig.stay(plumb_test::direction_at(30.0 + 10.0 * k, 47.0 * k));
      EXPECT_NE(v.validity, Validity::valid) << figure;
      EXPECT_TRUE(v.alert) << figure;
      if (figure < 4) {
        EXPECT_NE(v.state, HealthState::nominal) << figure;
      }
    }
  }
}

}  // namespace
}  // namespace bit_flip_test
