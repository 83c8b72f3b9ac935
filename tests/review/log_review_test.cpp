#include "plumb/review/log_review.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "flight.hpp"

namespace {

using plumb::review::FindingCode;
using plumb::review::Grade;
using plumb::review::kNoChip;
using plumb::review::LogReview;
using plumb::review::OpenQuestion;
using review_flight::Axes;
using review_flight::count_of;
using review_flight::first_of;
using review_flight::SimulatedFlight;
using review_flight::with_chips;

bool is_open(const LogReview& review, OpenQuestion question) {
  return std::find(review.open.begin(), review.open.end(), question) != review.open.end();
}

std::function<Axes(double, Axes)> plus(double x, double y, double z, double from_s = 0.0) {
  return [=](double time_s, Axes f) {
    if (time_s < from_s) return f;
    return Axes{f[0] + x, f[1] + y, f[2] + z};
  };
}

}  // namespace

TEST(LogReview, SoundChipsAreGreenAndJudged) {
  for (int chips = 1; chips <= 4; ++chips) {
    const LogReview review = with_chips(chips).review();
    EXPECT_EQ(review.grade, Grade::green) << chips;
    EXPECT_TRUE(review.findings.empty()) << chips;
    EXPECT_TRUE(review.judged);
    EXPECT_EQ(review.chips.size(), static_cast<std::size_t>(chips));
    EXPECT_NEAR(review.at_rest_s, 10.0, 1.1);
    EXPECT_EQ(is_open(review, OpenQuestion::one_chip), chips == 1);
    EXPECT_EQ(is_open(review, OpenQuestion::two_chips), chips == 2);
    EXPECT_TRUE(is_open(review, OpenQuestion::one_attitude));
  }
}

// Errors that calibrated sensors have, anywhere, are no finding.
RC_GTEST_PROP(LogReviewLaw, ErrorsOfSoundSensorsNameNobody, ()) {
  SimulatedFlight flight = with_chips(*rc::gen::inRange(1, 5));
  flight.seed = *rc::gen::arbitrary<unsigned>();
  flight.vibration_mps2 = 0.1 * *rc::gen::inRange(0, 60);
  flight.rate_radps = 0.1 * *rc::gen::inRange(0, 40);
  flight.gyro = *rc::gen::arbitrary<bool>();
  for (auto& chip : flight.chips) {
    const auto error = [] { return 0.001 * *rc::gen::inRange(-90, 91); };  // 0.16 m/s^2 in all, two differ by 0.31
    const Axes e = {error(), error(), error()};
    chip.reads = plus(e[0], e[1], e[2]);
    chip.rate_hz = *rc::gen::element(20.0, 50.0, 200.0);
    chip.noise_mps2 = 0.001 * *rc::gen::inRange(1, 40);
  }
  const LogReview review = flight.review();
  RC_ASSERT(review.findings.empty());
}

// Of three or more chips with one that is off, that one is named and no other, at rest and in motion.
RC_GTEST_PROP(LogReviewLaw, TheOneThatIsOffIsNamed, ()) {
  SimulatedFlight flight = with_chips(*rc::gen::inRange(3, 6));
  flight.seed = *rc::gen::arbitrary<unsigned>();
  const auto bad = *rc::gen::inRange<std::size_t>(0, flight.chips.size());
  const auto axis = *rc::gen::inRange<std::size_t>(0, 3);
  const double size = 0.1 * *rc::gen::inRange(10, 40) * (*rc::gen::arbitrary<bool>() ? 1.0 : -1.0);
  Axes error{};
  error[axis] = size;
  const double from_s = *rc::gen::element(0.0, 15.0);
  flight.chips[bad].reads = plus(error[0], error[1], error[2], from_s);
  const LogReview review = flight.review();
  RC_ASSERT(review.grade == Grade::red || (review.grade == Grade::orange && std::abs(size) < 1.6));
  const FindingCode code = from_s > 0.0 ? FindingCode::motion_disagreement : FindingCode::disagreement;
  const auto* const finding = first_of(review, code);
  RC_ASSERT(finding != nullptr);
  for (const auto& one : review.findings) {
    RC_ASSERT(one.chip == bad);
    RC_ASSERT(one.other == kNoChip);
  }
  RC_ASSERT(std::abs(finding->figure - std::abs(size)) < 0.3);
  if (from_s > 0.0) RC_ASSERT(finding->from_s >= from_s - 5.0);  // readings are averaged over nine cells
}

