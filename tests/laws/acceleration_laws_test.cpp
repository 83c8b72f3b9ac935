// What a steady acceleration within the stated bound does: law 11 of docs/property-testing.md.
#include "laws/bound_law.hpp"

namespace acceleration_laws_test {
namespace {

using namespace plumb;
using namespace plumb_test;

/// From what a parked vehicle does to beyond gravity, where the vector may point anywhere.
constexpr std::array<double, 7> kBounds_mps2 = {
    1e-3 * kG0_mps2, 5e-3 * kG0_mps2, 0.03 * kG0_mps2, 0.1 * kG0_mps2, 0.3 * kG0_mps2, 0.9 * kG0_mps2, 10.0};

/// Which acceleration: those that a test finds hardest to see, and any.
enum class Push : std::uint8_t { across, keeps_length, turns_most, along, any };
constexpr std::array<Push, 5> kEveryPush = {Push::across, Push::keeps_length, Push::turns_most, Push::along, Push::any};

/// Of at most `bound`, under gravity `g`.
Vec3 pushed(Push push, const Vec3& g, double bound, TrialNoise& noise) {
  const double length = norm(g);
  const Vec3 down = scaled(g, 1.0 / length);
  Vec3 aside = cross(down, noise.direction());
  aside = scaled(aside, 1.0 / norm(aside));
  const auto to = [&](double turn, double felt) {  // such that g + a is so long, and turned by so much
    const Vec3 whole = plus(scaled(down, felt * std::cos(turn)), scaled(aside, felt * std::sin(turn)));
    return minus(whole, g);
  };
  constexpr double kInside = 1.0 - 1e-9;  // what rounding adds must not leave the bound
  const double sine = std::min(1.0, kInside * bound / length);
  switch (push) {
    case Push::across: return scaled(aside, kInside * bound);
    case Push::keeps_length: return to(2.0 * std::asin(0.5 * sine), length);
    case Push::turns_most: return to(std::asin(sine), length * std::sqrt(1.0 - sine * sine));
    case Push::along: return scaled(down, noise.sign() * kInside * bound);
    case Push::any: return scaled(noise.direction(), bound * noise.uniform());
  }
  return {};
}

MonitorConfig allowing(double bound_mps2) {
  MonitorConfig config = as_rare_as_rejections();
  config.acceleration_bound_mps2 = bound_mps2;
  return config;
}

TEST(Law, ElevenNoAccelerationWithinItsBoundExceedsTheProtectionLevelOrExcludesAHealthySensor) {
  BoundLaw law(BoundLaw::Tried::unconfirmed_too);
  const LawCount count = run_law(11, kLawCases, [&law](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    // The frame of fitted axes is known but for a turn that gravity does not show; the bound is in that frame.
    if (tool.knowledge == Knowledge::fitted) return not_of_this_law();
    const int allowed = strata.digit(static_cast<int>(kBounds_mps2.size()));
    const double bound = kBounds_mps2[slot(allowed)];
    const Push push = strata.of(kEveryPush);
    const double gravity = strata.of(std::array<double, 3>{0.0, 3.0, -3.0});
    const int faults = strata.digit(2);
    LawCase c(tool.tool, LawCase::some(tool.n(), faults, noise), Lie::constant, gravity);
    c.least_mps2 = 0.1 * kTrialSigma_mps2;
    c.draw(noise);
    Watch watch = proven_watch(tool, allowing(bound), 100 + allowed, gravity);
    const std::string influence = "under up to " + std::to_string(bound) + " m/s^2";
    return law.visit(watch, tool, c, noise, influence, [&](const Vec3& direction) {
      const Vec3 g = scaled(direction, kG0_mps2 + gravity * tool.tool.gravity.sigma_mps2);
      return c.with_noise(c.felt(plus(g, pushed(push, g, bound, noise)), noise), noise);
    });
  });
  law.conclude(11, count, 0.5, 0.9);
}

}  // namespace
}  // namespace acceleration_laws_test
