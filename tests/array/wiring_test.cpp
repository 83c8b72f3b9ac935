#include "plumb/array/wiring.hpp"

#include "array_test_support.hpp"

namespace plumb {
namespace test {
namespace wiring_test {
namespace {

constexpr double kVisible = 1e-9;

/// docs/theory.md, section 1.5: swaps among the three on the cone leave every test silent; with the axial one they do
/// not.
TEST(WiringEffectOf, SwapsOfTheTetrahedron) {
  const SensorArray array = tetrahedron();
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 3; ++j) {
      const WiringEffect effect = wiring_effect(array, Wiring::swapped(i, j));
      EXPECT_TRUE(effect.unseen(kVisible, kVisible));
      EXPECT_NEAR(effect.inclination_rad, 0.0, 1e-9);
      EXPECT_EQ(effect.turn_rad, kPi) << "a mirror image";
    }
    EXPECT_GT(wiring_effect(array, Wiring::swapped(i, 3)).parity, 0.5);
    EXPECT_GT(wiring_effect(array, Wiring::reversed(i)).parity, 0.5);
  }
  const WiringEffect turned = wiring_effect(array, Wiring::cycled(0, 1, 2));
  EXPECT_TRUE(turned.unseen(kVisible, kVisible));
  EXPECT_NEAR(turned.turn_rad, 2.0 * kPi / 3.0, 1e-12);
  EXPECT_NEAR(turned.inclination_rad, 0.0, 1e-9);
  EXPECT_FALSE(wiring_effect(array, Wiring::cycled(0, 1, 3)).unseen(0.1, 0.1));
}

TEST(WiringEffectOf, ATriadHidesAllOfThem) {
  const SensorArray array = built(std::array<Vec3, 3>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}.data(), 3);
  const WiringEffect flipped = wiring_effect(array, Wiring::reversed(2));
  EXPECT_TRUE(flipped.unseen(kVisible, kVisible));
  EXPECT_NEAR(flipped.inclination_rad, kPi, 1e-9);
  EXPECT_TRUE(wiring_effect(array, Wiring::swapped(0, 2)).unseen(kVisible, kVisible));
  EXPECT_TRUE(wiring_effect(array, Wiring::swapped_reversed(0, 1)).unseen(kVisible, kVisible));
}

TEST(WiringEffectOf, CorrectWiringHasNone) {
  const WiringEffect effect = wiring_effect(tetrahedron(), Wiring::correct());
  EXPECT_TRUE(effect.unseen(1e-15, 1e-15));
  EXPECT_NEAR(effect.turn_rad, 0.0, 1e-9);
  EXPECT_NEAR(effect.inclination_rad, 0.0, 1e-9);
  EXPECT_EQ(wiring_effect(SensorArray(), Wiring::correct()).parity, 0.0);
}

/// Against the readings themselves: what parity and length would say at attitudes drawn at random.
RC_GTEST_PROP(WiringLaw, NoAttitudeShowsMoreThanTheEffectSays, ()) {
  std::vector<SensorRow> rows = any_rows();
  for (SensorRow& row : rows) row.sigma_mps2 = 1.0;
  const Expected<SensorArray> made = make(rows);
  RC_ASSERT(made.has_value());
  const SensorArray& array = *made;
  const FiguresOfMerit merit = figures_of_merit(array);
  RC_PRE(merit.condition < 1e3);
  const int i = *rc::gen::inRange(0, array.size());
  const int j = *rc::gen::inRange(0, array.size());
  const int kind = *rc::gen::inRange(0, 3);
  const Wiring wiring = kind == 0   ? Wiring::reversed(i)
                        : kind == 1 ? Wiring::swapped(i, j)
                                    : Wiring::swapped_reversed(i, j);
  const WiringEffect effect = wiring_effect(array, wiring);
  const Vec3 g = any_unit();
  Readings y{};
  for (int c = 0; c < array.size(); ++c) y[at(c)] = wiring.sign[at(c)] * dot(array.axis(wiring.source[at(c)]), g);
  const ParityBasis basis = parity_basis(array, array.all());
  double square = 0.0;
  for (int r = 0; r < basis.rows; ++r) {
    double sum = 0.0;
    for (int c = 0; c < array.size(); ++c) sum += basis.weight[at(r)][at(c)] * y[at(c)];
    square += sum * sum;
  }
  const Vec3 x = least_squares(array, array.all()).estimate(y);
  const double rounding = 1e-10 * merit.condition * merit.condition;
  RC_ASSERT(std::sqrt(square) <= effect.parity + rounding);
  RC_ASSERT(std::fabs(norm(x) - 1.0) <= effect.length + rounding);
  if (effect.unseen(1e-9, 1e-9) && merit.condition < 30.0) {
    RC_ASSERT(angle_between_rad(x, g) <= effect.turn_rad + 1e-6);
    const double off = angle_between_rad(x, {0.0, 0.0, 1.0}) - angle_between_rad(g, {0.0, 0.0, 1.0});
    RC_ASSERT(std::fabs(off) <= effect.inclination_rad + 1e-6);
  }
}

}  // namespace
}  // namespace wiring_test
}  // namespace test
}  // namespace plumb
