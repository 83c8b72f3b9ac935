#include "plumb/noise/whiteness.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// Means that scatter within a tenth of what white noise does are taken for white.
constexpr double kSame = 0.1;
/// Averaging twice as long pays where it takes three tenths off the variance; white noise halves it.
constexpr double kPays = 0.7;

struct BlockScatter {
  double within = 0.0;  ///< variance of samples about the mean of their block
  double of_means = 0.0;
};

BlockScatter block_scatter(const std::vector<double>& readings, const std::vector<double>& sums, std::size_t block) {
  const std::size_t blocks = readings.size() / block;
  const auto n = static_cast<double>(block), count = static_cast<double>(blocks);
  // Sums are of readings less their mean: so are these means.
  const double level = sums.size() > 1 ? readings[0] - (sums[1] - sums[0]) : 0.0;
  const double all = (sums[blocks * block] - sums[0]) / (n * count);
  BlockScatter out;
  for (std::size_t b = 0; b < blocks; ++b) {
    const double mean = (sums[(b + 1) * block] - sums[b * block]) / n;
    out.of_means += (mean - all) * (mean - all) / (count - 1.0);
    for (std::size_t i = b * block; block > 1 && i < (b + 1) * block; ++i) {
      const double off = (readings[i] - level) - mean;
      out.within += off * off / ((n - 1.0) * count);
    }
  }
  return out;
}

std::size_t best_block_of(const std::vector<double>& sums) {
  std::size_t best = 1;
  double before = allan_variance(sums, 1);
  for (std::size_t m = 2; m <= kLongestWindow && 4 * m < sums.size(); m *= 2) {
    const double now = allan_variance(sums, m);
    if (now <= kPays * before) best = m;
    before = now;
  }
  return best;
}

}  // namespace

const char* to_string(WhitenessVerdict verdict) noexcept {
  switch (verdict) {
    case WhitenessVerdict::white: return "white";
    case WhitenessVerdict::correlated: return "correlated";
    case WhitenessVerdict::opposed: return "opposed";
  }
  return "?";
}

Whiteness whiteness(const std::vector<double>& readings, const std::vector<double>& sums, const Coefficients& noise,
                    double period_s, std::size_t block) {
  Whiteness out;
  out.block = block;
  std::vector<AllanPoint> point(1);
  point[0].samples = block;
  point[0].deviation = std::sqrt(allan_variance(sums, block));
  add_intervals(point, noise, readings.size(), period_s);
  const BlockScatter scatter = block_scatter(readings, sums, block);
  const double root = std::sqrt(static_cast<double>(block));
  out.block_sigma = point[0].deviation;
  out.block_sigma_high = point[0].high;
  out.sample_sigma = block > 1 ? std::sqrt(scatter.within) : out.block_sigma;
  if (out.sample_sigma > 0.0) out.factor = out.block_sigma * root / out.sample_sigma;
  const double low = out.factor * point[0].low / point[0].deviation,
               high = out.factor * point[0].high / point[0].deviation;
  if (out.factor > 1.0 + kSame && low > 1.0) out.verdict = WhitenessVerdict::correlated;
  if (out.factor < 1.0 - kSame && high < 1.0) out.verdict = WhitenessVerdict::opposed;
  out.declare_sigma = std::max(out.sample_sigma, out.block_sigma_high * root);
  out.best_block = best_block_of(sums);
  out.log_block_sigma = std::sqrt(scatter.of_means);
  const double covered = out.declare_sigma / root;
  if (out.log_block_sigma > (1.0 + kSame) * covered) out.wander = std::sqrt(scatter.of_means - covered * covered);
  return out;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
