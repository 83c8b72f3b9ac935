/// One gravity for a whole episode: where the host has stated how far healthy sensors drift and what acceleration it
/// allows for, a set whose length is off by different amounts at different attitudes is not healthy.
#pragma once

#include "plumb/detection/detail/norm_mismatch_doubt.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Whether the lengths on record may speak against sets (docs/theory.md, section 5.3): stability is stated of every
/// monitored sensor, an acceleration is allowed for, and no set of four (of chips: of one more than determine a vector)
/// that agrees with itself contradicts one gravity, or is about to. Such a set may be healthy, and then the tool moves.
/// With `hears`, what these sets are off by goes on record first.
bool holds_one_gravity(const BlockTests& tests, const ReferencePanel& panel, bool hears, VoteRecord& record) noexcept;

/// Whether no gravity within its bounds explains what the set of `units` was off by; with `hears`, at this block too.
bool contradicts_one_gravity(const BlockTests& tests, const ReferencePanel& panel, SensorSet units, bool hears,
                             VoteRecord& record) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
