#include "array_model.hpp"

#include <algorithm>

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

/// By sensor, the number of its arm: the axes of a chip share one.
std::vector<int> arms_of(const ArrayOnBoard& on_board) {
  std::vector<int> out;
  for (int i = 0; i < on_board.array.size(); ++i) out.push_back(on_board.array.units().of(i));
  return out;
}

Eigen::Vector3d eigen_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

}  // namespace

ArrayModel::ArrayModel(const ArrayOnBoard& on_board)
    : on_board_(on_board),
      arm_of_(arms_of(on_board)),
      at_{on_board.array.size(), 1 + *std::max_element(arm_of_.begin(), arm_of_.end())},
      weight_(at_.sensors),
      x_(Vector::Zero(at_.size())) {
  for (Index i = 0; i < at_.sensors; ++i) weight_[i] = 1.0 / on_board.array.sigma_mps2(static_cast<int>(i));
  look_across();
}

void ArrayModel::set(const Vector& x) {
  x_ = x;
  look_across();
}

ArrayModel::Vector ArrayModel::parity(const Pair& pair) const {
  return across_.transpose() * weight_.cwiseProduct(corrected(pair));
}

ArrayModel::Matrix ArrayModel::slope(const Pair& pair) const {
  const Eigen::Matrix3d omega = omega_of(pair);
  const Eigen::Vector3d force = to_force_ * weight_.cwiseProduct(corrected(pair));
  Matrix out = Matrix::Zero(at_.sensors, at_.size());
  for (Index i = 0; i < at_.sensors; ++i) {
    const Eigen::Vector3d h = axis(i), r = arm(i);
    out.block<1, 3>(i, at_.arm(unit(i))) = h.transpose() * omega;
    out.block<1, 3>(i, at_.within_chip(i)) = h.transpose() * omega;
    out(i, at_.lag() + i) = pair.slope[i];
    out(i, at_.rectification() + i) = pair.power[i];
    out.block<1, 3>(i, at_.row(i)) = (force + omega * r).transpose();
    out(i, at_.bias() + i) = 1.0;
    for (std::size_t p = 0; p < kGyroUnknowns; ++p)
      out(i, at_.gyro() + static_cast<Index>(p)) = h.dot(pair.omega_by[p] * r);
  }
  return across_.transpose() * weight_.asDiagonal() * out;
}

Eigen::Vector3d ArrayModel::nominal(Index sensor) const {
  return eigen_of(on_board_.array.axis(static_cast<int>(sensor)));
}

Eigen::Vector3d ArrayModel::arm(Index sensor) const {
  return eigen_of(on_board_.setup.lever_arm_m[static_cast<std::size_t>(sensor)]) +
         x_.segment<3>(at_.arm(unit(sensor))) + x_.segment<3>(at_.within_chip(sensor));
}

Eigen::Matrix3d ArrayModel::omega_of(const Pair& pair) const {
  Eigen::Matrix3d out = pair.omega;
  for (std::size_t p = 0; p < kGyroUnknowns; ++p) out += x_[at_.gyro() + static_cast<Index>(p)] * pair.omega_by[p];
  return out;
}

ArrayModel::Vector ArrayModel::corrected(const Pair& pair) const {
  const Eigen::Matrix3d omega = omega_of(pair);
  Vector out = pair.reading - x_.segment(at_.bias(), at_.sensors) -
               x_.segment(at_.lag(), at_.sensors).cwiseProduct(pair.slope) -
               x_.segment(at_.rectification(), at_.sensors).cwiseProduct(pair.power);
  for (Index i = 0; i < at_.sensors; ++i) out[i] -= axis(i).dot(omega * arm(i));
  return out;
}

void ArrayModel::look_across() {
  Matrix axes(at_.sensors, 3);
  for (Index i = 0; i < at_.sensors; ++i) axes.row(i) = weight_[i] * axis(i).transpose();
  const Eigen::HouseholderQR<Matrix> qr(axes);
  const Matrix q = qr.householderQ();
  across_ = q.rightCols(at_.sensors - 3);
  to_force_ = (axes.transpose() * axes).ldlt().solve(axes.transpose());
}

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
