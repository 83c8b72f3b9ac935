/// The two forms of one calibration: inverse to each other, the same of every reading, refused where not unique.
#include "plumb/paper/paper_parameters.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/bench.hpp"
#include "plumb/array/geometry.hpp"

namespace paper_parameters_test {
namespace {

using namespace calibration_test;

constexpr double kTolerance = 1e-12;

struct Forms {
  plumb::SensorArray nominal;
  plumb::SensorArray calibrated;
  plumb::SensorModel common;
};

plumb::SensorArray array_of(const std::array<Vec3, plumb::kCapacity>& axes, int n) {
  std::array<plumb::SensorRow, plumb::kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    rows[at(i)].id = plumb::make_id(("A" + std::to_string(i + 1)).c_str());
    rows[at(i)].axis = axes[at(i)];
    rows[at(i)].sigma_mps2 = 1e-3;
  }
  const auto made = plumb::SensorArray::make(rows.data(), n);
  EXPECT_TRUE(made.has_value());
  return made ? *made : plumb::SensorArray{};
}

/// Axes of which any three span well; each tilted by up to 0.3 rad, all four orders of temperature at work.
Forms drawn_forms(int n, std::uint64_t seed) {
  Noise noise(seed);
  std::array<Vec3, plumb::kCapacity> nominal{}, calibrated{};
  for (int attempt = 0; attempt < 10000; ++attempt) {
    double least = 1.0;
    for (int i = 0; i < n; ++i) {
      nominal[at(i)] = noise.direction();
      const Vec3 turn = plumb::scaled(noise.direction(), noise.within(0.3));
      calibrated[at(i)] = turned(nominal[at(i)], turn);
      calibrated[at(i)] = plumb::scaled(calibrated[at(i)], 1.0 / plumb::norm(calibrated[at(i)]));
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) {
        for (int k = 0; k < j; ++k) {
          least = std::fmin(least, std::fabs(plumb::det3(nominal[at(i)], nominal[at(j)], nominal[at(k)])));
          least = std::fmin(least, std::fabs(plumb::det3(calibrated[at(i)], calibrated[at(j)], calibrated[at(k)])));
        }
      }
    }
    if (least > 0.3 || (n > 4 && least > 1e-4)) break;
  }
  Forms f;
  f.nominal = array_of(nominal, n);
  f.calibrated = array_of(calibrated, n);
  f.common.size = n;
  f.common.reads = noise.uniform() < 0.5 ? plumb::Reads::gravity : plumb::Reads::specific_force;
  for (int i = 0; i < n; ++i) {
    plumb::SensorCoefficients& c = f.common.sensor[at(i)];
    c.reference_degc = 25.0 + noise.within(10.0);
    for (std::size_t k = 0; k < 4; ++k) {
      const double size = std::pow(0.004, static_cast<double>(k));
      c.scale[k] = (k == 0 ? 0.3 : 0.0) + size * noise.within(0.1);
      c.bias[k] = size * noise.within(0.5);
    }
  }
  return f;
}

bool near(double a, double b, double scale) { return std::fabs(a - b) <= kTolerance * scale; }

bool same(const plumb::SensorModel& a, const plumb::SensorModel& b) {
  for (int i = 0; i < a.size; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (!near(a.sensor[at(i)].scale[k], b.sensor[at(i)].scale[k], std::fabs(a.sensor[at(i)].scale[k]))) return false;
      if (!near(a.sensor[at(i)].bias[k], b.sensor[at(i)].bias[k], std::fabs(a.sensor[at(i)].bias[k]))) return false;
    }
    for (int k = 0; k < a.size; ++k) {
      const std::size_t m = at(i * plumb::kCapacity + k);
      if (!near(a.misalignment[m], b.misalignment[m], 1.0)) return false;
    }
  }
  return a.size == b.size && a.reads == b.reads;
}

