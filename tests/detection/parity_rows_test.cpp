// What a calibration leaves in parity over all attitudes: the bound, its quantile, and when the tighter one may be
// used.
#include "plumb/detection/detail/parity_rows.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "calibration/calibration_support.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/detection/set_test.hpp"
#include "plumb/numeric/symmetric_eigenvalues.hpp"
#include "plumb/numeric/tails.hpp"
#include "support/binomial_interval.hpp"
#include "support/long_run.hpp"
#include "threshold_support.hpp"

// Serves: REQ-052

namespace parity_rows_test {
namespace {

using namespace plumb;
using plumb_test::drawn;
using plumb_test::drawn_direction;

constexpr double kSigma = 2e-4 * kG0_mps2;

/// The array of a tool with `n` sensors, calibrated at `count` stations; `without_first`: so many stations lack
/// sensor 1.
SensorArray calibrated(int n, int count, std::uint64_t seed, int without_first = 0) {
  AxisList axes{};
  const Datasheet d =
      n == 4 ? calibration_test::paper_tool(kSigma)
             : calibration_test::datasheet_of(axes, n == 8 ? cone_with_axis(axes, 8) : cone(axes, n), kSigma);
  calibration_test::Noise noise(seed);
  const calibration_test::Truth truth = calibration_test::draw_truth(d, noise);
  std::vector<Station> stations = calibration_test::random_stations(d, truth, count, noise, kSigma);
  for (int k = 0; k < without_first; ++k)
    stations[static_cast<std::size_t>(k)].delivered = SensorSet::first(n).without(0);
  const auto fit = calibrate(d, plumb_test::kGravity, stations.data(), count);
  EXPECT_TRUE(fit.has_value());
  return fit ? fit->array : SensorArray();
}

/// Largest eigenvalue of V' C(u) V by itself.
double variance_at(const SensorArray& array, const Vec3& u) {
  const ParityBasis basis = parity_basis(array, array.all());
  const auto r = static_cast<std::size_t>(basis.rows);
  std::vector<double> square(r * r, 0.0), values(r);
  for (std::size_t k = 0; k < r; ++k) {
    for (std::size_t l = 0; l < r; ++l) {
      for (int i = 0; i < array.size(); ++i) {
        for (int j = 0; j < array.size(); ++j) {
          square[k * r + l] += basis.weight[k][static_cast<std::size_t>(i)] *
                               basis.weight[l][static_cast<std::size_t>(j)] *
                               array.uncertainty().of_parameters_at(i, j, AttitudeProducts(scaled(u, kG0_mps2)));
        }
      }
    }
  }
  EXPECT_TRUE(symmetric_eigenvalues(square.data(), basis.rows, basis.rows, values.data()));
  return values[r - 1];
}

/// Roy's root of `rows` x 4 normals below x, by de Bruijn's Pfaffian and Simpson's rule; an oracle of the table's.
class LargestRoot {
 public:
  explicit LargestRoot(int rows) : p_(std::min(4, rows)), m_(std::max(4, rows)), whole_(pfaffian(400.0 + 8.0 * rows)) {}
  double below(double x) const { return pfaffian(x) / whole_; }

 private:
  double shape(int i) const { return 0.5 * (m_ - p_ - 1) + 1.0 + i; }
  double density(int i, double y) const {
    return y > 0.0 ? std::exp((shape(i) - 1.0) * std::log(y) - y - std::lgamma(shape(i))) : 0.0;
  }
  double pfaffian(double x) const {
    constexpr int kSteps = 40000;
    const double step = std::sqrt(0.5 * x) / kSteps;  // y = s^2: the density of half a degree is smooth in s
    std::array<double, 4> below{};
    std::array<std::array<double, 4>, 4> twice{};
    const auto weight = [this](int i, double s) { return 2.0 * s * density(i, s * s); };
    for (int k = 0; k < kSteps; ++k) {
      const double a = k * step, b = a + 0.5 * step, c = a + step;
      std::array<double, 4> half{}, full{};
      for (int i = 0; i < p_; ++i) {
        const auto n = static_cast<std::size_t>(i);
        const double fa = weight(i, a), fb = weight(i, b), fc = weight(i, c);
        half[n] = below[n] + step / 24.0 * (5.0 * fa + 8.0 * fb - fc);
        full[n] = below[n] + step / 6.0 * (fa + 4.0 * fb + fc);
      }
      for (int i = 0; i < p_; ++i) {
        for (int j = 0; j < p_; ++j) {
          const auto n = static_cast<std::size_t>(i), o = static_cast<std::size_t>(j);
          twice[n][o] += step / 6.0 * (below[n] * weight(j, a) + 4.0 * half[n] * weight(j, b) + full[n] * weight(j, c));
        }
      }
      below = full;
    }
    const auto entry = [&](int i, int j) {
      if (j >= p_) return below[static_cast<std::size_t>(i)];
      const auto n = static_cast<std::size_t>(i), o = static_cast<std::size_t>(j);
      return 2.0 * twice[n][o] - below[n] * below[o];
    };
    if (p_ == 1) return below[0];
    if (p_ == 2) return entry(0, 1);
    return entry(0, 1) * entry(2, 3) - entry(0, 2) * entry(1, 3) + entry(0, 3) * entry(1, 2);
  }

