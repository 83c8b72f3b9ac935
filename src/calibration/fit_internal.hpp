/// The parts of the forward fit. Private to the calibration module; src/paper takes its inline arithmetic.
///
/// Two coordinates are used. *Natural*: per sensor W (3) and b [m/s^2], r = W g + b. *Prior units* x:
/// natural = datasheet + S x with S S' the prior covariance, so that the prior is |x|^2 / 2, information
/// can be compared between parameters of different units, and a prior sigma of zero freezes a parameter.
#pragma once

#include <array>
#include <cstddef>

#include "plumb/calibration/calibration.hpp"
#include "plumb/core/detail/numbers.hpp"
#include "plumb/numeric/cholesky.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {

using numbers::at;

using Parameters = std::array<double, kFitParameters>;

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
/// The datasheet's own W and b.
Parameters datasheet_parameters(const Datasheet& datasheet) noexcept;
/// The x that `natural` takes to theta; no prior sigma may be zero.
Parameters prior_units(const Datasheet& datasheet, const Parameters& theta) noexcept;
inline Vec3 row_of(const Parameters& theta, int i) noexcept {
  return {theta[at(4 * i)], theta[at(4 * i + 1)], theta[at(4 * i + 2)]};
}

/// Rows of stations that share an inclination while the tool rolls about `axis`. `used` is what the stations make of
/// it: some group has two stations or more.
struct Roll {
  Vec3 axis{0.0, 0.0, 1.0};
  double wobble_rad = 0.0;
  bool used = false;
  int groups = 0;  ///< beyond kMaxRollGroups: too many
  int lone = 0;    ///< groups of one station
};

/// Where the outliers were separated: a station is out where its residual there, with that misfit, is beyond
/// the limit. Kept as parameters rather than as a list, so that any number of stations is screened alike.
struct Screen {
  Parameters theta{};
  double misfit_variance = 0.0;
};

/// Positive, and neither so small nor so large that squares and their reciprocals vanish or overflow.
inline bool usual(double value) noexcept { return value >= 1e-100 && value <= 1e100; }
/// Whether datasheet and gravity have numbers that a fit can start from. A prior sigma of zero is allowed: it freezes
/// the parameter.
bool acceptable(const Datasheet& datasheet, double g_mps2) noexcept;
/// Whether nothing is frozen. A frozen parameter stays at its nominal value, which the closed form knows nothing of.
bool all_free(const Datasheet& datasheet) noexcept;
/// Whether a step (natural units, common rotation taken out) is below so much of each value, or of its prior sigma.
bool small_step(const PriorRoots& roots, int n, const Parameters& natural, const Parameters& moved,
                double relative) noexcept;

/// What is fixed during one fit.
struct Problem {
  const Datasheet& datasheet;
  double g_mps2 = 0.0;
  StationList stations;
  int count = 0;
  Roll roll;
  const Screen* screen = nullptr;
};
Problem problem_of(const Datasheet& datasheet, double g_mps2, const FitOptions& options,
                   const StationList& stations) noexcept;
bool unit_axis(const Vec3& axis) noexcept;

/// Ten products z z' of z = (g, 1): xx xy xz x yy yz y zz z 1.
inline constexpr int kMomentCount = 10;
/// So many a pair of sensors (i, j <= i).
using Blocks = std::array<double, std::size_t{kMomentCount} * kCapacity*(kCapacity + 1) / 2>;

/// How much a station counts, by its residual.
enum class Loss : std::uint8_t { squares, huber, tukey };

/// Sums over the stations of one roll group, for the mean inclination that belongs to the group alone.
struct RollGroup {
  std::uint32_t tag = 0;
  int stations = 0;
  double origin = 0.0;  ///< component of gravity along the axis at the first station [m/s^2]: levels count from it
  double weight = 0.0;
  double level = 0.0;   ///< sum of weight times level
  double square = 0.0;  ///< sum of weight times squared level
  double growth = 0.0;  ///< sum of weight times the derivative of the variance by the misfit's
  Parameters slope{};   ///< sum of weight times gradient
};
struct RollSums {
  int groups = 0;
  std::array<RollGroup, kMaxRollGroups> group;  ///< the first `groups` are set
};

/// Sums over the stations; `blocks` holds kMomentCount numbers a pair of sensors (i, j <= i).
struct Sums {
  int stations = 0;
  int rows = 0;
  int bad_station = -1;  ///< the first one that is not finite
  bool finite = true;
  double chi2 = 0.0;           ///< of the stations, and of the inclinations within their groups
  double weighted_chi2 = 0.0;  ///< sum of weight^2 residual^2, for the moment estimate of the misfit
  double worst = 0.0;          ///< largest residual of a station over its outlier limit, squared
};
class FitTally;
class Screening;
/// What a fit needs beyond its sums, where it has it. Without roll groups, and where no station is omitted by a
/// screen, none of it; and who reads no factor gives no room for it.
struct Room {
  RollSums* roll = nullptr;
  Screening* screening = nullptr;
  double* factor = nullptr;  ///< square
};
/// `tally`, where given, sees every station that is used.
Sums accumulate(const Problem& problem, const Parameters& theta, double misfit_variance, Loss loss, double* blocks,
                Parameters& rhs, const Room& room, FitTally* tally = nullptr) noexcept;
