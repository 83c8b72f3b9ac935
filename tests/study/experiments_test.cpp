#include "plumb/study/experiments.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "plumb/paper/paper_rule.hpp"
#include "study_test_support.hpp"

namespace experiments_test {
namespace {

using namespace study_test;
using namespace plumb::study;
using plumb::SensorSet;

constexpr double kLimit_g = plumb::kPaperDeltaF_mps2 / plumb::kG0_mps2;
const SensorSet kTriple[4] = {SensorSet(7U), SensorSet(11U), SensorSet(13U), SensorSet(14U)};

// Negative: REQ-191
TEST(Table2AsPrinted, FollowsFromItsOwnRule) {
  int singles = 0, pairs = 0;
  for (std::size_t e = 0; e < kTable2.size(); ++e) {
    const Table2Row& row = kTable2[e];
    EXPECT_EQ(row.number, static_cast<int>(e) + 1);
    EXPECT_EQ(row.detected, row.mae_all_g >= kLimit_g) << row.number;
    EXPECT_EQ(row.detected, !row.faulty.empty());
    SensorSet correct;
    for (std::size_t k = 0; k < 4; ++k) {
      // A triple passes exactly if it holds no faulty sensor, and then reads as in experiment 1.
      const bool healthy = (row.faulty & kTriple[k]).empty();
      EXPECT_EQ(row.mae_triple_g[k] < kLimit_g, healthy) << row.number << ' ' << k;
      if (healthy) {
        EXPECT_EQ(row.mae_triple_g[k], kTable2[0].mae_triple_g[k]);
        correct = correct | kTriple[k];
      }
    }
    const SensorSet rule = row.detected && !correct.empty() ? SensorSet(15U) - correct : SensorSet{};
    EXPECT_EQ(row.isolated, rule) << row.number;
    singles += row.faulty.size() == 1 ? 1 : 0;
    pairs += row.faulty.size() == 2 ? 1 : 0;
  }
  EXPECT_EQ(singles, 16);
  EXPECT_EQ(pairs, 6);
}

TEST(WithFault, PutsTheLevelIntoTheFaultySensorOnly) {
  const auto tool = plumb::scenario::paper_tool(2);
  const auto survey = record(survey_run(tool, 2, Part::faults, 1, 32));
  ASSERT_TRUE(survey.has_value());
  const auto& clean = survey->attitude.front();
  for (const Table2Row& row : kTable2) {
    for (const RandomLaw law : {RandomLaw::held, RandomLaw::anew}) {
      const auto faulty = with_fault(tool, row, law, 77, clean);
      ASSERT_TRUE(faulty.has_value()) << faulty.error();
      for (int i = 0; i < 4; ++i) {
        std::set<double> values;
        for (std::size_t k = 0; k < clean.size(); ++k) {
          const double now = (*faulty)[k].raw[at(i)];
          values.insert(now);
          if (!row.faulty.has(i)) {
            EXPECT_EQ(now, clean[k].raw[at(i)]);
          }
        }
        if (!row.faulty.has(i)) continue;
        const std::size_t levels = row.level == Level::random && law == RandomLaw::anew ? 32U : 1U;
        EXPECT_EQ(values.size(), levels) << row.number;
        const double wanted = row.level == Level::plus_3v ? 3.0 : row.level == Level::minus_3v ? -3.0 : 0.0;
        if (row.level != Level::random) {
          EXPECT_NEAR(*values.begin(), wanted, 2e-4);
        }
        EXPECT_LE(std::abs(*values.begin()), 3.001);
        EXPECT_LE(std::abs(*values.rbegin()), 3.001);
      }
    }
  }
}

TEST(WithFault, DrawsBySeed) {
  const auto tool = plumb::scenario::paper_tool(2);
  const auto survey = record(survey_run(tool, 2, Part::faults, 1, 1));
  ASSERT_TRUE(survey.has_value());
  const auto level = [&](std::uint64_t seed, int sensor) {
    return with_fault(tool, kTable2[17], RandomLaw::held, seed, survey->attitude.front())->front().raw[at(sensor)];
  };
  EXPECT_EQ(level(5, 0), level(5, 0));
  EXPECT_NE(level(5, 0), level(6, 0));
  EXPECT_NE(level(5, 0), level(5, 1)) << "two faulty sensors draw apart";
}

}  // namespace
}  // namespace experiments_test
