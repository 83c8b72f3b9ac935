/// `plumb simulate --flight`: the array of a file in motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/scenario/flight.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct FlightOptions {
  std::string kind;  ///< a word of `to_string(FlightKind)`; empty: no flight
  double duration_s = 10.0;
  bool duration_given = false;
  std::string calibration;  ///< of the sensors that fly; empty: the nominal ones
  std::vector<std::string> faults;
};

/// What a log is simulated into, shared with scenarios.
struct FlightFiles {
  std::string array, out, truth;
  std::optional<std::uint64_t> seed;
};

void add_flight_options(const Options& command, FlightOptions& options);
/// Options of flights without --flight.
std::optional<io::FileError> flight_misuse(const FlightOptions& options);
io::ExitCode run_flight(const FlightOptions& options, const FlightFiles& files);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