TEST(LogReview, OfTwoThatDifferAcrossGravityNeitherIsNamed) {
  SimulatedFlight flight = with_chips(2);
  flight.chips[1].reads = plus(1.5, 0.0, 0.0);
  const LogReview review = flight.review();
  const auto* const finding = first_of(review, FindingCode::disagreement);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->chip, 0U);
  EXPECT_EQ(finding->other, 1U);
  EXPECT_FALSE(finding->told_by_length);
  EXPECT_EQ(finding->grade, Grade::red);
}

TEST(LogReview, OfTwoTheOneWhoseLengthIsWrongIsNamed) {
  SimulatedFlight flight = with_chips(2);
  flight.chips[1].reads = plus(0.0, 0.0, 1.5);
  const LogReview review = flight.review();
  const auto* const finding = first_of(review, FindingCode::disagreement);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->chip, 1U);
  EXPECT_EQ(finding->other, kNoChip);
  EXPECT_TRUE(finding->told_by_length);
  ASSERT_NE(first_of(review, FindingCode::gravity_length), nullptr);
  EXPECT_NEAR(first_of(review, FindingCode::gravity_length)->figure, -1.5, 0.05);
}

// A wrong length does not make a chip answerable for a difference that it does not explain.
TEST(LogReview, ALengthThatDoesNotExplainTheDifferenceNamesNobody) {
  SimulatedFlight flight = with_chips(2);
  flight.chips[1].reads = plus(0.0, 0.0, 0.5);
  flight.chips[0].reads = plus(1.5, 0.0, 0.0);
  const LogReview review = flight.review();
  const auto* const again = first_of(review, FindingCode::disagreement);
  ASSERT_NE(again, nullptr);
  EXPECT_NE(again->other, kNoChip);
}

// Three that all differ: no majority, nobody is named.
TEST(LogReview, WhereNoTwoAgreeNobodyIsNamed) {
  SimulatedFlight flight = with_chips(3);
  flight.chips[1].reads = plus(1.0, 0.0, 0.0);
  flight.chips[2].reads = plus(-1.0, 0.0, 0.0);
  const LogReview review = flight.review();
  const auto* const finding = first_of(review, FindingCode::disagreement);
  ASSERT_NE(finding, nullptr);
  EXPECT_NE(finding->other, kNoChip);
}

TEST(LogReview, ADriftingAxisIsNamedFromWhereItLeavesTheOthers) {
  SimulatedFlight flight = with_chips(3);
  flight.motion_s = 110.0;
  flight.chips[2].reads = [](double t, Axes f) { return Axes{f[0] + 0.02 * std::max(0.0, t - 20.0), f[1], f[2]}; };
  const LogReview review = flight.review();
  const auto* const finding = first_of(review, FindingCode::motion_disagreement);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->chip, 2U);
  EXPECT_GT(finding->from_s, 37.0);
  EXPECT_LT(finding->from_s, 75.0);
}

TEST(LogReview, AStuckAxisIsRedInMotionAndItsChipIsNamed) {
  SimulatedFlight flight = with_chips(3);
  flight.chips[0].reads = [](double t, Axes f) { return t < 20.0 ? f : Axes{f[0], 0.25, f[2]}; };
  const LogReview review = flight.review();
  const auto* const finding = first_of(review, FindingCode::axis_stuck);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->chip, 0U);
  EXPECT_EQ(finding->axis, 1);
  EXPECT_EQ(finding->grade, Grade::red);
  EXPECT_NEAR(finding->from_s, 20.0, 1.0);
  EXPECT_DOUBLE_EQ(finding->figure, 0.25);
}

TEST(LogReview, AFrozenChipIsOneFindingNotThree) {
  SimulatedFlight flight = with_chips(2);
  flight.chips[1].reads = [](double t, Axes f) { return t < 20.0 ? f : Axes{0.0, 0.0, -9.81}; };
  const LogReview review = flight.review();
  EXPECT_EQ(count_of(review, FindingCode::chip_frozen), 1U);
  EXPECT_EQ(count_of(review, FindingCode::axis_stuck), 0U);
}

// A coarse sensor at rest reads the same for long: no finding.
TEST(LogReview, ACoarseSensorAtRestIsNotStuck) {
  SimulatedFlight flight = with_chips(3);
  flight.motion_s = 0.0;
  flight.rest_s = 60.0;
  for (auto& chip : flight.chips) {
    chip.reads = [](double, Axes f) {
      return Axes{0.1 * std::round(f[0] / 0.1), 0.1 * std::round(f[1] / 0.1), 0.1 * std::round(f[2] / 0.1)};
    };
  }
  const LogReview review = flight.review();
  EXPECT_EQ(count_of(review, FindingCode::axis_stuck), 0U);
}

