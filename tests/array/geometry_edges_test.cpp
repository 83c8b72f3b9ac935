// Edges of the geometry: noise that leaves no number, rows that memory has damaged, rows that are none.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "array_test_support.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/array/named.hpp"
#include "support/simulated_tool.hpp"

namespace geometry_edges_test {
namespace {

using namespace plumb;

/// Three orthogonal axes and one between the last two, each with a noise of its own.
SensorArray four(const std::array<double, 4>& sigma_mps2) {
  const double h = std::sqrt(0.5);
  AxisList axes{};
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = {0.0, 0.0, 1.0};
  axes[3] = {0.0, h, h};
  SensorArray array = plumb_test::make_array(axes, 4, 1.0);
  std::array<SensorRow, 4> rows{};
  for (int i = 0; i < 4; ++i) {
    rows[static_cast<std::size_t>(i)] = array.row(i);
    rows[static_cast<std::size_t>(i)].sigma_mps2 = sigma_mps2[static_cast<std::size_t>(i)];
  }
  EXPECT_TRUE(array.set_rows(rows.data()).has_value());
  return array;
}

TEST(GeometryEdge, NoiseWhoseSquareIsNoNumberHasNoVector) {
  const SensorArray array = four({1e200, 1e200, 1e200, 1e200});
  EXPECT_FALSE(least_squares(array, array.all()).valid);
  EXPECT_EQ(parity_basis(array, array.all()).rows, 1) << "what agrees does not ask for the size of the noise";
}

/// A direction that only one sensor sees, a hundred decades louder than the others: beside them it is not there.
TEST(GeometryEdge, ADirectionOfNoWeightLeavesAParityOfTheOthers) {
  const SensorArray array = four({1e200, 1.0, 1.0, 1.0});
  EXPECT_FALSE(least_squares(array, array.all()).valid);
  const ParityBasis basis = parity_basis(array, array.all());
  ASSERT_EQ(basis.rows, 1);
  double square = 0.0;
  for (int i = 0; i < 4; ++i)
    square += basis.weight[0][static_cast<std::size_t>(i)] * basis.weight[0][static_cast<std::size_t>(i)];
  EXPECT_TRUE(std::isfinite(square));
}

// Negative: REQ-166
TEST(GeometryEdge, AnAxisThatMemoryHasDamagedGivesNoVector) {
  SensorArray array = plumb_test::tetrahedron();
  const_cast<SensorRow&>(array.row(1)).axis[0] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(least_squares(array, array.all()).valid);
}

TEST(GeometryEdge, RowsThatAreNoneLeaveTheArrayAsItWas) {
  SensorArray array = plumb_test::tetrahedron();
  std::array<SensorRow, 4> rows{};
  for (int i = 0; i < 4; ++i) rows[static_cast<std::size_t>(i)] = array.row(i);
  rows[2].sigma_mps2 = 0.0;
  const Expected<void> answer = array.set_rows(rows.data());
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().code, Errc::sigma_not_positive);
  EXPECT_EQ(answer.error().index, 2);
  EXPECT_GT(array.sigma_mps2(2), 0.0);
}

}  // namespace
}  // namespace geometry_edges_test
