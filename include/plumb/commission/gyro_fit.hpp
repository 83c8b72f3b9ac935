/// Redundant gyro axes aligned against each other by what they read in motion: scale, axis, bias, delay and, where
/// specific forces are given, g-sensitivity of every axis.
///
/// Model: y_i(t) = a_i . w(t - tau_i) + b_i + c_i . f(t) + noise, with the rate w unknown at every sample. Least
/// squares over the a_i, b_i, tau_i, c_i and all w: variable projection (Golub and Pereyra 1973) with Kaufman's
/// derivative. For rows alone and equal noise it is total least squares.
///
/// Gyros alone do not tell what changes w in common: A -> A K with any 3x3 matrix K (scale, shear and turn of the whole
/// array), one delay of all axes, C -> C + A L of the g-sensitivities and, without stretches at rest, b -> b + A d.
/// They are pinned by the least change: K by the nominal axes, the mean delay by 0, and A'b = 0, A'C = 0.
/// `gyro_common.hpp` finds K from gravity's turns.
#pragma once

#include "plumb/commission/motion_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

struct GyroNominal {
  Vec3 axis{};                    ///< unit vector in the frame of the array, scale 1
  double noise_radps = 1e-3;      ///< weight of the axis against the others: only ratios count
  double full_scale_radps = 0.0;  ///< a reading that reaches it is saturated; 0: unknown
  std::string id{};               ///< by which refusals name it; empty: they give its number, from 0
};

/// Samples of all axes by their number, at a regular period. A reading that is not finite counts as not given: a row
/// that is missing is one of NaN.
struct GyroLog {
  double period_s = 0.0;
  std::vector<std::vector<double>> rate_radps;  ///< by axis, of equal length
  std::vector<bool> at_rest;                    ///< by sample; empty: no stretch at rest is known
  std::vector<Vec3> force_mps2;                 ///< by sample, frame of the array; empty: not given

  std::size_t samples() const noexcept { return rate_radps.empty() ? 0 : rate_radps.front().size(); }
};

struct GyroFitSettings {
  bool delay = true;
  bool force = false;  ///< g-sensitivity, from `force_mps2`
  int least_samples = 500;
  int least_rest = 100;  ///< samples at rest that biases are taken from
  /// rms rate about the least turned direction over that about the most: below, rows off nominal pretend as much.
  double least_ratio = 0.05;
  double row_sigma = 0.005;      ///< a motion that tells rows less well is refused
  double delay_sigma_s = 0.001;  ///< so is one that tells delays less well
  double delay_limit_s = 0.02;   ///< and a delay beyond this
  double force_sigma = 1e-4;     ///< rad/s per m/s^2
  double bias_sigma_radps = 0.01;
};

struct FittedGyro {
  Vec3 row{};               ///< scale times axis
  double bias_radps = 0.0;  ///< from rest it includes the Earth's rate, 7.3e-5 rad/s
  double delay_s = 0.0;     ///< positive: this axis reads later than the mean of all
  Vec3 per_force{};         ///< rad/s per m/s^2
  Mat3 row_covariance{};    ///< of what is told: the common matrix is held at its pin
  double bias_sigma_radps = 0.0;
  double delay_sigma_s = 0.0;
  Vec3 per_force_sigma{};
};

/// rms of what a reading differs by from that of the common rate, in single samples and in means of `kGyroBlock`.
inline constexpr int kGyroBlock = 32;
struct GyroResidual {
  double sample_radps = 0.0;
  double block_radps = 0.0;
  int samples = 0;
  int blocks = 0;
};

struct GyroFit {
  std::vector<FittedGyro> axis;
  std::vector<GyroNominal> nominal;
  bool bias_from_rest = false;
  bool absolute = false;  ///< the common matrix is found (`with_common`), not pinned
  int least_rest = 100;
  int steps = 0;
  GyroResidual residual;
};

/// At least four axes; axes of which three span space. Covariances are scaled by what the fit leaves, in samples or, if
/// that is more than white noise leaves, in blocks. Refused where the log has too few samples or axes at full scale,
/// where the body turned too little about an axis, where a parameter stays open, and where the steps do not settle: the
/// text names what, and what to do.
CommissionExpected<GyroFit> fit_gyros(const GyroLog& log, const std::vector<GyroNominal>& nominal,
                                      const GyroFitSettings& settings = {});

/// The same fit held against any log, one that it has not seen above all: among samples (blocks) whose rate (mean rate)
/// is at least `above_radps`. Biases are those of the log's own stretches at rest where it has enough. All zero where
/// no sample qualifies or the log has another number of axes.
GyroResidual gyro_residual(const GyroLog& log, const GyroFit& fit, double above_radps = 0.0);

/// The common rate at every sample, frame of the array: least squares over all axes. NaN where an axis is not given or
/// is saturated. Empty where the log has another number of axes than the fit.
std::vector<Vec3> common_rates(const GyroLog& log, const GyroFit& fit);

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
