#include "plumb/detection/combination_mae.hpp"

#include <cmath>
#include <cstring>

#include "plumb/detection/detail/near_lengths.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

#if PLUMB_WIDE_LANES
/// What is rare stays out of the way of what is not, and the registers are for that alone.
#define PLUMB_APART __attribute__((noinline))
#define PLUMB_WITHIN __attribute__((always_inline)) inline
#else
#define PLUMB_APART inline
#define PLUMB_WITHIN inline
#endif

namespace {

/// A double beyond this has no fraction left: adding and subtracting it rounds to the nearest integer, ties to even, in
/// a way that several triples can go at once.
constexpr double kNoFraction = 4503599627370496.0;
/// Written so that a NaN takes the clamp: no comparison with it is true.
inline double whole_units(double error_mps2) noexcept {
  const double units = (error_mps2 < 0.0 ? -error_mps2 : error_mps2) * kMaeUnits_per_mps2;
  const double held = units < static_cast<double>(kMaeClamp) ? units : static_cast<double>(kMaeClamp);
  return (held + kNoFraction) - kNoFraction;
}

/// A sensor of a triple as an index that no damage to the triple leads out of the readings.
constexpr size_t index_of(std::uint8_t sensor) noexcept {
  if constexpr ((kCapacity & (kCapacity - 1)) == 0) return sensor & static_cast<unsigned>(kCapacity - 1);
  return sensor < kCapacity ? sensor : 0;
}

/// Error of one triple in units.
inline std::int32_t error_of(const SensorArray& array, const Readings& y, int triple, double g_mps2) noexcept {
  const auto& s = array.triple(triple).sensors;
  const auto q = [&array, triple](size_t k) { return array.form_coefficients(k)[triple]; };
  const double square =
      squared_length(q(0), q(1), q(2), q(3), q(4), q(5), y[index_of(s[0])], y[index_of(s[1])], y[index_of(s[2])]);
  const double kept = square < 0.0 ? 0.0 : square;  // a NaN goes through to the clamp
  return static_cast<std::int32_t>(whole_units(std::sqrt(kept) - g_mps2));
}

}  // namespace

std::int32_t to_mae_units(double error_mps2) noexcept { return static_cast<std::int32_t>(whole_units(error_mps2)); }

void CombinationMae::configure(int triples, int window) noexcept {
  triples_ = static_cast<std::uint16_t>(triples);
  window_ = static_cast<std::uint16_t>(window < 1 ? 1 : window > kWindowCapacity ? kWindowCapacity : window);
  clear();
}

void CombinationMae::clear() noexcept {
  ring_.fill(-1);
  sum_.fill(0);
  count_.fill(0);
  head_ = 0;
  clear_all_sensor();
}

void CombinationMae::clear_all_sensor() noexcept {
  all_ring_.fill(-1);
  all_sum_ = 0;
  all_count_ = 0;
}

inline void CombinationMae::replace(std::int32_t& slot, std::int32_t value, std::int64_t& sum,
                                    std::uint16_t& count) noexcept {
  if (slot >= 0) {
    sum -= slot;
    --count;
  }
  slot = value;
  if (value >= 0) {
    sum += value;
    ++count;
  }
}

/// What is not all there side by side: where a sensor is not usable, where some do not all have a value yet, fewer
/// sensors than fit, the rest behind the last two.
PLUMB_APART void CombinationMae::add_from(int first, Lanes lanes, const SensorArray& array, const Readings& y_mps2,
                                          SensorSet usable, double g_mps2) noexcept {
  constexpr int kMostAtOnce = 8;
  const bool side_by_side = kPortableLanes != Lanes::one && lanes != Lanes::one && usable.contains(array.all());
  Readings moved{};
  const int fewer = kCapacity - array.size();
  if (side_by_side) {
    for (int i = fewer; i < kCapacity; ++i) moved[static_cast<size_t>(i)] = y_mps2[static_cast<size_t>(i - fewer)];
  }
  std::int32_t* const slots = &ring_[row(head_)];
  while (first < triples_) {
    if (side_by_side) {
      first = replace_side_by_side(array, moved.data(), g_mps2, slots, sum_.data(), {first, triples_}, lanes);
    }
    const int end = side_by_side && first + kMostAtOnce <= triples_ ? first + kMostAtOnce : triples_;
    for (; first < end; ++first) {
      const auto k = static_cast<size_t>(first);
      const bool present = side_by_side || usable.contains(array.triple(first).set());
      const std::int32_t now = present ? error_of(array, y_mps2, first, g_mps2) : -1;
      replace(slots[k], now, sum_[k], count_[k]);
    }
  }
}

