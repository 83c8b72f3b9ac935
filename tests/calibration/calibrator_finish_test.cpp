// What is made of converged parameters: other stations than those of the fit, a misfit beside noise of nothing.
#include <gtest/gtest.h>

#include <vector>

#include "calibration/bench.hpp"

namespace calibrator_finish_test {
namespace {

using namespace calibration_test;

StationList list_of(const Bench& b) { return {b.stations.data(), b.count()}; }

Calibrator converged(const Bench& b) {
  Calibrator out(b.sheet, b.gravity, b.options);
  for (int k = 0; k < 200 && !out.done(); ++k) out.iterate(b.stations.data(), b.count());
  EXPECT_TRUE(out.done());
  return out;
}

TEST(CalibratorFinish, WithoutAScreenNoStationIsAnOutlier) {
  Bench b;
  const Calibrator c = converged(b);
  Station far = b.stations[0];
  far.mean[0] += 100.0;
  EXPECT_FALSE(c.sets_aside(far));
}

/// A station that came after the fit and is no number.
// Negative: REQ-034
TEST(CalibratorFinish, AStationThatIsNoNumberIsRefused) {
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

/// A tool that is noisier than declared: the misfit that was found for it changes the weights. Chi^2 is told against
/// the declared noise, whatever the weights.
TEST(CalibratorFinish, ChiSquareIsReportedAgainstTheDeclaredNoise) {
  Bench b;
  Noise loud(3);
  for (Station& s : b.stations) {
    for (int i = 0; i < 4; ++i) s.mean[at(i)] += 10.0 * kBenchSigma * 3.0 / kG0_mps2 * loud.normal();
  }
  b.options.max_sensor_excess = 1e9;
  b.options.max_norm_rms_mps2 = 1.0;
  b.options.reject_outliers = false;
  Calibrator with = converged(b);
  b.options.estimate_misfit = false;
  Calibrator without = converged(b);
  HeldFit one, other;
  with.finish_held(list_of(b), one);
  without.finish_held(list_of(b), other);
  EXPECT_GT(one.chi2_per_freedom(), 20.0);
  EXPECT_NEAR(one.chi2, other.chi2, 0.2 * other.chi2);
}

/// Noise declared so small that the misfit alone weighs: residuals whose squares are numbers, and whose sum against the
/// declared noise is none. Of one station alone there is a rank to tell, of eight not even that.
// Negative: REQ-034
TEST(CalibratorFinish, AChiSquareThatIsNoNumberIsRefused) {
  for (const std::size_t strays : {1U, 8U}) {
    Bench b;
    for (int i = 0; i < b.sheet.size; ++i) b.sheet.sensor[at(i)].row.sigma_mps2 = 1e-6;
    b.options.reject_outliers = false;
    Calibrator c = converged(b);
    for (std::size_t k = 0; k < strays; ++k) b.stations[k].mean[0] = 3e147;
    FitReport report;
    const auto made = c.finish(b.stations.data(), b.count(), &report);
    ASSERT_FALSE(made.has_value());
    HeldFit held;
    EXPECT_NE(c.finish_held(list_of(b), held).code, Errc::ok);
    EXPECT_EQ(report.rank > 0, strays == 1U);
    EXPECT_EQ(held.rank > 0, strays == 1U);
    if (strays == 8U) {
      EXPECT_EQ(made.error().code, Errc::diverged);
    }
  }
}

}  // namespace
}  // namespace calibrator_finish_test
