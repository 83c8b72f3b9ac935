/// The cosine transform DCT-II, orthonormal (private to src/noise).
///
/// It makes both white noise and a random walk (less its mean) uncorrelated exactly, and 1/f noise between them nearly
/// so: the differences of a walk are white, and become a sine transform. So the powers of the components are
/// independent chi-squares, without a taper and at any slope.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

class CosineTransform {
 public:
  CosineTransform();
  ~CosineTransform();
  CosineTransform(const CosineTransform&) = delete;
  CosineTransform& operator=(const CosineTransform&) = delete;
  CosineTransform(CosineTransform&&) = delete;
  CosineTransform& operator=(CosineTransform&&) = delete;

  /// Components 0 .. count - 1 of values[0 .. count - 1]; fast where `fast_length(count) == count`.
  void apply(const double* values, std::size_t count, std::vector<double>& components);

 private:
  struct Plan;  // keeps the header of the Fourier transform, which is slow to compile, in one place
  std::unique_ptr<Plan> plan_;
};

/// The largest number up to `count` (>= 4) that is a multiple of four with no prime factor above five: within 1 % from
/// some thousand on.
std::size_t fast_length(std::size_t count) noexcept;

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
