// Commissioning of an array from simulated flights whose truth is known.
#include "plumb/commission/array_commission.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "plumb/scenario/flight.hpp"

namespace array_commission_test {
namespace {

using namespace plumb;
using namespace plumb::commission;

constexpr double kGyroNoise_radps = 0.0017;
constexpr double kFilterDelay_hz = 0.22508;  // of the simulator's filter: this over its bandwidth

/// As a file states it: healthy sensors are within these.
struct Stated {
  double scale = 1e-3, axis_rad = 1.5e-3, bias_mps2 = 9.8e-3, lag_s = 70e-6, rectification = 2e-5;
};

enum class Shape { three_chips, cone };

struct Flown {
  ArrayOnBoard on_board;
  std::vector<MotionSample> samples;
  std::vector<Vec3> arm_m;  ///< true
  std::vector<double> lag_s, rectification;
};

std::vector<Vec3> axes_of(Shape shape) {
  std::vector<Vec3> out;
  for (int i = 0; shape == Shape::cone && i < 6; ++i) {
    const double a = kPi * i / 3.0;
    out.push_back({0.8 * std::cos(a), 0.8 * std::sin(a), 0.6});
  }
  for (int i = 0; shape == Shape::three_chips && i < 9; ++i)
    out.push_back({i % 3 == 0 ? 1.0 : 0.0, i % 3 == 1 ? 1.0 : 0.0, i % 3 == 2 ? 1.0 : 0.0});
  return out;
}

std::vector<Vec3> arms_of(Shape shape) {
  const Vec3 chip[] = {{0.025, 0.0, 0.0}, {-0.0125, 0.0217, 0.0}, {-0.0125, -0.0217, 0.0}};
  std::vector<Vec3> out;
  for (int i = 0; i < 9 && shape == Shape::three_chips; ++i) out.push_back(chip[i / 3]);
  for (int i = 0; i < 6 && shape == Shape::cone; ++i)
    out.push_back({0.03 * std::cos(1.3 * i), 0.03 * std::sin(1.3 * i), 0.01 * (i % 3 - 1)});
  return out;
}

scenario::FlightSpec spec_of(Shape shape, std::uint64_t seed, scenario::FlightKind kind) {
  const Stated stated;
  scenario::FlightSpec out;
  out.kind = kind;
  out.seed = seed;
  out.axis = axes_of(shape);
  out.lever_arm_m = arms_of(shape);
  out.gyros = 2;
  out.gyro_noise_radps = kGyroNoise_radps;
  out.box.axis_rad = stated.axis_rad / std::sqrt(2.0);
  out.box.bias_mps2 = stated.bias_mps2;
  out.box.lever_m = 0.0;
  out.box.rectification = 0.5 * stated.rectification;
  return out;
}

/// Stated arms are wrong by up to 10 mm along each axis, and no bound of them is stated.
Flown fly(Shape shape, std::uint64_t seed, double duration_s, scenario::FlightKind kind = scenario::FlightKind::drone) {
  const Stated stated;
  const scenario::FlightSpec spec = spec_of(shape, seed, kind);
  scenario::Flight flight(spec);
  Flown out;
  const int n = static_cast<int>(spec.axis.size());
  std::mt19937 random(static_cast<unsigned>(977 * seed + 5));
  const auto wrong = [&random] { return 0.01 * (static_cast<double>(random()) / 2147483648.0 - 1.0); };
  std::vector<SensorRow> rows;
  Vec3 off{};
  MotionSetup& setup = out.on_board.setup;
  setup.gyros = 2;
  setup.gyro = {0.01, 0.01, 0.006, kGyroNoise_radps, 2e-5};
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    rows.push_back({make_id(("s" + std::to_string(i)).c_str()), spec.axis[k], spec.noise_mps2,
                    shape == Shape::cone ? std::uint8_t{0} : static_cast<std::uint8_t>(i / 3 + 1)});
    if (shape == Shape::cone || i % 3 == 0) off = {wrong(), wrong(), wrong()};
    setup.lever_arm_m[k] = plus(spec.lever_arm_m[k], off);
    setup.errors[k] = {0.0, 0.0, 0.0, stated.scale, stated.axis_rad, stated.bias_mps2};
    out.on_board.lever_bound_m[k] = -1.0;
    out.on_board.lag_bound_s[k] = stated.lag_s;
    out.on_board.rectification_bound[k] = stated.rectification;
    const scenario::FlightSensorErrors& e = flight.errors()[k];
    out.arm_m.push_back(plus(spec.lever_arm_m[k], e.lever_error_m));
    out.lag_s.push_back(e.skew_s + e.bandwidth * kFilterDelay_hz / spec.bandwidth_hz);
    out.rectification.push_back(e.rectification);
  }
  out.on_board.array = *SensorArray::make(rows.data(), n);
  for (int k = 0; k < static_cast<int>(duration_s * spec.rate_hz); ++k) {
    const scenario::FlightSample flown = flight.next();
    MotionSample& sample = out.samples.emplace_back();
    sample.time_s = flown.time_s;
    sample.delivered = out.on_board.array.all();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      sample.reading_mps2[i] = flown.reading_mps2[i];
      if (std::fabs(flown.reading_mps2[i]) >= spec.full_scale_mps2)
        sample.clipped = sample.clipped.with(static_cast<int>(i));
    }
    for (std::size_t g = 0; g < 2; ++g) {
      sample.rate_radps[g] = flown.rate_radps[g];
      sample.rate_given[g] = true;
    }
  }
  return out;
}

