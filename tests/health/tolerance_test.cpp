// How far the mean of a block may be off for what does not average out: drift since the calibration, steps.
#include "plumb/health/detail/tolerance.hpp"

#include <gtest/gtest.h>

#include "support/simulated_tool.hpp"

namespace tolerance_test {
namespace {

using namespace plumb;

class BlockTolerance : public testing::Test {
 protected:
  BlockTolerance() {
    in_force_.array = plumb_test::tetrahedron(1e-3);
    in_force_.model = plumb_test::identity_model(4);
    for (auto& sensor : in_force_.model.sensor) sensor.reference_degc = 20.0;
    evidence_.usable = in_force_.array.all();
    evidence_.samples = 32.0;
  }
  /// Readings that scatter by a noise of one sigma.
  BlockAccumulator noisy_block() const {
    BlockAccumulator block;
    plumb_test::Noise noise(1);
    for (int k = 0; k < 32; ++k) {
      Readings y{};
      for (int i = 0; i < 4; ++i) y[static_cast<std::size_t>(i)] = 1e-3 * noise.normal();
      block.add(y, in_force_.array.all(), 1.0);
    }
    return block;
  }

  Settings settings_;
  InForce in_force_;
  BlockEvidence evidence_;
};

// Verifies: REQ-123
TEST_F(BlockTolerance, DriftIsStabilityAndWhatWasLearned) {
  Stability stated;
  stated.mps2 = 0.001;
  stated.per_degc_mps2 = 0.0001;
  settings_.stability[1] = StabilityNow::of(stated, 0.0);
  allow_for_drift(settings_, in_force_, 20.0, 0.0, 0.0F, evidence_);
  EXPECT_EQ(evidence_.tolerance_mps2[0], 0.0F);
  EXPECT_NEAR(static_cast<double>(evidence_.tolerance_mps2[1]), kStabilitySigmas * 0.001, 1e-6);
  const float at_reference = evidence_.tolerance_mps2[1];
  allow_for_drift(settings_, in_force_, 40.0, 0.0, 0.5F, evidence_);
  EXPECT_EQ(evidence_.tolerance_mps2[0], 0.5F);
  EXPECT_GT(evidence_.tolerance_mps2[1], at_reference + 0.5F) << "20 degC away";
  allow_for_drift(settings_, in_force_, 40.0, 0.0, 1e9F, evidence_);
  EXPECT_EQ(evidence_.tolerance_mps2[1], kMostTolerance_mps2);
}

// Verifies: REQ-067
TEST_F(BlockTolerance, StepsBelowNoiseAreNoise) {
  settings_.resolution_mps2[0] = 1e-3F;
  allow_for_steps(settings_, in_force_.array, noisy_block(), in_force_.array.all(), evidence_);
  EXPECT_EQ(evidence_.tolerance_mps2[0], 0.0F);
  EXPECT_NEAR(evidence_.samples, 32.0 / (1.0 + 1.0 / 12.0), 1e-5);
}

// Negative: REQ-067
TEST_F(BlockTolerance, StepsCoarserThanNoiseAreHalfAStep) {
  settings_.resolution_mps2[2] = 4e-3F;
  allow_for_steps(settings_, in_force_.array, noisy_block(), in_force_.array.all(), evidence_);
  EXPECT_NEAR(static_cast<double>(evidence_.tolerance_mps2[2]), 2e-3, 1e-8);
  EXPECT_EQ(evidence_.samples, 32.0);
  // Noise as stated, and a channel that stands on one step all the same.
  settings_.resolution_mps2[3] = 1e-3F;
  BlockAccumulator still;
  for (int k = 0; k < 32; ++k) still.add(Readings{}, in_force_.array.all(), 1.0);
  allow_for_steps(settings_, in_force_.array, still, in_force_.array.all(), evidence_);
  EXPECT_NEAR(static_cast<double>(evidence_.tolerance_mps2[3]), 5e-4, 1e-8);
}

}  // namespace
}  // namespace tolerance_test
