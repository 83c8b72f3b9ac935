/// By how much the tool may have turned beside what a block's mean says.
#pragma once

#include "plumb/health/in_force.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Of a change of the specific force, in whatever direction, some sensor of `used` feels this share at least.
double least_share_felt(const SensorArray& array, SensorSet used) noexcept;

/// The most by which a tool turns in a block whose channels all pass for quiet: a steady turn by t scatters a channel
/// that feels all of it by t g / sqrt(12), and what noise may reach hides that. `noise_factor`: of the stated sigmas.
double hidden_turn_rad(const InForce& in_force, SensorSet in_service, SensorSet used, double restless_factor,
                       double noise_factor) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