PLUMB_WITHIN void CombinationMae::add_by(Lanes lanes, const SensorArray& array, const Readings& y_mps2,
                                         SensorSet usable, const Vec3* in_service, double g_mps2) noexcept {
  int first = 0;
  if (kPortableLanes != Lanes::one && lanes != Lanes::one && array.size() == kCapacity &&
      usable.contains(SensorSet::first(kCapacity))) {
    std::int32_t* const slots = &ring_[row(head_)];
    first = replace_side_by_side(array, y_mps2.data(), g_mps2, slots, sum_.data(), {0, triples_}, lanes);
  }
  if (first < triples_) add_from(first, lanes, array, y_mps2, usable, g_mps2);
  const std::int32_t all = in_service != nullptr ? to_mae_units(norm(*in_service) - g_mps2) : -1;
  replace(all_ring_[static_cast<size_t>(head_)], all, all_sum_, all_count_);
  head_ = head_ + 1 == window_ ? 0 : head_ + 1;
}

void CombinationMae::add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const Vec3* in_service,
                         double g_mps2) noexcept {
  add_by(most_lanes(), array, y_mps2, usable, in_service, g_mps2);
}

void CombinationMae::add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const Vec3* in_service,
                         double g_mps2, Lanes lanes) noexcept {
  add_by(lanes, array, y_mps2, usable, in_service, g_mps2);
}

#if PLUMB_SINGLE
void CombinationMae::add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const NearLengths& lengths,
                         const Differences& d_mps2, std::int32_t all_units, double g_mps2) noexcept {
  const SensorSet near = NearLengths::near(d_mps2, usable);
  const bool all_near = near.contains(array.all());
  for (int k = 0; k < triples_; ++k) {
    const auto a = static_cast<size_t>(k);
    std::int32_t now = -1;
    if (all_near || near.contains(array.triple(k).set())) now = lengths.triple_units(array, k, d_mps2);
    if (now < 0 && usable.contains(array.triple(k).set())) now = error_of(array, y_mps2, k, g_mps2);
    replace(ring_[row(head_) + a], now, sum_[a], count_[a]);
  }
  replace(all_ring_[static_cast<size_t>(head_)], all_units, all_sum_, all_count_);
  head_ = head_ + 1 == window_ ? 0 : head_ + 1;
}
#endif

std::int64_t CombinationMae::fresh_triple_sum(int k) const noexcept {
  std::int64_t sum = 0;
  for (int slot = 0; slot < window_; ++slot) {
    const std::int32_t v = ring_[row(slot) + static_cast<size_t>(k)];
    if (v >= 0) sum += v;
  }
  return sum;
}

double CombinationMae::smoothness(int k) const noexcept {
  if (count_[static_cast<size_t>(k)] < window_ || window_ < 3) return -1.0;
  const double mean = whole(sum_[static_cast<size_t>(k)]) / window_;
  double square = 0.0, steps = 0.0, before = 0.0;
  for (int n = 0, slot = head_; n < window_; ++n, slot = slot + 1 == window_ ? 0 : slot + 1) {
    const double off = static_cast<double>(ring_[row(slot) + static_cast<size_t>(k)]) - mean;
    if (n > 0) steps += (off - before) * (off - before);
    square += off * off;
    before = off;
  }
  return square > 0.0 ? 0.5 * steps / square : -1.0;
}

bool CombinationMae::holds() const noexcept {
  // An absent value is -1, all bits set: the words of a ring, as numbers without sign, add up to its sums and to that
  // for each absent one. One flipped bit, in a ring, in a sum or in a count, and they do not.
  constexpr std::uint64_t kAbsent = 0xFFFF'FFFFU;
  const auto words_of = [](const std::int32_t* v, size_t count) noexcept {
    std::uint64_t sum = 0, odd = 0;
    for (; count >= 2; count -= 2, v += 2) {
      std::uint64_t both = 0;
      std::memcpy(&both, v, sizeof both);
      sum += both & kAbsent;
      odd += both >> 32U;
    }
    return sum + odd + (count != 0 ? static_cast<std::uint32_t>(*v) : 0U);
  };
  const size_t window = window_, slots = window * triples_;
  std::uint64_t sum = 0, present = 0;
  for (size_t k = 0; k < triples_; ++k) {
    sum += static_cast<std::uint64_t>(sum_[k]);
    present += count_[k];
  }
  const std::uint64_t all = words_of(all_ring_.data(), window);
  return words_of(ring_.data(), slots) == sum + (slots - present) * kAbsent &&
         all == static_cast<std::uint64_t>(all_sum_) + (window - all_count_) * kAbsent;
}

void CombinationMae::rebuild() noexcept {
  sum_.fill(0);
  count_.fill(0);
  all_sum_ = 0;
  all_count_ = 0;
  for (int slot = 0; slot < window_; ++slot) {
    for (int k = 0; k < triples_; ++k) {
      const std::int32_t v = ring_[row(slot) + static_cast<size_t>(k)];
      if (v < 0) continue;
      sum_[static_cast<size_t>(k)] += v;
      ++count_[static_cast<size_t>(k)];
    }
    const std::int32_t all = all_ring_[static_cast<size_t>(slot)];
    if (all < 0) continue;
    all_sum_ += all;
    ++all_count_;
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb
