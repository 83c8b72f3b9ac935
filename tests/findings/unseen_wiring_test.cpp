// Wirings that gravity cannot see, for the axes of the datasheet, and what a station of known attitude says of them.
#include "plumb/findings/unseen_wiring.hpp"

#include <gtest/gtest.h>

#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/render/wiring_words.hpp"
#include "support/simulated_tool.hpp"

namespace unseen_wiring_test {
namespace {

using namespace plumb;
using findings::WiringStatus;

constexpr double kExact_rad = 1e-4;

SensorArray array_of(const AxisList& axes, int n) {
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<std::size_t>(i);
    rows[a].id = make_id(("a" + std::to_string(i + 1)).c_str());
    rows[a].axis = axes[a];
    rows[a].sigma_mps2 = 1e-3;
  }
  return *SensorArray::make(rows.data(), n);
}

/// How far apart two turns take one of the unit vectors.
double apart_rad(const Mat3& a, const Mat3& b) {
  double out = 0.0;
  for (const Vec3& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    out = std::fmax(out, angle_between_rad(times(a, e), times(b, e)));
  return out;
}

/// Of sensors with exactly these axes.
std::vector<findings::UnseenWiring> unseen_of(const SensorArray& array, double tolerance_rad) {
  return findings::unseen_wirings(array, array, tolerance_rad);
}

io::ArrayFile paper_tool() { return *io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml"); }

/// What a tool shows that is wired like this and stands as stated.
findings::MeasuredAttitude shown(const Mat3& turn, const std::string& text, const io::ArrayFile& array) {
  const io::KnownAttitude stated = *io::parse_known_attitude(text);
  return {stated, times(turn, down_of(stated, array.output_frame))};
}

std::string text_of(const findings::SeparatingAttitude& take) {
  return "1:" + std::to_string(take.inclination_deg) + "," + std::to_string(take.toolface_deg);
}

/// The 48 symmetries of four axes to the corners of a tetrahedron and their opposites, and of three at right angles,
/// but for the identity; the ten-fold ones of a cone of five, and all of it reversed.
TEST(UnseenWiring, AreTheSymmetriesOfTheAxes) {
  AxisList axes{};
  int n = paper_tetrahedron(axes);
  EXPECT_EQ(unseen_of(array_of(axes, n), kExact_rad).size(), 47U);
  n = orthogonal_triad(axes);
  EXPECT_EQ(unseen_of(array_of(axes, n), kExact_rad).size(), 47U);
  n = cone(axes, 5);
  EXPECT_EQ(unseen_of(array_of(axes, n), kExact_rad).size(), 19U);
}

TEST(UnseenWiring, OfAxesInGeneralPositionIsTheSignConventionAlone) {
  const AxisList axes = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.6, 0.0, 0.8}, {0.0, 0.28, 0.96}}};
  const SensorArray array = array_of(axes, 4);
  const std::vector<findings::UnseenWiring> found = unseen_of(array, kExact_rad);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(render::wiring_words(found[0].wiring, array), "all sensors reversed");
}

TEST(UnseenWiring, OfParallelAxesAreCountedByWhatTheyDoToTheVector) {
  AxisList axes{};
  int n = orthogonal_triad(axes);
  for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(n + i)] = axes[static_cast<std::size_t>(i)];
  EXPECT_EQ(unseen_of(array_of(axes, n + 3), kExact_rad).size(), 47U);
}

/// What the fit would take for errors of mounting is unseen too.
TEST(UnseenWiring, WithinThePriorOfTheAxesAreUnseenAsWell) {
  AxisList axes{};
  const int n = paper_tetrahedron(axes);
  axes[0] = {std::sin(rad_from_deg(72.5)), 0.0, std::cos(rad_from_deg(72.5))};  // 2 deg off the cone
  const SensorArray array = array_of(axes, n);
  EXPECT_LT(unseen_of(array, kExact_rad).size(), 10U);
  EXPECT_EQ(unseen_of(array, rad_from_deg(6.0)).size(), 47U);
}

/// Cones whose a2 is turned out of its place: an exchange with a3 is unseen as long as a fit accepts the axes that it
/// comes out with, 15 deg from their nominal ones at most, each of the two half of the turn.
TEST(UnseenWiring, WhatAFitAcceptsIsUnseen) {
  const auto listed = [](double degrees) {
    AxisList axes{};
    const int n = paper_tetrahedron(axes);
    const double azimuth = rad_from_deg(120.0 + degrees), across = std::sqrt(8.0) / 3.0;
    axes[1] = {across * std::cos(azimuth), across * std::sin(azimuth), 1.0 / 3.0};
    const SensorArray array = array_of(axes, n);
    for (const findings::UnseenWiring& one : unseen_of(array, findings::kUnseenAxis_rad)) {
      if (render::wiring_words(one.wiring, array) == "a2 and a3 exchanged") return true;
    }
    return false;
  };
  EXPECT_TRUE(listed(0.0));
  EXPECT_TRUE(listed(12.0));
  EXPECT_TRUE(listed(26.0));
  EXPECT_FALSE(listed(34.0));
}

