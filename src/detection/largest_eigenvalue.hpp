/// Of a symmetric 3x3 matrix. Private to the detection module.
#pragma once

#include <limits>

#include "plumb/core/vec3.hpp"
#include "plumb/numeric/symmetric_eigenvalues.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace detection_detail {

/// Infinite where an entry is not finite.
inline double largest_eigenvalue(const Mat3& symmetric) noexcept {
  Mat3 work = symmetric;
  Vec3 values{};
  return symmetric_eigenvalues(work.data(), 3, 3, values.data()) ? values[2] : std::numeric_limits<double>::infinity();
}

}  // namespace detection_detail
}  // namespace PLUMB_ABI
}  // namespace plumb
