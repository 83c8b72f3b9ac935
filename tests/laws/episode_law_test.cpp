// What the stations of an episode say together: laws 17 and 18 of docs/property-testing.md.
#include "laws/law_run.hpp"
#include "plumb/health/stability.hpp"

namespace episode_law_test {
namespace {

using namespace plumb;
using namespace plumb_test;

constexpr double kSigma_mps2 = 5e-5 * kG0_mps2;  ///< stability, 1 sigma
constexpr int kStations = 24;

/// One fault among five or more of which every four check each other: then the healthy ones speak for themselves.
bool speaks_of(const LawTool& tool) { return tool.n() >= 5 && tool.plane <= 2; }

/// Bias and drift within the tolerance, and whatever else a station feels; broken where a healthy sensor is excluded.
template <class Felt>
LawOutcome never_blames_the_healthy(const LawTool& tool, LawCase& c, Watch& watch, TrialNoise& noise, Felt&& felt) {
  Readings drift_mps2{};
  constexpr double kInside = 1.0 - 1e-6;
  for (int i = 0; i < tool.n(); ++i) drift_mps2[slot(i)] = noise.sign() * kInside * kStabilitySigmas * kSigma_mps2;
  for (int k = 0; k < kStations; ++k) {
    Readings y = c.felt(felt(), noise);
    for (int i = 0; i < tool.n(); ++i) y[slot(i)] += drift_mps2[slot(i)];
    const Verdict& v = watch.station(c.with_noise(y, noise));
    if (c.faulty().contains(v.excluded)) continue;
    return {true,
            "of " + std::to_string(tool.n()) + " sensors " + names_of(v.excluded) + " are excluded, but " +
                names_of(c.faulty()) + " is faulty; station " + std::to_string(k),
            {tool.n(), c.faulty().size(), k}};
  }
  return {};
}

void expect_some_excluded(std::uint64_t told, const LawCount& count, double share) {
  std::printf("the faulty sensor was excluded in %llu of %llu cases\n", static_cast<unsigned long long>(told),
              static_cast<unsigned long long>(count.cases));
  if (count.cases < 100) return;  // PLUMB_LAW_CASE asks for one
  EXPECT_GE(static_cast<double>(told), share * static_cast<double>(count.cases));
}

/// An acceleration is stated, and the tool accelerates by up to fifty times as much, anew at every station.
// Verifies: REQ-069
TEST(Law, SeventeenLengthsBlameNobodyHealthyThoughTheToolMovesMoreThanStated) {
  std::uint64_t told = 0;
  const LawCount count = run_law(17, kLawCases, [&told](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    if (!speaks_of(tool)) return not_of_this_law();
    const double size_mps2 = strata.of(std::array<double, 4>{1e-3, 3e-3, 1e-2, 1e-1}) * kG0_mps2;
    const double factor = strata.of(std::array<double, 4>{1.0, 5.0, 15.0, 50.0});
    MonitorConfig config;
    config.isolation_stations = 1;
    config.acceleration_bound_mps2 = 5e-5 * kG0_mps2;
    LawCase c(tool.tool, LawCase::some(tool.n(), 1, noise), Lie::constant, 0.0);
    c.least_mps2 = c.most_mps2 = size_mps2;
    c.draw(noise);
    const double length_mps2 = kG0_mps2 + noise.between(-3.0, 3.0) * tool.tool.gravity.sigma_mps2;
    Watch watch = fresh_watch(tool, config, 300, kSigma_mps2);
    const LawOutcome outcome = never_blames_the_healthy(tool, c, watch, noise, [&] {
      const Vec3 acceleration = scaled(noise.direction(), factor * config.acceleration_bound_mps2);
      return plus(scaled(noise.direction(), length_mps2), acceleration);
    });
    told += watch.verdict().excluded.empty() ? 0U : 1U;
    return outcome;
  });
  EXPECT_EQ(count.broken, 0U);
  expect_some_excluded(told, count, 0.2);
}

/// Gravity off by ten sigma: only a healthy set that doubts it keeps its subsets from being rejected. Drift within its
/// tolerance is the same at every station, and adds up in the parity of that set.
// Verifies: REQ-069
TEST(Law, EighteenDriftThatAddsUpTakesNoHealthySetItsWord) {
  std::uint64_t told = 0;
  const LawCount count = run_law(18, kLawCases, [&told](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    if (!speaks_of(tool)) return not_of_this_law();
    const double gravity = strata.of(std::array<double, 2>{10.0, -10.0});
    MonitorConfig config;
    config.isolation_stations = 1;
    LawCase c(tool.tool, LawCase::some(tool.n(), 1, noise), strata.of(kEveryLie), gravity);
    c.draw(noise);
    const double length_mps2 = kG0_mps2 + gravity * tool.tool.gravity.sigma_mps2;
    Watch watch = fresh_watch(tool, config, 301, kSigma_mps2);
    const LawOutcome outcome =
        never_blames_the_healthy(tool, c, watch, noise, [&] { return scaled(noise.direction(), length_mps2); });
    told += watch.verdict().excluded.empty() ? 0U : 1U;
    return outcome;
  });
  EXPECT_EQ(count.broken, 0U);
  expect_some_excluded(told, count, 0.2);
}

}  // namespace
}  // namespace episode_law_test
