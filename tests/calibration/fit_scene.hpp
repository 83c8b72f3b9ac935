/// Three orthogonal axes and six stations that a hand can reckon with, for tests of the parts of a fit.
#pragma once

#include <vector>

#include "../../src/calibration/fit_report.hpp"
#include "calibration/calibration_support.hpp"

namespace calibration_test {

using namespace plumb;
using fit::Parameters;

/// Three orthogonal axes of one unit, so that numbers stay what they are.
inline Datasheet triad() {
  AxisList axes{};
  Datasheet d = datasheet_of(axes, orthogonal_triad(axes), 1.0);
  for (int i = 0; i < 3; ++i) {
    DatasheetSensor& s = d.sensor[at(i)];
    s.row.axis = Vec3{};
    s.row.axis[at(i)] = 1.0;
    s.coefficients = {};
    s.coefficients.scale[0] = 1.0;
    s.prior = {1.0, 1.0, 1.0, {}, {}};
  }
  return d;
}

/// Gravity of 10 m/s^2 along every axis and against it: what a perfect triad reads.
inline std::vector<Station> six_faces() {
  std::vector<Station> out(6);
  for (int k = 0; k < 6; ++k) {
    out[at(k)].mean[at(k % 3)] = k < 3 ? 10.0 : -10.0;
    out[at(k)].delivered = SensorSet::first(3);
    out[at(k)].temperature_degc = 25.0;
    out[at(k)].count = 1;
  }
  return out;
}

struct Scene {
  Datasheet sheet = triad();
  std::vector<Station> stations = six_faces();
  FitOptions options;
  Parameters theta = fit::datasheet_parameters(sheet);

  fit::Problem problem() const {
    return fit::problem_of(sheet, 10.0, options, {stations.data(), static_cast<int>(stations.size())});
  }
};

}  // namespace calibration_test
