// The fit over temperature against the figures of docs/theory.md, section 9.7, and its own claims against the truth.
#include "plumb/calibration/temperature_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "calibration/temperature_support.hpp"
#include "plumb/calibration/cross_check.hpp"

namespace temperature_fit_test {
namespace {

using namespace temperature_test;
using plumb::Errc;

std::vector<plumb::Station> at_random(const Truth& truth, int count, double low, double high, Noise& noise) {
  std::vector<plumb::Station> out;
  for (int k = 0; k < count; ++k) {
    const double degc = low + (high - low) * noise.uniform();
    const Vec3 u = noise.direction();
    out.push_back(station_at(truth, plumb::scaled(u, plumb::kG0_mps2), degc, noise));
  }
  return out;
}

plumb::TemperatureOptions lenient(int order) {
  plumb::TemperatureOptions options = options_of(order);
  options.fit = plumb::without_limits(options.fit);
  options.fit.reject_outliers = false;
  return options;
}

TEST(TemperatureFit, RankIsThirteenAndEightMoreALevel) {
  plumb::AxisList four{}, six{};
  plumb::paper_tetrahedron(four);
  const int n6 = plumb::cone_with_axis(six, 6);
  const plumb::Datasheet sheets[] = {sheet_of(four, 3), sheet_of(four, 4), sheet_of(six, n6)};
  for (const plumb::Datasheet& d : sheets) {
    const int n = d.size, first = n == 3 ? 9 : 4 * n - 3;
    for (int levels = 1; levels <= 4; ++levels) {
      Noise noise(70 + static_cast<std::uint64_t>(levels));
      const Truth truth = temperature_test::draw_truth(d, noise);
      const Fit f = fit_of(d, on_levels(truth, levels_of(levels), noise), options_of(3));
      EXPECT_EQ(f.report.parameters, 10 * n);
      EXPECT_EQ(f.report.rank, first + 2 * n * (levels - 1)) << n << " sensors, " << levels << " levels";
      EXPECT_EQ(f.report.gauge, 3);
      EXPECT_EQ(f.report.null_directions, 10 * n - 3 - f.report.rank);
      EXPECT_EQ(f.made.has_value(), levels == 4);
    }
  }
}

TEST(TemperatureFit, CubicsFollowTheToolAndLowerOrdersDoNot) {
  const plumb::Datasheet d = paper_sheet();
  std::array<double, 4> square{};
  constexpr int kRuns = 40;
  double condition = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Noise noise(2000 + static_cast<std::uint64_t>(run));
    const Truth truth = temperature_test::draw_truth(d, noise);
    const auto stations = on_levels(truth, levels_of(4), noise);
    for (int order = 0; order <= 3; ++order) {
      const Fit f = fit_of(d, stations, order < 3 ? lenient(order) : options_of(3));
      ASSERT_TRUE(f.made.has_value()) << order;
      const double tilt = tilt_rms(truth, *f.made);
      square[at(order)] += tilt * tilt / kRuns;
      condition = order == 3 ? std::fmax(condition, f.report.condition) : condition;
    }
  }
  EXPECT_LE(std::sqrt(square[3]), 0.15e-3);
  EXPECT_GE(std::sqrt(square[2]), 1.2 * std::sqrt(square[3]));
  EXPECT_GE(std::sqrt(square[1]), 0.4e-3);
  EXPECT_GE(std::sqrt(square[0]), 3e-3);
  EXPECT_LE(condition, 5.0);
}

TEST(TemperatureFit, OtherPlansAsInTheNote) {
  const plumb::Datasheet d = paper_sheet();
  constexpr int kRuns = 41;
  std::vector<double> six, faces, hundred;
  for (int run = 0; run < kRuns; ++run) {
    Noise noise(3000 + static_cast<std::uint64_t>(run));
    const Truth truth = temperature_test::draw_truth(d, noise);
    std::vector<plumb::Station> stations;
    for (const double degc : levels_of(4)) {
      const auto some = at_random(truth, 6, degc, degc, noise);
      stations.insert(stations.end(), some.begin(), some.end());
    }
    const Fit small = fit_of(d, stations, options_of(3));
    ASSERT_TRUE(small.made.has_value());
    EXPECT_EQ(small.report.rank, 37);
    six.push_back(tilt_rms(truth, *small.made));
    stations = on_levels(truth, {25.0}, noise);
    for (const double degc : {70.0, 110.0, 150.0}) {
      for (int face = 0; face < 6; ++face) {
        Vec3 g{};
        g[at(face / 2)] = face % 2 == 0 ? plumb::kG0_mps2 : -plumb::kG0_mps2;
        stations.push_back(station_at(truth, g, degc, noise));
      }
    }
    const Fit cube = fit_of(d, stations, options_of(3));
    ASSERT_TRUE(cube.made.has_value());
    EXPECT_EQ(cube.report.rank, 37);
    faces.push_back(tilt_rms(truth, *cube.made));
    const Fit large = fit_of(d, at_random(truth, 100, kLow_degc, kHigh_degc, noise), options_of(3));
    ASSERT_TRUE(large.made.has_value());
    EXPECT_EQ(large.report.rank, 37);
    hundred.push_back(tilt_rms(truth, *large.made));
  }
  std::sort(six.begin(), six.end());
  std::sort(faces.begin(), faces.end());
  std::sort(hundred.begin(), hundred.end());
  EXPECT_LE(six[kRuns / 2], 0.50e-3);
  EXPECT_LE(faces[kRuns / 2], 0.22e-3);
  EXPECT_LE(hundred[kRuns / 2], 0.15e-3);
}

TEST(TemperatureFit, SettlesInSixStepsWhateverTheTool) {
  plumb::AxisList four{}, six{};
  plumb::paper_tetrahedron(four);
  const int n6 = plumb::cone_with_axis(six, 6);
  const plumb::Datasheet sheets[] = {sheet_of(four, 3), sheet_of(four, 4), sheet_of(six, n6)};
  for (const plumb::Datasheet& d : sheets) {
    for (std::uint64_t run = 0; run < 40; ++run) {
      Noise noise(4000 + run);
      const Truth truth = temperature_test::draw_truth(d, noise);
      plumb::TemperatureOptions options = options_of(3);
      options.fit.estimate_misfit = false;
      const Fit f = fit_of(d, on_levels(truth, levels_of(4), noise), options);
      ASSERT_TRUE(f.made.has_value()) << d.size << " sensors, run " << run;
      EXPECT_EQ(f.figures.stop, plumb::StopReason::converged);
      EXPECT_LE(f.report.iterations, d.size == 3 ? 7 : 6);
    }
  }
}

TEST(TemperatureFit, CoefficientsLieWithinTheirSigmas) {
  const plumb::Datasheet d = paper_sheet();
  int beyond = 0, count = 0;
  std::array<double, 8> square{};
  constexpr int kRuns = 60;
  for (int run = 0; run < kRuns; ++run) {
    Noise noise(5000 + static_cast<std::uint64_t>(run));
    const Truth truth = temperature_test::draw_truth(d, noise);
    const Fit f = fit_of(d, on_levels(truth, levels_of(4), noise), options_of(3));
    ASSERT_TRUE(f.made.has_value());
    for (int i = 0; i < d.size; ++i) {
      const plumb::SensorCoefficients &told = f.made->model.sensor[at(i)], &real = truth.model.sensor[at(i)];
      for (std::size_t k = 0; k < 4; ++k) {
        const plumb::TemperatureCoefficient &scale = f.report.sensor[at(i)].scale[k],
                                            &bias = f.report.sensor[at(i)].bias[k];
        EXPECT_NEAR(scale.value, told.scale[k], 1e-12 * std::fabs(told.scale[k]) + 1e-20);
        EXPECT_NEAR(bias.value, told.bias[k], 1e-11 * std::fabs(told.bias[k]) + 1e-16);
        EXPECT_GE(scale.data_share, 0.0);
        EXPECT_LE(scale.data_share, 1.0);
        const double z_scale = (scale.value - real.scale[k]) / scale.sigma;
        const double z_bias = (bias.value - real.bias[k]) / bias.sigma;
        square[k] += z_scale * z_scale / (kRuns * d.size);
        square[4 + k] += z_bias * z_bias / (kRuns * d.size);
        beyond += (std::fabs(z_scale) > 4.0 ? 1 : 0) + (std::fabs(z_bias) > 4.0 ? 1 : 0);
        count += 2;
      }
    }
  }
  EXPECT_LE(beyond, count / 100);
  for (const double s : square) {
    EXPECT_GE(s, 0.7);  // 240 values of z^2 scatter by 9 %; each tool has one frame and one prior
    EXPECT_LE(s, 1.35);
  }
}

/// The uncertainty that the calibration carries covers every temperature of the span, and 5 degC beyond.
TEST(TemperatureFit, CarriesAnUncertaintyForTheWholeSpan) {
  const plumb::Datasheet d = paper_sheet();
  const std::vector<double> degc = {15.0, 20.0, 40.0, 63.0, 85.0, 107.0, 130.0, 150.0, 155.0};
  std::vector<double> square(degc.size());
  constexpr int kRuns = 50;
  double inflation = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Noise noise(6000 + static_cast<std::uint64_t>(run)), none(0);
    const Truth truth = temperature_test::draw_truth(d, noise);
    const Fit f = fit_of(d, on_levels(truth, levels_of(4), noise), options_of(3));
    ASSERT_TRUE(f.made.has_value());
    inflation += f.report.inflation / kRuns;
    const plumb::ParityBasis parity = plumb::parity_basis(f.made->array, f.made->array.all());
    for (std::size_t t = 0; t < degc.size(); ++t) {
      for (const Vec3& g : icosahedron()) {
        const plumb::Station s = station_at(truth, g, degc[t], none, 0.0);
        const plumb::Readings y = f.made->model.apply(s.mean, degc[t], s.delivered);
        double value = 0.0, variance = 0.0;
        for (int i = 0; i < d.size; ++i) {
          value += parity.weight[0][at(i)] * y[at(i)];
          for (int j = 0; j < d.size; ++j) {
            variance += parity.weight[0][at(i)] * parity.weight[0][at(j)] * f.made->array.uncertainty().at(i, j, g);
          }
        }
        square[t] += value * value / variance / (12.0 * kRuns);
      }
    }
  }
  for (std::size_t t = 0; t < degc.size(); ++t) EXPECT_LE(square[t], 1.05) << degc[t] << " degC";
  // Without the inflation it would not.
  EXPECT_GT(inflation, 1.2);
  EXPECT_GT(*std::max_element(square.begin(), square.end()) * inflation, 1.05);
}

