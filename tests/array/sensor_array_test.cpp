#include "plumb/array/sensor_array.hpp"

#include <limits>
#include <type_traits>

#include "array_test_support.hpp"

namespace plumb {
namespace test {
namespace sensor_array_test {
namespace {

static_assert(std::is_trivially_copyable<SensorArray>::value, "a monitor holds one and must stay trivially copyable");

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<SensorRow> tetrahedron_rows() {
  AxisList axes{};
  const int n = paper_tetrahedron(axes);
  return rows_of(axes.data(), n, 0.01);
}

TEST(MakeId, KeepsFifteenCharactersAndPadsWithZeros) {
  EXPECT_STREQ(make_id("ax").data(), "ax");
  EXPECT_STREQ(make_id("0123456789abcdefgh").data(), "0123456789abcde");
  EXPECT_EQ(make_id("ax"), make_id("ax"));
  EXPECT_EQ(make_id(nullptr), SensorId{});
  EXPECT_EQ(make_id(""), SensorId{});
}

TEST(SensorArray, EmptyArrayIsAPlaceholder) {
  const SensorArray array;
  EXPECT_EQ(array.size(), 0);
  EXPECT_EQ(array.triple_count(), 0);
  EXPECT_TRUE(array.all().empty());
}

// Verifies: REQ-001
TEST(SensorArray, KeepsRowsAndEnumeratesTriplesOfEq13) {
  const Expected<SensorArray> array = make(tetrahedron_rows());
  ASSERT_TRUE(array.has_value());
  EXPECT_EQ(array->size(), 4);
  EXPECT_EQ(array->all(), SensorSet::first(4));
  EXPECT_EQ(array->triple_count(), 4);
  EXPECT_STREQ(array->row(2).id.data(), "a2");
  EXPECT_EQ(array->sigma_mps2(3), 0.01);
  EXPECT_EQ(array->axis(3), (Vec3{0.0, 0.0, 1.0}));
  const std::array<std::array<std::uint8_t, 3>, 4> order = {{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};
  for (int k = 0; k < 4; ++k) EXPECT_EQ(array->triple(k).sensors, order[at(k)]);
  EXPECT_EQ(array->triple(2).set(), SensorSet(0b1101U));
}

TEST(SensorArray, CountsOfEq13) {
  EXPECT_EQ(triple_count_of(3), 1);
  EXPECT_EQ(triple_count_of(4), 4);
  EXPECT_EQ(triple_count_of(5), 10);
  EXPECT_EQ(triple_count_of(8), 56);
  EXPECT_EQ(triple_count_of(16), 560);
  EXPECT_EQ(triple_count_of(24), 2024);
}

TEST(SensorArray, TetrahedronTriplesAreMonitoredAndHaveTheDeterminantOfTheNote) {
  const SensorArray array = tetrahedron();
  for (int k = 0; k < 4; ++k) {
    EXPECT_TRUE(array.triple(k).votes);
    EXPECT_NEAR(std::fabs(array.triple(k).det), 4.0 / (3.0 * std::sqrt(3.0)), 1e-15);
  }
}

TEST(SensorArray, OrthogonalTriadHasConditionOneAndTheUnitForm) {
  AxisList axes{};
  ASSERT_EQ(orthogonal_triad(axes), 3);
  const SensorArray array = built(axes.data(), 3);
  EXPECT_EQ(array.triple(0).det, 1.0);
  EXPECT_EQ(array.triple(0).condition, 1.0);
  EXPECT_EQ(array.form(0), (std::array<double, 6>{1.0, 1.0, 1.0, 0.0, 0.0, 0.0}));
}

TEST(SensorArray, ConditionOfASkewedTripleIsTheRatioOfItsSingularValues) {
  // Two axes 2a apart in a plane, the third normal to it: singular values sqrt2 cos a, 1, sqrt2 sin a.
  const double a = 0.1;
  const Vec3 axes[3] = {{std::cos(a), std::sin(a), 0.0}, {std::cos(a), -std::sin(a), 0.0}, {0.0, 0.0, 1.0}};
  const SensorArray array = built(axes, 3);
  EXPECT_NEAR(array.triple(0).condition, 1.0 / std::tan(a), 1e-13);
  EXPECT_TRUE(array.triple(0).votes);
}

TEST(SensorArray, ACoplanarTripleAmongOthersIsSingularAndNotMonitored) {
  const double d = std::sqrt(0.5);
  const Vec3 axes[4] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {d, d, 0.0}, {0.0, 0.0, 1.0}};
  const SensorArray array = built(axes, 4);
  const Triple& flat = array.triple(array.triple_index(0, 1, 2));
  EXPECT_FALSE(flat.votes);
  EXPECT_EQ(flat.condition, kInfinity);
  EXPECT_EQ(array.form(array.triple_index(0, 1, 2)), (std::array<double, 6>{}));
  EXPECT_TRUE(array.triple(array.triple_index(0, 1, 3)).votes);
}

// Verifies: REQ-005
TEST(SensorArray, NearSingularTripleHasAFormButIsNotMonitored) {
  const double d = 0.04;
  const Vec3 axes[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, std::sqrt(1.0 - d * d), d}};
  const SensorArray array = built(axes, 3);
  EXPECT_FALSE(array.triple(0).votes);
  EXPECT_GT(array.form(0)[2], 1.0);
  EXPECT_LT(array.triple(0).condition, 100.0);
}

// Verifies: REQ-001
TEST(SensorArray, ParallelAxesAreAllowed) {
  if constexpr (kCapacity >= 8) {
    const Vec3 axes[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_TRUE(make(rows_of(axes, 6)).has_value());
  }
  const Vec3 four[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}};
  EXPECT_TRUE(make(rows_of(four, 4)).has_value());
}

void expect_refused(const std::vector<SensorRow>& rows, Errc code, int index) {
  const Expected<SensorArray> array = make(rows);
  ASSERT_FALSE(array.has_value());
  EXPECT_EQ(array.error().code, code) << describe(array.error().code);
  EXPECT_EQ(array.error().index, index);
}

// Negative: REQ-001
TEST(SensorArrayRefuses, TooFewAndTooMany) {
  std::vector<SensorRow> rows = tetrahedron_rows();
  rows.resize(2);
  expect_refused(rows, Errc::too_few_sensors, -1);
  expect_refused({}, Errc::too_few_sensors, -1);
  EXPECT_EQ(SensorArray::make(nullptr, 4).error().code, Errc::too_few_sensors);
  EXPECT_EQ(SensorArray::make(rows.data(), -1).error().code, Errc::too_few_sensors);
  const std::vector<SensorRow> many(at(kCapacity + 1), tetrahedron_rows()[0]);
  expect_refused(many, Errc::too_many_sensors, -1);
  EXPECT_EQ(make(many).error().value, kCapacity + 1);
  EXPECT_EQ(make(many).error().limit, kCapacity);
}

// Negative: REQ-001
TEST(SensorArrayRefuses, AnAxisOffUnitLengthByMoreThanTheTolerance) {
  for (const double excess : {2e-6, -2e-6, 1.0, -1.0}) {
    std::vector<SensorRow> rows = tetrahedron_rows();
    rows[1].axis = scaled(rows[1].axis, 1.0 + excess);
    expect_refused(rows, Errc::axis_not_unit, 1);
    EXPECT_NEAR(make(rows).error().value, 1.0 + excess, 1e-12);
  }
  for (const double excess : {0.9e-6, -0.9e-6}) {
    std::vector<SensorRow> rows = tetrahedron_rows();
    rows[1].axis = scaled(rows[1].axis, 1.0 + excess);
    ASSERT_TRUE(make(rows).has_value());
    EXPECT_EQ(make(rows)->axis(1), rows[1].axis) << "accepted as given, never silently normalised";
  }
}

// Negative: REQ-001
TEST(SensorArrayRefuses, CoplanarAxes) {
  const double d = std::sqrt(0.5);
  const Vec3 axes[4] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {d, d, 0.0}, {-d, d, 0.0}};
  expect_refused(rows_of(axes, 4), Errc::axes_rank_deficient, -1);
  EXPECT_LT(make(rows_of(axes, 4)).error().value, 1e-6);
  const Vec3 barely[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 1.0, 1e-7}};
  expect_refused(rows_of(barely, 3), Errc::axes_rank_deficient, -1);
}

// Negative: REQ-001
TEST(SensorArrayRefuses, DuplicateAndEmptyIds) {
  std::vector<SensorRow> rows = tetrahedron_rows();
  rows[3].id = rows[1].id;
  expect_refused(rows, Errc::duplicate_id, 3);
  rows[3].id = make_id("");
  expect_refused(rows, Errc::empty_id, 3);
  // Bytes behind the terminator do not tell two ids apart.
  rows[3].id = rows[1].id;
  rows[3].id[10] = 'x';
  expect_refused(rows, Errc::duplicate_id, 3);
}

// Negative: REQ-001
TEST(SensorArrayRefuses, NumbersThatAreNone) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<SensorRow> rows = tetrahedron_rows();
      rows[2].axis[k] = bad;
      expect_refused(rows, Errc::not_finite, 2);
    }
    std::vector<SensorRow> rows = tetrahedron_rows();
    rows[2].sigma_mps2 = bad;
    expect_refused(rows, Errc::not_finite, 2);
  }
}

