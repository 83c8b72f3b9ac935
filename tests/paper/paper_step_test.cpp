// The step of the paper's fit from matrices that are none.
#include "../../src/paper/paper_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "paper/paper_scene.hpp"

namespace paper_step_test {
namespace {

using namespace calibration_test;

constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(PaperStep, AMatrixWithAnEntryBeyondAllNumbersHasNoStepAndNoRank) {
  PaperScene one;
  one.work->entry(0, 0) = 1.0;
  one.work->entry(1, 0) = kInf;
  EXPECT_EQ(paper::rank_of(1e-4, *one.work), 0);
  EXPECT_FALSE(paper::minimum_norm_step(one.problem(24), *one.work));
  // The same behind nine sound pivots, which the quicker ways take.
  PaperScene nine;
  for (int k = 0; k < kPaperRank; ++k) nine.work->entry(k, k) = std::pow(0.1, k / 2);
  nine.work->entry(10, 0) = 1e200;  // whose square is beyond all numbers
  EXPECT_FALSE(paper::minimum_norm_step(nine.problem(24), *nine.work));
  PaperScene sound;
  for (int k = 0; k < kPaperRank; ++k) sound.work->entry(k, k) = 1.0;
  EXPECT_TRUE(paper::minimum_norm_step(sound.problem(24), *sound.work));
  EXPECT_NE(sound.work->step[0], 0.0);
}

}  // namespace
}  // namespace paper_step_test
