#include "plumb/findings/worst_value.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "../io/io_test_support.hpp"

namespace worst_value_test {
namespace {

using namespace plumb;
using findings::WorstValue;
using Of = findings::WorstValue::Of;

/// Four sensors, and a fit that found them exactly as their datasheet says.
struct Fitted {
  io::ArrayFile file = io_test::array_of();
  std::unique_ptr<Calibration> fit = std::make_unique<Calibration>();
  FitOptions bound;

  Fitted() {
    fit->array = file.array;
    fit->model = file.datasheet.model();
  }
  WorstValue worst() const { return findings::worst_value(file, *fit, bound); }
  /// Turns the axis of a sensor towards (0, 1, 0).
  void turn(int sensor, double angle_rad) {
    std::array<SensorRow, 4> rows;
    for (int i = 0; i < 4; ++i) rows[static_cast<std::size_t>(i)] = file.array.row(i);
    Vec3& axis = rows[static_cast<std::size_t>(sensor)].axis;
    axis = plus(scaled(axis, std::cos(angle_rad)), scaled(Vec3{0.0, 1.0, 0.0}, std::sin(angle_rad)));
    const Expected<SensorArray> turned = SensorArray::make(rows.data(), 4);
    ASSERT_TRUE(turned);
    fit->array = *turned;
  }
};

TEST(WorstValue, IsNoneWhereEverySensorIsAsDescribed) { EXPECT_EQ(Fitted().worst().of, Of::nothing); }

TEST(WorstValue, IsTheScaleThatIsFarOff) {
  Fitted f;
  f.fit->model.sensor[1].scale[0] *= 1.4;
  const WorstValue worst = f.worst();
  EXPECT_EQ(worst.of, Of::scale);
  EXPECT_EQ(worst.sensor, 1);
  EXPECT_NEAR(worst.value, 1.4, 1e-12);
  EXPECT_EQ(worst.bound, f.bound.max_scale_change);
}

TEST(WorstValue, IsTheBiasThatIsFarOff) {
  Fitted f;
  f.fit->model.sensor[2].bias[0] += 20.0 * f.file.datasheet.sensor[2].prior.bias_mps2;
  const WorstValue worst = f.worst();
  EXPECT_EQ(worst.of, Of::bias);
  EXPECT_EQ(worst.sensor, 2);
  EXPECT_NEAR(worst.value, 20.0 * f.file.datasheet.sensor[2].prior.bias_mps2, 1e-9);
}

TEST(WorstValue, IsTheAxisOfTheSensorThatTheOthersContradict) {
  Fitted f;
  f.turn(3, 0.6);
  const WorstValue worst = f.worst();
  EXPECT_EQ(worst.of, Of::axis);
  EXPECT_EQ(worst.sensor, 3);
  EXPECT_NEAR(worst.value, 0.6, 1e-9);
}

}  // namespace
}  // namespace worst_value_test
