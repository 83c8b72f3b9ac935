#include "plumb/review/log_digest.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

namespace {

using plumb::logs::ImuRecord;
using plumb::review::Intervals;
using plumb::review::LogDigest;
using plumb::review::LogDigester;
using plumb::review::SourceBlock;

ImuRecord reading(double time_s, double x) {
  ImuRecord out;
  out.time_s = time_s;
  out.specific_force_mps2 = {x, 2.0 * x, -x};
  return out;
}

LogDigest digest_of(const std::vector<ImuRecord>& records, std::size_t most_blocks) {
  LogDigester digester(most_blocks);
  digester.source(0, {});
  for (const ImuRecord& record : records) digester.record(0, record);
  return digester.take("log", {});
}

SourceBlock whole(const LogDigest& digest) {
  SourceBlock out;
  for (const SourceBlock& block : digest.sources[0].blocks) out.add(block);
  return out;
}

}  // namespace

// What is kept does not depend on how the log was cut: any number of blocks gives the moments of all readings.
RC_GTEST_PROP(LogDigestLaw, MomentsAreThoseOfAllReadingsHoweverManyBlocks, ()) {
  const auto values = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-1000, 1000)));
  const auto most = *rc::gen::inRange<std::size_t>(1, 9);
  std::vector<ImuRecord> records;
  for (std::size_t k = 0; k < values.size(); ++k)
    records.push_back(reading(0.3 * static_cast<double>(k) - 4.0, values[k]));
  const LogDigest digest = digest_of(records, most);
  double mean = 0.0;
  for (const int v : values) mean += v;
  mean /= static_cast<double>(values.size());
  double squares = 0.0;
  for (const int v : values) squares += (v - mean) * (v - mean);
  const SourceBlock all = whole(digest);
  // Two blocks, before and after zero, never join.
  RC_ASSERT(digest.sources[0].blocks.size() <= std::max<std::size_t>(most, 2));
  RC_ASSERT(all.records == values.size());
  RC_ASSERT(std::abs(all.mean_mps2[0] - mean) < 1e-9);
  RC_ASSERT(std::abs(all.mean_mps2[1] - 2.0 * mean) < 1e-9);
  RC_ASSERT(std::abs(all.squares_m2ps4[2] - squares) < 1e-6 * (1.0 + squares));
  RC_ASSERT(digest.sources[0].records == values.size());
}

// Whatever the times are, memory is bounded and every reading is counted or said to be unreadable.
RC_GTEST_PROP(LogDigestLaw, AnyTimesStayWithinTheBlocks, ()) {
  const auto exponents = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-60, 330));
  std::vector<ImuRecord> records;
  double sign = 1.0;
  for (const int e : exponents) records.push_back(reading((sign = -sign) * std::pow(10.0, e), 1.0));
  const LogDigest digest = digest_of(records, 4);
  RC_ASSERT(digest.sources[0].blocks.size() <= 4U);
  RC_ASSERT(digest.sources[0].records + digest.sources[0].unreadable == records.size());
  RC_ASSERT(whole(digest).records == digest.sources[0].records);
  for (std::size_t k = 1; k < digest.sources[0].blocks.size(); ++k)
    RC_ASSERT(digest.sources[0].blocks[k - 1].index < digest.sources[0].blocks[k].index);
}

TEST(LogDigest, AMeanWithAVarianceCountsTheReadingsBehindIt) {
  ImuRecord mean = reading(0.0, 1.0);
  mean.count = 5;
  mean.variance_m2ps4 = {0.04, 0.0, 0.0};
  const SourceBlock block = whole(digest_of({mean, mean}, 8));
  EXPECT_DOUBLE_EQ(block.weight, 10.0);
  EXPECT_EQ(block.records, 2U);
  // 2 x 4 x 0.04 over 9.
  EXPECT_NEAR(block.deviation_mps2(0), std::sqrt(0.32 / 9.0), 1e-12);
  EXPECT_DOUBLE_EQ(block.deviation_mps2(1), 0.0);
}

