#include "plumb/findings/best_turn.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

void BestTurn::add(const Vec3& onto, const Vec3& from) noexcept {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) sum_[row][column] += onto[row] * from[column];
  }
}

Turn BestTurn::find(Hand hand) const {
  Eigen::Matrix3d profile;
  for (int row = 0; row < 3; ++row)
    profile.row(row) = Eigen::Vector3d(sum_[static_cast<std::size_t>(row)].data()).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(profile, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d u = svd.matrixU();
  const Eigen::Matrix3d v = svd.matrixV();
  const double sign = hand == Hand::kept && (u * v.transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d turn = u * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * v.transpose();
  Turn out{};
  for (int row = 0; row < 3; ++row) out[static_cast<std::size_t>(row)] = {turn(row, 0), turn(row, 1), turn(row, 2)};
  return out;
}

Vec3 turned(const Turn& turn, const Vec3& direction) noexcept {
  return {dot(turn[0], direction), dot(turn[1], direction), dot(turn[2], direction)};
}

double least_singular_value(const SensorArray& array) {
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  for (int i = 0; i < array.size(); ++i) {
    const Eigen::Vector3d axis(array.axis(i).data());
    gram += axis * axis.transpose();
  }
  return std::sqrt(Eigen::JacobiSVD<Eigen::Matrix3d>(gram).singularValues()[2]);
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
