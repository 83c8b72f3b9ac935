/// The paper's rule: what it finds, that it is exact, and where its claims end.
#include "plumb/paper/paper_rule.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "paper/paper_support.hpp"

// Serves: REQ-190

namespace paper_rule_test {
namespace {

using namespace plumb;
using calibration_test::Noise;
using paper_test::along_axes;
using paper_test::at;
using paper_test::raw_of;

using Raw = std::array<double, kCapacity>;
constexpr double kSigma = 2e-4 * kG0_mps2;
constexpr double kG = kG0_mps2;

/// A tool whose datasheet is the truth, with the rule over it.
struct Bench {
  explicit Bench(const Datasheet& d) : sheet(d), array(*d.array()), calibration(paper_test::exact_fits(d)) {}
  PaperFits fits() const { return {array, *calibration, rest}; }
  void add(const Readings& y, SensorSet in_use) { rule.add(fits(), kG, raw_of(sheet, y), 25.0, in_use); }
  PaperFinding finding(SensorSet in_use) const { return rule.finding(fits(), kPaperDeltaF_mps2, in_use); }

  Datasheet sheet;
  SensorArray array;
  std::unique_ptr<PaperCalibration> calibration;
  PaperFit rest;
  PaperRule rule;
};

Datasheet tool_of(int n) {
  if (n == 4) return calibration_test::paper_tool(kSigma);
  AxisList axes{};
  cone(axes, n);
  return calibration_test::datasheet_of(axes, n, kSigma);
}

TEST(PaperRule, DecidesNothingWithoutSamples) {
  const Bench bench(tool_of(4));
  const PaperFinding f = bench.finding(SensorSet::first(4));
  EXPECT_FALSE(f.detected);
  EXPECT_TRUE(f.isolated.empty());
}

TEST(PaperRule, MaeIsTheMeanOfAbsoluteErrors) {
  PaperMae mae;
  EXPECT_EQ(mae.mps2(), 0.0);
  mae.add(0.3);
  mae.add(-0.5);
  EXPECT_NEAR(mae.mps2(), 0.4, kMaeUnit_mps2);
  mae.add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_GT(mae.mps2(), 50.0) << "a NaN is the largest error, not none";
}

TEST(PaperRule, OneFaultAmongFourLeavesTheTripleOfTheOthers) {
  for (int faulty = 0; faulty < 4; ++faulty) {
    Bench bench(tool_of(4));
    Noise noise(7);
    for (int k = 0; k < 6; ++k) {
      Readings y = along_axes(bench.array, scaled(noise.direction(), kG));
      y[at(faulty)] += 3.0;
      bench.add(y, bench.array.all());
    }
    const PaperFinding f = bench.finding(bench.array.all());
    EXPECT_TRUE(f.detected);
    EXPECT_EQ(f.triples, 4);
    EXPECT_EQ(f.passing, 1);
    EXPECT_EQ(f.isolated, SensorSet::of(faulty));
    EXPECT_EQ(f.correct, bench.array.all().without(faulty));
    EXPECT_GT(f.worst_mps2, kPaperDeltaF_mps2);
  }
}

// Verifies: REQ-190
TEST(PaperRule, TheUnionOfPassingTriplesIsCorrectAndTheRestIsOut) {
  Bench bench(tool_of(6));
  Noise noise(3);
  for (int k = 0; k < 8; ++k) {
    Readings y = along_axes(bench.array, scaled(noise.direction(), kG));
    y[1] += 4.0;
    y[4] = -2.0;
    bench.add(y, bench.array.all());
  }
  const PaperFinding f = bench.finding(bench.array.all());
  EXPECT_EQ(f.triples, 20);
  EXPECT_EQ(f.passing, 4) << "the four triples of 0, 2, 3, 5";
  EXPECT_EQ(f.isolated, SensorSet::of(1).with(4));
}

TEST(PaperRule, TheLimitItselfFails) {
  // Eq (15) wants MAE < delta_F: at the limit the sensors are not correct.
  Bench bench(tool_of(4));
  const Readings y = along_axes(bench.array, {0.0, 0.0, kG + 1.0});
  bench.add(y, bench.array.all());
  const double mae = bench.finding(bench.array.all()).mae_all_mps2;
  EXPECT_TRUE(bench.rule.finding(bench.fits(), mae, bench.array.all()).detected);
  EXPECT_FALSE(bench.rule.finding(bench.fits(), mae * (1.0 + 1e-12), bench.array.all()).detected);
}

TEST(PaperRule, ATripleWithoutASoundFitDoesNotCount) {
  Bench bench(tool_of(4));
  bench.calibration->triple[3].rank = 8;  // of 1, 2, 3: the only one that would pass
  Noise noise(5);
  for (int k = 0; k < 6; ++k) {
    Readings y = along_axes(bench.array, scaled(noise.direction(), kG));
    y[0] += 3.0;
    bench.add(y, bench.array.all());
  }
  const PaperFinding f = bench.finding(bench.array.all());
  EXPECT_EQ(f.triples, 3);
  EXPECT_EQ(f.passing, 0);
  EXPECT_TRUE(f.isolated.empty());
}

TEST(PaperRule, ThreeSensorsAreReadByTheFitOfTheirTriple) {
  Bench bench(tool_of(4));
  const SensorSet in_use = SensorSet::of(0).with(1).with(3);
  const Vec3 g = scaled(calibration_test::rolled(30, 50), 1.0);
  const Raw raw = raw_of(bench.sheet, along_axes(bench.array, g));
  bench.calibration->triple[1].model.sensor[3].bias[0] += 0.7;  // the triple's own coefficients differ
  const Vec3 x = paper_vector_in_use(bench.fits(), raw, 25.0, in_use);
  EXPECT_EQ(x, paper_vector(bench.array, bench.calibration->triple[1], raw, 25.0));
  EXPECT_GT(norm(minus(x, g)), 0.3);
  bench.calibration->triple[1].converged = false;
  const Vec3 by_all = paper_vector_in_use(bench.fits(), raw, 25.0, in_use);
  EXPECT_LT(norm(minus(by_all, g)), 1e-9) << "without a fit of their own: the fit of all";
}

TEST(PaperRule, TheRestIsReadByItsOwnFitOnceItHasOne) {
  Bench bench(tool_of(5));
  const SensorSet in_use = SensorSet::first(5).without(2);
  const Raw raw = raw_of(bench.sheet, along_axes(bench.array, calibration_test::rolled(40, 110)));
  EXPECT_EQ(bench.fits().own(in_use), nullptr);
  bench.rest = bench.calibration->all;
  bench.rest.used = in_use;
  bench.rest.model.sensor[0].bias[0] += 0.5;
  EXPECT_EQ(bench.fits().own(in_use), &bench.rest);
  EXPECT_EQ(paper_vector_in_use(bench.fits(), raw, 25.0, in_use), paper_vector(bench.array, bench.rest, raw, 25.0));
}

TEST(PaperRule, TheReadingsOfAnExcludedSensorDoNotCount) {
  Bench bench(tool_of(5));
  for (std::size_t k = 0; k < kCapacity; ++k) bench.calibration->all.model.misalignment[k * kCapacity + 2] = 0.03;
  const SensorSet in_use = SensorSet::first(5).without(2);
  Raw raw = raw_of(bench.sheet, along_axes(bench.array, calibration_test::rolled(40, 110)));
  const Vec3 x = paper_vector_in_use(bench.fits(), raw, 25.0, in_use);
  for (const double wild : {std::numeric_limits<double>::quiet_NaN(), 1e300, -3.0}) {
    raw[2] = wild;
    EXPECT_EQ(paper_vector_in_use(bench.fits(), raw, 25.0, in_use), x);
  }
}

TEST(PaperRule, AFitInFlightTakesOverOnlyWithinItsBounds) {
  const Bench bench(tool_of(4));
  const PaperFit good = bench.calibration->all;
  const auto takes_over = [&bench](const PaperFit& fit) {
    return may_replace(fit, bench.sheet, kG, kPaperDeltaF_mps2);
  };
  EXPECT_TRUE(takes_over(good));
  PaperFit fit = good;
  fit.rank = 8;
  EXPECT_FALSE(takes_over(fit));
  fit = good;
  fit.converged = false;
  EXPECT_FALSE(takes_over(fit));
  fit = good;
  fit.model.sensor[1].bias[0] += 8.1 * bench.sheet.sensor[1].prior.bias_mps2;
  EXPECT_FALSE(takes_over(fit));
  fit.used = fit.used.without(1);
  EXPECT_TRUE(takes_over(fit)) << "a sensor that the fit does not use does not count";
  for (const double factor : {1.26, 1.0 / 1.26, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    fit = good;
    fit.model.sensor[2].scale[0] *= factor;
    EXPECT_FALSE(takes_over(fit)) << factor;
  }
  fit = good;
  fit.cost = std::pow(2.0 * kG * 1.01 * kPaperDeltaF_mps2, 2.0);
  EXPECT_FALSE(takes_over(fit));
  fit.cost = std::pow(2.0 * kG * 0.99 * kPaperDeltaF_mps2, 2.0);
  EXPECT_TRUE(takes_over(fit));
}

/// The sums are exact, so the order of the samples cannot matter.
RC_GTEST_PROP(PaperRuleLaw, TheOrderOfTheSamplesDoesNotMatter, ()) {
  const int n = *rc::gen::inRange(3, std::min(6, kCapacity) + 1);
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  const Datasheet sheet = tool_of(n);
  std::vector<Readings> samples;
  for (int k = 0; k < 20; ++k) {
    const double length = kG * (1.0 + noise.within(0.2));
    samples.push_back(along_axes(*sheet.array(), scaled(noise.direction(), length)));
    for (int i = 0; i < n; ++i) samples.back()[at(i)] += noise.within(1.0);
  }
  Bench forward(sheet), backward(sheet);
  for (const Readings& y : samples) forward.add(y, forward.array.all());
  std::reverse(samples.begin(), samples.end());
  std::swap(samples[3], samples[11]);
  for (const Readings& y : samples) backward.add(y, backward.array.all());
  const PaperFinding a = forward.finding(forward.array.all()), b = backward.finding(backward.array.all());
  RC_ASSERT(a.mae_all_mps2 == b.mae_all_mps2);
  RC_ASSERT(a.mae_triple_mps2 == b.mae_triple_mps2);
  RC_ASSERT(a.isolated == b.isolated);
}

/// Table 2, rows 2 to 17: one dead, stuck or random sensor of four, many attitudes pooled.
RC_GTEST_PROP(PaperRuleLaw, OneFaultOfFourOverManyAttitudesIsIsolated, ()) {
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  const int faulty = *rc::gen::inRange(0, 4);
  const int kind = *rc::gen::inRange(0, 4);
  Bench bench(tool_of(4));
  for (int k = 0; k < 40; ++k) {
    Readings y = along_axes(bench.array, scaled(noise.direction(), kG));
    for (int i = 0; i < 4; ++i) y[at(i)] += kSigma * noise.normal();
    const double random = noise.within(kG);
    y[at(faulty)] = kind == 0 ? 0.0 : kind == 1 ? kG : kind == 2 ? -kG : random;
    bench.add(y, bench.array.all());
  }
  const PaperFinding f = bench.finding(bench.array.all());
  RC_ASSERT(f.detected);
  RC_ASSERT(f.isolated == SensorSet::of(faulty));
}

/// Table 2, rows 18 to 23: two random sensors of four are detected, and none is named.
RC_GTEST_PROP(PaperRuleLaw, TwoFaultsOfFourAreDetectedAndNoSensorIsIsolated, ()) {
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  const int first = *rc::gen::inRange(0, 3);
  const int second = *rc::gen::inRange(first + 1, 4);
  Bench bench(tool_of(4));
  for (int k = 0; k < 40; ++k) {
    Readings y = along_axes(bench.array, scaled(noise.direction(), kG));
    y[at(first)] = noise.within(kG);
    y[at(second)] = noise.within(kG);
    bench.add(y, bench.array.all());
  }
  const PaperFinding f = bench.finding(bench.array.all());
  RC_ASSERT(f.detected);
  RC_ASSERT(f.passing == 0);
  RC_ASSERT(f.isolated.empty());
}

// ---- Where the claims end: at one attitude ------------------------------------------------------

TEST(PaperRuleLimit, AtOneAttitudeAFaultOfHalfGravityIsMissed) {
  // The shift d that the fault gives the vector turns it without changing its length: 2 g.d + d.d = 0.
  Bench bench(tool_of(4));
  const Vec3 g = calibration_test::rolled(70, 20);
  const LeastSquares map = least_squares(bench.array, bench.array.all());
  const Vec3 column = map.column[3];
  const double size = -2.0 * dot(g, column) / dot(column, column);
  ASSERT_GT(std::fabs(size), 0.5 * kG);
  Readings y = along_axes(bench.array, g);
  y[3] += size;
  for (int k = 0; k < 32; ++k) bench.add(y, bench.array.all());
  const PaperFinding f = bench.finding(bench.array.all());
  EXPECT_FALSE(f.detected) << "MAE " << f.mae_all_mps2;
  EXPECT_LT(f.passing, f.triples) << "the triples would show it";
  EXPECT_FALSE((bench.array.all() - f.correct).empty()) << "and name who it is";
  EXPECT_TRUE(f.isolated.empty()) << "but the shut gate keeps everybody in (step 6 follows step 5)";
  EXPECT_GT(angle_between_rad(map.estimate(y), g), 0.3) << "and the direction is far off";
}

TEST(PaperRuleLimit, AtOneAttitudeTheMirrorOfAFaultyTripleHidesTheFault) {
  // Within its triple the fault mirrors the vector: that triple passes beside the healthy one, and the union is all.
  Bench bench(tool_of(4));
  const Vec3 g = calibration_test::rolled(30, 50);
  const LeastSquares map = least_squares(bench.array, SensorSet::of(0).with(1).with(3));
  const Vec3 column = map.column[1];
  Readings y = along_axes(bench.array, g);
  y[1] -= 2.0 * dot(g, column) / dot(column, column);
  for (int k = 0; k < 32; ++k) bench.add(y, bench.array.all());
  const PaperFinding f = bench.finding(bench.array.all());
  EXPECT_TRUE(f.detected);
  EXPECT_EQ(f.passing, 2);
  EXPECT_TRUE(f.isolated.empty()) << "detected, and the rule calls every sensor correct";
}

TEST(PaperRuleLimit, AtOneAttitudeTwoFaultsThatAgreeIsolateAHealthySensor) {
  // Sensors 0 and 1 read a gravity that is turned about the axis of sensor 2, which therefore agrees with them.
  Bench bench(tool_of(4));
  const Vec3 g = calibration_test::rolled(30, 50);
  const Readings healthy = along_axes(bench.array, g);
  const Vec3 turn = scaled(bench.array.axis(2), rad_from_deg(60));
  const Readings turned = along_axes(bench.array, calibration_test::turned(g, turn));
  Readings y = healthy;
  y[0] = turned[0];
  y[1] = turned[1];
  for (int k = 0; k < 32; ++k) bench.add(y, bench.array.all());
  const PaperFinding f = bench.finding(bench.array.all());
  EXPECT_TRUE(f.detected);
  EXPECT_EQ(f.passing, 1);
  EXPECT_EQ(f.isolated, SensorSet::of(3)) << "sensor 3 is healthy";
}

/// A fit that is not sound reads nobody, nor do triples that were not fitted.
// Negative: REQ-190
TEST(PaperRule, WithoutASoundFitNoTripleUsesItsOwn) {
  Bench bench(tool_of(4));
  PaperCalibration& made = *bench.calibration;
  EXPECT_EQ(bench.fits().own(SensorSet::first(4)), &made.all);
  EXPECT_EQ(bench.fits().own(SensorSet::first(3)), &made.triple[0]);
  made.all.converged = false;
  made.triples = 0;
  EXPECT_EQ(bench.fits().own(SensorSet::first(4)), nullptr);
  EXPECT_EQ(bench.fits().own(SensorSet::first(3)), nullptr);
  bench.rest = made.all;
  bench.rest.converged = true;
  EXPECT_EQ(bench.fits().own(SensorSet::first(4)), &bench.rest);
}

}  // namespace
}  // namespace paper_rule_test
