// Laws of chips as fault units at rest (docs/theory.md, section 5.7), over drawn arrays, faults and attitudes.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

#include "support/chip_tool.hpp"

namespace chip_units_laws_test {
namespace {

using namespace plumb;
using namespace plumb_test;

/// One or two triads, and single sensors beside them that no three of lie in one plane.
SensorArray drawn_array(int chips, Noise& noise) {
  const int room = kCapacity - 3 * chips;
  const int singles =
      chips == 1 ? 3 + static_cast<int>(noise.uniform() * (room - 2)) : static_cast<int>(noise.uniform() * (room + 1));
  const Vec3 axes[5] = {{0.57735026918962576, 0.57735026918962576, 0.57735026918962576},
                        {-0.57735026918962576, 0.57735026918962576, 0.57735026918962576},
                        {0.6, -0.8, 0.0},
                        {0.0, 0.6, -0.8},
                        {0.28, 0.0, 0.96}};
  return chip_array(chips, std::vector<Vec3>(axes, axes + singles));
}

/// A single sensor is a unit that fails alone, beside a chip where the grade bears both.
// Verifies: REQ-206, REQ-071
RC_GTEST_PROP(ChipUnitsLaws, NoHealthyUnitIsExcludedWhileNoMoreFailThanTheGrade, ()) {
  const auto seed = static_cast<std::uint64_t>(*rc::gen::inRange(1, 1'000'000));
  Noise noise(seed);
  const int chips = 1 + static_cast<int>(noise.uniform() * 2.0);
  const SensorArray array = drawn_array(chips, noise);
  const int grade = confirmed_grade(array, array.all());
  RC_ASSERT(grade >= 1);
  const auto fault = kChipFaults[static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(kChipFaults.size())))];
  ChipRig tool(array, {}, seed);
  tool.fail(chips - 1, fault, seed + 1);
  if (grade >= 2 && noise.uniform() < 0.5) {
    const int other = 3 * chips;  // the first single sensor
    const double off_mps2 = (0.02 + 0.3 * noise.uniform()) * kG0_mps2;
    tool.failed = tool.failed.with(other);
    const Rig::Distort chip = tool.rig.distort;
    tool.rig.distort = [chip, other, off_mps2](int i, double reading, int sample) {
      return i == other ? reading + off_mps2 : chip(i, reading, sample);
    };
  }
  for (int s = 0; s < 6; ++s) {
    const Verdict& v = tool.station(1 + static_cast<int>(noise.uniform() * 4.0));
    RC_ASSERT(tool.failed.contains(v.excluded));
    RC_ASSERT(array.units().whole(v.excluded | v.provisionally_excluded) == (v.excluded | v.provisionally_excluded));
    if (noise.uniform() < 0.3) tool.shaken((0.005 + 0.05 * noise.uniform()) * kG0_mps2);
  }
}

/// The readings of a chip that fails, and nothing else, decide: which number the chips bear does not.
// Verifies: REQ-206
RC_GTEST_PROP(ChipUnitsLaws, TheNumbersOfTheChipsMeanNothing, ()) {
  const auto seed = static_cast<std::uint64_t>(*rc::gen::inRange(1, 1'000'000));
  const SensorArray one = chip_array(2);
  std::array<SensorRow, kCapacity> rows{};
  const int first = *rc::gen::inRange(1, 256), second = *rc::gen::inRange(1, 256);
  RC_PRE(first != second);
  for (int i = 0; i < 6; ++i) {
    rows[static_cast<std::size_t>(i)] = one.row(i);
    rows[static_cast<std::size_t>(i)].chip = static_cast<std::uint8_t>(i < 3 ? first : second);
  }
  const Expected<SensorArray> other = SensorArray::make(rows.data(), 6);
  RC_ASSERT(other.has_value());
  ChipRig a(one, {}, seed), b(*other, {}, seed);
  for (ChipRig* tool : {&a, &b}) {
    tool->fail(0, ChipFault::biased, seed);
    for (int s = 0; s < 4; ++s) tool->station(2);
  }
  const Verdict &v = a.rig.monitor.verdict(), &w = b.rig.monitor.verdict();
  RC_ASSERT(v.excluded == w.excluded);
  RC_ASSERT(v.state == w.state);
  RC_ASSERT(v.gravity_mps2 == w.gravity_mps2);
  RC_ASSERT(v.protection_level_housing_rad == w.protection_level_housing_rad);
  RC_ASSERT(v.config_hash == w.config_hash);
}

}  // namespace
}  // namespace chip_units_laws_test