TEST(LogReview, AChipThatFallsSilentIsSaid) {
  SimulatedFlight flight = with_chips(3);
  flight.chips[1].to_s = 25.0;
  const LogReview review = flight.review();
  const auto* const finding = first_of(review, FindingCode::stopped);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->chip, 1U);
  EXPECT_NEAR(finding->figure, 15.0, 0.1);
  EXPECT_EQ(count_of(review, FindingCode::stopped), 1U);
}

TEST(LogReview, OtherAxesAreAMountingNotAFault) {
  SimulatedFlight flight = with_chips(3);
  flight.chips[1].reads = [](double, Axes f) { return Axes{f[2], f[1], -f[0]}; };
  const LogReview review = flight.review();
  const auto* const finding = first_of(review, FindingCode::orientation);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->chip, 1U);
  EXPECT_NEAR(finding->figure, 90.0, 2.0);
  EXPECT_EQ(count_of(review, FindingCode::motion_disagreement), 0U);
}

TEST(LogReview, ScatterFarAboveTheOthersIsNoise) {
  SimulatedFlight flight = with_chips(4);
  flight.chips[3].noise_mps2 = 0.15;
  const LogReview review = flight.review();
  ASSERT_EQ(count_of(review, FindingCode::noise), 3U);
  EXPECT_EQ(first_of(review, FindingCode::noise)->chip, 3U);
}

TEST(LogReview, AReadingThatWandersAtRestIsDriftOfThatChip) {
  SimulatedFlight flight = with_chips(3);
  flight.rest_s = 120.0;
  flight.motion_s = 0.0;
  flight.chips[1].reads = [](double t, Axes f) { return Axes{f[0] + 0.0025 * t, f[1], f[2]}; };
  const LogReview review = flight.review();
  const auto* const finding = first_of(review, FindingCode::drift);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->chip, 1U);
  EXPECT_NEAR(finding->figure, 0.2, 0.02);
}

TEST(LogReview, WithoutAnythingToCompareNothingIsJudged) {
  SimulatedFlight flight = with_chips(1);
  flight.rest_s = 0.0;
  EXPECT_FALSE(flight.review().judged);
  EXPECT_TRUE(is_open(flight.review(), OpenQuestion::never_at_rest));
  EXPECT_FALSE(with_chips(0).review().judged);
}

TEST(LogReview, GravityThatIsGivenIsJudgedBy) {
  SimulatedFlight flight = with_chips(1);
  flight.gravity_mps2 = 9.3;
  EXPECT_EQ(flight.review().grade, Grade::orange);
  plumb::review::ReviewSettings settings;
  settings.gravity_mps2 = 9.3;
  EXPECT_EQ(plumb::review::review_log(flight.digest(), settings).grade, Grade::green);
}

TEST(LogReview, ReadingsBeforeTheCalibrationGetIt) {
  plumb::review::LogDigester digester;
  plumb::logs::ImuSource source;
  source.name = "sensor_accel[0]";
  source.device_id = 77;
  source.uncalibrated = true;
  digester.source(0, source);
  digester.parameter("CAL_ACC1_ID", 77.0);
  digester.parameter("CAL_ACC1_ZOFF", 1.0);
  digester.parameter("CAL_ACC1_ZSCALE", 1.09);
  for (int k = 0; k < 1000; ++k) {
    plumb::logs::ImuRecord record;
    record.time_s = 0.01 * k;
    record.specific_force_mps2 = {0.0, 0.01 * (k % 3), -8.0 + 0.01 * (k % 2)};
    digester.record(0, record);
  }
  const LogReview review = plumb::review::review_log(digester.take("log", {}));
  ASSERT_EQ(review.stretches.size(), 1U);
  EXPECT_NEAR(review.stretches[0].mean_mps2[0][2], (-7.995 - 1.0) * 1.09, 1e-9);
  EXPECT_TRUE(review.chips[0].calibration.applied_here);
}

TEST(LogReview, WhatPx4ChoseIsNoChipBesideTheOnesItChoseFrom) {
  plumb::review::LogDigester digester;
  const char* const names[] = {"sensor_combined[0]", "vehicle_imu[0]", "sensor_accel[0]", "vehicle_imu[1]"};
  const std::uint64_t devices[] = {0, 11, 11, 22};
  for (std::size_t k = 0; k < 4; ++k) {
    plumb::logs::ImuSource source;
    source.name = names[k];
    source.instance = k == 3 ? 1 : 0;
    source.device_id = devices[k];
    digester.source(k, source);
    for (int i = 0; i < 100; ++i) {
      plumb::logs::ImuRecord record;
      record.time_s = 0.1 * i;
      record.specific_force_mps2 = {0.01 * (i % 2), 0.01 * (i % 3), -9.81 + 0.01 * (i % 5)};
      digester.record(k, record);
    }
  }
  const LogReview review = plumb::review::review_log(digester.take("log", {}));
  ASSERT_EQ(review.chips.size(), 2U);
  EXPECT_EQ(review.chips[0].sources.size(), 2U);
  EXPECT_EQ(review.chips[0].name, "vehicle_imu[0]");
  EXPECT_EQ(review.chips[1].device_id, 22U);
}

