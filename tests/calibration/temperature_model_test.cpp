// The parts of the fit over temperature, each asked by itself: ranks and covariances of information that is none.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "../../src/calibration/temperature_model.hpp"
#include "calibration/temperature_support.hpp"

namespace temperature_model_test {
namespace {

using namespace temperature_test;
using plumb::Errc;

struct Scene {
  plumb::Datasheet sheet = paper_sheet();
  Noise noise{91};
  Truth truth = temperature_test::draw_truth(sheet, noise);
  std::vector<plumb::Station> stations = on_levels(truth, levels_of(3), noise);
  std::vector<plumb::Station> scratch = stations;
  plumb::fit::Joint joint{sheet, {kLow_degc, kHigh_degc}, 1};
  plumb::fit::JointState state = joint.nominal;
  std::unique_ptr<plumb::TemperatureWork> work = std::make_unique<plumb::TemperatureWork>();
  plumb::TemperatureReport report;
  plumb::FitReport figures;

  Scene() { report.levels = plumb::temperature_levels(stations.data(), count()); }
  int count() const { return static_cast<int>(stations.size()); }
  plumb::fit::JointAnalysis analysis(double floor) {
    return {joint, state, plumb::kG0_mps2, 0.0, floor, stations.data(), count(), scratch.data()};
  }
};

TEST(TemperatureModel, TheRankCountsTheEigenvaluesAboveTheFloor) {
  Scene s;
  ASSERT_TRUE(plumb::fit::find_rank(s.analysis(1e-10), *s.work, s.report));
  EXPECT_EQ(s.report.gauge, 3);
  EXPECT_EQ(s.report.rank, s.joint.parameters() - 3);
  EXPECT_EQ(s.report.null_directions, 0);
  // Below every value: all count, and no rotation does.
  ASSERT_TRUE(plumb::fit::find_rank(s.analysis(-1.0), *s.work, s.report));
  EXPECT_EQ(s.report.rank, s.joint.parameters());
  EXPECT_EQ(s.report.gauge, 0);
}

TEST(TemperatureModel, AxesWithoutLengthHaveNoRotationAndNoRank) {
  Scene s;
  s.state.theta.fill(0.0);
  ASSERT_TRUE(plumb::fit::find_rank(s.analysis(1e-10), *s.work, s.report));
  EXPECT_EQ(s.report.rank, 0);
  EXPECT_EQ(s.report.rank + s.report.gauge + s.report.null_directions, s.joint.parameters());
}

// Negative: REQ-034
TEST(TemperatureModel, InformationThatIsNoneHasNoRankAndNoPosterior) {
  Scene s;
  const int size = s.joint.parameters();
  for (int k = 0; k < size; ++k) s.work->information[at(k * size + k)] = -2.0;
  EXPECT_FALSE(plumb::fit::analyse(s.analysis(1e-10), *s.work, s.report, s.figures));
}

/// A prior so wide that the information beside it is beyond all numbers.
// Negative: REQ-034
TEST(TemperatureModel, InformationBeyondAllNumbersHasNoRank) {
  Scene s;
  plumb::Datasheet wide = s.sheet;
  for (int i = 0; i < wide.size; ++i) wide.sensor[at(i)].prior.bias_mps2 = 1e153;
  const plumb::fit::Joint joint(wide, {kLow_degc, kHigh_degc}, 1);
  const plumb::fit::JointState state = joint.nominal;
  const plumb::fit::JointAnalysis analysis = {
      joint, state, plumb::kG0_mps2, 0.0, 1e-10, s.stations.data(), s.count(), s.scratch.data()};
  EXPECT_FALSE(plumb::fit::find_rank(analysis, *s.work, s.report));
}

/// Where nothing but the slopes over temperature is open, nothing is at the middle of the span: no multiple of the mean
/// is as small.
TEST(TemperatureModel, ACovarianceThatVanishesSomewhereHasNoCover) {
  plumb::AxisList axes{};
  const double h = std::sqrt(1.0 / 3.0);
  for (int i = 0; i < 4; ++i) axes[at(i)] = {i % 2 == 0 ? h : -h, i < 2 ? h : -h, i % 3 == 0 ? h : -h};
  const plumb::Datasheet sheet = sheet_of(axes, 4);
  const plumb::fit::Joint joint(sheet, {kLow_degc, kHigh_degc}, 1);
  const auto work = std::make_unique<plumb::TemperatureWork>();
  const int size = joint.parameters(), per = joint.per_sensor();
  const auto open = [&](int parameter, double variance) {
    for (int i = 0; i < joint.sensors(); ++i) {
      const int k = per * i + parameter;
      work->information[at(k * size + k)] = variance;
    }
  };
  open(4, 1e-6);
  open(5, 1e-6);
  EXPECT_EQ(plumb::fit::covering_covariance(joint, joint.nominal, {kLow_degc, kHigh_degc}, *work), 0.0);
  for (int p = 0; p < 4; ++p) open(p, 1e-6);
  EXPECT_GE(plumb::fit::covering_covariance(joint, joint.nominal, {kLow_degc, kHigh_degc}, *work), 1.0);
}

// Negative: REQ-034
TEST(TemperatureModel, SumsBeyondAllNumbersAreNotFinite) {
  Scene s;
  for (int i = 0; i < s.joint.sensors(); ++i) s.joint.sheet.sensor[at(i)].row.sigma_mps2 = 1e-50;
  for (std::size_t k = 0; k < 8; ++k) s.stations[k].mean[0] = 3e103;
  plumb::fit::reduce_all(s.joint, s.state, s.stations.data(), s.count(), s.scratch.data());
  const plumb::fit::Problem problem = {s.joint.sheet, plumb::kG0_mps2, {s.scratch.data(), s.count()}, s.count(), {},
                                       nullptr};
  plumb::fit::JointSums sums;
  plumb::fit::accumulate(s.joint, s.state, problem, 0.0, plumb::fit::Loss::squares, s.work->information.data(), sums);
  EXPECT_FALSE(sums.sums.finite);
}

}  // namespace
}  // namespace temperature_model_test
