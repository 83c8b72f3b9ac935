// False-alarm rate of every test alone, with the true calibration: each triple's MAE, parity, the norm. By default up
// to 1e6 blocks at 1e-3; the long run (PLUMB_LONG=1) up to 1e7, and
// 1e-4.
// Serves: REQ-052
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include "plumb/detection/combination_mae.hpp"
#include "plumb/detection/mae_test.hpp"
#include "plumb/numeric/tails.hpp"
#include "support/binomial_interval.hpp"
#include "support/long_run.hpp"
#include "support/simulated_tool.hpp"

namespace false_alarm_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

constexpr double kSigma = 2e-4 * kG0_mps2;

SensorArray with_sigmas(const AxisList& axes, int n, const std::vector<double>& sigmas) {
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    SensorRow& row = rows[static_cast<std::size_t>(i)];
    row.id = make_id(("a" + std::to_string(i + 1)).c_str());
    row.axis = axes[static_cast<std::size_t>(i)];
    row.sigma_mps2 = sigmas[static_cast<std::size_t>(i) % sigmas.size()];
  }
  return *SensorArray::make(rows.data(), n);
}

SensorArray unequal_cone() {
  AxisList axes{};
  return with_sigmas(axes, cone(axes, 6), {kSigma, 0.5 * kSigma, 3.0 * kSigma});
}

struct Counts {
  std::int64_t blocks = 0, parity = 0, norm = 0, any_triple = 0;
  std::vector<std::int64_t> alone;  ///< of each triple, asked for the rate itself
};

/// Blocks of healthy noise at random attitudes, judged by the limits that the monitor uses.
Counts count_alarms(const SensorArray& array, int window, double rate, std::int64_t blocks, std::uint64_t seed) {
  const int n = array.size();
  const GravityReference gravity{kG0_mps2, 0.0, GravityModel::value};
  const TestLimits limits = TestLimits::from_rates(n, rate, 1e-6);
  const double alone = half_normal_mean_quantile(window, rate);
  const double shared = half_normal_mean_quantile(window, triple_share(array, rate));
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array.triple_count(), window);
  Noise noise(seed);
  Counts out;
  out.blocks = blocks;
  out.alone.assign(static_cast<std::size_t>(array.triple_count()), 0);
  for (std::int64_t block = 0; block < blocks; ++block) {
    const Vec3 g = scaled(plumb_test::random_direction(noise), kG0_mps2);
    BlockEvidence evidence;
    evidence.usable = array.all();
    evidence.samples = window;
    for (int s = 0; s < window; ++s) {
      Readings y{};
      for (int i = 0; i < n; ++i) {
        const auto a = static_cast<std::size_t>(i);
        y[a] = dot(array.axis(i), g) + array.sigma_mps2(i) * noise.normal();
        evidence.mean_mps2[a] += y[a] / window;
      }
      mae->add(array, y, array.all(), nullptr, kG0_mps2);
    }
    const SetTest all = test_set(array, gravity, limits, evidence, array.all());
    out.parity += all.parity > all.parity_alarm_limit(limits) ? 1 : 0;
    out.norm += std::fabs(all.norm) > all.norm_alarm_limit(limits) ? 1 : 0;
    bool any = false;
    for (int k = 0; k < array.triple_count(); ++k) {
      if (!array.triple(k).votes) continue;
      const SetTest t = test_set(array, gravity, limits, evidence, array.triple(k).set());
      const double error = mae->triple_mps2(k);
      if (error > computed_mae_limit(t, evidence, window, alone).limit_mps2()) ++out.alone[static_cast<std::size_t>(k)];
      any = any || error > computed_mae_limit(t, evidence, window, shared).limit_mps2();
    }
    out.any_triple += any ? 1 : 0;
  }
  return out;
}

