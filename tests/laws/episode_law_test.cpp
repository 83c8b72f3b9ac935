// What the stations of an episode say together: laws 17 and 18 of docs/property-testing.md.
#include "laws/law_run.hpp"
#include "plumb/health/stability.hpp"

namespace episode_law_test {
namespace {

using namespace plumb;
using namespace plumb_test;

constexpr double kStability_mps2 = 5e-5 * kG0_mps2;  ///< 1 sigma
constexpr int kStations = 24;

/// One fault among five or more sensors of which every four check each other, all of them at an end of their drift
/// tolerance. `draw(strata, tool, noise)` gives the case and what its tool feels at a station.
template <class Draw>
LawOutcome one_fault_and_drift(std::uint64_t number, TrialNoise& noise, int key, double acceleration_bound_mps2,
                               std::uint64_t& told, Draw&& draw) {
  Strata strata(number);
  const auto& tools = every_tool();
  const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
  if (tool.n() < 5 || tool.plane > 2) return not_of_this_law();
  auto [c, felt] = draw(strata, tool, noise);
  c.draw(noise);
  Readings drift_mps2{};
  constexpr double kInside = 1.0 - 1e-6;  // what rounding adds must not leave the tolerance, kept in single precision
  for (int i = 0; i < tool.n(); ++i) drift_mps2[slot(i)] = noise.sign() * kInside * kStabilitySigmas * kStability_mps2;
  MonitorConfig config;
  config.isolation_stations = 1;
  config.acceleration_bound_mps2 = acceleration_bound_mps2;
  Watch watch = fresh_watch(tool, config, key, kStability_mps2);
  LawOutcome outcome;
  for (int k = 0; k < kStations && outcome.broken.empty(); ++k) {
    Readings y = c.felt(felt(), noise);
    for (int i = 0; i < tool.n(); ++i) y[slot(i)] += drift_mps2[slot(i)];
    outcome = blames_the_healthy(tool, c, watch.station(c.with_noise(y, noise)).excluded, k);
  }
  told += watch.verdict().excluded.empty() ? 0U : 1U;
  return outcome;
}

/// An acceleration is stated, and the tool accelerates by up to fifty times as much, anew at every station.
// Verifies: REQ-069
TEST(Law, SeventeenOneGravityExcludesNoHealthySensorThoughTheToolAcceleratesMoreThanStated) {
  constexpr double kStated_mps2 = 5e-5 * kG0_mps2;
  std::uint64_t told = 0;
  const LawCount count = run_law(17, kLawCases, [&told](std::uint64_t number, TrialNoise& noise) {
    return one_fault_and_drift(
        number, noise, 300, kStated_mps2, told, [](Strata& strata, const LawTool& tool, auto& luck) {
          LawCase c(tool.tool, LawCase::some(tool.n(), 1, luck), Lie::constant, 0.0);
          c.least_mps2 = c.most_mps2 = strata.of(std::array<double, 4>{1e-3, 3e-3, 1e-2, 1e-1}) * kG0_mps2;
          const double acceleration_mps2 = strata.of(std::array<double, 4>{1.0, 5.0, 15.0, 50.0}) * kStated_mps2;
          const double length_mps2 = kG0_mps2 + luck.between(-3.0, 3.0) * tool.tool.gravity.sigma_mps2;
          const auto felt = [&luck, acceleration_mps2, length_mps2] {
            return plus(scaled(luck.direction(), length_mps2), scaled(luck.direction(), acceleration_mps2));
          };
          return std::pair{c, felt};
        });
  });
  EXPECT_EQ(count.broken, 0U);
  expect_some_excluded(told, count, 0.2);
}

/// Gravity is off by ten sigma: only a healthy set that agrees with itself keeps its parts from being rejected by their
/// length. Drift is the same at every station, and adds up in the parity of that set.
// Verifies: REQ-069
TEST(Law, EighteenSummedParityExcludesNoHealthySensorThoughDriftAddsUp) {
  std::uint64_t told = 0;
  const LawCount count = run_law(18, kLawCases, [&told](std::uint64_t number, TrialNoise& noise) {
    return one_fault_and_drift(number, noise, 301, 0.0, told, [](Strata& strata, const LawTool& tool, auto& luck) {
      const double gravity = strata.of(std::array<double, 2>{10.0, -10.0});
      const LawCase c(tool.tool, LawCase::some(tool.n(), 1, luck), strata.of(kEveryLie), gravity);
      const double length_mps2 = kG0_mps2 + gravity * tool.tool.gravity.sigma_mps2;
      return std::pair{c, [&luck, length_mps2] { return scaled(luck.direction(), length_mps2); }};
    });
  });
  EXPECT_EQ(count.broken, 0U);
  expect_some_excluded(told, count, 0.2);
}

}  // namespace
}  // namespace episode_law_test
