// A flight of the array of a file: what it takes from it, and what it refuses.
#include <gtest/gtest.h>

#include <cmath>

#include "motion_support.hpp"
#include "plumb/session/flight_play.hpp"

namespace flight_play_test {
namespace {

using namespace plumb;
using namespace motion_support;
using plumb_test::with;

io::FileExpected<scenario::FlightSpec> spec_of(const std::string& text) {
  return session::flight_spec_of(array_of(text), {});
}

TEST(FlightPlay, ErrorsLieWithinTheBoundsOfTheFile) {
  const io::ArrayFile array = array_of(drone_text());
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    session::FlightRequest request;
    request.seed = seed;
    scenario::FlightSpec spec = *session::flight_spec_of(array, request);
    spec.vertices = true;
    const scenario::Flight flight(spec);
    const double delay_s = std::sqrt(2.0) / (2.0 * 3.141592653589793 * spec.bandwidth_hz);
    for (const scenario::FlightSensorErrors& e : flight.errors()) {
      EXPECT_LE(std::fabs(e.scale), 0.001 * 1.000001);
      EXPECT_LE(std::hypot(e.axis_x_rad, e.axis_y_rad), 0.0015 * 1.000001);
      EXPECT_LE(std::fabs(e.bias_mps2), 0.0098 * 1.000001);
      for (const double part : e.lever_error_m) EXPECT_LE(std::fabs(part), 0.001 * 1.000001);
      EXPECT_LE(std::fabs(e.skew_s) + std::fabs(e.bandwidth) * delay_s, 70e-6 * 1.000001);
      EXPECT_LE(e.rectification, 2e-5);
    }
    for (const scenario::FlightGyroErrors& e : flight.gyro_errors()) {
      EXPECT_LE(norm(e.bias_radps), 0.006 * 1.000001);
      EXPECT_LE(std::fabs(e.scale[0]), 0.01 * 1.000001);
    }
  }
}

TEST(FlightPlay, TakesRateNoiseAndFullScaleFromTheFile) {
  const auto spec = spec_of(with(drone_text(), "sample_period_s = 0.001", "sample_period_s = 0.002"));
  ASSERT_TRUE(spec.has_value());
  EXPECT_EQ(spec->rate_hz, 500.0);
  EXPECT_EQ(spec->noise_mps2, 0.02);
  EXPECT_NEAR(spec->full_scale_mps2, 156.9, 1e-9);
  EXPECT_EQ(spec->gyros, 2);
  EXPECT_EQ(spec->gyro_noise_radps, 0.0017);
}

TEST(FlightPlay, RefusesWhatItCannotFly) {
  EXPECT_EQ(spec_of(without_all("lever_arm_m", drone_text())).error().field, "sensor[1].lever_arm_m");
  EXPECT_EQ(spec_of(with(drone_text(), "[input]", "[input]\nrows = \"stations\"")).error().field, "input.rows");
  EXPECT_EQ(spec_of(with(drone_text(), "0.02 m/s^2", "0.03 m/s^2")).error().field, "sensor.noise");
  const auto slow = spec_of(with(drone_text(), "sample_period_s = 0.001", "sample_period_s = 0.01"));
  ASSERT_FALSE(slow.has_value());
  EXPECT_NE(slow.error().what.find("the rate must be 500 to 10000 Hz"), std::string::npos);
}

}  // namespace
}  // namespace flight_play_test
