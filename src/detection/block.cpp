// BlockAccumulator and the judgement of a finished block.
#include <algorithm>
#include <cmath>

#include "plumb/core/detail/archive.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

using archive_detail::bits_of;
using std::size_t;

constexpr size_t packed_pair(int i, int j) noexcept {
  const auto hi = static_cast<size_t>(i > j ? i : j);
  const auto lo = static_cast<size_t>(i > j ? j : i);
  return hi * (hi + 1) / 2 + lo;
}

/// Variance of a linear functional of the channels over the block.
double functional_variance(const BlockAccumulator& block, const std::array<double, kCapacity>& l, int n) noexcept {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double own = l[static_cast<size_t>(i)];
    if (own == 0.0) continue;
    for (int j = 0; j < i; ++j) sum += 2.0 * own * l[static_cast<size_t>(j)] * block.covariance(i, j);
    sum += own * own * block.covariance(i, i);
  }
  return sum;
}

/// Over so many degrees of freedom a healthy residual may seem to scatter with this chance.
constexpr double kRecordRate = 1e-7;
/// Part of a channel's own scatter that its residual must hold before it is called the channel's.
constexpr double kOwnShare = 0.5;
/// The residual of a healthy channel against healthy ones passes for its own scatter with this chance in a block; three
/// blocks in a row are asked for.
constexpr double kCertainRate = 0.05;

/// A vector that swings by more than 0.1 g0 inside a block is motion whatever its noise class says: square of that
/// share.
constexpr double kMostSpread = 0.01;

/// So many of the others are doubted at once, at most: all that the provisional grade bears of eight; among more
/// units the choices would take too long.
constexpr int most_doubted(int n) noexcept { return n <= 8 ? 4 : 3; }

/// Scatter of the residual of a channel against the estimate of others.
struct ResidualScatter {
  double ratio = 0.0;   ///< to what noise explains
  double own = 0.0;     ///< of the channel alone, beyond noise [(m/s^2)^2]
  double excess = 0.0;  ///< of the residual, beyond noise [(m/s^2)^2]
};

ResidualScatter residual_scatter(const SensorArray& array, const BlockAccumulator& block, const BlockNoise& noise,
                                 const LeastSquares& others, int i) noexcept {
  std::array<double, kCapacity> l{};
  const double own_noise = noise.of(i);
  double expected = own_noise;
  for (int j = 0; j < array.size(); ++j) {
    const double weight = dot(array.axis(i), others.column[static_cast<size_t>(j)]);
    l[static_cast<size_t>(j)] = -weight;
    expected += weight * weight * noise.of(j);
  }
  l[static_cast<size_t>(i)] = 1.0;
  const double variance = functional_variance(block, l, array.size());
  return {variance / expected, block.covariance(i, i) - own_noise, variance - expected};
}

/// True where the scatter of channel i is its own, whichever `grade` units of `calm` are missing in the estimate: with
/// at most that many faulty ones among them, some choice leaves healthy sensors only, and those would have predicted a
/// movement of the tool.
bool own_for_certain(const SensorArray& array, const BlockAccumulator& block, const BlockNoise& noise, SensorSet calm,
                     int i, int grade) noexcept {
  const double least_ratio = scatter_factor(1, block.size(), kCertainRate);
  const SensorUnits& units = array.units();
  const SensorSet doubted = units.units_of(calm);
  for (SensorSet left = SensorSet::first(grade); units.all().contains(left); left = next_of_same_size(left)) {
    if (!doubted.contains(left)) continue;
    const LeastSquares ls = least_squares(array, calm - units.sensors_of(left));
    if (!ls.valid) return false;
    const ResidualScatter r = residual_scatter(array, block, noise, ls, i);
    // Few that lie badly say little of what the others feel: noise times a large factor.
    if (!(r.excess > kOwnShare * r.own && r.ratio > least_ratio)) return false;
  }
  return true;
}

