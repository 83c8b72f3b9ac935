#include "plumb/array/geometry.hpp"

#include <algorithm>
#include <limits>

#include "array_test_support.hpp"

namespace plumb {
namespace test {
namespace array_geometry_test {
namespace {

const double kR2 = std::sqrt(2.0);
const double kR6 = std::sqrt(6.0);

void expect_map(const Mat3& map, const Mat3& paper) {
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(map[k], paper[k], 1e-15) << "entry " << k;
}

TEST(PaperMaps, Eq17LeastSquaresOfAllFour) {
  const LeastSquares fit = least_squares(tetrahedron(), SensorSet::first(4));
  ASSERT_TRUE(fit.valid);
  const Vec3 paper[4] = {{kR2 / 2, 0, 0.25}, {-kR2 / 4, kR6 / 4, 0.25}, {-kR2 / 4, -kR6 / 4, 0.25}, {0, 0, 0.75}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(fit.column[i][k], paper[i][k], 1e-15) << i << k;
  }
  // H'H = 4/3 I.
  expect_map(fit.covariance, {0.75, 0, 0, 0, 0.75, 0, 0, 0, 0.75});
}

TEST(PaperMaps, Eqs18To21Triples) {
  const SensorArray a = tetrahedron();
  expect_map(triple_map(a, a.triple_index(1, 2, 3)),
             {-3 * kR2 / 4, -3 * kR2 / 4, kR2 / 2, kR6 / 4, -kR6 / 4, 0, 0, 0, 1});
  expect_map(triple_map(a, a.triple_index(0, 2, 3)),
             {3 * kR2 / 4, 0, -kR2 / 4, -kR6 / 4, -2 * kR6 / 4, kR6 / 4, 0, 0, 1});
  expect_map(triple_map(a, a.triple_index(0, 1, 3)), {3 * kR2 / 4, 0, -kR2 / 4, kR6 / 4, kR6 / 2, -kR6 / 4, 0, 0, 1});
  expect_map(triple_map(a, a.triple_index(0, 1, 2)), {kR2 / 2, -kR2 / 4, -kR2 / 4, 0, kR6 / 4, -kR6 / 4, 1, 1, 1});
}

TEST(TripleMap, IsZeroForASingularOrUnknownTriple) {
  const double d = std::sqrt(0.5);
  const Vec3 axes[4] = {{1, 0, 0}, {0, 1, 0}, {d, d, 0}, {0, 0, 1}};
  const SensorArray array = built(axes, 4);
  EXPECT_EQ(triple_map(array, array.triple_index(0, 1, 2)), Mat3{});
  EXPECT_EQ(triple_map(array, -1), Mat3{});
  EXPECT_EQ(triple_map(array, 4), Mat3{});
}

TEST(Parity, RowOfTheTetrahedron) {
  for (const double sigma : {1.0, 0.005}) {
    const ParityBasis basis = parity_basis(tetrahedron(sigma), SensorSet::first(4));
    ASSERT_EQ(basis.rows, 1);
    const double expected[4] = {0.5, 0.5, 0.5, -0.5};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(basis.weight[0][i] * sigma, expected[i], 1e-15);
  }
}

TEST(Parity, ThreeSensorsHaveNone) {
  EXPECT_EQ(parity_basis(tetrahedron(), SensorSet(0b0111U)).rows, 0);
  EXPECT_EQ(parity_basis(tetrahedron(), SensorSet(0b0011U)).rows, 0);
  EXPECT_EQ(parity_basis(tetrahedron(), SensorSet()).rows, 0);
}

TEST(Rank, CountsIndependentAxes) {
  const SensorArray array = tetrahedron();
  EXPECT_EQ(rank_of(array, SensorSet()), 0);
  EXPECT_EQ(rank_of(array, SensorSet(0b0100U)), 1);
  EXPECT_EQ(rank_of(array, SensorSet(0b1001U)), 2);
  EXPECT_EQ(rank_of(array, SensorSet(0b1011U)), 3);
  EXPECT_EQ(rank_of(array, SensorSet(~0U)), 3) << "members beyond the array do not count";
  EXPECT_EQ(rank_of(array, SensorSet(~0xFU)), 0);
}

TEST(LeastSquaresOf, TooFewSensorsIsNotValid) {
  EXPECT_FALSE(least_squares(tetrahedron(), SensorSet(0b0011U)).valid);
  EXPECT_FALSE(least_squares(tetrahedron(), SensorSet()).valid);
  EXPECT_FALSE(least_squares(SensorArray(), SensorSet(~0U)).valid);
}

// Negative: REQ-126
TEST(LeastSquaresOf, ASensorNotInUseCannotPoisonTheEstimate) {
  Readings y{};
  y[0] = 3.0;
  y[1] = 3.0;
  y[2] = 3.0;
  y[3] = std::numeric_limits<double>::quiet_NaN();
  const Vec3 x = least_squares(tetrahedron(), SensorSet(0b0111U)).estimate(y);
  EXPECT_NEAR(x[0], 0.0, 1e-14);
  EXPECT_NEAR(x[1], 0.0, 1e-14);
  EXPECT_NEAR(x[2], 9.0, 1e-14);
}

// Negative: REQ-004
TEST(LeastSquaresOf, WeighsByTheSigmas) {
  // Two sensors along x: the estimate is the mean weighted with 1/sigma^2.
  const Vec3 axes[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  std::vector<SensorRow> rows = rows_of(axes, 4, 1.0);
  rows[3].sigma_mps2 = 2.0;
  const LeastSquares fit = least_squares(*make(rows), SensorSet::first(4));
  EXPECT_NEAR(fit.column[0][0], 0.8, 1e-15);
  EXPECT_NEAR(fit.column[3][0], 0.2, 1e-15);
  EXPECT_NEAR(fit.covariance[0], 0.8, 1e-15);
}

TEST(LeastSquaresOf, SigmasBeyondAllReasonAreNotValidInsteadOfNotFinite) {
  const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<SensorRow> rows = rows_of(axes, 3, 1e-300);
  rows[2].sigma_mps2 = 1e300;
  EXPECT_FALSE(least_squares(*make(rows), SensorSet::first(3)).valid);
}

TEST(Merit, Mikoff5HasTwoNearSingularTriplesAndConfirmedGradeOne) {
  if constexpr (kCapacity >= 5) {
    const SensorArray array = built(mikoff5_axes().data(), 5);
    for (int k = 0; k < array.triple_count(); ++k) {
      const bool flat = k == array.triple_index(0, 2, 4) || k == array.triple_index(1, 3, 4);
      EXPECT_EQ(array.triple(k).votes, !flat) << k;
      if (flat) {
        EXPECT_GT(array.triple(k).condition, 100.0);
      }
    }
    const FiguresOfMerit m = figures_of_merit(array);
    EXPECT_EQ(m.near_singular_triples, 2);
    EXPECT_EQ(m.coplanarity, 3);
    EXPECT_EQ(m.confirmed_grade, 1);
    EXPECT_EQ(m.provisional_grade, 0);
    EXPECT_TRUE(critical_sensors(array, array.all()).empty());
  }
}

TEST(Merit, Tetrahedron) {
  const FiguresOfMerit m = figures_of_merit(tetrahedron(0.01));
  EXPECT_NEAR(m.gdop, 1.5, 1e-15);
  EXPECT_NEAR(m.condition, 1.0, 1e-15);
  EXPECT_NEAR(m.nearest_angle_rad, std::acos(1.0 / 3.0), 1e-15);
  EXPECT_NEAR(m.min_triple_det, 4.0 / (3.0 * std::sqrt(3.0)), 1e-15);
  EXPECT_NEAR(m.max_triple_condition, 2.0, 1e-14);
  EXPECT_NEAR(m.common_bias_visibility, 0.5, 1e-15);
  EXPECT_EQ(m.coplanarity, 2);
  EXPECT_EQ(m.confirmed_grade, 1);
  EXPECT_EQ(m.provisional_grade, 0);
  EXPECT_EQ(m.near_singular_triples, 0);
}

TEST(Merit, AnEmptyArrayHasNone) {
  const FiguresOfMerit m = figures_of_merit(SensorArray());
  EXPECT_EQ(m.gdop, 0.0);
  EXPECT_EQ(m.confirmed_grade, 0);
}

TEST(Merit, MinimumDeterminantsOfTheNote) {
  const auto min_det = [](int (*fill)(AxisList&, int), int n) {
    AxisList axes{};
    EXPECT_EQ(fill(axes, n), n);
    return figures_of_merit(built(axes.data(), n)).min_triple_det;
  };
  const auto plain_cone = [](AxisList& axes, int n) { return cone(axes, n); };
  EXPECT_NEAR(figures_of_merit(tetrahedron()).min_triple_det, 0.770, 5e-4);
  if constexpr (kCapacity >= 8) {
    EXPECT_NEAR(min_det(plain_cone, 5), 0.506, 5e-4);
    EXPECT_NEAR(min_det(platonic, 6), 0.470, 5e-4);
    EXPECT_NEAR(min_det(plain_cone, 7), 0.227, 5e-4);
    EXPECT_NEAR(min_det(cone_with_axis, 8), 0.219, 5e-4);
  }
}

TEST(Merit, AConeHidesACommonBiasFromParity) {
  for (int n = 4; n <= kCapacity; ++n) {
    AxisList axes{};
    ASSERT_EQ(cone(axes, n), n);
    EXPECT_NEAR(figures_of_merit(built(axes.data(), n)).common_bias_visibility, 0.0, 1e-14) << n;
  }
  // The fourth of eq (16) mounted the other way round shows all of it.
  AxisList axes{};
  paper_tetrahedron(axes);
  axes[3] = {0.0, 0.0, -1.0};
  EXPECT_NEAR(figures_of_merit(built(axes.data(), 4)).common_bias_visibility, 1.0, 1e-15);
}

// Verifies: REQ-006
TEST(Coplanarity, OfKTriadsIsTwoK) {
  if constexpr (kCapacity >= 6) {
    for (int k = 2; 3 * k <= kCapacity; ++k) {
      AxisList axes{};
      for (int i = 0; i < 3 * k; ++i) axes[at(i)][at(i % 3)] = 1.0;
      const SensorArray array = built(axes.data(), 3 * k);
      EXPECT_EQ(coplanarity(array, array.all()), 2 * k);
      EXPECT_EQ(confirmed_grade(array, array.all()), k - 1);
      EXPECT_EQ(provisional_grade(array, array.all()), k >= 2 ? k - 2 : 0);
    }
  }
}

// Negative: REQ-006
TEST(Coplanarity, CountsAnAxisWithinTheToleranceOnly) {
  const auto c_at = [](double sine) {
    const double d = std::sqrt(0.5 * (1 - sine * sine));
    const Vec3 axes[4] = {{1, 0, 0}, {0, 1, 0}, {d, d, sine}, {0, 0, 1}};
    const SensorArray array = built(axes, 4);
    return coplanarity(array, array.all());
  };
  EXPECT_EQ(c_at(0.049), 3);
  EXPECT_EQ(c_at(0.051), 2);
}

TEST(Coplanarity, IsTheSizeWhereRankIsLost) {
  EXPECT_EQ(coplanarity(tetrahedron(), SensorSet(0b0011U)), 2);
  EXPECT_EQ(coplanarity(tetrahedron(), SensorSet()), 0);
  EXPECT_EQ(confirmed_grade(tetrahedron(), SensorSet(0b0011U)), 0);
  EXPECT_EQ(confirmed_grade(tetrahedron(), SensorSet(0b0111U)), 0);
}

TEST(Critical, EverySensorOfThreeAndNoneOfTheTetrahedron) {
  const SensorArray array = tetrahedron();
  EXPECT_TRUE(critical_sensors(array, array.all()).empty());
  EXPECT_EQ(critical_sensors(array, SensorSet(0b1011U)), SensorSet(0b1011U));
}

TEST(Critical, TheOnlyAxisOutOfAPlane) {
  const double d = std::sqrt(0.5);
  const double tilt = 0.02;  // rank 3 by the numbers, yet too flat to rely on
  const Vec3 axes[4] = {{1, 0, 0}, {0, 1, 0}, {d * std::cos(tilt), d * std::cos(tilt), std::sin(tilt)}, {0, 0, 1}};
  const SensorArray array = built(axes, 4);
  EXPECT_EQ(critical_sensors(array, array.all()), SensorSet::of(3));
}

// Verifies: REQ-004
RC_GTEST_PROP(GeometryLaw, ResidualOfLeastSquaresIsOrthogonalToTheAxes, ()) {
  const SensorArray array = any_array();
  const Readings y = any_readings(115.0);  // |y| up to 200 m/s^2 for three sensors
  const LeastSquares fit = least_squares(array, array.all());
  RC_ASSERT(fit.valid);
  const Vec3 x = fit.estimate(y);
  Vec3 sum{};
  double smallest = array.sigma_mps2(0);
  for (int i = 0; i < array.size(); ++i) smallest = std::min(smallest, array.sigma_mps2(i));
  for (int i = 0; i < array.size(); ++i) {
    const double weight = smallest / array.sigma_mps2(i);
    sum = plus(sum, scaled(array.axis(i), weight * weight * (y[at(i)] - dot(array.axis(i), x))));
  }
  RC_ASSERT(norm(sum) <= 1e-10);
}

RC_GTEST_PROP(GeometryLaw, LeastSquaresReturnsAnyVectorThatWasMeasured, ()) {
  const SensorArray array = any_array();
  const Vec3 g = scaled(any_unit(), any_in(0.0, 20.0));
  Readings y{};
  for (int i = 0; i < array.size(); ++i) y[at(i)] = dot(array.axis(i), g);
  const LeastSquares fit = least_squares(array, array.all());
  RC_ASSERT(fit.valid);
  RC_ASSERT(norm(minus(fit.estimate(y), g)) <= 1e-11);
}

RC_GTEST_PROP(GeometryLaw, CovarianceIsThatOfTheColumns, ()) {
  const SensorArray array = any_array();
  const LeastSquares fit = least_squares(array, array.all());
  RC_ASSERT(fit.valid);
  const double scale = fit.covariance[0] + fit.covariance[4] + fit.covariance[8];
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (int i = 0; i < array.size(); ++i) {
        sum += fit.column[at(i)][r] * fit.column[at(i)][c] * array.sigma_mps2(i) * array.sigma_mps2(i);
      }
      RC_ASSERT(std::fabs(sum - fit.covariance[3 * r + c]) <= 1e-12 * scale);
    }
  }
}

RC_GTEST_PROP(GeometryLaw, TripleMapInvertsItsRows, ()) {
  const SensorArray array = any_array();
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    if (std::isinf(t.condition)) continue;
    const Mat3 w = triple_map(array, k);
    for (int r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 h = {array.axis(t.sensors[0])[c], array.axis(t.sensors[1])[c], array.axis(t.sensors[2])[c]};
        RC_ASSERT(std::fabs(product(w, r, h) - (at(r) == c ? 1.0 : 0.0)) <= 4e-15 * t.condition);
      }
    }
  }
}

RC_GTEST_PROP(GeometryLaw, ParityDoesNotChangeWithAnyAcceleration, ()) {
  const SensorArray array = any_array(4);
  const Vec3 x = scaled(any_unit(), any_in(0.0, 200.0));
  const ParityBasis basis = parity_basis(array, array.all());
  RC_ASSERT(basis.rows == array.size() - 3);
  for (int r = 0; r < basis.rows; ++r) {
    double sum = 0.0;
    double scale = 0.0;
    for (int i = 0; i < array.size(); ++i) {
      sum += basis.weight[at(r)][at(i)] * dot(array.axis(i), x);
      scale += std::fabs(basis.weight[at(r)][at(i)]);
    }
    RC_ASSERT(std::fabs(sum) <= 1e-14 * (scale + 100.0) * norm(x));
  }
}

RC_GTEST_PROP(GeometryLaw, ParityRowsAreOrthonormalInWhitenedUnits, ()) {
  const SensorArray array = any_array(4);
  const SensorSet used = array.all().without(array.size() > 4 ? *rc::gen::inRange(3, array.size()) : -1);
  const ParityBasis basis = parity_basis(array, used);
  RC_ASSERT(basis.rows == used.size() - 3);
  for (int r = 0; r < basis.rows; ++r) {
    for (int s = 0; s <= r; ++s) {
      double sum = 0.0;
      for (int i = 0; i < kCapacity; ++i) {
        const double sigma = i < array.size() ? array.sigma_mps2(i) : 1.0;
        sum += basis.weight[at(r)][at(i)] * basis.weight[at(s)][at(i)] * sigma * sigma;
      }
      RC_ASSERT(std::fabs(sum - (r == s ? 1.0 : 0.0)) <= 1e-14);
    }
    for (int i = 0; i < kCapacity; ++i) {
      if (!used.has(i)) RC_ASSERT(basis.weight[at(r)][at(i)] == 0.0);
    }
  }
}

// Verifies: REQ-006
RC_GTEST_PROP(GeometryLaw, FewerSensorsNeverShowAHigherGradeOrALargerPlane, ()) {
  const SensorArray array = any_array(4);
  const int lost = *rc::gen::inRange(3, array.size());  // the first three keep rank 3
  const SensorSet rest = array.all().without(lost);
  RC_ASSERT(coplanarity(array, rest) <= coplanarity(array, array.all()));
  RC_ASSERT(coplanarity(array, rest) + 1 >= coplanarity(array, array.all()));
  RC_ASSERT(confirmed_grade(array, rest) <= confirmed_grade(array, array.all()));
  RC_ASSERT(provisional_grade(array, array.all()) <= confirmed_grade(array, array.all()));
}

RC_GTEST_PROP(GeometryLaw, CriticalSensorsAreThoseWithoutWhichEveryRestIsFlat, ()) {
  const SensorArray array = any_array();
  const SensorSet critical = critical_sensors(array, array.all());
  RC_ASSERT(array.all().contains(critical));
  for (int i = 0; i < array.size(); ++i) {
    const SensorSet rest = array.all().without(i);
    // Three axes within t of one plane have |det| <= 3 t: with one triple beyond that the rest stands.
    bool stands = false;
    for (int k = 0; k < array.triple_count(); ++k) {
      if (rest.contains(array.triple(k).set()) && std::fabs(array.triple(k).det) > 3.0 * kPlaneTolerance) stands = true;
    }
    if (stands) RC_ASSERT(!critical.has(i));
    if (rank_of(array, rest) < 3) RC_ASSERT(critical.has(i));
  }
}

RC_GTEST_PROP(GeometryLaw, FiguresOfMeritDoNotDependOnTheFrame, ()) {
  std::vector<SensorRow> rows = any_rows();
  const FiguresOfMerit before = figures_of_merit(*make(rows));
  const Vec3 about = any_unit();
  const double angle = any_in(0.0, 2.0 * kPi);
  for (SensorRow& row : rows) row.axis = rotated(row.axis, about, angle);
  const FiguresOfMerit after = figures_of_merit(*make(rows));
  RC_ASSERT(std::fabs(before.gdop - after.gdop) <= 1e-12 * before.gdop);
  RC_ASSERT(std::fabs(before.condition - after.condition) <= 1e-11 * before.condition);
  RC_ASSERT(std::fabs(before.nearest_angle_rad - after.nearest_angle_rad) <= 1e-14);
  RC_ASSERT(std::fabs(before.min_triple_det - after.min_triple_det) <= 4e-15);
  RC_ASSERT(std::fabs(before.common_bias_visibility - after.common_bias_visibility) <= 1e-12);
  RC_ASSERT(before.common_bias_visibility <= 1.0 + 1e-14);
}

}  // namespace
}  // namespace array_geometry_test
}  // namespace test
}  // namespace plumb