// What an attack found. A noisy gyro, a slow chip, one wrong time, a chip that is turned beside one that is off.
TEST(LogReview, ANoisyGyroHidesNoDisagreement) {
  SimulatedFlight flight = with_chips(3);
  flight.rate_radps = 1.2;
  flight.chips[1].reads = plus(3.0, 0.0, 0.0, 15.0);
  EXPECT_NE(first_of(flight.review(), FindingCode::motion_disagreement), nullptr);
}

TEST(LogReview, ASlowChipIsComparedInLongerCells) {
  SimulatedFlight flight = with_chips(3);
  flight.rest_s = 0.0;
  flight.motion_s = 120.0;
  flight.chips[2].rate_hz = 2.0;
  flight.chips[2].reads = plus(5.0, 0.0, 0.0);
  EXPECT_EQ(flight.review().grade, Grade::red);
}

TEST(LogReview, AChipThatIsNotComparedIsSaid) {
  SimulatedFlight flight = with_chips(3);
  flight.chips[2].rate_hz = 0.1;
  flight.chips[2].reads = plus(4.0, 0.0, 0.0);
  const LogReview review = flight.review();
  EXPECT_TRUE(is_open(review, OpenQuestion::not_compared));
  EXPECT_FALSE(review.chips[2].compared);
  EXPECT_TRUE(review.chips[0].compared);
}

TEST(LogReview, OneWrongTimeStopsNoOtherChip) {
  SimulatedFlight flight = with_chips(2);
  plumb::review::LogDigest digest = flight.digest();
  plumb::review::SourceBlock stray = digest.sources[0].blocks.back();
  stray.index += 3600;
  stray.records = 1;
  digest.sources[0].blocks.push_back(stray);
  digest.sources[0].last_s += 3600.0;
  const LogReview review = plumb::review::review_log(digest);
  EXPECT_EQ(count_of(review, FindingCode::stopped), 0U);
  EXPECT_EQ(count_of(review, FindingCode::stray), 1U);
  EXPECT_LT(review.to_s, 60.0);
}

TEST(LogReview, ATurnedChipHidesNoDisagreementOfTheOthers) {
  SimulatedFlight flight = with_chips(3);
  flight.chips[1].reads = plus(2.2, 0.0, 0.0);
  flight.chips[2].reads = [](double, Axes f) { return Axes{f[2], f[1], -f[0]}; };
  const LogReview review = flight.review();
  EXPECT_EQ(count_of(review, FindingCode::orientation), 1U);
  EXPECT_EQ(first_of(review, FindingCode::orientation)->chip, 2U);
  EXPECT_EQ(count_of(review, FindingCode::disagreement), 1U);
  EXPECT_EQ(review.grade, Grade::red);
}

TEST(LogReview, AFreezeThatFillsNoWholeBlockIsSeen) {
  SimulatedFlight flight = with_chips(3);
  flight.chips[0].rate_hz = 500.0;
  flight.chips[0].reads = [](double t, Axes f) { return t > 20.5 && t < 22.4 ? Axes{1.0, 1.0, -9.0} : f; };
  const LogReview review = flight.review();
  ASSERT_NE(first_of(review, FindingCode::chip_frozen), nullptr);
  EXPECT_NEAR(first_of(review, FindingCode::chip_frozen)->from_s, 20.5, 0.01);
}

TEST(LogReview, WhatAllReadAlikeIsNoFaultOfAnyChip) {
  SimulatedFlight flight = with_chips(3);
  flight.gravity_mps2 = 12.0;
  flight.gyro = false;
  const LogReview review = flight.review();
  EXPECT_EQ(count_of(review, FindingCode::common_length), 1U);
  EXPECT_EQ(count_of(review, FindingCode::gravity_length), 0U);
}

TEST(LogReview, AChipThatBeginsLateIsSaid) {
  SimulatedFlight flight = with_chips(3);
  flight.chips[1].from_s = 12.0;
  ASSERT_NE(first_of(flight.review(), FindingCode::late), nullptr);
  EXPECT_EQ(first_of(flight.review(), FindingCode::late)->chip, 1U);
}
