#include "plumb/commission/gyro_fit.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "gyro_scene.hpp"

namespace gyro_fit_test {
namespace {

using namespace plumb;
using namespace plumb::commission;
using namespace plumb_test;

constexpr int kSamples = 4000;

GyroLog waves_log(const GyroScene& scene, std::uint64_t seed, bool rest = true) {
  const GyroWaves waves(seed);
  return gyro_log(
      scene, [&](double t_s) { return waves.at(t_s); }, kSamples, seed + 1, rest);
}

/// Errors over their sigmas, of rows and delays.
std::vector<double> errors_of(const GyroFit& fit, const GyroScene& scene) {
  const Eigen::MatrixXd rows = pinned_rows(scene);
  const double mean_s = mean_delay_s(scene);
  std::vector<double> out;
  for (std::size_t i = 0; i < fit.axis.size(); ++i) {
    const FittedGyro& one = fit.axis[i];
    for (std::size_t c = 0; c < 3; ++c)
      out.push_back((one.row[c] - rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c))) /
                    std::sqrt(one.row_covariance[4 * c]));
    out.push_back((one.delay_s - (scene.truth[i].delay_s - mean_s)) / one.delay_sigma_s);
  }
  return out;
}

std::string refusal(const CommissionExpected<GyroFit>& fit) { return fit ? "none" : fit.error(); }
bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST(GyroFit, RowsDelaysAndBiasesComeBackWithNumbers) {
  const GyroScene scene = gyro_scene(6, 1);
  const auto fit = fit_gyros(waves_log(scene, 11), scene.nominal);
  ASSERT_TRUE(fit.has_value()) << fit.error();
  const Eigen::MatrixXd rows = pinned_rows(scene);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(fit->axis[i].row[c], rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)), 2e-4);
    EXPECT_NEAR(fit->axis[i].delay_s, scene.truth[i].delay_s - mean_delay_s(scene), 2e-5);
    EXPECT_NEAR(fit->axis[i].bias_radps, scene.truth[i].bias_radps, 5.0 * scene.noise_radps / std::sqrt(190.0));
    // Rest alone tells three of six combinations, the motion the others.
    EXPECT_NEAR(fit->axis[i].bias_sigma_radps, scene.noise_radps / std::sqrt(2.0 * 190.0), 2.5e-5);
  }
  // Three of six degrees of freedom are the rate.
  // Interpolation smooths the samples, not their means.
  EXPECT_LT(fit->residual.sample_radps, scene.noise_radps * std::sqrt(0.5));
  EXPECT_GT(fit->residual.sample_radps, 0.8 * scene.noise_radps * std::sqrt(0.5));
  EXPECT_NEAR(fit->residual.block_radps, scene.noise_radps * std::sqrt(0.5 / kGyroBlock), 5e-5);
  EXPECT_TRUE(fit->bias_from_rest);
  EXPECT_FALSE(fit->absolute);
}

TEST(GyroFit, AnotherRecordingHasTheSameResidual) {
  const GyroScene scene = gyro_scene(5, 2);
  const auto fit = fit_gyros(waves_log(scene, 21), scene.nominal);
  ASSERT_TRUE(fit.has_value()) << fit.error();
  const GyroResidual held_out = gyro_residual(waves_log(scene, 22), *fit);
  EXPECT_NEAR(held_out.sample_radps, fit->residual.sample_radps, 0.03 * fit->residual.sample_radps);
  EXPECT_NEAR(held_out.block_radps, fit->residual.block_radps, 0.3 * fit->residual.block_radps);
  EXPECT_GT(held_out.samples, 3900);
  EXPECT_EQ(gyro_residual(waves_log(scene, 22), *fit, 1e3).samples, 0);
  EXPECT_EQ(gyro_residual(waves_log(gyro_scene(6, 2), 22), *fit).samples, 0) << "another array";
  // What a row that is off leaves is seen.
  GyroScene off = scene;
  off.truth[1].row[0] += 0.02;
  EXPECT_GT(gyro_residual(waves_log(off, 22), *fit).sample_radps, 2.0 * held_out.sample_radps);
}