/// v of the systematic limit: variance of the vector inside the block beyond what the stated noise explains. Noise that
/// was learned is not taken off: a movement may have been learned with it.
double vector_spread(const SensorArray& array, const BlockAccumulator& block, const BlockNoise& noise,
                     const LeastSquares& ls) noexcept {
  Vec3 excess{};
  for (int i = 0; i < array.size(); ++i) {
    if (!ls.used.has(i)) continue;
    const Vec3& own = ls.column[static_cast<size_t>(i)];
    for (int j = 0; j <= i; ++j) {
      if (!ls.used.has(j)) continue;
      const double expected = i == j ? noise.stated_of(i) : 0.0;
      const double times = i == j ? 1.0 : 2.0;
      const double beyond = times * (block.covariance(i, j) - expected);
      const Vec3& other = ls.column[static_cast<size_t>(j)];
      for (size_t axis = 0; axis < 3; ++axis) excess[axis] += own[axis] * other[axis] * beyond;
    }
  }
  double total = 0.0;
  for (const double e : excess) total += e > 0.0 ? e : 0.0;
  return total;
}

}  // namespace

void ScatterRecord::forget(int i, double keep) noexcept {
  const auto a = static_cast<size_t>(i);
  for (auto* sums : {&residual, &freedom, &own_excess, &residual_excess}) (*sums)[a] *= keep;
}

void ScatterRecord::add(int i, double ratio, double degrees, double own, double left) noexcept {
  const auto a = static_cast<size_t>(i);
  if (freedom[a] > kMostFreedom) forget(i, 0.5);
  residual[a] += ratio * degrees;
  freedom[a] += degrees;
  own_excess[a] += own;
  residual_excess[a] += left;
}

bool ScatterRecord::plausible() const noexcept {
  return std::all_of(freedom.begin(), freedom.end(),
                     [](double f) { return f >= 0.0 && f <= kMostFreedom + kWindowCapacity; });
}

void BlockAccumulator::clear() noexcept { *this = BlockAccumulator{}; }

void BlockAccumulator::add(const Readings& y_mps2, SensorSet usable, double count, Differences& d) noexcept {
  // A channel's origin is where it first delivers in the block.
  const SensorSet fresh = usable - usable_;
  for (int i = 0; (fresh.bits >> static_cast<unsigned>(i)) != 0 && i < kCapacity; ++i) {
    if (!fresh.has(i)) continue;
    const auto a = static_cast<size_t>(i);
    check_ += bits_of(y_mps2[a]) - bits_of(origin_[a]);
    origin_[a] = y_mps2[a];
  }
  check_ -= usable_.bits;
  usable_ = usable_ | usable;
  check_ += usable_.bits;
  d.fill(Scalar{0});
  Scalar* row = product_.data();
  std::uint32_t left = usable.bits;
  for (size_t i = 0; left != 0 && i < d.size(); row += ++i, left >>= 1U) {
    if ((left & 1U) == 0) continue;
    ++present_[i];
    const auto own = static_cast<Scalar>(y_mps2[i] - origin_[i]);
    d[i] = own;
    // What stood there is taken off as it is read: were it another than what was written, the difference would stay.
    check_ -= bits_of(sum_[i]);
    sum_[i] += own;
    check_ += bits_of(sum_[i]) + 1;
    for (size_t j = 0; j <= i; ++j) row[j] += own * d[j];
  }
  check_ -= bits_of(inverse_count_);
  // A division is the dearest of all operations where it is made in software.
  inverse_count_ += kSingle && count == 1.0 ? 1.0 : 1.0 / count;
  check_ += bits_of(inverse_count_) + 1;
  ++size_;
}

std::uint64_t BlockAccumulator::check() const noexcept {
  std::uint64_t out = usable_.bits + bits_of(inverse_count_) + static_cast<std::uint64_t>(size_);
  for (size_t i = 0; i < origin_.size(); ++i)
    out += bits_of(origin_[i]) + bits_of(sum_[i]) + static_cast<std::uint64_t>(present_[i]);
  return out;
}

SensorSet BlockAccumulator::usable() const noexcept {
  SensorSet out;
  for (int i = 0; i < kCapacity; ++i) {
    if (present_[static_cast<size_t>(i)] > 0 && 2 * present_[static_cast<size_t>(i)] >= size_) out = out.with(i);
  }
  return out;
}

SensorSet BlockAccumulator::complete() const noexcept {
  SensorSet out;
  for (int i = 0; i < kCapacity; ++i) {
    if (size_ > 0 && present_[static_cast<size_t>(i)] == size_) out = out.with(i);
  }
  return out;
}

