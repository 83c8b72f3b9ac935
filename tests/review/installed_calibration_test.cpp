// What an autopilot has installed: calibrations that are applied here and those that are not, chips switched off, and
// clips counted by axis.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "flight.hpp"
#include "plumb/review/log_import.hpp"

namespace installed_calibration_test {
namespace {

using namespace plumb::review;
using review_flight::count_of;
using review_flight::first_of;
using review_flight::SimulatedFlight;
using review_flight::with_chips;

bool leaves_open(const LogReview& review, OpenQuestion question) {
  return std::find(review.open.begin(), review.open.end(), question) != review.open.end();
}

/// Three chips of PX4 whose log holds readings before the calibration; the second reads `offset` too much along x, and
/// has that offset in its parameters.
LogDigest raw_px4(double offset_mps2) {
  SimulatedFlight flight = with_chips(3);
  for (std::size_t k = 0; k < 3; ++k) flight.chips[k].name = "sensor_accel[" + std::to_string(k) + "]";
  flight.chips[1].reads = [offset_mps2](double, Axes f) { return Axes{f[0] + offset_mps2, f[1], f[2]}; };
  LogDigest digest = flight.digest();
  for (std::size_t k = 0; k < 3; ++k) {
    digest.sources[k].source.uncalibrated = true;
    const std::string prefix = "CAL_ACC" + std::to_string(k) + "_";
    digest.parameters[prefix + "ID"] = 1000.0 + static_cast<double>(k);
    digest.parameters[prefix + "PRIO"] = 50.0;
    digest.parameters[prefix + "XOFF"] = k == 1 ? offset_mps2 : 0.01;
  }
  return digest;
}

TEST(InstalledCalibration, OffsetsOfPx4AreTakenFromReadingsBeforeThem) {
  LogDigest digest = raw_px4(1.5);
  const LogReview with = review_log(digest);
  EXPECT_EQ(with.grade, Grade::green);
  EXPECT_TRUE(with.chips[1].compared);
  EXPECT_TRUE(with.chips[1].calibration.applied_here);
  EXPECT_FALSE(leaves_open(with, OpenQuestion::more_calibration));
  digest.parameters.erase("CAL_ACC1_XOFF");
  const LogReview without = review_log(digest);
  ASSERT_NE(first_of(without, FindingCode::disagreement), nullptr);
  EXPECT_EQ(first_of(without, FindingCode::disagreement)->chip, 1U);
}

// A correction by temperature stands in TC_A* and changes with it: what is left of a difference says nothing then.
TEST(InstalledCalibration, ReadingsThatPx4CorrectsByTemperatureAreNotComparedBeforeIt) {
  LogDigest digest = raw_px4(1.5);
  digest.parameters["TC_A_ENABLE"] = 1.0;
  digest.parameters["TC_A1_ID"] = 1001.0;
  digest.parameters["TC_A1_X0_0"] = 1.4;
  digest.parameters["CAL_ACC1_XOFF"] = 0.1;
  const LogReview review = review_log(digest);
  EXPECT_EQ(count_of(review, FindingCode::disagreement), 0U);
  EXPECT_EQ(count_of(review, FindingCode::motion_disagreement), 0U);
  EXPECT_TRUE(leaves_open(review, OpenQuestion::more_calibration));
  EXPECT_FALSE(leaves_open(review, OpenQuestion::not_compared)) << "the reason is said once";
  for (const ChipSummary& chip : review.chips) EXPECT_FALSE(chip.compared) << chip.name;
  // Nor are coefficients made of half of what the autopilot applies.
  const auto plan = plan_import(digest, review);
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->coefficients_text, "");

