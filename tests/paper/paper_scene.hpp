/// Three sensors before the paper's fit of them, and the storage of its steps.
#pragma once

#include <memory>
#include <vector>

#include "../../src/paper/paper_step.hpp"
#include "calibration/bench.hpp"

namespace calibration_test {

/// Of three sensors: 12 parameters.
struct PaperScene {
  PaperScene() : error(*PaperError::make(sheet, gravity, SensorSet::first(3))) {
    work->size = work->stride = error.parameters();
    for (double& entry : work->matrix) entry = 0.0;
    work->gradient.fill(1.0);
  }
  static Datasheet triad() {
    AxisList axes{};
    return datasheet_of(axes, orthogonal_triad(axes), kBenchSigma);
  }
  paper::Problem problem(int count) const { return {error, stations.data(), count}; }

  Datasheet sheet = triad();
  GravityReference gravity = standard_gravity();
  Noise noise{3};
  Truth truth = draw_truth(sheet, noise);
  std::vector<Station> stations = random_stations(sheet, truth, 24, noise, kBenchSigma);
  PaperError error;
  std::unique_ptr<paper::Workspace> work = std::make_unique<paper::Workspace>();
};

}  // namespace calibration_test
