#include "plumb/scenario/heading.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plumb/scenario/scenario.hpp"

namespace heading_test {
namespace {

using namespace plumb;
using namespace plumb::scenario;

double azimuth_of(const Vec3& north, const Vec3& down) {
  const Vec3 east = cross(down, north);
  return std::atan2(east[2], north[2]);  // of the z axis of the tool
}

TEST(Heading, NorthIsLevelAndTellsTheAzimuthOfTheTool) {
  for (const double inclination : {0.2, 1.1, 2.9}) {
    for (const double azimuth : {-2.5, -0.3, 0.0, 1.2, 3.0}) {
      for (const double toolface : {0.0, 0.7, 4.0}) {
        const Attitude attitude{inclination, azimuth, toolface};
        const Vec3 down = gravity_direction(attitude), north = north_direction(attitude);
        EXPECT_NEAR(norm(north), 1.0, 1e-12);
        EXPECT_NEAR(dot(north, down), 0.0, 1e-12);
        EXPECT_NEAR(azimuth_of(north, down), azimuth, 1e-12);
      }
    }
  }
}

std::vector<AttitudeLaw> laws() {
  DrillingPath path;
  path.stations = 6;
  path.turn_rad = 0.4;
  DirectionList list;
  list.directions = {{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 0.6, 0.8}, {0.0, 0.6, 0.8}};
  return {path, list, RandomStations{6}, RollTest{1.0, 6, 0.3}, FixedAttitude{}};
}

TEST(Heading, NorthStaysLevelOnTheWayAndArrives) {
  for (const AttitudeLaw& law : laws()) {
    const std::vector<Vec3> down = *directions_of(law, 7);
    const Headings headings(law, down, 7);
    for (std::size_t k = 0; k + 1 < down.size(); ++k) {
      const Passage passage(down[k], down[k + 1]);
      for (const double part : {0.0, 0.1, 0.5, 0.999}) {
        EXPECT_NEAR(norm(headings.north(k, part)), 1.0, 1e-9);
        EXPECT_NEAR(dot(headings.north(k, part), passage.at(part)), 0.0, 1e-9) << law.index() << " " << part;
      }
      EXPECT_NEAR(norm(minus(headings.north(k, 1.0), headings.north(k + 1, 0.0))), 0.0, 1e-9) << law.index();
    }
  }
}

// The rate is the one that carries both vectors along: dv/dt = -w x v.
TEST(Heading, TheRateIsThatOfBothVectors) {
  constexpr double kMove_s = 2.0, kStep = 1e-5;
  for (const AttitudeLaw& law : laws()) {
    const std::vector<Vec3> down = *directions_of(law, 7);
    const Headings headings(law, down, 7);
    for (std::size_t k = 0; k + 1 < down.size(); ++k) {
      const Passage passage(down[k], down[k + 1]);
      for (const double part : {0.2, 0.5, 0.9}) {
        const Vec3 rate = headings.rate_radps(k, part, kMove_s);
        const auto check = [&](const Vec3& before, const Vec3& now, const Vec3& after) {
          const Vec3 slope = scaled(minus(after, before), 1.0 / (2.0 * kStep * kMove_s));
          EXPECT_NEAR(norm(plus(slope, cross(rate, now))), 0.0, 1e-6) << law.index() << " " << k << " " << part;
        };
        check(passage.at(part - kStep), passage.at(part), passage.at(part + kStep));
        check(headings.north(k, part - kStep), headings.north(k, part), headings.north(k, part + kStep));
      }
      EXPECT_EQ(norm(headings.rate_radps(k, 0.0, kMove_s)), 0.0);
    }
  }
}

Scenario field_of(const AttitudeLaw& law) {
  Datasheet sheet;
  sheet.size = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    sheet.sensor[i].row.axis[i] = 1.0;
    sheet.sensor[i].row.sigma_mps2 = 0.001;
    sheet.sensor[i].coefficients.scale[0] = 1.0;
  }
  Scenario out;
  out.tool = perfect_tool(sheet);
  out.attitudes = law;
  out.noise.white = 0.0;
  out.rate_hz = 50.0;
  out.turning.rate_radps = 0.3;
  out.turning.from_s = 4.0;
  out.turning.until_s = 6.0;
  return out;
}

// Verifies: REQ-253
// What holds at every row of the run, whatever the law: the field has its length and its dip, and integrating the
// gyros carries both vectors from row to row.
TEST(Heading, AllGroupsSenseOneMotion) {
  for (const AttitudeLaw& law : laws()) {
    Scenario gravity = field_of(law), magnetic = gravity, rates = gravity;
    magnetic.sensed = Sensed::magnetic;
    magnetic.gravity_mps2 = 12.8;
    magnetic.dip_rad = 1.2;
    rates.sensed = Sensed::rate;
    const Simulator g = *Simulator::make(gravity), b = *Simulator::make(magnetic), w = *Simulator::make(rates);
    ASSERT_EQ(g.size(), b.size());
    ASSERT_EQ(g.size(), w.size());
    Vec3 last_g{}, last_b{}, last_w{};
    for (std::uint64_t row = 0; row < g.size(); ++row) {
      Truth of_g, of_b, of_w;
      (void)g.at(row, &of_g);
      const Sample field = b.at(row, &of_b), turn = w.at(row, &of_w);
      EXPECT_NEAR(norm(of_b.gravity_mps2), 12.8, 1e-9);
      EXPECT_NEAR(dot(of_b.gravity_mps2, of_g.gravity_mps2) / (12.8 * gravity.gravity_mps2), std::sin(1.2), 1e-9);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(field.raw[k], of_b.gravity_mps2[k], 1e-12);
        EXPECT_NEAR(turn.raw[k], of_w.rate_radps[k], 1e-12);
      }
      const Vec3 mean = scaled(plus(last_w, of_w.rate_radps), 0.5 / gravity.rate_hz);
      const auto carried = [&mean](const Vec3& v) { return minus(v, cross(mean, v)); };
      if (row > 0) {
        const double turned = norm(mean);
        EXPECT_LT(norm(minus(of_g.gravity_mps2, carried(last_g))), 9.8 * (2.0 * turned * turned + 4e-3)) << row;
        EXPECT_LT(norm(minus(of_b.gravity_mps2, carried(last_b))), 12.8 * (2.0 * turned * turned + 4e-3)) << row;
      }
      last_g = of_g.gravity_mps2;
      last_b = of_b.gravity_mps2;
      last_w = of_w.rate_radps;
    }
  }
}

