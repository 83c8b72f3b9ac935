/// What is wrong with the bytes of a log, told without a damaged log filling the screen (private to src/logs).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "plumb/core/config.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

/// The same kind of trouble is told at most five times; the rest is counted, and summed up at the end. `Trouble` is an
/// enumeration that ends with `count`; `words_of(Trouble)` names many of a kind.
template <class Trouble>
class LogNotes {
 public:
  static constexpr std::uint64_t kToldOfAKind = 5;

  explicit LogNotes(LogSink& sink) : sink_(sink) {}

  /// Counts a trouble. False where it would not be told: its sentence need not be put together.
  bool wanted(Trouble trouble, std::uint64_t offset) noexcept {
    Tally& tally = tallies_[static_cast<std::size_t>(trouble)];
    ++tally.seen;
    if (tally.seen == kToldOfAKind + 1) tally.first_untold = offset;
    return tally.seen <= kToldOfAKind;
  }
  /// After `wanted` of the same trouble, or of what a log can have only once.
  void say(std::uint64_t offset, const std::string& what) { sink_.note(offset, what); }
  void sum_up() {
    for (std::size_t k = 0; k < tallies_.size(); ++k) {
      if (tallies_[k].seen <= kToldOfAKind) continue;
      say(tallies_[k].first_untold, std::to_string(tallies_[k].seen - kToldOfAKind) +
                                        " more notes from here on are left out: " + words_of(static_cast<Trouble>(k)));
    }
  }

 private:
  struct Tally {
    std::uint64_t seen = 0;
    std::uint64_t first_untold = 0;  ///< offset
  };
  LogSink& sink_;
  std::array<Tally, static_cast<std::size_t>(Trouble::count)> tallies_{};
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
