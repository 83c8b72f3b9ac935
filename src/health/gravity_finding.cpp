// What the length being off means, and what is done about it.
#include <cmath>

#include "block_view.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

/// The study takes attitudes that differ by this many excitation angles: neighbours tell it nothing new.
constexpr double kStudyAngles = 2.0;

}  // namespace

/// While the tool is trusted, too, and the length within its limit: an offset that no single block shows is seen at
/// many attitudes. Then the attitudes on record are those of one length; with the first that is not of it, gravity has
/// changed, and the study begins anew.
void HealthMonitor::study_reference(const BlockView& view) noexcept {
  using Kind = BlockView::Kind;
  const SensorSet used = in_service_ & evidence_.usable;
  const bool trusted = view.kind == Kind::clean && mode_ != Mode::suspect && mode_ != Mode::recalibrating;
  const bool off = view.kind == Kind::reference;
  bool news = !trusted || told_reference_ != ReferenceKind::none;
  if (view.kind == Kind::alarm || view.used.parity_rows < 1) {
    reference_study_.clear();
  } else if (trusted || off || !reference_study_.empty()) {
    // Reject, not alarm: as wide as what latches, for the finding is believed for long. Without the gravity term, which
    // is alike at every attitude and part of what is looked for.
    const double sigma = view.used.norm_sigma_mps2 / std::sqrt(evidence_.samples);
    double bound = view.used.norm_reject_limit(limits_) * sigma - TestLimits::gravity * gravity_.sigma_mps2;
    // There the limit counts in sigmas of noise and calibration together, and not all of the acceleration is left in
    // it.
    if (config_.alarm_form == AlarmForm::average_tool) bound += limits_.acceleration_mps2;
    const bool one_length = reference_study_.agrees(view.used.norm_error_mps2, bound);
    if (!one_length && (trusted || told_reference_ == ReferenceKind::none)) reference_study_.clear();
    if (used == in_service_ &&
        reference_study_.add(view.used.x_mps2, view.used.norm_error_mps2, bound,
                             kStudyAngles * config_.excitation_angle_rad, limits_.reject[1] * sigma)) {
      news = true;
    }
  }
  if (news && !(gravity_widened_mps2_ > 0.0)) tell_reference(trusted);
}

/// A finding stands until the host states another gravity: widened by it, no block shows the offset any more.
void HealthMonitor::tell_reference(bool trusted) noexcept {
  // An acceleration that was allowed for turns the direction whatever the length says.
  const double turn_rad = acceleration_turn_rad(gravity_, limits_.acceleration_mps2);
  const double stated_mps2 = TestLimits::gravity * gravity_.sigma_mps2;
  ReferenceFinding found = reference_study_.find(gravity_.g_mps2, stated_mps2, config_.alert_limit_rad - turn_rad);
  // Within its limit the length is not in doubt: only what lies beyond the stated gravity for certain is told.
  const bool beyond = std::fabs(found.length_mps2) > stated_mps2 + found.length_bound_mps2;
  if (trusted && !(found.kind == ReferenceKind::common_scale && beyond)) found = ReferenceFinding{};
  if (found.turn_rad > 0.0) found.turn_rad += turn_rad;
  const bool told = found.kind == ReferenceKind::common_scale || found.kind == ReferenceKind::common_bias;
  if (told && found.kind != told_reference_) reference_notice_ = found.kind;
  told_reference_ = found.kind;
  found.bias_mps2 = times(frame_, found.bias_mps2);
  verdict_.reference = found;
  if (found.kind == ReferenceKind::common_scale) widen_gravity(found);
}

/// Takes gravity to be known no better than the offset that every sensor of the array vouches for. Only ever wider: no
/// explanation dies of it. Not while a sensor is doubted, and not where the offset may be an acceleration.
void HealthMonitor::widen_gravity(const ReferenceFinding& found) noexcept {
  const bool vouched = in_service_ == array_.all() && !partial_ && !episode_.open && noisy_.empty();
  const double most_mps2 = std::fabs(found.length_mps2) + found.length_bound_mps2;
  if (!vouched || limits_.acceleration_mps2 > 0.0 || !(most_mps2 <= kMostGravityOffset_mps2)) return;
  const double stated_mps2 = TestLimits::gravity * gravity_.sigma_mps2;
  gravity_widened_mps2_ = std::fabs(found.length_mps2) + std::fmax(0.0, found.length_bound_mps2 - stated_mps2);
  gravity_.sigma_mps2 += gravity_widened_mps2_ / TestLimits::gravity;
  verdict_.reference.widened_mps2 = gravity_widened_mps2_;
  forget_near();
}

}  // namespace PLUMB_ABI
}  // namespace plumb