double BlockAccumulator::samples(SensorSet of) const noexcept {
  if (size_ == 0) return 0.0;
  int least = size_;
  for (int i = 0; i < kCapacity; ++i) {
    if (of.has(i)) least = std::min<int>(least, present_[static_cast<size_t>(i)]);
  }
  // Variance of an unweighted mean of means: sigma^2 sum(1/count) / size^2; the scarcest channel decides.
  return static_cast<double>(size_) * least / inverse_count_;
}

Readings BlockAccumulator::mean() const noexcept {
  Readings out{};
  for (int i = 0; i < kCapacity; ++i) {
    const auto a = static_cast<size_t>(i);
    if (present_[a] > 0) out[a] = origin_[a] + static_cast<double>(sum_[a]) / present_[a];
  }
  return out;
}

bool BlockAccumulator::plausible() const noexcept {
  for (int i = 0; i < kCapacity; ++i) {
    const int present = present_[static_cast<size_t>(i)];
    if (present > size_ || (present > 0) != usable_.has(i)) return false;
    // What readings that are held at the clamp can have added up to: no mean and no covariance of them overflows.
    const double most = 2.0 * kReadingClamp_mps2;
    if (!(std::fabs(origin_[static_cast<size_t>(i)]) <= kReadingClamp_mps2)) return false;
    // A sum of 32 rounded ones may lie above that by its rounding.
    constexpr double kRounded = kSingle ? 1.0 + 1e-5 : 1.0;
    if (!(std::fabs(static_cast<double>(sum_[static_cast<size_t>(i)])) <= kRounded * most * present)) return false;
    for (int j = 0; j <= i; ++j) {
      if (!(std::fabs(static_cast<double>(product_[packed_pair(i, j)])) <= kRounded * most * most * size_))
        return false;
    }
  }
  // Every sample adds between 2^-32 and 1.
  return size_ == 0 ? inverse_count_ == 0.0 : inverse_count_ > 0.0 && inverse_count_ <= size_;
}

double BlockAccumulator::covariance(int i, int j) const noexcept {
  // Over the samples of the scarcer channel: exact without dropouts, within sigma^2/N with a few.
  const int least = std::min(present_[static_cast<size_t>(i)], present_[static_cast<size_t>(j)]);
  if (least < 2) return 0.0;
  const double n = least;
  const auto both = static_cast<double>(product_[packed_pair(i, j)]);
  const auto a = static_cast<double>(sum_[static_cast<size_t>(i)]),
             b = static_cast<double>(sum_[static_cast<size_t>(j)]);
  return (both - a * b / n) / (n - 1.0);
}

double scatter_factor(int n, int size, double rate) noexcept {
  return n > 0 && size > 1 ? chi2_tail_quantile(rate / n, size - 1) / (size - 1) : 0.0;
}

namespace {

/// So few units at rest may all hang at what they last said, in a tool that the others rightly show to move. A chip
/// feels every movement by itself, so that all may hang but one, and that one alone may be noisy just as well: of chips
/// it is the provisional grade, at which those that move check each other (docs/theory.md, section 5.7).
int most_that_hang(const SensorArray& array, SensorSet judged) noexcept {
  return array.units().grouped() ? provisional_grade(array, judged) : confirmed_grade(array, judged);
}

/// Sorts the scattering channels: noisy ones, and whether the rest leaves the tool at rest.
void tell_noise_from_motion(const SensorArray& array, const BlockAccumulator& block, const BlockNoise& noise,
                            const LeastSquares& ls, double factor, ScatterRecord* record,
                            BlockJudgement& out) noexcept {
  const SensorSet calm = ls.used;
  if (record != nullptr) {
    for (int i = 0; i < array.size(); ++i) {
      if (calm.has(i)) record->forget(i, 0.5);
    }
  }
  if (out.scattering.empty()) return;
  const int grade = std::min(provisional_grade(array, calm | out.scattering), most_doubted(array.units().size()));
  for (int i = 0; i < array.size(); ++i) {
    if (!out.scattering.has(i)) continue;
    const ResidualScatter r = residual_scatter(array, block, noise, ls, i);
    bool noisy = r.ratio > factor;
    if (record != nullptr) {
      const auto a = static_cast<size_t>(i);
      record->add(i, r.ratio, block.size() - 1, r.own, r.excess);
      const bool mine = record->residual_excess[a] > kOwnShare * record->own_excess[a];
      // The quantile last: it costs more than all the rest.
      noisy = noisy ||
              (mine && record->residual[a] > chi2_tail_quantile(kRecordRate, static_cast<int>(record->freedom[a])));
    }
    if (!noisy) {
      out.quiet = false;  // the others predict its movement: the tool moves
      continue;
    }
    out.noisy = out.noisy.with(i);
    if (grade > 0 && own_for_certain(array, block, noise, calm, i, grade))
      out.noisy_for_certain = out.noisy_for_certain.with(i);
  }
}

}  // namespace

