/// A flight whose chips sample by clocks of their own: what each has delivered, row by row as a host logs it (private
/// to this module). Clocks are off by what is drawn within their stated bounds.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "plumb/io/log_writer.hpp"
#include "plumb/scenario/flight.hpp"
#include "plumb/scenario/random.hpp"
#include "plumb/session/motion_plan.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

class ClockedFlight {
 public:
  /// A row holds the newest reading of each chip, with the time by its clock; what has no clock is sampled at the
  /// period of `spec`, and has empty cells in the rows between.
  struct Row {
    scenario::FlightSample flown;  ///< at the time of the row; of it readings and rates are those delivered last
    SensorSet delivered;
    std::array<bool, kGyros> rate_given{};
    io::ClockTimes clock_s = io::kNoClockTimes;
  };

  /// `spec` as without clocks; `clocks` of the same array.
  ClockedFlight(const scenario::FlightSpec& spec, const ClockPlan& clocks);
  Row next();

 private:
  /// One clock as it really is.
  struct Chip {
    MotionClock real;
    double start_s = 0.0;      ///< by the clock, of its first sample
    std::uint64_t number = 0;  ///< of its next sample
    bool of_the_log = false;
    bool fresh = false;  ///< a sample is in the row to come

    double stamp_s() const noexcept { return start_s + static_cast<double>(number) * real.sample_period_s; }
    double due_s() const noexcept;
  };
  Chip drawn_chip(const MotionClock& stated, std::size_t number, bool of_the_log) const;
  /// The chip whose next sample comes first before the next row at a whole period; as many as there are chips: none
  /// does.
  std::size_t first_due(double before_s) const noexcept;
  void sample(std::size_t chip, double time_s);
  scenario::FlightSample at(double time_s);
  Row row_at(double time_s);

  scenario::FlightSpec spec_;
  scenario::Flight flight_;                    ///< without noise, at a rate that leaves nothing between its samples
  std::deque<scenario::FlightSample> course_;  ///< of it the newest samples
  std::uint64_t first_ = 0;                    ///< number of the oldest
  std::vector<Chip> chips_;
  Row now_;
  std::uint64_t ticks_ = 0;  ///< rows at whole periods
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
