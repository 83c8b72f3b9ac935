/// What is counted over many scenarios. Whole numbers only: two tallies added in any order give the same tally, so
/// threads, ranks and interruptions leave no trace in a result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "plumb/campaign/outcome.hpp"
#include "plumb/campaign/plan.hpp"

namespace plumb {
namespace campaign {

/// Counted apart for every cell; a scenario may raise several.
enum class Count : std::uint8_t {
  scenarios,
  detected,                     ///< an alarm of whatever kind at or after the onset
  isolated,                     ///< excluded at the end: the faulty sensors exactly
  partial,                      ///< excluded: some of the faulty sensors
  provisional,                  ///< none excluded, only faulty ones provisionally
  ambiguous,                    ///< detected, no sensor excluded or provisionally excluded at the end
  undetected,                   ///< a fault, and no alarm
  missed_above_threshold,       ///< no alarm, although one sensor had a constant bias of at least 1 MDB
  wrong_exclusion,              ///< a healthy sensor was excluded at any time
  wrong_provisional_exclusion,  ///< ... was provisionally excluded at any time
  false_alarm,                  ///< an alarm before the onset, or without any fault
  misleading,                   ///< error above the alert limit without an alert, while published as usable
  beyond_protection,            ///< error above the protection level, while published as usable
  unavailable,                  ///< alert at the end: nothing usable within the alert limit
  failed,                       ///< the monitor ended in `failed`
};
inline constexpr int kCounts = 15;
/// "wrong_exclusion": the key in the result file.
const char* to_string(Count count) noexcept;
/// What it means, for tables.
const char* words_of(Count count) noexcept;

/// Regions of the Stanford diagram, one entry per block that was published as usable or not.
enum class Region : std::uint8_t {
  available,              ///< error <= PL <= AL
  misleading,             ///< PL < error <= AL
  hazardous,              ///< PL <= AL < error
  unavailable,            ///< no PL, or PL above AL, error <= PL
  unavailable_misleading  ///< AL < PL < error
};
inline constexpr int kRegions = 5;
const char* to_string(Region region) noexcept;

/// Octaves of angle: number k ends at 0.001 deg times 2^k.
inline constexpr int kOctaves = 20;
int octave_of(double angle_rad) noexcept;

/// Numbers of the first scenarios in which something happened that must not.
inline constexpr int kKept = 16;
using FirstNumbers = std::array<std::uint64_t, kKept>;
inline constexpr std::uint64_t kNoNumber = ~std::uint64_t{0};

class Tally {
 public:
  Tally() = default;
  explicit Tally(const Plan& plan);

  void add(const Plan& plan, const Spec& spec, const Outcome& outcome) noexcept;
  /// Adds what another slice of the same campaign has counted.
  void merge(const Tally& other) noexcept;

  std::uint64_t count(int cell, Count what) const noexcept;
  std::uint64_t total(Count what) const noexcept;
  /// Largest error before any alarm, from the onset on [nrad].
  std::uint64_t largest_undetected_nrad(int cell) const noexcept { return largest_[static_cast<std::size_t>(cell)]; }
  std::uint64_t largest_undetected_nrad() const noexcept;
  int cells() const noexcept { return static_cast<int>(largest_.size()); }
  /// Blocks from the onset to the first alarm, and to the exclusion: [k] = k + 1 blocks.
  const std::array<std::uint64_t, kMostBlocks>& blocks_to_detect() const noexcept { return detect_; }
  const std::array<std::uint64_t, kMostBlocks>& blocks_to_isolate() const noexcept { return isolate_; }
  std::uint64_t region(Region which) const noexcept { return regions_[static_cast<std::size_t>(which)]; }
  /// Blocks by octave of error and of protection level (the last row: none available).
  std::uint64_t stanford(int error, int level) const noexcept {
    return stanford_[static_cast<std::size_t>(level * kOctaves + error)];
  }
  const FirstNumbers& first_wrong() const noexcept { return wrong_; }
  const FirstNumbers& first_misleading() const noexcept { return misleading_; }

  /// All of it as numbers, for files and messages: those that add up, those of which the largest counts, and those of
  /// which the smallest are kept.
  struct Numbers {
    std::vector<std::uint64_t> sums, maxima, firsts;
  };
  Numbers numbers() const;
  /// False where they are not those of this plan.
  bool take(const Numbers& numbers) noexcept;

 private:
  void count_blocks(const Plan& plan, const Outcome& outcome, std::uint64_t& largest_nrad) noexcept;

  std::vector<std::uint64_t> counts_;   ///< by cell, kCounts each
  std::vector<std::uint64_t> largest_;  ///< by cell
  std::array<std::uint64_t, kMostBlocks> detect_{}, isolate_{};
  std::array<std::uint64_t, kRegions> regions_{};
  std::array<std::uint64_t, std::size_t{kOctaves} * (kOctaves + 1)> stanford_{};
  FirstNumbers wrong_ = none(), misleading_ = none();

  static FirstNumbers none() noexcept {
    FirstNumbers out{};
    out.fill(kNoNumber);
    return out;
  }
};

/// The number of blocks within which a share of the counted cases fell; 0 where none was counted.
int quantile_blocks(const std::array<std::uint64_t, kMostBlocks>& histogram, double share) noexcept;

}  // namespace campaign
}  // namespace plumb
