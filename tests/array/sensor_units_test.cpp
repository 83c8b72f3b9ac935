// Units of an array: chips, and sensors on none (docs/theory.md, section 5.7).
#include "plumb/array/sensor_units.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "plumb/array/fault_bounds.hpp"
#include "support/chip_tool.hpp"

namespace sensor_units_test {
namespace {

using namespace plumb;
using namespace plumb_test;

const Vec3 kAskew = {0.57735026918962576, 0.57735026918962576, 0.57735026918962576};
const Vec3 kOther = {-0.57735026918962576, 0.57735026918962576, 0.57735026918962576};

SensorUnits units_of(const std::array<int, 8>& chip, int n) {
  return SensorUnits::of_chips(n, [&chip](int i) { return chip[static_cast<std::size_t>(i)]; });
}

TEST(SensorUnits, AreNumberedByTheirFirstSensor) {
  const SensorUnits units = units_of({9, 0, 4, 9, 4, 0, 9, 4}, 8);
  EXPECT_EQ(units.size(), 4);
  EXPECT_TRUE(units.grouped());
  const std::array<int, 8> expected = {0, 1, 2, 0, 2, 3, 0, 2};
  for (int i = 0; i < 8; ++i) EXPECT_EQ(units.of(i), expected[static_cast<std::size_t>(i)]) << i;
  EXPECT_EQ(units.sensors_of(SensorSet::of(0)), SensorSet(0b0100'1001U));
  EXPECT_EQ(units.units_of(SensorSet(0b0001'0010U)), SensorSet(0b0110U));
  EXPECT_EQ(units.whole(SensorSet::of(4)), SensorSet(0b1001'0100U));
  EXPECT_EQ(units.count(units.whole(SensorSet::of(4)).with(1)), 2);
}

TEST(SensorUnits, WithinAreThoseWithAllTheirPresentSensors) {
  const SensorUnits units = units_of({1, 1, 1, 2, 2, 2, 0, 0}, 8);
  const SensorSet all = SensorSet::first(8);
  EXPECT_EQ(units.units_within(SensorSet(0b0100'1111U), all), SensorSet(0b0101U));
  EXPECT_EQ(units.units_within(SensorSet(0b0100'1111U), all.without(4).without(5)), SensorSet(0b0111U));
  EXPECT_EQ(units.units_within(SensorSet(0b0000'0001U), all), SensorSet{});
  EXPECT_EQ(units.units_within(SensorSet{}, all), SensorSet{});
}

TEST(SensorUnits, OfSensorsOnNoChipOrAloneOnOneAreTheSensors) {
  for (const SensorUnits& units : {units_of({}, 8), units_of({1, 2, 3, 4, 5, 6, 7, 8}, 8)}) {
    EXPECT_FALSE(units.grouped());
    EXPECT_EQ(units.size(), 8);
    EXPECT_EQ(units.sensors_of(SensorSet(0b1010'0110U)), SensorSet(0b1010'0110U));
    EXPECT_EQ(units.units_of(SensorSet(0b1010'0110U)), SensorSet(0b1010'0110U));
    EXPECT_EQ(units.units_within(SensorSet(0b0110U), SensorSet(0b0111U)), SensorSet(0b0110U));
  }
}

TEST(SensorUnits, AnArrayOfNoSensorsHasNone) {
  EXPECT_EQ(SensorArray{}.units().size(), 0);
  EXPECT_FALSE(SensorArray{}.units().grouped());
}

TEST(CoplanarityOfUnits, IsZeroForTriadsAndCountsWhatLiesInOnePlaneBesideThem) {
  const auto of = [](const SensorArray& array) { return coplanarity(array, array.all()); };
  EXPECT_EQ(of(chip_array(1)), 0);
  EXPECT_EQ(of(chip_array(2)), 0);
  EXPECT_EQ(of(chip_array(2, {}, false)), 4);
  EXPECT_EQ(of(chip_array(2, {kAskew})), 1);
  EXPECT_EQ(of(chip_array(2, {kAskew, kOther})), 2);
  // A chip that has lost an axis lies in the plane of the others.
  const SensorArray two = chip_array(2);
  EXPECT_EQ(coplanarity(two, two.all().without(0)), 1);
  EXPECT_EQ(coplanarity(two, two.all().without(0).without(3)), 2) << "rank 2: all of them";
  EXPECT_EQ(coplanarity(two, two.all().without(0).without(4)), 1);
}

/// Whatever is lost, an axis or a chip.
TEST(CoplanarityOfUnits, NoLossRaisesAGrade) {
  for (const SensorArray& array :
       {chip_array(2), chip_array(2, {kAskew, kOther}), chip_array(1, {kAskew, kOther, {0.6, -0.8, 0.0}})}) {
    for (std::uint32_t bits = 1; bits < (1U << static_cast<unsigned>(array.size())); ++bits) {
      const SensorSet used(bits);
      for (int i = 0; i < array.size(); ++i) {
        if (!used.has(i)) continue;
        EXPECT_LE(confirmed_grade(array, used.without(i)), confirmed_grade(array, used)) << bits << " " << i;
        EXPECT_LE(provisional_grade(array, used.without(i)), provisional_grade(array, used)) << bits << " " << i;
      }
    }
  }
}

/// The definition: with any `confirmed_grade` units taken away the rest spans space, and with one more it may not.
TEST(CoplanarityOfUnits, TheGradeIsOneLessThanTheFewestUnitsWhoseLossLeavesAPlane) {
  for (const SensorArray& array :
       {chip_array(2), chip_array(2, {kAskew}), chip_array(2, {kAskew, kOther}), chip_array(1, {kAskew, kOther}),
        chip_array(1, {kAskew, kOther, {0.6, -0.8, 0.0}, {0.0, 0.6, -0.8}})}) {
    const SensorUnits& units = array.units();
    int fewest = units.size();
    for (std::uint32_t bits = 1; bits < (1U << static_cast<unsigned>(units.size())); ++bits) {
      const SensorSet out(bits);
      if (!spans_space(array, array.all() - units.sensors_of(out)) && out.size() < fewest) fewest = out.size();
    }
    EXPECT_EQ(confirmed_grade(array, array.all()), fewest - 1);
  }
}

/// Another vector within the slack of the trusted chips is within it in every component: twice the slack is told.
TEST(FaultBoundsOfUnits, OfParallelTriadsAreThoseOfAgreement) {
  const FaultBounds two = fault_bounds(chip_array(2), 2.0);
  EXPECT_NEAR(two.worst_fault(1), 4.0, 1e-9);
  EXPECT_NEAR(two.vector_error[1], 2.0 * std::sqrt(3.0), 1e-9);
  EXPECT_TRUE(std::isinf(two.worst_fault(2))) << "a turned chip of two is told from nobody";
  const FaultBounds sensors = fault_bounds(chip_array(2, {}, false), 2.0);
  EXPECT_TRUE(std::isinf(sensors.worst_fault(2)));
}

/// Against the search over all sets of trusted units: linear programming by the vertices that three sensors cut out.
TEST(FaultBoundsOfUnits, AreThoseOfEverySetOfTrustedUnits) {
  const SensorArray array = chip_array(1, {kAskew, kOther, {0.6, -0.8, 0.0}, {0.0, 0.6, -0.8}});
  const SensorUnits& units = array.units();
  const FaultBounds found = fault_bounds(array, 2.0);
  for (int k = 1; k <= units.size() - 1 - coplanarity(array, array.all()); ++k) {
    double worst = 0.0;
    for (SensorSet out = SensorSet::first(k); units.all().contains(out); out = next_of_same_size(out)) {
      const SensorSet trusted = array.all() - units.sensors_of(out);
      for (int t = 0; t < array.triple_count(); ++t) {
        const Triple& corner = array.triple(t);
        if (!trusted.contains(corner.set()) || !std::isfinite(corner.condition)) continue;
        for (const double a : {2.0, -2.0}) {
          for (const double b : {2.0, -2.0}) {
            const Vec3 d = times(triple_map(array, t), {2.0, a, b});
            bool inside = true;
            for (int i = 0; i < array.size(); ++i)
              inside = inside && (!trusted.has(i) || std::fabs(dot(array.axis(i), d)) <= 2.0 + 1e-9);
            for (int i = 0; i < array.size() && inside; ++i) {
              if (!trusted.has(i)) worst = std::fmax(worst, 2.0 + std::fabs(dot(array.axis(i), d)));
            }
          }
        }
      }
    }
    EXPECT_NEAR(found.worst_fault(k), worst, 1e-9) << k;
  }
}

}  // namespace
}  // namespace sensor_units_test