RC_GTEST_PROP(PaperParametersLaw, ThereAndBackIsTheSameCalibration, ()) {
  const int n = *rc::gen::inRange(3, 5);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const Forms f = drawn_forms(n, seed);
  const auto paper = plumb::paper_form(f.nominal, f.calibrated, f.common);
  RC_ASSERT(paper.has_value());
  const auto back = plumb::common_frame_form(f.nominal, *paper);
  RC_ASSERT(back.has_value());
  RC_ASSERT(same(back->model, f.common));
  for (int i = 0; i < n; ++i)
    RC_ASSERT(plumb::norm(plumb::minus(back->axis[at(i)], f.calibrated.axis(i))) <= kTolerance);
}

RC_GTEST_PROP(PaperParametersLaw, BackAndThereIsTheSameModelOfThePaper, ()) {
  const int n = *rc::gen::inRange(3, 5);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const Forms f = drawn_forms(n, seed);
  Noise noise(seed + 1);
  plumb::SensorModel paper = f.common;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      if (i != k) paper.misalignment[at(i * plumb::kCapacity + k)] = noise.within(0.05);
    }
  }
  const auto common = plumb::common_frame_form(f.nominal, paper);
  RC_ASSERT(common.has_value());
  const auto again = plumb::paper_form(f.nominal, array_of(common->axis, n), common->model);
  RC_ASSERT(again.has_value());
  if (n == 3) RC_ASSERT(same(*again, paper));
  // n = 4: four numbers of the paper show in no reading. The form is canonical: a second round changes nothing.
  const auto once_more = plumb::common_frame_form(f.nominal, *again);
  RC_ASSERT(once_more.has_value());
  const auto canonical = plumb::paper_form(f.nominal, array_of(once_more->axis, n), once_more->model);
  RC_ASSERT(canonical.has_value());
  RC_ASSERT(same(*canonical, *again));
}

RC_GTEST_PROP(PaperParametersLaw, BothFormsSayTheSameVectorAtEveryAttitudeAndTemperature, ()) {
  const int n = *rc::gen::inRange(3, 5);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const Forms f = drawn_forms(n, seed);
  const auto paper = plumb::paper_form(f.nominal, f.calibrated, f.common);
  RC_ASSERT(paper.has_value());
  Noise noise(seed + 2);
  const plumb::LeastSquares over_nominal = plumb::least_squares(f.nominal, f.nominal.all());
  const plumb::LeastSquares over_calibrated = plumb::least_squares(f.calibrated, f.calibrated.all());
  for (int k = 0; k < 20; ++k) {
    const Vec3 g = plumb::scaled(noise.direction(), plumb::kG0_mps2);
    const double temperature_degc = 25.0 + noise.within(100.0);
    plumb::Readings along{};
    for (int i = 0; i < n; ++i) along[at(i)] = plumb::dot(f.calibrated.axis(i), g);
    const auto raw = f.common.raw_from(along, temperature_degc);
    RC_ASSERT(raw.has_value());
    const Vec3 x = over_calibrated.estimate(f.common.apply(*raw, temperature_degc, f.nominal.all()));
    const Vec3 y = over_nominal.estimate(paper->apply(*raw, temperature_degc, f.nominal.all()));
    RC_ASSERT(plumb::norm(plumb::minus(x, g)) <= 1e-11 * plumb::kG0_mps2);
    RC_ASSERT(plumb::norm(plumb::minus(y, g)) <= 1e-11 * plumb::kG0_mps2);
  }
}

