#include "plumb/detection/isolation.hpp"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>
#include <algorithm>

#include <cmath>

#include "support/simulated_tool.hpp"

namespace isolation_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

const GravityReference kGravity{kG0_mps2, 1e-3, GravityModel::value};
constexpr double kSigma = 5e-4 * kG0_mps2;

struct Case {
  SensorArray array;
  TestLimits limits;
  Isolation isolation;
  Noise noise;

  Case(const SensorArray& a, std::uint64_t seed)
      : array(a), limits(TestLimits::from_rates(a.size(), 1e-5, 1e-6)), noise(seed) {
    isolation.pose(array, array.all());
  }
  BlockEvidence block(const Vec3& u, const std::array<double, kCapacity>& fault, double samples = 32) {
    BlockEvidence out;
    out.usable = array.all();
    out.samples = samples;
    for (int i = 0; i < array.size(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      out.mean_mps2[a] =
          dot(array.axis(i), u) * kG0_mps2 + fault[a] + array.sigma_mps2(i) / std::sqrt(samples) * noise.normal();
    }
    return out;
  }
};

// Verifies: REQ-006
TEST(Isolation, GradesOfNamedArrays) {
  Case tetra(plumb_test::tetrahedron(), 1);
  EXPECT_EQ(tetra.isolation.confirmed_grade(), 1);
  EXPECT_EQ(tetra.isolation.provisional_grade(), 0);
  EXPECT_EQ(tetra.isolation.voting(), 4);
  Case cone(plumb_test::cone_array(7), 1);
  EXPECT_EQ(cone.isolation.confirmed_grade(), 4);
  EXPECT_EQ(cone.isolation.provisional_grade(), 3);
  EXPECT_EQ(cone.isolation.voting(), 35);
}

// Verifies: REQ-072
TEST(Isolation, OneStationIsolatesTheFaultOfAFiveSensorConeByParityAlone) {
  Case c(plumb_test::cone_array(5, kSigma), 7);
  std::array<double, kCapacity> fault{};
  fault[3] = 0.5;
  const IsolationAnswer answer = c.isolation.vote({c.array, kGravity, c.limits, c.block({0.6, 0.0, 0.8}, fault)});
  EXPECT_EQ(answer.parity, SensorSet::of(3));
  EXPECT_FALSE(answer.full_consistent);
}

// Negative: REQ-070
TEST(Isolation, AMirrorAtEveryStationNeverIsolatesAHealthySensorAtTheConfirmedGrade) {
  Case c(plumb_test::tetrahedron(kSigma), 11);
  const Mat3 map = triple_map(c.array, c.array.triple_index(0, 1, 3));
  const Vec3 w = {map[0], map[3], map[6]};
  for (int station = 0; station < 30; ++station) {
    const Vec3 u = plumb_test::random_direction(c.noise);
    std::array<double, kCapacity> fault{};
    fault[0] = -2.0 * kG0_mps2 * dot(u, w) / dot(w, w);
    const IsolationAnswer answer = c.isolation.vote({c.array, kGravity, c.limits, c.block(u, fault)});
    EXPECT_TRUE((answer.strict - SensorSet::of(0)).empty());
  }
  EXPECT_GE(c.isolation.live(), 2) << "truth {2,3,4} and mirror {1,2,4} both explain everything";
}

// Negative: REQ-103
TEST(Isolation, MoreStationsAtOneAttitudeDoNotResolveAnotherAttitudeDoes) {
  Case c(plumb_test::tetrahedron(kSigma), 13);
  const Mat3 map = triple_map(c.array, c.array.triple_index(0, 1, 3));
  const Vec3 w = {map[0], map[3], map[6]};
  const Vec3 u = plumb_test::direction_at(20, 40);
  std::array<double, kCapacity> fault{};
  fault[0] = -2.0 * kG0_mps2 * dot(u, w) / dot(w, w);  // a constant bias, exactly mirrored here
  for (int k = 0; k < 20; ++k) {
    EXPECT_TRUE(c.isolation.vote({c.array, kGravity, c.limits, c.block(u, fault)}).strict.empty());
  }
  const IsolationAnswer answer =
      c.isolation.vote({c.array, kGravity, c.limits, c.block(plumb_test::direction_at(20, 50), fault)});
  EXPECT_EQ(answer.strict, SensorSet::of(0));
}

// Verifies: REQ-061
TEST(Isolation, AWrongGravityVoidsTheNormAndIsolatesNoSensor) {
  for (int n = 5; n <= kCapacity; ++n) {
    Case c(plumb_test::cone_array(n, kSigma), 17);
    const GravityReference wrong{kG0_mps2 * 1.01, 1e-4, GravityModel::value};
    for (int station = 0; station < 10; ++station) {
      std::array<double, kCapacity> none{};
      const auto answer =
          c.isolation.vote({c.array, wrong, c.limits, c.block(plumb_test::random_direction(c.noise), none)});
      EXPECT_TRUE(answer.norm_void);
      EXPECT_TRUE(answer.strict.empty());
      EXPECT_TRUE(answer.parity.empty());
      EXPECT_FALSE(answer.no_consistent_hypothesis);
    }
  }
}

/// A precise sensor among noisy ones has little leverage, and so has an axis that stands nearly alone. A steady
/// acceleration that the others show without it is no fault of its own.
// Verifies: REQ-061
TEST(Isolation, AnAccelerationThatTheOthersShowTooIsNoFaultOfAWeaklyCheckedMember) {
  std::array<SensorRow, kCapacity> rows{};
  AxisList axes{};
  const int n = cone_with_axis(axes, 6);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    rows[i].id = make_id(("a" + std::to_string(i)).c_str());
    rows[i].axis = axes[i];
    rows[i].sigma_mps2 = i == 5 ? 0.1 * kSigma : kSigma;
  }
  Case c(*SensorArray::make(rows.data(), n), 23);
  const std::array<double, kCapacity> none{};
  const SetTest whole = test_set(c.array, kGravity, c.limits, c.block({0, 0, 1}, none), c.array.all());
  ASSERT_LT(whole.least_leverage, 0.05);
  for (int station = 0; station < 40; ++station) {
    const Vec3 u = plumb_test::random_direction(c.noise);
    const Vec3 along = plumb_test::random_direction(c.noise);
    const double strong = 0.05 * kG0_mps2;
    std::array<double, kCapacity> steady{};
    for (int i = 0; i < n; ++i) steady[static_cast<std::size_t>(i)] = strong * dot(c.array.axis(i), along);
    const BlockEvidence block = c.block(u, steady);
    const SetTest t = test_set(c.array, kGravity, c.limits, block, c.array.all());
    const SetTest without = test_set(c.array, kGravity, c.limits, block, c.array.all().without(5));
    const bool shown = std::fabs(t.norm) > t.norm_reject_limit(c.limits) &&
                       std::fabs(without.norm) > without.norm_reject_limit(c.limits);
    const auto answer = c.isolation.vote({c.array, kGravity, c.limits, block});
    EXPECT_TRUE(answer.norm_void || !shown) << station;
    EXPECT_TRUE(answer.strict.empty()) << station;
  }
}

