#include "plumb/health/detail/gravity_finding.hpp"
#include "plumb/detection/estimate_error.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

/// The study takes attitudes that differ by this many excitation angles: neighbours tell it nothing new.
constexpr double kStudyAngles = 2.0;

/// By what the length may be off alike at every attitude: gravity as stated here, and where the array was calibrated.
double stated_gravity_mps2(const InForce& in_force) noexcept {
  const GravityReference& gravity = in_force.gravity;
  return TestLimits::gravity * (gravity.sigma_mps2 + in_force.array.uncertainty().common_scale * gravity.g_mps2);
}

}  // namespace

bool GravityFinding::withdraw() noexcept {
  study_.clear();
  if (!(widened_mps2_ > 0.0)) return false;
  widened_mps2_ = turn_rad_ = 0.0;
  told_ = NormMismatchKind::none;
  return true;
}

/// While the tool is validated, too, and the length within its limit: an offset that no single block shows is seen at
/// many attitudes. Then the attitudes on record are those of one length; with the first that is not of it, gravity has
/// changed, and the study begins anew. True where there is something to be said.
bool GravityFinding::learn(const Terms& terms, const BlockReport& report) noexcept {
  using Kind = BlockReport::Kind;
  const TestLimits& limits = terms.settings.limits;
  const MonitorConfig& config = terms.settings.config;
  const bool off = report.kind == Kind::reference;
  bool news = !terms.trusted || told_ != NormMismatchKind::none;
  if (report.kind == Kind::alarm || report.used.parity_rows < 1) {
    study_.clear();
  } else if (terms.trusted || off || !study_.empty()) {
    // Reject, not alarm: as wide as what latches, for the finding is believed for long. Without the gravity term, which
    // is alike at every attitude and part of what is looked for.
    const double sigma = report.used.norm_sigma_mps2 / std::sqrt(terms.evidence.samples);
    const double stated_mps2 = stated_gravity_mps2(terms.in_force);
    double bound = report.used.norm_reject_limit(limits) * sigma - stated_mps2;
    // There the limit counts in sigmas of noise and calibration together, and not all of the acceleration is left in
    // it.
    if (config.alarm_form == AlarmForm::average_tool) bound += limits.acceleration_mps2;
    const bool one_length = study_.agrees(report.used.norm_error_mps2, bound);
    if (!one_length && (terms.trusted || told_ == NormMismatchKind::none)) study_.clear();
    const bool whole = terms.evidence.usable.contains(terms.in_service);
    if (whole && study_.add(report.used.x_mps2, report.used.norm_error_mps2, bound,
                            kStudyAngles * config.distinct_attitude_angle_rad, limits.reject[1] * sigma)) {
      news = true;
    }
  }
  return news;
}

/// A finding stands until the host states another gravity: widened by it, no block shows the offset any more.
GravityFinding::News GravityFinding::study(const Terms& terms, const BlockReport& report) noexcept {
  const bool news = learn(terms, report);
  return news && !(widened_mps2_ > 0.0) ? tell(terms) : News{};
}

/// Gravity is taken to be known no better than the offset that every sensor of the array corroborates. Only ever wider:
/// it rejects no explanation. Not while a sensor is doubted, and not where the offset may be an acceleration.
GravityFinding::News GravityFinding::tell(const Terms& terms) noexcept {
  const GravityReference& gravity = terms.in_force.gravity;
  const double acceleration_mps2 = terms.settings.limits.acceleration_mps2;
  // An acceleration that was allowed for turns the direction whatever the length says.
  const double turn_rad = acceleration_turn_rad(gravity, acceleration_mps2);
  const double stated_mps2 = stated_gravity_mps2(terms.in_force);
  NormMismatch found = study_.find(gravity.g_mps2, stated_mps2, terms.settings.config.alert_limit_rad - turn_rad);
  // Within its limit the length is not in doubt: only what lies beyond the stated gravity for certain is reported.
  const bool beyond = std::fabs(found.length_mps2) > stated_mps2 + found.length_bound_mps2;
  if (terms.trusted && !(found.kind == NormMismatchKind::common_scale && beyond)) found = NormMismatch{};
  if (found.turn_rad > 0.0) found.turn_rad += turn_rad;
  News news;
  news.told = true;
  const bool certain = found.kind == NormMismatchKind::common_scale || found.kind == NormMismatchKind::common_bias;
  news.noticed = certain && found.kind != told_;
  told_ = found.kind;
  turn_rad_ = found.turn_rad;
  found.bias_mps2 = times(terms.settings.frame, found.bias_mps2);
  const double most_mps2 = std::fabs(found.length_mps2) + found.length_bound_mps2;
  if (found.kind == NormMismatchKind::common_scale && terms.corroborated && !(acceleration_mps2 > 0.0) &&
      most_mps2 <= kMostGravityOffset_mps2) {
    widened_mps2_ = std::fabs(found.length_mps2) + std::fmax(0.0, found.length_bound_mps2 - stated_mps2);
    news.widen_mps2 = found.widened_mps2 = widened_mps2_;
  }
  news.finding = found;
  return news;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
