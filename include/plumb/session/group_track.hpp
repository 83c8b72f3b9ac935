/// What one group of sensors measured while the tool stood still, kept for the checks between groups.
#pragma once

#include <vector>

#include "plumb/session/monitor_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// At the end of a block at rest.
struct TrackPoint {
  double time_s = 0.0;
  bool usable = false;     ///< the direction may be used, and its error has a bound
  Vec3 vector{};           ///< tool frame; the length does not matter
  double bound_rad = 0.0;  ///< of the direction in the housing (`Verdict::protection_level_housing_rad`)
};

class GroupTrack : public VerdictSink {
 public:
  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  stepping::Wanted wanted() const override { return stepping::Wanted::blocks; }
  const std::vector<TrackPoint>& points() const noexcept { return points_; }

 private:
  std::vector<TrackPoint> points_;
};

/// The times at rest that a track shows: between two blocks that follow one another without a pause.
class RestTimes {
 public:
  explicit RestTimes(const std::vector<TrackPoint>& track);
  /// Of times that do not decrease from call to call.
  bool at_rest(double time_s) noexcept;

 private:
  struct Span {
    double begin_s, end_s;
  };
  std::vector<Span> spans_;
  std::size_t next_ = 0;
};

/// Gravity and the magnetic field of one tool, held against the dip that is expected where it is.
struct DipCheck {
  int checked = 0;                         ///< blocks in which both directions were usable
  int disagreeing = 0;                     ///< of those: further off than both bounds and the reference allow
  double least_rad = 0.0, most_rad = 0.0;  ///< the dips measured
  double worst_excess_rad = 0.0;           ///< beyond what is allowed
  double widest_allowed_rad = 0.0;
  double first_s = 0.0;  ///< of the first that disagrees
};

/// Standard deviations of the reference that are allowed: two-sided, 1e-5.
inline constexpr double kDipSigmas = 4.42;

/// |asin(g.b) - dip| <= bound of g + bound of b + kDipSigmas sigma, at every block of `field` with one of `gravity`
/// within `together_s`.
DipCheck check_dip(const std::vector<TrackPoint>& gravity, const std::vector<TrackPoint>& field,
                   const io::MagneticReference& reference, double together_s);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
