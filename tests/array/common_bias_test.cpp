#include "plumb/array/common_bias.hpp"

#include "array_test_support.hpp"

namespace plumb {
namespace test {
namespace common_bias_test {
namespace {

/// docs/theory.md, section 1.4: parity of the paper's tool sees half of it and the vector takes 1.5 b along z; with the
/// fourth sensor the other way round parity sees all and the vector takes nothing.
TEST(CommonBiasOf, TheTetrahedronAndItsFourthSensorReversed) {
  const CommonBias plain = common_bias(tetrahedron());
  EXPECT_NEAR(plain.visibility, 0.5, 1e-15);
  EXPECT_NEAR(norm(minus(plain.vector_error, {0.0, 0.0, 1.5})), 0.0, 1e-15);
  const PolarityPlan plan = best_polarity(tetrahedron());
  EXPECT_EQ(plan.reverse, SensorSet::of(3));
  EXPECT_NEAR(plan.effect.visibility, 1.0, 1e-15);
  EXPECT_NEAR(norm(plan.effect.vector_error), 0.0, 1e-15);
}

TEST(CommonBiasOf, AConeHidesItAndReversingSensorsShowsMostOfIt) {
  for (int n = 4; n <= 8; ++n) {
    AxisList axes{};
    const SensorArray array = built(axes.data(), cone(axes, n));
    EXPECT_NEAR(common_bias(array).visibility, 0.0, 1e-14);
    EXPECT_NEAR(norm(common_bias(array).vector_error), std::sqrt(3.0), 1e-14);
    EXPECT_GE(best_polarity(array).effect.visibility, 0.91) << n;
  }
}

TEST(CommonBiasOf, ThreeSensorsCannotSeeIt) {
  const SensorArray array = built(std::array<Vec3, 3>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}.data(), 3);
  EXPECT_NEAR(best_polarity(array).effect.visibility, 0.0, 1e-15);
  EXPECT_EQ(best_polarity(array).reverse, SensorSet{}) << "nothing is gained by reversing";
  EXPECT_EQ(common_bias(SensorArray()).visibility, 0.0);
}

RC_GTEST_PROP(CommonBiasLaw, NoPatternShowsMoreThanTheBest, ()) {
  const std::vector<SensorRow> rows = any_rows();
  const Expected<SensorArray> array = make(rows);
  RC_ASSERT(array.has_value());
  RC_PRE(figures_of_merit(*array).condition < 1e3);
  const PolarityPlan plan = best_polarity(*array);
  RC_ASSERT(!plan.reverse.has(0));
  // A pattern of one's own, mounted and judged by the parity basis.
  const std::uint32_t pattern = *rc::gen::inRange<std::uint32_t>(0, std::uint32_t{1} << rows.size());
  const auto mounted = [&rows](SensorSet reverse) {
    std::vector<SensorRow> turned = rows;
    for (int i = 0; i < static_cast<int>(turned.size()); ++i) {
      if (reverse.has(i)) turned[at(i)].axis = scaled(turned[at(i)].axis, -1.0);
    }
    return figures_of_merit(*make(turned)).common_bias_visibility;
  };
  RC_ASSERT(mounted(SensorSet(pattern)) <= plan.effect.visibility + 1e-6);
  RC_ASSERT(std::fabs(mounted(plan.reverse) - plan.effect.visibility) <= 1e-9);
}

}  // namespace
}  // namespace common_bias_test
}  // namespace test
TEST(CommonBias, NoSensorsHaveNoPlan) {
  const PolarityPlan plan = best_polarity(SensorArray{});
  EXPECT_TRUE(plan.reverse.empty());
}

}  // namespace plumb
