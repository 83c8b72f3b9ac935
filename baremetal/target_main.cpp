// The replay on the target. The emulator has put the recording at METAL_MEMORY, 16 MB beside the RAM that the program
// has; answers and costs are written to files of the host.
#include "board.hpp"
#include "replay.hpp"

namespace {

constexpr std::uintptr_t kRecording = METAL_MEMORY;  // first word: how many follow
constexpr std::uintptr_t kExact = kRecording + 0x400000U, kFigures = kRecording + 0x800000U;
constexpr std::uintptr_t kCosts = kRecording + 0xC00000U;
constexpr std::size_t kRoom = 0x400000U / 8U;  // words of each of them

}  // namespace

extern "C" int application();
int application() {
  const auto* recording = reinterpret_cast<const std::uint64_t*>(kRecording);
  metal::Answers answers = {{reinterpret_cast<std::uint64_t*>(kExact), kRoom},
                            {reinterpret_cast<std::uint64_t*>(kFigures), kRoom}};
  metal::WordWriter costs(reinterpret_cast<std::uint64_t*>(kCosts), kRoom);
  metal::start_clock();
  metal::paint_stack();
  const std::uint32_t before = metal::stack_left();
  const int wrong =
      metal::replay(recording + 1, static_cast<std::size_t>(recording[0]), answers, &costs, &metal::clock_ticks);
  const std::uint32_t used = before - metal::stack_left();
  if (wrong != 0) return wrong;
  costs.word(metal::monitor_size());
  costs.word(used);
  const bool written =
      metal::write_file("exact.bin", reinterpret_cast<const void*>(kExact), answers.exact.used() * 8U) &&
      metal::write_file("figures.bin", reinterpret_cast<const void*>(kFigures), answers.figures.used() * 8U) &&
      metal::write_file("costs.bin", reinterpret_cast<const void*>(kCosts), costs.used() * 8U);
  return written && !costs.full() ? 0 : 20;
}
