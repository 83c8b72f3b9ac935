/// What a verdict says: written from the state of the monitor, which none of these functions changes. Nothing but
/// `has_news` reads a verdict, and nothing is decided by one.
#pragma once

#include "plumb/health/detail/block_report.hpp"
#include "plumb/health/detail/monitor_state.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// How far the vector of the last block may be believed at this sample.
Validity validity_of(const MonitorState& state) noexcept;
/// Whether the protection level is one of this sample: of an older vector the bound says nothing now.
bool is_protected(const MonitorState& state, Validity validity) noexcept;
/// The level of the last block in the frame of the housing [rad].
double housing_level_rad(const MonitorState& state) noexcept;
std::uint16_t usable_bits(const MonitorState& state, Validity validity) noexcept;

/// Whether anything but what every sample changes is other than `last` says, though neither a block nor an event says
/// so: by the host, by time alone, or in the fit that is being made.
bool has_news(const MonitorState& state, const Verdict& last) noexcept;

/// The figures of a block.
void publish_report(const MonitorState& state, const BlockReport& report, Verdict& v) noexcept;
/// What every sample changes.
void publish_sample(const MonitorState& state, const Sample& sample, Verdict& v) noexcept;
/// What the verdict claims of this sample.
void publish_claims(const MonitorState& state, Validity validity, Verdict& v) noexcept;
/// All but the figures of a block. `turns`: which turn would help is asked anew.
void publish(const MonitorState& state, const Sample& sample, bool ticked, bool turns, Verdict& v) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