/// S N S in prior units from the blocks.
template <class Matrix>
void expand(const double* blocks, const RollSums* roll, const PriorRoots& roots, int n,
            const Matrix& information) noexcept;

/// A symmetric matrix of n rows of which the lower triangle counts: as a square, both triangles in their place, ...
struct Square {
  double* entry;
  int n;
  double& operator()(int i, int j) const noexcept { return entry[i * n + j]; }
  bool factor() const noexcept { return cholesky_factor(entry, n, n); }
  void solve(double* b) const noexcept { cholesky_solve(entry, n, n, b); }
  static constexpr bool keeps(int, int) noexcept { return true; }
};
/// ... or packed, row by row.
struct Packed {
  double* entry;
  int n;
  double& operator()(int i, int j) const noexcept { return entry[i * (i + 1) / 2 + j]; }
  bool factor() const noexcept { return cholesky_factor_packed(entry, n); }
  void solve(double* b) const noexcept { cholesky_solve_packed(entry, n, b); }
  static constexpr bool keeps(int i, int j) noexcept { return j <= i; }
};

/// How the iteration treats a fit in which the axes may be free ...
struct FreeAxes {
  using Count = int;      ///< counts the stations: any number of them
  using Matrix = Square;  ///< of the normal equations
  /// The factor outlives the step, in the room that the caller gives: the misfit is estimated from its inverse.
  static constexpr bool kKeepsFactor = true;
  /// A step may turn all axes together, which costs the data nothing.
  static constexpr bool kTurnsTogether = true;
};
/// ... and one in which they are held: what must fit in the small stack of a monitor's step.
struct HeldAxes {
  using Count = std::uint8_t;  ///< the stations of a StationList, as many as can be omitted
  using Matrix = Packed;
  static constexpr bool kKeepsFactor = false;
  static constexpr bool kTurnsTogether = false;
};
/// Stations at most that a fit with held axes counts.
inline constexpr int kMostCounted = StationList::kMarked;

/// What the noise beyond the datasheet's would have to be for half of the stations to lie below the median that noise
/// alone would have, from a guess at it; times `share`. `freedom` is that of the whole fit. Robust, and a start only:
/// it has a tenth of the precision of the moment estimate. [(m/s^2)^2]
/// `Count` counts the stations, and must hold their number.
template <class Count>
double median_misfit(const Problem& problem, const Parameters& theta, double misfit_variance, int freedom,
                     double share) noexcept;

/// Whether some residual of a least-squares fit is so far above the median that it may be an outlier: noise of any size
/// alone seldom looks so. An outlier pulls the fit, hence a part of the limit only.
template <class Count>
bool stands_out(const Problem& problem, const Parameters& theta, int freedom) noexcept;

/// Counts the roll groups; `used` where any two stations share one. At most kMaxRollGroups are used.
void find_roll_groups(const Problem& problem, Roll& roll) noexcept;

/// W and b from the stations alone, in the frame that the prior likes best; false where they do not determine it, or
/// where the datasheet is too far off. Incomplete stations are not used. All priors must be above zero.
bool closed_form(const Problem& problem, Parameters& theta) noexcept;

/// Rotates all W by the vector `turn` (axis times angle).
void turn_all(const Vec3& turn, int n, Parameters& theta) noexcept;

/// Rotates theta so that its axes lie as near to the datasheet's as one rotation allows (Wahba); about the roll axis
/// alone where roll groups have settled the other two. The sensor `left_out`, if any, has no say.
void turn_to_datasheet(const Datasheet& datasheet, const Roll& roll, Parameters& theta, int left_out = -1) noexcept;

/// Rotates theta so that its axes cost the prior least, by at most so many steps, none of which goes uphill. All priors
/// must be above zero.
void turn_to_prior(const Datasheet& datasheet, int steps, Parameters& theta) noexcept;

/// Takes the best common rotation (dW_i = W_i x e; about the roll axis alone where roll groups see the others) out of a
/// small change of the parameters. Returns the turn (axis times angle) that it amounted to.
Vec3 remove_rotation(const Parameters& theta, int n, const Roll& roll, Parameters& change) noexcept;

/// Rank, condition, null directions, sigmas and shares, from the information (prior units, lower triangle;
/// destroyed). Eigenvalues below `floor` times the largest count as zero. Leaves the posterior covariance
/// in natural units, gauge removed, in `information` (both triangles). False where the eigenvalues could
/// not be had.
bool analyse(const Datasheet& datasheet, const Roll& roll, const PriorRoots& roots, const Parameters& theta,
             double floor, double* information, double* scratch, FitReport& report) noexcept;

/// Rank where the axes are held: of the information about scales and biases alone, in prior units. Eigenvalues below
/// `floor` times the largest count as zero. -1 where they could not be had.
int rank_of_held(const Datasheet& datasheet, const double* blocks, double floor) noexcept;

/// Multiplies the covariance and the sigmas: for residuals larger than the noise, unless a misfit says so.
void inflate(double factor, int n4, double* covariance, FitReport& report) noexcept;

/// Calibrated model, axes and uncertainty from the fitted parameters and their covariance (stride 4n);
/// completes the report with e_cal.
Error compose(const Datasheet& datasheet, const GravityReference& gravity, const Parameters& theta,
              const double* covariance, FitReport& report, Calibration& out) noexcept;

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
