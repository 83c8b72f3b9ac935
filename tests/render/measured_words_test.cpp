#include "plumb/render/measured_words.hpp"
#include "plumb/render/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace measured_words_test {
namespace {

using plumb::render::angle_with_sigma;
using plumb::render::angle_words;
using plumb::render::depth_words;

TEST(MeasuredWords, ADepthIsToldToTheCentimetre) {
  EXPECT_EQ(depth_words(12345.67), "12345.67");
  EXPECT_EQ(depth_words(0.0), "0.00");
  EXPECT_EQ(depth_words(3.0), "3.00");
  EXPECT_EQ(depth_words(1234567.891), "1234567.89");
  EXPECT_EQ(depth_words(std::nan("")), "-");
}

TEST(MeasuredWords, AnAngleHasTheDigitsThatItsSigmaEarns) {
  EXPECT_EQ(angle_words(32.68412, 0.012), "32.684");
  EXPECT_EQ(angle_words(32.68412, 0.0017), "32.6841");
  EXPECT_EQ(angle_words(32.68412, 1.2), "32.7");
  EXPECT_EQ(angle_words(32.68412, 12.0), "33");
  EXPECT_EQ(angle_words(32.68412, 123.0), "33");
  EXPECT_EQ(angle_words(32.68412, 0.0996), "32.68");  // 0.10
  EXPECT_EQ(angle_words(32.68412, 0.0), "32.684");
  EXPECT_EQ(angle_words(32.68412, std::nan("")), "32.684");
  EXPECT_EQ(angle_words(std::nan(""), 0.1), "-");
  EXPECT_EQ(angle_with_sigma(65.533, 0.00171), "65.5330 ± 0.0017");
  EXPECT_EQ(angle_with_sigma(65.533, 1.14), "65.5 ± 1.1");
  EXPECT_EQ(angle_with_sigma(65.533, 0.0), "65.533");
}

TEST(MeasuredWords, AZeroHasNoMinusSign) {
  EXPECT_EQ(plumb::render::fixed_words(-0.0004, 3), "0.000");
  EXPECT_EQ(plumb::render::fixed_words(-0.0, 0), "0");
  EXPECT_EQ(plumb::render::fixed_words(-0.0006, 3), "-0.001");
  EXPECT_EQ(plumb::render::unsigned_zero("-0.000 mg0"), "0.000 mg0");
  EXPECT_EQ(plumb::render::unsigned_zero("-10"), "-10");
  EXPECT_EQ(plumb::render::unsigned_zero("-"), "-") << "no number";
  EXPECT_EQ(plumb::render::unsigned_zero(""), "");
  EXPECT_EQ(plumb::render::angle_words(-1e-5, 0.1), "0.00");
}

}  // namespace
}  // namespace measured_words_test
