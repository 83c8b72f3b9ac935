// What episodes of an attack came to: plain numbers, so that whoever adds, prints and stores them knows no capacity.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace plumb_bench {

/// Most blocks from power-on to nominal that are told apart; the last bin holds longer times and never.
inline constexpr std::size_t kNominalBins = 257;

/// One number of a tally, by its name in files and tables.
enum class Count : std::uint8_t {
  episodes,
  blocks,        ///< offered while the attack lasts
  valid_blocks,  ///< of these, valid at their last sample
  // Episodes in which it happened; 0 is what plumb promises.
  wrong_exclusion,  ///< a healthy sensor excluded, with no more faults than the confirmed grade bears
  wrong_aside,      ///< a healthy sensor provisionally excluded, with no more faults than that grade bears
  beyond_level,     ///< at rest since before its block: a protection level given, and an error beyond it
  hazardous,        ///< the same: valid, alert off, and an error beyond the alert limit
  stale,            ///< usable without data, or of an attitude that the tool has left by more than a row can hide
  broken,           ///< own snapshot refused, sets that are no partition, a figure that is not finite
  failed_healthy,   ///< failed though no sensor is faulty
  // Episodes in which it happened; nothing is promised.
  unpromised,   ///< one of the above, with more faults in service than it is promised for, or behind hidden motion
  false_doubt,  ///< nominal left by an alarm before any sensor was faulty
  failed,       ///< failed, for whatever reason
  faulty,       ///< with a faulty sensor at least
  all_out,      ///< of these, with every faulty sensor out of service at the end
};
inline constexpr int kCounts = 15;
const char* to_string(Count count);

/// Safety columns: never in a promised family.
inline constexpr std::array<Count, 7> kSafety = {Count::wrong_exclusion, Count::wrong_aside, Count::beyond_level,
                                                 Count::hazardous,       Count::stale,       Count::broken,
                                                 Count::failed_healthy};

struct Tally {
  std::array<std::uint64_t, kCounts> count{};
  std::array<std::uint64_t, kNominalBins> to_nominal{};  ///< episodes by blocks from power-on to nominal

  std::uint64_t& operator[](Count c) { return count[static_cast<std::size_t>(c)]; }
  std::uint64_t operator[](Count c) const { return count[static_cast<std::size_t>(c)]; }
  void add(const Tally& other);
  /// Sum of the safety columns.
  std::uint64_t unsafe() const;
  /// Blocks within which half of the episodes became nominal; kNominalBins - 1 where it takes longer.
  std::size_t median_to_nominal() const;
  bool operator==(const Tally& other) const { return count == other.count && to_nominal == other.to_nominal; }
  bool operator!=(const Tally& other) const { return !(*this == other); }
};

}  // namespace plumb_bench
