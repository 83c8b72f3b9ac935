/// One station of a survey as the sensors give it, and what is known of their errors.
#pragma once

#include <array>
#include <cstddef>

#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// Row-major covariance of (Gx, Gy, Gz [m/s^2], Bx, By, Bz [tesla]).
using Covariance6 = std::array<double, 36>;
using Vec6 = std::array<double, 6>;

/// Tool axes: right-handed, z down the hole, x and y across, toolface counted from y (ISCWSA; Williamson, SPE 67616).
struct Measurement {
  double md_m = 0.0;    ///< measured depth along the hole
  Vec3 gravity_mps2{};  ///< positive where the axis points down: minus the specific force
  Vec3 field_tesla{};
  Covariance6 random{};  ///< drawn anew at every station: noise of the means, resolution
  Vec6 bias_bound{};     ///< no error of a component is larger than this beside its distribution; 0: none stated
};

constexpr Vec3 gravity_of_specific_force(const Vec3& f_mps2) noexcept { return scaled(f_mps2, -1.0); }

/// Six independent components.
Covariance6 independent_covariance(double gravity_sigma_mps2, double field_sigma_tesla) noexcept;

/// 1-sigma of what one tool carries from station to station, alike and independent on every axis.
struct ToolErrors {
  double accelerometer_bias_mps2 = 0.0;
  double accelerometer_scale = 0.0;  ///< of 1
  double magnetometer_bias_tesla = 0.0;
  double magnetometer_scale = 0.0;
  double axial_interference_tesla = 0.0;  ///< of the drill string, on z
};

/// ISCWSA MWD revision 5 for a tool without axial correction: accelerometers 0.004 m/s^2 and 0.0005, magnetometers
/// 70 nT and 0.0016, axial interference 220 nT (AB, AS, MB, MS and AMIL of OWSG's set A, revision 5.1, 8 October 2020).
constexpr ToolErrors iscwsa_tool() noexcept { return {0.004, 0.0005, 70e-9, 0.0016, 220e-9}; }

/// The random covariance with the tool's errors added: what one station by itself has to allow for.
Covariance6 total_covariance(const Measurement& station, const ToolErrors& tool) noexcept;

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
