#include "plumb/logs/log_aligner.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

namespace log_aligner_test {
namespace {

using plumb::logs::AlignedRow;
using plumb::logs::AlignedSource;
using plumb::logs::Alignment;
using plumb::logs::ImuRecord;
using plumb::logs::LogAligner;

ImuRecord line(double time_s) {
  ImuRecord out;
  out.time_s = time_s;
  out.specific_force_mps2 = {2.0 * time_s, -time_s, 1.0};
  out.temperature_degc = 10.0 + time_s;
  return out;
}

LogAligner aligner(std::vector<AlignedRow>& rows, Alignment how = Alignment::linear, double gap_s = 1.0) {
  return LogAligner({{0, gap_s}, {1, gap_s}}, 0, how, [&rows](const AlignedRow& row) {
    rows.push_back(row);
    return true;
  });
}

// A straight line comes back exactly, whatever the instants and in whatever order the two sources are handed on.
RC_GTEST_PROP(LogAlignerLaw, AStraightLineIsKeptAtEveryInstantWithin, ()) {
  const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 50));
  const auto other = *rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 50));
  const auto first_last = *rc::gen::arbitrary<bool>();
  std::vector<AlignedRow> rows;
  LogAligner under_test = aligner(rows);
  const auto feed = [&](std::size_t number, const std::vector<int>& intervals) {
    double time_s = 0.0;
    for (const int step : intervals) under_test.record(number, line(time_s += 0.01 * step));
  };
  feed(first_last ? 1 : 0, first_last ? other : steps);
  feed(first_last ? 0 : 1, first_last ? steps : other);
  under_test.finish();
  RC_ASSERT(rows.size() == steps.size());
  double end_s = 0.0;
  for (const int step : other) end_s += 0.01 * step;
  const double begin_s = other.empty() ? HUGE_VAL : 0.01 * other.front();
  for (const AlignedRow& row : rows) {
    const bool within = row.time_s > begin_s + 1e-9 && row.time_s < end_s - 1e-9;
    const double x = row.readings[1].specific_force_mps2[0];
    if (within) RC_ASSERT(std::abs(x - 2.0 * row.time_s) < 1e-9);
    if (row.time_s < begin_s - 1e-9 || row.time_s > end_s + 1e-9) RC_ASSERT(std::isnan(x));
    RC_ASSERT(!(std::abs(row.readings[0].specific_force_mps2[1] + row.time_s) > 0.0));
  }
}

TEST(LogAligner, TheNearestRecordKeepsItsValues) {
  std::vector<AlignedRow> rows;
  LogAligner under_test = aligner(rows, Alignment::nearest);
  for (const double t : {0.0, 0.1}) under_test.record(1, line(t));
  for (const double t : {0.04, 0.06}) under_test.record(0, line(t));
  under_test.finish();
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_DOUBLE_EQ(rows[0].readings[1].specific_force_mps2[0], 0.0);
  EXPECT_DOUBLE_EQ(rows[1].readings[1].specific_force_mps2[0], 0.2);
  EXPECT_NEAR(under_test.mean_distance_s(1), 0.04, 1e-12);
}

TEST(LogAligner, AcrossAGapNothingIsInterpolated) {
  std::vector<AlignedRow> rows;
  LogAligner under_test = aligner(rows, Alignment::linear, 0.5);
  for (const double t : {0.0, 0.4, 2.0, 2.3}) under_test.record(1, line(t));
  for (const double t : {0.2, 1.0, 2.1}) under_test.record(0, line(t));
  under_test.finish();
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_FALSE(std::isnan(rows[0].readings[1].specific_force_mps2[0]));
  EXPECT_TRUE(std::isnan(rows[1].readings[1].specific_force_mps2[0]));
  EXPECT_FALSE(std::isnan(rows[2].readings[1].specific_force_mps2[0]));
}

TEST(LogAligner, WhatIsNotNewerIsLeftOutAndCounted) {
  std::vector<AlignedRow> rows;
  LogAligner under_test = aligner(rows);
  for (const double t : {0.2, 0.2, 0.1, std::nan(""), 0.3}) under_test.record(0, line(t));
  under_test.finish();
  EXPECT_EQ(rows.size(), 2U);
  EXPECT_EQ(under_test.left_out(), 3U);
}

TEST(LogAligner, ARecordThatJumpedAheadIsLeftOutNotThoseBehindIt) {
  std::vector<AlignedRow> rows;
  LogAligner under_test = aligner(rows);
  for (const double t : {0.0, 0.1, 3600.0, 0.2, 0.3}) under_test.record(1, line(t));
  for (const double t : {0.05, 0.25}) under_test.record(0, line(t));
  under_test.finish();
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[1].readings[1].specific_force_mps2[0], 0.5, 1e-12);
  EXPECT_EQ(under_test.left_out(), 1U);
}

// A source that stops does not hold up the others for ever.
TEST(LogAligner, ASourceThatStopsIsWaitedForOnlySoLong) {
  std::vector<AlignedRow> rows;
  LogAligner under_test = aligner(rows);
  under_test.record(1, line(0.0));
  for (std::size_t k = 0; k < LogAligner::kMostWaiting + 10; ++k)
    under_test.record(0, line(0.001 * static_cast<double>(k)));
  EXPECT_GE(rows.size(), 9U);
  under_test.finish();
  EXPECT_EQ(rows.size(), LogAligner::kMostWaiting + 10);
}

TEST(LogAligner, StopsWhereNoMoreRowsAreWanted) {
  int count = 0;
  LogAligner under_test({{0, 1.0}}, 0, Alignment::linear, [&count](const AlignedRow&) { return ++count < 3; });
  for (int k = 0; k < 10; ++k) under_test.record(0, line(0.1 * k));
  under_test.finish();
  EXPECT_EQ(count, 3);
  EXPECT_TRUE(under_test.stopped());
}

}  // namespace
}  // namespace log_aligner_test