// Negative: REQ-001
TEST(SensorArrayRefuses, ASigmaThatIsNotPositive) {
  for (const double bad : {0.0, -0.0, -1.0, std::numeric_limits<double>::denorm_min()}) {
    std::vector<SensorRow> rows = tetrahedron_rows();
    rows[0].sigma_mps2 = bad;
    expect_refused(rows, Errc::sigma_not_positive, 0);
  }
}

TEST(SensorArray, TripleIndexRefusesWhatIsNoTriple) {
  const SensorArray array = tetrahedron();
  EXPECT_EQ(array.triple_index(-1, 1, 2), -1);
  EXPECT_EQ(array.triple_index(1, 1, 2), -1);
  EXPECT_EQ(array.triple_index(0, 2, 2), -1);
  EXPECT_EQ(array.triple_index(0, 1, 4), -1);
}

TEST(RowUncertainty, IsTheQuadraticFormOfThePackedBlocks) {
  RowUncertainty u;
  // Axis error x of sensor 0 with variance 4, offset of sensor 1 with variance 9, their covariance 2.
  u.covariance[0] = 4.0;
  const int offset1 = 7;
  u.covariance[at(offset1 * (offset1 + 1) / 2 + offset1)] = 9.0;
  u.covariance[at(offset1 * (offset1 + 1) / 2 + 0)] = 2.0;
  u.misfit_mps2[0] = 0.5;
  const Vec3 g = {3.0, 5.0, 7.0};
  EXPECT_DOUBLE_EQ(u.at(0, 0, g), 9.0 * 4.0 + 0.25);
  EXPECT_DOUBLE_EQ(u.at(1, 1, g), 9.0);
  EXPECT_DOUBLE_EQ(u.at(0, 1, g), 3.0 * 2.0);
  EXPECT_DOUBLE_EQ(u.at(1, 0, g), 3.0 * 2.0);
  SensorArray array = tetrahedron();
  array.set_uncertainty(u);
  EXPECT_DOUBLE_EQ(array.uncertainty().at(1, 1, g), 9.0);
}

