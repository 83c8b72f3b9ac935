// Which single faults fitted tools isolate over eight attitudes, gravity within three sigmas, and that nobody healthy
// is. With PLUMB_LONG=1 twenty times as many episodes.
#include <gtest/gtest.h>

#include <iostream>
#include <vector>

#include "support/binomial_interval.hpp"
#include "support/isolation_trials.hpp"
#include "support/long_run.hpp"

namespace fitted_isolation_test {
namespace {

using namespace plumb;
using namespace plumb_test;

constexpr double kSigma = 2e-4 * kG0_mps2;
constexpr int kAttitudes = 8, kCalibrationStations = 48, kTools = 20;

/// Episodes of one bias of `size_mg`, of either sign, each in one of a pool of fitted tools.
TrialCount isolated(int n, double size_mg, int episodes) {
  TrialNoise noise(static_cast<std::uint64_t>(1000 * n) + static_cast<std::uint64_t>(10.0 * size_mg));
  std::vector<TrialTool> tools;
  for (int k = 0; k < kTools; ++k) {
    tools.push_back(fitted_tool(trial_axes(n, 0), n, kCalibrationStations, noise, kSigma));
    EXPECT_EQ(tools.back().array.size(), n);
  }
  const double size_mps2 = size_mg * 1e-3 * kG0_mps2;
  TrialCount out;
  for (int t = 0; t < episodes; ++t) {
    const TrialTool& tool = tools[slot(t % kTools)];
    TrialEpisode episode(tool, 1, FaultLaw::bias, size_mps2, size_mps2, noise);
    const double length_mps2 = kG0_mps2 + noise.between(-3.0, 3.0) * tool.gravity.sigma_mps2;
    Isolation isolation = tool.monitored;
    IsolationAnswer answer;
    bool blamed = false;
    for (int k = 0; k < kAttitudes; ++k) {
      const Vec3 g = scaled(noise.direction(), length_mps2);
      answer = isolation.vote({tool.array, tool.gravity, tool.limits, episode.block(g, noise)});
      blamed = blamed || !episode.faulty().contains(answer.strict);
    }
    out.add(episode.faulty(), answer.strict, blamed);
  }
  return out;
}

// Verifies: REQ-070
TEST(FittedIsolation, ABiasOfTwoMilliGIsIsolatedOverEightAttitudes) {
  const int episodes = long_run() ? 20000 : 1000;
  for (int n = 4; n <= 8; ++n) {
    for (const double size_mg : {1.0, 2.0, 5.0}) {
      const TrialCount count = isolated(n, size_mg, episodes);
      const auto interval =
          clopper_pearson(static_cast<std::int64_t>(count.correct), static_cast<std::int64_t>(count.trials), 0.95);
      std::cout << "[ measured ] n = " << n << ", " << size_mg << " mg: isolated " << count.correct << " of "
                << count.trials << " (" << interval.low << " .. " << interval.high << "), wrong " << count.wrong
                << '\n';
      EXPECT_EQ(count.wrong, 0U) << n << ' ' << size_mg;
      if (size_mg >= 2.0) {
        EXPECT_GE(interval.high, n < 7 ? 0.97 : 0.96) << n << ' ' << size_mg;
      }
      if (size_mg >= 5.0) {
        EXPECT_GE(100 * count.correct, 99 * count.trials) << n << ' ' << size_mg;
      }
    }
  }
}

}  // namespace
}  // namespace fitted_isolation_test
