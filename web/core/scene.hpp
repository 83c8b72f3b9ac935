/// A scene of the page as the parts that a run needs: tool, stand, world (private to web/core).
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/health/monitor_setup.hpp"
#include "plumb/scenario/host_request.hpp"
#include "plumb/scenario/scenario.hpp"
#include "reading.hpp"

namespace plumb_web {

/// How a scene moves: "stations", "roll", or the name of a flight.
std::string motion_of(const json& scene);

/// How the sensors of the page are made.
struct Make {
  double scale_per_mps2 = 0.0;
  double full_scale_raw = 0.0;
  double resolution_raw = 0.0;
  plumb::Reads reads = plumb::Reads::gravity;
};
/// What the array file says that the page offers: sensors of the paper's kind.
Make paper_make();

/// Sensors of one make along these axes, of any length but zero. `chips` are the numbers of their chips, 0: of its own.
plumb::Datasheet datasheet_of(const plumb::AxisList& axes, const ChipList& chips, int n, double noise_mps2,
                              const Make& make);

/// The stations of the stand, found as `plumb calibrate` finds them in its log.
std::vector<plumb::Station> stations_of(const plumb::scenario::Tool& tool, const plumb::SensorArray& array,
                                        const plumb::GravityReference& gravity, std::uint64_t seed);

/// The way of the tool from station to station, without faults.
plumb::scenario::Scenario world_of(const json& scene, const plumb::scenario::Tool& tool);

std::unique_ptr<plumb::MonitorSetup> setup_of(const plumb::Datasheet& datasheet, const plumb::Calibration& fit,
                                              const plumb::GravityReference& gravity);

/// From the frame of the housing into that of the nominal axes.
plumb::Mat3 turn_of(const plumb::scenario::Tool& tool);

/// The faults of a scene, and each as a sentence.
struct SceneFaults {
  std::vector<plumb::scenario::Fault> faults;
  std::vector<std::string> words;
};
tl::expected<SceneFaults, std::string> faults_of(const json& scene, const plumb::Datasheet& datasheet);
tl::expected<std::vector<plumb::scenario::HostRequest>, std::string> requests_of(const json& scene,
                                                                                 const plumb::SensorArray& array);

}  // namespace plumb_web
