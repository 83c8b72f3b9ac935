#include "plumb/array/mirror.hpp"

#include "array_test_support.hpp"

namespace plumb {
namespace test {
namespace array_mirror_test {
namespace {

Vec3 vector_of(const SensorArray& array, int triple, const Readings& y) {
  const Triple& t = array.triple(triple);
  return times(triple_map(array, triple), {y[t.sensors[0]], y[t.sensors[1]], y[t.sensors[2]]});
}

/// Of the note: |w|^2 = 3/2 and f* = -(4/3) g.w for the paper's tool, which stuck at -1 g on a vertical tool is.
TEST(Mirror, ValuesOfTheTetrahedron) {
  const SensorArray array = tetrahedron();
  for (int t = 0; t < 4; ++t) {
    for (int m = 0; m < 3; ++m) EXPECT_NEAR(dot(triple_weight(array, t, m), triple_weight(array, t, m)), 1.5, 1e-12);
  }
  const Vec3 vertical = {0.0, 0.0, 1.0};
  const int lower = array.triple_index(0, 1, 2);
  for (int m = 0; m < 3; ++m) EXPECT_NEAR(mirror_error(array, lower, m, vertical), -4.0 / 3.0, 1e-12) << "1/3 -> -1";
  const Vec3 g = {0.3, -0.5, std::sqrt(0.66)};
  EXPECT_NEAR(mirror_error(array, 1, 0, g), -4.0 / 3.0 * dot(g, triple_weight(array, 1, 0)), 1e-12);
}

TEST(Mirror, OfATriadIsAReversal) {
  const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const SensorArray array = built(axes, 3);
  EXPECT_EQ(mirror_axis(array, 0, 1), (Vec3{0.0, -1.0, 0.0}));
  EXPECT_EQ(mirror_error(array, 0, 1, {0.0, 0.7, 0.1}), -1.4);
}

TEST(Mirror, NoInverseNoMirror) {
  const double d = std::sqrt(0.5);
  const Vec3 axes[4] = {{1, 0, 0}, {0, 1, 0}, {d, d, 0}, {0, 0, 1}};
  const SensorArray array = built(axes, 4);
  const int flat = array.triple_index(0, 1, 2);
  EXPECT_EQ(mirror_error(array, flat, 0, {1.0, 2.0, 3.0}), 0.0);
  EXPECT_EQ(mirror_axis(array, flat, 0), Vec3{});
  EXPECT_EQ(mirror_axis(array, 99, 0), Vec3{});
  EXPECT_EQ(mirror_axis(array, 1, 3), Vec3{});
}

RC_GTEST_PROP(MirrorLaw, TheMirrorErrorIsAnExactUndetectablePair, ()) {
  const SensorArray array = any_array();
  const int t = *rc::gen::inRange(0, array.triple_count());
  RC_PRE(array.triple(t).condition < 1e3);
  const int m = *rc::gen::inRange(0, 3);
  const Vec3 g = scaled(any_unit(), 9.8);
  Readings y{};
  for (int i = 0; i < array.size(); ++i) y[at(i)] = dot(array.axis(i), g);
  const double mirror = mirror_error(array, t, m, g);
  const std::uint8_t faulty = array.triple(t).sensors[at(m)];
  const double truth = y[faulty];
  y[faulty] = truth + mirror;
  const double precision = 1e-9 * array.triple(t).condition;
  RC_ASSERT(std::fabs(norm(vector_of(array, t, y)) - 9.8) <= precision);
  // It is what the sensor would read on its mirror axis.
  const Vec3 wrong = mirror_axis(array, t, m);
  RC_ASSERT(std::fabs(norm(wrong) - 1.0) <= 1e-9 * array.triple(t).condition);
  RC_ASSERT(std::fabs(dot(wrong, g) - y[faulty]) <= precision);
  // And T1: any other error changes the length by as much as it says.
  const double f = any_in(-20.0, 20.0);
  y[faulty] = truth + f;
  const Vec3 x = vector_of(array, t, y);
  const Vec3 w = triple_weight(array, t, m);
  const double expected = dot(w, w) * f * (f - mirror);
  RC_ASSERT(std::fabs(dot(x, x) - 9.8 * 9.8 - expected) <= 1e-9 * (100.0 + std::fabs(expected)) * dot(w, w));
}

}  // namespace
}  // namespace array_mirror_test
}  // namespace test

TEST(Mirror, AMemberThatATripleDoesNotHaveWeighsNothing) {
  for (const int member : {-1, 3}) {
    EXPECT_EQ(triple_weight(test::tetrahedron(), 0, member), Vec3{});
    EXPECT_EQ(mirror_error(test::tetrahedron(), 0, member, {0.0, 0.0, 9.81}), 0.0);
  }
}

}  // namespace plumb
