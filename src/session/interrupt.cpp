#include "plumb/session/interrupt.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

volatile std::sig_atomic_t g_interrupt = 0;

void on_interrupt(int) { g_interrupt = 1; }

}  // namespace

void watch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  // No SA_RESTART, so that a read that waits on a pipe wakes up; once only, so that a second Ctrl-C ends a
  // tool that does not come to its orderly end.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const volatile std::sig_atomic_t* interrupt_flag() noexcept { return &g_interrupt; }
bool interrupted() noexcept { return g_interrupt != 0; }

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
