// A thousand samples a second by the timer interrupt, the monitor in the loop, a million samples: none may be lost. The
// interrupt writes into a ring, the loop takes from it and sleeps where nothing waits.
#include "../examples/embed/sample_ring.hpp"
#include "board.hpp"
#include "plumb/health/health_monitor.hpp"
#include "ticks.hpp"

extern "C" {
int application();
void systick_handler();
}

namespace {

constexpr std::uint32_t kRoom = 256;
metal::TickedTool tool;
plumb::HealthMonitor monitor;
SampleRing<plumb::Sample, kRoom> ring;
volatile int ticks = 0;

/// SysTick, from the processor's clock of 25 MHz.
void start_ticks() noexcept {
  const auto reg = [](std::uintptr_t at) -> volatile std::uint32_t& {
    return *reinterpret_cast<volatile std::uint32_t*>(at);
  };
  reg(0xE000E014U) = 25000U - 1U;
  reg(0xE000E018U) = 0U;
  reg(0xE000E010U) = 7U;  // counts, interrupts, by the processor's clock
}

}  // namespace

void systick_handler() {
  if (ticks >= metal::kTicks) return;
  plumb::Sample sample;
  tool.sample(ticks, sample);
  ring.put(sample);
  ticks = ticks + 1;
}

int application() {
  if (!tool.make() || !monitor.configure(tool.setup())) return 2;
  metal::start_clock();
  start_ticks();
  plumb::Sample sample;
  std::uint32_t most = 0, worst = 0;
  for (int k = 0; k < metal::kTicks;) {
    if (!ring.take(sample)) {
      if (ring.lost() != 0) break;
      asm volatile("wfi");
      continue;
    }
    const std::uint32_t begin = metal::clock_ticks();
    const plumb::Verdict& verdict = monitor.step(sample);
    const std::uint32_t took = metal::clock_ticks() - begin;
    worst = took > worst ? took : worst;
    most = ring.waiting() > most ? ring.waiting() : most;
    const int wrong = metal::wrong_after(k, verdict);
    if (wrong != 0) return 10 + wrong;
    ++k;
  }
  const std::uint32_t told[] = {static_cast<std::uint32_t>(ticks), ring.lost(), most, worst};
  return metal::write_file("ticks.bin", told, sizeof told) && ring.lost() == 0 ? 0 : 3;
}
