/// A count out of a number of trials, with what it says of the rate behind it.
#pragma once

#include <cstdint>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

/// k of n, with the Clopper-Pearson interval: it holds the true rate in at least `confidence` of all cases, however
/// small k and n are.
struct Proportion {
  std::uint64_t count = 0;
  std::uint64_t trials = 0;
  double low = 0.0;
  double high = 1.0;
  double share() const noexcept { return trials == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(trials); }
};

/// A count above `trials` is taken as `trials`; a confidence outside (0, 1) as 0.95. No trials: the interval is 0 to 1.
Proportion proportion(std::uint64_t count, std::uint64_t trials, double confidence = 0.95);

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
