/// The parts of the forward fit. Private to the calibration room.
///
/// Two coordinates are used. *Natural*: per sensor W (3) and b [m/s^2], r = W g + b. *Prior units* x:
/// natural = datasheet + S x with S S' the prior covariance, so that the prior is |x|^2 / 2, information
/// can be compared between parameters of different units, and a prior sigma of zero freezes a parameter.
#pragma once

#include <array>
#include <cstddef>

#include "plumb/calibration/calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {

using Parameters = std::array<double, kFitParameters>;

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// Eqs (1) and (2): c0 + c1 t + c2 t^2 + c3 t^3.
inline double cubic(const std::array<double, 4>& c, double t) noexcept {
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

/// Symmetric 3x3 matrix: xx, xy, xz, yy, yz, zz.
using Symmetric3 = std::array<double, 6>;

inline Vec3 times(const Symmetric3& m, const Vec3& v) noexcept {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[1] * v[0] + m[3] * v[1] + m[4] * v[2],
          m[2] * v[0] + m[4] * v[1] + m[5] * v[2]};
}

inline void add_outer(Symmetric3& m, const Vec3& v, double weight) noexcept {
  const double x = v[0] * weight, y = v[1] * weight, z = v[2] * weight;
  m[0] += x * v[0];
  m[1] += x * v[1];
  m[2] += x * v[2];
  m[3] += y * v[1];
  m[4] += y * v[2];
  m[5] += z * v[2];
}

inline Symmetric3 adjugate(const Symmetric3& m) noexcept {
  return {m[3] * m[5] - m[4] * m[4], m[2] * m[4] - m[1] * m[5], m[1] * m[4] - m[2] * m[3],
          m[0] * m[5] - m[2] * m[2], m[1] * m[2] - m[0] * m[4], m[0] * m[3] - m[1] * m[1]};
}

inline double det(const Symmetric3& m) noexcept {
  const Symmetric3 a = adjugate(m);
  return m[0] * a[0] + m[1] * a[1] + m[2] * a[2];
}

/// m^-1 v; all zero where the determinant is not above zero.
inline Vec3 solve(const Symmetric3& m, const Vec3& v) noexcept {
  const Symmetric3 a = adjugate(m);
  const double determinant = m[0] * a[0] + m[1] * a[1] + m[2] * a[2];
  if (!(determinant > 0.0)) return Vec3{};
  return scaled(times(a, v), 1.0 / determinant);
}

/// Square root of the prior covariance of one sensor: a symmetric 3x3 block for W, a number for b.
struct PriorRoot {
  Symmetric3 axes{};
  double bias = 0.0;
};
using PriorRoots = std::array<PriorRoot, kCapacity>;
PriorRoots prior_roots(const Datasheet& datasheet) noexcept;

/// S v. S is symmetric: it takes steps to natural units and gradients to prior units.
Parameters times_roots(const PriorRoots& roots, int n, const Parameters& v) noexcept;
/// Datasheet + S x.
Parameters natural(const Datasheet& datasheet, const PriorRoots& roots, const Parameters& x) noexcept;
inline Vec3 row_of(const Parameters& theta, int i) noexcept {
  return {theta[at(4 * i)], theta[at(4 * i + 1)], theta[at(4 * i + 2)]};
}

/// What is fixed during one fit.
struct Problem {
  const Datasheet& datasheet;
  double g_mps2;
  const Station* stations;
  int count;
};

/// The rows that one station contributes.
struct StationRows {
  int rows = 0;
  std::array<int, kCapacity> sensor{};      ///< ascending
  std::array<double, kCapacity> reading{};  ///< r [m/s^2]
  std::array<double, kCapacity> weight{};   ///< 1 / variance of the mean
};

/// The direction of gravity that explains a station best, and what is left.
struct StationFit {
  bool finite = false;
  Vec3 gravity{};                            ///< of length G
  Vec3 estimate{};                           ///< unconstrained least squares
  std::array<double, kCapacity> residual{};  ///< r - W g - b, by row
  std::array<double, kCapacity> tangent1{};  ///< weighted images of two tangent directions of the sphere,
  std::array<double, kCapacity> tangent2{};  ///< orthonormal in the whitened space
  double direction_variance = 0.0;           ///< of the fitted direction [rad^2], both tangents together
  double chi2 = 0.0;
};

enum class Loaded : std::uint8_t { used, skipped, not_finite };

/// Working readings and weights of a station. Skipped: no samples, or fewer than three independent rows.
Loaded load_rows(const Datasheet& datasheet, const Station& station, double misfit_variance,
                 StationRows& rows) noexcept;
int usable_stations(const Problem& problem) noexcept;
bool independent(const Datasheet& datasheet, SensorSet delivered) noexcept;
void fit_station(const StationRows& rows, const Parameters& theta, double g_mps2, StationFit& out) noexcept;

/// Ten products z z' of z = (g, 1): xx xy xz x yy yz y zz z 1.
inline constexpr int kMomentCount = 10;
/// Sums over the stations; `blocks` holds kMomentCount numbers a pair of sensors (i, j <= i).
struct Sums {
  int stations = 0;
  int rows = 0;
  bool finite = true;
  double chi2 = 0.0;
  double weighted_chi2 = 0.0;  ///< sum of weight^2 residual^2, for the moment estimate of the misfit
};
Sums accumulate(const Problem& problem, const Parameters& theta, double misfit_variance, double* blocks,
                Parameters& rhs) noexcept;
/// S N S in prior units from the blocks; lower triangle, row-major with stride 4n.
void expand(const double* blocks, const PriorRoots& roots, int n, double* information) noexcept;

/// Rotates theta so that its axes lie as near to the datasheet's as one rotation allows (Wahba).
void turn_to_datasheet(const Datasheet& datasheet, Parameters& theta) noexcept;

/// Takes the best common rotation (dW_i = W_i x e) out of a small change of the parameters.
void remove_rotation(const Parameters& theta, int n, Parameters& change) noexcept;

/// Rank, condition, null directions, sigmas and shares, from the information (prior units, lower triangle;
/// destroyed). Eigenvalues below `floor` times the largest count as zero. Leaves the posterior covariance
/// in natural units, gauge removed, in `information` (both triangles). False where the eigenvalues could
/// not be had.
bool analyse(const Datasheet& datasheet, const PriorRoots& roots, const Parameters& theta, double floor,
             double* information, double* scratch, FitReport& report) noexcept;

/// Multiplies the covariance and the sigmas: for residuals larger than the noise, unless a misfit says so.
void inflate(double factor, int n4, double* covariance, FitReport& report) noexcept;

/// Residuals, norm, parity, chi^2, excitation into the report.
struct ResidualSummary {
  bool finite = false;
  int rows = 0;
  double direction_variance = 0.0;  ///< of a fitted direction, mean over the stations [rad^2]
};
ResidualSummary describe_residuals(const Problem& problem, const Parameters& theta, FitReport& report) noexcept;

/// Calibrated model, axes and uncertainty from the fitted parameters and their covariance (stride 4n);
/// completes the report with e_cal.
Expected<Calibration> compose(const Datasheet& datasheet, const GravityReference& gravity, const Parameters& theta,
                              const double* covariance, FitReport& report) noexcept;

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
