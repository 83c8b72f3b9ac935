#include "plumb/detection/combination_mae.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "plumb/array/named.hpp"
#include "support/simulated_tool.hpp"

namespace combination_mae_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

/// Eqs (22)-(25) by the inverse of the three rows, independent of the quadratic form of the kernel.
double length_by_inverse(const SensorArray& array, int k, const Readings& y) {
  const auto& s = array.triple(k).sensors;
  return norm(times(triple_map(array, k), {y[s[0]], y[s[1]], y[s[2]]}));
}

// Verifies: REQ-051
TEST(CombinationMae, EqualsDirectEvaluationOfEquations26To29) {
  const SensorArray array = plumb_test::tetrahedron();
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array.triple_count(), 8);
  Noise noise(3);
  const LeastSquares all = least_squares(array, array.all());
  std::vector<Readings> window;
  for (int step = 0; step < 8; ++step) {
    const Vec3 u = plumb_test::random_direction(noise);
    Readings y{};
    for (int i = 0; i < 4; ++i)
      y[static_cast<std::size_t>(i)] = dot(array.axis(i), u) * kG0_mps2 + 0.05 * noise.normal();
    window.push_back(y);
    const Vec3 x = all.estimate(y);
    mae->add(array, y, array.all(), &x, kG0_mps2);
  }
  for (int k = 0; k < array.triple_count(); ++k) {
    double sum = 0.0;
    for (const auto& y : window) sum += std::fabs(length_by_inverse(array, k, y) - kG0_mps2);
    EXPECT_NEAR(mae->triple_mps2(k), sum / 8.0, 1.01 * kMaeUnit_mps2 / 2.0);
    EXPECT_EQ(mae->triple_samples(k), 8);
  }
  double sum = 0.0;
  for (const auto& y : window) sum += std::fabs(norm(all.estimate(y)) - kG0_mps2);
  EXPECT_NEAR(mae->all_mps2(), sum / 8.0, kMaeUnit_mps2);
}

// Negative: REQ-051
TEST(CombinationMae, HugeAndNonFiniteErrorsTakeTheClampAndLeaveNoTrace) {
  EXPECT_EQ(to_mae_units(std::numeric_limits<double>::quiet_NaN()), kMaeClamp);
  EXPECT_EQ(to_mae_units(std::numeric_limits<double>::infinity()), kMaeClamp);
  EXPECT_EQ(to_mae_units(-1e300), kMaeClamp);
  EXPECT_EQ(to_mae_units(0.0), 0);

  const SensorArray array = plumb_test::tetrahedron();
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array.triple_count(), 4);
  Readings wild{};
  wild.fill(1e300);
  Readings calm{};
  for (int i = 0; i < 4; ++i) calm[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2;
  for (int k = 0; k < 2; ++k) mae->add(array, wild, array.all(), nullptr, kG0_mps2);
  EXPECT_GT(mae->triple_mps2(0), 100.0);
  for (int k = 0; k < 4; ++k) mae->add(array, calm, array.all(), nullptr, kG0_mps2);
  for (int k = 0; k < array.triple_count(); ++k) EXPECT_LT(mae->triple_mps2(k), 2e-7);
}

/// The window sum after any history equals a fresh sum over the ring, bit for bit.
// Verifies: REQ-051
RC_GTEST_PROP(CombinationMaeLaw, WindowSumIsExactWhateverCameBefore, ()) {
  const int n = *rc::gen::inRange(3, kCapacity + 1);
  const int window = *rc::gen::inRange(1, kWindowCapacity + 1);
  const int steps = *rc::gen::inRange(1, 200);
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  AxisList axes{};
  for (int i = 0; i < n; ++i) axes[static_cast<std::size_t>(i)] = plumb_test::random_direction(noise);
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    auto& row = rows[static_cast<std::size_t>(i)];
    row.id = make_id(("s" + std::to_string(i)).c_str());
    row.axis = axes[static_cast<std::size_t>(i)];
    row.sigma_mps2 = 0.01;
  }
  const auto array = SensorArray::make(rows.data(), n);
  RC_PRE(array.has_value());
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array->triple_count(), window);
  const LeastSquares map = least_squares(*array, array->all());
  for (int step = 0; step < steps; ++step) {
    Readings y{};
    SensorSet usable = array->all();
    for (int i = 0; i < n; ++i) {
      const double kind = noise.uniform();
      double v = 20.0 * (noise.uniform() - 0.5);
      if (kind < 0.05) v = 1e300;
      if (kind > 0.98) v = std::numeric_limits<double>::infinity();
      if (kind > 0.99) v = std::numeric_limits<double>::quiet_NaN();
      if (noise.uniform() < 0.1) usable = usable.without(i);
      y[static_cast<std::size_t>(i)] = v;
    }
    const Vec3 x = map.estimate(y);
    mae->add(*array, y, usable, &x, kG0_mps2);
  }
  for (int k = 0; k < array->triple_count(); ++k) RC_ASSERT(mae->triple_sum(k) == mae->fresh_triple_sum(k));
}

/// Error of triple k in units, by one triple alone.
std::int32_t units_alone(const SensorArray& array, int k, const Readings& y, double g_mps2) {
  const auto& s = array.triple(k).sensors;
  const auto q = [&array, k](std::size_t c) { return array.form_coefficients(c)[k]; };
  const double square = squared_length(q(0), q(1), q(2), q(3), q(4), q(5), y[s[0]], y[s[1]], y[s[2]]);
  return to_mae_units(std::sqrt(square < 0.0 ? 0.0 : square) - g_mps2);
}

