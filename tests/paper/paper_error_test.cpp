/// The error that the paper's calibration minimises, and its derivatives, against direct evaluation and differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/bench.hpp"
#include "plumb/paper/paper_calibration.hpp"

namespace paper_error_test {
namespace {

using namespace calibration_test;
using plumb::PaperError;
using plumb::PaperParameters;
using plumb::SensorSet;

constexpr double kSigma = 2e-4 * plumb::kG0_mps2;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

plumb::Datasheet tool_of(int n, plumb::Reads reads = plumb::Reads::gravity) {
  plumb::AxisList axes{};
  const int made = n == 4 ? plumb::paper_tetrahedron(axes) : plumb::cone_with_axis(axes, n);
  plumb::Datasheet d = datasheet_of(axes, made, kSigma, reads);
  for (int i = 0; i < n; ++i) {
    plumb::SensorCoefficients& c = d.sensor[at(i)].coefficients;
    c.scale = {0.3 + 0.01 * i, 2e-5, -1e-7, 1e-9};
    c.bias = {0.02, -1e-3, 2e-5, 1e-7};
    c.reference_degc = 20.0 + i;
  }
  return d;
}

/// Parameters about two prior sigmas from the datasheet.
PaperParameters drawn_parameters(const PaperError& error, Noise& noise) {
  PaperParameters p = error.start();
  for (int k = 0; k < error.parameters(); ++k) p[at(k)] += 2.0 * error.prior()[at(k)] * noise.normal();
  return p;
}

std::vector<plumb::Station> drawn_stations(const plumb::Datasheet& d, int count, Noise& noise) {
  const Truth truth = draw_truth(d, noise);
  std::vector<plumb::Station> out;
  for (int k = 0; k < count; ++k) {
    const double temperature = 60.0 + noise.within(40.0);
    const Vec3 g = plumb::scaled(noise.direction(), plumb::kG0_mps2);
    out.push_back(station_at(d, truth, g, noise, kSigma, temperature));
  }
  return out;
}

PaperError error_of(const plumb::Datasheet& d, SensorSet used) {
  const auto error = PaperError::make(d, standard_gravity(), used);
  EXPECT_TRUE(error.has_value());
  return error.value_or(PaperError{});
}

/// Sets of three, four and eight sensors, with gaps.
struct Choice {
  int tool;
  SensorSet used;
};
std::vector<Choice> choices() {
  return {{4, SensorSet::first(4)}, {4, SensorSet(0b1101U)}, {8, SensorSet(0b11110101U)}, {8, SensorSet::first(8)}};
}

TEST(PaperError, AgreesWithTheModelAndLeastSquares) {
  Noise noise(11);
  for (const plumb::Reads reads : {plumb::Reads::gravity, plumb::Reads::specific_force}) {
    for (const Choice& choice : choices()) {
      const plumb::Datasheet d = tool_of(choice.tool, reads);
      const PaperError error = error_of(d, choice.used);
      const PaperParameters p = drawn_parameters(error, noise);
      const std::vector<plumb::Station> stations = drawn_stations(d, 12, noise);
      plumb::SensorModel model = d.model();
      error.store(p, model);
      const auto array = d.array();
      ASSERT_TRUE(array.has_value());
      const plumb::LeastSquares ls = plumb::least_squares(*array, choice.used);
      ASSERT_TRUE(ls.valid);
      double cost = 0.0;
      for (const plumb::Station& s : stations) {
        const Vec3 x = ls.estimate(model.apply(s.mean, s.temperature_degc, choice.used));
        const double direct = plumb::dot(x, x) - plumb::kG0_mps2 * plumb::kG0_mps2;
        EXPECT_NEAR(error(p, s), direct, 1e-10);
        cost += direct * direct / 12.0;
      }
      EXPECT_NEAR(error.cost(p, stations.data(), 12), cost, 1e-10 * cost);
    }
  }
}

TEST(PaperError, MapIsUnweightedWhateverTheNoise) {
  plumb::Datasheet d = tool_of(4);
  const auto even = d.array();
  d.sensor[0].row.sigma_mps2 *= 10.0;
  const auto uneven = d.array();
  ASSERT_TRUE(even.has_value() && uneven.has_value());
  Noise noise(12);
  const PaperError error = error_of(d, SensorSet::first(4));
  plumb::PaperFit fit;
  fit.used = SensorSet::first(4);
  fit.model = d.model();
  error.store(drawn_parameters(error, noise), fit.model);
  const std::vector<plumb::Station> stations = drawn_stations(d, 1, noise);
  const plumb::Station& s = stations[0];
  const Vec3 x = plumb::paper_vector(*uneven, fit, s.mean, s.temperature_degc);
  const Vec3 y = plumb::least_squares(*even, fit.used).estimate(fit.model.apply(s.mean, s.temperature_degc, fit.used));
  EXPECT_LE(plumb::norm(plumb::minus(x, y)), 1e-12);
  const Vec3 none = plumb::paper_vector(*uneven, plumb::PaperFit{}, s.mean, s.temperature_degc);
  EXPECT_EQ(plumb::norm(none), 0.0);
}

TEST(PaperError, GradientIsThatOfTheError) {
  Noise noise(13);
  for (const Choice& choice : choices()) {
    const plumb::Datasheet d = tool_of(choice.tool);
    const PaperError error = error_of(d, choice.used);
    const PaperParameters p = drawn_parameters(error, noise);
    PaperParameters gradient;
    for (const plumb::Station& s : drawn_stations(d, 5, noise)) {
      EXPECT_EQ(error(p, s), error(p, s, &gradient));
      for (int k = 0; k < error.parameters(); ++k) {
        const double h = 1e-4 * error.prior()[at(k)];
        PaperParameters up = p, down = p;
        up[at(k)] += h;
        down[at(k)] -= h;
        // Per prior sigma, so that one bound serves all parameters; errors are up to 200 (m/s^2)^2.
        const double difference = (error(up, s) - error(down, s)) / 2e-4;
        EXPECT_NEAR(gradient[at(k)] * error.prior()[at(k)], difference, 1e-7) << "parameter " << k;
      }
    }
  }
}

TEST(PaperError, CurvatureIsThatOfTheError) {
  Noise noise(14);
  for (const Choice& choice : choices()) {
    const plumb::Datasheet d = tool_of(choice.tool);
    const PaperError error = error_of(d, choice.used);
    const int n = error.parameters();
    const PaperParameters p = drawn_parameters(error, noise);
    for (const plumb::Station& s : drawn_stations(d, 3, noise)) {
      std::vector<double> curvature(at(n * n));
      error.add_curvature(p, s, -2.0, curvature.data());
      PaperParameters high, low;
      for (int k = 0; k < n; ++k) {
        const double h = 1e-4 * error.prior()[at(k)];
        PaperParameters up = p, down = p;
        up[at(k)] += h;
        down[at(k)] -= h;
        error(up, s, &high);
        error(down, s, &low);
        for (int a = k; a < n; ++a) {
          const double prior = error.prior()[at(a)];
          const double difference = prior * (high[at(a)] - low[at(a)]) / 2e-4;
          EXPECT_NEAR(-0.5 * curvature[at(a * n + k)] * prior * error.prior()[at(k)], difference, 1e-8)
              << a << ' ' << k;
        }
        for (int a = 0; a < k; ++a) EXPECT_EQ(curvature[at(a * n + k)], 0.0) << "above the diagonal";
      }
    }
  }
}

TEST(PaperError, RefusesWhatItCannotUse) {
  using plumb::Errc;
  const plumb::GravityReference g = standard_gravity();
  const auto refused = [](const plumb::Datasheet& d, const plumb::GravityReference& reference, SensorSet used,
                          Errc code, int index) {
    const auto error = PaperError::make(d, reference, used);
    ASSERT_FALSE(error.has_value());
    EXPECT_EQ(error.error().code, code);
    EXPECT_EQ(error.error().index, index);
  };
  plumb::Datasheet d = tool_of(4);
  refused(d, g, SensorSet(0b11U), Errc::too_few_sensors, -1);
  refused(d, g, SensorSet::first(9), Errc::too_many_sensors, -1);
  refused(d, g, SensorSet(0b10011U), Errc::out_of_range, 3);
  refused(d, {0.0, 0.0, plumb::GravityModel::value}, SensorSet::first(4), Errc::out_of_range, 4);
  refused(d, {kNan, 0.0, plumb::GravityModel::value}, SensorSet::first(4), Errc::out_of_range, 4);
  refused(d, {1e-101, 0.0, plumb::GravityModel::value}, SensorSet::first(4), Errc::out_of_range, 4);
  refused(d, {1e101, 0.0, plumb::GravityModel::value}, SensorSet::first(4), Errc::out_of_range, 4);
  d.sensor[2].prior.axis_rad = -0.01;
  refused(d, g, SensorSet::first(4), Errc::out_of_range, 5);
  EXPECT_TRUE(PaperError::make(d, g, SensorSet(0b1011U)).has_value()) << "what is not used does not matter";
  d = tool_of(4);
  d.sensor[1].coefficients.scale[0] = 0.0;
  refused(d, g, SensorSet::first(4), Errc::not_finite, 1);
  d = tool_of(4);
  d.sensor[3].prior.bias_mps2 = kNan;
  refused(d, g, SensorSet::first(4), Errc::not_finite, 3);
  d = tool_of(4);
  d.sensor[2].row.axis = d.sensor[1].row.axis;
  refused(d, g, SensorSet(0b1110U), Errc::axes_rank_deficient, -1);
  d.size = plumb::kCapacity + 1;
  refused(d, g, SensorSet::first(4), Errc::too_many_sensors, -1);
}

TEST(PaperError, VanishingScaleFactorIsNoReading) {
  const plumb::Datasheet d = tool_of(4);
  const PaperError error = error_of(d, SensorSet::first(4));
  Noise noise(15);
  const std::vector<plumb::Station> stations = drawn_stations(d, 3, noise);
  PaperParameters p = error.start();
  p[5] = 0.0;
  PaperParameters gradient;
  EXPECT_TRUE(std::isnan(error(p, stations[0], &gradient)));
  EXPECT_TRUE(std::isnan(error.cost(p, stations.data(), 3)));
  EXPECT_TRUE(std::isnan(error.cost(error.start(), stations.data(), 0)));
  EXPECT_TRUE(std::isnan(error.cost(error.start(), nullptr, 3)));
}

/// Stations that do not count, parameters at which nothing can be said: the sums are those of the rest, or none.
TEST(PaperError, StationsThatDoNotCountAreNotUsed) {
  Bench b;
  const auto error = PaperError::make(b.sheet, b.gravity, SensorSet::first(4));
  ASSERT_TRUE(error.has_value());
  const PaperParameters start = error->start();
  const double cost = error->cost(start, b.stations.data(), b.count());
  b.stations.push_back(b.stations[0]);
  b.stations.back().count = 0;
  EXPECT_EQ(error->cost(start, b.stations.data(), b.count()), cost);
  std::vector<double> matrix(400);
  PaperParameters gradient{};
  EXPECT_NEAR(error->gauss_newton(start, b.stations.data(), b.count(), matrix.data(), 20, gradient), cost, 1e-9 * cost);
  PaperParameters flat = start;
  flat[4] = 0.0;  // the scale factor of the first sensor
  std::vector<double> curvature(400, 7.0);
  error->add_curvature(flat, b.stations[0], 1.0, curvature.data());
  EXPECT_EQ(curvature, std::vector<double>(400, 7.0));
  PaperFit fit;
  PaperOptions plain;
  plain.step = PaperStep::plain_inverse;
  plain.max_iterations = 2;
  const auto done = paper_calibrate(b.sheet, b.gravity, b.stations.data(), b.count(), SensorSet::first(4), plain, fit);
  EXPECT_TRUE(done.has_value());
  PaperFit none;
  EXPECT_FALSE(
      paper_calibrate(b.sheet, b.gravity, b.stations.data() + 48, 1, SensorSet::first(4), {}, none).has_value() &&
      none.stop == StopReason::converged);
}

TEST(PaperError, OfAxesBeyondAllNumbersThereIsNone) {
  plumb::AxisList axes{};
  plumb::Datasheet sheet = datasheet_of(axes, plumb::orthogonal_triad(axes), kSigma);
  for (double& h : sheet.sensor[1].row.axis) h = 1e200;
  const auto made = PaperError::make(sheet, standard_gravity(), SensorSet::first(3));
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, plumb::Errc::axes_rank_deficient);
}

}  // namespace
}  // namespace paper_error_test
