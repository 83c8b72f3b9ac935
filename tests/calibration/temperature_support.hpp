/// Simulated tools whose scale factors and biases drift with temperature.
#pragma once

#include <memory>

#include "calibration/calibration_support.hpp"
#include "plumb/calibration/temperature_fit.hpp"

namespace temperature_test {

using calibration_test::at;
using calibration_test::Noise;
using plumb::Vec3;

inline constexpr double kSigma_mps2 = 2e-4 * plumb::kG0_mps2;
inline constexpr double kLow_degc = 20.0, kHigh_degc = 150.0;

/// Bounds of the coefficients, per degC^k: 100 ug0 and 200 ppm, and bends of a few tenths of what these make over the
/// span.
inline constexpr std::array<double, 3> kBiasDrift = {1e-4, 5e-7, 3e-9}, kScaleDrift = {2e-4, 1e-6, 6e-9};

/// A datasheet that knows nothing of temperature but how much there may be.
inline plumb::Datasheet sheet_of(const plumb::AxisList& axes, int n, double sigma_mps2 = kSigma_mps2) {
  plumb::Datasheet d = calibration_test::datasheet_of(axes, n, sigma_mps2);
  for (int i = 0; i < n; ++i) {
    d.sensor[at(i)].coefficients.scale = {3.0 / plumb::kG0_mps2, 0.0, 0.0, 0.0};
    d.sensor[at(i)].coefficients.bias = {0.02, 0.0, 0.0, 0.0};
    // As wide as `draw_truth` spreads.
    for (std::size_t k = 0; k < 3; ++k) {
      d.sensor[at(i)].prior.bias_t_mps2[k] = 0.577 * kBiasDrift[k] * plumb::kG0_mps2;
      d.sensor[at(i)].prior.scale_t[k] = 0.577 * kScaleDrift[k];
    }
  }
  return d;
}

inline plumb::Datasheet paper_sheet(double sigma_mps2 = kSigma_mps2) {
  plumb::AxisList axes{};
  const int n = plumb::paper_tetrahedron(axes);
  return sheet_of(axes, n, sigma_mps2);
}

/// What the sensors really are: axes, and cubics in T - 25 degC in the paper's form.
struct Truth {
  std::array<Vec3, plumb::kCapacity> axis{};
  plumb::SensorModel model;
};

inline Truth draw_truth(const plumb::Datasheet& d, Noise& noise, double drift = 1.0) {
  const calibration_test::Truth constant = calibration_test::draw_truth(d, noise);
  Truth t;
  t.model = d.model();
  for (int i = 0; i < d.size; ++i) {
    plumb::SensorCoefficients& c = t.model.sensor[at(i)];
    const double length = plumb::norm(constant.w[at(i)]);
    t.axis[at(i)] = plumb::scaled(constant.w[at(i)], 1.0 / length);
    c.scale[0] *= length;
    const double offset = constant.b[at(i)] * (d.reads == plumb::Reads::gravity ? 1.0 : -1.0);
    c.bias[0] = (c.bias[0] + offset) / length;
    for (std::size_t k = 0; k < 3; ++k) {
      c.bias[k + 1] += drift * noise.within(kBiasDrift[k] * plumb::kG0_mps2);
      c.scale[k + 1] += c.scale[0] * drift * noise.within(kScaleDrift[k]);
    }
  }
  return t;
}

inline plumb::Station station_at(const Truth& truth, const Vec3& gravity, double temperature_degc, Noise& noise,
                                 double sigma_mps2 = kSigma_mps2) {
  plumb::Readings r{};
  for (int i = 0; i < truth.model.size; ++i) {
    r[at(i)] = plumb::dot(truth.axis[at(i)], gravity) + sigma_mps2 * noise.normal();
  }
  plumb::Station s;
  const auto raw = truth.model.raw_from(r, temperature_degc);
  EXPECT_TRUE(raw.has_value());
  if (raw) s.mean = *raw;
  s.delivered = plumb::SensorSet::first(truth.model.size);
  s.temperature_degc = temperature_degc;
  s.count = 1;
  return s;
}

/// The twelve corners of an icosahedron, as gravity.
inline std::vector<Vec3> icosahedron() {
  const double a = std::sqrt((5.0 - std::sqrt(5.0)) / 10.0), b = std::sqrt((5.0 + std::sqrt(5.0)) / 10.0);
  std::vector<Vec3> out;
  for (const double s : {a, -a}) {
    for (const double l : {b, -b}) {
      out.push_back(plumb::scaled({s, l, 0.0}, plumb::kG0_mps2));
      out.push_back(plumb::scaled({0.0, s, l}, plumb::kG0_mps2));
      out.push_back(plumb::scaled({l, 0.0, s}, plumb::kG0_mps2));
    }
  }
  return out;
}

/// `levels` temperatures evenly spread over the span.
inline std::vector<double> levels_of(int levels, double low = kLow_degc, double high = kHigh_degc) {
  std::vector<double> out;
  for (int k = 0; k < levels; ++k) out.push_back(levels > 1 ? low + (high - low) * k / (levels - 1) : low);
  return out;
}

inline std::vector<plumb::Station> on_levels(const Truth& truth, const std::vector<double>& degc, Noise& noise,
                                             double sigma_mps2 = kSigma_mps2) {
  std::vector<plumb::Station> out;
  for (const double t : degc) {
    for (const Vec3& g : icosahedron()) out.push_back(station_at(truth, g, t, noise, sigma_mps2));
  }
  return out;
}

/// A fit with its memory and its reports.
struct Fit {
  std::unique_ptr<plumb::TemperatureWork> work = std::make_unique<plumb::TemperatureWork>();
  plumb::TemperatureReport report;
  plumb::FitReport figures;
  plumb::Expected<plumb::Calibration> made = plumb::fail(plumb::Errc::not_calibrated);
};

inline Fit fit_of(const plumb::Datasheet& d, const std::vector<plumb::Station>& stations,
                  const plumb::TemperatureOptions& options) {
  Fit out;
  std::vector<plumb::Station> scratch(stations.size());
  out.made = plumb::calibrate_over_temperature(d, calibration_test::standard_gravity(), stations.data(),
                                               static_cast<int>(stations.size()), options, scratch.data(), *out.work,
                                               &out.report, &out.figures);
  return out;
}

inline plumb::TemperatureOptions options_of(int order, double low = kLow_degc, double high = kHigh_degc) {
  plumb::TemperatureOptions out;
  out.order = order;
  out.use_degc = {low, high};
  return out;
}

/// rms angle between what the calibrated tool says without noise and the truth, over the sphere and over the span of
/// temperatures, one common rotation taken out.
inline double tilt_rms(const Truth& truth, const plumb::Calibration& c, double low = kLow_degc,
                       double high = kHigh_degc) {
  constexpr int kTemperatures = 14;
  const plumb::LeastSquares ls = plumb::least_squares(c.array, c.array.all());
  std::vector<Vec3> asked, said;
  Noise none(0);
  for (int t = 0; t < kTemperatures; ++t) {
    const double degc = low + (high - low) * t / (kTemperatures - 1);
    for (const Vec3& g : icosahedron()) {
      const plumb::Station s = station_at(truth, g, degc, none, 0.0);
      const Vec3 x = ls.estimate(c.model.apply(s.mean, degc, s.delivered));
      asked.push_back(plumb::scaled(g, 1.0 / plumb::norm(g)));
      said.push_back(plumb::scaled(x, 1.0 / plumb::norm(x)));
    }
  }
  calibration_test::turn_onto(said, asked);
  double square = 0.0;
  for (std::size_t k = 0; k < said.size(); ++k) {
    const double angle = plumb::angle_between_rad(said[k], asked[k]);
    square += angle * angle / static_cast<double>(said.size());
  }
  return std::sqrt(square);
}

}  // namespace temperature_test