ArrayFit fitted(const Flown& flown) {
  const ArrayFitSettings settings;
  const ArrayPairs pairs(flown.on_board, flown.samples, 0, flown.samples.size(), settings.scale);
  const CommissionExpected<ArrayFit> fit = fit_array(flown.on_board, pairs, settings);
  if (!fit) throw std::runtime_error(fit.error());
  return *fit;
}

Vec3 mean_of(const std::vector<Vec3>& all) {
  Vec3 out{};
  for (const Vec3& one : all) out = plus(out, scaled(one, 1.0 / static_cast<double>(all.size())));
  return out;
}

/// What the arms are off by, from the reference point that the fit has chosen.
std::vector<Vec3> arm_errors(const Flown& flown, const ArrayBounds& bounds) {
  std::vector<Vec3> out;
  for (std::size_t k = 0; k < flown.arm_m.size(); ++k) out.push_back(minus(bounds.lever_arm_m[k], flown.arm_m[k]));
  const Vec3 mean = mean_of(out);
  for (Vec3& one : out) one = minus(one, mean);
  return out;
}

// Verifies: REQ-208
TEST(ArrayCommission, ArmsOfChipsAreFoundAndBoundsHoldInTwentyFlights) {
  int beyond_three_sigma = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Flown flown = fly(Shape::three_chips, seed, 10.0);
    const ArrayFit fit = fitted(flown);
    const ArrayBounds bounds = bounds_of(flown.on_board, fit, flown.samples);
    const std::vector<Vec3> off = arm_errors(flown, bounds);
    double mean_lag_s = 0.0;
    for (const double lag_s : flown.lag_s) mean_lag_s += lag_s / 9.0;
    for (std::size_t k = 0; k < 9; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_FALSE(fit.arm_m[k][c].open) << seed;
        EXPECT_LT(std::fabs(off[k][c]), 1e-3) << seed;
        EXPECT_LE(std::fabs(off[k][c]), bounds.lever_m[k]) << seed;
        beyond_three_sigma += std::fabs(off[k][c]) > kBoundSigmas * fit.arm_m[k][c].sigma ? 1 : 0;
      }
      EXPECT_LE(std::fabs(flown.rectification[k]), bounds.rectification[k]) << seed;
      EXPECT_LE(std::fabs(flown.lag_s[k] - mean_lag_s), bounds.lag_s[k]) << seed;
    }
    EXPECT_LT(2.0 * fit.residual_mps2, fit.residual_before_mps2) << "arms that are 10 mm wrong show";
    EXPECT_LT(fit.residual_mps2, 1e-2) << "20 mm/s^2 are 2.9e-3 in such a pair, and vibration adds to that";
  }
  EXPECT_LE(beyond_three_sigma, 3) << "of 540";
}

