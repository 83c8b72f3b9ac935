// What holds of an alignment at any attitudes.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "plumb/survey/joint_alignment.hpp"
#include "turned_tool.hpp"

namespace joint_alignment_laws_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;
using namespace turned_tool;

Truth any_attitude() {
  const auto part = [] { return *rc::gen::inRange(0, 100001) / 100000.0; };
  return {std::acos(1.0 - 2.0 * part()), 2.0 * kPi * part(), 2.0 * kPi * part()};
}

RC_GTEST_PROP(JointAlignmentLaw, EachStationGivesOneEquation, ()) {
  // d dip / d w = - e, e magnetic east in tool axes: by central differences.
  const Measurement m = station_of(any_attitude(), World{});
  const Vec3 c = cross(m.gravity_mps2, m.field_tesla), east = scaled(c, 1.0 / norm(c));
  constexpr double kStep = 1e-5;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 step{};
    step[k] = kStep;
    const double up = totals_of(m.gravity_mps2, times(rotation_of(step), m.field_tesla)).dip_rad;
    const double down = totals_of(m.gravity_mps2, times(transposed(rotation_of(step)), m.field_tesla)).dip_rad;
    RC_ASSERT(std::fabs((up - down) / (2.0 * kStep) + east[k]) < 1e-8);
  }
}

std::vector<Truth> some_attitudes(int least) {
  std::vector<Truth> out;
  const int stations = *rc::gen::inRange(least, 3 * least);
  for (int k = 0; k < stations; ++k) out.push_back(any_attitude());
  return out;
}

Vec3 any_turn(double most_deg) {
  const auto part = [&] { return *rc::gen::inRange(-1000, 1001) / 1000.0 * most_deg; };
  return degrees(part(), part(), part());
}

RC_GTEST_PROP(JointAlignmentLaw, WithoutNoiseTheTurnComesBack, ()) {
  TurnedTool tool;
  tool.noisy = false;
  tool.turn_rad = any_turn(5.0);
  AlignmentSettings settings;
  settings.dip_known = *rc::gen::arbitrary<bool>();
  settings.stated_rad = rad_from_deg(5.0);
  const auto found = align_magnetometers(tool.of(some_attitudes(12)), settings);
  RC_ASSERT(found.has_value() || found.error().why == NoAlignment::not_observable);  // attitudes too much alike
  if (!found) return;
  for (std::size_t k = 0; k < 3; ++k) RC_ASSERT(std::fabs(found->turn_rad[k] - tool.turn_rad[k]) < 1e-7);
  RC_ASSERT(found->chi_square < 1e-6);
}

RC_GTEST_PROP(JointAlignmentLaw, FollowsTheFrame, ()) {
  // Axes of the tool named otherwise: the same rotation, seen from there. Errors that are alike on every axis only.
  TurnedTool tool;
  tool.turn_rad = any_turn(1.0);
  tool.seed = static_cast<unsigned>(*rc::gen::inRange(1, 100000));
  AlignmentSettings settings;
  settings.tool = {0.004, 0.0, 70e-9, 0.0, 0.0};
  settings.dip_known = *rc::gen::arbitrary<bool>();
  settings.misfit_false_alarm = 1e-9;
  std::vector<ReferencedStation> stations = tool.of(scattered(*rc::gen::inRange(20, 50)));
  const auto one = align_magnetometers(stations, settings);
  RC_ASSERT(one.has_value());
  const Mat3 frame = rotation_of(any_turn(180.0));
  for (ReferencedStation& s : stations) {
    s.measured.gravity_mps2 = times(frame, s.measured.gravity_mps2);
    s.measured.field_tesla = times(frame, s.measured.field_tesla);
  }
  const auto other = align_magnetometers(stations, settings);
  RC_ASSERT(other.has_value());
  const Vec3 expected = times(frame, one->turn_rad);
  RC_ASSERT(norm(minus(other->turn_rad, expected)) < 1e-9);
  for (std::size_t k = 0; k < 3; ++k)
    RC_ASSERT(std::fabs(one->axis[k].sigma_rad / other->axis[k].sigma_rad - 1.0) < 1e-6);
  RC_ASSERT(std::fabs(one->chi_square - other->chi_square) < 1e-6 * one->chi_square);
}

RC_GTEST_PROP(JointAlignmentLaw, DoesNotCountStationsInOrder, ()) {
  TurnedTool tool;
  tool.turn_rad = any_turn(1.0);
  std::vector<ReferencedStation> stations = tool.of(scattered(30));
  const auto one = align_magnetometers(stations, {});
  const std::vector<int> key = *rc::gen::container<std::vector<int>>(30, rc::gen::arbitrary<int>());
  std::vector<std::size_t> order(30);
  for (std::size_t k = 0; k < 30; ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key[a] < key[b]; });
  std::vector<ReferencedStation> mixed;
  for (const std::size_t k : order) mixed.push_back(stations[k]);
  const auto other = align_magnetometers(mixed, {});
  RC_ASSERT(one.has_value() && other.has_value());
  RC_ASSERT(norm(minus(one->turn_rad, other->turn_rad)) < 1e-11);
  RC_ASSERT(order[static_cast<std::size_t>(other->held_out.worst)] == static_cast<std::size_t>(one->held_out.worst));
}

RC_GTEST_PROP(JointAlignmentLaw, ATurnAboutOneAxisOfTheToolShowsNothingOfIt, ()) {
  // Any tool turned about any axis of its own at any attitude keeps east at one angle to it: with an unknown dip the
  // rotation about it cannot be told. With a known one where the axis lies in the magnetic meridian.
  const bool known = *rc::gen::arbitrary<bool>();
  const Measurement first = station_of(any_attitude(), World{});
  const Vec3 g = scaled(first.gravity_mps2, 1.0 / norm(first.gravity_mps2));
  const Vec3 b = scaled(first.field_tesla, 1.0 / norm(first.field_tesla));
  const Vec3 east = scaled(cross(g, b), 1.0 / norm(cross(g, b))), north = cross(east, g);
  const double a = *rc::gen::inRange(0, 360) * kPi / 180.0, up = *rc::gen::inRange(0, 360) * kPi / 180.0;
  Vec3 axis = plus(scaled(g, std::cos(a)), scaled(north, std::sin(a)));
  if (!known) axis = plus(scaled(axis, std::cos(up)), scaled(east, std::sin(up)));
  std::vector<ReferencedStation> stations;
  const int count = *rc::gen::inRange(8, 40);
  for (int k = 0; k < count; ++k) {
    const Mat3 turn = rotation_of(scaled(axis, *rc::gen::inRange(0, 6283) / 1000.0));
    ReferencedStation s{first, reference_of(World{})};
    s.measured.gravity_mps2 = times(turn, first.gravity_mps2);
    s.measured.field_tesla = times(turn, first.field_tesla);
    s.measured.random = independent_covariance(1e-3, 20e-9);
    stations.push_back(s);
  }
  AlignmentSettings settings;
  settings.dip_known = known;
  const auto found = align_magnetometers(stations, settings);
  RC_ASSERT(!found.has_value());
  RC_ASSERT(found.error().why == NoAlignment::not_observable);
  double squares = 0.0;  // of the axis within the directions that are open
  for (const AlignmentAxis& open : found.error().axis) {
    if (!open.told) squares += std::pow(dot(open.direction, axis), 2);
  }
  RC_ASSERT(std::fabs(squares - 1.0) < 1e-4);
}

}  // namespace
}  // namespace joint_alignment_laws_test