/// One sensor is provisionally excluded, and the next fault is among those that are left: the level covers it as it
/// does once the first is excluded.
// Negative: REQ-121
TEST(Isolation, TheNextFaultAfterAProvisionalExclusionIsWithinTheProtectionLevel) {
  int judged = 0;
  for (int n = 5; n <= std::min(7, kCapacity); ++n) {
    Case c(plumb_test::cone_array(n), 31);
    const SensorSet left = c.array.all().without(0);
    Isolation latched;
    latched.pose(c.array, left);
    std::array<double, kCapacity> fault{};
    fault[0] = 2.0;
    for (int station = 0; station < 20; ++station) {
      fault[2] = 1e-5 * station * kG0_mps2;
      const BlockEvidence block = c.block(plumb_test::random_direction(c.noise), fault);
      const ProtectionTerms terms{1, 4.9};
      const FaultSetScan aside = c.isolation.scan({c.array, kGravity, c.limits, block}, left, 1, -1, terms);
      const FaultSetScan out = latched.scan({c.array, kGravity, c.limits, block}, left, 1, -1, terms);
      if (!aside.protection_available || !out.protection_available) continue;
      ++judged;
      EXPECT_GE(aside.protection_rad, out.protection_rad) << n << " " << station;
    }
  }
  EXPECT_GT(judged, 40);
}