TEST(Heading, InterferenceTurnsWithTheToolOrStandsBesideIt) {
  for (const bool of_tool : {true, false}) {
    Scenario magnetic = field_of(RandomStations{4});
    magnetic.sensed = Sensed::magnetic;
    magnetic.dip_rad = 1.2;
    const Simulator clean = *Simulator::make(magnetic);
    magnetic.interference = {{0.1, -0.2, 0.3}, of_tool, 2.0, 8.0};
    const Simulator disturbed = *Simulator::make(magnetic);
    for (std::uint64_t row = 0; row < clean.size(); ++row) {
      Truth without, with;
      const double time_s = clean.at(row, &without).time_s;
      (void)disturbed.at(row, &with);
      const Vec3 added = minus(with.gravity_mps2, without.gravity_mps2);
      const bool there = time_s >= 2.0 && time_s < 8.0;
      EXPECT_NEAR(norm(added), there ? norm(Vec3{0.1, -0.2, 0.3}) : 0.0, 1e-12);
      if (there && of_tool) {
        EXPECT_NEAR(added[1], -0.2, 1e-12);
      }
      // Beside the tool it keeps its angle to the Earth's field.
      if (there && !of_tool) {
        EXPECT_NEAR(dot(added, without.gravity_mps2) / kG0_mps2, 0.1 * std::cos(1.2) + 0.3 * std::sin(1.2), 1e-9);
      }
    }
  }
}

// Negative: REQ-253
TEST(Heading, GroupsHaveNoiseOfTheirOwn) {
  Scenario one = field_of(FixedAttitude{});
  one.noise.white = 1.0;
  Scenario other = one;
  other.part = 99;
  const Simulator a = *Simulator::make(one), b = *Simulator::make(other);
  double product = 0.0, square = 0.0;
  for (std::uint64_t row = 0; row < a.size(); ++row) {
    const double x = a.at(row).raw[0], y = b.at(row).raw[0];
    product += x * y;
    square += x * x;
  }
  EXPECT_LT(std::fabs(product), 0.3 * square);
}

}  // namespace
}  // namespace heading_test
