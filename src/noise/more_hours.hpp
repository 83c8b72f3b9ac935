/// How much longer a log must be to show a term (private to src/noise).
#pragma once

#include <cstddef>
#include <optional>

#include "plumb/noise/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

/// Hours beyond the log of `readings` after which a coefficient `wanted` of that term is beyond two sigmas of its
/// estimate, where `noise` are the others; nothing where 100 times the length is not enough.
std::optional<double> more_hours(Term term, double wanted, const Coefficients& noise, std::size_t readings,
                                 double period_s);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
