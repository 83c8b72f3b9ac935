#include "plumb/health/detail/noise_study.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Channels that scatter by more than so many times what their residuals do scatter together: the tool moves.
constexpr double kTogetherSigmas = 2.0;
/// Channels that scatter by more than the largest factor explains in a block do so for another reason. With a stuck
/// sensor among them they need not do it together: it does not follow what moves the others.
constexpr double kMostOfOneBlock = 1.8 * NoiseStudy::kMostFactor * NoiseStudy::kMostFactor;
/// What the smoothest that counts of the triples shows of white noise, on average: it is one of the least smooth.
constexpr double kWhite = 1.1;
/// Noise is called correlated from this part of that on, and in few blocks from so much less.
constexpr double kStillWhite = 0.88, kOfOneBlock = 0.4;
/// ln of the variance of a mean over that of independent samples, for a smoothness of nothing. Fitted to noise of
/// the first order, its correlation from one sample to the next 0.5 to 0.99, in windows of 32.
constexpr double kSteepness = 4.6;
/// So many triples are looked at, evenly among all.
constexpr int kMostTriples = 64;

/// Scatter of the parity residuals, in variances that `stated` explains.
double parity_scatter(const SensorArray& array, const BlockAccumulator& block, const LeastSquares& used,
                      const BlockNoise& stated) noexcept {
  double sum = 0.0, expected = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!used.used.has(i)) continue;
    const double weight = 1.0 / (array.sigma_mps2(i) * array.sigma_mps2(i));
    for (int j = 0; j <= i; ++j) {
      if (!used.used.has(j)) continue;
      const double explained = dot(array.axis(i), used.column[static_cast<size_t>(j)]);
      const double projected = weight * ((i == j ? 1.0 : 0.0) - explained);
      sum += (i == j ? 1.0 : 2.0) * projected * block.covariance(i, j);
      if (i == j) expected += projected * stated.of(i);
    }
  }
  return expected > 0.0 ? sum / expected : 0.0;
}

float averaged(float mean, double value, double blocks) noexcept {
  return static_cast<float>(static_cast<double>(mean) + (value - static_cast<double>(mean)) / blocks);
}

/// Clamped, so that no reading makes of a mean what is no number.
double kept(double ratio) noexcept { return ratio >= 0.0 ? std::fmin(ratio, 1e6) : 0.0; }

/// The value that `rank` - 1 of `count` exceed.
template <class Values>
float ranked(Values& values, int count, int rank) noexcept {
  for (int k = 0; k < rank; ++k) {
    for (int j = k + 1; j < count; ++j) {
      if (values[static_cast<size_t>(j)] > values[static_cast<size_t>(k)])
        std::swap(values[static_cast<size_t>(j)], values[static_cast<size_t>(k)]);
    }
  }
  return values[static_cast<size_t>(rank - 1)];
}

}  // namespace

bool NoiseStudy::add(const SensorArray& array, const BlockAccumulator& block, const LeastSquares& used,
                     const BlockNoise& stated) noexcept {
  const int sensors = used.used.size();
  if (!used.valid || sensors < 4 || block.size() < kLeastWindow) return false;
  std::array<float, kCapacity> now{}, sorted{};
  int count = 0;
  for (int i = 0; i < array.size(); ++i) {
    if (!used.used.has(i)) continue;
    now[static_cast<size_t>(i)] = static_cast<float>(kept(block.covariance(i, i) / stated.of(i)));
    sorted[static_cast<size_t>(count++)] = now[static_cast<size_t>(i)];
  }
  const double parity = kept(parity_scatter(array, block, used, stated));
  const auto most = static_cast<double>(ranked(sorted, count, count / 2 + 1));
  if (most > kTogetherSigmas * std::fmax(parity, 1.0) || most > kMostOfOneBlock) return false;
  blocks_ = static_cast<float>(std::fmin(static_cast<double>(blocks_) + 1.0, kMemoryBlocks));
  for (int i = 0; i < array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double weight = sensors_.has(i) ? static_cast<double>(blocks_) : 1.0;
    if (used.used.has(i)) channel_[a] = averaged(channel_[a], static_cast<double>(now[a]), weight);
  }
  sensors_ = used.used;
  parity_ = averaged(parity_, parity, static_cast<double>(blocks_));
  freedom_ = static_cast<float>((sensors - 3) * (block.size() - 1));
  return true;
}

void NoiseStudy::add_smoothness(const SensorArray& array, const CombinationMae& window, SensorSet used) noexcept {
  if (window.window() < kLeastWindow || used.size() < 4) return;
  std::array<float, kMostTriples> values{};
  int count = 0;
  const int stride = (array.triple_count() + kMostTriples - 1) / kMostTriples;
  for (int k = 0; k < array.triple_count() && count < kMostTriples; k += stride) {
    if (!array.triple(k).votes || !used.contains(array.triple(k).set())) continue;
    const double value = window.smoothness(k);
    if (value >= 0.0) values[static_cast<size_t>(count++)] = static_cast<float>(value);
  }
  if (count == 0) return;
  // Of n sensors (n - 3) / n of the triples are without a given one; a fourth of these are less smooth than what
  // counts.
  const int rank = std::max(1, count * (used.size() - 3) / (4 * used.size()));
  smooth_blocks_ = static_cast<float>(std::fmin(static_cast<double>(smooth_blocks_) + 1.0, kMemoryBlocks));
  smoothness_ = averaged(smoothness_, static_cast<double>(ranked(values, count, rank)) / kWhite,
                         static_cast<double>(smooth_blocks_));
}

double NoiseStudy::factor() const noexcept {
  if (!(blocks_ >= 1.0F)) return 1.0;
  std::array<float, kCapacity> sorted{};
  int count = 0;
  for (size_t a = 0; a < channel_.size(); ++a) {
    if (sensors_.has(static_cast<int>(a))) sorted[static_cast<size_t>(count++)] = channel_[a];
  }
  if (count == 0 || !(freedom_ > 0.0F)) return 1.0;
  const auto most = static_cast<double>(ranked(sorted, count, count / 2 + 1));
  const double found = std::fmin(most, static_cast<double>(parity_));
  const double own_sigma = std::sqrt(2.0 / (static_cast<double>(freedom_) * static_cast<double>(blocks_)));
  if (!(found > 1.0 + kSignificance * own_sigma)) return 1.0;
  return std::fmin(std::sqrt(found * (1.0 + kMargin * own_sigma)), kMostFactor);
}

double NoiseStudy::correlation(double samples) const noexcept {
  if (!(smooth_blocks_ >= 1.0F) || !(samples > 1.0)) return 1.0;
  const auto found = static_cast<double>(smoothness_);
  if (!(found < kStillWhite - kOfOneBlock / static_cast<double>(smooth_blocks_))) return 1.0;
  return std::fmax(1.0, std::fmin(std::exp(kSteepness * (1.0 - found)), samples));
}

bool NoiseStudy::plausible() const noexcept {
  const auto count = [](float blocks) { return blocks >= 0.0F && blocks <= static_cast<float>(kMemoryBlocks); };
  return count(blocks_) && count(smooth_blocks_) && freedom_ >= 0.0F && smoothness_ >= 0.0F && parity_ >= 0.0F;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
