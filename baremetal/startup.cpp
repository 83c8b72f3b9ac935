// From reset to the application on Cortex-M: floating-point unit on, memory set up, no operating system.
#include <cstdint>

#include "board.hpp"

extern "C" {
extern std::uint32_t data_load[], data_begin[], data_end[], bss_begin[], bss_end[], stack_bottom[], stack_top[];
using Initialiser = void (*)();
extern Initialiser init_array_begin[], init_array_end[];
int application();  // not main, which ISO C++ forbids to call
[[noreturn]] void reset_handler();
[[noreturn]] void fault_handler();
[[gnu::weak]] void systick_handler();  // of an image that has the timer interrupt
// What <cmath> and the compiler may call; without an operating system each of them is the end.
[[noreturn]] void __assert_func(const char*, int, const char*, const char*) { metal::leave(90); }
[[noreturn]] void __cxa_pure_virtual() { metal::leave(91); }
}

namespace {

using Handler = void (*)();
constexpr std::uint32_t kPaint = 0xA5A5A5A5U;
constexpr std::uintptr_t kCoprocessorAccess = 0xE000ED88U;  // CPACR: full access to CP10 and CP11

[[gnu::section(".vectors"), gnu::used]] const struct {
  std::uint32_t* stack;
  Handler handler[15];
} vectors = {stack_top,
             {reset_handler, fault_handler, fault_handler, fault_handler, fault_handler, fault_handler, fault_handler,
              fault_handler, fault_handler, fault_handler, fault_handler, fault_handler, fault_handler, fault_handler,
              systick_handler}};

}  // namespace

void reset_handler() {
  *reinterpret_cast<volatile std::uint32_t*>(kCoprocessorAccess) |= 0xF00000U;
  asm volatile("dsb\nisb" ::: "memory");
  const std::uint32_t* from = data_load;
  for (std::uint32_t* to = data_begin; to < data_end; ++to) *to = *from++;
  for (std::uint32_t* to = bss_begin; to < bss_end; ++to) *to = 0;
  for (Initialiser* run = init_array_begin; run < init_array_end; ++run) (*run)();
  metal::leave(application());
}

void fault_handler() { metal::leave(92); }
void systick_handler() { metal::leave(93); }

namespace metal {

[[gnu::noinline]] void paint_stack() noexcept {
  const auto* here = static_cast<std::uint32_t*>(__builtin_frame_address(0));
  for (volatile std::uint32_t* word = stack_bottom; word < here - 16; ++word) *word = kPaint;
}

std::uint32_t stack_left() noexcept {
  const volatile std::uint32_t* word = stack_bottom;
  while (word < stack_top && *word == kPaint) ++word;
  return static_cast<std::uint32_t>(word - stack_bottom) * 4U;
}

namespace {
std::int32_t semihosting(std::uint32_t operation, const void* argument) noexcept {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return static_cast<std::int32_t>(r0);
}
}  // namespace

void leave(int status) noexcept {
  constexpr std::uint32_t kExitExtended = 0x20, kApplicationExit = 0x20026;
  const std::uint32_t block[] = {kApplicationExit, static_cast<std::uint32_t>(status)};
  semihosting(kExitExtended, block);
  for (;;) {
  }
}

bool write_file(const char* name, const void* from, std::uint32_t size) noexcept {
  constexpr std::uint32_t kOpen = 0x01, kClose = 0x02, kWrite = 0x05, kBinaryWrite = 5;
  std::uint32_t length = 0;
  while (name[length] != '\0') ++length;
  const std::uint32_t open[] = {static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(name)), kBinaryWrite,
                                length};
  const std::int32_t file = semihosting(kOpen, open);
  if (file < 0) return false;
  const std::uint32_t write[] = {static_cast<std::uint32_t>(file),
                                 static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(from)), size};
  const bool written = semihosting(kWrite, write) == 0;
  const std::uint32_t close[] = {static_cast<std::uint32_t>(file)};
  return semihosting(kClose, close) == 0 && written;
}

namespace {
/// APB timer 0 of the board, 25 MHz, counts down over 32 bits.
constexpr std::uintptr_t kTimer = 0x40000000U;
volatile std::uint32_t& timer(std::uintptr_t offset) noexcept {
  return *reinterpret_cast<volatile std::uint32_t*>(kTimer + offset);
}
}  // namespace

void start_clock() noexcept {
  timer(0x8) = 0xFFFFFFFFU;  // reload
  timer(0x4) = 0xFFFFFFFFU;  // value
  timer(0x0) = 1U;           // count
}

std::uint32_t clock_ticks() noexcept { return 0xFFFFFFFFU - timer(0x4); }

}  // namespace metal
