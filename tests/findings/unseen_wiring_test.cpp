// Wirings that gravity cannot see, for the axes of the datasheet, and what a station of known attitude says of them.
#include "plumb/findings/unseen_wiring.hpp"

#include <gtest/gtest.h>

#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/render/wiring_words.hpp"
#include "support/rewired_tool.hpp"

namespace unseen_wiring_test {
namespace {

using namespace plumb;
using findings::WiringStatus;
using plumb_test::array_of_axes;
using plumb_test::Noise;

constexpr double kExact_rad = 1e-4;

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
  EXPECT_EQ(unseen_of(array_of_axes(axes, n), kExact_rad).size(), 47U);
  n = orthogonal_triad(axes);
  EXPECT_EQ(unseen_of(array_of_axes(axes, n), kExact_rad).size(), 47U);
  n = cone(axes, 5);
  EXPECT_EQ(unseen_of(array_of_axes(axes, n), kExact_rad).size(), 19U);
}

TEST(UnseenWiring, OfAxesInGeneralPositionIsTheSignConventionAlone) {
  const AxisList axes = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.6, 0.0, 0.8}, {0.0, 0.28, 0.96}}};
  const SensorArray array = array_of_axes(axes, 4);
  const std::vector<findings::UnseenWiring> found = unseen_of(array, kExact_rad);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(render::wiring_words(found[0].wiring, array), "all sensors reversed");
}

TEST(UnseenWiring, OfParallelAxesAreCountedByWhatTheyDoToTheVector) {
  AxisList axes{};
  int n = orthogonal_triad(axes);
  for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(n + i)] = axes[static_cast<std::size_t>(i)];
  EXPECT_EQ(unseen_of(array_of_axes(axes, n + 3), kExact_rad).size(), 47U);
}

/// What the fit would take for errors of mounting is unseen too.
TEST(UnseenWiring, WithinThePriorOfTheAxesAreUnseenAsWell) {
  AxisList axes{};
  const int n = paper_tetrahedron(axes);
  axes[0] = {std::sin(rad_from_deg(72.5)), 0.0, std::cos(rad_from_deg(72.5))};  // 2 deg off the cone
  const SensorArray array = array_of_axes(axes, n);
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
    const SensorArray array = array_of_axes(axes, n);
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
  const SensorArray array = array_of_axes(axes, n);
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

/// A calibration that accepts the axes of sensors that are wired otherwise and mounted up to 5 deg off lists the
/// wiring, though of exact axes it would be seen.
// Verifies: REQ-183
TEST(UnseenWiring, WhateverAFitOfSensorsOffTheDatasheetAcceptsIsListed) {
  Noise noise(11);
  int accepted = 0, beyond = 0;
  for (int k = 0; k < 4000; ++k) {
    const auto tool = plumb_test::draw_rewired(4 + k % 3, noise);
    if (!tool) continue;
    ++accepted;
    EXPECT_TRUE(tool->is_listed(findings::unseen_wirings(tool->nominal, tool->fitted, findings::kUnseenAxis_rad))) << k;
    beyond += tool->is_listed(unseen_of(tool->nominal, findings::kUnseenAxis_rad)) ? 0 : 1;
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(beyond, 5) << "what the datasheet axes alone do not tell does happen";
}

/// Where gravity points and what such a tool shows stand within any tolerance of one another, its wiring still explains
/// the station: half of the stations lie where the turn leaves the vector.
// Negative: REQ-183
TEST(UnseenWiring, NoStationConfirmsAToolThatIsWiredOtherwise) {
  Noise noise(12);
  io::ArrayFile array = paper_tool();
  int open = 0;
  for (int k = 0; k < 3000; ++k) {
    const auto tool = plumb_test::draw_rewired(4 + k % 3, noise);
    if (!tool) continue;
    array.array = tool->nominal;
    for (int station = 0; station < 8; ++station) {
      Vec3 down = plumb_test::random_direction(noise);
      for (int power = 0; station % 2 == 0 && power < 12; ++power) down = plus(down, times(tool->turn, down));
      if (!(norm(down) > 0.1)) continue;
      io::KnownAttitude stated;
      stated.inclination_rad = std::atan2(std::hypot(down[0], down[1]), down[2]);
      stated.toolface_rad = std::atan2(-down[0], -down[1]);
      stated.tolerance_rad = rad_from_deg(std::pow(10.0, -1.0 + 2.0 * noise.uniform()));
      const Vec3 shows = times(tool->turn, down_of(stated, array.output_frame));
      const WiringStatus status = findings::check_wiring(array, &tool->fitted, {{stated, shows}}).status;
      EXPECT_NE(status, WiringStatus::confirmed) << k << ", tolerance " << deg_from_rad(stated.tolerance_rad);
      open += status == WiringStatus::open ? 1 : 0;
    }
  }
  EXPECT_GT(open, 100) << "stations at which both wirings stand as stated do happen";
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
