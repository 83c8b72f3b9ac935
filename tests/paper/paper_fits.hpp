/// Scenes for the tests of the paper's fit, and its step by another way.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include "calibration/calibration_support.hpp"
#include "plumb/paper/paper_calibration.hpp"

namespace calibration_test {

using plumb::PaperFit;
using plumb::PaperOptions;
using plumb::PaperTrace;
using plumb::SensorSet;

inline constexpr double kSigma = 2e-4 * plumb::kG0_mps2;
inline const SensorSet kAll = SensorSet::first(4);

inline void tell(const std::string& name, double value) {
  testing::Test::RecordProperty(name, std::to_string(value));
  std::cout << "[ measured ] " << name << " = " << value << '\n';
}

struct FittedScene {
  plumb::Datasheet sheet;
  Truth truth;
  std::vector<plumb::Station> stations;
};

inline FittedScene scene_of(std::uint64_t seed, double sigma_mps2 = kSigma) {
  Noise noise(seed);
  FittedScene s;
  s.sheet = paper_tool(kSigma);
  s.truth = draw_truth(s.sheet, noise);
  s.stations = random_stations(s.sheet, s.truth, 48, noise, sigma_mps2);
  return s;
}

inline PaperFit fitted_by_paper(const FittedScene& s, SensorSet used, const PaperOptions& options = {},
                                PaperTrace* trace = nullptr) {
  PaperFit fit;
  const auto done = plumb::paper_calibrate(s.sheet, standard_gravity(), s.stations.data(),
                                           static_cast<int>(s.stations.size()), used, options, fit, trace);
  EXPECT_TRUE(done.has_value());
  return fit;
}

/// J'J in prior units, by the gradient alone.
inline std::vector<double> information(const plumb::PaperError& error, const plumb::PaperParameters& at_parameters,
                                       const FittedScene& s, std::vector<double>& slope) {
  const int n = error.parameters();
  std::vector<double> out(at(n * n));
  slope.assign(at(n), 0.0);
  plumb::PaperParameters gradient;
  for (const plumb::Station& station : s.stations) {
    const double e = error(at_parameters, station, &gradient);
    for (int a = 0; a < n; ++a) {
      gradient[at(a)] *= error.prior()[at(a)];
      slope[at(a)] += e * gradient[at(a)];
    }
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) out[at(a * n + b)] += gradient[at(a)] * gradient[at(b)];
    }
  }
  return out;
}

/// The eigenvalues of the whole matrix, and the step of rank nine that they give [prior units].
inline std::vector<double> reference_step(const plumb::PaperError& error, const plumb::PaperParameters& from,
                                          const FittedScene& s, std::vector<double>& values) {
  const int n = error.parameters();
  std::vector<double> slope, vectors(at(n * n)), step(at(n));
  std::vector<double> matrix = information(error, from, s, slope);
  values.assign(at(n), 0.0);
  EXPECT_TRUE(plumb::symmetric_eigen(matrix.data(), n, n, values.data(), vectors.data()));
  for (int v = n - plumb::kPaperRank; v < n; ++v) {
    double share = 0.0;
    for (int k = 0; k < n; ++k) share += vectors[at(k * n + v)] * slope[at(k)];
    for (int k = 0; k < n; ++k) step[at(k)] -= vectors[at(k * n + v)] * share / values[at(v)];
  }
  return step;
}

/// n sensors of a cone and its axis, at four temperatures.
inline FittedScene scene_of_many(int n, std::uint64_t seed, double sigma_mps2) {
  Noise noise(seed);
  FittedScene s;
  plumb::AxisList axes{};
  EXPECT_EQ(plumb::cone_with_axis(axes, n), n);
  s.sheet = datasheet_of(axes, n, kSigma);
  s.truth = draw_truth(s.sheet, noise);
  for (int k = 0; k < 60; ++k) {
    const Vec3 g = plumb::scaled(noise.direction(), plumb::kG0_mps2);
    s.stations.push_back(station_at(s.sheet, s.truth, g, noise, sigma_mps2, 25.0 + 10.0 * (k % 4)));
  }
  return s;
}

/// Stations from 20 to 150 degC of a tool that the paper's parameters describe exactly.
inline FittedScene scene_over_temperature(bool bias_drifts) {
  FittedScene s = scene_of(7);
  for (int i = 0; i < 4 && !bias_drifts; ++i) s.sheet.sensor[at(i)].coefficients.bias = {0.02, 0.0, 0.0, 0.0};
  const auto error = plumb::PaperError::make(s.sheet, standard_gravity(), kAll);
  EXPECT_TRUE(error.has_value());
  if (!error) return s;
  Noise noise(8);
  plumb::PaperParameters truth = error->start();
  for (int k = 0; k < error->parameters(); ++k) truth[at(k)] += 0.5 * error->prior()[at(k)] * noise.normal();
  plumb::SensorModel model = s.sheet.model();
  error->store(truth, model);
  EXPECT_NEAR(model.sensor[0].scale[1] / model.sensor[0].scale[0], 1e-5 / (3.0 / plumb::kG0_mps2), 1e-18);
  EXPECT_EQ(model.sensor[0].bias[1], bias_drifts ? 1e-3 : 0.0);
  for (plumb::Station& station : s.stations) {
    const Vec3 g = plumb::scaled(noise.direction(), plumb::kG0_mps2);
    plumb::Readings y{};
    for (int i = 0; i < 4; ++i) y[at(i)] = plumb::dot(s.sheet.sensor[at(i)].row.axis, g);
    station.temperature_degc = 85.0 + noise.within(65.0);
    const auto raw = model.raw_from(y, station.temperature_degc);
    EXPECT_TRUE(raw.has_value());
    if (raw) station.mean = *raw;
  }
  return s;
}

}  // namespace calibration_test
