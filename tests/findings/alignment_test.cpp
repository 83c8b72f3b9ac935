#include "plumb/findings/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "plumb/core/units.hpp"
#include "plumb/findings/frame_turn.hpp"
#include "plumb/io/array_file.hpp"

namespace alignment_test {
namespace {

using namespace plumb;
using findings::Alignment;
using findings::AlignmentSource;
using findings::MeasuredAttitude;

io::ArrayFile paper_tool() { return *io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml"); }

/// Rows of the rotation by `angle` about `axis`.
Mat3 rotation(const Vec3& axis, double angle) {
  const Vec3 u = scaled(axis, 1.0 / norm(axis));
  const double s = std::sin(angle), c = std::cos(angle);
  Mat3 out = {c, -s * u[2], s * u[1], s * u[2], c, -s * u[0], -s * u[1], s * u[0], c};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) out[3 * r + k] += (1.0 - c) * u[r] * u[k];
  }
  return out;
}

/// A calibration whose axes are those of the datasheet, turned.
Calibration turned_by(const io::ArrayFile& array, const Mat3& turn) {
  Calibration out;
  out.array = array.array;
  findings::apply_turn(turn, out);
  return out;
}

MeasuredAttitude at_station(int number, double inclination_deg, double toolface_deg, double tolerance_deg,
                            const io::ArrayFile& array, const Mat3& shown_turned) {
  MeasuredAttitude out;
  out.stated = {number, rad_from_deg(inclination_deg), rad_from_deg(toolface_deg), rad_from_deg(tolerance_deg)};
  out.down = times(shown_turned, io::down_of(out.stated, array.output_frame));
  return out;
}

// Verifies: REQ-042
TEST(Alignment, TheAxesOfTheDatasheetBoundItByTheirPriors) {
  io::ArrayFile array = paper_tool();
  const Alignment two_deg = findings::alignment_of(array, nullptr);
  EXPECT_EQ(two_deg.source, AlignmentSource::datasheet);
  // Four axes of 2 deg each hold a turn to some 1.2 deg, and 5.5 of those hold but for 1e-6.
  EXPECT_NEAR(deg_from_rad(two_deg.bound_rad), 6.8, 0.1);
  for (DatasheetSensor& sensor : array.datasheet.sensor) sensor.prior.axis_rad *= 0.1;
  EXPECT_NEAR(findings::alignment_of(array, nullptr).bound_rad, 0.1 * two_deg.bound_rad, 0.002 * two_deg.bound_rad);
  array.monitor.integrity_risk = 1e-3;
  EXPECT_LT(findings::alignment_of(array, nullptr).bound_rad, 0.08 * two_deg.bound_rad);
}

TEST(Alignment, WhatTheArrayFileStatesCounts) {
  io::ArrayFile array = paper_tool();
  array.monitor.alignment_bound_rad = 0.25F;
  const Alignment stated = findings::alignment_of(array, nullptr);
  EXPECT_EQ(stated.source, AlignmentSource::stated);
  EXPECT_EQ(stated.bound_rad, 0.25);
}

// Verifies: REQ-042
TEST(Alignment, RollGroupsKnowTheAxisAndNotTheTurnAboutIt) {
  const io::ArrayFile array = paper_tool();
  Calibration fit = turned_by(array, io::kIdentity3);
  fit.report.roll_axis = {0, 0, 1};
  fit.report.inclination_sigma_rad = rad_from_deg(0.01);
  const Alignment rolled = findings::alignment_of(array, &fit, {});
  EXPECT_EQ(rolled.source, AlignmentSource::roll_groups);
  // Three axes 70.5 deg from the roll axis hold the turn about it to 1.22 deg.
  EXPECT_NEAR(deg_from_rad(rolled.bound_rad), 6.8, 0.2);
  const findings::TurnInformation known = findings::information_of(array.datasheet, &fit.report);
  EXPECT_NEAR(std::sqrt(1.0 / known[0]), rad_from_deg(0.01), 1e-9);
}

// Verifies: REQ-042
// Negative: REQ-042
TEST(Alignment, StationsOfKnownAttitudeBoundItByTheirTolerances) {
  const io::ArrayFile array = paper_tool();
  const Calibration fit = turned_by(array, io::kIdentity3);
  const auto bound_deg = [&](std::vector<MeasuredAttitude> measured) {
    const Alignment found = findings::alignment_of(array, &fit, measured);
    return deg_from_rad(found.bound_rad);
  };
  const MeasuredAttitude upright = at_station(1, 0, 0, 0.2, array, io::kIdentity3),
                         lying = at_station(2, 90, 0, 0.2, array, io::kIdentity3);
  EXPECT_NEAR(bound_deg({upright, lying}), 0.2 * std::sqrt(2.0), 1e-3);
  EXPECT_GT(bound_deg({upright}), 5.0) << "nothing is known about a turn about that station's vertical";
  EXPECT_GT(bound_deg({upright, at_station(2, 5, 0, 0.2, array, io::kIdentity3)}), 2.0) << "nearly the same attitude";
  const Mat3 off = rotation({0, 1, 0}, rad_from_deg(1.0));
  EXPECT_GT(bound_deg({at_station(1, 0, 0, 0.2, array, off), at_station(2, 90, 0, 0.2, array, off)}), 1.0)
      << "what the stations show the axes to be off by is part of the bound";
}

// Verifies: REQ-042
TEST(Alignment, NoTurnWithinTheTolerancesIsBeyondTheBound) {
  const io::ArrayFile array = paper_tool();
  std::mt19937 random(71);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  int near = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 axis = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double turn_rad = rad_from_deg(uniform(0.0, 3.0));
    const Mat3 turn = rotation(axis, turn_rad);
    std::vector<MeasuredAttitude> measured;
    const int stations = 1 + k % 4;
    for (int s = 0; s < stations; ++s) {
      MeasuredAttitude one = at_station(s + 1, uniform(0, 180), uniform(0, 360), 0.01, array, turn);
      // The attitude is stated as it is but for an error of its tolerance, in whatever direction.
      one.stated.tolerance_rad = rad_from_deg(uniform(0.01, 1.0));
      one.down = times(
          rotation({uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}, one.stated.tolerance_rad * uniform(0.0, 1.0)),
          one.down);
      measured.push_back(one);
    }
    Calibration fit = turned_by(array, io::kIdentity3);
    const Alignment found = findings::alignment_of(array, &fit, measured);
    EXPECT_GE(found.bound_rad, turn_rad * (1.0 - 1e-6)) << "seed 71, case " << k;
    if (found.bound_rad < 1.5 * turn_rad) ++near;
  }
  EXPECT_GT(near, 50) << "no bound that says nothing";
}