TEST(ArrayCommission, BoundsOfSingleSensorsHoldInTwentyFlights) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Flown flown = fly(Shape::cone, seed, 20.0);
    const ArrayFit fit = fitted(flown);
    const ArrayBounds bounds = bounds_of(flown.on_board, fit, flown.samples);
    const std::vector<Vec3> off = arm_errors(flown, bounds);
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(std::fabs(off[k][c]), bounds.lever_m[k]) << seed;
    }
    EXPECT_EQ(fit.gauge, 4);
    EXPECT_EQ(fit.parameters, 3 * 6 + 6 + 6);
  }
}

TEST(ArrayCommission, TheMeansOfCorrectionsAndLagsAreZero) {
  const ArrayFit fit = fitted(fly(Shape::three_chips, 3, 10.0));
  Vec3 arm{};
  double lag_s = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    for (std::size_t c = 0; c < 3; ++c) arm[c] += fit.arm_m[k][c].value;
    lag_s += fit.lag_s[k].value;
  }
  EXPECT_LT(norm(arm), 1e-12);
  EXPECT_LT(std::fabs(lag_s), 1e-15);
}

/// A flight in which nothing turns, by its own accelerations.
Flown without_rotation(bool arms_stated) {
  Flown out = fly(Shape::three_chips, 5, 0.0);
  std::mt19937 random(7);
  const auto noise = [&random](double sigma) {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(random()) / 4294967296.0;
    return sigma * sum;
  };
  for (double& bound : out.on_board.lever_bound_m) bound = arms_stated ? 2e-3 : -1.0;
  for (int k = 0; k < 10000; ++k) {
    const double t_s = 1e-3 * k;
    const Vec3 force{4.0 * std::sin(9.0 * t_s), 5.0 * std::sin(7.0 * t_s + 1.0), 9.8 + 3.0 * std::sin(11.0 * t_s)};
    MotionSample& sample = out.samples.emplace_back();
    sample.time_s = t_s;
    sample.delivered = out.on_board.array.all();
    for (std::size_t i = 0; i < 9; ++i) sample.reading_mps2[i] = force[i % 3] + noise(0.02);
    for (std::size_t g = 0; g < 2; ++g) {
      sample.rate_radps[g] = {noise(kGyroNoise_radps), noise(kGyroNoise_radps), noise(kGyroNoise_radps)};
      sample.rate_given[g] = true;
    }
  }
  return out;
}

// Verifies: REQ-208
TEST(ArrayCommission, WithoutRotationAllArmsAreOpenAndStatedOnesStay) {
  for (const bool stated : {false, true}) {
    const Flown flown = without_rotation(stated);
    const ArrayFit fit = fitted(flown);
    const ArrayBounds bounds = bounds_of(flown.on_board, fit, flown.samples);
    for (std::size_t k = 0; k < 9; ++k) {
      for (std::size_t c = 0; c < 3; ++c) EXPECT_TRUE(fit.arm_m[k][c].open) << k;
      if (!stated) continue;
      EXPECT_EQ(bounds.lever_arm_m[k], flown.on_board.setup.lever_arm_m[k]);
      EXPECT_EQ(bounds.lever_m[k], 2e-3);
    }
    EXPECT_LE(fit.rank, fit.parameters - fit.gauge - 6);
  }
}

