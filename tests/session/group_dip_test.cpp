// Gravity held against the field of a tool, block by block.
#include "plumb/session/group_dip.hpp"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace group_dip_test {
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

TrackPoint point(double end_s, const Vec3& vector, double bound_rad, bool usable = true) {
  TrackPoint out;
  out.begin_s = end_s - 0.9 * kBlock_s;
  out.end_s = end_s;
  out.usable = usable;
  out.vector = vector;
  out.bound_rad = bound_rad;
  return out;
}

/// A tool whose magnetometers expect this dip.
struct Pair {
  explicit Pair(double dip_rad, double sigma_rad = 0.0) {
    group.group = "mag";
    group.magnetic.dip_known = true;
    group.magnetic.dip_rad = dip_rad;
    group.magnetic.dip_sigma_rad = sigma_rad;
    dip.tell([this](const DipEvent& event) {
      events.push_back(event);
      return io::FileExpected<void>();
    });
  }
  void gravity(const TrackPoint& block) { ASSERT_TRUE(dip.gravity().rested(block)); }
  void field(const TrackPoint& block) { ASSERT_TRUE(dip.field().rested(block)); }
  io::ArrayFile tool, group;
  GroupDip dip{tool, group};
  std::vector<DipEvent> events;
};

// The property that matters: directions within their bounds never disagree, whatever dip, attitude and order.
// Negative: REQ-242
RC_GTEST_PROP(GroupDip, DirectionsWithinTheirBoundsNeverDisagree, ()) {
  const double dip_rad = 1e-3 * *rc::gen::inRange(-1570, 1571);
  Pair pair(dip_rad);
  const int blocks = *rc::gen::inRange(1, 20);
  for (int k = 0; k < blocks; ++k) {
    const Vec3 g = any_direction(), b = at_angle(g, kPi / 2.0 - dip_rad);
    const double bound_g = 1e-4 * *rc::gen::inRange(0, 2000), bound_b = 1e-4 * *rc::gen::inRange(0, 2000);
    const double part = 0.001 * *rc::gen::inRange(0, 1001);
    const TrackPoint gravity = point(kBlock_s * k, scaled(at_angle(g, part * bound_g), 9.8), bound_g + 1e-9);
    const TrackPoint field = point(kBlock_s * k, scaled(at_angle(b, (1.0 - part) * bound_b), 12.5), bound_b + 1e-9);
    const bool field_first = *rc::gen::arbitrary<bool>();
    if (field_first) pair.field(field);
    pair.gravity(gravity);
    if (!field_first) pair.field(field);
  }
  RC_ASSERT(pair.dip.check().checked == blocks);
  RC_ASSERT(pair.dip.check().disagreeing == 0);
  RC_ASSERT(pair.events.empty());
  RC_ASSERT(pair.dip.doubt().empty());
}

// Verifies: REQ-242
RC_GTEST_PROP(GroupDip, ATurnOfOneGroupBeyondTheBoundsIsFound, ()) {
  const double dip_rad = 1e-3 * *rc::gen::inRange(-1300, 1301);
  const double bound_rad = 1e-4 * *rc::gen::inRange(1, 500);
  const Vec3 g = any_direction();
  // Towards gravity by more than both bounds: the dip is off by that.
  const double off_rad = 2.0 * bound_rad + 1e-4 * *rc::gen::inRange(1, 1000);
  const Vec3 b = at_angle(g, kPi / 2.0 - dip_rad - off_rad);
  Pair pair(dip_rad), allowed(dip_rad, off_rad / kDipSigmas);
  for (Pair* one : {&pair, &allowed}) {
    one->field(point(1.0, b, bound_rad));
    one->gravity(point(1.0, g, bound_rad));
  }
  RC_ASSERT(pair.dip.check().checked == 1);
  RC_ASSERT(pair.dip.check().disagreeing == 1);
  RC_ASSERT(std::fabs(pair.dip.check().worst_excess_rad - (off_rad - 2.0 * bound_rad)) < 1e-6);
  RC_ASSERT(pair.dip.check().first_s == 1.0);
  RC_ASSERT(!pair.dip.doubt().empty());
  RC_ASSERT(allowed.dip.check().disagreeing == 0);
}

TEST(GroupDip, OnlyBlocksThatMeetWithBothDirectionsUsableCount) {
  const Vec3 g{0.0, 0.0, 1.0}, b{1.0, 0.0, 0.0};
  Pair pair(0.0);
  pair.gravity(point(1.0, g, 0.01));
  pair.field(point(1.0, b, 0.01));  // counts
  pair.field(point(1.6, b, 0.01));  // no gravity then
  pair.gravity(point(2.5, g, 0.01, false));
  pair.field(point(2.5, b, 0.01));
  pair.field(point(3.5, b, 0.01, false));
  pair.gravity(point(3.5, g, 0.01));
  pair.field(point(9.0, b, 0.01));
  EXPECT_EQ(pair.dip.check().checked, 1);
}

// Verifies: REQ-242
TEST(GroupDip, WhatIsNotANumberDisagrees) {
  Pair pair(0.0);
  pair.gravity(point(1.0, {0.0, 0.0, 1.0}, 0.01));
  pair.field(point(1.0, {std::nan(""), 0.0, 0.0}, 0.01));
  EXPECT_EQ(pair.dip.check().disagreeing, 1);
  EXPECT_FALSE(pair.dip.doubt().empty());
}

TEST(GroupDip, EveryBlockOfTheFieldCountsOnce) {
  Pair pair(0.0);
  pair.field(point(1.0, {1.0, 0.0, 0.0}, 0.01));
  pair.gravity(point(0.9, {0.0, 0.0, 1.0}, 0.01));
  pair.gravity(point(1.1, {0.0, 0.0, 1.0}, 0.01));
  EXPECT_EQ(pair.dip.check().checked, 1);
}

// Verifies: REQ-242
TEST(GroupDip, AnEventSaysWhenTheyBeginToDisagreeAndWhenTheyAgreeAgain) {
  const Vec3 down{0.0, 0.0, 1.0}, level{1.0, 0.0, 0.0}, steep{std::cos(0.2), 0.0, std::sin(0.2)};
  Pair pair(0.0);
  double time_s = 0.0;
  for (const Vec3& field : {level, steep, steep, level, level}) {
    pair.field(point(time_s, field, 0.01));
    pair.gravity(point(time_s, down, 0.01));
    time_s += 1.0;
  }
  ASSERT_EQ(pair.events.size(), 2U);
  EXPECT_EQ(pair.events[0].kind, DipEventKind::disagree);
  EXPECT_EQ(pair.events[0].time_s, 1.0);
  EXPECT_NEAR(pair.events[0].dip_rad, 0.2, 1e-12);
  EXPECT_EQ(pair.events[1].kind, DipEventKind::agree);
  EXPECT_EQ(pair.events[1].time_s, 3.0);
  const std::string line = dip_event_json(pair.events[0], pair.group, SensorArray());
  EXPECT_NE(line.find("\"event\":\"dip_disagrees\""), std::string::npos) << line;
  EXPECT_NE(line.find("\"group\":\"mag\""), std::string::npos) << line;
}

}  // namespace
}  // namespace group_dip_test
