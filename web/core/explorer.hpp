/// What the page asks of the core, as text in and text out: the same functions in WebAssembly and, for the tests,
/// native.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/host_request.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb_web {

/// A JSON object with `error`: what was found, and how to mend it.
std::string refusal(const std::string& text);

/// States, events, causes and validities by number, the state machine's table, the fault catalogue, the geometries and
/// the names of the figures of a record.
std::string vocabulary();

/// The axes of a built-in geometry, as `plumb geometry --name` has it: a JSON array, or a refusal.
std::string builtin_axes(const std::string& name);

/// `{"name", "axes": [[x,y,z],...], "noise_mps2", "samples"}` -> what `plumb geometry --json` prints of these sensors.
/// With "map": true the map over all attitudes stands behind it, as `map`.
std::string study(const std::string& design);

/// A tool in a scenario, and the monitor that watches it.
class Play {
 public:
  /// Calibrates the tool on its stand and configures the monitor. `{"axes", "noise_mps2", "truth_seed", "stand_seed",
  /// "seed", "stations", "inclination_deg", "build_deg", "toolface_step_deg", "dwell_s", "move_s", "vibration_mps2",
  /// "faults": ["a2:stuck=0V@station6"], "requests": ["64s reset a2 key 1"]}`, all but the axes optional.
  /// Answers `{"samples", "duration_s", "faults": ["a2 stands at 0 V ..."]}` or a refusal.
  std::string begin(const std::string& scene);

  /// Steps at most so many samples and keeps a record of each; 0 at the end.
  int run(int samples);

  /// Of all samples stepped, one after the other: as many numbers each as `record_names` has.
  const std::vector<double>& records() const noexcept { return records_; }

  /// FNV-1a over every field of every verdict, bit for bit.
  std::uint64_t digest() const noexcept { return digest_; }

 private:
  void record(const plumb::Sample& sample);

  std::unique_ptr<plumb::MonitorSetup> setup_;
  std::unique_ptr<plumb::HealthMonitor> monitor_;
  std::unique_ptr<plumb::scenario::Simulator> simulator_;
  plumb::scenario::Host host_;
  plumb::Mat3 turn_{};  ///< from the frame of the housing into that of the nominal axes
  std::vector<double> records_;
  std::uint64_t digest_ = 0;
};

/// What stands where in a record.
const std::vector<std::string>& record_names();

}  // namespace plumb_web