  digest.parameters["TC_A_ENABLE"] = 0.0;
  const LogReview off = review_log(digest);
  EXPECT_FALSE(leaves_open(off, OpenQuestion::more_calibration));
  ASSERT_NE(first_of(off, FindingCode::disagreement), nullptr);
  EXPECT_EQ(first_of(off, FindingCode::disagreement)->chip, 1U);
}

// What PX4 hands on has been corrected: there the same parameters are no reason to leave a chip out.
TEST(InstalledCalibration, CorrectedReadingsAreComparedWhateverTheAutopilotCorrects) {
  LogDigest digest = raw_px4(1.5);
  for (SourceDigest& source : digest.sources) source.source.uncalibrated = false;
  digest.parameters["TC_A_ENABLE"] = 1.0;
  const LogReview review = review_log(digest);
  EXPECT_FALSE(leaves_open(review, OpenQuestion::more_calibration));
  ASSERT_NE(first_of(review, FindingCode::disagreement), nullptr);
  EXPECT_EQ(first_of(review, FindingCode::disagreement)->chip, 1U);
}

TEST(InstalledCalibration, AChipSwitchedOffIsSaidAndStillJudged) {
  LogDigest digest = raw_px4(0.02);
  digest.parameters["CAL_ACC2_PRIO"] = 0.0;
  const LogReview review = review_log(digest);
  EXPECT_EQ(review.grade, Grade::green);
  ASSERT_EQ(review.findings.size(), 1U);
  EXPECT_EQ(review.findings[0].code, FindingCode::disabled);
  EXPECT_EQ(review.findings[0].grade, Grade::green);
  EXPECT_EQ(review.findings[0].chip, 2U);
  EXPECT_TRUE(review.chips[2].disabled);
  EXPECT_FALSE(review.chips[1].disabled);
  EXPECT_TRUE(review.chips[2].compared);

  digest = raw_px4(1.5);
  digest.parameters.erase("CAL_ACC1_XOFF");
  digest.parameters["CAL_ACC1_PRIO"] = 0.0;
  const LogReview bad = review_log(digest);
  EXPECT_EQ(bad.grade, Grade::red);
  EXPECT_EQ(bad.findings.front().code, FindingCode::disagreement) << "the worst comes first";
  EXPECT_EQ(count_of(bad, FindingCode::disabled), 1U);
}

// The slot of the device counts, not the number of the instance; -1 is "not set yet".
TEST(InstalledCalibration, OnlyThePriorityOfTheDeviceItselfSwitchesOff) {
  LogDigest digest = raw_px4(0.02);
  digest.parameters["CAL_ACC0_PRIO"] = -1.0;
  digest.parameters["CAL_ACC3_PRIO"] = 0.0;
  digest.parameters["CAL_ACC3_ID"] = 0.0;
  EXPECT_EQ(count_of(review_log(digest), FindingCode::disabled), 0U);
}

TEST(InstalledCalibration, ArduPilotSwitchesOffByInsUse) {
  LogDigest digest = with_chips(3).digest();
  digest.parameters["INS_USE"] = 1.0;
  digest.parameters["INS_USE2"] = 1.0;
  digest.parameters["INS_USE3"] = 0.0;
  const LogReview review = review_log(digest);
  ASSERT_EQ(count_of(review, FindingCode::disabled), 1U);
  EXPECT_EQ(first_of(review, FindingCode::disabled)->chip, 2U);
  EXPECT_TRUE(leaves_open(review, OpenQuestion::no_calibration_in_log)) << "INS_USE is no calibration";
}

void clip(LogDigest& digest, std::size_t source, std::size_t axis, std::uint64_t count) {
  digest.sources[source].blocks.at(12).clipped[axis] += count;
}

// Three axes that clip in the same shock are three counts, not one three times as large; nor do two messages of a chip
// that count the same clips add up.
TEST(Clips, AreCountedByAxisAndNotAddedUpOverAxesAndMessages) {
  LogDigest digest = with_chips(2).digest();
  for (std::size_t axis = 0; axis < 3; ++axis) clip(digest, 0, axis, 90);
  EXPECT_EQ(review_log(digest).chips[0].clipped, 90U);
  EXPECT_EQ(count_of(review_log(digest), FindingCode::clipping), 0U);

  clip(digest, 0, 2, 20);
  LogReview review = review_log(digest);
  ASSERT_EQ(count_of(review, FindingCode::clipping), 1U);
  EXPECT_EQ(first_of(review, FindingCode::clipping)->chip, 0U);
  EXPECT_DOUBLE_EQ(first_of(review, FindingCode::clipping)->figure, 110.0);
  EXPECT_EQ(review.chips[1].clipped, 0U);

  digest.sources[1].source.device_id = digest.sources[0].source.device_id;
  for (std::size_t axis = 0; axis < 3; ++axis) clip(digest, 1, axis, 105);
  review = review_log(digest);
  ASSERT_EQ(review.chips.size(), 1U);
  EXPECT_EQ(review.chips[0].clipped, 110U);
}

// Whatever each axis counts in whichever seconds: the figure is that of the axis with most.
RC_GTEST_PROP(ClipsLaw, TheFigureIsThatOfTheAxisWithMost, ()) {
  LogDigest digest = with_chips(1).digest();
  std::array<std::uint64_t, 3> sums{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::size_t block : {std::size_t{3}, std::size_t{15}, std::size_t{30}}) {
      const auto count = *rc::gen::inRange<std::uint64_t>(0, 120);
      digest.sources[0].blocks.at(block).clipped[axis] = count;
      sums[axis] += count;
    }
  }
  const std::uint64_t most = *std::max_element(sums.begin(), sums.end());
  const LogReview review = review_log(digest);
  RC_ASSERT(review.chips[0].clipped == most);
  RC_ASSERT(count_of(review, FindingCode::clipping) == (most > 100U ? 1U : 0U));
}

}  // namespace
}  // namespace installed_calibration_test