/// Twelve on a cone: twelve turns, twelve mirrors, and each of them reversed. The neighbours are nearer than the width
/// in which a sensor is sought.
TEST(UnseenWiring, OfManyNeighboursNoneIsLostWithinThePrior) {
  AxisList axes{};
  const int n = cone(axes, 12);
  const SensorArray array = array_of(axes, n);
  EXPECT_EQ(unseen_of(array, kExact_rad).size(), 47U);
  EXPECT_EQ(unseen_of(array, rad_from_deg(6.0)).size(), 47U);
}

TEST(UnseenWiring, EachLeavesNoResidualInAnyRecording) {
  const io::ArrayFile array = paper_tool();
  for (const findings::UnseenWiring& one : unseen_of(array.array, kExact_rad)) {
    const WiringEffect effect = wiring_effect(array.array, one.wiring);
    EXPECT_LT(effect.parity, 1e-9) << render::wiring_words(one.wiring, array.array);
    EXPECT_LT(effect.length, 1e-9);
    EXPECT_GT(effect.turn_rad, 0.5);
  }
}

/// Sensors mounted up to some degrees off the datasheet, wired at random: a calibration that accepts the axes that this
/// shows lists the wiring, though of exact axes it would be seen.
// Verifies: REQ-183
// Negative: REQ-183
TEST(UnseenWiring, WhateverAFitOfSensorsOffTheDatasheetAcceptsIsListed) {
  plumb_test::Noise noise(11);
  int accepted = 0, beyond = 0;
  for (int k = 0; k < 4000; ++k) {
    io::ArrayFile array = paper_tool();
    AxisList axes{}, bent{};
    const int n = 4 + k % 3;
    cone(axes, n);
    const auto turned = [&noise](const Vec3& axis, double most_deg) {
      const Vec3 moved = plus(axis, scaled(plumb_test::random_direction(noise), rad_from_deg(most_deg)));
      return scaled(moved, 1.0 / norm(moved));
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      axes[i] = turned(axes[i], 20.0);
      bent[i] = turned(axes[i], 6.0);
    }
    array.array = array_of(axes, n);
    const SensorArray mounted = array_of(bent, n);
    Wiring wiring = Wiring::correct();
    for (int i = n - 1; i > 0; --i)
      std::swap(wiring.source[static_cast<std::size_t>(i)],
                wiring.source[static_cast<std::size_t>(noise.uniform() * (i + 1))]);
    // What the fit comes out with: the axes behind the channels, turned as near to the datasheet's as they go.
    const auto turn = findings::unseen_turn(mounted, array.array, wiring, kPi);
    if (!turn || apart_rad(*turn, io::kIdentity3) < rad_from_deg(12.0)) continue;
    bool fits = true;
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<std::size_t>(i);
      bent[a] = times(*turn, mounted.axis(wiring.source[a]));
      fits = fits && angle_between_rad(bent[a], axes[a]) <= findings::kUnseenAxis_rad;
    }
    if (!fits) continue;
    ++accepted;
    const SensorArray fitted = array_of(bent, n);
    const auto lists = [&](const findings::WiringCheck& check) {
      return std::any_of(check.unseen.begin(), check.unseen.end(), [&turn](const findings::UnseenWiring& one) {
        return apart_rad(one.turn, *turn) < rad_from_deg(12.0);
      });
    };
    EXPECT_TRUE(lists(findings::check_wiring(array, &fitted, {}))) << k;
    beyond += lists(findings::check_wiring(array, nullptr, {})) ? 0 : 1;
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(beyond, 5) << "what the datasheet axes alone do not tell does happen";
}