TEST(GyroFit, SensitivityToForceComesBackButForWhatIsCommon) {
  GyroScene scene = gyro_scene(8, 3);
  Noise noise(5);
  Eigen::MatrixXd rows(8, 3), force(8, 3);
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      scene.truth[i].per_force[c] = 2e-4 * noise.normal();
      force(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = scene.truth[i].per_force[c];
      rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = scene.truth[i].row[c];
    }
  }
  force -= rows * (rows.transpose() * rows).inverse() * rows.transpose() * force;
  GyroFitSettings settings;
  settings.force = true;
  const auto fit = fit_gyros(waves_log(scene, 31), scene.nominal, settings);
  ASSERT_TRUE(fit.has_value()) << fit.error();
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double sigma = fit->axis[i].per_force_sigma[c];
      EXPECT_NEAR(fit->axis[i].per_force[c], force(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)),
                  5.0 * sigma);
      EXPECT_LT(sigma, 2e-5);
    }
  }
}

// A mean of squared errors over their variances, of some 800 numbers: within 0.75 and 1.3 where the sigmas are right.
TEST(GyroFit, SigmasAreNeitherTooSmallNorTooLarge) {
  double square = 0.0;
  int count = 0;
  for (std::uint64_t seed = 100; seed < 140; ++seed) {
    const GyroScene scene = gyro_scene(5, seed);
    const auto fit = fit_gyros(waves_log(scene, seed), scene.nominal);
    ASSERT_TRUE(fit.has_value()) << fit.error();
    for (const double error : errors_of(*fit, scene)) {
      square += error * error;
      ++count;
    }
  }
  RecordProperty("ratio", std::to_string(square / count));
  EXPECT_GT(square / count, 0.75);
  EXPECT_LT(square / count, 1.3);
}

TEST(GyroFit, RefusalsSayWhatIsMissing) {
  const GyroScene scene = gyro_scene(5, 4);
  const GyroLog good = waves_log(scene, 41);
  EXPECT_TRUE(fit_gyros(good, scene.nominal).has_value());

  GyroScene three = scene;
  three.nominal.resize(3);
  EXPECT_TRUE(says(refusal(fit_gyros(good, three.nominal)), "3 gyro axes: at least 4"));

  GyroScene flat = scene;
  for (std::size_t i = 0; i < 5; ++i)
    flat.nominal[i].axis = {std::cos(0.7 * static_cast<double>(i)), std::sin(0.7 * static_cast<double>(i)), 0.0};
  EXPECT_TRUE(says(refusal(fit_gyros(good, flat.nominal)), "in one plane"));

  GyroLog ragged = good;
  ragged.rate_radps[2].pop_back();
  EXPECT_TRUE(says(refusal(fit_gyros(ragged, scene.nominal)), "equal length"));

  GyroScene saturated = scene;
  saturated.nominal[3].full_scale_radps = 0.001;
  EXPECT_TRUE(says(refusal(fit_gyros(good, saturated.nominal)), "at rest: at least 100"));
  GyroLog moving = good;
  moving.at_rest.clear();
  EXPECT_TRUE(says(refusal(fit_gyros(moving, saturated.nominal)), "axis 3 is saturated or not given"));

  GyroFitSettings long_log;
  long_log.least_samples = 5000;
  EXPECT_TRUE(says(refusal(fit_gyros(good, scene.nominal, long_log)), "record for longer"));

  GyroFitSettings force;
  force.force = true;
  GyroLog without = good;
  without.force_mps2.clear();
  EXPECT_TRUE(says(refusal(fit_gyros(without, scene.nominal, force)), "needs the specific force"));
}

TEST(GyroFit, AnAxisThatNothingChecksHasNoDelay) {
  GyroScene scene = gyro_scene(4, 5, 0.0, 0.0);
  const std::array<Vec3, 4> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, 1}};
  for (std::size_t i = 0; i < 4; ++i) scene.nominal[i].axis = scene.truth[i].row = axes[i];
  EXPECT_TRUE(says(refusal(fit_gyros(waves_log(scene, 51), scene.nominal)), "leaves 2 combinations"))
      << refusal(fit_gyros(waves_log(scene, 51), scene.nominal));
  GyroFitSettings settings;
  settings.delay = false;
  EXPECT_TRUE(fit_gyros(waves_log(scene, 51), scene.nominal, settings).has_value());
}

RC_GTEST_PROP(GyroFitLaw, TheTruthIsRecoveredWithinItsSigma, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
  const int axes = *rc::gen::inRange(4, 13);
  const bool rest = *rc::gen::arbitrary<bool>();
  const GyroScene scene =
      gyro_scene(axes, seed, *rc::gen::element(0.0, 0.01, 0.03), *rc::gen::element(0.0, 0.002, 0.012));
  const auto fit = fit_gyros(waves_log(scene, seed, rest), scene.nominal);
  if (!fit) RC_FAIL(fit.error());
  RC_ASSERT(fit->bias_from_rest == rest);
  for (const double error : errors_of(*fit, scene)) RC_ASSERT(std::fabs(error) < 6.0);
}

