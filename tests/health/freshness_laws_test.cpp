// Whatever befalls a tool: what is called valid rests on samples that arrive now, and read what the block read.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "snapshot_support.hpp"

namespace freshness_laws_test {
namespace {

using namespace plumb;
using plumb_test::Life;
using plumb_test::Noise;
using plumb_test::random_direction;
using plumb_test::Rig;

bool says_usable(const Verdict& v) { return v.validity == Validity::valid || v.validity == Validity::degraded; }

/// For every input: with no accepted sample within T_age nothing is valid, and alert is on; and what is not valid is
/// not usable.
// Negative: REQ-128
RC_GTEST_PROP(FreshnessLaw, WithoutAnAcceptedSampleNothingIsValid, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  Life life(n, *rc::gen::arbitrary<std::uint64_t>());
  HealthMonitor& monitor = life.tool.rig.monitor;
  const int dry_spell = *rc::gen::inRange(1, 200);
  const double step_s = *rc::gen::element(0.01, 0.3, 4.0, 6.0);
  double accepted_s = 0.0, skew_s = 0.0;
  int missing = 0;
  for (int k = 0; k < 2500; ++k) {
    Sample sample = life.next({&monitor});
    const bool dry = k / dry_spell % 7 == 6;
    if (dry) {
      sample.delivered = SensorSet{};
      skew_s += step_s;
    }
    sample.time_s += skew_s;
    const Verdict& v = monitor.step(sample);
    missing = v.accepted && sample.delivered.contains(v.in_service) ? 0 : missing + 1;
    if (v.accepted) accepted_s = sample.time_s;
    const double without_s = sample.time_s - accepted_s;
    if (missing >= monitor.config().missing_confirm || without_s > 1.0) {
      RC_ASSERT(!says_usable(v) || missing < monitor.config().missing_confirm);
      RC_ASSERT(!says_usable(v) || without_s <= 1.0);
      RC_ASSERT(v.alert || v.validity == Validity::valid);
    }
    RC_ASSERT(v.alert || says_usable(v));
    RC_ASSERT(says_usable(v) == ((v.usable & Usable::vector) != 0));
    RC_ASSERT(v.validity != Validity::held || (v.usable & (Usable::stationary | Usable::protection_level)) == 0);
    RC_ASSERT((v.usable & Usable::protection_level) != 0 || v.alert);
  }
}

/// A tool without a fault that rests and turns as it likes: while a sample is called valid, the vector is within its
/// bound of the truth at that sample, and within what one reading shows.
// Verifies: REQ-128
RC_GTEST_PROP(FreshnessLaw, ValidIsTrueOfThisSample, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Rig rig(n == 4 ? plumb_test::tetrahedron() : plumb_test::cone_array(n), {}, seed);
  rig.prove();
  Noise luck(seed + 1);
  // One reading of each sensor within 6 sigma: what the vector may be off by without any of them showing it.
  const double unseen_rad = 6.5 * 2.0 * rig.setup.array.sigma_mps2(0) / kG0_mps2 * std::sqrt(n / 3.0);
  Vec3 u = random_direction(luck);
  int left = 0, valid = 0;
  double rate = 0.0;
  Vec3 about{};
  for (int k = 0; k < 3000; ++k) {
    if (--left <= 0) {
      left = 1 + static_cast<int>(150.0 * luck.uniform());
      rate = luck.uniform() < 0.5 ? 0.0 : std::pow(10.0, -5.0 + 4.0 * luck.uniform());  // rad per sample
      about = random_direction(luck);
      if (luck.uniform() < 0.2) u = random_direction(luck);
    }
    const Vec3 moved = plus(u, scaled(cross(about, u), rate));
    u = scaled(moved, 1.0 / norm(moved));
    const Verdict& v = rig.step(rig.sample(u, kG0_mps2));
    if (v.validity != Validity::valid) continue;
    ++valid;
    RC_ASSERT(angle_between_rad(v.gravity_mps2, u) <= v.protection_level_calibrated_axes_rad + unseen_rad);
  }
  RC_CLASSIFY(valid > 0, "valid at some time");
}

}  // namespace
}  // namespace freshness_laws_test
