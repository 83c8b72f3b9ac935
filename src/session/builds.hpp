/// The capacities that this program has the monitor's inner loops for: one list for the steppers of a log and the
/// kernels of a campaign (private to these).
#pragma once

#include <vector>

/// Calls X(namespace of the capacity, capacity, longest window of its monitor (plumb/core/config.hpp)) for each that
/// the build has, from the smallest up.
#ifdef PLUMB_BUILT_FOR_4
#define PLUMB_IF_BUILT_FOR_4(X) X(cap4, 4, 32)
#else
#define PLUMB_IF_BUILT_FOR_4(X)
#endif
#ifdef PLUMB_BUILT_FOR_8
#define PLUMB_IF_BUILT_FOR_8(X) X(cap8, 8, 32)
#else
#define PLUMB_IF_BUILT_FOR_8(X)
#endif
#ifdef PLUMB_BUILT_FOR_24
#define PLUMB_IF_BUILT_FOR_24(X) X(cap24, 24, 256)
#else
#define PLUMB_IF_BUILT_FOR_24(X)
#endif
#define PLUMB_FOR_EACH_BUILD(X) PLUMB_IF_BUILT_FOR_4(X) PLUMB_IF_BUILT_FOR_8(X) PLUMB_IF_BUILT_FOR_24(X)

namespace plumb {
namespace stepping {

/// A part of one capacity, by the function that makes it.
template <class Make>
struct Build {
  int capacity;
  int window;
  Make make;

  bool holds(int least_capacity, int of_window) const noexcept {
    return capacity >= least_capacity && window >= of_window;
  }
};

template <class Builds>
std::vector<int> capacities_of(const Builds& builds) {
  std::vector<int> out;
  for (const auto& build : builds) out.push_back(build.capacity);
  return out;
}

}  // namespace stepping
}  // namespace plumb
