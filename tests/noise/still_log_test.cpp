// The longest even stretch at rest of a log, and what ends it.
#include "plumb/noise/still_log.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "plumb/noise/axis_study.hpp"
#include "plumb/noise/fit.hpp"
#include "simulated_noise.hpp"

namespace still_log_test {
namespace {

using namespace plumb;
using namespace plumb::noise;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

StillLog log_of(std::size_t rows, std::uint64_t seed) {
  StillLog out;
  out.columns = {{"a1", simulated_noise::normals(seed, 1, rows)}};
  for (std::size_t k = 0; k < rows; ++k) out.time_s.push_back(100.0 + 0.01 * static_cast<double>(k));
  return out;
}

TEST(StillLog, AGoodLogIsTakenWhole) {
  const StillLog log = log_of(5000, 1);
  const Stretch out = longest_stretch(log, 0);
  EXPECT_EQ(out.refused, Refused::no);
  EXPECT_EQ(out.readings, log.columns[0].readings);
  EXPECT_NEAR(out.period_s, 0.01, 1e-9);
  EXPECT_EQ(out.begin_s, 100.0);
  for (const Breaks& kind : out.breaks) EXPECT_EQ(kind.count, 0U);
  EXPECT_EQ(out.filled, 0U);
  EXPECT_EQ(out.resolution, 0.0);
}

TEST(StillLog, AClockOfWholeMillisecondsHasItsMeanRate) {
  StillLog log = log_of(5000, 2);
  for (std::size_t k = 0; k < log.time_s.size(); ++k) log.time_s[k] = 1e-3 * std::floor(2.5 * static_cast<double>(k));
  const Stretch out = longest_stretch(log, 0);
  EXPECT_NEAR(out.period_s, 0.0025, 1e-6);
  EXPECT_EQ(out.readings.size(), 5000U);
  EXPECT_EQ(out.filled, 0U);
}

TEST(StillLog, AGapCutsTheLog) {
  StillLog log = log_of(5000, 3);
  for (std::size_t k = 2000; k < log.time_s.size(); ++k) log.time_s[k] += 7.5;
  const Stretch out = longest_stretch(log, 0);
  EXPECT_EQ(out.readings.size(), 3000U);
  EXPECT_NEAR(out.begin_s, 127.5, 1e-6);
  const Breaks& gaps = out.breaks_of(BreakCode::gap);
  EXPECT_EQ(gaps.count, 1U);
  EXPECT_NEAR(gaps.first.value, 7.5, 0.02);
  EXPECT_NEAR(gaps.first.time_s, 120.0, 0.02);
}

TEST(StillLog, SingleRowsThatAreMissingAreFilled) {
  StillLog log = log_of(5000, 4);
  log.columns[0].readings[1000] = kNaN;
  log.time_s.erase(log.time_s.begin() + 3000);
  log.columns[0].readings.erase(log.columns[0].readings.begin() + 3000);
  const Stretch out = longest_stretch(log, 0);
  EXPECT_EQ(out.readings.size(), 5000U);
  EXPECT_EQ(out.filled, 2U);
  EXPECT_NEAR(out.readings[1000], 0.5 * (out.readings[999] + out.readings[1001]), 1e-12);
}

TEST(StillLog, ASilentColumnIsCut) {
  StillLog log = log_of(5000, 5);
  for (std::size_t k = 1000; k < 1100; ++k) log.columns[0].readings[k] = kNaN;
  const Stretch out = longest_stretch(log, 0);
  EXPECT_EQ(out.readings.size(), 3900U);
  EXPECT_EQ(out.breaks_of(BreakCode::silent).count, 1U);
  EXPECT_EQ(out.breaks_of(BreakCode::gap).count, 0U);
  EXPECT_NEAR(out.breaks_of(BreakCode::silent).worst.value, 1.0, 0.02);
}

TEST(StillLog, AKnockAndATurnCutTheLog) {
  StillLog log = log_of(20000, 6);
  for (std::size_t k = 3000; k < 3020; ++k) log.columns[0].readings[k] += 60.0;   // a knock
  for (std::size_t k = 9000; k < 20000; ++k) log.columns[0].readings[k] += 20.0;  // and another attitude
  const Stretch out = longest_stretch(log, 0);
  EXPECT_EQ(out.refused, Refused::no);
  EXPECT_GE(out.begin_s, 190.0);
  EXPECT_GT(out.readings.size(), 10700U);
  const Breaks& motion = out.breaks_of(BreakCode::motion);
  EXPECT_EQ(motion.count, 2U);
  EXPECT_NEAR(motion.first.time_s, 130.0, 1.0);
  EXPECT_NEAR(motion.worst.time_s, 190.0, 1.0);
  EXPECT_GT(motion.worst.value, 10.0);
}

TEST(StillLog, SlowNoiseIsNoMotion) {
  StillLog log;
  log.rate_hz = 100.0;
  log.columns = {{"a1", simulated_noise::Source({2e-5, 1e-3, 4e-3, 4e-3, 1e-3}, 60000, 0.01).draw(7)}};
  const Stretch out = longest_stretch(log, 0);
  for (const Breaks& kind : out.breaks) EXPECT_EQ(kind.count, 0U);
  EXPECT_EQ(out.readings.size(), 60000U);
}

TEST(StillLog, SaysWhyThereIsNothingToJudge) {
  StillLog log = log_of(5000, 8);
  log.columns[0].readings.assign(5000, 1.25);
  EXPECT_EQ(longest_stretch(log, 0).refused, Refused::constant);
  log.columns[0].readings.assign(5000, kNaN);
  EXPECT_EQ(longest_stretch(log, 0).refused, Refused::too_short);
  EXPECT_EQ(longest_stretch(log_of(200, 9), 0).refused, Refused::too_short);
  StillLog stopped = log_of(5000, 10);
  stopped.time_s.assign(5000, 3.0);
  EXPECT_EQ(longest_stretch(stopped, 0).refused, Refused::no_rate);
  StillLog none;
  none.rate_hz = 100.0;
  none.columns = {{"a1", {}}};
  EXPECT_EQ(longest_stretch(none, 0).refused, Refused::too_short);
}

TEST(StillLog, FewCodesShowTheirResolution) {
  StillLog log = log_of(5000, 11);
  for (double& y : log.columns[0].readings) y = 0.25 * std::round(4.0 * y);
  EXPECT_EQ(longest_stretch(log, 0).resolution, 0.25);
  // Noise far below one code: what is declared is that of rounding.
  for (std::size_t k = 0; k < 5000; ++k) log.columns[0].readings[k] = k % 977 == 0 ? 0.25 : 0.0;
  EXPECT_GE(study_axis(log, 0, {}).whiteness.declare_sigma, 0.25 / std::sqrt(12.0));
}

TEST(StillLog, TimesThatComeInBurstsAreNoGaps) {
  StillLog log = log_of(5000, 12);
  for (std::size_t k = 0; k < log.time_s.size(); ++k)
    log.time_s[k] = 100.0 + 0.04 * static_cast<double>(k / 4) + 1e-4 * static_cast<double>(k % 4);
  const Stretch out = longest_stretch(log, 0);
  EXPECT_GT(out.irregular, kIrregular);
  EXPECT_EQ(out.readings.size(), 5000U);
  EXPECT_NEAR(out.period_s, 0.01, 1e-5);
}

RC_GTEST_PROP(StillLog, IsNeverLongerThanTheTimeItCovers, ()) {
  const auto steps =
      *rc::gen::container<std::vector<double>>(600, rc::gen::element(0.01, 0.01, 0.01, 0.02, 0.035, 2.0));
  StillLog log = log_of(600, 13);
  log.time_s[0] = 0.0;
  for (std::size_t k = 1; k < 600; ++k) log.time_s[k] = log.time_s[k - 1] + steps[k];
  const auto holes = *rc::gen::container<std::vector<int>>(20, rc::gen::inRange(0, 600));
  for (const int hole : holes) log.columns[0].readings[static_cast<std::size_t>(hole)] = kNaN;
  const Stretch out = longest_stretch(log, 0);
  RC_ASSERT(static_cast<double>(out.readings.size()) * out.period_s <= 2.0 * (log.time_s.back() + out.period_s));
  for (const double y : out.readings) RC_ASSERT(std::isfinite(y));
}

}  // namespace
}  // namespace still_log_test
