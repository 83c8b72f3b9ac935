/// A fit with held axes on a small stack against the same fit by the general way: digit for digit.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "calibration/bench.hpp"

namespace held_fit_test {
namespace {

using namespace calibration_test;
using namespace plumb;

constexpr double kSigma = kBenchSigma;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Case {
  Datasheet datasheet = paper_tool(2e-4 * kG0_mps2);
  std::vector<StationMean> means;
  std::vector<Station> stations;  // the same, less every fourth
  GravityReference gravity;
  FitOptions options;

  explicit Case(std::uint64_t seed, int outlier = -1) {
    Noise noise(seed);
    Truth truth = draw_truth(datasheet, noise, 0.2, 0.0);
    for (int i = 0; i < datasheet.size; ++i) datasheet.sensor[at(i)].prior.axis_rad = 0.0;
    options.require_full_rank = false;
    options.estimate_misfit = false;
    for (int k = 0; k < 24; ++k) {
      Station s = station_at(datasheet, truth, scaled(noise.direction(), gravity.g_mps2), noise, 2e-4 * kG0_mps2);
      if (k == outlier) s.mean[1] += 0.2;
      StationMean mean;
      mean.raw = s.mean;
      mean.temperature_degc = s.temperature_degc;
      means.push_back(mean);
      s.count = 1;
      s.delivered = SensorSet::first(datasheet.size);
      s.scatter.fill(0.0);
      if (k % 4 != 3) stations.push_back(s);
    }
  }
  StationList list() const {
    return {means.data(), static_cast<int>(means.size()), SensorSet::first(datasheet.size), 4};
  }
};

void expect_same(const Case& c, bool sets_aside) {
  Calibrator general(c.datasheet, c.gravity, c.options), held(c.datasheet, c.gravity, c.options);
  const int count = static_cast<int>(c.stations.size());
  ASSERT_EQ(c.list().size(), count);
  for (int k = 0; k < 200 && !(general.done() && held.done()); ++k) {
    general.iterate(c.stations.data(), count);
    held.iterate_held(c.list());
    ASSERT_EQ(general.parameters(), held.parameters()) << "iteration " << k;
    ASSERT_EQ(general.cost(), held.cost());
    ASSERT_EQ(general.done(), held.done());
  }
  FitReport report;
  const Expected<Calibration> whole = general.finish(c.stations.data(), count, &report);
  HeldFit fit;
  const Error error = held.finish_held(c.list(), fit);
  ASSERT_TRUE(whole.has_value()) << describe(whole.error().code);
  EXPECT_EQ(error.code, Errc::ok) << describe(error.code);
  EXPECT_EQ(report.outliers > 0, sets_aside);
  EXPECT_EQ(fit.rank, report.rank);
  EXPECT_EQ(fit.degrees_of_freedom, report.degrees_of_freedom);
  EXPECT_EQ(fit.chi2, report.chi2);
  EXPECT_EQ(fit.p_value, report.p_value);
  for (int i = 0; i < c.datasheet.size; ++i) {
    const SensorCoefficients& nominal = c.datasheet.sensor[at(i)].coefficients;
    const SensorCoefficients& fitted = whole->model.sensor[at(i)];
    EXPECT_EQ(fitted.scale[0], nominal.scale[0] * fit.length[at(i)]);
    EXPECT_EQ(fitted.bias[0], (nominal.bias[0] + fit.bias_mps2[at(i)]) / fit.length[at(i)]);
  }
}

TEST(HeldFit, IsTheGeneralFitDigitForDigit) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) expect_same(Case(seed), false);
}

TEST(HeldFit, LeavesOutTheSameStations) { expect_same(Case(3, 5), true); }

TEST(HeldFit, RefusesWhatTheGeneralFitRefuses) {
  Case c(2);
  for (StationMean& mean : c.means) mean.raw[2] = mean.raw[0];  // one channel on two inputs
  for (Station& station : c.stations) station.mean[2] = station.mean[0];
  Calibrator general(c.datasheet, c.gravity, c.options), held(c.datasheet, c.gravity, c.options);
  for (int k = 0; k < 200 && !(general.done() && held.done()); ++k) {
    general.iterate(c.stations.data(), static_cast<int>(c.stations.size()));
    held.iterate_held(c.list());
  }
  const Expected<Calibration> whole = general.finish(c.stations.data(), static_cast<int>(c.stations.size()));
  HeldFit fit;
  const Error error = held.finish_held(c.list(), fit);
  ASSERT_FALSE(whole.has_value());
  EXPECT_EQ(error.code, whole.error().code);
  EXPECT_EQ(error.index, whole.error().index);
}

