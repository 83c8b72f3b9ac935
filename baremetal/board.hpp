/// What the replay needs of the board and of the debugger behind it (semihosting).
#pragma once

#include <cstdint>

namespace metal {

[[noreturn]] void leave(int status) noexcept;  ///< the emulator ends with this status
bool write_file(const char* name, const void* from, std::uint32_t size) noexcept;

void start_clock() noexcept;
std::uint32_t clock_ticks() noexcept;  ///< of 40 ns; with `-icount shift=10` an instruction takes 25.6 of them

void paint_stack() noexcept;          ///< below the caller
std::uint32_t stack_left() noexcept;  ///< bytes that nobody has written since

}  // namespace metal
