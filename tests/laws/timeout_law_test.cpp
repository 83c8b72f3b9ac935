// When doubt may end in failed: law 14 of docs/property-testing.md, over kLawCases cases.
#include "laws/law_run.hpp"

namespace timeout_law_test {
namespace {

using namespace plumb;
using namespace plumb_test;

std::string said(const LawTool& tool, const LawCase& c, const char* how, const Verdict& v) {
  return "of " + std::to_string(tool.n()) + " sensors " + names_of(c.faulty()) + how + "; excluded " +
         names_of(v.excluded) + ", " + to_string(v.state);
}

/// As many sensors as the confirmed grade fail for good, one after another, one or two stations between.
LawOutcome one_after_another(const LawTool& tool, TrialNoise& noise) {
  LawCase c(tool.tool, LawCase::some(tool.n(), tool.strict(), noise), Lie::constant, 0.0);
  c.least_mps2 = 0.05 * kG0_mps2;
  c.draw(noise);
  Watch watch = proven_watch(tool, {}, 0, 0.0);
  const int gap = 2 + noise.below(2);
  SensorSet failed;
  int played = 0;
  for (int left = c.faulty().size(); left > 0; --left) {
    int next = noise.below(tool.n());
    while (!c.faulty().has(next) || failed.has(next)) next = (next + 1) % tool.n();
    failed = failed.with(next);
    for (int station = 0; station < (left > 1 ? gap : 12); ++station) {
      const Vec3 direction = noise.direction();
      Readings y = c.healthy_readings(direction);
      const Readings lies = c.readings(direction, noise);
      for (int i = 0; i < tool.n(); ++i) {
        if (failed.has(i)) y[slot(i)] = lies[slot(i)];
      }
      const Verdict& v = watch.station(c.with_noise(y, noise));
      ++played;
      if (v.state == HealthState::failed)
        return {true, said(tool, c, " failed one after another", v), {tool.n(), c.faulty().size(), played}};
    }
  }
  return {};
}

/// One sensor that is off by little for longer than patience lasts, and by much from then on.
LawOutcome found_out_late(const LawTool& tool, TrialNoise& noise) {
  LawCase c(tool.tool, LawCase::some(tool.n(), 1, noise), Lie::constant, 0.0);
  const int liar = c.faulty().lowest();
  const double small_mps2 = noise.sign() * noise.log_between(5.0, 50.0) * c.block_sigma(liar);
  const double large_mps2 = noise.sign() * noise.log_between(0.3, 2.0) * kG0_mps2;
  Watch watch = proven_watch(tool, {}, 0, 0.0);
  for (int station = 0; station < 20; ++station) {
    Readings y = c.healthy_readings(noise.direction());
    y[slot(liar)] += station < 10 ? small_mps2 : large_mps2;
    const Verdict& v = watch.station(c.with_noise(y, noise));
    if (v.state == HealthState::failed)
      return {true, said(tool, c, " was found out late", v), {tool.n(), 1, station + 1}};
  }
  return {};
}

TEST(Law, FourteenFaultsThatLeaveSensorsWhichCheckOneAnotherEndInNoTimeout) {
  const LawCount count = run_law(14, kLawCases, [](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    const bool named = tool.geometry == Geometry::named || tool.geometry == Geometry::named_other;
    if (tool.n() < 5 || !named) return not_of_this_law();
    return strata.digit(2) == 0 ? one_after_another(tool, noise) : found_out_late(tool, noise);
  });
  EXPECT_EQ(count.broken, 0U);
}

}  // namespace
}  // namespace timeout_law_test
