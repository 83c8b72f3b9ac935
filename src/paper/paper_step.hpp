/// The step of the paper's fit, and the storage that it works in. Private to the calibration module.
#pragma once

#include "../calibration/fit_internal.hpp"
#include "plumb/paper/paper_calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace paper {

using fit::at;

/// At one temperature J'J has rank 3(n+1) <= 4n: every derivative is linear in x times (1 or a reading). What several
/// temperatures add beyond 4n is far smaller, and far from the nine directions that count.
inline constexpr int kFactorColumns = 4 * kPaperCapacity;

/// All that the iteration needs; the large part of the stack that `paper_calibrate` uses.
// The matrices are written before they are read, and clearing 90 KB would take longer than a step.
struct Workspace {  // NOLINT(cppcoreguidelines-pro-type-member-init,hicpp-member-init)
  int size = 0;     ///< parameters
  int stride = 0;   ///< of the matrix, row-major
  std::array<double, std::size_t{kPaperParameters} * kPaperParameters> matrix;
  std::array<double, std::size_t{kPaperParameters} * kFactorColumns> factor;  ///< stride kFactorColumns
  std::array<double, std::size_t{kFactorColumns} * kFactorColumns> gram;      ///< stride `columns`
  std::array<double, std::size_t{kFactorColumns} * kFactorColumns> vectors;   ///< the same
  std::array<double, kFactorColumns> values{};                                ///< ascending
  int columns = 0;
  std::array<double, kFactorColumns> pivot{};  ///< squares of what was left at each
  double rest = 0.0;                           ///< trace of what the first nine columns leave
  PaperParameters gradient{};
  PaperParameters step{};

  double& entry(int i, int j) noexcept { return matrix[at(i * stride + j)]; }
  double& root(int i, int j) noexcept { return factor[at(i * kFactorColumns + j)]; }
};

struct Problem {
  const PaperError& error;
  const Station* stations;
  int count;
};

/// Half the gradient of the sum of squares and its Gauss-Newton matrix, in prior units. Returns the cost.
double assemble(const Problem& problem, const PaperParameters& theta, Workspace& work) noexcept;

/// From the matrix and gradient of `assemble`, which it spends. False where there is no finite step.
bool minimum_norm_step(const Problem& problem, Workspace& work) noexcept;

/// With the full Hessian, eliminated with row pivots; no other safeguard.
bool plain_inverse_step(const Problem& problem, const PaperParameters& theta, Workspace& work) noexcept;

/// What rounding and noise feign of a singular value, relative to the largest. `noise` is that of a station mean
/// relative to gravity.
double rank_floor(double noise) noexcept;

/// From the matrix of `assemble`; `noise` as above.
int rank_of(double noise, Workspace& work) noexcept;

}  // namespace paper
}  // namespace PLUMB_ABI
}  // namespace plumb
