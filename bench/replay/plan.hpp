// What a generated case is made of, before it is played.
#pragma once

#include "corpus.hpp"
#include "draws.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

struct Plan {
  Situation situation = Situation::plain;
  plumb::MonitorSetup setup;
  plumb::scenario::Scenario scenario;
  bool has_other = false;  ///< another fit of the same tool
  plumb::SensorModel other_model;
  plumb::SensorArray other_array;
  int samples_per_row = 1;    ///< more: a row is a mean
  bool power_cycles = false;  ///< now and then, beside the situation
  plumb::Vec3 push_mps2{};    ///< steady acceleration of the tool in some stations
};

/// A datasheet of n sensors on one of the built-in geometries, or anywhere.
plumb::Datasheet draw_datasheet(int n, Draws& draws);
/// Means of tagged stations of 16 samples at random attitudes.
std::vector<plumb::Station> draw_stations(const plumb::scenario::Tool& tool, int stations, std::uint64_t seed);

/// False where the case cannot be made.
bool make_plan(const CaseNumber& number, Draws& draws, Coverage& coverage, Plan& plan);

}  // namespace PLUMB_ABI
}  // namespace plumb_replay
