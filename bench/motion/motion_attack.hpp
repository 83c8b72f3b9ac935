/// One flight against an adversary: up to as many units as a monitor of motion is promised for read whatever serves to
/// have a healthy sensor blamed, or a force taken for better than it is.
#pragma once

#include <string>

#include "motion_lies.hpp"

namespace plumb_bench {

/// Who attacks.
enum class AttackKind : std::uint8_t {
  sensors,   ///< accelerometers alone
  gyro,      ///< a gyro alone: the only one, or one of two
  both,      ///< accelerometers and one of two gyros, or the only gyro in the place of a unit
  adaptive,  ///< any of these, and it copies the monitor and tries what it will read next on the copy
};
inline constexpr int kAttackKinds = 4;
const char* to_string(AttackKind kind) noexcept;

struct AttackOutcome {
  std::string scene;    ///< in words
  int units_lying = 0;  ///< of the sensors; isolation of one is promised where this is not beyond the grade
  bool alarm = false;
  bool isolated = false;      ///< a liar
  bool blamed = false;        ///< a healthy sensor isolated or excluded
  bool false_alarm = false;   ///< before the attack began, or gyros said to disagree of which none lies
  double blamed_at_s = -1.0;  ///< the first time
  double passed_at_s = -1.0;  ///< the first time that a bound was passed
  BoundTally sample, block;   ///< where the bound is promised
};

/// Everything follows from the number. `more_units`: so many units more lie than are promised for.
AttackOutcome attack(AttackKind kind, std::uint64_t number, int more_units = 0);

}  // namespace plumb_bench
