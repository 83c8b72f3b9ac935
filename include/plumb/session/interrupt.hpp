/// Ctrl-C as a request to come to an end, which what reads a log looks at row by row.
#pragma once

#include <csignal>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// From now on the first Ctrl-C (or SIGTERM) asks for an orderly end; the second one ends at once.
void watch_interrupts();
const volatile std::sig_atomic_t* interrupt_flag() noexcept;
bool interrupted() noexcept;

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
