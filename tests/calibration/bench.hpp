/// A bench whose every number a test may spoil.
#pragma once

#include <vector>

#include "calibration/calibration_support.hpp"

namespace calibration_test {

using namespace plumb;

inline constexpr double kBenchSigma = 2e-4 * kG0_mps2;

struct Bench {
  explicit Bench(std::uint64_t seed = 1, int count = 48) : noise(seed) {
    stations = random_stations(sheet, truth, count, noise, kBenchSigma);
  }
  Noise noise;
  Datasheet sheet = paper_tool(kBenchSigma);
  Truth truth = draw_truth(sheet, noise);
  std::vector<Station> stations;
  GravityReference gravity = standard_gravity();
  FitOptions options;
  FitReport report;

  int count() const { return static_cast<int>(stations.size()); }
  Expected<Calibration> run() { return calibrate(sheet, gravity, stations.data(), count(), options, &report); }
  Errc refusal() {
    const auto c = run();
    return c ? Errc::ok : c.error().code;
  }
};

}  // namespace calibration_test