  int p_, m_;
  double whole_;
};

TEST(RoysRoot, IsTheQuantileByQuadrature) {
  for (int rows = 1; rows <= kCapacity - 3; ++rows) {
    const double root = roys_root(rows);
    EXPECT_NEAR(LargestRoot(rows).below(root * root), 0.995, 2e-6) << rows;
  }
  EXPECT_NEAR(roys_root(1), std::sqrt(chi2_tail_quantile(0.005, 4)), 1e-6);
}

TEST(RoysRoot, IsExceededByOneMatrixInTwoHundred) {
  calibration_test::Noise noise(20);
  const int draws = plumb_test::long_run() ? 2'000'000 : 40'000;
  for (const int rows : {1, 2, 3, 5}) {
    int beyond = 0;
    for (int k = 0; k < draws; ++k) {
      std::array<double, 16> square{};
      for (int r = 0; r < rows; ++r) {
        std::array<double, 4> row{};
        for (double& w : row) w = noise.normal();
        for (std::size_t p = 0; p < 4; ++p) {
          for (std::size_t q = 0; q < 4; ++q) square[4 * p + q] += row[p] * row[q];
        }
      }
      std::array<double, 4> values{};
      ASSERT_TRUE(symmetric_eigenvalues(square.data(), 4, 4, values.data()));
      if (values[3] > roys_root(rows) * roys_root(rows)) ++beyond;
    }
    const auto interval = plumb_test::clopper_pearson(beyond, draws, 0.9999);
    EXPECT_LE(interval.low, 0.005) << rows;
    EXPECT_GE(interval.high, 0.005) << rows;
  }
}

RC_GTEST_PROP(LargestOverDirections, IsNotExceededAndReached, ()) {
  Mat3 a{};
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t q = 0; q <= p; ++q) a[3 * p + q] = a[3 * q + p] = drawn(-1.0, 1.0);
  }
  const double small = *rc::gen::element(1.0, 1e-3, 1e-9, 0.0);
  const Vec3 b = {small * drawn(-1.0, 1.0), small * drawn(-1.0, 1.0), small * drawn(-1.0, 1.0)};
  const double bound = largest_over_directions(a, b, 0.25);
  Vec3 u = drawn_direction();
  const auto value = [&](const Vec3& v) { return dot(v, times(a, v)) + 2.0 * dot(b, v) + 0.25; };
  double best = value(u);
  for (std::size_t start = 0; start < 6; ++start) {  // there may be two peaks, on opposite sides
    u = Vec3{};
    u[start / 2] = start % 2 == 0 ? 1.0 : -1.0;
    // Ascends: the shifted map is that of a convex function.
    for (int k = 0; k < 4000; ++k) {
      const Vec3 next = plus(plus(times(a, u), scaled(u, 4.0)), b);
      u = scaled(next, 1.0 / norm(next));
    }
    best = std::fmax(best, value(u));
  }
  RC_ASSERT(best <= bound + 1e-12);
  RC_ASSERT(best >= bound - 1e-4);
}

/// At no attitude is more left in parity than the bound says, and at some attitude nearly so much.
// Verifies: REQ-055
TEST(WorstParityVariance, IsNotExceededAtAnyAttitudeAndNearlyReached) {
  for (const int n : {4, 5, 6, 8}) {
    const SensorArray array = calibrated(n, 24, 70U + static_cast<std::uint64_t>(n));
    const double bound = worst_parity_variance(array, kG0_mps2);
    calibration_test::Noise noise(5);
    double most = 0.0;
    for (int k = 0; k < 4000; ++k) most = std::fmax(most, variance_at(array, noise.direction()));
    std::cout << "[ measured ] n = " << n << ": " << most << " of " << bound << ", alike " << parity_rows_alike(array)
              << '\n';
    EXPECT_LE(most, bound) << n;
    EXPECT_GE(most, 0.97 * bound) << n;
  }
}