// The direction that is named is the one about which the body did not turn.
RC_GTEST_PROP(GyroFitLaw, MotionThatLacksAnAxisIsRefusedAndNamesIt, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
  const auto missing = *rc::gen::inRange<std::size_t>(0, 3);
  const GyroScene scene = gyro_scene(*rc::gen::inRange(4, 10), seed, 0.01);
  GyroWaves waves(seed);
  waves.about[missing] = 0.0;
  const auto fit = fit_gyros(gyro_log(
                                 scene, [&](double t_s) { return waves.at(t_s); }, kSamples, seed),
                             scene.nominal);
  RC_ASSERT(!fit.has_value());
  if (!says(fit.error(), "turned too little about")) RC_FAIL(fit.error());
  const std::size_t open = fit.error().find('(');
  std::array<double, 3> named{};
  RC_ASSERT(std::sscanf(fit.error().c_str() + open, "(%lf, %lf, %lf)", &named[0], &named[1], &named[2]) == 3);
  RC_ASSERT(std::fabs(named[missing]) > 0.9);
}

RC_GTEST_PROP(GyroFitLaw, RestAloneAndOneSteadySpinAreRefused, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
  const GyroScene scene = gyro_scene(*rc::gen::inRange(4, 10), seed, 0.01);
  Noise noise(seed);
  const Vec3 spin = scaled(random_direction(noise), *rc::gen::element(0.0, 1.0, 20.0));
  const auto fit = fit_gyros(gyro_log(
                                 scene, [&](double) { return spin; }, kSamples, seed, false),
                             scene.nominal);
  RC_ASSERT(!fit.has_value());
}

// Order of the axes and unit of time change nothing else.
RC_GTEST_PROP(GyroFitLaw, OrderAndUnitOfTimeDoNotMatter, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
  const GyroScene scene = gyro_scene(*rc::gen::inRange(4, 10), seed);
  const GyroLog log = waves_log(scene, seed);
  const auto fit = fit_gyros(log, scene.nominal);
  GyroScene other = scene;
  GyroLog turned = log;
  std::reverse(other.nominal.begin(), other.nominal.end());
  std::reverse(turned.rate_radps.begin(), turned.rate_radps.end());
  turned.period_s *= 2.0;
  for (auto& axis : turned.rate_radps) {
    for (double& y : axis) y *= 0.5;
  }
  for (GyroNominal& one : other.nominal) one.noise_radps *= 0.5;
  const auto again = fit_gyros(turned, other.nominal);
  RC_ASSERT(fit.has_value() && again.has_value());
  const std::size_t n = fit->axis.size();
  for (std::size_t i = 0; i < n; ++i) {
    const FittedGyro &a = fit->axis[i], &b = again->axis[n - 1 - i];
    RC_ASSERT(norm(minus(a.row, b.row)) < 1e-6);
    RC_ASSERT(std::fabs(2.0 * a.delay_s - b.delay_s) < 1e-7);
    RC_ASSERT(std::fabs(0.5 * a.bias_radps - b.bias_radps) < 1e-9);
  }
}

// What gyros alone do not tell leaves no trace: the whole array turned, sheared and scaled reads the same as another
// motion.
RC_GTEST_PROP(GyroFitLaw, ACommonMatrixIsNotTold, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
  const GyroScene scene = gyro_scene(*rc::gen::inRange(4, 10), seed);
  Noise noise(seed + 7);
  Mat3 matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (double& one : matrix) one += 0.1 * (noise.uniform() - 0.5);
  GyroScene other = scene;
  for (FittedGyro& axis : other.truth) {
    const Vec3 row = axis.row;
    for (std::size_t c = 0; c < 3; ++c)
      axis.row[c] = row[0] * matrix[c] + row[1] * matrix[3 + c] + row[2] * matrix[6 + c];
  }
  const auto a = fit_gyros(waves_log(scene, seed), scene.nominal), b = fit_gyros(waves_log(other, seed), scene.nominal);
  RC_ASSERT(a.has_value() && b.has_value());
  for (std::size_t i = 0; i < a->axis.size(); ++i) {
    const double sigma =
        std::sqrt(a->axis[i].row_covariance[0] + a->axis[i].row_covariance[4] + a->axis[i].row_covariance[8]);
    RC_ASSERT(norm(minus(a->axis[i].row, b->axis[i].row)) < 6.0 * sigma);
  }
}

}  // namespace gyro_fit_test