RC_GTEST_PROP(PaperParametersLaw, AnyNumberOfSensorsHasACommonFrameForm, ()) {
  const int n = *rc::gen::inRange(3, std::min(plumb::kCapacity, 8) + 1);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Forms f = drawn_forms(n, seed);
  Noise noise(seed + 3);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      if (i != k) f.common.misalignment[at(i * plumb::kCapacity + k)] = noise.within(0.03);
    }
  }
  const auto form = plumb::common_frame_form(f.nominal, f.common);
  RC_ASSERT(form.has_value());
  const Vec3 g = plumb::scaled(noise.direction(), plumb::kG0_mps2);
  plumb::Readings along{};
  for (int i = 0; i < n; ++i) along[at(i)] = plumb::dot(f.nominal.axis(i), g);
  const auto raw = f.common.raw_from(along, 40.0);
  RC_ASSERT(raw.has_value());
  const plumb::Readings y = form->model.apply(*raw, 40.0, f.nominal.all());
  for (int i = 0; i < n; ++i)
    RC_ASSERT(std::fabs(y[at(i)] - plumb::dot(form->axis[at(i)], g)) <= 1e-11 * plumb::kG0_mps2);
}

TEST(PaperParameters, OfThePaperTetrahedronAreTheMisalignmentsThatTheAxesShow) {
  const plumb::Datasheet d = paper_tool(1e-3);
  const auto nominal = d.array();
  ASSERT_TRUE(nominal.has_value());
  std::array<Vec3, plumb::kCapacity> axes{};
  for (int i = 0; i < 4; ++i) axes[at(i)] = d.sensor[at(i)].row.axis;
  const double tilt = 0.01;
  axes[3] = {std::sin(tilt), 0.0, std::cos(tilt)};  // the axial sensor leans towards a1
  const auto paper = plumb::paper_form(*nominal, array_of(axes, 4), d.model());
  ASSERT_TRUE(paper.has_value());
  for (int k = 0; k < 3; ++k) {
    // h'_4 - h_4 is (sin, 0, cos - 1): coefficients over the three cone axes, row by row of eq (3).
    const double expected =
        (k == 0 ? 2.0 : -1.0) * std::sin(tilt) / (3.0 * std::sqrt(8.0) / 3.0) + std::cos(tilt) - 1.0;
    EXPECT_NEAR(paper->misalignment[at(3 * plumb::kCapacity + k)], expected, 1e-12) << k;
  }
  EXPECT_EQ(paper->sensor[0].scale, d.sensor[0].coefficients.scale);
}

TEST(PaperParameters, OfAnUnchangedToolAreZero) {
  const plumb::Datasheet d = paper_tool(1e-3);
  const auto nominal = d.array();
  ASSERT_TRUE(nominal.has_value());
  const auto paper = plumb::paper_form(*nominal, *nominal, d.model());
  ASSERT_TRUE(paper.has_value());
  EXPECT_TRUE(same(*paper, d.model()));
}

TEST(PaperParameters, AreRefusedByNameWhereTheyDoNotExist) {
  // Three of four axes in one plane: the fourth row has nothing to be expressed in.
  std::array<Vec3, plumb::kCapacity> flat{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.6, 0.8, 0}, Vec3{0, 0, 1}};
  const plumb::SensorArray plane = array_of(flat, 4);
  plumb::SensorModel model;
  model.size = 4;
  const auto singular = plumb::paper_form(plane, plane, model);
  ASSERT_FALSE(singular.has_value());
  EXPECT_EQ(singular.error().code, plumb::Errc::axes_rank_deficient);
  EXPECT_EQ(singular.error().index, 3);
  if (plumb::kCapacity >= 5) {
    const Forms five = drawn_forms(5, 7);
    const auto many = plumb::paper_form(five.nominal, five.calibrated, five.common);
    ASSERT_FALSE(many.has_value());
    EXPECT_EQ(many.error().code, plumb::Errc::not_unique);
    EXPECT_EQ(many.error().value, 5.0);
  }
  // A sensor that lies across its nominal direction has no scale factor in the paper's form.
  const plumb::SensorArray unit = array_of({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, 3);
  const plumb::SensorArray swapped = array_of({Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}}, 3);
  model.size = 3;
  const auto across = plumb::paper_form(unit, swapped, model);
  ASSERT_FALSE(across.has_value());
  EXPECT_EQ(across.error().code, plumb::Errc::not_invertible);
  EXPECT_EQ(across.error().index, 0);
  model.misalignment[1] = 0.1;
  const auto crossed = plumb::paper_form(unit, unit, model);
  ASSERT_FALSE(crossed.has_value());
  EXPECT_EQ(crossed.error(), (plumb::Error{plumb::Errc::out_of_range, 1}));
  model.size = 4;
  const auto sizes = plumb::paper_form(unit, unit, model);
  ASSERT_FALSE(sizes.has_value());
  EXPECT_EQ(sizes.error(), (plumb::Error{plumb::Errc::out_of_range, 0}));
}