/// Every number of lanes that this processor has.
std::vector<Lanes> lanes_here() {
  std::vector<Lanes> out = {Lanes::one, kPortableLanes};
  if (most_lanes() >= Lanes::four) out.push_back(Lanes::four);
  if (most_lanes() == Lanes::eight) out.push_back(Lanes::eight);
  return out;
}

// Verifies: REQ-051
RC_GTEST_PROP(CombinationMaeLaw, TriplesSideBySideGiveTheBitsOfOneAlone, ()) {
  const int n = *rc::gen::inRange(3, kCapacity + 1);
  AxisList axes{};
  cone(axes, n);
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    auto& row = rows[static_cast<std::size_t>(i)];
    row.id = make_id(("a" + std::to_string(i)).c_str());
    row.axis = axes[static_cast<std::size_t>(i)];
    row.sigma_mps2 = 1e-3;
  }
  const auto array = std::make_unique<SensorArray>(*SensorArray::make(rows.data(), n));
  const auto lanes = lanes_here();
  std::vector<CombinationMae> by(lanes.size() + 1);  // the last one as the processor likes it
  for (CombinationMae& mae : by) mae.configure(array->triple_count(), 2);
  std::vector<std::vector<std::int32_t>> alone;
  for (int step = 0; step < 8; ++step) {
    Readings y{};
    for (int i = 0; i < n; ++i) {
      const double odd[] = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, 5e-324, -0.0};
      const int kind = *rc::gen::inRange(0, 40);
      const double plain = 12.0 * (*rc::gen::inRange(-1000000, 1000000) / 999983.0);
      y[static_cast<std::size_t>(i)] = kind < 6 ? odd[kind] : plain;
    }
    // A sensor that is out leaves gaps in its row of the window: what comes there next is not all taken side by side.
    const int out = *rc::gen::inRange(-2 * n, n);
    const SensorSet usable = out < 0 ? array->all() : array->all().without(out);
    for (std::size_t l = 0; l < lanes.size(); ++l) by[l].add(*array, y, usable, nullptr, kG0_mps2, lanes[l]);
    by.back().add(*array, y, usable, nullptr, kG0_mps2);
    std::vector<std::int32_t>& now = alone.emplace_back();
    for (int k = 0; k < array->triple_count(); ++k) {
      const bool present = usable.contains(array->triple(k).set());
      now.push_back(present ? units_alone(*array, k, y, kG0_mps2) : -1);
      const std::int32_t before = step > 0 ? alone[alone.size() - 2][static_cast<std::size_t>(k)] : -1;
      const std::int64_t sum = std::int64_t{now.back() < 0 ? 0 : now.back()} + (before < 0 ? 0 : before);
      for (const CombinationMae& mae : by) {
        RC_ASSERT(mae.triple_sum(k) == sum);
        RC_ASSERT(mae.fresh_triple_sum(k) == sum);
      }
    }
  }
}

/// Four triples, of which fewer are left than are taken side by side.
// Verifies: REQ-051
TEST(CombinationMae, FewerTriplesThanLanesAreLeftAsTheyAre) {
  const SensorArray array = plumb_test::tetrahedron();
  Readings y{};
  std::array<std::int32_t, kTripleCapacity> slots{};
  std::array<std::int64_t, kTripleCapacity> sums{};
  slots.fill(5);
  sums.fill(5);
  for (const Lanes lanes : lanes_here()) {
    EXPECT_EQ(replace_side_by_side(array, y.data(), kG0_mps2, slots.data(), sums.data(), {3, 4}, lanes), 3);
  }
  for (const std::int32_t slot : slots) EXPECT_EQ(slot, 5);
  for (const std::int64_t sum : sums) EXPECT_EQ(sum, 5);
}

// Verifies: REQ-051
TEST(CombinationMae, ATripleWithAMissingMemberUsesItsOwnCount) {
  const SensorArray array = plumb_test::tetrahedron();
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array.triple_count(), 4);
  Readings y{};
  for (int i = 0; i < 4; ++i) y[static_cast<std::size_t>(i)] = array.axis(i)[2] * 9.0;
  mae->add(array, y, array.all(), nullptr, kG0_mps2);
  mae->add(array, y, array.all().without(3), nullptr, kG0_mps2);
  EXPECT_EQ(mae->triple_samples(array.triple_index(0, 1, 2)), 2);
  EXPECT_EQ(mae->triple_samples(array.triple_index(0, 1, 3)), 1);
  EXPECT_NEAR(mae->triple_mps2(array.triple_index(0, 1, 3)), kG0_mps2 - 9.0, 1e-6);
}

// Serves: REQ-051
TEST(CombinationMae, TheWindowIsNeverEmptyAndNeverBeyondItsRoom) {
  const auto mae = std::make_unique<CombinationMae>();
  mae->configure(4, 0);
  EXPECT_EQ(mae->window(), 1);
  mae->configure(4, kWindowCapacity + 1);
  EXPECT_EQ(mae->window(), kWindowCapacity);
}

}  // namespace
}  // namespace combination_mae_test
