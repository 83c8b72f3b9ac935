// The kernel in single precision against the bounds that are proved for it; long double plays the exact value.
#include "plumb/detection/detail/near_lengths.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "detection/rounding_bounds.hpp"
#include "plumb/array/named.hpp"
#include "plumb/detection/combination_mae.hpp"

namespace near_lengths_test {
namespace {

using namespace plumb;

/// Even numbers from a seed: a generator of the library would start with the least of each, and three equal axes.
class Even {
 public:
  explicit Even(std::uint32_t seed) : random_(seed) {}
  double in(double low, double high) {
    random_ = random_ * 1664525U + 1013904223U;
    return low + (high - low) * ((random_ >> 8U) / 16777216.0);
  }

 private:
  std::uint32_t random_;
};

struct Near {
  std::array<double, 3> reading{}, difference{};
  TripleForm form{};
};

/// Three axes that vote, readings of a length from 8 to 12 m/s^2, differences up to `most`.
Near any_near(double most_mps2, Even& even) {
  for (;;) {
    std::array<Vec3, 3> axis{};
    for (Vec3& h : axis) {
      h = {even.in(-1.0, 1.0), even.in(-1.0, 1.0), even.in(-1.0, 1.0)};
      if (norm(h) > 0.1) h = scaled(h, 1.0 / norm(h));
    }
    std::array<SensorRow, 3> rows{};
    for (std::size_t i = 0; i < 3; ++i) {
      const char id[] = {'a', static_cast<char>('1' + i), '\0'};
      rows[i] = {make_id(id), axis[i], 1e-3};
    }
    const Expected<SensorArray> array = SensorArray::make(rows.data(), 3);
    if (!array || !array->triple(0).votes) continue;
    Near out;
    out.form = array->form(0);
    const Vec3 towards = {even.in(-1.0, 1.0), even.in(-1.0, 1.0), even.in(0.1, 1.0)};
    const Vec3 x = scaled(towards, even.in(8.0, 12.0) / norm(towards));
    for (std::size_t i = 0; i < 3; ++i) {
      out.reading[i] = dot(axis[i], x);
      out.difference[i] = even.in(-most_mps2, most_mps2);
    }
    return out;
  }
}

constexpr long double wide(double value) { return static_cast<long double>(value); }

long double square_of(const TripleForm& q, const std::array<long double, 3>& y) {
  return wide(q[0]) * y[0] * y[0] + wide(q[1]) * y[1] * y[1] + wide(q[2]) * y[2] * y[2] + wide(q[3]) * y[0] * y[1] +
         wide(q[4]) * y[0] * y[2] + wide(q[5]) * y[1] * y[2];
}

/// What the kernel makes of it, and what it should.
struct Made {
  float change = 0.0F;
  long double square = 0.0L, exact_change = 0.0L;
};
Made made_of(const Near& n) {
  const TripleForm& q = n.form;
  const auto& y = n.reading;
  const std::array<float, 3> slope = {static_cast<float>(2.0 * q[0] * y[0] + q[3] * y[1] + q[4] * y[2]),
                                      static_cast<float>(2.0 * q[1] * y[1] + q[3] * y[0] + q[5] * y[2]),
                                      static_cast<float>(2.0 * q[2] * y[2] + q[4] * y[0] + q[5] * y[1])};
  std::array<float, 6> single{};
  std::array<float, 3> d{};
  for (std::size_t k = 0; k < 6; ++k) single[k] = static_cast<float>(q[k]);
  for (std::size_t k = 0; k < 3; ++k) d[k] = static_cast<float>(n.difference[k]);
  Made out;
  out.change = near_change(slope, single, d[0], d[1], d[2]);
  std::array<long double, 3> at{}, moved{};
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = wide(y[k]);
    moved[k] = at[k] + wide(n.difference[k]);
  }
  out.square = square_of(q, at);
  out.exact_change = square_of(q, moved) - out.square;
  return out;
}

RC_GTEST_PROP(NearLengthsLaw, TheChangeOfASquareIsWithinTheProvedBound, ()) {
  Even even(*rc::gen::arbitrary<std::uint32_t>());
  const Made made = made_of(any_near(0.125, even));
  RC_ASSERT(std::fabs(static_cast<long double>(made.change) - made.exact_change) <=
            wide(plumb_test::kNearFormError_m2ps4));
}

RC_GTEST_PROP(NearLengthsLaw, TheIntegerIsWithinTheProvedBound, ()) {
  Even even(*rc::gen::arbitrary<std::uint32_t>());
  const Made made = made_of(any_near(0.125, even));
  RC_PRE(std::fabs(made.exact_change) <= 8.0L);
  const double g_mps2 = even.in(9.0, 10.0);
  NearLength length;
  length.take(static_cast<double>(made.square), g_mps2);
  const std::int32_t units = length.units(made.change);
  const long double exact = std::fabs(std::sqrt(made.square + made.exact_change) - wide(g_mps2));
  RC_ASSERT(units >= 0);
  RC_ASSERT(std::fabs(static_cast<long double>(units) - exact * wide(kMaeUnits_per_mps2)) <=
            wide(plumb_test::kNearSampleError_units) + 0.01L);
}

/// The noise of an instrument, in the paper's array: what is left is the rounding to a unit, as in double.
TEST(NearLengths, AreWithinAUnitForThePapersAxes) {
  AxisList axes{};
  paper_tetrahedron(axes);
  std::array<SensorRow, 4> rows{};
  for (std::size_t i = 0; i < 4; ++i) {
    const char id[] = {'a', static_cast<char>('1' + i), '\0'};
    rows[i] = {make_id(id), axes[i], 1e-3};
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), 4);
  ASSERT_TRUE(array.has_value());
  long double worst = 0.0L;
  Even even(1);
  for (int k = 0; k < 100000; ++k) {
    const Triple& t = array->triple(k % 4);
    const Vec3 towards = {even.in(-1.0, 1.0), even.in(-1.0, 1.0), even.in(-1.0, 1.0)};
    if (norm(towards) < 0.1) continue;
    Near n;
    n.form = array->form(k % 4);
    for (std::size_t i = 0; i < 3; ++i) {
      n.reading[i] = dot(array->axis(t.sensors[i]), scaled(towards, kG0_mps2 / norm(towards)));
      n.difference[i] = 0.02 * even.in(-1.0, 1.0);
    }
    const Made made = made_of(n);
    NearLength length;
    length.take(static_cast<double>(made.square), kG0_mps2);
    const long double exact = std::fabs(std::sqrt(made.square + made.exact_change) - wide(kG0_mps2));
    worst = std::max(worst,
                     std::fabs(static_cast<long double>(length.units(made.change)) - exact * wide(kMaeUnits_per_mps2)));
  }
  std::printf("figure: at most %.3Lf units from the exact error\n", worst);
  EXPECT_LT(worst, 1.0L);
}

TEST(NearLengths, WhatIsFarOrNotANumberIsLeftToDouble) {
  NearLength length;
  EXPECT_EQ(length.units(0.0F), -1) << "nothing taken yet";
  length.take(96.0, 9.8);
  EXPECT_GE(length.units(0.0F), 0);
  EXPECT_GE(length.units(-72.0F), 0);
  EXPECT_GE(length.units(72.0F), 0);
  for (const float far :
       {72.1F, -72.1F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_EQ(length.units(far), -1) << far;
  }
  for (const double square : {0.0, -1.0, 15.9, 10001.0, std::numeric_limits<double>::quiet_NaN()}) {
    length.take(square, 9.8);
    EXPECT_EQ(length.units(0.0F), -1) << square;
  }
  Differences d{};
  d[1] = 1.001F;
  d[2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(NearLengths::near(d, SensorSet::first(4)), SensorSet::of(0) | SensorSet::of(3));
}

}  // namespace
}  // namespace near_lengths_test
