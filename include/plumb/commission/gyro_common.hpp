/// The 3x3 matrix that motion of gyros alone does not tell (`gyro_fit.hpp`), from gravity's turn between stations at
/// rest: the integral of the rates must carry gravity's direction before a turn to that after it.
#pragma once

#include "plumb/commission/gyro_fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

/// From rest to rest: samples `begin` to `end` of the log, and the direction in which the accelerometers' specific
/// force points at either, frame in which the gyros are to be absolute. Calibrated accelerometers, means over the
/// stations.
struct GravityTurn {
  std::size_t begin = 0;
  std::size_t end = 0;
  Vec3 before{};
  Vec3 after{};
  double sigma_rad = 1e-3;  ///< of the turn: both directions and what biases and noise of the gyros integrate to
};

struct CommonSettings {
  double sigma = 0.005;         ///< a matrix that the turns tell less well in any direction is refused
  double allowed_sigmas = 4.0;  ///< rms of the turns' residuals over their sigma: more is refused
  double largest = 0.2;         ///< entry of the matrix less identity: more is no small correction of nominal axes
};

struct CommonMatrix {
  Mat3 matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< w_absolute = matrix * w_relative
  std::array<double, 81> covariance{};     ///< of its entries, row-major
  double residual_rad = 0.0;               ///< rms angle between gravity as carried and as measured
  int steps = 0;
};

/// dg/dt = -w x g, least squares over the nine entries by Gauss-Newton. A turn tells two numbers, and nothing of a
/// rotation about gravity itself: five turns at least, about axes across gravity, in several attitudes. Refused where
/// biases are not from rest, where samples within a turn are not given, where the turns leave something open (the text
/// names the entry), and where they contradict each other. A delay that all axes share does not matter here. The
/// Earth's rate is in the biases at rest, and turns with the body: up to 7.3e-5 rad/s times the duration of a turn is
/// left.
CommissionExpected<CommonMatrix> fit_common(const GyroLog& log, const GyroFit& fit,
                                            const std::vector<GravityTurn>& turns, const CommonSettings& settings = {});

/// The fit in the absolute frame: rows times the inverse of the matrix, covariances with that of the matrix.
GyroFit with_common(const GyroFit& fit, const CommonMatrix& common);

/// rms angle between gravity as the fit carries it and as measured, on turns of any log. Refused as above.
CommissionExpected<double> turn_residual_rad(const GyroLog& log, const GyroFit& fit,
                                             const std::vector<GravityTurn>& turns);

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
