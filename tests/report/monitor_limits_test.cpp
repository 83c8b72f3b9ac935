#include "plumb/report/monitor_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "plumb/numeric/tails.hpp"
#include "support/simulated_tool.hpp"

namespace monitor_limits_test {
namespace {

using namespace plumb;
using report::monitor_limits;
using report::MonitorLimits;

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
  const std::string text = report::limits_text(l);
  EXPECT_NE(text.find("blocks beyond 9 samples buy nothing at one attitude, and these have 32"), std::string::npos)
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
  const std::string text = report::limits_text(l);
  EXPECT_NE(text.find("delta_f = 50 mg blinds the triples"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(report::limits_json(l))["limits"];
  EXPECT_NEAR(json["blind_worst_mps2"].get<double>(), l.blind_worst_mps2, 1e-12);
  config.delta_f_mps2 = 0.005 * kG0_mps2;
  EXPECT_LT(monitor_limits(array, kExact, config).blind_median_mps2, 0.5 * l.blind_median_mps2);
}

// Negative: REQ-178
TEST(MonitorLimits, SayNothingOfWhatIsNotThere) {
  const std::string text = report::limits_text(monitor_limits(plumb_test::cone_array(3, kSigma), kExact, {}));
  for (const char* word : {"parity", "buy nothing", "delta_f"}) EXPECT_EQ(text.find(word), std::string::npos) << word;
  MonitorConfig given;
  given.delta_f_mps2 = 0.05 * kG0_mps2;
  const std::string four = report::limits_text(monitor_limits(plumb_test::tetrahedron(kSigma), kExact, given));
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
