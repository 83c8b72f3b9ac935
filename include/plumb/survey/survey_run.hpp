/// A survey from its first station to its last: judged, corrected where asked for, and laid out as a path.
#pragma once

#include <optional>
#include <vector>

#include "plumb/survey/error_tests.hpp"
#include "plumb/survey/multi_station.hpp"
#include "plumb/survey/path.hpp"
#include "plumb/survey/position_covariance.hpp"
#include "plumb/survey/saturation.hpp"
#include "plumb/survey/wiring.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

struct SurveySettings {
  StationSettings station;
  double integrity_risk = 1e-4;  ///< of the protection levels
  std::optional<North> north;    ///< of the path; none: grid where there is a convergence, else true, else magnetic
  bool correct_axial = false;    ///< estimate the axial interference, and take it off where it could be estimated
};

struct Survey {
  std::vector<SurveyStation> stations;
  double integrity_risk = 0.0;
  North north = North::magnetic;
  WiringStudy wiring;
  std::optional<ErrorTests> tests;  ///< none where they could not be made: `tests_refused`
  std::string tests_refused;
  std::optional<tl::expected<Estimate, EstimateRefusal>> axial;  ///< where asked for; `tests` are those of the readings
  /// Positions of the stations that were accepted; the others are left out.
  io::FileExpected<std::vector<PathPoint>> path;
  std::vector<std::size_t> on_path;                     ///< number of the station of each position
  std::vector<PositionCovariance> position_covariance;  ///< of each position
  std::vector<SaturatedChannel> saturated;
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
