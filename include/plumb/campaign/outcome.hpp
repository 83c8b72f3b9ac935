/// What became of one scenario.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/campaign/plan.hpp"

namespace plumb {
namespace campaign {

/// One block, as the monitor published it, against the truth.
struct BlockOutcome {
  double tilt_rad = 0.0;        ///< angle between the published vector and the truth
  double protection_rad = 0.0;  ///< the bound on it, where one was available
  bool bounded = false;         ///< a protection level was available
  bool usable = false;          ///< published as valid or degraded
  bool alert = true;
  bool alarmed = false;  ///< this block or one before it raised an alarm
};

struct Outcome {
  int blocks = 0;
  int first_fault_block = -1;  ///< the block in which the first fault begins; -1 = none does
  int alarm_block = -1;        ///< the first with an alarm of whatever kind; -1 = none had one
  int isolated_block = -1;     ///< from it on exactly the faulty are out
  std::uint32_t faulty = 0;    ///< bits of sensors, these and the following
  std::uint32_t excluded = 0;  ///< at the end, lost ones included
  std::uint32_t provisionally_excluded = 0;
  std::uint32_t ever_excluded = 0, ever_provisionally_excluded = 0;
  bool failed = false;  ///< the monitor ended in `failed`
  std::array<BlockOutcome, kMostBlocks> block{};

  bool detected() const noexcept { return first_fault_block >= 0 && alarm_block >= first_fault_block; }
  bool false_alarm() const noexcept {
    return alarm_block >= 0 && (first_fault_block < 0 || alarm_block < first_fault_block);
  }
  bool wrong_exclusion() const noexcept { return (ever_excluded & ~faulty) != 0; }
  bool wrong_provisional_exclusion() const noexcept { return (ever_provisionally_excluded & ~faulty) != 0; }
  /// Error above the alert limit without an alert, while published as usable.
  bool misleading(double alert_limit_rad) const noexcept;
  /// Error above the protection level, while published as usable.
  bool beyond_protection() const noexcept;
};

}  // namespace campaign
}  // namespace plumb
