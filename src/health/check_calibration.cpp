// Whether the calibration keeps its word: before it is believed nobody is convicted by it.
#include "block_view.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// One attitude more. With it the calibration may be believed, or contradicted (true): then what was held against
/// single sensors is forgotten, for it rested on limits that do not hold, and the bound of this block rests on them,
/// too.
[[gnu::noinline]] bool HealthMonitor::check_calibration(const BlockView& view) noexcept {
  const int grade = isolation_.strict_grade();
  if (grade < 1) return false;  // three sensors: what is wrong with one is wrong with all
  if (!check_.open() || check_.refused() || owes_calibration() || mode_ == Mode::failed) return false;
  check_.count(view.kind == BlockView::Kind::clean);
  if (!check_.add(station_.direction, evidence_, config_.excitation_angle_rad)) return false;
  const CalibrationCheck::Terms terms{array_, gravity_, limits_};
  const SensorSet posed = isolation_.posed();
  if (!episode_.open) check_.corroborate(terms, posed);
  if (!check_.open() || !check_.contradict(terms, posed, grade)) return false;
  forget_episode();
  clean_run_ = 0;
  verdict_.calibration = check_.finding();
  calibration_notice_ = true;
  return true;
}

/// Until the calibration is believed a sensor is convicted only if the others agree at every attitude on record; once
/// it has been contradicted, by no evidence: that rests on what was learned a moment ago.
bool HealthMonitor::may_convict(SensorSet culprits) const noexcept {
  if (!check_.open()) return true;
  return !check_.finding().contradicted && check_.vouches({array_, gravity_, limits_}, isolation_.posed() - culprits);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