// Verifies: REQ-183
TEST(UnseenWiring, OneStationInGeneralPositionConfirmsTheTetrahedron) {
  const io::ArrayFile array = paper_tool();
  const findings::WiringCheck open = findings::check_wiring(array, nullptr, {});
  EXPECT_EQ(open.status, WiringStatus::open);
  EXPECT_EQ(open.left.size(), 47U);
  EXPECT_GT(open.take.separation_deg, 15.0);
  const std::string take = text_of(open.take);
  EXPECT_EQ(findings::check_wiring(array, nullptr, {shown(io::kIdentity3, take, array)}).status,
            WiringStatus::confirmed);
  // Every tool that is wired otherwise is caught by the same station, and by no other mistake than its own.
  for (const findings::UnseenWiring& one : open.unseen) {
    const findings::WiringCheck check = findings::check_wiring(array, nullptr, {shown(one.turn, take, array)});
    EXPECT_EQ(check.status, WiringStatus::contradicted) << render::wiring_words(one.wiring, array.array);
    ASSERT_EQ(check.left.size(), 1U);
    EXPECT_EQ(render::wiring_words(open.unseen[check.left[0]].wiring, array.array),
              render::wiring_words(one.wiring, array.array));
  }
}

// Negative: REQ-183
TEST(UnseenWiring, AStationOnAMirrorPlaneLeavesItOpenAndAnotherIsNamed) {
  const io::ArrayFile array = paper_tool();
  // Toolface 90 deg lies in the plane that a2 and a3 mirror.
  const findings::WiringCheck check = findings::check_wiring(array, nullptr, {shown(io::kIdentity3, "3:40,90", array)});
  EXPECT_EQ(check.status, WiringStatus::open);
  ASSERT_EQ(check.left.size(), 1U);
  EXPECT_EQ(render::wiring_words(check.unseen[check.left[0]].wiring, array.array), "a2 and a3 exchanged");
  EXPECT_GT(check.take.separation_deg, 90.0);
  const std::string text = render::wiring_text(check, array);
  EXPECT_NE(text.find("not excluded by station 3"), std::string::npos) << text;
  EXPECT_NE(text.find("--known-attitude STATION:"), std::string::npos) << text;
  // Both together do.
  const findings::WiringCheck both = findings::check_wiring(
      array, nullptr, {shown(io::kIdentity3, "3:40,90", array), shown(io::kIdentity3, text_of(check.take), array)});
  EXPECT_EQ(both.status, WiringStatus::confirmed);
}

TEST(UnseenWiring, AVerticalToolShowsTheSignAndNotTheMirror) {
  const io::ArrayFile array = paper_tool();
  const findings::WiringCheck check = findings::check_wiring(array, nullptr, {shown(io::kIdentity3, "1:0,0", array)});
  EXPECT_EQ(check.status, WiringStatus::open);
  EXPECT_EQ(check.left.size(), 5U);  // the turns and mirrors of the cone about its axis
}

TEST(UnseenWiring, TheToleranceDecides) {
  const io::ArrayFile array = paper_tool();
  const auto status = [&array](const char* stated, const char* stands) {
    findings::MeasuredAttitude one = shown(io::kIdentity3, stands, array);
    one.stated = *io::parse_known_attitude(stated);
    return findings::check_wiring(array, nullptr, {one}).status;
  };
  EXPECT_EQ(status("1:30,20", "1:34.9,20"), WiringStatus::confirmed);
  EXPECT_EQ(status("1:30,20", "1:35.1,20"), WiringStatus::contradicted);
  EXPECT_EQ(status("1:30,20,5.2", "1:35.1,20"), WiringStatus::confirmed);
  EXPECT_EQ(status("1:30,20,45", "1:30,20"), WiringStatus::open);
}

TEST(KnownAttitude, IsReadAndRefusedWithItsForm) {
  const io::KnownAttitude one = *io::parse_known_attitude("7:60,-40,2.5");
  EXPECT_EQ(one.station, 7);
  EXPECT_DOUBLE_EQ(deg_from_rad(one.inclination_rad), 60.0);
  EXPECT_DOUBLE_EQ(deg_from_rad(one.toolface_rad), 320.0);
  EXPECT_DOUBLE_EQ(deg_from_rad(one.tolerance_rad), 2.5);
  EXPECT_DOUBLE_EQ(deg_from_rad(io::parse_known_attitude("1:0,0")->tolerance_rad), 5.0);
  for (const char* wrong : {"", "7", "7:60", "7:60,", "0:60,40", "-1:60,40", "7:181,0", "7:nan,0", "7:60,400",
                            "7:60,40,0", "7:60,40,46", "7:60,40,2,1", "7:60,40 ", "a:60,40", "7;60,40"}) {
    const auto read = io::parse_known_attitude(wrong);
    ASSERT_FALSE(read) << wrong;
    EXPECT_NE(read.error().find("STATION:INCLINATION,TOOLFACE"), std::string::npos) << read.error();
  }
}

}  // namespace
}  // namespace unseen_wiring_test
