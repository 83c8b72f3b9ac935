#include "plumb/detection/fault_ranges.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

bool FaultRanges::has(double f_mps2) const noexcept {
  for (int k = 0; k < count; ++k)
    if (range[static_cast<std::size_t>(k)].has(f_mps2)) return true;
  return false;
}

void FaultRanges::append(const FaultRange& more) noexcept {
  if (count > 0 && more.low_mps2 <= range[static_cast<std::size_t>(count - 1)].high_mps2) {
    FaultRange& last = range[static_cast<std::size_t>(count - 1)];
    last.high_mps2 = std::fmax(last.high_mps2, more.high_mps2);
    return;
  }
  if (count < kMost) {
    range[static_cast<std::size_t>(count++)] = more;
    return;
  }
  // The nearest two of five: k and the one behind it, which may be `more`.
  auto nearest = static_cast<std::size_t>(kMost - 1);
  double least = more.low_mps2 - range[nearest].high_mps2;
  for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(kMost); ++k) {
    const double apart = range[k + 1].low_mps2 - range[k].high_mps2;
    if (apart < least) {
      least = apart;
      nearest = k;
    }
  }
  if (nearest + 1 == static_cast<std::size_t>(kMost)) {
    range[nearest].high_mps2 = more.high_mps2;
    return;
  }
  range[nearest].high_mps2 = range[nearest + 1].high_mps2;
  for (std::size_t k = nearest + 1; k + 1 < static_cast<std::size_t>(kMost); ++k) range[k] = range[k + 1];
  range[static_cast<std::size_t>(kMost - 1)] = more;
}

FaultRanges FaultRanges::widened(double by_mps2) const noexcept {
  FaultRanges out;
  for (int k = 0; k < count; ++k) {
    const FaultRange& r = range[static_cast<std::size_t>(k)];
    out.append({r.low_mps2 - by_mps2, r.high_mps2 + by_mps2});
  }
  return out;
}

FaultRanges FaultRanges::with(const FaultRanges& other) const noexcept {
  FaultRanges out;
  for (int k = 0; k < count; ++k) {
    for (int m = 0; m < other.count; ++m) {
      const FaultRange& a = range[static_cast<std::size_t>(k)];
      const FaultRange& b = other.range[static_cast<std::size_t>(m)];
      const FaultRange both{std::fmax(a.low_mps2, b.low_mps2), std::fmin(a.high_mps2, b.high_mps2)};
      if (both.low_mps2 <= both.high_mps2) out.append(both);
    }
  }
  return out;
}

bool FaultRanges::plausible() const noexcept {
  if (count < 0 || count > kMost) return false;
  for (int k = 0; k < count; ++k) {
    const FaultRange& r = range[static_cast<std::size_t>(k)];
    const bool behind = k == 0 || range[static_cast<std::size_t>(k - 1)].high_mps2 < r.low_mps2;
    if (!(r.low_mps2 <= r.high_mps2) || !behind) return false;
  }
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