struct Held {
  explicit Held(int count = 24) {
    for (int i = 0; i < sheet.size; ++i) sheet.sensor[at(i)].prior.axis_rad = 0.0;
    Noise noise(5);
    const Truth truth = draw_truth(sheet, noise, 0.2, 0.0);
    options.require_full_rank = false;
    options.estimate_misfit = false;
    stations = random_stations(sheet, truth, count, noise, kSigma);
  }
  Error run() {
    Calibrator fit(sheet, gravity, options);
    const StationList list(stations.data(), static_cast<int>(stations.size()));
    for (int k = 0; k < 200 && !fit.done(); ++k) fit.iterate_held(list);
    fit.iterate_held(list);  // after its end: nothing
    return fit.finish_held(list, out);
  }
  Datasheet sheet = paper_tool(kSigma);
  GravityReference gravity = standard_gravity();
  FitOptions options;
  std::vector<Station> stations;
  HeldFit out;
};

TEST(HeldFit, TakesAsManyStationsAsItCountsAndNoMore) {
  Held fits;
  EXPECT_EQ(fits.run().code, Errc::ok);
  Held many(200);
  EXPECT_EQ(many.run().code, Errc::diverged);
}

TEST(HeldFit, NumbersThatAreNoneAreRefused) {
  Held reading;
  reading.stations[5].mean[1] = kNan;
  EXPECT_EQ(reading.run().code, Errc::diverged);
  Held scale;
  scale.sheet.sensor[2].coefficients.scale[0] = 0.0;
  EXPECT_EQ(scale.run().code, Errc::not_finite);
  Held endless;
  endless.options.stop_relative = -1.0;
  endless.options.max_iterations = 20;
  EXPECT_EQ(endless.run().code, Errc::diverged);
  Held few(2);
  EXPECT_EQ(few.run().code, Errc::too_few_stations);
}

TEST(HeldFit, SpecificForceHasTheOtherSign) {
  Held gravity, force;
  force.sheet.reads = Reads::specific_force;
  for (Station& s : force.stations) {
    for (int i = 0; i < 4; ++i) {
      // V = SF(T) (f + B), and f = -g.
      const SensorModel model = force.sheet.model();
      const double offset = model.bias_at(i, s.temperature_degc) * model.scale_at(i, s.temperature_degc);
      s.mean[at(i)] = 2.0 * offset - s.mean[at(i)];
    }
  }
  ASSERT_EQ(gravity.run().code, Errc::ok);
  ASSERT_EQ(force.run().code, Errc::ok);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(force.out.bias_mps2[at(i)], -gravity.out.bias_mps2[at(i)], 1e-9) << i;
    EXPECT_NEAR(force.out.length[at(i)], gravity.out.length[at(i)], 1e-9) << i;
  }
}

/// Held biases and scales with stations that stray. As few as there are parameters: nothing is left to judge by.
TEST(HeldFit, StraysRefuseItAndTooFewAreNotJudged) {
  Held strays;
  strays.stations[3].mean[1] += 0.2;
  strays.stations[9].mean[2] -= 0.2;
  EXPECT_NE(strays.run().code, Errc::ok) << "without the misfit there is no noise that explains them";
  Held few(4);
  few.run();
  EXPECT_LE(few.out.degrees_of_freedom, 0);
  EXPECT_EQ(few.out.p_value, 1.0);
}

TEST(HeldFit, WithoutFreedomNothingIsLeftOfChiSquare) {
  HeldFit fit;
  fit.chi2 = 12.0;
  EXPECT_EQ(fit.chi2_per_freedom(), 0.0);
  fit.degrees_of_freedom = 6;
  EXPECT_EQ(fit.chi2_per_freedom(), 2.0);
}

}  // namespace
}  // namespace held_fit_test