/// Four axes in the plane of x and y, and four along z: the last four are read by nothing but one another and the
/// length.
SensorArray fan_and_four_z() {
  static_assert(kCapacity >= 8, "eight sensors");
  AxisList axes{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double turn_rad = rad_from_deg(45.0 * static_cast<double>(i));
    axes[i] = {std::cos(turn_rad), std::sin(turn_rad), 0.0};
    axes[4 + i] = {0.0, 0.0, 1.0};
  }
  return plumb_test::make_array(axes, 8, kSigma);
}

/// Of four sensors of one direction two are provisionally excluded, and what moved them has moved the others alike:
/// these check one another and are wrong together. The level counts them as one fault.
// Verifies: REQ-044
TEST(Isolation, ACommonCauseOfOneDirectionIsWithinTheProtectionLevel) {
  Case c(fan_and_four_z(), 33);
  const SensorSet left = c.array.all().without(4).without(5);
  int hidden = 0;
  for (int station = 1; station <= 40; ++station) {
    std::array<double, kCapacity> drift{};
    drift[4] = drift[5] = 2.0;
    drift[6] = drift[7] = 2.5e-4 * station * kG0_mps2;
    // Horizontal, and the other half anywhere.
    const Vec3 u =
        station % 2 == 0 ? plumb_test::direction_at(90.0, 25.0 * station) : plumb_test::random_direction(c.noise);
    const BlockEvidence block = c.block(u, drift);
    const FaultSetScan scan = c.isolation.scan({c.array, kGravity, c.limits, block}, left, 1, -1, {1, 4.9, 2});
    const SetTest used = test_set(c.array, kGravity, c.limits, block, left);
    if (!used.consistent(c.limits)) continue;  // the length shows it
    ++hidden;
    EXPECT_TRUE(!scan.protection_available || scan.protection_rad >= angle_between_rad(used.x_mps2, u)) << station;
  }
  EXPECT_GT(hidden, 10);
}

// Negative: REQ-044
TEST(Isolation, OneExcludedSensorOfADirectionIsNoCommonCause) {
  Case c(fan_and_four_z(), 34);
  const Vec3 u = plumb_test::direction_at(90, 20);
  const ProtectionTerms one{1, 4.9, 1}, two{1, 4.9, 2};
  std::array<double, kCapacity> moved{};
  moved[4] = 2.0;
  const BlockEvidence by_one = c.block(u, moved);
  moved[5] = 2.0;
  const BlockEvidence by_two = c.block(u, moved);
  const SensorSet left = c.array.all().without(4);
  EXPECT_LT(c.isolation.scan({c.array, kGravity, c.limits, by_one}, left, 1, -1, one).protection_rad, 2e-3);
  EXPECT_GT(c.isolation.scan({c.array, kGravity, c.limits, by_two}, left.without(5), 1, -1, two).protection_rad, 1e-2)
      << "horizontal: the length shows no z";
}

/// Where the others know the length too badly to deny the acceleration, it is no fault of the precise one either; a
/// reading that they do deny is.
// Negative: REQ-061
TEST(Isolation, WhatTheOthersCannotDenyIsNoFaultOfAWeaklyCheckedMember) {
  std::array<SensorRow, kCapacity> rows{};
  AxisList axes{};
  const int n = cone_with_axis(axes, 6);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    rows[i].id = make_id(("a" + std::to_string(i)).c_str());
    rows[i].axis = axes[i];
    rows[i].sigma_mps2 = i == 5 ? 0.01 * kSigma : kSigma;
  }
  Case c(*SensorArray::make(rows.data(), n), 29);
  const Vec3 along = c.array.axis(5);
  int shown_by_all_only = 0, denied = 0;
  for (int station = 0; station < 40; ++station) {
    const Vec3 u = plumb_test::direction_at(1.0 + 0.1 * station, 31.0 * station);
    std::array<double, kCapacity> steady{}, fault{};
    for (int i = 0; i < n; ++i) steady[static_cast<std::size_t>(i)] = 3.6e-3 * dot(c.array.axis(i), along);
    fault[5] = 0.02 * kG0_mps2;
    const BlockEvidence block = c.block(u, steady);
    const SetTest t = test_set(c.array, kGravity, c.limits, block, c.array.all());
    const SetTest without = test_set(c.array, kGravity, c.limits, block, c.array.all().without(5));
    const bool alone = std::fabs(t.norm) > t.norm_reject_limit(c.limits) &&
                       std::fabs(without.norm) < without.norm_reject_limit(c.limits);
    shown_by_all_only += alone && t.parity_consistent(c.limits) ? 1 : 0;
    c.isolation.clear();
    EXPECT_TRUE(c.isolation.vote({c.array, kGravity, c.limits, block}).strict.empty()) << station;
    c.isolation.clear();
    denied += c.isolation.vote({c.array, kGravity, c.limits, c.block(u, fault)}).strict == SensorSet::of(5) ? 1 : 0;
  }
  EXPECT_GT(shown_by_all_only, 10);
  EXPECT_GT(denied, 30);
}