TEST(LogDigest, ReadingsWithoutATimeOrAnAxisAreCountedAndLeftOut) {
  ImuRecord timeless = reading(NAN, 1.0);
  ImuRecord broken = reading(1.0, 1.0);
  broken.specific_force_mps2[1] = NAN;
  ImuRecord far = reading(1.0e300, 1.0);
  const LogDigest digest = digest_of({timeless, broken, far, reading(2.0, 1.0)}, 8);
  EXPECT_EQ(digest.sources[0].unreadable, 3U);
  EXPECT_EQ(digest.sources[0].records, 1U);
}

TEST(LogDigest, ATimeThatGoesBackIsCountedAndGoesIntoItsBlock) {
  const LogDigest digest = digest_of({reading(5.5, 1.0), reading(7.5, 1.0), reading(5.6, 3.0)}, 8);
  EXPECT_EQ(digest.sources[0].backwards, 1U);
  ASSERT_EQ(digest.sources[0].blocks.size(), 2U);
  EXPECT_EQ(digest.sources[0].blocks[0].records, 2U);
  EXPECT_DOUBLE_EQ(digest.sources[0].blocks[0].mean_mps2[0], 2.0);
}

TEST(LogDigest, OnlyParametersOfAccelerometersAreKept) {
  LogDigester digester;
  digester.parameter("CAL_ACC0_XOFF", 0.5);
  digester.parameter("INS_ACC2OFFS_X", 0.25);
  digester.parameter("BATT_V_DIV", 3.0);
  const LogDigest digest = digester.take("log", {});
  EXPECT_EQ(digest.parameters.size(), 2U);
  EXPECT_DOUBLE_EQ(digest.parameters.at("CAL_ACC0_XOFF"), 0.5);
}

TEST(Intervals, TheUsualOneIsTheMedianAndGapsAreWhatIsMuchLonger) {
  Intervals intervals;
  EXPECT_TRUE(std::isnan(intervals.usual_s()));
  for (int k = 0; k < 1000; ++k) intervals.add(0.004);
  for (int k = 0; k < 3; ++k) intervals.add(1.0);
  EXPECT_NEAR(intervals.usual_s(), 0.004, 1e-12);
  EXPECT_EQ(intervals.gaps(5.0).count, 3U);
  EXPECT_NEAR(intervals.gaps(5.0).lost_s, 3.0 * 0.996, 1e-9);
  intervals.add(-1.0);
  intervals.add(NAN);
  EXPECT_EQ(intervals.gaps(5.0).count, 3U);
}

TEST(LogDigest, TheFirstValueOfAParameterCountsAndWhatIsNoNumberIsLeftOut) {
  LogDigester digester;
  digester.parameter("CAL_ACC0_XOFF", 0.5);
  digester.parameter("CAL_ACC0_XOFF", 0.0);
  digester.parameter("CAL_ACC0_YOFF", NAN);
  const LogDigest digest = digester.take("log", {});
  EXPECT_DOUBLE_EQ(digest.parameters.at("CAL_ACC0_XOFF"), 0.5);
  EXPECT_EQ(digest.parameters.count("CAL_ACC0_YOFF"), 0U);
  EXPECT_EQ(digest.notes.size(), 2U);
}

TEST(LogDigest, ReadingsThatDoNotChangeAreFollowedAcrossBlocks) {
  std::vector<ImuRecord> records;
  for (int k = 0; k < 40; ++k) records.push_back(reading(0.1 * k, k > 5 && k < 31 ? 1.0 + 1.0e-8 * k : 0.1 * k));
  const auto still = digest_of(records, 8).sources[0].longest_still;
  EXPECT_EQ(still[0].records, 25U);
  EXPECT_NEAR(still[3].from_s, 0.6, 1e-12);
  EXPECT_NEAR(still[3].to_s, 3.0, 1e-12);
}
