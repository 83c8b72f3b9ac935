/// By how much the tool may have turned beside what a block's mean says (docs/theory.md, section 6.3).
#pragma once

#include "plumb/health/detail/in_force.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Of a change of the specific force, in whatever direction, some sensor of `used` feels this share at least, 0 to 1:
/// sqrt(lambda_min / n), from below. 0 where the axes of `used` span no space.
double least_share_felt(const SensorArray& array, SensorSet used) noexcept;

/// The most by which a tool turns in a block whose channels all count as at rest: a steady turn by t scatters a channel
/// that feels all of it by t g / sqrt(12), and what noise may reach hides that [rad]. `used`: the sensors that
/// delivered. `scatter_factor`: variance over that of noise up to which a channel is at rest; no more than 1 = no
/// scatter is known, and the turn is 0. `noise_factor`: noise in stated sigmas.
double hidden_turn_rad(const InForce& in_force, SensorSet in_service, SensorSet used, double scatter_factor,
                       double noise_factor) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
