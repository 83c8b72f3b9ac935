/// What a set of axes can and cannot determine: least squares, triple maps, parity, coplanarity.
#pragma once

#include <array>

#include "plumb/array/sensor_array.hpp"
#include "plumb/core/detail/flag.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Readings of the sensors of one array, indexed by sensor [m/s^2].
using Readings = std::array<double, kCapacity>;
/// What the readings of a sample differ by from the first of their block [m/s^2].
using Differences = std::array<Scalar, kCapacity>;

/// Rank of the axes of `used` (0..3), with singular values below 1e-6 counted as zero.
int rank_of(const SensorArray& array, SensorSet used) noexcept;

/// The 3 x |used| map of least squares (eq 5, the matrix of eq 17 for the paper's axes; weighted with 1/sigma^2 where
/// the sigmas differ) and what follows from it. `valid` is false where rank(used) < 3.
struct LeastSquares {
  Flag valid;  ///< `used` determines a vector
  SensorSet used;
  std::array<Vec3, kCapacity> column{};  ///< column i of the pseudo-inverse; zero for sensors not used
  Mat3 covariance{};                     ///< of x for one sample [(m/s^2)^2]
  Vec3 estimate(const Readings& y) const noexcept;

  static constexpr auto fields() noexcept {
    using L = LeastSquares;
    return field_list(&L::valid, &L::used, &L::column, &L::covariance);
  }
};
LeastSquares least_squares(const SensorArray& array, SensorSet used) noexcept;

/// Inverse of the three rows of a triple: x = map * (y_i, y_j, y_k), eqs (18)-(21). The triple must
/// have rank 3 as `rank_of` judges it (finite condition); otherwise all entries are zero.
Mat3 triple_map(const SensorArray& array, int triple) noexcept;

/// Orthonormal basis of the left null space of the rows of `used`, each divided by its sigma
/// (weighted parity, (|used|-3) rows). Entry [r][i] multiplies y_i in m/s^2; the result has unit
/// variance under white noise. For the paper's tetrahedron the row is (1,1,1,-1)/(2 sigma). The first
/// coefficient of weight in a row is positive. No rows where rank(used) < 3.
struct ParityBasis {
  int rows = 0;
  std::array<std::array<double, kCapacity>, kCapacity> weight{};
};
ParityBasis parity_basis(const SensorArray& array, SensorSet used) noexcept;

/// The sensors of `set` whose axes lie within 10 deg of the line of `axis` (unit length), in either sense.
SensorSet of_direction(const SensorArray& array, SensorSet set, const Vec3& axis) noexcept;

/// Whether the axes of `used` have rank 3 and do not lie within kPlaneTolerance of one plane.
bool spans_space(const SensorArray& array, SensorSet used) noexcept;

/// c(H): the largest number of units of `used` (sensors, where no chips are stated) all of whose axes lie within
/// kPlaneTolerance of one plane (of any two axes of the array, in use or not, so that a loss never raises a grade); 2
/// for sensors in general position, 0 for triads, all units where rank < 3.
int coplanarity(const SensorArray& array, SensorSet used) noexcept;

/// m_strict = units - 1 - c, never below 0 (docs/theory.md, sections 5.1 and 5.7; n-3 is the case of sensors in general
/// position).
int confirmed_grade(const SensorArray& array, SensorSet used) noexcept;
/// The same of so many units whose coplanarity number is known.
constexpr int confirmed_grade(int units, int coplanarity) noexcept {
  return units - 1 > coplanarity ? units - 1 - coplanarity : 0;
}
/// m_parity = units - 2 - c, never below 0; needs no gravity.
int provisional_grade(const SensorArray& array, SensorSet used) noexcept;
constexpr int provisional_grade(int units, int coplanarity) noexcept { return confirmed_grade(units - 1, coplanarity); }

/// Sensors whose loss leaves rank < 3 (coplanarity within the rank tolerance of 0.05, so a nearly
/// coplanar rest counts as lost too).
SensorSet critical_sensors(const SensorArray& array, SensorSet used) noexcept;

/// Figures of merit of a geometry (paper section 4; Shim and Yang's criterion for FDI is the angle
/// between the two nearest axes: the larger the better).
struct FiguresOfMerit {
  double gdop = 0.0;               ///< sqrt(trace((H'H)^-1)), noise gain of the vector
  double condition = 0.0;          ///< of H
  double nearest_angle_rad = 0.0;  ///< smallest angle between two measurement lines
  double min_triple_det = 0.0;     ///< smallest |det| over all triples
  double max_triple_condition = 0.0;
  double common_bias_visibility = 0.0;  ///< |V'1|/|1|, V = parity basis (docs/theory.md, section 1.4)
  int units = 0;  ///< what may fail at once: chips where they are stated, else sensors; all that follows counts them
  int coplanarity = 0;
  int confirmed_grade = 0;
  int provisional_grade = 0;
  int near_singular_triples = 0;
};
FiguresOfMerit figures_of_merit(const SensorArray& array) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
