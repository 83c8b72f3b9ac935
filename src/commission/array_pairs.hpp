/// Block pairs as the fit of an array takes them (private to src/commission).
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "plumb/commission/array_fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

/// What the gyro may be off by: nine of scale and axes by rows, three biases, one lag, and what its filter takes from
/// fast turns: their mean square is felt along a lever arm in full.
inline constexpr std::size_t kGyroUnknowns = 14;
inline constexpr std::size_t kGyroBias = 9, kGyroLag = 12, kGyroFilter = 13;

struct ArrayPairs::Pair {
  Eigen::VectorXd reading, slope;
  Eigen::VectorXd power;  ///< mean square less the squared mean: that of the vibration, and of slow changes
  Eigen::Matrix3d omega;
  std::array<Eigen::Matrix3d, kGyroUnknowns> omega_by;  ///< by what the gyro may be off by
};

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
