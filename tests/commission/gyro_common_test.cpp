#include "plumb/commission/gyro_common.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>

#include "gyro_scene.hpp"

namespace gyro_common_test {
namespace {

using namespace plumb;
using namespace plumb::commission;
using namespace plumb_test;

constexpr double kPeriod_s = 0.01, kDirection_rad = 5e-4;

struct Fitted {
  CommissionExpected<GyroFit> relative;
  GyroLog log;
  std::vector<GravityTurn> turns;
};

Fitted fitted(const GyroScene& scene, const GyroTurns& turns, std::uint64_t seed) {
  Fitted out{tl::unexpected<std::string>(""), turning_log(scene, turns, seed),
             gravity_turns(turns, kPeriod_s, kDirection_rad, seed)};
  out.relative = fit_gyros(out.log, scene.nominal);
  return out;
}

std::string refusal(const CommissionExpected<CommonMatrix>& common) { return common ? "none" : common.error(); }
bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

/// All turns about one body axis, back and forth.
GyroTurns about(const Vec3& axis, int count) {
  GyroTurns out;
  for (int t = 0; t < count; ++t) out.angle_rad.push_back(scaled(axis, t % 2 == 0 ? 1.2 : -1.2));
  return out;
}

}  // namespace

TEST(GyroCommon, RowsBecomeAbsolute) {
  const GyroScene scene = gyro_scene(6, 1, 0.03);
  const Fitted f = fitted(scene, random_turns(20, 3), 4);
  ASSERT_TRUE(f.relative.has_value()) << f.relative.error();
  const auto common = fit_common(f.log, *f.relative, f.turns);
  ASSERT_TRUE(common.has_value()) << common.error();
  const GyroFit absolute = with_common(*f.relative, *common);
  EXPECT_TRUE(absolute.absolute);
  double before = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    before = std::fmax(before, norm(minus(f.relative->axis[i].row, scene.truth[i].row)));
    EXPECT_LT(norm(minus(absolute.axis[i].row, scene.truth[i].row)), 2e-3);
  }
  EXPECT_GT(before, 0.01) << "relative rows are pinned by the nominal axes, which are off";
  // Two directions of 0.5 mrad each, of which two components show.
  EXPECT_NEAR(common->residual_rad, 2.0 * kDirection_rad, 0.5 * kDirection_rad);

  // Other turns, which the matrix has not seen.
  const GyroTurns others = random_turns(12, 5);
  const GyroLog log = turning_log(scene, others, 6);
  const auto turns = gravity_turns(others, kPeriod_s, kDirection_rad, 7);
  const auto held_out = turn_residual_rad(log, absolute, turns), relative = turn_residual_rad(log, *f.relative, turns);
  ASSERT_TRUE(held_out.has_value() && relative.has_value());
  EXPECT_LT(*held_out, 3.0 * kDirection_rad);
  EXPECT_GT(*relative, 10.0 * kDirection_rad);
}

TEST(GyroCommon, RefusalsSayWhatIsMissing) {
  const GyroScene scene = gyro_scene(5, 2, 0.02);
  const Fitted f = fitted(scene, random_turns(16, 8), 9);
  ASSERT_TRUE(f.relative.has_value()) << f.relative.error();
  EXPECT_TRUE(fit_common(f.log, *f.relative, f.turns).has_value());

  auto few = f.turns;
  few.resize(4);
  EXPECT_TRUE(says(refusal(fit_common(f.log, *f.relative, few)), "4 turns"));

  GyroFit moving = *f.relative;
  moving.bias_from_rest = false;
  EXPECT_TRUE(says(refusal(fit_common(f.log, moving, f.turns)), "not from rest"));

  auto beyond = f.turns;
  beyond[3].end = f.log.samples();
  EXPECT_TRUE(says(refusal(fit_common(f.log, *f.relative, beyond)), "turn 3: it must end"));

  GyroLog hole = f.log;
  hole.rate_radps[1][(f.turns[2].begin + f.turns[2].end) / 2] = std::nan("");
  EXPECT_TRUE(says(refusal(fit_common(hole, *f.relative, f.turns)), "turn 2: an axis is saturated"));

  auto swapped = f.turns;
  std::swap(swapped[1].after, swapped[5].after);
  EXPECT_FALSE(fit_common(f.log, *f.relative, swapped).has_value());

  EXPECT_FALSE(turn_residual_rad(f.log, *f.relative, {}).has_value());
}

RC_GTEST_PROP(GyroCommonLaw, TheTruthIsRecoveredWithinItsSigma, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
  const GyroScene scene = gyro_scene(*rc::gen::inRange(4, 10), seed, *rc::gen::element(0.0, 0.01, 0.03));
  const Fitted f = fitted(scene, random_turns(*rc::gen::inRange(14, 30), seed), seed);
  if (!f.relative) RC_FAIL(f.relative.error());
  const auto common = fit_common(f.log, *f.relative, f.turns);
  if (!common) RC_FAIL(common.error());
  const GyroFit absolute = with_common(*f.relative, *common);
  for (std::size_t i = 0; i < absolute.axis.size(); ++i) {
    const FittedGyro& one = absolute.axis[i];
    for (std::size_t c = 0; c < 3; ++c)
      RC_ASSERT(std::fabs(one.row[c] - scene.truth[i].row[c]) < 6.0 * std::sqrt(one.row_covariance[4 * c]));
  }
}

// However many turns: about one body axis they say nothing of the others.
RC_GTEST_PROP(GyroCommonLaw, TurnsAboutOneAxisAreRefused, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
  const auto axis = *rc::gen::inRange<std::size_t>(0, 3);
  const GyroScene scene = gyro_scene(5, seed, 0.01);
  const Fitted all = fitted(scene, random_turns(16, seed), seed);
  RC_ASSERT(all.relative.has_value());
  Vec3 direction{};
  direction[axis] = 1.0;
  const GyroTurns one = about(direction, *rc::gen::inRange(5, 30));
  const auto common = fit_common(turning_log(scene, one, seed + 1), *all.relative,
                                 gravity_turns(one, kPeriod_s, kDirection_rad, seed + 2));
  RC_ASSERT(!common.has_value());
  RC_ASSERT(says(common.error(), "of 9 directions open"));
}

}  // namespace gyro_common_test
