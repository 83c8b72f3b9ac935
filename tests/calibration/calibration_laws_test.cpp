/// Laws of the fit for any array of rank 3.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration_support.hpp"

namespace calibration_laws_test {
namespace {

using namespace calibration_test;

constexpr double kSigma = 2e-4 * plumb::kG0_mps2;

struct Scene {
  plumb::Datasheet sheet;
  Truth truth;
  std::vector<plumb::Station> stations;
};

/// Axes anywhere, but the array well enough conditioned that its directions mean something.
Scene drawn_scene(double sigma_mps2) {
  const int n = *rc::gen::inRange(3, std::min(8, plumb::kCapacity) + 1);
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  plumb::AxisList axes{};
  for (int attempt = 0; attempt < 1000; ++attempt) {
    double best = 0.0;
    for (int i = 0; i < n; ++i) axes[at(i)] = noise.direction();
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) {
        for (int k = 0; k < j; ++k)
          best = std::fmax(best, std::fabs(plumb::det3(axes[at(i)], axes[at(j)], axes[at(k)])));
      }
    }
    if (best > 0.4) break;
  }
  Scene scene;
  scene.sheet =
      datasheet_of(axes, n, kSigma, noise.uniform() < 0.5 ? plumb::Reads::gravity : plumb::Reads::specific_force);
  scene.truth = draw_truth(scene.sheet, noise, 0.5);
  scene.stations = random_stations(scene.sheet, scene.truth, 40, noise, sigma_mps2);
  return scene;
}

plumb::Expected<plumb::Calibration> fit(const Scene& s) {
  return plumb::calibrate(s.sheet, standard_gravity(), s.stations.data(), static_cast<int>(s.stations.size()));
}

// Verifies: REQ-032
RC_GTEST_PROP(CalibrationLaws, EveryArrayOfRankThreeIsFoundAgain, ()) {
  const Scene scene = drawn_scene(kSigma);
  const auto c = fit(scene);
  RC_ASSERT(c.has_value());
  const int n = scene.sheet.size;
  RC_ASSERT(c->report.rank == 4 * n - 3);
  RC_ASSERT(c->report.gauge == 3);
  const std::vector<double> error = observable_error(n, scene.truth, fitted(scene.sheet, *c));
  for (int k = 0; k < 4 * n; ++k) RC_ASSERT(std::fabs(error[at(k)]) <= 6.0 * c->report.sigma[at(k)]);
  RC_ASSERT(c->report.norm_rms_mps2 <= 20.0 * kSigma);
}

// Verifies: REQ-036
RC_GTEST_PROP(CalibrationLaws, TheResultIsACommonFrameModel, ()) {
  const auto c = fit(drawn_scene(kSigma));
  RC_ASSERT(c.has_value());
  for (const double m : c->model.misalignment) RC_ASSERT(m == 0.0);
  const int n = c->array.size();
  for (int i = 0; i < n; ++i) {
    RC_ASSERT(std::fabs(plumb::norm(c->array.axis(i)) - 1.0) <= 1e-12);
    RC_ASSERT(c->array.sigma_mps2(i) > 0.0);
    for (int k = 0; k < 4; ++k) {
      const std::size_t d = at(4 * i + k);
      RC_ASSERT(c->array.uncertainty().covariance[d * (d + 1) / 2 + d] >= 0.0);
    }
    RC_ASSERT(c->report.e_cal_mps2[at(i)] > 0.0);
  }
}

RC_GTEST_PROP(CalibrationLaws, OrderOfStationsDoesNotMatter, ()) {
  Scene scene = drawn_scene(kSigma);
  const auto one = fit(scene);
  std::reverse(scene.stations.begin(), scene.stations.end());
  const auto two = fit(scene);
  RC_ASSERT(one.has_value() && two.has_value());
  for (int i = 0; i < scene.sheet.size; ++i) {
    RC_ASSERT(plumb::norm(plumb::minus(one->array.axis(i), two->array.axis(i))) <= 1e-8);
  }
}

// Verifies: REQ-034
RC_GTEST_PROP(CalibrationLaws, AnyReadingsAtAllComeBackAsAValue, ()) {
  Scene scene = drawn_scene(kSigma);
  const int victim = *rc::gen::inRange(0, 40);
  const int sensor = *rc::gen::inRange(0, scene.sheet.size);
  scene.stations[at(victim)].mean[at(sensor)] = *rc::gen::arbitrary<double>();
  scene.stations[at(victim)].count = *rc::gen::arbitrary<std::uint32_t>();
  scene.stations[at(victim)].delivered = plumb::SensorSet(*rc::gen::arbitrary<std::uint32_t>());
  plumb::FitReport report;
  const auto c = plumb::calibrate(scene.sheet, standard_gravity(), scene.stations.data(), 40, {}, &report);
  if (!c) RC_SUCCEED("refused");
  for (int i = 0; i < scene.sheet.size; ++i) RC_ASSERT(std::isfinite(c->model.sensor[at(i)].scale[0]));
  RC_ASSERT(report.norm_rms_mps2 <= plumb::FitOptions{}.max_norm_rms_mps2);
}

}  // namespace
}  // namespace calibration_laws_test