BlockNoise noise_of(const SensorArray& array, double factor,
                    const std::array<float, kCapacity>& resolution_mps2) noexcept {
  BlockNoise out;
  for (int i = 0; i < array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double stated = array.sigma_mps2(i), sigma = factor * stated, step = static_cast<double>(resolution_mps2[a]);
    out.variance[a] = sigma * sigma + step * step / (step > sigma ? 4.0 : 12.0);
    out.stated[a] = stated * stated + step * step / (step > stated ? 4.0 : 12.0);
  }
  return out;
}

BlockJudgement judge_block(const SensorArray& array, const BlockAccumulator& block, SensorSet considered, double factor,
                           double g_mps2) noexcept {
  return judge_block(array, block, considered, factor, g_mps2, noise_of(array));
}

BlockJudgement judge_block(const SensorArray& array, const BlockAccumulator& block, SensorSet considered, double factor,
                           double g_mps2, const BlockNoise& noise, ScatterRecord* record,
                           const LeastSquares* known) noexcept {
  BlockJudgement out;
  out.evidence.mean_mps2 = block.mean();
  out.evidence.usable = block.usable() & array.all();
  out.evidence.samples = block.samples(out.evidence.usable & considered);
  const SensorSet judged = out.evidence.usable & considered;
  if (block.size() == 0) return out;
  if (block.size() == 1) {
    out.quiet = rank_of(array, judged) == 3;
    return out;
  }
  for (int i = 0; i < array.size(); ++i) {
    if (!judged.has(i)) continue;
    if (!(block.covariance(i, i) <= factor * noise.of(i))) out.scattering = out.scattering.with(i);
  }
  const SensorSet calm = judged - out.scattering;
  const bool at_hand = known != nullptr && known->valid && known->used == calm;
  const LeastSquares ls = at_hand ? *known : least_squares(array, calm);
  out.quiet = ls.valid;
  const bool may_hang = out.scattering.size() >= 3 && rank_of(array, out.scattering) == 3 &&
                        array.units().count(calm) <= most_that_hang(array, judged);
  if (ls.valid && may_hang) {
    out.quiet = false;
  } else if (ls.valid) {
    tell_noise_from_motion(array, block, noise, ls, factor, record, out);
  } else if (rank_of(array, judged) < 3) {
    out.scattering = SensorSet{};  // too few sensors to say anything
  }
  if (out.quiet) {
    out.evidence.spread_mps2_sq = vector_spread(array, block, noise, ls);
    out.quiet = out.evidence.spread_mps2_sq < kMostSpread * g_mps2 * g_mps2;
  }
  if (!out.quiet) out.noisy = out.noisy_for_certain = SensorSet{};
  return out;
}

bool moves_together(const SensorArray& array, const BlockAccumulator& block, SensorSet considered, double factor,
                    double g_mps2, const BlockNoise& noise, BlockJudgement& out) noexcept {
  const SensorSet judged = out.evidence.usable & considered;
  if (block.size() < 2 || judged.size() < 4) return false;
  for (int i = 0; i < array.size(); ++i) {
    if (!out.scattering.has(i)) continue;
    const LeastSquares others = least_squares(array, judged.without(i));
    if (!others.valid || !(residual_scatter(array, block, noise, others, i).ratio <= factor)) return false;
  }
  const LeastSquares all = least_squares(array, judged);
  out.evidence.spread_mps2_sq = vector_spread(array, block, noise, all);
  return all.valid && out.evidence.spread_mps2_sq < kMostSpread * g_mps2 * g_mps2;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