/// In its plain form the rule of docs/theory.md, section 5.3, lets any set of >= 4 that passes parity void the norm.
/// Counter-example: four of mikoff5's z axes with three coplanar pass parity whatever the fourth reads;
/// taken literally, its fault would void the norm for ever. Only sets whose members are all checked may.
// Negative: REQ-061
TEST(Isolation, ASetWithAnUncheckedMemberDoesNotVoidTheNorm) {
  AxisList axes{};
  const Vec3 raw[5] = {
      {.004, -.863, .506}, {-.860, .011, .510}, {.013, .876, .483}, {.876, .006, .483}, {.002, .001, 1.0}};
  for (std::size_t i = 0; i < 5; ++i) axes[i] = scaled(raw[i], 1.0 / norm(raw[i]));
  Case c(plumb_test::make_array(axes, 5, kSigma), 19);
  EXPECT_EQ(c.isolation.coplanarity(), 3);
  EXPECT_EQ(c.isolation.confirmed_grade(), 1);
  std::array<double, kCapacity> fault{};
  fault[1] = 0.1;
  const Vec3 u = plumb_test::direction_at(50, 290);
  const SetTest unchecked = test_set(c.array, kGravity, c.limits, c.block(u, fault), SensorSet(0b10111));
  ASSERT_TRUE(unchecked.parity_consistent(c.limits)) << "0, 2 and 4 are coplanar: nobody checks 1";
  ASSERT_GT(std::fabs(unchecked.norm), unchecked.norm_reject_limit(c.limits)) << "and yet the norm is off";
  SensorSet excluded;
  for (int station = 0; station < 6; ++station) {
    const auto answer =
        c.isolation.vote({c.array, kGravity, c.limits, c.block(plumb_test::random_direction(c.noise), fault)});
    EXPECT_FALSE(answer.norm_void);
    excluded = answer.strict;
  }
  EXPECT_EQ(excluded, SensorSet::of(1));
}

/// T5: with at most m_strict faulty sensors, whatever they read, no healthy one is excluded, at any
/// station of the episode; gravity error within three sigmas included.
// Verifies: REQ-070, REQ-074
RC_GTEST_PROP(IsolationLaw, NeverIsolatesASensorHealthyThroughout, ()) {
  const int n = *rc::gen::inRange(4, kCapacity + 1);
  const bool axial = *rc::gen::arbitrary<bool>();
  AxisList axes{};
  const int made = axial ? cone_with_axis(axes, n) : cone(axes, n);
  Case c(plumb_test::make_array(axes, made, kSigma), *rc::gen::arbitrary<std::uint64_t>());
  const int m = *rc::gen::inRange(1, c.isolation.confirmed_grade() + 1);
  SensorSet faulty;
  while (faulty.size() < m) faulty = faulty.with(static_cast<int>(c.noise.uniform() * n));
  const int kind = *rc::gen::inRange(0, 4);
  const double gravity_off = (2.0 * c.noise.uniform() - 1.0) * 3.0 * kGravity.sigma_mps2;
  const Vec3 ghost = plumb_test::random_direction(c.noise);
  for (int station = 0; station < 8; ++station) {
    const Vec3 u = scaled(plumb_test::random_direction(c.noise), 1.0 + gravity_off / kG0_mps2);
    std::array<double, kCapacity> fault{};
    for (int i = 0; i < n; ++i) {
      if (!faulty.has(i)) continue;
      const double truth = dot(c.array.axis(i), u) * kG0_mps2;
      double f = 0.0;
      if (kind == 0) f = 20.0 * (c.noise.uniform() - 0.5);                // random
      if (kind == 1) f = -truth;                                          // stuck at zero
      if (kind == 2) f = dot(c.array.axis(i), ghost) * kG0_mps2 - truth;  // colluding on a false gravity
      if (kind == 3) f = 0.02 + 0.3 * c.noise.uniform();                  // small bias
      fault[static_cast<std::size_t>(i)] = f;
    }
    const auto answer = c.isolation.vote({c.array, kGravity, c.limits, c.block(u, fault)});
    RC_ASSERT(faulty.contains(answer.strict));
    // The provisional grade is lower: it promises nothing beyond its own m.
    if (m <= c.isolation.provisional_grade()) RC_ASSERT(faulty.contains(answer.parity));
  }
}

