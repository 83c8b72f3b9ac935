#include "plumb/render/monitor_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "plumb/numeric/tails.hpp"
#include "support/simulated_tool.hpp"

namespace monitor_limits_test {
namespace {

using namespace plumb;
using findings::monitor_limits;
using findings::MonitorLimits;
using render::limits_text;

constexpr double kSigma = 2e-4 * kG0_mps2;
const GravityReference kExact{kG0_mps2, 0.0, GravityModel::value};

/// Independent offsets of `s_mps2` that calibration left in every sensor.
SensorArray with_offsets(SensorArray array, double s_mps2) {
  auto u = std::make_unique<RowUncertainty>();
  for (int i = 0; i < array.size(); ++i) {
    const auto k = static_cast<std::size_t>(4 * i + 3);
    u->covariance[k * (k + 1) / 2 + k] = s_mps2 * s_mps2;
  }
  array.set_uncertainty(*u);
  return array;
}

TEST(MonitorLimits, OfTheTetrahedronByHand) {
  const MonitorConfig config;
  const MonitorLimits l = monitor_limits(plumb_test::tetrahedron(kSigma), kExact, config);
  const double k = normal_tail_quantile(0.5e-5);
  EXPECT_NEAR(l.parity.noise_mps2, k * kSigma / std::sqrt(32.0), 1e-9);
  EXPECT_EQ(l.parity.systematic_mps2, 0.0);
  EXPECT_NEAR(l.parity.bias_mps2, 2.0 * k * kSigma / std::sqrt(32.0), 1e-9) << "parity shows half of a bias";
  EXPECT_NEAR(l.length.noise_mps2, std::sqrt(0.75) * k * kSigma / std::sqrt(32.0), 1e-9) << "H'H = 4/3 I";
  EXPECT_EQ(l.useful_samples, 0.0) << "nothing is left by a perfect calibration";
  EXPECT_EQ(l.delta_f_mps2, 0.0);
  EXPECT_EQ(l.blind_worst_mps2, 0.0);
}

// Verifies: REQ-178
TEST(MonitorLimits, BlocksBeyondTheRatioOfTheVariancesBuyNothing) {
  const SensorArray array = with_offsets(plumb_test::tetrahedron(kSigma), kSigma / 3.0);
  MonitorConfig config;
  const MonitorLimits l = monitor_limits(array, kExact, config);
  EXPECT_NEAR(l.left_mps2, kSigma / 3.0, 1e-9);
  EXPECT_NEAR(l.useful_samples, 9.0, 1e-6);
  const std::string text = render::limits_text(l);
  EXPECT_NE(text.find("blocks beyond 9 samples bring no gain at one attitude, and these have 32"), std::string::npos)
      << text;
  // It is so: at eight times the window the limit falls by less than a third, where noise falls to 35 %.
  config.window = 256;
  const MonitorLimits longer = monitor_limits(array, kExact, config);
  EXPECT_NEAR(longer.parity.noise_mps2, l.parity.noise_mps2 / std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(longer.parity.systematic_mps2, l.parity.systematic_mps2, 1e-12);
  EXPECT_GT(longer.parity.bias_mps2, 0.67 * l.parity.bias_mps2);
}

// Verifies: REQ-178
TEST(MonitorLimits, SayWhatAGivenDeltaFHides) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  MonitorConfig config;
  config.delta_f_mps2 = 0.05 * kG0_mps2;
  const MonitorLimits l = monitor_limits(array, kExact, config);
  // |w|^2 = 3/2: whatever the attitude, |f| |w| < delta_F passes, and beyond (2G + delta_F)/|w| nothing does (T8).
  EXPECT_GE(l.blind_median_mps2, 0.05 / std::sqrt(1.5) / 1.02 * kG0_mps2);
  EXPECT_LE(l.blind_worst_mps2, 2.05 / std::sqrt(1.5) * kG0_mps2);
  EXPECT_GT(l.blind_worst_mps2, l.blind_median_mps2);
  EXPECT_GT(deg_from_rad(l.blind_tilt_rad), 2.0);
  EXPECT_EQ(l.triple.noise_mps2, config.delta_f_mps2);
  EXPECT_NEAR(l.parity.bias_mps2, monitor_limits(array, kExact, MonitorConfig{}).parity.bias_mps2, 1e-15);
  const std::string text = render::limits_text(l);
  EXPECT_NE(text.find("delta_f = 50 mg the triples miss"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(render::limits_json(l))["limits"];
  EXPECT_NEAR(json["blind_worst_mps2"].get<double>(), l.blind_worst_mps2, 1e-12);
  config.delta_f_mps2 = 0.005 * kG0_mps2;
  EXPECT_LT(monitor_limits(array, kExact, config).blind_median_mps2, 0.5 * l.blind_median_mps2);
}

// Negative: REQ-178
TEST(MonitorLimits, SayNothingOfWhatIsNotThere) {
  const std::string text = render::limits_text(monitor_limits(plumb_test::cone_array(3, kSigma), kExact, {}));
  for (const char* word : {"parity", "buy nothing", "delta_f"}) EXPECT_EQ(text.find(word), std::string::npos) << word;
  MonitorConfig given;
  given.delta_f_mps2 = 0.05 * kG0_mps2;
  const std::string four = render::limits_text(monitor_limits(plumb_test::tetrahedron(kSigma), kExact, given));
  for (const char* word : {"parity", "delta_f"}) EXPECT_NE(four.find(word), std::string::npos) << word;
}

TEST(MonitorLimits, AnAccelerationThatIsAllowedForIsPartOfTheLengthAlone) {
  const SensorArray array = with_offsets(plumb_test::tetrahedron(kSigma), kSigma / 3.0);
  for (const AlarmForm form : {AlarmForm::every_tool, AlarmForm::average_tool}) {
    MonitorConfig config;
    config.alarm_form = form;
    const MonitorLimits still = monitor_limits(array, kExact, config);
    config.acceleration_bound_mps2 = 0.05;
    const MonitorLimits pushed = monitor_limits(array, kExact, config);
    EXPECT_NEAR(pushed.length.systematic_mps2, still.length.systematic_mps2 + 0.05, 1e-9);
    EXPECT_NEAR(pushed.triple.systematic_mps2, still.triple.systematic_mps2 + 0.05, 1e-9);
    EXPECT_EQ(pushed.parity.bias_mps2, still.parity.bias_mps2);
    EXPECT_NEAR(pushed.useful_samples, still.useful_samples, 1e-6) << "what calibration leaves is the same";
  }
}

// Verifies: REQ-123
TEST(MonitorLimits, DriftThatIsAllowedForIsPartOfEveryLimitAndSaid) {
  const SensorArray array = with_offsets(plumb_test::tetrahedron(kSigma), kSigma / 3.0);
  Readings tolerance{};
  for (std::size_t i = 0; i < 4; ++i) tolerance[i] = 8e-4 * kG0_mps2;
  for (const AlarmForm form : {AlarmForm::every_tool, AlarmForm::average_tool}) {
    MonitorConfig config;
    config.alarm_form = form;
    const MonitorLimits still = monitor_limits(array, kExact, config);
    const MonitorLimits drifted = monitor_limits(array, kExact, config, tolerance);
    // Four sensors on a tetrahedron: every one has a quarter in parity, and its column is 3/4 long.
    EXPECT_NEAR(drifted.parity.systematic_mps2 - still.parity.systematic_mps2, 2.0 * tolerance[0], 1e-6);
    const double longer = drifted.length.systematic_mps2 - still.length.systematic_mps2;
    EXPECT_GT(longer, 0.75 * tolerance[0]);
    EXPECT_LT(longer, 3.0 * 1.01 * tolerance[0]);
    EXPECT_GT(drifted.triple.systematic_mps2, still.triple.systematic_mps2 + tolerance[0]);
    EXPECT_NEAR(drifted.useful_samples, still.useful_samples, 1e-6) << "what calibration leaves is the same";
    EXPECT_NE(limits_text(drifted).find("0.8 mg in a reading, 4 sigmas of the stability\n"), std::string::npos);
    EXPECT_NE(limits_text(still).find("No stability is stated"), std::string::npos);
  }
  tolerance[2] = 0.0;
  const std::string some = limits_text(monitor_limits(array, kExact, {}, tolerance));
  EXPECT_NE(some.find("none for 1 of the sensors, which state none"), std::string::npos) << some;
}

TEST(MonitorLimits, TheAverageFormIsTheNarrower) {
  const SensorArray array = with_offsets(plumb_test::tetrahedron(kSigma), kSigma / 3.0);
  MonitorConfig config;
  const MonitorLimits every = monitor_limits(array, kExact, config);
  config.alarm_form = AlarmForm::average_tool;
  const MonitorLimits average = monitor_limits(array, kExact, config);
  EXPECT_EQ(average.parity.noise_mps2, every.parity.noise_mps2);
  EXPECT_NEAR(average.parity.bias_mps2, 2.0 * normal_tail_quantile(0.5e-5) * kSigma * std::sqrt(1.0 / 32.0 + 1.0 / 9.0),
              1e-9);
  EXPECT_LT(average.parity.bias_mps2, every.parity.bias_mps2);
  EXPECT_LT(average.length.bias_mps2, every.length.bias_mps2);
}

}  // namespace
}  // namespace monitor_limits_test
