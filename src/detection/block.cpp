// BlockAccumulator and the judgement of a finished block.
#include <algorithm>
#include <cmath>

#include "plumb/detection/stationarity.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

using std::size_t;

constexpr size_t packed(int i, int j) noexcept {
  const auto hi = static_cast<size_t>(i > j ? i : j);
  const auto lo = static_cast<size_t>(i > j ? j : i);
  return hi * (hi + 1) / 2 + lo;
}

/// Variance of a linear functional of the channels over the block.
double functional_variance(const BlockAccumulator& block, const std::array<double, kCapacity>& l, int n) noexcept {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    if (l[static_cast<size_t>(i)] == 0.0) continue;
    for (int j = 0; j < n; ++j) sum += l[static_cast<size_t>(i)] * l[static_cast<size_t>(j)] * block.covariance(i, j);
  }
  return sum;
}

/// True where the residual of channel i against the estimate of the quiet ones scatters beyond noise.
bool residual_restless(const SensorArray& array, const BlockAccumulator& block, const LeastSquares& others, int i,
                       double factor) noexcept {
  std::array<double, kCapacity> l{};
  double expected = array.sigma_mps2(i) * array.sigma_mps2(i);
  for (int j = 0; j < array.size(); ++j) {
    const double weight = dot(array.axis(i), others.column[static_cast<size_t>(j)]);
    l[static_cast<size_t>(j)] = -weight;
    expected += weight * weight * array.sigma_mps2(j) * array.sigma_mps2(j);
  }
  l[static_cast<size_t>(i)] = 1.0;
  return functional_variance(block, l, array.size()) > factor * expected;
}

/// v of the systematic limit: variance of the vector inside the block beyond what noise explains.
double vector_spread(const SensorArray& array, const BlockAccumulator& block, const LeastSquares& ls) noexcept {
  double total = 0.0;
  for (size_t axis = 0; axis < 3; ++axis) {
    std::array<double, kCapacity> l{};
    double expected = 0.0;
    for (int j = 0; j < array.size(); ++j) {
      const double weight = ls.column[static_cast<size_t>(j)][axis];
      l[static_cast<size_t>(j)] = weight;
      expected += weight * weight * array.sigma_mps2(j) * array.sigma_mps2(j);
    }
    const double excess = functional_variance(block, l, array.size()) - expected;
    if (excess > 0.0) total += excess;
  }
  return total;
}

}  // namespace

void BlockAccumulator::clear() noexcept { *this = BlockAccumulator{}; }

void BlockAccumulator::add(const Readings& y_mps2, SensorSet usable, double count) noexcept {
  if (size_ == 0) {
    usable_ = usable;
    for (int i = 0; i < kCapacity; ++i)
      origin_[static_cast<size_t>(i)] = usable.has(i) ? y_mps2[static_cast<size_t>(i)] : 0.0;
  }
  // A channel that first delivers later in the block starts its origin then.
  for (int i = 0; i < kCapacity; ++i) {
    if (usable.has(i) && !usable_.has(i)) origin_[static_cast<size_t>(i)] = y_mps2[static_cast<size_t>(i)];
  }
  usable_ = usable_ | usable;
  std::array<double, kCapacity> d{};
  for (int i = 0; i < kCapacity; ++i) {
    const auto a = static_cast<size_t>(i);
    if (!usable.has(i)) continue;
    ++present_[a];
    d[a] = y_mps2[a] - origin_[a];
    sum_[a] += d[a];
    for (int j = 0; j <= i; ++j) product_[packed(i, j)] += d[a] * d[static_cast<size_t>(j)];
  }
  inverse_count_ += 1.0 / count;
  ++size_;
}

SensorSet BlockAccumulator::usable() const noexcept {
  SensorSet out;
  for (int i = 0; i < kCapacity; ++i) {
    if (present_[static_cast<size_t>(i)] > 0 && 2 * present_[static_cast<size_t>(i)] >= size_) out = out.with(i);
  }
  return out;
}

double BlockAccumulator::samples(SensorSet of) const noexcept {
  if (size_ == 0) return 0.0;
  int least = size_;
  for (int i = 0; i < kCapacity; ++i) {
    if (of.has(i)) least = std::min(least, present_[static_cast<size_t>(i)]);
  }
  // Variance of an unweighted mean of means: sigma^2 sum(1/count) / size^2; the scarcest channel decides.
  return static_cast<double>(size_) * least / inverse_count_;
}

Readings BlockAccumulator::mean() const noexcept {
  Readings out{};
  for (int i = 0; i < kCapacity; ++i) {
    const auto a = static_cast<size_t>(i);
    if (present_[a] > 0) out[a] = origin_[a] + sum_[a] / present_[a];
  }
  return out;
}

bool BlockAccumulator::plausible() const noexcept {
  for (int i = 0; i < kCapacity; ++i) {
    const int present = present_[static_cast<size_t>(i)];
    if (present > size_ || (present > 0) != usable_.has(i)) return false;
  }
  // Every sample adds between 2^-32 and 1.
  return size_ == 0 ? inverse_count_ == 0.0 : inverse_count_ > 0.0 && inverse_count_ <= size_;
}

double BlockAccumulator::covariance(int i, int j) const noexcept {
  // Over the samples of the scarcer channel: exact without dropouts, within sigma^2/N with a few.
  const int least = std::min(present_[static_cast<size_t>(i)], present_[static_cast<size_t>(j)]);
  if (least < 2) return 0.0;
  const double n = least;
  return (product_[packed(i, j)] - sum_[static_cast<size_t>(i)] * sum_[static_cast<size_t>(j)] / n) / (n - 1.0);
}

double restless_factor(int n, int size, double rate) noexcept {
  return n > 0 && size > 1 ? chi2_tail_quantile(rate / n, size - 1) / (size - 1) : 0.0;
}

BlockJudgement judge_block(const SensorArray& array, const BlockAccumulator& block, SensorSet considered, double factor,
                           double g_mps2) noexcept {
  BlockJudgement out;
  out.evidence.mean_mps2 = block.mean();
  out.evidence.usable = block.usable() & array.all();
  out.evidence.samples = block.samples(out.evidence.usable & considered);
  const SensorSet judged = out.evidence.usable & considered;
  if (block.size() == 0 || rank_of(array, judged) < 3) return out;
  if (block.size() == 1) {
    out.quiet = true;
    return out;
  }
  for (int i = 0; i < array.size(); ++i) {
    if (!judged.has(i)) continue;
    const double limit = factor * array.sigma_mps2(i) * array.sigma_mps2(i);
    if (block.covariance(i, i) > limit) out.restless = out.restless.with(i);
  }
  const SensorSet calm = judged - out.restless;
  const LeastSquares ls = least_squares(array, calm);
  out.quiet = ls.valid;
  for (int i = 0; i < array.size() && out.quiet; ++i) {
    if (!out.restless.has(i)) continue;
    if (residual_restless(array, block, ls, i, factor)) {
      out.noisy = out.noisy.with(i);
    } else {
      out.quiet = false;  // the others predict its movement: the tool moves
    }
  }
  if (out.quiet) {
    out.evidence.spread_mps2_sq = vector_spread(array, block, ls);
    // A vector that swings by more than 0.1 g0 inside a block is motion whatever its noise class says.
    out.quiet = out.evidence.spread_mps2_sq < 0.01 * g_mps2 * g_mps2;
  } else {
    out.noisy = SensorSet{};
  }
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
