/// What the page asks of the core, as text in and text out: the same functions in WebAssembly and, for the tests,
/// native.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plumb/scenario/scenario.hpp"

#include "plumb/array/named.hpp"
#include "records.hpp"

namespace plumb_web {

/// A JSON object with `error`: what was found, and how to mend it.
std::string refusal(const std::string& text);

/// States, events, causes and validities by number, the state machine's table, the fault catalogue, the paper's Table 2
/// and the names of the figures of a record.
std::string vocabulary();

/// The axes of a built-in geometry, as `plumb geometry --name` has it: a JSON array, or a refusal.
std::string builtin_axes(const std::string& name);

/// `{"name", "axes": [[x,y,z],...], "chips": [1,1,1,2,2,2], "noise_mps2", "samples"}` -> what `plumb geometry --json`
/// prints of these sensors, and `motion_grade`: how many faulty units are isolated in motion, null where there are too
/// many sensors to be judged there. With "map": true the map over all attitudes stands behind it, as `map`.
std::string study(const std::string& design);

class StationRun;
class FlightRun;

/// A tool in a scenario, the monitor that watches it, and other rules on the same samples.
class Play {
 public:
  Play();
  ~Play();
  Play(const Play&) = delete;
  Play& operator=(const Play&) = delete;

  /// Calibrates the tool on its stand and configures the monitors. `{"axes", "chips", "noise_mps2", "truth_seed",
  /// "stand_seed", "seed", "motion": "stations" | "roll" | "drone" | "drilling" | "car" | "launch", "stations",
  /// "inclination_deg", "build_deg", "toolface_step_deg", "dwell_s", "move_s", "vibration_mps2", "duration_s",
  /// "faults": ["a2:stuck=0V@station6"], "requests": ["64s reset a2 key 1"]}`, all but the axes optional. A flight
  /// has no stations, requests or stand: its sensors are calibrated but for what a data sheet allows.
  /// Answers `{"samples", "duration_s", "stations", "paper_absent": "why the paper's rule is not there", "faults":
  /// ["a2 stands at 0 V ..."], "px4_units": [7, 56]}` or a refusal.
  std::string begin(const std::string& scene);

  /// Steps at most so many samples and keeps a record of each; 0 at the end.
  int run(int samples);

  /// The scene that began last as files for the tool, by name: `array.toml`, and of a run from station to station
  /// `stand.toml` and `run.toml`; `play.sh` plays them and says the same verdicts. Or a refusal.
  std::string files() const;

  /// Of all samples stepped, one after the other: as many numbers each as `record_names` has.
  const std::vector<double>& records() const noexcept { return records_; }

  /// FNV-1a over every field of every verdict and over whom PX4 blames, bit for bit. Not of the paper's monitor, whose
  /// fit ends where rounding has it; what that decided is in `decisions`.
  std::uint64_t digest() const noexcept;
  /// Over what was decided at every sample (`decisions_of`).
  std::uint64_t decisions() const { return decisions_of(records_); }

 private:
  std::string begin_stations(const nlohmann::json& scene, const plumb::AxisList& axes, int n);
  std::string begin_flight(const nlohmann::json& scene, const plumb::AxisList& axes, int n);

  /// Of a run from station to station; null of a flight.
  const plumb::scenario::Simulator* world() const noexcept;

  std::unique_ptr<StationRun> stations_;
  std::unique_ptr<FlightRun> flight_;
  std::uint64_t stand_seed_ = 1;
  std::vector<std::string> requests_;
  std::vector<double> records_;
};

}  // namespace plumb_web
