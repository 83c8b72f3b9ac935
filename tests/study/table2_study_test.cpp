// Table 2 of the paper: the same verdicts from simulated tools, whatever is drawn; and what one attitude makes of it.
#include "plumb/study/table2_study.hpp"

#include <algorithm>
#include <iostream>

#include "plumb/study/one_attitude_study.hpp"
#include "study_test_support.hpp"

namespace table2_study_test {
namespace {

using namespace study_test;
using namespace plumb::study;
using plumb::SensorSet;

constexpr double kG = plumb::kG0_mps2;

/// Smallest MAE that had to be above the limit and largest that had to be below it [g0].
struct Extremes {
  double least_faulty = 1e9;
  double most_healthy = 0.0;
  void add(double mae_g, double printed_g) {
    if (printed_g < 0.05) {
      most_healthy = std::max(most_healthy, mae_g);
    } else {
      least_faulty = std::min(least_faulty, mae_g);
    }
  }
};

// Verifies: REQ-191
TEST(Table2Study, SameVerdictsAsPrintedForEverySeed) {
  Extremes extremes;
  int runs = 0, equal = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Bench bench = bench_of(seed);
    for (const RandomLaw law : {RandomLaw::held, RandomLaw::anew}) {
      const auto study = table2_study(bench.fits, bench.tool, seed, law);
      ASSERT_TRUE(study.has_value()) << study.error();
      ++runs;
      equal += study->same_verdicts() == kExperiments ? 1 : 0;
      for (std::size_t e = 0; e < kTable2.size(); ++e) {
        const plumb::PaperFinding& finding = study->result[e].finding;
        extremes.add(finding.mae_all_mps2 / kG, kTable2[e].mae_all_g);
        for (std::size_t k = 0; k < 4; ++k) extremes.add(finding.mae_triple_mps2[k] / kG, kTable2[e].mae_triple_g[k]);
        EXPECT_TRUE(study->result[e].same_verdict) << "seed " << seed << ", experiment " << e + 1;
      }
    }
  }
  std::cout << "[ measured ] " << equal << " of " << runs << " runs with all 23 verdicts as printed; least faulty MAE "
            << extremes.least_faulty << " g0, largest healthy one " << extremes.most_healthy << " g0\n";
  EXPECT_EQ(equal, runs);
  EXPECT_GT(extremes.least_faulty, 1.5 * 0.05) << "no verdict hangs on a draw";
  EXPECT_LT(extremes.most_healthy, 7.63e-4) << "the largest healthy figure that the paper prints";
}

TEST(Table2Study, TheMonitorExcludesTheFaultyOneAndNoOther) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Bench bench = bench_of(seed);
    const auto study = table2_study(bench.fits, bench.tool, seed);
    ASSERT_TRUE(study.has_value()) << study.error();
    for (std::size_t e = 0; e < kTable2.size(); ++e) {
      const Table2Result& r = study->result[e];
      const SensorSet faulty = kTable2[e].faulty;
      EXPECT_TRUE((r.ever_named - faulty).empty()) << "seed " << seed << ", experiment " << e + 1;
      EXPECT_EQ(r.excluded, kTable2[e].isolated) << "seed " << seed << ", experiment " << e + 1;
      if (faulty.empty()) {
        EXPECT_EQ(r.state, plumb::HealthState::nominal);
      }
      if (faulty.size() == 2) {
        EXPECT_TRUE(r.state == plumb::HealthState::failed || r.state == plumb::HealthState::suspect);
        EXPECT_EQ(r.silent, 0) << "seed " << seed << ", experiment " << e + 1;
      }
      if (faulty.size() == 1) {
        EXPECT_EQ(r.state, plumb::HealthState::degraded_3_sensor);
        EXPECT_GE(r.named_after, 4) << "an answer has to stand at four attitudes before it is acted upon";
        EXPECT_LE(r.named_after, 8);
      }
    }
  }
}

TEST(OneAttitudeStudy, ThePapersRuleErrsWherePlumbHoldsBack) {
  const Bench bench = bench_of(1);
  const auto study = one_attitude_study(bench.fits, bench.tool, 1, RandomLaw::held);
  ASSERT_TRUE(study.has_value()) << study.error();
  const AnswerCount paper = study->paper.faulty();
  const AnswerCount own = study->own.faulty();
  EXPECT_EQ(paper.trials(), 500U * 22U);
  EXPECT_EQ(own.trials(), 500U * 22U);
  EXPECT_EQ(study->paper.group[0][Answer::right], 500U);
  EXPECT_EQ(study->own.group[0][Answer::right], 500U);
  EXPECT_GT(paper[Answer::names_healthy], 100U) << "of two faulty ones a healthy third can look like the faulty one";
  EXPECT_GT(paper[Answer::silent_large], 500U);
  EXPECT_EQ(study->paper.group[1][Answer::names_healthy], 0U) << "the triple of the healthy three always passes";
  EXPECT_GT(paper[Answer::keeps_faulty], 100U);
  EXPECT_GT(study->paper.largest_silent_tilt_rad, 1.0);
  EXPECT_EQ(own.errors(), 0U);
  EXPECT_EQ(study->own.attitudes_in_error, 0U);
  EXPECT_LE(own[Answer::silent_small], 20U) << "a dead sensor that reads what it should";
  EXPECT_LT(study->own.largest_silent_mps2, 2e-3 * kG);
  EXPECT_LT(study->own.largest_silent_tilt_rad, plumb::rad_from_deg(0.1));
}

TEST(OneAttitudeStudy, PlumbIsolatesNoHealthySensorWhateverIsDrawn) {
  std::uint64_t trials = 0;
  for (std::uint64_t seed = 2; seed <= 11; ++seed) {
    const Bench bench = bench_of(seed);
    for (const RandomLaw law : {RandomLaw::held, RandomLaw::anew}) {
      const auto study = one_attitude_study(bench.fits, bench.tool, seed, law, 50);
      ASSERT_TRUE(study.has_value()) << study.error();
      trials += study->own.faulty().trials();
      EXPECT_EQ(study->own.faulty().errors(), 0U) << seed;
      EXPECT_EQ(study->own.group[0][Answer::alarm_only] + study->own.group[0][Answer::names_healthy], 0U) << seed;
    }
  }
  EXPECT_EQ(trials, 10U * 50U * (22U + 10U)) << "drawn anew: only the ten random experiments";
}

TEST(Table2Study, OtherToolsAreCounted) {
  const auto others = all_verdicts_as_printed(1, 5);
  ASSERT_TRUE(others.has_value()) << others.error();
  EXPECT_EQ(others->trials, 5U);
  EXPECT_EQ(others->count, 5U);
}

TEST(OneAttitudeStudy, SameSeedSameCounts) {
  const Bench bench = bench_of(4);
  const auto a = one_attitude_study(bench.fits, bench.tool, 4, RandomLaw::held, 20);
  const auto b = one_attitude_study(bench.fits, bench.tool, 4, RandomLaw::held, 20);
  const auto c = one_attitude_study(bench.fits, bench.tool, 5, RandomLaw::held, 20);
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(a->paper.faulty().of, b->paper.faulty().of);
  EXPECT_NE(a->paper.faulty().of, c->paper.faulty().of);
}

}  // namespace
}  // namespace table2_study_test