TEST(TemperatureFit, RejectsASpoiledReading) {
  const plumb::Datasheet d = paper_sheet();
  Noise noise(71);
  const Truth truth = temperature_test::draw_truth(d, noise);
  auto stations = on_levels(truth, levels_of(4), noise);
  stations[17].mean[2] += 0.05 * 3.0;  // 50 mg0
  const Fit f = fit_of(d, stations, options_of(3));
  ASSERT_TRUE(f.made.has_value());
  ASSERT_EQ(f.figures.outliers, 1);
  EXPECT_EQ(f.figures.outlier[0].station, 17);
  EXPECT_EQ(f.figures.outlier[0].sensor, 2);
  EXPECT_EQ(f.figures.stations, 47);
  EXPECT_LE(tilt_rms(truth, *f.made), 0.3e-3);
  plumb::TemperatureOptions keep = lenient(3);
  const Fit spoiled = fit_of(d, stations, keep);
  ASSERT_TRUE(spoiled.made.has_value());
  EXPECT_GT(tilt_rms(truth, *spoiled.made), 1e-3);
}

TEST(TemperatureFit, FindsNoiseThatTheDatasheetDoesNotKnow) {
  const plumb::Datasheet d = paper_sheet(0.25 * kSigma_mps2);
  Noise noise(72);
  const Truth truth = temperature_test::draw_truth(d, noise);
  const Fit f = fit_of(d, on_levels(truth, levels_of(4), noise), options_of(3));
  ASSERT_TRUE(f.made.has_value());
  EXPECT_NEAR(f.figures.misfit_mps2, kSigma_mps2, 0.25 * kSigma_mps2);
  EXPECT_LT(f.figures.p_value, 1e-6);
}

