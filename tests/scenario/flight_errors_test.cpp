#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "flight_specs.hpp"

namespace plumb {
namespace scenario {
namespace flight_test {
namespace {

std::vector<double> values_of(const FlightSensorErrors& e) {
  return {
      e.scale,  e.axis_x_rad, e.axis_y_rad,   e.bias_mps2, e.lever_error_m[0], e.lever_error_m[1], e.lever_error_m[2],
      e.skew_s, e.bandwidth,  e.rectification};
}

TEST(FlightErrors, ErrorsAreAtTheVerticesOrBetween) {
  FlightSpec spec = spec_of(FlightKind::drone, 3, 24);
  spec.gyros = 2;
  const FlightErrorBox& b = spec.box;
  const std::vector<double> widths = {b.scale,   b.axis_rad, b.axis_rad, b.bias_mps2, b.lever_m,
                                      b.lever_m, b.lever_m,  b.skew_s,   b.bandwidth, b.rectification};
  const Flight inside(spec);
  spec.vertices = true;
  const Flight at(spec);
  for (std::size_t p = 0; p < widths.size(); ++p) {
    int above = 0;
    for (std::size_t i = 0; i < 24; ++i) {
      EXPECT_EQ(std::abs(values_of(at.errors()[i])[p]), widths[p]);
      EXPECT_LT(std::abs(values_of(inside.errors()[i])[p]), widths[p]);
      above += values_of(at.errors()[i])[p] > 0.0 ? 1 : 0;
    }
    EXPECT_GT(above, 2) << p;
    EXPECT_LT(above, 22) << p;
  }
  ASSERT_EQ(at.gyro_errors().size(), 2U);
  for (const FlightGyroErrors& e : at.gyro_errors()) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(std::abs(e.scale[k]), b.gyro_scale);
      EXPECT_EQ(std::abs(e.axis_x_rad[k]), b.gyro_axis_rad);
      EXPECT_EQ(std::abs(e.axis_y_rad[k]), b.gyro_axis_rad);
      EXPECT_EQ(std::abs(e.bias_radps[k]), b.gyro_bias_radps);
    }
    EXPECT_EQ(std::abs(e.skew_s), b.gyro_skew_s);
    EXPECT_EQ(std::abs(e.bandwidth), b.gyro_bandwidth);
  }
}

TEST(FlightErrors, ScaleAndBiasActOnTheReading) {
  FlightSpec spec = perfect_spec(FlightKind::drone, 4);
  const auto plain = fly(spec, 3000);
  spec.box.scale = 0.01;
  spec.box.bias_mps2 = 0.3;
  const auto wrong = fly(spec, 3000);
  const auto errors = Flight(spec).errors();
  for (std::size_t k = 0; k < plain.size(); ++k) {
    for (std::size_t i = 0; i < 8; ++i) {
      const double expected = (1.0 + errors[i].scale) * plain[k].reading_mps2[i] + errors[i].bias_mps2;
      ASSERT_NEAR(wrong[k].reading_mps2[i], expected, 1e-9);
    }
  }
}

TEST(FlightErrors, ASkewedSensorReadsWhatIsTrueThen) {
  FlightSpec spec = perfect_spec(FlightKind::drone, 4);
  const auto plain = fly(spec, 3002);
  spec.vertices = true;
  spec.box.skew_s = 1e-3;  // one sample
  const auto wrong = fly(spec, 3000);
  const auto errors = Flight(spec).errors();
  for (std::size_t k = 1; k < wrong.size(); ++k) {
    for (std::size_t i = 0; i < 8; ++i) {
      const double expected = plain[errors[i].skew_s > 0.0 ? k + 1 : k - 1].reading_mps2[i];
      ASSERT_NEAR(wrong[k].reading_mps2[i], expected, 1e-7);
    }
  }
}

// Against the cubic through four instants of the fine grid: straight lines would be off by 0.2 m/s^2.
TEST(FlightErrors, BetweenInstantsTheReadingIsSmooth) {
  const auto skewed = [](double instants) {
    FlightSpec spec = perfect_spec(FlightKind::drone, 4);
    spec.faults = {{FlightFaultKind::skew, SensorSet::first(8), instants * 125e-6, 0.0, 0.0}};
    return fly(spec, 3000);
  };
  const auto before = skewed(-1.0), first = skewed(0.0), half = skewed(0.5), second = skewed(1.0), after = skewed(2.0);
  for (std::size_t k = 0; k < half.size(); ++k) {
    for (std::size_t i = 0; i < 8; ++i) {
      const double near = first[k].reading_mps2[i] + second[k].reading_mps2[i];
      const double far = before[k].reading_mps2[i] + after[k].reading_mps2[i];
      ASSERT_NEAR(half[k].reading_mps2[i], (9.0 * near - far) / 16.0, 0.01);
    }
  }
}

TEST(FlightErrors, BandwidthAndLeverErrorsAreThoseOfAnotherSensor) {
  FlightSpec spec = perfect_spec(FlightKind::drone, 6);
  spec.vertices = true;
  spec.box.bandwidth = 0.02;
  spec.box.lever_m = 1e-3;
  const auto wrong = fly(spec, 3000);
  const auto errors = Flight(spec).errors();
  int compared = 0;
  for (const double sign : {-1.0, 1.0}) {
    FlightSpec other = perfect_spec(FlightKind::drone, 6);
    other.bandwidth_hz *= 1.0 + 0.02 * sign;
    for (std::size_t i = 0; i < 8; ++i) other.lever_arm_m[i] = plus(other.lever_arm_m[i], errors[i].lever_error_m);
    const auto as_built = fly(other, 3000);
    for (std::size_t i = 0; i < 8; ++i) {
      if (errors[i].bandwidth * sign < 0.0) continue;
      ++compared;
      for (std::size_t k = 0; k < wrong.size(); ++k) ASSERT_EQ(wrong[k].reading_mps2[i], as_built[k].reading_mps2[i]);
    }
  }
  EXPECT_EQ(compared, 8);
}

TEST(FlightErrors, ATurnedAxisMissesByItsAngle) {
  FlightSpec spec = perfect_spec(FlightKind::car, 6);
  spec.vibration = 0.0;
  const auto plain = fly(spec, 3000);
  spec.vertices = true;
  spec.box.axis_rad = 1e-3;
  const auto wrong = fly(spec, 3000);
  double worst = 0.0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    for (std::size_t i = 0; i < 8; ++i) {
      const double most = std::sqrt(2.0) * 1e-3 * norm(plain[k].specific_force_mps2);
      worst = std::max(worst, std::abs(wrong[k].reading_mps2[i] - plain[k].reading_mps2[i]) / most);
    }
  }
  EXPECT_LT(worst, 1.01);
  EXPECT_GT(worst, 0.8);
}

// Behind a filter of 8 kHz hardly anything of the vibration is missing, so that the mean square can be taken from the
// readings.
TEST(FlightErrors, VibrationIsRectifiedByItsMeanSquare) {
  for (const bool before : {false, true}) {
    FlightSpec spec = perfect_spec(FlightKind::drone, 7);
    spec.rate_hz = 8000.0;
    spec.bandwidth_hz = 8000.0;
    spec.rectifies_before_filter = before;
    const auto plain = fly(spec, 24000);
    spec.vertices = true;
    spec.box.rectification = 1e-3;
    const auto wrong = fly(spec, 24000);
    const auto errors = Flight(spec).errors();
    spec.vibration = 0.0;
    spec.box.rectification = 0.0;
    const auto smooth = fly(spec, 24000);
    for (std::size_t i = 0; i < 8; ++i) {
      double shift = 0.0, square = 0.0;
      for (std::size_t k = 16000; k < plain.size(); ++k) {
        shift += wrong[k].reading_mps2[i] - plain[k].reading_mps2[i];
        square += std::pow(plain[k].reading_mps2[i] - smooth[k].reading_mps2[i], 2.0);
      }
      EXPECT_NEAR(shift / (errors[i].rectification * square), 1.0, 0.05) << i;
    }
  }
}

TEST(FlightErrors, AnErrorlessGyroReadsTheTrueRate) {
  FlightSpec spec = perfect_spec(FlightKind::drone, 9);
  spec.gyros = 2;
  for (const FlightSample& s : fly(spec, 3000)) {
    EXPECT_EQ(s.rate_radps[0], s.true_rate_radps);
    EXPECT_EQ(s.rate_radps[1], s.true_rate_radps);
  }
  spec.gyros = 0;
  for (const FlightSample& s : fly(spec, 10)) EXPECT_EQ(s.rate_radps[0], Vec3{});
}

TEST(FlightErrors, ASkewedGyroReadsWhatIsTrueThen) {
  FlightSpec spec = perfect_spec(FlightKind::drone, 9);
  spec.gyros = 2;
  const auto plain = fly(spec, 3002);
  spec.vertices = true;
  spec.box.gyro_skew_s = 1e-3;  // one sample
  const auto wrong = fly(spec, 3000);
  const auto errors = Flight(spec).gyro_errors();
  for (std::size_t k = 1; k < wrong.size(); ++k) {
    EXPECT_EQ(wrong[k].reading_mps2, plain[k].reading_mps2);
    for (std::size_t g = 0; g < 2; ++g)
      EXPECT_EQ(wrong[k].rate_radps[g], plain[errors[g].skew_s > 0.0 ? k + 1 : k - 1].true_rate_radps);
  }
}

TEST(FlightErrors, AGyroOfAnotherBandwidthReadsAsOneOfThatFilter) {
  FlightSpec spec = perfect_spec(FlightKind::drone, 9);
  spec.vertices = true;
  spec.box.gyro_bandwidth = 0.02;
  const auto wrong = fly(spec, 3000);
  const double sign = Flight(spec).gyro_errors()[0].bandwidth;
  FlightSpec other = perfect_spec(FlightKind::drone, 9);
  other.bandwidth_hz *= 1.0 + sign;
  const auto as_built = fly(other, 3000);
  for (std::size_t k = 0; k < wrong.size(); ++k) EXPECT_EQ(wrong[k].rate_radps[0], as_built[k].rate_radps[0]);
}

TEST(FlightErrors, GyroErrorsStayWithinTheBox) {
  FlightSpec spec = spec_of(FlightKind::drone, 9);
  spec.box.gyro_skew_s = spec.box.gyro_bandwidth = 0.0;  // the bound below knows the rate of this instant alone
  spec.gyro_noise_radps = 0.0;
  spec.vertices = true;
  double worst = 0.0;
  for (const FlightSample& s : fly(spec, 10000)) {
    const double rate = norm(s.true_rate_radps);
    const double most = spec.box.gyro_bias_radps + 1.011 * (0.01 + std::sqrt(2.0) * 0.005) * rate;
    for (std::size_t k = 0; k < 3; ++k) {
      const double error = std::abs(s.rate_radps[0][k] - s.true_rate_radps[k]);
      ASSERT_LE(error, most);
      worst = std::max(worst, error / most);
    }
  }
  EXPECT_GT(worst, 0.6);
}

TEST(FlightErrors, NoiseHasItsSigma) {
  FlightSpec spec = spec_of(FlightKind::drone, 10);
  spec.box = FlightErrorBox::none();
  spec.full_scale_mps2 = 1000.0 * kG0_mps2;
  spec.noise_mps2 = 0.5;
  spec.gyro_noise_radps = 0.1;
  const auto noisy = fly(spec, 20000);
  spec.noise_mps2 = 0.0;
  const auto plain = fly(spec, 20000);
  double square = 0.0, rate_square = 0.0;
  for (std::size_t k = 0; k < noisy.size(); ++k) {
    square += std::pow(noisy[k].reading_mps2[3] - plain[k].reading_mps2[3], 2.0);
    rate_square += std::pow(noisy[k].rate_radps[0][2] - noisy[k].true_rate_radps[2], 2.0);
  }
  EXPECT_NEAR(std::sqrt(square / 20000.0), 0.5, 0.02);
  EXPECT_NEAR(std::sqrt(rate_square / 20000.0), 0.1, 0.004);
}

}  // namespace
}  // namespace flight_test
}  // namespace scenario
}  // namespace plumb
