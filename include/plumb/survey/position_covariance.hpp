/// How far the position of each station may be off, from the errors of inclinations and azimuths along the hole.
///
/// After the ISCWSA's way of adding errors (Williamson, SPE 67616, section "Propagation"): what the tool carries from
/// station to station moves all of them together and is summed as a vector before it is squared; what is drawn anew at
/// each station is squared first. With p_K the position at station K (minimum curvature), t_k the tangents and a_k =
/// (inclination, azimuth):
///   C_K = G P G' + d d' s^2 + h h' v^2 + l l' c^2 + m m' q^2 + sum_k H_k R_k H_k'
///   G = sum_k H_k J_k W_k,  d = sum_k of the azimuth's column of H_k,  H_k = dp_K/dt_k dt_k/da_k
///   h = sum_k sin I_k times the inclination's column of H_k,  l = sum_k dp_K/dMD_k,  m = sum_k MD_k dp_K/dMD_k
/// P is the covariance of what the tool carries (its terms, and the rotation of its magnetometers), J_k W_k what a_k
/// changes with each, s the common sigma of the declination, v that of the sag, c and q those of the measured depth,
/// R_k the covariance of a_k from noise and from what of the declination is drawn anew.
#pragma once

#include <array>
#include <vector>

#include "plumb/survey/joint_alignment.hpp"
#include "plumb/survey/path.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// Row-major 15 x 15: covariance of a further small rotation of the magnetometers about x, y and z of the tool frame
/// [rad] and of the terms, as `JointAlignment::covariance`.
using CarriedCovariance = std::array<double, kAlignmentUnknowns * kAlignmentUnknowns>;
/// Independent terms of these stated sizes, no rotation.
CarriedCovariance carried_covariance(const ToolErrors& tool) noexcept;
/// What an estimate of the terms leaves, no rotation.
CarriedCovariance carried_covariance(const Estimate& estimate) noexcept;
/// What a station changes with the terms, no rotation.
CarriedWeights carried_weights(const Measurement& station) noexcept;

/// A station of the path with the errors of its direction.
struct PathStationErrors {
  PathStation station;
  std::array<double, 2 * kAlignmentUnknowns> carried{};  ///< row-major 2 x 15: inclination, azimuth [rad] by each
  std::array<double, 4> random_rad2{};                   ///< of (inclination, azimuth), drawn anew at each station
  /// Of a station that is taken to be vertical, instead: how far its direction may be from vertical, to either side.
  double tilt_sigma_rad = 0.0;
};

/// Errors of a station as it was judged. `north`: that of its azimuth on the path, whose declination it takes part in.
/// `weights`: what the six components of the judged station change with what the tool carries, by `carried_weights`, or
/// by `alignment_weights` of a station that was aligned.
PathStationErrors path_errors(const SurveyStation& judged, North north, const CarriedWeights& weights);

/// What is wrong at all stations of a survey alike; 1 sigma each.
struct CommonErrors {
  CarriedCovariance carried{};
  double declination_sigma_rad = 0.0;
  double sag_sigma_rad = 0.0;      ///< of the inclination in a horizontal hole; at I it times sin I (SAG of the ISCWSA)
  double depth_sigma_m = 0.0;      ///< of the measured depth, of all stations but the first (DREF)
  double depth_scale_sigma = 0.0;  ///< the same in proportion to the measured depth, of 1 (DSF)
};

/// Row-major 3 x 3 of (north, east, down) [m^2].
using PositionCovariance = std::array<double, 9>;

/// One a station; the first is the origin, and exact. Stations that are taken to be vertical err all to one side, to
/// north and to east alike: their azimuths are not known, and so it is never too small for them.
/// The depth of the first is exact as its position is: an error of depth in proportion moves the second station by its
/// own depth times that, however near the first it is.
/// Not in it: bounds of biases (`Measurement::bias_bound`), the convergence, depths that are wrong at random.
/// The stations are those that `minimum_curvature` has laid out: what it refuses is not checked once more.
std::vector<PositionCovariance> position_covariances(const std::vector<PathStationErrors>& stations,
                                                     const CommonErrors& common);

/// How the position of the second of two stations changes with the tangents of the first and of the second, row-major
/// 3 x 3 [m], and with the length between them. Of a dogleg below 180 degrees.
struct StepDerivatives {
  std::array<double, 9> by_first{}, by_second{};
  Vec3 by_length{};
};
StepDerivatives step_derivatives(const Vec3& first, const Vec3& second, double length_m) noexcept;

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