// Verifies: REQ-075
TEST(Isolation, LosingAChannelProjectsTheHypotheses) {
  Case c(plumb_test::cone_array(6, kSigma), 23);
  std::array<double, kCapacity> fault{};
  fault[0] = 2.0;
  c.isolation.vote({c.array, kGravity, c.limits, c.block(plumb_test::random_direction(c.noise), fault)});
  const int live = c.isolation.live();
  EXPECT_LT(live, 20);
  c.isolation.pose(c.array, c.array.all().without(5));
  EXPECT_LT(c.isolation.live(), 10) << "what died stays rejected among those that are left";
  c.isolation.pose(c.array, c.array.all());
  EXPECT_EQ(c.isolation.live(), 20) << "a sensor that joins poses a new question";
}

// Verifies: REQ-070
// Negative: REQ-121
TEST(Isolation, ScanFindsTheMinimumFaultCount) {
  Case c(plumb_test::cone_array(6, kSigma), 29);
  std::array<double, kCapacity> fault{};
  fault[2] = 1.0;
  const BlockEvidence block = c.block(plumb_test::direction_at(70, 10), fault);
  c.isolation.vote({c.array, kGravity, c.limits, block});
  const FaultSetScan scan = c.isolation.scan({c.array, kGravity, c.limits, block}, c.array.all(), 3, 1, {1, 4.9});
  EXPECT_EQ(scan.least, 1);
  EXPECT_EQ(scan.suspects, SensorSet::of(2));
  EXPECT_EQ(scan.asserted, SensorSet::of(2));
  EXPECT_GT(scan.minimum_faults[2], 1);
  for (int i : {0, 1, 3, 4, 5}) EXPECT_EQ(scan.minimum_faults[static_cast<std::size_t>(i)], 1);
  ASSERT_TRUE(scan.protection_available);
  // The level covers the true tilt error of the estimate that still holds the faulty sensor.
  const SetTest used = test_set(c.array, kGravity, c.limits, block, c.array.all());
  EXPECT_GE(scan.protection_rad, angle_between_rad(used.x_mps2, plumb_test::direction_at(70, 10)));
}

/// Another array is another question: what died under the first is not held against it.
// Negative: REQ-075
TEST(Isolation, OnAnotherArrayItStartsAnew) {
  const GravityReference gravity{kG0_mps2, 1e-3, GravityModel::value};
  const SensorArray four = plumb_test::tetrahedron(kSigma), five = plumb_test::cone_array(5, kSigma);
  Isolation isolation;
  isolation.pose(four, four.all());
  BlockEvidence block;
  block.usable = four.all();
  block.samples = 32.0;
  for (int i = 0; i < 4; ++i) block.mean_mps2[static_cast<std::size_t>(i)] = four.axis(i)[2] * kG0_mps2;
  block.mean_mps2[1] += 1.0;
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  isolation.vote({four, gravity, limits, block}, four.all());
  EXPECT_LT(isolation.live(), isolation.voting());
  isolation.pose(five, four.all());
  EXPECT_EQ(isolation.live(), isolation.voting());
}

}  // namespace
}  // namespace isolation_test
