// The same of the paper's fit: steps from matrices that are none, a form for three sensors without stations.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "../../src/calibration/paper_three.hpp"
#include "calibration/edges_support.hpp"
#include "plumb/calibration/paper_parameters.hpp"

namespace paper_inner_edges_test {
namespace {

using namespace calibration_test;

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Of three sensors: 12 parameters.
struct PaperScene {
  PaperScene() : error(*PaperError::make(sheet, gravity, SensorSet::first(3))) {
    work->size = work->stride = error.parameters();
    for (double& entry : work->matrix) entry = 0.0;
    work->gradient.fill(1.0);
  }
  static Datasheet triad() {
    AxisList axes{};
    return datasheet_of(axes, orthogonal_triad(axes), kEdgeSigma);
  }
  paper::Problem problem(int count) const { return {error, stations.data(), count}; }

  Datasheet sheet = triad();
  GravityReference gravity = standard_gravity();
  Noise noise{3};
  Truth truth = draw_truth(sheet, noise);
  std::vector<Station> stations = random_stations(sheet, truth, 24, noise, kEdgeSigma);
  PaperError error;
  std::unique_ptr<paper::Workspace> work = std::make_unique<paper::Workspace>();
};

TEST(PaperInnerEdge, AMatrixWithAnEntryBeyondAllNumbersHasNoStepAndNoRank) {
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

TEST(PaperInnerEdge, AxesBeyondAllNumbersAreNoAxes) {
  PaperScene s;
  for (double& h : s.sheet.sensor[1].row.axis) h = 1e200;
  const auto made = PaperError::make(s.sheet, s.gravity, SensorSet::first(3));
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, Errc::axes_rank_deficient);
}

TEST(PaperInnerEdge, ThreeSensorsWithoutAScaleOrWithoutAStationHaveNoCost) {
  PaperScene s;
  for (int i = 0; i < 3; ++i) s.sheet.sensor[at(i)].coefficients.bias = {0.02, 0.0, 0.0, 0.0};
  s.error = *PaperError::make(s.sheet, s.gravity, SensorSet::first(3));
  paper::ThreeSensorStep three;
  ASSERT_TRUE(three.begin(s.problem(24)));
  EXPECT_TRUE(std::isfinite(three.look(s.problem(24), s.error.start())));
  EXPECT_TRUE(three.shows_all(s.problem(24), 1e-6));
  EXPECT_TRUE(std::isnan(three.look(s.problem(0), s.error.start())));
  PaperParameters theta = s.error.start();
  theta[4] = 0.0;
  EXPECT_TRUE(std::isnan(three.look(s.problem(24), theta)));

  // Below the least double next to the datasheet's own.
  s.sheet.sensor[1].coefficients.scale[0] = 1e100;
  const PaperError large = *PaperError::make(s.sheet, s.gravity, SensorSet::first(3));
  theta = large.start();
  theta[4] = 1e-300;
  EXPECT_TRUE(std::isnan(three.look({large, s.stations.data(), 24}, theta)));

  ASSERT_TRUE(three.begin(s.problem(4)));
  EXPECT_TRUE(std::isfinite(three.look(s.problem(4), s.error.start())));
  EXPECT_FALSE(three.shows_all(s.problem(4), 1e-6)) << "four stations";
}

/// Misalignments so large, or so nearly one another's inverse, that the rows of the common frame have no length.
TEST(PaperInnerEdge, MisalignmentsThatLeaveNoLengthHaveNoCommonFrame) {
  AxisList axes{};
  const Datasheet sheet = datasheet_of(axes, orthogonal_triad(axes), kEdgeSigma);
  const Expected<SensorArray> array = sheet.array();
  ASSERT_TRUE(array.has_value());
  SensorModel model = sheet.model();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) model.misalignment[at(i * kCapacity + j)] = i == j ? 0.0 : 1e4;
  }
  const auto small = common_frame_form(*array, model);
  ASSERT_FALSE(small.has_value());
  EXPECT_EQ(small.error().code, Errc::not_invertible);
  EXPECT_LT(small.error().value, small.error().limit);

  model.misalignment = {};
  model.misalignment[at(1)] = 1e160;
  const auto endless = common_frame_form(*array, model);
  ASSERT_FALSE(endless.has_value());
  EXPECT_EQ(endless.error().code, Errc::not_invertible);
}

}  // namespace
}  // namespace paper_inner_edges_test
