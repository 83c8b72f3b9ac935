#include "plumb/scenario/truth.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plumb/scenario/library.hpp"

namespace plumb {
namespace scenario {
namespace truth_test {
namespace {

TEST(Truth, PerfectToolIsItsDatasheet) {
  const Tool tool = perfect_tool(paper_datasheet());
  ASSERT_EQ(tool.model.size, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(tool.axes[i], tool.datasheet.sensor[i].row.axis);
    EXPECT_EQ(tool.model.sensor[i].bias[0], 0.0);
    EXPECT_EQ(tool.model.sensor[i].scale[0], kPaperScale_VpMps2);
  }
}

TEST(Truth, UniformErrorsStayWithinTheSpansAndFillThem) {
  const TruthSpans spans;
  double widest_bias = 0.0;
  double widest_scale = 0.0;
  double widest_tilt = 0.0;
  double sum_bias = 0.0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Tool tool = draw_tool(paper_datasheet(), seed);
    for (std::size_t i = 0; i < 4; ++i) {
      const double bias = tool.model.sensor[i].bias[0];
      const double scale = tool.model.sensor[i].scale[0] / kPaperScale_VpMps2 - 1.0;
      const double tilt = angle_between_rad(tool.axes[i], tool.datasheet.sensor[i].row.axis);
      EXPECT_NEAR(norm(tool.axes[i]), 1.0, 4e-16);
      widest_bias = std::max(widest_bias, std::abs(bias));
      widest_scale = std::max(widest_scale, std::abs(scale));
      widest_tilt = std::max(widest_tilt, tilt);
      sum_bias += bias;
    }
  }
  EXPECT_LE(widest_bias, spans.bias_mps2);
  EXPECT_GT(widest_bias, 0.99 * spans.bias_mps2);
  EXPECT_LE(widest_scale, spans.scale * (1.0 + 1e-12));
  EXPECT_GT(widest_scale, 0.99 * spans.scale);
  EXPECT_LE(widest_tilt, std::sqrt(2.0) * spans.axis_rad * (1.0 + 1e-12)) << "2 deg about each of two axes";
  EXPECT_GT(widest_tilt, 1.3 * spans.axis_rad);
  EXPECT_NEAR(sum_bias / 4000.0, 0.0, 4.0 * spans.bias_mps2 / std::sqrt(3.0 * 4000.0));
}

TEST(Truth, NormalErrorsHaveTheSpanAsSigma) {
  TruthSpans spans;
  spans.shape = TruthSpans::Shape::normal;
  double square = 0.0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Tool tool = draw_tool(paper_datasheet(), seed, spans);
    for (std::size_t i = 0; i < 4; ++i) square += tool.model.sensor[i].bias[0] * tool.model.sensor[i].bias[0];
  }
  EXPECT_NEAR(std::sqrt(square / 4000.0) / spans.bias_mps2, 1.0, 4.0 / std::sqrt(8000.0));
}

TEST(Truth, SeedDecidesAndSensorsAreIndependent) {
  const Tool four = draw_tool(paper_datasheet(), 3);
  EXPECT_EQ(four.axes, draw_tool(paper_datasheet(), 3).axes);
  EXPECT_NE(four.axes, draw_tool(paper_datasheet(), 4).axes);
  Datasheet three = paper_datasheet();
  three.size = 3;
  const Tool fewer = draw_tool(three, 3);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(fewer.axes[i], four.axes[i]);
}

TEST(Truth, TemperatureCoefficientsScaleWithTheScaleFactor) {
  Datasheet sheet = paper_datasheet();
  sheet.sensor[0].coefficients.scale[1] = 1e-4 * kPaperScale_VpMps2;
  const Tool tool = draw_tool(sheet, 1);
  EXPECT_NEAR(tool.model.sensor[0].scale[1] / tool.model.sensor[0].scale[0], 1e-4, 1e-18);
}

}  // namespace
}  // namespace truth_test
}  // namespace scenario
}  // namespace plumb
