// Parity added up over the votes of an episode: no healthy set is contradicted, and a fault below what one block shows
// is.
#include "plumb/detection/detail/parity_sums.hpp"

#include <gtest/gtest.h>

#include "detection/still_block.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-069

namespace parity_sums_test {
namespace {

using namespace plumb;
using plumb_test::cone_array;
using plumb_test::Noise;
using plumb_test::random_direction;

constexpr double kSigma = 2e-4 * kG0_mps2;
const GravityReference kGravity{kG0_mps2, 1.5e-4 * kG0_mps2, GravityModel::value};

/// Votes at random attitudes, with the same errors at each.
struct Votes {
  SensorArray array;
  TestLimits limits;
  Noise noise;
  Readings error_mps2{};
  float tolerance_mps2 = 0.0F;
  ParitySums sums;
  bool each_passes = true;  ///< so far no block has shown anything

  Votes(int n, std::uint64_t seed)
      : array(cone_array(n, kSigma)), limits(TestLimits::from_rates(n, 1e-5, 1e-6)), noise(seed) {}
  void take(int votes) {
    for (int k = 0; k < votes; ++k) {
      BlockEvidence block = plumb_test::block_at(array, random_direction(noise));
      for (std::size_t i = 0; i < static_cast<std::size_t>(array.size()); ++i) {
        block.mean_mps2[i] += error_mps2[i] + kSigma / std::sqrt(block.samples) * noise.normal();
        block.tolerance_mps2[i] = tolerance_mps2;
      }
      const BlockTests tests(array, kGravity, limits, block);
      each_passes = each_passes && tests.of(array.all()).parity_consistent(limits);
      sums.add(tests, array.all());
    }
  }
  bool agrees(SensorSet set) const { return sums.agrees(array, limits, set); }
};

TEST(ParitySums, NoiseAloneContradictsNoSet) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Votes votes(5 + static_cast<int>(seed % 4), seed);
    for (int k = 0; k < 30; ++k) {
      votes.take(1);
      for (SensorSet s = SensorSet::first(4); votes.array.all().contains(s); s = next_of_same_size(s))
        ASSERT_TRUE(votes.agrees(s)) << seed << ' ' << k;
      ASSERT_TRUE(votes.agrees(votes.array.all())) << seed << ' ' << k;
    }
  }
}

/// The worst drift within its tolerance is the same at every vote: it adds up, and noise does not.
TEST(ParitySums, WhatIsSystematicMayAddUp) {
  Votes votes(4, 7);
  const ParityBasis basis = parity_basis(votes.array, votes.array.all());
  votes.tolerance_mps2 = static_cast<float>(kSigma);
  for (std::size_t i = 0; i < 4; ++i) votes.error_mps2[i] = std::copysign(kSigma, basis.weight[0][i]);
  votes.take(100);
  EXPECT_TRUE(votes.each_passes);
  EXPECT_TRUE(votes.agrees(votes.array.all()));
  Votes untold(4, 7);
  untold.error_mps2 = votes.error_mps2;
  untold.take(100);
  EXPECT_FALSE(untold.agrees(untold.array.all())) << "without a tolerance the same errors are a fault";
}

/// A misfit is drawn anew at every attitude, and is the same at all votes of one. A tool that comes back to an attitude
/// again and again adds it up like what is systematic: as noise of independent votes it would contradict healthy sets.
TEST(ParitySums, AMisfitOfOneAttitudeAddsUp) {
  for (const double misfits : {0.1, 0.3, 1.0, 5.0}) {  // in standard deviations of a block mean
    int contradicted = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
      Votes votes(5, seed);
      RowUncertainty left;
      const double misfit_mps2 = misfits * kSigma / std::sqrt(32.0);
      left.misfit_mps2.fill(misfit_mps2);
      votes.array.set_uncertainty(left);
      for (std::size_t i = 0; i < 5; ++i) votes.error_mps2[i] = misfit_mps2 * votes.noise.normal();
      votes.take(100);
      if (!votes.agrees(votes.array.all())) ++contradicted;
    }
    EXPECT_EQ(contradicted, 0) << misfits;
  }
}

TEST(ParitySums, AFaultBelowWhatABlockShowsContradictsTheSetsThatItIsIn) {
  Votes votes(5, 11);
  votes.error_mps2[2] = 0.6 * kSigma;
  votes.take(1);
  EXPECT_TRUE(votes.agrees(votes.array.all())) << "one vote is the block's own test";
  votes.take(29);
  EXPECT_TRUE(votes.each_passes);
  EXPECT_FALSE(votes.agrees(votes.array.all()));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(votes.agrees(votes.array.all().without(i)), i == 2) << i;
  EXPECT_TRUE(votes.agrees(SensorSet::first(3))) << "three have no parity";
  votes.sums.clear();
  EXPECT_TRUE(votes.agrees(votes.array.all()));
}

}  // namespace
}  // namespace parity_sums_test
