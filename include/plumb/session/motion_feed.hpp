/// From the rows of a log to the samples that a monitor of motion judges: the rows themselves, or, where chips have
/// clocks of their own, the common instants that `MotionClocks` makes of what these have delivered.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "plumb/session/motion_inputs.hpp"
#include "plumb/session/motion_plan.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// What became of the samples of one clock. Times are those of rows.
struct ClockRun {
  std::string name;
  MotionClock clock;
  double wait_s = 0.0;
  bool of_the_log = false;    ///< that of what no [[clock]] names
  std::uint64_t samples = 0;  ///< delivered, whatever became of them
  std::uint64_t anew = 0;     ///< of them those before which one was missing, or the clock had jumped
  std::uint64_t early = 0;    ///< too early after the one before
  std::uint64_t not_valid = 0;
  double first_anew_s = 0.0, first_early_s = 0.0, first_not_valid_s = 0.0;
  std::uint64_t instants = 0;  ///< common ones
  std::uint64_t absent = 0;    ///< of them those for which it had nothing
  std::uint64_t steps = 0;     ///< forward, of at most a second
  double step_sum_s = 0.0;
  double late_sum_s = 0.0;  ///< from a sample, by the stated clock, to its row

  double mean_step_s() const noexcept { return steps > 0 ? step_sum_s / static_cast<double>(steps) : 0.0; }
  double mean_late_s() const noexcept { return samples > 0 ? late_sum_s / static_cast<double>(samples) : 0.0; }
};

class MotionFeed {
 public:
  /// `plan` outlives it, and is one of `plan_motion`.
  explicit MotionFeed(const MotionPlan& plan);

  bool has_clocks() const noexcept { return clocks_ != nullptr; }
  /// [[clock]] tables: as many times a row.
  std::size_t stated() const noexcept { return plan_.clocks ? plan_.clocks->stated : 0; }
  /// A row of the log, by its own time. `clock_s`: `stated` times by the clocks of the chips, NaN where the chip has
  /// delivered nothing; not looked at without clocks. A chip has delivered where its time is another one than before,
  /// and any of its cells is filled.
  void take(const MotionSample& row, const double* clock_s) noexcept;
  /// What is to be judged by now, in order; false: wait for the next row.
  bool next(MotionSample& out) noexcept;

  const std::vector<ClockRun>& clocks() const noexcept { return runs_; }
  /// Of the rates as they were delivered, with clocks.
  const RateInputs& rates(std::size_t gyro) const noexcept { return rates_[gyro].found().gyro[gyro]; }

 private:
  void push(std::size_t clock, double time_s, const MotionSample& row) noexcept;
  bool delivered(const MotionClock& clock, const MotionSample& row) const noexcept;

  const MotionPlan& plan_;
  std::unique_ptr<MotionClocks> clocks_;
  std::vector<ClockRun> runs_;
  std::vector<double> last_s_;  ///< by the clock, of its last sample; NaN: none yet
  std::array<MotionInputsWatch, kGyros> rates_;
  MotionSample row_;  ///< without clocks: the one to be judged
  bool pending_ = false;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
