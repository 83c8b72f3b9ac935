#include "plumb/scenario/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace plumb {
namespace scenario {
namespace noise_test {
namespace {

TEST(Noise, QuantisesToTheNearestStep) {
  EXPECT_EQ(quantised(1.26, 0.5), 1.5);
  EXPECT_EQ(quantised(-1.26, 0.5), -1.5);
  EXPECT_EQ(quantised(1.2, 0.5), 1.0);
  EXPECT_EQ(quantised(1.2, 0.0), 1.2) << "unknown resolution";
  EXPECT_TRUE(std::isnan(quantised(std::numeric_limits<double>::quiet_NaN(), 0.5)));
}

TEST(Noise, ClipsAtFullScale) {
  EXPECT_EQ(clipped(6.0, 5.0), 5.0);
  EXPECT_EQ(clipped(-6.0, 5.0), -5.0);
  EXPECT_EQ(clipped(4.0, 5.0), 4.0);
  EXPECT_EQ(clipped(6.0, 0.0), 6.0) << "unknown full scale";
  EXPECT_TRUE(std::isnan(clipped(std::numeric_limits<double>::quiet_NaN(), 5.0)));
}

TEST(Noise, ConverterDeliversFullScaleExactly) {
  DatasheetSensor sensor;
  sensor.full_scale_raw = 5.0;
  sensor.resolution_raw = 0.3;
  EXPECT_EQ(digitised(7.0, sensor, {}), 5.0);
  NoiseLaw ideal;
  ideal.quantise = false;
  ideal.clip = false;
  EXPECT_EQ(digitised(7.01, sensor, ideal), 7.01);
}

TEST(Noise, VibrationHasItsRmsOnEveryAxis) {
  const Stream stream(4, Purpose::vibration);
  constexpr int kRows = 100000;
  double square[3] = {};
  for (int k = 0; k < kRows; ++k) {
    const Vec3 a = vibration(stream, static_cast<std::uint64_t>(k), 2.0);
    for (std::size_t c = 0; c < 3; ++c) square[c] += a[c] * a[c];
  }
  for (const double s : square) EXPECT_NEAR(std::sqrt(s / kRows), 2.0, 2.0 * 4.0 / std::sqrt(2.0 * kRows));
}

}  // namespace
}  // namespace noise_test
}  // namespace scenario
}  // namespace plumb