TEST(PaperParameters, SingularMisalignmentsHaveNoCommonFrameForm) {
  const plumb::SensorArray unit = array_of({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, 3);
  plumb::SensorModel model;
  model.size = 3;
  model.misalignment[1] = 1.0;
  model.misalignment[plumb::kCapacity] = 1.0;  // I - M has two equal rows but for the sign
  const auto form = plumb::common_frame_form(unit, model);
  ASSERT_FALSE(form.has_value());
  EXPECT_EQ(form.error().code, plumb::Errc::not_invertible);
  model.misalignment = {};
  model.misalignment[0] = 0.5;
  const auto diagonal = plumb::common_frame_form(unit, model);
  ASSERT_FALSE(diagonal.has_value());
  EXPECT_EQ(diagonal.error(), (plumb::Error{plumb::Errc::out_of_range, 1}));
  model.misalignment[0] = 0.0;
  model.size = 2;
  EXPECT_FALSE(plumb::common_frame_form(unit, model).has_value());
}

TEST(PaperParameters, OfArraysThatDoNotMatchAreRefused) {
  AxisList axes{};
  const auto array_of = [](const AxisList& a, int n) {
    const Datasheet d = datasheet_of(a, n, kBenchSigma);
    const auto made = d.array();
    EXPECT_TRUE(made.has_value());
    return *made;
  };
  const SensorArray three = array_of(axes, orthogonal_triad(axes));
  const SensorArray four = array_of(axes, paper_tetrahedron(axes));
  SensorModel model;
  model.size = 4;
  EXPECT_EQ(paper_form(four, three, model).error().code, Errc::out_of_range);
  AxisList flat{};
  flat[0] = {1.0, 0.0, 0.0};
  flat[1] = {0.0, 1.0, 0.0};
  flat[2] = {std::sqrt(0.5 - 1e-7), std::sqrt(0.5), std::sqrt(1e-7)};
  const SensorArray nearly = array_of(flat, 3);
  model.size = 3;
  EXPECT_EQ(paper_form(three, nearly, model).error().code, Errc::axes_rank_deficient);
}

/// Misalignments so large, or so nearly one another's inverse, that the rows of the common frame have no length.
TEST(PaperParameters, MisalignmentsThatLeaveNoLengthHaveNoCommonFrame) {
  AxisList axes{};
  const Datasheet sheet = datasheet_of(axes, orthogonal_triad(axes), kBenchSigma);
  const Expected<SensorArray> array = sheet.array();
  ASSERT_TRUE(array.has_value());
  SensorModel model = sheet.model();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) model.misalignment[at(i * kCapacity + j)] = i == j ? 0.0 : 1e4;
  }
  const auto small = common_frame_form(*array, model);
  ASSERT_FALSE(small.has_value());
  EXPECT_EQ(small.error().code, Errc::not_invertible);
  EXPECT_LT(small.error().value, small.error().limit);

  model.misalignment = {};
  model.misalignment[at(1)] = 1e160;
  const auto endless = common_frame_form(*array, model);
  ASSERT_FALSE(endless.has_value());
  EXPECT_EQ(endless.error().code, Errc::not_invertible);
}

}  // namespace
}  // namespace paper_parameters_test
