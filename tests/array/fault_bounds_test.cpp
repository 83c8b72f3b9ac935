#include "plumb/array/fault_bounds.hpp"

#include <algorithm>
#include <limits>

#include "array_test_support.hpp"

namespace plumb {
namespace test {
namespace fault_bounds_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SensorArray cone_of(int n) {
  AxisList axes{};
  return built(axes.data(), cone(axes, n));
}

/// T7 as it is written: every choice of trusted sensors, the cheapest triple of it, the sum of its coefficients.
double by_definition(const SensorArray& array, const Readings& slack, int k, int i) {
  double worst = 0.0;
  for (std::uint32_t bits = 0; bits <= array.all().bits; ++bits) {
    const SensorSet trusted(bits);
    if (trusted.size() != array.size() - k || trusted.has(i)) continue;
    double cheapest = kInfinity;
    for (int t = 0; t < array.triple_count(); ++t) {
      if (!trusted.contains(array.triple(t).set()) || std::isinf(array.triple(t).condition)) continue;
      const Mat3 map = triple_map(array, t);
      double cost = 0.0;
      for (std::size_t m = 0; m < 3; ++m) {
        const double coefficient = dot(array.axis(i), {map[m], map[3 + m], map[6 + m]});
        cost += std::fabs(coefficient) * slack[array.triple(t).sensors[m]];
      }
      cheapest = std::min(cheapest, cost);
    }
    worst = std::max(worst, slack[at(i)] + cheapest);
  }
  return worst;
}

/// The table of docs/theory.md, section 8.2, in units of e: rows k = 1.., and the error of the vector.
TEST(FaultBoundsOf, MatchTheTableOfTheNote) {
  const FaultBounds tetra = fault_bounds(tetrahedron());
  EXPECT_NEAR(tetra.worst_fault(1), 8.0, 1e-9);
  EXPECT_NEAR(tetra.vector_error[1], 6.0, 1e-9);
  EXPECT_EQ(tetra.worst_fault(2), kInfinity);

  const FaultBounds five = fault_bounds(cone_of(5));
  EXPECT_NEAR(five.worst_fault(1), 6.5, 0.05);
  EXPECT_NEAR(five.worst_fault(2), 10.5, 0.05);
  EXPECT_NEAR(five.vector_error[2], 9.7, 0.05);

  AxisList axes{};
  const FaultBounds six = fault_bounds(built(axes.data(), platonic(axes, 6)));
  EXPECT_NEAR(six.worst_fault(1), 6.5, 0.05);
  EXPECT_NEAR(six.worst_fault(2), 6.5, 0.05);
  EXPECT_NEAR(six.worst_fault(3), 10.5, 0.05);
  EXPECT_NEAR(six.vector_error[2], 4.5, 0.05);

  const FaultBounds seven = fault_bounds(cone_of(7));
  const double expected_seven[] = {5.0, 6.2, 11.2, 20.2};
  for (int k = 1; k <= 4; ++k) EXPECT_NEAR(seven.worst_fault(k), expected_seven[k - 1], 0.05) << k;
  EXPECT_NEAR(seven.vector_error[2], 4.6, 0.05);
  EXPECT_NEAR(seven.vector_error[4], 19.8, 0.05);

  const FaultBounds eight = fault_bounds(built(axes.data(), cone_with_axis(axes, 8)));
  const double expected_eight[] = {6.1, 6.1, 7.2, 11.2, 20.2};
  for (int k = 1; k <= 5; ++k) EXPECT_NEAR(eight.worst_fault(k), expected_eight[k - 1], 0.05) << k;
  EXPECT_NEAR(eight.vector_error[2], 4.1, 0.05);
  EXPECT_NEAR(eight.vector_error[4], 9.6, 0.05);
}

TEST(FaultBoundsOf, NothingIsPromisedBeyondThePlane) {
  const FaultBounds triad = fault_bounds(built(std::array<Vec3, 3>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}.data(), 3));
  EXPECT_EQ(triad.worst_fault(1), kInfinity);
  EXPECT_NEAR(triad.vector_error[0], 2.0 * std::sqrt(3.0), 1e-12);
  EXPECT_EQ(triad.vector_error[1], kInfinity);
  EXPECT_EQ(triad.worst_fault(0), kInfinity) << "nobody is at fault";
  EXPECT_EQ(triad.worst_fault(4), kInfinity);
  // c = 3: one fault is detected, and not told from every other one.
  const FaultBounds z = fault_bounds(built(mikoff5_axes().data(), 5));
  EXPECT_LT(z.worst_fault(1), 15.0);
  EXPECT_EQ(z.worst_fault(2), kInfinity);
}

TEST(FaultBoundsOf, TwoTriadsPredictAnAxisByItsTwinAlone) {
  const Vec3 axes[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const FaultBounds bounds = fault_bounds(built(axes, 6));
  EXPECT_NEAR(bounds.worst_fault(1), 4.0, 1e-12);
  EXPECT_EQ(bounds.worst_fault(2), kInfinity);
}

RC_GTEST_PROP(FaultBoundsLaw, VerticesGiveWhatTheDefinitionGives, ()) {
  const SensorArray array = any_array(4);
  RC_PRE(array.size() <= 7);
  Readings slack{};
  for (int i = 0; i < array.size(); ++i) slack[at(i)] = any_in(0.5, 3.0);
  const FaultBounds bounds = fault_bounds(array, slack);
  const int last = array.size() - 1 - coplanarity(array, array.all());
  for (int k = 1; k <= array.size(); ++k) {
    for (int i = 0; i < array.size(); ++i) {
      if (k > last) {
        RC_ASSERT(bounds.fault[at(k)][at(i)] == kInfinity);
      } else {
        const double expected = by_definition(array, slack, k, i);
        RC_ASSERT(std::fabs(bounds.fault[at(k)][at(i)] - expected) <= 1e-6 * expected);
      }
    }
  }
}

/// Another explanation of the readings, found by trying: a vector d that the trusted sensors allow.
RC_GTEST_PROP(FaultBoundsLaw, NoExplanationIsFurtherAwayThanTheBound, ()) {
  // Of full size: the first cases that are drawn are small, with axes on top of one another.
  const SensorArray array = *rc::gen::resize(rc::kNominalSize, rc::gen::exec([] { return any_array(4); }));
  const int last = array.size() - 1 - coplanarity(array, array.all());
  RC_PRE(last >= 1);
  const FaultBounds bounds = fault_bounds(array);
  Vec3 d = any_unit();
  // As long as it may be with k sensors distrusted: those that object first are distrusted.
  const int k = *rc::gen::inRange(1, last + 1);
  std::vector<double> objections;
  for (int i = 0; i < array.size(); ++i) objections.push_back(std::fabs(dot(array.axis(i), d)));
  std::vector<double> sorted = objections;
  std::sort(sorted.begin(), sorted.end(), [](double a, double b) { return a > b; });
  d = scaled(d, 2.0 / sorted[at(k)]);
  RC_ASSERT(norm(d) <= bounds.vector_error[at(k)] * (1.0 + 1e-9));
  for (int i = 0; i < array.size(); ++i) {
    if (objections[at(i)] > sorted[at(k)])
      RC_ASSERT(2.0 + std::fabs(dot(array.axis(i), d)) <= bounds.fault[at(k)][at(i)] * (1.0 + 1e-9));
  }
}

}  // namespace
}  // namespace fault_bounds_test
}  // namespace test
TEST(FaultBounds, NoSensorsBoundNothing) {
  const FaultBounds bounds = fault_bounds(SensorArray{}, 0.1);
  EXPECT_EQ(bounds.sensors, 0);
  EXPECT_TRUE(std::isinf(bounds.vector_error[0]));
}

}  // namespace plumb