TEST(ArrayCommission, TheMonitorTakesTheBoundsAndAnotherFlightRaisesNoAlarm) {
  const Flown flown = fly(Shape::three_chips, 8, 30.0);
  std::vector<MotionSample> first(flown.samples.begin(), flown.samples.begin() + 15000);
  Flown half = flown;
  half.samples = first;
  const ArrayFit fit = fitted(half);
  const ArrayBounds bounds = bounds_of(half.on_board, fit, half.samples);
  MotionSetup setup = flown.on_board.setup, wrong = setup;
  for (std::size_t k = 0; k < 9; ++k) {
    setup.lever_arm_m[k] = bounds.lever_arm_m[k];
    setup.errors[k].lever_m = bounds.lever_m[k];
    setup.errors[k].lag_s = bounds.lag_s[k];
    setup.errors[k].rectification = bounds.rectification[k];
    wrong.errors[k] = setup.errors[k];
    wrong.errors[k].lever_m = 1e-3;
  }
  setup.gyro = wrong.gyro = bounds.gyro;
  EXPECT_EQ(lag_needed_s(flown.on_board.array, setup, flown.samples, 0, 15000), 0.0);
  const Replay healthy = replayed(flown.on_board.array, setup, flown.samples, 15000, 30000);
  EXPECT_FALSE(healthy.alarm);
  EXPECT_GT(healthy.judged, 14990U);
  EXPECT_TRUE(replayed(flown.on_board.array, wrong, flown.samples, 15000, 30000).alarm) << "arms 10 mm off";
  std::vector<MotionSample> faulty = flown.samples;
  for (std::size_t k = 20000; k < faulty.size(); ++k) {
    for (std::size_t i = 3; i < 6; ++i) faulty[k].reading_mps2[i] += 0.1 * kG0_mps2;
  }
  const Replay seen = replayed(flown.on_board.array, setup, faulty, 15000, 30000);
  EXPECT_EQ(seen.isolated, SensorSet{}.with(3).with(4).with(5));
}

TEST(ArrayCommission, ALagThatNoBoundCoversIsMeasuredAndAFaultIsNot) {
  Flown flown = fly(Shape::three_chips, 2, 6.0);
  MotionSetup setup = flown.on_board.setup;
  for (std::size_t k = 0; k < 9; ++k) {
    setup.lever_arm_m[k] = flown.arm_m[k];
    setup.errors[k].lever_m = 2e-4;
    setup.errors[k].rectification = 2e-5;
  }
  for (std::size_t k = flown.samples.size() - 1; k > 0; --k)
    flown.samples[k].reading_mps2[4] = flown.samples[k - 1].reading_mps2[4];
  const double needed_s = lag_needed_s(flown.on_board.array, setup, flown.samples, 0, flown.samples.size());
  EXPECT_GT(needed_s, 1e-4);
  EXPECT_LT(needed_s, 1e-3) << "a sample";
  for (std::size_t k = 3000; k < flown.samples.size(); ++k) flown.samples[k].reading_mps2[4] = 0.0;
  EXPECT_LT(lag_needed_s(flown.on_board.array, setup, flown.samples, 0, flown.samples.size()), 0.0);
}

TEST(ArrayCommission, NoiseOfTheGyrosAndScatterAreMeasured) {
  const Flown flown = fly(Shape::three_chips, 4, 5.0);
  EXPECT_NEAR(gyro_noise_radps(flown.samples, 2), kGyroNoise_radps, 0.1 * kGyroNoise_radps);
  EXPECT_GE(gyro_noise_radps(flown.samples, 1), 0.9 * kGyroNoise_radps) << "with what it turns";
  EXPECT_GT(scatter_in_sigmas(flown.on_board.array, flown.samples), 0.9);
  std::vector<MotionSample> filtered = flown.samples;
  for (std::size_t k = 8; k < filtered.size(); ++k) {
    for (std::size_t i = 0; i < 9; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < 8; ++j) sum += flown.samples[k - j].reading_mps2[i];
      filtered[k].reading_mps2[i] = sum / 8.0;
    }
  }
  EXPECT_LT(scatter_in_sigmas(flown.on_board.array, filtered), 0.5);
}

TEST(ArrayCommission, TooFewPairsAreRefusedWithTheirNumber) {
  const Flown flown = fly(Shape::three_chips, 1, 0.5);
  const ArrayPairs pairs(flown.on_board, flown.samples, 0, flown.samples.size(), 2);
  const CommissionExpected<ArrayFit> fit = fit_array(flown.on_board, pairs);
  ASSERT_FALSE(fit.has_value());
  EXPECT_NE(fit.error().find("has " + std::to_string(pairs.size())), std::string::npos) << fit.error();
  EXPECT_NE(fit.error().find("Remedy: record longer"), std::string::npos);
}

}  // namespace
}  // namespace array_commission_test
