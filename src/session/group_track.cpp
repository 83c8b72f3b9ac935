#include "plumb/session/group_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// Blocks that are further apart than this, in the shortest distance of two, have a pause between them.
constexpr double kPause = 1.5;

double dip_of(const Vec3& gravity, const Vec3& field) {
  return std::asin(std::clamp(dot(gravity, field) / (norm(gravity) * norm(field)), -1.0, 1.0));
}

}  // namespace

io::FileExpected<void> GroupTrack::take(const Sample&, const Verdict& verdict) {
  if (!verdict.tick) return {};
  const bool usable = verdict.validity >= Validity::degraded && verdict.protection_available && !verdict.alert &&
                      norm(verdict.gravity_mps2) > 0.0;
  points_.push_back({verdict.time_s, usable, verdict.gravity_mps2, verdict.protection_level_housing_rad});
  return {};
}

RestTimes::RestTimes(const std::vector<TrackPoint>& track) {
  double shortest_s = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < track.size(); ++k) {
    const double apart_s = track[k].time_s - track[k - 1].time_s;
    if (apart_s > 0.0) shortest_s = std::fmin(shortest_s, apart_s);
  }
  for (std::size_t k = 1; k < track.size(); ++k) {
    const double begin_s = track[k - 1].time_s, end_s = track[k].time_s;
    if (!(end_s - begin_s <= kPause * shortest_s)) continue;
    if (!spans_.empty() && spans_.back().end_s == begin_s) {
      spans_.back().end_s = end_s;
    } else {
      spans_.push_back({begin_s, end_s});
    }
  }
}

bool RestTimes::at_rest(double time_s) noexcept {
  while (next_ < spans_.size() && spans_[next_].end_s < time_s) ++next_;
  return next_ < spans_.size() && spans_[next_].begin_s < time_s;
}

DipCheck check_dip(const std::vector<TrackPoint>& gravity, const std::vector<TrackPoint>& field,
                   const io::MagneticReference& reference, double together_s) {
  DipCheck out;
  std::size_t at = 0;
  for (const TrackPoint& b : field) {
    while (at + 1 < gravity.size() &&
           std::fabs(gravity[at + 1].time_s - b.time_s) <= std::fabs(gravity[at].time_s - b.time_s))
      ++at;
    if (at >= gravity.size()) break;
    const TrackPoint& g = gravity[at];
    if (!g.usable || !b.usable || !(std::fabs(g.time_s - b.time_s) <= together_s)) continue;
    const double dip_rad = dip_of(g.vector, b.vector);
    const double allowed_rad = g.bound_rad + b.bound_rad + kDipSigmas * reference.dip_sigma_rad;
    const double excess_rad = std::fabs(dip_rad - reference.dip_rad) - allowed_rad;
    out.least_rad = out.checked == 0 ? dip_rad : std::fmin(out.least_rad, dip_rad);
    out.most_rad = out.checked == 0 ? dip_rad : std::fmax(out.most_rad, dip_rad);
    out.widest_allowed_rad = std::fmax(out.widest_allowed_rad, allowed_rad);
    ++out.checked;
    if (!(excess_rad > 0.0)) continue;
    if (out.disagreeing++ == 0) out.first_s = b.time_s;
    out.worst_excess_rad = std::fmax(out.worst_excess_rad, excess_rad);
  }
  return out;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
