// The counterpart of Figs 4 to 10 of the paper, in numbers.
#include "plumb/study/calibration_study.hpp"

#include <iostream>

#include "study_test_support.hpp"

namespace calibration_study_test {
namespace {

using namespace study_test;
using namespace plumb::study;

constexpr double kMg = 1e-3 * plumb::kG0_mps2;

TEST(CalibrationStudy, BothMethodsConvergeWithinAFewIterationsForEverySeed) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto study = calibration_study(plumb::scenario::paper_tool(seed), seed);
    ASSERT_TRUE(study.has_value()) << study.error();
    ASSERT_EQ(study->history.size(), 5U);
    EXPECT_EQ(study->stations.size(), 48U);
    for (const FitHistory& h : study->history) {
      EXPECT_TRUE(h.paper_converged) << seed;
      EXPECT_EQ(h.paper_rank, 9) << "of " << plumb::paper_parameters(h.used.size());
      EXPECT_LE(h.paper.size() - 1, 6U);
      EXPECT_LE(h.own.size() - 1, 8U);
      // Both start at the datasheet, where eq (10) has one value.
      EXPECT_NEAR(h.paper.front().cost_g4, h.own.front().cost_g4, 1e-9 * h.paper.front().cost_g4);
      // Fig 7: "almost zero".
      EXPECT_LT(h.paper.back().cost_g4, 1e-4 * h.paper.front().cost_g4);
      EXPECT_LT(h.own.back().cost_g4, 1e-4 * h.own.front().cost_g4);
      EXPECT_LT(h.own.back().cost_g4, 2.0 * h.paper.back().cost_g4);
    }
  }
}

TEST(CalibrationStudy, ThePapersCostIsMetWithTheWrongParameters) {
  double paper_bias = 0.0, own_bias = 0.0, paper_scale = 0.0, own_scale = 0.0, own_misalignment = 0.0;
  constexpr std::uint64_t kTools = 20;
  for (std::uint64_t seed = 1; seed <= kTools; ++seed) {
    const auto study = calibration_study(plumb::scenario::paper_tool(seed), seed);
    ASSERT_TRUE(study.has_value()) << study.error();
    const FitHistory& all = study->history.front();
    const ParameterError before = error_of(all, all.paper.front());
    const ParameterError paper = error_of(all, all.paper.back());
    const ParameterError own = error_of(all, all.own.back());
    EXPECT_GT(before.bias_mps2, 2.0 * kMg);
    EXPECT_LT(own.bias_mps2, 0.02 * kMg) << seed;
    EXPECT_LT(own.scale, 5e-5) << seed;
    EXPECT_LT(own.misalignment, 5e-5) << seed;
    paper_bias += paper.bias_mps2 / kTools;
    own_bias += own.bias_mps2 / kTools;
    paper_scale += paper.scale / kTools;
    own_scale += own.scale / kTools;
    own_misalignment += own.misalignment / kTools;
  }
  std::cout << "[ measured ] mean over tools: bias mg paper " << paper_bias / kMg << " own " << own_bias / kMg
            << "; scale paper " << paper_scale << " own " << own_scale << "; misalignment own " << own_misalignment
            << '\n';
  EXPECT_GT(paper_bias, 100.0 * own_bias) << "9 of 20 parameters show: the rest stays near the datasheet";
  EXPECT_GT(paper_scale, 100.0 * own_scale);
}

TEST(CalibrationStudy, TheHistoryBeginsAtTheDatasheetAndEndsAtTheFinishedFit) {
  const Bench bench = bench_of(9);
  const plumb::Datasheet& sheet = bench.tool.datasheet;
  const auto stations = calibration_stations(bench.tool, 9);
  ASSERT_TRUE(stations.has_value());
  plumb::Calibrator calibrator(sheet, study_gravity(), {});
  const CommonFrame start = frame_of(sheet, calibrator.parameters());
  while (!calibrator.done()) calibrator.iterate(stations->data(), static_cast<int>(stations->size()));
  const CommonFrame end = frame_of(sheet, calibrator.parameters());
  const CommonFrame finished = frame_of(*bench.fits.own);
  for (int i = 0; i < sheet.size; ++i) {
    EXPECT_EQ(start.axis[at(i)], sheet.sensor[at(i)].row.axis);
    EXPECT_DOUBLE_EQ(start.scale[at(i)], sheet.sensor[at(i)].coefficients.scale[0]);
    EXPECT_EQ(start.bias_mps2[at(i)], 0.0);
    // `finish` only turns the axes onto the nominal ones.
    EXPECT_NEAR(end.scale[at(i)], finished.scale[at(i)], 1e-12);
    EXPECT_NEAR(end.bias_mps2[at(i)], finished.bias_mps2[at(i)], 1e-12);
    for (int k = 0; k < i; ++k) {
      EXPECT_NEAR(plumb::dot(end.axis[at(i)], end.axis[at(k)]), plumb::dot(finished.axis[at(i)], finished.axis[at(k)]),
                  1e-12);
    }
  }
}

TEST(CalibrationStudy, PlainInverseHardlyEverEnds) {
  const auto ends = plain_inverse_ends(1, 50);
  ASSERT_TRUE(ends.has_value()) << ends.error();
  EXPECT_EQ(ends->trials, 50U);
  EXPECT_LT(ends->share(), 0.25);
  std::cout << "[ measured ] plain inverse ends in " << ends->count << " of 50\n";
}

TEST(CalibrationStudy, OnlyForFourSensors) {
  plumb::Datasheet three = plumb::scenario::paper_datasheet();
  three.size = 3;
  const auto fits = fit_both(three, {});
  ASSERT_FALSE(fits.has_value());
  EXPECT_NE(fits.error().find("3"), std::string::npos);
  EXPECT_NE(fits.error().find("Remedy"), std::string::npos);
  const auto none = fit_both(plumb::scenario::paper_datasheet(), {});
  ASSERT_FALSE(none.has_value());
  EXPECT_NE(none.error().find("too few stations"), std::string::npos) << none.error();
}

}  // namespace
}  // namespace calibration_study_test
