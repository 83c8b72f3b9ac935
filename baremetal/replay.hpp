/// Plays a recording through a monitor; the same source on host and target.
#pragma once

#include <cstddef>
#include <cstdint>

#include "recording.hpp"

namespace metal {
inline namespace PLUMB_ABI {

/// Counts instructions where there is a counter: a target's timer, or nothing.
using Clock = std::uint32_t (*)() noexcept;

/// What the step did beside taking the sample in.
enum class Work : std::uint64_t { sample, block, event, iteration, judgement, short_block, longest_block };

/// What has to be the same bit for bit, and numbers that may differ in their last digits.
struct Answers {
  WordWriter exact, figures;
};

/// Every change, block and vector goes to `answers`; to `costs`, where given, three words a step: state before it
/// and work, clock ticks, ticks that reading the clock itself takes. 0 = played to the end; else what was wrong.
int replay(const std::uint64_t* recording, std::size_t size, Answers& answers, WordWriter* costs, Clock clock) noexcept;
/// Bytes of the object that is stepped.
std::size_t monitor_size() noexcept;

}  // namespace PLUMB_ABI
}  // namespace metal
