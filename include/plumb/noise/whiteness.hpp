/// Whether the noise is white over a block, and what follows for the block and for the sigma to declare.
///
/// A monitor believes that a mean over a block of N samples scatters by sigma/sqrt(N) (docs/theory.md, section 3.2).
/// That holds for white noise; an output filter, vibration and slow terms make means scatter more, quantisation less.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plumb/noise/allan.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

enum class WhitenessVerdict : std::uint8_t {
  white,       ///< means of a block scatter as those of white noise do, within a tenth or by chance
  correlated,  ///< more
  opposed,     ///< less: one sample takes back what the one before it added
};
const char* to_string(WhitenessVerdict verdict) noexcept;

struct Whiteness {
  WhitenessVerdict verdict = WhitenessVerdict::white;
  std::size_t block = 0;          ///< samples of a block
  double sample_sigma = 0.0;      ///< of samples within a block, about its mean [unit of the readings]
  double block_sigma = 0.0;       ///< of one block's mean against the next: Allan deviation over the block
  double block_sigma_high = 0.0;  ///< upper end of its 95 % interval
  double factor = 1.0;            ///< block_sigma sqrt(block)/sample_sigma; 1 for white noise
  /// What to state as the noise of one sample: covers samples within a block and means of blocks.
  double declare_sigma = 0.0;
  /// The longest block up to kLongestWindow that still averages: each doubling up to it takes three tenths off the
  /// variance.
  std::size_t best_block = 1;
  double log_block_sigma = 0.0;  ///< of the means of all blocks of the log about their mean
  double wander = 0.0;  ///< what that is beyond declare_sigma/sqrt(block); 0: nothing. It belongs to `stability`
};
/// Longest block of a monitor.
inline constexpr std::size_t kLongestWindow = 256;

/// `sums` as of prefix_sums, with readings for at least four blocks of `block` samples; `noise`: of the fit, for the
/// interval.
Whiteness whiteness(const std::vector<double>& readings, const std::vector<double>& sums, const Coefficients& noise,
                    double period_s, std::size_t block);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
