// The compiled kernel against the bounds that are proved for it. long double (64 bits) plays the exact value: its own
// error is below 0.01 units of 2^-53, which is added to the bound.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "array/array_test_support.hpp"
#include "detection/rounding_bounds.hpp"
#include "plumb/detection/combination_mae.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-051

namespace rounding_test {
namespace {

using namespace plumb;
using Form = std::array<double, 6>;
static_assert(std::numeric_limits<long double>::digits >= 64, "these tests need a wider type than double");

constexpr long double kU = 0x1p-53L;
constexpr long double kReferenceError_u = 0.01L;

struct Exact {
  long double value = 0.0L;
  long double size = 0.0L;
};

constexpr long double wide(double value) { return static_cast<long double>(value); }

Exact exact_form(const Form& q, double a, double b, double c) {
  const std::array<std::array<double, 3>, 6> factors = {
      {{q[0], a, a}, {q[1], b, b}, {q[2], c, c}, {q[3], a, b}, {q[4], a, c}, {q[5], b, c}}};
  Exact out;
  for (const auto& f : factors) {
    const long double term = wide(f[0]) * wide(f[1]) * wide(f[2]);
    out.value += term;
    out.size += std::fabs(term);
  }
  return out;
}

/// Every operation rounded to memory: no compiler may contract or reorder it.
double step_by_step(const Form& q, double a, double b, double c) {
  const std::array<std::array<double, 3>, 6> factors = {
      {{q[0], a, a}, {q[1], b, b}, {q[2], c, c}, {q[3], a, b}, {q[4], a, c}, {q[5], b, c}}};
  volatile double sum = 0.0;
  bool first = true;
  for (const auto& f : factors) {
    volatile double term = f[0] * f[1];
    term = term * f[2];
    sum = first ? term : sum + term;
    first = false;
  }
  return sum;
}

/// Any size from 2^-40 to 2^9, either sign, and the awkward values.
double any_number() {
  const int kind = *rc::gen::inRange(0, 10);
  if (kind == 0) return *rc::gen::elementOf(std::vector<double>{0.0, -0.0, 1.0, -1.0, 0x1p-1074, 0x1p-540, 0x1p-1022});
  const int exponent = *rc::gen::inRange(-40, 10);
  return std::ldexp(test::any_in(-1.0, 1.0), exponent);
}

Form any_form() {
  Form q{};
  for (double& v : q) v = any_number();
  return q;
}

RC_GTEST_PROP(RoundingLaw, KernelIsTheScalarExpressionLeftToRight, ()) {
  const Form q = any_form();
  const double a = any_number();
  const double b = any_number();
  const double c = any_number();
  const double computed = squared_length(q, a, b, c);
  const double expected = step_by_step(q, a, b, c);
  RC_ASSERT(computed == expected);
}

RC_GTEST_PROP(RoundingLaw, FormIsWithinItsProvedBound, ()) {
  const Form q = any_form();
  const double a = any_number();
  const double b = any_number();
  const double c = any_number();
  const Exact exact = exact_form(q, a, b, c);
  const long double bound =
      (wide(plumb_test::kFormError_u) + kReferenceError_u) * kU * exact.size + 7000.0L * 0x1p-1075L;
  const long double error = std::fabs(wide(squared_length(q, a, b, c)) - exact.value);
  RC_ASSERT(error <= bound);
}

TEST(Rounding, TheProvedBoundOfTheFormIsNotIdle) {
  plumb_test::Noise noise(11);
  long double worst_u = 0.0L;
  for (int trial = 0; trial < 20000; ++trial) {
    Form q{};
    for (double& v : q) v = noise.normal();
    const double a = noise.normal();
    const double b = noise.normal();
    const double c = noise.normal();
    const Exact exact = exact_form(q, a, b, c);
    worst_u = std::max(worst_u, std::fabs(wide(squared_length(q, a, b, c)) - exact.value) / (kU * exact.size));
  }
  EXPECT_GT(worst_u, 1.5L);  // random numbers come within a factor of five of the worst case
  EXPECT_LT(worst_u, wide(plumb_test::kFormError_u));
}

void expect_unit_conversion(double error) {
  const long double units = std::fabs(wide(error)) / wide(kMaeUnit_mps2);
  if (units > static_cast<long double>(kMaeClamp - 1)) {
    EXPECT_GE(to_mae_units(error), kMaeClamp - 1) << error;
    return;
  }
  EXPECT_LE(std::fabs(static_cast<long double>(to_mae_units(error)) - units), wide(plumb_test::kUnitsError_units))
      << error;
  EXPECT_EQ(to_mae_units(error), to_mae_units(-error));
}

TEST(Rounding, ConversionToFixedPointIsWithinItsProvedBound) {
  for (const double units : {0.0, 0.5, 1.0, 1.5, 2.5, 12345678.5, 2139999998.5, 2139999999.5, 2140000000.0, 3e9}) {
    const double error = units * kMaeUnit_mps2;
    expect_unit_conversion(error);
    expect_unit_conversion(std::nextafter(error, 0.0));
    expect_unit_conversion(std::nextafter(error, 1e9));
  }
  expect_unit_conversion(std::numeric_limits<double>::denorm_min());
  plumb_test::Noise noise(12);
  for (int trial = 0; trial < 20000; ++trial) expect_unit_conversion(noise.normal() * std::ldexp(1.0, trial % 40 - 32));
}

RC_GTEST_PROP(RoundingLaw, SampleInTheWindowIsWithinItsProvedBound, ()) {
  const SensorArray array = test::any_array();
  const Readings y = test::any_readings(*rc::gen::element(10.0, 40.0, 160.0));
  const double g_mps2 = test::any_in(9.0, 10.0);
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array.triple_count(), 1);
  mae->add(array, y, array.all(), nullptr, g_mps2);
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& triple = array.triple(k);
    if (!triple.votes) continue;
    const auto& s = triple.sensors;
    const Exact square = exact_form(array.form(k), y[s[0]], y[s[1]], y[s[2]]);
    const double computed = squared_length(array.form(k), y[s[0]], y[s[1]], y[s[2]]);
    const long double form_error = std::fabs(wide(computed) - square.value);
    RC_ASSERT(form_error <= wide(plumb_test::kFormErrorInRange_m2ps4) + kReferenceError_u * kU * square.size);
    if (!(square.value >= 16.0L && square.value <= 90000.0L)) continue;
    const long double units = std::fabs(std::sqrt(square.value) - wide(g_mps2)) / wide(kMaeUnit_mps2);
    const long double sample_error = std::fabs(static_cast<long double>(mae->triple_sum(k)) - units);
    RC_ASSERT(sample_error <= wide(plumb_test::kSampleError_units) + kReferenceError_u);
  }
}

