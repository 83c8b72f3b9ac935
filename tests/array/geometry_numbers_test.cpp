// Geometry at the end of the numbers: noise whose square is none, axes that memory has damaged.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "array_test_support.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/array/named.hpp"
#include "support/simulated_tool.hpp"

namespace geometry_numbers_test {
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

TEST(GeometryNumbers, NoiseWhoseSquareIsNoNumberHasNoVector) {
  const SensorArray array = four({1e200, 1e200, 1e200, 1e200});
  EXPECT_FALSE(least_squares(array, array.all()).valid);
  EXPECT_EQ(parity_basis(array, array.all()).rows, 1) << "what agrees does not ask for the size of the noise";
}

/// A direction that only one sensor sees, a hundred decades louder than the others: beside them it is not there.
TEST(GeometryNumbers, ADirectionOfNoWeightLeavesAParityOfTheOthers) {
  const SensorArray array = four({1e200, 1.0, 1.0, 1.0});
  EXPECT_FALSE(least_squares(array, array.all()).valid);
  const ParityBasis basis = parity_basis(array, array.all());
  ASSERT_EQ(basis.rows, 1);
  double square = 0.0;
  for (int i = 0; i < 4; ++i)
    square += basis.weight[0][static_cast<std::size_t>(i)] * basis.weight[0][static_cast<std::size_t>(i)];
  EXPECT_TRUE(std::isfinite(square));
}

/// Every byte of the rows altered in turn, as memory may: the map gives numbers, or says that it is none.
// Negative: REQ-166
TEST(GeometryNumbers, RowsThatMemoryHasDamagedGiveNumbersOrNoVector) {
  const SensorArray sound = plumb_test::tetrahedron();
  Readings readings{};
  readings.fill(1.0);
  int valid = 0, none = 0;
  for (int i = 0; i < sound.size(); ++i) {
    for (const double* figure :
         {&sound.row(i).axis[0], &sound.row(i).axis[1], &sound.row(i).axis[2], &sound.row(i).sigma_mps2}) {
      const auto place =
          reinterpret_cast<const unsigned char*>(figure) - reinterpret_cast<const unsigned char*>(&sound);
      for (std::ptrdiff_t byte = place; byte < place + static_cast<std::ptrdiff_t>(sizeof(double)); ++byte) {
        for (const int value : {0x00, 0x3F, 0x7F, 0x80, 0xF0, 0xFF}) {
          SensorArray damaged = sound;
          reinterpret_cast<unsigned char*>(&damaged)[byte] = static_cast<unsigned char>(value);
          const LeastSquares map = least_squares(damaged, damaged.all());
          ++(map.valid ? valid : none);
          if (!map.valid) continue;
          EXPECT_TRUE(std::isfinite(norm(map.estimate(readings)))) << byte << " " << value;
          for (const double c : map.covariance) EXPECT_TRUE(std::isfinite(c)) << byte << " " << value;
        }
      }
    }
  }
  // An infinite axis: the exponent takes two bytes.
  const double infinite = HUGE_VAL;
  SensorArray damaged = sound;
  const auto place =
      reinterpret_cast<const unsigned char*>(&sound.row(1).axis[0]) - reinterpret_cast<const unsigned char*>(&sound);
  std::memcpy(reinterpret_cast<unsigned char*>(&damaged) + place, &infinite, sizeof infinite);
  EXPECT_FALSE(least_squares(damaged, damaged.all()).valid);
  EXPECT_GT(valid, 0);
  EXPECT_GT(none, 0);
}

}  // namespace
}  // namespace geometry_numbers_test
