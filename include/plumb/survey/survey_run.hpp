/// A survey from its first station to its last: judged, corrected where asked for, and laid out as a path.
#pragma once

#include <optional>
#include <vector>

#include "plumb/survey/error_tests.hpp"
#include "plumb/survey/joint_alignment.hpp"
#include "plumb/survey/multi_station.hpp"
#include "plumb/survey/path.hpp"
#include "plumb/survey/position_covariance.hpp"
#include "plumb/survey/saturation.hpp"
#include "plumb/survey/wiring.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// What is stated beside the tool's own errors, 1 sigma of each, for the covariance of positions. 0: not stated, and
/// not allowed for.
struct PathSigmas {
  double sag_rad = 0.0;      ///< as in `CommonErrors`
  double depth_m = 0.0;      ///< the same
  double depth_scale = 0.0;  ///< the same, of 1

  bool any() const noexcept { return sag_rad > 0.0 || depth_m > 0.0 || depth_scale > 0.0; }
};

struct SurveySettings {
  StationSettings station;
  PathSigmas path;
  double integrity_risk = 1e-4;  ///< of the protection levels
  std::optional<North> north;    ///< of the path; none: grid where there is a convergence, else true, else magnetic
  bool correct_axial = false;    ///< estimate the axial interference, and take it off where it could be estimated
  /// 1 sigma that is stated of the magnetometers' alignment: estimate it from the dip, and turn the field by it where
  /// it could be estimated. Axial interference is then an unknown of it, of the tool's stated size: `correct_axial`
  /// does nothing beside it. None: leave the magnetometers as they are.
  std::optional<double> align_within_rad;
};

struct Survey {
  std::vector<SurveyStation> stations;
  double integrity_risk = 0.0;
  North north = North::magnetic;
  WiringStudy wiring;
  std::optional<ErrorTests> tests;  ///< none where they could not be made: `tests_refused`
  std::string tests_refused;
  std::optional<tl::expected<Estimate, EstimateRefusal>> axial;  ///< where asked for; `tests` are those of the readings
  std::optional<tl::expected<JointAlignment, AlignmentRefusal>> alignment;  ///< the same
  /// Numbers of the stations that neither of the two used: their gravity failed as it was read, or another check did
  /// when the estimate of the others was taken off.
  std::vector<std::size_t> left_out;
  /// Positions of the stations that were accepted; the others are left out.
  io::FileExpected<std::vector<PathPoint>> path;
  std::vector<std::size_t> on_path;                     ///< number of the station of each position
  std::vector<PositionCovariance> position_covariance;  ///< of each position
  std::vector<SaturatedChannel> saturated;
  PathSigmas path_sigmas;  ///< that the covariance allows for
};

/// Stations in the order of their depth.
Survey run_survey(const std::vector<ReferencedStation>& stations, const SurveySettings& settings);

/// The azimuth from that north, or why there is none.
OrUndefined<Angle> azimuth_from(const SurveyStation& station, North north);

/// True vertical depth of each station from inclinations alone (the mean of neighbouring cosines), as its references
/// need it before anything is judged; the first lies as deep as it is along the hole.
std::vector<double> depths_m(const std::vector<Measurement>& stations);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