void tell(const std::string& what, std::int64_t count, std::int64_t trials, double rate) {
  const plumb_test::Interval at = plumb_test::clopper_pearson(count, trials, 0.95);
  std::cout << "[ measured ] " << what << ": " << count << " of " << trials << " = "
            << static_cast<double>(count) / static_cast<double>(trials) / rate << " of the request, 95 % "
            << at.low / rate << " .. " << at.high / rate << '\n';
}

/// The rate lies within 20 % of the request: shown at 99 % where the count allows (`proven`), else not refuted at 99.99
/// %.
void expect_within_a_fifth(const std::string& what, std::int64_t count, std::int64_t trials, double rate, bool proven) {
  const plumb_test::Interval at = plumb_test::clopper_pearson(count, trials, proven ? 0.99 : 0.9999);
  if (proven) {
    EXPECT_GE(at.low, 0.8 * rate) << what;
    EXPECT_LE(at.high, 1.2 * rate) << what;
  } else {
    EXPECT_GE(at.high, 0.8 * rate) << what;
    EXPECT_LE(at.low, 1.2 * rate) << what;
  }
}

void measure(const char* name, const SensorArray& array, int window, double rate, std::int64_t blocks) {
  const Counts c = count_alarms(array, window, rate, blocks, 77U + static_cast<std::uint64_t>(window));
  const std::string where = std::string(name) + ", N = " + std::to_string(window);
  const bool proven = static_cast<double>(blocks) * rate >= 900.0;
  tell(where + ", parity", c.parity, blocks, rate);
  tell(where + ", norm", c.norm, blocks, rate);
  expect_within_a_fifth(where + ", parity", c.parity, blocks, rate, proven);
  expect_within_a_fifth(where + ", norm", c.norm, blocks, rate, proven);
  std::int64_t pooled = 0, least = blocks, most = 0;
  int triples = 0;
  for (int k = 0; k < array.triple_count(); ++k) {
    if (!array.triple(k).votes) continue;
    const std::int64_t count = c.alone[static_cast<std::size_t>(k)];
    // With 56 triples the chance finds one far out: each alone is held to what does not refute it.
    expect_within_a_fifth(where + ", triple " + std::to_string(k), count, blocks, rate, false);
    pooled += count;
    least = std::min(least, count);
    most = std::max(most, count);
    ++triples;
  }
  tell(where + ", triple with the least", least, blocks, rate);
  tell(where + ", triple with the most", most, blocks, rate);
  expect_within_a_fifth(where + ", triples", pooled / triples, blocks, rate, proven);
  tell(where + ", any triple on its share", c.any_triple, blocks, rate);
  EXPECT_LE(plumb_test::clopper_pearson(c.any_triple, blocks, 0.9999).low, rate) << where << ": shares add up";
}

std::int64_t by_run(std::int64_t usual, std::int64_t in_full) { return plumb_test::long_run() ? in_full : usual; }

// Verifies: REQ-052
TEST(FalseAlarm, EveryTestAloneKeepsItsRateAtOneSample) {
  measure("four sensors, 1e-3", plumb_test::tetrahedron(kSigma), 1, 1e-3, by_run(1000000, 4000000));
}

// Verifies: REQ-052
TEST(FalseAlarm, EveryTestAloneKeepsItsRateAtThirtyTwoSamples) {
  measure("four sensors, 1e-3", plumb_test::tetrahedron(kSigma), 32, 1e-3, by_run(100000, 1000000));
}

// Verifies: REQ-052
TEST(FalseAlarm, EveryTestAloneKeepsItsRateWithUnequalSensors) {
  measure("six unequal sensors, 1e-3", unequal_cone(), 1, 1e-3, by_run(200000, 1000000));
  measure("six unequal sensors, 1e-3", unequal_cone(), 8, 1e-3, by_run(50000, 1000000));
}

// Verifies: REQ-052
TEST(FalseAlarm, EveryTestAloneKeepsItsRateAtOneInTenThousand) {
  measure("four sensors, 1e-4", plumb_test::tetrahedron(kSigma), 1, 1e-4, by_run(1000000, 10000000));
  if (!plumb_test::long_run()) return;
  measure("four sensors, 1e-4", plumb_test::tetrahedron(kSigma), 32, 1e-4, 9000000);
}

