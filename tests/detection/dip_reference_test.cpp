// One station judged by length and dip (docs/theory.md, T16): what is possible is kept, and only that.
#include "plumb/detection/dip_reference.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <type_traits>

#include "support/dip_scene.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-220

namespace dip_reference_test {
namespace {

using namespace plumb;
using plumb_test::DipScene;
using plumb_test::Noise;

/// Errors at the middle, in between, and at the ends of what is stated.
std::function<double()> within_bounds(Noise& noise) {
  const int kind = *rc::gen::inRange(0, 4);
  return [&noise, kind] {
    const double u = 2.0 * noise.uniform() - 1.0;
    return kind == 0 ? 0.0 : kind == 1 ? (u < 0.0 ? -1.0 : 1.0) : u;
  };
}

/// Three to six axes, some nearly in a plane; any dip, both ends among them.
DipScene drawn_scene(Noise& noise) {
  const int n = *rc::gen::element(3, 3, 3, 4, kCapacity < 6 ? 4 : 6);
  const double least_det = *rc::gen::element(0.06, 0.3, 0.9);
  const double dip_deg = *rc::gen::oneOf(rc::gen::element(0.0, 90.0, -90.0, 50.0, 72.0),
                                         rc::gen::map(rc::gen::inRange(-900, 901), [](int k) { return 0.1 * k; }));
  DipScene scene = DipScene::make(plumb_test::sensors_along(plumb_test::random_axes(n, least_det, noise), n), dip_deg);
  scene.stated.field.vector_nt = *rc::gen::element(0.0, 50.0, 500.0);
  scene.stated.field.turn_rad = *rc::gen::element(0.0, 0.003);
  scene.stated.reference.dip_error_rad.bound = *rc::gen::element(0.0, 0.01, 0.2);
  scene.stated.acceleration_mps2 = *rc::gen::element(0.0, 0.0, 0.01);
  return scene;
}

/// Of any size up to 2 g0, log-uniform, or the one that keeps the length (of three sensors).
double drawn_fault(const DipScene& scene, int i, const Vec3& down, Noise& noise) {
  if (scene.array.size() == 3 && *rc::gen::inRange(0, 3) == 0)
    return plumb_test::mirror_fault_mps2(scene.array, i, scaled(down, scene.g_mps2)) * (1.0 + 1e-3 * noise.normal());
  return (noise.uniform() < 0.5 ? -1.0 : 1.0) * 2.0 * kG0_mps2 * std::pow(1e-4, noise.uniform());
}

// Verifies: REQ-220
RC_GTEST_PROP(DipReferenceLaw, TheTruthIsNeverLeftOut, ()) {
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  DipScene scene = drawn_scene(noise);
  const auto draw = within_bounds(noise);
  scene.settle(draw);
  const Vec3 down = plumb_test::random_direction(noise);
  const int i = *rc::gen::inRange(-1, scene.array.size());
  const double f = i < 0 ? 0.0 : drawn_fault(scene, i, down, noise);
  const DipStation station = scene.station(down, i, f, noise, draw);
  const DipJudgement judged = judge_dip(scene.array, station);
  RC_ASSERT(judged.refusal == DipRefusal::none);
  if (i < 0) {
    RC_ASSERT(judged.none.consistent());
  } else {
    RC_ASSERT(judged.faulty[static_cast<std::size_t>(i)].fault().has(f));
  }
}

// Verifies: REQ-220
RC_GTEST_PROP(DipReferenceLaw, WhatIsLeftExplainsTheStation, ()) {
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  DipScene scene = drawn_scene(noise);
  const auto draw = within_bounds(noise);
  scene.settle(draw);
  const Vec3 down = plumb_test::random_direction(noise);
  const DipStation station = scene.station(down, 0, drawn_fault(scene, 0, down, noise), noise, draw);
  const DipJudgement judged = judge_dip(scene.array, station);
  const double k = station.sigmas;
  for (int i = 0; i < scene.array.size(); ++i) {
    const DipHypothesis& h = judged.faulty[static_cast<std::size_t>(i)];
    RC_ASSERT(h.shift.plausible());
    for (int r = 0; r < h.shift.count; ++r) {
      const FaultRange& range = h.shift.range[static_cast<std::size_t>(r)];
      for (const double t : {range.low_mps2, 0.5 * (range.low_mps2 + range.high_mps2), range.high_mps2}) {
        const Vec3 q = minus(judged.x_mps2, scaled(judged.column[static_cast<std::size_t>(i)], t));
        const double length_off = std::fabs(norm(q) - station.gravity.g_mps2) - k * station.gravity.sigma_mps2;
        RC_ASSERT(length_off <= sine_of(std::fmin(h.turn_rad, 1.5)) * 10.5 + 1e-6);
        const double angle = angle_between_rad(q, station.field.field_nt);
        const double off = std::fabs(0.5 * kPi - angle - station.reference.dip_rad);
        // The band in gravity along the field is that of the angle, but for the lengths: within 0.1 deg of it, and near
        // 90 deg where a cosine is flat within the root of twice as much.
        const double allowed = station.reference.dip_error_rad.within(k) + station.field.turn_rad +
                               (6e3 * 0.02 + station.field.vector_nt + 90.0 * k) / 4.5e4 + 1.6 * h.turn_rad;
        RC_ASSERT(off <= allowed + std::sqrt(allowed) + 0.06);
      }
    }
  }
}

// Negative: REQ-220
TEST(DipReference, AnErrorBeyondWhatIsStatedMayLeaveTheTruthOut) {
  Noise noise(3);
  const DipScene scene = DipScene::make(plumb_test::triad_array(), 60.0);
  const Vec3 down = plumb_test::direction_at(40, 70);
  DipStation station = scene.station(down, -1, 0.0, noise, [] { return 0.0; });
  EXPECT_TRUE(judge_dip(scene.array, station).none.consistent());
  station.mean_mps2[0] += 0.1;  // 10 mg where 0.42 mg are stated
  EXPECT_FALSE(judge_dip(scene.array, station).none.consistent());
  station.bound_mps2[0] = 0.1;
  EXPECT_TRUE(judge_dip(scene.array, station).none.consistent());
}

/// T16: the length does not see a mirror fault; the dip does, unless the faulty one's column is across the field.
TEST(DipReference, AMirrorFaultShowsInTheDipUnlessTheFieldLiesInTheMirror) {
  Noise noise(5);
  const DipScene scene = DipScene::make(plumb_test::triad_array(), 60.0);
  const Vec3 down = plumb_test::direction_at(40, 70);
  const double f = plumb_test::mirror_fault_mps2(scene.array, 0, scaled(down, scene.g_mps2));
  ASSERT_GT(std::fabs(f), 0.5 * kG0_mps2);
  const auto exact = [] { return 0.0; };
  DipStation seen = scene.station(down, 0, f, noise, exact);
  EXPECT_FALSE(judge_dip(scene.array, seen).none.consistent());
  DipStation blind = seen;
  blind.reference.dip_error_rad.bound = kPi;
  EXPECT_TRUE(judge_dip(scene.array, blind).none.consistent());
  const Vec3 along{0.0, 0.6, 0.8};  // in the plane of the two healthy axes
  DipScene there = scene;
  there.dip_rad = there.stated.reference.dip_rad = 0.5 * kPi - angle_between_rad(along, down);
  EXPECT_TRUE(judge_dip(scene.array, there.station(down, along, 0, f, noise, exact)).none.consistent());
}

RC_GTEST_PROP(DipReferenceLaw, ALargerFaultThanTheSurelySeenIsSeen, ()) {
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  DipScene scene = drawn_scene(noise);
  scene.stated.field.vector_nt = 0.0;
  const auto draw = within_bounds(noise);
  const double stated_dip = scene.dip_rad;
  scene.settle(draw);
  const Vec3 down = plumb_test::random_direction(noise);
  const int i = *rc::gen::inRange(0, scene.array.size());
  DipStation figures = scene.stated;
  const Vec3 along = plumb_test::direction_beside(down, 0.5 * kPi - scene.dip_rad, noise);
  figures.field.field_nt = scaled(along, scene.total_nt);
  RC_ASSERT(std::fabs(stated_dip - scene.stated.reference.dip_rad) < 1e-12);
  const double seen = surely_seen_mps2(scene.array, figures, scaled(down, scene.g_mps2), i);
  RC_ASSERT(seen > 0.0);
  const double f = (noise.uniform() < 0.5 ? -1.0 : 1.0) * seen * (1.0 + 0.3 * noise.uniform() + 1e-6);
  const DipStation station = scene.station(down, along, i, f, noise, draw);
  RC_ASSERT(!judge_dip(scene.array, station).none.consistent());
}

/// A dip that is off by its whole bound, either way: no larger fault passes, and one of nearly that size does.
TEST(DipReference, TheSurelySeenCountsTheErrorOfTheDipTwice) {
  Noise noise(27);
  DipScene scene = DipScene::make(plumb_test::triad_array(), 55.0);
  constexpr double kBound_rad = 0.1;
  scene.stated.reference.dip_error_rad = {0.0, kBound_rad};
  const Vec3 down = plumb_test::direction_at(50, 130);
  const Vec3 along = plumb_test::direction_beside(down, 0.5 * kPi - scene.dip_rad, noise);
  DipStation figures = scene.stated;
  figures.field.field_nt = scaled(along, scene.total_nt);
  const double seen = surely_seen_mps2(scene.array, figures, scaled(down, scene.g_mps2), 0);
  double largest = 0.0;
  for (const double off_rad : {-kBound_rad, kBound_rad}) {
    for (int k = -2000; k <= 2000; ++k) {
      const double f = 0.01 * k;
      DipStation station = scene.station(down, along, 0, f, noise, [] { return 0.0; });
      station.reference.dip_rad += off_rad;
      if (judge_dip(scene.array, station).none.consistent()) largest = std::fmax(largest, std::fabs(f));
    }
  }
  EXPECT_LE(largest, seen);
  EXPECT_GT(largest, 0.0);
  figures.reference.dip_error_rad.bound = 0.5 * kBound_rad;
  EXPECT_LT(surely_seen_mps2(scene.array, figures, scaled(down, scene.g_mps2), 0), seen);
}

// Verifies: REQ-223
TEST(DipReference, WhatCannotBeJudgedIsRefusedWithAReason) {
  Noise noise(9);
  const DipScene scene = DipScene::make(plumb_test::triad_array(), 60.0);
  const DipStation good = scene.station(plumb_test::direction_at(40, 70), -1, 0.0, noise, [] { return 0.0; });
  const auto refusal = [&](const std::function<void(DipStation&)>& spoil) {
    DipStation station = good;
    spoil(station);
    return judge_dip(scene.array, station).refusal;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal([](DipStation&) {}), DipRefusal::none);
  EXPECT_EQ(refusal([](DipStation& s) { s.used = s.used.without(1); }), DipRefusal::too_few_sensors);
  EXPECT_EQ(refusal([](DipStation& s) { s.used = SensorSet::first(4); }), DipRefusal::too_few_sensors);
  EXPECT_EQ(refusal([=](DipStation& s) { s.mean_mps2[2] = kNan; }), DipRefusal::not_finite);
  EXPECT_EQ(refusal([=](DipStation& s) { s.field.field_nt[0] = kInf; }), DipRefusal::not_finite);
  EXPECT_EQ(refusal([=](DipStation& s) { s.reference.dip_rad = kNan; }), DipRefusal::not_finite);
  EXPECT_EQ(refusal([=](DipStation& s) { s.acceleration_mps2 = kNan; }), DipRefusal::not_finite);
  EXPECT_EQ(refusal([=](DipStation& s) { s.sigmas = kNan; }), DipRefusal::not_finite);
  EXPECT_EQ(refusal([](DipStation& s) { s.sigma_mps2[0] = 0.0; }), DipRefusal::error_not_positive);
  EXPECT_EQ(refusal([](DipStation& s) { s.bound_mps2[0] = -1e-6; }), DipRefusal::error_not_positive);
  EXPECT_EQ(refusal([](DipStation& s) { s.reference.dip_error_rad.sigma = -0.1; }), DipRefusal::error_not_positive);
  EXPECT_EQ(refusal([](DipStation& s) { s.field.turn_rad = -0.1; }), DipRefusal::error_not_positive);
  EXPECT_EQ(refusal([](DipStation& s) { s.gravity.g_mps2 = 0.0; }), DipRefusal::bad_reference);
  EXPECT_EQ(refusal([](DipStation& s) { s.reference.total_nt = 0.0; }), DipRefusal::bad_reference);
  EXPECT_EQ(refusal([](DipStation& s) { s.reference.dip_rad = 1.6; }), DipRefusal::bad_reference);
  EXPECT_EQ(refusal([](DipStation& s) { s.field.field_nt = {}; }), DipRefusal::too_coarse);
  EXPECT_EQ(refusal([](DipStation& s) { s.gravity.sigma_mps2 = 3.0; }), DipRefusal::too_coarse);
  EXPECT_EQ(refusal([](DipStation& s) { s.field.vector_nt = 6e4; }), DipRefusal::too_coarse);
  EXPECT_EQ(refusal([](DipStation& s) { s.field.field_nt = scaled(s.field.field_nt, 1.05); }),
            DipRefusal::field_length);
  EXPECT_STREQ(to_string(DipRefusal::field_length), "field_length");
  for (int k = 0; k <= static_cast<int>(kLastDipRefusal); ++k)
    EXPECT_STRNE(to_string(static_cast<DipRefusal>(k)), "?") << k;
  EXPECT_STREQ(to_string(static_cast<DipRefusal>(99)), "?");
}

// Negative: REQ-223
TEST(DipReference, AFieldWithinItsReferenceIsJudgedAtAnyDip) {
  Noise noise(9);
  for (const double dip_deg : {-90.0, -40.0, 0.0, 70.0, 89.9, 90.0}) {
    const DipScene scene = DipScene::make(plumb_test::triad_array(), dip_deg);
    DipStation station = scene.station(plumb_test::direction_at(40, 70), -1, 0.0, noise, [] { return 0.0; });
    station.field.field_nt = scaled(station.field.field_nt, 1.01);
    const DipJudgement judged = judge_dip(scene.array, station);
    EXPECT_EQ(judged.refusal, DipRefusal::none) << dip_deg;
    EXPECT_TRUE(judged.none.consistent()) << dip_deg;
  }
}

/// Four sensors check each other without either reference.
TEST(DipReference, ResidualsCountWhereThereAreMoreThanThree) {
  Noise noise(13);
  const DipScene scene = DipScene::make(plumb_test::tetrahedron(), 60.0);
  DipStation station = scene.station(plumb_test::direction_at(40, 70), 2, 0.5, noise, [] { return 0.0; });
  station.gravity.sigma_mps2 = 0.5;
  station.reference.dip_error_rad.bound = kPi;
  const DipJudgement judged = judge_dip(scene.array, station);
  EXPECT_FALSE(judged.none.consistent());
  for (std::size_t i = 0; i < 4; ++i) {
    const FaultRanges fault = judged.faulty[i].fault();
    ASSERT_EQ(fault.count, 1) << i;
    EXPECT_NEAR(std::fabs(fault.range[0].low_mps2 + fault.range[0].high_mps2), 1.0, 0.02) << i;
  }
}

TEST(DipReference, IsPlainData) {
  EXPECT_TRUE((std::is_trivially_copyable_v<DipStation> && std::is_trivially_copyable_v<DipJudgement>));
  EXPECT_TRUE(noexcept(judge_dip(SensorArray{}, DipStation{})));
  EXPECT_EQ(judge_dip(SensorArray{}, DipStation{}).refusal, DipRefusal::too_few_sensors);
}

}  // namespace
}  // namespace dip_reference_test