// Negative: REQ-055
TEST(WorstParityVariance, AnUncertainGravityAtTheCalibrationDoesNotCount) {
  SensorArray array = calibrated(5, 24, 9);
  const double bound = worst_parity_variance(array, kG0_mps2);
  RowUncertainty left = array.uncertainty();
  EXPECT_GT(left.common_scale, 0.0);
  left.common_scale = 0.0;
  array.set_uncertainty(left);
  EXPECT_EQ(worst_parity_variance(array, kG0_mps2), bound);
}

TEST(ParityRowsAlike, AfterAFitOfAllSensorsAtEveryStationAndOnlyThen) {
  for (const int n : {5, 6, 8}) {
    EXPECT_TRUE(parity_rows_alike(calibrated(n, 24, 7))) << n;
    EXPECT_FALSE(parity_rows_alike(calibrated(n, 24, 7, 8)))
        << n << ", a sensor that delivered at two stations of three";
  }
  SensorArray array = calibrated(6, 24, 7);
  RowUncertainty left = array.uncertainty();
  left.covariance[0] *= 1.5;
  array.set_uncertainty(left);
  EXPECT_FALSE(parity_rows_alike(array)) << "one sensor is known less well";
  left.covariance[0] = std::numeric_limits<double>::quiet_NaN();
  array.set_uncertainty(left);
  EXPECT_FALSE(parity_rows_alike(array));
  EXPECT_TRUE(std::isinf(worst_parity_variance(array, kG0_mps2)));
}

/// The factor of rows alike is the smaller one, and used for such rows alone.
TEST(ParityRowsAlike, DecideWhichFactorHolds) {
  const TestLimits general = TestLimits::from_rates(6, 1e-5, 1e-6);
  EXPECT_NEAR(general.parity_calibration, std::sqrt(chi2_tail_quantile(0.005, 12)), 1e-12);
  EXPECT_NEAR(general.of(calibrated(6, 24, 7)).parity_calibration, kLikeRows * roys_root(3), 1e-12);
  EXPECT_EQ(general.of(calibrated(6, 24, 7)).of(calibrated(6, 24, 7, 8)).parity_calibration,
            general.parity_calibration);
}

/// Over many calibrations the parity error of the true array is within factor times root at all attitudes, but for 1 of
/// 200: neither factor may be smaller where it is used.
// Verifies: REQ-057
TEST(ParityRowsAlike, FittedToolsStayWithinTheFactorAtEveryAttitude) {
  const int tools = plumb_test::long_run() ? 4000 : 400;
  for (const int n : {4, 5, 6}) {
    int beyond = 0;
    AxisList axes{};
    const Datasheet d =
        n == 4 ? calibration_test::paper_tool(kSigma) : calibration_test::datasheet_of(axes, cone(axes, n), kSigma);
    const TestLimits general = TestLimits::from_rates(n, 1e-5, 1e-6);
    for (int tool = 0; tool < tools; ++tool) {
      calibration_test::Noise noise(90000U + static_cast<std::uint64_t>(10000 * n + tool));
      const calibration_test::Truth truth = calibration_test::draw_truth(d, noise);
      const std::vector<Station> stations = calibration_test::random_stations(d, truth, 24, noise, kSigma);
      const auto c = calibrate(d, calibration_test::standard_gravity(), stations.data(), 24);
      ASSERT_TRUE(c.has_value());
      const TestLimits limits = general.of(c->array);
      bool out = false;
      for (int k = 0; k < 300 && !out; ++k) {
        const Station s = calibration_test::station_at(d, truth, scaled(noise.direction(), kG0_mps2), noise, 0.0);
        BlockEvidence block;
        block.mean_mps2 = c->model.apply(s.mean, s.temperature_degc, s.delivered);
        block.usable = c->array.all();
        block.samples = 1.0;
        const SetTest t = test_set(c->array, calibration_test::standard_gravity(), limits, block, c->array.all());
        out = t.parity > t.parity_systematic;
      }
      beyond += out ? 1 : 0;
    }
    const auto interval = plumb_test::clopper_pearson(beyond, tools, 0.999);
    std::cout << "[ measured ] n = " << n << ": " << beyond << " of " << tools << " tools beyond at some attitude\n";
    EXPECT_LE(interval.low, 0.005) << n;
  }
}

}  // namespace
}  // namespace parity_rows_test