TEST(TemperatureFit, BothSensesOfTheSensorsAreOneCalibration) {
  Noise noise(73), again(73);
  plumb::Datasheet down = paper_sheet(), up = paper_sheet();
  up.reads = plumb::Reads::specific_force;
  for (int i = 0; i < 4; ++i) {
    up.sensor[at(i)].coefficients.bias = {-0.02, -3e-4, 1e-7, 0.0};
    down.sensor[at(i)].coefficients.bias = {0.02, 3e-4, -1e-7, 0.0};
  }
  const Truth truth = temperature_test::draw_truth(down, noise);
  const auto stations = on_levels(truth, levels_of(4), noise);
  auto turned = stations;
  for (auto& s : turned) {
    for (double& v : s.mean) v = -v;
  }
  const Fit a = fit_of(down, stations, options_of(3)), b = fit_of(up, turned, options_of(3));
  ASSERT_TRUE(a.made.has_value() && b.made.has_value());
  for (int i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(a.made->model.sensor[at(i)].bias[k], -b.made->model.sensor[at(i)].bias[k], 1e-12);
      EXPECT_NEAR(a.made->model.sensor[at(i)].scale[k], b.made->model.sensor[at(i)].scale[k], 1e-12);
    }
  }
  EXPECT_LE(tilt_rms(truth, *a.made), 0.3e-3);
}

