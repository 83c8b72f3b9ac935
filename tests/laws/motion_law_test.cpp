// Law 19: in motion nobody healthy is isolated or excluded, and the published force is within its bound.
#include <gtest/gtest.h>

#include <algorithm>

#include "laws/law_run.hpp"
#include "motion/rigid_motion.hpp"

namespace motion_law_test {
namespace {

using namespace plumb;
using plumb_test::kLawCases;
using plumb_test::LawCount;
using plumb_test::LawOutcome;
using plumb_test::names_of;
using plumb_test::run_law;
using plumb_test::Strata;
using plumb_test::TrialNoise;

constexpr std::uint64_t kSamples = 100;
constexpr double kOnset_s = 0.02;

/// Who fails, beside what healthy sensors may be off by.
enum class Failure { nobody, sensor, gyro, sensor_and_one_gyro_of_two };

class Case {
 public:
  Case(std::uint64_t number, TrialNoise& noise)
      : strata_(number),
        failure_(static_cast<Failure>(strata_.digit(4))),
        n_(5 + strata_.digit(4)),
        setup_(setup(noise)),
        array_(plumb_test::cone_array(n_, 0.01)),
        motion_(array_, setup_, static_cast<std::uint64_t>(1e15 * noise.uniform()), 60.0, 4.0) {
    motion_.draw_errors(noise.uniform() < 0.5);
    if (noise.uniform() < 0.5) {
      motion_.add_shock(0.03 + 0.03 * noise.uniform(),
                        scaled(plumb_test::random_direction(luck_), 400.0 * noise.uniform()));
    }
    victim_ = noise.below(n_);
    bias_mps2_ = noise.sign() * noise.log_between(0.05, 50.0);
    scale_ = noise.between(-1.0, 3.0);
  }

  LawOutcome run() {
    MotionMonitor monitor;
    EXPECT_TRUE(monitor.configure(array_, setup_).has_value());
    const SensorSet faulty = fails() ? SensorSet::of(victim_) : SensorSet{};
    for (std::uint64_t k = 0; k < kSamples; ++k) {
      const MotionVerdict& v = monitor.step(sample(k));
      isolated = isolated | v.isolated | v.excluded;
      if (!faulty.contains(isolated))
        return broken("isolates " + names_of(isolated) + ", faulty are " + names_of(faulty), k);
      if (v.sample.validity != ForceValidity::bounded || (fails_gyro() && v.sample.gyro_assumed)) continue;
      const double error = norm(minus(v.sample.force_mps2, mean_force(v.sample.time_s)));
      if (!(error <= v.sample.bound_mps2)) return broken("the force is beyond its bound", k);
    }
    return {true, {}, {}};
  }

  SensorSet isolated;

 private:
  MotionSetup setup(TrialNoise& noise) {
    MotionSetup out = plumb_test::motion_setup(n_, static_cast<std::uint64_t>(1e6 * noise.uniform()));
    out.gyros = failure_ == Failure::sensor_and_one_gyro_of_two ? 2 : 1;
    out.dwell_s = 0.01;
    constexpr BlockSamples kBlocks[] = {kMotionSamples, {1, 2, 6, 30}, {1, 5, 10, 20}};
    out.block_samples = kBlocks[strata_.digit(3)];
    luck_ = plumb_test::Noise(static_cast<std::uint64_t>(1e15 * noise.uniform()));
    return out;
  }
  bool fails() const { return failure_ == Failure::sensor || failure_ == Failure::sensor_and_one_gyro_of_two; }
  bool fails_gyro() const { return failure_ == Failure::gyro; }
  MotionSample sample(std::uint64_t k) {
    MotionSample s = motion_.sample(k);
    if (s.time_s < kOnset_s) return s;
    if (fails()) s.reading_mps2[static_cast<std::size_t>(victim_)] += bias_mps2_;
    if (fails_gyro()) s.rate_radps[0] = scaled(s.rate_radps[0], scale_);
    if (setup_.gyros == 2) s.rate_radps[1] = scaled(s.rate_radps[1], scale_);
    return s;
  }
  /// The published mean is that of two samples.
  Vec3 mean_force(double time_s) const {
    const double half_s = 0.5 * setup_.sample_period_s;
    return scaled(plus(motion_.force(time_s - half_s), motion_.force(time_s + half_s)), 0.5);
  }
  LawOutcome broken(const std::string& how, std::uint64_t k) const {
    static const char* const words[] = {"nobody fails", "a sensor fails", "the gyro fails",
                                        "a sensor and one gyro of two fail"};
    return {true,
            "of " + std::to_string(n_) + " sensors, " + words[static_cast<int>(failure_)] + ": " + how + ", sample " +
                std::to_string(k),
            {n_, fails() ? 1 : 0, static_cast<int>(k)}};
  }

  Strata strata_;
  Failure failure_;
  int n_;
  plumb_test::Noise luck_{0};
  MotionSetup setup_;
  SensorArray array_;
  plumb_test::RigidMotion motion_;
  int victim_ = 0;
  double bias_mps2_ = 0.0, scale_ = 1.0;
};

// Verifies: REQ-201, REQ-204, REQ-205
TEST(Law, NineteenInMotionNobodyHealthyIsIsolatedAndTheForceIsWithinItsBound) {
  plumb_test::expect_law_of_cases<Case>(19, kLawCases, 0.05);
}

}  // namespace
}  // namespace motion_law_test
