// The public arrays as Eigen sees them.
#pragma once

#include <Eigen/Dense>

#include "plumb/survey/measurement.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

template <int Rows, int Columns, std::size_t Size>
Eigen::Map<const Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>> matrix_of(const std::array<double, Size>& a) {
  static_assert(Size == static_cast<std::size_t>(Rows) * static_cast<std::size_t>(Columns), "size of the array");
  return Eigen::Map<const Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>>(a.data());
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
