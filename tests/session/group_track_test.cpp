// The checks between the groups of one tool.
#include "plumb/session/group_track.hpp"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

namespace group_track_test {
namespace {

using namespace plumb;
using namespace plumb::session;

constexpr double kBlock_s = 0.32;

Vec3 any_direction() {
  const double z = 1e-3 * *rc::gen::inRange(-1000, 1001), turn = 1e-3 * *rc::gen::inRange(0, 6283);
  const double across = std::sqrt(std::fmax(0.0, 1.0 - z * z));
  return {across * std::cos(turn), across * std::sin(turn), z};
}

/// A unit vector at the angle `rad` from the unit vector `from`, anywhere around it.
Vec3 at_angle(const Vec3& from, double rad) {
  const Vec3 helper = std::fabs(from[0]) < 0.7 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  const Vec3 a = scaled(cross(from, helper), 1.0 / norm(cross(from, helper))), b = cross(from, a);
  const double turn = 1e-3 * *rc::gen::inRange(0, 6283);
  return plus(scaled(from, std::cos(rad)),
              scaled(plus(scaled(a, std::cos(turn)), scaled(b, std::sin(turn))), std::sin(rad)));
}

io::MagneticReference reference_of(double dip_rad, double sigma_rad = 0.0) {
  io::MagneticReference out;
  out.dip_known = true;
  out.dip_rad = dip_rad;
  out.dip_sigma_rad = sigma_rad;
  return out;
}

/// The property that matters: directions within their bounds never disagree, whatever dip and attitude.
RC_GTEST_PROP(DipCheck, DirectionsWithinTheirBoundsNeverDisagree, ()) {
  const double dip_rad = 1e-3 * *rc::gen::inRange(-1570, 1571);
  std::vector<TrackPoint> gravity, field;
  const int blocks = *rc::gen::inRange(1, 20);
  for (int k = 0; k < blocks; ++k) {
    const Vec3 g = any_direction(), b = at_angle(g, kPi / 2.0 - dip_rad);
    const double bound_g = 1e-4 * *rc::gen::inRange(0, 2000), bound_b = 1e-4 * *rc::gen::inRange(0, 2000);
    const double part = 0.001 * *rc::gen::inRange(0, 1001);
    gravity.push_back({kBlock_s * k, true, scaled(at_angle(g, part * bound_g), 9.8), bound_g + 1e-9});
    field.push_back({kBlock_s * k, true, scaled(at_angle(b, (1.0 - part) * bound_b), 12.5), bound_b + 1e-9});
  }
  const DipCheck check = check_dip(gravity, field, reference_of(dip_rad), kBlock_s);
  RC_ASSERT(check.checked == blocks);
  RC_ASSERT(check.disagreeing == 0);
}

RC_GTEST_PROP(DipCheck, ATurnOfOneGroupBeyondTheBoundsIsFound, ()) {
  const double dip_rad = 1e-3 * *rc::gen::inRange(-1300, 1301);
  const double bound_rad = 1e-4 * *rc::gen::inRange(1, 500);
  const Vec3 g = any_direction();
  // Towards gravity by more than both bounds: the dip is off by that.
  const double off_rad = 2.0 * bound_rad + 1e-4 * *rc::gen::inRange(1, 1000);
  const Vec3 b = at_angle(g, kPi / 2.0 - dip_rad - off_rad);
  const DipCheck check =
      check_dip({{1.0, true, g, bound_rad}}, {{1.0, true, b, bound_rad}}, reference_of(dip_rad), 0.1);
  RC_ASSERT(check.checked == 1);
  RC_ASSERT(check.disagreeing == 1);
  RC_ASSERT(std::fabs(check.worst_excess_rad - (off_rad - 2.0 * bound_rad)) < 1e-6);
  RC_ASSERT(check.first_s == 1.0);
  const DipCheck allowed = check_dip({{1.0, true, g, bound_rad}}, {{1.0, true, b, bound_rad}},
                                     reference_of(dip_rad, off_rad / kDipSigmas), 0.1);
  RC_ASSERT(allowed.disagreeing == 0);
}

TEST(DipCheck, OnlyBlocksOfTheSameTimeWithBothDirectionsUsableCount) {
  const Vec3 g{0.0, 0.0, 1.0}, b{1.0, 0.0, 0.0};
  const std::vector<TrackPoint> gravity = {{1.0, true, g, 0.01}, {2.0, false, g, 0.01}, {3.0, true, g, 0.01}};
  const std::vector<TrackPoint> field = {
      {1.0, true, b, 0.01}, {1.5, true, b, 0.01}, {2.0, true, b, 0.01}, {3.0, false, b, 0.01}, {9.0, true, b, 0.01}};
  EXPECT_EQ(check_dip(gravity, field, reference_of(0.0), 0.2).checked, 1);
  EXPECT_EQ(check_dip({}, field, reference_of(0.0), 0.2).checked, 0);
  EXPECT_EQ(check_dip(gravity, {}, reference_of(0.0), 0.2).checked, 0);
}

TEST(RestTimes, LieBetweenBlocksThatFollowOneAnother) {
  std::vector<TrackPoint> track;
  for (const double t : {1.0, 1.5, 2.0, 5.0, 5.5, 9.0}) track.push_back({t, true, {0.0, 0.0, 1.0}, 0.0});
  RestTimes rest(track);
  EXPECT_FALSE(rest.at_rest(0.9));
  EXPECT_FALSE(rest.at_rest(1.0)) << "the block before is not known to begin anywhere";
  EXPECT_TRUE(rest.at_rest(1.2));
  EXPECT_TRUE(rest.at_rest(2.0));
  EXPECT_FALSE(rest.at_rest(3.0)) << "a pause";
  EXPECT_TRUE(rest.at_rest(5.4));
  EXPECT_FALSE(rest.at_rest(8.9));
  EXPECT_FALSE(RestTimes({}).at_rest(1.0));
}

}  // namespace
}  // namespace group_track_test
