/// The inner loop of `plumb monitor`: steps a monitor over rows of a log and hands back the verdicts that somebody
/// wants. Built once per capacity, so that four sensors are stepped by the monitor for four; nothing here depends on a
/// capacity (private to this module).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace plumb {
namespace stepping {

/// Of which rows somebody wants the verdict; of the first row of a run always.
enum class Wanted : std::uint8_t { changes, blocks, samples };

struct Row {
  double time_s;
  double temperature_degc;
  std::uint32_t delivered;  ///< bits of the sensors
  std::uint32_t station, count, roll_group;
};

struct Turn {
  bool turning, rate_known;
  std::array<double, 3> rate_radps;
};

/// What a monitor in motion has found by a row.
struct Found {
  bool alarm = false;
  std::uint32_t excluded = 0;  ///< bits of the sensors
};

/// Rows one after the other, as the log has them.
struct Rows {
  int sensors = 0;
  int clocks = 0;  ///< of chips that have their own
  std::vector<Row> row;
  std::vector<double> raw;        ///< `sensors` of them a row
  std::vector<Turn> turn;         ///< one a row where the log says how the tool turns, else none
  std::vector<Turn> second_turn;  ///< likewise, by the second gyro
  std::vector<double> depth_m;    ///< likewise
  std::vector<double> clock_s;    ///< `clocks` of them a row; NaN: the chip has delivered nothing
  std::vector<Found> found;       ///< one a row where a monitor in motion runs beside, else none

  const double* raw_of(std::size_t k) const noexcept { return raw.data() + k * static_cast<std::size_t>(sensors); }
  void resize(std::size_t count, bool turns, bool has_depth, bool turns_twice = false) {
    row.resize(count);
    raw.resize(count * static_cast<std::size_t>(sensors));
    turn.resize(turns ? count : 0);
    second_turn.resize(turns_twice ? count : 0);
    depth_m.resize(has_depth ? count : 0);
    clock_s.resize(count * static_cast<std::size_t>(clocks));
  }
};

/// What a run showed of one sensor.
struct SensorCounts {
  bool excluded_by_reading = false;     ///< for good or provisionally, for what it read beside the others
  bool named_noisy = false;             ///< an event excluded it provisionally for its own scatter
  std::uint64_t scattering_blocks = 0;  ///< blocks at rest in which it scattered by itself
  double scatter_raw_sq = 0.0;          ///< the sum of its variances in those
  std::uint64_t full_scale_at_rest = 0, full_scale_in_motion = 0;  ///< rows
};

/// What no verdict holds, over the whole run; by the plumb monitor only.
struct RunCounts {
  bool known = false;
  bool length_off_after_exclusion = false;  ///< the sensors left agree with each other and not with gravity
  std::uint64_t blocks_in_motion = 0;       ///< those in which the tool turned at an unknown rate among them
  std::vector<SensorCounts> sensor;
};

/// What the monitor said to these rows.
struct Said {
  std::uint64_t blocks = 0, changes = 0;
  std::vector<std::size_t> row;     ///< whose verdict is wanted, in order
  std::vector<std::uint8_t> bytes;  ///< these verdicts, packed (packed.hpp)
  RunCounts counts;                 ///< of all rows of the run so far

  void clear() noexcept {
    blocks = changes = 0;
    row.clear();
    bytes.clear();
  }
};

class Stepper {
 public:
  Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;
  virtual ~Stepper() = default;

  /// `first`: these rows begin the run. What `said` held before is gone, but for the counts of a run that goes on.
  virtual void step(const Rows& rows, bool first, Wanted wanted, Said& said) = 0;
  /// What the monitor says now, packed.
  virtual void now(std::vector<std::uint8_t>& bytes) const = 0;
  virtual int capacity() const noexcept = 0;
};

/// A monitor of the smallest build of this program for so many sensors and such a window, and of `least_capacity` at
/// least, configured with a packed setup that another build has accepted; null where there is none. What is said must
/// not depend on which it is.
std::unique_ptr<Stepper> make_stepper(const std::vector<std::uint8_t>& setup, int sensors, int window,
                                      int least_capacity = 0);

/// Capacities that this program was built with, in rising order.
const std::vector<int>& stepper_capacities();

}  // namespace stepping
}  // namespace plumb
