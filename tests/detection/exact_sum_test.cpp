// The sliding sums stay exact for ever: 1e7 updates by default, 1e9 in the long run (PLUMB_LONG=1).
// Serves: REQ-051
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "plumb/detection/combination_mae.hpp"
#include "support/long_run.hpp"
#include "support/simulated_tool.hpp"

namespace exact_sum_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

/// One reading: usually gravity with noise, now and then what a broken channel or bus delivers.
double any_reading(Noise& noise, double healthy) {
  const double kind = noise.uniform();
  if (kind > 0.002) return healthy + 1e-3 * noise.uniform();
  if (kind < 0.0004) return std::numeric_limits<double>::quiet_NaN();
  if (kind < 0.0008) return std::numeric_limits<double>::infinity();
  if (kind < 0.0012) return -std::numeric_limits<double>::infinity();
  return kind < 0.0016 ? 1e300 : -1e300;
}

/// Errors in units as the kernel must see them, kept outside of it: the oracle of the window sums.
struct Shadow {
  std::vector<std::int32_t> ring;
  std::size_t head = 0;
  void push(std::int32_t value) {
    ring[head] = value;
    head = head + 1 == ring.size() ? 0 : head + 1;
  }
  std::int64_t sum() const {
    std::int64_t out = 0;
    for (const std::int32_t v : ring) out += v;
    return out;
  }
};

// Verifies: REQ-051
TEST(ExactSum, EqualsAFreshSumAfterAnyNumberOfUpdates) {
  const SensorArray array = plumb_test::tetrahedron();
  const std::int64_t updates = plumb_test::long_run() ? 1000000000 : 10000000;
  const std::int64_t between = updates / 1000;  // compared a thousand times on the way
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array.triple_count(), kWindowCapacity);
  std::vector<Shadow> shadow(static_cast<std::size_t>(array.triple_count()));
  for (Shadow& s : shadow) s.ring.assign(kWindowCapacity, 0);
  Noise noise(20180227);
  std::int64_t clamped = 0;
  Readings y{};
  for (std::int64_t step = 1; step <= updates; ++step) {
    for (int i = 0; i < array.size(); ++i)
      y[static_cast<std::size_t>(i)] = any_reading(noise, array.axis(i)[2] * kG0_mps2);
    mae->add(array, y, array.all(), nullptr, kG0_mps2);
    for (int k = 0; k < array.triple_count(); ++k) {
      const Triple& t = array.triple(k);
      const double square = squared_length(array.form(k), y[t.sensors[0]], y[t.sensors[1]], y[t.sensors[2]]);
      const std::int32_t units = to_mae_units(std::sqrt(square < 0.0 ? 0.0 : square) - kG0_mps2);
      clamped += units == kMaeClamp ? 1 : 0;
      shadow[static_cast<std::size_t>(k)].push(units);
    }
    if (step % between != 0) continue;
    for (int k = 0; k < array.triple_count(); ++k) {
      ASSERT_EQ(mae->triple_sum(k), shadow[static_cast<std::size_t>(k)].sum()) << "after " << step;
      ASSERT_EQ(mae->triple_sum(k), mae->fresh_triple_sum(k)) << "after " << step;
      ASSERT_EQ(mae->triple_samples(k), kWindowCapacity);
    }
  }
  EXPECT_GT(clamped, updates / 1000) << "else no broken reading was met";
  RecordProperty("updates", std::to_string(updates));
}

// Negative: REQ-051
TEST(ExactSum, ARunningSumInFloatingPointWouldNot) {
  Noise noise(3);
  std::vector<double> ring(32, 0.0);
  double running = 0.0;
  for (std::size_t step = 0; step < 100000; ++step) {
    const double error = step == 50000 ? 1e6 : 0.02 * noise.uniform();  // one spike
    running += error - ring[step % 32];
    ring[step % 32] = error;
  }
  double fresh = 0.0;
  for (const double e : ring) fresh += e;
  EXPECT_NE(running, fresh);
}

}  // namespace
}  // namespace exact_sum_test
