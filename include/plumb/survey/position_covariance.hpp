/// How far the position of each station may be off, from the errors of inclinations and azimuths along the hole.
///
/// After the ISCWSA's way of adding errors (Williamson, SPE 67616, section "Propagation"): what the tool carries from
/// station to station moves all of them together and is summed as a vector before it is squared; what is drawn anew at
/// each station is squared first. With p_K the position at station K (minimum curvature), t_k the tangents and a_k =
/// (inclination, azimuth):
///   C_K = G P G' + d d' s^2 + sum_k H_k R_k H_k'
///   G = sum_k H_k J_k W_k,  d = sum_k of the azimuth's column of H_k,  H_k = dp_K/dt_k dt_k/da_k
/// P is the covariance of the tool's terms (terms.hpp), J_k W_k what a_k changes with each, s the common sigma of the
/// declination, R_k the covariance of a_k from noise and from what of the declination is drawn anew.
#pragma once

#include <array>
#include <vector>

#include "plumb/survey/path.hpp"
#include "plumb/survey/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// Row-major 12 x 12 covariance of the terms.
using TermCovariance = std::array<double, kTermCount * kTermCount>;
/// Independent terms of these stated sizes.
TermCovariance stated_covariance(const ToolErrors& tool) noexcept;

/// A station of the path with the errors of its direction.
struct PathStationErrors {
  PathStation station;
  std::array<double, 2 * kTermCount> per_term{};  ///< row-major 2 x 12: inclination, azimuth [rad] by each term
  std::array<double, 4> random_rad2{};            ///< of (inclination, azimuth), drawn anew at each station
  /// Of a station that is taken to be vertical, instead: how far its direction may be from vertical, to either side.
  double tilt_sigma_rad = 0.0;
};

/// Errors of a station as it was judged. `north`: that of its azimuth on the path, whose declination it takes part in.
PathStationErrors path_errors(const SurveyStation& judged, North north);

/// Row-major 3 x 3 of (north, east, down) [m^2].
using PositionCovariance = std::array<double, 9>;

/// One a station; the first is the origin, and exact. Stations that are taken to be vertical err all to one side, to
/// north and to east alike: their azimuths are not known, and so it is never too small for them.
/// Not in it: errors of the measured depth, sag, bounds of biases (`Measurement::bias_bound`), the convergence.
/// The stations are those that `minimum_curvature` has laid out: what it refuses is not checked once more.
std::vector<PositionCovariance> position_covariances(const std::vector<PathStationErrors>& stations,
                                                     const TermCovariance& terms, double declination_sigma_rad);

/// How the position of the second of two stations changes with the tangents of the first and of the second, row-major
/// 3 x 3 [m]. Of a dogleg below 180 degrees.
struct StepDerivatives {
  std::array<double, 9> by_first{}, by_second{};
};
StepDerivatives step_derivatives(const Vec3& first, const Vec3& second, double length_m) noexcept;

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