RC_GTEST_PROP(SensorArrayLaw, TripleIndexIsTheInverseOfTheEnumeration, ()) {
  const SensorArray array = any_array();
  for (int k = 0; k < array.triple_count(); ++k) {
    const auto& s = array.triple(k).sensors;
    RC_ASSERT(s[0] < s[1] && s[1] < s[2] && s[2] < array.size());
    RC_ASSERT(array.triple_index(s[0], s[1], s[2]) == k);
    RC_ASSERT(array.triple(k).set().size() == 3);
  }
}

RC_GTEST_PROP(SensorArrayLaw, TheFormIsTheSquaredLengthOfTheMappedReadings, ()) {
  const SensorArray array = any_array();
  const Readings y = any_readings(200.0);
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    if (std::isinf(t.condition)) continue;
    const Vec3 v = {y[t.sensors[0]], y[t.sensors[1]], y[t.sensors[2]]};
    const TripleForm form = array.form(k);
    const double by_form = form[0] * v[0] * v[0] + form[1] * v[1] * v[1] + form[2] * v[2] * v[2] +
                           form[3] * v[0] * v[1] + form[4] * v[0] * v[2] + form[5] * v[1] * v[2];
    const Vec3 x = times(triple_map(array, k), v);
    const double scale = (form[0] + form[1] + form[2]) * dot(v, v);
    RC_ASSERT(std::fabs(by_form - dot(x, x)) <= 4e-15 * scale);
  }
}

RC_GTEST_PROP(SensorArrayLaw, RotationOfTheFrameChangesNoTriple, ()) {
  const std::vector<SensorRow> rows = any_rows();
  const Vec3 about = any_unit();
  const double angle = any_in(0.0, 2.0 * kPi);
  std::vector<SensorRow> turned = rows;
  for (SensorRow& row : turned) row.axis = rotated(row.axis, about, angle);
  const Expected<SensorArray> a = make(rows);
  const Expected<SensorArray> b = make(turned);
  RC_ASSERT(a.has_value() && b.has_value());
  for (int k = 0; k < a->triple_count(); ++k) {
    const double condition = a->triple(k).condition;
    RC_ASSERT(std::fabs(a->triple(k).det - b->triple(k).det) <= 4e-15);
    if (condition < 1e3) RC_ASSERT(std::fabs(condition - b->triple(k).condition) <= 1e-14 * condition * condition);
  }
}

RC_GTEST_PROP(SensorArrayLaw, DeterminantAndConditionBoundEachOther, ()) {
  // |det| = s1 s2 s3 with 1 <= s1 <= sqrt3 (unit rows), so 1/condition^2 <= |det| / s1^3 <= 1/condition.
  const SensorArray array = any_array();
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    RC_ASSERT(t.condition >= 1.0);
    RC_ASSERT(t.votes == (std::fabs(t.det) >= kMinTripleDet));
    if (std::isinf(t.condition)) continue;
    const double cube = 3.0 * std::sqrt(3.0);
    RC_ASSERT(std::fabs(t.det) <= cube / t.condition * (1.0 + 1e-9));
    RC_ASSERT(std::fabs(t.det) >= 1.0 / (t.condition * t.condition) * (1.0 - 1e-6));
  }
}

TEST(SensorArrayRefuses, RowsThatAreNoneAndStaysAsItWas) {
  SensorArray array = *make(tetrahedron_rows());
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
}  // namespace sensor_array_test
}  // namespace test
}  // namespace plumb
