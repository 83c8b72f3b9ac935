// Arrays that a build for eight sensors cannot hold: the tests of the room array are built for eight, these for 24.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "plumb/array/geometry.hpp"
#include "plumb/array/named.hpp"

namespace plumb {
namespace ten_axes_test {
namespace {

static_assert(kCapacity >= 10);

TEST(Platonic, TenAxesAreTheFaceNormalsOfTheIcosahedron) {
  AxisList axes{};
  ASSERT_EQ(platonic(axes, 10), 10);
  // Of the nine others, three lie at acos(sqrt5/3) and six at acos(1/3) from any axis.
  for (std::size_t i = 0; i < 10; ++i) {
    int near = 0;
    for (std::size_t j = 0; j < 10; ++j) {
      if (j == i) continue;
      const double cosine = std::fabs(dot(axes[i], axes[j]));
      const bool is_near = std::fabs(cosine - std::sqrt(5.0) / 3.0) < 1e-14;
      EXPECT_TRUE(is_near || std::fabs(cosine - 1.0 / 3.0) < 1e-14) << cosine;
      if (is_near) ++near;
    }
    EXPECT_EQ(near, 3);
  }
}

TEST(Platonic, TheLeastDeterminantOfTenAxesIsThatOfTheNote) {
  AxisList axes{};
  ASSERT_EQ(platonic(axes, 10), 10);
  std::array<SensorRow, 10> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].id = make_id(("a" + std::to_string(i + 1)).c_str());
    rows[i].axis = axes[i];
    rows[i].sigma_mps2 = 0.01;
  }
  const auto array = SensorArray::make(rows.data(), 10);
  ASSERT_TRUE(array.has_value());
  EXPECT_NEAR(figures_of_merit(*array).min_triple_det, 0.238, 5e-4);
}

}  // namespace
}  // namespace ten_axes_test
}  // namespace plumb
