// The sensor model against the equations in extended precision.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "plumb/calibration/sensor_model.hpp"

namespace {

using namespace plumb;

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
  std::array<long double, 4> single{};
  for (std::size_t i = 0; i < 4; ++i) {
    const SensorCoefficients& c = model.sensor[i];
    const long double t = static_cast<long double>(temperature) - c.reference_degc;
    const long double scale = c.scale[0] + t * (c.scale[1] + t * (c.scale[2] + t * c.scale[3]));  // eq (1)
    const long double bias = c.bias[0] + t * (c.bias[1] + t * (c.bias[2] + t * c.bias[3]));       // eq (2)
    single[i] = raw[i] / scale - bias;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    long double sum = single[i];  // eq (3): A_i = V_i/SF*_i - B*_i - sum m_ik A_k of the single readings
    for (std::size_t k = 0; k < 4; ++k) sum -= model.misalignment[i * kCapacity + k] * single[k];
    RC_ASSERT(std::fabs(static_cast<double>(got[i] - sum)) <= 1e-12 * (1.0 + std::fabs(static_cast<double>(sum))));
  }
}

}  // namespace
