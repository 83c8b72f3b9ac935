// What drift since the calibration does within its tolerance: law 12 of docs/property-testing.md.
#include "laws/bound_law.hpp"
#include "plumb/array/geometry.hpp"

namespace drift_law_test {
namespace {

using namespace plumb;
using namespace plumb_test;

/// Stability, 1 sigma: from a servo accelerometer's to a poor MEMS part's.
constexpr std::array<double, 7> kStability_mps2 = {2e-5 * kG0_mps2, 5e-5 * kG0_mps2, 1e-4 * kG0_mps2, 2e-4 * kG0_mps2,
                                                   5e-4 * kG0_mps2, 1e-3 * kG0_mps2, 2e-3 * kG0_mps2};

/// Which drift: any, all at the ends of their tolerance, and the corners that do most harm.
enum class Corner : std::uint8_t {
  any,
  random,
  common,  ///< all by the same
  turns,   ///< each turns the vector the same way
  blames,  ///< each adds to the residual of one sensor
};
constexpr std::array<Corner, 5> kEveryCorner = {Corner::any, Corner::random, Corner::common, Corner::turns,
                                                Corner::blames};

/// Of every sensor, as a share of its tolerance.
Readings drift_of(Corner corner, const SensorArray& array, TrialNoise& noise) {
  constexpr double kInside = 1.0 - 1e-6;  // what rounding adds must not leave the tolerance, kept in single precision
  const LeastSquares map = least_squares(array, array.all());
  const Vec3 aside = noise.direction();
  const int blamed = noise.below(array.size());
  const double sign = noise.sign();
  Readings out{};
  for (int i = 0; i < array.size(); ++i) {
    const double share = dot(map.column[slot(i)], corner == Corner::blames ? array.axis(blamed) : aside);
    const double end = share < 0.0 ? -kInside : kInside;
    switch (corner) {
      case Corner::any: out[slot(i)] = noise.between(-kInside, kInside); break;
      case Corner::random: out[slot(i)] = noise.sign() * kInside; break;
      case Corner::common: out[slot(i)] = sign * kInside; break;
      case Corner::turns: out[slot(i)] = end; break;
      case Corner::blames: out[slot(i)] = i == blamed ? -end : end; break;
    }
  }
  return out;
}

TEST(Law, TwelveNoDriftWithinItsToleranceExcludesAHealthySensorOrExceedsTheProtectionLevel) {
  BoundLaw law(BoundLaw::Tried::usable);
  const LawCount count = run_law(12, kLawCases, [&law](std::uint64_t number, TrialNoise& noise) {
    Strata strata(number);
    const auto& tools = every_tool();
    const LawTool& tool = tools[slot(strata.digit(static_cast<int>(tools.size())))];
    // The frame of fitted axes is known but for a turn that gravity does not show; the bound is in that frame.
    if (tool.knowledge == Knowledge::fitted) return not_of_this_law();
    const int faults = strata.digit(tool.strict() + 1);
    const int stated = strata.digit(static_cast<int>(kStability_mps2.size()));
    const double sigma = kStability_mps2[slot(stated)];
    const Corner corner = strata.of(kEveryCorner);
    const bool by_scale = noise.below(2) == 1, from_power_on = noise.below(2) == 1;
    const double gravity = 3.0 * (noise.below(3) - 1);
    const Lie lie = kEveryLie[slot(noise.below(static_cast<int>(kEveryLie.size())))];
    LawCase c(tool.tool, LawCase::some(tool.n(), faults, noise), lie, gravity);
    c.least_mps2 = 0.1 * kTrialSigma_mps2;
    c.draw(noise);
    const Readings share = drift_of(corner, tool.tool.array, noise);
    const auto drifted = [&](const Vec3& direction, Readings y) {
      for (int i = 0; i < tool.n(); ++i) {
        const double at = by_scale ? dot(tool.tool.array.axis(i), direction) : 1.0;
        y[slot(i)] += kStabilitySigmas * sigma * share[slot(i)] * at;
      }
      return c.with_noise(y, noise);
    };
    const MonitorConfig config = as_rare_as_rejections();
    Watch watch = from_power_on ? fresh_watch(tool, config, 200 + stated, sigma)
                                : proven_watch(tool, config, 200 + stated, gravity, sigma);
    for (int k = 0; from_power_on && k < 4; ++k) {
      const Vec3 direction = noise.direction();
      watch.station(drifted(direction, c.healthy_readings(direction)));
    }
    const std::string influence =
        "drifted by up to " + std::to_string(1e3 * kStabilitySigmas * sigma / kG0_mps2) + " mg";
    return law.visit(watch, tool, c, noise, influence,
                     [&](const Vec3& direction) { return drifted(direction, c.readings(direction, noise)); });
  });
  law.conclude(12, count, 0.25, 0.5);
}

}  // namespace
}  // namespace drift_law_test
