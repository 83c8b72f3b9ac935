/// A flight of the array of a file, simulated into a log as `plumb simulate --flight` does it. Errors of sensors and
/// gyro, and of clocks of chips, are drawn within the bounds that the file states for motion: it is the tool that the
/// file describes.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/scenario/fault.hpp"
#include "plumb/scenario/flight.hpp"
#include "plumb/scenario/injector.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

class ClockedFlight;
class FlightGyros;

struct FlightRequest {
  scenario::FlightKind kind = scenario::FlightKind::drone;
  double duration_s = 10.0;
  std::uint64_t seed = 1;
  std::vector<scenario::Fault> faults;                     ///< as `plumb inject` takes them
  std::vector<std::vector<scenario::Fault>> group_faults;  ///< likewise, of each group of the array file; empty: none
  const Calibration* calibration = nullptr;  ///< of the sensors that fly, which outlives it; null: the nominal ones
};

/// What of the array file flies. Errors: no lever arms, sensors of different noise, rows that are stations, a rate that
/// the simulator does not fly.
io::FileExpected<scenario::FlightSpec> flight_spec_of(const io::ArrayFile& array, const FlightRequest& request);

class FlightPlay {
 public:
  ~FlightPlay();
  FlightPlay(const FlightPlay&) = delete;
  FlightPlay& operator=(const FlightPlay&) = delete;
  static io::FileExpected<std::unique_ptr<FlightPlay>> make(const io::ArrayFile& array, const FlightRequest& request);

  /// Once, to its end or to Ctrl-C. "-": standard output. `truth_path` may be empty.
  io::FileExpected<void> run(const std::string& log_path, const std::string& truth_path);
  std::uint64_t rows() const noexcept { return rows_; }
  double last_time_s() const noexcept { return last_time_s_; }
  /// Faults that no row has shown, as positions in the list of the request; likewise those of a group of the array
  /// file.
  std::vector<int> without_effect() const { return injector_.without_effect(); }
  std::vector<int> without_effect(std::size_t group) const;

 private:
  FlightPlay(const io::ArrayFile& array, const FlightRequest& request, const scenario::FlightSpec& spec,
             scenario::Injector injector);
  struct Row {
    scenario::FlightSample flown;
    Sample sample;
    io::LogWriter::Notes notes;
  };
  Sample sample_of(const scenario::FlightSample& flown) const;
  Row next();
  /// The readings of the groups at the instant of a row, and the names of those with a fault.
  std::string add_groups(Row& row);

  const io::ArrayFile& array_;
  FlightRequest request_;
  scenario::Flight flight_;
  std::unique_ptr<ClockedFlight> clocked_;  ///< in its place, where chips have clocks of their own
  scenario::Injector injector_;
  std::vector<FlightGyros> groups_;
  std::vector<Sample> group_samples_;
  SensorModel model_;
  double rate_hz_;
  std::uint64_t rows_ = 0;
  double last_time_s_ = 0.0;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