// Verifies: REQ-042
TEST(FrameTurn, KnownAttitudesTurnTheAxesIntoTheHousing) {
  const io::ArrayFile array = paper_tool();
  const Mat3 off = rotation({1, 2, -1.5}, rad_from_deg(2.0));  // from the housing to the axes as they were fitted
  Calibration fit = turned_by(array, off);
  const std::vector<MeasuredAttitude> measured = {at_station(1, 30, 40, 0.1, array, off),
                                                  at_station(2, 100, 200, 0.1, array, off)};
  const Mat3 turn = findings::turn_into_housing(array, fit.report, measured);
  for (const MeasuredAttitude& m : measured) {
    const double left_rad = angle_between_rad(times(turn, m.down), io::down_of(m.stated, array.output_frame));
    EXPECT_LT(left_rad, rad_from_deg(0.02));
  }
  findings::apply_turn(turn, fit);
  for (int i = 0; i < array.array.size(); ++i)
    EXPECT_LT(angle_between_rad(fit.array.axis(i), array.array.axis(i)), rad_from_deg(0.02)) << i;
}

// Negative: REQ-042
TEST(FrameTurn, ATurnThatTheAxesExcludeIsNotMade) {
  const io::ArrayFile array = paper_tool();
  const Mat3 off = rotation({0, 1, 0}, rad_from_deg(12.0));
  const std::vector<MeasuredAttitude> measured = {at_station(1, 30, 40, 0.1, array, off),
                                                  at_station(2, 100, 200, 0.1, array, off)};
  EXPECT_EQ(findings::turn_into_housing(array, FitReport{}, measured), io::kIdentity3);
  EXPECT_EQ(findings::turn_into_housing(array, FitReport{}, {}), io::kIdentity3);
}

TEST(FrameTurn, ACovarianceTurnsWithItsAxes) {
  const io::ArrayFile array = paper_tool();
  const Mat3 turn = rotation({0.3, -1, 2}, 0.1);
  Calibration fit = turned_by(array, io::kIdentity3);
  RowUncertainty u;
  std::mt19937 random(5);
  for (int a = 0; a < 16; ++a) {
    for (int b = 0; b <= a; ++b)
      u.covariance[static_cast<std::size_t>(a * (a + 1) / 2 + b)] =
          (a == b ? 2.0 : 0.0) + 0.1 * static_cast<double>(random()) / 4294967296.0;
  }
  fit.array.set_uncertainty(u);
  const SensorArray before = fit.array;
  findings::apply_turn(turn, fit);
  const Vec3 g = {3.0, -5.0, 7.0}, turned = times(turn, g);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(dot(before.axis(i), g), dot(fit.array.axis(i), turned), 1e-12);
    for (int j = 0; j < 4; ++j)
      EXPECT_NEAR(before.uncertainty().at(i, j, g), fit.array.uncertainty().at(i, j, turned), 1e-9) << i << j;
  }
}

}  // namespace
}  // namespace alignment_test
