// The sensor model against the equations in extended precision.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "plumb/calibration/sensor_model.hpp"

namespace requirements_model_test {
namespace {

using namespace plumb;

using Wide = long double;

Wide wide(double value) { return static_cast<Wide>(value); }

Wide cubic(const std::array<double, 4>& c, Wide t) {
  return wide(c[0]) + t * (wide(c[1]) + t * (wide(c[2]) + t * wide(c[3])));
}

double drawn(double low, double high) {
  const int step = *rc::gen::inRange(0, 1000001);
  return low + (high - low) * step * 1e-6;
}

// Verifies: REQ-003
RC_GTEST_PROP(RequirementSensorModel, AgreesWithExtendedPrecision, ()) {
  SensorModel model;
  model.size = 4;
  const double temperature = drawn(-40.0, 200.0);
  std::array<double, kCapacity> raw{};
  for (std::size_t i = 0; i < 4; ++i) {
    SensorCoefficients& c = model.sensor[i];
    c.reference_degc = drawn(15.0, 60.0);
    const double scale = drawn(0.1, 3.0);
    const double drift = drawn(-1e-4, 1e-4);
    const double bias = drawn(-0.5, 0.5);
    const double slope = drawn(-1e-3, 1e-3);
    c.scale = {scale, scale * drift, scale * drift * 1e-3, scale * drift * 1e-6};
    c.bias = {bias, slope, slope * 1e-3, slope * 1e-6};
    raw[i] = scale * drawn(-190.0, 190.0);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (i != k) model.misalignment[i * kCapacity + k] = drawn(-0.05, 0.05);
    }
  }
  const Readings got = model.apply(raw, temperature, SensorSet::first(4));
  std::array<Wide, 4> single{};
  for (std::size_t i = 0; i < 4; ++i) {
    const SensorCoefficients& c = model.sensor[i];
    const Wide t = wide(temperature) - wide(c.reference_degc);
    single[i] = wide(raw[i]) / cubic(c.scale, t) - cubic(c.bias, t);  // eqs (1), (2)
  }
  for (std::size_t i = 0; i < 4; ++i) {
    Wide sum = single[i];  // eq (3) over the single readings
    for (std::size_t k = 0; k < 4; ++k) sum -= wide(model.misalignment[i * kCapacity + k]) * single[k];
    const auto error = static_cast<double>(wide(got[i]) - sum);
    const auto size = static_cast<double>(sum);
    RC_ASSERT(std::fabs(error) <= 1e-12 * (1.0 + std::fabs(size)));
  }
}

}  // namespace
}  // namespace requirements_model_test
