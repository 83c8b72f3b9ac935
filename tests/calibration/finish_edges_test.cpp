// Edges of what is made of converged parameters: other stations than those of the fit, a misfit beside noise of
// nothing.
#include <gtest/gtest.h>

#include <vector>

#include "calibration/edges_support.hpp"
#include "plumb/calibration/cross_check.hpp"
#include "support/member.hpp"

namespace finish_edges_test {
namespace {

using namespace calibration_test;
using plumb_test::member;

double& misfit_of(Calibrator& c) { return member<9, double>(c); }

StationList list_of(const Bench& b) { return {b.stations.data(), b.count()}; }

Calibrator converged(const Bench& b) {
  Calibrator out(b.sheet, b.gravity, b.options);
  for (int k = 0; k < 200 && !out.done(); ++k) out.iterate(b.stations.data(), b.count());
  EXPECT_TRUE(out.done());
  return out;
}

TEST(FinishEdge, WithoutAScreenNoStationIsSetAside) {
  Bench b;
  const Calibrator c = converged(b);
  Station far = b.stations[0];
  far.mean[0] += 100.0;
  EXPECT_FALSE(c.sets_aside(far));
}

/// Chi^2 is told against the datasheet's noise, whatever misfit the weights have: a misfit changes the weights alone.
TEST(FinishEdge, ChiSquareOfAHeldFitKnowsNoMisfit) {
  Bench b;
  Calibrator plain(b.sheet, b.gravity, b.options), with = plain;
  misfit_of(with) = 1e-2;
  HeldFit one, other;
  plain.finish_held(list_of(b), one);
  with.finish_held(list_of(b), other);
  EXPECT_GT(one.chi2, 0.0);
  EXPECT_NEAR(other.chi2, one.chi2, 1e-3 * one.chi2);
}

/// A station that came after the fit and is no number.
// Negative: REQ-034
TEST(FinishEdge, AStationThatIsNoNumberEndsBoth) {
  Bench b;
  const Calibrator c = converged(b);
  b.stations.push_back(b.stations[0]);
  b.stations.back().mean[1] = 1e200;
  const auto made = c.finish(b.stations.data(), b.count());
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, Errc::diverged);
  HeldFit held;
  EXPECT_EQ(c.finish_held(list_of(b), held).code, Errc::diverged);
}

/// Residuals whose squares are numbers, and whose sum against the datasheet's noise is none: of one station alone there
/// is a rank to tell, of eight not even that.
// Negative: REQ-034
TEST(FinishEdge, AChiSquareThatIsNoNumberEndsBoth) {
  for (const std::size_t strays : {1U, 8U}) {
    Bench b;
    for (int i = 0; i < b.sheet.size; ++i) b.sheet.sensor[at(i)].row.sigma_mps2 = 1e-50;
    for (std::size_t k = 0; k < strays; ++k) b.stations[k].mean[0] = 3e103;
    Calibrator c(b.sheet, b.gravity, b.options);
    misfit_of(c) = 1.0;
    FitReport report;
    const auto made = c.finish(b.stations.data(), b.count(), &report);
    ASSERT_FALSE(made.has_value());
    EXPECT_EQ(made.error().code, Errc::diverged);
    EXPECT_EQ(report.rank > 0, strays == 1U);
    HeldFit held;
    EXPECT_EQ(c.finish_held(list_of(b), held).code, Errc::diverged);
    EXPECT_EQ(held.rank > 0, strays == 1U);
  }
}

/// As many figures as parameters: what is left over is nothing, and widens nothing.
TEST(FinishEdge, ResidualsWithoutFreedomWidenNoSigma) {
  Bench b;
  b.stations.resize(3);
  b.options.require_full_rank = false;
  b.options.estimate_misfit = false;
  b.run();
  EXPECT_LE(b.report.degrees_of_freedom, 0);
  EXPECT_EQ(b.report.p_value, 1.0);
  for (int k = 0; k < b.report.parameters; ++k) EXPECT_TRUE(std::isfinite(b.report.sigma[at(k)])) << k;
}

/// Readings whose squares are no numbers predict nothing.
TEST(FinishEdge, AVectorOfNoLengthIsNotPredicted) {
  Bench b;
  const auto fit = b.run();
  ASSERT_TRUE(fit.has_value());
  Station endless = b.stations[0];
  EXPECT_TRUE(predict(*fit, b.gravity, endless).judged);
  for (double& raw : endless.mean) raw *= 1e200;
  EXPECT_FALSE(predict(*fit, b.gravity, endless).judged);
}

/// Five axes along three lines and readings without an error: who is left out changes nothing, and nobody is odd.
TEST(FinishEdge, WhereEveryFitIsPerfectNobodyIsOdd) {
  AxisList axes{};
  for (int i = 0; i < 5; ++i) axes[at(i)][at(i % 3)] = i < 3 ? 1.0 : -1.0;
  Datasheet sheet = datasheet_of(axes, 5, 1.0);
  for (DatasheetSensor& s : sheet.sensor) {
    s.coefficients = {};
    s.coefficients.scale[0] = 1.0;
  }
  std::vector<Station> stations;
  const GravityReference gravity = {10.0, 0.0, GravityModel::value};
  const Vec3 directions[] = {{10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {6, 8, 0}, {8, 0, 6}, {0, 6, 8}};
  for (const Vec3& u : directions) {
    for (const double hand : {1.0, -1.0}) {
      Station s;
      s.delivered = SensorSet::first(5);
      s.temperature_degc = 25.0;
      s.count = 1;
      for (int i = 0; i < 5; ++i) s.mean[at(i)] = hand * dot(axes[at(i)], u);
      for (int again = 0; again < 4; ++again) stations.push_back(s);
    }
  }
  std::vector<Station> scratch(stations.size());
  const OddSensor odd =
      odd_sensor(sheet, gravity, stations.data(), static_cast<int>(stations.size()), {}, scratch.data());
  EXPECT_EQ(odd.sensor, -1);
  EXPECT_EQ(odd.ratio, 1.0);
}

}  // namespace
}  // namespace finish_edges_test
