// How far biases and scales may move at once, in all, and per hour.
#include "plumb/health/detail/drift_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/simulated_tool.hpp"

namespace drift_bounds_test {
namespace {

using namespace plumb;

constexpr DriftSigmas kSigma = {1e-3, 1e-4};
constexpr double kHour_s = 3600.0;

SensorModel model_of() {
  SensorModel model;
  model.size = 4;
  return model;
}

DriftBounds bounds_of(const SensorModel& commissioning) {
  DriftBounds bounds;
  bounds.begin(commissioning, alike(kSigma));
  return bounds;
}

/// Of sensor 2 alone: its bias by so many drift sigmas.
CoefficientChange shifted(double sigmas) {
  CoefficientChange change;
  change.length.fill(1.0);
  change.shift_mps2[2] = sigmas * kSigma.bias_mps2;
  return change;
}

// Verifies: REQ-130
TEST(DriftBounds, AChangeIsBoundedFromTheCalibrationInForce) {
  const SensorModel model = model_of();
  const DriftBounds bounds = bounds_of(model);
  EXPECT_EQ(bounds.check(shifted(2.9), SensorSet::first(4), model, 0.0).code, Errc::ok);
  const Error error = bounds.check(shifted(3.1), SensorSet::first(4), model, 0.0);
  EXPECT_EQ(error.code, Errc::implausible);
  EXPECT_EQ(error.index, 2);
  EXPECT_NEAR(error.value, 3.1, 1e-12);
  EXPECT_EQ(error.limit, DriftBounds::kLastSigmas);
  EXPECT_EQ(bounds.check(shifted(3.1), SensorSet::first(2), model, 0.0).code, Errc::ok) << "of another sensor";
}

// Negative: REQ-130
TEST(DriftBounds, SmallStepsDoNotAddUpWithoutLimit) {
  SensorModel model = model_of();
  DriftBounds bounds = bounds_of(model);
  int adopted = 0;
  double now_s = 0.0;
  while (adopted < 100 && bounds.check(shifted(0.45), SensorSet::first(4), model, now_s).code == Errc::ok) {
    shifted(0.45).write(SensorSet::first(4), model);
    bounds.note_adoption(now_s, true);
    EXPECT_TRUE(bounds.allow(model));
    now_s += 10.0 * kHour_s;
    ++adopted;
  }
  EXPECT_EQ(adopted, 11) << "five sigmas from the commissioning calibration";
  shifted(0.45).write(SensorSet::first(4), model);
  EXPECT_FALSE(bounds.allow(model));
}

// Verifies: REQ-130
TEST(DriftBounds, AfterAnAdoptionTheHoursCount) {
  const SensorModel model = model_of();
  DriftBounds bounds = bounds_of(model);
  const auto limit = [&](double hours) {
    return bounds.check(shifted(9.0), SensorSet::first(4), model, hours * kHour_s).limit;
  };
  bounds.note_adoption(0.0, false);
  EXPECT_EQ(limit(0.0), DriftBounds::kLastSigmas) << "the first calibration is no step in flight";
  bounds.note_adoption(0.0, true);
  EXPECT_EQ(limit(0.0), DriftBounds::kLeastHours * DriftBounds::kSigmasPerHour);
  EXPECT_EQ(limit(2.0), 2.0 * DriftBounds::kSigmasPerHour);
  EXPECT_EQ(limit(50.0), DriftBounds::kLastSigmas);
}

// Negative: REQ-130
TEST(DriftBounds, WhatIsNoNumberIsWithinNoBound) {
  const SensorModel model = model_of();
  const DriftBounds bounds = bounds_of(model);
  for (const double none : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    CoefficientChange change = shifted(none);
    EXPECT_EQ(bounds.check(change, SensorSet::first(4), model, 0.0).code, Errc::implausible);
    change = shifted(0.0);
    change.length[1] = none;
    EXPECT_EQ(bounds.check(change, SensorSet::first(4), model, 0.0).code, Errc::implausible);
    SensorModel damaged = model;
    damaged.sensor[3].scale[0] = none;
    EXPECT_FALSE(bounds.allow(damaged));
  }
}

// Verifies: REQ-130
TEST(DriftBounds, AChangeOfRowsIsWhatTheReadingsChangeBy) {
  const SensorArray array = plumb_test::tetrahedron();
  CoefficientChange change = shifted(2.0);
  change.length[0] = 1.0 + 3e-4;
  const RowChange rows = change.on_rows(array.all(), array);
  EXPECT_NEAR(norm({rows.of[0], rows.of[1], rows.of[2]}), 3e-4, 1e-15);
  EXPECT_EQ(rows.of[11], change.shift_mps2[2]);
  RowUncertainty left;
  rows.doubt(array, left);
  EXPECT_EQ(std::sqrt(left.covariance[11 * 12 / 2 + 11]), change.shift_mps2[2]);
}

}  // namespace
}  // namespace drift_bounds_test
