// Samples from an interrupt to the loop: one writer, one reader, no lock, no copy that the other may see half done.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

/// `kRoom` items, a power of two: as many as may wait while one step takes long (docs/embedding.md, the worst step over
/// the time between two samples, plus one).
template <class Item, std::uint32_t kRoom>
class SampleRing {
  static_assert(kRoom != 0 && (kRoom & (kRoom - 1)) == 0, "a power of two");

 public:
  /// By the interrupt. False: no room, the item is dropped and counted.
  bool put(const Item& item) noexcept {
    const std::uint32_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == kRoom) {
      lost_.store(lost_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    item_[written % kRoom] = item;
    written_.store(written + 1, std::memory_order_release);
    return true;
  }

  /// By the loop. False: nothing waits.
  bool take(Item& item) noexcept {
    const std::uint32_t read = read_.load(std::memory_order_relaxed);
    if (read == written_.load(std::memory_order_acquire)) return false;
    item = item_[read % kRoom];
    read_.store(read + 1, std::memory_order_release);
    return true;
  }

  std::uint32_t waiting() const noexcept {
    return written_.load(std::memory_order_acquire) - read_.load(std::memory_order_relaxed);
  }
  std::uint32_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  std::array<Item, kRoom> item_{};
  std::atomic<std::uint32_t> written_{0}, read_{0}, lost_{0};
};
