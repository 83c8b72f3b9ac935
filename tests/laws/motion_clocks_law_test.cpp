// Law 21: chips with clocks of their own, anywhere within their bounds: nobody healthy is isolated or excluded, and the
// published force is within its bound.
#include <gtest/gtest.h>

#include <memory>

#include "laws/law_run.hpp"
#include "motion/clocked_motion.hpp"

namespace motion_clocks_law_test {
namespace {

using namespace plumb;
using plumb_test::kLawCases;
using plumb_test::LawCount;
using plumb_test::LawOutcome;
using plumb_test::names_of;
using plumb_test::run_law;
using plumb_test::Strata;
using plumb_test::TrialNoise;

constexpr double kEnd_s = 0.12, kOnset_s = 0.03;

enum class Failure { nobody, sensor, clock };

class Case {
 public:
  Case(std::uint64_t number, TrialNoise& noise)
      : strata_(number),
        failure_(static_cast<Failure>(strata_.digit(3))),
        n_(5 + strata_.digit(4)),
        luck_(static_cast<std::uint64_t>(1e15 * noise.uniform())),
        setup_(setup(noise)),
        stated_(plumb_test::clocks_of(n_, n_, setup_, luck_)),
        array_(plumb_test::cone_array(n_, 0.01)),
        motion_(array_, setup_, static_cast<std::uint64_t>(1e15 * noise.uniform()), 160.0, 2.0),
        chips_(stated_, luck_, noise.uniform() < 0.5, 1.0, noise.uniform() < 0.5 ? 0.0 : 0.04) {
    motion_.draw_errors(noise.uniform() < 0.5);
    if (noise.uniform() < 0.5) {
      motion_.add_shock(0.03 + 0.05 * noise.uniform(),
                        scaled(plumb_test::random_direction(luck_), 400.0 * noise.uniform()));
    }
    victim_ = noise.below(n_);
    bias_mps2_ = noise.sign() * noise.log_between(0.05, 50.0);
    if (failure_ == Failure::clock) chips_.put_off(victim_, noise.sign() * noise.log_between(1e-4, 2e-2));
  }

  LawOutcome run() {
    const auto clocks = std::make_unique<MotionClocks>();
    const auto monitor = std::make_unique<MotionMonitor>();
    EXPECT_TRUE(clocks->configure(array_, setup_, stated_).has_value());
    SensorArray array = array_;
    MotionSetup setup = setup_;
    EXPECT_TRUE(with_clocks(stated_, array, setup).has_value());
    EXPECT_TRUE(monitor->configure(array, setup).has_value());
    const SensorSet faulty = failure_ == Failure::nobody ? SensorSet{} : SensorSet::of(victim_);
    for (double now_s = 0.0; now_s < kEnd_s; now_s += 0.5 * setup_.sample_period_s) {
      chips_.deliver(now_s, *clocks, [this](int, double t) { return read(t); });
      MotionSample s;
      while (clocks->next(now_s, s)) {
        ++drawn;
        const MotionVerdict& v = monitor->step(s);
        isolated = isolated | v.isolated | v.excluded;
        if (!faulty.contains(isolated))
          return broken("isolates " + names_of(isolated) + ", faulty are " + names_of(faulty));
        bounded += v.sample.validity == ForceValidity::bounded ? 1 : 0;
        if (v.sample.validity != ForceValidity::bounded) continue;
        const double error = norm(minus(v.sample.force_mps2, mean_force(v.sample.time_s)));
        if (!(error <= v.sample.bound_mps2)) return broken("the force is beyond its bound");
      }
    }
    if (drawn < 80) return broken("only " + std::to_string(drawn) + " instants were drawn");
    if (failure_ == Failure::nobody && bounded < 40)
      return broken("only " + std::to_string(bounded) + " forces were bounded");
    return {true, {}, {}};
  }

  SensorSet isolated;
  int drawn = 0, bounded = 0;

 private:
  MotionSetup setup(TrialNoise& noise) {
    MotionSetup out = plumb_test::motion_setup(n_, static_cast<std::uint64_t>(1e6 * noise.uniform()));
    out.gyros = 2;
    out.dwell_s = 0.01;
    return out;
  }
  MotionSample read(double t) {
    MotionSample s = motion_.sample_at(t);
    if (failure_ == Failure::sensor && t >= kOnset_s) s.reading_mps2[static_cast<std::size_t>(victim_)] += bias_mps2_;
    return s;
  }
  /// The published mean is that of two samples.
  Vec3 mean_force(double time_s) const {
    const double half_s = 0.5 * setup_.sample_period_s;
    return scaled(plus(motion_.force(time_s - half_s), motion_.force(time_s + half_s)), 0.5);
  }
  LawOutcome broken(const std::string& how) const {
    static const char* const words[] = {"nobody fails", "a sensor fails", "a clock is off"};
    return {true,
            "of " + std::to_string(n_) + " sensors, " + words[static_cast<int>(failure_)] + ": " + how,
            {n_, failure_ == Failure::nobody ? 0 : 1, drawn}};
  }

  Strata strata_;
  Failure failure_;
  int n_;
  plumb_test::Noise luck_;
  MotionSetup setup_;
  ClockSetup stated_;
  SensorArray array_;
  plumb_test::RigidMotion motion_;
  plumb_test::ChipClocks chips_;
  int victim_ = 0;
  double bias_mps2_ = 0.0;
};

// Verifies: REQ-207
TEST(Law, TwentyOneWithClocksOfTheirOwnNobodyHealthyIsIsolatedAndTheForceIsWithinItsBound) {
  plumb_test::expect_law_of_cases<Case>(21, kLawCases / 5, 0.05);
}

}  // namespace
}  // namespace motion_clocks_law_test
