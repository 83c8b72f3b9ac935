// What a calibration that promises too much leads to: law 15 of docs/property-testing.md, over kLawCases cases.
#include "laws/law_run.hpp"

namespace calibration_law_test {
namespace {

using namespace plumb;
using namespace plumb_test;

/// The errors of rows and offsets, of which the calibration says that there are none.
struct Errors {
  std::array<Vec3, kCapacity> row{};
  Readings offset_mps2{};

  Errors(int n, double size_mps2, TrialNoise& noise) {
    for (int i = 0; i < n; ++i) {
      for (double& component : row[slot(i)]) component = size_mps2 / kG0_mps2 * noise.normal();
      offset_mps2[slot(i)] = size_mps2 * noise.normal();
    }
  }
  double of(int i, const Vec3& g_mps2) const { return dot(row[slot(i)], g_mps2) + offset_mps2[slot(i)]; }
};

LawOutcome promises_too_much(const LawTool& tool, TrialNoise& noise) {
  constexpr int kAttitudes = 30;
  const double size_mps2 = noise.log_between(0.4, 1.2) * 1e-3 * kG0_mps2;
  const Errors errors(tool.n(), size_mps2, noise);
  LawCase c(tool.tool, {}, Lie::constant, 0.0);
  Watch watch(tool, {});
  for (int played = 1; played <= kAttitudes; ++played) {
    const Vec3 direction = noise.direction();
    Readings y = c.healthy_readings(direction);
    for (int i = 0; i < tool.n(); ++i) y[slot(i)] += errors.of(i, scaled(direction, kG0_mps2));
    const Verdict& v = watch.station(c.with_noise(y, noise));
    const bool blamed = !v.excluded.empty() || !v.provisionally_excluded.empty();
    if (!blamed && v.state != HealthState::failed) continue;
    return {true,
            "of " + std::to_string(tool.n()) + " healthy sensors " + names_of(v.excluded) + " excluded, " +
                names_of(v.provisionally_excluded) + " provisionally excluded, " + to_string(v.state),
            {tool.n(), 0, played}};
  }
  return {};
}

TEST(Law, FifteenAnOptimisticCalibrationExcludesAHealthySensorInOneToolOfAThousandAtMost) {
  const LawCount count = run_law(15, kLawCases, [](std::uint64_t number, TrialNoise& noise) -> LawOutcome {
    const LawTool& tool = every_tool()[number % every_tool().size()];
    if (tool.knowledge != Knowledge::exact || tool.strict() < 1) return not_of_this_law();
    return promises_too_much(tool, noise);
  });
  // A few tools agree by chance at the first attitudes, or as if some sensors were at fault.
  EXPECT_LE(1000 * count.broken, count.cases);
}

}  // namespace
}  // namespace calibration_law_test
