#include "plumb/detection/combination_mae.hpp"

#include <cmath>
#include <cstring>
#include <type_traits>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// A double beyond this has no fraction left: adding and subtracting it rounds to the nearest integer, ties to even, in
/// a way that several triples can go at once.
constexpr double kNoFraction = 4503599627370496.0;
/// Triples side by side, in registers that every x86-64 and every ARMv8 has (vectors of GCC and Clang). Lane by lane
/// the same operations in the same order as for one triple alone: the same bits.
using Two = double __attribute__((vector_size(16)));
using TwoInts = std::int32_t __attribute__((vector_size(8)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
constexpr int kAtOnce = 4;
/// A processor of 32 bits has no registers for them: the compiler would take them apart again, by way of the stack.
constexpr bool kVectors = sizeof(void*) >= 8;

template <class V, class T>
inline V load(const T* from) noexcept {
  V out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
template <class V, class T>
inline void store(const V& v, T* to) noexcept {
  std::memcpy(to, &v, sizeof v);
}

/// `v` in every lane of a double or of two.
template <class T>
constexpr T lanes(double v) noexcept {
  if constexpr (std::is_same_v<T, double>) {
    return v;
  } else {
    return T{v, v};
  }
}

/// Written so that a NaN takes the clamp: no comparison with it is true.
template <class T>
inline T whole_units(T error_mps2) noexcept {
  const T units = (error_mps2 < lanes<T>(0.0) ? -error_mps2 : error_mps2) / lanes<T>(kMaeUnit_mps2);
  const T most = lanes<T>(static_cast<double>(kMaeClamp));
  const T held = units < most ? units : most;
  return (held + lanes<T>(kNoFraction)) - lanes<T>(kNoFraction);
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

/// The same for two triples.
inline TwoInts errors_of(const SensorArray& array, const Readings& y, int first, double g_mps2) noexcept {
  const auto& s = array.triple(first).sensors;
  const auto& r = array.triple(first + 1).sensors;
  const auto pair = [&y, &s, &r](size_t m) { return Two{y[index_of(s[m])], y[index_of(r[m])]}; };
  const Two a = pair(0), b = pair(1), c = pair(2);
  const auto q = [&array, first](size_t k) { return load<Two>(array.form_coefficients(k) + first); };
  const Two square = squared_length(q(0), q(1), q(2), q(3), q(4), q(5), a, b, c);
  const Two kept = square < lanes<Two>(0.0) ? lanes<Two>(0.0) : square;
  const Two length = {std::sqrt(kept[0]), std::sqrt(kept[1])};
  return __builtin_convertvector(whole_units(length - lanes<Two>(g_mps2)), TwoInts);
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

void CombinationMae::replace(std::int32_t& slot, std::int32_t value, std::int64_t& sum, std::uint16_t& count) noexcept {
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

/// Four triples of which every one has a value in this slot, before and now. False where one has none: nothing is done.
bool CombinationMae::replace_four(const SensorArray& array, const Readings& y_mps2, int first, double g_mps2) noexcept {
  const auto k = static_cast<size_t>(first);
  const size_t slot = row(head_) + k;
  const auto old = load<FourInts>(&ring_[slot]);
  if ((old[0] | old[1] | old[2] | old[3]) < 0) return false;
  const TwoInts low = errors_of(array, y_mps2, first, g_mps2), high = errors_of(array, y_mps2, first + 2, g_mps2);
  const FourInts now = __builtin_shufflevector(low, high, 0, 1, 2, 3);
  store(now, &ring_[slot]);
  const FourInts more = now - old;
  for (size_t t = 0; t < kAtOnce; ++t) sum_[k + t] += more[t];
  return true;
}

void CombinationMae::add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const Vec3* in_service,
                         double g_mps2) noexcept {
  const bool all_usable = usable.contains(array.all());
  int first = 0;
  while (first < triples_) {
    const bool four = kVectors && all_usable && first + kAtOnce <= triples_;
    if (four && replace_four(array, y_mps2, first, g_mps2)) {
      first += kAtOnce;
      continue;
    }
    const int end = four ? first + kAtOnce : triples_;
    for (; first < end; ++first) {
      const auto k = static_cast<size_t>(first);
      const bool present = all_usable || usable.contains(array.triple(first).set());
      const std::int32_t now = present ? error_of(array, y_mps2, first, g_mps2) : -1;
      replace(ring_[row(head_) + k], now, sum_[k], count_[k]);
    }
  }
  const std::int32_t all = in_service != nullptr ? to_mae_units(norm(*in_service) - g_mps2) : -1;
  replace(all_ring_[static_cast<size_t>(head_)], all, all_sum_, all_count_);
  head_ = head_ + 1 == window_ ? 0 : head_ + 1;
}

std::int64_t CombinationMae::fresh_triple_sum(int k) const noexcept {
  std::int64_t sum = 0;
  for (int slot = 0; slot < window_; ++slot) {
    const std::int32_t v = ring_[row(slot) + static_cast<size_t>(k)];
    if (v >= 0) sum += v;
  }
  return sum;
}

bool CombinationMae::holds() const noexcept {
  // An absent value is -1, all bits set: the words of a ring, as numbers without sign, add up to its sums and to that
  // for each absent one. One flipped bit, in a ring, in a sum or in a count, and they do not.
  constexpr std::uint64_t kAbsent = 0xFFFF'FFFFU;
  const auto words_of = [](const std::int32_t* v, size_t count) noexcept {
    std::uint64_t sum = 0, odd = 0;
    for (; count >= 2; count -= 2, v += 2) {
      std::uint64_t both;
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