/// What the window must hold for one triple, one number at a time.
std::int32_t scalar_units(const Form& q, double a, double b, double c, double g_mps2) {
  const double square = step_by_step(q, a, b, c);
  const double error = std::fabs(std::sqrt(square < 0.0 ? 0.0 : square) - g_mps2);  // a NaN stays one
  const double units = error * kMaeUnits_per_mps2;
  return units < kMaeClamp ? static_cast<std::int32_t>(std::nearbyint(units)) : kMaeClamp;
}

/// Every triple of one sample against the scalar. `mae` holds a window of one.
void expect_scalar_bits(const CombinationMae& mae, const SensorArray& array, const Readings& y, SensorSet usable,
                        double g_mps2) {
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& triple = array.triple(k);
    const auto& s = triple.sensors;
    const bool present = usable.contains(triple.set());
    RC_ASSERT(mae.triple_samples(k) == (present ? 1 : 0));
    const std::int32_t expected = scalar_units(array.form(k), y[s[0]], y[s[1]], y[s[2]], g_mps2);
    RC_ASSERT(mae.triple_sum(k) == (present ? expected : 0));
  }
}

/// Readings whose squares are next to the smallest positive number: rounding may make their form negative.
constexpr double kSquaresVanish_mps2 = 0x1p-538;

Readings any_awkward_readings() {
  const double inf = std::numeric_limits<double>::infinity();
  Readings y = test::any_readings(*rc::gen::element(10.0, 160.0, 1e6, kSquaresVanish_mps2));
  for (double& v : y) {
    if (*rc::gen::inRange(0, 4) != 0) continue;
    v = *rc::gen::element(0.0, -0.0, 1e300, -1e300, inf, -inf, std::numeric_limits<double>::quiet_NaN(), 0x1p-1074);
  }
  return y;
}

// Triples are taken several at a time, from arrays whose number of triples is no multiple of that (3 to 8 sensors: 1,
// 4, 10, 20, 35, 56): each lane must hold what the scalar gives, whatever stands beside it. First sample: empty slots;
// second: the slots are full, and all may be usable or not.
RC_GTEST_PROP(RoundingLaw, EveryLaneHoldsTheBitsOfTheScalar, ()) {
  const SensorArray array = test::any_array();
  const double g_mps2 = test::any_in(9.0, 10.0);
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array.triple_count(), 1);
  const Readings first = any_awkward_readings();
  mae->add(array, first, array.all(), nullptr, g_mps2);
  expect_scalar_bits(*mae, array, first, array.all(), g_mps2);
  SensorSet usable = array.all();
  if (*rc::gen::arbitrary<bool>()) usable = usable.without(*rc::gen::inRange(0, array.size()));
  const Readings second = any_awkward_readings();
  mae->add(array, second, usable, nullptr, g_mps2);
  expect_scalar_bits(*mae, array, second, usable, g_mps2);
}

TEST(Rounding, ASquareThatRoundingTurnedNegativeIsALengthOfZero) {
  const SensorArray array = test::tetrahedron();
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array.triple_count(), 1);
  plumb_test::Noise noise(13);
  int negative = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Readings y{};
    for (double& v : y) v = noise.normal() * kSquaresVanish_mps2;
    mae->add(array, y, array.all(), nullptr, kG0_mps2);
    for (int k = 0; k < array.triple_count(); ++k) {
      const auto& s = array.triple(k).sensors;
      negative += squared_length(array.form(k), y[s[0]], y[s[1]], y[s[2]]) < 0.0 ? 1 : 0;
      EXPECT_EQ(mae->triple_sum(k), to_mae_units(kG0_mps2));
    }
  }
  EXPECT_GT(negative, 0) << "else this shows nothing";
}

}  // namespace
}  // namespace rounding_test
