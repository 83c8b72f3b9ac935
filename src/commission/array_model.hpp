/// How the readings of an array follow from what is not known of it (private to src/commission).
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "array_pairs.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

/// Where the unknowns stand in one vector.
struct ArrayLayout {
  using Index = Eigen::Index;
  Index sensors, arms;
  Index arm(Index unit) const { return 3 * unit; }
  Index lag() const { return 3 * arms; }
  Index rectification() const { return lag() + sensors; }
  Index row(Index sensor) const { return rectification() + sensors + 3 * sensor; }
  Index bias() const { return rectification() + 4 * sensors; }
  Index gyro() const { return bias() + sensors; }
  Index within_chip(Index sensor) const { return gyro() + static_cast<Index>(kGyroUnknowns) + 3 * sensor; }
  Index size() const { return within_chip(sensors); }
};

/// Residuals in sigmas of a sample. The array has to outlive it.
class ArrayModel {
 public:
  using Index = Eigen::Index;
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  using Pair = ArrayPairs::Pair;

  /// With all unknowns zero.
  explicit ArrayModel(const ArrayOnBoard& on_board);

  const ArrayLayout& at() const { return at_; }
  const Vector& x() const { return x_; }
  void set(const Vector& x);

  /// What no force explains.
  Vector parity(const Pair& pair) const;
  /// How that follows from the unknowns, less the sign: the residual falls by this times a step.
  Matrix slope(const Pair& pair) const;

  /// Sensors of one chip share an arm, but for what they are apart within it; one without a chip has its own.
  Index unit(Index sensor) const { return arm_of_[static_cast<std::size_t>(sensor)]; }
  Eigen::Vector3d nominal(Index sensor) const;

 private:
  Eigen::Vector3d axis(Index sensor) const { return nominal(sensor) + x_.segment<3>(at_.row(sensor)); }
  Eigen::Vector3d arm(Index sensor) const;
  Eigen::Matrix3d omega_of(const Pair& pair) const;
  Vector corrected(const Pair& pair) const;
  void look_across();

  const ArrayOnBoard& on_board_;
  std::vector<int> arm_of_;
  ArrayLayout at_;
  Vector weight_;
  Vector x_;
  Matrix across_, to_force_;
};

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
