/// A bias that all sensors share (reference voltage, heat): how much of it shows, what it does to the vector, and which
/// sensors to mount the other way round so that it shows most (docs/theory.md, section 1.4).
#pragma once

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Per unit of the common bias. Geometry only: sensors count alike.
struct CommonBias {
  double visibility = 0.0;  ///< |V'1|/|1|: 1 = parity sees all of it, 0 = nothing
  Vec3 vector_error{};      ///< H^+ 1: what the vector takes
};

/// A choice of sensors to reverse.
struct PolarityPlan {
  SensorSet reverse;  ///< fewest that reach the visibility below; the first sensor always stays
  CommonBias effect;  ///< with these reversed
};

CommonBias common_bias(const SensorArray& array) noexcept;

/// Tries every pattern of polarities (2^(n-1), each in O(n)).
PolarityPlan best_polarity(const SensorArray& array) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