// Verifies: REQ-052
TEST(FalseAlarm, EveryTestAloneKeepsItsRateWithEightSensors) {
  measure("eight sensors, 1e-3", plumb_test::cone_array(8, kSigma), 1, 1e-3, by_run(50000, 1000000));
  if (!plumb_test::long_run()) return;
  measure("eight sensors, 1e-3", plumb_test::cone_array(8, kSigma), 32, 1e-3, 900000);
  measure("eight sensors, 1e-4", plumb_test::cone_array(8, kSigma), 1, 1e-4, 9000000);
}

/// Without the weights of the sensors the same blocks alarm at quite another rate.
// Negative: REQ-052
TEST(FalseAlarm, ATestThatTakesUnequalSensorsForEqualLosesItsRate) {
  const SensorArray truth = unequal_cone();
  AxisList axes{};
  const SensorArray taken = with_sigmas(axes, cone(axes, 6), {kSigma * std::sqrt(10.25 / 3.0)});  // same mean square
  const TestLimits limits = TestLimits::from_rates(6, 1e-3, 1e-6);
  const GravityReference gravity{kG0_mps2, 0.0, GravityModel::value};
  Noise noise(5);
  const std::int64_t blocks = 20000;
  std::int64_t alarms = 0;
  for (std::int64_t k = 0; k < blocks; ++k) {
    const Vec3 g = scaled(plumb_test::random_direction(noise), kG0_mps2);
    BlockEvidence evidence;
    evidence.usable = truth.all();
    evidence.samples = 1.0;
    for (int i = 0; i < 6; ++i)
      evidence.mean_mps2[static_cast<std::size_t>(i)] = dot(truth.axis(i), g) + truth.sigma_mps2(i) * noise.normal();
    const SetTest t = test_set(taken, gravity, limits, evidence, taken.all());
    alarms += t.parity > t.parity_alarm_limit(limits) ? 1 : 0;
  }
  EXPECT_GT(plumb_test::clopper_pearson(alarms, blocks, 0.9999).low, 2e-3);
}

/// The limit that the monitor publishes is the one measured above: its share, or the rate asked for each triple.
// Verifies: REQ-052
TEST(FalseAlarm, TheMonitorAsksEachTripleForItsShareOrForWhatIsConfigured) {
  for (const double each : {0.0, 1e-3}) {
    MonitorConfig config;
    config.false_alarm_rate = 1e-3;
    config.triple_false_alarm_rate = each;
    plumb_test::Rig rig(plumb_test::tetrahedron(kSigma), config);
    rig.setup.gravity.sigma_mps2 = 0.0;
    rig.restart();
    const Verdict& v = rig.stay(plumb_test::direction_at(40, 30));
    const double quantile = half_normal_mean_quantile(32, each > 0.0 ? each : 1e-3 / 4.0);
    bool one_of_them = false;
    BlockEvidence block;
    block.usable = rig.setup.array.all();
    block.samples = 32.0;
    for (int i = 0; i < 4; ++i) {
      block.mean_mps2[static_cast<std::size_t>(i)] =
          dot(rig.setup.array.axis(i), plumb_test::direction_at(40, 30)) * kG0_mps2;
    }
    for (int k = 0; k < 4; ++k) {
      const TestLimits limits = TestLimits::from_rates(4, 1e-3, 1e-6);
      const SetTest t = test_set(rig.setup.array, rig.setup.gravity, limits, block, rig.setup.array.triple(k).set());
      const double expected = t.norm_sigma_mps2 * quantile;
      one_of_them = one_of_them || std::fabs(v.mae_worst_limit_mps2 / expected - 1.0) < 1e-3;
    }
    EXPECT_TRUE(one_of_them) << each;
  }
}

}  // namespace
}  // namespace false_alarm_test
