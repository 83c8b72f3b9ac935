#include "plumb/io/exact_text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdint>

namespace exact_text_test {
namespace {

using namespace plumb;
using namespace plumb::io;

TEST(ExactText, TheShortestThatReadsBack) {
  EXPECT_EQ(exact_text(Quantity::acceleration, 2e-4 * kG0_mps2, {"ug0", "m/s^2"}), "200 ug0");
  EXPECT_EQ(exact_text(Quantity::acceleration, 0.001, {"ug0", "m/s^2"}), "0.001 m/s^2");
  EXPECT_EQ(exact_text(Quantity::rate, 100.0, {"kHz", "Hz"}), "100 Hz");
}

RC_GTEST_PROP(ExactTextLaw, ReadsBackAsTheSameNumber, ()) {
  const double value = std::ldexp(static_cast<double>(*rc::gen::arbitrary<std::int32_t>()), *rc::gen::inRange(-60, 20));
  const FileExpected<double> back =
      parse_quantity(Quantity::acceleration, exact_text(Quantity::acceleration, value, {"ug0", "mg0", "g0", "m/s^2"}));
  RC_ASSERT(back.has_value());
  RC_ASSERT(*back == value);
}

}  // namespace
}  // namespace exact_text_test