TEST(TemperatureFit, OfOneLevelIsTheFitAtOneTemperature) {
  const plumb::Datasheet d = paper_sheet();
  Noise noise(74);
  const Truth truth = temperature_test::draw_truth(d, noise);
  auto stations = on_levels(truth, {60.0}, noise);
  for (std::size_t k = 0; k < stations.size(); ++k) stations[k].temperature_degc += 0.5 * static_cast<double>(k);
  const Fit f = fit_of(d, stations, options_of(plumb::kAutomaticOrder));
  const auto plain = plumb::calibrate(d, calibration_test::standard_gravity(), stations.data(), 12);
  ASSERT_TRUE(f.made.has_value() && plain.has_value());
  EXPECT_EQ(f.report.order, 0);
  EXPECT_EQ(f.report.rank, 13);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(f.made->model.sensor[at(i)].bias, plain->model.sensor[at(i)].bias);
    EXPECT_EQ(f.made->array.axis(i), plain->array.axis(i));
  }
  EXPECT_EQ(f.made->array.uncertainty().covariance, plain->array.uncertainty().covariance);
}

TEST(TemperatureFit, ForecastGrowsWhereNothingWasRecorded) {
  const plumb::Datasheet d = paper_sheet();
  Noise noise(75);
  const Truth truth = temperature_test::draw_truth(d, noise);
  const Fit near = fit_of(d, at_random(truth, 100, 20.0, 150.0, noise), options_of(3));
  const Fit far = fit_of(d, at_random(truth, 100, 20.0, 60.0, noise), options_of(3));
  ASSERT_TRUE(near.made.has_value() && far.made.has_value());
  EXPECT_EQ(far.report.rank, 37);
  EXPECT_GT(far.report.condition, 1000.0);
  EXPECT_LT(near.report.condition, 30.0);
  EXPECT_EQ(far.report.forecast[2].degc, 150.0);
  EXPECT_GT(far.report.forecast[2].tilt_rad, 10.0 * near.report.forecast[2].tilt_rad);
  EXPECT_LT(far.report.forecast[0].tilt_rad, 2.0 * near.report.forecast[0].tilt_rad);
  EXPECT_GT(far.report.forecast[2].reading_mps2, 10.0 * far.report.forecast[0].reading_mps2);
}

}  // namespace
}  // namespace temperature_fit_test
