/// What a log shows of the gyro and the clock that a monitor of motion rests on: whether they can be what the array
/// file says they are.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/motion/motion_setup.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Of one gyro; all of it 0 where the log has no columns for it.
struct RateInputs {
  std::uint64_t rates = 0;    ///< rows with one
  std::uint64_t missing = 0;  ///< rows without
  double first_missing_s = 0.0;
  double largest_radps = 0.0;
  double largest_at_s = 0.0;
  double still_s = 0.0;  ///< longest stretch of rows with one and the same rate, all three numbers
  double still_from_s = 0.0;
  bool still_at_zero = false;  ///< that rate is 0, 0, 0
};

struct MotionInputs {
  std::uint64_t rows = 0;
  /// Steps from row to row, against the stated period.
  std::uint64_t steps_back = 0;       ///< not after the row before
  double first_back_s = 0.0;          ///< time of the first of them
  std::uint64_t steps_irregular = 0;  ///< forward by less than half a period or more than one and a half
  double first_irregular_s = 0.0;
  double mean_step_s = 0.0;        ///< of the regular ones, or of the others where these are more
  bool period_is_another = false;  ///< they are
  double jitter_s = 0.0;           ///< largest difference of a regular one from the period
  std::array<RateInputs, kGyros> gyro{};
};

class MotionInputsWatch {
 public:
  explicit MotionInputsWatch(double period_s) noexcept : period_s_(period_s) {}
  void add(double time_s) noexcept;
  /// Of the row that `add` was called for last.
  void add_rate(std::size_t gyro, bool given, const Vec3& rate_radps) noexcept;
  const MotionInputs& found() const noexcept { return found_; }

 private:
  MotionInputs found_;
  double period_s_;
  double last_s_ = 0.0;
  struct Steps {
    double sum_s = 0.0;
    std::uint64_t count = 0;
  };
  Steps regular_, irregular_;
  std::array<Vec3, kGyros> rate_radps_{};
  std::array<double, kGyros> same_from_s_{};
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
