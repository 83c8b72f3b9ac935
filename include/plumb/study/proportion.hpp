/// A count out of a number of trials, with what it says of the rate behind it.
#pragma once

#include <cstdint>
#include <string>

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

/// How an interval is printed everywhere: rounded outwards, so that what is printed holds whatever the interval holds.
/// A value that is not 0 is never printed as 0, and one that is not `whole` never as `whole`: near it, the digits are
/// those of what is missing.
std::string rounded_down(double value, int digits = 3, double whole = 1.0);
std::string rounded_up(double value, int digits = 3, double whole = 1.0);
/// To the nearest, but never to 0 or to `whole` from beside them.
std::string rounded_share(const Proportion& p, int digits = 4, double whole = 1.0);

/// "[0.000184, 0.00118]"; with `whole` 100 in percent. Of a 95 % interval an end at 0 or at the whole is none: the
/// other end then is a bound of 97.5 %.
std::string interval_text(const Proportion& p, int digits = 3, double whole = 1.0);
/// "95 % interval 3.1e-05 to 0.00045", "at most 0.000185 with 97.5 % confidence", "at least 0.99981 with 97.5 %
/// confidence"; "%" follows the figures where `whole` is 100.
std::string interval_words(const Proportion& p, int digits = 3, double whole = 1.0);
/// What a table of intervals says of them.
inline constexpr const char* kIntervalNote =
    "95 % Clopper-Pearson intervals, rounded outwards; where the count is 0 or all, the other end is a bound of 97.5 %";

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
