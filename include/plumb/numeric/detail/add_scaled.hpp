/// A few numbers times a factor, added to as many others.
#pragma once

#include <cstddef>
#include <cstring>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// to[k] += factor * from[k] for k < kCount, an even number. Two at a time: the compilers do not join them of
/// themselves at -O2, since `to` and `from` might overlap. Each product and each sum is rounded, as one by one.
template <int kCount>
inline void add_scaled(double* to, const double* from, double factor) noexcept {
  static_assert(kCount % 2 == 0, "two at a time");
  using Two = double __attribute__((vector_size(2 * sizeof(double))));
  for (int k = 0; k < kCount; k += 2) {
    Two sum, part;
    std::memcpy(&sum, to + k, sizeof sum);
    std::memcpy(&part, from + k, sizeof part);
    sum += factor * part;
    std::memcpy(to + k, &sum, sizeof sum);
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
