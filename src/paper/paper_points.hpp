/// What the paper's error needs at every station, and sums over stations. Private to the paper module.
#pragma once

#include <Eigen/Core>

#include "../calibration/fit_internal.hpp"
#include "plumb/paper/paper_calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What all stations have in common.
struct PaperError::Prepared {
  std::array<Vec3, kPaperCapacity> column{};     ///< of map (I - m)
  std::array<double, kPaperCapacity> ratio{};    ///< SF over the nominal one
  std::array<double, kPaperCapacity> inverse{};  ///< 1 / SF
  std::array<double, kPaperCapacity> bias{};
  bool finite = true;
  double temperature_degc = 0.0;
  bool tempered = false;
  std::array<double, kPaperCapacity> gain{};   ///< 1 / SF* at that temperature; NaN where SF* is 0
  std::array<double, kPaperCapacity> drift{};  ///< B*
};

namespace paper {

/// Adds v v' to the lower triangle of a row-major matrix, four columns at a time: over the diagonal to the end of the
/// four. `v` and the rows have room for a multiple of four.
inline void add_square(const double* v, int size, double* matrix, int stride) noexcept {
  using Four = Eigen::Array4d;
  for (int a = 0; a < size; ++a) {
    double* row = matrix + fit::at(a * stride);
    for (int b = 0; b <= a; b += 4) Four::Map(row + b) += v[a] * Four::Map(v + b);
  }
}

}  // namespace paper
}  // namespace PLUMB_ABI
}  // namespace plumb
