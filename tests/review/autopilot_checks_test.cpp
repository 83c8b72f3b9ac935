// What a review makes of the autopilot's own words.
#include <gtest/gtest.h>

#include "flight.hpp"

namespace autopilot_checks_test {
namespace {

using plumb::logs::ChipStatus;
using plumb::review::Finding;
using plumb::review::FindingCode;
using plumb::review::Grade;
using plumb::review::LogDigest;
using plumb::review::LogDigester;
using plumb::review::LogReview;
using plumb::review::review_log;
using review_flight::Axes;
using review_flight::count_of;
using review_flight::first_of;
using review_flight::SimulatedFlight;
using review_flight::with_chips;
using Health = ChipStatus::Health;

/// Of the second of three chips, ten a second from `from_s` on.
std::vector<ChipStatus> statuses(double from_s, double to_s, Health health, double apart_mps2) {
  std::vector<ChipStatus> out;
  for (double t = from_s; t < to_s; t += 0.1) {
    ChipStatus one;
    one.time_s = t;
    one.device_id = 1001;
    one.health = health;
    one.inconsistency_mps2 = apart_mps2;
    out.push_back(one);
  }
  return out;
}

LogReview reviewed(const SimulatedFlight& flight, const std::vector<ChipStatus>& said) {
  LogDigester digester;
  for (const ChipStatus& one : said) digester.status(one);
  LogDigest digest = flight.digest();
  digest.statuses = digester.take("", {}).statuses;
  return review_log(digest);
}

TEST(AutopilotChecks, AChipThatTheAutopilotTookForFailedIsRed) {
  const LogReview review = reviewed(with_chips(3), statuses(20.0, 22.05, Health::failed, 0.0));
  const Finding* found = first_of(review, FindingCode::autopilot_failed);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(review.grade, Grade::red);
  EXPECT_EQ(found->chip, 1U);
  EXPECT_NEAR(found->figure, 21.0, 1.0);
  EXPECT_NEAR(found->from_s, 20.0, 0.01);
}

TEST(AutopilotChecks, TwoReportsOrReportsBeforeTheFirstReadingAreNone) {
  EXPECT_EQ(reviewed(with_chips(3), statuses(20.0, 20.15, Health::failed, 0.0)).grade, Grade::green);
  SimulatedFlight flight = with_chips(3);
  for (auto& chip : flight.chips) chip.from_s = 5.0;
  EXPECT_EQ(reviewed(flight, statuses(1.0, 4.0, Health::failed, 0.0)).grade, Grade::green);
}

TEST(AutopilotChecks, SoundReportsEndARun) {
  std::vector<ChipStatus> said;
  for (int k = 0; k < 10; ++k) {
    for (const Health health : {Health::failed, Health::failed, Health::sound})
      said.push_back(statuses(20.0 + k, 20.0 + k + 0.05, health, 0.0).front());
  }
  EXPECT_EQ(reviewed(with_chips(3), said).grade, Grade::green);
}

TEST(AutopilotChecks, ItsComparisonCountsAtRestOnly) {
  const LogReview rest = reviewed(with_chips(3), statuses(1.0, 9.0, Health::sound, 0.5));
  ASSERT_NE(first_of(rest, FindingCode::autopilot_apart), nullptr);
  EXPECT_EQ(rest.grade, Grade::orange);
  EXPECT_EQ(first_of(rest, FindingCode::autopilot_apart)->chip, 1U);
  EXPECT_DOUBLE_EQ(first_of(rest, FindingCode::autopilot_apart)->figure, 0.5);
  EXPECT_EQ(reviewed(with_chips(3), statuses(1.0, 9.0, Health::sound, 0.9)).grade, Grade::red);
  EXPECT_EQ(reviewed(with_chips(3), statuses(1.0, 9.0, Health::sound, 0.3)).grade, Grade::green);
  EXPECT_EQ(reviewed(with_chips(3), statuses(12.0, 30.0, Health::sound, 5.0)).grade, Grade::green);
}

TEST(AutopilotChecks, ItsComparisonAddsNothingWhereTheReadingsTellThemselves) {
  SimulatedFlight flight = with_chips(3);
  flight.chips[1].reads = [](double, Axes f) { return Axes{f[0] + 1.0, f[1], f[2]}; };
  const LogReview review = reviewed(flight, statuses(1.0, 9.0, Health::sound, 0.67));
  EXPECT_EQ(count_of(review, FindingCode::disagreement), 1U);
  EXPECT_EQ(count_of(review, FindingCode::autopilot_apart), 0U);
}

TEST(AutopilotChecks, ItsMeasureOfVibrationCountsForSlowChipsAndThreeReportsInARow) {
  SimulatedFlight flight = with_chips(1);
  flight.chips[0].rate_hz = 10.0;
  const auto vibrating = [](int reports) {
    std::vector<ChipStatus> out;
    for (int k = 0; k < reports; ++k) {
      ChipStatus one;
      one.time_s = 20.0 + 0.1 * k;
      one.vibration_mps2 = {5.0, 5.0, 42.0};
      out.push_back(one);
    }
    return out;
  };
  const LogReview review = reviewed(flight, vibrating(3));
  ASSERT_EQ(count_of(review, FindingCode::vibration), 1U);
  EXPECT_EQ(first_of(review, FindingCode::vibration)->axis, 2);
  EXPECT_DOUBLE_EQ(first_of(review, FindingCode::vibration)->figure, 42.0);
  EXPECT_EQ(count_of(reviewed(flight, vibrating(2)), FindingCode::vibration), 0U);
  flight.chips[0].rate_hz = 100.0;
  EXPECT_EQ(count_of(reviewed(flight, vibrating(3)), FindingCode::vibration), 0U);
}

TEST(AutopilotChecks, LongLogsKeepTheLeastOfEachBlock) {
  LogDigester digester(8);
  for (const ChipStatus& one : statuses(0.0, 100.0, Health::sound, 0.5)) digester.status(one);
  const LogDigest digest = digester.take("", {});
  ASSERT_EQ(digest.statuses.size(), 1U);
  EXPECT_LE(digest.statuses[0].apart_mps2.size(), 8U);
  EXPECT_GE(digest.block_s, 16.0);
  for (const auto& [block, apart] : digest.statuses[0].apart_mps2) EXPECT_DOUBLE_EQ(apart, 0.5);
}

TEST(AutopilotChecks, OfTwoThatDifferTheOneToldElsewhereIsLikely) {
  SimulatedFlight flight = with_chips(3);
  flight.motion_s = 60.0;
  flight.chips[0].reads = [](double, Axes f) { return Axes{f[0], f[1] + 1.5, f[2]}; };
  flight.chips[2].to_s = 40.0;  // from there on two are left
  const LogReview review = flight.review();
  ASSERT_EQ(count_of(review, FindingCode::disagreement), 1U);
  bool seen = false;
  for (const Finding& finding : review.findings) {
    if (finding.other == plumb::review::kNoChip) continue;
    seen = true;
    EXPECT_EQ(finding.likely, 0U);
  }
  EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace autopilot_checks_test
