/// The floor of a spectrum and what stands above it (private to src/noise).
#pragma once

#include "plumb/noise/spectrum.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

/// Fills `floor` and `peaks` from `density`, `bin_hz` and `averages`.
void find_floor_and_peaks(Spectrum& spectrum, double half_rate_hz);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
