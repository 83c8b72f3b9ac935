// Numbers of every size in every place of a datasheet and of the stations: a fit ends with figures that are finite, or
// with a reason. Overflow is no reason to go on.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "calibration/extremes_support.hpp"
#include "plumb/calibration/cross_check.hpp"
#include "plumb/calibration/observability.hpp"

namespace extremes_test {
namespace {

void expect_finite(const Calibration& c) {
  for (int i = 0; i < c.array.size(); ++i) {
    EXPECT_NEAR(plumb::norm(c.array.axis(i)), 1.0, 1e-6) << i;
    EXPECT_TRUE(std::isfinite(c.array.sigma_mps2(i))) << i;
    EXPECT_TRUE(std::isfinite(c.model.sensor[at(i)].scale[0] + c.model.sensor[at(i)].bias[0])) << i;
  }
  for (const double v : c.array.uncertainty().covariance) EXPECT_TRUE(std::isfinite(v));
  EXPECT_GE(c.report.p_value, 0.0);
  EXPECT_LE(c.report.p_value, 1.0);
}

// Negative: REQ-034
TEST(ExtremeNumbers, AFitIsFiniteOrRefused) {
  for (const bool estimated : {true, false}) {
    const Count count = for_each_extreme([&](Problem& p) {
      p.options.estimate_misfit = estimated;
      p.options.require_full_rank = estimated;
      FitReport report;
      const Expected<Calibration> c =
          plumb::calibrate(p.sheet, p.gravity, p.stations.data(), p.count(), p.options, &report);
      if (c) expect_finite(*c);
      return c.has_value();
    });
    expect_both(count, 100, 150);
  }
}

// Negative: REQ-034
TEST(ExtremeNumbers, AFitWithHeldAxesIsFiniteOrRefused) {
  const Count count = for_each_extreme(
      [](Problem& p) {
        hold_axes(p);
        p.options.estimate_misfit = false;
        p.options.require_full_rank = false;
        plumb::Calibrator fit(p.sheet, p.gravity, p.options);
        const plumb::StationList list(p.stations.data(), p.count());
        for (int k = 0; k < 200 && !fit.done(); ++k) fit.iterate_held(list);
        plumb::HeldFit out;
        if (fit.finish_held(list, out).code != Errc::ok) return false;
        for (int i = 0; i < p.sheet.size; ++i) {
          EXPECT_TRUE(std::isfinite(out.length[at(i)] + out.bias_mps2[at(i)])) << i;
        }
        EXPECT_TRUE(std::isfinite(out.chi2));
        return true;
      },
      Kind::held);
  expect_both(count, 100, 100);
}

// Negative: REQ-034
TEST(ExtremeNumbers, AFitOverTemperatureIsFiniteOrRefused) {
  const Count count = for_each_extreme(
      [](Problem& p) {
        const Fit f = fit_of(p.sheet, p.stations, options_of(1));
        if (f.made) expect_finite(*f.made);
        return f.made.has_value();
      },
      Kind::warmed);
  expect_both(count, 70, 200);
}

TEST(ExtremeNumbers, ThePlannerNeverProposesWhatIsNoDirection) {
  const Count count = for_each_extreme([](Problem& p) {
    auto planner = std::make_unique<plumb::StationPlanner>(p.sheet, p.gravity.g_mps2);
    for (const double z : {1.0, -1.0}) planner->add({{0.0, 0.0, z}, plumb::SensorSet::first(4), 100.0});
    const plumb::PlannedAttitude best = planner->best(100.0);
    if (best.gain == 0.0) return false;
    EXPECT_NEAR(plumb::norm(best.direction), 1.0, 1e-9);
    return true;
  });
  expect_both(count, 200, 80);
}

TEST(ExtremeNumbers, NoSensorIsSuspectedForANaN) {
  std::vector<Station> scratch(24);
  const Count count = for_each_extreme([&scratch](Problem& p) {
    p.options.max_iterations = 20;
    const plumb::OddSensor odd =
        plumb::odd_sensor(p.sheet, p.gravity, p.stations.data(), p.count(), p.options, scratch.data());
    EXPECT_GE(odd.sensor, -1);
    EXPECT_LT(odd.sensor, 4);
    EXPECT_FALSE(std::isnan(odd.ratio));
    return odd.sensor >= 0;
  });
  expect_both(count, 40, 250);
}

/// Two numbers at once, drawn: what one alone cannot bring about.
// Negative: REQ-034
TEST(ExtremeNumbers, AFitWithTwoOfThemIsFiniteOrRefused) {
  const std::vector<Change> all = places();
  Noise noise(5);
  const auto drawn = [&noise](std::size_t n) {
    return static_cast<std::size_t>(noise.uniform() * static_cast<double>(n));
  };
  Count plain, warmed;
  for (int k = 0; k < 600; ++k) {
    const std::size_t first = drawn(all.size()), second = drawn(all.size());
    const double one = kSizes[drawn(std::size(kSizes))], two = kSizes[drawn(std::size(kSizes))];
    SCOPED_TRACE(testing::Message() << "places " << first << " " << second << ", sizes " << one << " " << two);
    Problem p = sound(k % 2 == 0 ? Kind::warmed : Kind::plain);
    all[first](p, one);
    all[second](p, two);
    const Expected<Calibration> c = plumb::calibrate(p.sheet, p.gravity, p.stations.data(), p.count(), p.options);
    if (c) expect_finite(*c);
    ++(c ? plain.answered : plain.refused);
    const Fit f = fit_of(p.sheet, p.stations, options_of(1));
    if (f.made) expect_finite(*f.made);
    ++(f.made ? warmed.answered : warmed.refused);
  }
  for (const Count& count : {plain, warmed}) {
    EXPECT_GE(count.answered, 10);
    EXPECT_GE(count.refused, 400);
  }
}

/// A scale factor that passes through zero just in the middle of the span, for which all others are told.
// Negative: REQ-034
TEST(ExtremeNumbers, AScaleWithoutAMeanOverTheSpanIsRefused) {
  Problem p = sound(Kind::warmed);
  auto& c = p.sheet.sensor[1].coefficients;
  plumb::TemperatureOptions options = options_of(1);
  options.use_degc = {c.reference_degc - 8.0, c.reference_degc + 24.0};
  ASSERT_TRUE(fit_of(p.sheet, p.stations, options).made.has_value()) << "with a scale factor that does not";
  c.scale[1] = -c.scale[0] / 8.0;
  const Fit f = fit_of(p.sheet, p.stations, options);
  ASSERT_FALSE(f.made.has_value());
  EXPECT_EQ(f.made.error().code, Errc::diverged);
}

TEST(ExtremeNumbers, AScaleOfZeroHasNoTemperatureTermsToCarryOver) {
  Problem p = sound();
  Calibration c;
  c.model = p.sheet.model();
  p.sheet.sensor[3].coefficients.scale[0] = 0.0;
  c.model.sensor[3].scale[1] = 7.0;
  c.model.sensor[1].scale[0] = 0.0;
  c.model.sensor[1].scale[1] = 7.0;
  c.model.sensor[2].scale[1] = 7.0;
  const Datasheet out = plumb::with_temperature_of(p.sheet, c);
  EXPECT_EQ(out.sensor[1].coefficients.scale[1], p.sheet.sensor[1].coefficients.scale[1]);
  EXPECT_EQ(out.sensor[2].coefficients.scale[1], 7.0);
  EXPECT_EQ(out.sensor[3].coefficients.scale[1], p.sheet.sensor[3].coefficients.scale[1]);
}

/// A channel that says nothing and of which nothing is known beforehand: its row shrinks to nothing.
// Negative: REQ-034
TEST(ExtremeNumbers, ARowThatVanishesIsRefused) {
  for (const double open : {1.0, 3.0, 10.0, 1e4, 1e8, 1e16, 1e50, 1e100}) {
    const bool of_use = open < 100.0;  // by itself: a channel that says something is calibrated with it
    Problem p = sound();
    p.options.start = plumb::FitStart::datasheet;
    p.options.estimate_misfit = false;
    p.options.reject_outliers = false;
    p.sheet.sensor[3].prior = {open, open, open, {}, {}};
    const auto made = [&p] {
      return plumb::calibrate(p.sheet, p.gravity, p.stations.data(), p.count(), p.options).has_value();
    };
    EXPECT_EQ(made(), of_use) << open;
    for (Station& s : p.stations) s.mean[3] = 0.0;
    EXPECT_FALSE(made()) << open;
    Problem warm = sound(Kind::warmed);
    plumb::Prior& prior = warm.sheet.sensor[3].prior;
    prior.scale = prior.axis_rad = prior.bias_mps2 = open;
    plumb::TemperatureOptions options = options_of(1);
    options.fit.estimate_misfit = options.fit.reject_outliers = false;
    EXPECT_EQ(fit_of(warm.sheet, warm.stations, options).made.has_value(), of_use) << open;
    for (Station& s : warm.stations) s.mean[3] = 0.0;
    EXPECT_FALSE(fit_of(warm.sheet, warm.stations, options).made.has_value()) << open;
  }
}

/// Readings that no ellipsoid holds: of noise alone, all alike, and in one plane.
// Negative: REQ-034
TEST(ExtremeNumbers, StationsOfNoToolAreRefused) {
  Problem healthy = sound();
  EXPECT_TRUE(
      plumb::calibrate(healthy.sheet, healthy.gravity, healthy.stations.data(), healthy.count(), healthy.options));
  for (int kind = 0; kind < 4; ++kind) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      Problem p = sound();
      Noise noise(seed);
      for (Station& s : p.stations) {
        const double common = noise.normal();
        for (int i = 0; i < 4; ++i) {
          const double own = noise.normal();
          s.mean[at(i)] = kind == 0   ? own
                          : kind == 1 ? common
                          : kind == 2 ? own * own * own
                                      : (i < 2 ? own : std::sqrt(1.0 + own * own));
        }
      }
      FitReport report;
      EXPECT_FALSE(plumb::calibrate(p.sheet, p.gravity, p.stations.data(), p.count(), p.options, &report).has_value())
          << kind << " " << seed;
    }
  }
}

}  // namespace
}  // namespace extremes_test
