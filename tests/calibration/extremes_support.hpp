/// Numbers of every size in every place of a datasheet and of the stations, for the tests of the fits.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "calibration/temperature_support.hpp"

namespace extremes_test {

using namespace temperature_test;
using plumb::Calibration;
using plumb::Datasheet;
using plumb::DatasheetSensor;
using plumb::Errc;
using plumb::Expected;
using plumb::FitOptions;
using plumb::FitReport;
using plumb::GravityReference;
using plumb::Station;

inline constexpr double kMost = std::numeric_limits<double>::max();

/// From nothing to too much, and what is no number.
inline constexpr double kSizes[] = {0.0,   5e-324, 1e-300, 1e-160, 1e-80,
                                    1e-20, 1e20,   1e80,   1e150,  1e155,
                                    1e160, 1e300,  kMost,  -1.0,   std::numeric_limits<double>::quiet_NaN()};

struct Problem {
  Datasheet sheet = paper_sheet();
  GravityReference gravity = calibration_test::standard_gravity();
  std::vector<Station> stations;
  FitOptions options;

  int count() const { return static_cast<int>(stations.size()); }
};

inline void hold_axes(Problem& p) {
  for (int i = 0; i < p.sheet.size; ++i) p.sheet.sensor[at(i)].prior.axis_rad = 0.0;
}

enum class Kind { plain, warmed, held };  ///< at one temperature, at two, with axes that are as the datasheet says

/// Twenty-four stations.
inline Problem sound(Kind kind = Kind::plain) {
  Problem p;
  Noise noise(31);
  temperature_test::Truth truth = temperature_test::draw_truth(p.sheet, noise);
  if (kind == Kind::held) {
    hold_axes(p);
    for (int i = 0; i < p.sheet.size; ++i) truth.axis[at(i)] = p.sheet.sensor[at(i)].row.axis;
  }
  p.stations = on_levels(truth, kind == Kind::warmed ? levels_of(2) : std::vector<double>{25.0, 25.0}, noise);
  return p;
}

using Change = std::function<void(Problem&, double)>;

/// A number of one sensor, and the same of all.
inline std::vector<Change> places() {
  using Place = std::function<double&(DatasheetSensor&)>;
  const std::vector<Place> of_sensor = {[](DatasheetSensor& s) -> double& { return s.row.sigma_mps2; },
                                        [](DatasheetSensor& s) -> double& { return s.prior.bias_mps2; },
                                        [](DatasheetSensor& s) -> double& { return s.prior.scale; },
                                        [](DatasheetSensor& s) -> double& { return s.prior.axis_rad; },
                                        [](DatasheetSensor& s) -> double& { return s.prior.bias_t_mps2[0]; },
                                        [](DatasheetSensor& s) -> double& { return s.prior.scale_t[0]; },
                                        [](DatasheetSensor& s) -> double& { return s.coefficients.scale[0]; },
                                        [](DatasheetSensor& s) -> double& { return s.coefficients.bias[0]; },
                                        [](DatasheetSensor& s) -> double& { return s.coefficients.scale[1]; }};
  std::vector<Change> out;
  for (const Place& place : of_sensor) {
    out.push_back([place](Problem& p, double size) { place(p.sheet.sensor[1]) = size; });
    out.push_back([place](Problem& p, double size) {
      for (int i = 0; i < p.sheet.size; ++i) place(p.sheet.sensor[at(i)]) = size;
    });
  }
  out.push_back([](Problem& p, double size) { p.gravity.g_mps2 = size; });
  out.push_back([](Problem& p, double size) { p.stations[3].mean[2] = size; });
  out.push_back([](Problem& p, double size) {
    for (Station& s : p.stations) s.mean[2] = size;
  });
  out.push_back([](Problem& p, double size) {
    for (Station& s : p.stations) s.mean.fill(size);
  });
  out.push_back([](Problem& p, double size) { p.stations[3].temperature_degc = size; });
  out.push_back([](Problem& p, double size) { p.stations[3].scatter[1] = size; });
  return out;
}

/// How many of the problems were answered, and how many refused: a test of either alone would say nothing.
struct Count {
  int answered = 0, refused = 0;
};

/// All places with all sizes: `judge` says what is wrong with the answer, in the way of EXPECT, and whether there was
/// one.
inline Count for_each_extreme(const std::function<bool(Problem&)>& judge, Kind kind = Kind::plain) {
  Count count;
  const std::vector<Change> all = places();
  for (std::size_t place = 0; place < all.size(); ++place) {
    for (const double size : kSizes) {
      SCOPED_TRACE(testing::Message() << "place " << place << ", size " << size);
      Problem p = sound(kind);
      all[place](p, size);
      ++(judge(p) ? count.answered : count.refused);
    }
  }
  return count;
}

/// Of 360 problems each.
inline void expect_both(const Count& count, int answered, int refused) {
  EXPECT_GE(count.answered, answered);
  EXPECT_GE(count.refused, refused);
  EXPECT_EQ(count.answered + count.refused, 360);
}

}  // namespace extremes_test
